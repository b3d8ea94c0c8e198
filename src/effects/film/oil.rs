//! Viscosity of an oil at its temperature.

use crate::numerics::elementary::{ln, pow};

/// \[K] absolute temperature of 0 degC.
const ZERO_CELSIUS: f64 = 273.15;
/// \[K] temperature of ISO viscosity grades.
const GRADE_TEMPERATURE: f64 = 40.0 + ZERO_CELSIUS;
/// Slopes of Walther's law of mineral oils with a viscosity index of 95, by their ISO viscosity grade [mm2/s]. They are those of the
/// viscosities at 100 degC that give the index by ASTM D2270, such as 8.53 mm2/s of ISO VG 68.
const SLOPES: [(f64, f64); 14] = [
    (10.0, 3.8587),
    (15.0, 3.8329),
    (22.0, 3.8135),
    (32.0, 3.8045),
    (46.0, 3.7443),
    (68.0, 3.6711),
    (100.0, 3.5732),
    (150.0, 3.4816),
    (220.0, 3.4112),
    (320.0, 3.3548),
    (460.0, 3.3061),
    (680.0, 3.2612),
    (1000.0, 3.2278),
    (1500.0, 3.2008),
];

/// An oil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Oil {
    /// Oil of one viscosity [Pa s].
    Given(f64),
    /// Oil of an ISO viscosity grade [mm2/s] and a density [kg/m3], by Walther's law (ASTM D341).
    Graded(f64, f64),
}

impl Oil {
    /// Its name, at a temperature \[degC].
    pub fn name(&self, temperature: f64) -> String {
        match self {
            Self::Given(viscosity) => format!("oil of {viscosity} Pa s"),
            Self::Graded(grade, _) => format!("ISO VG {grade} at {temperature} degC"),
        }
    }

    /// [Pa s] dynamic viscosity at a temperature \[degC].
    pub fn viscosity(&self, temperature: f64) -> f64 {
        match *self {
            Self::Given(viscosity) => viscosity,
            Self::Graded(grade, density) => kinematic(grade, temperature) * 1e-6 * density,
        }
    }

    /// [1/K] relative fall of the viscosity with temperature, at a temperature \[degC]; none of an oil of one viscosity.
    pub fn falls(&self, temperature: f64) -> Option<f64> {
        match *self {
            Self::Given(_) => None,
            Self::Graded(grade, _) => {
                // d ln(nu)/dT of lg lg(nu + 0.7) = A - B lg T.
                let shifted = kinematic(grade, temperature) + 0.7;
                let growth = slope(grade) * ln(shifted) / (temperature + ZERO_CELSIUS);
                Some(growth * shifted / (shifted - 0.7))
            }
        }
    }
}

/// [mm2/s] kinematic viscosity of a grade at a temperature \[degC]: Walther's law `lg lg(nu + 0.7) = A - B lg T` (ASTM D341).
fn kinematic(grade: f64, temperature: f64) -> f64 {
    let absolute = temperature + ZERO_CELSIUS;
    let log10 = |x: f64| ln(x) / std::f64::consts::LN_10;
    let at_grade = log10(log10(grade + 0.7));
    let log_log = at_grade - slope(grade) * log10(absolute / GRADE_TEMPERATURE);
    // Below 0.2 mm2/s the law ends: no oil is as thin.
    (pow(10.0, pow(10.0, log_log)) - 0.7).max(0.2)
}

/// Slope of Walther's law of a grade, between those of the table by the logarithm of the grade.
fn slope(grade: f64) -> f64 {
    let next = SLOPES.partition_point(|&(listed, _)| listed <= grade).clamp(1, SLOPES.len() - 1);
    let ((g0, b0), (g1, b1)) = (SLOPES[next - 1], SLOPES[next]);
    let share = (ln(grade / g0) / ln(g1 / g0)).clamp(0.0, 1.0);
    b0 + (b1 - b0) * share
}
