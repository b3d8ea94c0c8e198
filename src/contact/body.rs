//! What contacts of the cage have in common: the motion of a body with its axes, and damping.

use nalgebra::Vector3;

use crate::numerics::scalar::Scalar;

/// Motion of a rigid body, in world axes.
#[derive(Clone, Copy, Debug)]
pub struct BodyMotion<S: Scalar> {
    /// [m] origin.
    pub position: Vector3<S>,
    /// [-] unit vectors of the body's own axes.
    pub axes: [Vector3<S>; 3],
    /// [m/s] velocity of the origin.
    pub velocity: Vector3<S>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<S>,
}

/// [N] elastic load with Hunt-Crossley dissipation `chi` [s/m], never pulling.
#[inline(always)]
pub fn damped<S: Scalar>(elastic: S, approach_rate: S, dissipation: f64) -> S {
    (elastic * (S::one() + approach_rate.scale(dissipation))).positive_part()
}
