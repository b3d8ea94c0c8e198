//! Self-aligning ball bearings by their designations: two rows whose outer race is one sphere about the middle of the bearing.
//!
//! A row's contact lines go through the middle of the sphere, so that a ball of a circle `d_m` at a contact angle `a` is half of `d_m tan a` beside it. Number
//! and diameter of the balls follow from both load ratings, with `g = D cos a / d_m` and the radius of the sphere `r_e = d_m/(2 cos a) + D/2`:
//!
//! ```text
//! C  = 1.3 f_c (2 cos a)^0.7 Z^(2/3) D^1.8
//! f_c = 39.9 (2 r_i/(2 r_i - D))^0.41 g^0.3 (1 - g)^1.39 (1 + g)^(-1/3) (1 + (1.04 ((1 - g)/(1 + g))^1.72 (r_i (2 r_e - D)/(r_e (2 r_i - D)))^0.41)^(10/3))^(-3/10)
//! C0 = 2 Z Q cos a / 5      Q = (pi^3/6) p^3 R^2/E^2, p = 4600 MPa, of a ball in the sphere, 1/R = 2/D - 1/r_e
//! ```
//! (ISO 281 and its report ISO/TR 1281-1 with lambda = 1, ISO 76; millimetres and newtons.) The table is SKF's as remembered; it was not at hand. `e` of its
//! factors is `1.5 tan a` (ISO 281). That rows and balls then fill the width is a check of both (`tests/catalogue.rs`).

use std::f64::consts::PI;

use super::CatalogueError;
use super::designation::self_aligning;
use super::digits::short;
use super::double_row::DoubleRow;

/// Rows of the table, below a line of names.
const ROWS: &str = include_str!("self_aligning.csv");
/// [-] radius of the inner grooves over the ball diameter, at most (ISO 281).
const CONFORMITY: f64 = 0.53;
/// [MPa] pressure that leaves a mark of a ten-thousandth of the ball (ISO 76, self-aligning ball bearings).
const MARKING: f64 = 4600.0;
/// [MPa] contact modulus of bearing steel.
const MODULUS: f64 = 0.5 * 206e3 / (1.0 - 0.3 * 0.3);
/// [-] height of the shoulders of an inner groove over the ball diameter.
const SHOULDER: f64 = 0.2;
/// [-] part of the width of the outer ring that its race is as wide as.
const RACE: f64 = 0.95;
/// Rounds in which balls follow from both ratings: the ratings know their diameter but for `g`.
const ROUNDS: usize = 60;

/// What the table says of a bearing: millimetres, newtons.
struct Size {
    bore: f64,
    outside: f64,
    width: f64,
    dynamic: f64,
    static_: f64,
    /// [-] tangent of the contact angle.
    tangent: f64,
}

/// Balls of a row.
struct Balls {
    count: f64,
    /// \[mm] diameter.
    diameter: f64,
}

/// The rows of a designation; none where it is no self-aligning ball bearing.
///
/// # Errors
/// If its size is not known.
pub fn rows_of(designation: &str) -> Option<Result<DoubleRow, CatalogueError>> {
    let number = self_aligning(designation)?;
    let unknown = || CatalogueError::Kind {
        name: designation.into(),
        kind: "a self-aligning ball bearing of a size that the table lacks",
    };
    Some(size(&number).map(|size| size.rows(&number)).ok_or_else(unknown))
}

fn size(number: &str) -> Option<Size> {
    let line = ROWS.lines().skip(1).find(|line| line.split(',').next() == Some(number))?;
    let numbers: Option<Vec<f64>> = line.split(',').skip(1).map(|cell| cell.parse().ok()).collect();
    let [bore, outside, width, dynamic, static_, e] = numbers?[..] else { return None };
    let (dynamic, static_) = (1e3 * dynamic, 1e3 * static_);
    Some(Size { bore, outside, width, dynamic, static_, tangent: e / 1.5 })
}

impl Size {
    fn pitch(&self) -> f64 {
        0.5 * (self.bore + self.outside)
    }

    fn cosine(&self) -> f64 {
        1.0 / self.tangent.hypot(1.0)
    }

    /// [-] radius of the sphere over a ball diameter \[mm].
    fn sphere(&self, diameter: f64) -> f64 {
        0.5 + 0.5 * self.pitch() / (diameter * self.cosine())
    }

