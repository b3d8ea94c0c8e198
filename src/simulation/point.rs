//! Outputs of the last communication point: computed when they are first asked for, once.

use std::sync::OnceLock;

use super::instant::Instant;
use super::outputs::{Outputs, RaceOutput};
use super::{Simulation, conditions};
use crate::forces::Contacts;
use crate::model::Conditions;
use crate::model::bodies::Race;

/// What the outputs of a communication point depend on, beside model and state.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Conditions there: inputs that are set later are those of the next step.
    conditions: Conditions,
    /// Has a step led here whose contacts the workspace has?
    stepped: bool,
    /// The outputs, once they were asked for.
    outputs: OnceLock<Outputs>,
}

impl Point {
    /// A point under these conditions.
    pub fn new(conditions: Conditions, stepped: bool) -> Self {
        Self { conditions, stepped, outputs: OnceLock::new() }
    }

    /// What the bearing does there.
    pub fn instant(&self, simulation: &Simulation) -> Instant {
        let (model, state) = (&simulation.model, &simulation.state);
        match (self.outputs.get(), self.stepped) {
            (Some(outputs), _) => outputs.into(),
            (None, true) => {
                Instant::of(model, state, &simulation.workspace.contacts(model), &self.conditions)
            }
            (None, false) => {
                let contacts = Contacts::new(model, state, &self.conditions);
                Instant::of(model, state, &contacts, &self.conditions)
            }
        }
    }
}

impl Simulation {
    /// Outputs of the last communication point.
    pub fn outputs(&self) -> &Outputs {
        let Point { conditions, stepped, outputs } = &self.point;
        outputs.get_or_init(|| {
            let (model, state) = (&self.model, &self.state);
            match stepped {
                true => Outputs::of(model, state, &self.workspace.contacts(model), conditions),
                false => Outputs::new(model, state, conditions),
            }
        })
    }

    /// A race at the last communication point. It takes no contacts, as other outputs do.
    pub fn race_output(&self, race: Race) -> RaceOutput {
        match self.point.outputs.get() {
            Some(outputs) => outputs[race],
            None => RaceOutput::new(&self.state, &self.model, race),
        }
    }

    /// The state as it is becomes that of the last communication point; `stepped` if the last step with this workspace led to it.
    pub(super) fn reach(&mut self, stepped: bool) {
        let stepped = stepped && self.workspace.has_contacts_of_state();
        self.point = Point::new(conditions(&self.inputs, &self.state), stepped);
    }

    /// Are all numbers finite that outputs are computed from?
    pub fn is_finite(&self) -> bool {
        self.state.is_finite()
    }
}
