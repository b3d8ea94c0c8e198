//! Slip of a groove that bends across rolling (Heathcote 1921), added to laws of flat contacts.
//!
//! A ball rolling in a groove touches it on a surface `z = y^2/(2 R)` with the mean curvature of both, so that the
//! relative rolling speed makes particles at the sides slip differently from those in the middle: `-kappa y^2` beside
//! the creepage `c_x - phi y` (Johnson 1985, section 8.5). The change of the forces is computed on strips along rolling,
//! each under its own creepage: with `u` the linear force of a strip over twice its limit, `f = u (2 - |u|)`, from
//! `|u| = 1` on `u/|u|` (Carter 1926; exact for a line contact). The flat law's own forces are kept; only the difference
//! of the strips with and without the curvature is added.

use std::sync::LazyLock;

use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::{Scalar, SmoothMap, Values};

/// Strips across the contact.
const STRIPS: usize = 24;

/// Places y/b of the strips, in lanes, and their parts of the load, `3/4 (1 - y^2)` integrated: Gauss-Chebyshev
/// quadrature.
static PLACES: LazyLock<[[Lanes; 2]; STRIPS / WIDTH]> = LazyLock::new(|| {
    let raw: [(f64, f64); STRIPS] = std::array::from_fn(|k| {
        let (sin, cos) = (std::f64::consts::PI * (k as f64 + 0.5) / STRIPS as f64).sin_cos();
        (cos, sin.powi(3))
    });
    let sum: f64 = raw.iter().map(|(_, weight)| weight).sum();
    std::array::from_fn(|group| {
        let strip = |lane: usize| raw[WIDTH * group + lane];
        [Lanes::from_fn(|lane| strip(lane).0), Lanes::from_fn(|lane| strip(lane).1 / sum)]
    })
});

/// Sums of forces over the strips, lane by lane.
#[derive(Clone, Copy)]
struct Forces {
    /// f_x times 1, y/b and its square.
    x: [Lanes; 3],
    y: Lanes,
}

/// Sums of the forces' derivatives, times powers of y/b.
#[derive(Clone, Copy)]
struct Slopes {
    /// d f_x / d u_x times 1 to y^4.
    xx: [Lanes; 5],
    /// d f_x / d u_y times 1, y, y^2.
    xy: [Lanes; 3],
    yy: Lanes,
}

const ZERO: Lanes = Lanes([0.0; WIDTH]);
const NO_FORCES: Forces = Forces { x: [ZERO; 3], y: ZERO };
const NO_SLOPES: Slopes = Slopes { xx: [ZERO; 5], xy: [ZERO; 3], yy: ZERO };

/// Sums over the strips; sums of derivatives only if asked for.
#[inline(always)]
fn sums(q: [f64; 4], mut slopes: Option<&mut Slopes>) -> Forces {
    let one = Lanes::constant(1.0);
    let [x, y, spin, curvature] = q.map(Lanes::constant);
    let mut forces = NO_FORCES;
    let uy = y.scale(0.5);
    for &[place, weight] in PLACES.iter() {
        let ux = (x - (spin + curvature * place) * place).scale(0.5);
        let square = ux.square() + uy.square();
        let size = square.sqrt();
        // A quotient by a selected number becomes a jump for each lane; by a larger one it stays a vector's.
        let inverse = one / size.at_least(f64::MIN_POSITIVE);
        let sliding = size - one;
        // f = g u
        let g = inverse.where_positive(sliding, Lanes::constant(2.0) - size);
        let wg = weight * g;
        let mut fx = wg * ux;
        forces.y += wg * uy;
        for sum in &mut forces.x {
            *sum += fx;
            fx *= place;
        }
        if let Some(slopes) = &mut slopes {
            // derivative of g by |u|, over |u|; nothing where |u| is
            let slope =
                (-inverse * inverse * inverse).where_positive(sliding, -inverse.where_positive(size, ZERO));
            let ws = weight * slope;
            let mut xx = wg + ws * ux * ux;
            let mut xy = ws * ux * uy;
            slopes.yy += wg + ws * uy * uy;
            for sum in &mut slopes.xx {
                *sum += xx;
                xx *= place;
            }
            for sum in &mut slopes.xy {
                *sum += xy;
                xy *= place;
            }
        }
    }
    forces
}

fn total(Lanes([a, b, c, d]): Lanes) -> f64 {
    (a + b) + (c + d)
}

/// Changes by the curvature of the groove of `(F_x/(mu Q), F_y/(mu Q), M_z/(mu Q b))`, and the second moment
/// `y^2 f_x` over `mu Q b^2` as a whole.
///
/// Arguments are forces of linear theory over mu Q: of the creepages along and across rolling, of the slip
/// `phi b` of the spin and of the slip `kappa b^2` of the curvature at the contact's side.
#[derive(Clone, Copy, Debug)]
pub struct CurvatureEffect;

impl SmoothMap<4, 4> for CurvatureEffect {
    #[inline(always)]
    fn values<V: Values>(&self, q: [V; 4]) -> [V; 4] {
        V::each(q, curvature_effect)
    }
    fn with_gradient(&self, q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
        curvature_effect_with_gradient(q)
    }
}

