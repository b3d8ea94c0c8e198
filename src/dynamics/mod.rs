//! One implicit step of the whole bearing: Newton's equations of balls and race bodies under the HHT scheme.

mod ball;
mod blame;
mod cage;
mod neighbour;
mod race;

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use crate::arrowhead::{Arrowhead, BLOCK, BODIES, BallBlock};
use crate::contact::body::BodyContact;
use crate::contact::{BallRaceContact, ContactModel};
use crate::hht::HhtStep;
use crate::model::{CAGE, Constraint, Model, RaceBody};
use crate::motion::{Pose, Twist, Wrench};
use crate::newton::{self, Equations, NewtonBuffers, NewtonFailure};
use crate::scalar::constant_vector;
use crate::state::{BallState, Powers, RaceState, State, race_motion};
use ball::{BallTrial, RaceReaction, RaceSeen, Surroundings};
pub use blame::{Partner, to_blame};
use cage::CageTrial;
pub use neighbour::follow;
pub use race::RaceLoad;
use race::{RaceScales, RaceTrial};

/// [N] residual that is small enough for any bearing (paper section 5).
const FORCE_TOLERANCE: f64 = 1e-6;
/// [-] residual over the largest contact load that is small enough: nine digits of the load.
const RELATIVE_TOLERANCE: f64 = 1e-9;
/// [-] units of round-off that positions put into forces through the stiffest contact.
const ROUND_OFF_UNITS: f64 = 50.0;
/// [-] accepted violation of position constraints over the ball diameter (paper section 5: 1e-8).
const CONSTRAINT_TOLERANCE: f64 = 1e-8;

/// What is imposed at the end of a step.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// [s] end of the step.
    pub time: f64,
    /// Pose and twist of races with prescribed motion; ignored for bodies.
    pub motion: [(Pose, Twist); 2],
    /// Load and speed of race bodies; ignored for the others.
    pub loads: [RaceLoad; 2],
    /// [-] friction coefficient of the ball-race contacts.
    pub friction: f64,
}

/// Buffers of a step, kept between steps; they carry no state.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    balls: Vec<BallTrial>,
    races: [Option<RaceTrial>; 2],
    cage: Option<CageTrial>,
    arrowhead: Arrowhead,
    border: DMatrix<f64>,
    ball_corrections: Vec<Vector6<f64>>,
    border_correction: DVector<f64>,
    unknowns: Vec<f64>,
    newton: NewtonBuffers,
}

/// The equations of one trial step.
struct BearingStep<'a> {
    model: &'a Model,
    contacts: [ContactModel<'a>; 2],
    start: &'a State,
    step: HhtStep,
    boundary: &'a Boundary,
    seen: [RaceSeen; 2],
    force_tolerance: f64,
    workspace: &'a mut Workspace,
    contact_values: u64,
    contact_tangents: u64,
    fresh: bool,
}

/// Why a step was not taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepFailure {
    /// Newton's method gave up; the ball with the largest residual is named.
    Newton(NewtonFailure, usize),
    /// The local error is too large; the ball with the largest share is named.
    Error(usize),
}

/// Tries one step of `h` [s]. On success the state is the new one; otherwise only its statistics and step control
/// have changed.
///
/// # Errors
/// See [`StepFailure`]; the step control has then been told.
pub fn try_step(
    model: &Model,
    state: &mut State,
    boundary: &Boundary,
    h: f64,
    workspace: &mut Workspace,
) -> Result<(), StepFailure> {
    let mut buffers = std::mem::take(&mut workspace.newton);
    let mut unknowns = std::mem::take(&mut workspace.unknowns);
    let mut statistics = state.statistics;
    let mut equations = BearingStep::new(model, state, boundary, h, workspace);
    equations.predict(&mut unknowns);
    let mut solved = newton::solve(&mut equations, &mut unknowns, &mut buffers, &mut statistics.newton);
    if solved.is_err() {
        statistics.second_guesses += 1;
        equations.predict_steady(&mut unknowns);
        solved = newton::solve(&mut equations, &mut unknowns, &mut buffers, &mut statistics.newton);
    }
    statistics.contact_values += equations.contact_values;
    statistics.contact_tangents += equations.contact_tangents;
    let worst = equations.worst_ball();
    let step = equations.step;
    let (error, erring) = equations.local_error();
    workspace.newton = buffers;
    workspace.unknowns = unknowns;
    state.statistics = statistics;
    if let Err(failure) = solved {
        state.statistics.rejected_newton += 1;
        state.control.fail();
        return Err(StepFailure::Newton(failure, worst));
    }
    if !state.control.judge(error) {
        state.statistics.rejected_error += 1;
        return Err(StepFailure::Error(erring));
    }
    accept(model, state, boundary, &step, workspace);
    let contacts = workspace.balls.iter().map(|ball| &ball.contacts);
    renew_polynomials(model, state, boundary.friction, contacts);
    Ok(())
}

