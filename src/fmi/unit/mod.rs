//! What an instance simulates: a bearing, or a shaft with its bearings. Both are values by reference: some go in, steps are made, others
//! come out.

mod bearing;
mod derivatives;
mod system;

use std::ops::{Deref, DerefMut};

use serde::{Deserialize, Serialize};

use super::log::Log;
use super::outcome::Outcome;
use crate::interface::contradiction::Contradiction;
use crate::interface::variables::{Causality, Variable};
use crate::scene::{Giver, Group};
use crate::simulation::Snapshot;
use crate::simulation::system::SystemSnapshot;
pub use bearing::BearingUnit;
pub use system::SystemUnit;

/// What an instance simulates.
#[derive(Clone)]
pub enum Unit {
    /// A bearing.
    Bearing(Box<BearingUnit>),
    /// A shaft with its bearings.
    System(Box<SystemUnit>),
}

/// A point that a unit was at.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum UnitSnapshot {
    /// A bearing.
    Bearing(Box<Snapshot>),
    /// A shaft with its bearings.
    System(Box<SystemSnapshot>),
}

impl UnitSnapshot {
    /// \[s] time.
    pub fn time(&self) -> f64 {
        match self {
            Self::Bearing(snapshot) => snapshot.time(),
            Self::System(snapshot) => snapshot.time(),
        }
    }
}

/// A unit as an instance sees it. Lists of values have one of every row, by value reference; those of outputs are ignored where values
/// go in.
pub trait Simulated {
    /// The variables; the index of a row is its value reference.
    fn rows(&self) -> &[Variable];

    /// Value references of the inputs.
    fn inputs(&self) -> &[usize];

    /// \[s] time.
    fn time(&self) -> f64;

    /// Value of a row: an input as set, an output of the last communication point.
    fn value(&self, reference: usize) -> f64;

    /// Values of all rows.
    fn values(&self) -> Vec<f64>;

    /// Are all numbers finite that values are computed from?
    fn is_finite(&self) -> bool;

    /// Does anything change by itself with time?
    fn follows_time(&self) -> bool;

    /// \[s] time that the scene's scripts are written for, from 0.
    fn duration(&self) -> f64;

    /// Starts again with the parameters among these values at a time \[s], under what the scripts say then.
    ///
    /// # Errors
    /// If that is not possible.
    fn start_at(&mut self, time: f64, values: &[f64]) -> Outcome;

    /// Sets the time \[s] of a unit that has not moved yet and does not follow time.
    ///
    /// # Errors
    /// If it does not start there.
    fn set_start_time(&mut self, time: f64) -> Outcome;

    /// Goes on with the tunable parameters among these values.
    ///
    /// # Errors
    /// If they contradict one another.
    fn tune(&mut self, values: &[f64]) -> Outcome;

    /// Takes the inputs among these values, and their rates, for the next step or start.
    ///
    /// # Errors
    /// If one is not allowed.
    fn prepare(&mut self, values: &[f64], rates: &[f64]) -> Outcome;

    /// Starts again at the present time under the inputs that were prepared.
    ///
    /// # Errors
    /// If there is no equilibrium.
    fn initialise(&mut self) -> Outcome;

    /// Runs to a time \[s] under the inputs that were prepared, some of them given by the scripts that are played.
    ///
    /// # Errors
    /// A discarded step if it cannot be finished.
    fn advance(&mut self, end: f64, played: &[bool]) -> Outcome;

    /// The point that it is at.
    fn snapshot(&self) -> UnitSnapshot;

    /// Goes to a point; false, with nothing changed, if that is of another unit.
    fn restore(&mut self, snapshot: &UnitSnapshot) -> bool;

    /// Scripts: who gives what there is one for; none where the scene has no script.
    fn scripts(&self) -> Vec<Option<Giver>>;

    /// What a script gives, in words, and its group.
    fn script_name(&self, script: usize) -> (String, Group);

    /// The script that may give an input.
    fn script_of(&self, reference: usize) -> Option<usize>;

    /// A quaternion of zeros among these values: an input that nothing is connected to.
    fn zero_quaternion(&self, values: &[f64]) -> Option<String>;

    /// A race whose prepared pose contradicts its twist, over a step \[s] before now.
    fn contradiction(&self, step: f64, played: &[bool]) -> Option<(String, Contradiction)>;

    /// Tells what is simulated.
    fn announce(&self, log: &Log);

    /// Derivatives of all variables by every input, one column per input, of the step since a point, or of the start.
    ///
    /// # Errors
    /// If there are none.
    fn derivatives(&self, before: Option<&UnitSnapshot>, played: &[bool]) -> Outcome<Vec<Vec<f64>>>;

    /// Is a parameter among these values different?
    fn parameters_differ(&self, one: &[f64], other: &[f64]) -> bool {
        let pairs = one.iter().zip(other);
        let mut rows = self.rows().iter().zip(pairs);
        rows.any(|(row, (one, other))| row.causality == Causality::Parameter && one != other)
    }
}

impl Deref for Unit {
    type Target = dyn Simulated + Send;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Bearing(unit) => &**unit,
            Self::System(unit) => &**unit,
        }
    }
}

impl DerefMut for Unit {
    fn deref_mut(&mut self) -> &mut Self::Target {
        match self {
            Self::Bearing(unit) => &mut **unit,
            Self::System(unit) => &mut **unit,
        }
    }
}
