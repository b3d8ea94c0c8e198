//! Spalls of balls: the hole of [`super::spall`] in the ball, where it meets a race.
//!
//! On both sides of a contact the hole is the same to the half-space that it was computed for: what counts is the sum of the curvatures of
//! ball and groove, so that a ball drops deeper into the same hole on the race that fits it less. The place of the contact on the ball is
//! that of the normal `n` without damage, in axes fixed in the ball: `e` out through the middle of the spall, `t` along its length, `w`
//! across. With the drop `D(n, e, delta)` the approach is `delta - D`, and force and moment on the ball are the derivatives of
//! the energy by its place and by its rotation: `-Q grad(delta - D)` and `-Q n x dD/dn`. The moment is that of a load that stands on an edge
//! and not in the middle; the race has the opposite, so that a pair turns nothing as a whole.

use nalgebra::{UnitQuaternion, Vector3};

use super::spall::{Spall, Spalls, Whole};
use crate::numerics::scalar::{Scalar, constant_vector, dot};

/// [-] square of a distance from the spall's pole, on a ball of radius 1, below which azimuths mean nothing.
const POLE: f64 = 1e-30;

/// A spall of a ball.
#[derive(Clone, Debug, PartialEq)]
pub struct OnBall {
    /// The ball (0 is the first).
    pub ball: usize,
    /// Its place among the damaged balls.
    pub damaged: usize,
    /// [-] directions from the ball's centre out through the middle, along the length, and across, in the ball's own axes.
    pub axes: [Vector3<f64>; 3],
    /// \[m] its length and width.
    pub size: [f64; 2],
    hole: Spalls,
}

/// Spalls of balls as a race meets them.
#[derive(Clone, Debug, PartialEq)]
pub struct BallSpalls(pub Vec<OnBall>);

/// Damaged balls during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damage<'a> {
    /// Their spalls.
    pub spalls: &'a BallSpalls,
    /// Orientation of each damaged ball.
    pub orientations: &'a Vec<UnitQuaternion<f64>>,
}

impl Damage<'_> {
    /// Each spall with the orientation of its ball.
    #[inline(always)]
    pub(super) fn each(&self) -> impl Iterator<Item = (&OnBall, &UnitQuaternion<f64>)> {
        self.spalls.0.iter().map(|spall| (spall, &self.orientations[spall.damaged]))
    }
}

/// Drop \[m], its derivative by the normal \[m], which is along the ball's surface, and by the approach [-].
#[derive(Clone, Copy, Debug)]
pub(super) struct Drop<S: Scalar> {
    pub depth: S,
    pub by_normal: Vector3<S>,
    pub by_approach: S,
}

impl OnBall {
    /// A spall of a ball of a radius \[m], which is the one of this place among the damaged ones. Azimuth and angle are those of the ball's
    /// own axes; `whole` is its contact with a race.
    pub fn new([ball, damaged]: [usize; 2], spall: &Spall, radius: f64, whole: Whole) -> Option<Self> {
        let (sine, cosine) = spall.angle.sin_cos();
        let (z, y) = spall.azimuth.sin_cos();
        let axes = [
            Vector3::new(sine, cosine * y, cosine * z),
            Vector3::new(0.0, -z, y),
            Vector3::new(cosine, -sine * y, -sine * z),
        ];
        // A ball is a groove circle without a radius and a groove of the ball's.
        let whole = Whole { groove_radius: radius, circle_radius: 0.0, side: 1.0, ..whole };
        let hole = Spalls::new(vec![Spall { azimuth: 0.0, angle: 0.0, ..*spall }], whole)?;
        Some(Self { ball, damaged, axes, size: [spall.length, spall.width], hole })
    }

    /// \[m] half width along rolling of a contact under a typical load.
    pub fn typical_half_width(&self) -> f64 {
        self.hole.typical_half_width()
    }

    /// \[m] half axis across rolling of a contact under a typical load.
    pub fn typical_half_axis(&self) -> f64 {
        self.hole.typical_half_axis()
    }

    /// [-] 1 for the ball that has it, of several from a first one on; 0 for the others.
    #[inline(always)]
    pub(super) fn owner<S: Scalar>(&self, first: usize) -> S {
        S::by_lane(|lane| if first + lane == self.ball { 1.0 } else { 0.0 })
    }

