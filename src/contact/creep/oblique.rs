//! Rolling obliquely to the axes of the contact ellipse.
//!
//! Creep laws are known for rolling along an axis of the ellipse. Rolling along the other one is rolling along the axis of
//! the ellipse with both exchanged, a quarter of a turn further. Between, the forces of both are mixed: what holds for each,
//! that forces stay within their limits and dissipate, holds for the mixture.
//!
//! With the angle chi between rolling and the x axis the shares are as `cos^2 chi` to `m sin^2 chi`, where `m` is the root of
//! the axis ratio: in adhesion, where forces go with the way of a particle through the contact, the ratio itself would
//! be right, in sliding 1. Below 6 degrees there is no share across rolling; it would be 1 % at most. A rolling speed of 1 mm/s,
//! below which creepages are held finite and a direction has no meaning, counts as along x.
//!
//! For the table of the nonlinear theory a net knows what the mixture lacks ([`ObliqueNet`]). It keeps forces within their limits, and takes
//! at most `GIVEN_BACK` of the mixture's power away, so that the sum dissipates as well.

use super::Law;
use super::linear_theory::{CreepForces, Creepage, LinearTheory};
use crate::kalker::LinearError;
use crate::kalker::Patch;
use crate::kalker::linear::Scales;
use crate::kalker::oblique_net::{BEGIN, FULL, ObliqueNet};
use crate::numerics::scalar::{Scalar, within_limit};

/// [-] largest part of the mixture's power that the correction may take away.
const GIVEN_BACK: f64 = 0.9;

/// Constants of rolling across the ellipse's x axis, beside those of rolling along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exchanged {
    /// [-] `C11/C22` of the exchanged ellipse over the one in hand: coefficients of the same forces.
    longitudinal: f64,
    /// [-] `C22/C11`, likewise.
    lateral: f64,
    /// [-] `C23/C11`, likewise.
    coupling: f64,
    /// [-] `C33/C33`.
    spin: f64,
    /// [-] semi-axis along x over the one along y.
    axis_ratio: f64,
    /// Difference of the theory from a mixture of the tables.
    net: ObliqueNet,
}

/// Rolling across the x axis: its law.
#[derive(Clone, Copy, Debug)]
pub struct Across<'a> {
    /// The exchanged ellipse.
    pub exchanged: &'a Exchanged,
    /// Law of the exchanged ellipse.
    pub law: Law<'a>,
}

/// The patch with its axes exchanged, rolling along its x axis.
pub fn exchanged(patch: &Patch) -> Patch {
    Patch { axis_ratio: 1.0 / patch.axis_ratio, rolling_angle: 0.0, ..*patch }
}

impl Exchanged {
    /// Constants of a patch.
    ///
    /// # Errors
    /// If the patch is out of range.
    pub fn new(patch: &Patch) -> Result<Self, LinearError> {
        let here = Scales::new(&Patch { rolling_angle: 0.0, ..*patch })?;
        let there = Scales::new(&exchanged(patch))?;
        Ok(Self {
            longitudinal: there.c11 / here.c22,
            lateral: there.c22 / here.c11,
            coupling: there.c23 / here.c11,
            spin: there.c33 / here.c33,
            axis_ratio: patch.axis_ratio,
            net: ObliqueNet::new(patch)?,
        })
    }

    /// Linear theory of the exchanged ellipse by that of the one in hand and the sine of the rolling direction.
    #[inline(always)]
    fn theory<S: Scalar>(&self, theory: &LinearTheory<S>, sine: S) -> LinearTheory<S> {
        LinearTheory {
            longitudinal: theory.lateral.scale(self.longitudinal),
            lateral: theory.longitudinal.scale(self.lateral),
            coupling: theory.longitudinal.scale(self.coupling) * theory.mean_semi_axis * sine,
            spin: theory.spin.scale(self.spin),
            half_width: theory.half_width.scale(self.axis_ratio),
            ..*theory
        }
    }

