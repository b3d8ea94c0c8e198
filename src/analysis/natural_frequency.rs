//! Natural frequencies of a bearing: that of a race on its balls, which a blow makes ring, and the highest one, of a ball between its races, the
//! lightest body on the stiffest springs.

use nalgebra::SMatrix;

use crate::equilibrium::{self, EquilibriumInput, Gyroscopic, Prescribed};
use crate::forces::{BallContacts, Contacts};
use crate::model::bodies::Race;
use crate::model::state::State;
use crate::model::{Conditions, Model};
use crate::scene::Scene;

/// \[Hz] natural frequencies of the race that the load moves, from the least on: of its mass and inertia on the stiffness of the
/// equilibrium under the script's loads at a time \[s], in the directions that are free. Balls, cage and gyroscopic moments
/// are left out. None where nothing is free, where the race is carried by a shaft or a flexible support, or without an equilibrium.
pub fn of_race(model: &Model, scene: &Scene, time: f64) -> Vec<f64> {
    let race = Race::loaded(scene);
    let Some(body) = model.bodies[race].as_ref().filter(|body| !body.carried) else { return vec![] };
    if model.supports[race].is_some() {
        return vec![];
    }
    let input = EquilibriumInput::at(scene, Gyroscopic::Friction, time);
    let free = input.conditions.map(|condition| matches!(condition, Prescribed::Load(_)));
    let Ok(equilibrium) = equilibrium::solve(model, &input) else { return vec![] };
    let masses = [body.mass, body.mass, body.mass, body.inertia.y, body.inertia.z];
    let symmetric = 0.5 * (equilibrium.stiffness + equilibrium.stiffness.transpose());
    let coupled = |i: usize, k: usize| if free[i] && free[k] { symmetric[(i, k)] } else { 0.0 };
    let scaled = SMatrix::<f64, 5, 5>::from_fn(|i, k| coupled(i, k) / (masses[i] * masses[k]).sqrt());
    let squares = scaled.symmetric_eigenvalues();
    // Held directions have 0, but for rounding.
    let nothing = 1e-12 * squares.amax();
    let squares = squares.iter().filter(|square| **square > nothing);
    let mut frequencies: Vec<f64> = squares.map(|square| square.sqrt() / std::f64::consts::TAU).collect();
    frequencies.sort_by(f64::total_cmp);
    frequencies
}

/// \[Hz] frequency `sqrt((dQ_i/dx + dQ_o/dx)/m)/2 pi` at which a ball swings along its contact normals under these loads
/// \[N] on the inner and the outer race, with `dQ/dx = 1.5 K^(2/3) Q^(1/3)` of the stiffest contact; 0 without load.
pub fn of_ball(model: &Model, state: &State, conditions: &Conditions, loads: [f64; 2]) -> f64 {
    let contacts = Contacts::new(model, state, conditions);
    let spring = |(race, load): (Race, f64)| {
        let stiffness = |ball: &BallContacts| ball.raceways[race].stiffness;
        let stiffness = contacts.balls.iter().map(stiffness).fold(0.0, f64::max);
        1.5 * (stiffness * stiffness * load.max(0.0)).cbrt()
    };
    let spring: f64 = Race::BOTH.into_iter().zip(loads).map(spring).sum();
    (spring / model.bearing.ball.mass).sqrt() / std::f64::consts::TAU
}
