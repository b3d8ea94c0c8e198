//! Balls that a guess or a correction has thrown far from balance: they are brought back alone, before all is corrected together.
//!
//! A ball at the edge of the load zone presses with a few newtons on one race, and a step of 100 us takes it through many times the
//! depth of that contact. Newton's method then comes back by a factor of two or three at a time, and all other balls would be evaluated
//! as often. Its six equations with the bodies where they are cost two contacts an iteration.

use nalgebra::Vector6;

use super::ball::{BallTrial, Surroundings};
use super::equations::BearingStep;
use crate::model::bodies::Race;
use crate::model::state::BallState;
use crate::numerics::hht::HhtStep;
use crate::numerics::size::largest;

/// [-] way that a correction alone would take a ball over the depth of its deeper contact, above which it is out of balance. At half of it
/// balls are brought back that one correction of all brings back, too; at twice a step of `scenes/radial.toml` with the goal `fast` takes
/// a tenth more corrections.
const THROWN: f64 = 0.06;
/// [-] share of the balls above which it is the bodies that are not where they will be: where a load turns around, say.
const MANY: f64 = 0.6;
/// [-] residual over what it was that is left to the correction of all.
const LEFT: f64 = 1e-3;
/// Most iterations of one ball.
const MOST: u32 = 12;

impl BearingStep<'_> {
    /// Brings balls back that are far out of balance, with all bodies where they are; were there some? Their blocks of the matrix are
    /// then to be computed anew.
    pub(super) fn repair_balls(&mut self) -> bool {
        let workspace = &mut *self.workspace;
        let (tolerance, mass) = (self.force_tolerance, self.model.bearing.ball.mass);
        let thrown =
            workspace.balls.iter().filter(|trial| trial.is_thrown(tolerance, &self.step, mass)).count();
        if thrown == 0 || thrown as f64 > MANY * workspace.balls.len() as f64 {
            return false;
        }
        let bodies = (&self.races, &workspace.bodies, workspace.cage.as_ref());
        let acts = (&self.contacts, &self.ambient);
        let around = Surroundings::new(self.model, acts, &self.start.differences, bodies);
        for (index, (trial, start)) in workspace.balls.iter_mut().zip(&self.start.balls).enumerate() {
            if trial.is_thrown(tolerance, &self.step, mass) {
                let target = tolerance.max(LEFT * largest(&trial.residual));
                let evaluations = trial.balance(index, &around, &self.step, start, target);
                self.contact_tangents += 2 * u64::from(evaluations);
            }
        }
        true
    }
}

impl BallTrial {
    /// Is the ball so far out of balance that Newton's method would have to follow the bend of a contact? A stiff contact bends as soon
    /// as its depth changes; in short steps the ball's mass leaves little of that.
    fn is_thrown(&self, tolerance: f64, step: &HhtStep, mass: f64) -> bool {
        let size = largest(&self.residual);
        let [inner, outer] = Race::BOTH.map(|race| &self.raceways[race]);
        let deeper = if inner.load > outer.load { inner } else { outer };
        // Without a contact any way is too far: it ends in one.
        let depth = deeper.approach.max(0.0);
        let gain = step.position_gain();
        let slope = if deeper.load > 0.0 { 1.5 * deeper.load / depth } else { 0.0 };
        size > tolerance && gain * size / (mass + gain * slope) > THROWN * depth
    }

    /// Solves the ball's own equations to a residual \[N], or as far as that goes; how often were its contacts evaluated?
    fn balance(
        &mut self,
        index: usize,
        around: &Surroundings<'_>,
        step: &HhtStep,
        start: &BallState,
        target: f64,
    ) -> u32 {
        let radius = around.model.bearing.ball.radius;
        let from = self.unknowns;
        let evaluate = |trial: &mut Self, unknowns: Vector6<f64>| {
            trial.move_to(unknowns, radius, step, start);
            trial.evaluate_alone(index, around, step, start);
            largest(&trial.residual)
        };
        let mut norm = evaluate(self, from);
        let mut evaluations = 1;
        while norm > target && evaluations < MOST {
            let at = self.unknowns;
            let Some(full) = self.block.diagonal.lu().solve(&-self.residual) else {
                break;
            };
            let mut length = 1.0;
            let next = loop {
                let next = evaluate(self, at + full * length);
                evaluations += 1;
                if next < norm * (1.0 - 1e-4 * length) || evaluations >= MOST {
                    break next;
                }
                length *= 0.5;
            };
            if next < norm {
                norm = next;
            } else {
                // Not a number either.
                norm = evaluate(self, at);
                evaluations += 1;
                break;
            }
        }
        if !norm.is_finite() {
            evaluate(self, from);
            evaluations += 1;
        }
        self.repaired = Some(self.unknowns - from);
        evaluations
    }
}
