//! Gatherer of a run step by step and row by row, whoever plays it: of every bearing, and of the shaft with its housings where there is one.

mod bearing;
mod circling;
mod phases;
mod shaft;

use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::Observer;
use roulement::simulation::system::System;

pub use bearing::{BearingSeen, BearingWatch, Life, headlines};
pub use circling::{Circling, Exciting};
pub use phases::{Extreme, Phase};
pub use shaft::{ShaftSeen, ShaftWatch};

use crate::error::Run;
use crate::report::figures::Figures;
use crate::report::means::Means;

/// Gathers while a machine runs.
pub struct Watch {
    bearings: Vec<BearingWatch>,
    shaft: Option<ShaftWatch>,
}

/// Gathered figures of a run.
pub struct Seen {
    /// Of every bearing.
    pub bearings: Vec<BearingSeen>,
    /// Of the shaft with its housings.
    pub shaft: Option<ShaftSeen>,
}

impl Watch {
    /// Of a machine that has not been played yet.
    pub fn of(machine: &Machine) -> Self {
        let phases = match machine {
            Machine::Bearing(bearing) => &bearing.scene().phase,
            Machine::Shaft(system) => &system.scene().phases,
        };
        Self {
            bearings: machine.bearings().map(|(_, bearing)| BearingWatch::of(bearing, phases)).collect(),
            shaft: machine.shaft().map(ShaftWatch::of),
        }
    }

    /// Takes a row.
    pub fn push(&mut self, machine: &Machine) {
        for ((_, bearing), watch) in machine.bearings().zip(&mut self.bearings) {
            watch.push(bearing);
        }
        if let (Some(watch), Some(system)) = (&mut self.shaft, machine.shaft()) {
            watch.push(system);
        }
    }

    /// All of it, at the end of a machine.
    pub fn finish(self, machine: &Machine) -> Seen {
        let bearings = self.bearings.into_iter().zip(machine.bearings());
        let changes = |from, to| machine.script_changes_within(from, to);
        let exciting = machine.shaft().map_or(Exciting::default(), |system| Exciting::of(system.scene()));
        let finish = |(watch, (_, bearing)): (BearingWatch, (&str, &Simulation))| {
            watch.finish(bearing, &changes, exciting)
        };
        let mut seen = Seen {
            bearings: bearings.map(finish).collect(),
            shaft: self.shaft.map(|watch| watch.finish(&changes)),
        };
        let means = seen
            .bearings
            .iter()
            .filter(|seen| seen.circling.is_some())
            .filter_map(|seen| seen.means.as_ref());
        if let Some(from) = means.map(|means| means.window[0]).reduce(f64::min) {
            seen.set_unstable(from);
        }
        seen
    }
}

impl Observer for Watch {
    fn bearing(&mut self, bearing: &Simulation) {
        self.bearings.iter_mut().for_each(|watch| watch.step(bearing));
    }

    fn shaft(&mut self, system: &System) {
        for ((_, bearing), watch) in system.bearings().zip(&mut self.bearings) {
            watch.step(bearing);
        }
        if let Some(watch) = &mut self.shaft {
            watch.step(system, self.bearings.iter().map(BearingWatch::lost));
        }
    }
}

impl Seen {
    /// Figures of the summary of every bearing, then of the shaft.
    pub fn figures(&self, machine: &Machine) -> Vec<Figures> {
        let bearings =
            machine.bearings().zip(&self.bearings).map(|((_, bearing), seen)| seen.figures(bearing));
        let shaft = self.shaft.as_ref().zip(machine.shaft()).map(|(seen, system)| seen.figures(system));
        bearings.chain(shaft).collect()
    }

