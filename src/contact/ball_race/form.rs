//! Form of a race: how far its groove departs from a torus along the circumference, waves of manufacture or of a housing.
//!
//! The circle of groove centres has the radius `R + w(th)` and the offset `x + v(th)`, with the azimuth `th` counted from
//! the race's own y axis. With `c`, `s` the cosine and sine of the normal's angle in the plane of the ball, the approach changes
//! along the circumference by `-(c w' + s v')`: the normal leans by that over the distance `rho` from the axis. Without it the
//! waves would push balls in and let them out with energy from nowhere.
//!
//! Left out: the waves' own curvature, `n^2 w/R^2` of 1e-3 of that of the contact, and that a contact of half width `b` averages a wave of
//! order `n`: `3 (sin q - q cos q)/q^3` with `q = n b/R`, 0.975 at 0.5 and 0.9 at 1, beyond which waves are refused.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::shift::{Shift, azimuth};
use crate::contact::motion::RaceMotion;
use crate::numerics::periodic_spline::PeriodicSpline;
use crate::numerics::scalar::Scalar;

/// Points of the spline to the shortest wave: its values are then right within 3e-7 of the amplitude.
const POINTS_PER_WAVE: usize = 64;
/// [-] order over half width of the contact and radius of the race beyond which a wave is shorter than the contact that should
/// follow it.
pub const SHORTEST: f64 = 1.0;
/// [-] amplitude over the largest one of a profile below which an order is taken for noise of the measurement.
const NOISE: f64 = 0.01;

/// A wave of a race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// [-] waves around the race.
    pub order: usize,
    /// \[m] amplitude; positive is away from the axis, or towards +x.
    pub amplitude: f64,
    /// \[rad] angle `p` of `cos(order th - p)`.
    pub phase: f64,
    /// Does it move the groove along the axis, and not away from it?
    pub axial: bool,
}

/// Form of a race.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// \[m] away from the axis, and along it.
    spline: PeriodicSpline<2>,
    /// [-] order of the shortest wave.
    pub order: f64,
    /// \[rad] turn of the form on the race, from its y axis towards z.
    turn: f64,
}

impl Form {
    /// The form of some waves; none without any.
    pub fn of_waves(waves: &[Wave]) -> Option<Self> {
        let order = waves.iter().map(|wave| wave.order).max()?.max(1);
        let count = POINTS_PER_WAVE * order;
        let values: Vec<[f64; 2]> = (0..count)
            .map(|i| {
                let mut sums = [0.0; 2];
                for wave in waves {
                    // Whole turns are left out of the angle, where they would cost digits.
                    let turn = (wave.order * i % count) as f64 / count as f64;
                    sums[usize::from(wave.axial)] += wave.amplitude * (TAU * turn - wave.phase).cos();
                }
                sums
            })
            .collect();
        Some(Self { spline: PeriodicSpline::through(&values)?, order: order as f64, turn: 0.0 })
    }

    /// The form through points at equal distances around the race, the first on its y axis: `[radial, axial]` \[m].
    pub fn of_profile(points: &[[f64; 2]]) -> Option<Self> {
        Some(Self { spline: PeriodicSpline::through(points)?, order: shortest(points), turn: 0.0 })
    }

    /// Form turned on its race by an angle \[rad] from the race's y axis towards z.
    #[must_use]
    pub fn turned(self, angle: f64) -> Self {
        Self { turn: self.turn + angle, ..self }
    }

    /// The groove circle at an azimuth \[rad].
    pub fn at(&self, azimuth: f64) -> [f64; 2] {
        self.spline.at(azimuth - self.turn).map(|[value, ..]| value)
    }

    /// The groove circle where a ball is, `offset` \[m] from the race's origin.
    #[inline(always)]
    pub(super) fn under<S: Scalar>(&self, offset: &Vector3<S>, race: &RaceMotion<S>) -> Shift<S> {
        let azimuth = azimuth(offset, race);
        let [radial, radial_slope, axial, axial_slope] = S::map_smooth_many([azimuth], |[azimuth]| {
            let [w, v] = self.spline.at(azimuth - self.turn);
            ([w[0], w[1], v[0], v[1]], [w[1], w[2], v[1], v[2]].map(|slope| [slope]))
        });
        Shift { radial, radial_slope, axial, axial_slope }
    }
}

/// Highest order of a profile that is no noise.
fn shortest(points: &[[f64; 2]]) -> f64 {
    let count = points.len();
    let amplitude = |order: usize| {
        let mut sums = [0.0; 4];
        for (i, [radial, axial]) in points.iter().enumerate() {
            let (sin, cos) = (TAU * (order * i % count) as f64 / count as f64).sin_cos();
            sums.iter_mut()
                .zip([radial * cos, radial * sin, axial * cos, axial * sin])
                .for_each(|(s, x)| *s += x);
        }
        sums[0].hypot(sums[1]).max(sums[2].hypot(sums[3]))
    };
    let amplitudes: Vec<f64> = (1..=count / 2).map(amplitude).collect();
    let largest = amplitudes.iter().copied().fold(0.0, f64::max);
    let highest = amplitudes.iter().rposition(|amplitude| *amplitude > NOISE * largest);
    highest.map_or(1.0, |index| (index + 1) as f64)
}
