//! The changing part of an instance.

use serde::{Deserialize, Serialize};

use crate::simulation::driven::MachineSnapshot;

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
    /// Within a step, while the importer is asked for inputs.
    Intermediate,
}

/// State of the interface: phase and values as set. The state of what is simulated is its own.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Phase.
    pub phase: Phase,
    /// Inputs and parameters as set, by value reference; entries of outputs are not used.
    pub values: Vec<f64>,
    /// First derivatives of the inputs.
    pub rates: Vec<f64>,
    /// Values at the communication point before the last, where parameters were set there: of those that applied before.
    pub tuned_outputs: Option<Vec<f64>>,
    /// \[s] duration of the last communication step; 0 before the first.
    pub last_step: f64,
    /// Were inputs (before the start) or parameters set that the simulation does not know of yet?
    pub changed: bool,
    /// Inputs that the importer set before the start; the others start where the parameters put them.
    pub given: Vec<bool>,
    /// Parameters, by value reference, that the simulation runs with.
    pub applied: Vec<f64>,
    /// Scripts, by their number, of inputs that the importer set or gave a derivative of: they are not played.
    pub set: Vec<bool>,
    /// Scripts that were played in the last communication step.
    pub played: Vec<bool>,
    /// The communication point before the last; none before the first step.
    pub before: Option<MachineSnapshot>,
}

impl State {
    /// State of an instance whose variables have their start values.
    pub fn new(values: Vec<f64>, scripts: usize) -> Self {
        Self {
            phase: Phase::Instantiated,
            rates: vec![0.0; values.len()],
            tuned_outputs: None,
            last_step: 0.0,
            changed: false,
            given: vec![false; values.len()],
            applied: values.clone(),
            set: vec![false; scripts],
            played: vec![false; scripts],
            before: None,
            values,
        }
    }

    /// All numbers by value reference.
    fn lists(&self) -> impl Iterator<Item = &Vec<f64>> {
        [&self.values, &self.rates, &self.applied].into_iter().chain(&self.tuned_outputs)
    }

    /// Can an instance be in this state that has as many variables and scripts as this one?
    pub fn fits(&self, other: &Self) -> bool {
        let (n_variables, n_scripts) = (other.values.len(), other.set.len());
        !matches!(self.phase, Phase::Fatal | Phase::Intermediate)
            && [&self.set, &self.played].iter().all(|list| list.len() == n_scripts)
            && self.given.len() == n_variables
            && self.lists().all(|list| list.len() == n_variables)
    }

    pub fn is_finite(&self) -> bool {
        self.lists().flatten().chain([&self.last_step]).all(|value| value.is_finite())
    }
}
