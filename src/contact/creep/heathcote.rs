//! Slip of a groove that bends across rolling (Heathcote 1921), added to laws of flat contacts.
//!
//! A ball rolling in a groove touches it on a surface `z = y^2/(2 R)` with the mean curvature of both, so that the
//! relative rolling speed makes particles at the sides slip differently from those in the middle: `-kappa y^2` beside
//! the creepage `c_x - phi y` (Johnson 1985, section 8.5). The change of the forces is computed on strips along rolling,
//! each under its own creepage: with `u` the linear force of a strip over twice its limit, `f = u (2 - |u|)`, from
//! `|u| = 1` on `u/|u|` (Carter 1926; exact for a line contact). The flat law's own forces are kept; only the difference
//! of the strips with and without the curvature is added.

use std::array::from_fn;
use std::sync::LazyLock;

use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::scalar::{Scalar, SmoothMap, Values};

/// Strips across the contact: as many on either side of its middle.
const STRIPS: usize = 24;

/// Strips on both sides of the middle, in lanes, or one such pair in all of them.
#[derive(Clone, Copy)]
struct Pairs {
    /// |y/b| and its square.
    place: Lanes,
    square: Lanes,
    /// Part of the load that a strip carries, times 1, |y/b| and its square.
    weights: [Lanes; 3],
}

impl Pairs {
    /// That of one lane in all lanes.
    #[inline(always)]
    fn everywhere(&self, lane: usize) -> Self {
        let [load, first, second] = &self.weights;
        Self {
            place: Lanes::constant(self.place.0[lane]),
            square: Lanes::constant(self.square.0[lane]),
            weights: [
                Lanes::constant(load.0[lane]),
                Lanes::constant(first.0[lane]),
                Lanes::constant(second.0[lane]),
            ],
        }
    }
}

/// All strips; their parts of the load are `3/4 (1 - y^2)` integrated by Gauss-Chebyshev quadrature.
static PAIRS: LazyLock<[Pairs; STRIPS / 2 / WIDTH]> = LazyLock::new(|| {
    let raw: [(f64, f64); STRIPS / 2] = from_fn(|k| {
        let (sin, cos) = (std::f64::consts::PI * (k as f64 + 0.5) / STRIPS as f64).sin_cos();
        (cos, sin.powi(3))
    });
    let sum: f64 = raw.iter().map(|(_, weight)| 2.0 * weight).sum();
    from_fn(|group| {
        let lanes = |number: fn(f64, f64) -> f64| {
            Lanes::from_fn(|lane| {
                let (place, weight) = raw[WIDTH * group + lane];
                number(place, weight)
            })
        };
        Pairs {
            place: lanes(|place, _| place),
            square: lanes(|place, _| place * place),
            weights: [
                lanes(|_, weight| weight),
                lanes(|place, weight| weight * place),
                lanes(|place, weight| weight * place * place),
            ]
            .map(|weight| weight.scale(1.0 / sum)),
        }
    })
});

/// [-] slip over the limit beyond which only its direction counts: products of four sizes are numbers.
const LARGEST: f64 = 1e70;

/// Halves of the arguments: slips over the limit, where `|u| = 1` begins to slide.
#[inline(always)]
fn halves([x, y, spin, curvature]: [Lanes; 4]) -> [Lanes; 4] {
    let half = |q: Lanes| q.clamp_to(-LARGEST, LARGEST).scale(0.5);
    [half(x), half(y), half(spin), half(curvature)]
}

/// Two pairs of strips: those of the bent groove at +y and -y, and those of a flat one.
#[derive(Clone, Copy)]
struct Strips {
    /// u along rolling, its size, and the force over it.
    u: [Lanes; 4],
    size: [Lanes; 4],
    force: [Lanes; 4],
}

