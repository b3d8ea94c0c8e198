//! Friction of a roller bearing: rolling resistance of its lines in oil, sliding of roller ends on ribs, drag of rollers in what is around them.
//!
//! All of it is a moment `M = -(w/s) T` on the inner ring about the axis, with the opposite one on the outer ring, at the speed `w` of the rings against each other.
//! `s = (w^2 + w_0^2)^(1/2)` keeps it smooth where the bearing stands. `T` is the power of all contacts that roll and slide as the rings have the speed `s`, over `s`:
//!
//! ```text
//! u = d_m (1 - gamma^2) s/4          speed of the surfaces at both lines
//! 2 u F                              rolling resistance of a line, F on each surface
//! v = (d_m/D) (1 - k) h s            slip at a rib of the inner ring (k in place of 1 - k: of the outer one), h beside the line of its race
//! mu P v                             friction of a rib
//! ```
//! The rolling force of a line of a length l under a load Q, with the curvature 1/R of both surfaces:
//!
//! ```text
//! F_e = 4.318 (G U)^0.658 W^0.0126 R l/alpha      elastic, Goksem and Hargreaves 1978 (recalled; the inlet of Ertel and Grubin, integrated, is within 15 %: tests)
//! F_r = 2.08 (eta u Q l)^(1/2)                    rigid: Reynolds' equation between a cylinder and a plane (Martin's load)
//! F = (F_e^-2 + F_r^-2)^(-1/2) / (1 + 0.29 L^0.78) e^(-c s)
//! G U = alpha eta u/R,  W = Q/(E' R l),  L = eta beta u^2/k
//! ```
//! with inlet heating by Aihara (1987), whose torque formula of tapered roller bearings has this elastic force, too, and SKF's starvation. Lines of light loads have
//! the rigid force: it comes in from none with the load. A rib is a ball on a plane with the film and the mixed friction that balls have ([`crate::contact::film`]).

use std::f64::consts::{LN_10, PI};

use nalgebra::{RowVector6, Vector3, Vector6};

use super::LinkForce;
pub use super::roller_oil::Lubricant;
use super::roller_oil::{MODULUS, Of, RibFilm};
use super::rollers::Geometry;
use crate::contact::film::RacewayFilm;
use crate::numerics::elementary::{ln, pow};

/// [rad/s] speed of the rings below which friction goes to none, a revolution a minute.
const LEAST_SPEED: f64 = 0.1;
/// [-] load over `E' R l` below which the rigid rolling force goes in proportion to the load: the slope of a root has no end.
const LEAST_LINE: f64 = 1e-7;
/// [-] half of the height of a rib over the roller's diameter: ribs of NU 206, NU 210 and NU 306 have a fifth of it in catalogues (recalled). An estimate.
const RIB_MIDDLE: f64 = 0.1;
/// [-] radius of the ball that touches a rib's plane over the roller's diameter. Spherical ends of tapered rollers have nine tenths of the way to the apex, ten to
/// fifteen diameters; those of cylindrical ones are of that order. An estimate.
const RIB_BALL: f64 = 10.0;

/// What rollers move through; it rests with the outer ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// [kg/m3] density.
    pub density: f64,
    /// [Pa s] dynamic viscosity.
    pub viscosity: f64,
}

/// What is known of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rubbing {
    /// Oil; dry if there is none.
    pub oil: Option<Lubricant>,
    /// [-] friction coefficient of dry ribs.
    pub rib_friction: f64,
    /// \[m] radius of the ball that touches a rib's plane; an estimate if not given.
    pub rib_radius: Option<f64>,
    /// What rollers move through.
    pub around: Option<Surroundings>,
}

/// Friction of a roller bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    given: Rubbing,
    count: f64,
    diameter: f64,
    length: f64,
    /// \[m] power of rolling over force and speed of the rings: twice the speed of the surfaces over that of the rings.
    rolling: f64,
    /// \[m] speed of the rollers' centres over that of the rings, and [-] that of their spin.
    orbit: f64,
    spin: f64,
    /// \[m] radii of curvature of roller and race together.
    radii: [f64; 2],
    /// \[m] slip at ribs of both rings over the speed of the rings; 0 where there are none.
    slips: [f64; 2],
    rib_radius: f64,
    /// Films of ribs; none without oil or ribs.
    ribs: Option<RacewayFilm>,
    /// Loads by the axial and the radial force on the inner ring: of the lines, and of a rib.
    line_loads: [[f64; 2]; 2],
    rib_load: [f64; 2],
    /// [-] load of the outer line over the centrifugal force.
    thrown: f64,
}

