//! Oil of the roller bearings of a system, their ribs, and what is around their rollers: ranges, what must agree, and friction as the model takes it.

use crate::effects::ambient;
use crate::effects::film::Section;
use crate::model::link::roller_friction::{Friction, Lubricant, Rubbing, Surroundings};
use crate::model::link::rollers::Geometry;
use crate::schema::numbers::Range;
use crate::schema::{RollerAmbient, RollerFilm, RollersSection, SceneError};

const FRICTION: Range = Range::closed(0.0, 2.0, "");
const RIB_RADIUS: Range = Range::closed(1e-4, 1e3, "m");
/// Friction coefficient where a film touches, and none is given: that of dry balls.
const DRY: f64 = 0.08;
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
        let own = section(film);
        own.check().map_err(of_rollers)?;
        if own.iso_vg.is_some() && own.temperature.is_none() {
            let why = "with iso_vg give temperature, of the oil at the contacts";
            return Err(SceneError::conflict("bearing.rollers.film", why));
        }
        let [bore, outside] = usual_rings(of.pitch_diameter.0, of.diameter.0);
        let [bore, outside] = [film.bore.map_or(bore, |of| of.0), film.outside.map_or(outside, |of| of.0)];
        if bore < outside {
            return Ok(());
        }
        let why = format!("it must be smaller than film.outside, {outside} m (usual if not given)");
        Err(SceneError::conflict(format!("bearing.rollers.film.bore = {bore} m"), why))
    })?;
    of.ambient.as_ref().map_or(Ok(()), |RollerAmbient { density, viscosity }| {
        ambient::DENSITY.check(&key("ambient.density"), density.0)?;
        ambient::VISCOSITY.check(&key("ambient.viscosity"), viscosity.0)
    })
}

/// What is wrong with a key of `[film]`, by its name here.
fn of_rollers(why: SceneError) -> SceneError {
    let own = |key: String| format!("bearing.rollers.{key}");
    match why {
        SceneError::Range { key, value, unit, range } => {
            SceneError::Range { key: own(key), value, unit, range }
        }
        SceneError::Conflict { key, why } => SceneError::Conflict { key: own(key), why },
        other => other,
    }
}

/// The section `[film]` with these keys, and what that has where one is not given.
fn section(of: &RollerFilm) -> Section {
    let usual = Section::default();
    Section {
        iso_vg: of.iso_vg,
        temperature: of.temperature,
        viscosity: of.viscosity,
        density: of.density.unwrap_or(usual.density),
        pressure_viscosity: of.pressure_viscosity.unwrap_or(usual.pressure_viscosity),
        temperature_viscosity: of.temperature_viscosity,
        conductivity: of.conductivity.unwrap_or(usual.conductivity),
        eyring_stress: of.eyring_stress.unwrap_or(usual.eyring_stress),
        limiting_shear: of.limiting_shear.unwrap_or(usual.limiting_shear),
        roughness: of.roughness.unwrap_or(usual.roughness),
        supply: of.supply.unwrap_or(usual.supply),
        bore: of.bore,
        outside: of.outside,
        // Lines have their own, and a line on a rib is none.
        rolling_resistance: false,
        ..usual
    }
}

/// \[m] usual bore of the inner ring and outside diameter of the outer one.
fn usual_rings(pitch: f64, roller: f64) -> [f64; 2] {
    let around = USUAL_SECTION * roller;
    [(pitch - around).max(0.1 * pitch), pitch + around]
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
    let section = section(of);
    let viscosity = section.oil().viscosity(section.oil_temperature());
    let shape = GEOMETRY[usize::from(geometry.taper.is_some())];
    let starvation = section.starvation(shape, usual_rings(geometry.pitch_diameter, geometry.diameter));
    // SKF's exponent is by mm2/s and rpm.
    let kinematic = viscosity / section.density.0 * 1e6;
    Lubricant {
        oil: section.lubricant(),
        viscosity,
        starvation: starvation * kinematic * 30.0 / std::f64::consts::PI,
    }
}
