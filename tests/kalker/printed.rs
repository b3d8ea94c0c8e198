//! The paper's objective as printed (eq. 13), as an experiment: the integral of `| |s| f/(mu p) - s |^2` over the contact.
//! It is zero for every traction of full adhesion, bounded or not, and so does not determine the solution.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use roulement::kalker::linear::resultants;
use roulement::kalker::load_displacement::Basis;
use roulement::kalker::nonlinear::Kalker;
use roulement::kalker::solution::{LocalState, Solution};
use roulement::kalker::{Patch, ScaledCreepage, ScaledForces};

/// Iterations after which the experiment ends wherever it is.
const MAX_ITERATIONS: u32 = 60;

/// The printed problem of one patch, on the points and with the polynomials of the repaired one.
pub struct Printed {
    kalker: Kalker,
    points: Vec<LocalState>,
    /// Traction polynomials at the points, and slips by all coefficients: rows x of each point, then y.
    values: DMatrix<f64>,
    slips: DMatrix<f64>,
    /// Net forces over mu Q, mu Q c and mu Q c^2.
    resultants: DMatrix<f64>,
}

impl Printed {
    pub fn new(patch: Patch, degree: usize) -> Self {
        let kalker = Kalker::new(patch, degree).unwrap();
        let basis = Basis::new(degree);
        let (n, at_rest) = (basis.len(), ScaledCreepage::default());
        let points = kalker.local_states(&solution(DVector::zeros(2 * n)), &at_rest);
        let values = DMatrix::from_fn(points.len(), n, |i, k| {
            let ([x, y], (p, q)) = (points[i].place, basis.powers[k]);
            x.powi(p as i32) * y.powi(q as i32) / points[i].bound
        });
        let mut slips = DMatrix::zeros(2 * points.len(), 2 * n);
        for k in 0..2 * n {
            let unit = DVector::from_fn(2 * n, |i, _| if i == k { 1.0 } else { 0.0 });
            let states = kalker.local_states(&solution(unit), &at_rest);
            for (i, state) in states.iter().enumerate() {
                (slips[(i, k)], slips[(points.len() + i, k)]) = (state.slip[0], state.slip[1]);
            }
        }
        let resultants = resultants(&patch, &basis) * (1.5 / PI);
        Self { kalker, points, values, slips, resultants }
    }

    /// Residual of eq. 13 at all points, and its derivative by the coefficients (one row a residual).
    fn residual(&self, z: &DVector<f64>, h: &ScaledCreepage) -> (DVector<f64>, DMatrix<f64>) {
        let (n, rows) = (self.values.ncols(), self.points.len());
        let states = self.kalker.local_states(&solution(z.clone()), h);
        let tractions = [&self.values * z.rows(0, n), &self.values * z.rows(n, n)];
        let mut values = DVector::zeros(2 * rows);
        let mut jacobian = DMatrix::zeros(2 * rows, 2 * n);
        for (i, state) in states.iter().enumerate() {
            let s = state.slip;
            let (root, size) = (state.weight.sqrt(), s[0].hypot(s[1]));
            let direction = if size > 0.0 { [s[0] / size, s[1] / size] } else { [0.0; 2] };
            for m in 0..2 {
                let relative = tractions[m][i] / state.bound;
                values[2 * i + m] = root * (size * relative - s[m]);
                for k in 0..2 * n {
                    let slips = [self.slips[(i, k)], self.slips[(rows + i, k)]];
                    let along = direction[0] * slips[0] + direction[1] * slips[1];
                    let own = if k / n == m { size * self.values[(i, k % n)] / state.bound } else { 0.0 };
                    jacobian[(2 * i + m, k)] = root * (relative * along + own - slips[m]);
                }
            }
        }
        (values, jacobian)
    }

    /// Minimises the printed objective by Levenberg-Marquardt from zero traction: forces, and the objective reached.
    pub fn solve(&self, h: &ScaledCreepage) -> (ScaledForces, f64) {
        let mut z = DVector::zeros(2 * self.values.ncols());
        let (mut r, mut jacobian) = self.residual(&z, h);
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
            let next = trial.as_ref().map(|trial| self.residual(trial, h));
            match (trial, next) {
                (Some(trial), Some((values, slopes))) if values.norm_squared() < r.norm_squared() => {
                    (z, r, jacobian) = (trial, values, slopes);
                    damping *= 0.1;
                }
                _ => damping *= 10.0,
            }
        }
        (self.forces(&z), r.norm_squared())
    }

    /// Net forces, the tangential one within its limit.
    fn forces(&self, z: &DVector<f64>) -> ScaledForces {
        let net = &self.resultants * z;
        let size = net[0].hypot(net[1]).max(1.0);
        ScaledForces { fx: net[0] / size, fy: net[1] / size, mz: net[2], second_moment: net[3] }
    }
}

/// Coefficients as a solution.
fn solution(coefficients: DVector<f64>) -> Solution {
    Solution { coefficients, forces: ScaledForces::default(), stick: 0.0, iterations: 0 }
}
