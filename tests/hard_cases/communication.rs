//! Communication steps of any size, and inputs that jump, shake and step.

use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;

use crate::gates::{Case, Importer, Run, limits};
use crate::random::Random;
use crate::scenes::{ANGULAR, HELD, POSE, ROLLING_START, load, scene};

const COMBINED: &str = "x = { force = 1500.0 }\ny = { force = 300.0 }\n";

/// Thrust and radial load, communication steps of `step`.
fn regular(step: &str, milliseconds: f64) -> Run {
    let rows = format!("{COMBINED}output_interval = \"{step}\"");
    let scene = scene(ANGULAR, &load(milliseconds, 6000.0, &rows));
    Case::new(&format!("communication steps of {step}"), scene, limits(2300, 5, 5, 3.0)).pass()
}

#[test]
fn steps_from_1_us_to_10_ms() {
    let reference = regular("100 us", 20.0);
    // Two milliseconds of 1 us steps; there the own steps are shorter too, and the start's ringing is seen.
    for (step, milliseconds, point, tolerance) in [
        ("10 us", 20.0, 200, 1e-6),
        ("1 ms", 20.0, 200, 1e-6),
        ("10 ms", 20.0, 200, 1e-6),
        ("1 us", 2.0, 20, 1e-3),
    ] {
        let run = regular(step, milliseconds);
        let (a, b) = (run.last(), &reference.history[point]);
        assert!((a.time - b.time).abs() < 1e-12);
        for (one, other) in [
            (a.balls[0].inner.load, b.balls[0].inner.load),
            (a.inner.pose.position.x, b.inner.pose.position.x),
            (a.dissipated, b.dissipated),
        ] {
            assert!((one / other - 1.0).abs() < tolerance, "{step}: {one} {other}");
        }
    }
}

#[test]
fn irregular_steps() {
    // From a microsecond to three milliseconds, evenly on a logarithmic scale.
    let mut random = Random::new(3);
    let mut times: Vec<f64> = vec![];
    while times.last().is_none_or(|time| *time < 0.04) {
        times.push(times.last().unwrap_or(&0.0) + random.logarithmic(1e-6, 3e-3));
    }
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        (simulation.scripted_inputs(simulation.time()), times[point as usize])
    };
    let scene = scene(ANGULAR, &load(40.0, 6000.0, COMBINED));
    let mut case = Case::new("irregular communication steps, 1 us to 3 ms", scene, limits(4600, 5, 5, 3.0));
    case.importer = Some(&importer);
    case.points = times.len() as u32;
    let run = case.pass();
    let sum: f64 = run.last().balls.iter().map(|b| b.inner.load * b.inner.contact_angle.sin()).sum();
    assert!((sum / 1500.0 - 1.0).abs() < 0.03, "{sum} N");
}

const THREE: &str = "[bearing]\nballs = 3\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
                     contact_angle = \"25 deg\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n";

/// As many communication steps of 100 ns as `milliseconds` have, against usual ones.
fn tiny(milliseconds: f64) {
    let run = |interval: &str, every: u32| {
        let rows = format!("x = {{ force = 500.0 }}\n{HELD}output_interval = \"{interval}\"\n");
        let name = format!("{milliseconds} ms in communication steps of {interval}");
        let scene = scene(ANGULAR, &(load(milliseconds, 6000.0, &rows) + THREE + POSE));
        let mut case = Case::new(&name, scene, limits(110_000, 5, 5, 3.0));
        case.every = every;
        case.pass()
    };
    let (tiny, usual) = (run("100 ns", 100), run("100 us", 1));
    let (a, b) = (tiny.last(), usual.last());
    for (one, other) in [
        (a.balls[0].inner.load, b.balls[0].inner.load),
        (a.balls[0].outer.load, b.balls[0].outer.load),
        (a.dissipated, b.dissipated),
    ] {
        assert!((one / other - 1.0).abs() < 1e-4, "{one} {other}");
    }
}

#[test]
fn ten_thousand_tiny_steps() {
    tiny(1.0);
}

#[test]
#[ignore = "long"]
fn hundred_thousand_tiny_steps() {
    tiny(10.0);
}

/// Thrust case with a given pose for 40 ms.
fn posed(name: &str, importer: &Importer<'_>, limit: crate::gates::Limits) -> Run {
    let mut case = Case::new(name, posed_scene(), limit);
    case.importer = Some(importer);
    case.pass()
}

fn posed_scene() -> roulement::scene::Scene {
    let rows = format!("x = {{ force = 1500.0 }}\n{HELD}");
    scene(ANGULAR, &(load(40.0, 6000.0, &rows) + POSE + "\n" + ROLLING_START))
}

/// [m] where 1500 N put the inner race.
fn thrust_position() -> f64 {
    Simulation::new(&posed_scene()).unwrap().inputs().inner.pose.position.x
}

#[test]
fn pose_that_jumps() {
    // 5 um to and fro every millisecond, without a velocity that would announce it.
    let start = thrust_position();
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        inputs.inner.pose.position.x = start + if point / 10 % 2 == 1 { 5e-6 } else { 0.0 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let run = posed("pose jumps by 5 um every ms", &importer, limits(5300, 5, 5, 3.0));
    // The thrust of both positions, and nothing beyond them.
    let thrust = |i: usize| -run.history[i].inner.wrench.force.x;
    let (low, high) = (thrust(390), thrust(400));
    let all = (100..=400).map(thrust);
    let (least, most) = all.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
    assert!((low / 1505.0 - 1.0).abs() < 0.01 && high > 1.3 * low, "{low} N, {high} N");
    assert!(least > 0.97 * low && most < 1.03 * high, "{least} to {most} N");
}

#[test]
fn pose_with_noise() {
    let start = thrust_position();
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        // The noise of a point depends on its number alone, so that it can be replayed.
        let mut random = Random::new(u64::from(point) + 1);
        inputs.inner.pose.position.x = start + 0.2e-6 * random.symmetric();
        inputs.inner.pose.position.y = 0.2e-6 * random.symmetric();
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let run = posed("pose with noise of 0.2 um", &importer, limits(4500, 5, 5, 3.0));
    let mean = -run.history[200..].iter().map(|o| o.inner.wrench.force.x).sum::<f64>() / 201.0;
    assert!((mean / 1505.0 - 1.0).abs() < 0.01, "{mean} N");
}

#[test]
fn speed_that_steps() {
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        inputs.inner.twist.angular_velocity *= if point < 100 { 1.0 } else { 0.5 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let run = posed("speed halves within 100 us", &importer, limits(4500, 10, 10, 2.0));
    // The balls run ahead, brake, and roll again.
    assert!(run.history[101].cage_slip < -0.5 && run.last().cage_slip.abs() < 0.01);
}
