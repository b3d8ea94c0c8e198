//! Gatherer of the phases of a run: means, least and largest values, heat and life of each, from the steps in it. A step that
//! begins or ends outside counts with the part that is inside, along which values go straight.

use std::borrow::Cow;

use roulement::effects::rating::Sums;
use roulement::model::Model;
use roulement::scene::PhaseSection;

use super::life::Life;
use crate::report::means::{Blocks, Means};
use crate::report::quantities::Watched;

/// Name and unit of a quantity that has least and largest values and no mean.
pub type Peak = (Cow<'static, str>, &'static str);

/// Gathers one phase.
pub struct PhaseWatch {
    name: String,
    window: [f64; 2],
    blocks: Blocks,
    peaks: Vec<Peak>,
    /// Least and largest values of the quantities, then of the peaks.
    extremes: Vec<[f64; 2]>,
    last: Option<(f64, Vec<f64>)>,
    rated: Option<Rated>,
}

/// Revolutions and loads of a phase.
struct Rated {
    last: (f64, Sums),
    /// At its begin, and so far.
    begin: Sums,
    end: Sums,
    /// \[N] largest load of a ball in it.
    largest: f64,
}

/// A phase of a run.
#[derive(Clone, Debug)]
pub struct Phase {
    /// Its name.
    pub name: String,
    /// Means over what was run of it; settled or not is of these.
    pub means: Means,
    /// Least and largest values.
    pub extremes: Vec<Extreme>,
    /// Its rating life, of a bearing that has one.
    pub life: Option<Life>,
    /// \[J] heat of friction, of a bearing.
    pub heat: Option<f64>,
}

/// Least and largest value of a quantity in a phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// Its name.
    pub name: Cow<'static, str>,
    /// Its unit.
    pub unit: &'static str,
    /// \[unit] least value.
    pub least: f64,
    /// \[unit] largest value.
    pub largest: f64,
}

/// Where a run is.
pub struct Now<'a> {
    /// \[s] time.
    pub time: f64,
    /// Values of the quantities, and what they count for in means.
    pub values: &'a [f64],
    /// See `values`.
    pub weights: &'a [f64],
    /// Values of the peaks.
    pub peaks: &'a [f64],
    /// Revolutions and loads so far, of a bearing with a rating.
    pub rating: Option<&'a Sums>,
}

impl PhaseWatch {
    /// Gatherers of every phase, of quantities and peaks; forces have a moment at an arm \[m].
    pub fn of_all(phases: &[PhaseSection], quantities: &[Watched], peaks: &[Peak], arm: f64) -> Vec<Self> {
        let of = |phase: &PhaseSection| {
            let window = [phase.from.0, phase.to.0];
            Self {
                name: phase.name.clone(),
                window,
                blocks: Blocks::within(quantities.to_vec(), arm, window),
                peaks: peaks.to_vec(),
                extremes: vec![[f64::INFINITY, f64::NEG_INFINITY]; quantities.len() + peaks.len()],
                last: None,
                rated: None,
            }
        };
        phases.iter().map(of).collect()
    }

    /// Takes where a step has ended. A time that was there already adds nothing.
    pub fn step(&mut self, now: &Now<'_>) {
        let Now { time, values, weights, peaks, rating } = *now;
        if self.last.as_ref().is_some_and(|(last, _)| *last >= time) {
            return;
        }
        self.blocks.add(time, values, weights, [0.0; 3]);
        let mut all = values.to_vec();
        all.extend(peaks);
        self.spread(time, &all);
        if let Some(sums) = rating {
            self.rate(time, sums);
        }
        self.last = Some((time, all));
    }

    /// Is a time in it?
    fn has(&self, time: f64) -> bool {
        (self.window[0]..=self.window[1]).contains(&time)
    }

    /// Shares of the step to a time at which the phase begins or ends.
    fn ends_within(&self, last: f64, time: f64) -> impl Iterator<Item = f64> {
        let inside = self.window.into_iter().filter(move |end| (last..time).contains(end));
        inside.map(move |end| (end - last) / (time - last))
    }

