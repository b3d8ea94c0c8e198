//! Kalker's nonlinear theory as a smooth table, built from the half-space reference solver.
//!
//! Arguments are linear theory's forces without coupling over their limits, `q = (F_x/(mu Q), F_y/(mu Q), M_z/M_max)`
//! with `F_x = G c^2 C11 c_x`, `F_y = G c^2 C22 c_y`, `M_z = G c^4 C33 phi`; results are forces over mu Q and M_max. In
//! these, load, size and friction drop out and Poisson's ratio nearly does; the axis ratio is the table's fourth
//! axis, interpolated once per contact.
//!
//! On a ray `t = |q|/(1 + |q|)` runs from rest to complete sliding. With theta the angle from the x axis and phi the
//! angle from y towards z, what is stored is
//! `f_x/(t cos theta)`, `f_y/(t sin theta)`, `m_z/(t sin theta)`: smooth across rest, the poles and the planes of
//! symmetry. Interpolation is by cubic Hermite pieces in all three directions: continuous with its first derivatives.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

use super::half_space::{HalfSpace, HalfSpaceError, Tractions};
use super::linear::{LinearError, Scales};
use super::{Patch, ScaledCreepage};

/// Intervals from rest to sliding, from the x axis to the plane of y and spin, and of half a turn in that plane.
pub const SHAPE: [usize; 3] = [12, 8, 16];
/// Intervals of ln(axis ratio) from 0.05 to 20.
pub const RATIOS: usize = 12;
/// Poisson's ratio of the table.
pub const POISSON: f64 = 0.3;
/// Cells across the ellipse of the coarser grid.
const CELLS: usize = 16;
/// Creepage |q| that stands for complete sliding.
const SLIDING: f64 = 1e3;

/// The shipped table: `cargo run --release --example kalker_table` makes it.
const SHIPPED: &[u8] = include_bytes!("table.bin");

/// Nodes of one axis ratio.
pub const NODES: usize = (SHAPE[0] + 1) * (SHAPE[1] + 1) * SHAPE[2];

/// Axis ratio of a knot.
pub fn knot(index: usize) -> f64 {
    let (low, high) = (0.05f64.ln(), 20f64.ln());
    (low + (high - low) * index as f64 / RATIOS as f64).exp().clamp(0.05, 20.0)
}

/// Stored values of all nodes of one axis ratio, t slowest, phi fastest.
///
/// # Errors
/// If the reference solver has no answer at a node.
pub fn build(axis_ratio: f64) -> Result<Vec<[f64; 3]>, HalfSpaceError> {
    let patch = Patch { axis_ratio, poisson_ratio: POISSON, rolling_angle: 0.0 };
    let scales = Scales::new(&patch)?;
    let (coarse, fine) = (HalfSpace::new(&patch, CELLS)?, HalfSpace::new(&patch, 2 * CELLS)?);
    let mut nodes = vec![[0.0; 3]; NODES];
    let index = |i: usize, j: usize, k: usize| (i * (SHAPE[1] + 1) + j) * SHAPE[2] + k;
    for j in 0..=SHAPE[1] {
        for k in 0..SHAPE[2] {
            let theta = FRAC_PI_2 * j as f64 / SHAPE[1] as f64;
            let phi = PI * k as f64 / SHAPE[2] as f64;
            // On the axes and planes of symmetry what would be divided by zero has its limit: a little beside them.
            let aside = |angle: f64| angle.clamp(0.02, FRAC_PI_2 - 0.02);
            let theta = aside(theta);
            let direction = [theta.cos(), theta.sin() * phi.cos(), theta.sin() * phi.sin()];
            let mut starts: [Option<Tractions>; 2] = [None, None];
            for i in 0..=SHAPE[0] {
                let t = i as f64 / SHAPE[0] as f64;
                let coupling = scales.c23;
                let forces = if i == 0 {
                    // linear theory with its coupling, over t
                    let (hy, hz) = (direction[1] / scales.c22, direction[2] * scales.moment / scales.c33);
                    [direction[0], direction[1] + coupling * hz, direction[2] - coupling * hy / scales.moment]
                } else {
                    let r = if i == SHAPE[0] { SLIDING } else { t / (1.0 - t) };
                    let creepage = ScaledCreepage {
                        x: r * direction[0] / scales.c11,
                        y: r * direction[1] / scales.c22,
                        spin: r * direction[2] * scales.moment / scales.c33,
                        curvature: 0.0,
                    };
                    let solutions = [
                        coarse.solve(&creepage, starts[0].as_ref())?,
                        fine.solve(&creepage, starts[1].as_ref())?,
                    ];
                    let limit = |get: fn(&Tractions) -> f64| 2.0 * get(&solutions[1]) - get(&solutions[0]);
                    let values = [
                        limit(|s| s.forces.fx),
                        limit(|s| s.forces.fy),
                        limit(|s| s.forces.mz) / scales.moment,
                    ];
                    starts = solutions.map(Some);
                    values.map(|value| value / t)
                };
                nodes[index(i, j, k)] =
                    [forces[0] / theta.cos(), forces[1] / theta.sin(), forces[2] / theta.sin()];
            }
        }
    }
    Ok(nodes)
}

