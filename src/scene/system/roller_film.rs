//! Oil of the roller bearings of a system, their ribs, and what is around their rollers: ranges, what must agree, and friction as the model takes it.

use crate::effects::film::oil::Oil;
use crate::effects::film::{Supplied, USUAL_DENSITY};
use crate::model::link::roller_friction::{Friction, Lubricant, Rubbing, Surroundings};
use crate::model::link::rollers::Geometry;
use crate::schema::numbers::Range;
use crate::schema::{RollerAmbient, RollerFilm, RollersSection, SceneError};

const FRICTION: Range = Range::closed(0.0, 2.0, "");
const RIB_RADIUS: Range = Range::closed(1e-4, 1e3, "m");
/// Friction coefficient where a film touches, and none is given: that of dry balls.
const DRY: f64 = 0.08;
/// [degC] of ISO viscosity grades.
const GRADE_TEMPERATURE: f64 = 40.0;
/// Geometry constant K_z of SKF's starvation factor: cylindrical roller bearings with a cage, tapered ones.
const GEOMETRY: [f64; 2] = [5.1, 6.0];
/// [-] pitch diameter less the bore, and outside diameter less the pitch diameter, over a roller's, as usual: 1.8 of an NU 206, 2.2 of a 30206.
const USUAL_SECTION: f64 = 2.0;

/// Checks the keys.
///
/// # Errors
/// Names the key, the value and the range.
pub fn check(of: &RollersSection) -> Result<(), SceneError> {
    let key = |name: &str| format!("bearing.rollers.{name}");
    let numbers = [
        ("rib_friction", of.rib_friction, FRICTION),
        ("rib_radius", of.rib_radius.map(|of| of.0), RIB_RADIUS),
    ];
    for (name, value, range) in numbers {
        let Some(value) = value else { continue };
        range.check(&key(name), value)?;
        if of.axial_way.is_none() && of.contact_angle.is_none() {
            let why = "is of ribs, which these rollers have none of: give axial_way or contact_angle, or take it out";
            return Err(SceneError::conflict(key(name), why));
        }
    }
    if of.rib_radius.is_some() && of.film.is_none() {
        let why = "is for the film on ribs: give film, or take it out";
        return Err(SceneError::conflict(key("rib_radius"), why));
    }
    of.film.as_ref().map_or(Ok(()), |film| {
        check_film(film)?;
        let [bore, outside] = rings(film, of.pitch_diameter.0, of.diameter.0);
        match bore < outside {
            true => Ok(()),
            false => {
                let why = format!("it must be smaller than film.outside, {outside} m (usual if not given)");
                Err(SceneError::conflict(format!("bearing.rollers.film.bore = {bore} m"), why))
            }
        }
    })?;
    of.ambient.as_ref().map_or(Ok(()), |RollerAmbient { density, viscosity }| {
        Range::closed(0.0, 2e4, "kg/m3").check(&key("ambient.density"), density.0)?;
        Range::above(0.0, 1e4, "Pa.s").check(&key("ambient.viscosity"), viscosity.0)
    })
}

