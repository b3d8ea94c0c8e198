//! Kalker's linear theory of one contact: creepages in, forces out, and the numbers between them.

use crate::numerics::scalar::Scalar;

/// Creepages of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Creepage<S> {
    /// [-] longitudinal slip over rolling speed.
    pub longitudinal: S,
    /// [-] lateral slip over rolling speed.
    pub lateral: S,
    /// [1/m] spin over rolling speed.
    pub spin: S,
    /// [1/m2] kappa of the slip `-kappa y^2` of a bent groove over rolling speed; none if that effect is off.
    pub curvature: Option<S>,
}

impl<S: Scalar> Creepage<S> {
    /// Number by number from two creepages.
    #[inline(always)]
    pub fn zip_with<U: Scalar, T>(&self, other: &Creepage<U>, mut f: impl FnMut(S, U) -> T) -> Creepage<T> {
        Creepage {
            longitudinal: f(self.longitudinal, other.longitudinal),
            lateral: f(self.lateral, other.lateral),
            spin: f(self.spin, other.spin),
            curvature: self.curvature.zip(other.curvature).map(|(a, b)| f(a, b)),
        }
    }
}

/// Kalker's linear theory of the contact in hand, dimensional (paper eq. 14), and its limits.
#[derive(Clone, Copy, Debug)]
pub struct LinearTheory<S> {
    /// \[N] `G c^2 C11`.
    pub longitudinal: S,
    /// \[N] `G c^2 C22`.
    pub lateral: S,
    /// [N m] `G c^3 C23`.
    pub coupling: S,
    /// [N m2] `G c^4 C33`.
    pub spin: S,
    /// \[N] `mu Q`.
    pub friction_limit: S,
    /// [N m] spin moment of complete slip.
    pub moment_limit: S,
    /// \[m] `c = sqrt(a b)`.
    pub mean_semi_axis: S,
    /// \[m] semi-axis transverse to rolling.
    pub half_width: S,
}

/// Tangential effect of the ball on the raceway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreepForces<S> {
    /// \[N] along the rolling direction.
    pub longitudinal: S,
    /// \[N] transverse to it.
    pub lateral: S,
    /// [N m] about the normal.
    pub spin_moment: S,
    /// [N m2] integral of `y^2` times the longitudinal traction; 0 where the groove counts as flat.
    pub second_moment: S,
}

impl<S: Scalar> CreepForces<S> {
    /// \[N] power that goes into friction at these creepages, over the rolling speed.
    #[inline(always)]
    pub(crate) fn power(&self, creepage: &Creepage<S>) -> S {
        let flat = self.longitudinal * creepage.longitudinal
            + self.lateral * creepage.lateral
            + self.spin_moment * creepage.spin;
        creepage.curvature.map_or(flat, |curvature| flat - self.second_moment * curvature)
    }

    /// Number by number from two forces.
    #[inline(always)]
    pub fn zip_with<U: Scalar, T>(
        &self,
        other: &CreepForces<U>,
        mut f: impl FnMut(S, U) -> T,
    ) -> CreepForces<T> {
        CreepForces {
            longitudinal: f(self.longitudinal, other.longitudinal),
            lateral: f(self.lateral, other.lateral),
            spin_moment: f(self.spin_moment, other.spin_moment),
            second_moment: f(self.second_moment, other.second_moment),
        }
    }
}
