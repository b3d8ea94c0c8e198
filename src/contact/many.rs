//! Contacts of many balls with a race at once: values alone, several balls in the lanes of one vector.

use nalgebra::Vector3;

use super::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use crate::lanes::{Lanes, WIDTH};
use crate::scalar::constant_vector;

/// What a ball-race contact does, in world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactEffect {
    /// [N] normal load.
    pub load: f64,
    /// [N/m^1.5] Hertz stiffness.
    pub stiffness: f64,
    /// [N] force on the ball.
    pub force: Vector3<f64>,
    /// [N m] moment on the ball about its centre.
    pub ball_moment: Vector3<f64>,
    /// [N m] moment on the race about its origin.
    pub race_moment: Vector3<f64>,
    /// [W] power lost to friction.
    pub friction_power: f64,
    /// [W] power lost to contact damping.
    pub damping_power: f64,
}

impl From<&BallRaceContact<f64>> for ContactEffect {
    fn from(contact: &BallRaceContact<f64>) -> Self {
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

/// Evaluates the contacts of up to [`WIDTH`] balls with a race, to the same bits as [`ContactModel::evaluate`].
pub fn evaluate_group(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: &[BallMotion<f64>],
    effects: &mut [ContactEffect],
) {
    if let Some(last) = balls.len().checked_sub(1) {
        // Lanes without a ball repeat the last.
        evaluate_lanes(contact, race, std::array::from_fn(|lane| &balls[lane.min(last)]), effects);
    }
}

/// One version for processors with vectors of four numbers, one for those without; the running one is chosen at run time.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn evaluate_lanes(
    contact: &ContactModel<'_>,
    race: &RaceMotion<f64>,
    balls: [&BallMotion<f64>; WIDTH],
    effects: &mut [ContactEffect],
) {
    let motion = BallMotion {
        position: Lanes::vector(|lane| balls[lane].position),
        velocity: Lanes::vector(|lane| balls[lane].velocity),
        angular_velocity: Lanes::vector(|lane| balls[lane].angular_velocity),
    };
    let race = RaceMotion {
        position: constant_vector(&race.position),
        axis: constant_vector(&race.axis),
        velocity: constant_vector(&race.velocity),
        angular_velocity: constant_vector(&race.angular_velocity),
    };
    let contact: BallRaceContact<Lanes> = contact.evaluate(&motion, &race);
    let vector = |v: &Vector3<Lanes>, lane: usize| Vector3::new(v.x.0[lane], v.y.0[lane], v.z.0[lane]);
    for (lane, effect) in effects.iter_mut().enumerate() {
        *effect = ContactEffect {
            load: contact.load.0[lane],
            stiffness: contact.stiffness.0[lane],
            force: vector(&contact.force, lane),
            ball_moment: vector(&contact.ball_moment, lane),
            race_moment: vector(&contact.race_moment, lane),
            friction_power: contact.friction_power.0[lane],
            damping_power: contact.damping_power.0[lane],
        };
    }
}
