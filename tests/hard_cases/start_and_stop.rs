//! Start from rest, standstill, reversal of the speed, very slow and very fast.

use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, GROOVE, load, scene};

/// [rad/s] of 1 rpm.
const RPM: f64 = std::f64::consts::TAU / 60.0;

fn ramp(points: &str, rows: &str, milliseconds: f64) -> String {
    format!("[load]\nduration = \"{milliseconds} ms\"\ninner_speed = {points}\n{rows}\n")
}

#[test]
fn start_from_rest() {
    let changes = ramp("[[0.0, 0.0], [0.02, \"6000 rpm\"]]", "x = { force = 1500.0 }", 30.0);
    let case = Case::new("start from rest in 20 ms", scene(ANGULAR, &changes), limits(4000, 100, 10, 3.0));
    let run = case.pass();
    assert_eq!(run.history[0].cage_speed, 0.0);
    assert!(run.last().cage_slip.abs() < 0.02, "{}", run.last().cage_slip);
    // The balls only ever gain speed, and friction only ever takes energy.
    let rises = run.history[..200].windows(2).all(|pair| pair[1].cage_speed >= pair[0].cage_speed - 1e-3);
    assert!(rises && run.history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated));
}

#[test]
fn start_with_the_race_at_full_speed_and_the_balls_at_rest() {
    let changes = ramp("[[0.0, 0.0], [1e-6, \"6000 rpm\"]]", "x = { force = 1500.0 }\noutput_interval = \"50 us\"", 20.0);
    let case = Case::new("race at 6000 rpm within 50 us, balls at rest", scene(ANGULAR, &changes), limits(4000, 100, 10, 3.0));
    let run = case.pass();
    assert!(run.last().cage_slip.abs() < 0.02, "{}", run.last().cage_slip);
}

#[test]
fn standstill_under_load() {
    for (name, base, rows) in [
        ("standstill, thrust, radial load and moment", ANGULAR, "x = { force = 1500.0 }\ny = { force = 400.0 }\nrz = { moment = 3.0 }"),
        ("standstill, radial load", GROOVE, "y = { force = 1500.0 }\nx = { displacement = 0.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }"),
    ] {
        let scene = scene(base, &load(50.0, 0.0, rows));
        let case = Case::new(name, scene, limits(6000, 10, 10, 3.0));
        let run = case.pass();
        let (first, last) = (&run.history[0], run.last());
        println!("{:e} {:e} {:e}", last.stored_energy - first.stored_energy, last.work, last.dissipated);
        let moved = (last.inner.pose.position - first.inner.pose.position).norm();
        println!("moved {moved:e}");
        for (a, b) in first.balls.iter().zip(&last.balls) {
            println!("{:e} {:e} {:e} | {} {}", (a.position-b.position).norm(), b.angular_velocity.norm(), b.orbital_speed, a.inner.load, b.inner.load);
        }
    }
}

#[test]
fn speed_reversal() {
    let run = |sign: f64| {
        let points = format!("[[0.0, {}], [0.01, {}], [0.03, {}]]", sign * 6000.0 * RPM, sign * 6000.0 * RPM, -sign * 6000.0 * RPM);
        let changes = ramp(&points, "x = { force = 1500.0 }", 40.0);
        Case::new(if sign > 0.0 {"reversal from 6000 to -6000 rpm in 20 ms"} else {"reversal from -6000 to 6000 rpm in 20 ms"}, scene(ANGULAR, &changes), limits(6000, 100, 10, 3.0)).pass()
    };
    let (forward, backward) = (run(1.0), run(-1.0));
    for (a, b) in forward.history.iter().zip(&backward.history) {
        assert!((a.cage_speed + b.cage_speed).abs() < 1e-6 * (1.0 + a.cage_speed.abs()), "{} {}", a.cage_speed, b.cage_speed);
        assert!((a.friction_power - b.friction_power).abs() < 1e-6 * (1e-3 + a.friction_power), "{} {}", a.friction_power, b.friction_power);
    }
    assert!(forward.last().cage_slip.abs() < 0.02);
}

#[test]
fn fast_and_slow() {
    for (name, rpm, duration) in [("30000 rpm", 30000.0, 20.0), ("0.01 rpm", 0.01, 200.0)] {
        let scene = scene(ANGULAR, &load(duration, rpm, "x = { force = 1500.0 }"));
        let case = Case::new(name, scene, limits(40000, 100, 10, 9.0));
        let run = case.pass();
        let last = run.last();
        println!("{} {}", last.cage_slip, last.cage_speed);
        for gyroscopic in [Gyroscopic::None, Gyroscopic::OuterRaceControl, Gyroscopic::Friction] {
            let input = EquilibriumInput::from_scene(run.simulation.scene(), gyroscopic);
            let e = equilibrium::solve(run.simulation.model(), &input).unwrap();
            println!("{} {} {}", e.cage_speed, e.balls[0].report.inner_load, e.balls[0].report.outer_load);
        }
        println!("{} {} {}", last.cage_speed, last.balls[0].inner.load, last.balls[0].outer.load);
    }
}
