//! Complete elliptic integrals.

use std::f64::consts::PI;

/// Means that are taken at most.
const MOST: i32 = 40;
/// Weight of the last one's square in the sum.
const LAST_POWER: f64 = (1u64 << (MOST - 1)) as f64;

/// Complete elliptic integrals of the first and second kind, `(K, E)`, of parameter `m = k^2` in [0, 1).
///
/// Arithmetic-geometric mean (Abramowitz and Stegun 17.6): quadratic convergence, exact to rounding.
pub fn complete_elliptic_integrals(m: f64) -> (f64, f64) {
    let (mut a, mut b, mut c) = (1.0, (1.0 - m).sqrt(), m.sqrt());
    let (mut power, mut sum) = (0.5, 0.5 * c * c);
    // Seven doublings of the correct digits are enough for any m that is not 1 to rounding.
    for _ in 0..MOST {
        if c.abs() < 1e-17 * a {
            break;
        }
        let next = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        // One in four ends with means that are a last digit apart and stay so: nothing that is left to add changes the sum.
        if next == (a, b, c) && sum + LAST_POWER * c * c == sum {
            break;
        }
        (a, b, c) = next;
        power *= 2.0;
        sum += power * c * c;
    }
    let first = PI / (2.0 * a);
    (first, first * (1.0 - sum))
}
