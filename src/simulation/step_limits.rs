//! Steps that what the balls roll over allows, whatever the local error says: a step must not pass what it did not see.

use std::f64::consts::TAU;

use super::slip::orbital_speed;
use crate::contact::form::Form;
use crate::contact::spall::Spalls;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::state::{BallState, State};

/// Steps to the shortest wave of a race.
const STEPS_PER_WAVE: f64 = 16.0;
/// [-] step over the half width of a contact, near a spall.
const STEP_OVER_WIDTH: f64 = 0.3;
/// Half widths of a contact before and behind a spall in which it counts as near: the drop there is below 0.1 um.
const NEAR: f64 = 4.0;

/// \[s] largest step from a state; none where the local error alone decides.
pub(super) fn largest_step(model: &Model, state: &State) -> Option<f64> {
    let limit = |race: Race| {
        let waves = model.form[race].as_ref().map(|form| over_waves(form, state, race));
        let spalls = model.spalls[race].as_ref().map(|spalls| over_spalls(spalls, state, race));
        waves.into_iter().chain(spalls).reduce(f64::min)
    };
    Race::BOTH.into_iter().filter_map(limit).reduce(f64::min)
}

/// [rad/s] speed of a ball along a race.
fn speed(ball: &BallState, state: &State, race: Race) -> f64 {
    orbital_speed(ball, state.race(Race::Outer)) - state.race(race).rate.x
}

fn over_waves(form: &Form, state: &State, race: Race) -> f64 {
    let speeds = state.balls.iter().map(|ball| speed(ball, state, race).abs());
    TAU / (STEPS_PER_WAVE * form.order * speeds.fold(0.0, f64::max))
}

fn over_spalls(spalls: &Spalls, state: &State, race: Race) -> f64 {
    let body = state.race(race);
    let half_width = spalls.typical_half_width();
    let mut limit = f64::INFINITY;
    for ball in &state.balls {
        let offset = ball.position - body.pose.position;
        let azimuth = offset.dot(&body.axes[2]).atan2(offset.dot(&body.axes[1]));
        let speed = speed(ball, state, race);
        for spall in spalls.each() {
            let (radius, near) = (spalls.radius(spall), 0.5 * spall.length + NEAR * half_width);
            // Arc that the ball has before it until it is over the middle, in its own direction.
            let ahead = radius * ((spall.azimuth - azimuth) * speed.signum()).rem_euclid(TAU);
            let behind = TAU * radius - ahead;
            let free = if behind < near { 0.0 } else { (ahead - near).max(0.0) };
            limit = limit.min((free + STEP_OVER_WIDTH * half_width) / (radius * speed.abs()));
        }
    }
    limit
}
