//! Stages of a step of a method of higher order ([`crate::numerics::esdirk`]): where each starts from, what is expected of it, and the local
//! error of the step.
//!
//! A stage is a step of backward Euler from what the motions of earlier stages add up to. Places go on with velocities, orientations by the
//! rotation vector of the step, `v' = w + v x w/2 + v x (v x w)/12 + ..` (w in the body's own axes), of which the orders of the method
//! hold. What Newton's method leaves of the equations of all stages is made good by the last.

use nalgebra::{DVector, UnitQuaternion, Vector3};

use super::Boundary;
use super::accept::powers_of_stage;
use super::equations::BearingStep;
use super::guess::{orbit_turns, steady_acceleration};
use super::stage_guess::Known;
use super::system::{Part, StructureLoad, StructureStep, SystemStep};
use crate::model::Model;
use crate::model::bodies::RigidBody;
use crate::model::energies::Powers;
use crate::model::state::{BodyState, State, Trend, normalised};
use crate::model::structure::StructureState;
use crate::numerics::arrowhead::{BLOCK, Six};
use crate::numerics::esdirk::{DIAGONAL, EARLIER, ERROR, PLACES, STAGES, WEIGHTS};
use crate::numerics::motion::Wrench;

/// Where a stage of a step starts from, and what is expected of it.
pub struct Stage<'a> {
    /// Motion that it starts from, by bearing.
    pub starts: &'a [State],
    /// What is expected, by bearing.
    pub foreseen: &'a [Foreseen],
    /// Accelerations that are expected, by structure.
    pub accelerations: &'a [DVector<f64>],
    /// Boundaries at its end; none of the last stage, which ends with the step.
    pub boundaries: Option<&'a [Boundary]>,
}

/// What is expected of a stage of a bearing.
#[derive(Clone, Debug, Default)]
pub struct Foreseen {
    /// First guess of the unknowns.
    pub unknowns: Vec<f64>,
    /// Unknowns, were all to go on as at the start of the step but for the turn of orbits.
    pub steady: Vec<f64>,
}

/// Starts of a stage, lent to its equations.
#[derive(Clone, Debug, Default)]
pub struct Starts {
    /// By bearing.
    pub bearings: Vec<State>,
    /// Expectations by bearing.
    pub foreseen: Vec<Foreseen>,
    /// By structure.
    pub structures: Vec<StructureState>,
    /// Accelerations that are expected of each structure.
    pub accelerations: Vec<DVector<f64>>,
}

impl Starts {
    /// A stage with these boundaries; none of the last.
    pub fn stage<'a>(&'a self, boundaries: Option<&'a [Boundary]>) -> Stage<'a> {
        Stage {
            starts: &self.bearings,
            foreseen: &self.foreseen,
            accelerations: &self.accelerations,
            boundaries,
        }
    }

    /// Structures at the start of a stage, under these loads, or those of the end of the step.
    pub fn structure_steps<'a>(
        &'a self,
        structures: &[StructureStep<'a>],
        loads: Option<&'a [StructureLoad]>,
    ) -> Vec<StructureStep<'a>> {
        let all = structures.iter().zip(&self.structures).enumerate();
        let of = |(index, (one, start)): (usize, (&StructureStep<'a>, &'a StructureState))| {
            let load = loads.map_or(one.load, |loads| &loads[index]);
            StructureStep { start, load, ..*one }
        };
        all.map(of).collect()
    }
}

/// A velocity at a stage, of a place or a turn.
#[derive(Clone, Copy, Debug)]
struct Moving {
    /// Rate of a place [m/s] or of a rotation vector [rad/s].
    rate: Vector3<f64>,
    /// [m/s2, rad/s2] its acceleration, that of a turn material.
    acceleration: Vector3<f64>,
    /// [N, N m] what is left of the equations of motion.
    left: Vector3<f64>,
}

/// A bearing at the stages that were reached.
#[derive(Clone, Debug, Default)]
struct Reached {
    /// Places and turns of balls, then of bodies, by stage.
    moving: [Vec<[Moving; 2]>; STAGES],
    /// Unknowns by stage.
    unknowns: [Vec<f64>; STAGES],
    /// Unknowns of the second stage as the last step has them expected, and as they were at the start.
    expected: Vec<[f64; 2]>,
    /// Powers by stage, but for the last.
    powers: [Powers; STAGES],
}

/// Stages of a step that were reached.
#[derive(Clone, Debug, Default)]
pub struct Stages {
    bearings: Vec<Reached>,
    /// Rates and accelerations of each structure by stage.
    structures: Vec<[[DVector<f64>; 2]; STAGES]>,
}

