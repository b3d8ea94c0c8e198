//! The section `[growth]`: its keys, their ranges, and what they must agree in.

use serde::Deserialize;

use super::fits::{RingClass, Tolerance, Within};
use crate::effects::effect::Setup;
use crate::effects::keys::Keys;
use crate::schema::numbers::{Number, POISSON_RATIO, Place, Range, YOUNGS_MODULUS};
use crate::schema::schedule::{self, Schedule};
use crate::schema::units::{Density, Force, Length, Pressure, TemperatureRise, ThermalExpansion};
use crate::schema::{BearingSection, Material, SceneError};

/// The effect as a scene has it: there is a section, or there is none.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The section `[growth]`.
    pub section: Option<Section>,
}

impl Keys for Settings {}

/// Temperatures over that of the given dimensions, and fits.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(
    default,
    deny_unknown_fields,
    expecting = "a table of inner, outer, balls, rotation, fits, ring_class, shaft, housing"
)]
pub struct Section {
    /// \[K] rise of the inner ring, constant or a table over time.
    #[serde(deserialize_with = "schedule::deserialize::<TemperatureRise, _>")]
    pub inner: Schedule,
    /// \[K] rise of the outer ring.
    #[serde(deserialize_with = "schedule::deserialize::<TemperatureRise, _>")]
    pub outer: Schedule,
    /// \[K] rise of the balls.
    #[serde(deserialize_with = "schedule::deserialize::<TemperatureRise, _>")]
    pub balls: Schedule,
    /// Do rings and what they are fitted to grow by their rotation?
    pub rotation: bool,
    /// Where fits that are given by words are within their tolerances.
    pub fits: Within,
    /// Class of the dimensions of the rings (ISO 492), for such fits.
    pub ring_class: RingClass,
    /// Seat of the inner ring: a shaft.
    pub shaft: Option<Partner>,
    /// Seat of the outer ring: a housing.
    pub housing: Option<Partner>,
}

/// Shaft or housing; steel if its material is not given.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Partner {
    /// \[m] diametral interference of the fit at given dimensions; negative is a gap. Without it the ring is not held by its
    /// seat: it grows by its own temperature and rotation.
    pub interference: Option<Length>,
    /// Tolerance of the seat in place of an interference: of a shaft such as "k6", of a housing such as "H7" (ISO 286-1). With that of the ring
    /// it is one, by `growth.fits`.
    pub fit: Option<String>,
    /// \[m] roughness Rz of ring and seat together: 0.8 of it are pressed flat, and lost to the interference (DIN 7190-1).
    pub roughness: Option<Length>,
    /// \[N] radial load that loosens an inner ring by `0.08 um (d/B F)^0.5`, d and B in mm, F in N, up to a quarter of C0 (NSK, Rolling Bearings);
    /// with `width`.
    pub radial_load: Option<Force>,
    /// \[m] width of the ring.
    pub width: Option<Length>,
    /// \[m] diameter of the seat: bore of the inner ring, outside of the outer ring.
    pub diameter: Length,
    /// \[m] bore of a hollow shaft; 0 is a solid one.
    pub bore: Option<Length>,
    /// \[m] outside diameter of the housing.
    pub outside: Option<Length>,
    /// \[Pa] Young's modulus.
    #[serde(default = "steel_modulus")]
    pub youngs_modulus: Pressure,
    /// [-] Poisson's ratio.
    #[serde(default = "steel_ratio")]
    pub poisson_ratio: f64,
    /// [kg/m3] density.
    #[serde(default = "steel_density")]
    pub density: Density,
    /// [1/K] coefficient of thermal expansion.
    #[serde(default = "steel_expansion")]
    pub thermal_expansion: ThermalExpansion,
    /// \[K] rise of its temperature.
    #[serde(default, deserialize_with = "schedule::deserialize::<TemperatureRise, _>")]
    pub rise: Schedule,
}

impl Partner {
    /// A solid shaft or a wide housing of steel at a seat of a diameter \[m] that does not hold the ring.
    pub(super) fn of_seat(diameter: f64) -> Self {
        Self {
            interference: None,
            fit: None,
            roughness: None,
            radial_load: None,
            width: None,
            diameter: Length(diameter),
            bore: None,
            outside: None,
            youngs_modulus: steel_modulus(),
            poisson_ratio: steel_ratio(),
            density: steel_density(),
            thermal_expansion: steel_expansion(),
            rise: Schedule::default(),
        }
    }

