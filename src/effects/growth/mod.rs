//! Growth of rings and balls by temperature, by their fits on shaft and in housing, and by rotation.
//!
//! Each part has one temperature and expands freely: a ring takes the radius of its groove circle, the radius and the place of
//! its groove along, a ball its diameter. A fit and rotation widen the groove circle by the displacement of the raceway's bottom
//! ([`rings`]). Nothing is moved back to touch: the change of preload is the effect. Contacts get their stiffness of warm dimensions
//! (`stiffening.rs`). Mass and inertia, ellipses and creep coefficients, pockets, and gaps between balls stay those of the cold
//! bearing: they change by a thousandth in 100 K.

mod fits;
pub mod rings;
mod section;
mod stiffening;

use serde::{Deserialize, Serialize};

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::estimate::{Estimate, Outline, digits};
use super::reports::{GrowthOutput, Rises};
use super::twin::Twin;
use crate::contact::raceway::Raceway;
use crate::schema::numbers::Number;
use crate::schema::schedule::Schedule;
use crate::schema::variable_units::{METRE, PASCAL, RADIAN, Unit};
use crate::schema::{BearingSection, Material, SceneError};
pub use fits::{RingClass, Within};
use rings::{Cylinder, Fit, Seated};
pub use section::{EXPANSION, Partner, RISE, Section, Settings};
use stiffening::Stiffening;

/// Quantities that growth follows from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Warmth {
    /// \[K] rises of temperature.
    pub rises: Rises,
    /// [rad/s] spin of the inner and the outer race.
    pub spins: [f64; 2],
}

/// State of growth: where it has come to, and what it works against.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Grown {
    /// Growth of rings and balls.
    pub warmth: Warmth,
    /// Forces of the contacts of the inner and the outer race against growth.
    pub pushes: [Push; 2],
}

/// Derivatives \[N] of the elastic energy of all contacts of a race by its dimensions and the balls'.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Push {
    /// By the ball's radius, and by the groove's with the opposite sign.
    pub closing: f64,
    /// By the radius of the circle of groove centres.
    pub circle: f64,
    /// By the place of the groove along the axis.
    pub along: f64,
}

impl Push {
    /// Adds a contact of a load \[N]: radial and axial component of its normal, out of the ball.
    pub fn add(&mut self, load: f64, [radial, axial]: [f64; 2]) {
        self.closing += load;
        self.circle -= load * radial;
        self.along -= load * axial;
    }
}

impl Settings {
    /// Rises over time of all parts; none where growth is not simulated.
    pub fn schedules(&self) -> Option<[&Schedule; 5]> {
        const COLD: &Schedule = &Schedule::Constant(0.0);
        let Section { inner, outer, balls, shaft, housing, .. } = self.section.as_ref()?;
        Some([
            inner,
            outer,
            balls,
            shaft.as_ref().map_or(COLD, |partner| &partner.rise),
            housing.as_ref().map_or(COLD, |partner| &partner.rise),
        ])
    }

    /// Does a table give one of them?
    pub fn follows_time(&self) -> bool {
        self.schedules().into_iter().flatten().any(Schedule::is_scripted)
    }

    /// \[K] rises at a time \[s].
    pub fn rises(&self, time: f64) -> Option<Rises> {
        Some(self.schedules()?.map(|schedule| schedule.at(time)))
    }

    /// The hot type, of bearing, balls and races of a scene.
    pub fn growth(&self, bearing: &BearingSection, ball: &Material, race: &Material) -> Option<Growth> {
        let section = self.section.as_ref()?;
        let raceways = bearing.raceways();
        let bottoms = [
            raceways[0].groove_circle_radius - raceways[0].groove_radius,
            raceways[1].groove_circle_radius + raceways[1].groove_radius,
        ];
        // Curvatures along the circumference at the free contact angle, of a bearing without clearance.
        let cosine = bearing.contact_angle.map_or(1.0, |angle| angle.0.cos());
        let (radius, orbit) = (0.5 * bearing.ball_diameter.0, 0.5 * bearing.pitch_diameter.0);
        let curvatures = [cosine / (orbit - radius * cosine), -cosine / (orbit + radius * cosine)];
        let ring = |index: usize, partner: &Option<Partner>| Ring {
            cold: raceways[index],
            stiffening: Stiffening::new(radius, &raceways[index], curvatures[index]),
            bottom: bottoms[index],
            expansion: race.thermal_expansion.0,
            seat: partner.as_ref().map(|partner| Seat::new((index, partner, section), race, bottoms[index])),
        };
        Some(Growth {
            ball_radius: radius,
            ball_expansion: ball.thermal_expansion.0,
            rotation: section.rotation,
            rings: [ring(0, &section.shaft), ring(1, &section.housing)],
        })
    }
}

