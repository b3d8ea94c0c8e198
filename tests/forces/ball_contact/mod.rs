//! Balls without a cage: contact of neighbours, motion and energy of a full row, and scenes that are refused.

use std::f64::consts::PI;

use nalgebra::Vector3;
use roulement::contact::BallMotion;
use roulement::contact::ball_ball::BallBallModel;
use roulement::forces::Contacts;
use roulement::interface::variables::Variables;
use roulement::numerics::scalar::{Dual, Scalar, constant_vector};
use roulement::scene::{Groups, Scene};
use roulement::simulation::outputs::Outputs;
use roulement::simulation::{Simulation, SimulationError, Snapshot};

use crate::random::vector;
use crate::scenes::scene;

mod bearings;
mod contact;

const THRUST: &str = include_str!("../../../scenes/thrust.toml");
/// [m]
const RADIUS: f64 = 4.7625e-3;
/// Steel: Young's modulus [Pa] and Poisson's ratio.
const STEEL: (f64, f64) = (206e9, 0.3);
/// [kg] a ball of the scenes.
const MASS: f64 = 7800.0 * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;

/// The row of balls that ran through itself: combined load, no cage.
const COMBINED: &str = r#"
[bearing]
balls = 13
ball_diameter = "9.525 mm"
pitch_diameter = "46 mm"
contact_angle = "40 deg"
inner_conformity = 0.52
outer_conformity = 0.52
[effects]
damping = "0.02 s/m"
[inner]
drive = "wrench"
mass = "0.2 kg"
inertia = ["6e-5 kg m^2", "4e-5 kg m^2", "4e-5 kg m^2"]
[load]
duration = "100 ms"
output_interval = "0.2 ms"
inner_speed = "3000 rpm"
x = { force = "2000 N" }
y = { force = "2500 N" }
ry = { rotation = 0.0 }
rz = { rotation = 0.0 }
"#;

fn go_on(simulation: &mut Simulation, points: u32, interval: f64) -> Vec<Outputs> {
    let begin = simulation.time();
    let mut history = vec![simulation.outputs().clone()];
    for point in 1..=points {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(begin + f64::from(point) * interval).unwrap();
        history.push(simulation.outputs().clone());
    }
    history
}
