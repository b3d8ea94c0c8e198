//! Shear of a film: an Eyring fluid whose viscosity grows with pressure, up to a limiting shear stress.

use super::{Lubricant, ShearPressure};
use crate::numerics::elementary::{asinh, exp, ln};
use crate::numerics::scalar::Scalar;

/// \[Pa] pressure of Roelands' law.
const ROELANDS_PRESSURE: f64 = 1.962e8;
/// [-] logarithm of the viscosity [Pa s] that all oils of Roelands' law have in common, with the opposite sign.
const ROELANDS_POLE: f64 = 9.67;
/// [-] largest logarithm of the viscosity over that without pressure: 1e87 times, far beyond what limits the shear.
const LARGEST_GROWTH: f64 = 200.0;
/// \[Pa] pressure that is added where a stress is divided by it, so that there is no 0/0 without load.
const LEAST_PRESSURE: f64 = 1e-3;
/// \[Pa] the same where thinning is divided by a stress.
const LEAST_STRESS: f64 = 1e-30;

/// Places and weights of Gauss and Legendre's quadrature of six points over 0 to 1.
const RINGS: [[f64; 2]; 6] = [
    [0.033_765_242_898_423_99, 0.085_662_246_189_585_18],
    [0.169_395_306_766_867_74, 0.180_380_786_524_069_3],
    [0.380_690_406_958_401_5, 0.233_956_967_286_345_52],
    [0.619_309_593_041_598_5, 0.233_956_967_286_345_52],
    [0.830_604_693_233_132_3, 0.180_380_786_524_069_3],
    [0.966_234_757_101_576, 0.085_662_246_189_585_18],
];

/// Friction by the shear of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shear<S> {
    /// [-] shear stress over pressure.
    pub friction: S,
    /// [-] it over that of an oil that does not thin.
    pub thinning: S,
}

impl Lubricant {
    /// [Pa s] viscosity under a pressure \[Pa] of one without pressure [Pa s] (Roelands 1966).
    #[inline(always)]
    pub fn viscosity_under<S: Scalar>(&self, viscosity: f64, pressure: S) -> S {
        let growth = ln(viscosity) + ROELANDS_POLE;
        let exponent = self.pressure_viscosity * ROELANDS_PRESSURE / growth;
        let power = exp(ln(pressure.scale(1.0 / ROELANDS_PRESSURE) + S::one()).scale(exponent));
        exp((power - S::one()).scale(growth).clamp_to(0.0, LARGEST_GROWTH)).scale(viscosity)
    }

    /// Shear of a film at a shear rate above 0 [1/s] in a contact of a mean pressure \[Pa].
    #[inline(always)]
    pub fn shear<S: Scalar>(&self, viscosity: f64, pressure: S, rate: S) -> Shear<S> {
        match self.shear_pressure {
            ShearPressure::Mean => self.shear_under(viscosity, pressure, rate),
            ShearPressure::Hertz => self.shear_over_ellipse(viscosity, pressure, rate, &RINGS),
        }
    }

    /// Shear by stresses under Hertz's pressure `1.5 p (1 - t)^(1/2)`, where t is the share of the ellipse's area within: a quadrature
    /// over t, by places and weights. The thinning is the mean over the stress. Six places of Gauss are within 0.5 % of the integral for
    /// ordinary oils, 1.3 % at most from 0.3 to 2.7 GPa: the growth of viscosity with pressure, and the edge of the limiting stress, are what is missed.
    #[inline(always)]
    pub fn shear_over_ellipse<S: Scalar>(
        &self,
        viscosity: f64,
        mean: S,
        rate: S,
        rings: &[[f64; 2]],
    ) -> Shear<S> {
        let [mut stress, mut unthinned] = [S::zero(); 2];
        for [within, weight] in rings {
            let pressure = mean.scale(1.5 * (1.0 - within).sqrt());
            let ring = self.shear_under(viscosity, pressure, rate);
            let of_ring = ring.friction * pressure.scale(*weight);
            stress += of_ring;
            unthinned += of_ring * ring.thinning;
        }
        // No load has neither.
        let thinning = unthinned / (stress + S::constant(LEAST_STRESS));
        Shear { friction: stress / (mean + S::constant(LEAST_PRESSURE)), thinning }
    }

    /// Shear of a film at a shear rate above 0 [1/s] under one pressure \[Pa], of a contact its mean, two thirds of the largest (Eyring 1936;
    /// Johnson and Tevaarwerk 1977). The integral over the ellipse is within 2.4 % of it at 1500 N and slide-to-roll ratios from 1e-4 on,
    /// and at 500 N from 1e-3 on; light contacts that hardly slip carry up to ten times more in it (100 N, 1e-5).
    #[inline(always)]
    pub fn shear_under<S: Scalar>(&self, viscosity: f64, pressure: S, rate: S) -> Shear<S> {
        let viscous = self.viscosity_under(viscosity, pressure) * rate;
        let thinned = asinh(viscous.scale(1.0 / self.eyring_stress)).scale(self.eyring_stress);
        let limit = pressure.scale(self.limiting_shear);
        let stress = thinned.where_positive(limit - thinned, limit);
        Shear { friction: stress / (pressure + S::constant(LEAST_PRESSURE)), thinning: stress / viscous }
    }
}
