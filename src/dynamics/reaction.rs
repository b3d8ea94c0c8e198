//! Force and moment of a pair on one of its bodies, with their derivatives.

use nalgebra::Vector3;

use super::directions::D;
use crate::contact::pair::PairForces;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::constant_vector;

/// Force and moment of one or many pairs on a body, world axes, with derivatives.
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

    /// Reaction on the first body, without derivatives.
    pub fn constant_on_first(pair: &PairForces) -> Self {
        Self { force: constant_vector(&pair.force), moment: constant_vector(&pair.moment) }
    }

    /// Reaction on the second body, without derivatives.
    pub fn constant_on_second(pair: &PairForces) -> Self {
        Self { force: constant_vector(&-pair.force), moment: constant_vector(&pair.other_moment) }
    }

    /// A force and a moment without derivatives.
    pub fn constant(wrench: &Wrench) -> Self {
        Self { force: constant_vector(&wrench.force), moment: constant_vector(&wrench.moment) }
    }

    /// Adds another reaction.
    pub fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}
