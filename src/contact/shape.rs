//! Load-independent properties of a ball-race contact over the raceway's curvature, as smooth polynomials.
//!
//! The transverse curvature of a groove contact is constant; the one along rolling varies with the contact angle.
//! Everything that Hertz and Kalker need then is a function of that one curvature, tabulated once per raceway.

use std::convert::Infallible;
use std::f64::consts::PI;
use std::sync::LazyLock;

use super::hertz::HertzContact;
use super::materials::Pair;
use super::raceway::Raceway;
use crate::kalker::LinearError;
use crate::kalker::Patch;
use crate::kalker::creep_coefficients::along_x;
use crate::numerics::elliptic::complete_elliptic_integrals;
use crate::numerics::scalar::Scalar;

/// Nodes per polynomial. The interval of curvatures is short, so that they converge at about two digits a node:
/// the relative error of the stiffness is below 1e-10 for ball over pitch diameter up to 0.4 (tested).
const NODES: usize = 14;
/// [-] largest cosine of a contact angle on the washer of a thrust bearing: 30 degrees from a free angle of 86.
const STEEPEST: f64 = 0.56;

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
            let coefficient: f64 = (0..NODES).map(|j| weight * values[j] * COSINES[k][j]).sum();
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

/// Chebyshev polynomials (first index) at the nodes.
static COSINES: LazyLock<[[f64; NODES]; NODES]> = LazyLock::new(|| {
    std::array::from_fn(|k| std::array::from_fn(|j| (k as f64 * PI * (j as f64 + 0.5) / NODES as f64).cos()))
});

/// Position of Chebyshev node j in [-1, 1].
fn node(j: usize) -> f64 {
    (PI * (j as f64 + 0.5) / NODES as f64).cos()
}

/// Properties of one contact that do not depend on its load, each to be multiplied by the named power of the approach. `T`
/// is a number, or a polynomial that gives the number at any curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeAt<T> {
    /// [N/m^1.5] `Q = stiffness delta^1.5` (paper eq. 8).
    pub stiffness: T,
    /// [N/m] `G c^2 C11` over `delta`.
    pub longitudinal: T,
    /// [N/m] `G c^2 C22` over `delta`.
    pub lateral: T,
    /// [N/m^0.5] `G c^3 C23` over `delta^1.5`.
    pub coupling: T,
    /// \[N] `G c^4 C33` over `delta^2`.
    pub spin: T,
    /// [m^0.5] semi-axis along rolling over `sqrt(delta)`.
    pub semi_axis_rolling: T,
    /// [m^0.5] semi-axis transverse to rolling over `sqrt(delta)`.
    pub semi_axis_transverse: T,
    /// [m^0.5] `c = sqrt(a b)` over `sqrt(delta)`.
    pub mean_semi_axis: T,
    /// [m^0.5] spin moment of complete slip over `mu Q sqrt(delta)`.
    pub spin_arm: T,
}

/// Computes every property of a [`ShapeAt`] by one expression from the same property of others. It is a macro because the
/// compiler does not inline nine calls of a closure where several balls are evaluated at once.
macro_rules! each_property {
    ($($property:ident of $shape:expr),+ => $value:expr) => {
        ShapeAt {
            stiffness: { $(let $property = &$shape.stiffness;)+ $value },
            longitudinal: { $(let $property = &$shape.longitudinal;)+ $value },
            lateral: { $(let $property = &$shape.lateral;)+ $value },
            coupling: { $(let $property = &$shape.coupling;)+ $value },
            spin: { $(let $property = &$shape.spin;)+ $value },
            semi_axis_rolling: { $(let $property = &$shape.semi_axis_rolling;)+ $value },
            semi_axis_transverse: { $(let $property = &$shape.semi_axis_transverse;)+ $value },
            mean_semi_axis: { $(let $property = &$shape.mean_semi_axis;)+ $value },
            spin_arm: { $(let $property = &$shape.spin_arm;)+ $value },
        }
    };
}

impl ShapeAt<f64> {
    /// Properties as constants of a type of numbers.
    #[inline(always)]
    pub(super) fn constant<S: Scalar>(&self) -> ShapeAt<S> {
        each_property!(property of self => S::constant(*property))
    }

    /// Properties of a Hertz contact without creep: its coefficients are 0.
    fn without_creep(hertz: &HertzContact) -> Self {
        let (along, across) = (hertz.semi_axis_rolling, hertz.semi_axis_transverse);
        let (long, short) = (along.max(across), along.min(across));
        let (_, second) = complete_elliptic_integrals(1.0 - (short / long).powi(2));
        Self {
            stiffness: hertz.stiffness,
            longitudinal: 0.0,
            lateral: 0.0,
            coupling: 0.0,
            spin: 0.0,
            semi_axis_rolling: along,
            semi_axis_transverse: across,
            mean_semi_axis: (along * across).sqrt(),
            // Hertzian pressure times distance from the centre, integrated: 3/8 of the long axis times E(m).
            spin_arm: 0.375 * long * second,
        }
    }

