//! Spectrum of the wrench of the bearing on the race that the load moves, over the second half of a run: by frequency, and by order over the
//! turns of the shaft, with the frequencies of cage and damage by the running cage speed, and those of the teeth of its machine.
//!
//! Rows see up to half of their own frequency. What is faster folds back below it: `load.output_interval` is to be short
//! enough for what rings, or its energy is small.

pub mod lines;
pub mod meshes;
pub mod picture;
pub mod welch;
mod words;

use std::io;
use std::path::Path;

use roulement::analysis::natural_frequency;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::{Outputs, RaceOutput};
use roulement::simulation::play::Rows;

use lines::Named;
use meshes::Mesh;
use welch::{Amplitudes, Welch};

/// [-] signals: force and moment.
pub const COUNT: usize = 6;
/// Names of the signals after that of the race, and their units.
pub const SIGNALS: [(&str, &str); COUNT] = [
    ("force.x", "N"),
    ("force.y", "N"),
    ("force.z", "N"),
    ("moment.x", "N.m"),
    ("moment.y", "N.m"),
    ("moment.z", "N.m"),
];
/// [-] difference of times of rows, over their interval, that is rounding.
const ROUNDING: f64 = 1e-6;
/// [-] speed of a race over that of the other one below which it stands.
const STANDS: f64 = 1e-6;

/// Does a scene ask for it?
pub fn is_wanted(scene: &Scene) -> bool {
    scene.effects.defects.reports_frequencies()
}

/// Takes the rows of a run.
pub struct Recorder {
    race: Race,
    interval: f64,
    /// Rows before the window, and rows seen.
    skipped: u64,
    seen: u64,
    welch: Welch<COUNT>,
    /// \[s] first and last time of the window.
    window: [f64; 2],
    speeds: Speeds,
    meshes: Vec<Mesh>,
    own: Vec<f64>,
}

/// Sums over rows.
#[derive(Clone, Copy, Debug)]
struct Speeds {
    rows: f64,
    /// \[Hz] FTF, BPFO, BPFI, BSF.
    frequencies: [f64; 4],
    /// \[Hz] turns of the inner and the outer race, their least and largest values.
    turns: [f64; 2],
    least: [f64; 2],
    most: [f64; 2],
}

/// The spectrum of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Whose wrench it is.
    pub race: Race,
    /// \[s] first and last time of the window.
    pub window: [f64; 2],
    /// \[s] from row to row.
    pub interval: f64,
    /// Amplitudes [N, N m].
    pub amplitudes: Amplitudes<COUNT>,
    /// \[Hz] mean turns of the shaft; 0 if none of the races turns.
    pub shaft: f64,
    /// \[Hz] by how much they change over the window.
    pub shaft_change: f64,
    /// Mean frequencies of cage and damage.
    pub marked: [Named<'static>; 4],
    /// Mean frequencies of the meshes of its machine.
    pub meshes: Vec<Mesh>,
    /// \[Hz] own frequencies of the race under the script's loads in the middle of the window, where it has some.
    pub own: Vec<f64>,
}

/// \[Hz] turns of a race about its own axis.
fn turns(race: &RaceOutput) -> f64 {
    (race.pose.orientation.inverse() * race.twist.angular_velocity).x / std::f64::consts::TAU
}

impl Recorder {
    /// For a simulation in a machine with these meshes, if its scene asks for it.
    pub fn of(simulation: &Simulation, meshes: Vec<Mesh>) -> Option<Self> {
        let scene = simulation.scene();
        let rows = Rows::of(simulation);
        let count = rows.count() + 1;
        let skipped = count / 2;
        is_wanted(scene).then(|| Self {
            race: Race::loaded(scene),
            interval: rows.interval,
            skipped,
            seen: 0,
            welch: Welch::new(count - skipped),
            window: [f64::NAN; 2],
            speeds: Speeds {
                rows: 0.0,
                frequencies: [0.0; 4],
                turns: [0.0; 2],
                least: [f64::INFINITY; 2],
                most: [f64::NEG_INFINITY; 2],
            },
            meshes,
            own: natural_frequency::of_race(
                simulation.model(),
                scene,
                simulation.time() + 0.5 * (skipped + count) as f64 * rows.interval,
            ),
        })
    }

