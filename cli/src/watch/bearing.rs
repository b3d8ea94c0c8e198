//! Gatherer of a bearing in a run: means, spectrum, energy, limits, and what its error is told from.

use std::f64::consts::TAU;

use roulement::effects::Row;
use roulement::effects::rating::Sums;
use roulement::effects::reports::LifeOutput;
use roulement::model::Model;
use roulement::model::bodies::Race;
use roulement::scene::PhaseSection;
use roulement::simulation::Simulation;
use roulement::simulation::instant::Instant;

use crate::error::{Course, Lengths, Sample, sizes};
use crate::report::energy::EnergyWatch;
use crate::report::figures::Figures;
use crate::report::limits::Limits;
use crate::report::losses::{Closed, LossWatch, Sums as LossSums};
use crate::report::means::{Blocks, Means};
use crate::report::quantities::{Parts, of_bearing, values, weights};
use crate::report::spectrum::{Recorder, Spectrum};
use crate::report::thinned::Thinned;

use super::circling::{Circling, CirclingWatch, Exciting};
use super::phases::{Now, Phase, PhaseWatch};

/// Gathers while a bearing runs.
pub struct BearingWatch {
    blocks: Blocks,
    spectrum: Option<Recorder>,
    energy: EnergyWatch,
    limits: Limits,
    losses: LossWatch,
    circling: CirclingWatch,
    /// Revolutions and loads from step to step, for the life over the window.
    rated: Thinned<(f64, Sums)>,
    samples: Thinned<Sample>,
    phases: Vec<PhaseWatch>,
}

/// Gathered figures of a bearing.
pub struct BearingSeen {
    /// Means over the second half.
    pub means: Option<Means>,
    /// Spectrum of its second half, where the scene asks for one.
    pub spectrum: Option<Spectrum>,
    /// Its energy.
    pub energy: EnergyWatch,
    /// Limits of the bearing that it met.
    pub limits: Limits,
    /// What closes its losses over the window of the means.
    pub closed: Option<Closed>,
    /// Life over the window of the means.
    pub life: Option<Life>,
    /// Phases of the run that it came to.
    pub phases: Vec<Phase>,
    /// A race that moves by more than its loads explain.
    pub circling: Option<Circling>,
    /// Motions that grow about where the run starts, a sentence each.
    pub growing: Vec<String>,
    /// Rows for comparison with other runs.
    samples: Vec<Sample>,
}

impl BearingWatch {
    /// Of a simulation that has not been played yet, and phases of its run.
    pub fn of(simulation: &Simulation, phases: &[PhaseSection]) -> Self {
        let quantities = of_bearing(Parts::of(simulation));
        let peaks = PEAKS.iter().filter(|peak| peak.is_of(simulation));
        let peaks: Vec<_> = peaks.map(|peak| (peak.name.into(), peak.unit)).collect();
        Self {
            phases: PhaseWatch::of_all(phases, &quantities, &peaks, lengths(simulation).pitch_radius),
            blocks: Blocks::of_bearing(simulation),
            spectrum: Recorder::of(simulation),
            energy: EnergyWatch::default(),
            limits: Limits::default(),
            losses: LossWatch::default(),
            circling: CirclingWatch::default(),
            rated: Thinned::default(),
            samples: Thinned::default(),
        }
    }

    /// Takes the start, or where a step has ended.
    pub fn step(&mut self, simulation: &Simulation) {
        let instant = simulation.instant();
        self.blocks.push(&instant);
        self.limits.step(&instant);
        self.losses.step(simulation, &instant);
        let rating = simulation.state().rating.as_ref();
        if let Some(sums) = rating {
            self.rated.push((instant.time, *sums));
        }
        if !self.phases.is_empty() {
            let peaks = PEAKS.iter().filter(|peak| peak.is_of(simulation));
            let peaks: Vec<f64> = peaks.map(|peak| (peak.get)(&instant)).collect();
            let (values, weights) = (values(&instant), weights(&instant));
            let now = Now { time: instant.time, values: &values, weights: &weights, peaks: &peaks, rating };
            self.phases.iter_mut().for_each(|phase| phase.step(&now));
        }
    }

