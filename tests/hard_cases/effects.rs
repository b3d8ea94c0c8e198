//! Effects where they are hardest: waves at standstill and at 20,000 rpm, damping that nearly swallows a shock, spalls under a shock.

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, FLAT, GROOVE, load, scene};

const WAVES: &str = "[form]\ninner = [{ order = 9, amplitude = \"0.3 um\" }, { order = 11, amplitude = \"0.3 um\" }]\n\
                     outer = [{ order = 2, amplitude = \"5 um\" }, { order = 10, amplitude = \"0.3 um\", direction = \"axial\" }]\n\
                     balls = [\"1 um\", 0, 0, 0, \"-1 um\", 0, 0, 0, 0, 0]\n";

#[test]
fn waves_at_standstill() {
    let scene = scene(ANGULAR, &(load(10.0, 0.0, "x = { force = 1500.0 }\n") + WAVES));
    let run = Case::new("wavy races at standstill", scene, limits(1100, 10, 40, 3.0)).pass();
    let force = run.last().inner.wrench.force;
    assert!((force.x / -1500.0 - 1.0).abs() < 1e-6 && force.yz().norm() < 1e-3, "{force}");
}

#[test]
fn waves_at_20_000_rpm() {
    let scene = scene(ANGULAR, &(load(10.0, 20_000.0, "x = { force = 1500.0 }\n") + WAVES));
    let run = Case::new("wavy races at 20000 rpm", scene, limits(4000, 20, 20, 5.0)).pass();
    let late = &run.history[run.history.len() / 2..];
    let mean = late.iter().map(|outputs| outputs.inner.wrench.force.x).sum::<f64>() / late.len() as f64;
    assert!((mean / -1500.0 - 1.0).abs() < 0.05, "{mean}");
}

#[test]
fn a_shock_that_the_contacts_nearly_swallow() {
    let inner = "[inner]\ndrive = \"wrench\"\nmass = 2.0\ninertia = [6e-4, 4e-4, 4e-4]\n";
    let damping = "[effects]\ncreep = \"saturated\"\ndamping = { retardation_time = \"20 us\" }\n";
    let rows = format!(
        "y = {{ force = [[0.0, 1500.0], [0.005, 1500.0], [0.00505, 6500.0], [0.0051, 1500.0]] }}\n\
         output_interval = \"25 us\"\n{FLAT}"
    );
    let scene = scene(GROOVE, &(load(20.0, 6000.0, &rows) + inner + damping));
    let mut case =
        Case::new("5 kN within 0.1 ms on viscoelastic contacts", scene, limits(12_000, 90, 90, 7.0));
    case.window = [0.0, 1.0];
    case.pass();
}

/// A shock of 4 kN more within 0.1 ms on the inner race of a 6206 at 6000 rpm, while the most loaded ball, the eighth, runs over a spall:
/// the race has come down on it at 5.2 ms.
fn shock(defects: &str) -> roulement::scene::Scene {
    let inner = "[inner]\ndrive = \"wrench\"\nmass = 2.0\ninertia = [6e-4, 4e-4, 4e-4]\n";
    let damping = "[effects]\ncreep = \"saturated\"\ndamping = { retardation_time = \"5 us\" }\n";
    let rows = format!(
        "y = {{ force = [[0.0, 1500.0], [0.005, 1500.0], [0.00505, 5500.0], [0.0051, 1500.0]] }}\n\
         output_interval = \"25 us\"\n{FLAT}"
    );
    scene(GROOVE, &(load(15.0, 6000.0, &rows) + inner + damping + defects))
}

/// Size of the spalls.
const SPALLS: &str = "length = \"1 mm\"\nwidth = \"3 mm\"\ndepth = \"0.1 mm\"\n";

#[test]
fn a_spall_under_shock() {
    let on =
        |race: &str, azimuth: &str| format!("[[defect]]\non = \"{race}\"\nazimuth = \"{azimuth}\"\n{SPALLS}");
    let scene = shock(&(on("outer", "-5.5 deg") + &on("inner", "180 deg")));
    let mut case =
        Case::new("5.5 kN within 0.1 ms on spalls of both races", scene, limits(12_000, 200, 200, 7.0));
    case.window = [0.0, 1.0];
    let run = case.pass();
    // A ball over the spall of the outer race is without load while its neighbours carry the race.
    let drops = |outputs: &roulement::simulation::outputs::Outputs| {
        let near = |ball: &&roulement::simulation::outputs::BallOutput| (ball.azimuth + 0.096).abs() < 0.01;
        outputs.balls.iter().filter(near).map(|ball| ball.outer.load).fold(f64::INFINITY, f64::min)
    };
    let least = run.history.iter().map(drops).fold(f64::INFINITY, f64::min);
    let most = run.history.iter().flat_map(|o| &o.balls).map(|ball| ball.outer.load).fold(0.0, f64::max);
    assert!(least < 50.0 && most > 1000.0, "{least} {most}");
}

#[test]
fn a_spall_of_a_ball_under_shock() {
    let scene = shock(&format!("[[defect]]\non = \"ball\"\nball = 8\nazimuth = \"75 deg\"\n{SPALLS}"));
    let mut case =
        Case::new("5.5 kN within 0.1 ms on a spall of a ball", scene, limits(12_000, 200, 200, 7.0));
    case.window = [0.0, 1.0];
    case.pass();
}
