//! `solver.level = "equilibrium"` of a system: every row and communication point is the equilibrium of shaft, housings and bearings under
//! the present inputs.

use super::super::inputs::Inputs;
use super::super::play::Scripted;
use super::inputs::Played;
use super::pace::Pace;
use super::{System, SystemError};
use crate::model::state::State;

impl System {
    /// Goes to the equilibrium at `end` \[s] under the inputs as set and what the scripts give then; also gives the equilibria that others
    /// go to under theirs.
    ///
    /// # Errors
    /// If there is no equilibrium; the system then stays where it is.
    pub(super) fn advance_by_equilibria(
        &mut self,
        end: f64,
        others: Vec<Self>,
        played: &Played,
    ) -> Result<Vec<Self>, SystemError> {
        let there = |other: Self| other.equilibrium_at(end, played);
        let others = others.into_iter().map(there).collect::<Result<_, _>>()?;
        *self = self.clone().equilibrium_at(end, played)?;
        Ok(others)
    }

    fn equilibrium_at(mut self, end: f64, played: &Played) -> Result<Self, SystemError> {
        let before: Vec<State> = self.bearings.iter().map(|bearing| bearing.state.clone()).collect();
        let scripts = self.together().begin_scripts(end, played);
        let inputs = self.bearings.iter().zip(&scripts).map(|(bearing, script)| {
            let mut inputs = bearing.inputs;
            script.set_inputs(&bearing.scene, &bearing.paths, end, &mut inputs);
            inputs
        });
        let bearings: Vec<Inputs> = inputs.collect();
        let given = self.structures.given(played);
        let (inputs, paths) = given.reached(&self.structures.inputs, end);
        let spins = (0..self.structures.scene.shafts.len()).map(|shaft| given.spin(shaft, end)).collect();
        let mut next = Self::start(&self.structures.scene, end, Some((&inputs, &bearings)), Some(spins))?;
        next.structures.paths = paths;
        next.structures.pace = Pace { time: end, ..self.structures.pace };
        for (bearing, before) in next.bearings.iter_mut().zip(&before) {
            bearing.go_on_from(before);
        }
        next.together().report();
        let checked = next.together().check_tilts();
        checked.map_err(|why| next.stopped(why))?;
        Ok(next)
    }
}
