//! From solved equations to the next state, and from a motion to a consistent state.

use nalgebra::Vector3;

use super::group::Groups;
use super::neighbours::NeighbourTrial;
use super::record::record;
use super::spacing;
use super::support::supports_of;
use super::{Boundary, Workspace, body};
use crate::contact::BallMotion;
use crate::contact::many::Touch;
use crate::contact::pair::PairForces;
use crate::effects::ambient::Ambient;
use crate::effects::growth::Grown;
use crate::effects::reports::SupportState;
use crate::forces::{
    BallPair, Contacts, Pairs, Totals, between_cage_and_lands, elastic_energy, kinetic_energy,
    kinetic_energy_of, stored_energy, supports_energy,
};
use crate::model::Model;
use crate::model::bearing::Ball;
use crate::model::bodies::{Body, PerRace, Race};
use crate::model::energies::{Energies, Powers, Pressed};
use crate::model::state::{BallState, BodyState, State, Trend, axes_of};
use crate::numerics::elementary::cbrt;
use crate::numerics::esdirk;
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::Wrench;
use crate::numerics::step_control::LARGEST_CUT;
use crate::schema::Method;

/// \[N] residual that is small enough for any bearing (paper section 5).
const FORCE_TOLERANCE: f64 = 1e-6;
/// [-] residual over the largest contact load that is small enough: nine digits of the load, or eight where the step itself is no better.
const RELATIVE_TOLERANCE: f64 = 1e-9;
const MOST_RELATIVE_TOLERANCE: f64 = 1e-8;
/// [-] residual over the force that makes up for the error of a step: what Newton's method leaves must not show beside that error, nor add up
/// in steps so small that they have next to none (cli/tests/studies/cost_reference.rs).
const SHARE_OF_ERROR: f64 = 1e-3;
/// [-] the same of a stage of a method of several, whose error is that of a method of lower order: with a thirtieth of it (and 1e-8) `scenes/radial.toml` took
/// 1.3 times the evaluations by the same authors' method of four stages, with ten times of it a twentieth fewer, at the same errors to two digits.
const SHARE_OF_STAGES: f64 = 0.09;
const MOST_OF_STAGES: f64 = 1e-5;
/// [-] units of round-off that positions put into forces through the stiffest contact: 1100 m from the origin Newton's
/// method still reached one unit in every step (tests/hard_cases/extremes.rs); the rest is margin.
const ROUND_OFF_UNITS: f64 = 10.0;

/// The pairs of a step that was solved.
struct Solved<'a> {
    workspace: &'a Workspace,
    guide: Option<Race>,
}

impl Pairs for Solved<'_> {
    #[inline(always)]
    fn of_ball(&self, ball: usize, mut see: impl FnMut(Body, &PairForces)) {
        for race in Race::BOTH {
            see(race.into(), &self.workspace.groups.pair(ball, race));
        }
        if let Some(pair) = &self.workspace.balls[ball].pocket {
            see(Body::Cage, pair);
        }
    }

    fn between_balls(&self) -> impl Iterator<Item = BallPair> {
        self.workspace.neighbours.iter().filter_map(NeighbourTrial::touching)
    }

    fn between_bodies(&self) -> impl Iterator<Item = (Body, Body, PairForces)> {
        let cage = self.workspace.cage.as_ref();
        cage.into_iter().flat_map(|cage| between_cage_and_lands(self.guide, &cage.lands))
    }
}

/// The end of a solved step: sums over its pairs, powers and stored energy.
pub struct StepEnd {
    totals: Totals,
    powers: Powers,
    /// Energies at the end.
    energies: Energies,
    /// Flexible supports of the races.
    supports: PerRace<Option<SupportState>>,
}

