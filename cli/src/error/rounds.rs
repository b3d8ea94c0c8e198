//! Rounds of refinement: what their errors are, and when to stop.

use std::fmt::Write;

use roulement::scene::{ErrorGoal, ErrorOf};

use super::difference::Difference;
use super::sample::{Course, Run};
use crate::cost::levers::seconds;
use crate::report::figures::Figures;
use crate::report::means::{Means, MeasuredError};

/// [-] what the steps of a twin are changed by: nothing that matters to a run whose histories are a matter of its steps.
pub const TWIN: f64 = 1e-9;
/// [-] a run is chaotic in a quantity if its twin is as far away as this part of what half the steps make.
const CHAOTIC: f64 = 0.3;
/// [-] a difference that halved steps leave above this part of it does not fall: at order 2 a quarter is left.
const FALLS: f64 = 0.5;
/// [-] error of histories above which a run without a goal is looked at for chaos.
const LARGE: f64 = 1e-2;
/// [-] the least part of an earlier round's difference that is taken for an error, whatever the last round says: that of
/// order 2. Two runs may agree in a mean by chance.
const ORDER_TWO: f64 = 0.25;
/// [-] error of the finer run over the difference of two, where there is no other difference to tell how they fall: that of differences
/// of which two thirds stay. Steps that are too long for a vibration do not fall by their order yet: with 1 instead of 2, one history in
/// twelve of random scenes was outside its bar (`error_bars`).
const ALONE: f64 = 2.0;
/// [-] the same at most, where differences hardly fall: then smaller steps, or chaos, have to tell.
const MOST: f64 = 3.0;

/// Next thing to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// Run with half the steps.
    Refine,
    /// Run the coarser one of the last two again with steps changed by [`TWIN`].
    Twin,
    /// The goal is met, or there was none.
    Done,
    /// Chaos, whose means are not known well enough: a longer run is needed.
    TooShort,
    /// As many runs as are allowed, and the goal is not met.
    TooMany,
}

/// A run's settings and price, and the largest errors that were found with it.
struct Round {
    text: String,
    cpu: f64,
    /// Largest error of means and of histories.
    errors: Option<[f64; 2]>,
}

/// Runs so far.
pub struct Rounds {
    goal: Option<ErrorGoal>,
    most: u32,
    rounds: Vec<Round>,
    /// The last two runs, the finer one last.
    runs: Vec<Run>,
    differences: Vec<Difference>,
    /// Quantities that are chaotic, and by what the difference of the twin has grown.
    chaotic: Vec<Option<f64>>,
    /// Number of differences when a twin was run last.
    twin: usize,
    /// Runs with smaller and smaller steps.
    refinements: u32,
}

/// An error and where it is.
struct Largest {
    error: f64,
    of: String,
}

impl Rounds {
    /// None yet; at most so many refinements, at least one.
    pub fn new(goal: Option<ErrorGoal>, most: u32) -> Self {
        Self {
            goal,
            most: most.max(2),
            rounds: vec![],
            runs: vec![],
            differences: vec![],
            chaotic: vec![],
            twin: 0,
            refinements: 0,
        }
    }

    /// Takes a run with half the steps of the last one.
    pub fn push(&mut self, run: Run) {
        self.refinements += 1;
        let solver = run.solver;
        let method: &str = solver.method.into();
        let text =
            format!("{method}, max_step {}, tolerance {:.1e}", seconds(solver.max_step.0), solver.tolerance);
        if let Some(last) = self.runs.last() {
            self.differences.push(Difference::of(last, &run));
        }
        self.chaotic.resize(run.quantities().count(), None);
        let cpu = run.cpu;
        self.runs.push(run);
        if self.runs.len() > 2 {
            self.runs.remove(0);
        }
        let errors = (!self.differences.is_empty()).then(|| self.largest().map(|largest| largest.error));
        self.rounds.push(Round { text, cpu, errors });
    }

