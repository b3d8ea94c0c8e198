//! Communication steps of any size, and inputs that jump, shake and step.

use roulement::inputs::Inputs;
use roulement::simulation::Simulation;

use crate::gates::{Case, Run, limits};
use crate::random::Random;
use crate::scenes::{ANGULAR, HELD, POSE, load, scene};

const THRUST_AND_RADIAL: &str = "x = { force = 1500.0 }\ny = { force = 300.0 }\n";

fn run_with_step(step: &str, milliseconds: f64) -> Run {
    let rows = format!("{THRUST_AND_RADIAL}output_interval = \"{step}\"");
    let name = format!("communication steps of {step}");
    let scene = scene(ANGULAR, &load(milliseconds, 6000.0, &rows));
    Case::new(&name, scene, limits(100_000, 10, 10, 3.0)).pass()
}

#[test]
fn regular_steps() {
    let reference = run_with_step("100 us", 20.0);
    for step in ["10 us", "1 ms", "10 ms"] {
        let run = run_with_step(step, 20.0);
        let (a, b) = (run.last(), reference.last());
        println!("{step}: {:e} {:e} {:e}", a.balls[0].inner.load/ b.balls[0].inner.load-1.0, a.dissipated/b.dissipated-1.0, a.inner.pose.position.x / b.inner.pose.position.x - 1.0);
    }
    let run = run_with_step("1 us", 2.0);
    let (a, b) = (run.last(), &reference.history[20]);
    println!("1us: {} {} {:e} {:e} {:e}", a.time, b.time, a.balls[0].inner.load/ b.balls[0].inner.load-1.0, a.dissipated/b.dissipated-1.0, a.inner.pose.position.x / b.inner.pose.position.x - 1.0);
}

#[test]
fn irregular_steps() {
    // From a microsecond to three milliseconds, any size in between as likely on a logarithmic scale.
    let mut random = Random::new(3);
    let mut times = vec![];
    let mut time = 0.0;
    while time < 0.04 {
        time += random.logarithmic(1e-6, 3e-3);
        times.push(time);
    }
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        (simulation.scripted_inputs(simulation.time()), times[point as usize])
    };
    let mut case = Case::new("irregular communication steps, 1 us to 3 ms", scene(ANGULAR, &load(40.0, 6000.0, THRUST_AND_RADIAL)), limits(100_000, 10, 10, 3.0));
    case.importer = Some(&importer);
    case.points = times.len() as u32;
    let run = case.pass();
    println!("{} points, {}", times.len(), run.last().balls[0].inner.load);
}

const THREE: &str = "[bearing]\nballs = 3\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
                     contact_angle = \"25 deg\"\ninner_conformity = 0.52\nouter_conformity = 0.52\n";

#[test]
fn hundred_thousand_tiny_steps() {
    let run = |interval: &str, every: u32| {
        let rows = format!("x = {{ force = 500.0 }}\n{HELD}output_interval = \"{interval}\"\n");
        let name = format!("{} communication steps of {interval}", if every > 1 { "1e5" } else { "100" });
        let mut case = Case::new(&name, scene(ANGULAR, &(load(10.0, 6000.0, &rows) + THREE + POSE)), limits(200_000, 10, 10, 3.0));
        case.every = every;
        case.pass()
    };
    let (tiny, usual) = (run("100 ns", 1000), run("100 us", 1));
    let (a, b) = (tiny.last(), usual.last());
    println!("{:e} {:e}", a.balls[0].inner.load/ b.balls[0].inner.load-1.0, a.dissipated/b.dissipated-1.0);
}

fn posed(name: &str, importer: &dyn Fn(&Simulation, u32) -> (Inputs, f64)) -> Run {
    let rows = format!("x = {{ force = 1500.0 }}\n{HELD}");
    let mut case = Case::new(name, scene(ANGULAR, &(load(40.0, 6000.0, &rows) + POSE)), limits(100_000, 100, 100, 4.0));
    case.importer = Some(importer);
    case.pass()
}

#[test]
fn pose_that_jumps() {
    // 5 um to and fro every millisecond, without a velocity that would announce it.
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        let start = simulation_start();
        inputs.inner.pose.position.x = start + if point / 10 % 2 == 1 { 5e-6 } else { 0.0 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let run = posed("pose jumps by 5 um every 1 ms", &importer);
    for i in [0, 9, 10, 11, 12, 15, 20, 21, 22, 30, 395, 400] { println!("{i} {} {}", run.history[i].inner.wrench.force.x, run.history[i].balls[0].inner.load); }
}

/// [m] where 1500 N put the inner race.
fn simulation_start() -> f64 {
    let rows = format!("x = {{ force = 1500.0 }}\n{HELD}");
    let simulation = Simulation::new(&scene(ANGULAR, &(load(1.0, 6000.0, &rows) + POSE))).unwrap();
    simulation.inputs().inner.pose.position.x
}

#[test]
fn pose_with_noise() {
    let start = simulation_start();
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        // Replayable: the noise of a point depends on its number alone.
        let mut random = Random::new(u64::from(point) + 1);
        inputs.inner.pose.position.x = start + 0.2e-6 * random.symmetric();
        inputs.inner.pose.position.y = 0.2e-6 * random.symmetric();
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let run = posed("pose with noise of 0.2 um", &importer);
    let mean = run.history[200..].iter().map(|o| o.inner.wrench.force.x).sum::<f64>() / 201.0;
    println!("mean {mean}");
}

#[test]
fn step_in_speed() {
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        let factor = if point < 100 { 1.0 } else { 0.5 };
        inputs.inner.twist.angular_velocity *= factor;
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let run = posed("speed halves within 100 us", &importer);
    for i in [99, 100, 101, 102, 110, 150, 200, 300, 400] { println!("{i} {} {}", run.history[i].cage_slip, run.history[i].friction_power); }
}
