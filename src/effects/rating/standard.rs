//! Formulas of ISO 281 (load ratings, modified life) and ISO/TS 16281 (life from the load of every ball) for radial, angular-contact and
//! thrust ball bearings.
//!
//! The standards were not at hand: formulas come from public codes that quote their clauses. One of these has the load ratings of
//! single balls over `cos(alpha)^0.7`. Only `cos(alpha)` gives a bearing half of whose balls are loaded the life that ISO 281 gives
//! it, within 0.1 % at any contact angle, where the other power is 8 % off at 25 degrees and 21 % at 40.

use crate::contact::hertz::HertzContact;

/// Quantities that load ratings depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    /// [-] number of balls Z.
    pub balls: usize,
    /// \[m] ball diameter D.
    pub ball_diameter: f64,
    /// \[m] pitch diameter.
    pub pitch_diameter: f64,
    /// \[rad] nominal contact angle.
    pub contact_angle: f64,
    /// [-] groove radii of the inner and the outer race over the ball diameter.
    pub conformities: [f64; 2],
}

/// [-] conformities that the tables of ISO 281 hold to; they are computed with the narrower ones for all.
const USUAL: [f64; 2] = [0.52, 0.53];
/// [-] conformity of both races that the tables are computed with.
const TABLE: f64 = 0.52;
/// [-] conformity that the table of thrust bearings holds to, and that which it is computed with.
const OF_THRUST: [f64; 2] = [0.54, 0.535];
/// \[rad] largest contact angle of radial bearings; beyond are thrust bearings (ISO 281).
const STEEPEST: f64 = std::f64::consts::FRAC_PI_4;
/// [-] factor of contemporary steel and manufacture (ISO 281:2007, table 1, deep-groove and angular-contact bearings).
const MATERIAL: f64 = 1.3;
/// \[m] ball diameter from which loads grow less with size.
const LARGE_BALL: f64 = 25.4e-3;
/// \[Pa] pressure at which a ball leaves a mark of a ten thousandth of its diameter (ISO 76).
pub const STATIC_PRESSURE: f64 = 4200e6;
/// [-] exponent of the two races' shares of the life of the bearing.
const SHARE: f64 = 10.0 / 9.0;

/// [-] `(1 - gamma)/(1 + gamma)`, and how much the grooves favour the outer race: `f_i/f_o (2 f_o - 1)/(2 f_i - 1)`.
fn favour(gamma: f64, [inner, outer]: [f64; 2]) -> f64 {
    let grooves = inner / outer * (2.0 * outer - 1.0) / (2.0 * inner - 1.0);
    ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * grooves.powf(0.41)
}

impl Geometry {
    /// [-] `D cos(alpha)/D_pw`.
    pub fn gamma(&self) -> f64 {
        self.ball_diameter * self.contact_angle.cos() / self.pitch_diameter
    }

    /// Is it a thrust bearing?
    pub fn is_thrust(&self) -> bool {
        // A last digit beyond is not beyond.
        self.contact_angle > STEEPEST * (1.0 + 1e-12)
    }

    /// Conformities that the factors of the standard are computed with.
    fn of_table(&self) -> [f64; 2] {
        let [inner, outer] = self.conformities;
        let (largest, table) =
            if self.is_thrust() { ([OF_THRUST[0]; 2], OF_THRUST[1]) } else { (USUAL, TABLE) };
        let usual = inner <= largest[0] * (1.0 + 1e-12) && outer <= largest[1] * (1.0 + 1e-12);
        if usual { [table; 2] } else { self.conformities }
    }