    /// Takes the twin of the coarser one of the last two runs.
    pub fn push_twin(&mut self, twin: &Run) {
        self.twin = self.differences.len();
        self.rounds.push(Round {
            text: format!("as the round with twice the last steps, these changed by {TWIN:.0e}"),
            cpu: twin.cpu,
            errors: None,
        });
        let (Some(coarse), Some(last)) = (self.runs.first(), self.differences.last()) else {
            return;
        };
        let apart = Difference::of(twin, coarse);
        for i in 0..self.chaotic.len() {
            // Differences that would be no error need no name.
            let matters = self.history_to_come(i) > self.goal.map_or(LARGE, |goal| goal.error);
            if matters && apart.histories[i] > CHAOTIC * last.histories[i] {
                self.chaotic[i] = Some(apart.histories[i] / TWIN);
            }
        }
    }

    /// [-] error of the finest run by the differences that each run had to the next, `of` one of which is given. Where a share r of a
    /// difference is left each time the steps are halved, all that are to come are r/(1 - r) of the last one. It is taken for no less
    /// than the last one itself, which at order 2 is three times as much, and than [`ORDER_TWO`] of the one before.
    fn to_come(&self, of: impl Fn(&Difference) -> f64) -> f64 {
        match self.differences.as_slice() {
            [] => 0.0,
            [alone] => ALONE * of(alone),
            [.., before, last] => {
                let [before, last] = [before, last].map(of);
                // Of what does not fall, and of nothing before it, nothing can be told by a ratio.
                let factor = if last < before { (last / (before - last)).clamp(1.0, MOST) } else { MOST };
                (factor * last).max(ORDER_TWO * before)
            }
        }
    }

    /// [-] error of the mean of a quantity over its size, no less than what chance may hide. Where it is chaotic, with the interval
    /// of the mean.
    fn mean_error(&self, i: usize) -> f64 {
        let Some(last) = self.differences.last() else {
            return 0.0;
        };
        match self.chaotic[i] {
            None => self.to_come(|difference| difference.means[i]).max(last.scatter[i]),
            Some(_) => last.means[i].hypot(self.interval(i)),
        }
    }

    /// [-] interval of the mean of a quantity of the finest run over its size; infinite where there are too few rows to tell.
    fn interval(&self, i: usize) -> f64 {
        let Some((part, i)) = self.runs.last().and_then(|run| run.quantities().nth(i)) else {
            return f64::INFINITY;
        };
        let mean = part.means.as_ref().and_then(|means| means.find(&part.quantities[i].name));
        let interval = mean.and_then(|mean| mean.interval);
        interval.map_or(f64::INFINITY, |interval| interval / part.sizes[i])
    }

    /// [-] error of the histories of a quantity over its size; none where it is chaotic.
    fn history_error(&self, i: usize) -> Option<f64> {
        let known = !self.differences.is_empty() && self.chaotic[i].is_none();
        known.then(|| self.history_to_come(i))
    }

    /// [-] the same, chaotic or not.
    fn history_to_come(&self, i: usize) -> f64 {
        self.to_come(|difference| difference.histories[i])
    }

    /// Name of a quantity.
    fn name(&self, i: usize) -> String {
        let quantity = self.runs.last().and_then(|run| run.quantities().nth(i));
        quantity.map_or_else(String::new, |(part, i)| part.name_of(i))
    }

    /// Largest errors of means and of histories.
    fn largest(&self) -> [Largest; 2] {
        let over = |error: &dyn Fn(usize) -> f64| {
            // The first of equal ones; what is not a number is larger than any.
            let (error, of) = (0..self.chaotic.len()).fold((0.0, None), |(most, of), i| {
                let error = error(i);
                if error > most || error.is_nan() { (error, Some(i)) } else { (most, of) }
            });
            Largest { error, of: of.map_or("none".into(), |i| self.name(i)) }
        };
        [over(&|i| self.mean_error(i)), over(&|i| self.history_error(i).unwrap_or(0.0))]
    }

