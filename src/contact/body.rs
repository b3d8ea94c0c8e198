//! Motion of a body with its axes, for contacts of the cage.

use nalgebra::Vector3;

use crate::numerics::scalar::{Scalar, constant_vector};

/// Motion of a rigid body, in world axes.
#[derive(Clone, Copy, Debug)]
pub struct BodyMotion<S: Scalar> {
    /// \[m] origin.
    pub position: Vector3<S>,
    /// [-] unit vectors of the body's own axes.
    pub axes: [Vector3<S>; 3],
    /// [m/s] velocity of the origin.
    pub velocity: Vector3<S>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<S>,
}

impl BodyMotion<f64> {
    /// The same motion without derivatives, as numbers that could have some.
    pub fn constant<S: Scalar>(&self) -> BodyMotion<S> {
        BodyMotion {
            position: constant_vector(&self.position),
            axes: self.axes.each_ref().map(constant_vector),
            velocity: constant_vector(&self.velocity),
            angular_velocity: constant_vector(&self.angular_velocity),
        }
    }
}
