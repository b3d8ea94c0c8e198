//! Force and moment of one contact on a body, with their derivatives.

use nalgebra::Vector3;

use super::ball::DIRECTIONS;
use crate::contact::body::BodyContact;
use crate::contact::many::ContactEffect;
use crate::numerics::scalar::{Dual, constant_vector};

/// Force and moment (world axes) of one contact on a race, with derivatives.
#[derive(Clone, Copy, Debug)]
pub struct RaceReaction {
    /// [N] force.
    pub force: Vector3<Dual<DIRECTIONS>>,
    /// [N m] moment about the race origin.
    pub moment: Vector3<Dual<DIRECTIONS>>,
}

impl RaceReaction {
    /// What a contact exerts on its second body, without derivatives.
    pub fn opposite(contact: &BodyContact<f64>) -> Self {
        Self { force: constant_vector(&-contact.force), moment: constant_vector(&contact.other_moment) }
    }

    /// What a contact exerts on its first body, without derivatives.
    pub fn direct(contact: &BodyContact<f64>) -> Self {
        Self { force: constant_vector(&contact.force), moment: constant_vector(&contact.moment) }
    }

    /// None.
    pub fn zero() -> Self {
        let zero = constant_vector(&Vector3::zeros());
        Self { force: zero, moment: zero }
    }

    /// That of a ball on a race, without derivatives.
    pub fn constant(contact: &ContactEffect) -> Self {
        Self { force: constant_vector(&-contact.force), moment: constant_vector(&contact.race_moment) }
    }

    /// Adds another.
    pub fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}
