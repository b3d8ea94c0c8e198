//! The immutable bearing: geometry and materials in SI, from the scene.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI, TAU};

use nalgebra::Vector3;
use thiserror::Error;

use super::bodies::{PerRace, Race};
use crate::contact::film::thickness::Ellipse;
use crate::contact::film::{Lubricant, RacewayFilm};
use crate::contact::materials::Pair;
use crate::contact::raceway::Raceway;
use crate::contact::shape::ContactShape;
use crate::contact::shoulder::{Beyond, SMALL_LOAD, Shoulders, half_angle};
use crate::contact::spall::Whole;
use crate::effects::heat_balance::Passing;
use crate::effects::shoulder::{DEFAULT_HEIGHT, default_ends};
use crate::scene::Scene;

/// Sides of a race.
const SIDES: [&str; 2] = ["-x", "+x"];

/// A contact that carries load beyond a shoulder of its race.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "ball {ball} presses on the {race} race with {load:.3e} N at a contact angle of {angle:.3} rad towards {side}, beyond the \
     shoulder that ends the groove at {end:.3} rad: {why}"
)]
pub struct BeyondShoulder {
    /// Ball, counted from 1.
    pub ball: usize,
    /// Inner or outer.
    pub race: &'static str,
    /// \[N] load.
    pub load: f64,
    /// Side of the race.
    pub side: &'static str,
    /// \[rad] contact angle.
    pub angle: f64,
    /// \[rad] where the groove ends.
    pub end: f64,
    /// Reason, said of the bearing.
    pub why: &'static str,
}

/// [-] approach over ball diameter of a typical load: 300 N on a ball of 10 mm.
const TYPICAL_APPROACH: f64 = 5e-4;

/// A ball: homogeneous sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// \[m] radius.
    pub radius: f64,
    /// \[kg] mass.
    pub mass: f64,
    /// [kg m2] moment of inertia about any axis through the centre.
    pub inertia: f64,
}

/// A ball bearing: everything that does not change while it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Bearing {
    /// [-] number of balls.
    pub n_balls: usize,
    /// The ball.
    pub ball: Ball,
    /// \[m] pitch diameter dm.
    pub pitch_diameter: f64,
    /// \[rad] azimuth of ball 1, from +y towards +z.
    pub first_ball_azimuth: f64,
    /// \[rad] free contact angle; 0 for a bearing given by its clearance.
    pub free_contact_angle: f64,
    /// Inner raceway.
    pub inner: Raceway,
    /// Outer raceway.
    pub outer: Raceway,
    /// Ends of both grooves.
    pub shoulders: PerRace<Shoulders>,
    /// Materials of ball and race together.
    pub materials: Pair,
}

impl Bearing {
    /// Builds the bearing of a scene.
    pub fn new(scene: &Scene) -> Self {
        let section = &scene.bearing;
        let (diameter, pitch) = (section.ball_diameter.0, section.pitch_diameter.0);
        let [inner, outer] = section.raceways();
        let radius = diameter / 2.0;
        let mass = scene.ball.density.0 * 4.0 / 3.0 * PI * radius.powi(3);
        let materials = [&scene.ball, &scene.race].map(|m| (m.youngs_modulus.0, m.poisson_ratio));
        Self {
            n_balls: section.balls,
            ball: Ball { radius, mass, inertia: 0.4 * mass * radius * radius },
            pitch_diameter: pitch,
            first_ball_azimuth: section.first_ball_azimuth.0,
            free_contact_angle: section.contact_angle.map_or(0.0, |angle| angle.0),
            inner,
            outer,
            shoulders: PerRace::new(|race| shoulders(scene, race)),
            materials: Pair::new(materials),
        }
    }

