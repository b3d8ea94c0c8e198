//! Oil between balls and races: films, their friction, and rolling resistance ([`crate::contact::film`]).
//!
//! Dry friction is what is left of it without oil: `lubrication` goes from 1, full films, to 0, exactly the dry bearing. Films
//! around a cage ([`crate::contact::cage_film`]) are simulated where they are asked for (`cage`); balls touch each other dry.

pub mod oil;
mod section;

use super::effect::{Effect, Getter, Info, InputRow, Row, Setup};
use super::estimate::{Estimate, Outline};
use super::growth::Warmth;
use super::losses::{ContactPower, Part};
use super::per_ball::ball_row;
use super::reports::{BallOutput, ContactOutput, FilmOutput, Reports};
use super::twin::{Switch, Twin};
use crate::contact::film::ShearPressure;
use crate::contact::film::mixed::MixedFriction;
use crate::contact::film::{Film, Loading, Lubricant, RacewayFilm, Supply};
use crate::numerics::elementary::exp;
use crate::schema::numbers::{Number, four};
use crate::schema::schedule::Schedule;
use crate::schema::units::{Celsius, Viscosity};
use crate::schema::variable_units::{METRE, ONE, PASCAL_SECOND, Unit, WATT};
use crate::schema::{Group, SceneError};
use oil::Oil;
pub use section::{LUBRICATION, Section, Settings, Supplied, USUAL_DENSITY};

/// Geometry constant K_z of SKF's starvation factor: deep groove and angular contact ball bearings.
const GEOMETRY: [f64; 2] = [3.1, 4.4];

/// Films of both races, and the oil they are of.
#[derive(Clone, Debug, PartialEq)]
pub struct Films {
    oil: Oil,
    /// \[degC] temperature of the oil where nothing has warmed.
    temperature: f64,
    /// Do rises of temperature come to it?
    warms: bool,
    /// [1/(mm2/s rpm)] starvation constant times lengths: by viscosity and speed the exponent of the replenishment.
    starvation: f64,
    /// \[m] mean of bore and outside diameter.
    mean_diameter: f64,
    /// Law of mixed friction: how much of a contact is dry.
    mixed_friction: MixedFriction,
    /// [kg/m3] density.
    density: f64,
    races: [RacewayFilm; 2],
    /// Is there oil around a cage?
    cage: bool,
}

impl Films {
    /// [Pa s] viscosity of the oil around a cage at the inner (0) or outer (1) race that guides it, times the degree of lubrication;
    /// 0 where it is dry.
    pub fn around_cage(&self, guide: usize, lubrication: f64, warmth: &Warmth) -> f64 {
        if self.cage { lubrication * self.supply(guide, lubrication, warmth).viscosity } else { 0.0 }
    }

    /// The film of the inner (0) or outer (1) race, over dry friction; none where surfaces are dry.
    pub fn film(
        &self,
        race: usize,
        lubrication: f64,
        warmth: &Warmth,
        dry_friction: f64,
    ) -> Option<Film<'_>> {
        (lubrication > 0.0).then(|| {
            let supply = self.supply(race, lubrication, warmth);
            Film::new(&self.races[race], supply, dry_friction)
        })
    }

    /// Remark about an oil that is thicker than the model is meant for, and that steps may not be solved with; nothing of others.
    pub fn stiff_oil(&self, lubrication: f64, warmth: &Warmth) -> Option<String> {
        let viscosity = [0, 1].map(|race| self.supply(race, lubrication, warmth).viscosity);
        let [inner, outer] = viscosity;
        let (viscosity, limit) = (inner.max(outer), section::VISCOSITY.high);
        (lubrication > 0.0 && viscosity > limit).then(|| {
            format!(
                "the oil is too thick: {} has {} Pa s, and above {limit} Pa s oil hardly flows; is film.temperature that of the \
                 contacts?",
                self.oil.name(self.temperature),
                four(&viscosity)
            )
        })
    }

    /// The oil at the inner (0) or outer (1) race: at the mean temperature of ring and balls where it warms with them.
    pub fn supply(&self, race: usize, lubrication: f64, warmth: &Warmth) -> Supply {
        let Warmth { rises, spins: [inner, outer] } = warmth;
        let rise = if self.warms { 0.5 * (rises[race] + rises[2]) } else { 0.0 };
        let viscosity = self.oil.viscosity(self.temperature + rise);
        // In mm2/s and rpm, as SKF's model has them.
        let turns = (inner - outer).abs() * 30.0 / std::f64::consts::PI;
        let kinematic = viscosity / self.density * 1e6;
        let replenishment = exp(-self.starvation * kinematic * turns);
        let dry_share = self.mixed_friction.of_bearing(turns, kinematic, self.mean_diameter, lubrication);
        Supply { viscosity, lubrication, replenishment, dry_share }
    }
}

