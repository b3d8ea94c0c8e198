//! Force and moment of a pair on one of its bodies, with their derivatives.

use nalgebra::{Matrix6, Vector3};

use super::directions::{D, by_first, by_second};
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
    #[inline(always)]
    pub fn on_second(pair: &PairForces<D>) -> Self {
        Self { force: -pair.force, moment: pair.other_moment }
    }
}

/// Derivatives of a pair that the matrix needs.
#[derive(Clone, Copy, Debug)]
pub struct PairTangent {
    /// Derivatives of force and moment (rows) on the first body by its own unknowns.
    pub by_first: Matrix6<f64>,
    /// Derivatives by the second body's.
    pub by_second: Matrix6<f64>,
    /// Reaction on the second body.
    pub on_second: Reaction,
}

impl PairTangent {
    /// That of a pair. Inlined where the pair is evaluated: derivatives that nobody asks for are then not computed.
    #[inline(always)]
    pub fn of(pair: &PairForces<D>) -> Self {
        Self {
            by_first: by_first(&pair.force, &pair.moment),
            by_second: by_second(&pair.force, &pair.moment),
            on_second: Reaction::on_second(pair),
        }
    }
}