/// A ring on its seat.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seat {
    /// The ring itself.
    ring: Cylinder,
    /// The fit, where it is held, with its interference \[m] as given.
    fit: Option<(Fit, f64)>,
    /// \[m] diameter of the seat.
    diameter: f64,
    /// [1/K] coefficient of thermal expansion of shaft or housing.
    expansion: f64,
}

impl Seat {
    /// Seat of the inner (0) or outer (1) ring, whose raceway has its bottom at a radius \[m].
    fn new((index, partner, section): (usize, &Partner, &Section), race: &Material, bottom: f64) -> Self {
        let seat = 0.5 * partner.diameter.0;
        let ring = Cylinder {
            inside: seat.min(bottom),
            outside: seat.max(bottom),
            youngs_modulus: race.youngs_modulus.0,
            poisson_ratio: race.poisson_ratio,
            density: race.density.0,
        };
        let radius =
            |length: Option<crate::schema::units::Length>| length.map_or(0.0, |length| 0.5 * length.0);
        let [inside, outside] =
            if index == 0 { [radius(partner.bore), seat] } else { [seat, radius(partner.outside)] };
        let other = Cylinder {
            inside,
            outside,
            youngs_modulus: partner.youngs_modulus.0,
            poisson_ratio: partner.poisson_ratio,
            density: partner.density.0,
        };
        let fit =
            if index == 0 { Fit { inner: other, outer: ring } } else { Fit { inner: ring, outer: other } };
        Self {
            ring,
            fit: partner.left(section).map(|interference| (fit, interference)),
            diameter: partner.diameter.0,
            expansion: partner.thermal_expansion.0,
        }
    }
}

/// One ring.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ring {
    cold: Raceway,
    stiffening: Stiffening,
    /// \[m] radius of the bottom of its raceway.
    bottom: f64,
    /// [1/K] coefficient of thermal expansion.
    expansion: f64,
    /// Shaft or housing that it sits on; none where nothing is known of it.
    seat: Option<Seat>,
}

impl Ring {
    /// \[m] displacement of the bottom of the raceway by fit and rotation, and the fit; `rise` and `partner` \[K] of the ring
    /// and of what it sits on, square of the speed [rad2/s2].
    fn displaced(&self, index: usize, rise: f64, partner: f64, square_speed: f64) -> (f64, Seated) {
        let Some(seat) = &self.seat else {
            return (0.0, Seated::default());
        };
        let free = seat.ring.spun(self.bottom) * square_speed;
        let Some((fit, interference)) = &seat.fit else {
            return (free, Seated::default());
        };
        // The part inside the seat widens the interference, the part around it takes it away.
        let hotter = seat.expansion * partner - self.expansion * rise;
        let hotter = if index == 0 { hotter } else { -hotter };
        let seated = fit.seated(interference + seat.diameter * hotter, square_speed);
        let pressures = if index == 0 { [seated.pressure, 0.0] } else { [0.0, seated.pressure] };
        (free + seat.ring.pressed(self.bottom, pressures), seated)
    }
}

/// Dimensions of the warm bearing from those of the cold one: what a step reads, once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    ball_radius: f64,
    ball_expansion: f64,
    rotation: bool,
    rings: [Ring; 2],
}

impl Growth {
    /// The inner (0) or outer (1) ring: \[m] growth of its raceway by fit and rotation, and its fit.
    fn ring(&self, index: usize, warmth: &Warmth) -> (f64, Seated) {
        let speed = if self.rotation { warmth.spins[index] } else { 0.0 };
        let [rise, partner] = [warmth.rises[index], warmth.rises[3 + index]];
        self.rings[index].displaced(index, rise, partner, speed * speed)
    }

