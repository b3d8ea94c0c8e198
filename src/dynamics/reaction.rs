//! Force and moment of a pair on one of its bodies, with their derivatives.

use nalgebra::Vector3;

use super::directions::D;
use crate::contact::pair::PairForces;

/// Force and moment of a pair on a body, world axes, with derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Reaction {
    /// \[N] force.
    pub force: Vector3<D>,
    /// [N m] moment about the body's origin.
    pub moment: Vector3<D>,
}

impl Reaction {
    /// Reaction on the first body of a pair.
    pub fn on_first(pair: &PairForces<D>) -> Self {
        Self { force: pair.force, moment: pair.moment }
    }

    /// Reaction on the second body of a pair.
    pub fn on_second(pair: &PairForces<D>) -> Self {
        Self { force: -pair.force, moment: pair.other_moment }
    }
}
