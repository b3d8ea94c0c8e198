//! What a bearing is given from outside.

use serde::{Deserialize, Serialize};

use crate::numerics::motion::{Pose, Twist, Wrench};

/// What a race is given from outside, valid at the last communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RaceInput {
    /// Pose of a race with given motion.
    pub pose: Pose,
    /// Twist of a race with given motion.
    pub twist: Twist,
    /// [m/s2, rad/s2] rate of change of the twist; zero if not known.
    pub twist_rate: Twist,
    /// Wrench applied to a race body, about its origin, world axes.
    pub applied: Wrench,
    /// [rad/s] prescribed spin of a race body or of a fixed race about its own axis.
    pub speed: f64,
}

/// Everything that is given from outside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Inner race.
    pub inner: RaceInput,
    /// Outer race.
    pub outer: RaceInput,
    /// [-] friction coefficient of the ball-race contacts.
    pub friction: f64,
}