impl<'a> BearingStep<'a> {
    fn new(
        model: &'a Model,
        start: &'a State,
        boundary: &'a Boundary,
        h: f64,
        workspace: &'a mut Workspace,
    ) -> Self {
        let contacts = [0, 1].map(|race| model.contact(race, boundary.friction));
        let seen = [0, 1].map(|race: usize| {
            let (pose, twist) = &boundary.motion[race];
            RaceSeen::Prescribed(race_motion(pose, twist))
        });
        if workspace.balls.len() != start.balls.len() {
            let seen_values = [seen[0].value(), seen[1].value()];
            workspace.balls =
                start.balls.iter().map(|ball| BallTrial::new(ball, &contacts, seen_values)).collect();
        }
        for race in 0..2 {
            workspace.races[race] =
                model.bodies[race].as_ref().map(|body| RaceTrial::new(body, &start.races[race]));
        }
        let cage = model.cage.as_ref().zip(start.cage.as_ref());
        workspace.cage = cage.map(|(cage, state)| CageTrial::new(cage, state));
        Self {
            model,
            contacts,
            start,
            step: HhtStep::new(model.solver.alpha_f, h),
            boundary,
            seen,
            force_tolerance: start.force_tolerance,
            workspace,
            contact_values: 0,
            contact_tangents: 0,
            fresh: true,
        }
    }

    /// First guess: accelerations and multipliers stay as they are.
    fn predict(&self, unknowns: &mut Vec<f64>) {
        unknowns.clear();
        for ball in &self.start.balls {
            unknowns.extend(ball.acceleration.iter());
            unknowns.extend(ball.angular_acceleration.iter().map(|a| a * self.model.bearing.ball.radius));
        }
        let length = self.model.race_length();
        let races = self.start.races.iter().zip(self.model.bodies.iter().map(Option::as_ref));
        let cage =
            self.start.cage.iter().zip(std::iter::once(self.model.cage.as_ref().map(|cage| &cage.body)));
        for (state, body) in races.chain(cage) {
            if let Some(body) = body {
                unknowns.extend(state.acceleration.iter());
                unknowns.extend(state.rate_derivative.iter().map(|a| a * length));
                let scales = body.constraints.iter().map(|c| multiplier_scale(c, length));
                unknowns.extend(state.multipliers.iter().zip(scales).map(|(m, scale)| m / scale));
            }
        }
    }

    /// Second guess, where the first led nowhere: everything keeps its velocity over the step, but for the spin of
    /// race bodies, which is prescribed.
    ///
    /// An acceleration that lasts for less than a step throws contacts far into sliding, where friction hardly depends
    /// on the velocity and Newton's method finds no way back.
    fn predict_steady(&self, unknowns: &mut Vec<f64>) {
        self.predict(unknowns);
        let back = -(1.0 - self.step.gamma) / self.step.gamma;
        let (balls, border) = unknowns.split_at_mut(BLOCK * self.start.balls.len());
        balls.iter_mut().for_each(|a| *a *= back);
        for (body, offset) in self.model.border_offsets().into_iter().enumerate() {
            if let Some(offset) = offset {
                border[offset..offset + BLOCK].iter_mut().for_each(|a| *a *= back);
                if body != CAGE {
                    let gained = self.boundary.loads[body].speed - self.start.races[body].rate.x;
                    border[offset + 3] += gained / self.step.velocity_gain() * self.model.race_length();
                }
            }
        }
    }

    fn worst_ball(&self) -> usize {
        let norms = self.workspace.balls.iter().map(|ball| ball.residual.amax());
        // A residual that is not a number is the worst.
        let worse = |a: f64, b: f64| if a.is_nan() { true } else { a > b };
        let mut worst = (0, f64::NEG_INFINITY);
        for (index, norm) in norms.enumerate() {
            if worse(norm, worst.1) {
                worst = (index, norm);
            }
        }
        worst.0
    }

