//! The outer race as a body on a hinge to a frame, and starts from given velocities.

use nalgebra::{UnitQuaternion, Vector3};
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;

use crate::scenes::{HELD, scene};

const THRUST: &str = include_str!("../../scenes/thrust.toml");

/// The thrust scene with the outer race on a hinge, the inner race held across the axis.
fn hinge(misalignment: &str, outer_speed: &str) -> Scene {
    let hinge = [
        ("outer.drive", "\"hinge\""),
        ("outer.mass", "0.3"),
        ("outer.inertia", "[3e-4, 2e-4, 2e-4]"),
        ("outer.misalignment", misalignment),
        ("load.outer_speed", outer_speed),
    ];
    scene(THRUST, &[&hinge[..], &HELD].concat())
}

fn run(scene: &Scene, points: u32) -> Vec<Outputs> {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut history = vec![simulation.outputs().clone()];
    for point in 1..=points {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(f64::from(point) * 1e-4).unwrap();
        history.push(simulation.outputs().clone());
    }
    history
}

#[test]
fn invariant_a_hinged_race_runs_like_a_fixed_one() {
    let tilt = "{ ry = 2e-4, rz = -1e-4 }";
    let hinged = run(&hinge(tilt, "0.0"), 50);
    let fixed = run(&scene(THRUST, &[&[("outer.misalignment", tilt)][..], &HELD].concat()), 50);
    let (a, b) = (hinged.last().unwrap(), fixed.last().unwrap());
    for (one, other) in a.balls.iter().zip(&b.balls) {
        assert!((one.inner.load / other.inner.load - 1.0).abs() < 1e-5);
        assert!((one.outer.load / other.outer.load - 1.0).abs() < 1e-5);
    }
    for outputs in &hinged {
        let pose = &outputs.outer.pose;
        let axis = UnitQuaternion::new(Vector3::new(0.0, 2e-4, -1e-4)) * Vector3::x();
        assert!(pose.position.norm() < 1e-9 && (pose.orientation * Vector3::x() - axis).norm() < 1e-8);
    }
    // At rest, the hinge carries what the bearing exerts.
    let (reaction, wrench) = (a.outer.reaction, a.outer.wrench);
    assert!((reaction.force + wrench.force).norm() < 1e-2, "{} {}", reaction.force, wrench.force);
    assert!((reaction.moment + wrench.moment).norm() < 1e-3 * wrench.moment.norm().max(1.0));
    assert!(wrench.force.norm() > 1000.0);
}

#[test]
fn invariant_a_hinge_follows_its_script_and_spins() {
    let script = "{ ry = [[0.0, 0.0], [\"2 ms\", 3e-4]], rz = 1e-4 }";
    let history = run(&hinge(script, "\"-1000 rpm\""), 30);
    for outputs in &history {
        let s = (outputs.time / 2e-3).min(1.0);
        let ry = 3e-4 * s * s * (3.0 - 2.0 * s);
        let axis = UnitQuaternion::new(Vector3::new(0.0, ry, 1e-4)) * Vector3::x();
        assert!((outputs.outer.pose.orientation * Vector3::x() - axis).norm() < 1e-8, "{}", outputs.time);
        let spin = (outputs.outer.pose.orientation.inverse() * outputs.outer.twist.angular_velocity).x;
        assert!((spin + 1000.0 * std::f64::consts::PI / 30.0).abs() < 1e-7, "{spin}");
    }
    let last = history.last().unwrap();
    let balance = last.work - last.dissipated - (last.stored_energy - history[0].stored_energy);
    assert!(balance.abs() < 1e-2 * last.work.abs().max(last.dissipated), "{balance} of {}", last.work);
}

#[test]
fn invariant_given_velocities_are_those_of_the_start() {
    let start = [
        ("start.orbital_speed", "100.0"),
        ("start.ball_angular_velocity", "[-300.0, 20.0, 5.0]"),
        ("start.inner_velocity", "[0.01, 0.0, 0.0]"),
    ];
    let history = run(&scene(THRUST, &start), 100);
    assert_eq!(history[0].inner.twist.velocity.x, 0.01);
    for ball in &history[0].balls {
        assert!((ball.orbital_speed - 100.0).abs() < 1e-9);
        let size = Vector3::new(300.0f64, 20.0, 5.0).norm();
        assert!((ball.angular_velocity.norm() - size).abs() < 1e-9 && ball.angular_velocity.x == -300.0);
    }
    // Friction brings the balls up to the rolling speed.
    assert!(history[100].cage_speed > 200.0, "{}", history[100].cage_speed);
}
