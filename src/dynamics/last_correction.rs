//! A last correction of balls, without evaluation, in a step that is solved.
//!
//! The residual that Newton's method leaves, up to its tolerance, makes stiff contacts swing, and the next guess misses by many times that.
//! Without it the guess is mostly the solution where all goes on evenly, and a step takes one evaluation. Powers and elastic energy of the
//! step are those of its contacts as they were evaluated, within the tolerance.

use super::Workspace;
use super::equations::BearingStep;
use super::guess::SMALL;
use crate::model::state::KeptBlock;
use crate::numerics::arrowhead::BLOCK;

/// [-] part of a residual which a correction leaves, above which the last one leaves too much for the next guess to be the solution.
const WORN: f64 = 0.01;
/// [-] price of such a correction over that of a new block: where new ones do not help, they cost little.
const PRICE: f64 = 1.0 / 50.0;
/// [-] part of a residual that a correction may leave where another one is not evaluated.
const GOOD: f64 = 0.1;

impl BearingStep<'_> {
    /// Corrects the balls between races of prescribed motion once more where the step is solved. Their forces follow as the blocks of the
    /// matrix say.
    ///
    /// Blocks must be as good as when they were used last. So a ball stays where it is if its acceleration has changed by much in the
    /// step, or if a correction in this step has left much of its residual.
    pub(super) fn correct_once_more(&mut self, unknowns: &mut [f64]) {
        if !self.balls_are_independent() || !self.keeps_matrices() {
            return;
        }
        self.charge_stale();
        let mut correction = std::mem::take(&mut self.workspace.last_correction);
        correction.resize(unknowns.len(), 0.0);
        if self.correct_balls(&mut correction, |ball, size| self.goes_on_evenly(ball, size, unknowns)) {
            unknowns.iter_mut().zip(&correction).for_each(|(unknown, more)| *unknown += more);
            self.workspace.groups.settle(unknowns);
            self.workspace.settled = true;
        }
        self.workspace.last_correction = correction;
    }

    /// May a ball with a residual of this `size` \[N] be corrected without evaluation?
    fn goes_on_evenly(&self, ball: usize, size: f64, unknowns: &[f64]) -> bool {
        let before = self.workspace.balls[ball].before;
        if before > 1.0 && size > GOOD * before * self.force_tolerance {
            return false;
        }
        let own = BLOCK * ball..BLOCK * (ball + 1);
        let (mut change, mut whole) = (0.0, 0.0);
        for (now, steady) in unknowns[own.clone()].iter().zip(&self.workspace.steady[own]) {
            change += (now - steady) * (now - steady);
            whole += steady * steady;
        }
        change < SMALL * SMALL * whole
    }

    /// Charges blocks with corrections that have left too much. The next step begins with a new one where they have cost as much.
    fn charge_stale(&mut self) {
        let most = WORN * self.force_tolerance;
        let Workspace { balls, groups, kept, .. } = &mut *self.workspace;
        for (ball, (trial, KeptBlock { renewal, .. })) in balls.iter().zip(&mut kept.balls).enumerate() {
            if trial.before > 1.0 && groups.size(ball) > most * trial.before {
                renewal.price += PRICE;
                if renewal.price >= 1.0 {
                    renewal.due = renewal.due.max(1);
                }
            }
        }
    }
}
