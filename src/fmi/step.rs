//! Communication steps, and derivatives by time: of the inputs within a step, of the outputs over it.

use super::instance::Instance;
use super::outcome::{Outcome, Status, error};
use crate::interface::variables::{Causality, Kind};
use crate::simulation::driven::MachineSnapshot;

/// [-] relative disagreement of importer and instance about the time that is still rounding.
const TIME_TOLERANCE: f64 = 1e-9;

/// What was before a step.
pub(super) struct Begun {
    before: Option<MachineSnapshot>,
    last_step: f64,
    played: Vec<bool>,
    tuned_outputs: Option<Vec<f64>>,
}

impl Instance {
    /// Advances by a communication step.
    ///
    /// # Errors
    /// An error for a time that is not the instance's, a step that is not positive or one beyond the defined stop time
    /// (FMI 2.0.4, section 2.1.6); discarded if the step cannot be
    /// finished: the state is then that of the last time reached.
    pub fn do_step(&mut self, time: f64, step: f64) -> Outcome {
        let now = self.unit.time();
        self.check_step(time, step)?;
        self.take_inputs()?;
        let advanced = self.unit.advance(time + step, &self.state.played);
        self.end_step(now, advanced)
    }

    /// The same, but what could not be finished is not begun: where a step is discarded, the instance is where it was before.
    ///
    /// # Errors
    /// As of [`Instance::do_step`].
    pub fn do_whole_step(&mut self, time: f64, step: f64) -> Outcome {
        let begun = self.remember();
        let done = self.do_step(time, step);
        self.keep_or_undo(begun, done)
    }

    /// What a step changes that may be discarded.
    pub(super) fn remember(&mut self) -> Begun {
        let before = self.state.before.take();
        self.state.before = self.spare.take();
        Begun {
            before,
            last_step: self.state.last_step,
            played: self.state.played.clone(),
            tuned_outputs: self.state.tuned_outputs.clone(),
        }
    }

    /// Goes back to where a step began if it was discarded or refused.
    pub(super) fn keep_or_undo(&mut self, begun: Begun, done: Outcome) -> Outcome {
        match &done {
            Ok(()) => {
                self.spare = begun.before;
                return done;
            }
            Err((Status::Discard, _)) => {
                let start = self.state.before.take();
                let restored = start.as_ref().is_some_and(|start| self.unit.restore(start));
                debug_assert!(restored, "a snapshot of this very unit fits it");
                let scripted = self.unit.inputs().iter().filter(|index| {
                    self.unit.script_of(**index).is_some_and(|script| self.state.played[script])
                });
                for &index in scripted {
                    self.state.values[index] = self.unit.value(index);
                }
                self.spare = start;
                (self.state.last_step, self.state.played) = (begun.last_step, begun.played);
                self.state.tuned_outputs = begun.tuned_outputs;
            }
            // Refused before anything moved.
            Err(_) => self.spare = self.state.before.take(),
        }
        self.state.before = begun.before;
        done
    }

    /// Checks a communication step.
    ///
    /// # Errors
    /// As of [`Instance::do_step`].
    pub fn check_step(&self, time: f64, step: f64) -> Outcome {
        let now = self.unit.time();
        if !(step > 0.0 && step.is_finite()) {
            return error(format!("the communication step {step} s is not positive"));
        }
        let scale = now.abs().max(time.abs()).max(step);
        if time.is_nan() || (time - now).abs() > TIME_TOLERANCE * scale {
            return error(format!("the communication point {time} s is not the instance's time {now} s"));
        }
        if time + step <= now {
            return error(format!("the communication step {step} s is lost in rounding at {now} s"));
        }
        if let Some(stop) =
            self.stop.filter(|stop| time + step > stop + TIME_TOLERANCE * scale.max(stop.abs()))
        {
            let end = time + step;
            return error(format!("the communication step to {end} s is beyond the stop time {stop} s"));
        }
        Ok(())
    }

    /// Takes one step of the integrator on the way to a time \[s], as a communication step of its own. Pose and twist of races that are given
    /// are then where they have come to: they go on like this until they are set again.
    ///
    /// # Errors
    /// As of [`Instance::do_step`].
    pub fn do_own_step(&mut self, end: f64) -> Outcome {
        let now = self.unit.time();
        self.take_inputs()?;
        let advanced = self.unit.advance(self.unit.next_point(end), &self.state.played);
        self.end_step(now, advanced)?;
        self.unit.follow(&mut self.state.values);
        Ok(())
    }