    /// Weighted root mean square of the local error of all positions, over its tolerance; and the ball with the
    /// largest share. Rotations count as displacements at the ball's surface and at the pitch circle.
    fn local_error(&self) -> (f64, usize) {
        let ball_radius = self.model.bearing.ball.radius;
        let scale = self.model.solver.tolerance * 2.0 * ball_radius;
        let (mut sum, mut count) = (0.0, 0.0);
        let mut worst = (0, -1.0);
        for (index, (start, trial)) in self.start.balls.iter().zip(&self.workspace.balls).enumerate() {
            let acceleration = trial.unknowns.fixed_rows::<3>(0).into_owned();
            let angular: Vector3<f64> = trial.unknowns.fixed_rows::<3>(3).into_owned();
            let translation = self.step.local_error(&start.acceleration, &acceleration);
            let rotation = self.step.local_error(&(start.angular_acceleration * ball_radius), &angular);
            let square = (translation.norm_squared() + rotation.norm_squared()) / (scale * scale);
            if square > worst.1 {
                worst = (index, square);
            }
            sum += square;
            count += 6.0;
        }
        let length = self.model.race_length();
        let races = self.start.races.iter().zip(self.workspace.races.iter().map(Option::as_ref));
        let cage = self.workspace.cage.as_ref().map(|cage| &cage.body);
        for (start, trial) in races.chain(self.start.cage.iter().zip(std::iter::once(cage))) {
            if let Some(trial) = trial {
                let translation = self.step.local_error(&start.acceleration, &trial.end.acceleration);
                let angular = trial.end.rate_derivative * length;
                let rotation = self.step.local_error(&(start.rate_derivative * length), &angular);
                sum += (translation.norm_squared() + rotation.norm_squared()) / (scale * scale);
                count += 6.0;
            }
        }
        ((sum / count).sqrt(), worst.0)
    }
}

/// The larger of two norms; `max` would drop a NaN.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// A multiplier's unknown is a force: moments are divided by the race length.
fn multiplier_scale(constraint: &Constraint, length: f64) -> f64 {
    if matches!(constraint, Constraint::Position(..)) { 1.0 } else { length }
}