    /// [-] factor f_c of ISO 281, N and mm, of radial bearings; of thrust bearings with that of the angle, `(cos alpha)^0.7 tan alpha`, which at 90 degrees
    /// is f_c itself: 0.9 (1 - sin(alpha)/3) in place of 0.41 x 0.95 (ISO/TR 1281-1).
    pub fn factor(&self) -> f64 {
        let conformities = self.of_table();
        let (gamma, inner) = (self.gamma(), conformities[0]);
        let curvature = (2.0 * inner / (2.0 * inner - 1.0)).powf(0.41);
        let flat = (1.0 - gamma).powf(1.39) / (1.0 + gamma).cbrt();
        if self.is_thrust() {
            let sine = self.contact_angle.sin();
            let size = (self.ball_diameter / self.pitch_diameter).powf(0.3);
            let both = (1.0 + favour(gamma, conformities).powf(10.0 / 3.0)).powf(-0.3);
            return 98.0665 * 0.9 * (1.0 - sine / 3.0) * sine * curvature * size * flat * both;
        }
        let both = (1.0 + (1.04 * favour(gamma, conformities)).powf(10.0 / 3.0)).powf(-0.3);
        98.0665 * 0.41 * 0.95 * curvature * gamma.powf(0.3) * flat * both
    }

    /// \[N] basic dynamic load rating C of a single-row bearing (ISO 281).
    pub fn dynamic_load_rating(&self) -> f64 {
        let millimetres = 1e3 * self.ball_diameter;
        let size = if self.ball_diameter <= LARGE_BALL {
            millimetres.powf(1.8)
        } else {
            3.647 * millimetres.powf(1.4)
        };
        let angle = if self.is_thrust() { 1.0 } else { self.contact_angle.cos().powf(0.7) };
        MATERIAL * self.factor() * angle * (self.balls as f64).powf(2.0 / 3.0) * size
    }

    /// \[N] loads of a rolling element that a race stands a million revolutions: inner and outer (ISO/TS 16281:2008, 4.3), of a
    /// bearing with a dynamic load rating \[N].
    pub fn ball_ratings(&self, dynamic_load_rating: f64) -> [f64; 2] {
        if self.is_thrust() {
            let ratio = favour(self.gamma(), self.conformities).powf(10.0 / 3.0);
            let single = dynamic_load_rating / (self.balls as f64 * self.contact_angle.sin());
            return [ratio, 1.0 / ratio].map(|ratio| single * (1.0 + ratio).powf(0.3));
        }
        let ratio = 1.044 * favour(self.gamma(), self.conformities);
        let single = dynamic_load_rating / (self.balls as f64 * self.contact_angle.cos());
        [
            single / 0.407 * (1.0 + ratio.powf(10.0 / 3.0)).powf(0.3),
            single / 0.389 * (1.0 + ratio.powf(-10.0 / 3.0)).powf(0.3),
        ]
    }

    /// \[N] load of a ball on the inner race that presses with [`STATIC_PRESSURE`]; elastic compliance of both [1/Pa].
    pub fn static_ball_load(&self, compliance: f64) -> f64 {
        self.static_ball_loads(compliance)[0]
    }

    /// \[N] the same on the inner and on the outer race.
    pub fn static_ball_loads(&self, compliance: f64) -> [f64; 2] {
        let cosine = self.contact_angle.cos();
        let curvature = 2.0 / self.ball_diameter;
        let along = [
            2.0 * cosine / (self.pitch_diameter - self.ball_diameter * cosine),
            -2.0 * cosine / (self.pitch_diameter + self.ball_diameter * cosine),
        ];
        [0, 1].map(|race: usize| {
            let across = curvature - 1.0 / (self.conformities[race] * self.ball_diameter);
            let contact = HertzContact::new(curvature + along[race], across, compliance);
            // Pressure is proportional to the root of the approach.
            let area = std::f64::consts::PI * contact.semi_axis_rolling * contact.semi_axis_transverse;
            let root = STATIC_PRESSURE * area / (1.5 * contact.stiffness);
            contact.stiffness * root.powi(3)
        })
    }

    /// \[N] basic static load rating C_0 (ISO 76: the most loaded ball of a radial bearing carries five times the mean, all of a thrust bearing the same)
    /// of the largest load of a ball \[N].
    pub fn static_load_rating(&self, ball_load: f64) -> f64 {
        let (sine, cosine) = self.contact_angle.sin_cos();
        self.balls as f64 * ball_load * if self.is_thrust() { sine } else { 0.2 * cosine }
    }

