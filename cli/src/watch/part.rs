//! Figures of every part of a machine, a bearing or its shafts with their housings: means, phases, losses, and rows that errors are
//! told from.

use roulement::effects::rating::Sums;
use roulement::model::Model;
use roulement::scene::PhaseSection;

use super::phases::{Now, Peak, Phase, PhaseWatch};
use crate::error::{Course, Lengths, Sample, sizes};
use crate::report::figures::Figures;
use crate::report::losses::{Closed, LossWatch};
use crate::report::means::{Blocks, Means};
use crate::report::quantities::Watched;
use crate::report::thinned::Thinned;

/// Gathers of a part while a machine runs.
pub struct PartWatch {
    blocks: Blocks,
    samples: Thinned<Sample>,
    /// Its losses; of shafts those of the whole machine.
    pub losses: LossWatch,
    phases: Vec<PhaseWatch>,
}

/// Gathered figures of a part.
pub struct PartSeen {
    /// Means over the second half.
    pub means: Option<Means>,
    /// Phases of the run that it came to.
    pub phases: Vec<Phase>,
    /// Balance of its losses over the window of the means; of shafts that of the whole machine.
    pub closed: Option<Closed>,
    /// Motions that grow about where the run starts, a sentence each.
    pub growing: Vec<String>,
    /// Quantities that means are of.
    pub watched: Vec<Watched>,
    /// Rows for comparison with other runs.
    pub samples: Vec<Sample>,
}

impl PartWatch {
    /// Gatherer of blocks that have seen nothing, of phases, and of what has a least and a largest value there; forces have a moment at an arm \[m].
    pub fn new(blocks: Blocks, phases: &[PhaseSection], peaks: &[Peak], arm: f64) -> Self {
        Self {
            phases: PhaseWatch::of_all(phases, blocks.quantities(), peaks, arm),
            blocks,
            samples: Thinned::default(),
            losses: LossWatch::default(),
        }
    }

    /// Takes the start, or where a step has ended: a time \[s], values, what they count for, and the largest of a bearing since the last time;
    /// `peaks` and revolutions are looked at where there are phases.
    pub fn step(
        &mut self,
        (time, values, weights): (f64, &[f64], &[f64]),
        largest: [f64; 3],
        peaks: &dyn Fn() -> Vec<f64>,
        rating: Option<&Sums>,
    ) {
        self.blocks.add(time, values, weights, largest);
        if !self.phases.is_empty() {
            let now = Now { time, values, weights, peaks: &peaks(), rating };
            self.phases.iter_mut().for_each(|phase| phase.step(&now));
        }
    }

    /// Takes a row.
    pub fn push(&mut self, sample: Sample) {
        self.samples.push(sample);
    }

    /// All of it, at the end. Does a script come to other values within a span \[s] of time?
    pub fn finish(self, model: Option<&Model>, changes: &dyn Fn(f64, f64) -> bool) -> PartSeen {
        let scripted = |means: Means| Means { scripted: changes(means.window[0], means.window[1]), ..means };
        let means = self.blocks.means().map(scripted);
        PartSeen {
            closed: means.as_ref().and_then(|means| self.losses.over(means.window)),
            means,
            phases: self.phases.into_iter().filter_map(|phase| phase.finish(model, changes)).collect(),
            growing: vec![],
            watched: self.blocks.quantities().to_vec(),
            samples: self.samples.finish(),
        }
    }
}

impl PartSeen {
    /// Nothing has settled of what goes on after a time \[s].
    pub fn set_unstable(&mut self, from: f64) {
        let all = self.means.iter_mut().chain(self.phases.iter_mut().map(|phase| &mut phase.means));
        all.for_each(|means| means.unstable |= means.window[1] > from);
    }

    /// Sample for comparison with other runs under a name, with figures of the run; its rows move there. Torques below `torque` \[N m] are
    /// of no account.
    pub fn take_course(&mut self, name: &str, lengths: Lengths, torque: f64, figures: Figures) -> Course {
        let samples = std::mem::take(&mut self.samples);
        Course {
            name: name.to_string(),
            sizes: sizes(&samples, &self.watched, lengths, torque),
            quantities: self.watched.clone(),
            samples,
            means: self.means.clone(),
            figures,
        }
    }

    /// Puts means with their errors in the place of those that it has.
    pub fn set_means(&mut self, means: Option<Means>) {
        // Whether a motion grows is known of this run.
        let unstable = self.means.as_ref().is_some_and(|own| own.unstable);
        self.means = means.map(|means| Means { unstable: means.unstable || unstable, ..means });
    }
}
