//! Steps that what the balls roll over allows, whatever the local error says: a step must not pass what it did not see.

use std::f64::consts::TAU;

use super::slip::orbital_speed;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::state::State;

/// Steps to the shortest wave of a race.
const STEPS_PER_WAVE: f64 = 16.0;

/// \[s] largest step from a state.
pub(super) fn largest_step(model: &Model, state: &State) -> Option<f64> {
    let wavy = Race::BOTH.into_iter().filter_map(|race| Some((race, model.form[race].as_ref()?)));
    let limits = wavy.map(|(race, form)| {
        let outer = state.race(Race::Outer);
        let own = state.race(race).rate.x;
        let speeds = state.balls.iter().map(|ball| (orbital_speed(ball, outer) - own).abs());
        TAU / (STEPS_PER_WAVE * form.order * speeds.fold(0.0, f64::max))
    });
    limits.reduce(f64::min)
}
