//! First guesses of a step: accelerations and multipliers at its end.

use nalgebra::Vector6;

use super::equations::BearingStep;
use crate::model::bodies::{Body, Constraint, Race};
use crate::numerics::arrowhead::BLOCK;
use crate::numerics::orbit_turn::OrbitTurn;

impl BearingStep<'_> {
    /// First guess: accelerations and multipliers stay as they are; those of a ball turn with its orbit.
    pub fn guess_steady_orbit(&self, unknowns: &mut Vec<f64>) {
        self.guess_steady_acceleration(unknowns);
        let race = self.start.race(Race::Outer);
        for (ball, unknowns) in self.start.balls.iter().zip(unknowns.chunks_exact_mut(BLOCK)) {
            let offset = ball.position - race.pose.position;
            let ahead = offset + (ball.velocity - race.velocity) * self.step.h;
            let turn = OrbitTurn::between(&offset, &ahead);
            let guess = turn.stacked(&Vector6::from_row_slice(unknowns));
            unknowns.copy_from_slice(guess.as_slice());
        }
    }

    /// Accelerations and multipliers as they are.
    fn guess_steady_acceleration(&self, unknowns: &mut Vec<f64>) {
        unknowns.clear();
        for ball in &self.start.balls {
            unknowns.extend(ball.acceleration.iter());
            unknowns.extend(ball.angular_acceleration.iter().map(|a| a * self.model.bearing.ball.radius));
        }
        let length = self.model.race_length();
        for ((_, state), (_, body)) in self.start.bodies.iter().zip(self.model.bodies.iter()) {
            if let Some(body) = body {
                unknowns.extend(state.acceleration.iter());
                unknowns.extend(state.rate_derivative.iter().map(|a| a * length));
                let scales = body.constraints.iter().map(|c| multiplier_scale(c, length));
                unknowns.extend(state.multipliers.iter().zip(scales).map(|(m, scale)| m / scale));
            }
        }
    }

    /// Second guess, where Newton's method failed from the first: everything keeps its velocity over the step, except for
    /// the spin of race bodies, which is prescribed.
    ///
    /// An acceleration that lasts for less than a step throws contacts far into sliding, where friction hardly depends
    /// on the velocity and Newton's method finds no way back.
    pub fn guess_steady_velocity(&self, unknowns: &mut Vec<f64>) {
        self.guess_steady_acceleration(unknowns);
        let back = -(1.0 - self.step.gamma) / self.step.gamma;
        let (balls, border) = unknowns.split_at_mut(BLOCK * self.start.balls.len());
        balls.iter_mut().for_each(|a| *a *= back);
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

/// A multiplier's unknown is a force: moments are divided by the race length.
fn multiplier_scale(constraint: &Constraint, length: f64) -> f64 {
    if matches!(constraint, Constraint::Position(..)) { 1.0 } else { length }
}