impl StepEnd {
    /// Energies of the step of `h` \[s] from a state that was solved with this workspace; with the powers of its stages before the end in
    /// their mean, or none where the trapezoidal rule holds.
    pub fn new(
        model: &Model,
        (state, stages): (&State, Option<&Powers>),
        boundary: &Boundary,
        h: f64,
        workspace: &Workspace,
    ) -> Self {
        let solved = Solved { workspace, guide: model.cage_guide() };
        let n_balls = workspace.balls.len();
        let mut totals = Totals::of(&solved, n_balls);
        if let (Some(spacing), Some(trial)) = (&model.spacing, &workspace.spacing) {
            let places = (0..n_balls).map(|ball| workspace.groups.position(ball));
            totals.add(Race::Outer.into(), spacing::on_guide(spacing, &trial.end, places));
        }
        let motions = || (0..n_balls).map(|ball| workspace.groups.motion(ball));
        let (powers, supports) = powers_of(model, boundary, &totals, workspace);
        let stiffened = |(index, ball): (usize, &BallState)| {
            let now = |race| Pressed::new(&workspace.groups.pair(index, race)).stiffened(&ball.pressed[race]);
            now(Race::Inner) + now(Race::Outer)
        };
        let stiffened = state.balls.iter().enumerate().map(stiffened);
        let mut energies = state.energies;
        let stiffened = stiffened.fold(0.0, |sum, work| sum + work);
        let left = match stages {
            None => energies.add((&state.powers, &powers), h, stiffened),
            Some(stages) => {
                let mut mean = *stages;
                mean.add_part(esdirk::DIAGONAL, &powers);
                energies.add_mean(&mean, h, stiffened)
            }
        };
        if model.solver.energy_error > 0.0 {
            let bodies = model.bodies.iter().zip(workspace.bodies.iter());
            let moved =
                bodies.filter_map(|((_, body), (_, trial))| Some((body.as_ref()?, &trial.as_ref()?.end)));
            let stored = kinetic_energy(model, motions(), moved)
                + elastic_energy(model, &solved, n_balls)
                + supports_energy(&supports);
            energies.close(left, stored);
        }
        Self { totals, powers, energies, supports }
    }

    /// [-] error of the step by the energy that it leaves unaccounted for; 0 where nothing is asked for.
    pub fn energy_error(
        &self,
        model: &Model,
        state: &State,
        boundary: &Boundary,
        h: f64,
        workspace: &Workspace,
    ) -> f64 {
        let solver = &model.solver;
        // The work of growth is known of an accepted step alone.
        let grows = state.grown.is_some_and(|grown| grown.warmth != boundary.conditions.warmth);
        // A step that is cut for its energy must not end the run.
        let shortest = solver.energy_step.0.max(solver.min_step.0 / LARGEST_CUT);
        if solver.energy_error == 0.0 || h <= shortest || grows {
            return 0.0;
        }
        let ball = &model.bearing.ball;
        let of_ball = |(index, state): (usize, &BallState)| {
            let now = kinetic_energy_of(ball, &workspace.groups.motion(index));
            (now - kinetic_energy_of(ball, &state.motion())).abs()
        };
        // What comes and goes excuses only steps that follow all of it.
        let exchanged = || match solver.unresolved > 0.0 {
            true => 0.0,
            false => state.balls.iter().enumerate().map(of_ball).fold(0.0, |sum, energy| sum + energy),
        };
        self.energies.error_since(&state.energies, exchanged, solver.energy_error)
    }
}

/// Powers at the end of a step, or of a stage of one, that was solved with this workspace, and the supports of the races there.
fn powers_of(
    model: &Model,
    boundary: &Boundary,
    totals: &Totals,
    workspace: &Workspace,
) -> (Powers, PerRace<Option<SupportState>>) {
    let motions = || (0..workspace.balls.len()).map(|ball| workspace.groups.motion(ball));
    let ambient = model.ambient(&boundary.frame);
    let mut powers = Powers {
        input: power_into_balls(&ambient, motions()),
        friction: totals.friction_power,
        damping: totals.damping_power,
        around: power_lost_around(&ambient, motions()),
    };
    for (body, trial) in workspace.bodies.iter() {
        match (body, trial) {
            (_, Some(trial)) => powers.input += trial.input_power,
            (Body::Race(race), None) => {
                powers.input -= boundary.motion[race].1.power(&totals.on(body));
            }
            // A cage is moved by forces alone.
            (Body::Cage, None) => {}
        }
    }
    let of_race = |race: Race| workspace.bodies[race].as_ref().map(|trial| &trial.end);
    let supports = supports_of(model, of_race, boundary, &mut powers);
    (powers, supports)
}

