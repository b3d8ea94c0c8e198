//! Shoulders of the races: loads beyond them, and contacts that are refused.

use std::f64::consts::FRAC_PI_2;

use roulement::Model;
use roulement::contact::shoulder::{Shoulders, largest_share};
use roulement::equilibrium::{self, EquilibriumError, EquilibriumInput, Gyroscopic};
use roulement::interface::variables::Variables;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::{Simulation, SimulationError};

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");
/// Independent data (tests/data/bearing/README.md).
const DATA: &str = include_str!("../data/bearing/shoulders.csv");

/// Name and numbers of each row: load, contact angle, semi-axis, half angle, height over D, shoulder angle, margin, t, share.
fn rows() -> Vec<(String, bool, [f64; 9])> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let columns = [1, 3, 4, 5, 6, 7, 8, 9, 10];
        (cells[0].to_string(), cells[2] == "inner", columns.map(|i| cells[i].parse().unwrap()))
    };
    DATA.lines().skip(1).map(row).collect()
}

/// One of the bearings of the data under a thrust [N], with shoulders of a height over the ball diameter on all sides.
fn bearing(name: &str, thrust: f64, height: f64) -> Scene {
    let (balls, diameter, pitch, angle, conformities) = match name {
        "7206" => (13, 9.525e-3, 46e-3, "25 deg", [0.52, 0.53]),
        _ => (16, 22.23e-3, 125.26e-3, "40 deg", [0.5232, 0.5232]),
    };
    let shoulders = format!("shoulder_height = [{0}, {0}]", height * diameter);
    Scene::parse(&format!(
        "[bearing]\nballs = {balls}\nball_diameter = {diameter}\npitch_diameter = {pitch}\ncontact_angle = \"{angle}\"\n\
         inner_conformity = {}\nouter_conformity = {}\n[inner]\n{shoulders}\n[outer]\n{shoulders}\n\
         [load]\nduration = 1e-3\noutput_interval = 1e-4\ninner_speed = 0.0\nx = {{ force = {thrust} }}\n\
         y = {{ displacement = 0.0 }}\nz = {{ displacement = 0.0 }}\nry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n",
        conformities[0], conformities[1]
    ))
    .unwrap()
}

fn solve(scene: &Scene) -> Result<equilibrium::Equilibrium, EquilibriumError> {
    let input = EquilibriumInput::from_scene(scene, Gyroscopic::None);
    equilibrium::solve(&Model::new(scene).unwrap(), &input)
}

#[test]
fn independent_data_share_of_a_load_beyond_a_shoulder() {
    for (name, inner, [_, angle, semi_axis, half_angle, height, shoulder, _, _, share]) in rows() {
        let (diameter, conformity) = match (name.as_str(), inner) {
            ("7206", true) => (9.525e-3, 0.52),
            ("7206", false) => (9.525e-3, 0.53),
            _ => (22.23e-3, 0.5232),
        };
        let end = Shoulders::end(height * diameter, conformity * diameter);
        assert!((end - shoulder).abs() < 1e-10, "{end} {shoulder}");
        assert!(((2.0 * semi_axis / diameter).asin() - half_angle).abs() < 1e-10);
        for (ends, towards_x) in [([0.3, end], angle), ([end, 0.3], -angle)] {
            let ours = Shoulders { ends }.share_beyond(towards_x, half_angle);
            assert!((ours - share).abs() < 1e-10, "{ours} {share}");
        }
    }
}

#[test]
fn independent_data_equilibria_report_the_share() {
    let mut cut = 0;
    for (name, inner, [thrust, angle, _, _, height, _, _, _, share]) in rows() {
        let solution = solve(&bearing(&name, thrust, height)).unwrap();
        for ball in &solution.balls {
            let b = &ball.report;
            let ours = if inner { b.inner_shoulder_share } else { b.outer_shoulder_share };
            // The data's displacements and those of the solver agree to nanometres.
            assert!((b.inner_contact_angle - angle).abs() < 1e-6, "{} {angle}", b.inner_contact_angle);
            assert!((ours - share).abs() < 1e-5, "{name} {thrust}: {ours} {share}");
        }
        if share > 0.0 {
            cut += 1;
            assert!(solution.to_string().contains("over shoulders"), "{solution}");
        }
    }
    assert!(cut > 10, "{cut}");
}