/// Films and moments of a bearing, as they are reported.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionOutputs {
    /// [N m] moment that holds the rings back against each other: of rolling resistance, of ribs, and of drag.
    pub parts: [f64; 3],
    /// \[W] power that is lost.
    pub loss: f64,
    /// \[m] least central film of a loaded line; 0 without oil or load.
    pub film: f64,
    /// [-] least film of a loaded line over the roughness; likewise.
    pub film_ratio: f64,
}

impl FrictionOutputs {
    /// [N m] all of the moment.
    pub fn torque(&self) -> f64 {
        self.parts.iter().sum()
    }

    /// \[W] power that one of the parts loses.
    pub fn loss_of(&self, part: usize) -> f64 {
        let torque = self.torque();
        if torque > 0.0 { self.loss * self.parts[part] / torque } else { 0.0 }
    }
}

/// [-] normals of both lines from the roller into the race, axial and radial.
fn line_normals(of: &Geometry) -> [Vector3<f64>; 2] {
    let angles = of.taper.map_or([0.0; 2], |of| {
        [of.contact_angle - of.roller_angle, of.contact_angle].map(|angle| of.direction * angle)
    });
    [-1.0, 1.0].map(|side: f64| {
        let (sine, cosine) = angles[usize::from(side > 0.0)].sin_cos();
        Vector3::new(sine, cosine, 0.0) * side
    })
}

/// [-] normal of a rib of the inner ring; of cylindrical rollers towards +x, forces of the others are negative then.
fn rib_normal(of: &Geometry) -> Vector3<f64> {
    of.taper.map_or_else(Vector3::x, |of| {
        let (sine, cosine) = (of.contact_angle - 0.5 * of.roller_angle).sin_cos();
        Vector3::new(-of.direction * cosine, sine, 0.0)
    })
}

/// \[m] distance of the middle of a rib from the line on the race: rollers turn against the race about that. A tapered roller's end is larger than its middle.
fn beside_line(of: &Geometry) -> f64 {
    let larger = of.taper.map_or(0.0, |taper| 0.5 * of.length * (0.5 * taper.roller_angle).tan());
    RIB_MIDDLE * of.diameter + larger
}

impl Friction {
    /// Of what is known, in a bearing.
    pub fn new(given: Rubbing, of: &Geometry) -> Self {
        let Geometry { count, diameter, length, pitch_diameter, .. } = *of;
        let gamma = of.gamma();
        let ratio = 0.5 * (1.0 - gamma);
        let rolling = 0.5 * pitch_diameter * (1.0 - gamma * gamma);
        let rib = rib_normal(of);
        let [inner, outer] = line_normals(of);
        let determinant = inner.x * rib.y - inner.y * rib.x;
        let by_rib = [-inner.y / determinant, inner.x / determinant];
        // The roller turns against a ring about the line on its race, by the pitch diameter over its own as fast as the cage does.
        let beside = beside_line(of) * pitch_diameter / diameter;
        let has = |race: usize| match of.taper {
            Some(_) => race == 0,
            None => of.ribs.contains(&true),
        };
        let slips =
            [(0, 1.0 - ratio), (1, ratio)].map(|(race, part)| if has(race) { part * beside } else { 0.0 });
        let rib_radius = given.rib_radius.unwrap_or(RIB_BALL * diameter);
        Self {
            given,
            count: count as f64,
            diameter,
            length,
            rolling,
            orbit: 0.5 * pitch_diameter * ratio,
            spin: rolling / diameter,
            radii: [1.0 - gamma, 1.0 + gamma].map(|of| 0.5 * diameter * of),
            slips,
            rib_radius,
            ribs: given.oil.filter(|_| slips[0] > 0.0).map(|oil| oil.of_ribs(rib_radius)),
            line_loads: [[rib.y / determinant, -rib.x / determinant], [-outer.x, -outer.y]],
            rib_load: by_rib,
            thrown: outer.y,
        }
    }

