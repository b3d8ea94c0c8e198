//! The objective of Kalker's nonlinear problem in polynomials, and its derivatives.

use nalgebra::{DMatrix, DMatrixView, DVector, Dyn, MatrixView};

use super::ScaledCreepage;
use super::nonlinear::{Kalker, Point};
use super::objective_weights::Weights;
use crate::numerics::lanes::WIDTH;

/// Tractions and arguments of the projection at every point, components x and y in turn.
pub(super) struct Fields {
    pub(super) tractions: DVector<f64>,
    pub(super) arguments: DVector<f64>,
}

/// A point that slides, and what the projection does there.
pub(super) struct Sliding {
    point: usize,
    /// Slope of the projection (symmetric: xx, xy, yy).
    slope: [f64; 3],
    /// Second derivative of the projection, times the weighted residual (symmetric: xx, xy, yy).
    bend: [f64; 3],
}

/// Sliding points that are taken together: their columns fit a processor's first cache.
const TOGETHER: usize = 32;

/// First derivatives of the objective, and what the second ones follow from.
pub(super) struct Expansion {
    pub(super) gradient: DVector<f64>,
    pub(super) sliding: Vec<Sliding>,
    /// Half the objective's derivatives by the arguments of the projection, at their places.
    by_argument: DVector<f64>,
}

/// Length of a vector whose components are far from overflow.
pub(super) fn norm([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// Square of a symmetric matrix (xx, xy, yy).
fn square([xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    [xx * xx + xy * xy, xy * (xx + yy), xy * xy + yy * yy]
}

/// Product of a symmetric matrix (xx, xy, yy) with a vector.
fn times([xx, xy, yy]: [f64; 3], [x, y]: [f64; 2]) -> [f64; 2] {
    [xx * x + xy * y, xy * x + yy * y]
}

/// A column as a slice.
fn column(matrix: &DMatrix<f64>, index: usize) -> &[f64] {
    &matrix.as_slice()[index * matrix.nrows()..(index + 1) * matrix.nrows()]
}

/// Product of every column with a vector.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn products(matrix: &DMatrix<f64>, vector: &[f64], results: &mut [f64]) {
    for (result, column) in results.iter_mut().zip(matrix.as_slice().chunks_exact(vector.len())) {
        let mut sums = [0.0; WIDTH];
        let (quads, ends) = (column.chunks_exact(WIDTH), vector.chunks_exact(WIDTH));
        let rest = quads.remainder().iter().zip(ends.remainder()).map(|(a, b)| a * b).sum::<f64>();
        for (a, b) in quads.zip(ends) {
            for lane in 0..WIDTH {
                sums[lane] += a[lane] * b[lane];
            }
        }
        *result = (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest;
    }
}

/// Adds every column times its factor.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn add_columns(sum: &mut [f64], matrix: &DMatrix<f64>, factors: &[f64]) {
    for (column, factor) in matrix.as_slice().chunks_exact(sum.len()).zip(factors) {
        for (entry, value) in sum.iter_mut().zip(column) {
            *entry += factor * value;
        }
    }
}

/// `result = by_a a + by_b b`.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn combine(result: &mut [f64], by_a: f64, a: &[f64], by_b: f64, b: &[f64]) {
    for ((entry, a), b) in result.iter_mut().zip(a).zip(b) {
        *entry = by_a * a + by_b * b;
    }
}

/// Second derivative of `w P(v)` with the projection P on the disc of radius `bound` (symmetric: xx, xy, yy).
fn projection_bend(v: [f64; 2], bound: f64, w: [f64; 2]) -> [f64; 3] {
    let size = norm(v);
    if size <= bound {
        return [0.0; 3];
    }
    let (c, s) = (v[0] / size, v[1] / size);
    let along = w[0] * c + w[1] * s;
    let factor = bound / (size * size);
    [
        factor * (3.0 * along * c * c - along - 2.0 * w[0] * c),
        factor * (3.0 * along * c * s - w[0] * s - w[1] * c),
        factor * (3.0 * along * s * s - along - 2.0 * w[1] * s),
    ]
}

/// Projection of v on the disc of radius `bound`, and its derivative (symmetric: xx, xy, yy).
pub(super) fn project(v: [f64; 2], bound: f64) -> ([f64; 2], [f64; 3]) {
    let size = norm(v);
    if size <= bound {
        return (v, [1.0, 0.0, 1.0]);
    }
    let (c, s, ratio) = (v[0] / size, v[1] / size, bound / size);
    ([bound * c, bound * s], [ratio * s * s, -ratio * c * s, ratio * c * c])
}

/// The objective at some creepages, with the weights that these have.
#[derive(Clone, Debug)]
pub(super) struct Objective<'a> {
    pub(super) kalker: &'a Kalker,
    creepage: ScaledCreepage,
    weights: Weights,
    /// Weights of the points, and their derivatives by the share of those at rest.
    points: Vec<(f64, f64)>,
    /// Arguments of the projection at the points by all coefficients: one column each of x and y.
    arguments: DMatrix<f64>,
    /// Half the second derivative while every point sticks.
    stick_curvature: DMatrix<f64>,
}