impl Equations for BearingStep<'_> {
    fn residual(&mut self, unknowns: &[f64], with_tangent: bool) -> f64 {
        let length = self.model.race_length();
        let offsets = self.model.border_offsets();
        let border_start = BLOCK * self.start.balls.len();
        let mut bearing = [RaceReaction::zero(); 2];
        let mut pockets = RaceReaction::zero();

        // race bodies first: the balls see them move
        for race in 0..2 {
            if let (Some(trial), Some(offset)) = (&mut self.workspace.races[race], offsets[race]) {
                let rows = self.model.border_rows(race);
                let from = border_start + offset;
                trial.move_to(&unknowns[from..from + rows], &self.start.races[race], &self.step, length);
                self.seen[race] = trial.seen;
            }
        }
        if let (Some(cage), Some(offset)) = (&mut self.workspace.cage, offsets[CAGE]) {
            let (from, start) = (border_start + offset, self.start.cage.as_ref());
            if let Some(start) = start {
                cage.move_to(&unknowns[from..from + BLOCK], start, &self.step, length);
            }
        }

        // balls; under prescribed races one whose unknowns did not change keeps its last evaluation
        let independent = offsets == [None; BODIES];
        let around = Surroundings {
            model: self.model,
            contacts: &self.contacts,
            differences: &self.start.differences,
            races: &self.seen,
            cage: self.model.cage.as_ref().zip(self.workspace.cage.as_ref()),
        };
        let mut norm = 0.0f64;
        for (j, trial) in self.workspace.balls.iter_mut().enumerate() {
            let unknown = Vector6::from_row_slice(&unknowns[BLOCK * j..BLOCK * (j + 1)]);
            if with_tangent || self.fresh || !independent || unknown != trial.unknowns {
                trial.unknowns = unknown;
                let start = &self.start.balls[j];
                trial.evaluate(j, &around, &self.step, start, with_tangent);
                if with_tangent {
                    self.contact_tangents += 2;
                } else {
                    self.contact_values += 2;
                }
            }
            norm = worse(norm, trial.residual.amax() / self.force_tolerance);
            for race in 0..2 {
                if let Some(race_trial) = &self.workspace.races[race] {
                    let reaction = match &trial.reactions[race] {
                        Some(reaction) => *reaction,
                        None => RaceReaction::constant(&trial.contacts[race]),
                    };
                    bearing[race].add(&reaction);
                    if with_tangent {
                        trial.block.left[race] = race_trial.coupling(&reaction, &self.step, length);
                    }
                }
            }
            if let (Some((_, reaction)), Some(cage)) = (&trial.pocket, &self.workspace.cage) {
                pockets.add(reaction);
                if with_tangent {
                    trial.block.left[CAGE] = cage.body.coupling(reaction, &self.step, length);
                }
            }
        }
        self.fresh = false;

        // cage
        if let (Some(model), Some(cage), Some(start)) =
            (&self.model.cage, &mut self.workspace.cage, &self.start.cage)
        {
            let lands = cage.touch_lands(model, &self.seen, &self.step, with_tangent);
            for (race, on_race, on_cage) in lands.into_iter().flatten() {
                bearing[race].add(&on_race);
                pockets.add(&on_cage);
                if let (true, Some(race)) = (with_tangent, &self.workspace.races[race]) {
                    cage.race_by_cage += race.coupling(&on_race, &self.step, length);
                    cage.cage_by_race += cage.body.coupling(&on_cage, &self.step, length);
                }
            }
            let load = weighted(&RaceLoad::default(), &model.body, &self.model.gravity);
            let scales = RaceScales { length, length_tolerance: f64::INFINITY, time: self.boundary.time };
            cage.body.assemble(&model.body, start, &load, &pockets, &self.step, &scales);
            norm = worse(norm, cage.body.residual.amax() / self.force_tolerance);
        }

        // race bodies
        let scales = RaceScales {
            length,
            length_tolerance: CONSTRAINT_TOLERANCE * 2.0 * self.model.bearing.ball.radius,
            time: self.boundary.time,
        };
        for race in 0..2 {
            if let (Some(trial), Some(body)) = (&mut self.workspace.races[race], &self.model.bodies[race]) {
                let load = weighted(&self.boundary.loads[race], body, &self.model.gravity);
                let start = &self.start.races[race];
                trial.assemble(body, start, &load, &bearing[race], &self.step, &scales);
                norm = worse(norm, trial.residual.rows(0, 6).amax() / self.force_tolerance);
                norm = worse(norm, trial.violation);
            }
        }

        if with_tangent {
            self.factorise();
        }
        norm
    }

    fn correction(&mut self, correction: &mut [f64]) -> bool {
        let offsets = self.model.border_offsets();
        let independent = offsets == [None; BODIES];
        let workspace = &mut *self.workspace;
        workspace.ball_corrections.clear();
        for trial in &workspace.balls {
            // A ball that is solved already, and that nothing else can disturb, stays where it is.
            let done = independent && trial.residual.amax() <= self.force_tolerance;
            workspace.ball_corrections.push(if done { Vector6::zeros() } else { -trial.residual });
        }
        let rows = self.model.border_size();
        workspace.border_correction.resize_vertically_mut(rows, 0.0);
        for race in 0..2 {
            if let (Some(trial), Some(offset)) = (&workspace.races[race], offsets[race]) {
                let rows = trial.residual.len();
                workspace.border_correction.rows_mut(offset, rows).copy_from(&-&trial.residual);
            }
        }
        if let (Some(cage), Some(offset)) = (&workspace.cage, offsets[CAGE]) {
            workspace.border_correction.rows_mut(offset, BLOCK).copy_from(&-&cage.body.residual);
        }
        let solved = workspace.arrowhead.solve(
            &mut workspace.ball_corrections,
            &mut workspace.border_correction,
            offsets,
        );
        let (balls, border) = correction.split_at_mut(BLOCK * workspace.balls.len());
        for (chunk, x) in balls.chunks_exact_mut(BLOCK).zip(&workspace.ball_corrections) {
            chunk.copy_from_slice(x.as_slice());
        }
        border.copy_from_slice(workspace.border_correction.as_slice());
        solved
    }

    fn refactor_contraction(&self) -> f64 {
        self.model.solver.matrix_reuse
    }
}

