//! Roller bearings of a system.

use nalgebra::Vector6;

use super::roller_film;
use crate::model::link::roller::Profile;
use crate::model::link::rollers::{Geometry, Rollers, Taper};
use crate::schema::numbers::Range;
use crate::schema::units::{Force, Length};
use crate::schema::{AxialTaken, BearingLevel, Preload, RollerProfile, RollersSection, SceneError};

const COUNT: Range = Range::closed(3.0, 1000.0, "");
const SIZE: Range = Range::closed(1e-4, 1.0, "m");
const CLEARANCE: Range = Range::closed(-1e-3, 1e-2, "m");
const PLAY: Range = Range::closed(0.0, 0.1, "m");
const ANGLE: Range = Range::closed(0.05, 0.8, "rad");
const RADIUS: Range = Range::closed(1e-3, 1e6, "m");
const STIFFNESS: Range = Range::above(0.0, 1e15, "N/m");
const FORCE: Range = Range::above(0.0, 1e9, "N");
/// [-] longest way of a preload, in diameters of a roller: about where lines at 14 degrees to the axis have the 4 GPa that leave a mark (ISO 76).
const LONGEST_WAY: f64 = 0.05;
const DAMPING: Range = Range::closed(0.0, 1e15, "N s/m or N m s/rad");

/// Checks the keys of a roller bearing.
///
/// # Errors
/// Names the key, the value and the range.
pub fn check(of: &RollersSection, level: Option<BearingLevel>) -> Result<(), SceneError> {
    if level == Some(BearingLevel::Dynamic) {
        let why = "rollers are simulated at level = \"equilibrium\"";
        return Err(SceneError::conflict("bearing.level = \"dynamic\"", why));
    }
    let key = |name: &str| format!("bearing.rollers.{name}");
    let length = of.length.0;
    COUNT.check(&key("count"), of.count as f64)?;
    let pitch = of.pitch_diameter.0;
    SIZE.check(&key("pitch_diameter"), pitch)?;
    // Rollers touch each other.
    let room = pitch * (std::f64::consts::PI / of.count as f64).sin();
    Range::closed(SIZE.low, room.min(0.5 * pitch), "m").check(&key("diameter"), of.diameter.0)?;
    SIZE.check(&key("length"), length)?;
    let numbers = [
        ("diametral_clearance", of.diametral_clearance.map(|of| of.0), CLEARANCE),
        ("crown_radius", of.crown_radius.map(|of| of.0), RADIUS),
        (
            "axial_clearance",
            of.axial_clearance.map(|of| of.0),
            if of.contact_angle.is_some() { CLEARANCE } else { PLAY },
        ),
        ("rib_stiffness", of.rib_stiffness.map(|of| of.0), STIFFNESS),
        ("dynamic_load_rating", of.dynamic_load_rating.map(|of| of.0), FORCE),
        ("radial_damping", of.radial_damping.map(|of| of.0), DAMPING),
        ("axial_damping", of.axial_damping.map(|of| of.0), DAMPING),
        ("tilt_damping", of.tilt_damping.map(|of| of.0), DAMPING),
    ];
    for (name, value, range) in numbers {
        value.map_or(Ok(()), |value| range.check(&key(name), value))?;
    }
    if of.contact_angle.is_some() != of.roller_angle.is_some() {
        let why = "contact_angle and roller_angle are those of a tapered bearing: give both, or none";
        return Err(SceneError::conflict("bearing.rollers", why));
    }
    if let (Some(angle), Some(between)) = (of.contact_angle, of.roller_angle) {
        ANGLE.check(&key("contact_angle"), angle.0)?;
        Range::closed(0.01, angle.0, "rad").check(&key("roller_angle"), between.0)?;
        if of.axial_way.is_some() || of.diametral_clearance.is_some() {
            let why = "is for cylindrical rollers: a tapered bearing takes forces along its x axis, and has axial_clearance";
            let name = if of.axial_way.is_some() { "axial_way" } else { "diametral_clearance" };
            return Err(SceneError::conflict(key(name), why));
        }
    } else if of.axial_way.is_none() && (of.axial_clearance.is_some() || of.rib_stiffness.is_some()) {
        let why = "says which forces along the axis ribs take: give it, or take axial_clearance and rib_stiffness out";
        return Err(SceneError::conflict(key("axial_way"), why));
    }
    roller_film::check(of)
}