    /// Is the ring held by it?
    pub(super) fn is_fitted(&self) -> bool {
        self.interference.is_some() || self.fit.is_some()
    }

    /// \[m] interference that surfaces and load leave of a fit in a section; none without one, and gaps stay as they are.
    pub(super) fn left(&self, section: &Section) -> Option<f64> {
        let of_words = |word: &String| {
            let tolerance = Tolerance::read(word, self.diameter.0).ok()?;
            tolerance.interference(self.diameter.0, section.ring_class, section.fits)
        };
        let interference = self.interference.map(|given| given.0).or(self.fit.as_ref().and_then(of_words))?;
        let flattened = FLATTENED * self.roughness.map_or(0.0, |roughness| roughness.0);
        let slenderness = self.width.map_or(0.0, |width| self.diameter.0 / width.0);
        let loosened = LOOSENED * (slenderness * self.radial_load.map_or(0.0, |load| load.0)).sqrt();
        let left = (interference - flattened - loosened).max(0.0);
        Some(if interference > 0.0 { left } else { interference })
    }

    /// Part as cold as it is given, and without a fit.
    pub(super) fn cold(self) -> Self {
        Self { interference: None, fit: None, rise: Schedule::default(), ..self }
    }
}

fn steel_modulus() -> Pressure {
    Material::default().youngs_modulus
}

fn steel_ratio() -> f64 {
    Material::default().poisson_ratio
}

fn steel_density() -> Density {
    Material::default().density
}

fn steel_expansion() -> ThermalExpansion {
    Material::default().thermal_expansion
}

/// Rises of temperature: from the coldest there is to where bearing steel has long lost its hardness.
pub const RISE: Range = Range::closed(-300.0, 1000.0, "K");
/// Coefficients of thermal expansion; a few glasses shrink.
pub const EXPANSION: Range = Range::closed(-1e-5, 1e-4, "1/K");
const INTERFERENCE: Range = Range::closed(-0.01, 0.01, "m");
const DIAMETER: Range = Range::above(0.0, 1e3, "m");
const DENSITY: Range = Range::closed(1.0, 1e5, "kg/m3");
const ROUGHNESS: Range = Range::closed(0.0, 1e-3, "m");
const LOAD: Range = Range::closed(0.0, 1e9, "N");
const WIDTH: Range = Range::above(0.0, 10.0, "m");

/// [-] part of the heights of both surfaces that a fit presses flat, on the diameter (DIN 7190-1).
const FLATTENED: f64 = 0.8;
/// [m/N^0.5] interference that a load takes, times the root of seat over width (NSK, Rolling Bearings, "Fitting").
const LOOSENED: f64 = 0.08e-6;

fn section(settings: &mut Settings, of: impl Fn(&mut Section) -> &mut Schedule) -> Place<'_> {
    settings.section.as_mut().map_or(Place::Value(None), |section| Place::Schedule(of(section)))
}

