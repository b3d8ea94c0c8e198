//! Largest value of a quantity in each turn of the balls about the bearing.

use std::f64::consts::TAU;

/// Gathers turn by turn.
#[derive(Clone, Debug, Default)]
pub struct Turns {
    /// \[s] time and [rad/s] speed of the last step.
    last: Option<(f64, f64)>,
    /// \[rad] turned since the turn began, at a time \[s], and the largest value since.
    turned: f64,
    begin: f64,
    largest: f64,
    /// Whole turns: \[s] where each began, and its largest value.
    whole: Vec<(f64, f64)>,
}

/// What came of all whole turns in a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerTurn {
    /// [-] their number.
    pub turns: usize,
    /// Mean of the largest value of each.
    pub mean: f64,
    /// The largest of all.
    pub largest: f64,
}

impl Turns {
    /// Takes a value at the start, or where a step has ended: a time \[s], and how fast the balls go round [rad/s].
    pub fn step(&mut self, time: f64, speed: f64, value: f64) {
        let Some((before, was)) = self.last.replace((time, speed)) else {
            (self.begin, self.largest) = (time, value);
            return;
        };
        self.turned += 0.5 * (was.abs() + speed.abs()) * (time - before);
        self.largest = self.largest.max(value);
        if self.turned >= TAU {
            self.whole.push((self.begin, self.largest));
            // A step is a small part of a turn: what goes beyond belongs to the next one.
            (self.turned, self.begin, self.largest) = (self.turned % TAU, time, value);
        }
    }

    /// Turns that began in a window, which begins at a time \[s]; none without a whole one, or where all values are 0.
    pub fn since(&self, from: f64) -> Option<PerTurn> {
        let values = || self.whole.iter().filter(|(begin, _)| *begin >= from).map(|(_, largest)| *largest);
        let turns = values().count();
        let largest = values().fold(0.0, f64::max);
        (largest > 0.0).then(|| PerTurn { turns, mean: values().sum::<f64>() / turns as f64, largest })
    }
}
