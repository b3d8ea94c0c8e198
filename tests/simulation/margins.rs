//! Margins that tell before a unit fails: each falls towards 0 before the run that it is about ends in an error, and against closed forms.

use roulement::interface::variables::Variables;
use roulement::simulation::{Simulation, SimulationError};

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");

/// A margin and the time \[s], at every communication point of a run that ends in an error; and that.
fn until_refused(changes: &[(&str, &str)], margin: &str) -> (Vec<(f64, f64)>, SimulationError) {
    let scene = scene(THRUST, changes);
    let mut simulation = Simulation::new(&scene).unwrap();
    let table = Variables::new(&scene);
    let row = table.rows().iter().find(|row| row.name == margin).unwrap();
    let mut seen = vec![];
    loop {
        let value = table.value_of(row, &simulation);
        assert!((0.0..=1.0).contains(&value), "{value}");
        seen.push((simulation.time(), value));
        match simulation.advance_scripted(simulation.time() + 1e-4) {
            Ok(()) => assert!(simulation.time() < scene.load.duration.0, "it was not refused"),
            Err(why) => return (seen, why),
        }
    }
}

#[test]
fn invariant_the_margin_to_the_shoulder_falls_before_a_ball_climbs_out_of_its_groove() {
    let changes = [
        ("load.x.force", "[[0.0, \"500 N\"], [\"40 ms\", \"12 kN\"]]"),
        ("load.duration", "\"40 ms\""),
        ("inner.shoulder_angle", "[\"33 deg\", \"33 deg\"]"),
        ("outer.shoulder_angle", "[\"60 deg\", \"60 deg\"]"),
    ];
    let (seen, why) = until_refused(&changes, "margin.shoulder");
    assert!(matches!(why, SimulationError::BeyondShoulder { .. }), "{why}");
    assert!(seen[0].1 > 0.4 && seen[seen.len() - 1].1 < 1e-3, "{seen:?}");
    // Once the start has rung out no point is above the one before.
    let late = &seen[50..];
    assert!(late.len() > 200 && late.windows(2).all(|pair| pair[1].1 < pair[0].1), "{late:?}");
}

#[test]
fn closed_form_margin_to_the_shoulder() {
    // A contact whose ellipse just reaches the shoulder has 1/2.
    let start = |end: &str| {
        let ends = format!("[\"{end}\", \"{end}\"]");
        let changes =
            [("inner.shoulder_angle", &*ends), ("outer.shoulder_angle", "[\"80 deg\", \"80 deg\"]")];
        Simulation::new(&scene(THRUST, &changes)).unwrap()
    };
    let wide = start("60 deg");
    let contact = &wide.outputs().balls[0].inner;
    let half_angle = (contact.semi_axis_transverse / wide.model().bearing.ball.radius).asin();
    let reached = start(&format!("{} rad", contact.contact_angle + half_angle));
    assert!((reached.outputs().margins.shoulder - 0.5).abs() < 1e-9, "{:?}", reached.outputs().margins);
    let distance = 60.0f64.to_radians() - contact.contact_angle;
    let expected = distance / (distance + half_angle);
    assert!((wide.outputs().margins.shoulder - expected).abs() < 1e-12);
}

#[test]
fn invariant_the_margin_of_friction_falls_before_thrust_through_zero_takes_the_bearing_apart() {
    let changes = [
        ("load.x.force", "[[0.0, \"500 N\"], [\"5 ms\", \"500 N\"], [\"25 ms\", \"-500 N\"]]"),
        ("load.duration", "\"25 ms\""),
    ];
    let (seen, why) = until_refused(&changes, "margin.friction");
    assert!(matches!(why, SimulationError::BeyondShoulder { .. }), "{why}");
    let falling: Vec<_> = seen.iter().filter(|(time, _)| (6e-3..15.2e-3).contains(time)).collect();
    assert!(falling.windows(2).all(|pair| pair[1].1 < pair[0].1), "{falling:?}");
    assert!(falling[0].1 > 0.8 && falling[falling.len() - 1].1 < 0.1, "{falling:?}");
    // Nothing presses for more than a millisecond before the other flank is met.
    let free = seen.iter().filter(|(_, margin)| *margin == 0.0).count();
    assert!(free > 10, "{free}");
}

#[test]
fn closed_form_margin_of_friction_where_all_slides() {
    // Balls that stand in a race at full speed: force and limit are the same but for the law's own approach to it.
    let changes = [("start.orbital_speed", "0.0"), ("start.spin_balance", "false")];
    let simulation = Simulation::new(&scene(THRUST, &changes)).unwrap();
    let outputs = simulation.outputs();
    let used = |get: fn(&roulement::simulation::outputs::BallOutput) -> (f64, f64, f64)| {
        let sums = outputs
            .balls
            .iter()
            .map(get)
            .fold((0.0, 0.0), |(force, load), (x, y, own)| (force + x.hypot(y), load + own));
        1.0 - sums.0 / (0.08 * sums.1)
    };
    let inner = used(|ball| (ball.inner.force_longitudinal, ball.inner.force_lateral, ball.inner.load));
    let outer = used(|ball| (ball.outer.force_longitudinal, ball.outer.force_lateral, ball.outer.load));
    assert!((outputs.margins.friction - inner.min(outer).max(0.0)).abs() < 1e-12);
    assert!(outputs.margins.friction < 1e-3, "{}", outputs.margins.friction);
}

#[test]
fn invariant_the_margin_of_the_step_falls_before_a_run_gives_up() {
    // Blows to and fro, each 6 % stronger than the one before.
    let blows = (1..190).map(|blow: i32| {
        let side = if blow % 2 == 0 { -1.0 } else { 1.0 };
        format!(", [{}, {}]", 5e-5 * f64::from(blow), 1500.0 + side * 10.0 * 1.06f64.powi(blow))
    });
    let blows = format!("[[0.0, 1500.0]{}]", blows.collect::<String>());
    let changes = [
        ("load.x.force", &*blows),
        ("load.duration", "\"9.4 ms\""),
        ("solver.min_step", "\"1 us\""),
        ("inner.shoulder_angle", "[1.5, 1.5]"),
        ("outer.shoulder_angle", "[1.5, 1.5]"),
    ];
    let (seen, why) = until_refused(&changes, "margin.step");
    assert!(matches!(why, SimulationError::StepTooSmall { .. }), "{why}");
    let least = |from: f64, to: f64| {
        let part = seen.iter().filter(|(time, _)| (from..to).contains(time));
        part.fold(1.0f64, |least, (_, margin)| least.min(*margin))
    };
    let end = seen[seen.len() - 1].0;
    let thirds = [least(1e-3, end / 3.0), least(end / 3.0, end * 2.0 / 3.0), least(end * 2.0 / 3.0, 1.0)];
    assert!(thirds[0] > thirds[1] && thirds[1] > thirds[2] && thirds[2] < 0.3, "{thirds:?} {end}");
}

#[test]
fn invariant_margins_are_of_what_a_scene_has() {
    let names = |changes: &[(&str, &str)]| -> Vec<String> {
        let table = Variables::new(&scene(THRUST, changes));
        let rows = table.rows().iter().filter(|row| row.name.starts_with("margin."));
        rows.map(|row| row.name.clone()).collect()
    };
    assert_eq!(names(&[]), ["margin.shoulder", "margin.friction", "margin.step"]);
    assert_eq!(names(&[("effects.creep", "\"frictionless\"")]), ["margin.shoulder", "margin.step"]);
    assert_eq!(names(&[("solver.level", "\"equilibrium\"")]), ["margin.shoulder", "margin.friction"]);
}
