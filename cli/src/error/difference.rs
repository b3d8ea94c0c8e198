//! How far two runs of a scene are apart, quantity by quantity.

use super::sample::{Run, Sample, sizes};
use crate::report::quantities::{COUNT, QUANTITIES};

/// Differences of all quantities over their sizes, in the order of [`QUANTITIES`]; 0 where a run does not have one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// [-] of means over the second half.
    pub means: [f64; COUNT],
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
        let squares = squares(&run.samples, &finer.samples);
        Self {
            means: std::array::from_fn(|i| relative(i, of_means(i))),
            histories: std::array::from_fn(|i| relative(i, squares[i].sqrt())),
        }
    }
}

/// Mean squares of the differences at equal times.
fn squares(run: &[Sample], finer: &[Sample]) -> [f64; COUNT] {
    let (mut sums, mut count) = ([0.0; COUNT], 0.0f64);
    let mut others = finer.iter().peekable();
    for sample in run {
        // Rows of both are at the same times to the bit: they come from one list.
        while others.next_if(|other| other.time < sample.time).is_some() {}
        if let Some(other) = others.next_if(|other| other.time == sample.time) {
            count += 1.0;
            for (sum, (a, b)) in sums.iter_mut().zip(sample.values.iter().zip(&other.values)) {
                *sum += (a - b) * (a - b);
            }
        }
    }
    sums.map(|sum| sum / count.max(1.0))
}
