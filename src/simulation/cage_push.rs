//! Pushes of a cage at the start: what a symmetric bearing never does to it.

use nalgebra::Vector3;

use super::Simulation;
use crate::model::bodies::Body;

/// Push of a cage, beside the motion that it has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CagePush {
    /// \[m] displacement of its centre, world axes.
    pub offset: Vector3<f64>,
    /// [m/s] velocity of its centre, world axes.
    pub velocity: Vector3<f64>,
}

impl Simulation {
    /// Pushes the cage, where there is one; accelerations and outputs are then those of its new motion.
    pub fn push_cage(&mut self, push: &CagePush) {
        let Some(cage) = self.state.bodies.get_mut(Body::Cage) else { return };
        cage.pose.position += push.offset;
        cage.velocity += push.velocity;
        self.settle();
    }
}