impl Stages {
    /// Begins a step: its first stage is its start.
    pub fn begin(&mut self, parts: &[Part<'_>], structures: &[StructureStep<'_>], starts: &mut Starts) {
        self.bearings.resize_with(parts.len(), Reached::default);
        starts.foreseen.resize_with(parts.len(), Foreseen::default);
        starts.bearings.truncate(parts.len());
        for (index, (part, reached)) in parts.iter().zip(&mut self.bearings).enumerate() {
            reached.begin(part.model, part.state);
            match starts.bearings.get_mut(index) {
                Some(start) => start.copy_from(part.state),
                None => starts.bearings.push(State::clone(part.state)),
            }
        }
        let first = |one: &StructureStep<'_>| {
            let at = || [one.start.rates.clone(), one.start.accelerations.clone()];
            std::array::from_fn(|_| at())
        };
        self.structures = structures.iter().map(first).collect();
        starts.structures = structures.iter().map(|one| one.start.clone()).collect();
        starts.accelerations = structures.iter().map(|one| one.start.accelerations.clone()).collect();
    }

    /// Puts the starts of a stage of a step of `h` \[s].
    pub fn prepare(
        &mut self,
        stage: usize,
        (parts, structures): (&[Part<'_>], &[StructureStep<'_>]),
        h: f64,
        starts: &mut Starts,
    ) {
        let Starts { bearings, foreseen, structures: of_structures, accelerations } = starts;
        for (((part, reached), start), foreseen) in
            parts.iter().zip(&mut self.bearings).zip(bearings).zip(foreseen)
        {
            reached.place(stage, (part.model, part.state), h, start);
            reached.foresee(stage, part.state, h, foreseen);
        }
        let structures = structures.iter().zip(&self.structures);
        for (((one, reached), start), expected) in structures.zip(of_structures).zip(accelerations) {
            let mut sums = [one.start.coordinates.clone(), one.start.rates.clone()];
            for (part, at) in EARLIER[stage].iter().zip(reached) {
                sums.iter_mut().zip(at).for_each(|(sum, of)| sum.axpy(part * h, of, 1.0));
            }
            [start.coordinates, start.rates] = sums;
            start.accelerations.fill(0.0);
            expected.fill(0.0);
            for (weight, at) in Known::new(stage, None).new.iter().zip(reached) {
                expected.axpy(*weight, &at[1], 1.0);
            }
        }
    }

    /// Takes over a stage that was solved.
    pub fn reach(&mut self, stage: usize, equations: &SystemStep<'_>, unknowns: &[f64]) {
        let mut rest = unknowns;
        for (reached, step) in self.bearings.iter_mut().zip(&equations.bearings) {
            let (own, others) = rest.split_at(step.size());
            rest = others;
            reached.reach(stage, step, own);
        }
        for (reached, trial) in self.structures.iter_mut().zip(&equations.trials) {
            reached[stage] = [trial.end.rates.clone(), trial.end.accelerations.clone()];
        }
    }

    /// Notes how the unknowns of a bearing have changed in a step of `h` \[s].
    pub fn follow(&self, bearing: usize, state: &mut State, h: f64) {
        self.bearings[bearing].follow(state.balls.len(), h, &mut state.trend);
    }

    /// Powers of the stages of a bearing before the last, in their mean.
    pub fn powers(&self, bearing: usize) -> Powers {
        let mut sum = Powers::default();
        for (weight, powers) in WEIGHTS.iter().zip(&self.bearings[bearing].powers[..STAGES - 1]) {
            sum.add_part(*weight, powers);
        }
        sum
    }

    /// Writes the local errors of a step of `h` \[s] where the steps of the bearings look for them.
    pub fn judge(&self, equations: &mut SystemStep<'_>, h: f64) {
        for (reached, step) in self.bearings.iter().zip(&mut equations.bearings) {
            reached.errors(step.model, step.before.balls.len(), h, &mut step.workspace.embedded);
        }
    }

    /// Local errors of a structure's coordinates in a step of `h` \[s], by the embedded method.
    pub fn structure_error(&self, structure: usize, h: f64) -> DVector<f64> {
        let reached = &self.structures[structure];
        let part = |j: usize| &reached[j][0] * (ERROR[j] * h);
        (1..STAGES).fold(part(0), |sum, j| sum + part(j))
    }
}