    /// The drop where its ball, which `owner` marks among several, is touched along a normal, at an approach \[m] before this spall.
    #[inline(always)]
    pub(super) fn under<S: Scalar>(
        &self,
        owner: S,
        orientation: &UnitQuaternion<f64>,
        normal: &Vector3<S>,
        approach: S,
    ) -> Drop<S> {
        let axes = self.axes.map(|axis| constant_vector::<S>(&(orientation * axis)));
        let [out, along, across] = axes.each_ref().map(|axis| dot(normal, axis));
        let square = out.square() + along.square() + S::constant(POLE);
        let radius = square.sqrt();
        let [azimuth, angle] = S::map_smooth_many([out, along, across], |[out, along, across]| {
            let square = out * out + along * along + POLE;
            let (radius, whole) = (square.sqrt(), square + across * across);
            let by_radius = -across / (radius * whole);
            (
                [along.atan2(out), across.atan2(radius)],
                [[-along / square, out / square, 0.0], [by_radius * out, by_radius * along, radius / whole]],
            )
        });
        // Other balls are whole.
        let [depth, by_azimuth, by_angle, by_approach] =
            S::apply(&self.hole, [azimuth, angle, approach]).map(|x| x * owner);
        let of_azimuth = (axes[1] * out - axes[0] * along) * (by_azimuth / square);
        let towards = (axes[0] * out + axes[1] * along) * (across / radius);
        let of_angle = (axes[2] * radius - towards) * (by_angle / (square + across.square()));
        Drop { depth, by_normal: of_azimuth + of_angle, by_approach }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::scalar::Dual;

    const RADIUS: f64 = 4.7625e-3;

    fn spall() -> OnBall {
        let whole = Whole {
            curvatures: [173.957, 11.885],
            semi_axes: [0.05967, 0.34083],
            typical_approach: 4.76e-6,
            groove_radius: 5.048e-3,
            circle_radius: 22.7e-3,
            side: 1.0,
        };
        let spall = Spall { azimuth: 0.4, angle: -0.2, length: 1e-3, width: 2e-3, depth: 1e-4 };
        OnBall::new([3, 0], &spall, RADIUS, whole).unwrap()
    }

    #[test]
    fn derivatives_are_differences_and_other_balls_are_whole() {
        let spall = spall();
        let turned = UnitQuaternion::new(Vector3::new(0.3, -1.2, 0.7));
        let [out, along, across] = spall.axes.map(|axis| turned * axis);
        let drop = |normal: &Vector3<f64>| spall.under(1.0, &turned, normal, 5e-6);
        let middle = drop(&out);
        assert!(middle.depth > 3e-6 && middle.by_normal.norm() < 1e-12, "{middle:?}");
        for (s, y) in [(0.0, 0.0), (0.05, 0.0), (0.1, 0.03), (-0.11, -0.1), (0.09, 0.15)] {
            let normal = (out + along * s + across * y).normalize();
            let here = drop(&normal);
            assert!(here.by_normal.dot(&normal).abs() < 1e-12);
            for direction in [along, across] {
                let tangent = direction - normal * normal.dot(&direction);
                let [before, after] = [-1e-6, 1e-6].map(|by| drop(&(normal + tangent * by).normalize()));
                let difference = (after.depth - before.depth) / 2e-6;
                let ours = here.by_normal.dot(&tangent);
                assert!((ours - difference).abs() < 1e-7 + 1e-4 * ours.abs(), "{s} {y}: {ours} {difference}");
                let by = |i: usize| Dual::<1>::variable(normal[i], 0, tangent[i]);
                let dual = Vector3::new(by(0), by(1), by(2));
                let exact = spall.under(Dual::constant(1.0), &turned, &dual, Dual::constant(5e-6));
                assert!((exact.depth.derivatives[0] - ours).abs() < 1e-9 + 1e-9 * ours.abs());
                for i in 0..3 {
                    let second = (after.by_normal[i] - before.by_normal[i]) / 2e-6;
                    let ours = exact.by_normal[i].derivatives[0];
                    assert!((ours - second).abs() < 1e-4 + 1e-3 * ours.abs(), "{s} {y}: {ours} {second}");
                }
            }
            let other = spall.under(0.0, &turned, &normal, 5e-6);
            assert_eq!((other.depth, other.by_approach, other.by_normal.norm()), (0.0, 0.0, 0.0));
            assert_eq!([2, 3, 4].map(|ball| spall.owner::<f64>(ball)), [0.0, 1.0, 0.0]);
        }
        // Behind the ball, and at the poles.
        for normal in [-out, across, -across] {
            let there = drop(&normal);
            assert!(there.depth < 1e-11 && there.by_normal.norm() < 1e-9, "{there:?}");
        }
    }
}
