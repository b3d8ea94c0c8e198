//! Rotation of a body in a trial step, with derivatives by the body's own unknowns or without.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::directions::{D, SECOND_ROTATION};
use crate::numerics::rotation::{conformal_product, from_rotation_vector, rotate, turn_back_by, turn_by};
use crate::numerics::scalar::{Dual, Scalar, constant_vector};

/// A number with derivatives by three of a body's own unknowns: of its rotation, or of its translation.
pub type Own = Dual<3>;

/// Rotation of a body over a step, and what follows from it.
#[derive(Clone, Copy, Debug)]
pub struct StepTurn<S: Scalar> {
    /// Conformal rotation vector of the step (paper section 2).
    pub rotation: Vector3<S>,
    /// [rad/s] material angular velocity.
    pub rate: Vector3<S>,
    /// [rad/s2] material angular acceleration.
    pub rate_derivative: Vector3<S>,
    /// [-] the body's own axis, world axes.
    pub axis: Vector3<S>,
    /// [rad/s] angular velocity, world axes.
    pub angular_velocity: Vector3<S>,
    /// Orientation at the start of the step.
    start: UnitQuaternion<f64>,
    /// Orientation at the start of the step, as a matrix.
    start_axes: Matrix3<f64>,
}

impl StepTurn<f64> {
    /// Turn without derivatives, as numbers that could have some.
    pub fn constant<S: Scalar>(&self) -> StepTurn<S> {
        let Self { start, start_axes, .. } = *self;
        let [rotation, rate, rate_derivative, axis, angular_velocity] =
            [self.rotation, self.rate, self.rate_derivative, self.axis, self.angular_velocity]
                .map(|v| constant_vector(&v));
        StepTurn { rotation, rate, rate_derivative, axis, angular_velocity, start, start_axes }
    }
}

impl<S: Scalar> StepTurn<S> {
    /// A turn of a rotation vector \[rad] in the body's axes at the start of a step, with material angular velocity [rad/s] and
    /// acceleration [rad/s2] at its end.
    pub fn new(
        turn_vector: &Vector3<S>,
        rate: Vector3<S>,
        rate_derivative: Vector3<S>,
        start: UnitQuaternion<f64>,
    ) -> Self {
        let zero = Vector3::from_element(S::zero());
        let rotation = from_rotation_vector(turn_vector);
        let start_axes = start.to_rotation_matrix().into_inner();
        let mut turned =
            Self { rotation, rate, rate_derivative, axis: zero, angular_velocity: zero, start, start_axes };
        turned.axis = turned.own_axis(0);
        turned.angular_velocity = turned.spatial(&rate);
        turned
    }

    /// One of the body's own axes, world axes.
    pub fn own_axis(&self, axis: usize) -> Vector3<S> {
        let component = |i: usize| S::constant(if i == axis { 1.0 } else { 0.0 });
        self.spatial(&Vector3::new(component(0), component(1), component(2)))
    }

    /// Conformal vector of the body's rotation relative to an orientation, in the axes of that.
    pub fn relative_to(&self, orientation: &UnitQuaternion<f64>) -> Vector3<S> {
        conformal_product(&(orientation.inverse() * self.start), &self.rotation)
    }

    /// A vector in world axes, from one in the body's own.
    pub fn spatial(&self, material: &Vector3<S>) -> Vector3<S> {
        turn_by(&self.start_axes, &rotate(&self.rotation, material))
    }

    /// A vector in the body's own axes, from one in world axes.
    pub fn material(&self, spatial: &Vector3<S>) -> Vector3<S> {
        rotate(&-self.rotation, &turn_back_by(&self.start_axes, spatial))
    }
}

/// Vectors with derivatives by a body's rotation, as those of the second body of a pair.
pub fn as_second(v: &Vector3<Own>) -> Vector3<D> {
    v.map(|own| {
        let mut second = D::constant(own.value);
        second.derivatives[SECOND_ROTATION..].copy_from_slice(&own.derivatives);
        second
    })
}
