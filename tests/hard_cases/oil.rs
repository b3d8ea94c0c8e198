//! Oil between balls and races, and around a cage: from rest, through zero, without load, cold, very fast, skidding, lost.

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, CAGE, FLAT, GROOVE, load, ramp, scene};

const THRUST: &str = "x = { force = 1500.0 }\n";
/// ISO VG 68 at 70 degC.
const OIL: &str = "[film]\niso_vg = 68\ntemperature = 70.0\n";
/// Rolling resistance and drag of oil are all that brakes a ball without load.
const COLD: &str = "[film]\nviscosity = \"1 Pa s\"\n";

#[test]
fn from_rest_in_oil() {
    // From no film to a full one.
    let changes = ramp(30.0, "[[0.0, 0.0], [0.02, \"6000 rpm\"]]", THRUST) + OIL;
    let run = Case::new("start from rest in oil", scene(ANGULAR, &changes), limits(4000, 10, 10, 3.0)).pass();
    let ratio = |o: &roulement::simulation::outputs::Outputs| o.balls[0].inner.film.ratio;
    assert!(ratio(&run.history[0]) < 0.05 && ratio(run.last()) > 1.0, "{}", ratio(run.last()));
    assert!(run.last().cage_slip.abs() < 0.03, "{}", run.last().cage_slip);
}

#[test]
fn reversal_in_oil() {
    let points = "[[0.0, \"6000 rpm\"], [0.005, \"6000 rpm\"], [0.015, \"-6000 rpm\"]]";
    let changes = ramp(20.0, points, THRUST) + OIL;
    let name = "speed from 6000 to -6000 rpm in oil";
    let run = Case::new(name, scene(ANGULAR, &changes), limits(3000, 10, 10, 3.0)).pass();
    assert!(run.last().cage_speed < 0.0 && run.last().cage_slip.abs() < 0.03, "{}", run.last().cage_slip);
}

#[test]
fn unloaded_balls_in_oil() {
    let rows = format!("y = {{ force = 1500.0 }}\n{FLAT}");
    let scene = scene(GROOVE, &(load(20.0, 6000.0, &rows) + OIL));
    let run = Case::new("unloaded balls in oil", scene, limits(5000, 30, 60, 6.0)).pass();
    // Some balls carry nothing on the inner race; films there are none, and those of light balls are finite.
    let idle = run.last().balls.iter().filter(|ball| ball.inner.load == 0.0).count();
    assert!(idle > 2, "{idle}");
    assert!(run.last().balls.iter().all(|ball| ball.outer.film.thickness < 1e-4));
}

#[test]
fn cold_start() {
    let changes = ramp(30.0, "[[0.0, 0.0], [0.02, \"3000 rpm\"]]", THRUST) + COLD;
    let run =
        Case::new("cold start in oil of 1 Pa s", scene(ANGULAR, &changes), limits(4000, 10, 10, 3.0)).pass();
    // Rolling resistance is most of the torque.
    let rolling =
        run.last().contact_power(|ball| ball.inner.film.rolling_power + ball.outer.film.rolling_power);
    assert!(rolling > 0.4 * run.last().friction_power, "{rolling} {}", run.last().friction_power);
}

#[test]
fn very_fast_in_oil() {
    let scene = scene(ANGULAR, &(load(20.0, 30_000.0, THRUST) + OIL));
    Case::new("30,000 rpm in oil", scene, limits(4000, 10, 10, 5.0)).pass();
}

#[test]
fn skidding_and_recovery() {
    // Too little load for the speed: balls fall behind; then enough, and they catch up.
    let rows = "x = { force = [[0.0, 60.0], [0.03, 60.0], [0.031, 2000.0]] }\n";
    let changes = load(60.0, 15_000.0, rows) + OIL;
    let mut case = Case::new("skidding and recovery", scene(ANGULAR, &changes), limits(12000, 60, 60, 6.0));
    case.window = [0.2, 0.5];
    let run = case.pass();
    let slip = |share: f64| run.history[(share * (run.history.len() - 1) as f64) as usize].ball_slip;
    assert!(slip(0.49) > 0.03, "{}", slip(0.49));
    assert!(slip(1.0).abs() < 0.01, "{}", slip(1.0));
}

#[test]
fn oil_lost_within_a_step() {
    let lost =
        "[film]\niso_vg = 68\ntemperature = 70.0\nlubrication = [[0.0, 1.0], [0.01, 1.0], [0.010001, 0.0]]\n";
    let scene = scene(ANGULAR, &(load(20.0, 6000.0, THRUST) + lost));
    let run = Case::new("oil lost within a microsecond", scene, limits(3000, 10, 10, 3.0)).pass();
    assert_eq!(run.last().balls[0].inner.film.ratio, 0.0);
}

#[test]
fn cage_in_oil() {
    let oil = "[film]\niso_vg = 68\ntemperature = 70.0\ncage = true\n";
    let rows = "x = { force = 1500.0 }\nz = { force = -300.0 }\n";
    let scene = scene(CAGE, &(load(20.0, 6000.0, rows) + oil));
    let run = Case::new("cage in oil", scene, limits(6000, 60, 60, 6.0)).pass();
    assert!(run.last().cage_slip.abs() < 0.03, "{}", run.last().cage_slip);
}
