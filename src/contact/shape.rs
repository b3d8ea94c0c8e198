//! Load-independent properties of a ball-race contact over the raceway's curvature, as smooth polynomials.
//!
//! The transverse curvature of a groove contact is constant; the one along rolling varies with the contact angle.
//! Everything that Hertz and Kalker need then is a function of that one curvature, tabulated once per raceway.

use std::f64::consts::PI;

use crate::contact::hertz::{HertzContact, complete_elliptic_integrals};
use crate::contact::raceway::Raceway;
use crate::kalker::Patch;
use crate::kalker::linear::{LinearError, creep_matrix};
use crate::model::bearing::Bearing;
use crate::numerics::scalar::Scalar;

/// Nodes per polynomial. The interval of curvatures is short, so that they converge at about two digits a node:
/// the relative error of the stiffness is below 1e-10 for ball over pitch diameter up to 0.4 (tested).
const NODES: usize = 14;

/// A polynomial in a variable that is scaled to [-1, 1], ascending powers.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Polynomial([f64; NODES]);

impl Polynomial {
    /// Interpolates values at the Chebyshev nodes.
    fn interpolate(values: &[f64; NODES]) -> Self {
        // Chebyshev coefficients by the discrete orthogonality of the nodes, then T_k in powers by recurrence.
        let n = NODES as f64;
        let mut powers = [0.0; NODES];
        let mut previous = [0.0; NODES];
        let mut current = [0.0; NODES];
        current[0] = 1.0;
        for k in 0..NODES {
            let weight = if k == 0 { 1.0 } else { 2.0 } / n;
            let coefficient: f64 =
                (0..NODES).map(|j| weight * values[j] * (k as f64 * PI * (j as f64 + 0.5) / n).cos()).sum();
            for (power, term) in powers.iter_mut().zip(current) {
                *power += coefficient * term;
            }
            let mut next = [0.0; NODES];
            let double = if k == 0 { 1.0 } else { 2.0 };
            for i in 0..NODES {
                let shifted = if i > 0 { double * current[i - 1] } else { 0.0 };
                next[i] = shifted - if k == 0 { 0.0 } else { previous[i] };
            }
            previous = current;
            current = next;
        }
        Self(powers)
    }
}

/// Position of Chebyshev node j in [-1, 1].
fn node(j: usize) -> f64 {
    (PI * (j as f64 + 0.5) / NODES as f64).cos()
}

/// Properties of the contacts of one raceway at one curvature; multiply by the named power of the approach.
#[derive(Clone, Copy, Debug)]
pub struct ShapeAt<S> {
    /// [N/m^1.5] `Q = stiffness delta^1.5` (paper eq. 8).
    pub stiffness: S,
    /// [N/m] `G c^2 C11` over `delta`.
    pub longitudinal: S,
    /// [N/m] `G c^2 C22` over `delta`.
    pub lateral: S,
    /// [N/m^0.5] `G c^3 C23` over `delta^1.5`.
    pub coupling: S,
    /// [N] `G c^4 C33` over `delta^2`.
    pub spin: S,
    /// [m^0.5] semi-axis along rolling over `sqrt(delta)`.
    pub semi_axis_rolling: S,
    /// [m^0.5] semi-axis transverse to rolling over `sqrt(delta)`.
    pub semi_axis_transverse: S,
    /// [m^0.5] `c = sqrt(a b)` over `sqrt(delta)`.
    pub mean_semi_axis: S,
    /// [m^0.5] spin moment of complete slip over `mu Q sqrt(delta)`.
    pub spin_arm: S,
}

