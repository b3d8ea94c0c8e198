//! The equations of one trial step: residual, Newton matrix and its solution.

use nalgebra::{Vector3, Vector6};

use super::ball::{BallTrial, RaceSeen, Surroundings};
use super::cage::CageTrial;
use super::race::{RaceLoad, RaceScales, RaceTrial};
use super::reaction::RaceReaction;
use super::turn::Turn;
use super::{Boundary, Workspace};
use crate::contact::many::{ContactEffect, evaluate_group};
use crate::contact::{BallMotion, ContactModel, RaceMotion};
use crate::dynamics::arrowhead::{BLOCK, BODIES, BallBlock, KeptBlock, KeptMatrix};
use crate::dynamics::state::{State, race_motion};
use crate::model::{CAGE, Model, OUTER, RaceBody};
use crate::numerics::hht::HhtStep;
use crate::numerics::lanes::WIDTH;
use crate::numerics::newton::Equations;

/// [-] accepted violation of position constraints over the ball diameter (paper section 5: 1e-8).
const CONSTRAINT_TOLERANCE: f64 = 1e-8;

/// The equations of one trial step.
pub struct BearingStep<'a> {
    pub model: &'a Model,
    contacts: [ContactModel<'a>; 2],
    pub start: &'a State,
    pub step: HhtStep,
    pub boundary: &'a Boundary,
    /// Motion of the races at the end of the step.
    races: [RaceMotion<f64>; 2],
    pub force_tolerance: f64,
    pub workspace: &'a mut Workspace,
    /// Contacts evaluated without and with derivatives.
    pub contact_values: u64,
    /// See there.
    pub contact_tangents: u64,
    /// Nothing was evaluated yet.
    fresh: bool,
}

impl<'a> BearingStep<'a> {
    /// The equations of a step of `h` [s].
    pub fn new(
        model: &'a Model,
        start: &'a State,
        boundary: &'a Boundary,
        h: f64,
        workspace: &'a mut Workspace,
    ) -> Self {
        let contacts = [0, 1].map(|race| model.contact(race, boundary.friction));
        let races = boundary.motion.each_ref().map(|(pose, twist)| race_motion(pose, twist));
        if workspace.balls.len() != start.balls.len() {
            let trial = |ball| BallTrial::new(ball, &contacts, races.each_ref());
            workspace.balls = start.balls.iter().map(trial).collect();
        }
        for race in 0..2 {
            let body = model.bodies[race].as_ref();
            match (body, &mut workspace.races[race]) {
                (Some(_), Some(trial)) => trial.end.clone_from(&start.races[race]),
                (body, trial) => *trial = body.map(|body| RaceTrial::new(body, &start.races[race])),
            }
        }
        match (model.cage.as_ref().zip(start.cage.as_ref()), &mut workspace.cage) {
            (Some((_, state)), Some(trial)) => trial.body.end.clone_from(state),
            (cage, trial) => *trial = cage.map(|(cage, state)| CageTrial::new(cage, state)),
        }
        Self {
            model,
            contacts,
            start,
            step: HhtStep::new(model.solver.alpha_f, h),
            boundary,
            races,
            force_tolerance: start.force_tolerance,
            workspace,
            contact_values: 0,
            contact_tangents: 0,
            fresh: true,
        }
    }

    /// Do the balls not feel each other, because no body has unknowns?
    pub fn balls_are_independent(&self) -> bool {
        self.model.border_offsets() == [None; BODIES]
    }

    /// Moves the balls to the end of the step and evaluates their contacts, residuals and, if asked for, tangents.
    ///
    /// Under prescribed races balls whose unknowns did not change keep their last evaluation.
    fn evaluate_balls(&mut self, unknowns: &[f64], with_tangent: bool) {
        let all = with_tangent || self.fresh || !self.balls_are_independent();
        let workspace = &mut *self.workspace;
        let around = Surroundings {
            model: self.model,
            contacts: &self.contacts,
            differences: &self.start.differences,
            races: [0, 1].map(|race| RaceSeen::new(race, &self.races, &workspace.races)),
            cage: self.model.cage.as_ref().zip(workspace.cage.as_ref()),
        };
        let radius = self.model.bearing.ball.radius;
        let mut effects = [[ContactEffect::none(); WIDTH]; 2];
        let mut motions = [BallMotion::at_rest(); WIDTH];
        for (group, trials) in workspace.balls.chunks_mut(WIDTH).enumerate() {
            let first = WIDTH * group;
            let mut changed = [all; WIDTH];
            for (lane, trial) in trials.iter_mut().enumerate() {
                let at = BLOCK * (first + lane);
                let unknown = Vector6::from_row_slice(&unknowns[at..at + BLOCK]);
                changed[lane] |= unknown != trial.unknowns;
                if changed[lane] {
                    trial.move_to(unknown, radius, &self.step, &self.start.balls[first + lane]);
                }
                motions[lane] = trial.motion;
            }
            if changed == [false; WIDTH] {
                continue;
            }
            if !with_tangent {
                for race in 0..2 {
                    let motions = &motions[..trials.len()];
                    let (contact, seen) = (&self.contacts[race], &self.races[race]);
                    match self.start.differences.get(first..first + trials.len()) {
                        None => evaluate_group(contact, seen, motions, &mut effects[race]),
                        Some(differences) => {
                            for (lane, (motion, of_ball)) in motions.iter().zip(differences).enumerate() {
                                let contact = contact.of_ball(Some(&of_ball[race]));
                                effects[race][lane] = ContactEffect::from(&contact.evaluate(motion, seen));
                            }
                        }
                    }
                }
            }
            for (lane, trial) in trials.iter_mut().enumerate() {
                let tangent = if with_tangent {
                    self.contact_tangents += 2;
                    Some(trial.contacts_with_tangent(first + lane, &around, &self.step))
                } else if changed[lane] {
                    self.contact_values += 2;
                    trial.take_contacts([effects[0][lane], effects[1][lane]]);
                    None
                } else {
                    continue;
                };
                trial.assemble(first + lane, &around, &self.step, &self.start.balls[first + lane], tangent);
            }
        }
        self.fresh = false;
    }
}

