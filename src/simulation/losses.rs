//! What a bearing loses, by what it is lost to: together the power that its races have to bring.
//!
//! Powers of contacts are those of the forces that act: what a contact loses beside the sliding of its creep forces is rolling
//! resistance and hysteresis, so that all parts together are the whole to the last digits.

use crate::contact::{ContactModel, RaceMotion};
use crate::dynamics::power_lost_around;
use crate::effects::Effect;
use crate::effects::moving_frame::FrameMotion;
use crate::forces::{Contacts, Totals};
use crate::model::Model;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::{BallState, State};
use crate::scene::Scene;

/// \[W] powers at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    /// Sliding and spin where balls touch races and one another.
    pub sliding: f64,
    /// Friction of the cage: in its pockets and on its lands.
    pub cage: f64,
    /// Hysteresis of rolling.
    pub hysteresis: f64,
    /// Rolling resistance of the oil.
    pub rolling: f64,
    /// Drag of the medium around the balls.
    pub drag: f64,
    /// Damping of all contacts.
    pub damping: f64,
    /// Dampers of supports.
    pub support: f64,
}

/// A part of the losses that is reported.
#[derive(Debug)]
pub struct Part {
    /// Name of its variable.
    pub name: &'static str,
    /// What it is.
    pub description: &'static str,
    /// The part in a few words.
    pub words: &'static str,
    /// Is there anything in a scene that it can be lost to?
    pub is_of: fn(&Scene) -> bool,
    /// \[W] its power.
    pub get: fn(&Losses) -> f64,
}

/// The whole, then its parts.
pub const LOSSES: [Part; 8] = [
    Part {
        name: "loss.total",
        description: "all power that the bearing loses: what its races have to bring at even speed",
        words: "all losses",
        is_of: |_| true,
        get: Losses::total,
    },
    Part {
        name: "loss.sliding",
        description: "power lost to sliding and spin where balls touch races and one another",
        words: "sliding of balls",
        is_of: |_| true,
        get: |losses| losses.sliding,
    },
    Part {
        name: "loss.cage",
        description: "power lost to friction of the cage, in its pockets and on its lands",
        words: "friction of the cage",
        is_of: |scene| scene.effects.cage.on,
        get: |losses| losses.cage,
    },
    Part {
        name: "loss.hysteresis",
        description: "power lost to the hysteresis of rolling",
        words: "hysteresis of rolling",
        is_of: |scene| scene.effects.hysteresis.on,
        get: |losses| losses.hysteresis,
    },
    Part {
        name: "loss.rolling",
        description: "power lost to rolling resistance of the oil",
        words: "rolling resistance of the oil",
        is_of: |scene| scene.effects.film.section.as_ref().is_some_and(|film| film.rolling_resistance),
        get: |losses| losses.rolling,
    },
    Part {
        name: "loss.drag",
        description: "power that the balls lose to the medium around them",
        words: "drag of the medium",
        is_of: |scene| scene.effects.ambient.section.is_some(),
        get: |losses| losses.drag,
    },
    Part {
        name: "loss.damping",
        description: "power lost to damping of all contacts",
        words: "damping of contacts",
        is_of: damps,
        get: |losses| losses.damping,
    },
    Part {
        name: "loss.support",
        description: "power lost in the dampers of flexible supports",
        words: "dampers of supports",
        is_of: |scene| scene.effects.support.sections.iter().any(Option::is_some),
        get: |losses| losses.support,
    },
];

fn damps(scene: &Scene) -> bool {
    let cage = scene.effects.cage.section.as_ref().and_then(|cage| cage.damping);
    scene.effects.damping.setting().is_some() || cage.is_some_and(|factor| factor.0 > 0.0)
}

impl Losses {
    /// \[W] all of it.
    pub fn total(&self) -> f64 {
        let Self { sliding, cage, hysteresis, rolling, drag, damping, support } = self;
        sliding + cage + hysteresis + rolling + drag + damping + support
    }

    /// Of a state with these contacts, their models, motion of the races and sums.
    pub(super) fn of(
        model: &Model,
        state: &State,
        contacts: &Contacts,
        (models, races): (&PerRace<ContactModel<'_>>, &PerRace<RaceMotion<f64>>),
        totals: &Totals,
    ) -> Self {
        let pockets = contacts.balls.iter().filter_map(|ball| ball.pocket);
        let cage = pockets.chain(contacts.lands.iter().flatten().copied());
        let cage = cage.fold(0.0, |sum, pair| sum + pair.friction_power);
        let (mut hysteresis, mut rolling) = (0.0, 0.0);
        for race in Race::BOTH.into_iter().filter(|race| models[*race].resists()) {
            let (of_race, oiled) = (&models[race], models[race].film.is_some_and(|film| film.resists()));
            for (ball, (contacts, state)) in contacts.balls.iter().zip(&state.balls).enumerate() {
                let contact = of_race.of_ball(ball, None);
                let contact = contact.completed(&contacts.raceways[race], &state.motion(), &races[race]);
                let lagging = of_race.hysteresis_power(&contact);
                hysteresis += lagging;
                if oiled {
                    rolling += contact.friction_power - contact.sliding_power() - lagging;
                }
            }
        }
        let support = state.supports.iter().flatten().fold(0.0, |sum, support| sum + support.lost);
        Self {
            sliding: totals.friction_power - cage - hysteresis - rolling,
            cage,
            hysteresis,
            rolling,
            drag: power_lost_around(
                &model.ambient(&FrameMotion::default()),
                state.balls.iter().map(BallState::motion),
            ),
            damping: totals.damping_power,
            support,
        }
    }
}