    /// Takes a row.
    pub fn push(&mut self, simulation: &Simulation) {
        let outputs = simulation.outputs();
        if let Some(spectrum) = &mut self.spectrum {
            spectrum.push(outputs);
        }
        self.energy.push(outputs);
        self.circling.push(simulation);
        self.limits.push(outputs);
        self.samples.push(Sample::new(outputs));
    }

    /// Its losses so far.
    pub fn lost(&self) -> LossSums {
        self.losses.last()
    }

    /// All of it, at the end. Does a script, of the bearing or of the shaft that carries it, come to other values within a span \[s] of time?
    /// And what acts on that shaft?
    pub fn finish(
        self,
        simulation: &Simulation,
        changes: &dyn Fn(f64, f64) -> bool,
        exciting: Exciting,
    ) -> BearingSeen {
        let means = self
            .blocks
            .means()
            .map(|means| Means { scripted: changes(means.window[0], means.window[1]), ..means });
        let from = means.as_ref().map_or(0.0, |means| means.window[0]);
        let scripted = means.as_ref().is_some_and(|means| means.scripted);
        let circling = self.circling.finish(simulation, from, Exciting { scripted, ..exciting });
        let rated = self.rated.finish();
        BearingSeen {
            closed: means.as_ref().and_then(|means| self.losses.over(means.window)),
            life: means.as_ref().and_then(|means| Life::over(means.window, &rated, simulation.model())),
            means,
            spectrum: self.spectrum.and_then(Recorder::finish),
            energy: self.energy,
            limits: self.limits,
            circling,
            growing: vec![],
            samples: self.samples.finish(),
            phases: self
                .phases
                .into_iter()
                .filter_map(|phase| phase.finish(Some(simulation.model()), changes))
                .collect(),
        }
    }
}

impl BearingSeen {
    /// Figures of the summary of a run that ended so.
    pub fn figures(&self, simulation: &Simulation) -> Figures {
        let mut figures = Figures::of(simulation, self.means.as_ref(), &self.limits, &self.energy);
        self.phases.iter().for_each(|phase| figures.add_phase(phase));
        figures
    }

    /// Warnings for whoever reads results of this run, a sentence each: its summary and its notes say the same.
    pub fn warnings(&self, simulation: &Simulation) -> Vec<String> {
        let of_race = |race: Race| {
            let share = self.limits.over_shoulders[race as usize];
            (share > 0.0).then(|| {
                format!("up to {:.2} % of a load is beyond the {} shoulders", 100.0 * share, race.name())
            })
        };
        let shoulders = Race::BOTH.into_iter().filter_map(of_race);
        let growing = self.growing.iter().cloned();
        growing
            .chain(self.remarks(simulation))
            .chain(shoulders)
            .chain(self.energy.warning(simulation))
            .collect()
    }

    /// Warnings but for what its summary says and what is said before it runs: the pressure, a race that circles, and what its life leaves
    /// out.
    pub fn remarks(&self, simulation: &Simulation) -> Vec<String> {
        let pressure = simulation.scene().pressure_note(self.limits.peak_pressure);
        let life = self.life.and_then(|life| life.life.warning());
        let bare = |note: String| note.trim_start_matches("warning: ").to_string();
        let circling = self.circling.as_ref().map(Circling::warning);
        pressure.into_iter().chain(life).map(bare).chain(circling).collect()
    }

    /// Sample for comparison with other runs, under the name of the bearing; its rows move there.
    pub fn take_course(&mut self, name: &str, simulation: &Simulation) -> Course {
        let quantities = of_bearing(Parts::of(simulation));
        let samples = std::mem::take(&mut self.samples);
        Course {
            name: name.to_string(),
            sizes: sizes(&samples, &quantities, lengths(simulation), 0.0),
            quantities,
            samples,
            means: self.means.clone(),
            figures: self.figures(simulation),
        }
    }
}

