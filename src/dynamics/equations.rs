//! The equations of one trial step: residual, Newton matrix and its solution.

use super::ball::{BallTrial, Surroundings};
use super::body::{BodyTrial, RaceSeen};
use super::body_sums::{BodyLoad, BodyScales, BodyStep};
use super::cage::CageTrial;
use super::spacing::SpacingTrial;
use super::stages::Foreseen;
use super::{Boundary, Workspace};
use crate::contact::many::ContactGroup;
use crate::contact::{ContactModel, RaceMotion};
use crate::effects::ambient::Ambient;
use crate::model::Model;
use crate::model::bodies::{Body, PerRace, Race, RigidBody};
use crate::model::state::{BodyState, State, race_motion};
use crate::numerics::arrowhead::{BLOCK, SLOTS};
use crate::numerics::hht::HhtStep;
use crate::numerics::lanes::WIDTH;
use crate::numerics::motion::Wrench;
use crate::numerics::newton::Equations;
use crate::numerics::size::{larger, largest};

/// [-] accepted violation of position constraints over the ball diameter (paper section 5: 1e-8).
const CONSTRAINT_TOLERANCE: f64 = 1e-8;

/// The equations of one trial step.
pub struct BearingStep<'a> {
    pub model: &'a Model,
    pub(super) contacts: PerRace<ContactModel<'a>>,
    /// Loads from outside at the end of the step.
    pub(super) ambient: Ambient,
    /// Where the motion starts from: the state at the start of the step, or what earlier stages lead a stage to.
    pub start: &'a State,
    /// State at the start of the step.
    pub before: &'a State,
    /// What earlier stages lead a stage to expect.
    pub foreseen: Option<&'a Foreseen>,
    pub step: HhtStep,
    pub boundary: &'a Boundary,
    pub force_tolerance: f64,
    pub workspace: &'a mut Workspace,
    /// Corrections so far.
    pub(super) corrections: u32,
    /// [-] largest residual of the bodies over its tolerance: now, and before the last correction.
    pub(super) of_bodies: [f64; 2],
    /// Are the rows of the bodies those of this step?
    pub(super) renewed_rows: bool,
    /// Was nothing evaluated yet?
    fresh: bool,
}

impl<'a> BearingStep<'a> {
    /// The equations of a step from a state.
    pub fn new(
        model: &'a Model,
        start: &'a State,
        boundary: &'a Boundary,
        step: HhtStep,
        workspace: &'a mut Workspace,
    ) -> Self {
        workspace.balls.resize_with(start.balls.len(), BallTrial::new);
        workspace.balls.iter_mut().for_each(|trial| trial.before = 0.0);
        workspace.settled = false;
        workspace.embedded.clear();
        workspace.prepare_bodies(model, start);
        if let Some(cage) = &mut workspace.cage {
            cage.oil = model.oil_around_cage(&boundary.conditions);
        }
        let contacts = model.contacts_oriented(&boundary.conditions, boundary.orientations.as_ref());
        let races = PerRace::new(|race| race_motion(&boundary.motion[race].0, &boundary.motion[race].1));
        workspace.groups.begin(&start.balls, (&model.bearing.ball, &step), || {
            let motion = start.balls[0].motion();
            PerRace::new(|race| ContactGroup::filled(&contacts[race].evaluate(&motion, &races[race])))
        });
        workspace.races = races;
        workspace.spacing = start.spacing.as_ref().map(|turn| SpacingTrial::new(turn, boundary, &step));
        if let (Some(spacing), Some(trial)) = (&model.spacing, &workspace.spacing) {
            let ball = (&model.bearing.ball, &step);
            workspace.groups.keep_apart(&start.balls, &spacing.azimuths, trial, ball);
        }
        Self {
            model,
            contacts,
            ambient: model.ambient(&boundary.frame),
            start,
            before: start,
            foreseen: None,
            step,
            boundary,
            force_tolerance: start.force_tolerance,
            workspace,
            corrections: 0,
            of_bodies: [0.0; 2],
            renewed_rows: false,
            fresh: true,
        }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        BLOCK * self.start.balls.len() + self.model.border_size()
    }

    /// Do steps share the blocks of balls?
    pub(super) fn keeps_matrices(&self) -> bool {
        self.model.solver.matrix_reuse > 0.0 && self.workspace.neighbours.is_empty()
    }

    /// Are the balls independent of each other, because no body has unknowns, no two balls may touch, and no ideal cage keeps them apart?
    pub fn balls_are_independent(&self) -> bool {
        self.model.border_size() == 0 && self.workspace.neighbours.is_empty()
    }

