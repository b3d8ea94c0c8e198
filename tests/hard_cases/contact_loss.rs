//! Contacts that open and close: clearance, thrust through zero, shock, an accelerated bearing.

use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;
use roulement::simulation::outputs::Outputs;

use crate::gates::{Case, Run, limits};
use crate::scenes::{ANGULAR, FLAT, GROOVE, HELD, WHOLE_INNER, WHOLE_OUTER, groove, load, scene};

/// The second half of a run, and the mean of a quantity over it.
fn late(run: &Run) -> &[Outputs] {
    &run.history[run.history.len() / 2..]
}

fn late_mean(run: &Run, get: impl Fn(&Outputs) -> f64) -> f64 {
    late(run).iter().map(get).sum::<f64>() / late(run).len() as f64
}

#[test]
fn unloaded_zone() {
    let rows = format!("y = {{ force = 1500.0 }}\n{FLAT}");
    let scene = scene(GROOVE, &(groove(50.0, 0.52) + &load(50.0, 6000.0, &rows)));
    let run = Case::new("radial load, clearance 50 um", scene, limits(5700, 10, 10, 4.0)).pass();
    let ball = run.simulation.model().bearing.ball;
    // Opposite to the load the balls touch the outer race alone, with their centrifugal force.
    let mut unloaded = 0;
    for b in late(&run).iter().flat_map(|o| &o.balls).filter(|b| b.azimuth.abs() > 2.0) {
        assert_eq!(b.inner.load, 0.0);
        unloaded += 1;
        let centrifugal = ball.mass * b.orbital_speed.powi(2) * b.position.yz().norm();
        assert!(b.outer.load < 5.0 * centrifugal, "{} N, {centrifugal} N", b.outer.load);
    }
    assert!(unloaded > 500);
    // The race goes as deep as the equilibrium says, from load over a ball to load between balls.
    let input = EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::None);
    let expected = equilibrium::solve(run.simulation.model(), &input).unwrap().displacement[1];
    let mean = late_mean(&run, |o| o.inner.pose.position.y);
    assert!((mean - expected).abs() < 10e-6, "{mean} m, {expected} m");
}

#[test]
fn thrust_takes_up_a_millimetre() {
    let thrust = format!("x = {{ force = 1500.0 }}\n{HELD}");
    let scene =
        scene(GROOVE, &(groove(1000.0, 0.56) + &load(15.0, 6000.0, &thrust) + WHOLE_INNER + WHOLE_OUTER));
    let run = Case::new("thrust, clearance 1 mm", scene, limits(1700, 10, 10, 4.0)).pass();
    // The balls climb to where the clearance is used up: cos(alpha) = 1 - P_d/(2 (f_i + f_o - 1) D), compression aside.
    let expected = (1.0f64 - 1e-3 / (2.0 * 0.12 * 9.525e-3)).acos();
    for ball in &run.last().balls {
        let angle = 0.5 * (ball.inner.contact_angle + ball.outer.contact_angle);
        assert!((angle - expected).abs() < 0.02, "{angle} rad, {expected} rad");
    }
}

#[test]
fn thrust_reversal_through_zero() {
    let rows = "x = { force = [[0.0, 1500.0], [0.01, 1500.0], [0.02, -1500.0]] }\n";
    let scene = scene(ANGULAR, &(load(40.0, 6000.0, rows) + WHOLE_INNER + WHOLE_OUTER));
    let run = Case::new("thrust from 1500 to -1500 N in 10 ms", scene, limits(6000, 40, 20, 3.0)).pass();
    // The race has moved by its play and the compression of both flanks.
    let mut input = EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::None);
    let mut at = |force: f64| {
        input.conditions[0] = Prescribed::Load(force);
        equilibrium::solve(run.simulation.model(), &input).unwrap().displacement[0]
    };
    let expected = at(1500.0) - at(-1500.0);
    let late = &run.history[350..];
    let mean = late.iter().map(|o| o.inner.pose.position.x).sum::<f64>() / late.len() as f64;
    let moved = run.history[100].inner.pose.position.x - mean;
    assert!((moved / expected - 1.0).abs() < 0.01, "{moved} m, {expected} m");
    // On the other flank now, every one.
    assert!(run.last().balls.iter().all(|ball| ball.inner.contact_angle < 0.0));
}

/// [N] largest load of any contact.
fn peak(history: &[Outputs]) -> f64 {
    let loads = history.iter().flat_map(|o| &o.balls).map(|ball| ball.inner.load.max(ball.outer.load));
    loads.fold(0.0, f64::max)
}

