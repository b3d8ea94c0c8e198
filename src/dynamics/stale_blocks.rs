//! Which blocks of the Newton matrix are computed anew: each where the corrections that it was not good enough for have cost as much as
//! it does.
//!
//! The rows of the bodies are computed anew with any block, and where they alone are out of date.
//!
//! Balls of all bearings that a border joins are corrected together: one whose block is out of date costs all of them another correction.

use super::equations::BearingStep;
use crate::model::state::{BlockRenewal, KeptBlock};
use crate::numerics::elementary::ln;
use crate::numerics::size::larger;

/// [-] price of one more correction, per ball, over that of a new block (benches/speed.rs): where balls are solved together and all
/// are evaluated, and where each is alone. With twice that, balls together take 7 % more time in the radial and the cage scene.
const TOGETHER: f64 = 0.05;
const ALONE: f64 = 0.2;
/// Most steps in a row that begin with a new block before an old one is tried again.
const LONGEST_PAUSE: u8 = 31;
/// [-] most corrections that are foreseen.
const MOST: f64 = 20.0;

impl BlockRenewal {
    /// Shall blocks of a `cost` be new, as one or as many, for what is saved in this step and what was not in earlier ones?
    /// If not, this block has cost some more.
    fn renew(&mut self, cost: f64, saved: f64, lost: f64, more: f64) -> bool {
        // One that is new and leads badly tells that no block is good for long here.
        if self.new || saved + lost < cost {
            self.price += more;
            return false;
        }
        if saved >= cost {
            self.back_off();
        }
        true
    }

    /// Lets the next steps begin with a new one: twice as many as the last time, unless an old one was good since then.
    fn back_off(&mut self) {
        self.pause = (2 * self.pause + 1).min(LONGEST_PAUSE);
        self.due = self.pause;
    }
}

/// Outcome of a correction of balls that are solved together.
#[derive(Clone, Copy, Debug, Default)]
struct Progress {
    /// Number of balls.
    balls: usize,
    /// [-] largest component of a residual over its tolerance before it.
    before: f64,
    /// Balls that are not solved yet.
    bad: f64,
    /// Most corrections that one of them is to take yet with its block.
    most: f64,
    /// Price of their blocks.
    price: f64,
}

/// Marks the balls whose blocks shall be computed anew, after a correction that has not led to the solution.
///
/// From how far the last one has come it follows how many more are needed with the blocks there are. New ones lead there
/// in one more; and what they would have saved in earlier steps counts as well.
pub(super) fn mark(bearings: &mut [BearingStep<'_>]) {
    let mut progress = Progress::default();
    for step in bearings.iter() {
        progress.balls += step.workspace.balls.len();
        progress.before = step.workspace.balls.iter().map(|trial| trial.before).fold(progress.before, larger);
    }
    for step in bearings.iter_mut().filter(|step| step.keeps_matrices()) {
        step.mark_unsolved(&mut progress);
    }
    for step in bearings.iter_mut().filter(|step| step.keeps_matrices()) {
        step.mark_stale(&progress);
    }
}

impl BearingStep<'_> {
    /// Marks the balls whose blocks shall be new from the beginning of a step.
    pub(super) fn mark_due(&mut self) {
        let (balls, kept) = (&mut self.workspace.balls, &mut self.workspace.kept);
        for (trial, KeptBlock { renewal, .. }) in balls.iter_mut().zip(&mut kept.balls) {
            if !renewal.new {
                renewal.pause = 0;
            }
            renewal.new = false;
            trial.renewed = renewal.due > 0;
            renewal.due = renewal.due.saturating_sub(1);
        }
        let rows = self.model.border_size();
        if rows > 0 && self.workspace.kept.border.rows.len() == rows * rows {
            self.take_up_border();
        }
    }

    /// Shall the rows of the bodies be new after a correction that has not led to the solution, though no block is? They cost a tenth of what
    /// a correction does, so as soon as that saves one. What they lead to is seen in these rows alone: those of balls are met whatever the
    /// bodies do.
    pub(super) fn rows_are_stale(&self) -> bool {
        let [now, before] = self.of_bodies;
        // As much is left of what is left as of what was before.
        !self.renewed_rows && !self.balls_are_independent() && now > 1.0 && now * now > before
    }

    /// Notes which old blocks have led nowhere, before all are computed anew.
    pub(super) fn give_up_old(&mut self) {
        let tolerance = self.force_tolerance;
        let workspace = &mut *self.workspace;
        let balls = workspace.balls.iter().zip(&mut workspace.kept.balls);
        for (ball, (trial, KeptBlock { renewal, .. })) in balls.enumerate() {
            if !renewal.new && trial.before > 1.0 && workspace.groups.size(ball) > tolerance {
                renewal.back_off();
            }
        }
    }

    /// Marks the balls that are not solved, or those of them whose blocks are out of date where each is alone; adds the others to what all have come to.
    fn mark_unsolved(&mut self, progress: &mut Progress) {
        let together = !self.balls_are_independent();
        let tolerance = self.force_tolerance;
        let workspace = &mut *self.workspace;
        let balls = workspace.balls.iter_mut().zip(&mut workspace.kept.balls);
        for (ball, (trial, kept)) in balls.enumerate() {
            let now = workspace.groups.size(ball) / tolerance;
            trial.renewed = now > 1.0;
            if !trial.renewed {
                continue;
            }
            let rate = now / if together { progress.before } else { trial.before };
            let more = if rate < 1.0 { (ln(now) / -ln(rate)).ceil().min(MOST) } else { MOST };
            if together {
                progress.bad += 1.0;
                progress.most = progress.most.max(more);
                progress.price += kept.renewal.price;
            } else {
                trial.renewed = kept.renewal.renew(1.0, ALONE * (more - 1.0), kept.renewal.price, ALONE);
            }
        }
    }

    /// Leaves those of the unsolved balls marked whose blocks are out of date, where they are solved together.
    fn mark_stale(&mut self, progress: &Progress) {
        if self.balls_are_independent() {
            return;
        }
        let Progress { balls, bad, most, price, .. } = *progress;
        let correction = TOGETHER * balls as f64;
        let workspace = &mut *self.workspace;
        let balls = workspace.balls.iter_mut().zip(&mut workspace.kept.balls);
        for (trial, kept) in balls.filter(|(trial, _)| trial.renewed) {
            trial.renewed = kept.renewal.renew(bad, correction * (most - 1.0), price, correction / bad);
        }
    }
}
