//! Local error of a step, and where it or the residual is largest.

use nalgebra::Vector3;

use super::body::BodyTrial;
use super::equations::BearingStep;
use super::failure::Worst;
use super::rest;
use crate::contact::RaceMotion;
use crate::model::Model;
use crate::model::bodies::{Body, Race};
use crate::model::state::{BodyState, State};
use crate::numerics::arrowhead::BLOCK;
use crate::numerics::size::largest;

/// [-] local error that is allowed of what need not be followed, over that of the rest: a hundred thousandth of a ball at the usual
/// tolerance, which is that of `fast`. Half of it keeps the promise no better, and ten times as much breaks it where a housing rings.
const LOOSE: f64 = 2e3;
/// [-] friction, which turns bodies, over loads: the order of friction coefficients. With 1 a cage in oil broke the promise.
const FRICTION: f64 = 0.1;
/// A vector at start and end of a step.
type Ends<'a> = (&'a Vector3<f64>, &'a Vector3<f64>);

/// May a step from here leave small forces unfollowed? HHT takes away the swings that they make: only while that costs no energy to
/// speak of.
fn need_not_follow_all(model: &Model, start: &State) -> bool {
    let solver = &model.solver;
    let frugal = solver.energy_error == 0.0 || start.energies.is_frugal(solver.energy_error);
    solver.unresolved > 0.0 && frugal
}

impl BearingStep<'_> {
    /// Bodies with unknowns: state at the start, and trial.
    fn moved(&self) -> impl Iterator<Item = (Body, &BodyState, &BodyTrial)> {
        let bodies = self.before.bodies.iter().zip(self.workspace.bodies.iter());
        let bodies = bodies.filter_map(|((body, start), (_, trial))| Some((body, start, trial.as_ref()?)));
        // The error of a carried race is that of its structure.
        bodies.filter(|(_, _, trial)| !trial.is_carried())
    }

    /// Where the residual is largest.
    pub fn worst_residual(&self) -> Worst {
        let tolerance = self.force_tolerance;
        let balls = (0..self.start.balls.len()).map(|ball| self.workspace.groups.size(ball) / tolerance);
        // A sum that is not a number wins over any violation.
        let bodies = self.moved().map(|(body, _, trial)| {
            let residual = largest(trial.residual.rows(0, 6).iter()) / tolerance;
            (body, if trial.violation > residual { trial.violation } else { residual })
        });
        Worst::of(balls, bodies)
    }

    /// Weighted root mean square of the local error of all positions, over its tolerance.
    pub fn local_error(&self) -> f64 {
        let allowed = self.allowed();
        let squares = self.ball_errors(allowed).chain(self.body_errors(allowed).map(|(_, square)| square));
        let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 6.0));
        (sum / count).sqrt()
    }

    /// Where the local error is largest.
    pub fn worst_error(&self) -> Worst {
        let allowed = self.allowed();
        Worst::of(self.ball_errors(allowed), self.body_errors(allowed))
    }

    /// Local error that a step may make.
    pub fn allowed(&self) -> Allowed {
        let solver = &self.model.solver;
        let groups = &self.workspace.groups;
        let load = |ball: usize| Race::BOTH.map(|race| groups.pressed(ball, race).1);
        let unresolved = need_not_follow_all(self.model, self.before).then(|| {
            let loads = (0..self.start.balls.len()).flat_map(load);
            solver.unresolved_share() * loads.fold(0.0, f64::max)
        });
        let share = if self.stands() { rest::LOCAL_ERROR } else { 1.0 };
        Allowed { length: share * solver.tolerance * 2.0 * self.model.bearing.ball.radius, unresolved }
    }

    /// Does the bearing stand at both ends of the step ([`rest::stands`])?
    fn stands(&self) -> bool {
        let end = Race::BOTH.map(|race| {
            let RaceMotion { axis, angular_velocity, .. } = &self.workspace.races[race];
            angular_velocity.dot(axis)
        });
        [rest::speeds(self.before), end].into_iter().all(|speeds| rest::stands(self.model, speeds))
    }

    /// Square of the local error of every ball over its tolerance; rotations count as displacements at its surface.
    fn ball_errors(&self, allowed: Allowed) -> impl Iterator<Item = f64> {
        let ball = &self.model.bearing.ball;
        let radius = ball.radius;
        let masses = [ball.mass, ball.inertia / (radius * radius)];
        self.before.balls.iter().enumerate().map(move |(index, start)| {
            let unknowns = self.workspace.groups.unknowns(index);
            let mut ends = [0, 3].map(|from| unknowns.fixed_rows::<3>(from).into_owned());
            let mut starts = match allowed.unresolved {
                // What turns with the orbit is followed without error.
                Some(_) => {
                    let steady = &self.workspace.steady[BLOCK * index..];
                    [0, 3].map(|from| Vector3::from_column_slice(&steady[from..from + 3]))
                }
                None => [start.acceleration, start.angular_acceleration * radius],
            };
            if let (Some(trial), Some(along)) =
                (&self.workspace.spacing, self.workspace.groups.along_orbit(index))
            {
                // Its share of the turn.
                let [before, after] = trial.accelerations();
                starts[0] += along * before;
                ends[0] += along * after;
            }
            self.square(allowed, index, [(&starts[0], &ends[0]), (&starts[1], &ends[1])], masses)
        })
    }

    /// Square of the local error of every body over its tolerance; rotations count as displacements at the pitch circle.
    fn body_errors(&self, allowed: Allowed) -> impl Iterator<Item = (Body, f64)> {
        let length = self.model.race_length();
        self.moved().map(move |(body, start, trial)| {
            let angular = [start, &trial.end].map(|state| state.rate_derivative * length);
            let ends = [(&start.acceleration, &trial.end.acceleration), (&angular[0], &angular[1])];
            let masses = match (body, self.model.bodies.get(body)) {
                (Body::Race(_), Some(Some(race))) => [race.mass, race.inertia.max() / (length * length)],
                // A cage is light, and what it does to losses is not seen in loads.
                _ => [f64::INFINITY; 2],
            };
            (body, self.square(allowed, self.before.balls.len() + body.index(), ends, masses))
        })
    }

    /// Square of the local error of what has a place in the list of balls and bodies over what is allowed, from linear and angular
    /// accelerations [m/s2] at both ends of the step, of these masses \[kg].
    fn square(&self, allowed: Allowed, place: usize, ends: [Ends<'_>; 2], masses: [f64; 2]) -> f64 {
        let errors = match self.workspace.embedded.get(place) {
            Some(errors) => *errors,
            None => ends.map(|(start, end)| self.step.local_error(start, end).norm_squared()),
        };
        let force = |k: usize| masses[k] * (ends[k].1 - ends[k].0).norm();
        allowed.square(errors, || [force(0), force(1) / FRICTION])
    }
}

