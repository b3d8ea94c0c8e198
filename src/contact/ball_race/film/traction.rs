//! Shear of a film: an Eyring fluid whose viscosity grows with pressure, up to a limiting shear stress.

use super::Lubricant;
use super::functions::{exp, ln};
use crate::numerics::scalar::Scalar;

/// \[Pa] pressure of Roelands' law.
const ROELANDS_PRESSURE: f64 = 1.962e8;
/// [-] logarithm of the viscosity [Pa s] that all oils of Roelands' law have in common, with the opposite sign.
const ROELANDS_POLE: f64 = 9.67;
/// [-] largest logarithm of the viscosity over that without pressure: 1e87 times, far beyond what limits the shear.
const LARGEST_GROWTH: f64 = 200.0;

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
        let growth = viscosity.ln() + ROELANDS_POLE;
        let exponent = self.pressure_viscosity * ROELANDS_PRESSURE / growth;
        let power = exp(ln(pressure.scale(1.0 / ROELANDS_PRESSURE) + S::one()).scale(exponent));
        exp((power - S::one()).scale(growth).clamp_to(0.0, LARGEST_GROWTH)).scale(viscosity)
    }

    /// Shear of a film at a shear rate above 0 [1/s] under the mean pressure of a contact \[Pa], two thirds of the largest (Eyring 1936;
    /// Johnson and Tevaarwerk 1977). The integral over the ellipse is within 2.4 % of it at 1500 N and slide-to-roll ratios from 1e-4 on,
    /// and at 500 N from 1e-3 on; light contacts that hardly slip carry up to ten times more in it (100 N, 1e-5).
    #[inline(always)]
    pub fn shear<S: Scalar>(&self, viscosity: f64, pressure: S, rate: S) -> Shear<S> {
        let viscous = self.viscosity_under(viscosity, pressure) * rate;
        let thinned = viscous
            .scale(1.0 / self.eyring_stress)
            .map_smooth(|x| (x.asinh(), 1.0 / x.hypot(1.0)))
            .scale(self.eyring_stress);
        let limit = pressure.scale(self.limiting_shear);
        let stress = thinned.where_positive(limit - thinned, limit);
        // A thousandth of a pascal, so that there is no 0/0 without load.
        Shear { friction: stress / (pressure + S::constant(1e-3)), thinning: stress / viscous }
    }
}
