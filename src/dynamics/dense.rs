//! Dense output: a bearing at a time within a step that was accepted.
//!
//! Positions are cubic between the ends of the step, whose values and rates they have (Hairer, Norsett and Wanner 1993, section II.6); motions that
//! are prescribed are those of the script, and normal loads those of the contacts there. Velocities and traction go linearly from one end
//! to the other, which has an error of the order of the scheme. Rolling balls follow the races within far less than a step: slip is the small
//! difference of large speeds, and traction what accelerates the balls. Neither is found again from velocities within the step: cubic
//! ones had up to six times the error that slip has at the ends, and traction from them up to eight times
//! (tests/simulation/dense.rs). Energies, heat and damage go on to there as they do over a step.

use nalgebra::{UnitQuaternion, Vector3};

use super::Boundary;
use super::accept::{grow, take_forces};
use super::record::record;
use crate::contact::BallRaceContact;
use crate::forces::{Contacts, stored_energy};
use crate::model::Model;
use crate::model::bodies::{Body, Race};
use crate::model::state::{BallState, BodyState, State, normalised};
use crate::numerics::hermite::Hermite;
use crate::numerics::motion::Pose;

/// A bearing where a step begins or ends.
#[derive(Clone, Debug)]
pub struct StepBound {
    /// Its state.
    pub state: State,
    /// Its contacts.
    pub contacts: Contacts,
}

/// The state at the time of a boundary, within the step from one state to another, and its contacts. Races that structures carry
/// are where the boundary has them.
pub fn within(model: &Model, ends: [&StepBound; 2], boundary: &Boundary) -> StepBound {
    let [start, end] = ends.map(|bound| &bound.state);
    let part = boundary.time - start.time;
    let between = Hermite::new(part, end.time - start.time);
    let mut state = start.clone();
    state.time = boundary.time;
    state.differences.clone_from(&end.differences);
    state.orientations.clone_from(&boundary.orientations);
    for (state, end) in state.balls.iter_mut().zip(&end.balls) {
        move_ball(state, end, between);
    }
    if let (Some(spacing), Some(before), Some(after)) = (&model.spacing, &start.spacing, &end.spacing) {
        let turn = before.within(after, between);
        turn.place(spacing, &mut state.balls);
        state.spacing = Some(turn);
    }
    let bodies = state.bodies.iter_mut().zip(end.bodies.iter()).zip(model.bodies.iter());
    for (((body, state), (_, end)), (_, moved)) in bodies {
        let (turned, spin) = ((state.turned, state.turned_rest), state.rate.x);
        match body {
            Body::Race(race) if moved.as_ref().is_none_or(|moved| moved.carried) => {
                let (pose, twist) = &boundary.motion[race];
                *state = BodyState::new(*pose, twist, 0);
                state.angular_velocity = twist.angular_velocity;
            }
            Body::Race(_) | Body::Cage => move_body(state, end, between),
        }
        state.count_turn(turned, 0.5 * part * (spin + state.rate.x));
    }
    let mut contacts = Contacts::new(model, &state, &boundary.conditions);
    for (index, (ball, of)) in state.balls.iter().zip(&mut contacts.balls).enumerate() {
        for race in Race::BOTH {
            let arm = ball.position - state.race(race).pose.position;
            follow_traction(
                &mut of.raceways[race],
                ends.map(|at| &at.contacts.balls[index].raceways[race]),
                between,
                arm,
            );
        }
    }
    take_forces(model, &mut state, boundary, &contacts);
    let stiffened = state.balls.iter().zip(&start.balls).map(|(now, before)| {
        let of = |race| now.pressed[race].stiffened(&before.pressed[race]);
        of(Race::Inner) + of(Race::Outer)
    });
    let stiffened = stiffened.fold(0.0, |sum, work| sum + work);
    let left = state.energies.add((&start.powers, &state.powers), part, stiffened);
    if model.solver.energy_error > 0.0 {
        state.energies.close(left, stored_energy(model, &state, &contacts));
    }
    grow(model, &mut state, boundary, |ball, race| contacts.balls[ball].raceways[race].touch());
    record(model, &mut state, &contacts, &boundary.conditions, Some(part));
    StepBound { state, contacts }
}

/// Sets the traction of a contact that carries load at both ends of the step to that on the line between them. `arm` \[m] is
/// the centre of the ball from the origin of the race.
fn follow_traction(
    contact: &mut BallRaceContact<f64>,
    ends: [&BallRaceContact<f64>; 2],
    between: Hermite,
    arm: Vector3<f64>,
) {
    if contact.load <= 0.0 || ends.iter().any(|end| end.load <= 0.0) {
        return;
    }
    let [start, end] = ends;
    let line = start.zip_with(end, |start: f64, end: f64| between.linear([start, end]));
    let along = |normal: &Vector3<f64>, force: &Vector3<f64>| normal * normal.dot(force);
    let traction = |of: &BallRaceContact<f64>| of.force - along(&of.geometry.normal, &of.force);
    contact.force =
        along(&contact.geometry.normal, &contact.force) + between.linear([traction(start), traction(end)]);
    contact.ball_moment = line.ball_moment;
    // What acts on both is opposite about any point.
    contact.race_moment = -(contact.ball_moment + arm.cross(&contact.force));
    contact.creepage = line.creepage;
    contact.creep = line.creep;
    contact.friction_power = line.friction_power;
}

/// Moves a ball on from the start of a step.
fn move_ball(state: &mut BallState, end: &BallState, between: Hermite) {
    state.position = between.at([state.position, end.position], [state.velocity, end.velocity]);
    state.velocity = between.linear([state.velocity, end.velocity]);
    state.angular_velocity = between.linear([state.angular_velocity, end.angular_velocity]);
}

/// Moves a body on from the start of a step.
fn move_body(state: &mut BodyState, end: &BodyState, between: Hermite) {
    let start = state.pose;
    let position = between.at([start.position, end.pose.position], [state.velocity, end.velocity]);
    // The turn since the start as a rotation vector: `v' = w + v x w/2 + v x (v x w)/12 + ..`, w in the body's own axes.
    let turn = (start.orientation.inverse() * end.pose.orientation).scaled_axis();
    let across = turn.cross(&end.rate);
    let last = end.rate + across * 0.5 + turn.cross(&across) / 12.0;
    let turned = between.at([Vector3::zeros(), turn], [state.rate, last]);
    state.pose = Pose { position, orientation: normalised(start.orientation * UnitQuaternion::new(turned)) };
    state.velocity = between.linear([state.velocity, end.velocity]);
    state.rate = between.linear([state.rate, end.rate]);
    state.refresh_motion();
}
