//! Angles of directions in the table.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI};

use super::table_pieces::counts;
use crate::numerics::scalar::Values;

/// Steps of `sin - cos` from -1 to 1 between the angles that others are measured from.
const STEPS: usize = 32;

/// An angle in [0, pi/2] with its cosine and sine.
#[derive(Clone, Copy)]
struct Reference {
    angle: f64,
    cos: f64,
    sin: f64,
}

/// Angles at even steps of `sin - cos`, with room for every number of six bits.
static REFERENCES: [Reference; 64] = {
    let mut references = [Reference { angle: 0.0, cos: 1.0, sin: 0.0 }; 64];
    let mut k = 0;
    while k <= STEPS {
        // sin - cos is the sine of the angle beyond pi/4, times the root of 2. To some digits: what counts is that cosine and
        // sine belong to the angle.
        let beyond = (2.0 * k as f64 / STEPS as f64 - 1.0) * FRAC_1_SQRT_2;
        let (mut angle, mut term, mut n) = (FRAC_PI_4, beyond, 0);
        while n < 20 {
            let odd = (2 * n + 1) as f64;
            angle += term / odd;
            term *= beyond * beyond * odd / (odd + 1.0);
            n += 1;
        }
        references[k] =
            Reference { angle, cos: alternating(angle, 1.0, 0), sin: alternating(angle, angle, 1) };
        k += 1;
    }
    references
};

/// Series of the cosine, from a first term of 1 and order 0, or of the sine, from one of the angle and order 1.
pub(super) const fn alternating(angle: f64, first: f64, order: usize) -> f64 {
    let (mut terms, mut k) = ([first; 16], 1);
    while k < terms.len() {
        let order = (order + 2 * k) as f64;
        terms[k] = -terms[k - 1] * angle * angle / (order * (order - 1.0));
        k += 1;
    }
    // small ones first
    let mut sum = 0.0;
    while k > 0 {
        k -= 1;
        sum += terms[k];
    }
    sum
}

/// Angle in [0, pi/2] of a unit vector, given by cosine and sine: an angle beside it, and the arc of the sine of the rest.
#[inline(always)]
pub(super) fn acute_angle<V: Values>([cos, sin]: [V; 2]) -> V {
    // The rest is below 0.04.
    const SERIES: [f64; 6] = [1.0, 1.0 / 6.0, 3.0 / 40.0, 5.0 / 112.0, 35.0 / 1152.0, 63.0 / 2816.0];
    let numbers = counts((sin - cos + V::one()).scale(0.5 * STEPS as f64));
    let reference = |lane: usize| &REFERENCES[numbers[lane] % REFERENCES.len()];
    let [at, cos_at, sin_at] = [
        V::by_lane(|lane| reference(lane).angle),
        V::by_lane(|lane| reference(lane).cos),
        V::by_lane(|lane| reference(lane).sin),
    ];
    let rest = sin * cos_at - cos * sin_at;
    at + rest * rest.square().polynomial(&SERIES)
}

/// Angle in [0, pi] alike.
#[inline(always)]
pub(super) fn angle<V: Values>([cos, sin]: [V; 2]) -> V {
    let acute = acute_angle([cos.abs(), sin]);
    acute.where_positive(cos, V::constant(PI) - acute)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_angles() {
        for step in 0..=1000 {
            let expected = PI * f64::from(step) / 1000.0;
            let error = angle([expected.cos(), expected.sin().abs()]) - expected;
            assert!(error.abs() < 1e-15, "{expected}: {error:e}");
        }
    }
}