/// The larger of two norms; `max` would drop a NaN.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
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
                self.races[race] = trial.motion_value();
            }
        }
        if let (Some(cage), Some(offset)) = (&mut self.workspace.cage, offsets[CAGE]) {
            let (from, start) = (border_start + offset, self.start.cage.as_ref());
            if let Some(start) = start {
                cage.move_to(&unknowns[from..from + BLOCK], start, &self.step, length);
            }
        }

        // balls
        self.evaluate_balls(unknowns, with_tangent);
        let mut norm = 0.0f64;
        for trial in &mut self.workspace.balls {
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

        // cage
        if let (Some(model), Some(cage), Some(start)) =
            (&self.model.cage, &mut self.workspace.cage, &self.start.cage)
        {
            let seen = [0, 1].map(|race| RaceSeen::new(race, &self.races, &self.workspace.races));
            let lands = cage.touch_lands(model, seen, &self.step, with_tangent);
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

    fn has_tangent(&self) -> bool {
        // Step sizes that differ by rounding have the same matrix. Where there are bodies every step has its own: corrections
        // with an old one stop just inside the tolerance, and what they leave adds up in a body that nothing else holds.
        let kept = &self.workspace.kept;
        let same = (kept.step - self.step.h).abs() < 1e-6 * self.step.h;
        let there = kept.balls.len() == self.start.balls.len();
        there && same && self.model.solver.matrix_reuse > 0.0 && self.balls_are_independent()
    }

    fn correction(&mut self, correction: &mut [f64]) -> bool {
        if self.balls_are_independent() {
            self.correct_balls(correction)
        } else {
            self.correct_all(correction)
        }
    }

    fn refactor_contraction(&self) -> f64 {
        self.model.solver.matrix_reuse
    }
}

impl BearingStep<'_> {
    /// Corrections of balls that feel nothing but races of prescribed motion. A ball's matrix goes round with it; a ball that
    /// is solved already stays where it is.
    fn correct_balls(&self, correction: &mut [f64]) -> bool {
        let Workspace { balls, kept, .. } = &*self.workspace;
        let mut regular = kept.balls.len() == balls.len();
        for ((trial, block), x) in balls.iter().zip(&kept.balls).zip(correction.chunks_exact_mut(BLOCK)) {
            if trial.residual.amax() <= self.force_tolerance {
                x.fill(0.0);
                continue;
            }
            let turn = Turn::between(&block.offset, &self.offset(trial));
            let solution = turn.stacked(&(block.inverse * turn.back().stacked(&-trial.residual)));
            regular &= solution.iter().all(|v| v.is_finite());
            x.copy_from_slice(solution.as_slice());
        }
        regular
    }

    /// Corrections of balls and bodies at once.
    fn correct_all(&mut self, correction: &mut [f64]) -> bool {
        let offsets = self.model.border_offsets();
        let workspace = &mut *self.workspace;
        workspace.ball_corrections.clear();
        workspace.ball_corrections.extend(workspace.balls.iter().map(|trial| -trial.residual));
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

    /// [m] a ball's position seen from the outer race.
    fn offset(&self, trial: &BallTrial) -> Vector3<f64> {
        trial.motion.position - self.races[OUTER].position
    }

    /// Inverts the blocks of balls that feel nothing but races of prescribed motion; leaves none if one is singular.
    fn invert_balls(&mut self) {
        let invert = |trial: &BallTrial| {
            let inverse = trial.block.diagonal.try_inverse()?;
            let regular = inverse.iter().all(|v| v.is_finite());
            regular.then(|| KeptBlock { inverse, offset: self.offset(trial) })
        };
        let balls = self.workspace.balls.iter().map(invert).collect::<Option<_>>().unwrap_or_default();
        self.workspace.kept = KeptMatrix { step: self.step.h, extra_corrections: 0, balls };
    }

    fn factorise(&mut self) {
        if self.balls_are_independent() {
            return self.invert_balls();
        }
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
pub fn weighted(load: &RaceLoad, body: &RaceBody, gravity: &Vector3<f64>) -> RaceLoad {
    let mut load = *load;
    load.applied.force += gravity * body.mass;
    load
}