#[test]
fn closed_form_share_is_half_where_the_contact_is_at_the_edge() {
    let shoulders = Shoulders { ends: [0.9, 0.8] };
    assert!((shoulders.share_beyond(0.8, 0.1) - 0.5).abs() < 1e-15);
    assert!((shoulders.share_beyond(-0.9, 0.1) - 0.5).abs() < 1e-15);
    assert_eq!(shoulders.share_beyond(0.3, 0.1), 0.0);
    assert_eq!(shoulders.share_beyond(0.3, 0.0), 0.0);
    assert!((shoulders.share_beyond(1.5, 0.1) - 1.0).abs() < 1e-15);
    // Contacts without load do not count.
    let contacts = [(100.0, 0.1), (200.0, 0.3), (1.0, 0.9)];
    assert_eq!(largest_share(contacts.into_iter()), 0.3);
    // An ellipse wider than the groove has its load beyond both sides.
    assert!(Shoulders { ends: [0.1; 2] }.share_beyond(0.0, 0.3) > 0.5);
    assert!(shoulders.beyond(0.79).is_none() && shoulders.beyond(-0.89).is_none());
    let beyond = shoulders.beyond(-0.95).unwrap();
    assert_eq!((beyond.side, beyond.angle, beyond.end), (0, 0.95, 0.9));
    // As high as the groove's radius: up to a right angle.
    assert_eq!(Shoulders::end(5e-3, 5e-3), FRAC_PI_2);
}

#[test]
fn closed_form_default_shoulders() {
    let ends = |scene: &Scene| {
        let shoulders = Model::new(scene).unwrap().bearing.shoulders;
        Race::BOTH.map(|race| shoulders[race].ends)
    };
    // 0.3 D high in grooves of 0.52 D, and the contact angle on the other side of an angular-contact bearing.
    let end = |height: f64| (1.0 - height / 0.52f64).acos();
    let near = |ours: [[f64; 2]; 2], expected: [[f64; 2]; 2]| {
        let pairs = ours.iter().flatten().zip(expected.iter().flatten());
        assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-9), "{ours:?} {expected:?}");
    };
    let (high, low) = (end(0.3), 25f64.to_radians());
    near(ends(&Scene::parse(RADIAL).unwrap()), [[high; 2]; 2]);
    near(ends(&Scene::parse(THRUST).unwrap()), [[high, low], [low, high]]);
    near(ends(&scene(THRUST, &[("bearing.contact_angle", "0.0")])), [[high; 2]; 2]);
    // A steep contact angle has a groove that reaches it.
    let steep = 70f64.to_radians();
    let low = 60f64.to_radians();
    near(ends(&scene(THRUST, &[("bearing.contact_angle", "\"60 deg\"")])), [[steep, low], [low, steep]]);
    let given = [("inner.shoulder_angle", "[0.7, 0.6]"), ("outer.shoulder_height", "[\"1 mm\", \"2 mm\"]")];
    let outer = [1e-3, 2e-3].map(|height| end(height / 9.525e-3));
    near(ends(&scene(THRUST, &given)), [[0.7, 0.6], outer]);
}

#[test]
fn regression_thrust_the_wrong_way_is_refused() {
    // It was carried 625 um away at -42 deg by a groove that is not there.
    let wrong = scene(THRUST, &[("load.x.force", "-1500.0")]);
    for why in [solve(&wrong).unwrap_err().to_string(), Simulation::new(&wrong).unwrap_err().to_string()] {
        for part in ["race", "shoulder", "angular-contact", "falls apart"] {
            assert!(why.contains(part), "{why}");
        }
    }
    // With shoulders on both sides it is carried, and so it is by a deep-groove bearing.
    let full = [("inner.shoulder_angle", "[1.5, 1.5]"), ("outer.shoulder_angle", "[1.5, 1.5]")];
    solve(&scene(THRUST, &[&full[..], &[("load.x.force", "-1500.0")]].concat())).unwrap();
    for force in ["{ force = 300.0 }", "{ force = -300.0 }"] {
        solve(&scene(RADIAL, &[("load.x", force)])).unwrap();
    }
    // Beyond a high shoulder the load is too large.
    let low = scene(THRUST, &[("inner.shoulder_angle", "[0.3, 0.3]")]);
    let why = solve(&low).unwrap_err();
    let EquilibriumError::BeyondShoulder(contact) = &why else { panic!("{why}") };
    assert_eq!((contact.race, contact.side), ("inner", "-x"));
    assert!(why.to_string().contains("too large for this shoulder"), "{why}");
}

#[test]
fn regression_a_load_that_turns_round_stops_the_run() {
    let table = "[[0.0, 1500.0], [0.002, 1500.0], [0.006, -1500.0]]";
    let scene = scene(THRUST, &[("load.x.force", table)]);
    let mut simulation = Simulation::new(&scene).unwrap();
    let why = loop {
        assert!(simulation.time() < 20e-3);
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        if let Err(why) = simulation.advance(simulation.time() + 1e-4) {
            break why;
        }
    };
    assert!(simulation.time() > 4e-3, "{}", simulation.time());
    assert!(matches!(why, SimulationError::BeyondShoulder { .. }), "{why}");
    for part in ["at 0.00", "falls apart", "leave each other", "[inner] and [outer]"] {
        assert!(why.to_string().contains(part), "{why}");
    }
}

