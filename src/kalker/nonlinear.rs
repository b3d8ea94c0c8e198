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
//! exactly where Coulomb's law holds (stick: s = 0 and |f| below the bound; slip: f at the bound along s). A penalty on
//! the singular traction at the leading edge takes the place of the condition that fresh material enters unstrained.
//! Minimised by Levenberg-Marquardt from the linear solution, or from a neighbouring one.

use std::f64::consts::{PI, TAU};

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use thiserror::Error;

use super::linear::{LinearError, adhesion_tractions, leading_edge, resultants};
use super::load_displacement::{Basis, load_displacement};
use super::objective::{Expansion, Fields, norm, project};
use super::{Patch, ScaledCreepage, ScaledForces};

/// [-] slip against traction in the projection.
pub(super) const SLIP_WEIGHT: f64 = 2.0;
/// [-] weight of the leading-edge rows.
const EDGE_WEIGHT: f64 = 8.0;
/// Iterations of one solve; 6 to 10 are usual.
const MAX_ITERATIONS: u32 = 200;
/// [-] relative decrease of the objective, promised or reached by Newton's step, that ends the iteration with it.
const DECREASE: f64 = 1e-11;
/// [-] share of that decrease below which Newton's step may take the matrix of the step before: a promise of 1e-13 of the
/// objective is a step of 3e-7 of the solution, of which an old matrix gets a small part wrong.
const NEARLY_NOTHING: f64 = 1e-2;
/// [-] objective over the square of creepages (up to sliding) at which Coulomb's law holds to twelve digits of traction.
const NEGLIGIBLE: f64 = 1e-24;
/// [-] relative decrease that is enough after `PATIENCE` iterations.
const IDLE_DECREASE: f64 = 1e-7;
const PATIENCE: u32 = 30;
/// [-] scaled creepage beyond which a contact slides as a whole, to within this number's inverse; larger ones are
/// scaled back to it.
const LARGEST_CREEPAGE: f64 = 1e5;

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
    /// Traction polynomials at the points: one row a point, one column a monomial.
    pub(super) values: DMatrix<f64>,
    /// The same, one column a point.
    pub(super) monomial_values: DMatrix<f64>,
    /// Slip at the points by all coefficients: rows x of each point, then y.
    pub(super) slips: DMatrix<f64>,
    /// Arguments of the projection at the points by all coefficients: one column each of x and y.
    pub(super) arguments: DMatrix<f64>,
    /// Leading-edge rows, and their square.
    pub(super) edge: DMatrix<f64>,
    pub(super) edge_square: DMatrix<f64>,
    /// Second derivative of the objective while every point sticks.
    pub(super) stick_curvature: DMatrix<f64>,
    /// Linear solutions of unit creepages.
    adhesion: DMatrix<f64>,
    /// Net forces over mu Q, mu Q c and mu Q c^2 by all coefficients.
    resultants: DMatrix<f64>,
    pub(super) monomials: usize,
}

/// The solution at one creepage.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Coefficients of the traction polynomials over mu p0: x components, then y.
    pub coefficients: DVector<f64>,
    /// Net forces; never above 1.
    pub forces: ScaledForces,
    /// [-] adhesion area over contact area.
    pub stick: f64,
    /// Iterations spent.
    pub iterations: u32,
}

/// Local state at a point of the grid, for pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalState {
    /// [-] X = x/a, Y = y/b.
    pub place: [f64; 2],
    /// [-] traction over mu p0, within the Coulomb bound.
    pub traction: [f64; 2],
    /// [-] slip velocity over V, times G/(mu p0).
    pub slip: [f64; 2],
    /// [-] Coulomb bound over mu p0.
    pub bound: f64,
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

