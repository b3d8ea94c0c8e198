//! Integrals over the steps of a run, and their means since the last communication point.

use serde::{Deserialize, Serialize};

/// Numbers that are integrated together.
pub trait Numbers: Copy + Default {
    /// Number by number with another.
    fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self;
}

/// Integrals since the start, and where they were at the last communication point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Since<T> {
    /// Values now.
    now: T,
    /// [value s] integrals.
    sums: T,
    /// [value s] integrals at the last communication point.
    marked: T,
    /// \[s] time of that point.
    at: f64,
}

impl<T: Numbers> Since<T> {
    /// Takes the values of this moment, at a time \[s] that no step has led to.
    pub fn begin(&mut self, now: T, time: f64) {
        self.now = now;
        self.mark(time);
    }

    /// Adds a step of `h` \[s] by the trapezoidal rule, as the energy balance does.
    pub fn add(&mut self, now: T, h: f64) {
        let step = self.now.zip(&now, |before, now| 0.5 * h * (before + now));
        self.sums = self.sums.zip(&step, |sum, step| sum + step);
        self.now = now;
    }

    /// From here on, at a time \[s], means are taken.
    pub fn mark(&mut self, time: f64) {
        (self.marked, self.at) = (self.sums, time);
    }

    /// Marks the place where others were at a time \[s] before this.
    pub fn mark_as(&mut self, then: &Self, time: f64) {
        (self.marked, self.at) = (then.sums, time);
    }

    /// Means since the last communication point, at a time \[s]; values of this moment where that is now.
    pub fn mean(&self, time: f64) -> T {
        let duration = time - self.at;
        match duration > 0.0 {
            true => self.sums.zip(&self.marked, |now, then| (now - then) / duration),
            false => self.now,
        }
    }
}