    /// Does the finest run keep an error?
    fn keeps(&self, goal: ErrorGoal) -> bool {
        let [means, histories] = self.largest();
        means.error <= goal.error && (goal.of == ErrorOf::Means || histories.error <= goal.error)
    }

    /// Is there a quantity whose histories do not come closer, and of which it is not known why?
    fn stalls(&self) -> bool {
        let (Some((last, before)), true) =
            (self.differences.split_last(), self.twin < self.differences.len())
        else {
            return false;
        };
        let least = self.goal.map_or(LARGE, |goal| goal.error);
        (0..self.chaotic.len()).any(|i| {
            let large = self.chaotic[i].is_none() && self.history_to_come(i) > least;
            let stays = match (before.last(), self.goal) {
                (Some(before), _) => last.histories[i] > FALLS * before.histories[i],
                // There is no other round to tell from.
                (None, goal) => goal.is_none(),
            };
            large && stays
        })
    }

    /// Next thing to do.
    pub fn judge(&self) -> Judgement {
        if self.differences.is_empty() {
            return Judgement::Refine;
        }
        let Some(goal) = self.goal else {
            return if self.stalls() { Judgement::Twin } else { Judgement::Done };
        };
        if self.keeps(goal) {
            return Judgement::Done;
        }
        if self.stalls() {
            return Judgement::Twin;
        }
        // Smaller steps do not make the interval of a chaotic mean smaller.
        let regular = |i: usize| {
            let histories =
                if goal.of == ErrorOf::Means { 0.0 } else { self.history_error(i).unwrap_or(0.0) };
            self.chaotic[i].is_none() && self.mean_error(i).max(histories) > goal.error
        };
        if !(0..self.chaotic.len()).any(regular) {
            return Judgement::TooShort;
        }
        if self.refinements >= self.most { Judgement::TooMany } else { Judgement::Refine }
    }

    /// Number of runs with smaller and smaller steps.
    pub fn refinements(&self) -> u32 {
        self.refinements
    }

    /// Number of rounds, those that look for chaos included.
    pub fn count(&self) -> usize {
        self.rounds.len()
    }

    /// Error bars of all figures of each part of the finest run; none with one run alone.
    pub fn bars(&self) -> Option<Vec<Figures>> {
        let [coarse, fine] = &self.runs[..] else { return None };
        let of_part = |((coarse, fine), first): ((&Course, &Course), usize)| {
            let alone = if self.differences.len() == 1 { ALONE } else { 1.0 };
            let mut bars = fine.figures.distance(&coarse.figures).times(alone);
            for (i, quantity) in fine.quantities.iter().enumerate() {
                bars.set(quantity.name.clone(), self.mean_error(first + i) * fine.sizes[i]);
            }
            bars
        };
        Some(coarse.parts.iter().zip(&fine.parts).zip(fine.firsts()).map(of_part).collect())
    }

    /// Means of each part of the finest run with their errors.
    pub fn means(&self) -> Vec<Option<Means>> {
        let Some(run) = self.runs.last() else { return vec![] };
        let of_part = |(part, first): (&Course, usize)| {
            let mut means = part.means.clone()?;
            for mean in means.means.iter_mut().filter(|_| !self.differences.is_empty()) {
                let Some(i) = part.quantities.iter().position(|quantity| quantity.name == mean.name) else {
                    continue;
                };
                let history = self.history_error(first + i).map(|error| error * part.sizes[i]);
                mean.error =
                    Some(MeasuredError { mean: self.mean_error(first + i) * part.sizes[i], history });
            }
            Some(means)
        };
        run.parts.iter().zip(run.firsts()).map(of_part).collect()
    }

    /// \[s] CPU time of all runs.
    pub fn cpu(&self) -> f64 {
        self.rounds.iter().map(|round| round.cpu).sum()
    }

    /// Findings for the summary.
    pub fn report(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_report(&mut text);
        text
    }

