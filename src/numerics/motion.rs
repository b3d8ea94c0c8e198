//! Pose, twist and wrench of a rigid body, in world axes.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::scalar::{Scalar, constant_vector};

/// Position and orientation of a body frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// \[m] origin.
    pub position: Vector3<f64>,
    /// [-] rotation from body to world axes.
    pub orientation: UnitQuaternion<f64>,
}

/// Velocity of a body frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// [m/s] of the origin.
    pub velocity: Vector3<f64>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<f64>,
}

/// Place of the frame that a race on a hinge is held in, beside what a script says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameInput {
    /// \[m] origin.
    pub position: Vector3<f64>,
    /// \[rad] rotation vector of its axis; x is not used.
    pub tilt: Vector3<f64>,
}

/// Force and moment about a body's origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "S: Serialize", deserialize = "S: Deserialize<'de>"))]
pub struct Wrench<S: Scalar = f64> {
    /// \[N] force.
    pub force: Vector3<S>,
    /// [N m] moment.
    pub moment: Vector3<S>,
}

impl<S: Scalar> Default for Wrench<S> {
    fn default() -> Self {
        Self { force: constant_vector(&Vector3::zeros()), moment: constant_vector(&Vector3::zeros()) }
    }
}

impl Default for Pose {
    fn default() -> Self {
        Self { position: Vector3::zeros(), orientation: UnitQuaternion::identity() }
    }
}

impl Twist {
    /// Power of a wrench on this motion \[W].
    pub fn power(&self, wrench: &Wrench) -> f64 {
        self.velocity.dot(&wrench.force) + self.angular_velocity.dot(&wrench.moment)
    }
}

impl Wrench {
    /// The sum with another one about the same point.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self { force: self.force + other.force, moment: self.moment + other.moment }
    }

    /// `(1 - t) self + t other`.
    pub fn blend(&self, other: &Self, t: f64) -> Self {
        Self { force: self.force.lerp(&other.force, t), moment: self.moment.lerp(&other.moment, t) }
    }
}
