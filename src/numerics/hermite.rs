//! Cubic Hermite interpolation within a step: from values and rates at both ends, exact for cubic polynomials.

use std::ops::{Add, Mul, Sub};

/// Weights at a time within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hermite {
    /// [-] of the change of the value over the step.
    change: f64,
    /// \[s] of the rates at start and end.
    rates: [f64; 2],
    /// [-] time over the step.
    share: f64,
}

impl Hermite {
    /// At `time` \[s] after the start of a step of `h` \[s].
    pub fn new(time: f64, h: f64) -> Self {
        let s = time / h;
        let left = 1.0 - s;
        Self { change: s * s * (3.0 - 2.0 * s), rates: [time * left * left, -time * s * left], share: s }
    }

    /// Value there on a line from start to end.
    pub fn linear<T>(&self, [start, end]: [T; 2]) -> T
    where
        T: Clone + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
    {
        start.clone() + (end - start) * self.share
    }

    /// Value there, from value and rate at start and end.
    pub fn at<T>(&self, [start, end]: [T; 2], [rate, last]: [T; 2]) -> T
    where
        T: Clone + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
    {
        start.clone() + (end - start) * self.change + rate * self.rates[0] + last * self.rates[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_cubic_is_met_and_ends_are_exact() {
        let value = |t: f64| 2.0 - 3.0 * t + 0.7 * t * t - 0.2 * t * t * t;
        let rate = |t: f64| -3.0 + 1.4 * t - 0.6 * t * t;
        let (ends, rates) = ([value(0.0), value(3.0)], [rate(0.0), rate(3.0)]);
        for time in [0.0, 0.4, 1.5, 2.9, 3.0] {
            assert!((Hermite::new(time, 3.0).at(ends, rates) - value(time)).abs() < 1e-14, "{time}");
        }
        assert_eq!(Hermite::new(0.0, 3.0).at(ends, rates), value(0.0));
    }
}
