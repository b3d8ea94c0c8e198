//! The paper's objective as printed (eq. 13), kept as an experiment: the integral of `| |s| f/(mu p) - s |^2` over the
//! contact. It is zero for every traction of full adhesion, bounded or not, and so does not determine the solution.

use nalgebra::{DMatrix, DVector};

use super::ScaledCreepage;
use super::nonlinear::{Kalker, Solution};

/// Iterations after which the experiment ends wherever it is.
const MAX_ITERATIONS: u32 = 60;

/// Residual of eq. 13 at all points, and its derivative by the coefficients (one row a residual).
fn residual(kalker: &Kalker, z: &DVector<f64>, h: &ScaledCreepage) -> (DVector<f64>, DMatrix<f64>) {
    let (n, rows) = (kalker.monomials, kalker.points.len());
    let mut values = DVector::zeros(2 * rows);
    let mut jacobian = DMatrix::zeros(2 * rows, 2 * n);
    for (i, (point, (f, s))) in kalker.points.iter().zip(kalker.fields(z, h)).enumerate() {
        let (root, size) = (point.weight.sqrt(), s[0].hypot(s[1]));
        let direction = if size > 0.0 { [s[0] / size, s[1] / size] } else { [0.0; 2] };
        for m in 0..2 {
            let share = f[m] / point.bound;
            values[2 * i + m] = root * (size * share - s[m]);
            for k in 0..2 * n {
                let slips = [kalker.slips[(i, k)], kalker.slips[(rows + i, k)]];
                let along = direction[0] * slips[0] + direction[1] * slips[1];
                let own = if k / n == m { size * kalker.values[(i, k % n)] / point.bound } else { 0.0 };
                jacobian[(2 * i + m, k)] = root * (share * along + own - slips[m]);
            }
        }
    }
    (values, jacobian)
}

/// Minimises the printed objective by Levenberg-Marquardt from zero traction: solution and the objective reached.
pub fn solve(kalker: &Kalker, h: &ScaledCreepage) -> (Solution, f64) {
    let mut z = DVector::zeros(2 * kalker.monomials);
    let (mut r, mut jacobian) = residual(kalker, &z, h);
    let mut damping = 1e-3;
    let mut iterations = 0;
    while iterations < MAX_ITERATIONS && damping < 1e12 {
        iterations += 1;
        let mut normal = jacobian.transpose() * &jacobian;
        for k in 0..normal.nrows() {
            normal[(k, k)] *= 1.0 + damping;
            normal[(k, k)] += 1e-14;
        }
        let step = normal.cholesky().map(|factor| factor.solve(&(jacobian.transpose() * &r)));
        let trial = step.map(|step| &z - step);
        let next = trial.as_ref().map(|trial| residual(kalker, trial, h));
        match (trial, next) {
            (Some(trial), Some((values, slopes))) if values.norm_squared() < r.norm_squared() => {
                (z, r, jacobian) = (trial, values, slopes);
                damping *= 0.1;
            }
            _ => damping *= 10.0,
        }
    }
    let objective = r.norm_squared();
    let fields = kalker.fields_at(&z, h);
    (kalker.finish(z, &fields, iterations), objective)
}
