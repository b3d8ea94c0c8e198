//! `solver.level = "equilibrium"`: every row and communication point is the equilibrium under the present inputs.

use super::inputs::Inputs;
use super::script::{self, Script};
use super::{Simulation, SimulationError, start};
use crate::model::bodies::Race;
use crate::model::state::State;
use crate::scene::{Drive, Groups};

impl Simulation {
    /// Goes to the equilibrium at `end` \[s] under the inputs as set and what the script gives then; so do others under theirs.
    ///
    /// # Errors
    /// If there is no equilibrium; the simulation then stays where it is.
    pub(super) fn advance_by_equilibria(
        &mut self,
        end: f64,
        mut others: Vec<Self>,
        scripted: Groups,
    ) -> Result<Vec<Self>, SimulationError> {
        let script = Script::new(&self.scene, scripted);
        script.begin(&mut self.paths, self.state.time);
        for other in &mut others {
            other.paths.clone_from(&self.paths);
            other.go_to_equilibrium(&script, other.inputs, end)?;
        }
        self.go_to_equilibrium(&script, self.inputs, end)?;
        Ok(others)
    }

    fn go_to_equilibrium(
        &mut self,
        script: &Script,
        mut inputs: Inputs,
        end: f64,
    ) -> Result<(), SimulationError> {
        script.set_inputs(&self.scene, &self.paths, end, &mut inputs);
        self.script_fixed_races(end, &mut inputs);
        for (race, section) in [(Race::Inner, &self.scene.inner), (Race::Outer, &self.scene.outer)] {
            if section.drive == Drive::Hinge {
                inputs[race].pose = script::hinge(section, &inputs[race].frame, end);
            }
        }
        let state = start::from_inputs(&self.scene, &self.model, &mut inputs, end)
            .map_err(|why| SimulationError::NoEquilibrium { time: end, why: Box::new(why) })?;
        let before = std::mem::replace(&mut self.state, state);
        self.inputs = inputs;
        self.paths = self.paths.after_script(&inputs, &self.state);
        self.check_room()?;
        self.settle();
        self.go_on_from(&before);
        self.check_creep(&self.boundary(end))
    }

    /// An equilibrium that comes after another state: turns and loads are counted on, and the work of the integrator.
    pub(super) fn go_on_from(&mut self, before: &State) {
        let state = &mut self.state;
        (state.control, state.statistics, state.energies) =
            (before.control, before.statistics, before.energies);
        let passed = state.time - before.time;
        for ((_, body), (_, was)) in state.bodies.iter_mut().zip(before.bodies.iter()) {
            body.count_turn((was.turned, was.turned_rest), 0.5 * passed * (was.rate.x + body.rate.x));
        }
        if let (Some(mut sums), Some(now)) = (before.rating, &state.rating) {
            sums.add_until(now, passed);
            state.rating = Some(sums);
        }
        self.reach(false);
    }
}
