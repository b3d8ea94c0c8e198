//! A run of a system by its scripts, step by step: as that of a bearing alone.

use super::super::Simulation;
use super::super::course::{Course, Moment};
use super::super::play::Scripted;
use super::advance::structure_steps;
use super::inputs::{Played, ShaftInputs};
use super::{System, SystemError};
use crate::dynamics::system::{Stepped, within};

impl Scripted for System {
    type Error = SystemError;

    fn time(&self) -> f64 {
        self.time
    }

    fn begin(&mut self, end: f64) -> Result<Course, SystemError> {
        let begin = self.time;
        if !(end > begin && end.is_finite()) {
            return Err(SystemError::Backwards { from: begin, to: end });
        }
        self.inputs = ShaftInputs::scripted(&self.scene, begin);
        self.take_scripted_inputs();
        let played = Played::all(&self.scene);
        let scripts = self.begin_scripts(end, &played);
        let mut stops = self.stops((&scripts, &played), end);
        stops.reverse();
        let inputs = self.bearings.iter().map(|bearing| bearing.inputs).collect();
        Ok(Course { scripts, played: Some(played), stops, inputs, start: None, end: None })
    }

    fn step(&mut self, course: &mut Course, row: f64) -> Result<(), SystemError> {
        if self.is_quasi_static() {
            return self.advance(row);
        }
        let Some(stop) = course.stop_after(self.time) else { return Ok(()) };
        self.bearings.iter_mut().zip(&course.inputs).for_each(|(bearing, own)| bearing.inputs = *own);
        course.start = (row < self.time + self.control.longest()).then(|| self.moment());
        if let Some(played) = &course.played {
            self.step_towards((&course.scripts, played), stop, &mut [], &mut vec![])?;
        }
        self.show(course);
        self.check_contacts()
    }

    fn look_back(&mut self, course: &mut Course, time: f64) {
        let (Some(start), Some(played)) = (course.start_before(time, self.time), &course.played) else {
            return;
        };
        let end = self.moment();
        self.time = start.time;
        self.states.clone_from(&start.structures);
        for ((bearing, state), inputs) in self.bearings.iter_mut().zip(&start.bearings).zip(&course.inputs) {
            bearing.state.clone_from(&state.state);
            bearing.inputs = *inputs;
        }
        let loads = self.loads(played, time);
        let boundaries = self.imposed(&course.scripts, &loads, time);
        let ends = start.bearings.iter().zip(&end.bearings);
        let mut stepped: Vec<_> = self
            .bearings
            .iter()
            .zip(ends)
            .zip(boundaries)
            .map(|((bearing, (start, end)), boundary)| Stepped {
                model: &bearing.model,
                ends: [start, end],
                boundary,
            })
            .collect();
        let structures = structure_steps(&self.carriers, &self.scales, &start.structures, &loads);
        let spans = (time - start.time, end.time - start.time);
        let (states, structures) = within(&mut stepped, &structures, &end.structures, &self.joints, spans);
        drop(stepped);
        (self.states, self.time) = (structures, time);
        let bearings = self.bearings.iter_mut().zip(states).zip(&course.scripts).zip(&course.inputs);
        for (((bearing, seen), script), inputs) in bearings {
            bearing.see(script, inputs, seen);
        }
        self.report();
        course.end = Some(end);
    }

    fn look_up(&mut self, course: &mut Course) {
        let time = self.time;
        let Some(Moment { time: end, bearings, structures }) = course.end.take() else {
            self.bearings.iter_mut().for_each(Simulation::begin_report);
            return;
        };
        let starts = course.start.iter_mut().flat_map(|start| &mut start.bearings);
        for ((bearing, end), start) in self.bearings.iter_mut().zip(bearings).zip(starts) {
            bearing.go_back_to(end.state, &mut start.state, time);
        }
        (self.states, self.time) = (structures, end);
        self.show(course);
    }

    fn end(&mut self, course: Course, accepted: bool) {
        if self.is_quasi_static() {
            return;
        }
        self.bearings.iter_mut().zip(&course.inputs).for_each(|(bearing, own)| bearing.inputs = *own);
        if let Some(played) = &course.played {
            self.finish(&course.scripts, played, accepted);
        }
        self.take_scripted_inputs();
        self.see_races();
    }
}

impl System {
    fn moment(&self) -> Moment {
        let bearings = self.bearings.iter().map(Simulation::bound).collect();
        Moment { time: self.time, bearings, structures: self.states.clone() }
    }

    /// Shows where the last step has ended.
    fn show(&mut self, course: &Course) {
        for ((bearing, script), inputs) in self.bearings.iter_mut().zip(&course.scripts).zip(&course.inputs) {
            bearing.show_end(script, inputs);
        }
        self.report();
    }
}
