//! One implicit step of the whole bearing: Newton's equations of balls and race bodies under the HHT scheme.

mod accept;
mod ball;
mod ball_equations;
mod body;
mod body_sums;
mod cage;
pub mod carried;
mod dense;
mod directions;
mod equations;
mod failure;
mod group;
mod guess;
mod last_correction;
mod local_error;
mod matrix;
mod neighbours;
mod reaction;
mod record;
mod repair;
mod sensitivity;
mod step_turn;
mod support;
pub mod system;

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector6};

use crate::contact::many::Touch;
use crate::contact::pair::PairForces;
use crate::effects::moving_frame::FrameMotion;
use crate::forces::{BallContacts, BallPair, Contacts};
use crate::model::bodies::{Bodies, Body, PerRace, Race};
use crate::model::state::{KeptMatrix, State};
use crate::model::{Conditions, Model};
use crate::numerics::arrowhead::{Arrowhead, Member, Six};
use crate::numerics::lanes::Lanes;
use crate::numerics::motion::{Pose, Twist};
use crate::numerics::newton::{self, NewtonBuffers, NewtonFailure};
use crate::numerics::ring::Ring;
use crate::numerics::size::larger;
use accept::{StepEnd, accept, renew_polynomials};
pub use accept::{make_consistent, power_lost_around};
use ball::BallTrial;
use body::BodyTrial;
pub use body_sums::BodyLoad;
use cage::CageTrial;
pub use dense::{StepBound, within};
use equations::BearingStep;
pub use failure::{FailureSite, Worst, failure_site};
use group::Groups;
use neighbours::NeighbourTrial;
pub use sensitivity::advance_perturbed;

/// Motions, loads and conditions imposed at the end of a step.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// \[s] end of the step.
    pub time: f64,
    /// Pose and twist of races with prescribed motion; not used where forces move the race.
    pub motion: PerRace<(Pose, Twist)>,
    /// Load and speed of races that forces move; not used for the others.
    pub loads: PerRace<BodyLoad>,
    /// Conditions of every contact.
    pub conditions: Conditions,
    /// Motion of the bearing's frame, and gravity in it.
    pub frame: FrameMotion,
    /// Orientations of damaged balls ([`Boundary::turn_balls`]); none where all balls are whole.
    pub orientations: Option<Vec<UnitQuaternion<f64>>>,
}

/// Buffers of a step, kept between steps.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    balls: Vec<BallTrial>,
    /// Motion, contacts, forces and residuals of the balls.
    groups: Groups,
    /// The state's matrix during a step.
    kept: KeptMatrix,
    /// Trials of the bodies that forces move; empty before the first step.
    bodies: Bodies<Option<BodyTrial>>,
    cage: Option<CageTrial>,
    /// Neighbouring balls that may touch in the step.
    neighbours: Vec<NeighbourTrial>,
    arrowhead: Arrowhead,
    /// The border with what the balls leave in it: of a bearing with a carried race a part of a larger one.
    reduced: DMatrix<f64>,
    /// Is the matrix that of this step's bodies and kept balls?
    factorised: bool,
    /// Bodies that forces move.
    members: Vec<Member>,
    /// The matrix of a step in which neighbouring balls may touch.
    ring: Ring,
    ball_corrections: Vec<Vector6<f64>>,
    /// The same of all groups of balls, where neighbouring balls do not touch.
    group_corrections: Vec<Six<Lanes>>,
    border_correction: DVector<f64>,
    unknowns: Vec<f64>,
    /// A correction that is not evaluated.
    last_correction: Vec<f64>,
    /// Has the step that was solved last ended with it?
    settled: bool,
    /// Accelerations and multipliers that do not change in the step but for the turn of orbits.
    steady: Vec<f64>,
    /// How they would change if they went on as in the last step.
    expected: Vec<f64>,
    newton: NewtonBuffers,
}

impl Workspace {
    /// Forces between a ball and the body that it touches; none where it does not touch the cage.
    fn pair(&self, ball: usize, body: Body) -> Option<PairForces> {
        match body {
            Body::Race(race) => Some(self.groups.pair(ball, race)),
            Body::Cage => self.balls[ball].pocket,
        }
    }

    /// Are its contacts those of the state that the last step led to, to the bit? After a correction that was not evaluated they are those
    /// before it.
    pub fn has_contacts_of_state(&self) -> bool {
        !self.settled
    }

