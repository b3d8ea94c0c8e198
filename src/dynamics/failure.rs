//! Where a step failed: which body, which ball, which contact.

use std::fmt;

use nalgebra::Vector3;

use super::{Boundary, Workspace};
use crate::contact::pair::PairForces;
use crate::forces::{Contacts, Pairs};
use crate::model::Model;
use crate::model::bodies::{Body, Race};
use crate::model::state::State;
use crate::numerics::motion::Wrench;

/// Where the residual or local error of a failed step is largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Worst {
    /// Index of the worst ball.
    pub ball: usize,
    /// The body whose norm is larger than that of every ball.
    pub body: Option<Body>,
}

impl Worst {
    /// Of a machine all of whose bearings are without states.
    pub const NOTHING: Self = Self { ball: 0, body: None };

    /// Ball and body of the largest norms, the first of equals; NaN counts as largest.
    pub fn of(balls: impl Iterator<Item = f64>, bodies: impl Iterator<Item = (Body, f64)>) -> Self {
        let worse = |norm: f64, than: f64| !than.is_nan() && (norm.is_nan() || norm > than);
        let (mut ball, mut worst) = (0, f64::NEG_INFINITY);
        for (index, norm) in balls.enumerate() {
            if worse(norm, worst) {
                (ball, worst) = (index, norm);
            }
        }
        let mut body = None;
        for (candidate, norm) in bodies {
            if worse(norm, worst) {
                (body, worst) = (Some(candidate), norm);
            }
        }
        Self { ball, body }
    }
}

/// Where a step failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FailureSite {
    /// The body whose residual or local error is larger than that of every ball.
    pub body: Option<Body>,
    /// Ball, counted from 1: of that body's balls the one whose contact force changed most in the step, else the ball
    /// with the largest residual or local error.
    pub ball: usize,
    /// Second body of that ball's contact whose force changed most in the step.
    pub contact: Body,
    /// Did the force of its neighbours change more than that of every body?
    pub neighbours: bool,
}

impl fmt::Display for FailureSite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (ball, contact) = (self.ball, self.contact);
        match self.body {
            Some(body) if body == contact => write!(f, "the {body}, at its contact with ball {ball}"),
            Some(body) => write!(f, "the {body}, then at ball {ball} on the {contact}"),
            None if self.neighbours => write!(f, "ball {ball} between its neighbours"),
            None => write!(f, "ball {ball} on the {contact}"),
        }
    }
}

/// Where the step from `state` failed that was tried last with this workspace.
pub fn failure_site(
    model: &Model,
    state: &State,
    boundary: &Boundary,
    worst: Worst,
    workspace: &Workspace,
) -> FailureSite {
    let before = Contacts::new(model, state, &boundary.conditions);
    let radius = model.bearing.ball.radius;
    let before = &before;
    let changes = |ball: usize| {
        Body::ALL.into_iter().filter_map(move |contact| {
            let old = before_of(before, ball, contact);
            let new = workspace.pair(ball, contact);
            let force = change(old.as_ref(), new.as_ref(), radius)?;
            Some(Change { ball, contact, force })
        })
    };
    let of_body = (0..state.balls.len())
        .flat_map(changes)
        .filter(|change| Some(change.contact) == worst.body && change.force > 0.0);
    // A body may be in trouble without its balls: a cage on its lands.
    let change = largest(of_body).or_else(|| largest(changes(worst.ball)));
    let (ball, contact, force) = change
        .map_or((worst.ball, Race::Inner.into(), 0.0), |change| (change.ball, change.contact, change.force));
    let pushed = before.neighbours_on(ball).fold(Wrench::default(), Wrench::plus);
    let push = workspace.balls[ball].pushed.map_or_else(Wrench::default, |push| push.wrench);
    let neighbours = size(&(push.force - pushed.force), &(push.moment - pushed.moment), radius) > force;
    FailureSite { body: worst.body, ball: ball + 1, contact, neighbours }
}

/// How much a contact changed in a step.
struct Change {
    ball: usize,
    contact: Body,
    /// \[N] force and moment over the ball's radius.
    force: f64,
}

/// The first of the largest.
fn largest(changes: impl Iterator<Item = Change>) -> Option<Change> {
    changes.reduce(|worst, change| if change.force > worst.force { change } else { worst })
}

/// The forces between a ball and a body at the start of the step.
fn before_of(contacts: &Contacts, ball: usize, body: Body) -> Option<PairForces> {
    let mut found = None;
    contacts.of_ball(ball, |other, pair| {
        if other == body {
            found = Some(*pair);
        }
    });
    found
}

/// \[N] change of the force on a ball, and of its moment over the radius \[m]; none where they never touched.
fn change(old: Option<&PairForces>, new: Option<&PairForces>, radius: f64) -> Option<f64> {
    let none = PairForces::none();
    if old.is_none() && new.is_none() {
        return None;
    }
    let (old, new) = (old.unwrap_or(&none), new.unwrap_or(&none));
    Some(size(&(new.force - old.force), &(new.moment - old.moment), radius))
}

/// \[N] size of a force \[N] and of a moment [N m] over the radius \[m]; what is not a number counts as the largest.
fn size(force: &Vector3<f64>, moment: &Vector3<f64>, radius: f64) -> f64 {
    let size = force.norm().hypot((moment / radius).norm());
    if size.is_nan() { f64::INFINITY } else { size }
}
