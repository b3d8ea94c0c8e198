//! Spalls of a race: how far a ball drops into a rectangular hole of its raceway, and the force along the way.
//!
//! A ball bridges a hole by its conformity with the groove, not by the depth: over the middle of a spall of a length `L` along
//! rolling, a width `W` and a depth `H` it stands on the edges. With `s` the arc from the middle, `x = L/2 - |s|` and the half width `b` of the
//! contact along rolling, `x' = (x + sqrt(x^2 + b^2))/2`, the drop is
//! `((rho_x x'^2/2)^-3.1 + (1.31 rho_y W^2/8)^-3.1 + H^-3.1)^(-1/3.1)`: a form whose three constants were fitted to boundary elements (elastic
//! half-space, sharp edges that do not yield; 1 to 2 mm long on a 6206's outer race, 300 and 1000 N) by the law below. For Newton's
//! method `|s|` is rounded over 0.3 b, and `x'` ends where it is 0.03 of a typical half width. A contact off the middle of the width, at an arc `y`, has
//! `W (1 - u^2)^2` in place of `W`, `u = y/(W/2 + a)`, so that the drop ends where a typical half axis `a` is beyond the side: an estimate
//! that no data support yet.
//!
//! The load is that of the approach less the drop, and `b` is that of the contact that carries this load on a whole race: both are
//! found together. The force on the ball is the derivative of the energy by its place, with a normal turned by the drop's
//! slope, so that no energy is made; as `b` follows the approach, it is a few per cent off Hertz's load at the edges.

use crate::numerics::elementary::pow;
use crate::numerics::scalar::{Dual, Scalar, Single, SmoothMap, Values};

/// Exponent of the sum of what carries the ball.
const EXPONENT: f64 = 3.1;
/// Half widths of the contact over which an edge is rounded.
const ROUNDING: f64 = 1.0;
/// Half widths of the contact over which the middle is rounded.
const MIDDLE: f64 = 0.3;
/// [-] x' over a typical half width of a contact from which the ball drops.
const BEGIN: f64 = 0.03;
/// Drop over the sides of the width over that of a rigid ball.
const SIDES: f64 = 1.31;
/// \[m] approach, and drop, below which nothing is resolved.
const FLOOR: f64 = 1e-12;
/// Iterations of the approach that carries the load; a few are enough.
const MAX_ITERATIONS: u32 = 50;
/// \[m] change of that approach that ends them.
const RESOLVED: f64 = 1e-16;
/// \[m] approach added so that a contact about to open has a size.
const TOUCH: f64 = 1e-9;

/// A spall of a race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spall {
    /// \[rad] azimuth of its middle, from the race's own y axis towards z.
    pub azimuth: f64,
    /// \[rad] contact angle of its middle.
    pub angle: f64,
    /// \[m] length along rolling.
    pub length: f64,
    /// \[m] width across.
    pub width: f64,
    /// \[m] depth.
    pub depth: f64,
}

/// The contact of a ball with a race where nothing is damaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whole {
    /// [1/m] sums of the curvatures of ball and race, along rolling and across.
    pub curvatures: [f64; 2],
    /// [m^0.5] semi-axes along rolling and across over the root of the approach.
    pub semi_axes: [f64; 2],
    /// \[m] approach of a typical load.
    pub typical_approach: f64,
    /// \[m] radius of the groove.
    pub groove_radius: f64,
    /// \[m] radius of the circle of groove centres.
    pub circle_radius: f64,
    /// [-] side on which the groove is, seen from its centre: 1 away from the axis (outer race), -1 towards it.
    pub side: f64,
}

/// All spalls of a race.
#[derive(Clone, Debug, PartialEq)]
pub struct Spalls {
    spalls: Vec<Spall>,
    whole: Whole,
}

/// Drop of a ball, and its derivatives by azimuth \[rad], angle of the contact \[rad] and approach \[m].
#[derive(Clone, Copy, Debug)]
pub(super) struct Drop<S> {
    pub depth: S,
    pub by_azimuth: S,
    pub by_angle: S,
    pub by_approach: S,
}

impl Spalls {
    /// Spalls of a race on which balls roll like this; none without any.
    pub fn new(spalls: Vec<Spall>, whole: Whole) -> Option<Self> {
        (!spalls.is_empty()).then_some(Self { spalls, whole })
    }

    /// All of them.
    pub fn each(&self) -> &[Spall] {
        &self.spalls
    }

    /// \[m] radius at which contacts with a spall's middle run around the race.
    pub fn radius(&self, spall: &Spall) -> f64 {
        self.whole.circle_radius + self.whole.side * self.whole.groove_radius * spall.angle.cos()
    }

    /// \[m] half width along rolling of a contact under a typical load.
    pub fn typical_half_width(&self) -> f64 {
        self.half_width(self.whole.typical_approach)
    }

