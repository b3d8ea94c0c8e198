//! From one communication point to the next, in steps that end at the knots of the script.

use std::cmp::Ordering;

use super::error::SimulationError;
use super::input_paths::InputPaths;
use super::inputs::Inputs;
use super::outputs::Outputs;
use super::script::{Script, script_motion};
use super::{Simulation, conditions, step_limits};
use crate::dynamics::{Boundary, StepFailure, Workspace, advance_perturbed, failure_site, try_step};
use crate::effects::film::Films;
use crate::model::bodies::Race;
use crate::model::state::State;
use crate::scene::{Drive, Groups, Level};

/// A simulation beside the running one, under slightly different inputs.
pub(super) struct Perturbed {
    state: State,
    paths: InputPaths,
    inputs: Inputs,
}

impl Simulation {
    /// Runs its own steps to exactly `end` \[s]. The inputs are taken as valid now, at the start.
    ///
    /// # Errors
    /// See [`SimulationError`]; the state is then that of the last converged step, at [`Simulation::time`]. Depth and place of
    /// contacts are looked at where the step ends.
    pub fn advance(&mut self, end: f64) -> Result<(), SimulationError> {
        self.advance_perturbed(end, &[], Groups::default()).map(drop)
    }

    /// Like [`Simulation::advance`], with some groups of inputs given by the scene's script where it has one. The inputs of
    /// these are then those of the time reached.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_with(&mut self, end: f64, scripted: Groups) -> Result<(), SimulationError> {
        self.advance_perturbed(end, &[], scripted).map(drop)
    }

    /// Like [`Simulation::advance`], with some groups of inputs given by the scene's script where it has one; also gives the outputs that slightly different inputs would have led to, in the same
    /// steps. They are exact to first order: take differences between perturbations of opposite sign.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and if the Newton matrix of a step is singular.
    pub fn advance_perturbed(
        &mut self,
        end: f64,
        inputs: &[Inputs],
        scripted: Groups,
    ) -> Result<Vec<Outputs>, SimulationError> {
        let begin = self.state.time;
        if !(end > begin && end.is_finite()) {
            return Err(SimulationError::Backwards { from: begin, to: end });
        }
        if self.model.solver.level == Level::Equilibrium {
            return self.advance_by_equilibria(end, inputs, scripted);
        }
        let script = self.begin_script(scripted);
        let mut perturbed: Vec<Perturbed> = inputs
            .iter()
            .map(|inputs| {
                let mut inputs = *inputs;
                self.script_fixed_races(begin, &mut inputs);
                let paths = self.paths.towards(&inputs, begin, end - begin);
                Perturbed { state: self.state.clone(), paths, inputs }
            })
            .collect();
        self.paths = self.paths.towards(&self.inputs, begin, end - begin);
        let result = self.follow(&script, end, &mut perturbed);
        self.end_script(&script, result.is_ok());
        result.and_then(|()| self.check_contacts())?;
        let outputs = |p: &Perturbed| {
            let mut inputs = p.inputs;
            script.set_inputs(&self.scene, &p.paths, p.state.time, &mut inputs);
            Outputs::new(&self.model, &p.state, &conditions(&inputs, &p.state))
        };
        Ok(perturbed.iter().map(outputs).collect())
    }

    /// The script of a communication step that begins now, from the inputs as set; where paths lead is left to the caller.
    pub(super) fn begin_script(&mut self, scripted: Groups) -> Script {
        let begin = self.state.time;
        self.begin_report();
        let script = Script::new(&self.scene, scripted);
        let mut given = self.inputs;
        self.script_fixed_races(begin, &mut given);
        self.inputs = given;
        script.begin(&mut self.paths, begin);
        script
    }

    /// Inputs at the end of a communication step. The last step's own evaluation serves for outputs where it was `accepted`.
    pub(super) fn end_script(&mut self, script: &Script, accepted: bool) {
        script.set_inputs(&self.scene, &self.paths, self.state.time, &mut self.inputs);
        self.reach(accepted);
        if script.gives_inputs() {
            self.paths = self.paths.after_script(&self.inputs, &self.state);
        }
    }

    /// What is imposed on the bearing where a step ends that goes to a time \[s].
    pub(super) fn imposed(&self, script: &Script, time: f64) -> Boundary {
        let mut boundary = self.boundary(time);
        script.impose(&self.scene, &self.paths, &mut boundary);
        boundary.see_spins(&self.model);
        boundary.turn_balls(&self.model, &self.state);
        boundary
    }

    /// The scene's script says how a race moves that is fixed in its frame or hinged to it, but for a speed that is the same
    /// at all times: that is an input.
    pub(super) fn script_fixed_races(&self, time: f64, inputs: &mut Inputs) {
        let load = &self.scene.load;
        for (race, section, speed) in [
            (Race::Inner, &self.scene.inner, &load.inner_speed),
            (Race::Outer, &self.scene.outer, &load.outer_speed),
        ] {
            if matches!(section.drive, Drive::Fixed | Drive::Hinge) {
                let now = self.paths.races[race].at(time).0;
                let input = &mut inputs[race];
                if speed.is_scripted() {
                    input.speed = speed.at(time);
                }
                script_motion(&self.scene, race, time, &now, input);
            }
        }
    }

    /// Steps to `end` \[s] and to the knots of the script on the way.
    fn follow(
        &mut self,
        script: &Script,
        end: f64,
        perturbed: &mut [Perturbed],
    ) -> Result<(), SimulationError> {
        // The perturbed steps leave the running simulation as it is.
        let mut aside = Workspace::default();
        for stop in self.stops(script, end) {
            while self.state.time < stop {
                self.step_towards(script, stop, perturbed, &mut aside)?;
            }
        }
        Ok(())
    }

    /// \[s] times at which a step ends on the way to `end`: knots of the script, and the end.
    pub(super) fn stops(&self, script: &Script, end: f64) -> Vec<f64> {
        let least = self.model.solver.min_step.0;
        let mut stops = script.knots(&self.scene, self.state.time, end, least);
        stops.push(end);
        stops
    }

    /// Takes one step towards a time \[s], not beyond it.
    pub(super) fn step_towards(
        &mut self,
        script: &Script,
        end: f64,
        perturbed: &mut [Perturbed],
        aside: &mut Workspace,
    ) -> Result<(), SimulationError> {
        loop {
            let remaining = end - self.state.time;
            let period = script.shortest_period(&self.scene, self.state.time);
            if let Some(limit) = step_limits::largest_step(&self.model, &self.state, period) {
                self.state.control.cap(limit);
            }
            let h = self.state.control.step_within(remaining);
            // The last step ends at the communication point to the bit.
            let last = h >= remaining * (1.0 - 1e-9);
            let next = if last { end } else { self.state.time + h };
            if next.partial_cmp(&self.state.time) != Some(Ordering::Greater) {
                return Err(SimulationError::LostInRounding { time: self.state.time, step: h });
            }
            let boundary = self.imposed(script, next);
            let start = (!perturbed.is_empty()).then(|| self.state.clone());
            let tried = try_step(&self.model, &mut self.state, &boundary, h, &mut self.workspace);
            let failure = match tried {
                Ok(()) => {
                    self.check_creep(&boundary)?;
                    if let Some(mut start) = start {
                        // Renewed by the step itself.
                        start.differences.clone_from(&self.state.differences);
                        let (scene, model) = (&self.scene, &self.model);
                        let perturbed = perturbed.iter_mut().map(|p| {
                            let mut boundary = p.paths.boundary(boundary.time, &p.inputs);
                            script.impose(scene, &p.paths, &mut boundary);
                            boundary.see_spins(model);
                            boundary.turn_balls(model, &p.state);
                            boundary.see_temperatures(&p.state);
                            (&mut p.state, boundary)
                        });
                        let accepted = &self.workspace;
                        if !advance_perturbed(&self.model, &start, &boundary, h, perturbed, accepted, aside) {
                            return Err(SimulationError::Singular(start.time));
                        }
                    }
                    return Ok(());
                }
                Err(failure) => failure,
            };
            if !self.state.control.above_minimum() {
                return Err(self.too_small(failure, &boundary));
            }
        }
    }

    /// The step that was tried last failed, and cannot be any smaller.
    pub(super) fn too_small(&self, failure: StepFailure, boundary: &Boundary) -> SimulationError {
        let (cause, worst) = match failure {
            StepFailure::Newton(_, worst) => ("Newton's method does not converge", worst),
            StepFailure::Error(worst) => ("the local error stays above solver.tolerance", worst),
        };
        let outputs = Outputs::new(&self.model, &self.state, &self.conditions());
        let site = failure_site(&self.model, &self.state, boundary, worst, &self.workspace);
        let ball = &outputs.balls[site.ball - 1];
        let conditions = self.conditions();
        let stiff = |films: &Films| films.stiff_oil(conditions.lubrication, &conditions.warmth);
        SimulationError::StepTooSmall {
            time: self.state.time,
            min_step: self.model.solver.min_step.0,
            cause,
            site,
            inner_load: ball.inner.load,
            outer_load: ball.outer.load,
            oil: self.model.films.as_ref().and_then(stiff).map(|said| format!("; {said}")),
        }
    }
}