/// Rows of a partner under the key of its section.
macro_rules! partner_numbers {
    ($partner:ident, $key:literal, $ring:literal) => {
        [
            Number::fixed(
                concat!("growth.", $key, ".interference"),
                INTERFERENCE,
                concat!("diametral interference of the ", $ring, " ring on its seat"),
                |s| {
                    Place::Value(
                        $partner(s).and_then(|p| p.interference.as_mut()).map(|length| &mut length.0),
                    )
                },
            ),
            Number::fixed(
                concat!("growth.", $key, ".diameter"),
                DIAMETER,
                concat!("diameter of the seat of the ", $ring, " ring"),
                |s| Place::Value($partner(s).map(|p| &mut p.diameter.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".bore"),
                Range::closed(0.0, 1e3, "m"),
                concat!("bore of the ", $key),
                |s| Place::Value($partner(s).and_then(|p| p.bore.as_mut()).map(|length| &mut length.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".outside"),
                DIAMETER,
                concat!("outside diameter of the ", $key),
                |s| Place::Value($partner(s).and_then(|p| p.outside.as_mut()).map(|length| &mut length.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".youngs_modulus"),
                YOUNGS_MODULUS,
                concat!("Young's modulus of the ", $key),
                |s| Place::Value($partner(s).map(|p| &mut p.youngs_modulus.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".poisson_ratio"),
                POISSON_RATIO,
                concat!("Poisson's ratio of the ", $key),
                |s| Place::Value($partner(s).map(|p| &mut p.poisson_ratio)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".density"),
                DENSITY,
                concat!("density of the ", $key),
                |s| Place::Value($partner(s).map(|p| &mut p.density.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".thermal_expansion"),
                EXPANSION,
                concat!("coefficient of thermal expansion of the ", $key),
                |s| Place::Value($partner(s).map(|p| &mut p.thermal_expansion.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".roughness"),
                ROUGHNESS,
                concat!("roughness Rz of the ", $ring, " ring and its seat together"),
                |s| Place::Value($partner(s).and_then(|p| p.roughness.as_mut()).map(|length| &mut length.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".radial_load"),
                LOAD,
                concat!("radial load that loosens the ", $ring, " ring"),
                |s| Place::Value($partner(s).and_then(|p| p.radial_load.as_mut()).map(|load| &mut load.0)),
            ),
            Number::fixed(
                concat!("growth.", $key, ".width"),
                WIDTH,
                concat!("width of the ", $ring, " ring"),
                |s| Place::Value($partner(s).and_then(|p| p.width.as_mut()).map(|length| &mut length.0)),
            ),
            // A package has it as an input.
            Number::checked(concat!("growth.", $key, ".rise"), RISE, |s| {
                $partner(s).map_or(Place::Value(None), |p| Place::Schedule(&mut p.rise))
            }),
        ]
    };
}

fn shaft(settings: &mut Settings) -> Option<&mut Partner> {
    settings.section.as_mut()?.shaft.as_mut()
}

fn housing(settings: &mut Settings) -> Option<&mut Partner> {
    settings.section.as_mut()?.housing.as_mut()
}

/// Numbers of the section. Rises of temperature are inputs of a package, not parameters.
pub const NUMBERS: &[Number<Settings>] = {
    const RISES: [Number<Settings>; 3] = [
        Number::checked("growth.inner", RISE, |s| section(s, |section| &mut section.inner)),
        Number::checked("growth.outer", RISE, |s| section(s, |section| &mut section.outer)),
        Number::checked("growth.balls", RISE, |s| section(s, |section| &mut section.balls)),
    ];
    const SHAFT: [Number<Settings>; 12] = partner_numbers!(shaft, "shaft", "inner");
    const HOUSING: [Number<Settings>; 12] = partner_numbers!(housing, "housing", "outer");
    let [a, b, c] = RISES;
    let [d, e, f, g, h, i, j, k, l, m, n, o] = SHAFT;
    let [p, q, r, s, t, u, v, w, x, y, z, last] = HOUSING;
    &[a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, last]
};

impl Section {
    /// Checks its keys against one another and the bearing.
    ///
    /// # Errors
    /// Names the key.
    pub(super) fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        let bearing = setup.bearing;
        let [inner, outer] = bearing.raceways();
        let bottoms = [
            2.0 * (inner.groove_circle_radius - inner.groove_radius),
            2.0 * (outer.groove_circle_radius + outer.groove_radius),
        ];
        for (index, (key, partner)) in
            [("shaft", &self.shaft), ("housing", &self.housing)].into_iter().enumerate()
        {
            let Some(partner) = partner else {
                if self.rotation && setup.turning[index] {
                    let why = format!(
                        "the {} race turns and rotation = true: give the diameter of its seat, growth.{key}.diameter",
                        ["inner", "outer"][index]
                    );
                    return Err(SceneError::conflict(format!("growth.{key}"), why));
                }
                continue;
            };
            partner.agree(&format!("growth.{key}"), index == 0, bottoms[index])?;
        }
        self.grooves_stay_wider_than_balls(bearing, setup.expansions)
    }

    /// Grooves that heat has made narrower than their balls are none.
    fn grooves_stay_wider_than_balls(
        &self,
        bearing: &BearingSection,
        [ball, race]: [f64; 2],
    ) -> Result<(), SceneError> {
        let extreme = |schedule: &Schedule, expansion: f64, worst: fn(f64, f64) -> f64, start: f64| {
            schedule.values().into_iter().map(|rise| expansion * rise).fold(start, worst)
        };
        let largest_ball = 1.0 + extreme(&self.balls, ball, f64::max, f64::NEG_INFINITY);
        for (key, ring, conformity) in [
            ("inner", &self.inner, bearing.inner_conformity),
            ("outer", &self.outer, bearing.outer_conformity),
        ] {
            let smallest_groove = 2.0 * conformity * (1.0 + extreme(ring, race, f64::min, f64::INFINITY));
            let wider = smallest_groove > largest_ball;
            if !wider {
                let why = format!(
                    "at these temperatures the balls are wider than the groove of bearing.{key}_conformity = {conformity}"
                );
                return Err(SceneError::conflict("growth.balls", why));
            }
        }
        Ok(())
    }
}

impl Partner {
    /// Seat between the bottom \[m] of the raceway, a diameter, and the other surface of shaft or housing.
    fn agree(&self, key: &str, is_shaft: bool, bottom: f64) -> Result<(), SceneError> {
        let seat = self.diameter.0;
        let (other, given, wrong) =
            if is_shaft { ("outside", self.outside, "shaft") } else { ("bore", self.bore, "housing") };
        if given.is_some() {
            return Err(SceneError::conflict(format!("{key}.{other}"), format!("no {wrong} has it")));
        }
        let range = if is_shaft {
            Range::above(0.0, bottom * (1.0 - LEAST_WALL), "m")
        } else {
            Range::closed(bottom * (1.0 + LEAST_WALL), 1e3, "m")
        };
        range.check(&format!("{key}.diameter"), seat)?;
        self.fit.as_deref().map_or(Ok(()), |word| self.fit_agrees(word, key, is_shaft))?;
        let lost = [("roughness", self.roughness.is_some()), ("radial_load", self.radial_load.is_some())];
        if let Some((name, _)) = lost.iter().find(|(_, given)| *given && !self.is_fitted()) {
            let why = "needed for what is lost of it: the interference of the fit";
            return Err(SceneError::conflict(format!("{key}.interference"), format!("{why} ({name})")));
        }
        match (self.radial_load.is_some(), self.width.is_some(), is_shaft) {
            (true, _, false) => {
                let why = "the load loosens inner rings: leave it out";
                return Err(SceneError::conflict(format!("{key}.radial_load"), why));
            }
            (true, false, true) => {
                let why = "needed with a radial_load: the width of the ring";
                return Err(SceneError::conflict(format!("{key}.width"), why));
            }
            _ => {}
        }
        if is_shaft {
            let bore = self.bore.map_or(0.0, |bore| bore.0);
            return Range::closed(0.0, seat * (1.0 - LEAST_WALL), "m").check(&format!("{key}.bore"), bore);
        }
        match (self.outside, self.is_fitted()) {
            (Some(outside), _) => {
                let range = Range::closed(seat * (1.0 + LEAST_WALL), 1e3, "m");
                range.check(&format!("{key}.outside"), outside.0)
            }
            (None, true) => {
                let why = "needed with an interference: the housing's outside diameter";
                Err(SceneError::conflict(format!("{key}.outside"), why))
            }
            (None, false) => Ok(()),
        }
    }

    /// Is a fit by words one of such a seat, and the only one?
    fn fit_agrees(&self, word: &str, key: &str, is_shaft: bool) -> Result<(), SceneError> {
        let tolerance = Tolerance::read(word, self.diameter.0);
        let why = match tolerance {
            _ if self.interference.is_some() => "give this or interference",
            Err(allowed) => allowed,
            Ok(tolerance) if !tolerance.is_of(usize::from(!is_shaft)) => {
                "shafts have small letters, holes of housings capital ones"
            }
            Ok(_) => return Ok(()),
        };
        Err(SceneError::conflict(format!("{key}.fit"), format!("\"{word}\": {why}")))
    }
}

/// [-] least thickness of a wall over the diameter: thinner ones are no rings.
const LEAST_WALL: f64 = 1e-3;
