//! How far two runs of a scene are apart, quantity by quantity.

use super::sample::{Course, Run, Sample};
use crate::report::interval;

/// Differences of all quantities of all parts over their sizes, in the order of [`Run::quantities`]; 0 where a run does not have one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Difference {
    /// [-] of means over the second half.
    pub means: Vec<f64>,
    /// [-] half of the interval (95 %) in which chance puts the mean of the difference, by its scatter over the second half:
    /// runs whose values differ now and then may agree in their means by accident.
    pub scatter: Vec<f64>,
    /// [-] of values at equal times, root mean square over the run.
    pub histories: Vec<f64>,
}

impl Difference {
    /// Difference of a run to a finer one of the same machine, whose sizes they are related to.
    pub fn of(run: &Run, finer: &Run) -> Self {
        let mut all = Self::default();
        run.parts.iter().zip(&finer.parts).for_each(|(run, finer)| all.add(run, finer));
        all
    }

    /// Adds the differences of a part.
    fn add(&mut self, run: &Course, finer: &Course) {
        let count = finer.quantities.len();
        let relative = |i: usize, difference: f64| {
            // What is 0 in both has no size and no error.
            if difference == 0.0 { 0.0 } else { difference / finer.sizes[i] }
        };
        let mean = |run: &Course, i: usize| {
            run.means.as_ref()?.find(&finer.quantities[i].name).map(|mean| mean.mean)
        };
        let of_means = |i: usize| mean(run, i).zip(mean(finer, i)).map_or(0.0, |(a, b)| (a - b).abs());
        let all = differences(&run.samples, &finer.samples);
        let square = |i: usize| all.iter().map(|row| row[i] * row[i]).sum::<f64>() / all.len().max(1) as f64;
        let half = &all[all.len() / 2..];
        let scatter = |i: usize| {
            let groups = |n: usize| {
                let each = (half.len() / n).max(1);
                let mean = |rows: &[Vec<f64>]| rows.iter().map(|row| row[i]).sum::<f64>() / each as f64;
                half.chunks_exact(each).take(n).map(mean).collect()
            };
            interval::of_mean(groups).unwrap_or(0.0)
        };
        self.means.extend((0..count).map(|i| relative(i, of_means(i))));
        self.scatter.extend((0..count).map(|i| relative(i, scatter(i))));
        self.histories.extend((0..count).map(|i| relative(i, square(i).sqrt())));
    }
}

/// Differences at equal times.
fn differences(run: &[Sample], finer: &[Sample]) -> Vec<Vec<f64>> {
    let mut all = Vec::with_capacity(run.len());
    let mut others = finer.iter().peekable();
    for sample in run {
        // Rows of both are at the same times to the bit: they come from one list.
        while others.next_if(|other| other.time < sample.time).is_some() {}
        if let Some(other) = others.next_if(|other| other.time == sample.time) {
            all.push(sample.values.iter().zip(&other.values).map(|(a, b)| a - b).collect());
        }
    }
    all
}
