//! From one communication point to the next, in steps that end at the knots of the scripts: of a bearing alone, and of those of a shaft.

use std::cmp::Ordering;

use super::error::SimulationError;
use super::inputs::Inputs;
use super::outputs::Outputs;
use super::script::{Script, script_motion};
use super::system::Played;
use super::together::{Stopped, Together};
use super::{Simulation, step_limits};
use crate::dynamics::system::{
    Joined, Part, Perturbed, StageBounds, Started, StructureLoad, advance_perturbed, try_step,
};
use crate::dynamics::{Boundary, StepFailure, Workspace, failure_site};
use crate::effects::film::Films;
use crate::model::bodies::Race;
use crate::model::state::State;
use crate::model::structure::StructureState;
use crate::numerics::step_control::StepControl;
use crate::scene::{Drive, Groups, Level};
use crate::schema::Method;

impl Together<'_> {
    /// Scripted its own steps to exactly `end` \[s] under the inputs as set, some of them given by the scripts where there are some: those
    /// are then those of the time reached. Takes along what has slightly different inputs, in the same steps.
    pub fn advance(
        &mut self,
        end: f64,
        played: &Played,
        perturbed: &mut [Together<'_>],
    ) -> Result<(), Stopped> {
        self.check_end(end)?;
        for beside in &mut *perturbed {
            beside.begin_scripts(end, played);
        }
        let scripts = self.begin_scripts(end, played);
        let followed = self.follow((&scripts, played), end, perturbed);
        self.finish((&scripts, played), followed.is_ok());
        for beside in perturbed {
            beside.finish((&scripts, played), false);
        }
        followed.and_then(|()| self.check_contacts())
    }

    /// Refuses an end of a communication step that is no later time.
    pub fn check_end(&self, end: f64) -> Result<(), Stopped> {
        let from = self.time();
        let later = end > from && end.is_finite();
        if later { Ok(()) } else { Err((0, SimulationError::Backwards { from, to: end })) }
    }

    fn follow(
        &mut self,
        course: (&[Script], &Played),
        end: f64,
        perturbed: &mut [Together<'_>],
    ) -> Result<(), Stopped> {
        // The perturbed steps leave the running bearings as they are.
        let mut aside = vec![];
        for stop in self.stops(course, end) {
            while self.time() < stop {
                self.step_towards(course, stop, perturbed, &mut aside)?;
            }
        }
        Ok(())
    }

    /// \[s] times at which a step ends on the way to `end`: knots of the scripts, not closer to one another or to the ends than the least
    /// step, and the end.
    pub fn stops(&self, (scripts, played): (&[Script], &Played), end: f64) -> Vec<f64> {
        let from = self.time();
        let least = self.solver().min_step.0;
        let each = scripts.iter().zip(&*self.bearings);
        let mut knots: Vec<f64> =
            each.flat_map(|(script, bearing)| script.knots(&bearing.scene, from, end)).collect();
        if let Some(structures) = &self.structures {
            knots.extend(structures.knots(played, from, end));
        }
        knots.sort_by(f64::total_cmp);
        let mut last = from;
        knots.retain(|&knot| {
            let apart = knot - last >= least && end - knot >= least;
            if apart {
                last = knot;
            }
            apart
        });
        knots.push(end);
        knots
    }

    /// Takes one step towards a time \[s], not beyond it.
    pub fn step_towards(
        &mut self,
        (scripts, played): (&[Script], &Played),
        end: f64,
        perturbed: &mut [Together<'_>],
        aside: &mut Vec<Workspace>,
    ) -> Result<(), Stopped> {
        loop {
            let time = self.time();
            let mut control = self.control();
            let of_structures = self.structures.as_ref().and_then(|all| all.shortest_period(played, time));
            for (bearing, script) in self.bearings.iter().zip(scripts) {
                let own = script.shortest_period(&bearing.scene, time);
                let period = own.into_iter().chain(of_structures).reduce(f64::min);
                if bearing.model.without_states {
                    bearing.longest_of_elements(period).into_iter().for_each(|limit| control.cap(limit));
                } else if let Some(limit) = step_limits::largest_step(&bearing.model, &bearing.state, period)
                {
                    control.cap(limit);
                }
            }
            let remaining = end - time;
            let h = control.step_within(remaining);
            // The last step ends at the communication point to the bit.
            let last = h >= remaining * (1.0 - 1e-9);
            let next = if last { end } else { time + h };
            if next.partial_cmp(&time) != Some(Ordering::Greater) {
                return Err((0, SimulationError::LostInRounding { time, step: h }));
            }
            let at = |time: f64| {
                let loads = self.loads(played, time);
                (self.imposed(scripts, &loads, time), loads)
            };
            let (boundaries, loads) = at(next);
            let places = self.solver().method.places().iter();
            let stages = places.map(|place| at(time + place * h));
            let stages: Vec<_> =
                stages.map(|(boundaries, loads)| StageBounds { boundaries, loads }).collect();
            let start: Option<Vec<State>> = (!perturbed.is_empty())
                .then(|| self.bearings.iter().map(|bearing| bearing.state.clone()).collect());
            match self.try_step((&boundaries, &loads), (h, &stages), &mut control) {
                Ok(ends) => {
                    if let Some(start) = start {
                        let accepted = (&boundaries[..], &loads[..], h);
                        self.perturb(start, accepted, (scripts, played, next), perturbed, aside)?;
                    }
                    if let Some(structures) = &mut self.structures {
                        structures.reach(ends, h);
                        structures.pace.time = next;
                        structures.pace.statistics.steps += 1;
                    }
                    self.rest_elements(&boundaries, h);
                    self.set_control(control);
                    return self.check_step(&boundaries);
                }
                Err((index, failure)) => {
                    self.set_control(control);
                    if !control.above_minimum() {
                        let stepped = self.bearings.iter().enumerate();
                        let mut stepped = stepped.filter(|(_, bearing)| !bearing.model.without_states);
                        return Err(match stepped.nth(index) {
                            Some((index, bearing)) => (index, bearing.too_small(failure, &boundaries[index])),
                            None => (0, self.too_small_for_structures(failure)),
                        });
                    }
                }
            }
        }
    }

    /// Tries one step of a size \[s] under these boundaries and loads, and those of its stages; on success gives the states of the structures.
    fn try_step(
        &mut self,
        (boundaries, loads): (&[Boundary], &[StructureLoad]),
        step: (f64, &[StageBounds]),
        control: &mut StepControl,
    ) -> Result<Vec<StructureState>, (usize, StepFailure)> {
        let mut buffers = std::mem::take(self.buffers());
        let structures = self.structures.as_deref();
        let steps = structures.map_or(vec![], |all| all.steps(&all.states, loads));
        let elements = structures.map_or(vec![], |all| all.element_steps(self.bearings, boundaries, step.0));
        let joined = structures.map_or(Joined::default(), |all| all.joined(&elements));
        let of = |(bearing, boundary)| {
            let Simulation { model, state, workspace, .. }: &mut Simulation = bearing;
            Part { model, state, boundary, workspace }
        };
        let stepped = self.bearings.iter_mut().zip(boundaries);
        let stepped = stepped.filter(|(bearing, _)| !bearing.model.without_states);
        let mut parts: Vec<Part<'_>> = stepped.map(of).collect();
        let tried = try_step(&mut parts, &steps, joined, step, control, &mut buffers);
        let without_states = self.bearings.iter_mut().filter(|bearing| bearing.model.without_states);
        without_states.for_each(|bearing| buffers.count(&mut bearing.state.statistics));
        if let Some(structures) = &mut self.structures {
            buffers.count(&mut structures.pace.statistics);
        }
        *self.buffers() = buffers;
        tried
    }

    /// Takes perturbed bearings along a step that was accepted: from where it started, under these boundaries and loads.
    fn perturb(
        &self,
        mut start: Vec<State>,
        (boundaries, loads, h): (&[Boundary], &[StructureLoad], f64),
        (scripts, played, next): (&[Script], &Played, f64),
        perturbed: &mut [Together<'_>],
        aside: &mut Vec<Workspace>,
    ) -> Result<(), Stopped> {
        let time = self.time();
        if self.solver().method != Method::Hht {
            return Err((0, SimulationError::NoDerivatives));
        }
        for (start, bearing) in start.iter_mut().zip(&*self.bearings) {
            // Renewed by the step itself.
            start.differences.clone_from(&bearing.state.differences);
        }
        let bearings = start.iter().zip(&*self.bearings).zip(boundaries);
        let bearings: Vec<Started<'_>> = bearings
            .filter(|((_, bearing), _)| !bearing.model.without_states)
            .map(|((start, bearing), boundary)| Started {
                model: &bearing.model,
                start,
                boundary,
                accepted: &bearing.workspace,
            })
            .collect();
        let imposed: Vec<_> = perturbed
            .iter()
            .map(|beside| {
                let loads = beside.loads(played, next);
                (beside.imposed(scripts, &loads, next), loads)
            })
            .collect();
        let stepped: Vec<bool> = self.bearings.iter().map(|bearing| !bearing.model.without_states).collect();
        let own = |boundaries: &[Boundary]| -> Vec<Boundary> {
            boundaries
                .iter()
                .zip(&stepped)
                .filter(|(_, stepped)| **stepped)
                .map(|(own, _)| own.clone())
                .collect()
        };
        let of_parts: Vec<_> = imposed.iter().map(|(boundaries, _)| own(boundaries)).collect();
        let parts = perturbed.iter_mut().zip(imposed.iter().zip(&of_parts)).map(
            |(beside, ((_, loads), boundaries))| Perturbed {
                states: (beside.bearings.iter_mut())
                    .filter(|bearing| !bearing.model.without_states)
                    .map(|bearing| &mut bearing.state)
                    .collect(),
                boundaries,
                structures: beside.structures.as_deref().map_or(vec![], |all| all.steps(&all.states, loads)),
            },
        );
        let structures = self.structures.as_deref();
        let buffers = match structures {
            Some(all) => &all.buffers,
            None => &self.bearings[0].buffers,
        };
        let steps = structures.map_or(vec![], |all| all.steps(&all.states, loads));
        let elements = structures.map_or(vec![], |all| all.element_steps(self.bearings, boundaries, h));
        let joined = structures.map_or(Joined::default(), |all| all.joined(&elements));
        let accepted = (h, &buffers.unknowns[..]);
        let ends = advance_perturbed(&bearings, &steps, joined, accepted, parts, aside)
            .ok_or((0, SimulationError::Singular(time)))?;
        for ((beside, ends), (boundaries, _)) in perturbed.iter_mut().zip(ends).zip(&imposed) {
            if let Some(structures) = &mut beside.structures {
                structures.reach(ends, h);
                structures.pace.time = next;
            }
            beside.rest_elements(boundaries, h);
        }
        Ok(())
    }

    /// The step that was tried last by a machine all of whose bearings are without states failed, and cannot be any smaller.
    fn too_small_for_structures(&self, failure: StepFailure) -> SimulationError {
        let cause = match failure {
            StepFailure::Newton(..) => "Newton's method does not converge",
            StepFailure::Error(_) => "the local error stays above solver.tolerance",
        };
        let (time, min_step) = (self.time(), self.solver().min_step.0);
        SimulationError::StepOfStructuresTooSmall { time, min_step, cause }
    }
}

impl Simulation {
    /// Scripted its own steps to exactly `end` \[s]. The inputs are taken as valid now, at the start.
    ///
    /// # Errors
    /// See [`SimulationError`]; the state is then that of the last converged step, at [`Simulation::time`]. Depth and place of
    /// contacts are looked at where the step ends.
    pub fn advance(&mut self, end: f64) -> Result<(), SimulationError> {
        self.advance_with(end, Groups::default())
    }

    /// Like [`Simulation::advance`], with some groups of inputs given by the scene's script where it has one. The inputs of
    /// these are then those of the time reached.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_with(&mut self, end: f64, scripted: Groups) -> Result<(), SimulationError> {
        self.advance_perturbed(end, &[], scripted).map(drop)
    }

    /// Like [`Simulation::advance_with`]; also gives what slightly different inputs would have led to, in the same
    /// steps. That is exact to first order: take differences between perturbations of opposite sign.
    ///
    /// # Errors
    /// As [`Simulation::advance`], and if the Newton matrix of a step is singular.
    pub fn advance_perturbed(
        &mut self,
        end: f64,
        inputs: &[Inputs],
        scripted: Groups,
    ) -> Result<Vec<Self>, SimulationError> {
        let beside = |inputs: &Inputs| {
            let mut bearing = self.beside();
            bearing.set_inputs(*inputs);
            bearing
        };
        let mut others: Vec<_> = inputs.iter().map(beside).collect();
        if self.model.solver.level == Level::Equilibrium {
            self.alone().check_end(end).map_err(|(_, why)| why)?;
            return self.advance_by_equilibria(end, others, scripted);
        }
        let mut perturbed: Vec<_> = others.iter_mut().map(Self::alone).collect();
        let played = Played::of_bearing(scripted);
        self.alone().advance(end, &played, &mut perturbed).map_err(|(_, why)| why)?;
        Ok(others)
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

    /// Boundary of the bearing where a step ends that goes to a time \[s].
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
