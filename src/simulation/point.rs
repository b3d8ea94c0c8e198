//! Outputs of the last communication point: computed when they are first asked for, once.

use std::sync::OnceLock;

use super::instant::Instant;
use super::losses::friction_torque;
use super::outputs::{Outputs, RaceOutput};
use super::{Simulation, conditions};
use crate::forces::Contacts;
use crate::model::Conditions;
use crate::model::bodies::Race;

/// Where the contacts of a point are found.
#[derive(Clone, Copy, Debug)]
enum Known {
    /// Nowhere: they have to be evaluated.
    Nothing,
    /// The workspace has those of the step that led here.
    OfStep,
    /// They were evaluated when the bearing, which is without states, came here.
    Rested,
}

/// Quantities that the outputs of a communication point depend on, beside model and state.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Conditions there: inputs that are set later are those of the next step.
    conditions: Conditions,
    /// Where its contacts are found.
    known: Known,
    /// They, once they were asked for.
    contacts: OnceLock<Box<Contacts>>,
    /// Sums over them, once they were asked for and the outputs were not.
    instant: OnceLock<Instant>,
    /// The outputs, once they were asked for.
    outputs: OnceLock<Outputs>,
}

impl Point {
    /// A point under these conditions.
    pub fn new(conditions: Conditions, stepped: bool) -> Self {
        let known = if stepped { Known::OfStep } else { Known::Nothing };
        let (contacts, instant, outputs) = Default::default();
        Self { conditions, known, contacts, instant, outputs }
    }

    /// A point that a bearing without states comes to, with its contacts.
    pub fn rested(conditions: Conditions, contacts: Contacts) -> Self {
        Self { known: Known::Rested, ..Self::of_contacts(conditions, contacts) }
    }

    /// A point whose contacts were evaluated.
    pub fn of_contacts(conditions: Conditions, contacts: Contacts) -> Self {
        Self { contacts: OnceLock::from(Box::new(contacts)), ..Self::new(conditions, false) }
    }
}

impl Simulation {
    /// Outputs of the last communication point.
    pub fn outputs(&self) -> &Outputs {
        let Point { conditions, outputs, .. } = &self.point;
        outputs.get_or_init(|| Outputs::of(&self.model, &self.state, self.contacts(), conditions))
    }

    /// The outputs of the last communication point, if they were asked for already.
    pub fn known_outputs(&self) -> Option<&Outputs> {
        self.point.outputs.get()
    }

    /// Sums of the last communication point, computed once: for who asks for few of its outputs.
    pub fn sums(&self) -> &Instant {
        self.point.instant.get_or_init(|| self.instant())
    }

    /// All contacts of the last communication point, evaluated once.
    pub(super) fn contacts(&self) -> &Contacts {
        let Point { conditions, known, contacts, .. } = &self.point;
        contacts.get_or_init(|| {
            Box::new(match known {
                Known::OfStep => self.workspace.contacts(&self.model),
                Known::Nothing | Known::Rested => Contacts::new(&self.model, &self.state, conditions),
            })
        })
    }

    /// Quantities where the last step ended; without all other outputs, where nobody asked for these.
    pub fn instant(&self) -> Instant {
        let Point { conditions, outputs, .. } = &self.point;
        match outputs.get() {
            Some(outputs) => outputs.into(),
            None => Instant::of(&self.model, &self.state, self.contacts(), conditions),
        }
    }

    /// \[N] normal loads of all contacts with the races at the last communication point, as [`Outputs::loads`].
    pub fn loads(&self) -> impl Iterator<Item = f64> {
        self.contacts().balls.iter().flat_map(|ball| [ball.raceways.inner.load, ball.raceways.outer.load])
    }

    /// [N m] friction torque at the last communication point: [`Outputs::friction_torque`].
    pub fn friction_torque(&self) -> f64 {
        friction_torque(&self.model, &self.state, || self.sums().losses)
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
        // Said once: what is set later is seen anew.
        if let known @ Known::Rested = &mut self.point.known {
            *known = Known::Nothing;
            return;
        }
        let stepped = stepped && !self.model.without_states && self.workspace.has_contacts_of_state();
        self.point = Point::new(conditions(&self.inputs, &self.state), stepped);
    }

    /// Are all numbers finite that outputs are computed from?
    pub fn is_finite(&self) -> bool {
        self.state.is_finite()
    }
}
