//! Tangential tractions on an ellipse and the displacements they cause, as polynomials (paper eq. 12).
//!
//! Coordinates are X = x/a, Y = y/b on the unit disc; lengths are in units of `c = sqrt(a b)`, tractions in units of
//! the shear modulus. With traction `(1 - X^2 - Y^2)^(-1/2) X^p Y^q`, polar integration of the half-space's influence
//! function (Boussinesq and Cerruti) about the field point leaves a Gauss-Chebyshev mean along each chord, and
//!
//! ```text
//! u(X, Y) = c integral over t in [0, pi) of A(t)/rho(t) g(n, t) dt,   n = -X sin t + Y cos t,
//! ```
//!
//! where g is the chord's mean, a polynomial in n, `rho` the chord's stretch and A the kernel's angular factor. The
//! integrand is periodic and smooth: the trapezoidal rule is exact to rounding.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::Patch;

/// Monomials X^p Y^q up to a degree, ordered by degree and then by power of Y.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// Powers `(p, q)`.
    pub powers: Vec<(usize, usize)>,
    /// Largest `p + q`.
    pub degree: usize,
}

impl Basis {
    /// All monomials up to `degree`.
    pub fn new(degree: usize) -> Self {
        let powers = (0..=degree).flat_map(|total| (0..=total).map(move |q| (total - q, q))).collect();
        Self { powers, degree }
    }

    /// Index of X^p Y^q.
    pub fn index(&self, p: usize, q: usize) -> usize {
        let total = p + q;
        total * (total + 1) / 2 + q
    }

    /// Number of monomials.
    pub fn len(&self) -> usize {
        self.powers.len()
    }

    /// Never: degree 0 has one monomial.
    pub fn is_empty(&self) -> bool {
        self.powers.is_empty()
    }
}

/// Binomial coefficient.
fn binomial(n: usize, k: usize) -> f64 {
    (1..=k).map(|i| (n - k + i) as f64 / i as f64).product()
}

/// Powers `x^0 .. x^n`.
fn powers(x: f64, n: usize) -> Vec<f64> {
    std::iter::successors(Some(1.0), |last| Some(last * x)).take(n + 1).collect()
}

/// Coefficients of n^0 .. n^(p+q) of the mean of `X^p Y^q` over the chord of direction t: on it
/// `X = s cos t - n sin t`, `Y = s sin t + n cos t`, `s = sqrt(1 - n^2) cos phi`, and the mean is over phi.
fn chord_mean(p: usize, q: usize, cos: &[f64], sin: &[f64]) -> Vec<f64> {
    let mut mean = vec![0.0; p + q + 1];
    for i in 0..=p {
        for j in 0..=q {
            let s_power = i + j;
            if s_power % 2 == 1 {
                continue;
            }
            let half = s_power / 2;
            // mean of cos^(2 l) is (2 l - 1)!!/(2 l)!!
            let moment: f64 = (1..=half).map(|l| (2 * l - 1) as f64 / (2 * l) as f64).product();
            let sign = if (p - i) % 2 == 1 { -1.0 } else { 1.0 };
            let factor = sign * binomial(p, i) * binomial(q, j) * moment * cos[i + q - j] * sin[j + p - i];
            // (1 - n^2)^half n^(p + q - s_power)
            for l in 0..=half {
                let sign = if l % 2 == 1 { -1.0 } else { 1.0 };
                mean[p + q - s_power + 2 * l] += factor * sign * binomial(half, l);
            }
        }
    }
    mean
}

