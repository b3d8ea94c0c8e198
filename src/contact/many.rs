//! Contacts of many balls with a race at once: values alone, several balls in the lanes of one vector.

use nalgebra::Vector3;

use super::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use crate::lanes::Lanes;
use crate::scalar::{Scalar, constant_vector};

/// Forces and losses of a ball-race contact, in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEffect<S: Scalar = f64> {
    /// \[N] normal load.
    pub load: S,
    /// [N/m^1.5] Hertz stiffness.
    pub stiffness: S,
    /// \[N] force on the ball.
    pub force: Vector3<S>,
    /// [N m] moment on the ball about its centre.
    pub ball_moment: Vector3<S>,
    /// [N m] moment on the race about its origin.
    pub race_moment: Vector3<S>,
    /// \[W] power lost to friction.
    pub friction_power: S,
    /// \[W] power lost to contact damping.
    pub damping_power: S,
}

impl<S: Scalar> From<&BallRaceContact<S>> for ContactEffect<S> {
    #[inline(always)]
    fn from(contact: &BallRaceContact<S>) -> Self {
        Self {
            load: contact.load,
            stiffness: contact.stiffness,
            force: contact.force,
            ball_moment: contact.ball_moment,
            race_moment: contact.race_moment,
            friction_power: contact.friction_power,
            damping_power: contact.damping_power,
        }
    }
}

impl<S: Scalar> ContactEffect<S> {
    /// That of no contact.
    pub fn none() -> Self {
        let (zero, vector) = (S::zero(), constant_vector(&Vector3::zeros()));
        Self {
            load: zero,
            stiffness: zero,
            force: vector,
            ball_moment: vector,
            race_moment: vector,
            friction_power: zero,
            damping_power: zero,
        }
    }
}

impl ContactEffect<Lanes> {
    fn lane(&self, lane: usize) -> ContactEffect {
        let vector = |v: &Vector3<Lanes>| v.map(|component| component.0[lane]);
        ContactEffect {
            load: self.load.0[lane],
            stiffness: self.stiffness.0[lane],
            force: vector(&self.force),
            ball_moment: vector(&self.ball_moment),
            race_moment: vector(&self.race_moment),
            friction_power: self.friction_power.0[lane],
            damping_power: self.damping_power.0[lane],
        }
    }
}

/// Evaluates the contacts of up to [`WIDTH`](crate::lanes::WIDTH) balls with a race, to the same bits as
/// [`ContactModel::evaluate`].
pub fn evaluate_group(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: &[BallMotion<f64>],
    effects: &mut [ContactEffect],
) {
    let Some(last) = balls.len().checked_sub(1) else {
        return;
    };
    // Lanes without a ball repeat the last.
    let ball = |lane: usize| &balls[lane.min(last)];
    let motion = BallMotion {
        position: Lanes::vector(|lane| ball(lane).position),
        velocity: Lanes::vector(|lane| ball(lane).velocity),
        angular_velocity: Lanes::vector(|lane| ball(lane).angular_velocity),
    };
    let mut together = ContactEffect::none();
    evaluate_lanes(contact, race, &motion, &mut together);
    for (lane, effect) in effects.iter_mut().enumerate().take(balls.len()) {
        *effect = together.lane(lane);
    }
}

/// One version for processors with vectors of four numbers, one for those without; the running one is chosen at run time.
///
/// Arguments and result lie in memory lane by lane: compilers begin to build vectors where numbers are stored.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn evaluate_lanes(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: &BallMotion<Lanes>,
    effects: &mut ContactEffect<Lanes>,
) {
    let race = RaceMotion {
        position: constant_vector(&race.position),
        axis: constant_vector(&race.axis),
        velocity: constant_vector(&race.velocity),
        angular_velocity: constant_vector(&race.angular_velocity),
    };
    *effects = ContactEffect::from(&contact.evaluate(balls, &race));
}