/// The table of one contact: one axis ratio, padded so that every stencil lies inside.
#[derive(Clone, Debug, PartialEq)]
pub struct CreepTable {
    nodes: Vec<[f64; 3]>,
    coupling: [f64; 2],
}

/// Padded sizes: one node more on each side in t and theta, one before and two behind in phi.
const PADDED: [usize; 3] = [SHAPE[0] + 3, SHAPE[1] + 3, SHAPE[2] + 3];

/// Weights and their slopes of the cubic Hermite piece with central differences at `u` in [0, 1].
#[inline(always)]
fn weights(u: f64) -> ([f64; 4], [f64; 4]) {
    let (u2, u3) = (u * u, u * u * u);
    (
        [
            0.5 * (-u3 + 2.0 * u2 - u),
            0.5 * (3.0 * u3 - 5.0 * u2 + 2.0),
            0.5 * (-3.0 * u3 + 4.0 * u2 + u),
            0.5 * (u3 - u2),
        ],
        [
            0.5 * (-3.0 * u2 + 4.0 * u - 1.0),
            0.5 * (9.0 * u2 - 10.0 * u),
            0.5 * (-9.0 * u2 + 8.0 * u + 1.0),
            0.5 * (3.0 * u2 - 2.0 * u),
        ],
    )
}

/// Piece and place in it of a coordinate in [0, count].
#[inline(always)]
fn locate(x: f64, count: usize) -> (usize, f64) {
    let piece = (x as usize).min(count - 1);
    (piece, x - piece as f64)
}

impl CreepTable {
    /// The table of a patch that rolls along an axis of its ellipse, from the shipped one.
    ///
    /// # Errors
    /// If the patch is out of range.
    pub fn new(patch: &Patch) -> Result<Self, LinearError> {
        static PARSED: OnceLock<Vec<f32>> = OnceLock::new();
        let values = PARSED.get_or_init(|| {
            SHIPPED
                .chunks_exact(4)
                .map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
                .collect()
        });
        let aligned = Patch { rolling_angle: 0.0, ..*patch };
        let scales = Scales::new(&aligned)?;
        // cubic in ln(axis ratio) between the knots
        let position = (patch.axis_ratio / 0.05).ln() / (20f64 / 0.05).ln() * RATIOS as f64;
        let (piece, u) = locate(position.clamp(0.0, RATIOS as f64), RATIOS);
        let (w, _) = weights(u);
        let mut nodes = vec![[0.0; 3]; NODES];
        for (offset, weight) in w.into_iter().enumerate() {
            let mut add = |knot: usize, weight: f64| {
                let slice = &values[knot * NODES * 3..(knot + 1) * NODES * 3];
                for (node, stored) in nodes.iter_mut().zip(slice.chunks_exact(3)) {
                    for (value, stored) in node.iter_mut().zip(stored) {
                        *value += weight * f64::from(*stored);
                    }
                }
            };
            // Beyond the ends the table goes on straight.
            match (piece + offset).checked_sub(1) {
                None => {
                    add(0, 2.0 * weight);
                    add(1, -weight);
                }
                Some(knot) if knot > RATIOS => {
                    add(RATIOS, 2.0 * weight);
                    add(RATIOS - 1, -weight);
                }
                Some(knot) => add(knot, weight),
            }
        }
        Ok(Self::padded(&nodes, &scales))
    }