/// Displacement polynomials of all traction polynomials.
///
/// Row and column blocks are (x, y) components; entry (i, j) of a block is the coefficient of monomial i in the
/// displacement, in units of `c`, by monomial j of the traction over G. Relative displacement of two like bodies.
pub fn load_displacement(patch: &Patch, basis: &Basis) -> DMatrix<f64> {
    // Points of the trapezoidal rule: slender ellipses have a narrow peak of 1/rho.
    let slenderness = patch.axis_ratio.max(1.0 / patch.axis_ratio);
    let points = 4 * basis.degree + 24 + (12.0 * slenderness) as usize;
    let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
    let (n, nu) = (basis.len(), patch.poisson_ratio);
    let mut matrix = DMatrix::zeros(2 * n, 2 * n);
    for point in 0..points {
        let t = PI * (point as f64 + 0.5) / points as f64;
        let (sin_t, cos_t) = t.sin_cos();
        let (cos, sin) = (powers(cos_t, basis.degree), powers(sin_t, basis.degree));
        let (dx, dy) = (a * cos_t, b * sin_t);
        let rho = dx.hypot(dy);
        // u = 1/(pi G) integral of [(1 - nu)/R + nu R_i R_j/R^3] p dA; a b = 1 in these units, the chord gives pi.
        let weight = PI / points as f64 / rho;
        let factors = [
            1.0 - nu + nu * dx * dx / (rho * rho),
            nu * dx * dy / (rho * rho),
            1.0 - nu + nu * dy * dy / (rho * rho),
        ];
        for (column, &(p, q)) in basis.powers.iter().enumerate() {
            for (k, coefficient) in chord_mean(p, q, &cos, &sin).into_iter().enumerate() {
                if coefficient == 0.0 {
                    continue;
                }
                // n^k = (-X sin t + Y cos t)^k
                for m in 0..=k {
                    let sign = if m % 2 == 1 { -1.0 } else { 1.0 };
                    let value = weight * coefficient * sign * binomial(k, m) * sin[m] * cos[k - m];
                    let row = basis.index(m, k - m);
                    matrix[(row, column)] += value * factors[0];
                    matrix[(row, n + column)] += value * factors[1];
                    matrix[(n + row, column)] += value * factors[1];
                    matrix[(n + row, n + column)] += value * factors[2];
                }
            }
        }
    }
    matrix
}

/// Integral over the unit disc of `(1 - X^2 - Y^2)^(-1/2) X^p Y^q`.
pub fn disc_moment(p: usize, q: usize) -> f64 {
    if p % 2 == 1 || q % 2 == 1 {
        return 0.0;
    }
    // Angle: 2 pi (p-1)!! (q-1)!!/(p+q)!!; radius: integral of r^(k+1) (1 - r^2)^(-1/2) = k!!/(k+1)!!.
    let double = |n: usize| -> f64 { (1..=n).rev().step_by(2).map(|i| i as f64).product() };
    let odd = |n: usize| if n == 0 { 1.0 } else { double(n - 1) };
    let k = p + q;
    2.0 * PI * odd(p) * odd(q) / double(k) * double(k) / double(k + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_disc_moments() {
        // 2 pi for the constant; 2 pi/3 for X^2 (a third of r^2's 4 pi/3).
        assert!((disc_moment(0, 0) - 2.0 * PI).abs() < 1e-14);
        assert!((disc_moment(2, 0) - 2.0 * PI / 3.0).abs() < 1e-14);
        assert!((disc_moment(2, 2) - 2.0 * PI / 15.0).abs() < 1e-14);
        assert_eq!(disc_moment(1, 2), 0.0);
    }

    #[test]
    fn closed_form_constant_traction_on_a_circle() {
        // Mindlin 1949: traction (1 - r^2)^(-1/2) on a circle of radius 1 moves one body rigidly by
        // pi (2 - nu)/(4 G); two bodies by twice that.
        for nu in [0.0, 0.3, 0.5] {
            let patch = Patch { axis_ratio: 1.0, poisson_ratio: nu, rolling_angle: 0.0 };
            let basis = Basis::new(2);
            let k = load_displacement(&patch, &basis);
            assert!((k[(0, 0)] - PI * (2.0 - nu) / 2.0).abs() < 1e-13, "{}", k[(0, 0)]);
            for row in 1..2 * basis.len() {
                assert!(k[(row, 0)].abs() < 1e-13, "row {row}");
            }
        }
    }

    #[test]
    fn invariant_under_exchange_of_the_axes() {
        let basis = Basis::new(5);
        let at = |ratio| {
            load_displacement(&Patch { axis_ratio: ratio, poisson_ratio: 0.3, rolling_angle: 0.0 }, &basis)
        };
        let (one, other) = (at(0.2), at(5.0));
        let n = basis.len();
        for (i, &(p, q)) in basis.powers.iter().enumerate() {
            for (j, &(r, s)) in basis.powers.iter().enumerate() {
                let swapped = (n + basis.index(q, p), n + basis.index(s, r));
                assert!((one[(i, j)] - other[swapped]).abs() < 1e-12 * one.amax());
            }
        }
    }

    #[test]
    fn refined_rule_changes_nothing() {
        // The number of points grows with the degree: the same entries with many more of them.
        let patch = Patch { axis_ratio: 0.05, poisson_ratio: 0.3, rolling_angle: 0.0 };
        let (small, large) = (Basis::new(4), Basis::new(24));
        let (few, many) = (load_displacement(&patch, &small), load_displacement(&patch, &large));
        for i in 0..small.len() {
            for j in 0..small.len() {
                let error = (few[(i, j)] - many[(i, j)]).abs();
                assert!(error < 1e-9 * few.amax(), "{i} {j}: {error:e}");
            }
        }
    }
}