    /// All contacts at the end of the step that was accepted last with this workspace.
    pub fn contacts(&self, model: &Model) -> Contacts {
        let of_ball = |(index, trial): (usize, &BallTrial)| BallContacts {
            raceways: self.groups.contacts(index),
            pocket: trial.pocket,
        };
        let lands = self.cage.as_ref().map_or([None; 2], |cage| cage.lands);
        let ball_pairs = self.touching_balls().collect();
        Contacts::from_parts(model, self.balls.iter().enumerate().map(of_ball).collect(), ball_pairs, lands)
    }

    /// Neighbouring balls that touch at the end of that step.
    pub fn touching_balls(&self) -> impl Iterator<Item = BallPair> {
        self.neighbours.iter().filter_map(NeighbourTrial::touching)
    }

    /// Where a ball (0 is the first) touches a race at the end of that step.
    pub fn touch(&self, ball: usize, race: Race) -> Touch {
        self.groups.touch(ball, race)
    }
}

/// Why a step was not taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepFailure {
    /// Newton's method gave up; and where the residual is largest.
    Newton(NewtonFailure, Worst),
    /// The local error is too large; and where it is largest.
    Error(Worst),
}

/// Tries one step of `h` \[s]. On success the state is the new one; otherwise only its statistics, step control, kept
/// matrix and differences to the table have changed.
///
/// # Errors
/// See [`StepFailure`]; the step control has then been told.
// A function of its own in programs, too: scripts/step-instructions counts what it takes.
#[inline(never)]
pub fn try_step(
    model: &Model,
    state: &mut State,
    boundary: &Boundary,
    h: f64,
    workspace: &mut Workspace,
) -> Result<(), StepFailure> {
    let mut buffers = std::mem::take(&mut workspace.newton);
    let mut unknowns = std::mem::take(&mut workspace.unknowns);
    workspace.kept = std::mem::take(&mut state.matrix);
    workspace.factorised = false;
    // Here and not at the end of a step, so that a state keeps those that its forces were computed with.
    renew_polynomials(model, state, boundary);
    let mut statistics = state.statistics;
    let mut equations = BearingStep::new(model, state, boundary, h, workspace);
    equations.list_near();
    equations.guess_steady_trend(&mut unknowns);
    let mut solve = |equations: &mut BearingStep<'_>, unknowns: &mut [f64]| {
        if equations.begin_with_first_law() {
            newton::solve(equations, unknowns, &mut buffers, &mut statistics.newton)?;
            equations.go_on_with_own_law();
        }
        newton::solve(equations, unknowns, &mut buffers, &mut statistics.newton)?;
        // Each time around another pair of balls has met.
        while equations.list_met() {
            newton::solve(equations, unknowns, &mut buffers, &mut statistics.newton)?;
        }
        Ok(())
    };
    let mut solved = solve(&mut equations, &mut unknowns);
    if solved.is_err() {
        equations.workspace.kept = KeptMatrix::default();
        equations.guess_steady_velocity(&mut unknowns);
        solved = solve(&mut equations, &mut unknowns);
        statistics.second_guesses += 1;
    }
    statistics.newton.factorisations += equations.renewals;
    statistics.contact_values += equations.contact_values;
    statistics.contact_tangents += equations.contact_tangents;
    let mut control = state.control;
    let end = match solved {
        Err(failure) => {
            statistics.rejected_newton += 1;
            control.fail();
            Err(StepFailure::Newton(failure, equations.worst_residual()))
        }
        Ok(()) => {
            equations.correct_once_more(&mut unknowns);
            let local = equations.local_error();
            let end = StepEnd::new(model, state, boundary, h, equations.workspace);
            let energy = end.energy_error(model, state, boundary, h, equations.workspace);
            match control.judge(larger(local, energy)) {
                true => Ok(end),
                false => {
                    statistics.rejected_error += 1;
                    Err(StepFailure::Error(equations.worst_error()))
                }
            }
        }
    };
    let step = equations.step;
    workspace.newton = buffers;
    workspace.unknowns = unknowns;
    state.matrix = std::mem::take(&mut workspace.kept);
    state.statistics = statistics;
    state.control = control;
    let end = end?;
    workspace.follow_trend(model, &mut state.trend, &workspace.unknowns, h);
    accept(model, state, boundary, &step, (workspace, &end));
    Ok(())
}