    /// \[m] half axis across rolling of a contact under a typical load.
    pub fn typical_half_axis(&self) -> f64 {
        self.whole.semi_axes[1] * self.whole.typical_approach.sqrt()
    }

    /// \[m] half width along rolling of a contact at an approach \[m].
    fn half_width(&self, approach: f64) -> f64 {
        self.whole.semi_axes[0] * approach.max(0.0).sqrt()
    }

    /// \[m] arc on either side of a spall's middle along which a ball at an approach \[m] drops.
    fn reach(&self, spall: &Spall, approach: f64) -> f64 {
        let begin = BEGIN * self.half_width(self.whole.typical_approach);
        0.5 * spall.length + (0.5 * ROUNDING * self.half_width(approach)).powi(2) / begin - begin
    }

    /// The drop at an azimuth, an angle of the contact about the groove's centre and an approach where nothing is damaged.
    #[inline(always)]
    pub(super) fn under<S: Scalar>(&self, azimuth: S, along: S, out: S, approach: S) -> Drop<S> {
        let side = self.whole.side;
        let [angle] = S::map_smooth_many([along, out], |[along, out]| {
            let square = along * along + out * out;
            ([(side * along).atan2(side * out)], [[out / square, -along / square]])
        });
        let [depth, by_azimuth, by_angle, by_approach] = S::apply(self, [azimuth, angle, approach]);
        Drop { depth, by_azimuth, by_angle, by_approach }
    }

    /// Drop and derivatives by the three arguments; the approach is that of a race without spalls.
    fn at<T: Single>(&self, [azimuth, angle, approach]: [T; 3]) -> [T; 4] {
        let place = [azimuth, angle].map(T::value);
        // Spalls as a contact of no more than its own approach meets them. Where there is none, nothing is solved.
        let mut own = approach.value();
        if self.under_load([place[0], place[1], own]) == [0.0; 4] {
            return [T::zero(); 4];
        }
        for _ in 0..MAX_ITERATIONS {
            let [depth, .., slope] = self.under_load([place[0], place[1], own]);
            let change = (own + depth - approach.value()) / (1.0 + slope);
            own -= change;
            // NaN ends it, too.
            let goes_on = change.abs() > RESOLVED;
            if !goes_on {
                break;
            }
        }
        // The last correction brings the derivatives of the root.
        let [depth, .., slope] = self.under_load([azimuth, angle, T::constant(own)]);
        let own = T::constant(own) - (T::constant(own) + depth - approach).scale(1.0 / (1.0 + slope.value()));
        let [_, by_azimuth, by_angle, slope] = self.under_load([azimuth, angle, own]);
        let rest = T::one() + slope;
        [approach - own, by_azimuth / rest, by_angle / rest, slope / rest]
    }

    /// Drop of a contact that carries its load by an approach \[m] of its own, and its derivatives by azimuth, angle and that.
    fn under_load<T: Single>(&self, [azimuth, angle, approach]: [T; 3]) -> [T; 4] {
        let mut sums = [T::zero(); 4];
        for spall in &self.spalls {
            let arc = (azimuth - T::constant(spall.azimuth)).map_smooth(|x| {
                let turns = (x / std::f64::consts::TAU).round();
                (x - turns * std::f64::consts::TAU, 1.0)
            });
            let radius = self.radius(spall);
            let reach = self.reach(spall, approach.value() + TOUCH);
            let near = arc.value().abs() * radius < reach;
            if !near {
                continue;
            }
            let across = (angle - T::constant(spall.angle)).scale(self.whole.groove_radius);
            let [depth, by_arc, by_across, by_approach] =
                self.drop_into(spall, arc.scale(radius), across, approach);
            let one = [depth, by_arc.scale(radius), by_across.scale(self.whole.groove_radius), by_approach];
            sums.iter_mut().zip(one).for_each(|(sum, x)| *sum += x);
        }
        sums
    }

