//! Bearings that take their steps together, and how a communication step begins and ends: one alone, or several with the structures that
//! carry their races.

use super::point::Point;
use super::script::Script;
use super::system::{Played, Structures, steady_torque};
use super::{Simulation, SimulationError};
use crate::dynamics::system::{StepBuffers, StructureLoad};
use crate::dynamics::{Boundary, Workspace};
use crate::model::bodies::Race;
use crate::numerics::step_control::StepControl;
use crate::numerics::tilt;
use crate::scene::Groups;
use crate::schema::Solver;

/// Which bearing could not go on, and why.
pub type Stopped = (usize, SimulationError);

/// Bearings that take their steps together. All have the same time and the same step control.
pub struct Together<'a> {
    /// One, or those of the structures.
    pub(super) bearings: &'a mut [Simulation],
    /// Structures that carry their races; nothing where a bearing is alone.
    pub(super) structures: Option<&'a mut Structures>,
}

impl Together<'_> {
    /// \[s] time.
    pub fn time(&self) -> f64 {
        match &self.structures {
            Some(structures) => structures.pace.time,
            None => self.bearings[0].state.time,
        }
    }

    /// Settings of the steps.
    pub fn solver(&self) -> &Solver {
        match &self.structures {
            Some(structures) => &structures.solver,
            None => &self.bearings[0].model.solver,
        }
    }

    /// Control of the step size.
    pub fn control(&self) -> StepControl {
        match &self.structures {
            Some(structures) => structures.pace.control,
            None => self.bearings[0].state.control,
        }
    }

    /// Goes on with a control of the step size.
    pub fn set_control(&mut self, control: StepControl) {
        self.bearings.iter_mut().for_each(|bearing| bearing.state.control = control);
        if let Some(structures) = &mut self.structures {
            structures.pace.control = control;
        }
    }

    /// Buffers of the steps.
    pub fn buffers(&mut self) -> &mut StepBuffers {
        match &mut self.structures {
            Some(structures) => &mut structures.buffers,
            None => &mut self.bearings[0].buffers,
        }
    }

    /// Begins a communication step to a time \[s]: scripts of the bearings, and paths to the inputs that were set.
    pub fn begin_scripts(&mut self, end: f64, played: &Played) -> Vec<Script> {
        let begin = self.time();
        if let Some(structures) = &mut self.structures {
            structures.head_for_inputs(begin, end);
        }
        let bearings = self.bearings.iter_mut().zip(&played.bearings);
        let script = |(bearing, groups): (&mut Simulation, &Groups)| {
            for race in bearing.carried_races() {
                bearing.inputs[race] = bearing.scripted_race(race, begin);
            }
            let script = bearing.begin_script(*groups);
            bearing.paths = bearing.paths.towards(&bearing.inputs, begin, end - begin);
            script
        };
        bearings.map(script).collect()
    }

    /// Inputs and outputs at the end of a communication step. The last step's own evaluation serves for outputs where it was `accepted`.
    pub fn finish(&mut self, (scripts, played): (&[Script], &Played), accepted: bool) {
        for (bearing, script) in self.bearings.iter_mut().zip(scripts) {
            bearing.end_script(script, accepted);
        }
        let time = self.time();
        if let Some(structures) = &mut self.structures {
            structures.end_script(played, time);
        }
        self.report();
    }

    /// Sets what the inputs of bearings say of races that structures carry to where these are.
    pub fn see_races(&mut self) {
        for bearing in &mut *self.bearings {
            for race in bearing.carried_races() {
                let state = bearing.state.race(race);
                bearing.inputs[race].follow(state.pose, state.twist(), state.rate.x);
            }
        }
    }

    /// Sets the inputs to what the scripts say now.
    pub fn take_scripted_inputs(&mut self) {
        self.bearings.iter_mut().for_each(Simulation::take_scripted_inputs);
        self.see_races();
    }

    /// Outputs of the structures as they are.
    pub fn report(&mut self) {
        self.see_races();
        let time = self.time();
        let in_balance = self.is_quasi_static();
        if let Some(structures) = &mut self.structures {
            structures.report(time);
            if in_balance {
                steady_torque::hold(self.bearings, structures);
            }
        }
    }

    /// Loads on the structures at the end of a step \[s].
    pub fn loads(&self, played: &Played, next: f64) -> Vec<StructureLoad> {
        let of = |structures: &&mut Structures| structures.loads(played, self.time(), next);
        self.structures.as_ref().map_or(vec![], of)
    }

    /// Boundaries of the bearings there.
    pub fn imposed(&self, scripts: &[Script], loads: &[StructureLoad], next: f64) -> Vec<Boundary> {
        let of = |(bearing, script): (&Simulation, _)| bearing.imposed(script, next);
        let mut boundaries: Vec<_> = self.bearings.iter().zip(scripts).map(of).collect();
        if let Some(structures) = &self.structures {
            structures.turn_races(&mut boundaries, loads);
            let with_bearings = boundaries.iter_mut().zip(&*self.bearings);
            with_bearings.for_each(|(boundary, bearing)| boundary.see_spins(&bearing.model));
        }
        boundaries
    }

    /// Refuses contacts of the step that was accepted last which no material takes, or where no groove is.
    pub fn check_contacts(&self) -> Result<(), Stopped> {
        let mut each = self.bearings.iter().enumerate();
        each.try_for_each(|(index, bearing)| bearing.check_contacts().map_err(|why| (index, why)))?;
        self.check_elements()
    }

    /// Refuses a state that the models of creep and of linear structures do not hold for.
    pub fn check_step(&self, boundaries: &[Boundary]) -> Result<(), Stopped> {
        for (index, (bearing, boundary)) in self.bearings.iter().zip(boundaries).enumerate() {
            bearing.check_creep(boundary).map_err(|why| (index, why))?;
        }
        self.check_tilts()
    }

    /// Refuses tilts beyond those that linear structures are valid for.
    pub fn check_tilts(&self) -> Result<(), Stopped> {
        let mut each = self.bearings.iter().enumerate();
        each.try_for_each(|(index, bearing)| bearing.check_tilts().map_err(|why| (index, why)))
    }
}

impl Simulation {
    /// Alone.
    pub(super) fn alone(&mut self) -> Together<'_> {
        Together { bearings: std::slice::from_mut(self), structures: None }
    }

    /// A copy without buffers.
    pub(super) fn beside(&self) -> Self {
        Self {
            scene: self.scene.clone(),
            model: self.model.clone(),
            inputs: self.inputs,
            state: self.state.clone(),
            paths: self.paths.clone(),
            point: Point::new(self.conditions(), false),
            workspace: Workspace::default(),
            buffers: StepBuffers::default(),
        }
    }

    /// Races that structures carry.
    fn carried_races(&self) -> impl Iterator<Item = Race> + use<> {
        let carried = Race::BOTH.map(|race| self.model.is_carried(race).then_some(race));
        carried.into_iter().flatten()
    }

    /// Refuses tilts of carried races beyond those that linear structures are valid for.
    fn check_tilts(&self) -> Result<(), SimulationError> {
        for race in self.carried_races() {
            let axis = self.state.race(race).axes[0];
            let tilt = axis.y.hypot(axis.z);
            if tilt.is_nan() || tilt > tilt::SMALL {
                let (time, race) = (self.state.time, race.name());
                return Err(SimulationError::Tilted { time, race, tilt, limit: tilt::SMALL });
            }
        }
        Ok(())
    }
}
