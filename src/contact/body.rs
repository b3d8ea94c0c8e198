//! Motion of a body with its axes and forces of a pair of bodies, for contacts of the cage.

use nalgebra::Vector3;

use crate::scalar::{Scalar, Single, values};

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

/// Forces between a first and a second body, world axes. The force on the second is the opposite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyContact<S: Scalar> {
    /// \[m] approach.
    pub approach: S,
    /// \[N] normal load.
    pub load: S,
    /// \[N] force on the first body.
    pub force: Vector3<S>,
    /// [N m] moment on the first body about its origin.
    pub moment: Vector3<S>,
    /// [N m] moment on the second body about its origin.
    pub other_moment: Vector3<S>,
    /// \[W] power lost to friction.
    pub friction_power: S,
    /// \[W] power lost to contact damping.
    pub damping_power: S,
}

impl<S: Single> BodyContact<S> {
    /// Values without derivatives.
    pub fn values(&self) -> BodyContact<f64> {
        BodyContact {
            approach: self.approach.value(),
            load: self.load.value(),
            force: values(&self.force),
            moment: values(&self.moment),
            other_moment: values(&self.other_moment),
            friction_power: self.friction_power.value(),
            damping_power: self.damping_power.value(),
        }
    }
}