impl Reached {
    /// Begins at the start of a step.
    fn begin(&mut self, model: &Model, state: &State) {
        let Self { moving, unknowns, powers, .. } = self;
        steady_acceleration(model, state, &mut unknowns[0]);
        powers[0] = state.powers;
        let ball = &model.bearing.ball;
        moving[0].clear();
        for at in &state.balls {
            let (place, turn) = (at.acceleration, at.angular_acceleration);
            moving[0].push([
                Moving::new(at.velocity, place, place * ball.mass - at.total.force),
                Moving::new(at.angular_velocity, turn, turn * ball.inertia - at.total.moment),
            ]);
        }
        for ((_, at), (_, body)) in state.bodies.iter().zip(model.bodies.iter()) {
            moving[0].push(of_body(body.as_ref(), at, at.rate));
        }
    }

    /// Takes over a stage of a bearing that was solved with these unknowns.
    fn reach(&mut self, stage: usize, step: &BearingStep<'_>, solved: &[f64]) {
        let Self { moving, unknowns, powers, .. } = self;
        unknowns[stage].clear();
        unknowns[stage].extend_from_slice(solved);
        let (model, workspace) = (step.model, &*step.workspace);
        if stage < STAGES - 1 {
            powers[stage] = powers_of_stage(model, step.boundary, workspace);
        }
        let ball = &model.bearing.ball;
        let moving = &mut moving[stage];
        moving.clear();
        for index in 0..step.before.balls.len() {
            let (motion, unknowns, total) = (
                workspace.groups.motion(index),
                workspace.groups.unknowns(index),
                workspace.groups.total(index),
            );
            let [place, turn] = [0, 3].map(|from| unknowns.fixed_rows::<3>(from).into_owned());
            let turn = turn / ball.radius;
            moving.push([
                Moving::new(motion.velocity, place, place * ball.mass - total.force),
                Moving::new(motion.angular_velocity, turn, turn * ball.inertia - total.moment),
            ]);
        }
        let bodies = workspace.bodies.iter().zip(step.before.bodies.iter()).zip(model.bodies.iter());
        for (((_, trial), (_, before)), (_, body)) in bodies {
            let end = trial.as_ref().map_or(before, |trial| &trial.end);
            let turn = (before.pose.orientation.inverse() * end.pose.orientation).scaled_axis();
            let across = turn.cross(&end.rate);
            let rate = end.rate + across * 0.5 + turn.cross(&across) / 12.0;
            moving.push(of_body(body.as_ref(), end, rate));
        }
    }

    /// Sum of what has been reached before a stage, of one ball or body: places and turns, each with its velocity.
    fn sum(&self, stage: usize, index: usize, h: f64) -> [[Vector3<f64>; 2]; 2] {
        let mut sums = [[Vector3::zeros(); 2]; 2];
        for (part, moving) in EARLIER[stage].iter().zip(&self.moving).take(stage) {
            for ([way, gain], Moving { rate, acceleration, .. }) in sums.iter_mut().zip(&moving[index]) {
                *way += rate * (part * h);
                *gain += acceleration * (part * h);
            }
        }
        sums
    }

    /// Remainder of the equations of a ball or body that a stage makes good: that of the last step and, of the last stage, those of the stages before it.
    fn remainder(&self, stage: usize, index: usize, before: &Wrench) -> Wrench {
        let mut sum = *before;
        if stage == STAGES - 1 {
            for (weight, moving) in WEIGHTS.iter().zip(&self.moving[..stage]) {
                let [force, moment] = moving[index].map(|moving| moving.left * (weight / DIAGONAL));
                sum.force += force;
                sum.moment += moment;
            }
        }
        sum
    }

    /// Puts the start of a stage of a step of `h` \[s] from a state.
    fn place(&self, stage: usize, (model, before): (&Model, &State), h: f64, start: &mut State) {
        for (index, (ball, before)) in start.balls.iter_mut().zip(&before.balls).enumerate() {
            let [[way, gain], [_, spin]] = self.sum(stage, index, h);
            ball.position = before.position + way;
            ball.velocity = before.velocity + gain;
            ball.angular_velocity = before.angular_velocity + spin;
            (ball.acceleration, ball.angular_acceleration) = (Vector3::zeros(), Vector3::zeros());
            ball.remainder = self.remainder(stage, index, &before.remainder);
        }
        let first = before.balls.len();
        let bodies = start.bodies.iter_mut().zip(before.bodies.iter()).zip(model.bodies.iter());
        for (((body, at), (_, before)), (_, moved)) in bodies {
            // Where it is given, the boundary has it.
            if moved.as_ref().is_none_or(|moved| moved.carried) {
                continue;
            }
            let index = first + body.index();
            let [[way, gain], [turn, spin]] = self.sum(stage, index, h);
            at.pose.position = before.pose.position + way;
            at.pose.orientation = normalised(before.pose.orientation * UnitQuaternion::new(turn));
            at.velocity = before.velocity + gain;
            at.rate = before.rate + spin;
            (at.acceleration, at.rate_derivative) = (Vector3::zeros(), Vector3::zeros());
            at.remainder = self.remainder(stage, index, &before.remainder);
        }
    }

