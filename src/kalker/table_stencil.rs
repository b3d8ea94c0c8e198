//! The nodes of the table around a place, and sums over them.

use std::f64::consts::{FRAC_PI_2, PI};

use super::table::{PADDED, SHAPE};
use super::table_angle::alternating;
use super::table_pieces::{counts, locate, locate_size, weights, weights_of_size};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::{Scalar, Values};

/// Pieces per unit of theta and phi.
pub(super) const DENSITY: [f64; 2] = [SHAPE[1] as f64 / FRAC_PI_2, SHAPE[2] as f64 / PI];

/// Numbers in memory from a function to the next, from a node to the next along theta, and along t.
const STRIDES: [usize; 3] = [PADDED[2], 3 * PADDED[2], 3 * PADDED[1] * PADDED[2]];

/// From the first to the last of the nodes around a place.
const SPAN: usize = 3 * STRIDES[2] + 3 * STRIDES[1] + 2 * STRIDES[0] + 4;

/// Steepness along phi of f_y and m_z, which go like sines and cosines of phi: with it their slopes are exact, and the force is
/// smooth across the x axis, where all phi meet.
const STEEPNESS: f64 = {
    let step = PI / SHAPE[2] as f64;
    step / alternating(step, step, 1)
};

/// The nodes around the places of one or several contacts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stencil<V> {
    /// Pieces of t.
    sizes: [usize; WIDTH],
    /// Where the nodes around begin in memory.
    first: [usize; WIDTH],
    /// Places in the pieces of t, theta and phi.
    within: [V; 3],
}

/// Weights along phi of the three functions.
type AlongPhi<V> = [[V; 4]; 3];

/// Weights, and their slopes.
#[derive(Clone, Copy)]
struct Weights<V> {
    t: ([V; 4], [V; 4]),
    theta: ([V; 4], [V; 4]),
    phi: (AlongPhi<V>, AlongPhi<V>),
}

impl<V: Values> Stencil<V> {
    /// At t, theta and phi.
    #[inline(always)]
    pub(super) fn new([t, theta, phi]: [V; 3]) -> Self {
        let (sizes, u) = locate_size(t);
        let (j, v) = locate(theta.scale(DENSITY[0]), SHAPE[1]);
        let (k, w) = locate(phi.scale(DENSITY[1]), SHAPE[2]);
        let beside = counts(j.scale(STRIDES[1] as f64) + k);
        let mut first = beside;
        for lane in 0..WIDTH {
            first[lane] += sizes[lane] * STRIDES[2];
        }
        Self { sizes, first, within: [u, v, w] }
    }

    /// Piece of t of the first contact.
    pub(super) fn size_piece(&self) -> usize {
        self.sizes[0]
    }

    /// Values of the stored functions.
    #[inline(always)]
    pub(super) fn values(&self, nodes: &[f64]) -> [V; 3] {
        let Weights { t, theta, phi } = self.weights();
        across(&phi.0, &self.along_phi(nodes, &products(&t.0, &theta.0)))
    }

    /// Values with their slopes.
    #[inline(always)]
    fn values_with_slopes(&self, nodes: &[f64]) -> [[V; 3]; 4] {
        let Weights { t, theta, phi } = self.weights();
        let along = self.along_phi(nodes, &products(&t.0, &theta.0));
        [
            across(&phi.0, &along),
            across(&phi.0, &self.along_phi(nodes, &products(&t.1, &theta.0))),
            across(&phi.0, &self.along_phi(nodes, &products(&t.0, &theta.1))),
            across(&phi.1, &along),
        ]
    }

    /// Weights along t, theta and phi.
    #[inline(always)]
    fn weights(&self) -> Weights<V> {
        let [u, v, w] = self.within;
        let (even, odd) = (weights(w, 1.0), weights(w, STEEPNESS));
        Weights {
            t: weights_of_size(&self.sizes, u),
            theta: weights(v, 1.0),
            phi: ([even.0, odd.0, odd.0], [even.1, odd.1, odd.1]),
        }
    }

    /// Is a contact where the one before it is?
    #[inline(always)]
    fn repeats(&self, lane: usize) -> bool {
        let [u, v, w] = &self.within;
        self.first[lane] == self.first[lane - 1]
            && u.lane(lane) == u.lane(lane - 1)
            && v.lane(lane) == v.lane(lane - 1)
            && w.lane(lane) == w.lane(lane - 1)
    }

    /// Sums over t and theta of every function, at each of the four nodes along phi.
    #[inline(always)]
    fn along_phi(&self, nodes: &[f64], weights: &[[V; 4]; 4]) -> AlongPhi<V> {
        // Contact by contact: the four nodes are a vector.
        let mut sums = [[Lanes::constant(0.0); 3]; WIDTH];
        for lane in 0..V::COUNT {
            // Lanes without a contact of their own repeat another.
            if lane > 0 && self.repeats(lane) {
                sums[lane] = sums[lane - 1];
                continue;
            }
            // One range, so that nothing is left to check within it.
            let around = &nodes[self.first[lane]..self.first[lane] + SPAN];
            let mut sum = [Lanes::constant(0.0); 3];
            for a in 0..4 {
                let [p, q, r, s] = &weights[a];
                let w = [p.lane(lane), q.lane(lane), r.lane(lane), s.lane(lane)];
                for function in 0..3 {
                    let first = a * STRIDES[2] + function * STRIDES[0];
                    let [one, other] = [
                        four(around, first).scale(w[0]) + four(around, first + STRIDES[1]).scale(w[1]),
                        four(around, first + 2 * STRIDES[1]).scale(w[2])
                            + four(around, first + 3 * STRIDES[1]).scale(w[3]),
                    ];
                    sum[function] += one + other;
                }
            }
            sums[lane] = sum;
        }
        // Loops, because compilers do not inline what makes arrays by functions here.
        let mut along = [[V::zero(); 4]; 3];
        for function in 0..3 {
            for k in 0..4 {
                along[function][k] = V::by_lane(|lane| sums[lane][function].0[k]);
            }
        }
        along
    }
}

/// Values of the stored functions, and their slopes by t, theta and phi over the piece.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
pub(super) fn values_with_slopes(stencil: &Stencil<f64>, nodes: &[f64]) -> [[f64; 3]; 4] {
    stencil.values_with_slopes(nodes)
}

/// Weights of nodes along t and theta.
#[inline(always)]
fn products<V: Values>(by_t: &[V; 4], by_theta: &[V; 4]) -> [[V; 4]; 4] {
    let mut products = [[V::zero(); 4]; 4];
    for a in 0..4 {
        for b in 0..4 {
            products[a][b] = by_t[a] * by_theta[b];
        }
    }
    products
}

/// Sums along phi.
#[inline(always)]
fn across<V: Values>(weights: &AlongPhi<V>, along: &AlongPhi<V>) -> [V; 3] {
    [sum(&weights[0], &along[0]), sum(&weights[1], &along[1]), sum(&weights[2], &along[2])]
}

#[inline(always)]
fn sum<V: Values>(w: &[V; 4], x: &[V; 4]) -> V {
    (w[0] * x[0] + w[1] * x[1]) + (w[2] * x[2] + w[3] * x[3])
}

/// Four nodes along phi.
#[inline(always)]
fn four(nodes: &[f64], first: usize) -> Lanes {
    Lanes([nodes[first], nodes[first + 1], nodes[first + 2], nodes[first + 3]])
}
