//! A system from one communication point to the next.

use super::super::inputs::Inputs;
use super::super::play::Scripted;
use super::super::together::{Stopped, Together};
use super::super::{Simulation, SimulationError};
use super::inputs::{Played, ShaftInputs};
use super::{Structures, System, SystemError};
use crate::dynamics::system::StepBuffers;

impl System {
    /// Scripted its own steps to exactly `end` \[s] by the scripts of all bearings and the shaft.
    ///
    /// # Errors
    /// See [`SystemError`]; the state is then that of the last converged step, at [`System::time`].
    pub fn advance(&mut self, end: f64) -> Result<(), SystemError> {
        self.script_inputs();
        let result = self.advance_with(end, &self.scripts());
        self.together().take_scripted_inputs();
        result
    }

    /// Scripted its own steps to exactly `end` \[s] under the inputs as set, some of them given by the scripts where there are some: those
    /// are then those of the time reached. Loads and drive go linearly to what was set.
    ///
    /// # Errors
    /// As [`System::advance`].
    pub fn advance_with(&mut self, end: f64, played: &Played) -> Result<(), SystemError> {
        self.advance_perturbed(end, &[], played).map(drop)
    }

    /// Like [`System::advance_with`]; also gives what slightly different inputs would have led to, in the same steps. That is exact to first
    /// order: take differences between perturbations of opposite sign.
    ///
    /// # Errors
    /// As [`System::advance`], if there are too many or too few inputs, and if the Newton matrix of a step is singular.
    pub fn advance_perturbed(
        &mut self,
        end: f64,
        inputs: &[(ShaftInputs, Vec<Inputs>)],
        played: &Played,
    ) -> Result<Vec<Self>, SystemError> {
        let checked = self.together().check_end(end);
        checked.map_err(|why| self.stopped(why))?;
        let mut others = inputs.iter().map(|inputs| self.beside(inputs)).collect::<Result<Vec<_>, _>>()?;
        if self.together().is_quasi_static() {
            return self.advance_by_equilibria(end, others, played);
        }
        let mut perturbed: Vec<_> = others.iter_mut().map(Scripted::together).collect();
        let advanced = self.together().advance(end, played, &mut perturbed);
        drop(perturbed);
        advanced.map_err(|why| self.stopped(why))?;
        Ok(others)
    }

    /// A copy without buffers, under other inputs.
    fn beside(&self, (shaft, bearings): &(ShaftInputs, Vec<Inputs>)) -> Result<Self, SystemError> {
        let copies = self.bearings.iter().map(Simulation::beside).collect();
        let structures = Structures { buffers: StepBuffers::default(), ..self.structures.clone() };
        let mut system = Self { bearings: copies, structures };
        let fit = system.set_inputs(shaft.clone(), bearings.clone());
        fit.then_some(system).ok_or(SystemError::OtherInputs)
    }
}

impl Scripted for System {
    type Error = SystemError;

    fn time(&self) -> f64 {
        Self::time(self)
    }

    fn together(&mut self) -> Together<'_> {
        Together { bearings: &mut self.bearings, structures: Some(&mut self.structures) }
    }

    fn stopped(&self, (index, source): Stopped) -> SystemError {
        match source {
            SimulationError::Backwards { .. }
            | SimulationError::LostInRounding { .. }
            | SimulationError::Singular(_)
            | SimulationError::RollersOutOfBalance { .. } => SystemError::Together(source),
            source => {
                let name = self.structures.scene.bearings[index].name.clone();
                SystemError::Bearing { name, source }
            }
        }
    }

    fn scripts(&self) -> Played {
        Played::all(&self.structures.scene)
    }

    fn script_inputs(&mut self) {
        self.structures.inputs = ShaftInputs::scripted(&self.structures.scene, self.time());
        self.bearings.iter_mut().for_each(Scripted::script_inputs);
    }

    fn advance_by_script(&mut self, end: f64) -> Result<(), SystemError> {
        self.advance(end)
    }
}
