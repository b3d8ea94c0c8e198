//! Interpolation in the table of Kalker's nonlinear theory: the 4 x 4 x 4 nodes around a place and their weights.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

use super::table::{PADDED, SHAPE};
use super::table_pieces::{locate, locate_size, piece, weights};
use crate::lanes::Lanes;
use crate::scalar::Scalar;

/// Pieces per unit of theta and phi.
pub(super) const DENSITY: [f64; 2] = [SHAPE[1] as f64 / FRAC_PI_2, SHAPE[2] as f64 / PI];

/// The nodes around a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stencil {
    /// Piece by t, theta and phi, and where in it.
    pub(super) piece: [usize; 3],
    within: [f64; 3],
}

impl Stencil {
    /// At t, theta and phi.
    #[inline(always)]
    pub(super) fn new([t, theta, phi]: [f64; 3]) -> Self {
        let (i, u) = locate_size(t);
        let (j, v) = locate(theta * DENSITY[0], SHAPE[1]);
        let (k, w) = locate(phi * DENSITY[1], SHAPE[2]);
        Self { piece: [i, j, k], within: [u, v, w] }
    }

    /// First of the four nodes along phi, at step `a` along t and `b` along theta.
    #[inline(always)]
    fn row(&self, a: usize, b: usize) -> usize {
        let [i, j, k] = self.piece;
        ((i + a) * PADDED[1] + j + b) * PADDED[2] + k
    }

    /// Weights along phi of the stored functions, and their slopes.
    #[inline(always)]
    fn weights_along_phi(&self) -> ([Lanes; 4], [Lanes; 4]) {
        // f_y and m_z go like sines and cosines of phi: with this steepness their slopes are exact, and the force is
        // smooth across the x axis, where all phi meet.
        static STEEPNESS: LazyLock<f64> = LazyLock::new(|| {
            let step = PI / SHAPE[2] as f64;
            step / step.sin()
        });
        let w = self.within[2];
        let (even, odd) = (weights(w, 1.0), weights(w, *STEEPNESS));
        let each = |even: [f64; 4], odd: [f64; 4]| -> [Lanes; 4] {
            std::array::from_fn(|c| Lanes([even[c], odd[c], odd[c], 0.0]))
        };
        (each(even.0, odd.0), each(even.1, odd.1))
    }
}

/// Values of the stored functions.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn interpolate(nodes: &[Lanes], stencil: &Stencil) -> Lanes {
    let ((wt, _), (wv, _)) =
        (piece(stencil.piece[0]).weights(stencil.within[0]), weights(stencil.within[1], 1.0));
    let (ww, _) = stencil.weights_along_phi();
    let mut value = Lanes::constant(0.0);
    for a in 0..4 {
        for b in 0..4 {
            let row = stencil.row(a, b);
            let mut line = Lanes::constant(0.0);
            for (w, node) in ww.iter().zip(&nodes[row..row + 4]) {
                line += *w * *node;
            }
            value += line.scale(wt[a] * wv[b]);
        }
    }
    value
}

/// Values of the stored functions, and their slopes by t, theta and phi over the piece.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn interpolate_with_slopes(nodes: &[Lanes], stencil: &Stencil) -> [Lanes; 4] {
    let ((wt, dt), (wv, dv)) =
        (piece(stencil.piece[0]).weights(stencil.within[0]), weights(stencil.within[1], 1.0));
    let (ww, dw) = stencil.weights_along_phi();
    let [mut value, mut by_t, mut by_theta, mut by_phi] = [Lanes::constant(0.0); 4];
    for a in 0..4 {
        for b in 0..4 {
            let row = stencil.row(a, b);
            let [mut line, mut slope] = [Lanes::constant(0.0); 2];
            for (c, node) in nodes[row..row + 4].iter().enumerate() {
                line += ww[c] * *node;
                slope += dw[c] * *node;
            }
            value += line.scale(wt[a] * wv[b]);
            by_t += line.scale(dt[a] * wv[b]);
            by_theta += line.scale(wt[a] * dv[b]);
            by_phi += slope.scale(wt[a] * wv[b]);
        }
    }
    [value, by_t, by_theta, by_phi]
}