/// Powers at the end of a stage that was solved with this workspace.
pub(super) fn powers_of_stage(model: &Model, boundary: &Boundary, workspace: &Workspace) -> Powers {
    let solved = Solved { workspace, guide: model.cage_guide() };
    let totals = Totals::of(&solved, workspace.balls.len());
    powers_of(model, boundary, &totals, workspace).0
}

/// Takes over a solved step of `h` \[s] that ends like this.
pub fn accept(
    model: &Model,
    state: &mut State,
    boundary: &Boundary,
    (h, step): (f64, &HhtStep),
    (workspace, end): (&Workspace, &StepEnd),
) {
    let error = workspace.force_of_error(&state.balls, &model.bearing.ball, step);
    state.time = boundary.time;
    state.statistics.steps += 1;
    for (index, ball) in state.balls.iter_mut().enumerate() {
        workspace.groups.end(index, model.bearing.ball.radius, ball);
    }
    for ((body, state), (_, trial)) in state.bodies.iter_mut().zip(workspace.bodies.iter()) {
        let (turned, spin) = ((state.turned, state.turned_rest), state.rate.x);
        match (body, trial) {
            (_, Some(trial)) => {
                state.copy_from(&trial.end);
                state.angular_velocity = trial.turn.angular_velocity;
                state.axes = match (body, &workspace.cage) {
                    (Body::Cage, Some(cage)) => cage.value.axes,
                    _ => {
                        let [_, y, z] = axes_of(&trial.end.pose.orientation);
                        [trial.turn.axis, y, z]
                    }
                };
            }
            (Body::Race(race), None) => {
                let (pose, twist) = &boundary.motion[race];
                *state = BodyState::new(*pose, twist, 0);
                state.angular_velocity = twist.angular_velocity;
                state.bearing_wrench = end.totals.on(body);
            }
            // A cage is moved by forces alone.
            (Body::Cage, None) => {}
        }
        state.count_turn(turned, 0.5 * h * (spin + state.rate.x));
    }
    state.spacing = workspace.spacing.as_ref().map(|trial| trial.end.clone());
    state.orientations.clone_from(&boundary.orientations);
    state.supports = end.supports;
    state.energies = end.energies;
    state.powers = end.powers;
    let solved = Solved { workspace, guide: model.cage_guide() };
    grow(model, state, boundary, |ball, race| workspace.touch(ball, race));
    record(model, state, &solved, &boundary.conditions, Some(h));
    state.force_tolerance =
        force_tolerance(&solved, state.balls.len(), reach(model, state), error, model.solver.method);
}

/// Goes on to what rings and balls have grown by at the end of a step, whose work is put in.
pub(super) fn grow(
    model: &Model,
    state: &mut State,
    boundary: &Boundary,
    touch: impl Fn(usize, Race) -> Touch,
) {
    if let Some(growth) = &model.growth {
        let grown = grown(touch, state, boundary);
        let work = state.grown.map_or(0.0, |before| growth.work(&before, &grown));
        state.energies.put_in(work);
        state.energies.unaccounted += work;
        state.grown = Some(grown);
    }
}

/// Growth of rings and balls, and the forces that these contacts set against it.
fn grown(touch: impl Fn(usize, Race) -> Touch, state: &State, boundary: &Boundary) -> Grown {
    let mut grown = Grown { warmth: boundary.conditions.warmth, ..Grown::default() };
    for ball in 0..state.balls.len() {
        for race in Race::BOTH {
            let Touch { load, normal, radial, .. } = touch(ball, race);
            let direction = [normal.dot(&radial), normal.dot(&state.race(race).axes[0])];
            grown.pushes[race as usize].add(load, direction);
        }
    }
    grown
}

