//! Why a simulation could not start or go on.

use thiserror::Error;

use crate::analysis::estimate::EstimateError;
use crate::dynamics::FailureSite;
use crate::equilibrium::{EquilibriumError, MAX_APPROACH};
use crate::kalker::nonlinear::KalkerError;
use crate::model::bearing::BeyondShoulder;
use crate::schema::numbers::four;

/// Why a simulation could not start or go on.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// No creep coefficients for the bearing's contacts.
    #[error("the creep law has no coefficients for this bearing: {0}")]
    Creep(#[from] KalkerError),
    /// `effects.auto` has nothing to estimate from.
    #[error("effects.auto: {0}")]
    Auto(#[from] EstimateError),
    /// No quasi-static equilibrium to start from.
    #[error("no equilibrium to start from: {0}")]
    Start(#[from] EquilibriumError),
    /// A cage for which there is no room among tilted or displaced races.
    #[error(
        "no start: the cage does not fit among the balls: wherever it is, it is pressed {overlap:.3e} m into {contact}, which \
         has a clearance of {clearance:.3e} m; the tilt of the races is too large for it"
    )]
    CageDoesNotFit {
        /// Contact that is pressed most.
        contact: String,
        /// \[m] overlap there.
        overlap: f64,
        /// \[m] diametral clearance there.
        clearance: f64,
    },
    /// The step size fell below its minimum.
    #[error(
        "at {} s the step fell below solver.min_step = {} s: {cause}, worst at {site} (inner load {} N, outer load {} N){}",
        four(.time), four(.min_step), four(.inner_load), four(.outer_load), .oil.as_deref().unwrap_or_default()
    )]
    StepTooSmall {
        /// \[s] time reached.
        time: f64,
        /// \[s] smallest step allowed.
        min_step: f64,
        /// Cause of the last failure.
        cause: &'static str,
        /// Body, ball and contact where the residual or the local error is largest.
        site: FailureSite,
        /// \[N] load of that ball on the inner race.
        inner_load: f64,
        /// \[N] its load on the outer race.
        outer_load: f64,
        /// Remark about the oil, where it hardly flows.
        oil: Option<String>,
    },
    /// The step size fell below its minimum where no bearing has states.
    #[error(
        "at {} s the step fell below solver.min_step = {} s: {cause}, of shafts and housings between bearings of level = \"equilibrium\"",
        four(.time), four(.min_step)
    )]
    StepOfStructuresTooSmall {
        /// \[s] time reached.
        time: f64,
        /// \[s] smallest step allowed.
        min_step: f64,
        /// Cause of the last failure.
        cause: &'static str,
    },
    /// A ball of a bearing without states found no balance.
    #[error(
        "at {} s ball {ball} found no balance at level = \"equilibrium\": {unbalanced:.3e} N are left; give the bearing level = \"dynamic\"",
        four(.time)
    )]
    OutOfBalance {
        /// \[s] time.
        time: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// \[N] force on the ball that is left.
        unbalanced: f64,
    },
    /// A roller of a bearing found no balance.
    #[error(
        "at {} s a roller of bearing \"{bearing}\" found no balance: its rings are too far from where it can lie between them; the load or the tilt is too large",
        four(.time)
    )]
    RollersOutOfBalance {
        /// \[s] time.
        time: f64,
        /// Its name.
        bearing: String,
    },
    /// A contact is deeper than Hertz's theory reaches.
    #[error(
        "at {} s ball {ball} is pressed into the {race} race by {approach:.3e} m: more than {MAX_APPROACH} of its \
         diameter, far beyond elastic Hertzian contact; the load is too large or the imposed motion is",
        four(.time)
    )]
    Overload {
        /// \[s] time.
        time: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// \[m] approach.
        approach: f64,
    },
    /// A contact lies where no groove is.
    #[error(
        "at {} s ball {ball} touches the {race} race on the side where it has no groove, {approach:.3e} m deep: the \
         race has come past its balls; the load, the clearance or the motion is too large, or a cage is missing",
        four(.time)
    )]
    LeftGroove {
        /// \[s] time.
        time: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// \[m] approach.
        approach: f64,
    },
    /// A contact lies beyond the shoulder of its race.
    #[error("at {} s {contact}", four(.time))]
    BeyondShoulder {
        /// \[s] time.
        time: f64,
        /// The contact.
        contact: BeyondShoulder,
    },
    /// Two balls are pressed together more deeply than Hertz's theory reaches.
    #[error(
        "at {} s balls {ball} and {next} are pressed together by {approach:.3e} m: more than {MAX_APPROACH} of their \
         diameter, far beyond elastic Hertzian contact",
        four(.time)
    )]
    BallsPressed {
        /// \[s] time.
        time: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// Its neighbour.
        next: usize,
        /// \[m] approach.
        approach: f64,
    },
    /// Balls that do not fit where the equilibrium puts them.
    #[error(
        "bearing.balls = {balls} is out of range at the start: allowed is [1, {fit}], as neighbouring balls overlap by \
         {overlap:.3e} m where the equilibrium puts them"
    )]
    TooManyBalls {
        /// Number of balls.
        balls: usize,
        /// Largest number that fits.
        fit: usize,
        /// \[m] largest overlap.
        overlap: f64,
    },
    /// A contact under the law `linear` creeps beyond what that law describes.
    #[error(
        "at {} s the law linear has left its range at ball {ball} on the {race} race: its creep force {force:.3} N is above \
         the friction limit mu Q = {limit:.3} N, as it has no sliding; creep or spin is too large for effects.creep = \
         \"linear\": take saturated, or a law of Kalker's nonlinear theory",
        four(.time)
    )]
    BeyondLinear {
        /// \[s] time.
        time: f64,
        /// Ball, counted from 1.
        ball: usize,
        /// Inner or outer.
        race: &'static str,
        /// \[N] creep force.
        force: f64,
        /// \[N] friction coefficient times load.
        limit: f64,
    },
    /// A row or communication point of quasi-static equilibria has none.
    #[error("at {} s: {why}", four(.time))]
    NoEquilibrium {
        /// \[s] time.
        time: f64,
        /// Why not.
        why: Box<SimulationError>,
    },
    /// A race is tilted further than linear structures are valid for.
    #[error(
        "at {} s the {race} race is tilted by {tilt:.3} rad: more than {limit} rad, the most that the linear equations of a shaft or a \
         housing hold for",
        four(.time)
    )]
    Tilted {
        /// \[s] time.
        time: f64,
        /// Inner or outer.
        race: &'static str,
        /// \[rad] tilt.
        tilt: f64,
        /// \[rad] largest tilt.
        limit: f64,
    },
    /// The Newton matrix of a step whose sensitivities were asked for is singular.
    #[error("at {} s the Newton matrix is singular", four(.0))]
    Singular(f64),
    /// Sensitivities of a method that has none.
    #[error("solver.method = \"esdirk3\" gives no derivatives by inputs: allowed is \"hht\"")]
    NoDerivatives,
    /// So late that a step no longer changes the time.
    #[error("at {} s a step of {} s is lost in rounding: begin nearer to time 0", four(.time), four(.step))]
    LostInRounding {
        /// \[s] time reached.
        time: f64,
        /// \[s] step.
        step: f64,
    },
    /// A step end that is not a time after the present one.
    #[error("cannot advance from {from} s to {to} s")]
    Backwards {
        /// \[s] present time.
        from: f64,
        /// \[s] asked for.
        to: f64,
    },
}