impl Strips {
    #[inline(always)]
    fn new([x, y, spin, curvature]: [Lanes; 4], pairs: &Pairs) -> Self {
        let (turn, bend) = (spin * pairs.place, x - curvature * pairs.square);
        let u = [bend - turn, bend + turn, x - turn, x + turn];
        let across = y.square();
        let size = [
            (u[0].square() + across).sqrt(),
            (u[1].square() + across).sqrt(),
            (u[2].square() + across).sqrt(),
            (u[3].square() + across).sqrt(),
        ];
        // 1/|u| of what slides, 1 elsewhere: four quotients at the price of one.
        let one = Lanes::constant(1.0);
        let [a, b, c, d] =
            [size[0].at_least(one), size[1].at_least(one), size[2].at_least(one), size[3].at_least(one)];
        let (ab, cd) = (a * b, c * d);
        let inverse = one / (ab * cd);
        let (per_ab, per_cd) = (inverse * cd, inverse * ab);
        let force = [
            force(size[0], per_ab * b),
            force(size[1], per_ab * a),
            force(size[2], per_cd * d),
            force(size[3], per_cd * c),
        ];
        Self { u, size, force }
    }
}

/// Force of a strip over its slip u: 1/|u| of what slides, which is the inverse of a size of at least 1, and 2 - |u| of what does not.
#[inline(always)]
fn force(size: Lanes, inverse: Lanes) -> Lanes {
    inverse + (Lanes::constant(1.0) - size).at_least(ZERO)
}

const ZERO: Lanes = Lanes([0.0; WIDTH]);

/// Adds what pairs of strips change: f_x, f_y over u_y, y/b f_x, and f_x times the square of y/b as a whole.
#[inline(always)]
fn add_changes(changes: &mut [Lanes; 4], strips: &Strips, weights: &[Lanes; 3]) {
    let Strips { u, force, .. } = strips;
    let [a, b, c, d] = [force[0] * u[0], force[1] * u[1], force[2] * u[2], force[3] * u[3]];
    let whole = a + b;
    changes[0] += weights[0] * (whole - (c + d));
    changes[1] += weights[0] * ((force[0] + force[1]) - (force[2] + force[3]));
    changes[2] += weights[1] * ((a - b) - (c - d));
    changes[3] += weights[2] * whole;
}

/// Changes from sums over the strips and half the lateral slip.
#[inline(always)]
fn changes<S: Scalar>([x, y, moment, second]: [S; 4], half_lateral: S) -> [S; 4] {
    [x, y * half_lateral, -moment, second]
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

const NO_SLOPES: Slopes = Slopes { xx: [ZERO; 5], xy: [ZERO; 3], yy: ZERO };

impl Slopes {
    /// Adds those of the strips `first` and `first + 1`, at +y and -y.
    #[inline(always)]
    fn add(&mut self, strips: &Strips, first: usize, half_lateral: Lanes, pairs: &Pairs) {
        let one = Lanes::constant(1.0);
        let uy = half_lateral;
        for (number, place) in [(first, pairs.place), (first + 1, -pairs.place)] {
            let (ux, size, force) = (strips.u[number], strips.size[number], strips.force[number]);
            // A quotient by a selected number becomes a jump for each lane; by a larger one it stays a vector's.
            let inverse = one / size.at_least(Lanes::constant(f64::MIN_POSITIVE));
            // derivative of the force over u by |u|, over |u|; nothing where |u| is
            let slope = -inverse.where_positive(size, ZERO) * inverse.square().at_most(one);
            let (weight, ws) = (pairs.weights[0] * force, pairs.weights[0] * slope);
            let mut xx = weight + ws * ux * ux;
            let mut xy = ws * ux * uy;
            self.yy += weight + ws * uy * uy;
            for sum in &mut self.xx {
                *sum += xx;
                xx *= place;
            }
            for sum in &mut self.xy {
                *sum += xy;
                xy *= place;
            }
        }
    }
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
        V::each_or_together(q, curvature_effect, |q| {
            let mut changes = [ZERO; 4];
            effects_together(&q, &mut changes);
            changes
        })
    }
    fn with_gradient(&self, q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
        curvature_effect_with_gradient(q)
    }
}

