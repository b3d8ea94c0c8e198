//! Gatherer of a bearing in a run: means, spectrum, energy, limits, and what its error is told from.

use roulement::effects::Row;
use roulement::effects::rating::Sums;
use roulement::scene::PhaseSection;
use roulement::simulation::Simulation;
use roulement::simulation::alarms::{Alarm, BearingAlarms};
use roulement::simulation::circling::{Circling, Exciting, Place};
use roulement::simulation::instant::Instant;

use crate::error::{Course, Lengths, Sample};
use crate::report::energy::EnergyWatch;
use crate::report::figures::Figures;
use crate::report::limits::Limits;
use crate::report::losses::Sums as LossSums;
use crate::report::means::{Blocks, largest};
use crate::report::quantities::{values, weights};
use crate::report::spectrum::meshes::Mesh;
use crate::report::spectrum::{Recorder, Spectrum};
use crate::report::thinned::Thinned;

use super::life::Life;
use super::part::{PartSeen, PartWatch};
use super::turns::{PerTurn, Turns};

/// Gathers while a bearing runs.
pub struct BearingWatch {
    part: PartWatch,
    spectrum: Option<Recorder>,
    energy: EnergyWatch,
    limits: Limits,
    /// Where its race was across its axis.
    places: Thinned<Place>,
    alarms: BearingAlarms,
    /// Alarms so far.
    told: Vec<Alarm>,
    /// Revolutions and loads from step to step, for the life over the window.
    rated: Thinned<(f64, Sums)>,
    /// Load times slip speed of balls that enter the load zone.
    entering: Turns,
}

/// Gathered figures of a bearing.
pub struct BearingSeen {
    /// Figures that every part of a machine has.
    pub part: PartSeen,
    /// Spectrum of its second half, where the scene asks for one.
    pub spectrum: Option<Spectrum>,
    /// Its energy.
    pub energy: EnergyWatch,
    /// Limits of the bearing that it met.
    pub limits: Limits,
    /// Life over the window of the means.
    pub life: Option<Life>,
    /// A race that moves by more than its loads explain.
    pub circling: Option<Circling>,
    /// \[W] largest load times slip speed of a ball that enters the load zone, in each turn of the balls over the window of the means.
    pub entering: Option<PerTurn>,
    /// Warnings while it ran.
    pub alarms: Vec<Alarm>,
}

impl BearingWatch {
    /// Gatherer of a simulation that has not been played yet, phases of its run, and the meshes of its machine.
    pub fn of(simulation: &Simulation, phases: &[PhaseSection], meshes: &[Mesh]) -> Self {
        let peaks = PEAKS.iter().filter(|peak| peak.is_of(simulation));
        let peaks: Vec<_> = peaks.map(|peak| (peak.name.into(), peak.unit)).collect();
        Self {
            part: PartWatch::new(
                Blocks::of_bearing(simulation),
                phases,
                &peaks,
                lengths(simulation).pitch_radius,
            ),
            spectrum: Recorder::of(simulation, meshes.to_vec()),
            energy: EnergyWatch::default(),
            limits: Limits::default(),
            places: Thinned::default(),
            alarms: BearingAlarms::default(),
            told: vec![],
            rated: Thinned::default(),
            entering: Turns::default(),
        }
    }

    /// Takes the start, or where a step has ended: what is to be warned of is given. See [`BearingAlarms::step`] for the others.
    pub fn step(
        &mut self,
        simulation: &Simulation,
        changes: &dyn Fn(f64, f64) -> bool,
        exciting: Exciting,
    ) -> Vec<Alarm> {
        let instant = simulation.instant();
        let rating = simulation.state().rating.as_ref();
        let peaks = || {
            let peaks = PEAKS.iter().filter(|peak| peak.is_of(simulation));
            peaks.map(|peak| (peak.get)(&instant)).collect()
        };
        let now = (instant.time, &values(&instant)[..], &weights(&instant)[..]);
        self.part.step(now, largest(&instant), &peaks, rating);
        self.part.losses.step(simulation, &instant);
        self.limits.step(&instant);
        self.entering.step(instant.time, instant.cage_speed, instant.entering_slip_load);
        if let Some(sums) = rating {
            self.rated.push((instant.time, *sums));
        }
        let pressed = self.alarms.press(simulation, instant.peak_pressure.into_iter().fold(0.0, f64::max));
        let moved = self.alarms.step(simulation, changes, exciting);
        let alarms: Vec<Alarm> = pressed.into_iter().chain(moved).collect();
        self.told.extend_from_slice(&alarms);
        alarms
    }

