//! Motion of a bearing's frame, and the forces of inertia in it.
//!
//! Every place and velocity of a scene is then one seen from that frame. With the acceleration `a` of a point of the frame,
//! the arm `e` from there to the frame's origin, its angular velocity `W` and their rates of change, a body of mass m at `r`
//! with the velocity `v` feels `m (g - a - W' x (r + e) - W x (W x (r + e)) - 2 W x v)`; and where it turns with `w` relative to
//! the frame, the moment of momentum that counts is `J (w + W)`.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use crate::numerics::scalar::{Scalar, cross};

/// How the frame of a bearing moves at an instant, and the gravity in it; components along the frame's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameMotion {
    /// [m/s2] gravity.
    pub gravity: Vector3<f64>,
    /// [m/s2] acceleration of the point that the arm begins at.
    pub acceleration: Vector3<f64>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<f64>,
    /// [rad/s2] angular acceleration.
    pub angular_acceleration: Vector3<f64>,
}

impl FrameMotion {
    /// Motion in axes that point along these (1), or are turned by half a turn about z (-1).
    #[must_use]
    pub fn seen_along(&self, direction: f64) -> Self {
        let signs = Vector3::new(direction, direction, 1.0);
        let seen = |vector: &Vector3<f64>| vector.component_mul(&signs);
        Self {
            gravity: seen(&self.gravity),
            acceleration: seen(&self.acceleration),
            angular_velocity: seen(&self.angular_velocity),
            angular_acceleration: seen(&self.angular_acceleration),
        }
    }

    /// All components as one vector, in the order of the fields.
    pub fn components(&self) -> SVector<f64, 12> {
        let vectors = [self.gravity, self.acceleration, self.angular_velocity, self.angular_acceleration];
        SVector::from_fn(|i, _| vectors[i / 3][i % 3])
    }

    /// The motion of these components.
    pub fn of_components(all: &SVector<f64, 12>) -> Self {
        let vector = |first: usize| Vector3::from_fn(|i, _| all[first + i]);
        Self {
            gravity: vector(0),
            acceleration: vector(3),
            angular_velocity: vector(6),
            angular_acceleration: vector(9),
        }
    }

    /// Gravity, acceleration, angular velocity or angular acceleration, by its place among these.
    pub fn vector(&self, quantity: usize) -> &Vector3<f64> {
        match quantity {
            0 => &self.gravity,
            1 => &self.acceleration,
            2 => &self.angular_velocity,
            _ => &self.angular_acceleration,
        }
    }

    /// The same, to be set.
    pub fn vector_mut(&mut self, quantity: usize) -> &mut Vector3<f64> {
        match quantity {
            0 => &mut self.gravity,
            1 => &mut self.acceleration,
            2 => &mut self.angular_velocity,
            _ => &mut self.angular_acceleration,
        }
    }
}

/// The motion of the frame as an input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameInputs {
    /// As set last.
    pub motion: FrameMotion,
    /// Rates of change \[1/s] of the components, where they are known.
    pub rate: FrameMotion,
    /// Is the angular acceleration given? If not, it is that by which the angular velocity changes.
    pub accelerates: bool,
}

impl FrameInputs {
    /// Inputs in axes that point along these (1), or are turned by half a turn about z (-1).
    #[must_use]
    pub fn seen_along(&self, direction: f64) -> Self {
        let [motion, rate] = [&self.motion, &self.rate].map(|of| of.seen_along(direction));
        Self { motion, rate, ..*self }
    }
}

/// A frame that moves, as forces need it, in any axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingFrame<S: Scalar = f64> {
    /// \[m] from the point whose acceleration is given to where places are counted from.
    pub arm: Vector3<S>,
    /// [m/s2] acceleration of that point.
    pub acceleration: Vector3<S>,
    /// [rad/s] angular velocity.
    pub turn: Vector3<S>,
    /// [rad/s2] angular acceleration.
    pub change: Vector3<S>,
}

impl<S: Scalar> MovingFrame<S> {
    /// [m/s2] force of inertia over the mass of a body at a place, with a velocity, both seen from the frame.
    #[inline]
    pub fn field(&self, position: &Vector3<S>, velocity: &Vector3<S>) -> Vector3<S> {
        let from_point = position + self.arm;
        let around = cross(&self.turn, &from_point) + velocity.map(|c| c.scale(2.0));
        -(self.acceleration + cross(&self.change, &from_point) + cross(&self.turn, &around))
    }
}

impl MovingFrame {
    /// That of a motion, with an arm \[m].
    pub fn new(motion: &FrameMotion, arm: Vector3<f64>) -> Self {
        let FrameMotion { acceleration, angular_velocity, angular_acceleration, .. } = *motion;
        Self { arm, acceleration, turn: angular_velocity, change: angular_acceleration }
    }

    /// Centrifugal, Euler and Coriolis terms without the acceleration of the point that places are counted from; none where it does not turn.
    pub fn about_origin(&self) -> Option<Self> {
        let turns = self.turn != Vector3::zeros() || self.change != Vector3::zeros();
        turns.then_some(Self { arm: Vector3::zeros(), acceleration: Vector3::zeros(), ..*self })
    }

    /// Frame with each vector seen otherwise: in other axes, or as numbers that have derivatives.
    #[inline]
    pub fn seen<S: Scalar>(&self, see: impl Fn(&Vector3<f64>) -> Vector3<S>) -> MovingFrame<S> {
        MovingFrame {
            arm: see(&self.arm),
            acceleration: see(&self.acceleration),
            turn: see(&self.turn),
            change: see(&self.change),
        }
    }

    /// [N m] moment of inertia forces on a body with these principal moments of inertia [kg m2] and a rate [rad/s] relative to
    /// the frame, in its own axes. `to_body` turns a vector of the frame into these axes.
    #[inline]
    pub fn moment<S: Scalar>(
        &self,
        inertia: &Vector3<f64>,
        rate: &Vector3<S>,
        to_body: impl Fn(&Vector3<f64>) -> Vector3<S>,
    ) -> Vector3<S> {
        let turn = to_body(&self.turn);
        let change = to_body(&self.change) - cross(rate, &turn);
        let momentum = |rate: &Vector3<S>| Vector3::from_fn(|i, _| rate[i].scale(inertia[i]));
        let whole = rate + turn;
        // The part `rate x J rate` is there without a moving frame, too.
        -(momentum(&change) + cross(&whole, &momentum(&turn)) + cross(&turn, &momentum(rate)))
    }
}
