//! How the motion of a race is given: which of its quantities are inputs, and inputs from their components.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::{Causality, InputError};
use crate::model::bodies::Race;
use crate::numerics::tilt;
use crate::scene::{Drive, Group, Orientation};
use crate::simulation::inputs::{AxisInput, RaceInput};

/// Setting of the motion of a race by the scene.
#[derive(Clone, Copy, Debug)]
pub struct RaceMotion {
    /// How it gets its motion.
    pub drive: Drive,
    /// How its orientation is written.
    pub orientation: Orientation,
    /// Does a script give its speed or its tilt at all times?
    pub scripted_speed: bool,
    /// Is it moved by a shaft or a housing, whatever its drive?
    pub carried: bool,
}

impl RaceMotion {
    /// Pose and twist: inputs where they are given, outputs where forces move the race.
    pub(super) fn pose(self) -> Option<Causality> {
        match self.drive {
            _ if self.carried => Some(Causality::Output),
            Drive::Pose => Some(Causality::Input),
            Drive::Wrench | Drive::Hinge => Some(Causality::Output),
            Drive::Fixed => None,
        }
    }

    /// Those of one form of orientation.
    pub(super) fn pose_as(self, orientation: Orientation) -> Option<Causality> {
        self.pose().filter(|_| self.orientation == orientation)
    }

    pub(super) fn output(self, drives: &[Drive]) -> Option<Causality> {
        drives.contains(&self.drive).then_some(Causality::Output)
    }

    pub(super) fn input(self, drives: &[Drive]) -> Option<Causality> {
        drives.contains(&self.drive).then_some(Causality::Input)
    }

    /// The prescribed speed: not where the angular velocity is given instead, or a script says it.
    pub(super) fn speed(self) -> Option<Causality> {
        let given = match self.drive {
            _ if self.carried => false,
            Drive::Wrench => true,
            Drive::Pose => self.orientation == Orientation::Shaft,
            Drive::Fixed | Drive::Hinge => !self.scripted_speed,
        };
        given.then_some(Causality::Input)
    }
}

/// How a quantity of a race is an input.
#[derive(Clone, Copy, Debug)]
pub struct InputAccess {
    /// \[unit] component as set last.
    pub get: fn(&RaceInput, usize) -> f64,
    /// Sets a component and its rate [unit, unit/s].
    pub set: fn(&mut RaceSetting, usize, f64, f64),
    /// [unit/s] rate of a component as set last.
    pub rate: fn(&RaceInput, usize) -> f64,
    /// Kind of the quantity.
    pub kind: InputKind,
    /// Group that it is given with.
    pub group: Group,
}

/// Kinds of inputs: what a small change of one is measured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// \[m] a translation.
    Displacement,
    /// [-] a component of a unit quaternion.
    Quaternion,
    /// \[rad] an angle.
    Angle,
    /// [m/s] a velocity.
    Velocity,
    /// [rad/s] an angular velocity.
    AngularVelocity,
    /// \[N] a force.
    Force,
    /// [N m] a moment.
    Moment,
    /// [-] a friction coefficient.
    Friction,
    /// \[K] a rise of temperature.
    Temperature,
}

/// Inputs of a race while they are being set, component by component.
#[derive(Debug)]
pub struct RaceSetting {
    /// All but the orientation.
    pub input: RaceInput,
    pub(super) quaternion: [Option<f64>; 4],
    pub(super) angles: [Option<f64>; 3],
    pub(super) axis: AxisInput,
    pub(super) tilted: bool,
}

/// [-] deviation of a quaternion's norm from 1 that is corrected; more is refused.
pub const NORM_TOLERANCE: f64 = 1e-3;

impl RaceSetting {
    /// Begins with the inputs of `base`.
    pub fn new(base: &RaceInput) -> Self {
        let axis = base.axis.unwrap_or_default();
        Self { input: *base, quaternion: [None; 4], angles: [None; 3], axis, tilted: false }
    }

    /// The inputs, with the orientation whose components were set.
    ///
    /// # Errors
    /// If the quaternion is far from unit length.
    pub fn finish(mut self, race: Race) -> Result<RaceInput, InputError> {
        if let [Some(w), Some(x), Some(y), Some(z)] = self.quaternion {
            let quaternion = Quaternion::new(w, x, y, z);
            let norm = quaternion.norm();
            let connected = norm != 0.0;
            if connected && (norm - 1.0).abs() > NORM_TOLERANCE {
                return Err(InputError::Quaternion { name: format!("{}.orientation", race.name()), norm });
            }
            // Masters that have not connected an input yet leave it at zero.
            self.input.pose.orientation = if connected {
                UnitQuaternion::new_normalize(quaternion)
            } else {
                UnitQuaternion::identity()
            };
        }
        if let [Some(x), Some(y), Some(z)] = self.angles {
            self.input.pose.orientation = from_cardan(x, y, z);
        }
        self.input.axis = self.tilted.then_some(self.axis);
        if let Some(axis) = self.input.axis {
            // Its turn is not known here; nothing but the path of the race asks for it.
            self.input.pose.orientation = tilt::orientation(&axis.tilt);
            self.input.twist.angular_velocity = tilt::angular_velocity(&axis.tilt, &axis.rate);
        }
        Ok(self.input)
    }
}

/// Orientation of Cardan angles, tilt first and spin last: `R = Ry(y) Rz(z) Rx(x)`.
fn from_cardan(x: f64, y: f64, z: f64) -> UnitQuaternion<f64> {
    let about = |axis: Vector3<f64>, angle: f64| UnitQuaternion::new(axis * angle);
    about(Vector3::y(), y) * about(Vector3::z(), z) * about(Vector3::x(), x)
}
