//! How far two runs of a scene are apart, quantity by quantity.

use super::sample::{Run, Sample, sizes};
use crate::report::interval;
use crate::report::quantities::{COUNT, QUANTITIES};

/// Differences of all quantities over their sizes, in the order of [`QUANTITIES`]; 0 where a run does not have one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// [-] of means over the second half.
    pub means: [f64; COUNT],
    /// [-] half of the interval (95 %) in which chance puts the mean of the difference, by its scatter over the second half:
    /// runs whose values differ now and then may agree in their means by accident.
    pub scatter: [f64; COUNT],
    /// [-] of values at equal times, root mean square over the run.
    pub histories: [f64; COUNT],
}

impl Difference {
    /// Difference of a run to a finer one, whose sizes they are related to.
    pub fn of(run: &Run, finer: &Run) -> Self {
        let sizes = sizes(&finer.samples, finer.lengths);
        let relative = |i: usize, difference: f64| {
            // What is 0 in both has no size and no error.
            if difference == 0.0 { 0.0 } else { difference / sizes[i] }
        };
        let mean = |run: &Run, i: usize| run.means.as_ref()?.find(QUANTITIES[i].name).map(|mean| mean.mean);
        let of_means = |i: usize| mean(run, i).zip(mean(finer, i)).map_or(0.0, |(a, b)| (a - b).abs());
        let all = differences(&run.samples, &finer.samples);
        let square = |i: usize| all.iter().map(|row| row[i] * row[i]).sum::<f64>() / all.len().max(1) as f64;
        let half = &all[all.len() / 2..];
        let scatter = |i: usize| {
            let groups = |n: usize| {
                let each = (half.len() / n).max(1);
                let mean = |rows: &[[f64; COUNT]]| rows.iter().map(|row| row[i]).sum::<f64>() / each as f64;
                half.chunks_exact(each).take(n).map(mean).collect()
            };
            interval::of_mean(groups).unwrap_or(0.0)
        };
        Self {
            means: std::array::from_fn(|i| relative(i, of_means(i))),
            scatter: std::array::from_fn(|i| relative(i, scatter(i))),
            histories: std::array::from_fn(|i| relative(i, square(i).sqrt())),
        }
    }
}

/// Differences at equal times.
fn differences(run: &[Sample], finer: &[Sample]) -> Vec<[f64; COUNT]> {
    let mut all = Vec::with_capacity(run.len());
    let mut others = finer.iter().peekable();
    for sample in run {
        // Rows of both are at the same times to the bit: they come from one list.
        while others.next_if(|other| other.time < sample.time).is_some() {}
        if let Some(other) = others.next_if(|other| other.time == sample.time) {
            all.push(std::array::from_fn(|i| sample.values[i] - other.values[i]));
        }
    }
    all
}
