//! Inputs of a bearing: motions, loads, speeds, friction, and those of effects.

use std::ops::{Index, IndexMut};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::effects::EffectInputs;
use crate::effects::reports::Rises;
use crate::model::bodies::Race;
use crate::numerics::motion::{FrameInput, Pose, Twist, Wrench};

/// Motion of a race given by that of its axis: coordinates of [`crate::numerics::tilt`], turn first. The turn itself is not
/// given: it is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxisInput {
    /// \[rad] zero, tilt about y and z.
    pub tilt: Vector3<f64>,
    /// [rad/s] spin about the own axis, rates of both tilts.
    pub rate: Vector3<f64>,
    /// [rad/s2] rates of these rates; zero if not known.
    pub acceleration: Vector3<f64>,
}

/// Inputs of a race, valid at the last communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RaceInput {
    /// Pose of a race with given motion.
    pub pose: Pose,
    /// Twist of a race with given motion.
    pub twist: Twist,
    /// [m/s2, rad/s2] rate of change of the twist; zero if not known.
    pub twist_rate: Twist,
    /// Motion of the axis, where it is given instead of orientation and angular velocity; these then follow from it, but for
    /// the angle about the axis.
    pub axis: Option<AxisInput>,
    /// Frame of a race on a hinge.
    pub frame: FrameInput,
    /// Wrench applied to a race that forces move, about its origin, world axes.
    pub applied: Wrench,
    /// [rad/s] prescribed spin about its own axis, of a race that has no pose as its input.
    pub speed: f64,
}

impl RaceInput {
    /// Says where a race is that a structure carries, and its spin [rad/s].
    pub fn follow(&mut self, pose: Pose, twist: Twist, speed: f64) {
        *self = Self { pose, twist, speed, axis: None, ..*self };
    }
}

/// All inputs of a bearing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Inner race.
    pub inner: RaceInput,
    /// Outer race.
    pub outer: RaceInput,
    /// [-] friction coefficient of the ball-race contacts.
    pub friction: f64,
    /// \[K] rises of temperature, which are reached by the end of the communication step; none where growth is not simulated.
    pub rises: Option<Rises>,
    /// Inputs of effects.
    pub effects: EffectInputs,
}

impl Index<Race> for Inputs {
    type Output = RaceInput;
    fn index(&self, race: Race) -> &RaceInput {
        match race {
            Race::Inner => &self.inner,
            Race::Outer => &self.outer,
        }
    }
}

impl IndexMut<Race> for Inputs {
    fn index_mut(&mut self, race: Race) -> &mut RaceInput {
        match race {
            Race::Inner => &mut self.inner,
            Race::Outer => &mut self.outer,
        }
    }
}
