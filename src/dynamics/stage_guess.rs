//! First guesses of the stages of a step ([`super::stages`]): polynomials through what earlier stages and the last step have solved.

use crate::numerics::esdirk::{PLACES, STAGES, extrapolation};

/// Weights with which unknowns that are known before a stage go on to it.
pub struct Known {
    /// Values at the start of the last step and in its fourth stage.
    pub old: [f64; 2],
    /// Values in the stages of this one.
    pub new: [f64; STAGES - 1],
}

impl Known {
    /// Those of a stage; `last` is the size of the last step over this one, where that counts.
    pub fn new(stage: usize, last: Option<f64>) -> Self {
        let [start, first, second, third, end] = PLACES;
        // Of the last step.
        let old = |ratio: f64| (third - 1.0) * ratio;
        let (old, new): (&[f64], &[f64]) = match (stage, last) {
            (1, None) => (&[], &[1.0]),
            (1, Some(ratio)) => {
                let [a, b, c] = extrapolation([-ratio, old(ratio), start], first);
                (&[a, b], &[c])
            }
            (2, None) => (&[], &extrapolation([start, first], second)),
            (2, Some(ratio)) => {
                let [b, c, d] = extrapolation([old(ratio), start, first], second);
                (&[0.0, b], &[c, d])
            }
            (3, None) => (&[], &extrapolation([start, first, second], third)),
            (3, Some(ratio)) => {
                let [b, c, d, e] = extrapolation([old(ratio), start, first, second], third);
                (&[0.0, b], &[c, d, e])
            }
            (_, None) => {
                let [c, e, f] = extrapolation([start, second, third], end);
                (&[], &[c, 0.0, e, f])
            }
            (_, Some(ratio)) => {
                let [b, c, e, f] = extrapolation([old(ratio), start, second, third], end);
                (&[0.0, b], &[c, 0.0, e, f])
            }
        };
        let weight = |of: &[f64], index: usize| of.get(index).copied().unwrap_or(0.0);
        Self { old: std::array::from_fn(|k| weight(old, k)), new: std::array::from_fn(|k| weight(new, k)) }
    }

    /// An unknown there, from those of the stages, and changes since the last step.
    pub fn sum(&self, reached: &[Vec<f64>; STAGES], old: Option<(&[f64], &[f64])>, index: usize) -> f64 {
        let Self { old: weights, new } = self;
        let known = new.iter().zip(reached).filter(|(weight, _)| **weight != 0.0);
        let sum = known.fold(0.0, |sum, (weight, of)| sum + weight * of[index]);
        let start = reached[0][index];
        old.map_or(sum, |(first, second)| {
            sum + weights[0] * (start + first[index]) + weights[1] * (start + second[index])
        })
    }
}
