//! Kalker's nonlinear theory in polynomials (paper section 3.1.1), with an objective that determines the solution.
//!
//! The printed objective, the integral of T S (eq. 13), is zero for every full-stick traction, bounded or not. Here
//! the unknown coefficients of the traction polynomials (eq. 12) minimise instead the sum over an elliptical grid of
//!
//! ```text
//! | f - P(f + k s) |^2
//! ```
//!
//! with f the traction over mu p0, s the slip in the same scale and P the projection on the Coulomb disc: it vanishes
//! exactly where Coulomb's law holds (stick: s = 0 and |f| below the bound; slip: f at the bound along s), for every k and
//! every weight of a point, which follow the creepages (`super::objective_weights`). A penalty on
//! the singular traction at the leading edge takes the place of the condition that fresh material enters unstrained.
//! The minimum is found by Newton's and Levenberg and Marquardt's methods from the linear solution, or from a solution at
//! nearby creepages.

use std::f64::consts::{PI, TAU};

use nalgebra::DMatrix;
use thiserror::Error;

use super::linear::{adhesion_tractions, leading_edge, resultants};
use super::load_displacement::{Basis, LoadDisplacement};
use super::patch::LinearError;
use super::{Patch, ScaledCreepage};

/// [-] weight of the leading-edge rows.
const EDGE_WEIGHT: f64 = 8.0;

/// Why there is no solution.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum KalkerError {
    /// The patch is out of range.
    #[error(transparent)]
    Patch(#[from] LinearError),
    /// Degree outside 1 to 7.
    #[error("the degree {0} of the traction polynomials is outside [1, 7]")]
    Degree(usize),
    /// A creepage that is NaN or infinite.
    #[error("the creepages {0:?} are not finite")]
    NotFinite(ScaledCreepage),
    /// The minimisation did not end.
    #[error("Kalker's nonlinear problem does not converge at the scaled creepages {0:?}")]
    NoConvergence(ScaledCreepage),
}

/// A point of the elliptical grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Area on the unit disc.
    pub(super) weight: f64,
    /// Coulomb's bound over mu p0.
    pub(super) bound: f64,
}

/// The problem of one patch: everything that does not depend on the creepages.
#[derive(Clone, Debug)]
pub struct Kalker {
    pub(super) patch: Patch,
    pub(super) points: Vec<Point>,
    /// Traction polynomials at the points: one row a monomial, one column a point.
    pub(super) monomial_values: DMatrix<f64>,
    /// Slip at the points by all coefficients: rows x of each point, then y.
    pub(super) slips: DMatrix<f64>,
    /// Slips as one column each of x and y of a point, and the squares of the slip over the contact, points by their
    /// areas and by what these are at rest.
    pub(super) slip_columns: DMatrix<f64>,
    pub(super) slip_squares: [DMatrix<f64>; 2],
    /// Leading-edge rows, and their square.
    pub(super) edge: DMatrix<f64>,
    pub(super) edge_square: DMatrix<f64>,
    /// Linear solutions of unit creepages.
    pub(super) adhesion: DMatrix<f64>,
    /// Net forces over mu Q, mu Q c and mu Q c^2 by all coefficients.
    pub(super) resultants: DMatrix<f64>,
    /// [-] linear force over mu Q by scaled creepage, the root of the mean square of all directions.
    pub(super) response: f64,
    pub(super) monomials: usize,
}

/// Nodes and weights of Gauss-Legendre quadrature on [0, 1].
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut p, mut last) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, last) = (((2.0 * k + 1.0) * x * p - k * last) / (k + 1.0), p);
                }
                slope = n as f64 * (x * p - last) / (x * x - 1.0);
                let step = p / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Points on the unit disc, `radial` times `angular`, whose rule gives the sliding force of a whole contact exactly.
fn quadrature(radial: usize, angular: usize) -> Vec<Point> {
    let mut points = Vec::with_capacity(radial * angular);
    for (square, radial_weight) in gauss_legendre(radial) {
        for k in 0..angular {
            let (sin, cos) = (TAU * (k as f64 + 0.5) / angular as f64).sin_cos();
            let r = square.sqrt();
            let weight = radial_weight * PI / angular as f64;
            points.push(Point { x: r * cos, y: r * sin, weight, bound: (1.0 - square).sqrt() });
        }
    }
    let sum: f64 = points.iter().map(|p| p.weight * p.bound).sum();
    for point in &mut points {
        point.weight *= TAU / 3.0 / sum;
    }
    points
}