/// \[W] power of weight and moving frame on all balls.
fn power_into_balls(ambient: &Ambient, balls: impl Iterator<Item = BallMotion<f64>>) -> f64 {
    balls.map(|ball| ambient.power_into(&ball)).fold(0.0, |sum, power| sum + power)
}

/// \[W] power that all balls lose to the medium around them.
pub fn power_lost_around(ambient: &Ambient, balls: impl Iterator<Item = BallMotion<f64>>) -> f64 {
    if ambient.medium.is_none() {
        return 0.0;
    }
    balls.map(|ball| ambient.power_lost(&ball)).fold(0.0, |sum, power| sum + power)
}

/// \[m] largest coordinate of a ball to expect: contacts cannot resolve less than its last digit.
fn reach(model: &Model, state: &State) -> f64 {
    let races = Race::BOTH.map(|race| state.race(race).pose.position.amax());
    races[0].max(races[1]) + model.race_length()
}

/// \[N] residual that is small enough after a step of a method with this `error` \[N]: a share of that, within nine and some digits of the largest
/// load; but not below a last digit of a coordinate times the stiffness `dQ/dx` of the stiffest contact, where nothing but rounding remains.
fn force_tolerance(pairs: &impl Pairs, balls: usize, reach: f64, error: f64, method: Method) -> f64 {
    let [share, most] = match method {
        Method::Hht => [SHARE_OF_ERROR, MOST_RELATIVE_TOLERANCE],
        Method::Esdirk3 => [SHARE_OF_STAGES, MOST_OF_STAGES],
    };
    // `dQ/dx = 1.5 K^(2/3) Q^(1/3)`; the root is taken once, of the largest
    let (mut load, mut cube) = (0.0f64, 0.0f64);
    let mut see = |contact: &PairForces| {
        load = load.max(contact.load);
        cube = cube.max(contact.stiffness * contact.stiffness * contact.load);
    };
    for ball in 0..balls {
        pairs.of_ball(ball, |body, contact| {
            if let Body::Race(_) = body {
                see(contact);
            }
        });
    }
    pairs.between_balls().for_each(|pair| see(&pair.forces));
    let stiffness = 1.5 * cbrt(cube);
    let round_off = ROUND_OFF_UNITS * f64::EPSILON * stiffness * reach;
    let of_load = (share * error).max(RELATIVE_TOLERANCE * load).min(most * load);
    FORCE_TOLERANCE.max(of_load).max(round_off)
}

impl Workspace {
    /// \[N] force on a ball that would move it by the local error of a step (root mean square of all balls; rotations count at the surface):
    /// `m (a1 - a0) (beta - alpha_f/2 - 1/6)/beta`.
    fn force_of_error(&self, start: &[BallState], ball: &Ball, step: &HhtStep) -> f64 {
        let square = |(index, state): (usize, &BallState)| {
            if let Some([place, turn]) = self.embedded.get(index) {
                return place + turn;
            }
            let unknowns = self.groups.unknowns(index);
            let change = |from: usize, before: Vector3<f64>| {
                let after = unknowns.fixed_rows::<3>(from).into_owned();
                step.local_error(&before, &after).norm_squared()
            };
            let along =
                self.spacing.as_ref().zip(self.groups.along_orbit(index)).map_or(0.0, |(trial, along)| {
                    let [before, after] = trial.accelerations().map(|turn| along * turn);
                    step.local_error(&before, &after).norm_squared()
                });
            change(0, state.acceleration) + change(3, state.angular_acceleration * ball.radius) + along
        };
        let sum = start.iter().enumerate().map(square).fold(0.0, |sum, square| sum + square);
        ball.mass * (sum / start.len() as f64).sqrt() / step.position_gain()
    }
}

impl Groups {
    /// Writes the state of a ball at the end of the step.
    fn end(&self, ball: usize, radius: f64, state: &mut BallState) {
        let (motion, unknowns) = (self.motion(ball), self.unknowns(ball));
        (state.position, state.velocity) = (motion.position, motion.velocity);
        state.angular_velocity = motion.angular_velocity;
        state.acceleration = unknowns.fixed_rows::<3>(0).into_owned();
        state.angular_acceleration = unknowns.fixed_rows::<3>(3) / radius;
        state.total = self.total(ball);
        state.remainder = self.remainder(ball);
        for race in Race::BOTH {
            state.pressed[race] = Pressed::new(&self.pair(ball, race));
        }
    }
}

