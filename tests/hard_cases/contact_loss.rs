//! Contacts that open and close: clearance, thrust through zero, shock, a shaken bearing.

use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::inputs::Inputs;
use roulement::simulation::Simulation;

use crate::gates::{Case, limits};
use crate::scenes::{ANGULAR, GROOVE, load, scene};

const HOLD: &str = "x = { displacement = 0.0 }\nry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n";

/// The radial bearing with another diametral clearance and conformity.
fn clearance(micrometres: f64, conformity: f64) -> String {
    format!(
        "[bearing]\nballs = 9\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\n\
         diametral_clearance = \"{micrometres} um\"\ninner_conformity = {conformity}\nouter_conformity = {conformity}\n"
    )
}

#[test]
fn unloaded_zone() {
    for (name, micrometres, conformity) in [("radial load, clearance 50 um", 50.0, 0.52), ("radial load, clearance 1 mm", 1000.0, 0.56)] {
        let rows = format!("y = {{ force = 1500.0 }}\n{HOLD}");
        let scene = scene(GROOVE, &(clearance(micrometres, conformity) + &load(50.0, 6000.0, &rows)));
        let run = Case::new(name, scene, limits(20000, 300, 100, 5.0)).pass();
        let last = run.last();
        let ball = run.simulation.model().bearing.ball;
        for b in &last.balls {
            println!("{:.1} {} {} {} {}", b.azimuth.to_degrees(), b.inner.load, b.outer.load, b.orbital_speed, ball.mass*b.orbital_speed.powi(2)*0.023);
        }
        let input = EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::None);
        let e = equilibrium::solve(run.simulation.model(), &input).unwrap();
        println!("{:?} {:?}", e.displacement, last.inner.pose.position);
        for b in &e.balls { println!("{} {} {}", b.azimuth.to_degrees(), b.report.inner_load, b.report.outer_load); }
    }
}

#[test]
fn thrust_reversal_through_zero() {
    let rows = "x = { force = [[0.0, 1500.0], [0.01, 1500.0], [0.02, -1500.0]] }\n";
    let run = Case::new("thrust from 1500 to -1500 N in 10 ms", scene(ANGULAR, &load(40.0, 6000.0, rows)), limits(10000, 300, 100, 5.0)).pass();
    for i in (0..400).step_by(10) { let o=&run.history[i]; println!("{:.4} {:e} {:?} {} {}", o.time, o.inner.pose.position.x, o.inner.pose.position, o.balls[0].inner.load, o.balls[5].outer.load); }
    let mut input = EquilibriumInput::from_scene(run.simulation.scene(), Gyroscopic::None);
    let a = equilibrium::solve(run.simulation.model(), &input).unwrap();
    input.conditions[0] = equilibrium::Prescribed::Load(-1500.0);
    let b = equilibrium::solve(run.simulation.model(), &input).unwrap();
    println!("{:?} {:?}", a.displacement, b.displacement);
}

#[test]
fn shock_of_5_kn() {
    let rows = "x = { force = 1500.0 }\ny = { force = [[0.0, 0.0], [0.005, 0.0], [0.00505, 5000.0], [0.0051, 0.0]] }\noutput_interval = \"25 us\"\n";
    let run = Case::new("5 kN for 0.1 ms across the thrust", scene(ANGULAR, &load(30.0, 6000.0, rows)), limits(10000, 300, 100, 5.0)).pass();
    let peak = run.history.iter().flat_map(|o| o.balls.iter().map(|b| b.inner.load.max(b.outer.load))).fold(0.0, f64::max);
    println!("peak {peak}; {} {}", run.history[190].balls[0].inner.load, run.last().balls[0].inner.load);
    let rows = format!("y = {{ force = [[0.0, 500.0], [0.005, 500.0], [0.00505, 5500.0], [0.0051, 500.0]] }}\noutput_interval = \"25 us\"\n{HOLD}");
    let run = Case::new("5 kN for 0.1 ms on the radial load", scene(GROOVE, &load(30.0, 6000.0, &rows)), limits(10000, 300, 100, 5.0)).pass();
    let peak = run.history.iter().flat_map(|o| o.balls.iter().map(|b| b.inner.load.max(b.outer.load))).fold(0.0, f64::max);
    println!("peak {peak}; {} {}", run.history[190].balls[0].inner.load, run.last().balls[0].inner.load);
}

#[test]
fn accelerated_bearing_is_a_bearing_under_gravity() {
    let acceleration = 50.0 * 9.80665;
    let rows = "x = { force = 200.0 }\n";
    let effects = "[effects]\ncreep = \"saturated\"\ndamping = \"0.02 s/m\"\n";
    // The outer race moves with 50 g from the start.
    let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
        let time = simulation.time();
        let mut inputs = simulation.scripted_inputs(time);
        inputs.outer.pose.position.y = 0.5 * acceleration * time * time;
        inputs.outer.twist.velocity.y = acceleration * time;
        inputs.outer.twist_rate.velocity.y = acceleration;
        (inputs, f64::from(point + 1) * 1e-4)
    };
    let shaken = scene(ANGULAR, &(load(20.0, 6000.0, rows) + effects + "[outer]\ndrive = \"pose\""));
    let mut case = Case::new("outer race accelerated by 50 g", shaken, limits(10000, 300, 100, 5.0));
    case.importer = Some(&importer);
    let moving = case.pass();
    let gravity = format!("gravity = [0.0, {}, 0.0]\n", -acceleration);
    let heavy = scene(ANGULAR, &(load(20.0, 6000.0, rows) + effects + &gravity));
    let standing = Case::new("gravity of 50 g", heavy, limits(10000, 300, 100, 5.0)).pass();
    for i in [1, 5, 10,20,50,100,150,200] {
        let (a, b) = (&moving.history[i], &standing.history[i]);
        println!("{:?} {:?} {} {}", a.inner.wrench.force, b.inner.wrench.force, a.balls[5].inner.load, b.balls[5].inner.load);
    }
}
