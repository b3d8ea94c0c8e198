//! What is gathered of a bearing in a run: means, spectrum, energy, limits, and what its error is told from.

use roulement::model::bodies::Race;
use roulement::simulation::Simulation;

use crate::error::{Course, Estimate, Lengths, Sample, sizes};
use crate::report::energy::EnergyWatch;
use crate::report::figures::Figures;
use crate::report::limits::Limits;
use crate::report::means::{Blocks, Means};
use crate::report::quantities::{Parts, of_bearing};
use crate::report::spectrum::{Recorder, Spectrum};
use crate::report::thinned::Thinned;

/// Gathers while a bearing runs.
pub struct BearingWatch {
    blocks: Blocks,
    spectrum: Option<Recorder>,
    energy: EnergyWatch,
    limits: Limits,
    estimate: Estimate,
    samples: Thinned<Sample>,
}

/// What was gathered of a bearing.
pub struct BearingSeen {
    /// Means over the second half.
    pub means: Option<Means>,
    /// Spectrum of its second half, where the scene asks for one.
    pub spectrum: Option<Spectrum>,
    /// Its energy.
    pub energy: EnergyWatch,
    /// Limits of the bearing that it met.
    pub limits: Limits,
    /// Its error, as far as its local errors tell.
    pub estimate: Estimate,
    /// Rows for comparison with other runs.
    samples: Vec<Sample>,
}

impl BearingWatch {
    /// Of a simulation that has not been played yet.
    pub fn of(simulation: &Simulation) -> Self {
        Self {
            blocks: Blocks::of_bearing(simulation),
            spectrum: Recorder::of(simulation),
            energy: EnergyWatch::default(),
            limits: Limits::default(),
            estimate: Estimate::default(),
            samples: Thinned::default(),
        }
    }

    /// Takes a row.
    pub fn push(&mut self, simulation: &Simulation) {
        let outputs = simulation.outputs();
        self.blocks.push(outputs);
        if let Some(spectrum) = &mut self.spectrum {
            spectrum.push(outputs);
        }
        self.energy.push(outputs);
        self.limits.push(outputs);
        self.estimate.push(simulation);
        self.samples.push(Sample::new(outputs));
    }

    /// All of it, at the end.
    pub fn finish(self) -> BearingSeen {
        BearingSeen {
            means: self.blocks.means(),
            spectrum: self.spectrum.and_then(Recorder::finish),
            energy: self.energy,
            limits: self.limits,
            estimate: self.estimate,
            samples: self.samples.finish(),
        }
    }
}

impl BearingSeen {
    /// Figures of the summary of a run that ended so.
    pub fn figures(&self, simulation: &Simulation) -> Figures {
        Figures::of(simulation, self.means.as_ref(), &self.limits, &self.energy)
    }

    /// What whoever reads results of this run should know, a sentence each: its summary and its notes say the same.
    pub fn warnings(&self, simulation: &Simulation) -> Vec<String> {
        let of_race = |race: Race| {
            let share = self.limits.over_shoulders[race as usize];
            (share > 0.0).then(|| {
                format!("up to {:.2} % of a load is beyond the {} shoulders", 100.0 * share, race.name())
            })
        };
        let shoulders = Race::BOTH.into_iter().filter_map(of_race);
        self.told(simulation).into_iter().chain(shoulders).chain(self.energy.warning(simulation)).collect()
    }

    /// The same, but for what its summary says: the pressure, and what its life leaves out.
    pub fn told(&self, simulation: &Simulation) -> Vec<String> {
        let pressure = simulation.scene().pressure_note(self.limits.peak_pressure);
        let life = simulation.outputs().life.and_then(|life| life.warning());
        let bare = |note: String| note.trim_start_matches("warning: ").to_string();
        pressure.into_iter().chain(life).map(bare).collect()
    }

    /// What is kept for comparison with other runs, under the name of the bearing; its rows move there.
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

/// Lengths of a bearing.
pub fn lengths(simulation: &Simulation) -> Lengths {
    let bearing = &simulation.model().bearing;
    Lengths { pitch_radius: 0.5 * bearing.pitch_diameter, ball_diameter: 2.0 * bearing.ball.radius }
}
