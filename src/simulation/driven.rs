//! A machine that is driven from outside: inputs go in, it starts and goes on under them, and comes back to points that it was at.

use serde::{Deserialize, Serialize};

use super::inputs::Inputs;
use super::machine::{Machine, MachineError};
use super::system::{Played, ShaftInputs, System, SystemSnapshot};
use super::{Simulation, Snapshot};
use crate::scene::machine::MachineScene;

/// Inputs of a machine, valid at the last communication point.
#[derive(Clone, Debug)]
pub struct MachineInputs {
    /// Inputs of the shaft and its housings; none of a bearing alone.
    pub shaft: Option<ShaftInputs>,
    /// Inputs of every bearing.
    pub bearings: Vec<Inputs>,
}

/// A point that a machine was at.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum MachineSnapshot {
    /// A bearing alone.
    Bearing(Box<Snapshot>),
    /// A shaft with its bearings.
    Shaft(Box<SystemSnapshot>),
}

impl MachineSnapshot {
    /// \[s] time.
    pub fn time(&self) -> f64 {
        match self {
            Self::Bearing(snapshot) => snapshot.time(),
            Self::Shaft(snapshot) => snapshot.time(),
        }
    }
}

impl Machine {
    /// Inputs as set last.
    pub fn inputs(&self) -> MachineInputs {
        MachineInputs {
            shaft: self.shaft().map(|system| system.inputs().clone()),
            bearings: self.bearings().map(|(_, bearing)| *bearing.inputs()).collect(),
        }
    }

    /// Sets the inputs of the next step or start. False, with nothing changed, if they are those of another machine.
    #[must_use]
    pub fn set_inputs(&mut self, inputs: MachineInputs) -> bool {
        match (self, inputs.shaft, &inputs.bearings[..]) {
            (Self::Bearing(bearing), None, [own]) => {
                bearing.set_inputs(*own);
                true
            }
            (Self::Shaft(system), Some(shaft), _) => system.set_inputs(shaft, inputs.bearings),
            _ => false,
        }
    }

    /// Starts again at the present time, from the equilibrium under the present inputs.
    ///
    /// # Errors
    /// See [`MachineError`].
    pub fn initialise(&mut self) -> Result<(), MachineError> {
        match self {
            Self::Bearing(bearing) => bearing.initialise()?,
            Self::Shaft(system) => system.initialise()?,
        }
        Ok(())
    }

    /// Sets the time \[s] of a machine that has not moved yet and does not follow time.
    ///
    /// # Errors
    /// If it does not start there.
    pub fn set_start_time(&mut self, time: f64) -> Result<(), MachineError> {
        match self {
            Self::Bearing(bearing) => bearing.set_start_time(time),
            Self::Shaft(system) if time == system.time() => {}
            Self::Shaft(system) => **system = System::starting_at(system.scene(), time)?,
        }
        Ok(())
    }

    /// Goes on with a scene that differs in tunable parameters alone.
    ///
    /// # Errors
    /// If a bearing has no equilibrium to begin another level at; nothing is then changed.
    pub fn tune(&mut self, scene: &MachineScene) -> Result<(), MachineError> {
        match (self, scene) {
            (Self::Bearing(bearing), MachineScene::Bearing(scene)) => bearing.tune(scene),
            (Self::Shaft(system), MachineScene::Shaft(scene)) => system.tune(scene)?,
            _ => debug_assert!(false, "a scene of another machine"),
        }
        Ok(())
    }

    /// Runs its own steps to exactly `end` \[s] under the inputs as set, some of them given by the scripts where there are some.
    ///
    /// # Errors
    /// See [`MachineError`]; the state is then that of the last converged step.
    pub fn advance_with(&mut self, end: f64, played: &Played) -> Result<(), MachineError> {
        match self {
            Self::Bearing(bearing) => bearing.advance_with(end, played.bearings[0])?,
            Self::Shaft(system) => system.advance_with(end, played)?,
        }
        Ok(())
    }

    /// Like [`Machine::advance_with`]; also gives what slightly different inputs of this machine would have led to, in the same steps. That is exact
    /// to first order: take differences between perturbations of opposite sign.
    ///
    /// # Errors
    /// As [`Machine::advance_with`], and if the Newton matrix of a step is singular.
    pub fn advance_perturbed(
        &mut self,
        end: f64,
        inputs: Vec<MachineInputs>,
        played: &Played,
    ) -> Result<Vec<Self>, MachineError> {
        Ok(match self {
            Self::Bearing(bearing) => {
                let inputs: Vec<Inputs> =
                    inputs.iter().flat_map(|one| one.bearings.first()).copied().collect();
                let ends = bearing.advance_perturbed(end, &inputs, played.bearings[0])?;
                ends.into_iter().map(Self::from).collect()
            }
            Self::Shaft(system) => {
                let inputs: Vec<_> =
                    inputs.into_iter().filter_map(|one| Some((one.shaft?, one.bearings))).collect();
                let ends = system.advance_perturbed(end, &inputs, played)?;
                ends.into_iter().map(Self::from).collect()
            }
        })
    }

    /// Everything needed to come back to this point.
    pub fn snapshot(&self) -> MachineSnapshot {
        match self {
            Self::Bearing(bearing) => MachineSnapshot::Bearing(Box::new(bearing.snapshot())),
            Self::Shaft(system) => MachineSnapshot::Shaft(Box::new(system.snapshot())),
        }
    }

    /// That, in the memory of an earlier one of this machine.
    pub fn snapshot_into(&self, snapshot: &mut MachineSnapshot) {
        match (self, snapshot) {
            (Self::Bearing(bearing), MachineSnapshot::Bearing(snapshot)) => bearing.snapshot_into(snapshot),
            (Self::Shaft(system), MachineSnapshot::Shaft(snapshot)) => system.snapshot_into(snapshot),
            (_, snapshot) => *snapshot = self.snapshot(),
        }
    }

    /// Goes to a point that the same machine was at; false, with nothing changed, if the snapshot is of another one.
    #[must_use]
    pub fn restore(&mut self, snapshot: &MachineSnapshot) -> bool {
        match (self, snapshot) {
            (Self::Bearing(bearing), MachineSnapshot::Bearing(snapshot)) => bearing.restore(snapshot),
            (Self::Shaft(system), MachineSnapshot::Shaft(snapshot)) => system.restore(snapshot),
            _ => false,
        }
    }

    /// Are all numbers finite that its outputs are computed from, but for those of the shaft?
    pub fn is_finite(&self) -> bool {
        self.bearings().all(|(_, bearing)| bearing.is_finite())
    }
}

/// Source of the values of a table of variables.
pub trait Parts {
    /// The shaft with its housings, where there is one.
    fn shaft(&self) -> Option<&System>;

    /// The bearings by their names; that of a bearing alone is empty.
    fn bearings(&self) -> impl Iterator<Item = (&str, &Simulation)>;
}

impl Parts for Machine {
    fn shaft(&self) -> Option<&System> {
        self.shaft()
    }

    fn bearings(&self) -> impl Iterator<Item = (&str, &Simulation)> {
        self.bearings()
    }
}

impl Parts for Simulation {
    fn shaft(&self) -> Option<&System> {
        None
    }

    fn bearings(&self) -> impl Iterator<Item = (&str, &Simulation)> {
        std::iter::once(("", self))
    }
}

impl Parts for System {
    fn shaft(&self) -> Option<&System> {
        Some(self)
    }

    fn bearings(&self) -> impl Iterator<Item = (&str, &Simulation)> {
        self.bearings()
    }
}