    fn spread(&mut self, time: f64, values: &[f64]) {
        let mut at: Vec<Vec<f64>> = vec![];
        if let Some((last, before)) = &self.last {
            for share in self.ends_within(*last, time) {
                at.push(before.iter().zip(values).map(|(a, b)| a + share * (b - a)).collect());
            }
        }
        if self.has(time) {
            at.push(values.to_vec());
        }
        for values in at {
            for ([least, largest], value) in self.extremes.iter_mut().zip(values) {
                *least = least.min(value);
                *largest = largest.max(value);
            }
        }
    }

    fn rate(&mut self, time: f64, sums: &Sums) {
        let load = sums.load_now();
        let [from, to] = self.window;
        let Some(rated) = &mut self.rated else {
            self.rated = Some(Rated {
                last: (time, *sums),
                begin: *sums,
                end: *sums,
                largest: if (from..=to).contains(&time) { load } else { 0.0 },
            });
            return;
        };
        let (before, at_begin) = &rated.last;
        let within = |end: f64| at_begin.within_step(sums, (end - before) / (time - before));
        if time <= from {
            rated.begin = *sums;
        } else if (*before..time).contains(&from) {
            rated.begin = within(from);
        }
        if time <= to {
            rated.end = *sums;
        } else if (*before..time).contains(&to) {
            rated.end = within(to);
        }
        // A phase inside one step has the load that the step ends with.
        if *before < to && time >= from {
            rated.largest = rated.largest.max(load);
        }
        rated.last = (time, *sums);
    }

    /// The phase, at the end of a run; none where the run did not come to it. Does the script come to other values within a span \[s] of
    /// time?
    pub fn finish(self, model: Option<&Model>, changes: &dyn Fn(f64, f64) -> bool) -> Option<Phase> {
        let means = self.blocks.all()?;
        let means = Means { scripted: changes(means.window[0], means.window[1]), ..means };
        let names = self.blocks.quantities().iter().map(|watched| {
            let shown = watched.shown;
            (watched.name.clone(), watched.unit, shown)
        });
        let peaks = self.peaks.into_iter().map(|(name, unit)| (name, unit, true));
        let extremes = names.chain(peaks).zip(self.extremes).filter(|((_, _, shown), _)| *shown);
        let extremes =
            extremes.map(|((name, unit, _), [least, largest])| Extreme { name, unit, least, largest });
        let life = self.rated.zip(model).and_then(|(rated, model)| {
            Life::of(&rated.end.since(&rated.begin).with_largest(rated.largest), model)
        });
        let heat = means.find("friction power").map(|power| power.mean * (means.window[1] - means.window[0]));
        Some(Phase { name: self.name, extremes: extremes.collect(), life, heat, means })
    }
}

impl Phase {
    /// Least and largest value of a quantity by its name.
    pub fn extreme(&self, name: &str) -> Option<&Extreme> {
        self.extremes.iter().find(|extreme| extreme.name == name)
    }

    /// Extremes of quantities that have no mean.
    pub fn peaks(&self) -> impl Iterator<Item = &Extreme> {
        self.extremes.iter().filter(|extreme| self.means.find(&extreme.name).is_none())
    }

    /// Is it settled, in words?
    pub fn settled(&self) -> &'static str {
        match (self.means.scripted, self.means.settled()) {
            (true, _) => "NOT SETTLED: the script changes in it",
            _ if self.means.unstable => "NOT SETTLED: a motion grows, or is beyond what loads explain",
            (false, None) => "too few steps to tell whether it has settled",
            (false, Some(true)) => "settled",
            (false, Some(false)) => "NOT SETTLED: means drift in it",
        }
    }

    /// Name of a mean of it among figures.
    pub fn figure(&self, quantity: &str) -> String {
        format!("{}: {quantity}", self.name)
    }
}
