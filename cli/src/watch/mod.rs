//! Gatherer of a run step by step and row by row, whoever plays it: of every bearing, and of the shaft with its housings where there is one.

mod bearing;
mod life;
mod part;
pub mod phases;
mod shaft;
mod turns;

use roulement::simulation::Simulation;
use roulement::simulation::alarms::Alarm;
use roulement::simulation::circling::Exciting;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::Observer;
use roulement::simulation::system::System;

pub use bearing::{BearingSeen, BearingWatch, headlines};
pub use life::Life;
pub use part::PartSeen;
pub use phases::{Extreme, Phase};
pub use shaft::{ShaftSeen, ShaftWatch};
pub use turns::PerTurn;

use crate::error::Run;
use crate::report::figures::Figures;
use crate::report::means::Means;
use crate::report::spectrum::meshes;

/// Gathers while a machine runs.
pub struct Watch {
    bearings: Vec<BearingWatch>,
    shaft: Option<ShaftWatch>,
    exciting: Exciting,
    /// Alarms since they were taken last, with the index of the bearing.
    alarms: Vec<(usize, Alarm)>,
}

/// Gathered figures of a run.
pub struct Seen {
    /// Figures of every bearing.
    pub bearings: Vec<BearingSeen>,
    /// Figures of the shaft with its housings.
    pub shaft: Option<ShaftSeen>,
}

/// Part of a machine at the end of a run, with its gathered figures.
#[derive(Clone, Copy)]
pub enum Part<'a> {
    /// A bearing, alone or on a shaft.
    Bearing(&'a Simulation, &'a BearingSeen),
    /// The shafts with their housings.
    Shaft(&'a System, &'a ShaftSeen),
}

impl<'a> Part<'a> {
    /// Figures that parts of all kinds have.
    pub fn gathered(self) -> &'a PartSeen {
        match self {
            Self::Bearing(_, seen) => &seen.part,
            Self::Shaft(_, seen) => &seen.part,
        }
    }

    /// Figures of its summary.
    pub fn figures(self) -> Figures {
        match self {
            Self::Bearing(bearing, seen) => seen.figures(bearing),
            Self::Shaft(system, seen) => seen.figures(system),
        }
    }

    /// Warnings for whoever reads its results, a sentence each.
    pub fn warnings(self) -> Vec<String> {
        match self {
            Self::Bearing(bearing, seen) => seen.warnings(bearing),
            Self::Shaft(system, seen) => seen.warnings(system),
        }
    }

    /// Warnings that its summary in words does not have, a sentence each; of shafts all.
    fn remarks(self) -> Vec<String> {
        match self {
            Self::Bearing(bearing, seen) => seen.remarks(bearing),
            Self::Shaft(..) => self.warnings(),
        }
    }

    /// Title of its scene.
    pub fn title(self) -> &'a str {
        match self {
            Self::Bearing(bearing, _) => &bearing.scene().title,
            Self::Shaft(system, _) => &system.scene().title,
        }
    }

    /// Text of its scene.
    pub fn source(self) -> &'a str {
        match self {
            Self::Bearing(bearing, _) => &bearing.scene().source,
            Self::Shaft(system, _) => &system.scene().source,
        }
    }

    /// \[s] time.
    pub fn time(self) -> f64 {
        match self {
            Self::Bearing(bearing, _) => bearing.time(),
            Self::Shaft(system, _) => system.time(),
        }
    }
}

impl Watch {
    /// Gatherer of a machine that has not been played yet.
    pub fn of(machine: &Machine) -> Self {
        let phases = match machine {
            Machine::Bearing(bearing) => &bearing.scene().phase,
            Machine::Shaft(system) => &system.scene().phases,
        };
        let meshes = machine.shaft().map_or(vec![], meshes::of);
        Self {
            bearings: machine.bearings().map(|(_, own)| BearingWatch::of(own, phases, &meshes)).collect(),
            shaft: machine.shaft().map(ShaftWatch::of),
            exciting: machine.shaft().map_or(Exciting::default(), |system| Exciting::of(system.scene())),
            alarms: vec![],
        }
    }

    /// Takes a row.
    pub fn push(&mut self, machine: &Machine) {
        let teeth = machine.shaft().map_or(vec![], meshes::turns);
        for ((_, bearing), watch) in machine.bearings().zip(&mut self.bearings) {
            watch.push(bearing, &teeth);
        }
        if let (Some(watch), Some(system)) = (&mut self.shaft, machine.shaft()) {
            watch.push(system);
        }
    }