impl Kalker {
    /// Prepares the problem of a patch for polynomials of a degree (1 to 7; 3 serves most, 5 is accurate).
    ///
    /// # Errors
    /// If patch or degree are out of range.
    pub fn new(patch: Patch, degree: usize) -> Result<Self, KalkerError> {
        if !(1..=7).contains(&degree) {
            return Err(KalkerError::Degree(degree));
        }
        let basis = Basis::new(degree);
        let n = basis.len();
        // Spin needs a quadratic; what a lower degree cannot hold of the start is dropped.
        let start_basis = Basis::new(degree.max(2));
        let tractions = adhesion_tractions(&patch, &start_basis)?;
        let mut adhesion = DMatrix::zeros(2 * n, 3);
        adhesion.rows_mut(0, n).copy_from(&tractions.rows(0, n));
        adhesion.rows_mut(n, n).copy_from(&tractions.rows(start_basis.len(), n));
        let stiffness = load_displacement(&patch, &basis);
        let (radial, angular) = (degree + 2, 3 * degree + 8);
        let mut points = Vec::with_capacity(radial * angular);
        for (square, share) in gauss_legendre(radial) {
            for k in 0..angular {
                let (sin, cos) = (TAU * (k as f64 + 0.5) / angular as f64).sin_cos();
                let r = square.sqrt();
                let weight = share * PI / angular as f64;
                points.push(Point { x: r * cos, y: r * sin, weight, bound: (1.0 - square).sqrt() });
            }
        }
        // A quadrature that gives the whole contact's sliding force exactly.
        let sum: f64 = points.iter().map(|p| p.weight * p.bound).sum();
        for point in &mut points {
            point.weight *= TAU / 3.0 / sum;
        }

        let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
        let (sin, cos) = patch.rolling_angle.sin_cos();
        let rows = points.len();
        let mut values = DMatrix::zeros(rows, n);
        let mut gradients = DMatrix::zeros(rows, n);
        for (row, point) in points.iter().enumerate() {
            for (column, &(p, q)) in basis.powers.iter().enumerate() {
                let power = |x: f64, k: usize| x.powi(k as i32);
                values[(row, column)] = power(point.x, p) * power(point.y, q) / point.bound;
                // derivative along rolling of the displacement monomial
                let by_x = if p > 0 { p as f64 * power(point.x, p - 1) * power(point.y, q) } else { 0.0 };
                let by_y = if q > 0 { q as f64 * power(point.x, p) * power(point.y, q - 1) } else { 0.0 };
                gradients[(row, column)] = cos * by_x / a + sin * by_y / b;
            }
        }
        let mut slips = DMatrix::zeros(2 * rows, 2 * n);
        slips.rows_mut(0, rows).copy_from(&(&gradients * stiffness.rows(0, n)));
        slips.rows_mut(rows, rows).copy_from(&(&gradients * stiffness.rows(n, n)));
        let mut arguments =
            SLIP_WEIGHT * DMatrix::from_fn(2 * n, 2 * rows, |k, i| slips[(i / 2 + rows * (i % 2), k)]);
        for i in 0..rows {
            for k in 0..n {
                arguments[(k, 2 * i)] += values[(i, k)];
                arguments[(n + k, 2 * i + 1)] += values[(i, k)];
            }
        }
        // As many rows as coefficients have the same sum of squares as one for every point of the edge.
        let edge = (leading_edge(&patch, &basis) * EDGE_WEIGHT).qr().r();
        let edge_square = edge.transpose() * &edge;
        let slip_square = {
            let weighted = DMatrix::from_fn(2 * rows, 2 * n, |i, k| slips[(i, k)] * points[i % rows].weight);
            slips.transpose() * weighted
        };
        Ok(Self {
            patch,
            points,
            monomial_values: values.transpose(),
            values,
            slips,
            arguments,
            stick_curvature: &edge_square + slip_square * (SLIP_WEIGHT * SLIP_WEIGHT),
            edge_square,
            edge,
            adhesion,
            resultants: resultants(&patch, &basis) * (1.5 / PI),
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

    /// Traction and slip at every point.
    pub(super) fn fields(&self, z: &DVector<f64>, h: &ScaledCreepage) -> Vec<([f64; 2], [f64; 2])> {
        let n = self.monomials;
        let (fx, fy) = (&self.values * z.rows(0, n), &self.values * z.rows(n, n));
        let elastic = &self.slips * z;
        let rows = self.points.len();
        self.points
            .iter()
            .enumerate()
            .map(|(i, point)| {
                let rigid = self.rigid(h, point);
                ([fx[i], fy[i]], [rigid[0] + elastic[i], rigid[1] + elastic[rows + i]])
            })
            .collect()
    }

    /// Solves for creepages, from the linear solution or from the coefficients of neighbouring creepages.
    ///
    /// # Errors
    /// See [`KalkerError`]; for every finite creepage there is a result or an error, never a NaN.
    pub fn solve(&self, creepage: &ScaledCreepage, start: Option<&[f64]>) -> Result<Solution, KalkerError> {
        let components = [creepage.x, creepage.y, creepage.spin, creepage.curvature];
        if !components.iter().all(|component| component.is_finite()) {
            return Err(KalkerError::NotFinite(*creepage));
        }
        let size = components.iter().fold(0.0f64, |size, component| size.max(component.abs()));
        let shrink = if size > LARGEST_CREEPAGE { LARGEST_CREEPAGE / size } else { 1.0 };
        let [x, y, spin, curvature] = components.map(|component| component * shrink);
        let h = ScaledCreepage { x, y, spin, curvature };
        // A start of another problem, or none at all, is no start.
        let usable =
            |start: &&[f64]| start.len() == self.coefficients() && start.iter().all(|z| z.is_finite());
        let mut z = match start.filter(usable) {
            Some(start) => DVector::from_column_slice(start),
            None => {
                // The linear solution, brought down where it is far above the bound.
                // The curvature slip at its mean over the pressure: y^2 = b^2/5.
                let mean = h.x - h.curvature / (5.0 * self.patch.axis_ratio);
                let linear = &self.adhesion * DVector::from_column_slice(&[mean, h.y, h.spin]);
                let excess = linear.amax();
                linear * if excess > 1.0 { 1.0 / excess } else { 1.0 }
            }
        };
        let mut fields = self.fields_at(&z, &h);
        let mut objective = self.objective(&z, &fields);
        let mut damping: f64 = 1e-3;
        let mut iterations = 0;
        // Factorised second derivative of the last Newton step.
        let mut factor: Option<Cholesky<f64, Dyn>> = None;
        while iterations < MAX_ITERATIONS {
            let Expansion { gradient, sliding } = self.expand(&z, &fields);
            let promise = |step: &DVector<f64>| 0.5 * gradient.dot(step);
            let before = objective;
            let enough = DECREASE * before + NEGLIGIBLE * size.min(1.0).powi(2);
            iterations += 1;
            // Newton's own step where the objective is convex: it ends the iteration at the minimum to rounding, so
            // that results are a smooth function of the creepages.
            // Where nearly nothing is left, the last step's matrix serves.
            let rest = factor.take().map(|factor| factor.solve(&gradient));
            let step = rest.filter(|step| promise(step) <= NEARLY_NOTHING * enough).or_else(|| {
                factor = self.curvature(&sliding, true).cholesky();
                factor.as_ref().map(|factor| factor.solve(&gradient))
            });
            if let Some(step) = step {
                // What the step still promises; below this, rounding decides whether the objective falls.
                let last = promise(&step) <= enough;
                let trial = &z - step;
                let there = self.fields_at(&trial, &h);
                let reached = self.objective(&trial, &there);
                if last {
                    let better = reached <= objective + enough;
                    let (z, fields) = if better { (trial, there) } else { (z, fields) };
                    return Ok(self.finish(z, &fields, iterations));
                }
                if reached < objective {
                    (z, fields, objective) = (trial, there, reached);
                    damping = (damping * 0.1).max(1e-12);
                    if before - objective <= enough {
                        return Ok(self.finish(z, &fields, iterations));
                    }
                    continue;
                }
            }
            factor = None;
            let gauss_newton = self.curvature(&sliding, false);
            loop {
                let mut damped = gauss_newton.clone();
                for i in 0..damped.nrows() {
                    damped[(i, i)] += damping * (gauss_newton[(i, i)] + 1e-12);
                }
                let trial = damped.cholesky().map(|factor| {
                    let trial = &z - factor.solve(&gradient);
                    let there = self.fields_at(&trial, &h);
                    (self.objective(&trial, &there), trial, there)
                });
                if let Some((reached, trial, there)) = trial
                    && reached < objective
                {
                    (z, fields, objective) = (trial, there, reached);
                    damping = (damping * 0.1).max(1e-12);
                    break;
                }
                damping *= 10.0;
                iterations += 1;
                if damping > 1e12 {
                    // No direction leads down: this is the minimum to rounding.
                    return Ok(self.finish(z, &fields, iterations));
                }
                if iterations >= MAX_ITERATIONS {
                    return Err(KalkerError::NoConvergence(*creepage));
                }
            }
            // Where points change between sticking and sliding for ever, the last digits are not worth more steps.
            if iterations > PATIENCE && before - objective <= IDLE_DECREASE * before {
                return Ok(self.finish(z, &fields, iterations));
            }
        }
        Err(KalkerError::NoConvergence(*creepage))
    }

    pub(super) fn finish(&self, z: DVector<f64>, fields: &Fields, iterations: u32) -> Solution {
        let net = &self.resultants * &z;
        let mut forces = ScaledForces { fx: net[0], fy: net[1], mz: net[2], second_moment: net[3] };
        // A polynomial may overstep the bound by its own error: a sliding contact stays at the friction limit.
        let size = forces.fx.hypot(forces.fy);
        if size > 1.0 {
            forces.fx /= size * (1.0 + f64::EPSILON);
            forces.fy /= size * (1.0 + f64::EPSILON);
        }
        let (mut stick, mut area) = (0.0, 0.0);
        let v = &fields.arguments;
        for (i, point) in self.points.iter().enumerate() {
            area += point.weight;
            if norm([v[2 * i], v[2 * i + 1]]) <= point.bound {
                stick += point.weight;
            }
        }
        Solution { coefficients: z, forces, stick: stick / area, iterations }
    }

    /// Derivatives of the forces (fx, fy, mz, second moment) by the scaled creepages (x, y, spin, curvature).
    ///
    /// By implicit differentiation of the minimum: where its gradient stays zero, the coefficients follow.
    /// None where the minimum is not isolated.
    pub fn derivatives(&self, solution: &Solution, creepage: &ScaledCreepage) -> Option<[[f64; 4]; 4]> {
        let z = &solution.coefficients;
        let Expansion { sliding, .. } = self.expand(z, &self.fields_at(z, creepage));
        let follow = self.curvature(&sliding, true).lu().solve(&-self.by_creepage(&sliding))?;
        let net = &self.resultants * follow;
        Some(std::array::from_fn(|i| std::array::from_fn(|k| net[(i, k)])))
    }

    /// Traction and slip at the points of the grid.
    pub fn local_states(&self, solution: &Solution, creepage: &ScaledCreepage) -> Vec<LocalState> {
        self.points
            .iter()
            .zip(self.fields(&solution.coefficients, creepage))
            .map(|(point, (f, slip))| LocalState {
                place: [point.x, point.y],
                traction: project(f, point.bound).0,
                slip,
                bound: point.bound,
            })
            .collect()
    }
}
