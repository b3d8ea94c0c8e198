//! Creep laws: from creepages to tangential force and spin moment.
//!
//! All laws share one interface: creepages in the contact frame (x rolling, y transverse, z from raceway into the
//! ball; velocity of the ball minus that of the raceway) and forces of the ball ON THE RACEWAY, which point along the
//! creepage (paper eq. 14). The force on the ball is the opposite.

use crate::kalker::table::CreepTable;
use crate::scalar::Scalar;

/// A law with what it needs beside the contact's linear theory; chosen once per step.
#[derive(Clone, Copy, Debug)]
pub enum Law<'a> {
    /// No tangential force.
    Frictionless,
    /// Kalker's linear theory, unbounded.
    Linear,
    /// The paper's regularised law without spin coupling.
    Regularised,
    /// Linear theory, saturated as a vector.
    Saturated,
    /// Kalker's nonlinear theory as a table.
    Table(&'a CreepTable),
}

/// Creepages of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Creepage<S> {
    /// [-] longitudinal slip over rolling speed.
    pub longitudinal: S,
    /// [-] lateral slip over rolling speed.
    pub lateral: S,
    /// [1/m] spin over rolling speed.
    pub spin: S,
}

/// Kalker's linear theory of the contact in hand, dimensional (paper eq. 14), and its limits.
#[derive(Clone, Copy, Debug)]
pub struct LinearTheory<S> {
    /// [N] `G c^2 C11`.
    pub longitudinal: S,
    /// [N] `G c^2 C22`.
    pub lateral: S,
    /// [N m] `G c^3 C23`.
    pub coupling: S,
    /// [N m2] `G c^4 C33`.
    pub spin: S,
    /// [N] `mu Q`.
    pub friction_limit: S,
    /// [N m] spin moment of complete slip.
    pub moment_limit: S,
    /// [m] `c = sqrt(a b)`.
    pub mean_semi_axis: S,
}

/// Tangential effect of the ball on the raceway.
#[derive(Clone, Copy, Debug)]
pub struct CreepForces<S> {
    /// [N] along the rolling direction.
    pub longitudinal: S,
    /// [N] transverse to it.
    pub lateral: S,
    /// [N m] about the normal.
    pub spin_moment: S,
}

/// [-] creepages below this count as zero where a printed formula is 0/0 there.
const CREEP_FLOOR: f64 = 1e-12;
/// [N] friction limit below which forces fade to zero, so that an unloaded contact is 0 and not 0/0.
const FORCE_FLOOR: f64 = 1e-9;
/// [N m] the same for the spin moment: the force floor on a patch of a micrometre.
const MOMENT_FLOOR: f64 = 1e-15;

/// Saturated over linear force at a linear force of `q` times its limit: the cubic of Vermeulen and Johnson (1964).
#[inline(always)]
pub fn saturation<S: Scalar>(q: S) -> S {
    // 1/q is used above q = 3 only; the guard keeps the other branch finite.
    let inverse = S::one() / q.where_positive(q - S::one(), S::one());
    let cubic = S::one() - q.scale(1.0 / 3.0) + q.square().scale(1.0 / 27.0);
    inverse.where_positive(q - S::constant(3.0), cubic)
}

impl<S: Scalar> LinearTheory<S> {
    /// Forces of a law.
    #[inline(always)]
    pub fn forces(&self, law: Law<'_>, creepage: &Creepage<S>) -> CreepForces<S> {
        match law {
            Law::Frictionless => {
                CreepForces { longitudinal: S::zero(), lateral: S::zero(), spin_moment: S::zero() }
            }
            Law::Linear => self.linear(creepage),
            Law::Regularised => self.regularised(creepage),
            Law::Saturated => self.saturated(creepage),
            Law::Table(table) => self.tabulated(table, creepage),
        }
    }

    /// Linear theory (paper eq. 14): unbounded.
    #[inline(always)]
    fn linear(&self, creepage: &Creepage<S>) -> CreepForces<S> {
        CreepForces {
            longitudinal: self.longitudinal * creepage.longitudinal,
            lateral: self.lateral * creepage.lateral + self.coupling * creepage.spin,
            spin_moment: self.spin * creepage.spin - self.coupling * creepage.lateral,
        }
    }

