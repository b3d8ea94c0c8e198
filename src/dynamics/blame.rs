//! Which contact a step failed at.

use std::fmt;

use super::{Boundary, Workspace};
use crate::model::{INNER, Model, OUTER};
use crate::motion::Wrench;
use crate::state::{RaceState, State};

/// What a ball touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// The inner race.
    Inner,
    /// The outer race.
    Outer,
    /// Its pocket in the cage.
    Pocket,
}

impl fmt::Display for Partner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Inner => "inner race",
            Self::Outer => "outer race",
            Self::Pocket => "cage pocket",
        })
    }
}

/// The contact of a ball whose force changed most in the step from `state` that failed last with this workspace.
pub fn to_blame(
    model: &Model,
    state: &State,
    boundary: &Boundary,
    ball: usize,
    workspace: &Workspace,
) -> Partner {
    let (start, trial) = (state.balls[ball].motion(), &workspace.balls[ball]);
    let wrench = |force, moment| Wrench { force, moment };
    let change = |before: Wrench, after: Wrench| {
        let turned = (after.moment - before.moment) / model.bearing.ball.radius;
        let change = (after.force - before.force).norm().hypot(turned.norm());
        // What is not a number has changed most.
        if change.is_nan() { f64::INFINITY } else { change }
    };
    let of_race = |race: usize| {
        let contact = model.contact(race, boundary.friction);
        let contact = contact.of_ball(state.difference(ball, race));
        let before = contact.evaluate(&start, &state.races[race].motion());
        let after = &trial.contacts[race];
        change(wrench(before.force, before.ball_moment), wrench(after.force, after.ball_moment))
    };
    let mut worst = (Partner::Inner, of_race(INNER));
    let mut compare = |partner, change| {
        if change > worst.1 {
            worst = (partner, change);
        }
    };
    compare(Partner::Outer, of_race(OUTER));
    if let Some((cage, motion)) = model.cage.as_ref().zip(state.cage.as_ref().map(RaceState::body_motion)) {
        let before = cage.pocket_contact(ball, &start, &motion);
        let [before, after] = [before, trial.pocket.as_ref().map(|(contact, _)| *contact)]
            .map(|contact| contact.map_or_else(Wrench::default, |c| wrench(c.force, c.moment)));
        compare(Partner::Pocket, change(before, after));
    }
    worst.0
}
