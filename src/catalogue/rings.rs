//! Mass and inertia of the rings from their section: a rectangle between bore (or outside) and shoulder without the groove.

use std::f64::consts::{PI, TAU};

use super::{Bearing, Candidate};

/// [kg/m3] density of bearing steel.
const DENSITY: f64 = 7800.0;
/// [-] height of the shoulders over the groove's bottom, over the ball diameter. Whole bearings of the table then have the maker's
/// masses within -17 and +13 %, without the cage (`tests/catalogue.rs`).
pub(super) const SHOULDER: f64 = 0.2;

/// A ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// \[kg] mass.
    pub mass: f64,
    /// [kg m2] moments of inertia about its axis and about a transverse one.
    pub inertia: [f64; 2],
}

/// A tube: mass and moments of inertia, of its radii and width \[m].
fn tube(inside: f64, outside: f64, width: f64) -> Ring {
    let mass = DENSITY * PI * (outside * outside - inside * inside) * width;
    let polar = 0.5 * mass * (outside * outside + inside * inside);
    Ring { mass, inertia: [polar, 0.5 * polar + mass * width * width / 12.0] }
}

/// Section that a groove takes away, a segment of a circle: area \[m2], and depth of its centroid below the shoulder \[m].
fn segment(radius: f64, depth: f64) -> [f64; 2] {
    let half = (1.0 - depth / radius).acos();
    let area = radius * radius * (half - half.sin() * half.cos());
    let from_centre = 2.0 * (radius * half.sin()).powi(3) / (3.0 * area);
    [area, from_centre - (radius - depth)]
}

impl Bearing {
    /// Inner and outer ring, or the washers of shaft and housing, which are alike.
    pub fn rings(&self, candidate: &Candidate) -> [Ring; 2] {
        let geometry = &candidate.geometry;
        let (ball, pitch) = (geometry.ball_diameter, geometry.pitch_diameter);
        if self.is_thrust() {
            let washer =
                tube(0.5 * self.bore, 0.5 * self.outside, 0.5 * (self.width - (1.0 - 2.0 * SHOULDER) * ball));
            return [0, 1].map(|race: usize| {
                let [area, _] = segment(geometry.conformities[race] * ball, SHOULDER * ball);
                let radius = 0.5 * pitch;
                let lost = DENSITY * TAU * radius * area;
                let polar = lost * radius * radius;
                Ring {
                    mass: washer.mass - lost,
                    inertia: [washer.inertia[0] - polar, washer.inertia[1] - 0.5 * polar],
                }
            });
        }
        [0, 1].map(|race: usize| {
            // The groove of the inner race is below its shoulder, that of the outer one above.
            let side = if race == 0 { 1.0 } else { -1.0 };
            let shoulder = 0.5 * (pitch - side * (1.0 - 2.0 * SHOULDER) * ball);
            let whole = if race == 0 {
                tube(0.5 * self.bore, shoulder, self.width)
            } else {
                tube(shoulder, 0.5 * self.outside, self.width)
            };
            let [area, depth] = segment(geometry.conformities[race] * ball, SHOULDER * ball);
            let radius = shoulder - side * depth;
            let lost = DENSITY * TAU * radius * area;
            let polar = lost * radius * radius;
            Ring {
                mass: whole.mass - lost,
                inertia: [whole.inertia[0] - polar, whole.inertia[1] - 0.5 * polar],
            }
        })
    }

    /// \[kg] mass of rings and balls, without a cage.
    pub fn mass(&self, candidate: &Candidate) -> f64 {
        let [inner, outer] = self.rings(candidate);
        let ball = DENSITY * PI / 6.0 * candidate.geometry.ball_diameter.powi(3);
        inner.mass + outer.mass + candidate.geometry.balls as f64 * ball
    }
}