    /// Friction at a speed [rad/s] of the rings against each other.
    pub fn at(&self, speed: f64) -> Turning<'_> {
        let s = (speed * speed + LEAST_SPEED * LEAST_SPEED).sqrt();
        let (line, heat) = self.given.oil.map_or_else(Default::default, |oil| self.inlet(&oil, s));
        let drag = self.given.around.map_or_else(Of::default, |around| self.drag(&around, s));
        Turning {
            friction: self,
            speed,
            s,
            lines: line,
            heat,
            ribs: self.given.oil.zip(self.ribs.as_ref()).map(|(oil, ribs)| {
                RibFilm::new(ribs, oil.viscosity, self.rib_radius, self.surface(s), self.given.rib_friction)
            }),
            parts: [0.0, 0.0, drag.value],
            by_displacement: RowVector6::zeros(),
            by_logarithm: drag.by_speed,
            by_rate: 0.0,
        }
    }

    /// [m/s] speed of the surfaces at lines.
    fn surface(&self, s: f64) -> f64 {
        0.5 * self.rolling * s
    }

    /// Both rolling forces of both lines as [`Lubricant::rolling`] has them, with what heating and starvation leave; and the logarithmic derivative of that by the speed.
    fn inlet(&self, oil: &Lubricant, s: f64) -> ([[f64; 2]; 2], f64) {
        let u = self.surface(s);
        let [left, by_speed] = oil.left(s, u);
        (self.radii.map(|radius| oil.rolling([radius, self.length], u).map(|of| of * left)), by_speed)
    }

    /// [N m] drag of all rollers over their orbit, and moments against their spin, as one moment between the rings: a cylinder across a stream (White 1991), one
    /// that turns (Theodorsen and Regier 1944); both recalled.
    fn drag(&self, around: &Surroundings, s: f64) -> Of {
        let Surroundings { density, viscosity } = *around;
        if density <= 0.0 {
            return Of::default();
        }
        let (velocity, radius) = (self.orbit * s, 0.5 * self.diameter);
        let reynolds = density * velocity * self.diameter / viscosity;
        let slow = 10.0 * pow(reynolds, -2.0 / 3.0);
        let force = 0.5 * density * (1.0 + slow) * self.diameter * self.length * velocity * velocity;
        let power = force * velocity;
        let spin = self.spin * s;
        let turning = density * spin * radius * radius / viscosity;
        let (laminar, slope) = (4.0 / turning, 4.07 / LN_10);
        // 1/c^(1/2) = -0.6 + 4.07 lg(Re c^(1/2)), in turns.
        let root = (0..8).fold(10.0_f64, |root, _| (slope * ln(turning / root) - 0.6).max(1.0));
        let turbulent = 1.0 / (root * root);
        let (coefficient, falls) = match laminar >= turbulent {
            true => (laminar, 1.0),
            false => (turbulent, 2.0 * slope / (root + slope)),
        };
        let churned = coefficient * PI * density * radius.powi(4) * self.length * spin.powi(3);
        let over = self.count / s;
        Of {
            value: (power + churned) * over,
            by_load: 0.0,
            by_speed: over * (power * (2.0 - 2.0 / 3.0 * slow / (1.0 + slow)) + churned * (2.0 - falls)),
        }
    }
}

/// Friction of a bearing whose rings have a speed, as its rollers are added.
#[derive(Clone, Copy, Debug)]
pub struct Turning<'a> {
    friction: &'a Friction,
    /// [rad/s] speed of the rings, and the same with what keeps it from 0.
    speed: f64,
    s: f64,
    lines: [[f64; 2]; 2],
    heat: f64,
    /// Films of ribs; none without oil or ribs.
    ribs: Option<RibFilm<'a>>,
    /// [N m] moments of rolling resistance, of ribs, of drag.
    parts: [f64; 3],
    /// Derivatives of their sum: by the displacement, by the logarithm of the speed, and by the rate through the centrifugal force.
    by_displacement: RowVector6<f64>,
    by_logarithm: f64,
    by_rate: f64,
}

