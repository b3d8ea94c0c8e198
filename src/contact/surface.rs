//! What a ball rolls on: the raceway as it is at the moment, and the ball that it fits.

use super::raceway::Raceway;

/// The surface of a race and the size of the balls on it, during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The raceway: by value, as its dimensions may change from step to step.
    pub raceway: Raceway,
    /// \[m] ball radius.
    pub ball_radius: f64,
}
