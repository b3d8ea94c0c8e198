//! Complete elliptic integrals.

use std::f64::consts::PI;

/// Complete elliptic integrals of the first and second kind, `(K, E)`, of parameter `m = k^2` in [0, 1).
///
/// Arithmetic-geometric mean (Abramowitz and Stegun 17.6): quadratic convergence, exact to rounding.
pub fn complete_elliptic_integrals(m: f64) -> (f64, f64) {
    let (mut a, mut b, mut c) = (1.0, (1.0 - m).sqrt(), m.sqrt());
    let (mut power, mut sum) = (0.5, 0.5 * c * c);
    // Seven doublings of the correct digits are enough for any m that is not 1 to rounding.
    for _ in 0..40 {
        if c.abs() < 1e-17 * a {
            break;
        }
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        power *= 2.0;
        sum += power * c * c;
    }
    let first = PI / (2.0 * a);
    (first, first * (1.0 - sum))
}
