//! A run by the scripts, step by step: steps end where the motion wants it, and times within a step are read from it.

use super::inputs::Inputs;
use super::play::Scripted;
use super::point::Point;
use super::script::Script;
use super::system::Played;
use super::together::{Stopped, Together};
use super::{Simulation, SimulationError, conditions};
use crate::dynamics::StepBound;
use crate::dynamics::system::elements::ElementState;
use crate::dynamics::system::{Joined, Stepped, within};
use crate::forces::Contacts;
use crate::model::link::LinkState;
use crate::model::state::State;
use crate::model::structure::StructureState;
use crate::scene::{Groups, Level};

/// Course of a run: data that it needs between its steps.
#[derive(Debug)]
pub struct Course {
    /// Scripts of the bearings.
    scripts: Vec<Script>,
    /// Groups of inputs that scripts give.
    played: Played,
    /// \[s] times at which a step ends, the next one last.
    stops: Vec<f64>,
    /// Inputs of the bearings as steps have them: what the scripts do not give.
    inputs: Vec<Inputs>,
    /// Where the last step began, if it may be looked into.
    start: Option<Moment>,
    /// Where it ended, while an earlier time is looked at.
    end: Option<Moment>,
}

/// States of a machine.
#[derive(Clone, Debug)]
struct Moment {
    /// \[s] time.
    time: f64,
    /// States of the bearings.
    bearings: Vec<StepBound>,
    /// States of the shafts and the housings.
    structures: Vec<StructureState>,
    /// States of what links them.
    links: Vec<LinkState>,
    /// States of the elements of bearings that have no others.
    elements: Vec<ElementState>,
}

impl Course {
    /// \[s] where the next step may not go beyond; none where the run has come to its end.
    fn stop_after(&mut self, time: f64) -> Option<f64> {
        while self.stops.last().is_some_and(|stop| *stop <= time) {
            self.stops.pop();
        }
        self.stops.last().copied()
    }

    /// Where the last step began, if a time \[s] lies within it.
    fn start_before(&self, time: f64, end: f64) -> Option<&Moment> {
        self.start.as_ref().filter(|start| start.time < time && time < end)
    }
}

impl Scripted for Simulation {
    type Error = SimulationError;

    fn time(&self) -> f64 {
        self.state.time
    }

    fn together(&mut self) -> Together<'_> {
        self.alone()
    }

    fn stopped(&self, (_, why): Stopped) -> SimulationError {
        why
    }

    fn scripts(&self) -> Played {
        Played::of_bearing(Groups::ALL)
    }

    fn script_inputs(&mut self) {
        self.inputs = self.scripted_inputs(self.state.time);
    }

    fn advance_by_script(&mut self, end: f64) -> Result<(), SimulationError> {
        self.advance_scripted(end)
    }
}