    /// C over `Z^(2/3) D^1.8` with balls of about a diameter \[mm].
    fn dynamic_by_balls(&self, diameter: f64) -> f64 {
        let (cosine, outer, inner) = (self.cosine(), self.sphere(diameter), CONFORMITY);
        let g = diameter * cosine / self.pitch();
        let conforming = |radius: f64| 2.0 * radius / (2.0 * radius - 1.0);
        let at_inner = 39.9 * conforming(inner).powf(0.41) * g.powf(0.3) * (1.0 - g).powf(1.39)
            / (1.0 + g).powf(1.0 / 3.0);
        let between = (conforming(inner) / conforming(outer)).powf(0.41);
        let outer_share = 1.04 * ((1.0 - g) / (1.0 + g)).powf(1.72) * between;
        1.3 * (2.0 * cosine).powf(0.7) * at_inner * (1.0 + outer_share.powf(10.0 / 3.0)).powf(-0.3)
    }

    /// C0 over `Z D^2`, in the same way.
    fn static_by_balls(&self, diameter: f64) -> f64 {
        let radius = 1.0 / (2.0 - 1.0 / self.sphere(diameter));
        0.4 * self.cosine() * PI.powi(3) / 6.0 * MARKING.powi(3) * (radius / MODULUS).powi(2)
    }

    /// The balls that have both load ratings: the whole number next to theirs, and the diameter that has C with it.
    fn balls(&self) -> Balls {
        let mut diameter = 0.25 * (self.outside - self.bore);
        let mut count = 1.0;
        for _ in 0..ROUNDS {
            let dynamic = self.dynamic / self.dynamic_by_balls(diameter);
            let static_ = self.static_ / self.static_by_balls(diameter);
            // Z^(2/3) D^1.8 and Z D^2 are known.
            diameter = (dynamic / static_.powf(2.0 / 3.0)).powf(1.0 / (1.8 - 4.0 / 3.0));
            count = static_ / (diameter * diameter);
        }
        let count = count.round();
        for _ in 0..ROUNDS {
            let dynamic = self.dynamic / self.dynamic_by_balls(diameter);
            diameter = (dynamic / count.powf(2.0 / 3.0)).powf(1.0 / 1.8);
        }
        // As the scene has it, so that the sphere is one.
        Balls { count, diameter: (1e4 * diameter).round() * 1e-4 }
    }

    fn rows(&self, number: &str) -> DoubleRow {
        let Balls { count, diameter } = self.balls();
        let (pitch, sphere) = (self.pitch(), self.sphere(diameter));
        let angle = self.tangent.atan();
        let edge = (0.5 * RACE * self.width / (sphere * diameter)).asin();
        let dimensions = [self.bore, self.outside, self.width].map(|of| short(of, 6)).join(" x ");
        let of_row = 2f64.powf(-0.7) * self.dynamic;
        let scene = format!(
            "# Load ratings and e as remembered of SKF's catalogue; both rows together have them.
title = \"{number}, a row of a self-aligning ball bearing, {dimensions} mm, internal geometry estimated\"

[bearing]
# Balls: estimated from C by ISO 281 and C0 by ISO 76 (4600 MPa); spread 5 % of the diameter.
balls = {count}
ball_diameter = \"{ball} mm\"
# Pitch diameter: estimated as midway between bore and outside diameter; spread 2 %.
pitch_diameter = \"{pitch} mm\"
# Contact angle: by e = 1.5 tan a of ISO 281, to 1 deg as e is rounded.
contact_angle = {angle}
inner_conformity = {CONFORMITY}
# The outer race is a sphere about the middle of the bearing.
outer_conformity = {sphere}

[rating]
dynamic_load_rating = {of_row}
static_load_rating = {half}

[effects]
damping = \"0.02 s/m\"           # estimated: bouncing of balls ends within about 1 ms; spread a factor of 3

[inner]
drive = \"pose\"
shoulder_height = [\"{shoulder} mm\", \"{shoulder} mm\"]

# Where the outer ring ends, as seen from the middle of the sphere.
[outer]
shoulder_angle = [{edge}, {edge}]

[load]
duration = \"20 ms\"
output_interval = \"100 us\"
inner_speed = \"1500 rpm\"
",
            ball = short(diameter, 6),
            half = 0.5 * self.static_,
            shoulder = short(SHOULDER * diameter, 4),
        );
        DoubleRow {
            scene,
            distance: 1e-3 * pitch * self.tangent,
            axial_play: 0.0,
            dynamic_load_rating: self.dynamic,
            back_to_back: false,
        }
    }
}