impl Settings {
    /// The degree of lubrication over time; none without a film.
    pub fn schedule(&self) -> Option<&Schedule> {
        self.section.as_ref().map(|section| &section.lubrication)
    }

    /// [m2/s] kinematic viscosity of the oil where nothing has warmed; none without a film.
    pub fn kinematic_viscosity(&self) -> Option<f64> {
        let section = self.section.as_ref()?;
        Some(section.oil().viscosity(section.oil_temperature()) / section.density.0)
    }

    /// [-] degree of lubrication at a time \[s]; 0 without a film.
    pub fn lubrication(&self, time: f64) -> f64 {
        self.schedule().map_or(0.0, |schedule| schedule.at(time))
    }

    /// The films of contacts on both races, of a pitch and a ball diameter \[m], with or without a contact angle.
    pub fn films(&self, races: [RacewayFilm; 2], [pitch, ball]: [f64; 2], angular: bool) -> Option<Films> {
        let section = self.section.as_ref()?;
        let usual = Outline::usual(pitch, ball);
        let usual = [usual.bore, usual.outside];
        let [bore, outside] = section.rings(usual);
        Some(Films {
            oil: section.oil(),
            temperature: section.oil_temperature(),
            warms: section.cold_temperature.is_some(),
            starvation: section.starvation(GEOMETRY[usize::from(angular)], usual),
            mean_diameter: 0.5e-3 * (bore + outside),
            mixed_friction: section.mixed_friction,
            density: section.density.0,
            races,
            cage: section.cage,
        })
    }
}

/// Subject of twins with and without oil.
pub const FILM: &str = "film";
/// Grade [mm2/s] and temperature \[degC] of the oil that estimates are for where the scene has none: a film is thick where it is cold.
const USUAL: (f64, f64) = (68.0, 40.0);

impl Section {
    /// The usual oil, or one of a dynamic viscosity [Pa s] that is known.
    fn usual(known: Option<f64>) -> Self {
        let (grade, temperature) = USUAL;
        match known {
            Some(viscosity) => Self { viscosity: Some(Viscosity(viscosity)), ..Self::default() },
            None => Self { iso_vg: Some(grade), temperature: Some(Celsius(temperature)), ..Self::default() },
        }
    }

    /// \[mm] bore of the inner ring and outside diameter of the outer one; usual ones \[m] if not given.
    fn rings(&self, [bore, outside]: [f64; 2]) -> [f64; 2] {
        [self.bore.map_or(bore, |bore| bore.0) * 1e3, self.outside.map_or(outside, |outside| outside.0) * 1e3]
    }

    /// [1/(mm2/s rpm)] exponent of SKF's starvation over viscosity and speed, by its geometry constant K_z and usual diameters of the rings \[m].
    pub fn starvation(&self, geometry: f64, usual: [f64; 2]) -> f64 {
        let [bore, outside] = self.rings(usual);
        let lengths = (bore + outside) * (geometry / (2.0 * (outside - bore))).sqrt();
        self.supply.starvation() * lengths
    }

    /// \[degC] temperature of the oil where nothing has warmed.
    pub fn oil_temperature(&self) -> f64 {
        self.temperature.or(self.cold_temperature).map_or(40.0, |temperature| temperature.0)
    }