    /// [-] part of the load ratio that a_ISO is of (ISO 281:2007, eq. 31 to 33, and 37 to 39 of thrust bearings).
    pub fn load_share(&self) -> f64 {
        if self.is_thrust() { 1.0 / 3.0 } else { 1.0 }
    }
}

/// \[N] fatigue load limit C_u from the static load rating \[N] and the pitch diameter \[m] (ISO 281, annex B, simple form).
pub fn fatigue_load_limit(static_load_rating: f64, pitch_diameter: f64) -> f64 {
    static_load_rating / 22.0 * (0.1 / pitch_diameter).min(1.0).sqrt()
}

/// [million revolutions] life that 90 % of bearings reach, of the ratings of a ball \[N] and its equivalent loads \[N] on both races
/// (ISO/TS 16281); infinite without load.
pub fn reference_life(ratings: [f64; 2], loads: [f64; 2]) -> f64 {
    let wear = |race: usize| (loads[race] / ratings[race]).powf(3.0 * SHARE);
    (wear(0) + wear(1)).powf(-1.0 / SHARE)
}

/// [-] life modification factor a_ISO of ball bearings (ISO 281:2007, eq. 31 to 33): viscosity ratio kappa, and contamination
/// factor times fatigue load limit over equivalent load, of a thrust bearing a third of that ([`Geometry::load_share`]).
pub fn life_modification(viscosity_ratio: f64, load_ratio: f64) -> f64 {
    const LARGEST: f64 = 50.0;
    let kappa = viscosity_ratio.clamp(0.1, 4.0);
    let film = match kappa {
        thin if thin < 0.4 => 2.2649 * thin.powf(-0.054381),
        middle if middle < 1.0 => 1.9987 * middle.powf(-0.19087),
        thick => 1.9987 * thick.powf(-0.071739),
    };
    let left = 1.0 - (2.5671 - film).powf(0.83) * load_ratio.cbrt();
    if left > 0.0 { (0.1 * left.powf(-9.3)).min(LARGEST) } else { LARGEST }
}

/// [m2/s] kinematic viscosity that separates the surfaces: of a speed of rotation [rad/s] and the pitch diameter \[m] (ISO 281).
pub fn reference_viscosity(speed: f64, pitch_diameter: f64) -> f64 {
    let (rpm, millimetres) = (speed * 30.0 / std::f64::consts::PI, 1e3 * pitch_diameter);
    let power = if rpm < 1000.0 { 45000.0 * rpm.powf(-0.83) } else { 4500.0 * rpm.powf(-0.5) };
    1e-6 * power * millimetres.powf(-0.5)
}