    /// Alarms since this was asked for last, a sentence each.
    pub fn take_alarms(&mut self, machine: &Machine) -> Vec<String> {
        let text =
            |(index, alarm): (usize, Alarm)| machine.bearings().nth(index).map(|(name, _)| alarm.text(name));
        std::mem::take(&mut self.alarms).into_iter().filter_map(text).collect()
    }

    /// All of it, at the end of a machine.
    pub fn finish(self, machine: &Machine) -> Seen {
        let bearings = self.bearings.into_iter().zip(machine.bearings());
        let changes = |from, to| machine.script_changes_within(from, to);
        let exciting = self.exciting;
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
            .filter_map(|seen| seen.part.means.as_ref());
        if let Some(from) = means.map(|means| means.window[0]).reduce(f64::min) {
            seen.set_unstable(from);
        }
        seen
    }
}

impl Observer for Watch {
    fn step(&mut self, machine: &Machine) {
        let changes = |from, to| machine.script_changes_within(from, to);
        for (index, ((_, bearing), watch)) in machine.bearings().zip(&mut self.bearings).enumerate() {
            let alarms = watch.step(bearing, &changes, self.exciting);
            self.alarms.extend(alarms.into_iter().map(|alarm| (index, alarm)));
        }
        if let (Some(watch), Some(system)) = (&mut self.shaft, machine.shaft()) {
            watch.step(system, self.bearings.iter().map(BearingWatch::lost));
        }
    }
}

impl Seen {
    /// Every bearing with its name, then the shafts. The last part stands for the whole machine: its name is empty.
    pub fn parts<'a>(&'a self, machine: &'a Machine) -> impl Iterator<Item = (&'a str, Part<'a>)> {
        let bearings = machine.bearings().zip(&self.bearings);
        let bearings = bearings.map(|((name, bearing), seen)| (name, Part::Bearing(bearing, seen)));
        let shaft = machine.shaft().zip(self.shaft.as_ref());
        bearings.chain(shaft.map(|(system, seen)| ("", Part::Shaft(system, seen))))
    }

    /// Figures of the summary of every part.
    pub fn figures(&self, machine: &Machine) -> Vec<Figures> {
        self.parts(machine).map(|(_, part)| part.figures()).collect()
    }

    /// Warnings for whoever reads results of this run, a sentence each, with the name of the bearing before it.
    pub fn warnings(&self, machine: &Machine) -> Vec<String> {
        let growing = self.shaft.iter().flat_map(|seen| seen.part.growing.clone());
        growing.chain(self.of_all(machine, Part::warnings)).collect()
    }

    /// Warnings that summaries of bearings do not have, a sentence each.
    pub fn remarks(&self, machine: &Machine) -> Vec<String> {
        self.of_all(machine, Part::remarks).map(|remark| format!("warning: {remark}")).collect()
    }

    /// Sentences of all parts, with the name of the bearing before each.
    fn of_all<'a>(
        &'a self,
        machine: &'a Machine,
        of: fn(Part<'a>) -> Vec<String>,
    ) -> impl Iterator<Item = String> {
        self.parts(machine).flat_map(move |(name, part)| {
            let before = if name.is_empty() { String::new() } else { format!("bearing {name}: ") };
            of(part).into_iter().map(move |sentence| format!("{before}{sentence}"))
        })
    }

    /// Gathered figures of every bearing, then of the shafts.
    fn parts_mut(&mut self) -> impl Iterator<Item = &mut PartSeen> {
        let bearings = self.bearings.iter_mut().map(|seen| &mut seen.part);
        bearings.chain(self.shaft.iter_mut().map(|seen| &mut seen.part))
    }

    /// Nothing has settled of what goes on after a time \[s], in any part of the machine.
    fn set_unstable(&mut self, from: f64) {
        self.parts_mut().for_each(|part| part.set_unstable(from));
    }

    /// Takes what grows about where the run starts, a sentence each: no means have settled then. The shafts say it of a machine.
    pub fn set_growing(&mut self, growing: &[String]) {
        if !growing.is_empty() {
            self.set_unstable(f64::NEG_INFINITY);
        }
        if let Some(part) = self.parts_mut().last() {
            part.growing = growing.to_vec();
        }
    }

    /// Puts means with their errors, of every bearing and then of the shaft, in the place of those that it has.
    pub fn set_means(&mut self, means: Vec<Option<Means>>) {
        self.parts_mut().zip(means).for_each(|(part, means)| part.set_means(means));
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
