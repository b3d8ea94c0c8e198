//! Which body and which contact a step failed at.

use std::fmt;

use super::{Boundary, Workspace};
use crate::dynamics::state::{RaceState, State};
use crate::model::{INNER, Model, OUTER};
use crate::numerics::motion::Wrench;

/// What a ball touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    /// The inner race.
    Inner,
    /// The outer race.
    Outer,
    /// The cage, with its pocket.
    Cage,
}

/// By index of the body.
const PARTNERS: [Partner; 3] = [Partner::Inner, Partner::Outer, Partner::Cage];

impl fmt::Display for Partner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Inner => "inner race",
            Self::Outer => "outer race",
            Self::Cage => "cage",
        })
    }
}

/// Where the residual or local error of a failed step is largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Worst {
    /// Index of the worst ball.
    pub ball: usize,
    /// Index of the race body or cage that is worse than every ball.
    pub body: Option<usize>,
}

impl Worst {
    /// The first of the largest norms of balls, and of bodies with their index. What is not a number is largest.
    pub fn of(balls: impl Iterator<Item = f64>, bodies: impl Iterator<Item = (usize, f64)>) -> Self {
        let worse = |norm: f64, than: f64| !than.is_nan() && (norm.is_nan() || norm > than);
        let (mut ball, mut worst) = (0, f64::NEG_INFINITY);
        for (index, norm) in balls.enumerate() {
            if worse(norm, worst) {
                (ball, worst) = (index, norm);
            }
        }
        let mut body = None;
        for (index, norm) in bodies {
            if worse(norm, worst) {
                (body, worst) = (Some(index), norm);
            }
        }
        Self { ball, body }
    }
}

/// What a failed step is laid to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blame {
    /// The race body or cage whose residual or local error is larger than that of every ball.
    pub body: Option<Partner>,
    /// Ball, counted from 1: of that body's balls the one whose contact force changed most in the step, else the ball
    /// with the largest residual or local error.
    pub ball: usize,
    /// Its contact whose force changed most in the step.
    pub contact: Partner,
}

impl fmt::Display for Blame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (ball, contact) = (self.ball, self.contact);
        match self.body {
            Some(body) if body == contact => write!(f, "the {body}, at its contact with ball {ball}"),
            Some(body) => write!(f, "the {body}, then at ball {ball} on the {contact}"),
            None => write!(f, "ball {ball} on the {contact}"),
        }
    }
}

/// What the step from `state` that failed last with this workspace is laid to.
pub fn to_blame(
    model: &Model,
    state: &State,
    boundary: &Boundary,
    worst: Worst,
    workspace: &Workspace,
) -> Blame {
    let body = worst.body.map(|body| PARTNERS[body]);
    let of_body = (0..state.balls.len())
        .flat_map(|ball| changes(model, state, boundary, ball, workspace))
        .filter(|change| Some(change.contact) == body && change.force > 0.0);
    let of_ball = || changes(model, state, boundary, worst.ball, workspace);
    // A body may be in trouble without its balls: a cage on its lands.
    let (ball, contact) = largest(of_body)
        .or_else(|| largest(of_ball()))
        .map_or((worst.ball, Partner::Inner), |change| (change.ball, change.contact));
    Blame { body, ball: ball + 1, contact }
}

/// How much a contact changed in a step.
struct Change {
    ball: usize,
    contact: Partner,
    /// [N] force and moment over the ball's radius.
    force: f64,
}

/// The first of the largest.
fn largest(changes: impl Iterator<Item = Change>) -> Option<Change> {
    changes.reduce(|worst, change| if change.force > worst.force { change } else { worst })
}

/// The contacts of a ball.
fn changes(
    model: &Model,
    state: &State,
    boundary: &Boundary,
    ball: usize,
    workspace: &Workspace,
) -> impl Iterator<Item = Change> + use<> {
    let (start, trial) = (state.balls[ball].motion(), &workspace.balls[ball]);
    let wrench = |force, moment| Wrench { force, moment };
    let change = |contact: Partner, before: Wrench, after: Wrench| {
        let turned = (after.moment - before.moment) / model.bearing.ball.radius;
        let force = (after.force - before.force).norm().hypot(turned.norm());
        // What is not a number has changed most.
        Change { ball, contact, force: if force.is_nan() { f64::INFINITY } else { force } }
    };
    let [inner, outer] = [INNER, OUTER].map(|race| {
        let contact = model.contact(race, boundary.friction);
        let contact = contact.of_ball(state.difference(ball, race));
        let before = contact.evaluate(&start, &state.races[race].motion());
        let after = &trial.contacts[race];
        let after = wrench(after.force, after.ball_moment);
        change(PARTNERS[race], wrench(before.force, before.ball_moment), after)
    });
    let cage = model.cage.as_ref().zip(state.cage.as_ref().map(RaceState::body_motion));
    let pocket = cage.map(|(cage, motion)| {
        let before = cage.pocket_contact(ball, &start, &motion);
        let [before, after] = [before, trial.pocket.as_ref().map(|(contact, _)| *contact)]
            .map(|contact| contact.map_or_else(Wrench::default, |c| wrench(c.force, c.moment)));
        change(Partner::Cage, before, after)
    });
    [inner, outer].into_iter().chain(pocket)
}