/// Effects on several contacts, pair by pair of strips. They go into memory lane by lane: compilers vectorise from the stores
/// backwards.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn effects_together(q: &[Lanes; 4], effects: &mut [Lanes; 4]) {
    let halves = halves(*q);
    // Sums in the order of those of one contact, whose strips are in the lanes.
    let mut sums = [[ZERO; 4]; WIDTH];
    let groups = &*PAIRS;
    for lane in 0..WIDTH {
        let mut sum = [ZERO; 4];
        for pairs in groups {
            let pair = pairs.everywhere(lane);
            add_changes(&mut sum, &Strips::new(halves, &pair), &pair.weights);
        }
        sums[lane] = sum;
    }
    let [a, b, c, d] = &sums;
    let total = |k: usize| (a[k] + b[k]) + (c[k] + d[k]);
    *effects = changes([total(0), total(1), total(2), total(3)], halves[1]);
}

/// Sums over the strips of one contact, in lanes.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn sums(q: &[Lanes; 4], sums: &mut [Lanes; 4]) {
    let (halves, mut sum) = (halves(*q), [ZERO; 4]);
    for pairs in &*PAIRS {
        add_changes(&mut sum, &Strips::new(halves, pairs), &pairs.weights);
    }
    *sums = sum;
}

/// Sums with derivatives of the strips of the bent groove and of those of a flat one.
#[cfg_attr(feature = "vectors", multiversion::multiversion(targets("x86_64+avx2")))]
fn sums_with_slopes(q: &[Lanes; 4], sums: &mut [Lanes; 4], slopes: &mut [Slopes; 2]) {
    let (halves, mut sum) = (halves(*q), [ZERO; 4]);
    let [mut bent, mut flat] = [NO_SLOPES; 2];
    for pairs in &*PAIRS {
        let strips = Strips::new(halves, pairs);
        add_changes(&mut sum, &strips, &pairs.weights);
        bent.add(&strips, 0, halves[1], pairs);
        flat.add(&strips, 2, halves[1], pairs);
    }
    *sums = sum;
    *slopes = [bent, flat];
}

#[inline(never)]
fn curvature_effect(q: [f64; 4]) -> [f64; 4] {
    let q = q.map(Lanes::constant);
    let mut forces = [ZERO; 4];
    sums(&q, &mut forces);
    changes(forces.map(total), halves(q)[1].0[0])
}