    /// Takes a row, with what its meshes do ([`meshes::turns`]).
    pub fn push(&mut self, outputs: &Outputs, teeth: &[[f64; 3]]) {
        let row = self.seen;
        self.seen += 1;
        // The last row of a run whose duration is no multiple of the interval is out of step.
        let off = outputs.time - row as f64 * self.interval;
        if row < self.skipped || off.abs() > ROUNDING * self.interval {
            return;
        }
        if self.window[0].is_nan() {
            self.window[0] = outputs.time;
        }
        self.window[1] = outputs.time;
        let wrench = &outputs[self.race].wrench;
        self.welch.push([
            wrench.force.x,
            wrench.force.y,
            wrench.force.z,
            wrench.moment.x,
            wrench.moment.y,
            wrench.moment.z,
        ]);
        self.speeds.push(outputs);
        self.meshes.iter_mut().zip(teeth).for_each(|(mesh, now)| mesh.add(*now));
    }

    /// The spectrum; none of a run that ended before a few rows of its second half.
    pub fn finish(self) -> Option<Spectrum> {
        let Self { race, interval, window, welch, speeds, meshes, own, .. } = self;
        let amplitudes = welch.finish()?;
        let mean = |sum: f64| sum / speeds.rows;
        // The shaft is the race that the load moves, or the other one where that stands.
        let turns = speeds.turns.map(|sum| mean(sum).abs());
        let loaded = race as usize;
        let shaft = if turns[loaded] > STANDS * turns[1 - loaded] { loaded } else { 1 - loaded };
        let [ftf, bpfo, bpfi, bsf] = speeds.frequencies.map(mean);
        Some(Spectrum {
            race,
            window,
            interval,
            amplitudes,
            shaft: turns[shaft],
            shaft_change: speeds.most[shaft] - speeds.least[shaft],
            marked: [("FTF", ftf), ("BPFO", bpfo), ("BPFI", bpfi), ("BSF", bsf)],
            meshes: meshes.into_iter().map(|mesh| mesh.over(speeds.rows)).collect(),
            own,
        })
    }
}

impl Speeds {
    fn push(&mut self, outputs: &Outputs) {
        let now = &outputs.frequencies;
        self.rows += 1.0;
        let frequencies = [now.cage, now.outer, now.inner, now.ball];
        self.frequencies.iter_mut().zip(frequencies).for_each(|(sum, x)| *sum += x);
        for (i, x) in [turns(&outputs.inner), turns(&outputs.outer)].into_iter().enumerate() {
            self.turns[i] += x;
            self.least[i] = self.least[i].min(x);
            self.most[i] = self.most[i].max(x);
        }
    }
}

impl Spectrum {
    /// \[Hz] from one frequency to the next.
    pub fn spacing(&self) -> f64 {
        1.0 / (self.amplitudes.rows as f64 * self.interval)
    }

    /// \[Hz] fastest of the marked frequencies.
    fn fastest(&self) -> f64 {
        let meshes = self.meshes.iter().map(|mesh| mesh.frequency);
        self.marked.iter().map(|line| line.1).chain(meshes).fold(0.0, f64::max)
    }

    /// [-] order of a frequency \[Hz]; none where no race turns once while a line is taken.
    pub fn order(&self, frequency: f64) -> Option<f64> {
        (self.shaft >= self.spacing()).then(|| frequency / self.shaft)
    }

    /// Writes it as a table.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut table = csv::Writer::from_writer(vec![]);
        let race = self.race.name();
        let names = SIGNALS.map(|(name, unit)| format!("{race}.{name} amplitude (Hann) [{unit}]"));
        let head = ["frequency [Hz]".to_string(), "order [1]".to_string()];
        table.write_record(head.iter().chain(&names))?;
        for (k, amplitudes) in self.amplitudes.at.iter().enumerate() {
            let frequency = k as f64 * self.spacing();
            let order = self.order(frequency).map_or(String::new(), |order| order.to_string());
            let numbers = amplitudes.iter().map(f64::to_string);
            table.write_record([frequency.to_string(), order].into_iter().chain(numbers))?;
        }
        let table = table.into_inner().map_err(|why| io::Error::other(why.to_string()))?;
        std::fs::write(path, table)
    }
}
