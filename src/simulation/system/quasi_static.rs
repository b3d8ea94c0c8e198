//! `solver.level = "equilibrium"` of a system: every row and communication point is the equilibrium of shaft, housings and bearings under
//! the present inputs.

use super::super::inputs::Inputs;
use super::inputs::{Given, Played, ShaftInputs};
use super::{System, SystemError};

impl System {
    /// Goes to the equilibrium at `end` \[s] under the inputs as set and what the scripts give then; also gives the equilibria under
    /// slightly different inputs.
    ///
    /// # Errors
    /// If there is no equilibrium; the system then stays where it is.
    pub(super) fn advance_by_equilibria(
        &mut self,
        end: f64,
        inputs: &[(ShaftInputs, Vec<Inputs>)],
        played: &Played,
    ) -> Result<Vec<Self>, SystemError> {
        let beside = |(shaft, bearings): &(ShaftInputs, Vec<Inputs>)| {
            let mut system = self.clone();
            if !system.set_inputs(shaft.clone(), bearings.clone()) {
                return Err(SystemError::OtherInputs);
            }
            system.equilibrium_at(end, played)
        };
        let perturbed = inputs.iter().map(beside).collect::<Result<_, _>>()?;
        *self = self.equilibrium_at(end, played)?;
        Ok(perturbed)
    }

    fn equilibrium_at(&self, end: f64, played: &Played) -> Result<Self, SystemError> {
        let mut there = self.clone();
        let scripts = there.begin_scripts(end, played);
        let bearings: Vec<Inputs> = there
            .bearings
            .iter()
            .zip(&scripts)
            .map(|(bearing, script)| {
                let mut inputs = bearing.inputs;
                script.set_inputs(&bearing.scene, &bearing.paths, end, &mut inputs);
                inputs
            })
            .collect();
        let given = Given { scene: &self.scene, paths: &there.paths, played };
        let (inputs, paths) = given.reached(&there.inputs, end);
        let spin = given.spin(end);
        let mut next = Self::start(&self.scene, end, Some((&inputs, &bearings)), Some(spin))?;
        next.paths = paths;
        for (bearing, before) in next.bearings.iter_mut().zip(&self.bearings) {
            bearing.go_on_from(&before.state);
        }
        next.report();
        next.check_tilts()?;
        Ok(next)
    }
}
