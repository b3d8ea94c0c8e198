//! Creep laws: from creepages to tangential force and spin moment.
//!
//! All laws share one interface: creepages in the contact frame (x rolling, y transverse, z from raceway into the
//! ball; velocity of the ball minus that of the raceway) and forces of the ball ON THE RACEWAY, which point along the
//! creepage (paper eq. 14). The force on the ball is the opposite.

pub mod heathcote;
pub mod identification;
pub mod linear_theory;
pub mod oblique;
pub mod regularised;

use crate::contact::shape::ShapeAt;
use crate::kalker::scaled_law::{PolynomialsFrom, ScaledKalker};
use crate::kalker::table::CreepTable;
use crate::numerics::elementary::{exp, ln};
use crate::numerics::scalar::{Scalar, SmoothMap, Values, within_limit};
use heathcote::CurvatureEffect;
pub use linear_theory::{CreepForces, Creepage, LinearTheory};
use regularised::Parameters;

/// A creep law with its tables or parameters; chosen once per step.
#[derive(Clone, Copy, Debug)]
pub enum Law<'a> {
    /// No tangential force.
    Frictionless,
    /// Kalker's linear theory, unbounded.
    Linear,
    /// The paper's regularised law.
    Regularised(&'a Parameters),
    /// Linear theory, saturated as a vector.
    Saturated,
    /// Kalker's nonlinear theory as a table.
    Table(&'a CreepTable),
    /// Kalker's nonlinear theory in polynomials.
    Kalker(&'a ScaledKalker),
    /// Nonlinear theory whose minimum is sought from the coefficients of a solution at nearby creepages.
    Continued(&'a ScaledKalker, &'a [f64]),
    /// Kalker's nonlinear theory in polynomials as simulations use it: the table plus a difference that is frozen in a step.
    Frozen(&'a CreepTable, &'a [f64; 4]),
}

/// \[N] friction limit below which forces fade to zero, so that an unloaded contact is 0 and not 0/0.
const FORCE_FLOOR: f64 = 1e-9;
/// [N m] moment limit below which the spin moment fades to zero: the force floor on a patch of a micrometre.
const MOMENT_FLOOR: f64 = 1e-15;

/// \[m] ratio of spin stiffness to moment limit below which the direction of rolling fades to zero: a ten thousandth of a
/// micrometre, without effect under load.
const ARM_FLOOR: f64 = 1e-10;
/// [-] cosine of the rolling direction below which the table's two directions are mixed: a third of the circle, and a
/// rolling speed of half a millimetre a second.
const MIXED_BELOW: f64 = 0.5;

/// A number that is 0 without a sign: a law that is not asked and one that is asked for nothing are then the same bits.
#[inline(always)]
fn unsigned_zero<S: Scalar>(number: S) -> S {
    number + S::zero()
}

/// Saturated over linear force at a linear force of `q` times its limit: the cubic of Vermeulen and Johnson (1964).
#[inline(always)]
pub fn saturation<S: Scalar>(q: S) -> S {
    // 1/q is used above q = 3 only; the guard keeps the other branch finite.
    let inverse = S::one() / q.where_positive(q - S::one(), S::one());
    let cubic = S::one() - q.scale(1.0 / 3.0) + q.square().scale(1.0 / 27.0);
    inverse.where_positive(q - S::constant(3.0), cubic)
}

/// What a film in series leaves of the stiffness of bodies whose linear force is `r` times its limit: `3 (1 - 1/w)/r` with the cube root
/// `w` of `1 + r`, which is `3/(w + w^2 + w^3)`.
#[derive(Clone, Copy, Debug)]
struct InSeries;

impl SmoothMap<1, 1> for InSeries {
    #[inline(always)]
    fn values<V: Values>(&self, [r]: [V; 1]) -> [V; 1] {
        let root = exp(ln(V::one() + r).scale(1.0 / 3.0));
        [V::constant(3.0) / root.polynomial(&[0.0, 1.0, 1.0, 1.0])]
    }

    #[inline(always)]
    fn with_gradient(&self, [r]: [f64; 1]) -> ([f64; 1], [[f64; 1]; 1]) {
        let root = exp(ln(1.0 + r) / 3.0);
        let [divisor, by_root] = [&[0.0, 1.0, 1.0, 1.0], &[1.0, 2.0, 3.0, 0.0]].map(|of| root.polynomial(of));
        let factor = 3.0 / divisor;
        ([factor], [[-factor * by_root / (3.0 * root * root * divisor)]])
    }
}

impl<S: Scalar> LinearTheory<S> {
    /// Linear theory of a contact: its shape, its depth \[m] and the root of it, the most that friction can carry \[N], and the
    /// cosine of the rolling direction against the x axis.
    #[inline(always)]
    pub(super) fn new(shape: &ShapeAt<S>, [depth, root]: [S; 2], friction_limit: S, cosine: S) -> Self {
        Self {
            longitudinal: shape.longitudinal * depth,
            lateral: shape.lateral * depth,
            coupling: shape.coupling * depth * root * cosine,
            spin: shape.spin * depth.square(),
            friction_limit,
            moment_limit: friction_limit * shape.spin_arm * root,
            mean_semi_axis: shape.mean_semi_axis * root,
            half_width: shape.semi_axis_transverse * root,
        }
    }

    /// Linear theory with a film between the bodies that shears in series with them; the viscous share is that of
    /// [`FilmForces`](crate::contact::ball_race::film::FilmForces).
    ///
    /// With the linear force of the bodies `r` times the limit, a viscous film and elastic bodies in series carry `r/(1 + r)` of it. The
    /// cubic of [`saturation`] gives that at an argument of `3 (1 - (1 + r)^(-1/3))`: by that much the bodies seem more compliant. A
    /// share of 0, as that of a dry contact or of one that slides in full, leaves them as they are.
    #[inline(always)]
    pub fn in_series(self, creepage: &Creepage<S>, viscous_share: S) -> Self {
        let linear = self.linear(creepage);
        let (per_force, per_moment) = self.per_limits();
        let (x, y) = (linear.longitudinal * per_force, linear.lateral * per_force);
        let z = linear.spin_moment * per_moment;
        let r = (x.square() + y.square() + z.square()).sqrt();
        let [softened] = S::apply(&InSeries, [r]);
        let factor = S::one() - viscous_share * (S::one() - softened);
        Self {
            longitudinal: self.longitudinal * factor,
            lateral: self.lateral * factor,
            coupling: self.coupling * factor,
            spin: self.spin * factor,
            ..self
        }
    }

    /// Forces of a law.
    #[inline(always)]
    pub fn forces(&self, law: Law<'_>, creepage: &Creepage<S>) -> CreepForces<S> {
        let flat = match law {
            Law::Frictionless => [S::zero(); 3],
            Law::Linear => return self.linear(creepage),
            Law::Regularised(parameters) => self.regularised(parameters, creepage),
            Law::Saturated => self.saturated(creepage),
            Law::Table(_) | Law::Frozen(..) if self.is_idle() => [S::zero(); 3],
            Law::Table(table) | Law::Frozen(table, _) => self.tabulated(table, creepage).map(unsigned_zero),
            Law::Kalker(kalker) => {
                return self.polynomials(&PolynomialsFrom { kalker, start: None }, creepage);
            }
            Law::Continued(kalker, start) => {
                return self.polynomials(&PolynomialsFrom { kalker, start: Some(start) }, creepage);
            }
        };
        let forces = match creepage.curvature {
            None => self.dimensional(flat, S::zero()),
            Some(_) if self.is_idle() => self.dimensional(flat.map(unsigned_zero), S::zero()),
            Some(curvature) => self.bent(flat, creepage, curvature),
        };
        match law {
            Law::Frozen(table, difference) => self.corrected(&forces, self.direction(table), difference),
            _ => forces,
        }
    }

    /// [`Self::forces`] as a function of its own, which takes tens of kilobytes with derivatives, for paths that few contacts go.
    #[inline(never)]
    pub(super) fn forces_apart(&self, law: Law<'_>, creepage: &Creepage<S>) -> CreepForces<S> {
        self.forces(law, creepage)
    }

    /// Does the contact carry nothing, or of several none? Laws that cost much are then not asked. It stands in their arms: asked once before
    /// them, all steps take 2 % more time.
    #[inline(always)]
    fn is_idle(&self) -> bool {
        !self.friction_limit.any_beyond(0.0, S::one())
    }

    /// Forces from force and moment over their limits.
    #[inline(always)]
    fn dimensional(&self, [x, y, z]: [S; 3], second_moment: S) -> CreepForces<S> {
        CreepForces {
            longitudinal: x * self.friction_limit,
            lateral: y * self.friction_limit,
            spin_moment: z * self.moment_limit,
            second_moment,
        }
    }

    /// Inverse friction limit [1/N] and moment limit [1/(N m)], finite without load.
    #[inline(always)]
    pub(super) fn per_limits(&self) -> (S, S) {
        let per_force = S::one() / (self.friction_limit + S::constant(FORCE_FLOOR));
        (per_force, S::one() / (self.moment_limit + S::constant(MOMENT_FLOOR)))
    }

    /// Linear theory (paper eq. 14): unbounded.
    #[inline(always)]
    fn linear(&self, creepage: &Creepage<S>) -> CreepForces<S> {
        CreepForces {
            longitudinal: self.longitudinal * creepage.longitudinal,
            lateral: self.lateral * creepage.lateral + self.coupling * creepage.spin,
            spin_moment: self.spin * creepage.spin - self.coupling * creepage.lateral,
            second_moment: S::zero(),
        }
    }

    /// Linear theory without its coupling over the limits, for a contact that rolls along +x: rolling against the x
    /// axis is rolling along it seen turned by half a turn. The first factor turns the force back.
    #[inline(always)]
    fn uncoupled(&self, creepage: &Creepage<S>) -> (S, [S; 3]) {
        let (per_force, per_moment) = self.per_limits();
        let turned = S::one().where_positive(self.coupling, -S::one());
        let q = [
            turned * self.longitudinal * creepage.longitudinal * per_force,
            turned * self.lateral * creepage.lateral * per_force,
            self.spin * creepage.spin * per_moment,
        ];
        (turned, q)
    }

    /// Linear theory without its coupling over the limits.
    #[inline(always)]
    pub(super) fn over_limits(&self, creepage: &Creepage<S>) -> [S; 3] {
        let (per_force, per_moment) = self.per_limits();
        [
            self.longitudinal * creepage.longitudinal * per_force,
            self.lateral * creepage.lateral * per_force,
            self.spin * per_moment * creepage.spin,
        ]
    }

    /// Kalker's nonlinear theory from its table.
    ///
    /// The table rolls one way along x. The coupling of spin and lateral creepage changes its sign with the direction, at
    /// full size: a jump, at which a step of a bearing at rest has no solution. Where a contact hardly rolls along x both
    /// directions are mixed, so that the coupling goes through zero there as in the other laws.
    #[inline(always)]
    fn tabulated(&self, table: &CreepTable, creepage: &Creepage<S>) -> [S; 3] {
        let [x, y, z] = self.over_limits(creepage);
        S::apply(table, [x, y, z, self.direction(table)])
    }

    /// 1 where the contact rolls along +x, -1 against it, between where it hardly rolls along x: smooth.
    #[inline(always)]
    fn direction(&self, table: &CreepTable) -> S {
        let (per_force, per_moment) = self.per_limits();
        // Cosine of the rolling direction, which the coupling carries, over the one below which directions are mixed.
        let uncoupled = (self.spin * per_moment).scale(MIXED_BELOW * table.spin_coupling());
        let (cosine, limit) = (self.coupling * per_force, uncoupled + S::constant(ARM_FLOOR));
        let forwards = S::one().where_positive(cosine, -S::one());
        if !limit.any_beyond(1.0, cosine * forwards) {
            return forwards;
        }
        // The polynomial is 1 or -1 where the cosine is.
        let cosine = (cosine / limit).clamp_to(-1.0, 1.0);
        cosine.scale(0.5) * (S::constant(3.0) - cosine.square())
    }

    /// Linear force over mu Q of the slips `phi b` and `kappa b^2` at the side of the contact.
    #[inline(always)]
    fn side_slips(&self, spin: S, curvature: S) -> (S, S) {
        let side = self.longitudinal * self.per_limits().0 * self.half_width;
        (side * spin, side * self.half_width * curvature)
    }

    /// A flat law's forces with the changes that the curvature of the groove makes.
    #[inline(always)]
    fn bent(&self, [x, y, z]: [S; 3], creepage: &Creepage<S>, curvature: S) -> CreepForces<S> {
        let (per_force, per_moment) = self.per_limits();
        let (spin, side) = self.side_slips(creepage.spin, curvature);
        let q = [
            self.longitudinal * creepage.longitudinal * per_force,
            self.lateral * creepage.lateral * per_force,
            spin,
            side,
        ];
        let [dx, dy, dz, second] = S::apply(&CurvatureEffect, q);
        let [x, y] = within_limit(x + dx, y + dy);
        let z = (z + dz * self.friction_limit * self.half_width * per_moment).clamp_to(-1.0, 1.0);
        let second = second * self.second_moment_scale();
        self.dimensional([x, y, z].map(unsigned_zero), unsigned_zero(second))
    }

    /// Arguments of the nonlinear theory in polynomials; the first factor turns x, y and the second moment back.
    #[inline(always)]
    fn polynomial_arguments(&self, creepage: &Creepage<S>) -> (S, [S; 4]) {
        let (turned, [x, y, z]) = self.uncoupled(creepage);
        let (_, side) = self.side_slips(creepage.spin, creepage.curvature.unwrap_or_else(S::zero));
        (turned, [x, y, z, turned * side])
    }

    /// Kalker's nonlinear theory in polynomials, the curvature of the groove included.
    #[inline(always)]
    fn polynomials(&self, kalker: &PolynomialsFrom<'_>, creepage: &Creepage<S>) -> CreepForces<S> {
        let (turned, q) = self.polynomial_arguments(creepage);
        let [x, y, z, second] = S::apply(kalker, q);
        self.dimensional([turned * x, turned * y, z], turned * second * self.second_moment_scale())
    }

    /// [N m2] mu Q times the square of the half width.
    #[inline(always)]
    fn second_moment_scale(&self) -> S {
        self.friction_limit * self.half_width.square()
    }

    /// Forces with the difference of the polynomials for rolling along +x, kept within their limits.
    #[inline(always)]
    fn corrected(&self, forces: &CreepForces<S>, direction: S, difference: &[f64; 4]) -> CreepForces<S> {
        let (per_force, per_moment) = self.per_limits();
        let [x, y, z, second] = difference.map(S::constant);
        let [x, y] = within_limit(
            forces.longitudinal * per_force + direction * x,
            forces.lateral * per_force + direction * y,
        );
        let z = (forces.spin_moment * per_moment + z).clamp_to(-1.0, 1.0);
        let second = forces.second_moment + direction * second * self.second_moment_scale();
        self.dimensional([x, y, z], second)
    }

    /// Linear theory saturated as one vector of force and moment.
    ///
    /// With `q = (F_x/(mu Q), F_y/(mu Q), M_z/M_max)` of linear theory, all three are multiplied by the same
    /// `g(|q|)`, the cubic of Vermeulen and Johnson (1964): `g = 1 - q/3 + q^2/27` up to `q = 3`, then `1/q`.
    /// The law is tangent to linear theory at zero with and without spin, `|F| <= mu Q`, `|M_z| <= M_max`; and dissipative for
    /// every creepage, since one factor scales a linear law whose coupling is skew (C32 = -C23). The moment is
    /// part of the norm because large spin must take the lateral force away, not saturate it.
    #[inline(always)]
    fn saturated(&self, creepage: &Creepage<S>) -> [S; 3] {
        let linear = self.linear(creepage);
        let (per_force, per_moment) = self.per_limits();
        let (x, y) = (linear.longitudinal * per_force, linear.lateral * per_force);
        let z = linear.spin_moment * per_moment;
        let factor = saturation((x.square() + y.square() + z.square()).sqrt());
        [x * factor, y * factor, z * factor]
    }
}

impl LinearTheory<f64> {
    /// Arguments of the polynomials, and the table's results in the same scale; nothing without a table.
    pub fn polynomial_scale(
        &self,
        table: Option<&CreepTable>,
        creepage: &Creepage<f64>,
    ) -> ([f64; 4], [f64; 4]) {
        let (turned, q) = self.polynomial_arguments(creepage);
        let Some(table) = table else {
            return (q, [0.0; 4]);
        };
        let forces = self.forces(Law::Table(table), creepage);
        let (per_force, per_moment) = self.per_limits();
        let per_second = 1.0 / (self.second_moment_scale() + f64::MIN_POSITIVE);
        let results = [
            turned * forces.longitudinal * per_force,
            turned * forces.lateral * per_force,
            forces.spin_moment * per_moment,
            turned * forces.second_moment * per_second,
        ];
        (q, results)
    }
}
