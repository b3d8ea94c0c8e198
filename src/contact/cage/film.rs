//! Films of oil around a cage: between its rings and the lands that guide it, and between balls and their pockets.
//!
//! Short journal bearings: the pressure of Reynolds' equation falls along the axis, and pulls nowhere (Ocvirk 1952; half Sommerfeld).
//! With the velocity `v` of one surface against the other half way between both centres, the gap closes by `m.v` in a direction
//! `m`. The film presses where it closes, with
//!
//! * `eta L^3 (m.v)/h^3` a unit of circumference in a land of width L,
//! * `3 pi sqrt(2) eta r^(3/2) (m.v)/h^(3/2)` between a ball of radius r and a cylinder, whose gap widens as `z^2/2r`.
//!
//! Shear is that of the gap all around (Petroff 1883), in a pocket of the ball in its middle. All of the work against both is lost.

use crate::numerics::elementary::pow;
use std::f64::consts::PI;

use nalgebra::Vector3;

use crate::numerics::scalar::{Scalar, cross, dot};

/// [m/s] closing speed below which its direction fades: films that hardly close hardly press.
const SLOWEST: f64 = 1e-6;
/// [-] gap over the clearance of a centred film below which films do not get thinner: surfaces touch there.
const THINNEST: f64 = 0.01;
/// Angles from the direction of closing, and weights: Gauss and Legendre.
const QUADRATURE: [(f64, f64); 12] = [
    (-1.5418318388012155, 0.07410284511124642),
    (-1.4201840652986215, 0.16797990046336778),
    (-1.2093602926139817, 0.2514504504753551),
    (-0.9225568852541117, 0.3191346476209631),
    (-0.5777883675058021, 0.36676921872847085),
    (-0.1967161780818201, 0.39135926439549307),
    (0.19671617808182015, 0.39135926439549307),
    (0.5777883675058021, 0.36676921872847085),
    (0.9225568852541117, 0.3191346476209631),
    (1.2093602926139817, 0.2514504504753551),
    (1.4201840652986215, 0.16797990046336778),
    (1.5418318388012155, 0.07410284511124642),
];

/// Two surfaces around each other: what their film sees, across the axis.
#[derive(Clone, Copy, Debug)]
pub struct Gap<S: Scalar> {
    /// [-] unit vector of the axis.
    pub axis: Vector3<S>,
    /// \[m] centre of the first surface from that of the second, in the direction in which the gap closes.
    pub eccentricity: Vector3<S>,
    /// [m/s] velocity of the first body less that of the second half way between both centres, across the axis.
    pub velocity: Vector3<S>,
    /// \[m] gap all around where they are concentric.
    pub clearance: f64,
}

impl<S: Scalar> Gap<S> {
    /// Force on the first body over a factor: the integral of `(m.v) m h^-n` over the directions in which the gap closes, with the
    /// power `n` of the gap h \[m].
    #[inline(always)]
    pub fn press(&self, power: f64) -> Vector3<S> {
        let least = S::constant((THINNEST * self.clearance).powi(2));
        let speed = (dot(&self.velocity, &self.velocity) + S::constant(SLOWEST * SLOWEST)).sqrt();
        let closing = self.velocity.map(|component| component / speed);
        let aside = cross(&self.axis, &closing);
        let mut sum = Vector3::from_element(S::zero());
        for (angle, weight) in QUADRATURE {
            let (sine, cosine) = angle.sin_cos();
            let direction = closing.map(|c| c.scale(cosine)) + aside.map(|c| c.scale(sine));
            let gap = (S::constant(self.clearance) - dot(&self.eccentricity, &direction)).positive_part();
            let gap = gap.square() + least;
            let pressure = gap.map_smooth(|square| {
                let value = pow(square, -0.5 * power);
                (value, -0.5 * power * value / square)
            });
            sum -= direction * (pressure * speed).scale(weight * cosine);
        }
        sum
    }

    /// [1/m] integral of the inverse gap over all directions.
    #[inline(always)]
    pub fn shear(&self) -> S {
        let square = dot(&self.eccentricity, &self.eccentricity);
        let all = S::constant(self.clearance * self.clearance);
        let room = (all - square).positive_part() + all.scale(2.0 * THINNEST * THINNEST);
        S::constant(2.0 * PI) / room.sqrt()
    }
}

/// Force on the first body \[N] and its friction moment about the axis [N m]: a land of a width and radius \[m] in oil of a viscosity
/// [Pa s], with the spin of the first body against the second [rad/s].
#[inline(always)]
pub fn land<S: Scalar>(gap: &Gap<S>, viscosity: f64, [width, radius]: [f64; 2], spin: S) -> (Vector3<S>, S) {
    let force = gap.press(3.0).map(|component| component.scale(viscosity * width.powi(3) * radius));
    (force, -(gap.shear() * spin).scale(viscosity * width * radius.powi(3)))
}

/// Force \[N] and moment [N m] on a ball of a radius \[m] in a pocket about the axis of the gap, with the angular velocity of the ball
/// against the cage [rad/s].
#[inline(always)]
pub fn pocket<S: Scalar>(
    gap: &Gap<S>,
    viscosity: f64,
    radius: f64,
    relative: &Vector3<S>,
) -> (Vector3<S>, Vector3<S>) {
    let factor = 3.0 * PI * 2f64.sqrt() * viscosity * radius.powf(1.5) * radius;
    let force = gap.press(1.5).map(|component| component.scale(factor));
    // Shear over a band whose width follows from the gap; about the axis all of it turns the ball, across it half.
    let along = gap.axis * dot(&gap.axis, relative);
    let factor = -viscosity * PI * PI * radius.powi(3) * (2.0 * radius / gap.clearance).sqrt();
    (force, (along + relative).map(|component| component.scale(factor)))
}
