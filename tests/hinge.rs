//! The outer race as a body on a hinge to a frame, and starts from given velocities.
#![allow(clippy::unwrap_used)]

use nalgebra::{UnitQuaternion, Vector3};
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;

const THRUST: &str = include_str!("../scenes/thrust.toml");

/// The thrust scene with another section of the outer race, the inner race held across the axis.
fn scene(outer: &str) -> String {
    THRUST.replace("drive = \"fixed\"", outer)
        + "y = { displacement = 0.0 }\nz = { displacement = 0.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n"
}

fn hinge(misalignment: &str) -> String {
    scene(&format!(
        "drive = \"hinge\"\nmass = 0.3\ninertia = [3e-4, 2e-4, 2e-4]\nmisalignment = {misalignment}"
    ))
}

fn run(text: &str, points: u32) -> Vec<Outputs> {
    let mut simulation = Simulation::new(&Scene::parse(text).unwrap()).unwrap();
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
    let hinged = run(&hinge(tilt), 50);
    let fixed = run(&scene(&format!("drive = \"fixed\"\nmisalignment = {tilt}")), 50);
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
    let text = hinge("{ ry = [[0.0, 0.0], [\"2 ms\", 3e-4]], rz = 1e-4 }")
        .replace("[load]", "[load]\nouter_speed = \"-1000 rpm\"");
    let history = run(&text, 30);
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
    let text = THRUST.to_string()
        + "[start]\norbital_speed = 100.0\nball_angular_velocity = [-300.0, 20.0, 5.0]\ninner_velocity = [0.01, 0.0, 0.0]\n";
    let history = run(&text, 100);
    assert_eq!(history[0].inner.twist.velocity.x, 0.01);
    for ball in &history[0].balls {
        assert!((ball.orbital_speed - 100.0).abs() < 1e-9);
        let size = Vector3::new(300.0f64, 20.0, 5.0).norm();
        assert!((ball.angular_velocity.norm() - size).abs() < 1e-9 && ball.angular_velocity.x == -300.0);
    }
    // Friction brings the balls up to the rolling speed.
    assert!(history[100].cage_speed > 200.0, "{}", history[100].cage_speed);
}
