//! Thrust ball bearings: contact angle 90 degrees, grooves in washers that face each other.

use std::f64::consts::{FRAC_PI_2, PI};

use roulement::contact::hertz::HertzContact;
use roulement::contact::materials::Pair;
use roulement::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic};
use roulement::scene::Scene;
use roulement::{Model, Simulation};

use crate::scenes::{HELD, scene};

/// A bearing like 51206: 12 balls of 8.731 mm on 41 mm.
const WASHERS: &str = r#"
[bearing]
balls = 12
ball_diameter = "8.731 mm"
pitch_diameter = "41 mm"
contact_angle = "90 deg"
inner_conformity = 0.54
outer_conformity = 0.54

[effects]
damping = "0.02 s/m"

[inner]
drive = "wrench"
mass = "0.1 kg"
inertia = ["5e-5 kg m^2", "3e-5 kg m^2", "3e-5 kg m^2"]

[load]
duration = "5 ms"
inner_speed = "1000 rpm"
x = { force = "6 kN" }
"#;

fn solve(changes: &[(&str, &str)], gyroscopic: Gyroscopic) -> Equilibrium {
    let scene = scene(WASHERS, changes);
    let model = Model::new(&scene).unwrap();
    equilibrium::solve(&model, &EquilibriumInput::from_scene(&scene, gyroscopic)).unwrap()
}

/// Approach of a ball and a washer under a load, flat along rolling as a groove at 90 degrees is.
fn approach(load: f64) -> f64 {
    let radius = 0.5 * 8.731e-3;
    let compliance = Pair::new([(206e9, 0.3); 2]).compliance;
    let hertz = HertzContact::new(1.0 / radius, 1.0 / radius - 1.0 / (0.54 * 8.731e-3), compliance);
    (load / hertz.stiffness).powf(2.0 / 3.0)
}

#[test]
fn closed_form_equal_shares_of_an_axial_load() {
    for (text, force) in [("\"6 kN\"", 6000.0), ("\"100 N\"", 100.0)] {
        let still =
            solve(&[("load.x.force", text), ("load.inner_speed", "0.0")], Gyroscopic::OuterRaceControl);
        let share = force / 12.0;
        for ball in &still.balls {
            let b = ball.report;
            assert!(
                (b.inner_load / share - 1.0).abs() < 1e-9 && (b.outer_load / share - 1.0).abs() < 1e-9,
                "{b:?}"
            );
            for angle in [b.inner_contact_angle, b.outer_contact_angle] {
                assert!((angle - FRAC_PI_2).abs() < 1e-9, "{angle}");
            }
        }
        // Hertz's table has ten digits.
        let expected = 2.0 * approach(share);
        assert!(
            (still.displacement[0] / expected - 1.0).abs() < 1e-9,
            "{} {expected}",
            still.displacement[0]
        );
        // K = dF/dx of Z Q, Q = k (x/2)^1.5.
        let stiffness = 1.5 * force / expected;
        assert!((still.stiffness[(0, 0)] / stiffness - 1.0).abs() < 1e-7, "{}", still.stiffness[(0, 0)]);
        // A tilted washer is pushed back by the same springs at its rim.
        let tilting = 0.5 * stiffness * 0.0205f64.powi(2);
        assert!((still.stiffness[(3, 3)] / tilting - 1.0).abs() < 0.1, "{}", still.stiffness[(3, 3)]);
    }
}

#[test]
fn closed_form_centrifugal_force_carried_by_both_washers() {
    let fast = solve(&[("load.inner_speed", "\"3000 rpm\"")], Gyroscopic::None);
    let mass = 7800.0 * PI / 6.0 * 8.731e-3f64.powi(3);
    let orbit = 0.5 * 100.0 * PI;
    assert!((fast.cage_speed / orbit - 1.0).abs() < 1e-3, "{}", fast.cage_speed);
    for ball in &fast.balls {
        let b = ball.report;
        let axial = [b.inner_load * b.inner_contact_angle.sin(), b.outer_load * b.outer_contact_angle.sin()];
        assert!(axial.iter().all(|part| (part / 500.0 - 1.0).abs() < 1e-9), "{axial:?}");
        // The ball has moved out: the washers push it back, one from either side of the right angle.
        assert!(b.outer_contact_angle < FRAC_PI_2 && b.inner_contact_angle > FRAC_PI_2, "{b:?}");
        let inwards = b.outer_load * b.outer_contact_angle.cos() - b.inner_load * b.inner_contact_angle.cos();
        let centrifugal = mass * fast.cage_speed.powi(2) * ball.position.yz().norm();
        assert!((inwards / centrifugal - 1.0).abs() < 1e-6, "{inwards} {centrifugal}");
    }
}

#[test]
fn closed_form_a_run_turns_its_balls_at_half_the_speed() {
    let mut simulation = Simulation::new(&scene(WASHERS, &HELD)).unwrap();
    let speed = 1000.0 * PI / 30.0;
    for point in 1..=10 {
        simulation.advance(5e-4 * f64::from(point)).unwrap();
        let outputs = simulation.outputs();
        // Pure spin at both washers does not hold the balls back.
        assert!((outputs.cage_speed / (0.5 * speed) - 1.0).abs() < 2e-3, "{}", outputs.cage_speed);
        assert!(outputs.ball_slip.abs() < 2e-3 && outputs.cage_slip.abs() < 2e-3, "{}", outputs.ball_slip);
        assert!(
            (outputs.inner.wrench.force.x / -6000.0 - 1.0).abs() < 1e-3,
            "{}",
            outputs.inner.wrench.force.x
        );
        for ball in &outputs.balls {
            assert!((ball.inner.load / 500.0 - 1.0).abs() < 1e-2, "{}", ball.inner.load);
            assert!((ball.inner.contact_angle - FRAC_PI_2).abs() < 0.02, "{}", ball.inner.contact_angle);
            assert!((ball.outer.contact_angle - FRAC_PI_2).abs() < 0.02, "{}", ball.outer.contact_angle);
        }
        assert!(outputs.friction_torque > 0.0);
    }
}

#[test]
fn a_washer_that_balls_have_left_is_refused() {
    // Nothing holds washers together against a pull.
    let pulled = scene(WASHERS, &[("load.x.force", "\"-100 N\"")]);
    let message = Simulation::new(&pulled).unwrap_err().to_string();
    assert!(message.contains("no equilibrium"), "{message}");
    // A radial load much larger than the thrust drives the balls out of their grooves.
    let aside = scene(WASHERS, &[("load.y.force", "\"60 kN\"")]);
    assert!(Simulation::new(&aside).is_err());
    // Angles beyond 90 degrees are those of the bearing turned round.
    let beyond = WASHERS.replace("90 deg", "91 deg");
    let message = Scene::parse(&beyond).unwrap_err().to_string();
    assert!(message.contains("bearing.contact_angle"), "{message}");
}
