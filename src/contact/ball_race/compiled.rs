//! Contacts with the numbers that this library computes with, in functions that are compiled here: whoever calls
//! [`ContactModel::evaluate`] from another crate compiles the whole chain from motion to forces once more.

use super::{BallRaceContact, ContactModel, Path};
use crate::contact::creep::Law;
use crate::contact::motion::{BallMotion, RaceMotion};
use crate::contact::pair::PairForces;
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::Dual;

/// A number with as many derivatives as a step takes of a contact with a race that moves.
type D = Dual<9>;
/// A number with derivatives by the ball's own motion alone.
type Own = Dual<6>;

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

    /// Force and moment on the ball beside a race of given motion, with derivatives in the six directions of the ball's own, by a path. The
    /// general one is not compiled for six: it takes nine, three of which stand still.
    pub fn on_ball(&self, path: Path, ball: &BallMotion<Own>, race: &RaceMotion<f64>) -> Wrench<Own> {
        let plain = match path {
            Path::Plain => plain_on_ball(self, ball, race),
            Path::General => None,
        };
        plain.unwrap_or_else(|| {
            let forces: PairForces<D> = self.forces(&ball.map(Dual::resized), &race.constant());
            Wrench { force: forces.force.map(Dual::resized), moment: forces.moment.map(Dual::resized) }
        })
    }
}

/// That by the plain path, where it holds. The start of an instance spends half of its time here, so it is compiled with vectors; processors
/// without them take the general path, which has the same bits.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn plain_on_ball(
    contact: &ContactModel<'_>,
    ball: &BallMotion<Own>,
    race: &RaceMotion<f64>,
) -> Option<Wrench<Own>> {
    #[cfg(feature = "vectors")]
    let is_compiled =
        multiversion::target::target_cfg_f!(any(not(target_arch = "x86_64"), target_feature = "avx2"));
    #[cfg(not(feature = "vectors"))]
    let is_compiled = true;
    if !is_compiled || matches!(contact.law, Law::Frictionless) {
        return None;
    }
    let (contact, oblique) = contact.rolling::<Own, false>(ball, &race.constant());
    (!oblique).then_some(Wrench { force: contact.force, moment: contact.ball_moment })
}
