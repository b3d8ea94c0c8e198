//! Rating life by ISO/TS 16281 and ISO 281 from the loads of all balls: of an equilibrium, or of all that a run has seen.
//!
//! In a run the powers of the loads are means over the revolutions of the races against each other: what a revolution costs does
//! not depend on how long it takes, and a bearing at rest does not age.
//!
//! A race that the load stands still on wears in one place, and its loads count with a larger power than those of a race that the load
//! goes around. Which one that is comes from how the load and both races turn.

pub mod line_contact;
pub mod standard;
mod sums;

use serde::Deserialize;

use crate::effects::reports::LifeOutput;

use std::f64::consts::TAU;

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::keys::Keys;
use super::reports::LoadRests;
use crate::contact::materials::Pair;
use crate::numerics::elementary::pow;
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::{Force, KinematicViscosity};
use crate::schema::variable_units::{NEWTON, ONE, Unit};
use crate::schema::{BearingSection, SceneError};
use standard::Geometry;
pub use sums::{Instant, Rates, Sums, Turning};

/// [-] exponent of the life of several bearings together: Weibull's of ball bearings (ISO/TS 16281; Lundberg and Palmgren 1947).
const WEIBULL: f64 = 10.0 / 9.0;

/// Life that nine of ten machines reach, from those of all their bearings, in whatever unit these have; none where one of them has none.
pub fn life_of_all(lives: impl IntoIterator<Item = Option<f64>>) -> Option<f64> {
    let failing = lives.into_iter().map(|life| life.map(|life| life.powf(-WEIBULL))).sum::<Option<f64>>();
    failing.map(|failing| failing.powf(-1.0 / WEIBULL))
}

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
    /// [m2/s] kinematic viscosity of the lubricant where it runs, that of the oil of `[film]` if not given; with `contamination` it gives the modified life.
    pub viscosity: Option<KinematicViscosity>,
    /// [-] viscosity ratio kappa, in place of `viscosity`.
    pub viscosity_ratio: Option<f64>,
    /// [-] contamination factor e_C: 0 is very dirty, 1 is clean.
    pub contamination: Option<f64>,
    /// [-] life factor of a maker, in place of a_ISO: the modified life is the reference life times it, and times the factor of `reliability`.
    pub life_factor: Option<f64>,
    /// [-] share of bearings that reach the modified life, 0.9 to 0.99.
    pub reliability: f64,
    /// The race that the load stands still on; found from how load and races turn if not given.
    pub load_rests_on: Option<LoadRests>,
}

impl Default for Section {
    fn default() -> Self {
        Self {
            dynamic_load_rating: None,
            static_load_rating: None,
            fatigue_load_limit: None,
            viscosity: None,
            viscosity_ratio: None,
            contamination: None,
            life_factor: None,
            reliability: 0.9,
            load_rests_on: None,
        }
    }
}

impl LoadRests {
    const ALL: [Self; 3] = [Self::Inner, Self::Outer, Self::Neither];

    /// From the share \[-] of the turn of the races against each other in which the load goes with the inner race.
    fn of_share(share: f64) -> Self {
        if share.abs() <= STANDING {
            Self::Outer
        } else if (share - 1.0).abs() <= STANDING {
            Self::Inner
        } else {
            Self::Neither
        }
    }

    /// Its word in scenes and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inner => "inner",
            Self::Outer => "outer",
            Self::Neither => "neither",
        }
    }

    /// In a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::Inner => "the load stands still on the inner race",
            Self::Outer => "the load stands still on the outer race",
            Self::Neither => "the load stands still on neither race",
        }
    }

    /// Does it on this race (0 is the inner one)?
    fn is_on(self, race: usize) -> bool {
        matches!((self, race), (Self::Inner, 0) | (Self::Outer, 1))
    }
}

/// The effect as a scene has it: there is a section, or there is none.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The section `[rating]`.
    pub section: Option<Section>,
}

impl Keys for Settings {}

const LOAD: Range = Range::above(0.0, 1e9, "N");

fn force(settings: &mut Settings, of: fn(&mut Section) -> &mut Option<Force>) -> Place<'_> {
    Place::Value(settings.section.as_mut().and_then(|section| of(section).as_mut()).map(|force| &mut force.0))
}