    /// Takes a row, with what the meshes of its machine do.
    pub fn push(&mut self, simulation: &Simulation, teeth: &[[f64; 3]]) {
        let outputs = simulation.outputs();
        if let Some(spectrum) = &mut self.spectrum {
            spectrum.push(outputs, teeth);
        }
        self.energy.push(outputs);
        if let Some(place) = Place::of(simulation) {
            self.places.push(place);
        }
        self.limits.push(outputs);
        self.part.push(Sample::new(outputs));
    }

    /// Its losses so far.
    pub fn lost(&self) -> LossSums {
        self.part.losses.last()
    }

    /// All of it, at the end. Does a script, of the bearing or of the shaft that carries it, come to other values within a span \[s] of time?
    /// And what acts on that shaft?
    pub fn finish(
        self,
        simulation: &Simulation,
        changes: &dyn Fn(f64, f64) -> bool,
        exciting: Exciting,
    ) -> BearingSeen {
        let part = self.part.finish(Some(simulation.model()), changes);
        let from = part.means.as_ref().map_or(0.0, |means| means.window[0]);
        let scripted = part.means.as_ref().is_some_and(|means| means.scripted);
        let places = self.places.finish().into_iter().filter(|place| place.time >= from).collect();
        let rated = self.rated.finish();
        BearingSeen {
            life: part.means.as_ref().and_then(|means| Life::over(means.window, &rated, simulation.model())),
            part,
            spectrum: self.spectrum.and_then(Recorder::finish),
            energy: self.energy,
            limits: self.limits,
            circling: Circling::of(places, simulation, Exciting { scripted, ..exciting }),
            entering: self.entering.since(from),
            alarms: self.told,
        }
    }
}

impl BearingSeen {
    /// Figures of the summary of a run that ended so.
    pub fn figures(&self, simulation: &Simulation) -> Figures {
        let mut figures = Figures::of(simulation, self.part.means.as_ref(), &self.limits, &self.energy);
        self.part.phases.iter().for_each(|phase| figures.add_phase(phase));
        figures
    }

    /// Warnings for whoever reads results of this run, a sentence each: its summary and its notes say the same.
    pub fn warnings(&self, simulation: &Simulation) -> Vec<String> {
        let growing = self.part.growing.iter().cloned();
        let alarms = self.alarms.iter().map(|alarm| alarm.text(""));
        growing
            .chain(alarms)
            .chain(self.remarks(simulation))
            .chain(self.limits.warnings())
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
        let figures = self.figures(simulation);
        self.part.take_course(name, lengths(simulation), 0.0, figures)
    }
}

/// Quantity that has a least and a largest value in a phase and no mean.
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

const PEAKS: [Peak; 7] = [
    Peak { name: "peak pressure on the inner race", unit: "Pa", of_cage: false, get: |o| o.peak_pressure[0] },
    Peak { name: "peak pressure on the outer race", unit: "Pa", of_cage: false, get: |o| o.peak_pressure[1] },
    Peak { name: "load between balls", unit: "N", of_cage: false, get: |o| o.between_balls },
    Peak {
        name: "slip load of balls that enter the load zone",
        unit: "W",
        of_cage: false,
        get: |o| o.entering_slip_load,
    },
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

/// Rows of all effects that are on for the summary, with their values at the end.
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
