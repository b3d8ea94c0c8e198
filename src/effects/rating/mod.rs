//! Rating life by ISO/TS 16281 and ISO 281 from the loads of all balls: of an equilibrium, or of all that a run has seen.
//!
//! In a run the powers of the loads are means over the revolutions of the races against each other: what a revolution costs does
//! not depend on how long it takes, and a bearing at rest does not age.

pub mod standard;

use crate::effects::reports::LifeOutput;
use serde::{Deserialize, Serialize};

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::keys::Keys;
use crate::contact::materials::Pair;
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::{Force, KinematicViscosity};
use crate::schema::variable_units::{NEWTON, ONE, Unit};
use crate::schema::{BearingSection, SceneError};
use standard::Geometry;

/// The section `[rating]`; ratings that are not given come from the geometry.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Section {
    /// \[N] basic dynamic load rating C.
    pub dynamic_load_rating: Option<Force>,
    /// \[N] basic static load rating C_0.
    pub static_load_rating: Option<Force>,
    /// \[N] fatigue load limit C_u.
    pub fatigue_load_limit: Option<Force>,
    /// [m2/s] kinematic viscosity of the lubricant where it runs; with `contamination` it gives the modified life.
    pub viscosity: Option<KinematicViscosity>,
    /// [-] contamination factor e_C: 0 is very dirty, 1 is clean.
    pub contamination: Option<f64>,
    /// [-] share of bearings that reach the modified life, 0.9 to 0.99.
    pub reliability: f64,
    /// The race that the load stands still on.
    pub load_rests_on: LoadRests,
}

impl Default for Section {
    fn default() -> Self {
        Self {
            dynamic_load_rating: None,
            static_load_rating: None,
            fatigue_load_limit: None,
            viscosity: None,
            contamination: None,
            reliability: 0.9,
            load_rests_on: LoadRests::Outer,
        }
    }
}

/// The race that the load stands still on; the other one turns against it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadRests {
    /// The inner race.
    Inner,
    /// The outer race.
    Outer,
}

/// The effect as a scene has it: there is a section, or there is none.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The section `[rating]`.
    pub section: Option<Section>,
}

impl Keys for Settings {}

const LOAD: Range = Range::above(0.0, 1e9, "N");
/// \[rad] largest contact angle of bearings that these formulas are of; beyond are thrust bearings.
const STEEPEST: f64 = std::f64::consts::FRAC_PI_4;

fn force(settings: &mut Settings, of: fn(&mut Section) -> &mut Option<Force>) -> Place<'_> {
    Place::Value(settings.section.as_mut().and_then(|section| of(section).as_mut()).map(|force| &mut force.0))
}

/// [million revolutions] longest life that is reported: that of an unloaded bearing has no end.
pub const LONGEST: f64 = 1e12;
/// [-] largest static safety that is reported.
pub const SAFEST: f64 = 1e6;

/// What the loads of a step, or of all steps, come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// [rad/s] speed of the races against each other.
    pub speed: f64,
    /// [N^p] means over the balls of powers of their loads on the inner and the outer race.
    pub powers: [f64; 2],
    /// \[N] largest load of a ball on the inner race.
    pub largest: f64,
}

/// What a run has seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sums {
    /// \[s] duration.
    duration: f64,
    /// \[rad] turn of the races against each other.
    turn: f64,
    /// [N^p rad] powers of loads over that turn.
    powers: [f64; 2],
    /// \[N] largest load of a ball on the inner race so far.
    largest: f64,
    /// Those of the last step.
    now: Rates,
}

impl Sums {
    /// Takes what holds now without a step.
    pub fn begin(&mut self, now: Rates) {
        self.now = now;
        self.largest = self.largest.max(now.largest);
    }

    /// Adds a step of `h` \[s] by the trapezoidal rule.
    pub fn add(&mut self, now: Rates, h: f64) {
        let before = self.now;
        self.duration += h;
        self.turn += 0.5 * h * (before.speed + now.speed);
        for (race, sum) in self.powers.iter_mut().enumerate() {
            *sum += 0.5 * h * (before.speed * before.powers[race] + now.speed * now.powers[race]);
        }
        self.begin(now);
    }

    /// Adds a step of `h` \[s] that ends where other sums have begun.
    pub fn add_until(&mut self, end: &Self, h: f64) {
        self.add(end.now, h);
    }