/// [million revolutions] longest life that is reported: that of an unloaded bearing has no end.
pub const LONGEST: f64 = 1e12;
/// [-] largest static safety that is reported.
pub const SAFEST: f64 = 1e6;

/// [-] powers p of the loads on a race that the load goes around, and on one that it stands still on.
const EXPONENTS: [f64; 2] = [3.0, 10.0 / 3.0];
/// [-] speed of the load against a race over that of the other race below which it stands still there: a load that shakes, such as a
/// weight with an unbalance of half its size, stands.
const STANDING: f64 = 0.25;
/// [-] radial load over the sum of ball loads below which it points nowhere: all balls carry the same, whatever their power.
const POINTS: f64 = 0.01;
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
    /// The race that the load stands still on, as the scene has it.
    load_rests_on: Option<LoadRests>,
    /// Source of the modified life, where it is asked for.
    modified: Option<Modified>,
    /// [-] part of the load ratio that a_ISO is of.
    load_share: f64,
    /// [-] factor of reliability.
    reliability: f64,
    /// \[m] pitch diameter.
    pitch_diameter: f64,
}

/// Source of the factor of the modified life.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Modified {
    /// [m2/s], [-] viscosity and contamination.
    Viscosity(f64, f64),
    /// [-], [-] viscosity ratio and contamination.
    Ratio(f64, f64),
    /// [-] a factor that is given.
    Given(f64),
}

impl Section {
    /// Where the factor of the modified life is from, in oil of a film with a kinematic viscosity [m2/s].
    fn modified(&self, oil: Option<f64>) -> Option<Modified> {
        let viscosity = self.viscosity.map(|viscosity| viscosity.0).or(oil);
        let ratio =
            self.viscosity_ratio.zip(self.contamination).map(|(ratio, dirt)| Modified::Ratio(ratio, dirt));
        let given = self.life_factor.map(Modified::Given).or(ratio);
        given.or(viscosity
            .zip(self.contamination)
            .map(|(viscosity, dirt)| Modified::Viscosity(viscosity, dirt)))
    }
}

impl Settings {
    /// Ratings of a bearing with materials of balls and races, in oil of a film with a kinematic viscosity [m2/s]; none where life is not
    /// asked for.
    pub fn rating(&self, bearing: &BearingSection, materials: &Pair, oil: Option<f64>) -> Option<Rating> {
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
            load_rests_on: section.load_rests_on,
            modified: section.modified(oil),
            load_share: geometry.load_share(),
            reliability: standard::reliability_factor(section.reliability),
            pitch_diameter: geometry.pitch_diameter,
        })
    }
}

impl Rating {
    /// Rates and sums under loads \[N] of all balls on both races while load and races turn so.
    pub fn at(&self, loads: impl Iterator<Item = [f64; 2]>, turning: Turning) -> Instant {
        let relative = turning.relative();
        let (mut rates, mut count, mut sum) = (Rates { speed: relative.abs(), ..Rates::default() }, 0.0, 0.0);
        for of_ball in loads {
            for race in 0..2 {
                // Balls without load are many, and a power of 0 is 0.
                if of_ball[race] > 0.0 {
                    for (power, exponent) in rates.powers[race].iter_mut().zip(EXPONENTS) {
                        *power += pow(of_ball[race], exponent);
                    }
                }
            }
            rates.largest = rates.largest.max(of_ball[0]);
            sum += of_ball[0];
            count += 1.0;
        }
        rates.powers = rates.powers.map(|of_race| of_race.map(|sum| sum / count));
        let turning = (turning.force[0].hypot(turning.force[1]) > POINTS * sum).then_some(turning);
        rates.with_inner = turning
            .filter(|_| relative != 0.0)
            .map(|turning| (turning.load_speed - turning.spins[1]) / relative);
        rates.ageing = LoadRests::ALL.map(|on| rates.speed / (TAU * 1e6 * self.reference(&rates, on)));
        Instant { rates, turning }
    }

    /// [million revolutions] reference life while the load stands still on a race.
    fn reference(&self, rates: &Rates, load_rests_on: LoadRests) -> f64 {
        let loads = [0, 1].map(|race| {
            let power = usize::from(load_rests_on.is_on(race));
            rates.powers[race][power].powf(1.0 / EXPONENTS[power])
        });
        standard::reference_life(self.ball_ratings, loads).min(LONGEST)
    }

