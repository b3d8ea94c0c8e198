//! Start from rest, standstill, reversal of the speed, very slow and very fast.

use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};

use crate::gates::{Case, Run, limits};
use crate::scenes::{ANGULAR, FLAT, GROOVE, load, ramp, scene};

const THRUST: &str = "x = { force = 1500.0 }\n";

#[test]
fn from_rest() {
    let changes = ramp(30.0, "[[0.0, 0.0], [0.02, \"6000 rpm\"]]", THRUST);
    let case = Case::new("start from rest in 20 ms", scene(ANGULAR, &changes), limits(3300, 5, 0, 1.5));
    let run = case.pass();
    assert_eq!(run.history[0].cage_speed, 0.0);
    assert!(run.last().cage_slip.abs() < 0.02, "{}", run.last().cage_slip);
    // The balls only ever gain speed, and friction only ever takes energy.
    let rises = run.history[..200].windows(2).all(|pair| pair[1].cage_speed >= pair[0].cage_speed - 1e-3);
    assert!(rises && run.history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated));
}

#[test]
fn race_at_full_speed_and_balls_at_rest() {
    let rows = format!("{THRUST}output_interval = \"50 us\"");
    let changes = ramp(20.0, "[[0.0, 0.0], [1e-6, \"6000 rpm\"]]", &rows);
    let name = "race from rest to 6000 rpm in 50 us";
    let run = Case::new(name, scene(ANGULAR, &changes), limits(2300, 15, 40, 3.0)).pass();
    // Complete sliding at first; then the balls roll.
    assert!(run.history[2].cage_slip > 0.5 && run.last().cage_slip.abs() < 0.02);
}

#[test]
fn standstill() {
    let combined = "x = { force = 1500.0 }\ny = { force = 400.0 }\nrz = { moment = 3.0 }\n".to_string();
    for (name, base, rows) in [
        ("standstill under thrust, radial load and moment", ANGULAR, combined),
        ("standstill under radial load", GROOVE, format!("y = {{ force = 1500.0 }}\n{FLAT}")),
    ] {
        let run = Case::new(name, scene(base, &load(25.0, 0.0, &rows)), limits(2800, 5, 60, 2.0)).pass();
        let (first, last) = (&run.history[0], run.last());
        let largest = first.balls.iter().map(|ball| ball.inner.load).fold(0.0, f64::max);
        for (a, b) in first.balls.iter().zip(&last.balls) {
            // What remains is creep at the regularisation speed: micrometres per second.
            assert!((a.position - b.position).norm() < 2.5e-9 && b.angular_velocity.norm() < 2e-4, "{b:?}");
            assert!((a.inner.load - b.inner.load).abs() < 5e-4 * largest);
        }
    }
}

#[test]
fn speed_reversal() {
    let reverse = |name: &str, rpm: f64| -> Run {
        let points = format!("[[0.0, \"{rpm} rpm\"], [0.005, \"{rpm} rpm\"], [0.015, \"{} rpm\"]]", -rpm);
        Case::new(name, scene(ANGULAR, &ramp(20.0, &points, THRUST)), limits(2200, 5, 5, 2.0)).pass()
    };
    let forward = reverse("speed from 6000 to -6000 rpm in 10 ms", 6000.0);
    let backward = reverse("speed from -6000 to 6000 rpm in 10 ms", -6000.0);
    // One is the mirror image of the other.
    for (a, b) in forward.history.iter().zip(&backward.history) {
        assert!((a.cage_speed + b.cage_speed).abs() < 1e-6 * (1.0 + a.cage_speed.abs()));
        assert!((a.friction_power - b.friction_power).abs() < 1e-6 * (1e-3 + a.friction_power));
    }
    assert!(forward.last().cage_slip.abs() < 0.02 && forward.last().cage_speed < 0.0);
}

#[test]
fn very_fast() {
    let scene = scene(ANGULAR, &load(20.0, 30_000.0, THRUST));
    let run = Case::new("30,000 rpm", scene, limits(2700, 5, 5, 4.5)).pass();
    // Centrifugal force and gyroscopic moment put the loads between those of both quasi-static hypotheses, within what
    // friction carries of the thrust.
    let solve = |gyroscopic| {
        let input = EquilibriumInput::from_scene(run.simulation.scene(), gyroscopic);
        equilibrium::solve(run.simulation.model(), &input).unwrap().balls[0].report.outer_load
    };
    let (none, control) = (solve(Gyroscopic::None), solve(Gyroscopic::OuterRaceControl));
    let outer = run.last().balls[0].outer.load;
    let band = (none - control).abs();
    assert!((outer - none).abs() < band + 0.03 * none, "{outer} {none} {control}");
}

#[test]
fn very_slow() {
    let scene = scene(ANGULAR, &load(25.0, 0.01, THRUST));
    let run = Case::new("0.01 rpm", scene, limits(2800, 5, 30, 1.5)).pass();
    // Far below the regularisation speed, and still rolling without slip.
    assert!(run.last().cage_slip.abs() < 1e-4, "{}", run.last().cage_slip);
    let (start, end) = (&run.history[0].balls[0], &run.last().balls[0]);
    assert!((start.inner.load / end.inner.load - 1.0).abs() < 1e-4);
}
