//! Contacts with the numbers that this library computes with, in functions that are compiled here: whoever calls
//! [`ContactModel::evaluate`] from another crate compiles the whole chain from motion to forces once more.

use super::pair::PairForces;
use super::{BallMotion, BallRaceContact, ContactModel, Path, RaceMotion};
use crate::numerics::scalar::Dual;

/// A number with as many derivatives as a step takes of a contact with a race that moves.
type D = Dual<9>;

impl ContactModel<'_> {
    /// [`Self::evaluate`] without derivatives.
    #[inline(never)]
    pub fn evaluated(&self, ball: &BallMotion<f64>, race: &RaceMotion<f64>) -> BallRaceContact<f64> {
        self.evaluate(ball, race)
    }

    /// [`Self::plain_forces`] or [`Self::forces`] with derivatives in nine directions, by a path, as steps take them.
    #[inline(never)]
    pub fn differentiated(&self, path: Path, ball: &BallMotion<D>, race: &RaceMotion<D>) -> PairForces<D> {
        let plain = match path {
            Path::Plain => self.plain_forces(ball, race),
            Path::General => None,
        };
        plain.unwrap_or_else(|| self.forces(ball, race))
    }
}
