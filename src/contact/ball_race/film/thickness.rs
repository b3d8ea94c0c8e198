//! Thickness of films in elliptic contacts.

use super::rolling::RollingFactors;
use crate::numerics::elementary::{exp, ln};
use crate::numerics::scalar::Scalar;

/// [-] load over `E' R^2` below which films do not grow any more: without load they would be infinite.
const LEAST_LOAD: f64 = 1e-9;
/// [-] largest loss of film by heating, of the numerator, to which the fit of Gupta and others holds; beyond, it comes near to a
/// whole loss without reaching it.
const LARGEST_LOSS: f64 = 0.9;

/// Numbers of a contact ellipse that follow from its shape alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// [-] factors of central and minimum film.
    films: [f64; 2],
    /// [-] semi-axis along rolling over that across it, kappa.
    pub ratio: f64,
    /// [-] half width over that of a line contact of the same peak pressure, beta.
    pub slenderness: f64,
    /// [-] what rolling resistance takes of both.
    pub rolling: RollingFactors,
}

impl Ellipse {
    /// The ellipse of a contact: semi-axes \[m] along and across rolling of a load \[N], E' \[Pa], sum of the curvatures along
    /// rolling [1/m].
    pub fn new([along, across]: [f64; 2], load: f64, modulus: f64, curvature: f64) -> Self {
        let (ratio, ellipticity) = (along / across, across / along);
        let pressure = 1.5 * load / (std::f64::consts::PI * along * across);
        let slenderness = along * modulus * curvature / (std::f64::consts::PI * pressure);
        Self {
            films: [1.0 - 0.61 * exp(-0.73 * ellipticity), 1.0 - exp(-0.68 * ellipticity)],
            ratio,
            slenderness,
            rolling: RollingFactors::new(ratio, slenderness),
        }
    }

    /// \[m] central and minimum film, isothermal and flooded (Hamrock and Dowson 1977): load over `E' Rx^2`, logarithm of
    /// `eta0 u/(E' Rx)`, sum of the curvatures along rolling [1/m], and logarithm of the pressure viscosity times E'.
    #[inline(always)]
    pub fn films<S: Scalar>(&self, load: S, speed: S, curvature: S, stiffening: f64) -> [S; 2] {
        let least = S::constant(LEAST_LOAD);
        let load = ln((load - least).positive_part() + least);
        let central = exp(speed.scale(0.67) - load.scale(0.067) + S::constant(0.53 * stiffening));
        let minimum = exp(speed.scale(0.68) - load.scale(0.073) + S::constant(0.49 * stiffening));
        [central.scale(2.69 * self.films[0]) / curvature, minimum.scale(3.63 * self.films[1]) / curvature]
    }
}

/// [-] what heating of the inlet leaves of a film (Gupta, Cheng and others 1992, without sliding): peak pressure over E', logarithm of
/// the thermal loading `eta0 beta u^2/k`.
#[inline(always)]
pub fn inlet_factor<S: Scalar>(pressure: S, logarithm: S) -> S {
    let loss = (pressure * exp(logarithm.scale(0.42))).scale(13.2);
    let left = loss.map_smooth(|loss| match loss <= LARGEST_LOSS {
        true => (1.0 - loss, -1.0),
        false => {
            let left = (1.0 - LARGEST_LOSS) * exp((LARGEST_LOSS - loss) / (1.0 - LARGEST_LOSS));
            (left, -left / (1.0 - LARGEST_LOSS))
        }
    });
    left / (S::one() + exp(logarithm.scale(0.64)).scale(0.213))
}