impl<'a> Objective<'a> {
    pub(super) fn new(kalker: &'a Kalker, creepage: &ScaledCreepage) -> Self {
        let weights = Weights::new(kalker, creepage);
        let n = kalker.monomials;
        let mut arguments = &kalker.slip_columns * weights.slip;
        for (i, mut column) in arguments.column_iter_mut().enumerate() {
            let mut component = column.rows_mut(n * (i % 2), n);
            component += kalker.monomial_values.column(i / 2);
        }
        let [areas, at_rest] = &kalker.slip_squares;
        let slip_square = weights.slip * weights.slip;
        let stick_curvature = &kalker.edge_square
            + areas * (slip_square * (1.0 - weights.rest))
            + at_rest * (slip_square * weights.rest);
        let points = kalker.points.iter().map(|point| weights.of(point)).collect();
        Self { kalker, creepage: *creepage, weights, points, arguments, stick_curvature }
    }

    /// Fields at coefficients z.
    pub(super) fn fields_at(&self, z: &DVector<f64>) -> Fields {
        let (n, rows) = (self.kalker.monomials, self.kalker.points.len());
        let mut tractions = DVector::zeros(2 * rows);
        let mut component = vec![0.0; rows];
        for (k, z) in z.as_slice().chunks_exact(n).enumerate() {
            products(&self.kalker.monomial_values, z, &mut component);
            for (i, value) in component.iter().enumerate() {
                tractions[2 * i + k] = *value;
            }
        }
        let mut arguments = DVector::zeros(2 * rows);
        products(&self.arguments, z.as_slice(), arguments.as_mut_slice());
        for (i, point) in self.kalker.points.iter().enumerate() {
            let rigid = self.kalker.rigid(&self.creepage, point);
            arguments[2 * i] += self.weights.slip * rigid[0];
            arguments[2 * i + 1] += self.weights.slip * rigid[1];
        }
        Fields { tractions, arguments }
    }

    /// The objective at z, whose fields are given.
    pub(super) fn objective(&self, z: &DVector<f64>, fields: &Fields) -> f64 {
        let (f, v) = (&fields.tractions, &fields.arguments);
        let mut sum = (&self.kalker.edge * z).norm_squared();
        for (i, point) in self.kalker.points.iter().enumerate() {
            let (p, _) = project([v[2 * i], v[2 * i + 1]], point.bound);
            sum += self.points[i].0 * ((f[2 * i] - p[0]).powi(2) + (f[2 * i + 1] - p[1]).powi(2));
        }
        sum
    }

    /// Half the objective's gradient at z, whose fields are given.
    ///
    /// With values V and arguments A of a point's traction and slope S of the projection, the residual's derivative is
    /// `V - S A`.
    pub(super) fn expand(&self, z: &DVector<f64>, fields: &Fields) -> Expansion {
        let (n, rows) = (self.kalker.monomials, self.kalker.points.len());
        let (f, v) = (&fields.tractions, &fields.arguments);
        let mut by_value = [vec![0.0; rows], vec![0.0; rows]];
        let mut by_argument = DVector::zeros(2 * rows);
        let mut sliding = Vec::with_capacity(rows);
        for (i, point) in self.kalker.points.iter().enumerate() {
            let argument = [v[2 * i], v[2 * i + 1]];
            let (p, slope) = project(argument, point.bound);
            let residual = [f[2 * i] - p[0], f[2 * i + 1] - p[1]];
            let seen = times(slope, residual);
            for k in 0..2 {
                by_value[k][i] = self.points[i].0 * residual[k];
                by_argument[2 * i + k] = -self.points[i].0 * seen[k];
            }
            if norm(argument) > point.bound {
                // second derivative of -residual P(argument)
                let bend = projection_bend(argument, point.bound, residual).map(|b| -self.points[i].0 * b);
                sliding.push(Sliding { point: i, slope, bend });
            }
        }
        let mut gradient = &self.kalker.edge_square * z;
        add_columns(gradient.as_mut_slice(), &self.arguments, by_argument.as_slice());
        for (part, by_value) in gradient.as_mut_slice().chunks_exact_mut(n).zip(&by_value) {
            add_columns(part, &self.kalker.monomial_values, by_value);
        }
        Expansion { gradient, sliding, by_argument }
    }

