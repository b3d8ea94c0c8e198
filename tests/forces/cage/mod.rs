//! The cage: contacts of pockets and lands, motion, energy, cost, and scenes that are refused.

use std::f64::consts::PI;

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use roulement::contact::cage_film::{self, Gap};
use roulement::contact::land::{LandModel, Lands};
use roulement::contact::materials::Pair;
use roulement::contact::motion::BodyMotion;
use roulement::contact::pair::PairForces;
use roulement::contact::pocket::PocketModel;
use roulement::contact::{BallMotion, RaceMotion};
use roulement::interface::variables::Variables;
use roulement::numerics::scalar::{Dual, Scalar, constant_vector};
use roulement::scene::{Guidance, Scene};
use roulement::simulation::Simulation;
use roulement::simulation::outputs::{CageOutput, Outputs, PocketOutput};

use crate::mechanics::{Body, CageDimensions};
use crate::random::{number, vector};
use crate::scenes::scene;

mod bearings;
mod contacts;
mod unbalance;

const THRUST: &str = include_str!("../../../scenes/thrust.toml");
const CAGE: &str = include_str!("../../../scenes/cage.toml");
/// Half the diametral clearance of pockets and lands of the scene [m].
const HALF_CLEARANCE: f64 = 0.1e-3;

/// Goes on by the scene's own script for some communication steps; outputs at every one, the present first.
fn go_on(simulation: &mut Simulation, points: u32) -> Vec<Outputs> {
    let interval = simulation.scene().load.output_interval.0;
    let mut history = vec![simulation.outputs().clone()];
    let begin = simulation.time();
    for point in 1..=points {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(begin + f64::from(point) * interval).unwrap();
        history.push(simulation.outputs().clone());
    }
    history
}

fn run(scene: &Scene, points: u32) -> (Simulation, Vec<Outputs>) {
    let mut simulation = Simulation::new(scene).unwrap();
    let history = go_on(&mut simulation, points);
    (simulation, history)
}

/// Changes of keys.
type Changes = [(&'static str, &'static str)];

/// The cage carried by the balls instead of the outer race.
const BALL_GUIDED: &Changes = &[
    ("cage.guided_by", "\"balls\""),
    ("cage.guidance_clearance", ""),
    ("cage.land_diameter", ""),
    ("cage.land_width", ""),
    ("friction.cage_race", ""),
];

/// The cage on lands of the inner race, which is a body.
const INNER_GUIDED: &Changes = &[("cage.guided_by", "\"inner\""), ("cage.land_diameter", "\"40 mm\"")];

/// Without the radial load.
const PURE_THRUST: &Changes = &[("load.z", "")];

/// The inner race braked from 6000 to 3000 rpm between two times [s], so that the cage runs into slower balls.
fn braked(changes: &Changes, from: f64, to: f64) -> Scene {
    let ramp = format!("[[0.0, \"6000 rpm\"], [{from}, \"6000 rpm\"], [{to}, \"3000 rpm\"]]");
    scene(CAGE, &[changes, &[("load.inner_speed", &ramp)]].concat())
}

fn cage(outputs: &Outputs) -> CageOutput {
    outputs.cage.unwrap()
}

fn pockets(outputs: &Outputs) -> impl Iterator<Item = PocketOutput> + '_ {
    outputs.balls.iter().map(|ball| ball.pocket.unwrap())
}

fn deepest_pocket(history: &[Outputs]) -> f64 {
    history.iter().flat_map(pockets).map(|pocket| pocket.approach).fold(f64::NEG_INFINITY, f64::max)
}

/// Energy put in that is neither stored nor lost, over all that was put in or lost.
fn imbalance(history: &[Outputs]) -> f64 {
    let (first, last) = (&history[0], &history[history.len() - 1]);
    let balance = last.work - last.dissipated - (last.stored_energy - first.stored_energy);
    balance.abs() / (last.work.abs() + last.dissipated)
}