    /// [-] share of a load beyond the shoulders of a race, and \[rad] distance of its ellipse from the nearer end of the groove, negative
    /// where it is cut: contact angle \[rad] towards +x, transverse semi-axis \[m].
    pub fn shoulder(&self, race: Race, towards_x: f64, semi_axis: f64) -> (f64, f64) {
        let half_angle = half_angle(semi_axis, self.ball.radius);
        let shoulders = &self.shoulders[race];
        (shoulders.share_beyond(towards_x, half_angle), shoulders.margin(towards_x, half_angle))
    }

    /// Refuses contacts with a race that carry load beyond its shoulders, by ball: loads \[N] and contact angles \[rad] towards
    /// +x.
    ///
    /// # Errors
    /// Names the first.
    pub fn check_shoulders(
        &self,
        race: Race,
        loads: impl Iterator<Item = f64> + Clone,
        towards_x: impl Fn(usize) -> f64,
    ) -> Result<(), BeyondShoulder> {
        let largest = loads.clone().fold(0.0, f64::max);
        for (index, load) in loads.enumerate().filter(|(_, load)| *load > SMALL_LOAD * largest) {
            let Some(beyond) = self.shoulders[race].beyond(towards_x(index)) else {
                continue;
            };
            let why = if self.free_contact_angle > 0.0 && beyond.side != loaded_side(race) {
                "a single-row angular-contact bearing carries thrust of its inner race along +x alone and falls apart under \
                 one along -x: its rings leave each other freely, up to this edge, and nothing holds them beyond; turn it round, pair it with \
                 a second one, or give both races a groove that reaches there (shoulder_height or shoulder_angle in [inner] and [outer])"
            } else {
                "the load, the displacement or the tilt is too large for this shoulder"
            };
            let Beyond { side, angle, end } = beyond;
            let (ball, race, side) = (index + 1, race.name(), SIDES[side]);
            return Err(BeyondShoulder { ball, race, load, side, angle, end, why });
        }
        Ok(())
    }

    /// Raceway of a race.
    pub fn raceway(&self, race: Race) -> &Raceway {
        match race {
            Race::Inner => &self.inner,
            Race::Outer => &self.outer,
        }
    }

    /// [1/m] curvature of a race along its circumference at the free contact angle; convex (inner race) positive.
    pub fn circumferential_curvature(&self, race: Race) -> f64 {
        let (orbit, cos) = (0.5 * self.pitch_diameter, self.free_contact_angle.cos());
        match race {
            Race::Inner => cos / (orbit - self.ball.radius * cos),
            Race::Outer => -cos / (orbit + self.ball.radius * cos),
        }
    }

    /// Contacts with a race at the free contact angle, of the shape that they have there.
    pub fn whole_contact(&self, race: Race, shape: &ContactShape) -> Whole {
        let (raceway, curvature) = (self.raceway(race), self.circumferential_curvature(race));
        let at = shape.at(curvature);
        let ball = 1.0 / self.ball.radius;
        Whole {
            curvatures: [ball + curvature, ball - 1.0 / raceway.groove_radius],
            semi_axes: [at.semi_axis_rolling, at.semi_axis_transverse],
            typical_approach: 2.0 * self.ball.radius * TYPICAL_APPROACH,
            groove_radius: raceway.groove_radius,
            circle_radius: raceway.groove_circle_radius,
            side: if race == Race::Inner { -1.0 } else { 1.0 },
        }
    }

    /// Films on a race, of contacts of the shape that they have at the free contact angle.
    pub fn raceway_film(&self, race: Race, shape: &ContactShape, lubricant: Lubricant) -> RacewayFilm {
        let curvature = self.circumferential_curvature(race);
        let at = shape.at(curvature);
        let modulus = 2.0 / self.materials.compliance;
        // Semi-axes and load of an approach of 1 m: their ratios are those of any.
        let semi_axes = [at.semi_axis_rolling, at.semi_axis_transverse];
        let ellipse = Ellipse::new(semi_axes, at.stiffness, modulus, 1.0 / self.ball.radius + curvature);
        RacewayFilm::new(lubricant, modulus, ellipse)
    }