    /// Pads the nodes of one axis ratio; the row at rest is linear theory's own.
    fn padded(nodes: &[[f64; 3]], scales: &Scales) -> Self {
        let coupling = [scales.c23 * scales.moment / scales.c33, -scales.c23 / (scales.c22 * scales.moment)];
        let (n_t, n_theta, n_phi) = (SHAPE[0] as isize, SHAPE[1] as isize, SHAPE[2] as isize);
        let at = |i: isize, j: isize, k: isize| -> [f64; 3] {
            // mirror about the plane x = 0; beyond the x axis phi is on the other side
            let (mut j, mut k) = (if j > n_theta { 2 * n_theta - j } else { j }, k);
            if j < 0 {
                (j, k) = (-j, k + n_phi);
            }
            // half a turn in phi changes the sign of what is odd in (y, spin)
            let turns = k.div_euclid(n_phi);
            let sign = if turns.rem_euclid(2) == 1 { -1.0 } else { 1.0 };
            let k = k.rem_euclid(n_phi);
            let [x, y, z] = if i == 0 {
                let phi = PI * k as f64 / n_phi as f64;
                let (sin, cos) = phi.sin_cos();
                [1.0, cos + coupling[0] * sin, sin + coupling[1] * cos]
            } else {
                nodes[((i * (n_theta + 1) + j) * n_phi + k) as usize]
            };
            [x, sign * y, sign * z]
        };
        // The stored theta at the ends lies a little inside; the functions are even there, so that nothing is lost.
        let mut padded = Vec::with_capacity(PADDED.iter().product());
        for i in -1..=n_t + 1 {
            for j in -1..=n_theta + 1 {
                for k in -1..=n_phi + 1 {
                    padded.push(match i {
                        -1 => std::array::from_fn(|c| 2.0 * at(0, j, k)[c] - at(1, j, k)[c]),
                        i if i > n_t => {
                            std::array::from_fn(|c| 2.0 * at(n_t, j, k)[c] - at(n_t - 1, j, k)[c])
                        }
                        i => at(i, j, k),
                    });
                }
            }
        }
        Self { nodes: padded, coupling }
    }