    /// Takes inputs and parameters for the step that begins.
    fn take_inputs(&mut self) -> Outcome {
        self.prepare()?;
        // Whatever happens from here on, these are no longer the present values.
        self.present = None;
        self.previous = None;
        self.forget_columns();
        // A point that a step has led to is found again from its snapshot, but for parameters that have changed.
        self.state.tuned_outputs = None;
        if self.state.changed {
            for begun in self.unit.tune(&self.state.values)? {
                self.log.write(Status::Ok, &begun);
            }
            self.state.tuned_outputs = Some(self.unit.values());
            self.state.applied.clone_from(&self.state.values);
            self.state.changed = false;
        }
        self.state.played = self.played();
        match &mut self.state.before {
            Some(before) => self.unit.snapshot_into(before),
            none => *none = Some(self.unit.snapshot()),
        }
        Ok(())
    }

    /// Looks at what a step since `now` \[s] has led to, and takes over the inputs that scripts gave.
    pub(super) fn end_step(&mut self, now: f64, advanced: Outcome) -> Outcome {
        if !self.keeps_rates {
            // A derivative belongs to the communication point that it was set for.
            self.unit.inputs().iter().for_each(|index| self.state.rates[*index] = 0.0);
        }
        let reached = self.unit.time();
        self.state.last_step = reached - now;
        if !self.unit.is_finite() {
            let restored = self.state.before.as_ref().is_some_and(|before| self.unit.restore(before));
            debug_assert!(restored, "a snapshot of this very unit fits it");
            self.state.last_step = 0.0;
            return Err((Status::Discard, format!("a result is not a number after {now} s")));
        }
        let some_played = self.state.played.contains(&true);
        for &index in self.unit.inputs().iter().filter(|_| some_played) {
            if self.unit.script_of(index).is_some_and(|script| self.state.played[script]) {
                self.state.values[index] = self.unit.value(index);
            }
        }
        for alarm in self.unit.alarms(&mut self.alarms) {
            self.log.write(Status::Warning, &alarm);
        }
        advanced
    }

    /// \[s] time of the last state that was reached.
    pub fn time(&self) -> f64 {
        self.unit.time()
    }

    /// First derivatives of inputs by time.
    ///
    /// # Errors
    /// If an order is not 1, a reference not that of an input, or a value not finite; nothing is then set.
    pub fn set_input_derivatives(&mut self, references: &[u32], orders: &[i32], values: &[f64]) -> Outcome {
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let row = &self.unit.rows()[self.row(*reference, Kind::Real)?];
            if row.causality != Causality::Input {
                return error(format!("{} is no input: it takes no input derivative", row.name));
            }
            if *order != 1 {
                return error(format!("input derivatives of order {order} are not offered, only of order 1"));
            }
            if !value.is_finite() {
                return error(format!("the derivative of {} = {value} is not a finite number", row.name));
            }
        }
        for (reference, value) in references.iter().zip(values) {
            self.state.rates[*reference as usize] = *value;
            self.take_over(*reference as usize);
        }
        Ok(())
    }

    /// First derivatives of outputs by time: their change over the last communication step.
    ///
    /// # Errors
    /// If an order is not 1 or a reference not that of an output.
    pub fn output_derivatives(&mut self, references: &[u32], orders: &[i32], values: &mut [f64]) -> Outcome {
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let index = self.row(*reference, Kind::Real)?;
            let row = &self.unit.rows()[index];
            if row.causality != Causality::Output {
                return error(format!("{} is no output: it has no output derivative", row.name));
            }
            if *order != 1 {
                return error(format!(
                    "output derivatives of order {order} are not offered, only of order 1"
                ));
            }
            *value = 0.0;
            if self.state.last_step > 0.0 {
                let change = self.unit.value(index) - self.previous_outputs()?[index];
                *value = change / self.state.last_step;
            }
        }
        Ok(())
    }

    /// Values of all rows at the communication point before the last, computed when first asked for.
    fn previous_outputs(&mut self) -> Outcome<&[f64]> {
        let values = match (self.previous.take(), &self.state.tuned_outputs, &self.state.before) {
            (Some(values), _, _) => values,
            (None, Some(values), _) => values.clone(),
            (None, None, Some(before)) => {
                let mut unit = self.unit.clone();
                if !unit.restore(before) {
                    return error("the start of the last step is of another scene");
                }
                unit.values()
            }
            (None, None, None) => self.unit.values(),
        };
        Ok(self.previous.insert(values))
    }
}
