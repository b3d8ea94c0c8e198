//! Number and diameter of the balls from the load ratings.
//!
//! C grows with `Z^(2/3) D^1.8` (ISO 281), C0 with `Z D^2` (ISO 76): together they tell Z from D. Both are computed for all numbers and
//! sizes of balls that fit, and compared.

use std::f64::consts::{PI, TAU};

use super::{Bearing, CatalogueError};
use crate::effects::rating::standard::Geometry;

/// [1/Pa] elastic compliance of steel on steel that gives the factors f_0 of ISO 76's table: 207 GPa, 0.3.
pub const STEEL_OF_ISO_76: f64 = 2.0 * (1.0 - 0.3 * 0.3) / 207e9;
/// [-] conformities of inner and outer race that the standards' tables are of.
pub(super) const USUAL: [f64; 2] = [0.52, 0.53];
/// [-] outer conformity of makers whose C0 is that of the inner race alone. It matters where the ball is small against the pitch
/// circle: there ISO 76 has the outer race with 0.53 as the weaker one.
const CLOSE: f64 = 0.52;
/// [-] conformity of thrust bearings that the tables of the standards hold to, which ISO 76 is of.
const OF_THRUST: f64 = 0.54;
/// [-] ball diameters over the height of the section, of a thrust bearing over its own; those of the table are 0.43 to 0.67.
const SIZES: [f64; 2] = [0.35, 0.75];
/// \[rad] most that balls fill, from the centre of the first to that of the last, where they are put in between eccentric rings; those
/// of the table fill 153 to 205 degrees.
const FILL: f64 = 205.0 / 360.0 * TAU;
/// [-] most of the pitch circle that balls fill where one shoulder is low; those of the table fill up to 0.93, the rest is the cage's.
const FILL_OF_ANGULAR_CONTACT: f64 = 0.95;
/// [-] largest error in both ratings that a best candidate may have. Ratings by makers' own factors are beyond those of ISO 281 by up to
/// a fifth.
const WORST: f64 = 0.25;
/// Most candidates that are given.
const MOST: usize = 12;

/// Balls that may be those of a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Quantities that the ratings depend on.
    pub geometry: Geometry,
    /// \[N] C of these balls by ISO 281.
    pub dynamic_load_rating: f64,
    /// \[N] C0 of these balls by ISO 76.
    pub static_load_rating: f64,
    /// [-] errors of C and C0 against those of the catalogue.
    pub errors: [f64; 2],
}

impl Candidate {
    /// [-] both errors as one.
    pub fn error(&self) -> f64 {
        self.errors[0].hypot(self.errors[1])
    }
}

/// \[m] diameters of balls (among those of ISO 3290-1): 1/32 inch up to two inches, 1/64 inch below one, 1/16 inch up to three, half
/// millimetres up to 20 mm.
fn ball_diameters() -> impl Iterator<Item = f64> {
    const INCH: f64 = 25.4;
    let coarse = (2..=64).map(|n| f64::from(n) * INCH / 32.0);
    let large = (33..=48).map(|n| f64::from(n) * INCH / 16.0);
    let fine = (3..64).step_by(2).map(|n| f64::from(n) * INCH / 64.0);
    let metric = (2..=40).map(|n| f64::from(n) * 0.5);
    // The f64 nearest to the decimal number, as scenes have it: the millionth part of a millimetre is the last digit of 1/64 inch.
    coarse.chain(fine).chain(large).chain(metric).map(|millimetres| (millimetres * 1e6).round() / 1e9)
}

/// \[N] C0 of a bearing (ISO 76): that of the weaker race.
fn static_load_rating(geometry: &Geometry, loads: [f64; 2]) -> f64 {
    geometry.static_load_rating(loads[0].min(loads[1]))
}

impl Bearing {
    /// [-] conformities that are taken where none are known.
    pub(super) fn usual_conformities(&self) -> [f64; 2] {
        if self.is_thrust() { [OF_THRUST; 2] } else { USUAL }
    }

    /// Balls with their ratings, and how far these are from its own; loads of a ball \[N] on both races that leave a mark.
    pub(super) fn rated(&self, geometry: Geometry, loads: [f64; 2]) -> Candidate {
        let dynamic = geometry.dynamic_load_rating();
        let static_ = static_load_rating(&geometry, loads);
        Candidate {
            geometry,
            dynamic_load_rating: dynamic,
            static_load_rating: static_,
            errors: [dynamic / self.dynamic_load_rating - 1.0, static_ / self.static_load_rating - 1.0],
        }
    }

    /// Balls that come near its ratings, the nearest first; those that its maker tells, alone.
    ///
    /// # Errors
    /// If none comes near.
    pub fn candidates(&self) -> Result<Vec<Candidate>, CatalogueError> {
        let pitch = self.pitch_diameter();
        let height = if self.is_thrust() { self.width } else { self.section_height() };
        if let Some(inside) = self.inside {
            return Ok(vec![inside]);
        }
        let [inner, usual] = self.usual_conformities();
        let outers = if self.is_thrust() { &[usual][..] } else { &[usual, CLOSE][..] };
        let mut found = vec![];
        for ball_diameter in ball_diameters() {
            if !(SIZES[0] * height..=SIZES[1] * height).contains(&ball_diameter) {
                continue;
            }
            let step = 2.0 * (ball_diameter / pitch).asin();
            let most = if self.is_deep_groove() {
                FILL / step + 1.0
            } else {
                FILL_OF_ANGULAR_CONTACT * 2.0 * PI / step
            };
            for &outer in outers {
                let of = |balls| Geometry {
                    balls,
                    ball_diameter,
                    pitch_diameter: pitch,
                    contact_angle: self.contact_angle,
                    conformities: [inner, outer],
                };
                let loads = of(1).static_ball_loads(STEEL_OF_ISO_76);
                for balls in 3..=most as usize {
                    found.push(self.rated(of(balls), loads));
                }
                if loads[1] >= loads[0] {
                    // The inner race is the weaker one anyway.
                    break;
                }
            }
        }
        found.sort_by(|a, b| a.error().total_cmp(&b.error()));
        found.truncate(MOST);
        match found.first() {
            Some(best) if best.error() <= WORST => Ok(found),
            best => Err(CatalogueError::NoBalls {
                dimensions: self.dimensions(),
                dynamic: self.dynamic_load_rating,
                static_: self.static_load_rating,
                percent: 100.0 * WORST,
                nearest: best.map_or_else(|| "none".into(), ToString::to_string),
            }),
        }
    }
}
