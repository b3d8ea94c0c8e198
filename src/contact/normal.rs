//! Normal load of a contact: an elastic law of the approach with dissipation, after Hunt and Crossley (1975) or of a viscoelastic
//! material after Kuwabara and Kono (1987) and Brilliantov and others (1996).

use crate::numerics::scalar::Scalar;

/// How a contact of Hertz's loses energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping {
    /// [s/m] dissipation factor chi: `F = k d^1.5 (1 + chi d')`.
    HuntCrossley(f64),
    /// \[s] retardation time A: `F = k (d^1.5 + 1.5 A d^0.5 d')`, the elastic load that the approach would have after that time.
    Viscoelastic(f64),
}

impl Damping {
    /// Is nothing lost?
    #[inline(always)]
    pub fn is_none(self) -> bool {
        matches!(self, Self::HuntCrossley(0.0) | Self::Viscoelastic(0.0))
    }
}

impl From<f64> for Damping {
    fn from(dissipation: f64) -> Self {
        Self::HuntCrossley(dissipation)
    }
}

/// Normal load of a contact.
#[derive(Clone, Copy, Debug)]
pub struct NormalLoad<S> {
    /// \[N] elastic part.
    pub elastic: S,
    /// \[N] with dissipation, never pulling: `elastic (1 + chi rate)`.
    pub total: S,
    /// \[W] power lost to dissipation.
    pub damping_power: S,
}

impl<S: Scalar> NormalLoad<S> {
    /// An elastic load \[N] with a dissipation factor chi [s/m], at a rate of approach [m/s].
    #[inline(always)]
    pub fn damped(elastic: S, approach_rate: S, dissipation: f64) -> Self {
        let total = (elastic * (S::one() + approach_rate.scale(dissipation))).positive_part();
        Self { elastic, total, damping_power: (total - elastic) * approach_rate }
    }

    /// Hertz's point contact: stiffness [N/m^1.5], depth \[m] and the root of it (paper eq. 8), damped.
    #[inline(always)]
    pub fn hertz(stiffness: S, depth: S, root: S, approach_rate: S, damping: Damping) -> Self {
        let elastic = stiffness * depth * root;
        match damping {
            Damping::HuntCrossley(dissipation) => Self::damped(elastic, approach_rate, dissipation),
            Damping::Viscoelastic(time) => {
                let total = (elastic + (stiffness * root * approach_rate).scale(1.5 * time)).positive_part();
                Self { elastic, total, damping_power: (total - elastic) * approach_rate }
            }
        }
    }
}
