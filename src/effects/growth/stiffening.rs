//! Hertz stiffness of a contact whose dimensions have changed a little.
//!
//! Tables of a raceway's contacts ([`crate::contact::shape`]) are those of cold dimensions. What growth changes of them are the
//! radius of the ball and, above all, the difference of the curvatures of ball and groove, which is small: balls of ceramic in
//! races of steel lose 2 % of it in 100 K. Stiffness is nearly a product of powers of both: its logarithm over that of the table
//! is a polynomial of second order in the logarithms of both changes; what is left out is below 1e-7 at 100 K (tested). The
//! curvature of the raceway along its circumference is exact anyway.

use crate::contact::hertz::HertzContact;
use crate::contact::raceway::Raceway;
use crate::numerics::elementary::{exp, ln};

/// Logarithm of the stiffness over that of cold dimensions, as a polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffening {
    /// \[m] cold radius of the ball.
    ball: f64,
    /// [1/m] cold difference of the curvatures of ball and groove.
    transverse: f64,
    /// [-] derivatives by logarithms of ball radius and transverse curvature: first ones.
    slopes: [f64; 2],
    /// [-] second ones: both by the ball, mixed, both by the curvature.
    bends: [f64; 3],
}

/// [-] change of the logarithm of the ball radius for differences: wide enough for second ones to have eight digits.
const BALL_STEP: f64 = 1e-3;
/// [-] change of the logarithm of the transverse curvature for differences: what ceramic balls do in 50 K.
const CURVATURE_STEP: f64 = 1e-2;

impl Stiffening {
    /// Contacts of balls of a radius \[m] with a raceway that has a curvature [1/m] along its circumference there.
    pub fn new(ball: f64, raceway: &Raceway, circumferential: f64) -> Self {
        let transverse = 1.0 / ball - 1.0 / raceway.groove_radius;
        let stiffness = |u: f64, w: f64| {
            let rolling = 1.0 / (ball * exp(u)) + circumferential;
            // Elastic constants drop out of the ratio.
            HertzContact::new(rolling, transverse * exp(w), 1e-11).stiffness
        };
        let cold = stiffness(0.0, 0.0);
        let at = |i: f64, k: f64| ln(stiffness(i * BALL_STEP, k * CURVATURE_STEP) / cold);
        let second = |plus: f64, minus: f64, step: f64| (plus + minus) / (step * step);
        let mixed = at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0);
        Self {
            ball,
            transverse,
            slopes: [
                (at(1.0, 0.0) - at(-1.0, 0.0)) / (2.0 * BALL_STEP),
                (at(0.0, 1.0) - at(0.0, -1.0)) / (2.0 * CURVATURE_STEP),
            ],
            bends: [
                second(at(1.0, 0.0), at(-1.0, 0.0), BALL_STEP),
                mixed / (4.0 * BALL_STEP * CURVATURE_STEP),
                second(at(0.0, 1.0), at(0.0, -1.0), CURVATURE_STEP),
            ],
        }
    }

    /// [-] stiffness over the cold one, of a ball and a groove of these radii \[m]; 1 to the bit for cold ones.
    pub fn at(&self, ball: f64, groove: f64) -> f64 {
        let u = ln(ball / self.ball);
        let w = ln((1.0 / ball - 1.0 / groove) / self.transverse);
        let [by_ball, by_curvature] = self.slopes;
        let [uu, uw, ww] = self.bends;
        exp(by_ball * u + by_curvature * w + 0.5 * (uu * u * u + ww * w * w) + uw * u * w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_stiffness_of_grown_contacts_is_that_of_hertz() {
        let (ball, groove, circle) = (4.7625e-3, 4.953e-3, 23.188e-3);
        let raceway = Raceway { groove_radius: groove, groove_circle_radius: circle, groove_offset: 0.0 };
        let curvature = 1.0 / (circle - groove);
        let stiffening = Stiffening::new(ball, &raceway, curvature);
        assert_eq!(stiffening.at(ball, groove), 1.0);
        let hertz = |ball: f64, groove: f64| {
            HertzContact::new(1.0 / ball + curvature, 1.0 / ball - 1.0 / groove, 1e-11).stiffness
        };
        // Steel at -60 K and +100 K, ceramic balls at 100 K, and balls alone.
        for [by_ball, by_groove] in [[-7.2e-4, -7.2e-4], [1.2e-3, 1.2e-3], [3.2e-4, 1.2e-3], [5e-4, 0.0]] {
            let (warm_ball, warm_groove) = (ball * (1.0 + by_ball), groove * (1.0 + by_groove));
            let exact = hertz(warm_ball, warm_groove) / hertz(ball, groove);
            let ours = stiffening.at(warm_ball, warm_groove);
            assert!((ours - exact).abs() < 1e-7, "{by_ball} {by_groove}: {ours} {exact}");
            // It is worth having.
            assert!((exact - 1.0).abs() > 2e-4, "{exact}");
        }
    }
}
