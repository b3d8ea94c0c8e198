//! Local error of a step, and which ball a failure is laid to.

use nalgebra::Vector3;

use super::equations::BearingStep;

impl BearingStep<'_> {
    /// The ball with the largest residual.
    pub fn worst_ball(&self) -> usize {
        let norms = self.workspace.balls.iter().map(|ball| ball.residual.amax());
        // A residual that is not a number is the worst.
        let worse = |a: f64, b: f64| if a.is_nan() { true } else { a > b };
        let mut worst = (0, f64::NEG_INFINITY);
        for (index, norm) in norms.enumerate() {
            if worse(norm, worst.1) {
                worst = (index, norm);
            }
        }
        worst.0
    }

    /// Weighted root mean square of the local error of all positions, over its tolerance; and the ball with the
    /// largest share. Rotations count as displacements at the ball's surface and at the pitch circle.
    pub fn local_error(&self) -> (f64, usize) {
        let ball_radius = self.model.bearing.ball.radius;
        let scale = self.model.solver.tolerance * 2.0 * ball_radius;
        let (mut sum, mut count) = (0.0, 0.0);
        let mut worst = (0, -1.0);
        for (index, (start, trial)) in self.start.balls.iter().zip(&self.workspace.balls).enumerate() {
            let acceleration = trial.unknowns.fixed_rows::<3>(0).into_owned();
            let angular: Vector3<f64> = trial.unknowns.fixed_rows::<3>(3).into_owned();
            let translation = self.step.local_error(&start.acceleration, &acceleration);
            let rotation = self.step.local_error(&(start.angular_acceleration * ball_radius), &angular);
            let square = (translation.norm_squared() + rotation.norm_squared()) / (scale * scale);
            if square > worst.1 {
                worst = (index, square);
            }
            sum += square;
            count += 6.0;
        }
        let length = self.model.race_length();
        let races = self.start.races.iter().zip(self.workspace.races.iter().map(Option::as_ref));
        let cage = self.workspace.cage.as_ref().map(|cage| &cage.body);
        for (start, trial) in races.chain(self.start.cage.iter().zip(std::iter::once(cage))) {
            if let Some(trial) = trial {
                let translation = self.step.local_error(&start.acceleration, &trial.end.acceleration);
                let angular = trial.end.rate_derivative * length;
                let rotation = self.step.local_error(&(start.rate_derivative * length), &angular);
                sum += (translation.norm_squared() + rotation.norm_squared()) / (scale * scale);
                count += 6.0;
            }
        }
        ((sum / count).sqrt(), worst.0)
    }
}
