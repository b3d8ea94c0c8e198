//! State of one ball.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::bodies::PerRace;
use super::energies::Pressed;
use crate::contact::BallMotion;
use crate::numerics::motion::Wrench;

/// One ball. It is isotropic, so it has no orientation; those of damaged balls are in [`super::state::State::orientations`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallState {
    /// \[m] centre.
    pub position: Vector3<f64>,
    /// [m/s] velocity of the centre.
    pub velocity: Vector3<f64>,
    /// [rad/s] angular velocity.
    pub angular_velocity: Vector3<f64>,
    /// [m/s2] acceleration of the centre; of a ball that an ideal cage keeps apart, those of its place along the axis and of its distance
    /// from that.
    pub acceleration: Vector3<f64>,
    /// [rad/s2] angular acceleration.
    pub angular_acceleration: Vector3<f64>,
    /// Total force and moment about the centre, the `g` of the HHT scheme: of what `acceleration` is of.
    pub total: Wrench,
    /// Remainder of the equations of motion that the last step left, within their tolerance.
    pub remainder: Wrench,
    /// How it is pressed on the races.
    pub pressed: PerRace<Pressed>,
}

impl BallState {
    /// The motion that contacts depend on.
    pub fn motion(&self) -> BallMotion<f64> {
        BallMotion {
            position: self.position,
            velocity: self.velocity,
            angular_velocity: self.angular_velocity,
        }
    }
}
