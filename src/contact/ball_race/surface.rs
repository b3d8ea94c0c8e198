//! Surface that a ball rolls on: the raceway as it is at the moment, its form, and the balls that it fits.

use super::ball_spall::Damage;
use super::form::Form;
use super::spall::Spalls;
use crate::contact::raceway::Raceway;
use crate::numerics::scalar::Scalar;

/// Size of a ball against that of the bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallSize {
    /// \[m] by how much its radius is larger.
    pub larger: f64,
    /// [-] its Hertz stiffness on the race over that of the others.
    pub stiffness: f64,
}

/// The surface of a race and the sizes of the balls on it, during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface<'a> {
    /// The raceway: by value, as its dimensions may change from step to step.
    pub raceway: Raceway,
    /// \[m] ball radius.
    pub ball_radius: f64,
    /// How far the race departs from a torus; none if it does nowhere.
    pub form: Option<&'a Form>,
    /// Its spalls, where it has some.
    pub spalls: Option<&'a Spalls>,
    /// Spalls of balls, where some have them.
    pub damage: Option<Damage<'a>>,
    /// Sizes of the balls, where they differ.
    pub sizes: Option<&'a [BallSize]>,
    /// The ball that is looked at (0 is the first), or the first of several; needed where balls differ.
    pub ball: usize,
}

impl Surface<'_> {
    /// A race without form under balls that are alike.
    pub fn plain(raceway: Raceway, ball_radius: f64) -> Self {
        Self { raceway, ball_radius, form: None, spalls: None, damage: None, sizes: None, ball: 0 }
    }

    /// Does it matter which ball is looked at?
    pub fn tells_balls(&self) -> bool {
        self.sizes.is_some() || self.damage.is_some()
    }

    /// Has the race or a ball spalls?
    #[inline(always)]
    pub(super) fn has_spalls(&self) -> bool {
        self.spalls.is_some() || self.damage.is_some()
    }

    /// The surface under a ball.
    #[inline(always)]
    pub fn under(&self, ball: usize) -> Self {
        Self { ball, ..*self }
    }

    /// Is the race a torus, and are the balls alike?
    #[inline(always)]
    pub(super) fn is_plain(&self) -> bool {
        self.form.is_none() && self.sizes.is_none() && !self.has_spalls()
    }

    /// A number of the size of the ball in each lane, where balls differ.
    #[inline(always)]
    pub fn of_balls<S: Scalar>(&self, number: impl Fn(&BallSize) -> f64) -> Option<S> {
        let sizes = self.sizes?;
        // Lanes without a ball of their own repeat the last.
        Some(S::by_lane(|lane| sizes.get(self.ball + lane).or(sizes.last()).map_or(0.0, &number)))
    }
}
