//! Creep coefficients of rolling along an axis of the ellipse, as Chebyshev series of the solutions of linear theory.
//!
//! They are analytic in the logarithm of the axis ratio and in Poisson's ratio: 56 by 16 terms are within 1e-10 of the solver
//! ([`super::linear::creep_matrix`]; tested), at a hundredth of its cost.

use std::f64::consts::PI;

use super::patch::{LinearError, POISSON, Patch, RATIO};

/// Terms by ln(axis ratio) and by Poisson's ratio.
const TERMS: [usize; 2] = [56, 16];
/// C11, C22, C23 and C33.
const COUNT: usize = 4;
/// The series, term by term, Poisson's ratio faster: `cargo run --release --example creep_coefficients` makes it.
const SHIPPED: &[u8] = include_bytes!("creep_coefficients.bin");

const _: () = assert!(SHIPPED.len() == TERMS[0] * TERMS[1] * COUNT * 8);

/// C11, C22, C23 and C33 of a patch as it rolls along its x axis.
///
/// # Errors
/// If the patch is out of range.
pub fn along_x(patch: &Patch) -> Result<[f64; COUNT], LinearError> {
    patch.check()?;
    let place = |x: f64, (low, high): (f64, f64)| ((x - low) - (high - x)) / (high - low);
    let by_poisson = polynomials(place(patch.poisson_ratio, POISSON));
    let [low, high] = [RATIO.0.ln(), RATIO.1.ln()];
    let x = place(patch.axis_ratio.ln(), (low, high));
    // Clenshaw's recurrence, from the last term on
    let (mut here, mut before) = ([0.0; COUNT], [0.0; COUNT]);
    for terms in SHIPPED.chunks_exact(TERMS[1] * COUNT * 8).rev() {
        let mut next = [0.0; COUNT];
        for (values, polynomial) in terms.chunks_exact(COUNT * 8).zip(&by_poisson) {
            for (sum, bytes) in next.iter_mut().zip(values.as_chunks().0) {
                *sum += polynomial * f64::from_le_bytes(*bytes);
            }
        }
        for k in 0..COUNT {
            next[k] += 2.0 * x * here[k] - before[k];
        }
        (before, here) = (here, next);
    }
    // The first term has half the weight of the recurrence.
    Ok(std::array::from_fn(|k| here[k] - x * before[k]))
}

/// Chebyshev polynomials of Poisson's ratio at a place in [-1, 1].
fn polynomials(x: f64) -> [f64; TERMS[1]] {
    let mut values = [1.0; TERMS[1]];
    values[1] = x;
    for k in 2..TERMS[1] {
        values[k] = 2.0 * x * values[k - 1] - values[k - 2];
    }
    values
}

/// The series from values at the Chebyshev nodes, by axis ratio and Poisson's ratio; in the order in which it is shipped.
///
/// # Errors
/// The first error of the values.
pub fn series<E>(at: impl Fn(f64, f64) -> Result<[f64; COUNT], E>) -> Result<Vec<[f64; COUNT]>, E> {
    let angle = |node: usize, count: usize| PI * (node as f64 + 0.5) / count as f64;
    let place = |node: usize, count: usize, (low, high): (f64, f64)| {
        0.5 * (low + high) + 0.5 * (high - low) * angle(node, count).cos()
    };
    let mut values = vec![];
    for i in 0..TERMS[0] {
        for j in 0..TERMS[1] {
            let ratio = place(i, TERMS[0], (RATIO.0.ln(), RATIO.1.ln())).exp();
            values.push(at(ratio, place(j, TERMS[1], POISSON))?);
        }
    }
    let weight = |term: usize, node: usize, count: usize| {
        let size = if term == 0 { 1.0 } else { 2.0 } / count as f64;
        size * (term as f64 * angle(node, count)).cos()
    };
    let term = |index: usize| {
        let (k, l) = (index / TERMS[1], index % TERMS[1]);
        let mut sum = [0.0; COUNT];
        for (node, values) in values.iter().enumerate() {
            let factor = weight(k, node / TERMS[1], TERMS[0]) * weight(l, node % TERMS[1], TERMS[1]);
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += factor * value;
            }
        }
        sum
    };
    Ok((0..TERMS[0] * TERMS[1]).map(term).collect())
}

/// The shipped series, in its order.
pub fn shipped() -> Vec<[f64; COUNT]> {
    let number = |place: usize| {
        let bytes = SHIPPED[8 * place..].first_chunk().copied().unwrap_or_default();
        f64::from_le_bytes(bytes)
    };
    (0..TERMS[0] * TERMS[1]).map(|term| std::array::from_fn(|k| number(COUNT * term + k))).collect()
}
