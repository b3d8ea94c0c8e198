//! Contacts with the numbers that this library computes with, in functions that are compiled here: whoever calls
//! [`ContactModel::evaluate`] from another crate compiles the whole chain from motion to forces once more.

use super::pair::PairForces;
use super::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use crate::numerics::scalar::Dual;

/// A number with as many derivatives as a step takes of a contact with a race that moves.
type D = Dual<9>;

impl ContactModel<'_> {
    /// [`Self::evaluate`] without derivatives.
    #[inline(never)]
    pub fn evaluated(&self, ball: &BallMotion<f64>, race: &RaceMotion<f64>) -> BallRaceContact<f64> {
        self.evaluate(ball, race)
    }

    /// What the contact does, with derivatives in nine directions.
    #[inline(never)]
    pub fn differentiated(&self, ball: &BallMotion<D>, race: &RaceMotion<D>) -> PairForces<D> {
        PairForces::from(&self.evaluate(ball, race))
    }
}
