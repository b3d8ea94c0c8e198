//! All that changes in a system, saved.

use serde::{Deserialize, Serialize};

use super::super::play::Scripted;
use super::super::{Simulation, Snapshot};
use super::inputs::{ShaftInputs, ShaftPaths};
use super::pace::Pace;
use super::{LevelJump, System};
use crate::dynamics::system::KeptBorder;
use crate::dynamics::system::elements::ElementState;
use crate::model::link::LinkState;
use crate::model::structure::StructureState;

/// All that changes in a system: enough to go on from here to the same bits, in any instance of the same scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SystemSnapshot {
    inputs: ShaftInputs,
    paths: ShaftPaths,
    /// States of the shaft, and of every housing.
    states: Vec<StructureState>,
    /// States of what links them.
    links: Vec<LinkState>,
    /// States of the elements of bearings that have no others.
    elements: Vec<ElementState>,
    /// Which bearings have states.
    with_states: Vec<bool>,
    /// What changes of level did.
    jumps: Vec<LevelJump>,
    /// Matrix of steps of a machine all of whose bearings are without states, if one is kept.
    border: Option<KeptBorder>,
    pace: Pace,
    bearings: Vec<Snapshot>,
}

impl SystemSnapshot {
    /// \[s] time.
    pub fn time(&self) -> f64 {
        self.pace.time
    }
}

impl System {
    fn with_states(&self) -> impl Iterator<Item = bool> {
        self.bearings.iter().map(|bearing| !bearing.model.without_states)
    }

    /// Everything needed to come back to this point.
    pub fn snapshot(&self) -> SystemSnapshot {
        SystemSnapshot {
            inputs: self.structures.inputs.clone(),
            paths: self.structures.paths.clone(),
            states: self.structures.states.clone(),
            links: self.structures.link_states.clone(),
            elements: self.structures.element_states.clone(),
            with_states: self.with_states().collect(),
            jumps: self.structures.jumps.clone(),
            border: self.structures.buffers.border.kept(),
            pace: self.structures.pace,
            bearings: self.bearings.iter().map(Simulation::snapshot).collect(),
        }
    }

    /// That, in the memory of an earlier one of this system.
    pub fn snapshot_into(&self, snapshot: &mut SystemSnapshot) {
        let SystemSnapshot {
            inputs,
            paths,
            states,
            links,
            elements,
            with_states,
            jumps,
            border,
            pace,
            bearings,
        } = snapshot;
        *border = self.structures.buffers.border.kept();
        *pace = self.structures.pace;
        inputs.clone_from(&self.structures.inputs);
        paths.clone_from(&self.structures.paths);
        states.clone_from(&self.structures.states);
        links.clone_from(&self.structures.link_states);
        elements.clone_from(&self.structures.element_states);
        with_states.clear();
        with_states.extend(self.with_states());
        jumps.clone_from(&self.structures.jumps);
        bearings.truncate(self.bearings.len());
        let (old, new) = self.bearings.split_at(bearings.len());
        old.iter().zip(&mut *bearings).for_each(|(bearing, snapshot)| bearing.snapshot_into(snapshot));
        bearings.extend(new.iter().map(Simulation::snapshot));
    }

    /// Goes to a point that the same system was at; false, with nothing changed, if the snapshot is of another one.
    #[must_use]
    pub fn restore(&mut self, snapshot: &SystemSnapshot) -> bool {
        let same = snapshot.bearings.len() == self.bearings.len()
            && self.bearings.iter().zip(&snapshot.bearings).all(|(bearing, snapshot)| bearing.fits(snapshot))
            && self.with_states().eq(snapshot.with_states.iter().copied())
            && snapshot.jumps.len() == self.bearings.len()
            && snapshot.inputs.fits(&self.structures.inputs)
            && snapshot.paths.fits(&self.structures.inputs)
            && snapshot.links.len() == self.structures.link_states.len()
            && (snapshot.links.iter().zip(&self.structures.link_states))
                .all(|(one, own)| one.rollers.len() == own.rollers.len())
            && snapshot.elements.len() == self.structures.element_states.len()
            && (snapshot.elements.iter().zip(&self.structures.element_states))
                .all(|(one, own)| one.rested.len() == own.rested.len())
            && snapshot.states.len() == self.structures.states.len()
            && self
                .structures
                .carriers
                .iter()
                .zip(&snapshot.states)
                .all(|(one, state)| state.fits(one.structure.size(), one.structure.held.len()))
            && snapshot.pace.time.is_finite()
            && snapshot.pace.control.fits(&self.structures.pace.control)
            && snapshot.pace.statistics.plausible()
            && snapshot.bearings.iter().all(|bearing| bearing.time() == snapshot.time());
        let rows = self.structures.carriers.iter().map(|one| one.structure.size()).sum();
        let same = same && self.structures.buffers.border.restore(snapshot.border.as_ref(), rows);
        if same {
            self.structures.pace = snapshot.pace;
            self.structures.inputs.clone_from(&snapshot.inputs);
            self.structures.paths.clone_from(&snapshot.paths);
            self.structures.states.clone_from(&snapshot.states);
            self.structures.link_states.clone_from(&snapshot.links);
            self.structures.element_states.clone_from(&snapshot.elements);
            self.structures.jumps.clone_from(&snapshot.jumps);
            let restored = self.bearings.iter_mut().zip(&snapshot.bearings);
            let all = restored.fold(true, |all, (bearing, snapshot)| bearing.restore(snapshot) && all);
            debug_assert!(all, "they were looked at");
            self.together().report();
        }
        same
    }
}
