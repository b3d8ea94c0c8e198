//! All that changes in a system, saved.

use serde::{Deserialize, Serialize};

use super::super::{Simulation, Snapshot};
use super::System;
use super::inputs::{ShaftInputs, ShaftPaths};
use crate::model::structure::StructureState;
use crate::numerics::step_control::StepControl;

/// All that changes in a system: enough to go on from here to the same bits, in any instance of the same scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SystemSnapshot {
    inputs: ShaftInputs,
    paths: ShaftPaths,
    /// Of the shaft, and of every housing.
    states: Vec<StructureState>,
    control: StepControl,
    time: f64,
    bearings: Vec<Snapshot>,
}

impl SystemSnapshot {
    /// \[s] time.
    pub fn time(&self) -> f64 {
        self.time
    }
}

impl System {
    /// Everything needed to come back to this point.
    pub fn snapshot(&self) -> SystemSnapshot {
        SystemSnapshot {
            inputs: self.inputs.clone(),
            paths: self.paths.clone(),
            states: self.states.clone(),
            control: self.control,
            time: self.time,
            bearings: self.bearings.iter().map(Simulation::snapshot).collect(),
        }
    }

    /// Goes to a point that the same system was at; false, with nothing changed, if the snapshot is of another one.
    #[must_use]
    pub fn restore(&mut self, snapshot: &SystemSnapshot) -> bool {
        let same = snapshot.bearings.len() == self.bearings.len()
            && self.bearings.iter().zip(&snapshot.bearings).all(|(bearing, snapshot)| bearing.fits(snapshot))
            && snapshot.inputs.fits(&self.inputs)
            && snapshot.paths.fits(&self.inputs)
            && snapshot.states.len() == self.states.len()
            && self
                .carriers
                .iter()
                .zip(&snapshot.states)
                .all(|(one, state)| state.fits(one.structure.size()))
            && snapshot.control.fits(&self.control)
            && snapshot.bearings.iter().all(|bearing| bearing.time() == snapshot.time);
        if same {
            self.inputs.clone_from(&snapshot.inputs);
            self.paths.clone_from(&snapshot.paths);
            self.states.clone_from(&snapshot.states);
            self.control = snapshot.control;
            self.time = snapshot.time;
            let restored = self.bearings.iter_mut().zip(&snapshot.bearings);
            let all = restored.fold(true, |all, (bearing, snapshot)| bearing.restore(snapshot) && all);
            debug_assert!(all, "they were looked at");
            self.report();
        }
        same
    }
}