    /// Motion of the outer race at the end of the step.
    pub(super) fn outer(&self) -> &RaceMotion<f64> {
        &self.workspace.races.outer
    }

    /// Moves the bodies to the end of the step; may one of them be somewhere else than at the last evaluation?
    fn move_bodies(&mut self, unknowns: &[f64]) -> bool {
        let mut moved = false;
        let length = self.model.race_length();
        let offsets = self.model.border_offsets();
        let border = &unknowns[BLOCK * self.start.balls.len()..];
        let Workspace { bodies, races, cage, spacing, groups, .. } = &mut *self.workspace;
        if let (Some(trial), Some(row)) = (spacing, self.model.spacing_row()) {
            moved |= trial.move_to(border[row], &self.step, length);
            groups.turn(&trial.turn);
        }
        for ((body, trial), (_, start)) in bodies.iter_mut().zip(self.start.bodies.iter()) {
            if let (Some(trial), Some(from)) = (trial, offsets[body.index()]) {
                if trial.is_carried() {
                    moved = true;
                    continue;
                }
                let own = &border[from..from + trial.unknowns.len()];
                moved |= own != trial.unknowns;
                trial.move_to(own, start, &self.step, length);
                match body {
                    Body::Race(race) => races[race] = trial.motion_value(),
                    Body::Cage => cage.iter_mut().for_each(|cage| cage.see(trial)),
                }
            }
        }
        moved
    }

    /// Moves the balls to the end of the step. Where the bodies stay, balls whose unknowns did not change keep their last evaluation.
    fn move_balls(&mut self, unknowns: &[f64], bodies_moved: bool) {
        let all = self.fresh || bodies_moved || !self.workspace.neighbours.is_empty();
        self.workspace.groups.move_to(&unknowns[..BLOCK * self.start.balls.len()], all);
        self.fresh = false;
    }

    /// Evaluates pairs and residuals of the groups of balls that have moved.
    pub(super) fn evaluate_moved(&mut self) {
        let workspace = &mut *self.workspace;
        let bodies = (&workspace.races, &workspace.bodies, workspace.cage.as_ref());
        let acts = (&self.contacts, &self.ambient);
        let around = Surroundings::new(self.model, acts, &self.start.differences, bodies);
        for (index, (trials, group)) in
            workspace.balls.chunks_mut(WIDTH).zip(workspace.groups.iter_mut()).enumerate()
        {
            let moved = group.moved.iter().filter(|moved| **moved).count();
            if moved > 0 {
                workspace.counted.contact_values += 2 * moved as u64;
                around.evaluate_group(WIDTH * index, trials, group);
            }
        }
    }

    /// Derivatives of the balls to be renewed where they are, and their couplings to the bodies.
    pub(super) fn differentiate_renewed(&mut self) {
        let workspace = &mut *self.workspace;
        let bodies = (&workspace.races, &workspace.bodies, workspace.cage.as_ref());
        let acts = (&self.contacts, &self.ambient);
        let around = Surroundings::new(self.model, acts, &self.start.differences, bodies);
        let length = self.model.race_length();
        for (index, trial) in workspace.balls.iter_mut().enumerate().filter(|(_, trial)| trial.renewed) {
            workspace.counted.contact_tangents +=
                trial.differentiate(index, &workspace.groups, &around, &self.step);
            for (slot, body) in workspace.bodies.iter() {
                if let Some(body) = body {
                    trial.couple_body(slot, body, &self.step, length);
                }
            }
            if let Some(apart) = workspace.groups.apart(index) {
                let moved = workspace.bodies.iter().filter(|(_, trial)| trial.is_some());
                let slots = moved.map(|(body, _)| body.index());
                apart.share(&mut trial.block, &workspace.groups.unknowns(index), slots, length);
            }
        }
    }

    /// Sums the forces of all pairs on the bodies that forces move.
    pub(super) fn scatter(&mut self) -> [Wrench; SLOTS] {
        let mut sums = [Wrench::default(); SLOTS];
        let Workspace { balls, groups, bodies, races, cage, .. } = &mut *self.workspace;
        for (body, _) in bodies.iter().filter(|(_, trial)| trial.is_some()) {
            let sum = &mut sums[body.index()];
            match body {
                Body::Race(race) => *sum = groups.on_race(race, balls.len()),
                Body::Cage => balls.iter().filter_map(|trial| trial.pocket.as_ref()).for_each(|pair| {
                    sum.force -= pair.force;
                    sum.moment += pair.other_moment;
                }),
            }
        }
        if let (Some(model), Some(cage)) = (&self.model.cage, cage.as_mut())
            && let Some(guide) = model.guide()
        {
            cage.touch_lands(model, &races[guide]);
            for pair in cage.lands.iter().flatten() {
                let on_race = &mut sums[Body::from(guide).index()];
                *on_race = on_race.plus(Wrench { force: -pair.force, moment: pair.other_moment });
                let on_cage = &mut sums[Body::Cage.index()];
                *on_cage = on_cage.plus(pair.on_first());
            }
        }
        sums
    }

