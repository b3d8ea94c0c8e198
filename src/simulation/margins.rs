//! How far a bearing is from where its run ends or means something else: 1 is far away, 0 is there. Each falls before a unit fails.
//!
//! - Shoulder: with `d` the angle from the middle of a contact to the end of its groove, and `b` the half angle of its ellipse,
//!   `d/(d + b)`. The ellipse begins to be cut at 1/2; at 0 its middle leaves the groove, and the run is refused.
//! - Friction: creep forces of a race over what its contacts can bear at most, `1 - sum |F|/sum mu Q`. At 0 all of them slide as a whole:
//!   what drives or holds the balls has no more to give, and a larger demand only speeds their slip up (gross sliding). Forces of
//!   complete spin without slip have no sum and are no part of it.
//! - Step: present over least step on a logarithmic scale, `ln(h/h_min)/ln(h_max/h_min)`, as trials cut a step by factors. Below 0
//!   there is no smaller step to try.

use super::outputs::BallOutput;
use crate::contact::shoulder::{SMALL_LOAD, half_angle};
use crate::effects::creep::CreepLaw;
use crate::model::bodies::{PerRace, Race};
use crate::numerics::step_control::StepControl;
use crate::scene::{Level, Scene};

/// [-] margins at a communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margins {
    /// Least of all loaded contacts, to the end of their groove.
    pub shoulder: f64,
    /// Margin to gross sliding of the race that has least.
    pub friction: f64,
    /// Margin of the step to the least that is allowed.
    pub step: f64,
}

/// A margin that is reported.
#[derive(Debug)]
pub struct Margin {
    /// Name of its variable.
    pub name: &'static str,
    /// Description in a sentence.
    pub description: &'static str,
    /// Does a scene have what it measures?
    pub is_of: fn(&Scene) -> bool,
    /// [-] its value, 0 to 1.
    pub get: fn(&Margins) -> f64,
}

/// All margins.
pub const MARGINS: [Margin; 3] = [
    Margin {
        name: "margin.shoulder",
        description: "least distance of a loaded contact from the end of its groove, over itself plus the half width of its ellipse, 0 to 1: 1/2 \
                      where the ellipse reaches the shoulder, 0 where its middle does and the run is refused",
        is_of: |_| true,
        get: |margins| margins.shoulder,
    },
    Margin {
        name: "margin.friction",
        description: "1 - creep forces of all contacts of a race over their friction limits, at the race that has least, 0 to 1: 0 is gross \
                      sliding, or no load at all",
        is_of: |scene| {
            scene.effects.creep.law != CreepLaw::Frictionless && scene.effects.film.section.is_none()
        },
        get: |margins| margins.friction,
    },
    Margin {
        name: "margin.step",
        description: "present step of the integrator between the least (0) and the largest (1) that are allowed, on a logarithmic scale: \
                      below the least a run gives up",
        is_of: |scene| scene.solver.level == Level::Dynamic,
        get: |margins| margins.step,
    },
];

impl Margins {
    /// Margins of balls of a radius \[m] with a friction coefficient on each race, and of a step.
    pub(super) fn of(
        balls: &[BallOutput],
        radius: f64,
        friction: PerRace<f64>,
        control: &StepControl,
    ) -> Self {
        let shoulder = Race::BOTH.map(|race| to_shoulder(balls, race, radius));
        let friction = Race::BOTH.map(|race| to_sliding(balls, race, friction[race]));
        Self {
            shoulder: shoulder[0].min(shoulder[1]),
            friction: friction[0].min(friction[1]),
            step: control.margin(),
        }
    }
}

/// [-] least margin of the loaded contacts of a race; 1 where there is none.
fn to_shoulder(balls: &[BallOutput], race: Race, radius: f64) -> f64 {
    let largest = balls.iter().map(|ball| ball[race].load).fold(0.0, f64::max);
    let loaded = balls.iter().map(|ball| &ball[race]).filter(|contact| contact.load > SMALL_LOAD * largest);
    loaded.fold(1.0, |least, contact| {
        let half_angle = half_angle(contact.semi_axis_transverse, radius);
        // The margin is that of the ellipse.
        let distance = (contact.shoulder_margin + half_angle).max(0.0);
        least.min(distance / (distance + half_angle))
    })
}

/// [-] friction that a race with a friction coefficient has left.
fn to_sliding(balls: &[BallOutput], race: Race, friction: f64) -> f64 {
    let (used, limit) = balls.iter().fold((0.0, 0.0), |(used, limit), ball| {
        let contact = &ball[race];
        (used + contact.force_longitudinal.hypot(contact.force_lateral), limit + friction * contact.load)
    });
    if limit > 0.0 { (1.0 - used / limit).max(0.0) } else { 0.0 }
}