    /// Life under what a run has seen.
    pub fn after(&self, sums: &Sums) -> LifeOutput {
        let life = self.life(&sums.means());
        LifeOutput { damage: sums.damage[life.load_rests_on as usize], ..life }
    }

    /// Life under loads that stay.
    pub fn life(&self, rates: &Rates) -> LifeOutput {
        let found = rates.with_inner.map(LoadRests::of_share);
        let load_rests_on = self.load_rests_on.or(found).unwrap_or_default();
        let reference = self.reference(rates, load_rests_on);
        let equivalent_load = self.dynamic_load_rating / reference.cbrt();
        let of_ratio = |ratio: f64, contamination: f64| {
            let load_ratio = contamination * self.fatigue_load_limit / equivalent_load;
            standard::life_modification(ratio, self.load_share * load_ratio)
        };
        let modified = self.modified.map(|modified| {
            let factor = match modified {
                Modified::Viscosity(viscosity, contamination) => {
                    let needed = standard::reference_viscosity(rates.speed, self.pitch_diameter);
                    of_ratio(viscosity / needed, contamination)
                }
                Modified::Ratio(ratio, contamination) => of_ratio(ratio, contamination),
                Modified::Given(factor) => factor,
            };
            (self.reliability * factor * reference).min(LONGEST)
        });
        let static_safety = (self.static_ball_load / rates.largest).min(SAFEST);
        let contradiction = found.filter(|found| *found != load_rests_on);
        LifeOutput {
            reference,
            modified,
            equivalent_load,
            static_safety,
            damage: 0.0,
            load_rests_on,
            contradiction,
        }
    }
}

type FromLife = fn(&LifeOutput) -> f64;

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "rating",
        adds: "report of rating life and static safety, from the loads of all balls since the start",
        states: "sums of powers of the loads over revolutions, the largest load",
        source: "ISO/TS 16281:2008, 4.3; ISO 281:2007; ISO 76",
        price: "6 % of the CPU time of a step (thrust case)",
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
        Number::fixed("rating.viscosity_ratio", Range::above(0.0, 100.0, ""), "viscosity ratio kappa", |s| {
            Place::Value(s.section.as_mut().and_then(|section| section.viscosity_ratio.as_mut()))
        }),
        Number::fixed("rating.life_factor", Range::above(0.0, 100.0, ""), "life factor of a maker", |s| {
            Place::Value(s.section.as_mut().and_then(|section| section.life_factor.as_mut()))
        }),
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
        let refused = |key: &str, why: &str| Err(SceneError::conflict(format!("rating.{key}"), why));
        let viscous = section.viscosity.is_some() || section.viscosity_ratio.is_some();
        if section.viscosity.is_some() && section.viscosity_ratio.is_some() {
            return refused("viscosity_ratio", "it stands in place of viscosity: give one of both");
        }
        if section.life_factor.is_some() {
            return match viscous || section.contamination.is_some() {
                true => refused(
                    "life_factor",
                    "it stands in place of a_ISO: leave out viscosity, viscosity_ratio and contamination",
                ),
                false => Ok(()),
            };
        }
        let missing = match (viscous || setup.oiled, section.contamination.is_some()) {
            (false, true) => Some("viscosity"),
            (true, false) if viscous => Some("contamination"),
            _ => None,
        };
        if let Some(missing) = missing {
            let why = "the modified life needs contamination, and a viscosity, a viscosity_ratio or the oil of a [film], or life_factor alone; without them there \
                       is none";
            return refused(missing, why);
        }
        Ok(())
    }

    fn rows(&self) -> Vec<Row> {
        let Some(section) = &self.section else {
            return vec![];
        };
        let mut rows: Vec<(&str, Unit, f64, &str, FromLife)> = vec![
            (
                "life.L10r",
                ONE,
                1e3,
                "reference rating life in million revolutions, under all loads since the start",
                |life| life.reference,
            ),
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
            (
                "life.damage",
                ONE,
                1e-9,
                "part of the reference rating life that was used up since the start; the time between two values over their difference is \
                 the life under the loads of that time",
                |life| life.damage,
            ),
        ];
        if section.contamination.is_some() || section.life_factor.is_some() {
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