/// \[m] way by which a preload pushes the inner ring of a tapered bearing along the bearing's x axis, with rings that are not tilted.
///
/// # Errors
/// If there is another play, or no way within a twentieth of a roller takes the force.
pub fn way_of_preload(of: &RollersSection, preload: &Preload) -> Result<f64, SceneError> {
    let key = "bearing.mounting.preload";
    if preload.is_given() && of.axial_clearance.is_some() {
        let why =
            "says how far the rings are from each other, as rollers.axial_clearance does: give one of both";
        return Err(SceneError::conflict(key, why));
    }
    if let Some(Length(way)) = preload.displacement {
        let ways = Range::closed(-CLEARANCE.high, -CLEARANCE.low, "m");
        return ways.check(&format!("{key}.displacement"), way).map(|()| way);
    }
    let Some(Force(wanted)) = preload.force else { return Ok(0.0) };
    let longest = LONGEST_WAY * of.diameter.0;
    let rollers = bearing(of, 1.0, Vector6::zeros(), 0.0);
    let force = |way: f64| -rollers.force(&(Vector6::x() * way), &Vector6::zeros()).force[0];
    Range::closed(0.0, force(longest), "N").check(&format!("{key}.force"), wanted)?;
    let (mut low, mut high) = (0.0, longest);
    // To the last bit.
    while low < 0.5 * (low + high) && 0.5 * (low + high) < high {
        let middle = 0.5 * (low + high);
        if force(middle) < wanted { low = middle } else { high = middle }
    }
    Ok(high)
}

/// The bearing, whose x axis points along that of the shaft (1) or against it (-1), with the bore of its outer ring at `rest`, and a way \[m] of the
/// inner ring along that axis by a preload.
pub fn bearing(of: &RollersSection, direction: f64, mut rest: Vector6<f64>, preload: f64) -> Rollers {
    let along = of.axial_way.map_or([false; 2], |way| match way {
        AxialTaken::Both => [true; 2],
        AxialTaken::Along => [direction > 0.0, direction < 0.0],
        AxialTaken::Against => [direction < 0.0, direction > 0.0],
    });
    let axial_clearance = of.axial_clearance.map_or(0.0, |of| of.0);
    let taper = of.contact_angle.zip(of.roller_angle).map(|(contact_angle, roller_angle)| {
        rest[0] += direction * (axial_clearance - preload);
        Taper { contact_angle: contact_angle.0, roller_angle: roller_angle.0, direction }
    });
    let profile = match (of.crown_radius, of.profile) {
        (Some(radius), _) => Profile::Crowned(radius.0),
        (None, RollerProfile::Logarithmic) => Profile::Logarithmic,
        (None, RollerProfile::Straight) => Profile::Straight,
    };
    let geometry = Geometry {
        count: of.count,
        diameter: of.diameter.0,
        length: of.length.0,
        pitch_diameter: of.pitch_diameter.0,
        diametral_clearance: of.diametral_clearance.map_or(0.0, |of| of.0),
        profile,
        ribs: along,
        axial_clearance,
        rib_stiffness: of.rib_stiffness.map(|of| of.0),
        first_azimuth: 0.0,
        taper,
    };
    let mut bearing = Rollers::new(geometry, of.dynamic_load_rating.map(|of| of.0));
    bearing.damping = [
        of.radial_damping.map_or(0.0, |c| c.0),
        of.axial_damping.map_or(0.0, |c| c.0),
        of.tilt_damping.map_or(0.0, |c| c.0),
    ];
    bearing.friction = roller_film::friction(of, &geometry);
    bearing.rest = rest;
    bearing
}
