//! Normal load of a contact: an elastic law of the approach with dissipation after Hunt and Crossley (1975).

use crate::numerics::scalar::Scalar;

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
    pub fn hertz(stiffness: S, depth: S, root: S, approach_rate: S, dissipation: f64) -> Self {
        Self::damped(stiffness * depth * root, approach_rate, dissipation)
    }
}