/// Sums with and without the curvature. They go into memory lane by lane: compilers vectorise from the stores backwards.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn both_sums(q: [f64; 4], forces: &mut [Forces; 2]) {
    *forces = [sums(q, None), sums(flat(q), None)];
}

/// The same with derivatives.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn both_sums_with_slopes(q: [f64; 4], forces: &mut [Forces; 2], slopes: &mut [Slopes; 2]) {
    let [mut with, mut without] = [NO_SLOPES; 2];
    *forces = [sums(q, Some(&mut with)), sums(flat(q), Some(&mut without))];
    *slopes = [with, without];
}

#[inline(never)]
fn curvature_effect(q: [f64; 4]) -> [f64; 4] {
    let mut forces = [NO_FORCES; 2];
    both_sums(q, &mut forces);
    changes(&forces)
}

/// Arguments without curvature.
fn flat([x, y, spin, _]: [f64; 4]) -> [f64; 4] {
    [x, y, spin, 0.0]
}

#[inline(always)]
fn changes([curved, flat]: &[Forces; 2]) -> [f64; 4] {
    let change = |curved: Lanes, flat: Lanes| total(curved) - total(flat);
    [
        change(curved.x[0], flat.x[0]),
        change(curved.y, flat.y),
        -change(curved.x[1], flat.x[1]),
        total(curved.x[2]),
    ]
}

/// Effect of the curvature with its derivatives.
#[inline(never)]
fn curvature_effect_with_gradient(q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
    let (mut forces, mut slopes) = ([NO_FORCES; 2], [NO_SLOPES; 2]);
    both_sums_with_slopes(q, &mut forces, &mut slopes);
    let change = changes(&forces);
    let [with, without] = slopes;
    let slopes = |s: &Slopes| {
        let (xx, xy) = (s.xx.map(total), s.xy.map(total));
        [
            [xx[0], xy[0], -xx[1], -xx[2]],
            [xy[0], total(s.yy), -xy[1], -xy[2]],
            [-xx[1], -xy[1], xx[2], xx[3]],
            [xx[2], xy[2], -xx[3], -xx[4]],
        ]
    };
    let (with, without) = (slopes(&with), slopes(&without));
    let gradient = std::array::from_fn(|m| {
        // the second moment is that of the curved strips alone, and the flat ones know no curvature
        std::array::from_fn(|n| 0.5 * (with[m][n] - if m < 3 && n < 3 { without[m][n] } else { 0.0 }))
    });
    (change, gradient)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of `f_x`, `y f_x`, `y^2 f_x`, `f_y` and of `(y/b)^k d f_x/d u_x`, k to 4, strip by strip in the order of the lanes.
    fn plainly([x, y, spin, curvature]: [f64; 4]) -> [f64; 9] {
        let mut lanes = [[0.0f64; WIDTH]; 9];
        for [places, weights] in PLACES.iter() {
            for lane in 0..WIDTH {
                let (place, weight) = (places.0[lane], weights.0[lane]);
                let (ux, uy) = (0.5 * (x - (spin + curvature * place) * place), 0.5 * y);
                let size = (ux * ux + uy * uy).sqrt();
                let (g, slope) = match size {
                    size if size > 1.0 => {
                        let inverse = 1.0 / size;
                        (inverse, -inverse * inverse * inverse)
                    }
                    size if size > 0.0 => (2.0 - size, -(1.0 / size)),
                    _ => (2.0, 0.0),
                };
                let (wg, ws) = (weight * g, weight * slope);
                let (mut fx, mut xx) = (wg * ux, wg + ws * ux * ux);
                for k in 0..3 {
                    lanes[k][lane] += fx;
                    fx *= place;
                }
                lanes[3][lane] += wg * uy;
                for k in 4..9 {
                    lanes[k][lane] += xx;
                    xx *= place;
                }
            }
        }
        lanes.map(|[a, b, c, d]| (a + b) + (c + d))
    }

    #[test]
    fn invariant_vectors_of_strips_have_the_bits_of_strips_one_by_one() {
        let sizes = [0.0, 1e-200, 1e-9, 0.1, -0.7, 1.9, -2.0, 30.0, 1e12];
        for (x, y) in sizes.into_iter().flat_map(|x| sizes.map(|y| (x, y))) {
            for (spin, curvature) in sizes.into_iter().flat_map(|x| sizes.map(|y| (x, y))) {
                let q = [x, y, spin, curvature];
                let (curved, flat) = (plainly(q), plainly(flat(q)));
                let expected = [curved[0] - flat[0], curved[3] - flat[3], -(curved[1] - flat[1]), curved[2]];
                let (values, gradient) = curvature_effect_with_gradient(q);
                assert_eq!(curvature_effect(q), expected, "{q:?}");
                assert_eq!(values, expected, "{q:?}");
                let slopes = [
                    (gradient[0][0], curved[4] - flat[4]),
                    (gradient[0][2], -curved[5] - -flat[5]),
                    (gradient[2][2], curved[6] - flat[6]),
                    (gradient[2][3], curved[7]),
                    (gradient[3][3], -curved[8]),
                ];
                for (ours, expected) in slopes {
                    assert_eq!(ours, 0.5 * expected, "{q:?}");
                }
            }
        }
    }
}