impl Together<'_> {
    /// Is every point an equilibrium?
    pub(super) fn is_quasi_static(&self) -> bool {
        self.solver().level == Level::Equilibrium
    }

    pub(super) fn begin_course(&mut self, end: f64, played: Played) -> Course {
        let scripts = self.begin_scripts(end, &played);
        let mut stops = self.stops((&scripts, &played), end);
        stops.reverse();
        let inputs = self.bearings.iter().map(|bearing| bearing.inputs).collect();
        Course { scripts, played, stops, inputs, start: None, end: None }
    }

    pub(super) fn step(&mut self, course: &mut Course, row: f64) -> Result<(), Stopped> {
        let time = self.time();
        let Some(stop) = course.stop_after(time) else { return Ok(()) };
        self.set_bearing_inputs(course);
        let longest = self.control().longest();
        course.start = (row < time + longest).then(|| self.moment());
        self.step_towards((&course.scripts, &course.played), stop, &mut [], &mut vec![])?;
        self.show(course);
        self.check_contacts()
    }

    pub(super) fn look_back(&mut self, course: &mut Course, time: f64) {
        let Some(start) = course.start_before(time, self.time()) else { return };
        let end = self.moment();
        for (bearing, bound) in self.bearings.iter_mut().zip(&start.bearings) {
            bearing.state.clone_from(&bound.state);
        }
        if let Some(structures) = &mut self.structures {
            structures.states.clone_from(&start.structures);
            structures.link_states.clone_from(&start.links);
            structures.element_states.clone_from(&start.elements);
        }
        self.set_bearing_inputs(course);
        let loads = self.loads(&course.played, time);
        let boundaries = self.imposed(&course.scripts, &loads, time);
        let ends = start.bearings.iter().zip(&end.bearings);
        let stepped = self.bearings.iter().zip(ends).zip(&boundaries);
        let mut stepped: Vec<_> = stepped
            .filter(|((bearing, _), _)| !bearing.model.without_states)
            .map(|((bearing, (start, end)), boundary)| Stepped {
                model: &bearing.model,
                ends: [start, end],
                boundary: boundary.clone(),
            })
            .collect();
        let spans = (time - start.time, end.time - start.time);
        let structures = self.structures.as_deref();
        let elements =
            structures.map_or(vec![], |all| all.element_steps(self.bearings, &boundaries, spans.0));
        let steps = structures.map_or(vec![], |all| all.steps(&start.structures, &loads));
        let joined = structures.map_or(Joined::default(), |all| all.joined(&elements));
        let (seen, states) = within(&mut stepped, &steps, &end.structures, joined, spans);
        drop((stepped, steps, elements));
        if let Some(structures) = &mut self.structures {
            structures.reach(states, spans.0);
            structures.pace.time = time;
        }
        self.rest_elements(&boundaries, spans.0);
        let mut seen = seen.into_iter();
        let all = self.bearings.iter_mut().zip(&course.scripts).zip(&course.inputs);
        for ((bearing, script), inputs) in all {
            match bearing.model.without_states {
                true => {
                    bearing.show_inputs(script, inputs);
                    bearing.reach(false);
                }
                false => seen.next().into_iter().for_each(|seen| bearing.see(script, inputs, seen)),
            }
        }
        self.report();
        course.end = Some(end);
    }

    pub(super) fn look_up(&mut self, course: &mut Course) {
        let time = self.time();
        let Some(Moment { time: ended, bearings, structures: states, links, elements }) = course.end.take()
        else {
            self.bearings.iter_mut().for_each(Simulation::begin_report);
            return;
        };
        let starts = course.start.iter_mut().flat_map(|start| &mut start.bearings);
        for ((bearing, end), start) in self.bearings.iter_mut().zip(bearings).zip(starts) {
            bearing.go_back_to(end.state, &mut start.state, time);
        }
        if let Some(structures) = &mut self.structures {
            (structures.states, structures.link_states) = (states, links);
            structures.element_states = elements;
            structures.pace.time = ended;
        }
        self.show(course);
    }

    pub(super) fn end(&mut self, course: &Course, accepted: bool) {
        if !self.is_quasi_static() {
            self.set_bearing_inputs(course);
            self.finish((&course.scripts, &course.played), accepted);
            self.take_scripted_inputs();
        }
    }

    /// Inputs of the bearings as steps have them.
    fn set_bearing_inputs(&mut self, course: &Course) {
        self.bearings.iter_mut().zip(&course.inputs).for_each(|(bearing, own)| bearing.inputs = *own);
    }

    fn moment(&self) -> Moment {
        let bearings = self.bearings.iter().map(Simulation::bound).collect();
        let structures = self.structures.as_ref().map_or(vec![], |all| all.states.clone());
        let links = self.structures.as_ref().map_or(vec![], |all| all.link_states.clone());
        let elements = self.structures.as_ref().map_or(vec![], |all| all.element_states.clone());
        Moment { time: self.time(), bearings, structures, links, elements }
    }

    /// Shows where the last step has ended.
    fn show(&mut self, course: &Course) {
        for ((bearing, script), inputs) in self.bearings.iter_mut().zip(&course.scripts).zip(&course.inputs) {
            bearing.show_inputs(script, inputs);
            bearing.reach(true);
        }
        self.report();
    }
}

impl Simulation {
    /// Where it is, and its contacts there.
    fn bound(&self) -> StepBound {
        let contacts = match self.model.without_states {
            true => Contacts::from_parts(&self.model, vec![], vec![], [None; 2]),
            false => self.contacts().clone(),
        };
        StepBound { state: self.state.clone(), contacts }
    }

    /// From the inputs that steps begin with, those that they follow, and beside them what the script says of those that they do not need.
    fn show_inputs(&mut self, script: &Script, inputs: &Inputs) {
        self.inputs = *inputs;
        script.set_inputs(&self.scene, &self.paths, self.state.time, &mut self.inputs);
        self.take_scripted_inputs();
    }

    /// Shows what was seen within the last step.
    fn see(&mut self, script: &Script, inputs: &Inputs, seen: StepBound) {
        self.state = seen.state;
        self.show_inputs(script, inputs);
        self.point = Point::of_contacts(conditions(&self.inputs, &self.state), seen.contacts);
    }

    /// Begins anew what is reported since the last row.
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
    fn go_back_to(&mut self, end: State, start: &mut State, time: f64) {
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
