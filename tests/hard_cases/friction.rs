//! Friction: none, hardly any, high, suddenly high, suddenly gone; skidding and recovery.

use nalgebra::Vector3;
use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;
use roulement::simulation::outputs::BallOutput;

use crate::gates::{Case, Run, limits};
use crate::scenes::{ANGULAR, load, ramp, scene};

const COMBINED: &str = "x = { force = 1500.0 }\ny = { force = 300.0 }\n";

fn friction(coefficient: f64) -> String {
    format!("[friction]\nball_race = {coefficient:e}\n")
}

/// 20 ms at 6000 rpm under thrust and radial load.
fn run(coefficient: f64) -> Run {
    let scene = scene(ANGULAR, &(load(20.0, 6000.0, COMBINED) + &friction(coefficient)));
    Case::new(&format!("friction {coefficient}"), scene, limits(2300, 10, 10, 4.0)).pass()
}

#[test]
fn none() {
    let run = run(0.0);
    for (start, end) in run.history[0].balls.iter().zip(&run.last().balls) {
        assert_eq!(start.angular_velocity, end.angular_velocity);
    }
    assert_eq!(run.last().friction_power, 0.0);
}

#[test]
fn hardly_any() {
    let run = run(1e-6);
    for (start, end) in run.history[0].balls.iter().zip(&run.last().balls) {
        // mu Q r over the moment of inertia, for as long as it lasts, at both contacts.
        let ball = run.simulation.model().bearing.ball;
        let bound = 2.0 * 1e-6 * 600.0 * ball.radius / ball.inertia * 0.02;
        assert!((start.angular_velocity - end.angular_velocity).norm() < bound, "{bound}");
    }
}

#[test]
fn high() {
    let run = run(0.3);
    assert!(run.last().cage_slip.abs() < 0.01, "{}", run.last().cage_slip);
}

#[test]
fn loss_of_lubrication() {
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        inputs.friction = if point < 200 { 0.01 } else { 0.15 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let scene = scene(ANGULAR, &(load(40.0, 6000.0, COMBINED) + &friction(0.01)));
    let mut case = Case::new("friction from 0.01 to 0.15 at once", scene, limits(4400, 10, 10, 3.0));
    case.importer = Some(&importer);
    let run = case.pass();
    // Heat rises at once and by about as much as friction does, positions go on without a jump.
    let (before, after) = (&run.history[200], &run.history[201]);
    assert!(after.friction_power > 5.0 * before.friction_power);
    let usual = (run.history[199].inner.pose.position - before.inner.pose.position).norm();
    let step = (after.inner.pose.position - before.inner.pose.position).norm();
    assert!(step < 3.0 * usual + 1e-7, "{step} m, {usual} m");
}

#[test]
fn gyroscopic_pivot() {
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        inputs.friction = if point < 100 { 0.1 } else { 1e-3 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let scene = scene(ANGULAR, &(load(20.0, 12_000.0, "x = { force = 400.0 }\n") + &friction(0.1)));
    let name = "friction cut from 0.1 to 0.001 at 12,000 rpm";
    let mut case = Case::new(name, scene, limits(2300, 10, 10, 3.0));
    case.importer = Some(&importer);
    let run = case.pass();
    // Speed about the direction of the orbit: that of a pivoting ball.
    let pivot = |ball: &BallOutput| {
        let (sin, cos) = ball.azimuth.sin_cos();
        ball.angular_velocity.dot(&Vector3::new(0.0, -sin, cos))
    };
    let (held, free) = (&run.history[100].balls[0], &run.history[101].balls[0]);
    // Held by friction, a thousandth of the ball's speed; let go, the axis keeps its direction in space while the orbit
    // goes on, but for what friction is left.
    assert!(pivot(held).abs() < 1e-3 * held.angular_velocity.norm());
    let radial = {
        let (sin, cos) = held.azimuth.sin_cos();
        held.angular_velocity.dot(&Vector3::new(0.0, cos, sin))
    };
    let expected = -radial * (held.orbital_speed * 1e-4);
    let gained = pivot(free) - pivot(held);
    assert!((gained / expected - 1.0).abs() < 0.1, "{gained} rad/s, {expected} rad/s");
    // Before the cut the lateral force is inside its limit, after it at the limit.
    assert!(held.outer.force_lateral.abs() < 0.5 * 0.1 * held.outer.load);
    assert!(free.outer.force_lateral.abs() > 0.9 * 1e-3 * free.outer.load);
}

#[test]
fn skidding_and_recovery() {
    let skid = |force: f64| -> Run {
        let rows = format!("x = {{ force = [[0.0, {force}], [0.02, {force}], [0.03, 1000.0]] }}\n");
        let changes = ramp(50.0, "[[0.0, \"600 rpm\"], [0.005, \"15000 rpm\"]]", &rows) + &friction(0.02);
        let name = format!("600 to 15,000 rpm in 5 ms under {force} N");
        Case::new(&name, scene(ANGULAR, &changes), limits(5500, 10, 10, 3.0)).pass()
    };
    let (light, heavier) = (skid(20.0), skid(100.0));
    let slip = |run: &Run, i: usize| run.history[i].cage_slip;
    // The balls stay behind, less so under more load, and heat; with load they recover.
    assert!(slip(&light, 100) > 0.9 && slip(&heavier, 100) < slip(&light, 100));
    assert!(heavier.history[100].friction_power > light.history[100].friction_power);
    assert!(slip(&light, 500).abs() < 0.01 && slip(&heavier, 500).abs() < 0.01);
}
