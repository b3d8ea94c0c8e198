//! A machine in motion: one bearing alone, or a shaft with its bearings. All that plays, watches and compares runs works on it.

use thiserror::Error;

use super::cage_push::CagePush;
use super::motions::Motion;
use super::play::Scripted;
use super::system::{Played, System, SystemError, script_changes_within, shaft_follows_time};
use super::together::{Stopped, Together};
use super::{Simulation, SimulationError};
use crate::model::state::Statistics;
use crate::numerics::step_control::StepControl;
use crate::scene::machine::MachineScene;

/// Why a machine could not start or go on.
#[derive(Debug, Error)]
pub enum MachineError {
    /// A bearing alone.
    #[error(transparent)]
    Bearing(#[from] SimulationError),
    /// A shaft with its bearings.
    #[error(transparent)]
    Shaft(#[from] SystemError),
}

/// A machine in motion. Cloning it saves everything; the clone goes on to the same bits.
#[derive(Clone, Debug)]
pub enum Machine {
    /// One bearing, whose races are given.
    Bearing(Box<Simulation>),
    /// A shaft with its bearings.
    Shaft(Box<System>),
}

impl Machine {
    /// Prepares a machine and starts it at time 0.
    ///
    /// # Errors
    /// See [`MachineError`].
    pub fn new(scene: &MachineScene) -> Result<Self, MachineError> {
        Ok(match scene {
            MachineScene::Bearing(scene) => Self::from(Simulation::new(scene)?),
            MachineScene::Shaft(scene) => Self::from(System::new(scene)?),
        })
    }

    /// The same, at a time \[s] of its script.
    ///
    /// # Errors
    /// See [`MachineError`].
    pub fn starting_at(scene: &MachineScene, time: f64) -> Result<Self, MachineError> {
        Ok(match scene {
            MachineScene::Bearing(scene) => Self::from(Simulation::starting_at(scene, time)?),
            MachineScene::Shaft(scene) => Self::from(System::starting_at(scene, time)?),
        })
    }

    /// \[s] time.
    pub fn time(&self) -> f64 {
        match self {
            Self::Bearing(bearing) => bearing.time(),
            Self::Shaft(system) => system.time(),
        }
    }

    /// The bearings by their names; that of a bearing alone is empty.
    pub fn bearings(&self) -> impl Iterator<Item = (&str, &Simulation)> {
        let (alone, mounted) = match self {
            Self::Bearing(bearing) => (Some(("", &**bearing)), None),
            Self::Shaft(system) => (None, Some(system.bearings())),
        };
        alone.into_iter().chain(mounted.into_iter().flatten())
    }

    /// Work of the integrator since the start: steps that all bearings take together, and the contacts of all of them.
    pub fn statistics(&self) -> Statistics {
        let each = self.bearings().map(|(_, bearing)| bearing.state().statistics);
        let join = |all: Statistics, one: Statistics| Statistics {
            contact_values: all.contact_values + one.contact_values,
            contact_tangents: all.contact_tangents + one.contact_tangents,
            polynomials: all.polynomials + one.polynomials,
            polynomial_failures: all.polynomial_failures + one.polynomial_failures,
            ..all
        };
        each.reduce(join).or(self.shaft().map(|system| *system.statistics())).unwrap_or_default()
    }

    /// Control of the step size.
    pub fn control(&self) -> &StepControl {
        match self {
            Self::Bearing(bearing) => &bearing.state().control,
            Self::Shaft(system) => system.control(),
        }
    }

    /// Does its script come to other values within a span \[s] of time?
    pub fn script_changes_within(&self, from: f64, to: f64) -> bool {
        let of_bearings = self.bearings().any(|(_, bearing)| bearing.script_changes_within(from, to));
        of_bearings || self.shaft().is_some_and(|system| script_changes_within(system.scene(), from, to))
    }

    /// Small motions about the present state: [`Simulation::motions`], [`System::motions`].
    pub fn motions(&self) -> Option<Vec<Motion>> {
        match self {
            Self::Bearing(bearing) => bearing.motions(),
            Self::Shaft(system) => system.motions(),
        }
    }

    /// Pushes the cage of every bearing that has one ([`Simulation::push_cage`]).
    pub fn push_cages(&mut self, push: impl Fn(&Simulation) -> CagePush) {
        match self {
            Self::Bearing(bearing) => bearing.push_cage(&push(bearing)),
            Self::Shaft(system) => system.push_cages(push),
        }
    }

    /// The shaft with its housings, where there is one.
    pub fn shaft(&self) -> Option<&System> {
        match self {
            Self::Bearing(_) => None,
            Self::Shaft(system) => Some(system),
        }
    }
}

impl From<Simulation> for Machine {
    fn from(bearing: Simulation) -> Self {
        Self::Bearing(Box::new(bearing))
    }
}

impl From<System> for Machine {
    fn from(system: System) -> Self {
        Self::Shaft(Box::new(system))
    }
}

impl Scripted for Machine {
    type Error = MachineError;

    fn time(&self) -> f64 {
        Self::time(self)
    }

    fn together(&mut self) -> Together<'_> {
        match self {
            Self::Bearing(bearing) => bearing.together(),
            Self::Shaft(system) => system.together(),
        }
    }

    fn stopped(&self, why: Stopped) -> MachineError {
        match self {
            Self::Bearing(bearing) => bearing.stopped(why).into(),
            Self::Shaft(system) => system.stopped(why).into(),
        }
    }

    fn scripts(&self) -> Played {
        match self {
            Self::Bearing(bearing) => bearing.scripts(),
            Self::Shaft(system) => system.scripts(),
        }
    }

    fn script_inputs(&mut self) {
        match self {
            Self::Bearing(bearing) => bearing.script_inputs(),
            Self::Shaft(system) => system.script_inputs(),
        }
    }

    fn advance_by_script(&mut self, end: f64) -> Result<(), MachineError> {
        match self {
            Self::Bearing(bearing) => bearing.advance_by_script(end)?,
            Self::Shaft(system) => system.advance_by_script(end)?,
        }
        Ok(())
    }
}

/// Does anything of a scene change by itself with time?
pub fn follows_time(scene: &MachineScene) -> bool {
    match scene {
        MachineScene::Bearing(scene) => super::follows_time(scene),
        MachineScene::Shaft(scene) => shaft_follows_time(scene),
    }
}