    /// Given quantities of a body that forces move in this step.
    fn given<'b>(&'b self, body: Body, model: &'b RigidBody, start: &'b BodyState) -> BodyStep<'b> {
        BodyStep {
            body: model,
            start,
            load: self.boundary.load_on(body, model, &self.ambient),
            flange: self.boundary.flange(self.model, body),
            moving: self.ambient.frame.as_ref(),
            step: &self.step,
            scales: BodyScales {
                length: self.model.race_length(),
                length_tolerance: CONSTRAINT_TOLERANCE * 2.0 * self.model.bearing.ball.radius,
                time: self.boundary.time,
            },
        }
    }

    /// Residuals of the bodies under these forces, and of the turn of an ideal cage; returns the largest norm.
    pub(super) fn assemble_bodies(&mut self, sums: &[Wrench; SLOTS]) -> f64 {
        let mut norm = 0.0;
        let mut trials = std::mem::take(&mut self.workspace.bodies);
        let bodies = self.model.bodies.iter().zip(self.start.bodies.iter());
        for (((body, model), (_, start)), (_, trial)) in bodies.zip(trials.iter_mut()) {
            if let (Some(model), Some(trial)) = (model, trial) {
                trial.assemble(&self.given(body, model, start), &sums[body.index()]);
                norm = larger(norm, largest(trial.residual.rows(0, 6).iter()) / self.force_tolerance);
                norm = larger(norm, trial.violation);
            }
        }
        self.workspace.bodies = trials;
        let Workspace { spacing, groups, .. } = &mut *self.workspace;
        if let Some(trial) = spacing {
            trial.assemble(groups, &self.step, self.model.race_length());
            // All balls leave something in it: each is held to its own tolerance, whatever their number.
            norm = larger(norm, trial.each.abs() / self.force_tolerance);
        }
        norm
    }

    /// Adds derivatives to the motion of the bodies.
    pub(super) fn differentiate_bodies(&mut self) {
        let length = self.model.race_length();
        let Workspace { bodies, cage, .. } = &mut *self.workspace;
        for ((body, trial), (_, start)) in bodies.iter_mut().zip(self.start.bodies.iter()) {
            if let Some(trial) = trial {
                trial.differentiate(start, &self.step, length);
                if let (Body::Cage, Some(cage)) = (body, cage.as_mut()) {
                    cage.see_derivatives(trial);
                }
            }
        }
    }

    /// Tangents of the bodies whose residuals were assembled last, and their couplings to each other by the lands.
    pub(super) fn assemble_blocks(&mut self) {
        let length = self.model.race_length();
        let mut trials = std::mem::take(&mut self.workspace.bodies);
        let mut lands = [None; 2];
        let guide = self.model.cage_guide();
        if let (Some(model), Some(cage), Some(guide)) =
            (&self.model.cage, self.workspace.cage.as_mut(), guide)
        {
            lands =
                cage.land_reactions(model, &RaceSeen::new(guide, &self.workspace.races, &trials), &self.step);
            cage.race_by_cage.fill(0.0);
            cage.cage_by_race.fill(0.0);
            if let (Some(race), Some(Some(own))) = (&trials[guide], trials.get(Body::Cage)) {
                for land in lands.iter().flatten() {
                    cage.race_by_cage += race.coupling(&land.on_race, &self.step, length);
                    cage.cage_by_race += own.coupling(&land.on_cage, &self.step, length);
                }
            }
        }
        let bodies = self.model.bodies.iter().zip(self.start.bodies.iter());
        for (((body, model), (_, start)), (_, trial)) in bodies.zip(trials.iter_mut()) {
            if let (Some(model), Some(trial)) = (model, trial) {
                let reactions = lands.iter().flatten().filter_map(|land| match body {
                    Body::Cage => Some(&land.on_cage),
                    Body::Race(race) => (Some(race) == guide).then_some(&land.on_race),
                });
                trial.assemble_block(&self.given(body, model, start), &reactions);
            }
        }
        self.workspace.bodies = trials;
    }
}