    /// Forces of the nonlinear theory from the mixture of its tables.
    #[inline(always)]
    fn corrected<S: Scalar>(
        &self,
        forces: &CreepForces<S>,
        theory: &LinearTheory<S>,
        [cosine, sine]: [S; 2],
        creepage: &Creepage<S>,
    ) -> CreepForces<S> {
        let [x, y, z] = theory.over_limits(creepage);
        let [x, y, z] = S::apply(&self.net, [x, y, z, cosine, sine]);
        let (per_force, per_moment) = theory.per_limits();
        let [x, y] = within_limit(forces.longitudinal * per_force + x, forces.lateral * per_force + y);
        let z = (forces.spin_moment * per_moment + z).clamp_to(-1.0, 1.0);
        let full = CreepForces {
            longitudinal: x * theory.friction_limit,
            lateral: y * theory.friction_limit,
            spin_moment: z * theory.moment_limit,
            ..*forces
        };
        // Between two forces within the limits all are, and power is as linear.
        let (most, taken) = (
            forces.power(creepage).positive_part().scale(GIVEN_BACK),
            forces.power(creepage) - full.power(creepage),
        );
        let beyond = taken - most;
        let part = (most / taken.where_positive(beyond, S::one())).where_positive(beyond, S::one());
        forces.zip_with(&full, |mixed, full| mixed + (full - mixed) * part)
    }

    /// [-] share of rolling across in the forces by the square of the sine of the rolling direction: smooth.
    #[inline(always)]
    fn share<S: Scalar>(&self, sine_square: S) -> S {
        let m = self.axis_ratio.sqrt();
        sine_square.map_smooth(|square| {
            let u = (square - BEGIN) / (FULL - BEGIN);
            let (ramp, slope) = match u {
                u if u <= 0.0 => (0.0, 0.0),
                u if u >= 1.0 => (square, 1.0),
                // from nothing at slope 0 to the square at slope 1
                u => (
                    FULL * u * u * (3.0 - 2.0 * u) + (FULL - BEGIN) * u * u * (u - 1.0),
                    6.0 * FULL / (FULL - BEGIN) * u * (1.0 - u) + u * (3.0 * u - 2.0),
                ),
            };
            let sum = 1.0 - ramp + m * ramp;
            (m * ramp / sum, m * slope / (sum * sum))
        })
    }
}

/// Has rolling across x a share, by the rolling speed and its component across x? From a little before it has.
#[inline(always)]
pub(crate) fn is_oblique<S: Scalar>(speed: S, across: S) -> bool {
    across.any_beyond(0.999 * BEGIN.sqrt(), speed)
}

impl Across<'_> {
    /// Forces of oblique rolling from those of the law along x, by linear theory along x, cosine and sine of the rolling direction and
    /// the creepages. A function of its own, as few contacts roll so.
    #[inline(never)]
    pub fn forces<S: Scalar>(
        &self,
        along: &CreepForces<S>,
        theory: &LinearTheory<S>,
        direction: [S; 2],
        creepage: &Creepage<S>,
    ) -> CreepForces<S> {
        let [_, sine] = direction;
        let mut forces = self.mixed(along, theory, sine, creepage);
        if matches!(self.law, Law::Table(_)) {
            forces = self.exchanged.corrected(&forces, theory, direction, creepage);
        }
        // Where rolling across has no share the forces keep their bits.
        let share = self.exchanged.share(sine.square());
        along.zip_with(&forces, |along, forces| forces.where_positive(share, along))
    }

    /// The mixture alone. The slip of a bent groove is part of rolling along x alone.
    #[inline(always)]
    pub fn mixed<S: Scalar>(
        &self,
        along: &CreepForces<S>,
        theory: &LinearTheory<S>,
        sine: S,
        creepage: &Creepage<S>,
    ) -> CreepForces<S> {
        // x of the exchanged ellipse is y here, its y is -x
        let turned = Creepage {
            longitudinal: creepage.lateral,
            lateral: -creepage.longitudinal,
            spin: creepage.spin,
            curvature: None,
        };
        let forces = self.exchanged.theory(theory, sine).forces_apart(self.law, &turned);
        let across = CreepForces {
            longitudinal: -forces.lateral,
            lateral: forces.longitudinal,
            spin_moment: forces.spin_moment,
            second_moment: S::zero(),
        };
        let share = self.exchanged.share(sine.square());
        let rest = S::one() - share;
        along.zip_with(&across, |along, across| along * rest + across * share)
    }
}
