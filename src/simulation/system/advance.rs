//! A system from one row to the next, in steps that end at the knots of its scripts.

use std::cmp::Ordering;

use nalgebra::DVector;

use super::super::inputs::Inputs;
use super::super::script::Script;
use super::super::{Simulation, SimulationError, step_limits};
use super::inputs::{Given, Played, ShaftInputs};
use super::{System, SystemError, SystemOutputs, loads};
use crate::dynamics::system::{
    Part, Perturbed, Started, StructureLoad, StructureStep, advance_perturbed, try_step,
};
use crate::dynamics::{Boundary, StepFailure, Workspace};
use crate::model::bodies::Race;
use crate::model::structure::{Carrier, Spin, StructureState, Turning};
use crate::numerics::tilt;
use crate::scene::{Groups, Level};

impl System {
    /// Runs its own steps to exactly `end` \[s] by the scripts of all bearings and the shaft.
    ///
    /// # Errors
    /// See [`SystemError`]; the state is then that of the last converged step, at [`System::time`].
    pub fn advance(&mut self, end: f64) -> Result<(), SystemError> {
        self.inputs = ShaftInputs::scripted(&self.scene, self.time);
        self.take_scripted_inputs();
        let result = self.advance_with(end, &Played::all(&self.scene));
        self.take_scripted_inputs();
        self.see_races();
        result
    }

    /// Is every point an equilibrium?
    pub(super) fn is_quasi_static(&self) -> bool {
        self.scene.solver().level == Level::Equilibrium
    }

    /// Sets the inputs of all bearings to what their scripts say now.
    pub(super) fn take_scripted_inputs(&mut self) {
        for bearing in &mut self.bearings {
            bearing.inputs = bearing.scripted_inputs(bearing.state.time);
        }
    }

