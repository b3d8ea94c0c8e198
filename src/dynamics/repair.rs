//! Balls that a guess or a correction has thrown far from balance, or that corrections of all lead nowhere: they are brought back alone, before all is
//! corrected together.
//!
//! A ball at the edge of the load zone presses with a few newtons on one race, and a step of 100 us takes it through many times the
//! depth of that contact. Newton's method then comes back by a factor of two or three at a time, and all other balls would be evaluated
//! as often. Its six equations with the bodies where they are cost two contacts an iteration.
//! The same holds where friction turns round within micrometres a second, as in a bearing at 13 rpm on a shaft whose teeth swing at 500 Hz: its balls
//! are alone in not being solved. The goal `fast` took 2.4 times as long there.

use std::cmp::Ordering;

use nalgebra::Vector6;

use super::ball::{BallAlone, Surroundings};
use super::ball_equations::BallEquations;
use super::equations::BearingStep;
use super::group::Groups;
use crate::model::bodies::{PerRace, Race};
use crate::numerics::hht::HhtStep;
use crate::numerics::size::largest;

/// [-] way that a correction alone would take a ball over the depth of its deeper contact, above which it is out of balance. At half of it a
/// step of `scenes/radial.toml` with the goal `fast` takes a twentieth fewer corrections and a tenth more time, as balls are brought back that one
/// correction of all brings back, too; at eight times of it, a third more time.
const THROWN: f64 = 0.12;
/// [-] share of the balls above which it is the bodies that are not where they will be: where a load turns around, say.
const MANY: f64 = 0.6;
/// [-] residual over what it was before the last correction, above which a ball of one bearing among several does not come by corrections of all. A bearing
/// alone goes without: its other balls cost less, and where it stands under 1.5 +- 1 kN it took 3037 steps in place of 2111.
const SLOW: f64 = 0.5;
/// [-] residual over what it was that is left to the correction of all. With a tenth of it the goal `fast` takes 3 % more time on
/// `scenes/radial.toml`, with ten times of it 4 to 13 %.
const LEFT: f64 = 1e-2;
/// Most iterations of one ball.
const MOST: u32 = 12;

impl BearingStep<'_> {
    /// Brings balls back that are far out of balance, with all bodies where they are. Their blocks of the matrix are then to be computed
    /// anew. Is it `alone`, or one of several bearings that are corrected together?
    pub(super) fn repair_balls(&mut self, alone: bool) {
        let workspace = &mut *self.workspace;
        let (balls, groups, counted) = (&mut workspace.balls, &mut workspace.groups, &mut workspace.counted);
        let (tolerance, ball) = (self.force_tolerance, &self.model.bearing.ball);
        let waited_for = !alone && self.corrections > 0;
        let is_slow =
            |size: f64, before: f64| waited_for && size > tolerance && size > SLOW * before * tolerance;
        let mut out = 0;
        for (index, trial) in balls.iter_mut().enumerate() {
            let size = groups.size(index);
            trial.out =
                is_slow(size, trial.before) || groups.is_thrown(index, tolerance, &self.step, ball.mass);
            out += usize::from(trial.out);
        }
        if out == 0 || out as f64 > MANY * balls.len() as f64 {
            return;
        }
        let bodies = (&workspace.races, &workspace.bodies, workspace.cage.as_ref());
        let acts = (&self.contacts, &self.ambient);
        let around = Surroundings::new(self.model, acts, &self.start.differences, bodies);
        for (index, (trial, start)) in balls.iter_mut().zip(&self.start.balls).enumerate() {
            if trial.out {
                let equations = BallEquations::new(start, ball, &self.step);
                let apart = groups.apart(index);
                let obliquely = PerRace::new(|race| groups.rolled_obliquely(index, race));
                let alone = |unknowns: &Vector6<f64>| {
                    let equations = (&equations, apart.as_ref());
                    let here = BallAlone::new(index, (equations, unknowns), &obliquely, &around, &self.step);
                    counted.contact_tangents += here.touching;
                    here
                };
                let from = groups.unknowns(index);
                let to = balance(from, tolerance.max(LEFT * groups.size(index)), alone);
                trial.repaired = Some(to - from);
                groups.put(index, &to);
            }
        }
        self.evaluate_moved();
    }
}

impl Groups {
    /// Is a ball so far out of balance that Newton's method would have to follow the bend of a contact? A stiff contact bends as soon
    /// as its depth changes; in short steps the ball's mass leaves little of that.
    fn is_thrown(&self, ball: usize, tolerance: f64, step: &HhtStep, mass: f64) -> bool {
        let size = self.size(ball);
        if size <= tolerance {
            return false;
        }
        let [inner, outer] = Race::BOTH.map(|race| self.pressed(ball, race));
        let (approach, load) = if inner.1 > outer.1 { inner } else { outer };
        // Without a contact any way is too far: it ends in one.
        let depth = approach.max(0.0);
        let gain = step.position_gain();
        let slope = if load > 0.0 { 1.5 * load / depth } else { 0.0 };
        gain * size / (mass + gain * slope) > THROWN * depth
    }
}

/// Solves a ball's own equations to a residual \[N], or as far as that goes.
fn balance(
    from: Vector6<f64>,
    target: f64,
    mut evaluate: impl FnMut(&Vector6<f64>) -> BallAlone,
) -> Vector6<f64> {
    let mut at = from;
    let mut here = evaluate(&at);
    let mut norm = largest(&here.residual);
    let mut evaluations = 1;
    while norm > target && evaluations < MOST {
        let Some(full) = here.tangent.lu().solve(&-here.residual) else {
            break;
        };
        let mut length = 1.0;
        let (next, next_norm) = loop {
            let next = evaluate(&(at + full * length));
            let size = largest(&next.residual);
            evaluations += 1;
            if size < norm * (1.0 - 1e-4 * length) || evaluations >= MOST {
                break (next, size);
            }
            length *= 0.5;
        };
        // Not a number either.
        if next_norm.partial_cmp(&norm) != Some(Ordering::Less) {
            break;
        }
        at += full * length;
        (here, norm) = (next, next_norm);
    }
    if norm.is_finite() { at } else { from }
}
