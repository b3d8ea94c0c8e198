//! The section `[film]`: its keys, their ranges, and what they must agree in.

use serde::Deserialize;

use super::oil::Oil;
use crate::contact::film::ShearPressure;
use crate::contact::film::mixed::MixedFriction;
use crate::effects::effect::Setup;
use crate::effects::keys::Keys;
use crate::schema::SceneError;
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::schedule::{self, Schedule};
use crate::schema::units::{Celsius, Density, Length, Pressure, PressureViscosity, Ratio, Viscosity};

/// The effect as a scene has it: there is a section, or there is none.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The section `[film]`.
    pub section: Option<Section>,
}

impl Keys for Settings {}

/// Oil, surfaces, and what of them is simulated.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    default,
    deny_unknown_fields,
    expecting = "a table such as { iso_vg = 68, temperature = \"70 degC\" }"
)]
pub struct Section {
    /// [-] 1 where films are full, 0 where surfaces are dry; constant or a table over time, and an input of an FMU.
    #[serde(deserialize_with = "schedule::deserialize::<Ratio, _>")]
    pub lubrication: Schedule,
    /// [mm2/s] ISO viscosity grade: kinematic viscosity at 40 degC of a mineral oil with a viscosity index of 95.
    pub iso_vg: Option<f64>,
    /// \[degC] temperature of the oil where it enters the contacts.
    pub temperature: Option<Celsius>,
    /// \[degC] the same where no part has warmed: to it comes the mean rise of the ring and the balls by `[growth]`.
    pub cold_temperature: Option<Celsius>,
    /// [Pa s] dynamic viscosity where the oil enters the contacts, instead of grade and temperature.
    pub viscosity: Option<Viscosity>,
    /// [kg/m3] density.
    pub density: Density,
    /// [1/Pa] growth of the viscosity with pressure.
    pub pressure_viscosity: PressureViscosity,
    /// [1/K] fall of the viscosity with temperature; that of the grade if not given, 0.035 with `viscosity`.
    pub temperature_viscosity: Option<f64>,
    /// [W/(m K)] thermal conductivity.
    pub conductivity: f64,
    /// \[Pa] Eyring stress.
    pub eyring_stress: Pressure,
    /// [-] largest shear stress over pressure.
    pub limiting_shear: f64,
    /// The pressure under which a film shears, with which its viscosity grows.
    pub shear_pressure: ShearPressure,
    /// \[m] roughness of ball and race together, root mean square.
    pub roughness: Length,
    /// How much of a contact is dry where the film is thin.
    pub mixed_friction: MixedFriction,
    /// Is there rolling resistance?
    pub rolling_resistance: bool,
    /// Does the shear of the inlet heat the oil?
    pub inlet_heating: bool,
    /// Is there oil between a cage and the lands that guide it, and between balls and cylindrical pockets?
    pub cage: bool,
    /// How oil comes back to where balls have pushed it away.
    pub supply: Supplied,
    /// \[m] bore of the inner ring and outside diameter of the outer one, for starvation and SKF's mixed friction; usual ones if not given.
    pub bore: Option<Length>,
    /// See `bore`.
    pub outside: Option<Length>,
}

impl Default for Section {
    fn default() -> Self {
        Self {
            lubrication: Schedule::Constant(1.0),
            iso_vg: None,
            temperature: None,
            cold_temperature: None,
            viscosity: None,
            density: Density(USUAL_DENSITY),
            pressure_viscosity: PressureViscosity(2.2e-8),
            temperature_viscosity: None,
            conductivity: 0.14,
            eyring_stress: Pressure(6e6),
            limiting_shear: 0.08,
            shear_pressure: ShearPressure::Mean,
            roughness: Length(0.1e-6),
            mixed_friction: MixedFriction::OlverSpikes,
            rolling_resistance: true,
            inlet_heating: true,
            cage: false,
            supply: Supplied::Bath,
            bore: None,
            outside: None,
        }
    }
}

/// How a bearing is supplied with oil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Supplied {
    /// There is always enough of it.
    Flooded,
    /// A bath to the lowest ball, or a jet.
    Bath,
    /// Drops in a stream of air.
    OilAir,
}

impl Supplied {
    /// [s/mm2] starvation constant K_rs of SKF's model.
    pub fn starvation(self) -> f64 {
        match self {
            Self::Flooded => 0.0,
            Self::Bath => 3e-8,
            Self::OilAir => 6e-8,
        }
    }

    /// Its name in a scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flooded => "flooded",
            Self::Bath => "bath",
            Self::OilAir => "oil_air",
        }
    }
}

/// [kg/m3] density of mineral oil.
pub const USUAL_DENSITY: f64 = 880.0;
/// Degrees of lubrication.
pub const LUBRICATION: Range = Range::closed(0.0, 1.0, "");
const GRADE: Range = Range::closed(2.0, 5000.0, "mm2/s");
/// From where oils are solid to where they burn.
const TEMPERATURE: Range = Range::closed(-60.0, 400.0, "degC");
pub(super) const VISCOSITY: Range = Range::closed(1e-4, 100.0, "Pa.s");

type Option64 = fn(&mut Section) -> Option<&mut f64>;

fn place(settings: &mut Settings, of: Option64) -> Place<'_> {
    Place::Value(settings.section.as_mut().and_then(of))
}