    /// Properties of a Hertz contact with the creep coefficients of a patch of an axis ratio, of materials with a combined
    /// `shear` modulus \[Pa] and Poisson's ratio.
    ///
    /// # Errors
    /// If Kalker's linear theory has no answer for the axis ratio.
    pub fn with_creep_of(
        axis_ratio: f64,
        hertz: &HertzContact,
        shear: f64,
        poisson_ratio: f64,
    ) -> Result<Self, LinearError> {
        let [c11, c22, c23, c33] = along_x(&Patch { axis_ratio, poisson_ratio, rolling_angle: 0.0 })?;
        let area = hertz.semi_axis_rolling * hertz.semi_axis_transverse;
        Ok(Self {
            longitudinal: shear * area * c11,
            lateral: shear * area * c22,
            coupling: shear * area.powf(1.5) * c23,
            spin: shear * area.powi(2) * c33,
            ..Self::without_creep(hertz)
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
    properties: ShapeAt<Polynomial>,
}

impl ContactShape {
    /// Tabulates the contacts of balls of a radius \[m] on a pitch circle of a diameter \[m] with a raceway.
    ///
    /// # Errors
    /// If Kalker's linear theory has no answer for an axis ratio that occurs.
    pub fn new(
        ball_radius: f64,
        pitch_diameter: f64,
        materials: &Pair,
        raceway: &Raceway,
    ) -> Result<Self, LinearError> {
        Self::tabulated(ball_radius, pitch_diameter, materials, raceway, |hertz| {
            let axis_ratio = hertz.semi_axis_rolling / hertz.semi_axis_transverse;
            ShapeAt::with_creep_of(axis_ratio, hertz, materials.shear_modulus, materials.poisson_ratio)
        })
    }

    /// Tabulates the contacts of balls of a radius \[m] on a pitch circle of a diameter \[m] with a raceway for forces without creep.
    pub fn without_creep(ball_radius: f64, pitch_diameter: f64, materials: &Pair, raceway: &Raceway) -> Self {
        let properties = |hertz: &HertzContact| Ok::<_, Infallible>(ShapeAt::without_creep(hertz));
        let Ok(shape) = Self::tabulated(ball_radius, pitch_diameter, materials, raceway, properties);
        shape
    }

    /// Interpolates the properties of Hertz contacts over the curvatures that occur.
    fn tabulated<E>(
        ball_radius: f64,
        pitch_diameter: f64,
        materials: &Pair,
        raceway: &Raceway,
        properties: impl Fn(&HertzContact) -> Result<ShapeAt<f64>, E>,
    ) -> Result<Self, E> {
        if raceway.faces_along_axis(ball_radius) {
            // Curvatures of both signs about a right angle, to where `Bearing::contact_angles` ends.
            let half_width = 1.05 * STEEPEST / (0.5 * pitch_diameter - STEEPEST * ball_radius);
            return Self::between(0.0, half_width, ball_radius, materials, raceway, properties);
        }
        // Curvature at contact angle 0; beyond a right angle the contact has left any real groove.
        let contact_radius = if raceway.groove_circle_radius > pitch_diameter / 2.0 {
            raceway.groove_circle_radius - raceway.groove_radius
        } else {
            -(raceway.groove_circle_radius + raceway.groove_radius)
        };
        let extreme = 1.05 / contact_radius;
        Self::between(0.475 * extreme, 0.525 * extreme.abs(), ball_radius, materials, raceway, properties)
    }

    /// Interpolates over curvatures [1/m] a half width about a middle.
    fn between<E>(
        middle: f64,
        half_width: f64,
        ball_radius: f64,
        materials: &Pair,
        raceway: &Raceway,
        properties: impl Fn(&HertzContact) -> Result<ShapeAt<f64>, E>,
    ) -> Result<Self, E> {
        let ball_curvature = 1.0 / ball_radius;
        let transverse_curvature = ball_curvature - 1.0 / raceway.groove_radius;
        let at = |node: f64| {
            let curvature = ball_curvature + (middle + half_width * node);
            properties(&HertzContact::new(curvature, transverse_curvature, materials.compliance))
        };
        let first = at(node(0))?;
        let mut columns = each_property!(value of first => [*value; NODES]);
        for j in 1..NODES {
            let here = at(node(j))?;
            columns = each_property!(column of columns, value of here => {
                let mut column = *column;
                column[j] = *value;
                column
            });
        }
        Ok(Self {
            middle,
            half_width,
            transverse_curvature,
            ball_curvature,
            compliance: materials.compliance,
            properties: each_property!(column of columns => Polynomial::interpolate(column)),
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
        self.scaled(curvature).polynomial(&self.properties.stiffness.0)
    }

    /// All properties at a circumferential curvature of the raceway [1/m].
    #[inline(always)]
    pub fn at<S: Scalar>(&self, curvature: S) -> ShapeAt<S> {
        let x = self.scaled(curvature);
        each_property!(property of self.properties => x.polynomial(&property.0))
    }

    /// [-] Hertz stiffness of a ball whose radius is larger by a length \[m] over that of the others, at a circumferential curvature
    /// of the raceway [1/m].
    pub fn stiffness_of_larger(&self, larger: f64, curvature: f64) -> f64 {
        let other = 1.0 / (1.0 / self.ball_curvature + larger);
        let transverse = self.transverse_curvature + (other - self.ball_curvature);
        let hertz = HertzContact::new(other + curvature, transverse, self.compliance);
        hertz.stiffness / self.hertz(curvature).stiffness
    }

    /// The exact Hertz contact at a circumferential curvature of the raceway [1/m], not interpolated.
    pub fn hertz(&self, curvature: f64) -> HertzContact {
        HertzContact::new(self.ball_curvature + curvature, self.transverse_curvature, self.compliance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolated_stiffness_is_exact_to_1e_10() {
        let steel = Pair::new([(206e9, 0.3); 2]);
        let (radius, groove_radius) = (4.7625e-3, 4.953e-3);
        for pitch in [24e-3, 46e-3, 300e-3] {
            // Groove centres a fifth of a millimetre beyond and within the pitch circle.
            for groove_circle_radius in [0.5 * pitch + 1.7e-4, 0.5 * pitch - 1.7e-4] {
                let raceway = Raceway { groove_radius, groove_circle_radius, groove_offset: 0.0 };
                let shape = ContactShape::new(radius, pitch, &steel, &raceway).unwrap();
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
