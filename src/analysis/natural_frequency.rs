//! Highest natural frequency of a bearing: a ball between its races, the lightest body on the stiffest springs.

use crate::forces::{BallContacts, Contacts};
use crate::model::bodies::Race;
use crate::model::state::State;
use crate::model::{Conditions, Model};

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
