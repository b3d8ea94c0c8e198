//! From solved equations to the next state, and from a motion to a consistent state.

use nalgebra::Vector3;

use super::equations::weighted;
use super::race::RaceLoad;
use super::{Boundary, Workspace, race};
use crate::contact::body::BodyContact;
use crate::contact::many::ContactEffect;
use crate::dynamics::state::{BallState, Powers, RaceState, State};
use crate::model::Model;
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::Wrench;

/// [N] residual that is small enough for any bearing (paper section 5).
const FORCE_TOLERANCE: f64 = 1e-6;
/// [-] residual over the largest contact load that is small enough: nine digits of the load.
const RELATIVE_TOLERANCE: f64 = 1e-9;
/// [-] units of round-off that positions put into forces through the stiffest contact: 1100 m from the origin Newton's
/// method still reached one unit in every step (tests/hard_cases/extremes.rs); the rest is margin.
const ROUND_OFF_UNITS: f64 = 10.0;

/// Takes over a solved step.
pub fn accept(model: &Model, state: &mut State, boundary: &Boundary, step: &HhtStep, workspace: &Workspace) {
    state.time = boundary.time;
    state.statistics.steps += 1;
    let land = model.cage.as_ref().and_then(|cage| cage.land);
    for (ball, trial) in state.balls.iter_mut().zip(&workspace.balls) {
        *ball = BallState {
            position: trial.motion.position,
            velocity: trial.motion.velocity,
            angular_velocity: trial.motion.angular_velocity,
            acceleration: trial.unknowns.fixed_rows::<3>(0).into_owned(),
            angular_acceleration: trial.unknowns.fixed_rows::<3>(3) / model.bearing.ball.radius,
            total: trial.total,
        };
    }
    for race in 0..2 {
        let before = &state.races[race];
        let (turned, spin) = ((before.turned, before.turned_rest), before.rate.x);
        match &workspace.races[race] {
            Some(trial) => state.races[race].clone_from(&trial.end),
            None => {
                let (pose, twist) = &boundary.motion[race];
                let mut wrench = bearing_wrench(workspace.balls.iter().map(|ball| &ball.contacts[race]));
                if let (Some(land), Some(cage)) = (land, &workspace.cage)
                    && land.race == race
                {
                    wrench = add_reaction(&wrench, cage.lands.iter().flatten());
                }
                state.races[race] = RaceState::new(*pose, twist, 0);
                state.races[race].bearing_wrench = wrench;
            }
        }
        let angle = 0.5 * step.h * (spin + state.races[race].rate.x);
        state.races[race].count_turn(turned, angle);
    }
    let mut powers = Powers::default();
    if let (Some(cage), Some(trial)) = (&mut state.cage, &workspace.cage) {
        let (turned, spin) = (cage.turned, cage.rate.x);
        cage.clone_from(&trial.body.end);
        cage.turned = turned + 0.5 * step.h * (spin + cage.rate.x);
        powers.input += trial.body.input_power;
        trial.lands.iter().flatten().for_each(|contact| powers.add(contact));
    }
    for ball in &workspace.balls {
        for contact in &ball.contacts {
            powers.friction += contact.friction_power;
            powers.damping += contact.damping_power;
        }
        ball.pocket.iter().for_each(|(contact, _)| powers.add(contact));
        powers.input += model.bearing.ball.mass * model.gravity.dot(&ball.motion.velocity);
    }
    for (trial, race) in workspace.races.iter().zip(&state.races) {
        powers.input += match trial {
            Some(trial) => trial.input_power,
            None => -race.twist().power(&race.bearing_wrench),
        };
    }
    state.energies.add(&state.powers, &powers, step.h);
    state.powers = powers;
    let contacts = workspace.balls.iter().flat_map(|ball| &ball.contacts);
    state.force_tolerance = force_tolerance(contacts, reach(model, state));
}

/// [m] largest coordinate of a ball to expect: its last digit is what contacts cannot resolve.
fn reach(model: &Model, state: &State) -> f64 {
    state.races.iter().fold(0.0f64, |far, race| far.max(race.pose.position.amax())) + model.race_length()
}

/// [N] residual below which nothing but rounding remains: nine digits of the largest load, or a last digit of a
/// coordinate times the stiffness `dQ/dx` of the stiffest contact.
fn force_tolerance<'a>(contacts: impl Iterator<Item = &'a ContactEffect>, reach: f64) -> f64 {
    // `dQ/dx = 1.5 K^(2/3) Q^(1/3)`; the root is taken once, of the largest
    let (mut load, mut cube) = (0.0f64, 0.0f64);
    for contact in contacts {
        load = load.max(contact.load);
        cube = cube.max(contact.stiffness * contact.stiffness * contact.load);
    }
    let stiffness = 1.5 * cube.cbrt();
    let round_off = ROUND_OFF_UNITS * f64::EPSILON * stiffness * reach;
    FORCE_TOLERANCE.max(RELATIVE_TOLERANCE * load).max(round_off)
}