    /// Runs its own steps to exactly `end` \[s] under the inputs as set, some of them given by the scripts where there are some: those
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
        let begin = self.time;
        if !(end > begin && end.is_finite()) {
            return Err(SystemError::Backwards { from: begin, to: end });
        }
        if self.is_quasi_static() {
            return self.advance_by_equilibria(end, inputs, played);
        }
        let beside = |(shaft, bearings): &(ShaftInputs, Vec<Inputs>)| {
            let mut system = self.clone();
            let fit = system.set_inputs(shaft.clone(), bearings.clone());
            fit.then(|| system.begin_scripts(end, played)).map(|_| system)
        };
        let perturbed: Option<Vec<Self>> = inputs.iter().map(beside).collect();
        let mut perturbed = perturbed.ok_or(SystemError::OtherInputs)?;
        let scripts = self.begin_scripts(end, played);
        let result = self.follow((&scripts, played), end, &mut perturbed);
        self.finish(&scripts, played, result.is_ok());
        perturbed.iter_mut().for_each(|system| system.finish(&scripts, played, false));
        result?;
        self.check_contacts()?;
        Ok(perturbed)
    }

    /// Refuses contacts of the step that was accepted last, as bearings do.
    pub(super) fn check_contacts(&self) -> Result<(), SystemError> {
        for (index, bearing) in self.bearings.iter().enumerate() {
            bearing.check_contacts().map_err(|source| self.of_bearing(index, source))?;
        }
        Ok(())
    }

    /// Begins a communication step to a time \[s]: scripts of the bearings, and paths to the inputs that were set.
    pub(super) fn begin_scripts(&mut self, end: f64, played: &Played) -> Vec<Script> {
        let begin = self.time;
        self.paths = self.paths.towards(&self.inputs, begin, end - begin);
        let bearings = self.bearings.iter_mut().zip(&played.bearings);
        let script = |(bearing, groups): (&mut Simulation, &Groups)| {
            // Structures move these.
            let scripted = bearing.scripted_inputs(begin);
            for race in Race::BOTH.into_iter().filter(|race| bearing.model.is_carried(*race)) {
                bearing.inputs[race] = scripted[race];
            }
            let script = bearing.begin_script(*groups);
            bearing.paths = bearing.paths.towards(&bearing.inputs, begin, end - begin);
            script
        };
        bearings.map(script).collect()
    }

    /// Inputs and outputs at the end of a communication step. The last step's own evaluation serves for outputs where it was `accepted`.
    pub(super) fn finish(&mut self, scripts: &[Script], played: &Played, accepted: bool) {
        for (bearing, script) in self.bearings.iter_mut().zip(scripts) {
            bearing.end_script(script, accepted);
        }
        let given = Given { scene: &self.scene, paths: &self.paths, played };
        (self.inputs, self.paths) = given.reached(&self.inputs, self.time);
        self.report();
    }

    /// Sets what the inputs of bearings say of races that structures carry to where these are.
    pub(super) fn see_races(&mut self) {
        for bearing in &mut self.bearings {
            for race in Race::BOTH.into_iter().filter(|race| bearing.model.is_carried(*race)) {
                let state = bearing.state.race(race);
                bearing.inputs[race].follow(state.pose, state.twist(), state.rate.x);
            }
        }
    }

    /// Outputs of the state as it is.
    pub(super) fn report(&mut self) {
        self.see_races();
        let torque = match self.carriers[0].structure.turning {
            Turning::Free => self.paths.torque(self.time),
            Turning::Given | Turning::Still => self.states[0].torque,
        };
        self.outputs = SystemOutputs::of(&self.scene, &self.carriers, &self.states, torque, self.time);
    }

    fn follow(
        &mut self,
        (scripts, played): (&[Script], &Played),
        end: f64,
        perturbed: &mut [Self],
    ) -> Result<(), SystemError> {
        // The perturbed steps leave the running system as it is.
        let mut aside = vec![];
        for stop in self.stops((scripts, played), end) {
            while self.time < stop {
                self.step_towards((scripts, played), stop, perturbed, &mut aside)?;
            }
        }
        Ok(())
    }

    /// \[s] times at which a step ends on the way to `end`: knots of the scripts, and the end.
    pub(super) fn stops(&self, (scripts, played): (&[Script], &Played), end: f64) -> Vec<f64> {
        let least = self.scene.solver().min_step.0;
        let of_bearings = scripts
            .iter()
            .zip(&self.bearings)
            .flat_map(|(script, bearing)| script.knots(&bearing.scene, self.time, end, least));
        let given = Given { scene: &self.scene, paths: &self.paths, played };
        let mut knots: Vec<f64> = of_bearings.chain(loads::knots(&given, self.time, end)).collect();
        knots.sort_by(f64::total_cmp);
        let mut last = self.time;
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
    pub(super) fn step_towards(
        &mut self,
        (scripts, played): (&[Script], &Played),
        end: f64,
        perturbed: &mut [Self],
        aside: &mut Vec<Workspace>,
    ) -> Result<(), SystemError> {
        loop {
            let remaining = end - self.time;
            let given = Given { scene: &self.scene, paths: &self.paths, played };
            let of_shaft = loads::shortest_period(&given, &self.states[0], self.time);
            for (bearing, script) in self.bearings.iter().zip(scripts) {
                let own = script.shortest_period(&bearing.scene, self.time);
                let period = own.into_iter().chain(of_shaft).reduce(f64::min);
                if let Some(limit) = step_limits::largest_step(&bearing.model, &bearing.state, period) {
                    self.control.cap(limit);
                }
            }
            let h = self.control.step_within(remaining);
            // The last step ends at the row to the bit.
            let last = h >= remaining * (1.0 - 1e-9);
            let next = if last { end } else { self.time + h };
            if next.partial_cmp(&self.time) != Some(Ordering::Greater) {
                return Err(SystemError::LostInRounding { time: self.time, step: h });
            }
            let loads = self.loads(played, next);
            let boundaries = self.imposed(scripts, &loads, next);
            let start = (!perturbed.is_empty()).then(|| self.bearings.clone());
            let structures = structure_steps(&self.carriers, &self.scales, &self.states, &loads);
            let mut parts: Vec<Part<'_>> = self
                .bearings
                .iter_mut()
                .zip(&boundaries)
                .map(|(bearing, boundary)| Part {
                    model: &bearing.model,
                    state: &mut bearing.state,
                    boundary,
                    workspace: &mut bearing.workspace,
                })
                .collect();
            let tried =
                try_step(&mut parts, &structures, &self.joints, h, &mut self.control, &mut self.workspace);
            drop(parts);
            match tried {
                Ok(ends) => {
                    if let Some(mut start) = start {
                        let accepted = (&boundaries[..], &loads[..], h);
                        self.perturb(&mut start, accepted, (scripts, played, next), perturbed, aside)?;
                    }
                    self.states = ends;
                    self.time = next;
                    return self.check_step(&boundaries);
                }
                Err((index, failure)) => {
                    if !self.control.above_minimum() {
                        return Err(self.too_small(index, failure, &boundaries[index]));
                    }
                }
            }
        }
    }

    /// Takes perturbed systems along a step that was accepted: from where bearings started, under these boundaries and loads.
    fn perturb(
        &self,
        start: &mut [Simulation],
        (boundaries, loads, h): (&[Boundary], &[StructureLoad], f64),
        (scripts, played, next): (&[Script], &Played, f64),
        perturbed: &mut [Self],
        aside: &mut Vec<Workspace>,
    ) -> Result<(), SystemError> {
        for (start, bearing) in start.iter_mut().zip(&self.bearings) {
            // Renewed by the step itself.
            start.state.differences.clone_from(&bearing.state.differences);
        }
        let bearings = start.iter().zip(&self.bearings).zip(boundaries);
        let bearings: Vec<Started<'_>> = bearings
            .map(|((start, bearing), boundary)| Started {
                model: &bearing.model,
                start: &start.state,
                boundary,
                accepted: &bearing.workspace,
            })
            .collect();
        let imposed: Vec<_> = perturbed
            .iter()
            .map(|system| {
                let loads = system.loads(played, next);
                let mut boundaries = system.imposed(scripts, &loads, next);
                for (boundary, bearing) in boundaries.iter_mut().zip(&system.bearings) {
                    boundary.see_temperatures(&bearing.state);
                }
                (loads, boundaries)
            })
            .collect();
        let ends = {
            let parts = perturbed.iter_mut().zip(&imposed).map(|(system, (loads, boundaries))| {
                let Self { bearings, carriers, scales, states, .. } = system;
                Perturbed {
                    states: bearings.iter_mut().map(|bearing| &mut bearing.state).collect(),
                    boundaries: boundaries.clone(),
                    structures: structure_steps(carriers, scales, states, loads),
                }
            });
            let structures = structure_steps(&self.carriers, &self.scales, &self.states, loads);
            let accepted = (h, &self.workspace.unknowns[..]);
            advance_perturbed(&bearings, &structures, &self.joints, accepted, parts, aside)
        };
        let ends = ends.ok_or(SystemError::Singular(self.time))?;
        for (system, states) in perturbed.iter_mut().zip(ends) {
            (system.states, system.time) = (states, next);
        }
        Ok(())
    }

    /// What acts on the structures at the end of a step \[s].
    pub(super) fn loads(&self, played: &Played, next: f64) -> Vec<StructureLoad> {
        let given = Given { scene: &self.scene, paths: &self.paths, played };
        loads::at(&given, &self.carriers, &self.states[0], self.time, next)
    }

    /// What is imposed on the bearings there.
    pub(super) fn imposed(&self, scripts: &[Script], loads: &[StructureLoad], next: f64) -> Vec<Boundary> {
        let speeds = self.speed_of_races(&loads[0].spin);
        let bearings = self.bearings.iter().zip(scripts).zip(&speeds);
        bearings
            .map(|((bearing, script), speed)| {
                let mut boundary = bearing.imposed(script, next);
                boundary.loads[Race::Inner].speed = *speed;
                boundary.see_spins(&bearing.model);
                boundary
            })
            .collect()
    }

    fn too_small(&self, index: usize, failure: StepFailure, boundary: &Boundary) -> SystemError {
        self.of_bearing(index, self.bearings[index].too_small(failure, boundary))
    }

    /// Refuses a state that the models of shaft and contacts do not hold for.
    fn check_step(&self, boundaries: &[Boundary]) -> Result<(), SystemError> {
        for (index, (bearing, boundary)) in self.bearings.iter().zip(boundaries).enumerate() {
            let checked: Result<(), SimulationError> = bearing.check_creep(boundary);
            checked.map_err(|source| self.of_bearing(index, source))?;
        }
        self.check_tilts()
    }

    /// Refuses tilts beyond those that linear structures are valid for.
    pub(super) fn check_tilts(&self) -> Result<(), SystemError> {
        for (index, bearing) in self.bearings.iter().enumerate() {
            for race in Race::BOTH.into_iter().filter(|race| bearing.model.is_carried(*race)) {
                let axis = bearing.state.race(race).axes[0];
                let tilt = axis.y.hypot(axis.z);
                if tilt.is_nan() || tilt > tilt::SMALL {
                    let (time, name) = (self.time, self.scene.bearings[index].name.clone());
                    let race = race.name();
                    return Err(SystemError::Tilted { time, name, race, tilt, limit: tilt::SMALL });
                }
            }
        }
        Ok(())
    }

    /// [rad/s] spin of the inner race of every bearing, in its own axes.
    fn speed_of_races(&self, given: &Spin) -> Vec<f64> {
        let speed = match self.carriers[0].structure.turning {
            Turning::Free => self.states[0].spin.speed,
            Turning::Given | Turning::Still => given.speed,
        };
        self.scene.bearings.iter().map(|bearing| bearing.mounting.direction.sign() * speed).collect()
    }
}

/// Structures at the start of a step, and what acts on them at its end.
pub(super) fn structure_steps<'a>(
    carriers: &'a [Carrier],
    scales: &'a [DVector<f64>],
    states: &'a [StructureState],
    loads: &'a [StructureLoad],
) -> Vec<StructureStep<'a>> {
    let all = carriers.iter().zip(scales).zip(states.iter().zip(loads));
    all.map(|((carrier, scales), (start, load))| StructureStep {
        model: &carrier.structure,
        scales,
        start,
        load,
    })
    .collect()
}