    /// Oil and surfaces as films need them.
    pub fn lubricant(&self) -> Lubricant {
        let fall = self.oil().falls(self.oil_temperature());
        Lubricant {
            pressure_viscosity: self.pressure_viscosity.0,
            temperature_viscosity: self.temperature_viscosity.or(fall).unwrap_or(0.035),
            conductivity: self.conductivity,
            eyring_stress: self.eyring_stress.0,
            limiting_shear: self.limiting_shear,
            shear_pressure: self.shear_pressure,
            roughness: self.roughness.0,
            mixed_friction: self.mixed_friction,
            inlet_heating: self.inlet_heating,
            rolling_resistance: self.rolling_resistance,
        }
    }
}

/// Report of the film of a contact.
pub fn output(film: &Film<'_>, loading: &Loading<f64>) -> FilmOutput {
    if loading.load <= 0.0 {
        return FilmOutput::default();
    }
    let [central, _] = film.films(loading);
    let forces = film.forces(loading);
    FilmOutput {
        thickness: central,
        ratio: film.ratio(loading),
        friction: forces.friction,
        rolling_power: 2.0 * forces.rolling_force * loading.speed,
    }
}

type FromContact = fn(&FilmOutput) -> f64;
type OfRace = fn(&BallOutput) -> &ContactOutput;

/// Outputs of every contact.
const CONTACT_ROWS: [(&str, Unit, f64, &str, FromContact); 4] = [
    ("film_thickness", METRE, 1e-6, "central film", |film| film.thickness),
    ("film_ratio", ONE, 1.0, "least film over the roughness of both surfaces", |film| film.ratio),
    ("film_friction", ONE, 0.05, "friction coefficient of film and roughness together", |film| film.friction),
    ("rolling_power", WATT, 1.0, "power of rolling resistance, part of the friction power", |film| {
        film.rolling_power
    }),
];

/// Films of all loaded contacts with a race.
fn films<'a>(reports: &'a Reports<'_>, of: OfRace) -> impl Iterator<Item = &'a FilmOutput> {
    reports.balls.iter().map(of).filter(|contact| contact.load > 0.0).map(|contact| &contact.film)
}