impl BearingStep<'_> {
    fn factorise(&mut self) {
        let offsets = self.model.border_offsets();
        let rows = self.model.border_size();
        let workspace = &mut *self.workspace;
        workspace.border.resize_mut(rows, rows, 0.0);
        workspace.border.fill(0.0);
        for race in 0..2 {
            if let (Some(trial), Some(offset)) = (&workspace.races[race], offsets[race]) {
                let rows = trial.residual.len();
                workspace.border.view_mut((offset, offset), (rows, rows)).copy_from(&trial.block);
            }
        }
        if let (Some(cage), Some(offset)) = (&workspace.cage, offsets[CAGE]) {
            let size = (BLOCK, BLOCK);
            workspace.border.view_mut((offset, offset), size).copy_from(&cage.body.block);
            let guide = self.model.cage.as_ref().and_then(|cage| cage.land).map(|land| offsets[land.race]);
            if let Some(Some(race)) = guide {
                workspace.border.view_mut((race, offset), size).copy_from(&cage.race_by_cage);
                workspace.border.view_mut((offset, race), size).copy_from(&cage.cage_by_race);
            }
        }
        let blocks: Vec<&BallBlock> = workspace.balls.iter().map(|trial| &trial.block).collect();
        workspace.arrowhead.factorise(&blocks, &workspace.border, offsets);
    }
}

/// Adds the weight of a race body to its applied load.
fn weighted(load: &RaceLoad, body: &RaceBody, gravity: &Vector3<f64>) -> RaceLoad {
    let mut load = *load;
    load.applied.force += gravity * body.mass;
    load
}

/// Takes over a solved step.
fn accept(model: &Model, state: &mut State, boundary: &Boundary, step: &HhtStep, workspace: &Workspace) {
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
fn force_tolerance<'a>(contacts: impl Iterator<Item = &'a BallRaceContact<f64>>, reach: f64) -> f64 {
    let (mut load, mut stiffness) = (0.0f64, 0.0f64);
    for contact in contacts {
        load = load.max(contact.load);
        stiffness = stiffness.max(1.5 * contact.stiffness.powf(2.0 / 3.0) * contact.load.cbrt());
    }
    let round_off = ROUND_OFF_UNITS * f64::EPSILON * stiffness * reach;
    FORCE_TOLERANCE.max(RELATIVE_TOLERANCE * load).max(round_off)
}

/// Solves Kalker's polynomials anew where the creepages of a contact have moved.
fn renew_polynomials<'a>(
    model: &Model,
    state: &mut State,
    friction: f64,
    contacts: impl Iterator<Item = &'a [BallRaceContact<f64>; 2]>,
) {
    let contact_models = [0, 1].map(|race| model.contact(race, friction));
    for (differences, contacts) in state.differences.iter_mut().zip(contacts) {
        for race in 0..2 {
            let Some(kalker) = model.polynomials(race) else {
                continue;
            };
            let difference = &mut differences[race];
            match contact_models[race].renew(kalker, &contacts[race], model.epsilon_switch, difference) {
                Ok(solved) => state.statistics.polynomials += u64::from(solved),
                Err(_) => state.statistics.polynomial_failures += 1,
            }
        }
    }
}

/// Sum of the contacts' effect on a race.
pub fn bearing_wrench<'a>(contacts: impl Iterator<Item = &'a BallRaceContact<f64>>) -> Wrench {
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

impl RaceReaction {
    /// What a contact exerts on its second body, without derivatives.
    fn opposite(contact: &BodyContact<f64>) -> Self {
        Self { force: constant_vector(&-contact.force), moment: constant_vector(&contact.other_moment) }
    }

    /// What a contact exerts on its first body, without derivatives.
    fn direct(contact: &BodyContact<f64>) -> Self {
        Self { force: constant_vector(&contact.force), moment: constant_vector(&contact.moment) }
    }

    fn zero() -> Self {
        let zero = constant_vector(&Vector3::zeros());
        Self { force: zero, moment: zero }
    }

    fn constant(contact: &BallRaceContact<f64>) -> Self {
        Self { force: constant_vector(&-contact.force), moment: constant_vector(&contact.race_moment) }
    }

    fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}

/// Makes a state consistent: forces of the present motion, accelerations and multipliers that they ask for.
///
/// Multipliers hold the constrained directions still (or at the given rate of the spin speed [rad/s2]).
pub fn make_consistent(model: &Model, state: &mut State, boundary: &Boundary) {
    let contacts = [0, 1].map(|race| model.contact(race, boundary.friction));
    let races = [0, 1].map(|race: usize| state.races[race].motion());
    if !state.differences.is_empty() {
        let of_ball = |ball: &BallState| {
            [0, 1].map(|race: usize| contacts[race].evaluate(&ball.motion(), &races[race]))
        };
        let ball_contacts: Vec<_> = state.balls.iter().map(of_ball).collect();
        renew_polynomials(model, state, boundary.friction, ball_contacts.iter());
    }
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
            all_contacts.push(contact);
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