    /// Means over the revolutions; of a bearing that has not turned, what holds now.
    fn means(&self) -> Rates {
        if self.turn > 0.0 {
            let powers = self.powers.map(|sum| sum / self.turn);
            Rates { speed: self.turn / self.duration, powers, largest: self.largest }
        } else {
            Rates { largest: self.largest, ..self.now }
        }
    }
}

/// Ratings of a bearing and its lubrication.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rating {
    /// \[N] basic dynamic load rating C.
    pub dynamic_load_rating: f64,
    /// \[N] basic static load rating C_0.
    pub static_load_rating: f64,
    /// \[N] fatigue load limit C_u.
    pub fatigue_load_limit: f64,
    /// \[N] ratings of a ball on both races.
    pub ball_ratings: [f64; 2],
    /// \[N] load of a ball on the inner race at which it leaves a mark.
    static_ball_load: f64,
    /// [-] powers of loads on both races.
    exponents: [f64; 2],
    /// [m2/s], [-] viscosity and contamination.
    lubrication: Option<(f64, f64)>,
    /// [-] factor of reliability.
    reliability: f64,
    /// \[m] pitch diameter.
    pitch_diameter: f64,
}

impl Settings {
    /// Ratings of a bearing with materials of balls and races; none where life is not asked for.
    pub fn rating(&self, bearing: &BearingSection, materials: &Pair) -> Option<Rating> {
        let section = self.section.as_ref()?;
        let geometry = Geometry {
            balls: bearing.balls,
            ball_diameter: bearing.ball_diameter.0,
            pitch_diameter: bearing.pitch_diameter.0,
            contact_angle: bearing.contact_angle.map_or(0.0, |angle| angle.0),
            conformities: [bearing.inner_conformity, bearing.outer_conformity],
        };
        let given = |force: Option<Force>| force.map(|force| force.0);
        let dynamic = given(section.dynamic_load_rating).unwrap_or_else(|| geometry.dynamic_load_rating());
        let own = geometry.static_ball_load(materials.compliance);
        let own_rating = geometry.static_load_rating(own);
        let static_load_rating = given(section.static_load_rating).unwrap_or(own_rating);
        Some(Rating {
            dynamic_load_rating: dynamic,
            static_load_rating,
            fatigue_load_limit: given(section.fatigue_load_limit)
                .unwrap_or_else(|| standard::fatigue_load_limit(static_load_rating, geometry.pitch_diameter)),
            ball_ratings: geometry.ball_ratings(dynamic),
            static_ball_load: own * (static_load_rating / own_rating),
            exponents: match section.load_rests_on {
                LoadRests::Inner => [10.0 / 3.0, 3.0],
                LoadRests::Outer => [3.0, 10.0 / 3.0],
            },
            lubrication: section.viscosity.map(|viscosity| viscosity.0).zip(section.contamination),
            reliability: standard::reliability_factor(section.reliability),
            pitch_diameter: geometry.pitch_diameter,
        })
    }
}

impl Rating {
    /// What loads \[N] of all balls on both races come to at a speed [rad/s] of the races against each other.
    pub fn rates(&self, loads: impl Iterator<Item = [f64; 2]>, speed: f64) -> Rates {
        let (mut rates, mut count) = (Rates { speed: speed.abs(), ..Rates::default() }, 0.0);
        for of_ball in loads {
            for race in 0..2 {
                // Balls without load are many, and a power of 0 is 0.
                if of_ball[race] > 0.0 {
                    rates.powers[race] += of_ball[race].powf(self.exponents[race]);
                }
            }
            rates.largest = rates.largest.max(of_ball[0]);
            count += 1.0;
        }
        rates.powers = rates.powers.map(|sum| sum / count);
        rates
    }

    /// Life under what a run has seen.
    pub fn after(&self, sums: &Sums) -> LifeOutput {
        self.life(&sums.means())
    }

    /// Life under loads that stay.
    pub fn life(&self, rates: &Rates) -> LifeOutput {
        let loads = [0, 1].map(|race: usize| rates.powers[race].powf(1.0 / self.exponents[race]));
        let reference = standard::reference_life(self.ball_ratings, loads).min(LONGEST);
        let equivalent_load = self.dynamic_load_rating / reference.cbrt();
        let modified = self.lubrication.map(|(viscosity, contamination)| {
            let ratio = viscosity / standard::reference_viscosity(rates.speed, self.pitch_diameter);
            let factor =
                standard::life_modification(ratio, contamination * self.fatigue_load_limit / equivalent_load);
            (self.reliability * factor * reference).min(LONGEST)
        });
        let static_safety = (self.static_ball_load / rates.largest).min(SAFEST);
        LifeOutput { reference, modified, equivalent_load, static_safety }
    }
}

