//! Rings that grow while the bearing runs: from clearance through none to preload.

use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};

use crate::gates::{Case, limits};
use crate::scenes::{GROOVE, WHOLE_INNER, load, scene};

#[test]
fn through_zero_clearance_to_preload() {
    let name = "inner ring warms by 60 K, clearance 10 um to -17 um";
    let warming = "[growth]\ninner = [[0, 0], [0.005, 0], [0.025, 60]]\n";
    // Thrust gives contact angles, which growth takes away.
    let rows =
        "x = { force = 150.0 }\ny = { force = 300.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n";
    let scene = scene(GROOVE, &(load(30.0, 6000.0, rows) + WHOLE_INNER + warming));
    let run = Case::new(name, scene, limits(3300, 20, 20, 4.5)).pass();
    let growth = |at: usize| run.history[at].growth.unwrap();
    let last = run.history.len() - 1;
    assert!((growth(0).clearance - 10e-6).abs() < 1e-12, "{:?}", growth(0));
    // 36.47 mm grow by 60 K of 12e-6.
    let preload = growth(last).clearance;
    assert!((preload - (10e-6 - 60.0 * 12e-6 * 36.47e-3)).abs() < 1e-10, "{preload}");
    // Thrust held the balls at an angle at first, preload does in the end: each carries about what the equilibrium says.
    let least =
        |at: usize| run.history[at].balls.iter().map(|ball| ball.inner.load).fold(f64::INFINITY, f64::min);
    assert!(least(last) > 3.0 * least(0), "{} {}", least(0), least(last));
    let input = EquilibriumInput {
        rises: [60.0, 0.0, 0.0, 0.0, 0.0],
        ..EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::Friction)
    };
    let expected = equilibrium::solve(run.simulation.model(), &input).unwrap();
    let sum = |at: usize| run.history[at].balls.iter().map(|ball| ball.inner.load).sum::<f64>();
    let theirs = expected.balls.iter().map(|ball| ball.report.inner_load).sum::<f64>();
    let late = (run.history.len() - 20)..run.history.len();
    let mean = late.clone().map(sum).sum::<f64>() / late.len() as f64;
    assert!((mean / theirs - 1.0).abs() < 0.01, "{mean} {theirs}");
    // Nothing jumps where the clearance is gone.
    let largest = (1..=last).map(|at| (sum(at) - sum(at - 1)).abs()).fold(0.0, f64::max);
    assert!(largest < 0.1 * theirs, "{largest} {theirs}");
}