/// The keys that the refusal names are the way on: the race flies through its play and is carried by the other flank.
#[test]
fn closed_form_thrust_through_zero_goes_on_with_the_keys_that_its_refusal_names() {
    let table = "[[0.0, 1500.0], [0.002, 1500.0], [0.006, -1500.0]]";
    for end in [("shoulder_height", "[\"3 mm\", \"3 mm\"]"), ("shoulder_angle", "[\"50 deg\", \"50 deg\"]")] {
        let keys = ["inner", "outer"].map(|race| format!("{race}.{}", end.0));
        let changes = [(keys[0].as_str(), end.1), (keys[1].as_str(), end.1), ("load.x.force", table)];
        let mut simulation = Simulation::new(&scene(THRUST, &changes)).unwrap();
        let before = simulation.outputs().inner.pose.position.x;
        let mut free = 0;
        for point in 1..=300 {
            simulation.advance_scripted(1e-4 * f64::from(point)).unwrap();
            free += u32::from(simulation.outputs().balls.iter().all(|ball| ball.inner.load == 0.0));
        }
        // For a while nothing holds it.
        assert!(free >= 2, "{free}");
        // It has moved by its play and the compression of both flanks.
        let at = |force: &str| {
            let held = [(keys[0].as_str(), end.1), (keys[1].as_str(), end.1), ("load.x.force", force)];
            solve(&scene(THRUST, &held)).unwrap().displacement[0]
        };
        let (moved, expected) =
            (before - simulation.outputs().inner.pose.position.x, at("1500.0") - at("-1500.0"));
        assert!((moved / expected - 1.0).abs() < 0.02, "{moved} {expected}");
        let force = simulation.outputs().inner.wrench.force.x;
        assert!((force / 1500.0 - 1.0).abs() < 0.05, "{force}");
    }
}

#[test]
fn closed_form_outputs_report_the_share_of_every_ball() {
    let changes = [
        ("effects.shoulder_outputs", "true"),
        ("effects.per_ball_outputs", "true"),
        ("inner.shoulder_angle", "[0.6, 0.3]"),
        ("load.x.force", "4000.0"),
    ];
    let scene = scene(THRUST, &changes);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance(1e-4).unwrap();
    let variables = Variables::new(&scene);
    let values = variables.values(simulation.inputs(), simulation.outputs());
    let value = |name: &str| values[variables.rows().iter().position(|row| row.name == name).unwrap()];
    let mut largest = 0.0f64;
    for (index, ball) in simulation.outputs().balls.iter().enumerate() {
        let half_angle = (ball.inner.semi_axis_transverse / 4.7625e-3).asin();
        let t = ((0.6 - ball.inner.contact_angle) / half_angle).clamp(-1.0, 1.0);
        let share = 0.25 * (1.0 - t).powi(2) * (2.0 + t);
        assert!((value(&format!("ball[{}].inner.shoulder_share", index + 1)) - share).abs() < 1e-12);
        largest = largest.max(share);
    }
    assert!(largest > 0.01 && largest < 0.5, "{largest}");
    assert!((value("shoulder.inner.share") - largest).abs() < 1e-12);
    assert_eq!(value("shoulder.outer.share"), 0.0);
}

#[test]
fn wrong_shoulders_are_refused_by_key_value_and_range() {
    let refusal =
        |changes: &[(&str, &str)]| Scene::edited(THRUST, changes.iter().copied()).unwrap_err().to_string();
    type Changes = [(&'static str, &'static str)];
    let cases: [(&Changes, &[&str]); 4] = [
        (
            &[("inner.shoulder_height", "[\"6 mm\", 0]")],
            &["inner.shoulder_height.minus_x = 0.006 m", "[0, 0.004953"],
        ),
        (&[("outer.shoulder_height", "[0, -1e-3]")], &["outer.shoulder_height.plus_x = -0.001 m", "[0, "]),
        (
            &[("outer.shoulder_angle", "[0, \"91 deg\"]")],
            &["outer.shoulder_angle.plus_x = 1.588", "[0, 1.57"],
        ),
        (
            &[("inner.shoulder_height", "[0, 0]"), ("inner.shoulder_angle", "[0, 0]")],
            &["inner.shoulder_height", "at most one"],
        ),
    ];
    for (changes, parts) in cases {
        let message = refusal(changes);
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
    scene(THRUST, &[("outer.shoulder_angle", "[0, \"90 deg\"]")]);
}
