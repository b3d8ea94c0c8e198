//! Kalker's linear theory, solved: full adhesion over the ellipse, for rolling in any direction.
//!
//! Without slip the elastic displacement must undo the rigid slip, `du/dr = -(c_x - phi y, c_y + phi x)` along the
//! rolling direction r (paper eq. 11). That leaves a polynomial in the transverse coordinate free, as in Kalker (1967)
//! chosen such that the singular traction at the leading edge is least.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use nalgebra::{DMatrix, Matrix3};

use super::creep_coefficients::along_x;
use super::load_displacement::{Basis, LoadDisplacement, disc_moment};
use super::patch::{LinearError, Patch};
use crate::numerics::elliptic::complete_elliptic_integrals;

/// Degree of the polynomials: odd ones converge faster. Coefficients are within 0.3 % of higher degrees from axis
/// ratio 0.02 to 50 (tested).
const DEGREE: usize = 9;
/// Points on the edge of the ellipse.
const EDGE_POINTS: usize = 96;

/// A polynomial of the basis as its coefficients.
type Polynomial = Vec<f64>;

/// Product of a polynomial with `alpha X + beta Y`.
fn times_line(basis: &Basis, polynomial: &[f64], alpha: f64, beta: f64) -> Polynomial {
    let mut product = vec![0.0; basis.len()];
    for (&(p, q), &coefficient) in basis.powers.iter().zip(polynomial) {
        if coefficient != 0.0 {
            product[basis.index(p + 1, q)] += alpha * coefficient;
            product[basis.index(p, q + 1)] += beta * coefficient;
        }
    }
    product
}

/// Displacement polynomials, column by column: those that undo the rigid slips of unit creepages c_x, c_y and spin phi, then
/// those that do not change along rolling.
fn displacements(patch: &Patch, basis: &Basis) -> DMatrix<f64> {
    let n = basis.len();
    let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
    let (sin, cos) = patch.rolling_angle.sin_cos();

    // polynomials of xi (along rolling) and eta (transverse)
    let one = {
        let mut one = vec![0.0; n];
        one[0] = 1.0;
        one
    };
    let along = |polynomial: &[f64]| times_line(basis, polynomial, a * cos, b * sin);
    let across = |polynomial: &[f64]| times_line(basis, polynomial, -a * sin, b * cos);
    let combine = |x: &[f64], p: f64, y: &[f64], q: f64| -> Polynomial {
        x.iter().zip(y).map(|(x, y)| p * x + q * y).collect()
    };
    let xi = along(&one);
    let (half_square, cross) = (combine(&along(&xi), 0.5, &xi, 0.0), across(&xi));
    // integrals along rolling of y = xi sin + eta cos and of x = xi cos - eta sin
    let integral_y = combine(&half_square, sin, &cross, cos);
    let integral_x = combine(&half_square, cos, &cross, -sin);

    let mut displacements = DMatrix::zeros(2 * n, 3 + 2 * (basis.degree + 1));
    let mut set = |column: usize, row: usize, polynomial: &[f64], factor: f64| {
        for (i, value) in polynomial.iter().enumerate() {
            displacements[(row + i, column)] = factor * value;
        }
    };
    set(0, 0, &xi, -1.0);
    set(1, n, &xi, -1.0);
    set(2, 0, &integral_y, 1.0);
    set(2, n, &integral_x, -1.0);
    let mut power = one;
    for k in 0..=basis.degree {
        set(3 + 2 * k, 0, &power, 1.0);
        set(4 + 2 * k, n, &power, 1.0);
        if k < basis.degree {
            power = across(&power);
        }
    }
    displacements
}

/// Traction polynomials (x components, then y) over G of unit creepages c_x, c_y and spin phi (times c): three columns.
///
/// # Errors
/// See [`LinearError`].
pub fn adhesion_tractions(patch: &Patch, theory: &LoadDisplacement) -> Result<DMatrix<f64>, LinearError> {
    patch.check()?;
    let basis = theory.basis();
    let n = basis.len();
    // tractions of all of them, and the singular traction on the leading edge
    let tractions =
        theory.tractions(patch, &displacements(patch, basis)).ok_or(LinearError::Singular(*patch))?;
    let rows = leading_edge_rows(patch, basis);
    let mut edge = DMatrix::zeros(2 * rows.nrows(), tractions.ncols());
    for component in 0..2 {
        let part = &rows * tractions.rows(component * n, n);
        edge.rows_mut(component * rows.nrows(), rows.nrows()).copy_from(&part);
    }
    let (mut right, free) = (-edge.columns(0, 3), edge.columns(3, edge.ncols() - 3).into_owned());
    // Least squares; over the range of patches the condition number of the free polynomials stays below 1e8.
    let factors = free.qr();
    factors.q_tr_mul(&mut right);
    let count = edge.ncols() - 3;
    let amounts =
        factors.r().solve_upper_triangular(&right.rows(0, count)).ok_or(LinearError::Singular(*patch))?;
    Ok(tractions.columns(0, 3) + tractions.columns(3, amounts.nrows()) * amounts)
}