impl ShapeAt<f64> {
    /// Contact of relative curvatures [1/m] along and transverse to rolling, of materials with a `compliance`
    /// `(1 - nu1^2)/E1 + (1 - nu2^2)/E2` [1/Pa], a combined `shear` modulus [Pa] and Poisson's ratio.
    ///
    /// # Errors
    /// If Kalker's linear theory has no answer for the axis ratio.
    pub fn new(
        curvature_rolling: f64,
        curvature_transverse: f64,
        compliance: f64,
        shear: f64,
        poisson_ratio: f64,
    ) -> Result<Self, LinearError> {
        let hertz = HertzContact::new(curvature_rolling, curvature_transverse, compliance);
        let axis_ratio = hertz.semi_axis_rolling / hertz.semi_axis_transverse;
        Self::with_creep_of(axis_ratio, &hertz, shear, poisson_ratio)
    }

    /// The same of a Hertz contact, with the creep coefficients of a patch of another axis ratio.
    ///
    /// # Errors
    /// As [`ShapeAt::new`].
    pub fn with_creep_of(
        axis_ratio: f64,
        hertz: &HertzContact,
        shear: f64,
        poisson_ratio: f64,
    ) -> Result<Self, LinearError> {
        let (along, across) = (hertz.semi_axis_rolling, hertz.semi_axis_transverse);
        let creep = creep_matrix(&Patch { axis_ratio, poisson_ratio, rolling_angle: 0.0 })?;
        let area = along * across;
        let (long, short) = (along.max(across), along.min(across));
        let (_, second) = complete_elliptic_integrals(1.0 - (short / long).powi(2));
        Ok(Self {
            stiffness: hertz.stiffness,
            longitudinal: shear * area * creep[(0, 0)],
            lateral: shear * area * creep[(1, 1)],
            coupling: shear * area.powf(1.5) * creep[(1, 2)],
            spin: shear * area.powi(2) * creep[(2, 2)],
            semi_axis_rolling: along,
            semi_axis_transverse: across,
            mean_semi_axis: area.sqrt(),
            // Hertzian pressure times distance from the centre, integrated: 3/8 of the long axis times E(m).
            spin_arm: 0.375 * long * second,
        })
    }
}

/// Shape of all contacts of one raceway.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactShape {
    /// [1/m] middle and half width of the interval of circumferential curvatures.
    middle: f64,
    half_width: f64,
    transverse_curvature: f64,
    ball_curvature: f64,
    compliance: f64,
    stiffness: Polynomial,
    longitudinal: Polynomial,
    lateral: Polynomial,
    coupling: Polynomial,
    spin: Polynomial,
    semi_axis_rolling: Polynomial,
    semi_axis_transverse: Polynomial,
    mean_semi_axis: Polynomial,
    spin_arm: Polynomial,
}

impl ContactShape {
    /// Tabulates the contacts of a raceway of the bearing.
    ///
    /// # Errors
    /// If Kalker's linear theory has no answer for an axis ratio that occurs.
    pub fn new(bearing: &Bearing, raceway: &Raceway) -> Result<Self, LinearError> {
        let radius = bearing.ball.radius;
        // Curvature at contact angle 0; beyond a right angle the contact has left any real groove.
        let contact_radius = if raceway.groove_circle_radius > bearing.pitch_diameter / 2.0 {
            raceway.groove_circle_radius - raceway.groove_radius
        } else {
            -(raceway.groove_circle_radius + raceway.groove_radius)
        };
        let extreme = 1.05 / contact_radius;
        let (middle, half_width) = (0.475 * extreme, 0.525 * extreme.abs());
        let ball_curvature = 1.0 / radius;
        let transverse_curvature = ball_curvature - 1.0 / raceway.groove_radius;
        let mut columns = [[0.0; NODES]; 9];
        for j in 0..NODES {
            let curvature = middle + half_width * node(j);
            let at = ShapeAt::new(
                ball_curvature + curvature,
                transverse_curvature,
                bearing.contact_compliance,
                bearing.shear_modulus,
                bearing.poisson_ratio,
            )?;
            let row = [
                at.stiffness,
                at.longitudinal,
                at.lateral,
                at.coupling,
                at.spin,
                at.semi_axis_rolling,
                at.semi_axis_transverse,
                at.mean_semi_axis,
                at.spin_arm,
            ];
            for (column, value) in columns.iter_mut().zip(row) {
                column[j] = value;
            }
        }
        let [
            stiffness,
            longitudinal,
            lateral,
            coupling,
            spin,
            semi_axis_rolling,
            semi_axis_transverse,
            mean_semi_axis,
            spin_arm,
        ] = columns.map(|column| Polynomial::interpolate(&column));
        Ok(Self {
            middle,
            half_width,
            transverse_curvature,
            ball_curvature,
            compliance: bearing.contact_compliance,
            stiffness,
            longitudinal,
            lateral,
            coupling,
            spin,
            semi_axis_rolling,
            semi_axis_transverse,
            mean_semi_axis,
            spin_arm,
        })
    }

