//! Weights in the objective of Kalker's nonlinear problem: of slip against traction, and of the points of the grid.
//!
//! The objective vanishes at Coulomb's law whatever they are, but polynomials do not reach it everywhere, and weights say
//! where they shall come near. At small creepages a contact sticks but for a narrow zone at its trailing edge. Tractions
//! of full adhesion rise there without bound, `1/sqrt(1 - r^2)`, and so the zone has most of the objective: with points by
//! their areas and slip by a constant, the solution gives up adhesion everywhere to make it less, and forces are 10 to 40 %
//! low. Towards rest the zone therefore counts by a power of the pressure, and slip by the inverse of the creepages, so
//! that it stays as large beside the bound as it is near sliding: what remains in the end is linear theory. Near
//! sliding areas and a constant have the smallest errors. Between, both change smoothly with the linear force of a uniform
//! slip as large as the rms rigid slip.

use super::ScaledCreepage;
use super::nonlinear::{Kalker, Point};

/// [-] weight k of slip against traction near sliding.
const SLIDING: f64 = 2.0;
/// [-] what slip weighs more at small creepages, times the size of these over the linear response.
const ADHESION: f64 = 0.9;
/// [-] size of creepages at which half of that is left.
const ADHESION_ENDS: f64 = 0.8;
/// [-] size of creepages below which slip weighs no more: there hardly a point of the grid slides.
const REST: f64 = 0.01;
/// [-] power of the pressure that points are weighted by at rest, and size of creepages at which half of that is left.
const PRESSURE_POWER: f64 = 1.15;
const PRESSURE_ENDS: f64 = 0.5;
/// [-] square of the size beyond which contacts slide as a whole.
const LARGEST: f64 = 1e12;

impl Point {
    /// Weight of the point at rest.
    pub(super) fn weight_at_rest(&self) -> f64 {
        self.weight * self.bound.powf(PRESSURE_POWER)
    }
}

/// Weights at some creepages, with derivatives by these.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    /// [-] weight k of slip against traction in the projection.
    pub(super) slip: f64,
    pub(super) slip_by_creepage: [f64; 4],
    /// [-] share of the points' weights at rest in their weights; that of areas is the rest.
    pub(super) rest: f64,
    pub(super) rest_by_creepage: [f64; 4],
}

/// `1/(1 + (x/half)^2)` and its slope: of squares of sizes.
fn fading(x: f64, half: f64) -> (f64, f64) {
    let value = 1.0 / (1.0 + (x / half).powi(2));
    (value, -2.0 * x / (half * half) * value * value)
}

impl Weights {
    pub(super) fn new(kalker: &Kalker, h: &ScaledCreepage) -> Self {
        // mean square of the rigid slip over the pressure, of which y^2 has the mean b^2/5 and y^4 3 b^4/35
        let (a, b) = (kalker.patch.axis_ratio, 1.0 / kalker.patch.axis_ratio);
        let (square, fourth) = (b / 5.0, 3.0 * b * b / 35.0);
        let by_creepage =
            [h.x - h.curvature * square, h.y, h.spin * (a + b) / 5.0, h.curvature * fourth - h.x * square];
        let mean_square = by_creepage[0] * h.x
            + by_creepage[1] * h.y
            + by_creepage[2] * h.spin
            + by_creepage[3] * h.curvature;
        let scale = kalker.response * kalker.response;
        let size = (scale * mean_square).min(LARGEST);
        let inner = 2.0 * scale;
        let chain = |slope: f64| match size < LARGEST {
            true => by_creepage.map(|component| slope * inner * component),
            false => [0.0; 4],
        };
        let more = ADHESION * kalker.response;
        let inverse = 1.0 / (size + REST * REST).sqrt();
        let (adhesion, adhesion_slope) = fading(size, ADHESION_ENDS * ADHESION_ENDS);
        let (rest, rest_slope) = fading(size, PRESSURE_ENDS * PRESSURE_ENDS);
        let slope = more * (inverse * adhesion_slope - 0.5 * inverse.powi(3) * adhesion);
        Self {
            slip: SLIDING + more * inverse * adhesion,
            slip_by_creepage: chain(slope),
            rest,
            rest_by_creepage: chain(rest_slope),
        }
    }

    /// Weight of a point, and its derivative by the share of the one at rest.
    pub(super) fn of(&self, point: &Point) -> (f64, f64) {
        let by_share = point.weight_at_rest() - point.weight;
        (point.weight + self.rest * by_share, by_share)
    }
}