/// Effect of the curvature with its derivatives.
#[inline(never)]
fn curvature_effect_with_gradient(q: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
    let q = q.map(Lanes::constant);
    let (mut forces, mut slopes) = ([ZERO; 4], [NO_SLOPES; 2]);
    sums_with_slopes(&q, &mut forces, &mut slopes);
    let change = changes(forces.map(total), halves(q)[1].0[0]);
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
    let gradient = from_fn(|m| {
        // the second moment is that of the curved strips alone, and the flat ones know no curvature
        from_fn(|n| 0.5 * (with[m][n] - if m < 3 && n < 3 { without[m][n] } else { 0.0 }))
    });
    (change, gradient)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number by number: the sums that values are made of, and `(y/b)^k d f_x/d u_x`, k to 4, of the bent and of a flat groove, in
    /// the order of the lanes.
    fn plainly(q: [f64; 4]) -> ([f64; 4], [[f64; 5]; 2]) {
        let [x, y, spin, curvature] = q.map(|q| 0.5 * q);
        let (mut sums, mut slopes) = ([[0.0; WIDTH]; 4], [[[0.0; WIDTH]; 5]; 2]);
        for Pairs { place, square, weights } in PAIRS.iter() {
            for lane in 0..WIDTH {
                let (place, square, weights) = (place.0[lane], square.0[lane], weights.map(|w| w.0[lane]));
                let (turn, bend) = (spin * place, x - curvature * square);
                let u = [bend - turn, bend + turn, x - turn, x + turn];
                let size = u.map(|u| (u * u + y * y).sqrt());
                let [a, b, c, d] = size.map(|size| size.max(1.0));
                let inverse = 1.0 / (a * b * (c * d));
                let (per_ab, per_cd) = (inverse * (c * d), inverse * (a * b));
                let inverse = [per_ab * b, per_ab * a, per_cd * d, per_cd * c];
                let force: [f64; 4] = from_fn(|k| inverse[k] + (1.0 - size[k]).max(0.0));
                let [a, b, c, d] = from_fn(|k| force[k] * u[k]);
                sums[0][lane] += weights[0] * (a + b - (c + d));
                sums[1][lane] += weights[0] * (force[0] + force[1] - (force[2] + force[3]));
                sums[2][lane] += weights[1] * (a - b - (c - d));
                sums[3][lane] += weights[2] * (a + b);
                for k in 0..4 {
                    let slope = match size[k] {
                        size if size > 1.0 => -(1.0 / size) * ((1.0 / size) * (1.0 / size)),
                        size if size > 0.0 => -(1.0 / size),
                        _ => 0.0,
                    };
                    let mut xx = weights[0] * force[k] + weights[0] * slope * u[k] * u[k];
                    for sum in &mut slopes[k / 2] {
                        sum[lane] += xx;
                        xx *= if k % 2 == 0 { place } else { -place };
                    }
                }
            }
        }
        let total = |[a, b, c, d]: [f64; WIDTH]| (a + b) + (c + d);
        let [x, lateral, moment, second] = sums.map(total);
        ([x, lateral * y, -moment, second], slopes.map(|slopes| slopes.map(total)))
    }

    /// Arguments of every size and sign.
    fn arguments() -> impl Iterator<Item = [f64; 4]> {
        let sizes = [0.0, 1e-200, 1e-9, 0.1, -0.7, 1.9, -2.0, 30.0, 1e12];
        let pairs = move || sizes.into_iter().flat_map(move |a| sizes.map(|b| (a, b)));
        pairs().flat_map(move |(x, y)| pairs().map(move |(spin, curvature)| [x, y, spin, curvature]))
    }

    #[test]
    fn invariant_vectors_of_strips_have_the_bits_of_strips_one_by_one() {
        for q in arguments() {
            let (expected, [curved, flat]) = plainly(q);
            let (values, gradient) = curvature_effect_with_gradient(q);
            assert_eq!(curvature_effect(q), expected, "{q:?}");
            assert_eq!(values, expected, "{q:?}");
            let slopes = [
                (gradient[0][0], curved[0] - flat[0]),
                (gradient[0][2], -curved[1] - -flat[1]),
                (gradient[2][2], curved[2] - flat[2]),
                (gradient[2][3], curved[3]),
                (gradient[3][3], -curved[4]),
            ];
            for (ours, expected) in slopes {
                assert_eq!(ours, 0.5 * expected, "{q:?}");
            }
        }
    }

    #[test]
    fn invariant_effects_of_four_contacts_have_the_bits_of_one() {
        let all: Vec<[f64; 4]> = arguments().collect();
        for (number, q) in all.iter().enumerate() {
            let four: [&[f64; 4]; WIDTH] =
                from_fn(|lane| if lane == 1 { q } else { &all[(7 * number + lane) % all.len()] });
            let together = CurvatureEffect.values::<Lanes>(from_fn(|k| Lanes::from_fn(|lane| four[lane][k])));
            for lane in 0..WIDTH {
                assert_eq!(
                    together.map(|lanes| lanes.0[lane]),
                    curvature_effect(*four[lane]),
                    "{:?}",
                    four[lane]
                );
            }
        }
    }

    #[test]
    fn closed_form_strips_after_carter() {
        // Strip by strip with a root and a quotient each.
        for q in arguments() {
            let [x, y, spin, curvature] = q.map(|q| 0.5 * q);
            let (mut sums, mut weights) = ([0.0; 4], 0.0);
            for k in 0..STRIPS {
                let (sin, place) = (std::f64::consts::PI * (k as f64 + 0.5) / STRIPS as f64).sin_cos();
                let weight = sin.powi(3);
                let force = |curvature: f64| {
                    let ux = x - (spin + curvature * place) * place;
                    let size = ux.hypot(y);
                    let force = if size > 1.0 { 1.0 / size } else { 2.0 - size };
                    [force * ux, force * y]
                };
                let ([bent, lateral], [flat, flat_lateral]) = (force(curvature), force(0.0));
                let changes =
                    [bent - flat, lateral - flat_lateral, -place * (bent - flat), place * place * bent];
                for (sum, change) in sums.iter_mut().zip(changes) {
                    *sum += weight * change;
                }
                weights += weight;
            }
            for (ours, sum) in curvature_effect(q).into_iter().zip(sums) {
                assert!((ours - sum / weights).abs() < 1e-13, "{q:?}: {ours} {}", sum / weights);
            }
        }
    }
}