    /// A patch in the middle of those that occur: the axis ratio of a raceway's contacts hardly changes with the
    /// contact angle, and not with load.
    pub fn typical_patch(&self, poisson_ratio: f64) -> Patch {
        let hertz = self.hertz(self.middle);
        let axis_ratio = hertz.semi_axis_rolling / hertz.semi_axis_transverse;
        Patch { axis_ratio, poisson_ratio, rolling_angle: 0.0 }
    }

    #[inline(always)]
    fn scaled<S: Scalar>(&self, curvature: S) -> S {
        (curvature - S::constant(self.middle)).scale(1.0 / self.half_width).clamp_to(-1.0, 1.0)
    }

    /// [N/m^1.5] Hertz stiffness at a circumferential curvature of the raceway [1/m].
    #[inline(always)]
    pub fn stiffness<S: Scalar>(&self, curvature: S) -> S {
        self.scaled(curvature).polynomial(&self.stiffness.0)
    }

    /// All properties at a circumferential curvature of the raceway [1/m].
    #[inline(always)]
    pub fn at<S: Scalar>(&self, curvature: S) -> ShapeAt<S> {
        let x = self.scaled(curvature);
        ShapeAt {
            stiffness: x.polynomial(&self.stiffness.0),
            longitudinal: x.polynomial(&self.longitudinal.0),
            lateral: x.polynomial(&self.lateral.0),
            coupling: x.polynomial(&self.coupling.0),
            spin: x.polynomial(&self.spin.0),
            semi_axis_rolling: x.polynomial(&self.semi_axis_rolling.0),
            semi_axis_transverse: x.polynomial(&self.semi_axis_transverse.0),
            mean_semi_axis: x.polynomial(&self.mean_semi_axis.0),
            spin_arm: x.polynomial(&self.spin_arm.0),
        }
    }

    /// The exact Hertz contact at a circumferential curvature of the raceway [1/m], not interpolated.
    pub fn hertz(&self, curvature: f64) -> HertzContact {
        HertzContact::new(self.ball_curvature + curvature, self.transverse_curvature, self.compliance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn interpolated_stiffness_is_exact_to_1e_10() {
        let text = include_str!("../../scenes/thrust.toml");
        for pitch in ["24 mm", "46 mm", "300 mm"] {
            let text =
                text.replace("\"46 mm\"", &format!("\"{pitch}\"")).replace("balls = 10 ", "balls = 7 ");
            let bearing = Bearing::new(&Scene::parse(&text).unwrap());
            for raceway in [&bearing.inner, &bearing.outer] {
                let shape = ContactShape::new(&bearing, raceway).unwrap();
                for i in 0..=50 {
                    let curvature = shape.middle + shape.half_width * (f64::from(i) / 25.0 - 1.0);
                    let exact = shape.hertz(curvature).stiffness;
                    let error = (shape.stiffness(curvature) / exact - 1.0).abs();
                    assert!(error < 1e-10, "pitch {pitch}, curvature {curvature}: {error:e}");
                }
            }
        }
    }
}
