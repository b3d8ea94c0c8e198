//! Motions of bodies that touch: of balls, of races, and of bodies with axes, such as the cage.

use nalgebra::Vector3;

use crate::numerics::scalar::Scalar;

/// Motion of a ball, in world axes.
#[derive(Clone, Copy, Debug)]
pub struct BallMotion<S: Scalar> {
    /// \[m] centre.
    pub position: Vector3<S>,
    /// [m/s] velocity of the centre.
    pub velocity: Vector3<S>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<S>,
}

impl BallMotion<f64> {
    /// A ball at the origin that does not move.
    pub fn at_rest() -> Self {
        Self { position: Vector3::zeros(), velocity: Vector3::zeros(), angular_velocity: Vector3::zeros() }
    }
}

impl<S: Scalar> BallMotion<S> {
    /// Motion in other numbers.
    #[inline(always)]
    pub fn map<T: Scalar>(&self, number: impl Fn(S) -> T) -> BallMotion<T> {
        BallMotion {
            position: self.position.map(&number),
            velocity: self.velocity.map(&number),
            angular_velocity: self.angular_velocity.map(&number),
        }
    }
}

/// Motion of a race, in world axes.
#[derive(Clone, Copy, Debug)]
pub struct RaceMotion<S: Scalar> {
    /// \[m] origin of the race frame.
    pub position: Vector3<S>,
    /// [-] unit vector of the race's own axis.
    pub axis: Vector3<S>,
    /// [-] unit vector of the race's own y axis, which azimuths on it are counted from. Plain numbers: as derivatives it costs
    /// more than 1 % of a step in every scene, and its turn changes too little within a step for Newton's method to notice.
    pub across: Vector3<f64>,
    /// [m/s] velocity of the origin.
    pub velocity: Vector3<S>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<S>,
}

impl Default for RaceMotion<f64> {
    /// At rest at the origin.
    fn default() -> Self {
        let zero = Vector3::zeros();
        Self {
            position: zero,
            axis: Vector3::x(),
            across: Vector3::y(),
            velocity: zero,
            angular_velocity: zero,
        }
    }
}

impl<S: Scalar> RaceMotion<S> {
    /// A race that rests: origin \[m], its own axis and its own y axis.
    pub fn resting(position: Vector3<S>, axis: Vector3<S>, across: Vector3<f64>) -> Self {
        let still = Vector3::from_element(S::zero());
        Self { position, axis, across, velocity: still, angular_velocity: still }
    }

    /// Motion in other numbers.
    #[inline(always)]
    pub fn map<T: Scalar>(&self, number: impl Fn(S) -> T) -> RaceMotion<T> {
        RaceMotion {
            position: self.position.map(&number),
            axis: self.axis.map(&number),
            across: self.across,
            velocity: self.velocity.map(&number),
            angular_velocity: self.angular_velocity.map(&number),
        }
    }
}

impl RaceMotion<f64> {
    /// Motion as numbers that could have derivatives, or one for each lane.
    #[inline(always)]
    pub fn constant<S: Scalar>(&self) -> RaceMotion<S> {
        self.map(S::constant)
    }
}

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

impl<S: Scalar> BodyMotion<S> {
    /// Motion in other numbers.
    #[inline(always)]
    pub fn map<T: Scalar>(&self, number: impl Fn(S) -> T) -> BodyMotion<T> {
        BodyMotion {
            position: self.position.map(&number),
            axes: self.axes.each_ref().map(|axis| axis.map(&number)),
            velocity: self.velocity.map(&number),
            angular_velocity: self.angular_velocity.map(&number),
        }
    }
}

impl BodyMotion<f64> {
    /// Motion without derivatives, as numbers that could have some.
    pub fn constant<S: Scalar>(&self) -> BodyMotion<S> {
        self.map(S::constant)
    }
}