    /// First guess of a stage: unknowns go on by the polynomial through those of earlier stages; where they have gone on smoothly, through some of
    /// the last step, too.
    fn foresee(&mut self, stage: usize, before: &State, h: f64, into: &mut Foreseen) {
        let Foreseen { unknowns, steady } = into;
        let Self { unknowns: reached, expected, .. } = self;
        let start = &reached[0];
        steady.clone_from(start);
        for (turn, own) in orbit_turns(before, PLACES[stage] * h).zip(steady.chunks_exact_mut(BLOCK)) {
            if let Ok(six) = <&mut Six<f64>>::try_from(own) {
                *six = turn.stacked(six);
            }
        }
        let Trend { step, changes, smooth } = &before.trend;
        let (size, balls) = (start.len(), before.balls.len());
        let is_smooth = |index: usize| smooth.get((index / BLOCK).min(balls)).is_some_and(|smooth| *smooth);
        let old = (changes.len() == 2 * size).then(|| changes.split_at(size));
        let (alone, with_old) = (Known::new(stage, None), Known::new(stage, Some(step / h)));
        unknowns.clear();
        unknowns.extend((0..size).map(|index| match old {
            Some(old) if is_smooth(index) => with_old.sum(reached, Some(old), index),
            _ if stage == 1 => steady[index],
            _ => alone.sum(reached, None, index),
        }));
        if stage == 1 {
            expected.clear();
            let of = |index: usize| old.map_or(steady[index], |old| with_old.sum(reached, Some(old), index));
            expected.extend((0..size).map(|index| [of(index), steady[index]]));
        }
    }

    /// Notes how unknowns have changed in a step of `h` \[s], and of which balls, and of all bodies, the last step has told more than that all
    /// goes on as it is.
    fn follow(&self, balls: usize, h: f64, trend: &mut Trend) {
        let Trend { step, changes, smooth } = trend;
        let [start, first, _, third, end] = &self.unknowns;
        *step = h;
        changes.clear();
        changes
            .extend([start, third].into_iter().flat_map(|of| of.iter().zip(end).map(|(of, end)| of - end)));
        let mut missed = vec![[0.0; 2]; balls + 1];
        for (index, (solved, guesses)) in first.iter().zip(&self.expected).enumerate() {
            for (sum, guess) in missed[(index / BLOCK).min(balls)].iter_mut().zip(guesses) {
                *sum += (solved - guess) * (solved - guess);
            }
        }
        smooth.clear();
        smooth.extend(missed.into_iter().map(|[by_trend, steady]| by_trend < steady));
    }

    /// Squares of the local errors of places and turns in a step of `h` \[s] \[m2], by the embedded method: of balls, turns at the surface, and
    /// of bodies, turns at the pitch circle.
    pub fn errors(&self, model: &Model, balls: usize, h: f64, into: &mut Vec<[f64; 2]>) {
        into.clear();
        for index in 0..self.moving[0].len() {
            let length = if index < balls { model.bearing.ball.radius } else { model.race_length() };
            let error = |k: usize| {
                let of = ERROR
                    .iter()
                    .zip(&self.moving)
                    .map(|(weight, moving)| moving[index][k].rate * (weight * h));
                of.sum::<Vector3<f64>>().norm_squared()
            };
            into.push([error(0), error(1) * length * length]);
        }
    }
}

impl Moving {
    fn new(rate: Vector3<f64>, acceleration: Vector3<f64>, left: Vector3<f64>) -> Self {
        Self { rate, acceleration, left }
    }
}

/// A body in a state, with the rate of its rotation vector.
fn of_body(body: Option<&RigidBody>, at: &BodyState, turn: Vector3<f64>) -> [Moving; 2] {
    let left = body.map_or([Vector3::zeros(); 2], |body| {
        [
            at.acceleration * body.mass - at.total.force,
            at.rate_derivative.component_mul(&body.inertia) - at.total.moment,
        ]
    });
    [Moving::new(at.velocity, at.acceleration, left[0]), Moving::new(turn, at.rate_derivative, left[1])]
}