    /// Raceway of the inner (0) or outer (1) ring.
    pub fn raceway(&self, index: usize, warmth: &Warmth) -> Raceway {
        let ring = &self.rings[index];
        let scale = 1.0 + ring.expansion * warmth.rises[index];
        Raceway {
            groove_radius: ring.cold.groove_radius * scale,
            groove_circle_radius: ring.cold.groove_circle_radius * scale + self.ring(index, warmth).0,
            groove_offset: ring.cold.groove_offset * scale,
        }
    }

    /// \[m] radius of a ball.
    pub fn ball_radius(&self, warmth: &Warmth) -> f64 {
        self.ball_radius * (1.0 + self.ball_expansion * warmth.rises[2])
    }

    /// [-] Hertz stiffness of a ball and the inner (0) or outer (1) raceway over that of cold dimensions.
    pub fn stiffening(&self, index: usize, warmth: &Warmth) -> f64 {
        let groove =
            self.rings[index].cold.groove_radius * (1.0 + self.rings[index].expansion * warmth.rises[index]);
        self.rings[index].stiffening.at(self.ball_radius(warmth), groove)
    }

    /// \[J] work that growth puts into the contacts from one state to another: it presses them together, or lets go of them. What it
    /// does to their stiffness is counted with all changes of stiffness.
    pub fn work(&self, from: &Grown, to: &Grown) -> f64 {
        if from.warmth == to.warmth {
            return 0.0;
        }
        let ball = self.ball_radius(&to.warmth) - self.ball_radius(&from.warmth);
        let of_race = |race: usize| {
            let [old, new] = [from, to].map(|grown| self.raceway(race, &grown.warmth));
            let [before, now] = [from.pushes[race], to.pushes[race]];
            let closing = ball - (new.groove_radius - old.groove_radius);
            (before.closing + now.closing) * closing
                + (before.circle + now.circle) * (new.groove_circle_radius - old.groove_circle_radius)
                + (before.along + now.along) * (new.groove_offset - old.groove_offset)
        };
        0.5 * (of_race(0) + of_race(1))
    }

    /// Report of the growth.
    pub fn output(&self, warmth: &Warmth) -> GrowthOutput {
        let [inner, outer] = [0, 1].map(|index| self.raceway(index, warmth));
        let diameter = 2.0 * self.ball_radius(warmth);
        let clearance = 2.0
            * (outer.groove_circle_radius + outer.groove_radius - inner.groove_circle_radius
                + inner.groove_radius
                - diameter);
        let centre_distance = inner.groove_radius + outer.groove_radius - diameter;
        let [inner, outer] = [0, 1].map(|index| self.ring(index, warmth).1);
        GrowthOutput {
            clearance,
            contact_angle: (1.0 - 0.5 * clearance / centre_distance).clamp(0.0, 1.0).acos(),
            interference: [inner.interference, outer.interference],
            seat_pressure: [inner.pressure, outer.pressure],
        }
    }
}

type FromGrowth = fn(&GrowthOutput) -> f64;

/// Key of growth by rotation.
const ROTATION: &str = "growth.rotation";
/// \[K] difference of temperature that its estimate is for, where the scene gives none.
const TYPICAL_RISE: f64 = 10.0;

impl Settings {
    /// Without and with temperatures and fits.
    fn by_temperature(&self, estimate: &Estimate) -> Twin {
        let on = self.section.is_some();
        // Rotation is an effect of its own.
        let cold = self.section.clone().map(|section| Section {
            inner: Schedule::default(),
            outer: Schedule::default(),
            balls: Schedule::default(),
            shaft: section.shaft.map(Partner::cold),
            housing: section.housing.map(Partner::cold),
            ..section
        });
        let warm = Section { inner: Schedule::Constant(TYPICAL_RISE), ..Section::default() };
        let other = if on { cold } else { Some(warm) };
        // A flow of oil takes most of the heat of fast bearings; only a balance of heat knows how much.
        let cooled = match (estimate.oil_conductance > 0.0, estimate.oiled) {
            (true, _) => "through the seats of both rings and to the oil",
            (false, true) => {
                "through the seats of both rings alone: oil that flows takes heat, here unknown how much"
            }
            (false, false) => "through the seats of both rings, where no oil flows",
        };
        let heating =
            format!("; friction would warm the bearing by about {} K {cooled}", digits(estimate.heating()));
        let words = if on { "" } else { "10 K between the inner ring and the rest" };
        Twin::new("growth", "growth by temperature", on, move |effects| {
            effects.growth.section.clone_from(&other);
        })
        .taken_as(words)
        .remarked(if on { String::new() } else { heating })
        .written("[growth] with inner, outer, balls: rises of temperature in K, not known here")
    }