impl Turning<'_> {
    /// \[N] rolling force on each surface of a line of a load \[N].
    pub fn rolling_force(&self, race: usize, load: f64) -> Of {
        let [elastic, rigid] = self.lines[race];
        // Neither is of dry lines.
        if load <= 0.0 || rigid <= 0.0 {
            return Of::default();
        }
        let Friction { radii, length, .. } = self.friction;
        let size = MODULUS * radii[race] * length;
        let least = LEAST_LINE * size;
        let [elastic, rigid] = [elastic * pow(load / size, 0.0126), rigid * load / (load + least).sqrt()];
        let softer = rigid * rigid / (elastic * elastic + rigid * rigid);
        let value = elastic * softer.sqrt();
        Of {
            value,
            by_load: value * (0.0126 * softer + (1.0 - softer) * (1.0 - 0.5 * load / (load + least))) / load,
            by_speed: value * (0.658 * softer + 0.5 * (1.0 - softer) + self.heat),
        }
    }

    /// Adds a roller: force on the inner ring in its plane, and centrifugal force \[N]. Gives the derivatives of its moment by both.
    pub fn add(&mut self, force: &Vector3<f64>, centrifugal: f64) -> (Vector3<f64>, f64) {
        let of = self.friction;
        let mut by_force = Vector3::zeros();
        let mut by_centrifugal = 0.0;
        for (race, [axial, radial]) in of.line_loads.into_iter().enumerate() {
            let thrown = of.thrown * race as f64;
            let line = self.rolling_force(race, axial * force.x + radial * force.y + thrown * centrifugal);
            self.parts[0] += of.rolling * line.value;
            self.by_logarithm += of.rolling * line.by_speed;
            by_force += Vector3::new(axial, radial, 0.0) * (of.rolling * line.by_load);
            by_centrifugal += of.rolling * line.by_load * thrown;
        }
        let [axial, radial] = of.rib_load;
        let pressed = axial * force.x + radial * force.y;
        let (load, sign) = (pressed.abs(), pressed.signum());
        if load > 0.0 && of.slips[0] > 0.0 {
            let dry = Of { value: of.given.rib_friction, ..Of::default() };
            for slips in of.slips.into_iter().filter(|slips| *slips > 0.0) {
                let rib = self.ribs.map_or(dry, |film| film.friction(load, slips * self.s));
                self.parts[1] += slips * rib.value * load;
                self.by_logarithm += slips * rib.by_speed * load;
                by_force +=
                    Vector3::new(axial, radial, 0.0) * (slips * (rib.value + rib.by_load * load) * sign);
            }
        }
        (by_force, by_centrifugal)
    }

    /// Adds derivatives of the moment: by the displacement, and by the rate through the centrifugal force.
    pub fn follow(&mut self, by_displacement: &Vector6<f64>, by_rate: f64) {
        self.by_displacement += by_displacement.transpose();
        self.by_rate += by_rate;
    }

    /// Its moment, on the inner ring, with its power and its derivatives.
    pub fn put(&self, on: &mut LinkForce) {
        let whole: f64 = self.parts.iter().sum();
        let (share, s) = (self.speed / self.s, self.s);
        on.friction = -share * whole;
        on.force[3] += on.friction;
        let mut row = on.by_displacement.row_mut(3);
        row -= self.by_displacement * share;
        let steep = whole * (1.0 - share * share) / s + share * share * self.by_logarithm / s;
        on.by_rate[(3, 3)] -= steep + share * self.by_rate;
        on.damped += share * whole * self.speed;
    }

    /// What is reported of it, but for films.
    pub fn outputs(&self) -> FrictionOutputs {
        let share = (self.speed / self.s).abs();
        let parts = self.parts.map(|part| share * part);
        let loss = parts.iter().sum::<f64>() * self.speed.abs();
        FrictionOutputs { parts, loss, ..FrictionOutputs::default() }
    }

    /// \[m, -] least central film of lines with such loads \[N], and the least of all over the roughness; none without oil or load.
    pub fn least_films(&self, loads: &[[f64; 2]]) -> Option<[f64; 2]> {
        let oil = self.friction.given.oil?;
        let lines = loads.iter().flat_map(|loads| loads.iter().copied().enumerate());
        let films = lines.filter(|(_, load)| *load > 0.0).map(|(race, load)| {
            let line = [self.friction.radii[race], self.friction.length];
            let [central, least] = oil.films(line, load, self.friction.surface(self.s));
            [central, least / oil.oil.roughness]
        });
        films.reduce(|one, other| [one[0].min(other[0]), one[1].min(other[1])])
    }
}
