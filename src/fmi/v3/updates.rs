//! Intermediate update: a communication step in the integrator's own steps, after each of which the importer may read outputs and set inputs.
//!
//! Each of them is a communication step of its own, from the inputs as they are set then; the pose and the twist of a race that are not set
//! go on as they were announced. What is discarded is the whole communication step.
#![allow(unsafe_code)]

use super::logger::Environment;
use super::slave::Slave;
use super::types::IntermediateUpdate;
use crate::fmi::outcome::{Outcome, Status, error};
use crate::fmi::saved_state::FmuState;
use crate::fmi::state::Phase;

/// The importer's callback.
#[derive(Clone, Copy)]
pub struct Updates {
    pub callback: IntermediateUpdate,
    pub environment: Environment,
    /// May the importer end steps early?
    pub early_return: bool,
}

/// A communication step that has begun.
pub struct Underway {
    /// Where it began.
    begun: Box<FmuState>,
    /// \[s] where it ends.
    end: f64,
    /// Did the importer bring the end forward?
    early: bool,
}

/// A question to the importer.
#[derive(Clone, Copy)]
pub struct Question {
    updates: Updates,
    time: f64,
    may_return: bool,
}

impl Question {
    /// Asks; the answer is the time \[s] at which the step should end, if it should end early.
    pub fn ask(self) -> Option<f64> {
        let Updates { callback, environment, .. } = self.updates;
        let (mut requested, mut time) = (false, self.time);
        // SAFETY: the importer guarantees its callback for the instance's lifetime; both places live through the call. The instance is not
        // in use: the importer may call it.
        unsafe {
            callback(environment.0, self.time, true, true, true, self.may_return, &mut requested, &mut time);
        }
        (requested && self.may_return).then_some(time)
    }
}

impl Slave {
    /// Begins a communication step, and takes the first step of the integrator.
    ///
    /// # Errors
    /// As of [`crate::fmi::Instance::do_whole_step`].
    pub fn begin_updated_step(&mut self, time: f64, step: f64) -> Outcome {
        self.instance.check_step(time, step)?;
        let begun = Box::new(self.instance.save());
        self.underway = Some(Underway { begun, end: time + step, early: false });
        self.one_step()
    }

    /// Goes on after the importer has answered.
    ///
    /// # Errors
    /// As of [`crate::fmi::Instance::do_whole_step`].
    pub fn continue_updated_step(&mut self, answer: Option<f64>) -> Outcome {
        let now = self.instance.time();
        self.instance.state.phase = Phase::StepComplete;
        let Some(underway) = &mut self.underway else { return error("no step is under way") };
        if let Some(time) = answer.filter(|time| *time < underway.end) {
            underway.end = time.max(now);
            underway.early = true;
        }
        if underway.end <= now {
            return Ok(());
        }
        self.one_step()
    }

    /// The question to the importer where a step of the integrator has ended.
    pub fn question(&self) -> Option<Question> {
        let asking = self.instance.state.phase == Phase::Intermediate;
        let (updates, underway) = (self.updates?, self.underway.as_ref().filter(|_| asking)?);
        let time = self.instance.time();
        Some(Question { updates, time, may_return: updates.early_return && time < underway.end })
    }

    /// Ends a communication step; true if that was early.
    pub fn end_updated_step(&mut self) -> bool {
        self.underway.take().is_some_and(|underway| underway.early)
    }

    fn one_step(&mut self) -> Outcome {
        let Some(underway) = &mut self.underway else { return error("no step is under way") };
        let done = self.instance.do_own_step(underway.end);
        match &done {
            Ok(()) => self.instance.state.phase = Phase::Intermediate,
            Err((status, _)) => {
                if *status == Status::Discard {
                    self.instance.restore(&underway.begun)?;
                }
                self.underway = None;
            }
        }
        done
    }
}
