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

/// Sums over the strips; sums of derivatives only if asked for.
#[inline(always)]
fn sums(q: [f64; 4], mut slopes: Option<&mut Slopes>) -> Forces {
    let zero = Lanes::constant(0.0);
    let one = Lanes::constant(1.0);
    let [x, y, spin, curvature] = q.map(Lanes::constant);
    let mut forces = Forces { x: [zero; 3], y: zero };
    let uy = y.scale(0.5);
    for &[place, weight] in PLACES.iter() {
        let ux = (x - (spin + curvature * place) * place).scale(0.5);
        let square = ux.square() + uy.square();
        let size = square.sqrt();
        let inverse = one / size.where_positive(size, one);
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
                (-inverse * inverse * inverse).where_positive(sliding, -inverse.where_positive(size, zero));
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

#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn curvature_effect(q: [f64; 4]) -> [f64; 4] {
    changes(&sums(q, None), &sums(flat(q), None))
}

/// Arguments without curvature.
fn flat([x, y, spin, _]: [f64; 4]) -> [f64; 4] {
    [x, y, spin, 0.0]
}

#[inline(always)]
fn changes(curved: &Forces, flat: &Forces) -> [f64; 4] {
    let change = |curved: Lanes, flat: Lanes| total(curved) - total(flat);
    [
        change(curved.x[0], flat.x[0]),
        change(curved.y, flat.y),
        -change(curved.x[1], flat.x[1]),
        total(curved.x[2]),
    ]
}

/// Effect of the curvature with its derivatives.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn curvature_effect_with_gradient(q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
    let zero = Lanes::constant(0.0);
    let none = Slopes { xx: [zero; 5], xy: [zero; 3], yy: zero };
    let (mut with, mut without) = (none, none);
    let change = changes(&sums(q, Some(&mut with)), &sums(flat(q), Some(&mut without)));
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