    /// Drop into one spall at arcs along and across \[m] and an approach \[m], and its derivatives by these.
    fn drop_into<T: Single>(&self, spall: &Spall, arc: T, across: T, approach: T) -> [T; 4] {
        let Whole { curvatures: [rolling, transverse], semi_axes: [along_root, _], .. } = self.whole;
        let touching = T::one().where_positive(approach, T::zero());
        let size = approach.positive_part() + T::constant(TOUCH);
        let square_slope = along_root * along_root;
        // x = L/2 - |s|, rounded
        let rounded = (arc.square() + size.scale(square_slope * MIDDLE * MIDDLE)).sqrt();
        let unit = arc / rounded;
        let x = T::constant(0.5 * spall.length) - arc * unit;
        let x_by_arc = -unit * (T::constant(2.0) - unit.square());
        let x_by_approach = unit.square() * (T::constant(0.5 * square_slope * MIDDLE * MIDDLE) / rounded);
        // x'
        let wide = square_slope * ROUNDING * ROUNDING;
        let root = (x.square() + size.scale(wide)).sqrt();
        let begin = BEGIN * self.typical_half_width();
        let inside = ((x + root).scale(0.5) - T::constant(begin)).positive_part();
        let inside_by_x = (T::one() + x / root).scale(0.5);
        let inside_by_approach = inside_by_x * x_by_approach + T::constant(0.25 * wide) / root;
        let ends = inside.square().scale(0.5 * rolling) + T::constant(FLOOR);
        let ends_by_arc = (inside * inside_by_x * x_by_arc).scale(rolling);
        let ends_by_approach = (inside * inside_by_approach).scale(rolling);
        // sides
        let limit = 0.5 * spall.width + self.typical_half_axis();
        let off = across.scale(1.0 / limit);
        let cover = T::one_minus(off.square()).positive_part();
        let rigid = 0.125 * SIDES * transverse * spall.width * spall.width;
        let sides = cover.square().square().scale(rigid) + T::constant(FLOOR);
        let sides_by_across = (cover.square() * cover * off).scale(-8.0 * rigid / limit);
        // all of them
        let inverse = |p: T| p.map_smooth(|p| (pow(p, -EXPONENT), -EXPONENT * pow(p, -EXPONENT - 1.0)));
        let sum = inverse(ends) + inverse(sides) + T::constant(pow(spall.depth, -EXPONENT));
        let depth = sum.map_smooth(|sum| {
            let depth = pow(sum, -1.0 / EXPONENT);
            (depth, -depth / (EXPONENT * sum))
        });
        let share =
            |p: T| (depth / p).map_smooth(|x| (pow(x, EXPONENT + 1.0), (EXPONENT + 1.0) * pow(x, EXPONENT)));
        let [of_ends, of_sides] = [share(ends), share(sides)];
        [depth, of_ends * ends_by_arc, of_sides * sides_by_across, of_ends * ends_by_approach * touching]
    }
}

impl SmoothMap<3, 4> for Spalls {
    #[inline(always)]
    fn values<V: Values>(&self, x: [V; 3]) -> [V; 4] {
        V::each(x, |x| self.at(x))
    }

    fn with_gradient(&self, x: [f64; 3]) -> ([f64; 4], [[f64; 3]; 4]) {
        let results = self.at([0, 1, 2].map(|i: usize| Dual::<3>::variable(x[i], i, 1.0)));
        (results.map(|result| result.value), results.map(|result| result.derivatives))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spalls() -> Spalls {
        let spall = |azimuth| Spall { azimuth, angle: 0.3, length: 1e-3, width: 3e-3, depth: 1e-4 };
        let whole = Whole {
            curvatures: [173.957, 11.885],
            semi_axes: [0.05967, 0.34083],
            typical_approach: 4.76e-6,
            groove_radius: 5.048e-3,
            circle_radius: 22.7e-3,
            side: 1.0,
        };
        Spalls::new(vec![spall(0.0), spall(2.0)], whole).unwrap()
    }

    #[test]
    fn derivatives_agree_with_differences_and_nothing_drops_beyond_the_reach() {
        let spalls = spalls();
        let steps = [1e-8, 1e-6, 1e-11];
        for i in 0..60 {
            let azimuth = 2.0 + 0.0025 * (f64::from(i) - 30.0);
            for angle in [0.3, 0.36, 0.5] {
                let x = [azimuth, angle, 5e-6];
                let (values, gradient) = spalls.with_gradient(x);
                assert_eq!(values, spalls.values(x));
                for k in 0..3 {
                    let moved = |by: f64| {
                        let mut x = x;
                        x[k] += by;
                        spalls.at(x)
                    };
                    let (before, after) = (moved(-steps[k]), moved(steps[k]));
                    for m in 0..4 {
                        let difference = (after[m] - before[m]) / (2.0 * steps[k]);
                        let scale = [1e-6, 1e-3, 1e-4, 0.3][m] / [1e-3, 1e-1, 1e-6][k];
                        let error = (gradient[m][k] - difference).abs();
                        assert!(error < 1e-3 * scale, "{x:?} {m} {k}: {} {difference}", gradient[m][k]);
                    }
                    // The slopes are those of the drop.
                    let difference = (after[0] - before[0]) / (2.0 * steps[k]);
                    let scale = [1e-3, 1e-5, 1.0][k];
                    assert!(
                        (values[1 + k] - difference).abs() < 1e-4 * scale,
                        "{x:?} {k}: {values:?} {difference}"
                    );
                }
            }
        }
        assert_eq!(spalls.at([1.0, 0.3, 5e-6]), [0.0; 4]);
        assert!(spalls.at([2.0, 0.3, 5e-6])[0] > 1.2e-5);
        // A contact beyond the side.
        assert!(spalls.at([2.0, 0.3 + 0.5, 5e-6])[0] <= 1.1 * FLOOR);
    }
}
