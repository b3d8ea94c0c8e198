//! Local error of a step, and where it or the residual is largest.

use nalgebra::Vector3;

use super::body::BodyTrial;
use super::equations::BearingStep;
use super::failure::Worst;
use crate::model::bodies::Body;
use crate::model::state::BodyState;
use crate::numerics::size::largest;

/// A vector at start and end of a step.
type Ends<'a> = (&'a Vector3<f64>, &'a Vector3<f64>);

impl BearingStep<'_> {
    /// Bodies with unknowns: state at the start, and trial.
    fn moved(&self) -> impl Iterator<Item = (Body, &BodyState, &BodyTrial)> {
        let bodies = self.start.bodies.iter().zip(self.workspace.bodies.iter());
        let bodies = bodies.filter_map(|((body, start), (_, trial))| Some((body, start, trial.as_ref()?)));
        // The error of a carried race is that of its structure.
        bodies.filter(|(_, _, trial)| !trial.is_carried())
    }

    /// Where the residual is largest.
    pub fn worst_residual(&self) -> Worst {
        let tolerance = self.force_tolerance;
        let balls = (0..self.start.balls.len()).map(|ball| self.workspace.groups.size(ball) / tolerance);
        // A sum that is not a number wins over any violation.
        let bodies = self.moved().map(|(body, _, trial)| {
            let residual = largest(trial.residual.rows(0, 6).iter()) / tolerance;
            (body, if trial.violation > residual { trial.violation } else { residual })
        });
        Worst::of(balls, bodies)
    }

    /// Weighted root mean square of the local error of all positions, over its tolerance.
    pub fn local_error(&self) -> f64 {
        let squares = self.ball_errors().chain(self.body_errors().map(|(_, square)| square));
        let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 6.0));
        (sum / count).sqrt()
    }

    /// Where the local error is largest.
    pub fn worst_error(&self) -> Worst {
        Worst::of(self.ball_errors(), self.body_errors())
    }

    /// Square of the local error of every ball over its tolerance; rotations count as displacements at its surface.
    fn ball_errors(&self) -> impl Iterator<Item = f64> {
        let radius = self.model.bearing.ball.radius;
        self.start.balls.iter().enumerate().map(move |(ball, start)| {
            let unknowns = self.workspace.groups.unknowns(ball);
            let acceleration = unknowns.fixed_rows::<3>(0).into_owned();
            let angular = unknowns.fixed_rows::<3>(3).into_owned();
            self.square(
                (&start.acceleration, &acceleration),
                (&(start.angular_acceleration * radius), &angular),
            )
        })
    }

    /// Square of the local error of every body over its tolerance; rotations count as displacements at the pitch circle.
    fn body_errors(&self) -> impl Iterator<Item = (Body, f64)> {
        let length = self.model.race_length();
        self.moved().map(move |(body, start, trial)| {
            let angular = [start, &trial.end].map(|state| state.rate_derivative * length);
            let linear = (&start.acceleration, &trial.end.acceleration);
            (body, self.square(linear, (&angular[0], &angular[1])))
        })
    }

    /// Square of the local error, from linear and angular accelerations [m/s2] at both ends of the step.
    fn square(&self, linear: Ends<'_>, angular: Ends<'_>) -> f64 {
        let scale = self.model.solver.tolerance * 2.0 * self.model.bearing.ball.radius;
        let error = |ends: Ends<'_>| self.step.local_error(ends.0, ends.1).norm_squared();
        (error(linear) + error(angular)) / (scale * scale)
    }
}
