//! Eigenvalues and shapes of linear equations of motion `M q'' + C q' + K q = 0`, whose C and K need not be symmetric.

use nalgebra::{Cholesky, Complex, DMatrix, DVector, Schur};

use super::size::ascending;

/// [-] eigenvalues whose imaginary part is a smaller part of the largest eigenvalue do not swing.
const SWINGS: f64 = 1e-7;
/// Iterations of the eigenvalues for each of them, at most.
const ITERATIONS: usize = 100;
/// [-] how far beside an eigenvalue its shape is solved for: at it, there is no solution.
const BESIDE: f64 = 1e-9;

/// One way in which a system swings.
#[derive(Clone, Debug)]
pub struct Mode {
    /// [1/s] its eigenvalue, with a positive imaginary part.
    pub eigenvalue: Complex<f64>,
    /// Amplitudes of the coordinates: they move as the real part of these times `exp(eigenvalue t)`.
    pub shape: DVector<Complex<f64>>,
}

impl Mode {
    /// \[Hz] frequency at which it swings.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.im / std::f64::consts::TAU
    }

    /// [-] damping over critical damping; negative where it grows.
    pub fn damping(&self) -> f64 {
        -self.eigenvalue.re / self.eigenvalue.norm()
    }
}

/// All modes that swing, by their frequency; M is symmetric and positive definite. None where it is not, or where eigenvalues are not
/// found.
pub fn modes(mass: &DMatrix<f64>, damping: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Option<Vec<Mode>> {
    let n = mass.nrows();
    let lower = Cholesky::new(mass.clone())?.l();
    // With q = L^-T x: the mass matrix becomes that of unit masses, whatever the units of the coordinates.
    let scaled = |matrix: &DMatrix<f64>| {
        let half = lower.solve_lower_triangular(matrix)?;
        Some(lower.solve_lower_triangular(&half.transpose())?.transpose())
    };
    let (damping, stiffness) = (scaled(damping)?, scaled(stiffness)?);
    // Time in units of the fastest swing: rates and displacements are then of a size.
    let rate = stiffness.amax().sqrt().max(damping.amax());
    if rate == 0.0 {
        return Some(vec![]);
    }
    let (damping, stiffness) = (damping / rate, stiffness / (rate * rate));
    let mut whole = DMatrix::zeros(2 * n, 2 * n);
    whole.view_mut((0, n), (n, n)).fill_with_identity();
    whole.view_mut((n, 0), (n, n)).copy_from(&-&stiffness);
    whole.view_mut((n, n), (n, n)).copy_from(&-&damping);
    let eigenvalues = Schur::try_new(whole, f64::EPSILON, ITERATIONS * 2 * n)?.complex_eigenvalues();
    let largest = eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let swinging: Vec<Complex<f64>> =
        eigenvalues.iter().copied().filter(|value| value.im > SWINGS * largest).collect();
    let rates: Vec<f64> = swinging.iter().map(|value| value.im).collect();
    let back = lower.transpose();
    let mode = |eigenvalue: Complex<f64>| {
        let x = shape(&damping, &stiffness, eigenvalue)?;
        let part = |of: fn(&Complex<f64>) -> f64| back.solve_upper_triangular(&x.map(|value| of(&value)));
        let (re, im) = (part(|value| value.re)?, part(|value| value.im)?);
        let shape = re.zip_map(&im, Complex::new);
        Some(Mode { eigenvalue: eigenvalue * rate, shape })
    };
    ascending(&rates).into_iter().map(|k| mode(swinging[k])).collect()
}

/// The shape of an eigenvalue, by inverse iteration.
fn shape(
    damping: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    eigenvalue: Complex<f64>,
) -> Option<DVector<Complex<f64>>> {
    let n = damping.nrows();
    let beside = eigenvalue * (1.0 + BESIDE);
    let mut matrix = damping.map(|value| beside * value) + stiffness.map(Complex::from);
    for i in 0..n {
        matrix[(i, i)] += beside * beside;
    }
    let factors = matrix.lu();
    // No symmetry of the system has a part in the start.
    let mut shape = DVector::from_fn(n, |i, _| Complex::new(1.0, 0.3) / (1.0 + 0.37 * i as f64));
    for _ in 0..3 {
        shape = factors.solve(&shape)?;
        let size = shape.norm();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        shape /= Complex::from(size);
    }
    Some(shape)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_damped_mass_and_two_that_are_coupled() {
        let one = |value: f64| DMatrix::from_element(1, 1, value);
        // 2 kg, 4 N s/m, 800 N/m: 20 rad/s undamped, damping ratio 4 / (2 sqrt(1600)).
        let found = modes(&one(2.0), &one(4.0), &one(800.0)).unwrap();
        let ratio: f64 = 0.05;
        assert!((found[0].damping() - ratio).abs() < 1e-12);
        assert!((found[0].eigenvalue.norm() - 20.0).abs() < 1e-10);
        assert!((found[0].eigenvalue.im - 20.0 * (1.0 - ratio * ratio).sqrt()).abs() < 1e-10);
        // Two equal masses between three equal springs: sqrt(k/m) in phase, sqrt(3 k/m) against each other, in any units.
        let units = DMatrix::from_diagonal(&DVector::from_row_slice(&[1.0, 1e-4]));
        let of = |matrix: DMatrix<f64>| &units * matrix * &units;
        let stiffness = DMatrix::from_row_slice(2, 2, &[2e6, -1e6, -1e6, 2e6]);
        let found = modes(&of(DMatrix::identity(2, 2)), &DMatrix::zeros(2, 2), &of(stiffness)).unwrap();
        for (mode, (rate, sign)) in found.iter().zip([(1e3, 1.0), (3f64.sqrt() * 1e3, -1.0)]) {
            assert!((mode.eigenvalue.im / rate - 1.0).abs() < 1e-9, "{}", mode.eigenvalue);
            let ratio = mode.shape[1] * 1e-4 / mode.shape[0];
            assert!((ratio - Complex::from(sign)).norm() < 1e-6, "{ratio}");
        }
    }

    #[test]
    fn closed_form_a_gyroscope_goes_round_forwards_and_backwards() {
        // Two tilts of a disc, I' = 2 I: omega^2 -+ 2 W omega - k/I = 0.
        let (spin, square) = (30.0f64, 1e4f64);
        let gyroscopic = DMatrix::from_row_slice(2, 2, &[0.0, 2.0 * spin, -2.0 * spin, 0.0]);
        let found =
            modes(&DMatrix::identity(2, 2), &gyroscopic, &(DMatrix::identity(2, 2) * square)).unwrap();
        let root = (spin * spin + square).sqrt();
        for (mode, (rate, side)) in found.iter().zip([(root - spin, -1.0), (root + spin, 1.0)]) {
            assert!((mode.eigenvalue.im - rate).abs() < 1e-8, "{} {rate}", mode.eigenvalue);
            // Forwards, the tilt goes from y to z: z is a quarter of a turn behind y.
            let turn = (mode.shape[0].conj() * mode.shape[1]).im;
            assert!((turn / mode.shape[0].norm_sqr() + side).abs() < 1e-6, "{turn}");
        }
        // What does not swing is no mode.
        let none = DMatrix::zeros(2, 2);
        assert!(modes(&DMatrix::identity(2, 2), &none, &none).unwrap().is_empty());
        assert!(modes(&none, &none, &none).is_none());
    }
}