/// [-] factor a_1 of a reliability between 0.9 and 0.99 (ISO 281:2007, table 12), linear in between.
pub fn reliability_factor(reliability: f64) -> f64 {
    const TABLE: [(f64, f64); 6] =
        [(0.9, 1.0), (0.95, 0.64), (0.96, 0.55), (0.97, 0.47), (0.98, 0.37), (0.99, 0.25)];
    let next = TABLE.partition_point(|&(r, _)| r <= reliability).clamp(1, TABLE.len() - 1);
    let [(r0, a0), (r1, a1)] = [TABLE[next - 1], TABLE[next]];
    a0 + (a1 - a0) * ((reliability - r0) / (r1 - r0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_half_loaded_bearing_has_the_life_of_its_load_rating() {
        // Sinusoidal zone of half the balls: J_r = 0.2288, and the means of its loads over the largest.
        for (angle, conformities) in [(0.0, [0.52, 0.53]), (25.0, [0.52, 0.53]), (40.0, [0.5232, 0.5232])] {
            let geometry = Geometry {
                balls: 13,
                ball_diameter: 9.525e-3,
                pitch_diameter: 46e-3,
                contact_angle: f64::to_radians(angle),
                conformities,
            };
            let rating = geometry.dynamic_load_rating();
            let n = 100_000;
            let mean = |power: f64| -> f64 {
                let zone = |j: usize| {
                    let angle = std::f64::consts::TAU * (j as f64 + 0.5) / n as f64;
                    angle.cos().max(0.0).powf(1.5)
                };
                (0..n).map(|j| zone(j).powf(power)).sum::<f64>() / n as f64
            };
            let along: f64 = (0..n)
                .map(|j| {
                    let angle = std::f64::consts::TAU * (j as f64 + 0.5) / n as f64;
                    angle.cos().max(0.0).powf(2.5)
                })
                .sum::<f64>()
                / n as f64;
            let force = 0.1 * rating;
            let largest = force / (13.0 * along * geometry.contact_angle.cos());
            let loads = [largest * mean(3.0).powf(1.0 / 3.0), largest * mean(10.0 / 3.0).powf(0.3)];
            let life = reference_life(geometry.ball_ratings(rating), loads);
            assert!((life / (rating / force).powi(3) - 1.0).abs() < 1e-3, "{angle}: {life}");
        }
    }

    #[test]
    fn limit_no_load_lives_for_ever_and_reliability_is_that_of_the_table() {
        assert_eq!(reference_life([1e3, 2e3], [0.0, 0.0]), f64::INFINITY);
        for (reliability, factor) in [(0.9, 1.0), (0.95, 0.64), (0.97, 0.47), (0.99, 0.25)] {
            assert!((reliability_factor(reliability) - factor).abs() < 1e-15, "{reliability}");
        }
        // Thicker films and cleaner oil never shorten life; at both ends the ratio is held.
        let mut last = 0.0;
        for kappa in [0.01, 0.1, 0.2, 0.39, 0.41, 0.99, 1.01, 3.0, 4.0, 10.0] {
            let factor = life_modification(kappa, 0.1);
            assert!(factor >= last * (1.0 - 1e-3), "{kappa}: {last} {factor}");
            last = factor;
        }
        assert_eq!(life_modification(0.01, 0.1), life_modification(0.1, 0.1));
        // Both formulas of the reference viscosity meet near 1000 revolutions per minute.
        let rpm = std::f64::consts::PI / 30.0;
        let [below, above] = [999.999, 1000.0].map(|n| reference_viscosity(n * rpm, 50e-3));
        assert!((below / above - 1.0).abs() < 0.03, "{below} {above}");
    }

    /// Factors f_c of thrust ball bearings of 90 degrees over `D/D_pw` (ISO 281:2007, table 4, as recalled), and f_0 of ISO 76.
    #[test]
    fn published_number_factors_of_thrust_bearings() {
        for (ratio, published) in
            [(0.01, 36.7), (0.02, 45.2), (0.06, 62.9), (0.1, 73.3), (0.2, 90.2), (0.3, 101.9)]
        {
            let geometry = Geometry {
                balls: 12,
                ball_diameter: 1e-3,
                pitch_diameter: 1e-3 / ratio,
                contact_angle: std::f64::consts::FRAC_PI_2,
                conformities: [0.54; 2],
            };
            assert!((geometry.factor() - published).abs() < 0.051, "{ratio}: {}", geometry.factor());
            let steel = 2.0 * (1.0 - 0.3 * 0.3) / 207e9;
            // Of a ball of 1 mm.
            let static_factor = geometry.static_ball_load(steel);
            assert!((static_factor - 61.6).abs() < 0.051, "{static_factor}");
        }
    }

    /// An axial load in equal shares: life is that of ISO 281, (C/F)^3, at any angle.
    #[test]
    fn closed_form_a_thrust_bearing_in_equal_shares_has_the_life_of_its_load_rating() {
        for angle in [50f64, 60.0, 75.0, 90.0] {
            let geometry = Geometry {
                balls: 13,
                ball_diameter: 7.938e-3,
                pitch_diameter: 36e-3,
                contact_angle: angle.to_radians(),
                conformities: [0.54; 2],
            };
            let (rating, force) = (28e3, 4e3);
            let load = force / (13.0 * angle.to_radians().sin());
            let life = reference_life(geometry.ball_ratings(rating), [load; 2]);
            assert!((life / (rating / force).powi(3) - 1.0).abs() < 1e-12, "{angle}: {life}");
        }
    }
}
