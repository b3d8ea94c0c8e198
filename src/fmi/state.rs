//! The changing part of an instance.

use serde::{Deserialize, Serialize};

use crate::scene::Groups;
use crate::simulation::Snapshot;

/// Phase of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// Made, or reset.
    Instantiated,
    /// Start values can be set and read.
    Initialization,
    /// Ready for the next step.
    StepComplete,
    /// After a step that could not be finished.
    StepFailed,
    /// Ended; results can still be read.
    Terminated,
    /// After a step or a start that was refused: reset or free.
    Error,
    /// After a fault: free only.
    Fatal,
}

/// State of the interface: phase and values as set. The state of the bearing is the simulation's.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Phase.
    pub phase: Phase,
    /// Inputs and parameters as set, by value reference; entries of outputs are not used.
    pub values: Vec<f64>,
    /// First derivatives of the inputs.
    pub rates: Vec<f64>,
    /// Outputs at the communication point before the last.
    pub previous_outputs: Vec<f64>,
    /// \[s] duration of the last communication step; 0 before the first.
    pub last_step: f64,
    /// Were inputs (before the start) or parameters set that the simulation does not know of yet?
    pub changed: bool,
    /// Inputs that the importer set before the start; the others start where the parameters put them.
    pub given: Vec<bool>,
    /// Parameters, by value reference, that the simulation runs with.
    pub applied: Vec<f64>,
    /// Groups of inputs that the importer set or gave a derivative of: their scripts are not played.
    pub set: Groups,
    /// Groups of inputs that the scene's script gave in the last communication step.
    pub played: Groups,
    /// The communication point before the last; none before the first step.
    pub before: Option<Snapshot>,
}

impl State {
    /// State of an instance whose variables have their start values.
    pub fn new(values: Vec<f64>) -> Self {
        Self {
            phase: Phase::Instantiated,
            rates: vec![0.0; values.len()],
            previous_outputs: values.clone(),
            last_step: 0.0,
            changed: false,
            given: vec![false; values.len()],
            applied: values.clone(),
            set: Groups::default(),
            played: Groups::default(),
            before: None,
            values,
        }
    }

    /// All numbers by value reference.
    fn lists(&self) -> [&[f64]; 4] {
        [&self.values, &self.rates, &self.previous_outputs, &self.applied]
    }

    /// Can an instance with that many variables be in this state?
    pub fn fits(&self, n_variables: usize) -> bool {
        self.phase != Phase::Fatal
            && self.given.len() == n_variables
            && self.lists().iter().all(|list| list.len() == n_variables)
    }

    pub fn is_finite(&self) -> bool {
        self.lists().into_iter().flatten().chain([&self.last_step]).all(|value| value.is_finite())
    }
}
