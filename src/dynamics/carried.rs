//! A race that a structure carries, such as a shaft: its motion from the coordinates of its seat, with derivatives.

use nalgebra::{Matrix3, Vector3};

use super::directions::{D, SECOND_ROTATION};
use crate::contact::RaceMotion;
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::{Pose, Twist};
use crate::numerics::scalar::{Dual, Scalar, constant_vector};
use crate::numerics::tilt::{self, columns_of_small};

/// Motion of a seat in the bearing's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeatMotion {
    /// \[m] place of the race's origin.
    pub position: Vector3<f64>,
    /// [m/s] its velocity.
    pub velocity: Vector3<f64>,
    /// [m/s2] its acceleration.
    pub acceleration: Vector3<f64>,
    /// \[rad] turn and tilts, the coordinates of [`tilt`]; tilts are below [`tilt::SMALL`].
    pub angles: Vector3<f64>,
    /// [rad/s] their rates.
    pub rates: Vector3<f64>,
}

impl SeatMotion {
    /// Angular velocity by the rates of the angles; the first column is the race's axis.
    pub fn columns(&self) -> Matrix3<f64> {
        Matrix3::from_columns(&columns_of_small(&self.angles))
    }

    /// Pose of the race.
    pub fn pose(&self) -> Pose {
        Pose { position: self.position, orientation: tilt::orientation(&self.angles) }
    }

    /// Twist of the race.
    pub fn twist(&self) -> Twist {
        Twist { velocity: self.velocity, angular_velocity: self.columns() * self.rates }
    }

    /// Motion as the balls see it, with derivatives by the rotation: by an angular acceleration in world axes, times `length` \[m], that
    /// the accelerations of the angles add up to.
    pub(super) fn differentiated(&self, step: &HhtStep, length: f64, across: Vector3<f64>) -> RaceMotion<D> {
        // Singular where the axis has turned by half a turn.
        let by_world = self.columns().try_inverse().unwrap_or_else(Matrix3::identity);
        let variable = |values: &Vector3<f64>, gain: f64| {
            Vector3::from_fn(|i, _| {
                let mut variable = D::constant(values[i]);
                for k in 0..3 {
                    variable.derivatives[SECOND_ROTATION + k] = by_world[(i, k)] * (gain / length);
                }
                variable
            })
        };
        let (angles, rates) =
            (variable(&self.angles, step.position_gain()), variable(&self.rates, step.velocity_gain()));
        let [turn, about_y, about_z] = columns_of_small(&angles);
        let by = |column: Vector3<D>, rate: D| column.map(|component| component * rate);
        RaceMotion {
            position: constant_vector(&self.position),
            axis: turn,
            across,
            velocity: constant_vector(&self.velocity),
            angular_velocity: by(turn, rates[0]) + by(about_y, rates[1]) + by(about_z, rates[2]),
        }
    }

    /// [N m] generalised moments of a moment in world axes on the angles, and their derivatives by the angles.
    pub fn generalised(&self, moment: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let angles = Vector3::from_fn(|i, _| Dual::<3>::variable(self.angles[i], i, 1.0));
        let of_column = |column: Vector3<Dual<3>>| {
            let moment = constant_vector::<Dual<3>>(moment);
            column[0] * moment[0] + column[1] * moment[1] + column[2] * moment[2]
        };
        let moments = columns_of_small(&angles).map(of_column);
        (Vector3::from_fn(|i, _| moments[i].value), Matrix3::from_fn(|i, k| moments[i].derivatives[k]))
    }
}