    /// Linear theory saturated as one vector of force and moment.
    ///
    /// With `q = (F_x/(mu Q), F_y/(mu Q), M_z/M_max)` of linear theory, all three are multiplied by the same
    /// `g(|q|)`, the cubic of Vermeulen and Johnson (1964): `g = 1 - q/3 + q^2/27` up to `q = 3`, then `1/q`.
    /// Tangent to linear theory at zero with and without spin, `|F| <= mu Q`, `|M_z| <= M_max`; and dissipative for
    /// every creepage, since one factor scales a linear law whose coupling is skew (C32 = -C23). The moment is
    /// part of the norm because large spin must take the lateral force away, not saturate it.
    #[inline(always)]
    fn saturated(&self, creepage: &Creepage<S>) -> CreepForces<S> {
        let linear = self.linear(creepage);
        let per_force = S::one() / (self.friction_limit + S::constant(FORCE_FLOOR));
        let per_moment = S::one() / (self.moment_limit + S::constant(MOMENT_FLOOR));
        let (x, y) = (linear.longitudinal * per_force, linear.lateral * per_force);
        let z = linear.spin_moment * per_moment;
        let factor = saturation((x.square() + y.square() + z.square()).sqrt());
        CreepForces {
            longitudinal: x * factor * self.friction_limit,
            lateral: y * factor * self.friction_limit,
            spin_moment: z * factor * self.moment_limit,
        }
    }

    /// Kalker's nonlinear theory from a table. Rolling against the x axis is rolling along it seen turned by half a turn.
    #[inline(always)]
    fn tabulated(&self, table: &CreepTable, creepage: &Creepage<S>) -> CreepForces<S> {
        let per_force = S::one() / (self.friction_limit + S::constant(FORCE_FLOOR));
        let per_moment = S::one() / (self.moment_limit + S::constant(MOMENT_FLOOR));
        let turned = S::constant(1.0).where_positive(self.coupling, S::constant(-1.0));
        let q = [
            turned * self.longitudinal * creepage.longitudinal * per_force,
            turned * self.lateral * creepage.lateral * per_force,
            self.spin * creepage.spin * per_moment,
        ];
        let [x, y, z] = S::map_smooth_three(q, |q| table.evaluate(q));
        CreepForces {
            longitudinal: turned * x * self.friction_limit,
            lateral: turned * y * self.friction_limit,
            spin_moment: z * self.moment_limit,
        }
    }

    /// The paper's regularised law without spin coupling (eq. 15-17, A.1-A.3, A.5).
    ///
    /// Where the printed formulas leave a choice: `c/c_0` and `c_z/c_*` are 0 at rest (their limit times phi); eps_z
    /// is `M_max/(C33 G c^4)`, which has the right dimension and makes phi_z tangent to linear theory; beta_0 = 1,
    /// the value identified for all axis ratios to within 1 %.
    #[inline(always)]
    fn regularised(&self, creepage: &Creepage<S>) -> CreepForces<S> {
        let magnitude = |x: S| (x.square() + S::constant(CREEP_FLOOR * CREEP_FLOOR)).sqrt();
        let spin = self.mean_semi_axis * creepage.spin;
        let total =
            magnitude((creepage.longitudinal.square() + creepage.lateral.square() + spin.square()).sqrt());
        // phi(c, eps) = (2 - c/eps) c/eps up to eps = 2 mu Q/(C G c^2), then 1 (eq. 15).
        let per_force = S::one() / (self.friction_limit + S::constant(FORCE_FLOOR));
        let phi = |stiffness: S, creep: S| {
            let x = (magnitude(creep) * stiffness * per_force).scale(0.5);
            let parabola = (S::constant(2.0) - x) * x;
            parabola.where_positive(S::one() - x, S::one())
        };
        let force = |stiffness: S, creep: S| self.friction_limit * creep / total * phi(stiffness, creep);
        let x = magnitude(creepage.spin) * self.spin / (self.moment_limit + S::constant(MOMENT_FLOOR));
        let phi_z = x * (S::one() + x) / (S::one() + x + x.square());
        let share = spin / (magnitude(creepage.lateral) + magnitude(spin));
        CreepForces {
            longitudinal: force(self.longitudinal, creepage.longitudinal),
            lateral: force(self.lateral, creepage.lateral),
            spin_moment: self.moment_limit * share * phi_z,
        }
    }
}