/// At the points, one row each, by monomials: tractions, and derivatives of displacements along rolling.
fn fields_of_monomials(patch: &Patch, basis: &Basis, points: &[Point]) -> [DMatrix<f64>; 2] {
    let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
    let (sin, cos) = patch.rolling_angle.sin_cos();
    let mut tractions = DMatrix::zeros(points.len(), basis.len());
    let mut gradients = DMatrix::zeros(points.len(), basis.len());
    for (row, point) in points.iter().enumerate() {
        for (column, &(p, q)) in basis.powers.iter().enumerate() {
            let power = |x: f64, k: usize| x.powi(k as i32);
            tractions[(row, column)] = power(point.x, p) * power(point.y, q) / point.bound;
            let by_x = if p > 0 { p as f64 * power(point.x, p - 1) * power(point.y, q) } else { 0.0 };
            let by_y = if q > 0 { q as f64 * power(point.x, p) * power(point.y, q - 1) } else { 0.0 };
            gradients[(row, column)] = cos * by_x / a + sin * by_y / b;
        }
    }
    [tractions, gradients]
}

impl Kalker {
    /// Prepares the problem of a patch for polynomials of a degree (1 to 7; 3 serves most, 5 is accurate).
    ///
    /// # Errors
    /// If patch or degree are out of range.
    pub fn new(patch: Patch, degree: usize) -> Result<Self, KalkerError> {
        if !(1..=7).contains(&degree) {
            return Err(KalkerError::Degree(degree));
        }
        let theory = LoadDisplacement::new(degree);
        let basis = theory.basis();
        let n = basis.len();
        // Spin needs a quadratic; what a lower degree cannot hold of the start is dropped.
        let start = LoadDisplacement::new(degree.max(2));
        let tractions = adhesion_tractions(&patch, &start)?;
        let mut adhesion = DMatrix::zeros(2 * n, 3);
        adhesion.rows_mut(0, n).copy_from(&tractions.rows(0, n));
        adhesion.rows_mut(n, n).copy_from(&tractions.rows(start.basis().len(), n));
        let stiffness = theory.matrix(&patch);
        let points = quadrature(degree + 2, 3 * degree + 8);
        let rows = points.len();
        let [values, gradients] = fields_of_monomials(&patch, basis, &points);
        let mut slips = DMatrix::zeros(2 * rows, 2 * n);
        slips.rows_mut(0, rows).copy_from(&(&gradients * stiffness.rows(0, n)));
        slips.rows_mut(rows, rows).copy_from(&(&gradients * stiffness.rows(n, n)));
        let slip_columns = DMatrix::from_fn(2 * n, 2 * rows, |k, i| slips[(i / 2 + rows * (i % 2), k)]);
        // As many rows as coefficients have the same sum of squares as one for every point of the edge.
        let edge = (leading_edge(&patch, basis) * EDGE_WEIGHT).qr().r();
        let edge_square = edge.transpose() * &edge;
        let slip_square = |weight: fn(&Point) -> f64| {
            let weights: Vec<f64> = points.iter().map(weight).collect();
            let weighted = DMatrix::from_fn(2 * rows, 2 * n, |i, k| slips[(i, k)] * weights[i % rows]);
            slips.transpose() * weighted
        };
        let slip_squares = [slip_square(|point| point.weight), slip_square(Point::weight_at_rest)];
        let resultants = resultants(&patch, basis) * (1.5 / PI);
        let response = &resultants * &adhesion;
        let response = (0.5 * response.view((0, 0), (2, 2)).norm_squared()).sqrt();
        Ok(Self {
            patch,
            points,
            monomial_values: values.transpose(),
            slips,
            slip_columns,
            slip_squares,
            edge_square,
            edge,
            adhesion,
            resultants,
            response,
            monomials: n,
        })
    }

    /// Number of coefficients of a solution.
    pub fn coefficients(&self) -> usize {
        2 * self.monomials
    }

    /// Rigid slip at a point.
    pub(super) fn rigid(&self, h: &ScaledCreepage, point: &Point) -> [f64; 2] {
        let (a, b) = (self.patch.axis_ratio.sqrt(), 1.0 / self.patch.axis_ratio.sqrt());
        let y = b * point.y;
        [h.x - (h.spin + h.curvature * y) * y, h.y + h.spin * a * point.x]
    }
}