    fn write_report(&self, out: &mut String) -> std::fmt::Result {
        if self.differences.is_empty() {
            return writeln!(out, "error            not measured: there is one run alone");
        }
        let [means, histories] = self.largest();
        writeln!(
            out,
            "error            means {:.1e} ({}), histories {:.1e} ({}): largest of all quantities, over their size",
            means.error, means.of, histories.error, histories.of
        )?;
        self.write_chaos(out)?;
        if let Some(goal) = self.goal {
            let of = match (goal.of, self.chaotic.iter().any(Option::is_some)) {
                (ErrorOf::Means, _) => "means",
                (ErrorOf::All, true) => "means, and histories that are not chaotic",
                (ErrorOf::All, false) => "means and histories",
            };
            if self.keeps(goal) {
                writeln!(out, "error goal       {:e} of {of}: met", goal.error)?;
            } else {
                writeln!(out, "error goal       {:e} of {of}: NOT MET", goal.error)?;
                self.write_why(out, goal)?;
            }
        }
        for (number, round) in self.rounds.iter().enumerate() {
            let errors = round.errors.map_or(String::new(), |[means, histories]| {
                format!("; means {means:.1e}, histories {histories:.1e}")
            });
            writeln!(out, "round {:<2}         {}: {:.2} s CPU{errors}", number + 1, round.text, round.cpu)?;
        }
        writeln!(out, "all rounds       {:.2} s CPU", self.cpu())
    }

    /// Says what is chaotic, and how that was seen.
    fn write_chaos(&self, out: &mut String) -> std::fmt::Result {
        let names: Vec<String> =
            (0..self.chaotic.len()).filter(|&i| self.chaotic[i].is_some()).map(|i| self.name(i)).collect();
        let growth = self.chaotic.iter().flatten().copied().fold(0.0, f64::max);
        if names.is_empty() {
            return Ok(());
        }
        writeln!(
            out,
            "CHAOTIC          {}: steps changed by {TWIN:.0e} move them as far as half the steps, {growth:.0e} times the \
             change. Their histories have no error to promise; the error of their means is that of 95 % of runs alike",
            names.join(", ")
        )
    }

    /// Why a goal is not met, and what would meet it.
    fn write_why(&self, out: &mut String, goal: ErrorGoal) -> std::fmt::Result {
        let over = |i: &usize| self.chaotic[*i].is_some() && self.mean_error(*i) > goal.error;
        let duration = self.runs.last().map_or(0.0, Run::end);
        let widest =
            (0..self.chaotic.len()).filter(over).map(|i| self.mean_error(i) / goal.error).fold(0.0, f64::max);
        if widest.is_infinite() {
            writeln!(
                out,
                "                 too few rows to tell the interval of chaotic means: lower load.output_interval"
            )?;
        } else if widest > 0.0 {
            // Intervals fall with the root of the time.
            writeln!(
                out,
                "                 smaller steps do not help chaotic means: load.duration of about {:.3} s would",
                duration * widest * widest
            )?;
        }
        if self.judge() == Judgement::TooMany {
            let [means, histories] = self.largest();
            let error =
                if goal.of == ErrorOf::Means { means.error } else { means.error.max(histories.error) };
            let falls =
                self.rounds.iter().filter_map(|round| round.errors).rev().nth(1).is_none_or(|[m, h]| {
                    error < FALLS * if goal.of == ErrorOf::Means { m } else { m.max(h) }
                });
            if falls {
                // The price doubles with each of them.
                let more = (error / goal.error).log(4.0).ceil().max(1.0);
                let last = self.rounds.last().map_or(0.0, |round| round.cpu);
                writeln!(
                    out,
                    "                 about {more:.0} more rounds would meet it (--rounds), the last of about {:.1} s CPU",
                    last * more.exp2()
                )?;
            } else {
                writeln!(
                    out,
                    "                 errors do not fall as steps do: more rounds are not sure to meet it (--rounds)"
                )?;
            }
        }
        Ok(())
    }
}
