//! Heavy and skew loads: misalignment, moment, preload, counter-rotation.

use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};

use crate::gates::{Case, Run, limits};
use crate::scenes::{ANGULAR, FLAT, GROOVE, HELD, WHOLE_INNER, groove, load, scene};

/// Quasi-static solution under the same conditions.
fn reference(run: &Run) -> equilibrium::Equilibrium {
    let input = EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::None);
    equilibrium::solve(run.simulation.model(), &input).unwrap()
}

/// Mean force and moment on the inner race over the second half.
fn mean_wrench(run: &Run) -> [f64; 6] {
    let late = &run.history[run.history.len() / 2..];
    let mean = |get: &dyn Fn(usize) -> f64| (0..late.len()).map(get).sum::<f64>() / late.len() as f64;
    std::array::from_fn(|i| {
        mean(&|k| {
            let wrench = &late[k].inner.wrench;
            if i < 3 { wrench.force[i] } else { wrench.moment[i - 3] }
        })
    })
}

const MISALIGNED: &str = "[outer]\ndrive = \"fixed\"\nmisalignment = { ry = \"0.5 deg\" }\n\
                          shoulder_angle = [1.5, 1.5]\n";

#[test]
fn misaligned_by_half_a_degree() {
    let thrust = format!("x = {{ force = 1500.0 }}\n{HELD}");
    let radial = format!("y = {{ force = 1000.0 }}\n{FLAT}");
    for (name, base, changes) in [
        ("outer race misaligned by 0.5 deg, angular contact", ANGULAR, load(30.0, 6000.0, &thrust)),
        (
            "outer race misaligned by 0.5 deg, deep groove",
            GROOVE,
            load(30.0, 6000.0, &radial) + &groove(30.0, 0.52),
        ),
    ] {
        let run =
            Case::new(name, scene(base, &(changes + WHOLE_INNER + MISALIGNED)), limits(4000, 20, 20, 4.5))
                .pass();
        // The moment that holds the tilt is the quasi-static one but for friction; pure tilt loads twice per turn.
        let expected = reference(&run).load[3];
        let moment = mean_wrench(&run)[4];
        assert!((moment / -expected - 1.0).abs() < 0.05, "{name}: {moment} N m, {expected} N m");
        let speeds = run.last().balls.iter().map(|ball| ball.orbital_speed);
        let (low, high) = speeds.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
        assert!(high > 1.02 * low, "{name}: {low} to {high} rad/s");
    }
}

#[test]
fn misalignment_that_the_race_may_follow() {
    let scene = scene(ANGULAR, &(load(30.0, 6000.0, "x = { force = 1500.0 }\n") + MISALIGNED));
    let name = "outer race misaligned by 0.5 deg, inner free to tilt";
    let run = Case::new(name, scene, limits(3300, 10, 10, 3.0)).pass();
    // The race tilts along, and the loads are those of an aligned bearing under thrust.
    let axis = run.last().inner.pose.orientation * nalgebra::Vector3::x();
    let outer = run.last().outer.pose.orientation * nalgebra::Vector3::x();
    assert!(axis.angle(&outer) < 0.05f64.to_radians(), "{}", axis.angle(&outer));
    let loads: Vec<f64> = run.last().balls.iter().map(|ball| ball.inner.load).collect();
    assert!(loads.iter().all(|load| (load / loads[0] - 1.0).abs() < 0.03), "{loads:?}");
}

#[test]
fn high_moment() {
    let rows = "rz = { moment = 60.0 }\nx = { displacement = 0.0 }\ny = { displacement = 0.0 }\nz = { displacement = 0.0 }\n";
    let scene = scene(GROOVE, &load(30.0, 6000.0, rows));
    let run = Case::new("60 N m on a deep-groove bearing", scene, limits(3600, 10, 10, 3.5)).pass();
    let moment = mean_wrench(&run)[5];
    assert!((moment + 60.0).abs() < 0.6, "{moment} N m");
}

fn interference<'a>(name: &'a str, micrometres: f64, rest: &str) -> Case<'a> {
    let rows = format!("y = {{ force = 500.0 }}\nx = {{ force = 100.0 }}\n{rest}");
    let scene = scene(GROOVE, &(groove(-micrometres, 0.52) + &load(20.0, 6000.0, &rows)));
    Case::new(name, scene, limits(2300, 10, 10, 3.0))
}

#[test]
fn preload_by_interference() {
    let tilt_held = "ry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n";
    let small = interference("interference 20 um", 20.0, "").pass();
    let large = interference("interference 200 um, tilt held", 200.0, tilt_held).pass();
    let (small, large) = ((&small, reference(&small)), (&large, reference(&large)));
    let load = |e: &equilibrium::Equilibrium| e.balls.iter().map(|ball| ball.report.inner_load).sum::<f64>();
    for (run, expected) in [&small, &large] {
        let ours = run.last().balls.iter().map(|ball| ball.inner.load).sum::<f64>();
        assert!((ours / load(expected) - 1.0).abs() < 5e-3, "{ours} N, {} N", load(expected));
    }
    // Radial stiffness grows with the third root of the preload.
    let loads = (load(&large.1) / load(&small.1)).cbrt();
    let stiffness = large.1.stiffness[(1, 1)] / small.1.stiffness[(1, 1)];
    assert!((stiffness / loads - 1.0).abs() < 0.05, "{stiffness} {loads}");
}

#[test]
#[ignore = "long"]
fn preload_that_flutters() {
    // With axial motion and tilt free, 100 um of interference and friction 0.08 the race vibrates by itself, at any
    // step size: the integrator follows, and agrees with itself on what that costs.
    let mut case =
        interference("interference 100 um, all free: flutter", 100.0, "output_interval = \"20 us\"");
    case.scene.load.duration.0 = 0.06;
    case.points = 3000;
    case.window = [0.4, 1.0];
    case.limits = limits(15_000, 10, 10, 6.0);
    let run = case.pass();
    assert!(run.last().friction_power > 100.0);
}

#[test]
fn counter_rotating_races() {
    let rows = "x = { force = 1500.0 }\nouter_speed = \"-6000 rpm\"\n";
    let scene = scene(ANGULAR, &load(20.0, 6000.0, rows));
    let run = Case::new("races at 6000 and -6000 rpm", scene, limits(2300, 10, 10, 2.0)).pass();
    let speed = 200.0 * std::f64::consts::PI;
    let ball = &run.last().balls[0];
    let angle = 0.5 * (ball.inner.contact_angle + ball.outer.contact_angle);
    let expected = run.simulation.model().bearing.epicyclic_speed(angle, speed, -speed);
    assert!((run.last().cage_speed / expected - 1.0).abs() < 0.02, "{} {expected}", run.last().cage_speed);
}
