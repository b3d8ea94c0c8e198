//! The paper's regularised law with full spin coupling (eq. 15-17 and appendix A).
//!
//! The printed formulas leave choices, made as follows:
//! * `c_i/c_0` and `c_i/c_*` are 0/0 at rest; both denominators get a floor, so that the products take their limit 0.
//! * eps_z of A.5 has the dimension wrong and the 3/2 spoils the slope: `eps_z = M_max/(C33 G c^4)` makes phi_z
//!   tangent to linear theory.
//! * A.5 has one parameter; with it, spin moments fit to 2-3 % only. `x (1 + beta_0 x)/(1 + beta_1 x + beta_0 x^2)` has
//!   the printed slope at 0 and, unlike A.5 with beta_0 other than 1, tends to 1; it fits to 0.4 %.
//! * C32 is negative: the moduli of eps_yz and eps_zy are used, and the sign of the coupling is written out.
//! * A force above mu Q is brought back with its direction kept; a spin moment above M_max, that of complete
//!   sliding, is cut.
//!
//! In combined creepage the slope at rest is below linear theory's (`c_x/c_0` is a direction cosine), and with spin
//! F_x has none at all at c_x = 0: the law is kept as the paper's reference, not as the default.

use super::linear_theory::{Creepage, LinearTheory};
use crate::numerics::scalar::{Scalar, within_limit};

/// [-] creepages below this count as zero where a printed formula is 0/0 there.
const CREEP_FLOOR: f64 = 1e-12;

/// Parameters of the spin coupling of one axis ratio, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// [-] eta_0, eta_1, eta_2 of A.4: lateral force by spin.
    pub eta: [f64; 3],
    /// [-] beta_0, beta_1: spin moment by spin.
    pub beta: [f64; 2],
    /// [-] alpha_0, alpha_1, alpha_2 of A.6: spin moment by lateral creepage.
    pub alpha: [f64; 3],
    /// [-] part of the coupling that there is: 1, or 0 for the law `uncoupled`.
    #[serde(skip, default = "whole")]
    pub coupling: f64,
}

fn whole() -> f64 {
    1.0
}

impl Parameters {
    /// Law without coupling of spin and lateral creepage (phi_yz = phi_zy = 0, section 3.1.3).
    pub fn uncoupled(self) -> Self {
        Self { coupling: 0.0, ..self }
    }
}

/// phi_yz of A.4: lateral force over mu Q at the spin x = |phi|/eps_yz.
#[inline(always)]
pub fn lateral_by_spin<S: Scalar>([e0, e1, e2]: [S; 3], x: S) -> S {
    (x.scale(2.0) + x.square() * e0) / (S::one() + x * e1 + x.square() * e2)
}

/// phi_z: spin moment over M_max at the spin x = |phi|/eps_z.
#[inline(always)]
pub fn moment_by_spin<S: Scalar>([b0, b1]: [S; 2], x: S) -> S {
    let square = x.square() * b0;
    (x + square) / (S::one() + x * b1 + square)
}

/// phi_zy of A.6: spin moment over M_max at the lateral creepage x = |c_y|/|eps_zy|.
#[inline(always)]
pub fn moment_by_lateral<S: Scalar>([a0, a1, a2]: [S; 3], x: S) -> S {
    let square = x.square();
    x * a0 / (S::one() + square * a1 + square.square() * a2)
}

impl<S: Scalar> LinearTheory<S> {
    /// Force and moment over mu Q and M_max.
    #[inline(always)]
    pub(super) fn regularised(&self, parameters: &Parameters, creepage: &Creepage<S>) -> [S; 3] {
        let magnitude = |x: S| (x.square() + S::constant(CREEP_FLOOR * CREEP_FLOOR)).sqrt();
        let (per_force, per_moment) = self.per_limits();
        let (long, lateral) = (creepage.longitudinal, creepage.lateral);
        let spin = self.mean_semi_axis * creepage.spin;
        // c_0 and c_* (eq. 17)
        let total = magnitude((long.square() + lateral.square() + spin.square()).sqrt());
        let sum = magnitude(lateral) + magnitude(spin);
        // phi(c, eps) = (2 - c/eps) c/eps up to eps = 2 mu Q/(C G c^2), then 1 (eq. 15).
        let phi = |stiffness: S, creep: S| {
            let x = (magnitude(creep) * stiffness * per_force).scale(0.5);
            let parabola = (S::constant(2.0) - x) * x;
            parabola.where_positive(S::one() - x, S::one())
        };
        // The coupling changes its sign with the direction of rolling.
        let sign = S::one().where_positive(self.coupling, -S::one());
        let coupling = (sign * self.coupling).scale(parameters.coupling);
        let by_spin = lateral_by_spin(
            parameters.eta.map(S::constant),
            (magnitude(creepage.spin) * coupling * per_force).scale(0.5),
        );
        let own = moment_by_spin(
            parameters.beta.map(S::constant),
            magnitude(creepage.spin) * self.spin * per_moment,
        );
        let by_lateral =
            moment_by_lateral(parameters.alpha.map(S::constant), magnitude(lateral) * coupling * per_moment);
        let x = long / total * phi(self.longitudinal, long);
        let y = lateral / total * phi(self.lateral, lateral) + sign * spin / total * by_spin;
        let z = spin / sum * own - sign * lateral / sum * by_lateral;
        let [x, y] = within_limit(x, y);
        [x, y, z.clamp_to(-1.0, 1.0)]
    }
}