/// Rows of the table of numbers.
pub(super) const NUMBERS: &[Number<Settings>] = &[
    // A package has it as an input.
    Number::checked("film.lubrication", LUBRICATION, |s| {
        s.section.as_mut().map_or(Place::Value(None), |section| Place::Schedule(&mut section.lubrication))
    }),
    Number::fixed("film.iso_vg", GRADE, "ISO viscosity grade of the oil", |s| {
        place(s, |section| section.iso_vg.as_mut())
    }),
    Number::fixed("film.temperature", TEMPERATURE, "temperature of the oil at the contacts in degC", |s| {
        place(s, |section| section.temperature.as_mut().map(|temperature| &mut temperature.0))
    }),
    Number::fixed(
        "film.cold_temperature",
        TEMPERATURE,
        "temperature of the oil at the contacts, where no part has warmed, in degC",
        |s| place(s, |section| section.cold_temperature.as_mut().map(|temperature| &mut temperature.0)),
    ),
    Number::fixed("film.viscosity", VISCOSITY, "dynamic viscosity of the oil at the contacts", |s| {
        place(s, |section| section.viscosity.as_mut().map(|viscosity| &mut viscosity.0))
    }),
    Number::fixed("film.density", Range::closed(100.0, 5000.0, "kg/m3"), "density of the oil", |s| {
        place(s, |section| Some(&mut section.density.0))
    }),
    Number::fixed(
        "film.pressure_viscosity",
        Range::closed(1e-10, 1e-7, "1/Pa"),
        "growth of the oil's viscosity with pressure",
        |s| place(s, |section| Some(&mut section.pressure_viscosity.0)),
    ),
    Number::fixed(
        "film.temperature_viscosity",
        Range::closed(1e-4, 1.0, "1/K"),
        "fall of the oil's viscosity with temperature",
        |s| place(s, |section| section.temperature_viscosity.as_mut()),
    ),
    Number::fixed(
        "film.conductivity",
        Range::closed(0.01, 10.0, "W/(m.K)"),
        "thermal conductivity of the oil",
        |s| place(s, |section| Some(&mut section.conductivity)),
    ),
    Number::fixed("film.eyring_stress", Range::closed(1e4, 1e9, "Pa"), "Eyring stress of the oil", |s| {
        place(s, |section| Some(&mut section.eyring_stress.0))
    }),
    Number::fixed(
        "film.limiting_shear",
        Range::above(0.0, 1.0, ""),
        "largest shear stress of the oil over pressure",
        |s| place(s, |section| Some(&mut section.limiting_shear)),
    ),
    Number::fixed(
        "film.roughness",
        Range::closed(1e-9, 1e-4, "m"),
        "roughness of ball and race together, root mean square",
        |s| place(s, |section| Some(&mut section.roughness.0)),
    ),
    Number::fixed("film.bore", Range::above(0.0, 1e3, "m"), "bore of the inner ring, for starvation", |s| {
        place(s, |section| section.bore.as_mut().map(|bore| &mut bore.0))
    }),
    Number::fixed(
        "film.outside",
        Range::above(0.0, 1e3, "m"),
        "outside diameter of the outer ring, for starvation",
        |s| place(s, |section| section.outside.as_mut().map(|outside| &mut outside.0)),
    ),
];

impl Section {
    /// The oil, by viscosity or by grade.
    pub fn oil(&self) -> Oil {
        match (self.viscosity, self.iso_vg) {
            (Some(viscosity), _) => Oil::Given(viscosity.0),
            (None, grade) => Oil::Graded(grade.unwrap_or(68.0), self.density.0),
        }
    }

    /// Checks that its numbers are in their ranges, and that it says which oil there is.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self) -> Result<(), SceneError> {
        let mut settings = Settings { section: Some(self.clone()) };
        NUMBERS.iter().try_for_each(|number| number.check(&mut settings))?;
        self.names_an_oil()
    }

    fn names_an_oil(&self) -> Result<(), SceneError> {
        let conflict = |key: &str, why: &str| Err(SceneError::conflict(key, why));
        match (self.viscosity, self.iso_vg) {
            (Some(_), Some(_)) => conflict("film", "give one of viscosity and iso_vg, not both"),
            (None, None) => conflict("film", "give the oil: iso_vg with temperature, or viscosity"),
            (Some(_), None) if self.temperature.or(self.cold_temperature).is_some() => {
                conflict("film.viscosity", "a viscosity is given as it is: without a temperature")
            }
            _ => Ok(()),
        }
    }

    /// Checks keys against one another and against the rest of the scene.
    pub(super) fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        let conflict = |key: &str, why: &str| Err(SceneError::conflict(key, why));
        self.names_an_oil()?;
        if self.iso_vg.is_some() && self.temperature.is_some() == self.cold_temperature.is_some() {
            let why = "with iso_vg give one of temperature (of the oil at the contacts) and cold_temperature (that where no \
                       part has warmed by [growth])";
            return conflict("film", why);
        }
        if self.cold_temperature.is_some() && !setup.grows {
            return conflict(
                "film.cold_temperature",
                "it needs a section [growth], whose temperatures come to it",
            );
        }
        if let (Some(bore), Some(outside)) = (self.bore, self.outside)
            && bore >= outside
        {
            return conflict("film.bore", "it must be smaller than film.outside");
        }
        if self.cage && !setup.cage {
            return conflict("film.cage", "it needs a cage: effects.cage = true with a section [cage]");
        }
        if !setup.saturates {
            return conflict(
                "film",
                "a film limits friction: effects.creep must be a law that has a limit, such as \"kalker_table\"",
            );
        }
        Ok(())
    }
}