    /// Passing contacts of a race, which conduct heat, of contacts of the shape that they have at the free contact angle.
    pub fn passing(&self, race: Race, shape: &ContactShape) -> Passing {
        let at = shape.at(self.circumferential_curvature(race));
        // Of a load of 1 N.
        let root = at.stiffness.powf(-1.0 / 3.0);
        Passing { semi_axes: [at.semi_axis_rolling * root, at.semi_axis_transverse * root] }
    }

    /// \[rad] smallest and largest contact angle for which there is a groove: up to a right angle on either side; on the
    /// washers of a thrust bearing 30 degrees to either side of the free contact angle.
    pub fn contact_angles(&self) -> [f64; 2] {
        match self.is_thrust_bearing() {
            true => [-1.0, 1.0].map(|side| self.free_contact_angle + side * FRAC_PI_6),
            false => [-FRAC_PI_2, FRAC_PI_2],
        }
    }

    /// Do the grooves face along the axis?
    pub fn is_thrust_bearing(&self) -> bool {
        self.inner.faces_along_axis(self.ball.radius)
    }

    /// \[rad] azimuth of a ball (0 for the first) of the bearing at rest.
    pub fn ball_azimuth(&self, index: usize) -> f64 {
        self.first_ball_azimuth + TAU * index as f64 / self.n_balls as f64
    }

    /// [-] ratio of cage speed to inner race speed at a contact angle \[rad], outer race at rest, pure rolling:
    /// `(1 - gamma)/2`, `gamma = D cos(alpha)/dm`.
    pub fn epicyclic_ratio(&self, contact_angle: f64) -> f64 {
        0.5 * (1.0 - 2.0 * self.ball.radius * contact_angle.cos() / self.pitch_diameter)
    }

    /// [rad/s] cage speed of pure rolling at one contact angle, both races turning.
    pub fn epicyclic_speed(&self, contact_angle: f64, inner_speed: f64, outer_speed: f64) -> f64 {
        let ratio = self.epicyclic_ratio(contact_angle);
        ratio * inner_speed + (1.0 - ratio) * outer_speed
    }
}

/// Side of a race that thrust of the inner race along +x loads: 0 is -x, 1 is +x.
fn loaded_side(race: Race) -> usize {
    match race {
        Race::Inner => 0,
        Race::Outer => 1,
    }
}

/// Ends of the groove of a race: those of the scene, or defaults.
fn shoulders(scene: &Scene, race: Race) -> Shoulders {
    let bearing = &scene.bearing;
    let (section, conformity) = match race {
        Race::Inner => (&scene.inner, bearing.inner_conformity),
        Race::Outer => (&scene.outer, bearing.outer_conformity),
    };
    let end = |height: f64| Shoulders::end(height, conformity * bearing.ball_diameter.0);
    if let Some(angles) = section.shoulder_angle {
        return Shoulders { ends: angles.map(|angle| angle.0) };
    }
    if let Some(heights) = section.shoulder_height {
        return Shoulders { ends: heights.map(|height| end(height.0)) };
    }
    let [loaded, other] = default_ends(
        bearing.contact_angle.map_or(0.0, |angle| angle.0),
        end(DEFAULT_HEIGHT * bearing.ball_diameter.0),
    );
    let mut ends = [loaded; 2];
    ends[1 - loaded_side(race)] = other;
    Shoulders { ends }
}

/// Neighbours among balls that stand around a bearing, each pair once: (0, 1), (1, 2) and so on to the last and the first.
pub fn neighbours(n_balls: usize) -> impl Iterator<Item = (usize, usize)> {
    let pairs = if n_balls > 2 { n_balls } else { n_balls.saturating_sub(1) };
    (0..pairs).map(move |first| (first, (first + 1) % n_balls))
}

/// Unit vectors at an azimuth \[rad]: radial and tangential (direction of growing azimuth).
pub fn azimuth_directions(azimuth: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (sin, cos) = azimuth.sin_cos();
    (Vector3::new(0.0, cos, sin), Vector3::new(0.0, -sin, cos))
}