/// Rows that give one component `sum d X^p Y^q` of the singular traction on the leading edge, weighted by the cosine between
/// the edge's normal and the rolling direction.
fn leading_edge_rows(patch: &Patch, basis: &Basis) -> DMatrix<f64> {
    let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
    let (sin, cos) = patch.rolling_angle.sin_cos();
    let places: Vec<[f64; 3]> = (0..EDGE_POINTS)
        .filter_map(|point| {
            let (y, x) = (TAU * (point as f64 + 0.5) / EDGE_POINTS as f64).sin_cos();
            let normal = (x / a, y / b);
            let facing = (normal.0 * cos + normal.1 * sin) / normal.0.hypot(normal.1);
            (facing > 0.0).then_some([x, y, (facing / EDGE_POINTS as f64).sqrt()])
        })
        .collect();
    DMatrix::from_fn(places.len(), basis.len(), |i, k| {
        let ([x, y, weight], (p, q)) = (places[i], basis.powers[k]);
        weight * x.powi(p as i32) * y.powi(q as i32)
    })
}

/// Rows that give the singular traction (x, then y) on the leading edge, see [`adhesion_tractions`].
pub fn leading_edge(patch: &Patch, basis: &Basis) -> DMatrix<f64> {
    let (part, n) = (leading_edge_rows(patch, basis), basis.len());
    let mut rows = DMatrix::zeros(2 * part.nrows(), 2 * n);
    for component in 0..2 {
        rows.view_mut((component * part.nrows(), component * n), part.shape()).copy_from(&part);
    }
    rows
}

/// Rows of net force x, y, moment z and second moment `y^2 f_x` (over `G c^2`, `G c^3`, `G c^4`) by traction
/// polynomials.
pub fn resultants(patch: &Patch, basis: &Basis) -> DMatrix<f64> {
    let n = basis.len();
    let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
    let mut rows = DMatrix::zeros(4, 2 * n);
    for (i, &(p, q)) in basis.powers.iter().enumerate() {
        rows[(0, i)] = disc_moment(p, q);
        rows[(1, n + i)] = disc_moment(p, q);
        rows[(2, i)] = -b * disc_moment(p, q + 1);
        rows[(2, n + i)] = a * disc_moment(p + 1, q);
        rows[(3, i)] = b * b * disc_moment(p, q + 2);
    }
    rows
}

/// Creep coefficients of rolling in any direction: `(F_x/(G c^2), F_y/(G c^2), M_z/(G c^3))` by
/// `(c_x, c_y, c phi)`, components along the ellipse axes. For rolling along x it is
/// `[[C11, 0, 0], [0, C22, C23], [0, C32, C33]]` (paper eq. 14).
///
/// # Errors
/// See [`LinearError`].
pub fn creep_matrix(patch: &Patch) -> Result<Matrix3<f64>, LinearError> {
    static THEORY: LazyLock<LoadDisplacement> = LazyLock::new(|| LoadDisplacement::new(DEGREE));
    let tractions = adhesion_tractions(patch, &THEORY)?;
    let matrix = resultants(patch, THEORY.basis()) * tractions;
    Ok(Matrix3::from_fn(|i, k| matrix[(i, k)]))
}

/// Linear theory of a patch as nonlinear laws need it: coefficients times 3/(2 pi), and the largest spin moment over
/// mu Q c.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    /// [-] `3 C11/(2 pi)`: longitudinal force over mu Q by scaled creepage.
    pub c11: f64,
    /// [-] `3 C22/(2 pi)`: lateral force over mu Q by scaled creepage.
    pub c22: f64,
    /// [-] `3 C23/(2 pi)`: lateral force over mu Q by scaled spin.
    pub c23: f64,
    /// [-] `3 C33/(2 pi)`: spin moment over mu Q c by scaled spin.
    pub c33: f64,
    /// [-] spin moment of complete sliding over mu Q c.
    pub moment: f64,
}

impl Scales {
    /// Linear theory of a patch as it rolls along the x axis of its ellipse.
    ///
    /// # Errors
    /// See [`LinearError`].
    pub fn new(patch: &Patch) -> Result<Self, LinearError> {
        let [c11, c22, c23, c33] = along_x(patch)?.map(|coefficient| coefficient * (1.5 / PI));
        let slender = patch.axis_ratio.min(1.0 / patch.axis_ratio);
        let (_, second) = complete_elliptic_integrals(1.0 - slender * slender);
        let moment = 0.375 * second / slender.sqrt();
        Ok(Self { c11, c22, c23, c33, moment })
    }
}
