//! One implicit step: Newton's equations of balls, race bodies and what carries them under the HHT scheme, or of the stages of a method of higher
//! order (`stages.rs`). [`system::try_step`] is the step of every machine, that of a bearing alone too.

mod accept;
mod across;
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
mod rest;
mod spacing;
mod stage_guess;
mod stages;
mod stale_blocks;
mod step_turn;
mod support;
pub mod system;
mod unbalance;

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector6};

use crate::contact::RaceMotion;
use crate::contact::many::Touch;
use crate::contact::pair::PairForces;
use crate::effects::moving_frame::FrameMotion;
use crate::forces::{BallContacts, BallPair, Contacts};
use crate::model::bodies::{Bodies, Body, PerRace, Race};
use crate::model::state::KeptMatrix;
use crate::model::{Conditions, Model};
use crate::numerics::arrowhead::{Arrowhead, Member, Six};
use crate::numerics::condensed::Condensed;
use crate::numerics::lanes::Lanes;
use crate::numerics::motion::{Pose, Twist};
use crate::numerics::newton::NewtonFailure;
use crate::numerics::ring::Ring;
pub use accept::{make_consistent, power_lost_around};
use ball::BallTrial;
use body::BodyTrial;
pub use body_sums::BodyLoad;
use cage::CageTrial;
pub use dense::StepBound;
pub use failure::{FailureSite, Worst, failure_site};
use group::Groups;
pub use local_error::Allowed;
use neighbours::NeighbourTrial;
use spacing::SpacingTrial;

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

/// Work of the equations of a bearing in a step.
#[derive(Clone, Copy, Debug, Default)]
struct Counted {
    /// Ball-race contacts evaluated without derivatives.
    contact_values: u64,
    /// Ball-race contacts evaluated with derivatives.
    contact_tangents: u64,
    /// Corrections for which blocks of some balls were computed anew.
    renewals: u64,
}

/// Buffers of a bearing in a step, kept between steps so that none is allocated.
///
/// Who fills what, in the order of a step ([`system::try_step`]); what follows reads it:
///
/// ```text
/// begin    try_step       kept <- state, factorised         state -> matrices of earlier steps
///          equations.rs   races, bodies, cage, groups       motion at the start, prescribed motion at the end
///          neighbours.rs  neighbours                        pairs of balls near each other
///          guess.rs       steady, expected                  first guess of the unknowns
/// iterate  equations.rs   groups, balls, bodies, cage,      motion, contacts, forces, residuals of a trial;
///          neighbours.rs  neighbours                          with derivatives of balls whose blocks are due
///          matrix.rs      kept, ring                        balls eliminated, alone or as a ring of neighbours
///                         members, arrowhead, reduced,      rows of the bodies after the balls, factorised
///                         factors_of, condensed, factorised   where they are not those that are kept
///                         ball_, group_, border_corrections
///          repair.rs      balls.repaired                    blocks of single balls computed anew
/// end      last_correction.rs  last_correction, settled     last correction, without evaluation
///          stages.rs      embedded                          local errors where a step has stages, each of which begins anew with
///                                                             equations.rs
///          local_error.rs, accept.rs                        read groups, balls, bodies, cage, steady
///          try_step       kept -> state, counted            matrices and counts of work
/// ```
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    /// Trials of the balls one by one: pocket, neighbours, derivatives.
    balls: Vec<BallTrial>,
    /// Motion, contacts, forces and residuals of the balls, several in the lanes of one.
    groups: Groups,
    /// The state's matrix during a step.
    kept: KeptMatrix,
    /// Trials of the bodies that forces move; empty before the first step.
    bodies: Bodies<Option<BodyTrial>>,
    /// Motion of the races at the end of the step.
    races: PerRace<RaceMotion<f64>>,
    /// Trial of the cage, where there is one.
    cage: Option<CageTrial>,
    /// Turn of balls that an ideal cage keeps apart.
    spacing: Option<SpacingTrial>,
    /// Neighbouring balls that may touch in the step.
    neighbours: Vec<NeighbourTrial>,
    /// Factors of the bodies' rows, balls eliminated.
    arrowhead: Arrowhead,
    /// Rows of the bodies with what the balls leave in them, that are factorised.
    factors_of: Vec<f64>,
    /// The same; in those of carried races, what the other bodies leave too.
    reduced: DMatrix<f64>,
    /// The bodies that nothing carries, eliminated from `reduced`.
    condensed: Condensed,
    /// Is the matrix that of this step's bodies and kept balls?
    factorised: bool,
    /// Bodies that forces move, by their places in the rows.
    members: Vec<Member>,
    /// The matrix of a step in which neighbouring balls may touch.
    ring: Ring,
    /// Corrections of the balls one by one, where neighbours may touch.
    ball_corrections: Vec<Vector6<f64>>,
    /// Corrections of all groups of balls, where neighbouring balls do not touch.
    group_corrections: Vec<Six<Lanes>>,
    /// Corrections of the bodies' rows.
    border_correction: DVector<f64>,
    /// Correction that is not evaluated.
    last_correction: Vec<f64>,
    /// \[m2] squares of the local errors of balls and bodies, of their places and turns, where an embedded method gives them.
    embedded: Vec<[f64; 2]>,
    /// Has the step that was solved last ended with it?
    settled: bool,
    /// Work of the step.
    counted: Counted,
    /// Accelerations and multipliers that do not change in the step but for the turn of orbits.
    steady: Vec<f64>,
    /// Changes of these, were they to go on as in the last step.
    expected: Vec<f64>,
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