/// Local error that a step may make.
///
/// Steps that are longer than a swing of a ball in its contacts do not compute that swing; HHT's damping takes it away. That is no loss
/// where the force that it swings with is small beside the loads, and shows in how much inertia forces change in a step. So a change up to
/// `unresolved` counts little, and of a larger one the rest. (A local error of positions alone tells nothing of it: where contacts are stiff,
/// positions follow the loads.)
#[derive(Clone, Copy, Debug)]
pub struct Allowed {
    /// \[m] tolerance.
    pub length: f64,
    /// \[N] change of an inertia force that need not be followed; none where all is.
    pub unresolved: Option<f64>,
}

impl Allowed {
    /// The stricter of both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let unresolved = match (self.unresolved, other.unresolved) {
            (Some(one), Some(other)) => Some(one.min(other)),
            _ => None,
        };
        Self { length: self.length.min(other.length), unresolved }
    }

    /// [-] square of local errors \[m2] over what is allowed, in a step that changes inertia forces by these \[N].
    pub fn square<const N: usize>(&self, errors: [f64; N], forces: impl FnOnce() -> [f64; N]) -> f64 {
        let square = self.length * self.length;
        let Some(unresolved) = self.unresolved else {
            return errors.iter().sum::<f64>() / square;
        };
        let followed = |(error, force): (f64, f64)| {
            let part = (1.0 - unresolved / force).max(0.0);
            error * (part * part + 1.0 / (LOOSE * LOOSE))
        };
        errors.into_iter().zip(forces()).map(followed).sum::<f64>() / square
    }
}
