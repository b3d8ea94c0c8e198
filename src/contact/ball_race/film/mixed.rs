//! Mixed friction: the share of it that is dry where films are about as thick as surfaces are rough.

use serde::Deserialize;
use strum::IntoStaticStr;

use crate::numerics::elementary::{exp, pow};
use crate::numerics::scalar::Scalar;

/// How much of a contact is dry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum MixedFriction {
    /// 1/(1 + L)^2 with the film ratio L of the contact (Olver and Spikes 1998).
    #[default]
    OlverSpikes,
    /// 1 - erf(L): the load that touching roughness carries (Arana and others 2019, film ratios up to 2).
    Erf,
    /// exp(-2.6e-8 (n nu)^1.4 d_m) of the whole bearing, in rpm, mm2/s and mm: SKF's weighting factor for the sliding friction (2018).
    Skf,
}

/// Coefficients of erf(x) = 1 - 1/(1 + a1 x + ... + a6 x^6)^16 within 3e-7 (Hastings 1955; Abramowitz and Stegun 1964, 7.1.28).
const ERF: [f64; 7] = [
    1.0,
    0.070_523_078_4,
    0.042_282_012_3,
    0.009_270_527_2,
    0.000_152_014_3,
    0.000_276_567_2,
    0.000_043_063_8,
];
/// [-] film ratio from which on nothing touches: 1e-31 do.
const FULL: f64 = 10.0;

impl MixedFriction {
    /// [-] share that is dry: by the film ratio of a contact, and by the share of its whole bearing where the law has that.
    #[inline(always)]
    pub fn dry_share<S: Scalar>(self, ratio: S, of_bearing: f64) -> S {
        match self {
            Self::OlverSpikes => S::one() / (S::one() + ratio).square(),
            Self::Erf => {
                let root = ratio.clamp_to(0.0, FULL).polynomial(&ERF).square().square();
                S::one() / root.square().square()
            }
            Self::Skf => S::constant(of_bearing),
        }
    }

    /// [-] dry share of a whole bearing in SKF's model, as far as the law has it: speed \[rpm], viscosity [mm2/s], mean diameter \[m], and
    /// degree of lubrication. A film of a part of the thickness is one at less speed: thickness goes with the power of 0.7 of the speed.
    pub fn of_bearing(self, speed: f64, viscosity: f64, mean_diameter: f64, lubrication: f64) -> f64 {
        match self {
            Self::OlverSpikes | Self::Erf => 0.0,
            Self::Skf => {
                let full = 2.6e-8 * pow(speed * viscosity, 1.4) * mean_diameter * 1e3;
                exp(-full * lubrication.powi(2))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values_of_the_error_function() {
        // Abramowitz and Stegun, table 7.1.
        for (x, erf) in [
            (0.0, 0.0),
            (0.1, 0.112_462_916),
            (0.5, 0.520_499_878),
            (1.0, 0.842_700_793),
            (2.0, 0.995_322_265),
        ] {
            let dry: f64 = MixedFriction::Erf.dry_share(x, 0.0);
            assert!((1.0 - dry - erf).abs() < 3e-7, "{x}: {dry}");
        }
    }
}