/// Solves Kalker's polynomials anew where the creepages of a contact have moved.
pub fn renew_polynomials(model: &Model, state: &mut State, friction: f64) {
    let contacts = [0, 1].map(|race| model.contact(race, friction));
    for (ball, differences) in state.balls.iter().zip(&mut state.differences) {
        for race in 0..2 {
            let Some(kalker) = model.polynomials(race) else {
                continue;
            };
            let contact = contacts[race].evaluate(&ball.motion(), &state.races[race].motion());
            match contacts[race].renew(kalker, &contact, model.epsilon_switch, &mut differences[race]) {
                Ok(solved) => state.statistics.polynomials += u64::from(solved),
                Err(_) => state.statistics.polynomial_failures += 1,
            }
        }
    }
}

/// Sum of the contacts' effect on a race.
pub fn bearing_wrench<'a>(contacts: impl Iterator<Item = &'a ContactEffect>) -> Wrench {
    contacts.fold(Wrench::default(), |sum, contact| Wrench {
        force: sum.force - contact.force,
        moment: sum.moment + contact.race_moment,
    })
}

/// Adds what contacts exert on their second body.
fn add_reaction<'a>(wrench: &Wrench, contacts: impl Iterator<Item = &'a BodyContact<f64>>) -> Wrench {
    contacts.fold(*wrench, |sum, contact| Wrench {
        force: sum.force - contact.force,
        moment: sum.moment + contact.other_moment,
    })
}

impl Powers {
    fn add(&mut self, contact: &BodyContact<f64>) {
        self.friction += contact.friction_power;
        self.damping += contact.damping_power;
    }
}

/// Makes a state consistent: forces of the present motion, accelerations and multipliers that they ask for.
///
/// Multipliers hold the constrained directions still (or at the given rate of the spin speed [rad/s2]).
pub fn make_consistent(model: &Model, state: &mut State, boundary: &Boundary) {
    let contacts = [0, 1].map(|race| model.contact(race, boundary.friction));
    let races = [0, 1].map(|race: usize| state.races[race].motion());
    renew_polynomials(model, state, boundary.friction);
    let ball_model = &model.bearing.ball;
    let mut powers = Powers::default();
    let mut wrenches = [Wrench::default(); 2];
    let mut all_contacts = Vec::with_capacity(2 * state.balls.len());
    let cage = model.cage.as_ref().zip(state.cage.as_ref().map(RaceState::body_motion));
    let mut on_cage = Wrench::default();
    if let Some((cage_model, motion)) = &cage
        && let Some(land) = &cage_model.land
    {
        for contact in cage_model.land_contacts(motion, races.each_ref()).iter().flatten() {
            on_cage.force += contact.force;
            on_cage.moment += contact.moment;
            wrenches[land.race] = add_reaction(&wrenches[land.race], std::iter::once(contact));
            powers.add(contact);
        }
    }
    for (index, ball) in state.balls.iter_mut().enumerate() {
        ball.total = Wrench { force: model.gravity * ball_model.mass, moment: Vector3::zeros() };
        powers.input += ball_model.mass * model.gravity.dot(&ball.velocity);
        for race in 0..2 {
            let contact = contacts[race]
                .of_ball(state.differences.get(index).map(|of_ball| &of_ball[race]))
                .evaluate(&ball.motion(), &races[race]);
            ball.total.force += contact.force;
            ball.total.moment += contact.ball_moment;
            powers.friction += contact.friction_power;
            powers.damping += contact.damping_power;
            wrenches[race].force -= contact.force;
            wrenches[race].moment += contact.race_moment;
            all_contacts.push(ContactEffect::from(&contact));
        }
        let pocket =
            cage.as_ref().and_then(|(cage, motion)| cage.pocket_contact(index, &ball.motion(), motion));
        if let Some(contact) = &pocket {
            ball.total.force += contact.force;
            ball.total.moment += contact.moment;
            on_cage = add_reaction(&on_cage, std::iter::once(contact));
            powers.add(contact);
        }
        ball.acceleration = ball.total.force / ball_model.mass;
        ball.angular_acceleration = ball.total.moment / ball_model.inertia;
    }
    if let (Some(cage), Some(state)) = (&model.cage, &mut state.cage) {
        state.bearing_wrench = on_cage;
        let load = weighted(&RaceLoad::default(), &cage.body, &model.gravity);
        powers.input += race::make_consistent(state, &cage.body, &load);
    }
    for race in 0..2 {
        let state = &mut state.races[race];
        state.bearing_wrench = wrenches[race];
        powers.input += match &model.bodies[race] {
            Some(body) => {
                let load = weighted(&boundary.loads[race], body, &model.gravity);
                race::make_consistent(state, body, &load)
            }
            None => -state.twist().power(&wrenches[race]),
        };
    }
    state.powers = powers;
    state.force_tolerance = force_tolerance(all_contacts.iter(), reach(model, state));
}