/// Solves Kalker's polynomials anew where the creepages of a contact have moved.
pub fn renew_polynomials(model: &Model, state: &mut State, boundary: &Boundary) {
    let State { balls, bodies, differences, statistics, orientations, .. } = state;
    for race in Race::BOTH {
        let Some(kalker) = model.polynomials(race) else {
            continue;
        };
        let model_of_race = model.contact(race, &boundary.conditions).oriented(orientations.as_ref());
        for (index, (ball, differences)) in balls.iter().zip(&mut *differences).enumerate() {
            let contact = model_of_race.of_ball(index, None).evaluate(&ball.motion(), &bodies[race].motion());
            match model_of_race.renew(kalker, &contact, model.epsilon_switch, &mut differences[race]) {
                Ok(solved) => statistics.polynomials += u64::from(solved),
                Err(_) => statistics.polynomial_failures += 1,
            }
        }
    }
}

/// Makes a state consistent: forces of the present motion, accelerations and multipliers that they ask for.
///
/// Multipliers hold the constrained directions still (or at the given rate of the spin speed [rad/s2]).
pub fn make_consistent(model: &Model, state: &mut State, boundary: &Boundary) {
    renew_polynomials(model, state, boundary);
    state.trend = Trend::default();
    let contacts = Contacts::new(model, state, &boundary.conditions);
    take_forces(model, state, boundary, &contacts);
    state.energies.stored = stored_energy(model, state, &contacts);
    let touch = |ball: usize, race: Race| contacts.balls[ball].raceways[race].touch();
    state.grown = model.growth.as_ref().map(|_| grown(touch, state, boundary));
    record(model, state, &contacts, &boundary.conditions, None);
    state.force_tolerance =
        force_tolerance(&contacts, state.balls.len(), reach(model, state), 0.0, model.solver.method);
}

/// Forces of these contacts at the motion that a state has, the accelerations and multipliers that they ask for, and their powers.
pub(super) fn take_forces(model: &Model, state: &mut State, boundary: &Boundary, contacts: &Contacts) {
    let ball_model = &model.bearing.ball;
    let ambient = model.ambient(&boundary.frame);
    for (index, ball) in state.balls.iter_mut().enumerate() {
        ball.total = contacts.on_ball(index, ambient.on_ball(&ball.motion()));
        ball.remainder = Wrench::default();
        ball.pressed =
            PerRace::new(|race| Pressed::new(&PairForces::from(&contacts.balls[index].raceways[race])));
        ball.acceleration = ball.total.force / ball_model.mass;
        ball.angular_acceleration = ball.total.moment / ball_model.inertia;
    }
    let mut totals = Totals::of(contacts, state.balls.len());
    if let Some(spacing) = &model.spacing {
        spacing::make_consistent(spacing, model, state, boundary);
        if let Some(turn) = &state.spacing {
            let places = state.balls.iter().map(|ball| ball.position);
            totals.add(Race::Outer.into(), spacing::on_guide(spacing, turn, places));
        }
    }
    let mut powers = Powers {
        input: power_into_balls(&ambient, state.balls.iter().map(BallState::motion)),
        friction: totals.friction_power,
        damping: totals.damping_power,
        around: power_lost_around(&ambient, state.balls.iter().map(BallState::motion)),
    };
    for ((body, state), (_, moved)) in state.bodies.iter_mut().zip(model.bodies.iter()) {
        state.bearing_wrench = totals.on(body);
        powers.input += match moved {
            Some(moved) => {
                let around = (boundary.flange(model, body), ambient.frame.as_ref());
                body::make_consistent(state, moved, &boundary.load_on(body, moved, &ambient), around)
            }
            None => -state.twist().power(&state.bearing_wrench),
        };
    }
    state.supports = supports_of(model, |race| Some(state.race(race)), boundary, &mut powers);
    state.powers = powers;
}