    /// Without and with the widening of rings by rotation.
    fn by_rotation(&self, estimate: &Estimate) -> Twin {
        let on = self.section.as_ref().is_some_and(|section| section.rotation);
        let turns = |index: usize| estimate.rings[index].speed != 0.0;
        let known = self.section.as_ref().is_some_and(|section| {
            (section.shaft.is_some() || !turns(0)) && (section.housing.is_some() || !turns(1))
        });
        let Outline { bore, outside, .. } = estimate.outline;
        let twin = Twin::new(ROTATION, "growth by rotation", on, move |effects| {
            let section = effects.growth.section.get_or_insert_default();
            section.rotation = !on;
            section.shaft.get_or_insert_with(|| Partner::of_seat(bore));
            section.housing.get_or_insert_with(|| Partner::of_seat(outside));
        });
        twin.written(
            "[growth] rotation = true, with the diameter of the turning ring's seat in [growth.shaft] or [growth.housing]",
        )
        .automatic(known.then_some(ROTATION))
    }
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "growth",
        adds: "growth of rings and balls by temperature, by fits on shaft and in housing, and by rotation",
        states: "what parts have grown by, and what contacts set against it (for the energy balance)",
        source: "Harris and Kotzalas 2006, ch. 3; Lame 1852; Timoshenko and Goodier, art. 32",
        price: "8 % of a step (thrust case), beside what warm contacts ask of the solver",
        example: "[growth]\ninner = \"50 K\"\nouter = \"30 K\"\nballs = \"40 K\"\n",
    };
    const ESTIMATE: &'static str =
        "settled states with and without it; 10 K between the inner ring and the rest where it is off";

    const NUMBERS: &'static [Number<Self>] = section::NUMBERS;

    fn setting(&self) -> Option<String> {
        let [inner, outer, balls, ..] = self.rises(0.0)?;
        let fits = self.section.as_ref().map_or(0, |section| {
            [&section.shaft, &section.housing].into_iter().flatten().filter(|p| p.is_fitted()).count()
        });
        let fits = ["", ", one fit", ", two fits"][fits];
        let rotation =
            if self.section.as_ref().is_some_and(|section| section.rotation) { ", rotation" } else { "" };
        Some(format!("inner {inner} K, outer {outer} K, balls {balls} K{fits}{rotation}"))
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        self.section.as_ref().map_or(Ok(()), |section| section.agree(setup))
    }

    fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        vec![self.by_temperature(estimate), self.by_rotation(estimate)]
    }

    fn switch(&mut self, key: &str, on: bool) {
        if let (ROTATION, Some(section)) = (key, &mut self.section) {
            section.rotation = on;
        }
    }

    fn headlines(&self) -> &'static [&'static str] {
        &["clearance", "contact_angle.free"]
    }

    fn rows(&self) -> Vec<Row> {
        if self.section.is_none() {
            return vec![];
        }
        let rows: [(&str, Unit, f64, &str, FromGrowth); 6] = [
            ("clearance", METRE, 1e-5, "diametral clearance of the unloaded bearing as it has grown", |g| {
                g.clearance
            }),
            ("contact_angle.free", RADIAN, 0.1, "free contact angle of the bearing as it has grown", |g| {
                g.contact_angle
            }),
            ("interference.inner", METRE, 1e-5, "interference of the inner ring on its shaft", |g| {
                g.interference[0]
            }),
            ("interference.outer", METRE, 1e-5, "interference of the outer ring in its housing", |g| {
                g.interference[1]
            }),
            ("seat_pressure.inner", PASCAL, 1e7, "pressure between the inner ring and its shaft", |g| {
                g.seat_pressure[0]
            }),
            ("seat_pressure.outer", PASCAL, 1e7, "pressure between the outer ring and its housing", |g| {
                g.seat_pressure[1]
            }),
        ];
        let row = |(name, unit, nominal, description, get): (&str, Unit, f64, &str, FromGrowth)| Row {
            name: name.into(),
            unit,
            nominal,
            description: description.into(),
            get: Getter::new(move |reports| reports.growth.map_or(0.0, get)),
        };
        rows.into_iter().map(row).collect()
    }
}