/// [-] the least film ratio of all loaded contacts; 0 without any.
fn least_ratio(reports: &Reports<'_>) -> f64 {
    let both = films(reports, |ball| &ball.inner).chain(films(reports, |ball| &ball.outer));
    let least = both.map(|film| film.ratio).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// Its power in a contact, beside what it leaves of sliding.
pub const POWER: ContactPower = ContactPower { name: "film", get: |contact| contact.film.rolling_power };

/// Its part of the losses.
pub const LOSS: Part = Part {
    name: "loss.rolling",
    description: "power lost to rolling resistance of the oil",
    words: "rolling resistance of the oil",
    is_of: |effects| effects.film.section.as_ref().is_some_and(|film| film.rolling_resistance),
    get: |losses| losses.rolling,
};

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "film",
        adds: "oil between balls and races: friction of films, mixed with that of roughness, and rolling resistance; an input \
               `lubrication` from full films to none",
        states: "none",
        source: "Hamrock and Dowson 1977; Gupta and others 1992; Roelands 1966; Johnson and Tevaarwerk 1977; Biboulet and Houpert 2010",
        price: "35 % of a step with the default law (thrust case; 49 % in scenes/radial.toml), 80 % with saturated",
        example: "[film]\niso_vg = 68\ntemperature = \"70 degC\"\n",
    };
    const ESTIMATE: &'static str = "settled states with and without it; ISO VG 68 at 40 degC where it is off";

    const NUMBERS: &'static [Number<Self>] = section::NUMBERS;

    fn setting(&self) -> Option<String> {
        let section = self.section.as_ref()?;
        let (oil, temperature) = (section.oil(), section.oil_temperature());
        let degree = match section.lubrication.at(0.0) {
            degree if degree >= 1.0 => String::new(),
            degree => format!(", lubrication {degree}"),
        };
        let resistance = if section.rolling_resistance { "" } else { ", without rolling resistance" };
        let mut laws = String::new();
        if section.mixed_friction != MixedFriction::default() {
            laws += &format!(", mixed_friction {}", <&str>::from(section.mixed_friction));
        }
        if section.shear_pressure != ShearPressure::default() {
            laws += &format!(", shear_pressure {}", <&str>::from(section.shear_pressure));
        }
        Some(format!(
            "{}, {:.3} mPa s, {}{degree}{resistance}{laws}",
            oil.name(temperature),
            1e3 * oil.viscosity(temperature),
            section.supply.name()
        ))
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        self.section.as_ref().map_or(Ok(()), |section| section.agree(setup))
    }

    fn inputs(&self) -> Vec<InputRow> {
        let input = || InputRow {
            name: "lubrication".into(),
            unit: ONE,
            nominal: 1.0,
            change: 1e-3,
            description: "degree of lubrication: 1 of full films, 0 of dry surfaces".into(),
            group: Group::Lubrication,
            place: 0,
            range: Some(LUBRICATION),
            get: |inputs, _| inputs.lubrication,
            rate: |_, _| 0.0,
            set: |inputs, _, value, _| inputs.lubrication = value,
        };
        self.section.iter().map(|_| input()).collect()
    }

    fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        let write = "[film] with iso_vg and temperature of the oil";
        let (on, known) = (self.section.is_some(), estimate.viscosity);
        let oil = self.section.clone().unwrap_or_else(|| Section::usual(known));
        let name = oil.oil().name(oil.oil_temperature());
        let resists = oil.rolling_resistance;
        let [film, bare] =
            [true, false].map(|rolling_resistance| Section { rolling_resistance, ..oil.clone() });
        let other = if on { None } else { Some(film.clone()) };
        let whole = Twin::new("film", FILM, on, move |effects| effects.film.section.clone_from(&other));
        // Over the same oil without it.
        let with = on && resists;
        let changed = if with { bare.clone() } else { film };
        let rolling = Twin::new("film", "rolling resistance", with, move |effects| {
            effects.film.section = Some(changed.clone());
        });
        let common: Option<Switch> =
            if on { None } else { Some(Box::new(move |effects| effects.film.section = Some(bare.clone()))) };
        vec![
            whole.taken_as(name.clone()).written(write),
            Twin { common, ..rolling }.taken_as(format!("{name}, over its film alone")).written(write),
        ]
    }

    fn headlines(&self) -> &'static [&'static str] {
        &["film.ratio", "rolling_power.inner", "rolling_power.outer"]
    }

    fn rows(&self) -> Vec<Row> {
        if self.section.is_none() {
            return vec![];
        }
        let row = |name: &str, unit: Unit, nominal: f64, description: &str, get: Getter| Row {
            name: name.into(),
            unit,
            nominal,
            description: description.into(),
            get,
        };
        let power = |of: OfRace| {
            Getter::new(move |reports| films(reports, of).map(|film| film.rolling_power).sum::<f64>() + 0.0)
        };
        vec![
            row(
                "film.ratio",
                ONE,
                1.0,
                "least film over the roughness, of all loaded contacts",
                Getter::new(least_ratio),
            ),
            row(
                "film.viscosity.inner",
                PASCAL_SECOND,
                0.01,
                "viscosity of the oil at the inner race",
                Getter::new(|reports| reports.oil.map_or(0.0, |oil| oil[0])),
            ),
            row(
                "film.viscosity.outer",
                PASCAL_SECOND,
                0.01,
                "viscosity of the oil at the outer race",
                Getter::new(|reports| reports.oil.map_or(0.0, |oil| oil[1])),
            ),
            row(
                "rolling_power.inner",
                WATT,
                10.0,
                "power of rolling resistance on the inner race, part of the friction power",
                power(|ball| &ball.inner),
            ),
            row(
                "rolling_power.outer",
                WATT,
                10.0,
                "power of rolling resistance on the outer race, part of the friction power",
                power(|ball| &ball.outer),
            ),
        ]
    }

    fn ball_rows(&self, ball: usize) -> Vec<Row> {
        if self.section.is_none() {
            return vec![];
        }
        let races: [(&str, OfRace); 2] = [("inner", |ball| &ball.inner), ("outer", |ball| &ball.outer)];
        let of_race = |(race, of): (&str, OfRace)| {
            CONTACT_ROWS.map(|(quantity, unit, nominal, what, get)| {
                let description = format!("{what} of ball {} and the {race} race", ball + 1);
                let name = format!("{race}.{quantity}");
                ball_row(ball, &name, unit, nominal, description, move |ball| get(&of(ball).film))
            })
        };
        races.into_iter().flat_map(of_race).collect()
    }
}
