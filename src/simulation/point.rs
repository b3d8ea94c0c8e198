//! Outputs of the last communication point: computed when they are first asked for, once.

use std::borrow::Cow;
use std::sync::OnceLock;

use super::instant::Instant;
use super::outputs::{Outputs, RaceOutput};
use super::{Simulation, conditions};
use crate::forces::Contacts;
use crate::model::Conditions;
use crate::model::bodies::Race;

/// Contacts, as far as they are known.
#[derive(Clone, Debug)]
enum Known {
    /// Nothing: they have to be evaluated.
    Nothing,
    /// The workspace has those of the step that led here.
    OfStep,
    /// All of it.
    All(Box<Contacts>),
}

/// Quantities that the outputs of a communication point depend on, beside model and state.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Conditions there: inputs that are set later are those of the next step.
    conditions: Conditions,
    /// Its contacts, as far as they are known.
    contacts: Known,
    /// The outputs, once they were asked for.
    outputs: OnceLock<Outputs>,
}

impl Point {
    /// A point under these conditions.
    pub fn new(conditions: Conditions, stepped: bool) -> Self {
        let contacts = if stepped { Known::OfStep } else { Known::Nothing };
        Self { conditions, contacts, outputs: OnceLock::new() }
    }

    /// A point whose contacts were evaluated.
    pub fn of_contacts(conditions: Conditions, contacts: Contacts) -> Self {
        Self { conditions, contacts: Known::All(Box::new(contacts)), outputs: OnceLock::new() }
    }

    /// Outputs of the bearing there.
    pub fn instant(&self, simulation: &Simulation) -> Instant {
        match self.outputs.get() {
            Some(outputs) => outputs.into(),
            None => Instant::of(
                &simulation.model,
                &simulation.state,
                &simulation.contacts_of(self),
                &self.conditions,
            ),
        }
    }
}

impl Simulation {
    /// Outputs of the last communication point.
    pub fn outputs(&self) -> &Outputs {
        let Point { conditions, outputs, .. } = &self.point;
        outputs
            .get_or_init(|| Outputs::of(&self.model, &self.state, &self.contacts_of(&self.point), conditions))
    }

    /// All contacts of a communication point that this is at.
    pub(super) fn contacts_of<'a>(&'a self, point: &'a Point) -> Cow<'a, Contacts> {
        match &point.contacts {
            Known::All(contacts) => Cow::Borrowed(contacts),
            Known::OfStep => Cow::Owned(self.workspace.contacts(&self.model)),
            Known::Nothing => Cow::Owned(Contacts::new(&self.model, &self.state, &point.conditions)),
        }
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
        let stepped = stepped && !self.model.without_states && self.workspace.has_contacts_of_state();
        self.point = Point::new(conditions(&self.inputs, &self.state), stepped);
    }

    /// Are all numbers finite that outputs are computed from?
    pub fn is_finite(&self) -> bool {
        self.state.is_finite()
    }
}