type FromLife = fn(&LifeOutput) -> f64;

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "rating",
        adds: "report of rating life and static safety, from the loads of all balls since the start",
        states: "sums of powers of the loads over revolutions, the largest load",
        source: "ISO/TS 16281:2008, 4.3; ISO 281:2007; ISO 76",
        price: "2.2 % of a step (thrust case)",
        example: "[rating]\nviscosity = \"20 mm^2/s\"\ncontamination = 0.5\n",
    };

    const NUMBERS: &'static [Number<Self>] = &[
        Number::fixed("rating.dynamic_load_rating", LOAD, "basic dynamic load rating C", |s| {
            force(s, |section| &mut section.dynamic_load_rating)
        }),
        Number::fixed("rating.static_load_rating", LOAD, "basic static load rating C0", |s| {
            force(s, |section| &mut section.static_load_rating)
        }),
        Number::fixed("rating.fatigue_load_limit", LOAD, "fatigue load limit Cu", |s| {
            force(s, |section| &mut section.fatigue_load_limit)
        }),
        Number::fixed(
            "rating.viscosity",
            Range::above(0.0, 1.0, "m2/s"),
            "kinematic viscosity of the lubricant where it runs",
            |s| {
                Place::Value(
                    s.section.as_mut().and_then(|section| section.viscosity.as_mut()).map(|v| &mut v.0),
                )
            },
        ),
        Number::fixed("rating.contamination", Range::closed(0.0, 1.0, ""), "contamination factor", |s| {
            Place::Value(s.section.as_mut().and_then(|section| section.contamination.as_mut()))
        }),
        Number::fixed(
            "rating.reliability",
            Range::closed(0.9, 0.99, ""),
            "share of bearings that reach the modified life",
            |s| Place::Value(s.section.as_mut().map(|section| &mut section.reliability)),
        ),
    ];

    fn setting(&self) -> Option<String> {
        let section = self.section.as_ref()?;
        let ratings = match section.dynamic_load_rating {
            Some(rating) => format!("C {} N", rating.0),
            None => "C from geometry".into(),
        };
        Some(match section.viscosity {
            Some(viscosity) => format!("{ratings}, {} mm2/s", viscosity.0 * 1e6),
            None => ratings,
        })
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        let Some(section) = &self.section else {
            return Ok(());
        };
        if section.viscosity.is_some() != section.contamination.is_some() {
            let missing = if section.viscosity.is_some() { "contamination" } else { "viscosity" };
            let why = "the modified life needs viscosity and contamination; without both there is none";
            return Err(SceneError::conflict(format!("rating.{missing}"), why));
        }
        let angle = setup.bearing.contact_angle.map_or(0.0, |angle| angle.0);
        if angle > STEEPEST * (1.0 + 1e-12) {
            let why = format!(
                "bearing.contact_angle = {angle} rad is that of a thrust bearing, which has other formulas: allowed is up to \
                 {STEEPEST:.4} rad"
            );
            return Err(SceneError::conflict("rating", why));
        }
        Ok(())
    }

    fn rows(&self) -> Vec<Row> {
        let Some(section) = &self.section else {
            return vec![];
        };
        let mut rows: Vec<(&str, Unit, f64, &str, FromLife)> = vec![
            ("life.L10r", ONE, 1e3, "reference rating life in million revolutions", |life| life.reference),
            ("life.equivalent_load", NEWTON, 1e3, "dynamic equivalent reference load", |life| {
                life.equivalent_load
            }),
            (
                "life.static_safety",
                ONE,
                1.0,
                "load of a ball that leaves a mark over the largest load on the inner race",
                |life| life.static_safety,
            ),
        ];
        if section.viscosity.is_some() {
            rows.push((
                "life.modified",
                ONE,
                1e3,
                "modified reference rating life in million revolutions",
                |life| life.modified.unwrap_or(0.0),
            ));
        }
        let row = |(name, unit, nominal, description, get): (&str, Unit, f64, &str, FromLife)| Row {
            name: name.into(),
            unit,
            nominal,
            description: description.into(),
            get: Getter::new(move |reports| reports.life.map_or(0.0, get)),
        };
        rows.into_iter().map(row).collect()
    }
}
