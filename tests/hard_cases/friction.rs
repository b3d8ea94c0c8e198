//! Friction: none, hardly any, high, suddenly high, suddenly gone; skidding and recovery.

use nalgebra::Vector3;
use roulement::inputs::Inputs;
use roulement::simulation::Simulation;

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, load, scene};

fn friction(coefficient: f64) -> String {
    format!("[friction]\nball_race = {coefficient:e}\n")
}

#[test]
fn no_friction_to_high_friction() {
    for mu in [0.0, 1e-6, 0.3] {
        let name = format!("friction {mu}");
        let scene = scene(ANGULAR, &(load(20.0, 6000.0, "x = { force = 1500.0 }\ny = { force = 300.0 }\n") + &friction(mu)));
        let run = Case::new(&name, scene, limits(10000, 300, 100, 5.0)).pass();
        let (a, b) = (&run.history[0], run.last());
        for (x, y) in a.balls.iter().zip(&b.balls) {
            println!("{:e} {:e} {} {}", (x.angular_velocity - y.angular_velocity).norm(), x.angular_velocity.norm(), x.orbital_speed, y.orbital_speed);
        }
        println!("{} {}", a.cage_slip, b.cage_slip);
    }
}

#[test]
fn loss_of_lubrication() {
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        inputs.friction = if point < 200 { 0.01 } else { 0.15 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let scene = scene(ANGULAR, &(load(40.0, 6000.0, "x = { force = 1500.0 }\ny = { force = 300.0 }\n") + &friction(0.01)));
    let mut case = Case::new("friction from 0.01 to 0.15 at once", scene, limits(10000, 300, 100, 5.0));
    case.importer = Some(&importer);
    let run = case.pass();
    for i in [100, 198, 199, 200, 201, 202, 210, 250, 400] { let o = &run.history[i]; println!("{} {} {} {}", o.time, o.friction_power, o.cage_slip, o.inner.pose.position); }
}

#[test]
fn gyroscopic_pivot() {
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let mut inputs = simulation.scripted_inputs(simulation.time());
        inputs.friction = if point < 100 { 0.1 } else { 1e-3 };
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let scene = scene(ANGULAR, &(load(20.0, 12000.0, "x = { force = 400.0 }\n") + &friction(0.1)));
    let mut case = Case::new("friction cut from 0.1 to 0.001 at 12000 rpm", scene, limits(10000, 300, 100, 5.0));
    case.importer = Some(&importer);
    let run = case.pass();
    for i in [0, 50, 99, 100, 101, 102, 105, 110, 120, 150, 200] { let o = &run.history[i]; let b = &o.balls[0];
        // spin about gyro axis (tangential)
        let (s, c) = b.azimuth.sin_cos();
        let t = Vector3::new(0.0, -s, c);
        let r = Vector3::new(0.0, c, s);
        println!("{:.4} tang {:.4} axial {:.2} radial {:.2} lat {} {} force/limit {} {}", o.time, b.angular_velocity.dot(&t), b.angular_velocity.x, b.angular_velocity.dot(&r), b.inner.creepage_lateral, b.outer.creepage_lateral, b.inner.force_lateral/b.inner.load, b.outer.force_lateral/b.outer.load); }
}

#[test]
fn skidding_and_recovery() {
    for force in [20.0, 100.0] {
        let rows = format!("x = {{ force = [[0.0, {force}], [0.02, {force}], [0.03, 1000.0]] }}\noutput_interval = \"100 us\"\n");
        let load = format!("[load]\nduration = \"50 ms\"\ninner_speed = [[0.0, \"600 rpm\"], [0.005, \"15000 rpm\"]]\n{rows}\n");
        let name = format!("600 to 15000 rpm in 5 ms under {force} N");
        let run = Case::new(&name, scene(ANGULAR, &(load + &friction(0.02))), limits(20000, 300, 100, 5.0)).pass();
        for i in (0..500).step_by(20) { let o = &run.history[i]; println!("{:.4} {:.4} {:.2}", o.time, o.cage_slip, o.friction_power); }
    }
}