    /// Warnings for whoever reads results of this run, a sentence each, with the name of the bearing before it.
    pub fn warnings(&self, machine: &Machine) -> Vec<String> {
        let named = |((name, bearing), seen): ((&str, &Simulation), &BearingSeen)| {
            let before = if name.is_empty() { String::new() } else { format!("bearing {name}: ") };
            seen.warnings(bearing).into_iter().map(move |warning| format!("{before}{warning}"))
        };
        let bearings = machine.bearings().zip(&self.bearings).flat_map(named);
        let shaft = self.shaft.as_ref().zip(machine.shaft());
        let growing = shaft.map(|(seen, _)| seen.growing.clone());
        let shaft = shaft.map(|(seen, system)| seen.warnings(system));
        growing.into_iter().flatten().chain(bearings).chain(shaft.into_iter().flatten()).collect()
    }

    /// Remarks on a run beside its summary, a sentence each: warnings, but for what summaries of bearings say themselves.
    pub fn remarks(&self, machine: &Machine) -> Vec<String> {
        let named = |((name, bearing), seen): ((&str, &Simulation), &BearingSeen)| {
            let before = if name.is_empty() { String::new() } else { format!("bearing {name}: ") };
            seen.remarks(bearing).into_iter().map(move |remark| format!("warning: {before}{remark}"))
        };
        let bearings = machine.bearings().zip(&self.bearings).flat_map(named);
        let shaft = self.shaft.as_ref().zip(machine.shaft()).map(|(seen, system)| seen.warnings(system));
        let shaft = shaft.into_iter().flatten().map(|warning| format!("warning: {warning}"));
        bearings.chain(shaft).collect()
    }

    /// Nothing has settled of what goes on after a time \[s], in any part of the machine.
    fn set_unstable(&mut self, from: f64) {
        let of_bearings = self.bearings.iter_mut().map(|seen| (&mut seen.means, &mut seen.phases));
        let of_shaft = self.shaft.iter_mut().map(|seen| (&mut seen.means, &mut seen.phases));
        for (means, phases) in of_bearings.chain(of_shaft) {
            let all = means.iter_mut().chain(phases.iter_mut().map(|phase| &mut phase.means));
            all.for_each(|means| means.unstable |= means.window[1] > from);
        }
    }

    /// Takes what grows about where the run starts, a sentence each: no means have settled then.
    pub fn set_growing(&mut self, growing: &[String]) {
        if !growing.is_empty() {
            self.set_unstable(f64::NEG_INFINITY);
        }
        match (&mut self.shaft, self.bearings.first_mut()) {
            (Some(shaft), _) => shaft.growing = growing.to_vec(),
            (None, Some(alone)) => alone.growing = growing.to_vec(),
            (None, None) => {}
        }
    }

    /// Puts means with their errors, of every bearing and then of the shaft, in the place of those that it has.
    pub fn set_means(&mut self, means: Vec<Option<Means>>) {
        let mut means = means.into_iter();
        // Whether a motion grows is known of this run.
        let put = |own: &mut Option<Means>, means: Option<Means>| {
            let unstable = own.as_ref().is_some_and(|own| own.unstable);
            *own = means.map(|means| Means { unstable: means.unstable || unstable, ..means });
        };
        self.bearings.iter_mut().zip(&mut means).for_each(|(seen, means)| put(&mut seen.means, means));
        self.shaft.iter_mut().zip(means).for_each(|(seen, means)| put(&mut seen.means, means));
    }

    /// Sample for comparison with other runs, with the CPU time \[s] of this one; its rows move there.
    pub fn take_comparable(&mut self, machine: &Machine, cpu: f64) -> Run {
        let bearings = machine.bearings().zip(&mut self.bearings);
        let mut parts: Vec<_> =
            bearings.map(|((name, bearing), seen)| seen.take_course(name, bearing)).collect();
        if let (Some(seen), Some(system)) = (&mut self.shaft, machine.shaft()) {
            parts.push(seen.take_course(system));
        }
        let solver = match machine {
            Machine::Bearing(bearing) => bearing.scene().solver,
            Machine::Shaft(system) => system.scene().solver(),
        };
        Run { solver, cpu, parts }
    }
}