/// Ranges are those of `[film]`.
fn check_film(of: &RollerFilm) -> Result<(), SceneError> {
    let key = |name: &str| format!("bearing.rollers.film.{name}");
    let numbers = [
        ("iso_vg", of.iso_vg, Range::closed(2.0, 5000.0, "mm2/s")),
        ("temperature", of.temperature.map(|of| of.0), Range::closed(-60.0, 400.0, "degC")),
        ("viscosity", of.viscosity.map(|of| of.0), Range::closed(1e-4, 100.0, "Pa.s")),
        ("density", of.density.map(|of| of.0), Range::closed(100.0, 5000.0, "kg/m3")),
        ("pressure_viscosity", of.pressure_viscosity.map(|of| of.0), Range::closed(1e-10, 1e-7, "1/Pa")),
        ("temperature_viscosity", of.temperature_viscosity, Range::closed(1e-4, 1.0, "1/K")),
        ("conductivity", of.conductivity, Range::closed(0.01, 10.0, "W/(m.K)")),
        ("eyring_stress", of.eyring_stress.map(|of| of.0), Range::closed(1e4, 1e9, "Pa")),
        ("limiting_shear", of.limiting_shear, Range::above(0.0, 1.0, "")),
        ("roughness", of.roughness.map(|of| of.0), Range::closed(1e-9, 1e-4, "m")),
        ("bore", of.bore.map(|of| of.0), Range::above(0.0, 1e3, "m")),
        ("outside", of.outside.map(|of| of.0), Range::above(0.0, 1e3, "m")),
    ];
    for (name, value, range) in numbers {
        value.map_or(Ok(()), |value| range.check(&key(name), value))?;
    }
    let whole = "bearing.rollers.film";
    match (of.viscosity, of.iso_vg) {
        (Some(_), Some(_)) => {
            return Err(SceneError::conflict(whole, "give one of viscosity and iso_vg, not both"));
        }
        (None, None) => {
            let why = "give the oil: iso_vg with temperature, or viscosity";
            return Err(SceneError::conflict(whole, why));
        }
        (None, Some(_)) if of.temperature.is_none() => {
            return Err(SceneError::conflict(
                whole,
                "with iso_vg give temperature, of the oil at the contacts",
            ));
        }
        (Some(_), None) if of.temperature.is_some() => {
            let why = "a viscosity is given as it is: without a temperature";
            return Err(SceneError::conflict(key("viscosity"), why));
        }
        _ => {}
    }
    Ok(())
}

/// \[m] bore of the inner ring and outside diameter of the outer one.
fn rings(of: &RollerFilm, pitch: f64, roller: f64) -> [f64; 2] {
    let around = USUAL_SECTION * roller;
    [
        of.bore.map_or((pitch - around).max(0.1 * pitch), |of| of.0),
        of.outside.map_or(pitch + around, |of| of.0),
    ]
}

/// Friction of a bearing; none where nothing is said of it.
pub fn friction(of: &RollersSection, geometry: &Geometry) -> Option<Box<Friction>> {
    let given = Rubbing {
        oil: of.film.as_ref().map(|film| lubricant(film, geometry)),
        rib_friction: of.rib_friction.unwrap_or(if of.film.is_some() { DRY } else { 0.0 }),
        rib_radius: of.rib_radius.map(|of| of.0),
        around: of
            .ambient
            .as_ref()
            .map(|of| Surroundings { density: of.density.0, viscosity: of.viscosity.0 }),
    };
    let asked = of.film.is_some() || of.rib_friction.is_some() || of.ambient.is_some();
    asked.then(|| Box::new(Friction::new(given, geometry)))
}

fn lubricant(of: &RollerFilm, geometry: &Geometry) -> Lubricant {
    let density = of.density.map_or(USUAL_DENSITY, |of| of.0);
    let temperature = of.temperature.map_or(GRADE_TEMPERATURE, |of| of.0);
    // That there is one of them was checked.
    let oil = match (of.viscosity, of.iso_vg) {
        (Some(viscosity), _) => Oil::Given(viscosity.0),
        (None, grade) => Oil::Graded(grade.unwrap_or(68.0), density),
    };
    let viscosity = oil.viscosity(temperature);
    let [bore, outside] = rings(of, geometry.pitch_diameter, geometry.diameter).map(|of| 1e3 * of);
    // SKF's exponent, in mm, mm2/s and rpm.
    let shape = GEOMETRY[usize::from(geometry.taper.is_some())] / (2.0 * (outside - bore));
    let lengths = (bore + outside) * shape.sqrt();
    let starvation = of.supply.unwrap_or(Supplied::Bath).starvation();
    Lubricant {
        viscosity,
        temperature_viscosity: of.temperature_viscosity.or(oil.falls(temperature)).unwrap_or(0.035),
        conductivity: of.conductivity.unwrap_or(0.14),
        pressure_viscosity: of.pressure_viscosity.map_or(2.2e-8, |of| of.0),
        eyring_stress: of.eyring_stress.map_or(6e6, |of| of.0),
        limiting_shear: of.limiting_shear.unwrap_or(0.08),
        roughness: of.roughness.map_or(0.1e-6, |of| of.0),
        starvation: starvation * viscosity / density * 1e6 * lengths * 30.0 / std::f64::consts::PI,
    }
}
