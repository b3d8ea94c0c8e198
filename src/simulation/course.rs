//! A run by the scene's own script, step by step: steps end where the motion wants it, and times within a step are read from it.

use super::inputs::Inputs;
use super::play::Scripted;
use super::point::Point;
use super::script::Script;
use super::system::Played;
use super::{Simulation, SimulationError, conditions};
use crate::dynamics::{StepBound, Workspace, within};
use crate::model::state::State;
use crate::model::structure::StructureState;
use crate::scene::{Groups, Level};

/// What a run needs between its steps.
#[derive(Debug)]
pub struct Course {
    /// Scripts of the bearings.
    pub(super) scripts: Vec<Script>,
    /// What scripts give of a shaft; none of a bearing alone.
    pub(super) played: Option<Played>,
    /// \[s] times at which a step ends, the next one last.
    pub(super) stops: Vec<f64>,
    /// Inputs of the bearings as steps have them: what the scripts do not give.
    pub(super) inputs: Vec<Inputs>,
    /// Where the last step began, if it may be looked into.
    pub(super) start: Option<Moment>,
    /// Where it ended, while an earlier time is looked at.
    pub(super) end: Option<Moment>,
}

/// States of a machine.
#[derive(Clone, Debug)]
pub struct Moment {
    /// \[s] time.
    pub(super) time: f64,
    /// Of the bearings.
    pub(super) bearings: Vec<StepBound>,
    /// Of the shaft and the housings.
    pub(super) structures: Vec<StructureState>,
}

impl Course {
    /// \[s] where the next step may not go beyond; none where the run has come to its end.
    pub(super) fn stop_after(&mut self, time: f64) -> Option<f64> {
        while self.stops.last().is_some_and(|stop| *stop <= time) {
            self.stops.pop();
        }
        self.stops.last().copied()
    }

    /// Where the last step began, if a time \[s] lies within it.
    pub(super) fn start_before(&self, time: f64, end: f64) -> Option<&Moment> {
        self.start.as_ref().filter(|start| start.time < time && time < end)
    }
}

impl Scripted for Simulation {
    type Error = SimulationError;

    fn time(&self) -> f64 {
        self.state.time
    }

    fn begin(&mut self, end: f64) -> Result<Course, SimulationError> {
        let begin = self.state.time;
        if !(end > begin && end.is_finite()) {
            return Err(SimulationError::Backwards { from: begin, to: end });
        }
        self.inputs = self.scripted_inputs(begin);
        let script = self.begin_script(Groups::ALL);
        self.paths = self.paths.towards(&self.inputs, begin, end - begin);
        let mut stops = self.stops(&script, end);
        stops.reverse();
        let (scripts, inputs) = (vec![script], vec![self.inputs]);
        Ok(Course { scripts, played: None, stops, inputs, start: None, end: None })
    }

    fn step(&mut self, course: &mut Course, row: f64) -> Result<(), SimulationError> {
        if self.model.solver.level == Level::Equilibrium {
            return self.advance_scripted(row);
        }
        let Some(stop) = course.stop_after(self.state.time) else { return Ok(()) };
        self.inputs = course.inputs[0];
        course.start = (row < self.state.time + self.state.control.longest()).then(|| self.moment());
        self.step_towards(&course.scripts[0], stop, &mut [], &mut Workspace::default())?;
        self.show_end(&course.scripts[0], &course.inputs[0]);
        self.check_contacts()
    }

    fn look_back(&mut self, course: &mut Course, time: f64) {
        let Some(start) = course.start_before(time, self.state.time) else { return };
        let end = self.moment();
        self.state.clone_from(&start.bearings[0].state);
        self.inputs = course.inputs[0];
        let boundary = self.imposed(&course.scripts[0], time);
        let seen = within(&self.model, [&start.bearings[0], &end.bearings[0]], &boundary);
        self.see(&course.scripts[0], &course.inputs[0], seen);
        course.end = Some(end);
    }

    fn look_up(&mut self, course: &mut Course) {
        let time = self.state.time;
        let Some(end) = course.end.take().and_then(|mut end| end.bearings.pop()) else {
            self.begin_report();
            return;
        };
        if let Some(start) = &mut course.start {
            self.go_back_to(end.state, &mut start.bearings[0].state, time);
        }
        self.show_end(&course.scripts[0], &course.inputs[0]);
    }

    fn end(&mut self, course: Course, accepted: bool) {
        if self.model.solver.level == Level::Dynamic {
            self.inputs = course.inputs[0];
            self.end_script(&course.scripts[0], accepted);
            self.take_scripted_inputs();
        }
    }
}

impl Simulation {
    fn moment(&self) -> Moment {
        Moment { time: self.state.time, bearings: vec![self.bound()], structures: vec![] }
    }

    /// Where it is, and its contacts there.
    pub(super) fn bound(&self) -> StepBound {
        StepBound { state: self.state.clone(), contacts: self.contacts_of(&self.point).into_owned() }
    }

    /// Shows where the last step has ended.
    pub(super) fn show_end(&mut self, script: &Script, inputs: &Inputs) {
        self.show_inputs(script, inputs);
        self.reach(true);
    }

    /// From the inputs that steps begin with, those that they follow, and beside them what the script says of those that they do not need.
    fn show_inputs(&mut self, script: &Script, inputs: &Inputs) {
        self.inputs = *inputs;
        script.set_inputs(&self.scene, &self.paths, self.state.time, &mut self.inputs);
        self.take_scripted_inputs();
    }

    /// Shows what was seen within the last step.
    pub(super) fn see(&mut self, script: &Script, inputs: &Inputs, seen: StepBound) {
        self.state = seen.state;
        self.show_inputs(script, inputs);
        self.point = Point::of_contacts(conditions(&self.inputs, &self.state), seen.contacts);
    }

    /// What is reported since the last row begins anew.
    pub(super) fn begin_report(&mut self) {
        let time = self.state.time;
        if let Some(heat) = &mut self.state.heat {
            heat.mark(time);
        }
        if let Some(means) = &mut self.state.means {
            means.mark(time);
        }
    }

    /// Is at the end of the last step again, after a time \[s] was looked at. What is reported since the last row begins anew there, for the next
    /// row within the same step, too.
    pub(super) fn go_back_to(&mut self, end: State, start: &mut State, time: f64) {
        let seen = std::mem::replace(&mut self.state, end);
        for state in [&mut self.state, start] {
            if let (Some(heat), Some(then)) = (&mut state.heat, &seen.heat) {
                heat.mark_as(then, time);
            }
            if let (Some(means), Some(then)) = (&mut state.means, &seen.means) {
                means.mark_as(then, time);
            }
        }
    }
}