impl Equations for BearingStep<'_> {
    fn residual(&mut self, unknowns: &[f64], with_tangent: bool) -> f64 {
        let independent = self.balls_are_independent();
        self.workspace.balls.iter_mut().for_each(|trial| trial.renewed = with_tangent);
        match (self.fresh, with_tangent) {
            (true, false) => self.mark_due(),
            (false, true) => self.give_up_old(),
            _ => {}
        }
        let renewed = self.workspace.balls.iter().any(|trial| trial.renewed);
        self.workspace.counted.renewals += u64::from(renewed && !with_tangent);
        // bodies first: the balls see them move
        let moved = self.move_bodies(unknowns);
        let factorises = !independent && (renewed || !self.workspace.factorised);
        if factorises {
            self.differentiate_bodies();
        }
        self.move_balls(unknowns, moved);
        self.evaluate_neighbours(with_tangent);
        self.evaluate_moved();
        let mut norm = 0.0f64;
        for ball in 0..self.workspace.balls.len() {
            norm = larger(norm, self.workspace.groups.size(ball) / self.force_tolerance);
        }
        if !independent {
            let sums = self.scatter();
            self.of_bodies[0] = self.assemble_bodies(&sums);
            norm = larger(norm, self.of_bodies[0]);
        }
        if renewed {
            self.differentiate_renewed();
            self.eliminate_renewed();
        }
        if factorises {
            self.factorise();
        }
        norm
    }

    fn has_tangent(&self) -> bool {
        // Step sizes that differ by rounding have the same matrix.
        let kept = &self.workspace.kept;
        let same = (kept.step - self.step.h).abs() < 1e-6 * self.step.h;
        let there = kept.balls.len() == self.start.balls.len();
        there && same && self.keeps_matrices()
    }

    fn correction(&mut self, correction: &mut [f64]) -> bool {
        self.correct(correction)
    }

    fn refactor_contraction(&self) -> f64 {
        self.model.solver.matrix_reuse
    }
}

impl Workspace {
    /// Buffers of the bodies, as they are at the start of a step.
    fn prepare_bodies(&mut self, model: &Model, start: &State) {
        if self.bodies.len() == start.bodies.len() {
            for ((_, trial), (_, state)) in self.bodies.iter_mut().zip(start.bodies.iter()) {
                trial.iter_mut().for_each(|trial| trial.end.copy_from(state));
            }
        } else {
            let trial = |body: Body, state: &BodyState| {
                let moved = model.bodies.get(body)?.as_ref();
                moved.map(|moved: &RigidBody| BodyTrial::new(moved, state))
            };
            self.bodies = start.bodies.map(trial);
            let cage = self.bodies.get(Body::Cage).and_then(Option::as_ref);
            self.cage = cage.map(CageTrial::new);
        }
    }
}

impl Boundary {
    /// Turns damaged balls from where they are in a state to the end of the step.
    pub fn turn_balls(&mut self, model: &Model, state: &State) {
        if let (Some(damaged), Some(orientations)) = (&model.damaged, &state.orientations) {
            let turned = damaged.turned(orientations, &state.balls, self.time - state.time);
            self.orientations = Some(turned);
        }
    }

    /// Takes the temperatures that a state has come to by the heat of friction.
    pub fn see_temperatures(&mut self, state: &State) {
        if let Some(warm) = &state.warm {
            self.conditions.warmth.rises = warm.rises;
        }
    }

    /// Takes the spins of the races, which rings grow by and oil is thrown off by, from their motions and prescribed speeds, and the turn of
    /// the frame that these are seen from.
    pub fn see_spins(&mut self, model: &Model) {
        if model.growth.is_some() || model.films.is_some() {
            let turn = self.frame.angular_velocity.x;
            self.conditions.warmth.spins = Race::BOTH.map(|race| {
                turn + match &model.bodies[race] {
                    Some(_) => self.loads[race].speed,
                    None => {
                        let (pose, twist) = &self.motion[race];
                        (pose.orientation.inverse() * twist.angular_velocity).x
                    }
                }
            });
        }
    }

    /// Load on a body from outside: applied wrench and weight.
    pub fn load_on(&self, body: Body, moved: &RigidBody, ambient: &Ambient) -> BodyLoad {
        let mut load = match body {
            Body::Race(race) => self.loads[race],
            Body::Cage => BodyLoad::default(),
        };
        load.applied.force += ambient.gravity * moved.mass;
        load
    }
}
