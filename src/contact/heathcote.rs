//! Slip of a groove that bends across rolling (Heathcote 1921), added to laws of flat contacts.
//!
//! A ball rolling in a groove touches it on a surface `z = y^2/(2 R)` with the mean curvature of both, so that the
//! relative rolling speed makes particles at the sides slip differently from those in the middle: `-kappa y^2` beside
//! the creepage `c_x - phi y` (Johnson 1985, section 8.5). What that changes is taken from strips along rolling, each
//! under its own creepage: with `u` the linear force of a strip over twice its limit, `f = u (2 - |u|)`, from
//! `|u| = 1` on `u/|u|` (Carter 1926; exact for a line contact). The flat law's own forces are kept; only the difference
//! of the strips with and without the curvature is added.

use std::sync::LazyLock;

/// Strips across the contact.
const STRIPS: usize = 24;

/// Places y/b of the strips and their shares of the load, `3/4 (1 - y^2)` integrated: Gauss-Chebyshev quadrature.
static PLACES: LazyLock<[(f64, f64); STRIPS]> = LazyLock::new(|| {
    let raw: [(f64, f64); STRIPS] = std::array::from_fn(|k| {
        let (sin, cos) = (std::f64::consts::PI * (k as f64 + 0.5) / STRIPS as f64).sin_cos();
        (cos, sin.powi(3))
    });
    let sum: f64 = raw.iter().map(|(_, weight)| weight).sum();
    raw.map(|(place, weight)| (place, weight / sum))
});

/// Sums over the strips: of the forces and of their derivatives by u, times powers of y/b.
#[derive(Default)]
struct Sums {
    /// f_x times 1, y, y^2.
    x: [f64; 3],
    y: f64,
    /// d f_x / d u_x times 1 to y^4.
    xx: [f64; 5],
    /// d f_x / d u_y times 1, y, y^2.
    xy: [f64; 3],
    yy: f64,
}

impl Sums {
    #[inline(always)]
    fn new([x, y, spin, curvature]: [f64; 4]) -> Self {
        let mut sums = Self::default();
        let uy = 0.5 * y;
        for &(place, weight) in PLACES.iter() {
            let ux = 0.5 * (x - (spin + curvature * place) * place);
            let size = (ux * ux + uy * uy).sqrt();
            // f = g u; slope is the derivative of g by |u|, over |u|
            let (g, slope) = if size < 1.0 {
                (2.0 - size, if size > 0.0 { -1.0 / size } else { 0.0 })
            } else {
                (1.0 / size, -1.0 / (size * size * size))
            };
            let (wg, ws) = (weight * g, weight * slope);
            let mut xx = wg + ws * ux * ux;
            let mut xy = ws * ux * uy;
            let mut fx = wg * ux;
            sums.y += wg * uy;
            sums.yy += wg + ws * uy * uy;
            for power in 0..5 {
                sums.xx[power] += xx;
                if power < 3 {
                    sums.x[power] += fx;
                    sums.xy[power] += xy;
                }
                xx *= place;
                xy *= place;
                fx *= place;
            }
        }
        sums
    }
}

/// What the curvature of the groove adds to `(F_x/(mu Q), F_y/(mu Q), M_z/(mu Q b))`, and the second moment
/// `y^2 f_x` over `mu Q b^2` as a whole; and their derivatives.
///
/// Arguments are forces of linear theory over mu Q: of the creepages along and across rolling, of the slip
/// `phi b` of the spin and of the slip `kappa b^2` of the curvature at the contact's side.
#[inline(always)]
pub fn curvature_effect(q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
    let curved = Sums::new(q);
    let flat = Sums::new([q[0], q[1], q[2], 0.0]);
    let values = |s: &Sums| [s.x[0], s.y, -s.x[1]];
    let slopes = |s: &Sums| {
        [
            [s.xx[0], s.xy[0], -s.xx[1], -s.xx[2]],
            [s.xy[0], s.yy, -s.xy[1], -s.xy[2]],
            [-s.xx[1], -s.xy[1], s.xx[2], s.xx[3]],
        ]
    };
    let (with, without) = (values(&curved), values(&flat));
    let (with_slopes, without_slopes) = (slopes(&curved), slopes(&flat));
    let mut change = [0.0; 4];
    let mut gradient = [[0.0; 4]; 4];
    for m in 0..3 {
        change[m] = with[m] - without[m];
        for n in 0..4 {
            let flat_slope = if n < 3 { without_slopes[m][n] } else { 0.0 };
            gradient[m][n] = 0.5 * (with_slopes[m][n] - flat_slope);
        }
    }
    change[3] = curved.x[2];
    gradient[3] = [curved.xx[2], curved.xy[2], -curved.xx[3], -curved.xx[4]].map(|slope| 0.5 * slope);
    (change, gradient)
}