#[test]
fn shock_of_5_kn_across_the_thrust() {
    let rows = "x = { force = 1500.0 }\noutput_interval = \"25 us\"\n\
                y = { force = [[0.0, 0.0], [0.005, 0.0], [0.00505, 5000.0], [0.0051, 0.0]] }\n";
    let scene = scene(ANGULAR, &load(30.0, 6000.0, rows));
    let run = Case::new("5 kN within 0.1 ms across the thrust", scene, limits(5500, 20, 20, 4.0)).pass();
    // Less than a quarter of the shock reaches one ball while the race's mass takes the rest, then all is as before.
    assert!(peak(&run.history) < 2500.0, "{}", peak(&run.history));
    let late = &run.history[run.history.len() - 200..];
    // The balls' spacing has changed for good, and single loads with it.
    let sum = |o: &Outputs| o.balls.iter().map(|ball| ball.inner.load).sum::<f64>();
    let (before, after) = (sum(&run.history[190]), late.iter().map(sum).sum::<f64>() / 200.0);
    assert!((after / before - 1.0).abs() < 0.01, "{after} N, {before} N");
}

#[test]
fn shock_of_5_kn_on_the_radial_load() {
    // With the shaft's mass on the race: 0.25 N s throw 2 kg at 0.125 m/s.
    let inner = "[inner]\ndrive = \"wrench\"\nmass = 2.0\ninertia = [6e-4, 4e-4, 4e-4]\n";
    let rows = format!(
        "y = {{ force = [[0.0, 1500.0], [0.005, 1500.0], [0.00505, 6500.0], [0.0051, 1500.0]] }}\n\
         output_interval = \"25 us\"\n{FLAT}"
    );
    let scene = scene(GROOVE, &(load(40.0, 6000.0, &rows) + inner));
    let mut case = Case::new("5 kN within 0.1 ms on the radial load", scene, limits(12_000, 90, 90, 7.0));
    case.window = [0.0, 1.0];
    let run = case.pass();
    // Static load, shock and rebound together stay below what the 6.5 kN would give if they stood still.
    let mut input = EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::None);
    input.conditions[1] = Prescribed::Load(6500.0);
    let standing = equilibrium::solve(run.simulation.model(), &input).unwrap();
    let bound = standing.balls.iter().map(|ball| ball.report.outer_load).fold(0.0, f64::max);
    assert!(peak(&run.history) < bound, "{} N, {bound} N", peak(&run.history));
    let position = |range: std::ops::Range<usize>| {
        let part = &run.history[range];
        part.iter().map(|o| o.inner.pose.position.y).sum::<f64>() / part.len() as f64
    };
    let (before, after) = (position(100..190), position(1200..1600));
    assert!((after - before).abs() < 2e-6, "{after} m, {before} m");
}

#[test]
fn acceleration_is_gravity() {
    let acceleration = 50.0 * 9.80665;
    let load = load(10.0, 6000.0, "x = { force = 200.0 }\n");
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let time = simulation.time();
        let mut inputs = simulation.scripted_inputs(time);
        inputs.outer.pose.position.y = 0.5 * acceleration * time * time;
        inputs.outer.twist.velocity.y = acceleration * time;
        inputs.outer.twist_rate.velocity.y = acceleration;
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let scene_of = |rest: &str| scene(ANGULAR, &format!("{load}{rest}"));
    let mut case = Case::new(
        "outer race accelerated by 50 g",
        scene_of("[outer]\ndrive = \"pose\""),
        limits(1150, 10, 10, 3.0),
    );
    case.importer = Some(&importer);
    let moving = case.pass();
    // Both start without weight: in the equilibrium under gravity, balls are elsewhere.
    let mut standing = Case::new("gravity of 50 g", scene_of(""), limits(1150, 10, 10, 3.0));
    standing.late_gravity = Some([0.0, -acceleration, 0.0]);
    let standing = standing.pass();
    // Nothing inside the bearing can tell which of both it is.
    let difference = |i: usize| {
        let (a, b) = (&moving.history[i].inner.wrench.force, &standing.history[i].inner.wrench.force);
        (a - b).norm() / b.norm()
    };
    let differences = [1, 10, 25, 50, 75, 100].map(difference);
    // Newton's tolerance is 1e-6 N of 200 N in each of both: 1e-8 of the force.
    assert!(differences.iter().all(|d| *d < 1e-8), "{differences:?}");
}
