//! A system from one row to the next, in steps that end at the knots of its scripts.

use std::cmp::Ordering;

use super::super::script::Script;
use super::super::{SimulationError, step_limits};
use super::inputs::{Given, Played, ShaftInputs};
use super::{System, SystemError, SystemOutputs, loads};
use crate::dynamics::StepFailure;
use crate::dynamics::system::{Part, StructureStep, try_step};
use crate::model::bodies::Race;
use crate::model::structure::{Spin, Turning};
use crate::numerics::tilt;

impl System {
    /// Runs its own steps to exactly `end` \[s] by the scripts of all bearings and the shaft.
    ///
    /// # Errors
    /// See [`SystemError`]; the state is then that of the last converged step, at [`System::time`].
    pub fn advance(&mut self, end: f64) -> Result<(), SystemError> {
        self.inputs = ShaftInputs::scripted(&self.scene, self.time);
        self.bearings
            .iter_mut()
            .for_each(|bearing| bearing.inputs = bearing.scripted_inputs(bearing.state.time));
        let result = self.advance_with(end, &Played::all(&self.scene));
        self.bearings
            .iter_mut()
            .for_each(|bearing| bearing.inputs = bearing.scripted_inputs(bearing.state.time));
        self.see_races();
        result
    }

    /// Runs its own steps to exactly `end` \[s] under the inputs as set, some of them given by the scripts where there are some: those
    /// are then those of the time reached. Loads and drive go linearly to what was set.
    ///
    /// # Errors
    /// As [`System::advance`].
    pub fn advance_with(&mut self, end: f64, played: &Played) -> Result<(), SystemError> {
        let begin = self.time;
        if !(end > begin && end.is_finite()) {
            return Err(SystemError::Backwards { from: begin, to: end });
        }
        let scripts: Vec<Script> = self
            .bearings
            .iter_mut()
            .zip(&played.bearings)
            .map(|(bearing, groups)| {
                // Structures move these.
                let scripted = bearing.scripted_inputs(begin);
                for race in Race::BOTH.into_iter().filter(|race| bearing.model.is_carried(*race)) {
                    bearing.inputs[race] = scripted[race];
                }
                let script = bearing.begin_script(*groups);
                bearing.paths = bearing.paths.towards(&bearing.inputs, begin, end - begin);
                script
            })
            .collect();
        self.paths = self.paths.towards(&self.inputs, begin, end - begin);
        let result = self.follow(&scripts, played, end);
        let mut checked = Ok(());
        for (index, (bearing, script)) in self.bearings.iter_mut().zip(&scripts).enumerate() {
            bearing.end_script(script, result.is_ok());
            if result.is_ok() && checked.is_ok() {
                checked = bearing.check_contacts().map_err(|source| (index, source));
            }
        }
        let given = Given { scene: &self.scene, paths: &self.paths, played };
        (self.inputs, self.paths) = given.reached(&self.inputs, self.time);
        self.report();
        result?;
        checked.map_err(|(index, source)| self.of_bearing(index, source))
    }

    /// Sets what the inputs of bearings say of races that structures carry to where these are.
    fn see_races(&mut self) {
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

    fn follow(&mut self, scripts: &[Script], played: &Played, end: f64) -> Result<(), SystemError> {
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
        knots.into_iter().chain([end]).try_for_each(|stop| self.step_to(scripts, played, stop))
    }

    fn step_to(&mut self, scripts: &[Script], played: &Played, end: f64) -> Result<(), SystemError> {
        while self.time < end {
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
            let given = Given { scene: &self.scene, paths: &self.paths, played };
            let loads = loads::at(&given, &self.carriers, &self.states[0], self.time, next);
            let speed = self.speed_of_races(&loads[0].spin);
            let boundaries: Vec<_> = self
                .bearings
                .iter()
                .zip(scripts)
                .zip(&speed)
                .map(|((bearing, script), speed)| {
                    let mut boundary = bearing.imposed(script, next);
                    boundary.loads[Race::Inner].speed = *speed;
                    boundary.see_spins(&bearing.model);
                    boundary
                })
                .collect();
            let structures: Vec<_> = self
                .carriers
                .iter()
                .zip(&self.scales)
                .zip(self.states.iter().zip(&loads))
                .map(|((carrier, scales), (start, load))| StructureStep {
                    model: &carrier.structure,
                    scales,
                    start,
                    load,
                })
                .collect();
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
                    self.states = ends;
                    self.time = next;
                    self.check_step(&boundaries)?;
                }
                Err((index, failure)) => {
                    if !self.control.above_minimum() {
                        return Err(self.too_small(index, failure, &boundaries[index]));
                    }
                }
            }
        }
        Ok(())
    }

    fn too_small(
        &self,
        index: usize,
        failure: StepFailure,
        boundary: &crate::dynamics::Boundary,
    ) -> SystemError {
        self.of_bearing(index, self.bearings[index].too_small(failure, boundary))
    }

    /// Refuses a state that the models of shaft and contacts do not hold for.
    fn check_step(&self, boundaries: &[crate::dynamics::Boundary]) -> Result<(), SystemError> {
        for (index, (bearing, boundary)) in self.bearings.iter().zip(boundaries).enumerate() {
            let checked: Result<(), SimulationError> = bearing.check_creep(boundary);
            checked.map_err(|source| self.of_bearing(index, source))?;
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