    /// Half the objective's second derivative; without the bend of the projection as Gauss and Newton take it, which is
    /// positive definite.
    ///
    /// Only what sliding points change is computed, w the weight of a point and I the slope while it sticks:
    /// `A^T (w (S^2 - I) + bend) A - w (V^T (S - I) A + its transpose)`.
    pub(super) fn curvature(&self, sliding: &[Sliding], with_bend: bool) -> DMatrix<f64> {
        let n = self.kalker.monomials;
        let rows = 2 * n;
        let mut curvature = DMatrix::zeros(rows, rows);
        let mut arguments = Vec::with_capacity(2 * TOGETHER * rows);
        let mut changes = Vec::with_capacity(2 * TOGETHER * rows);
        for sliding in sliding.chunks(TOGETHER) {
            arguments.clear();
            changes.clear();
            for Sliding { point, slope, bend } in sliding {
                let weight = self.points[*point].0;
                let values = column(&self.kalker.monomial_values, *point);
                let own = [0, 1].map(|k| column(&self.arguments, 2 * point + k));
                let mut outer = square(*slope);
                let mut change = *slope;
                for (k, stick) in [1.0, 0.0, 1.0].into_iter().enumerate() {
                    outer[k] = weight * (outer[k] - stick) + if with_bend { bend[k] } else { 0.0 };
                    change[k] = -2.0 * weight * (change[k] - stick);
                }
                for k in 0..2 {
                    arguments.extend_from_slice(own[k]);
                    let at = changes.len();
                    changes.resize(at + rows, 0.0);
                    let column = &mut changes[at..];
                    combine(column, outer[k], own[0], outer[k + 1], own[1]);
                    for (part, change) in column.chunks_exact_mut(n).zip([change[k], change[k + 1]]) {
                        for (entry, value) in part.iter_mut().zip(values) {
                            *entry += change * value;
                        }
                    }
                }
            }
            let width = 2 * sliding.len();
            let arguments = DMatrixView::from_slice(&arguments, rows, width);
            // the transpose, without a copy
            let ([width, rows], one) = ([width, rows].map(Dyn), Dyn(1));
            let changes = MatrixView::from_slice_with_strides_generic(&changes, width, rows, rows, one);
            curvature.gemm(0.5, &arguments, &changes, 1.0);
        }
        for i in 0..2 * n {
            for k in 0..=i {
                let sum = curvature[(i, k)] + curvature[(k, i)];
                curvature[(i, k)] = sum + self.stick_curvature[(i, k)];
                curvature[(k, i)] = curvature[(i, k)];
            }
        }
        curvature
    }

    /// Derivatives of half the objective's gradient by the creepages, through the slip and through the weights.
    pub(super) fn by_creepage(&self, fields: &Fields, expansion: &Expansion) -> DMatrix<f64> {
        let (n, rows) = (self.kalker.monomials, self.kalker.points.len());
        let (a, b) = (self.kalker.patch.axis_ratio.sqrt(), 1.0 / self.kalker.patch.axis_ratio.sqrt());
        let rigid = |point: &Point| {
            let (x, y) = (a * point.x, b * point.y);
            [[1.0, 0.0], [0.0, 1.0], [-y, x], [-y * y, 0.0]]
        };
        let mut projections = vec![([1.0, 0.0, 1.0], [0.0; 3]); rows];
        for Sliding { point, slope, bend } in &expansion.sliding {
            projections[*point] = (*slope, *bend);
        }
        let mut by_value = [DMatrix::zeros(rows, 4), DMatrix::zeros(rows, 4)];
        let mut by_argument = DMatrix::zeros(2 * rows, 4);
        let (f, v) = (&fields.tractions, &fields.arguments);
        let Weights { slip: slip_weight, slip_by_creepage, rest_by_creepage, .. } = self.weights;
        for (i, (point, (slope, bend))) in self.kalker.points.iter().zip(projections).enumerate() {
            let slip = [0, 1].map(|k| (v[2 * i + k] - f[2 * i + k]) / slip_weight);
            let (p, _) = project([v[2 * i], v[2 * i + 1]], point.bound);
            let residual = [0, 1].map(|k| f[2 * i + k] - p[k]);
            let residual_seen = times(slope, residual);
            let (weight, by_share) = self.points[i];
            for (column, rigid) in rigid(point).into_iter().enumerate() {
                let change = [0, 1].map(|k| slip_weight * rigid[k] + slip_by_creepage[column] * slip[k]);
                let (seen, bent) = (times(slope, change), times(bend, change));
                let twice = times(slope, seen);
                let heavier = by_share * rest_by_creepage[column];
                for k in 0..2 {
                    by_value[k][(i, column)] = heavier * residual[k] - weight * seen[k];
                    by_argument[(2 * i + k, column)] =
                        weight * twice[k] + bent[k] - heavier * residual_seen[k];
                }
            }
        }
        let mut result = &self.arguments * by_argument;
        for (k, by_value) in by_value.iter().enumerate() {
            result.rows_mut(k * n, n).gemm(1.0, &self.kalker.monomial_values, by_value, 1.0);
        }
        // The arguments' own derivatives by the coefficients grow with the weight of slip.
        let by_weight = &self.kalker.slip_columns * &expansion.by_argument;
        for (mut column, change) in result.column_iter_mut().zip(slip_by_creepage) {
            column.axpy(change, &by_weight, 1.0);
        }
        result
    }
}