    /// Forces over mu Q, mu Q and M_max at `q`, and their derivatives by q: row by force, column by q.
    pub fn evaluate(&self, q: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let size = q[0].hypot(q[1]).hypot(q[2]);
        if size < 1e-12 || !size.is_finite() {
            let [yz, zy] = self.coupling;
            let tangent = [[1.0, 0.0, 0.0], [0.0, 1.0, yz], [0.0, zy, 1.0]];
            return ([q[0], q[1] + yz * q[2], q[2] + zy * q[1]], tangent);
        }
        // into the quarter that is stored
        let sign_x = if q[0] < 0.0 { -1.0 } else { 1.0 };
        let sign_yz = if q[2] < 0.0 || (q[2] == 0.0 && q[1] < 0.0) { -1.0 } else { 1.0 };
        let (x, y, z) = (sign_x * q[0], sign_yz * q[1], sign_yz * q[2]);
        let across = y.hypot(z);
        let (cos_theta, sin_theta) = (x / size, across / size);
        let (cos_phi, sin_phi) = if across > 0.0 { (y / across, z / across) } else { (1.0, 0.0) };
        let (per_rest, t) = (1.0 / (1.0 + size), size / (1.0 + size));
        let theta = across.atan2(x);
        let phi = sin_phi.atan2(cos_phi);
        let density = [SHAPE[0] as f64, SHAPE[1] as f64 / FRAC_PI_2, SHAPE[2] as f64 / PI];
        let (i, u) = locate(t * density[0], SHAPE[0]);
        let (j, v) = locate(theta * density[1], SHAPE[1]);
        let (k, w) = locate(phi * density[2], SHAPE[2]);
        let ((wt, dt), (wv, dv), (ww, dw)) = (weights(u), weights(v), weights(w));

        // value and slopes of the three stored functions
        let (mut value, mut by_t, mut by_theta, mut by_phi) = ([0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]);
        for a in 0..4 {
            for b in 0..4 {
                let row = ((i + a) * PADDED[1] + j + b) * PADDED[2] + k;
                let (mut line, mut slope) = ([0.0; 3], [0.0; 3]);
                for (c, node) in self.nodes[row..row + 4].iter().enumerate() {
                    for m in 0..3 {
                        line[m] += ww[c] * node[m];
                        slope[m] += dw[c] * node[m];
                    }
                }
                for m in 0..3 {
                    value[m] += wt[a] * wv[b] * line[m];
                    by_t[m] += dt[a] * wv[b] * line[m];
                    by_theta[m] += wt[a] * dv[b] * line[m];
                    by_phi[m] += wt[a] * wv[b] * slope[m];
                }
            }
        }

        // forces and gradient: along the ray, and along theta and phi over the radius
        let factor = [cos_theta, sin_theta, sin_theta];
        let factor_slope = [-sin_theta, cos_theta, cos_theta];
        let ray = [cos_theta, sin_theta * cos_phi, sin_theta * sin_phi];
        let polar = [-sin_theta, cos_theta * cos_phi, cos_theta * sin_phi];
        let azimuthal = [0.0, -sin_phi, cos_phi];
        let signs = [sign_x, sign_yz, sign_yz];
        let mut forces = [0.0; 3];
        let mut gradient = [[0.0; 3]; 3];
        for m in 0..3 {
            forces[m] = signs[m] * t * factor[m] * value[m];
            let along = per_rest * per_rest * factor[m] * (value[m] + t * by_t[m] * density[0]);
            let down = per_rest * (factor_slope[m] * value[m] + factor[m] * by_theta[m] * density[1]);
            // f_x does not depend on phi at the pole, the others carry sin(theta) in front
            let around = match m {
                0 if sin_theta < 1e-9 => 0.0,
                0 => per_rest * cos_theta / sin_theta * by_phi[0] * density[2],
                _ => per_rest * by_phi[m] * density[2],
            };
            for n in 0..3 {
                let slope = along * ray[n] + down * polar[n] + around * azimuthal[n];
                gradient[m][n] = signs[m] * signs[n] * slope;
            }
        }
        limit(&mut forces, &mut gradient);
        (forces, gradient)
    }
}

/// Keeps the tangential force within the friction limit and the moment within its own, with the gradient.
fn limit(forces: &mut [f64; 3], gradient: &mut [[f64; 3]; 3]) {
    let size = forces[0].hypot(forces[1]);
    if size > 1.0 {
        let direction = [forces[0] / size, forces[1] / size];
        for n in 0..3 {
            let radial = direction[0] * gradient[0][n] + direction[1] * gradient[1][n];
            for m in 0..2 {
                gradient[m][n] = (gradient[m][n] - radial * direction[m]) / size;
            }
        }
        // One unit of rounding inside.
        (forces[0], forces[1]) = (direction[0] * (1.0 - f64::EPSILON), direction[1] * (1.0 - f64::EPSILON));
    }
    if forces[2].abs() > 1.0 {
        forces[2] = forces[2].signum();
        gradient[2] = [0.0; 3];
    }
}
