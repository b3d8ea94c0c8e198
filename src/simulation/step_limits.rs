//! Steps that what the balls roll over and what the script gives allow, whatever the local error says: a step must not pass what it
//! did not see.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::contact::ball_spall::OnBall;
use crate::contact::form::Form;
use crate::contact::spall::Spalls;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::state::{BallState, State};

/// Steps to the shortest wave of a race, and to the shortest period of a script.
const STEPS_PER_WAVE: f64 = 16.0;
/// [-] step over the half width of a contact, near a spall.
const STEP_OVER_WIDTH: f64 = 0.3;
/// Half widths of a contact before and behind a spall in which it counts as near: the drop there is below 0.1 um.
const NEAR: f64 = 4.0;

/// \[s] largest step from a state, with the shortest period \[s] of what the script gives; none where the local error alone decides.
pub(super) fn largest_step(model: &Model, state: &State, script: Option<f64>) -> Option<f64> {
    let script = script.map(|period| period / STEPS_PER_WAVE);
    let limit = |race: Race| {
        let waves = model.form[race].as_ref().map(|form| over_waves(form, state, race));
        let spalls = model.spalls[race].as_ref().map(|spalls| over_spalls(spalls, state, race));
        waves.into_iter().chain(spalls).reduce(f64::min)
    };
    let balls = over_spalls_of_balls(model, state);
    Race::BOTH.into_iter().filter_map(limit).chain(balls).chain(script).reduce(f64::min)
}

/// [rad/s] speed of a ball along a race.
fn speed(ball: &BallState, state: &State, race: Race) -> f64 {
    ball.orbital_speed(state.race(Race::Outer)) - state.race(race).rate.x
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
            let free = free_arc(ahead, near, radius);
            limit = limit.min((free + STEP_OVER_WIDTH * half_width) / (radius * speed.abs()));
        }
    }
    limit
}

/// \[m] arc before a spall counts as near, on a circle of a radius \[m], where its middle is `ahead` \[m].
fn free_arc(ahead: f64, near: f64, radius: f64) -> f64 {
    let behind = TAU * radius - ahead;
    if behind < near { 0.0 } else { (ahead - near).max(0.0) }
}

/// Damaged balls turn with their spalls past the contacts, which stand still as seen from the orbit of a ball.
fn over_spalls_of_balls(model: &Model, state: &State) -> Option<f64> {
    let (damaged, orientations) = (model.damaged.as_ref()?, state.orientations.as_ref()?);
    let limit = |race: Race| {
        let of = |spall: &OnBall| {
            let middle = orientations[spall.damaged] * spall.axes[0];
            until_contact(model, state, race, (spall, &middle))
        };
        damaged.spalls[race].0.iter().map(of).reduce(f64::min)
    };
    Race::BOTH.into_iter().filter_map(limit).reduce(f64::min)
}

/// \[s] largest step of a ball with a spall, in the direction of its middle from the ball's centre, for the contact with a race.
fn until_contact(model: &Model, state: &State, race: Race, (spall, middle): (&OnBall, &Vector3<f64>)) -> f64 {
    let (ball, body, outer) = (&state.balls[spall.ball], state.race(race), state.race(Race::Outer));
    let raceway = model.bearing.raceway(race);
    let (radius, axis) = (model.bearing.ball.radius, body.axes[0]);
    let offset = ball.position - body.pose.position;
    let along = offset.dot(&axis);
    let radial = offset - axis * along;
    let out = radial - radial.normalize() * raceway.groove_circle_radius;
    let normal = (out + axis * (along - raceway.groove_offset)).normalize();
    // As the spall goes round: its middle and the contact by azimuth and latitude.
    let turn = ball.angular_velocity - outer.axes[0] * ball.orbital_speed(outer);
    let speed = turn.norm();
    let about = turn.try_normalize(0.0).unwrap_or(axis);
    let [from, to] = [middle, &normal].map(|direction| direction - about * direction.dot(&about));
    let [length, width] = spall.size;
    let reach = 0.5 * length.hypot(width);
    let apart = radius * (middle.dot(&about).asin() - normal.dot(&about).asin()).abs();
    if apart > reach + NEAR * spall.typical_half_axis() {
        return f64::INFINITY;
    }
    let half_width = spall.typical_half_width();
    let circle = radius * from.norm();
    let ahead = circle * about.dot(&from.cross(&to)).atan2(from.dot(&to)).rem_euclid(TAU);
    let free = free_arc(ahead, reach + NEAR * half_width, circle);
    (free + STEP_OVER_WIDTH * half_width) / (circle * speed)
}
