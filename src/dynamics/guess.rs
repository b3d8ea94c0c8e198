//! First guesses of a step: accelerations and multipliers at its end.

use super::Workspace;
use super::equations::BearingStep;
use super::stages::Foreseen;
use crate::model::Model;
use crate::model::bodies::{Body, Constraint, Race};
use crate::model::state::{State, Trend, stack};
use crate::numerics::arrowhead::{BLOCK, Six};
use crate::numerics::orbit_turn::OrbitTurn;

/// [-] change of the accelerations of balls in a step over their size that a guess may go on with. Balls that come to rest have none that
/// stay: the guess would take them through the bend that friction has there (a bearing at a standstill then took a fifth more
/// corrections, and a fifth more of new blocks).
pub(super) const SMALL: f64 = 0.05;

impl BearingStep<'_> {
    /// First guess: accelerations and multipliers change as they did in the last step, where they have done so smoothly, and stay as they
    /// are elsewhere; those of a ball turn with its orbit.
    pub fn guess_steady_trend(&mut self, unknowns: &mut Vec<f64>) {
        if let Some(Foreseen { unknowns: foreseen, steady }) = self.foreseen {
            unknowns.clone_from(foreseen);
            self.workspace.steady.clone_from(steady);
            return;
        }
        steady_acceleration(self.model, self.start, unknowns);
        let Workspace { steady, expected, .. } = &mut *self.workspace;
        let Trend { step, changes, smooth } = &self.start.trend;
        expected.clear();
        if changes.len() == unknowns.len() {
            expected.extend(changes.iter().map(|change| change * (self.step.h / step)));
        } else {
            expected.resize(unknowns.len(), 0.0);
        }
        let changes = expected.chunks_exact_mut(BLOCK);
        for ((turn, unknowns), change) in
            orbit_turns(self.start, self.step.h).zip(unknowns.chunks_exact_mut(BLOCK)).zip(changes)
        {
            for vector in [unknowns, change] {
                if let Ok(six) = <&mut Six<f64>>::try_from(vector) {
                    *six = turn.stacked(six);
                }
            }
        }
        steady.clone_from(unknowns);
        let group = unknowns.len() / smooth.len().max(1);
        let groups = unknowns.chunks_exact_mut(group.max(1)).zip(expected.chunks_exact(group.max(1)));
        for ((unknowns, changes), _) in groups.zip(smooth).filter(|(_, smooth)| **smooth) {
            unknowns.iter_mut().zip(changes).for_each(|(unknown, change)| *unknown += change);
        }
    }

    /// Second guess, where Newton's method failed from the first: everything keeps its velocity over the step, except for
    /// the spin of race bodies, which is prescribed.
    ///
    /// An acceleration that lasts for less than a step throws contacts far into sliding, where friction hardly depends
    /// on the velocity and Newton's method finds no way back.
    pub fn guess_steady_velocity(&self, unknowns: &mut Vec<f64>) {
        steady_acceleration(self.model, self.start, unknowns);
        let back = -(1.0 - self.step.gamma) / self.step.gamma;
        let (balls, border) = unknowns.split_at_mut(BLOCK * self.start.balls.len());
        balls.iter_mut().for_each(|a| *a *= back);
        if let Some(row) = self.model.spacing_row() {
            border[row] *= back;
        }
        for (body, offset) in Body::ALL.into_iter().zip(self.model.border_offsets()) {
            if let Some(offset) = offset {
                border[offset..offset + BLOCK].iter_mut().for_each(|a| *a *= back);
                // A race on a support has no prescribed spin.
                if let Body::Race(race) = body
                    && self.model.supports[race].is_none()
                {
                    let gained = self.boundary.loads[race].speed - self.start.race(race).rate.x;
                    border[offset + 3] += gained / self.step.velocity_gain() * self.model.race_length();
                }
            }
        }
    }
}

impl Workspace {
    /// Takes over how the accelerations and multipliers of a `solved` step of `h` \[s] have changed, and whether a guess that goes on with
    /// such changes would have been the better one.
    pub(super) fn follow_trend(&self, model: &Model, trend: &mut Trend, solved: &[f64], h: f64) {
        trend.step = h;
        trend.changes.clear();
        trend.changes.extend(solved.iter().zip(&self.steady).map(|(solved, steady)| solved - steady));
        let of_balls = BLOCK * self.balls.len();
        let alone = model.border_size() == 0 && self.neighbours.is_empty();
        let group = if alone { BLOCK } else { of_balls.max(1) };
        let square = |list: &[f64]| list.iter().map(|x| x * x).sum::<f64>();
        let groups = trend.changes[..of_balls].chunks_exact(group).zip(self.expected.chunks_exact(group));
        trend.smooth.clear();
        trend.smooth.extend(groups.zip(self.steady.chunks_exact(group)).map(
            |((changes, expected), steady)| {
                let missed: f64 =
                    changes.iter().zip(expected).map(|(change, e)| (change - e) * (change - e)).sum();
                let change = square(changes);
                missed < change && change < SMALL * SMALL * square(steady)
            },
        ));
    }
}

/// Turns of the orbits of the balls of a state over a time \[s].
pub(super) fn orbit_turns(state: &State, time: f64) -> impl Iterator<Item = OrbitTurn<f64>> {
    let race = state.race(Race::Outer);
    state.balls.iter().map(move |ball| {
        let offset = ball.position - race.pose.position;
        let ahead = offset + (ball.velocity - race.velocity) * time;
        OrbitTurn::between(&offset, &ahead)
    })
}

/// Accelerations and multipliers of a state, as unknowns.
pub(super) fn steady_acceleration(model: &Model, state: &State, unknowns: &mut Vec<f64>) {
    unknowns.clear();
    for ball in &state.balls {
        let angular = ball.angular_acceleration * model.bearing.ball.radius;
        unknowns.extend_from_slice(stack(&ball.acceleration, &angular).as_slice());
    }
    let length = model.race_length();
    for ((_, state), (_, body)) in state.bodies.iter().zip(model.bodies.iter()) {
        if let Some(body) = body {
            unknowns.extend(state.acceleration.iter());
            unknowns.extend(state.rate_derivative.iter().map(|a| a * length));
            let scales = body.constraints.iter().map(|c| multiplier_scale(c, length));
            unknowns.extend(state.multipliers.iter().zip(scales).map(|(m, scale)| m / scale));
        }
    }
    unknowns.extend(state.spacing.as_ref().map(|turn| turn.acceleration * length));
}

/// A multiplier's unknown is a force: moments are divided by the race length.
fn multiplier_scale(constraint: &Constraint, length: f64) -> f64 {
    if matches!(constraint, Constraint::Position(..)) { 1.0 } else { length }
}
