//! Contacts of many balls with a race at once: values alone, several balls in the lanes of one vector.

use nalgebra::Vector3;

use super::pair::PairForces;
use super::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use crate::numerics::lanes::Lanes;
use crate::numerics::scalar::{Scalar, constant_vector};

impl<S: Scalar> From<&BallRaceContact<S>> for PairForces<S> {
    #[inline(always)]
    fn from(contact: &BallRaceContact<S>) -> Self {
        Self {
            approach: contact.geometry.approach,
            load: contact.load,
            stiffness: contact.stiffness,
            force: contact.force,
            moment: contact.ball_moment,
            other_moment: contact.race_moment,
            friction_power: contact.friction_power,
            damping_power: contact.damping_power,
        }
    }
}

impl PairForces<Lanes> {
    fn lane(&self, lane: usize) -> PairForces {
        let vector = |v: &Vector3<Lanes>| v.map(|component| component.0[lane]);
        PairForces {
            approach: self.approach.0[lane],
            load: self.load.0[lane],
            stiffness: self.stiffness.0[lane],
            force: vector(&self.force),
            moment: vector(&self.moment),
            other_moment: vector(&self.other_moment),
            friction_power: self.friction_power.0[lane],
            damping_power: self.damping_power.0[lane],
        }
    }
}

/// Evaluates the contacts of up to [`WIDTH`](crate::numerics::lanes::WIDTH) balls with a race, to the same bits as
/// [`ContactModel::evaluate`].
pub fn evaluate_group(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: &[BallMotion<f64>],
    effects: &mut [PairForces],
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
    let mut together = PairForces::none();
    evaluate_lanes(contact, race, &motion, &mut together);
    for (lane, effect) in effects.iter_mut().enumerate().take(balls.len()) {
        *effect = together.lane(lane);
    }
}

/// Compiled twice, for processors with vectors of four numbers and for those without; the version is chosen at run time.
///
/// Arguments and result lie in memory lane by lane, because compilers vectorise from the stores backwards.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn evaluate_lanes(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: &BallMotion<Lanes>,
    effects: &mut PairForces<Lanes>,
) {
    let race = RaceMotion {
        position: constant_vector(&race.position),
        axis: constant_vector(&race.axis),
        velocity: constant_vector(&race.velocity),
        angular_velocity: constant_vector(&race.angular_velocity),
    };
    *effects = PairForces::from(&contact.evaluate(balls, &race));
}
