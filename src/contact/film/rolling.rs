//! Hydrodynamic rolling resistance of elliptic contacts.

use std::f64::consts::PI;

use super::thickness::Ellipse;
use super::{exp, ln};
use crate::numerics::scalar::Scalar;

/// A lubricated inlet by numbers without dimension.
#[derive(Clone, Copy, Debug)]
pub struct Inlet<S> {
    /// Load over `E' Rx^2`, W.
    pub load: S,
    /// `2 eta0 u/(E' Rx)`, U.
    pub speed: S,
    /// Root of the area of the ellipse over Rx.
    pub half_width: S,
}

impl<S: Scalar> Inlet<S> {
    /// Rolling force on each surface over `E' Rx^2`, isothermal and flooded (Biboulet and Houpert 2010, part 2, eq. 32).
    ///
    /// The form that Balan and others (2015) give of the same work, by the curvatures alone, is within 0.6 % of it (tested).
    #[inline(always)]
    pub fn rolling_force(&self, ellipse: &Ellipse) -> S {
        let (ratio, slenderness) = (ellipse.ratio, ellipse.slenderness);
        let speed = ln(self.speed);
        // Semi-axis across rolling from the area.
        let across = self.half_width.scale(1.0 / (PI * ratio).sqrt());
        let share = self.load * exp(speed.scale(-0.75));
        let rigid = exp(speed.scale(-1.0 / 12.0)).scale(0.77 * slenderness.powf(-1.0 / 3.0) * ratio.powf(0.12));
        let elastic = S::constant(1.8 * slenderness.powf(-0.25));
        let weight = S::one() + share.scale(slenderness.powf(0.25) * ratio / 6.6);
        across.scale(2.0) * exp(speed.scale(0.75)) * ((rigid - elastic) / weight + elastic)
    }
}

/// [-] what heating of the inlet leaves of the rolling force (Aihara 1987), by the thermal loading `eta0 beta u^2/k`.
#[inline(always)]
pub fn inlet_factor<S: Scalar>(thermal_loading: S) -> S {
    S::one() / (S::one() + exp(ln(thermal_loading).scale(0.78)).scale(0.29))
}