/// The rating life under what a window of a run has seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Life {
    /// In million revolutions, with all that goes with it.
    pub life: LifeOutput,
    /// \[h] reference life at the mean speed of the window; none where nothing turns.
    pub hours: Option<f64>,
    /// \[h] modified life.
    pub modified_hours: Option<f64>,
}

impl Life {
    /// Names, units and values of its numbers, for the table of means.
    pub fn numbers(&self) -> Vec<(&'static str, &'static str, f64)> {
        let Self { life, hours, modified_hours } = self;
        let all = [
            ("life L10r", "1e6", Some(life.reference)),
            ("life L10r in hours", "h", *hours),
            ("modified life", "1e6", life.modified),
            ("modified life in hours", "h", *modified_hours),
            ("equivalent load", "N", Some(life.equivalent_load)),
            ("static safety", "1", Some(life.static_safety)),
        ];
        all.into_iter().filter_map(|(name, unit, value)| Some((name, unit, value?))).collect()
    }

    /// Under what was seen.
    pub fn of(sums: &Sums, model: &Model) -> Option<Self> {
        let life = model.rating.as_ref()?.after(sums);
        let speed = sums.speed().filter(|speed| *speed > 0.0);
        let hours = |million: f64| speed.map(|speed| million * 1e6 * TAU / speed / 3600.0);
        Some(Self { life, hours: hours(life.reference), modified_hours: life.modified.and_then(hours) })
    }

    /// Over a window \[s], from what was seen up to times \[s].
    fn over(window: [f64; 2], rated: &[(f64, Sums)], model: &Model) -> Option<Self> {
        let (_, end) = rated.last()?;
        let before = rated.iter().rev().find(|(time, _)| *time <= window[0]).unwrap_or(&rated[0]);
        Self::of(&end.since(&before.1), model)
    }
}

/// What has a least and a largest value in a phase, beside quantities with means.
struct Peak {
    name: &'static str,
    unit: &'static str,
    of_cage: bool,
    get: fn(&Instant) -> f64,
}

impl Peak {
    fn is_of(&self, simulation: &Simulation) -> bool {
        !self.of_cage || simulation.model().cage.is_some()
    }
}

const PEAKS: [Peak; 6] = [
    Peak { name: "peak pressure on the inner race", unit: "Pa", of_cage: false, get: |o| o.peak_pressure[0] },
    Peak { name: "peak pressure on the outer race", unit: "Pa", of_cage: false, get: |o| o.peak_pressure[1] },
    Peak { name: "load between balls", unit: "N", of_cage: false, get: |o| o.between_balls },
    Peak {
        name: "eccentricity of the cage",
        unit: "m",
        of_cage: true,
        get: |o| o.cage.map_or(0.0, |cage| cage.eccentricity),
    },
    Peak {
        name: "pocket load",
        unit: "N",
        of_cage: true,
        get: |o| o.cage.map_or(0.0, |cage| cage.pocket_load),
    },
    Peak { name: "land load", unit: "N", of_cage: true, get: |o| o.cage.map_or(0.0, |cage| cage.land_load) },
];

/// What every effect that is on promises for the summary, with its value at the end.
pub fn headlines(simulation: &Simulation) -> Vec<(Row, f64)> {
    let reports = simulation.outputs().reports();
    let rows = simulation.scene().effects.headlines();
    rows.into_iter().map(|row| (row.get.get(&reports), row)).map(|(value, row)| (row, value)).collect()
}

/// Lengths of a bearing.
pub fn lengths(simulation: &Simulation) -> Lengths {
    let bearing = &simulation.model().bearing;
    Lengths { pitch_radius: 0.5 * bearing.pitch_diameter, ball_diameter: 2.0 * bearing.ball.radius }
}
