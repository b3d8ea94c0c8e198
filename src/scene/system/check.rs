//! Checks of the keys of a system.

use super::bearing::WrittenBearing;
use super::check_motion::given_motion;
use super::ranges::{BORE_OFFSET, BORE_TILT, INERTIA, MASS, POSITION};
use super::read::Written;
use super::{MountedScene, NamedLoad, check_housing, rollers, spring};
use crate::effects::gravity::GRAVITY;
use crate::numerics::size::ascending;
use crate::schema::numbers::Range;
use crate::schema::{
    AxialSeat, Drive, Level, Mounting, SceneError, ShaftSection, Solver, check_duty, check_phases,
};

/// Checks every value against its range, and the keys against one another.
pub fn check(written: &Written) -> Result<(), SceneError> {
    let load = &written.load;
    Range::above(0.0, 1e4, "s").check("load.duration", load.duration.0)?;
    Range::closed(1e-9, load.duration.0, "s").check("load.output_interval", load.output_interval.0)?;
    check_duty(&written.duty)?;
    check_phases(&written.phase, load.duration.0)?;
    for (schedule, axis) in written.gravity.0.iter().zip(["x", "y", "z"]) {
        let key = format!("gravity.{axis}");
        schedule.values().into_iter().try_for_each(|value| GRAVITY.check(&key, value))?;
    }
    if let Some(frame) = &written.frame {
        frame.check("frame")?;
        let of_matrices = |name: &str| {
            let why = format!(
                "\"{name}\" is one of matrices, which do not say where its mass is: give frame.acceleration alone, or mass or beams"
            );
            Err(SceneError::conflict("frame.angular_velocity", why))
        };
        let shafts = written.shaft.0.iter().map(|shaft| (&shaft.name, &shaft.matrices));
        let housings = written.housing.iter().map(|housing| (&housing.name, &housing.matrices));
        let mut all = shafts.chain(housings);
        if let Some((name, _)) = all.find(|(_, matrices)| matrices.is_some() && frame.turns()) {
            return of_matrices(name);
        }
    }
    if written.bearing.is_empty() {
        return Err(SceneError::conflict("bearing", "a shaft needs bearings: give at least one [[bearing]]"));
    }
    if written.shaft.0.is_empty() {
        return Err(SceneError::conflict("shaft", "give at least one [[shaft]]"));
    }
    let mut names: Vec<&str> = written.bearing.iter().map(|bearing| bearing.name.as_str()).collect();
    names.extend(written.mesh.iter().map(|mesh| mesh.name.as_str()));
    names.extend(written.coupling.iter().map(|coupling| coupling.name.as_str()));
    let shafts = &written.shaft.0;
    for shaft in shafts {
        names.push(&shaft.name);
        names.extend(shaft.load.iter().map(|load| load.name.as_str()));
        names.extend(shaft.point.iter().map(|point| point.name.as_str()));
    }
    for housing in &written.housing {
        names.push(&housing.name);
        names.extend(housing.load.iter().map(|load| load.name.as_str()));
        names.extend(housing.point.iter().map(|point| point.name.as_str()));
    }
    for (index, name) in names.iter().enumerate() {
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(plain) {
            let why = "names are letters, digits, _ and -, such as left";
            return Err(SceneError::conflict(format!("name = \"{name}\""), why));
        }
        if names[..index].contains(name) {
            let why =
                "bearings, housings, loads and points of a system need names of their own, other than shaft";
            return Err(SceneError::conflict(format!("name = \"{name}\""), why));
        }
    }
    for bearing in &written.bearing {
        let mounting = &bearing.mounting;
        POSITION.check("bearing.mounting.position", mounting.position.0)?;
        let preload = mounting.preload;
        if preload.force.is_some() && preload.displacement.is_some() {
            let why = "give at most one of force and displacement";
            return Err(SceneError::conflict("bearing.mounting.preload", why));
        }
        let housings = || written.housing.iter().map(|housing| housing.name.as_str());
        if let Some(wanted) = &mounting.housing
            && !housings().any(|name| name == wanted)
        {
            let why = format!(
                "there is no such [[housing]]; there are: {}",
                housings().collect::<Vec<_>>().join(", ")
            );
            return Err(SceneError::conflict(format!("bearing.mounting.housing = \"{wanted}\""), why));
        }
        bore(mounting)?;
        hub(shafts, bearing)?;
        if bearing.links() {
            linked(bearing)?;
        }
        on_one_of(shafts, bearing)?;
    }
    for housing in &written.housing {
        check_housing::housing(housing)?;
        if !written.bearing.iter().any(|bearing| bearing.mounting.housing.as_ref() == Some(&housing.name)) {
            let why = "no bearing sits in it: give mounting.housing of one";
            return Err(SceneError::conflict(format!("housing \"{}\"", housing.name), why));
        }
    }
    shafts.iter().try_for_each(|one| shaft(one, shafts.len() > 1))
}

/// Keys that the scene of a bearing alone has, and what a machine has in their place.
const ELSEWHERE: [(&str, &[&str], &str); 5] = [
    (
        "interface",
        &["orientation", "dependencies", "inputs"],
        "is for a bearing without a shaft: inputs of a machine are played by its scripts until the importer sets one of them; who gives \
         friction, temperatures and oil of a bearing, and how its orientations are written, is [bearing.set] interface",
    ),
    (
        "",
        &["effects"],
        "are those of a bearing, in its scene or in [bearing.set]; gravity and [frame] are those of the machine",
    ),
    (
        "load",
        &["x", "y", "z", "ry", "rz"],
        "is for a bearing without a shaft: a force, a moment, a displacement or a rotation of a shaft is that of a [[shaft.load]]",
    ),
    (
        "load",
        &["rotating", "gear"],
        "is for a bearing without a shaft: a machine has [[shaft.rotating]] and [[shaft.gear]]",
    ),
    (
        "load",
        &["inner_speed", "outer_speed", "outer"],
        "is for a bearing without a shaft: a machine has shaft.speed or shaft.torque, mounting.outer_shaft for an outer ring that turns, and \
         [bearing.set] load.outer for one under a wrench",
    ),
];

/// Refuses keys of a bearing alone in the file of a machine.
pub fn elsewhere(text: &str) -> Result<(), SceneError> {
    let Ok(table) = toml::from_str::<toml::Table>(text) else { return Ok(()) };
    for (section, keys, why) in ELSEWHERE {
        let within =
            if section.is_empty() { Some(&table) } else { table.get(section).and_then(|of| of.as_table()) };
        if let Some(key) = keys.iter().find(|key| within.is_some_and(|table| table.contains_key(**key))) {
            let key = if section.is_empty() { key.to_string() } else { format!("{section}.{key}") };
            return Err(SceneError::conflict(key, why));
        }
    }
    Ok(())
}

/// A bearing sits on a shaft that there is.
fn on_one_of(shafts: &[ShaftSection], bearing: &WrittenBearing) -> Result<(), SceneError> {
    let names = || shafts.iter().map(|shaft| shaft.name.as_str());
    match &bearing.shaft {
        Some(wanted) if !names().any(|name| name == wanted) => {
            let why =
                format!("there is no such [[shaft]]; there are: {}", names().collect::<Vec<_>>().join(", "));
            Err(SceneError::conflict(format!("bearing.shaft = \"{wanted}\""), why))
        }
        None if shafts.len() > 1 => {
            let why = format!(
                "is needed where there are several: one of {}",
                names().collect::<Vec<_>>().join(", ")
            );
            Err(SceneError::conflict(format!("bearing \"{}\": bearing.shaft", bearing.name), why))
        }
        _ => Ok(()),
    }
}

/// The shaft that an outer ring is a part of.
fn hub(shafts: &[ShaftSection], bearing: &WrittenBearing) -> Result<(), SceneError> {
    let mounting = &bearing.mounting;
    let Some(wanted) = &mounting.outer_shaft else { return Ok(()) };
    let refuse = |why: String| {
        Err(SceneError::conflict(
            format!("bearing \"{}\": bearing.mounting.outer_shaft = \"{wanted}\"", bearing.name),
            why,
        ))
    };
    let named = |name: &str| shafts.iter().find(|shaft| shaft.name == name);
    let own = bearing.shaft.as_deref().and_then(named).or(shafts.first());
    let (Some(own), Some(hub)) = (own, named(wanted)) else {
        let names: Vec<&str> = shafts.iter().map(|shaft| shaft.name.as_str()).collect();
        return refuse(format!("there is no such [[shaft]]; there are: {}", names.join(", ")));
    };
    if own.name == hub.name {
        return refuse("is the shaft that the inner ring is a part of: give another one".into());
    }
    if mounting.housing.is_some() || mounting.has_bore() {
        return refuse(
            "is not for a ring with a seat: take housing, axial, misalignment and offset out".into(),
        );
    }
    let (inner, outer) = (own.place(0.0), hub.place(0.0));
    if (1..3).any(|axis| (inner[axis] - outer[axis]).abs() > 1e-9) {
        return refuse("both shafts must be on one axis: give them the same y and z of shaft.origin".into());
    }
    Ok(())
}

/// A bearing by its stiffness or by rollers has nothing of one of balls.
fn linked(bearing: &WrittenBearing) -> Result<(), SceneError> {
    let inside =
        |source| SceneError::At { place: format!("bearing \"{}\"", bearing.name), source: Box::new(source) };
    let mounting = &bearing.mounting;
    let tapered = bearing.rollers.as_ref().is_some_and(|of| of.contact_angle.is_some());
    let given = [
        ("bearing.scene", bearing.scene.is_some()),
        ("bearing.catalogue", bearing.catalogue.is_some()),
        ("bearing.set", !bearing.set.is_empty()),
        ("bearing.level_changes", bearing.level_changes),
        ("bearing.mounting", mounting.axial == AxialSeat::Free || mounting.preload.is_given() && !tapered),
    ];
    if let Some((key, _)) = given.into_iter().find(|(_, given)| *given) {
        let why = "is for a bearing of balls that are simulated; of one by its stiffness or by rollers mounting has position, direction, housing, offset and \
                   misalignment alone, outer_shaft of one by rollers, and preload of one by tapered rollers";
        return Err(inside(SceneError::conflict(key, why)));
    }
    let rubs = bearing
        .rollers
        .as_ref()
        .is_some_and(|of| of.film.is_some() || of.rib_friction.is_some() || of.ambient.is_some());
    if mounting.outer_shaft.is_some() && rubs {
        let why = "is for rollers whose outer ring is on no shaft: film, rib_friction and ambient are not simulated between two shafts";
        return Err(inside(SceneError::conflict("bearing.rollers", why)));
    }
    if mounting.outer_shaft.is_some() && bearing.stiffness.is_some() {
        let why = "is for balls and rollers: springs between two shafts are a [[coupling]]";
        return Err(inside(SceneError::conflict("bearing.mounting.outer_shaft", why)));
    }
    let checked = match (&bearing.stiffness, &bearing.rollers) {
        (Some(_), Some(_)) => {
            Err(SceneError::conflict("bearing", "give at most one of stiffness and rollers"))
        }
        (Some(stiffness), None) => spring::check_bearing(stiffness),
        (None, Some(of)) => rollers::check(of, bearing.level)
            .and_then(|()| rollers::way_of_preload(of, &mounting.preload).map(drop)),
        (None, None) => Ok(()),
    };
    checked.map_err(inside)
}

/// How an outer ring sits.
fn bore(mounting: &Mounting) -> Result<(), SceneError> {
    for (key, tilt) in mounting.misalignment.values() {
        BORE_TILT.check(&format!("bearing.mounting.misalignment.{key}"), tilt.unwrap_or(0.0))?;
    }
    for (key, length) in mounting.offset.values() {
        BORE_OFFSET.check(&format!("bearing.mounting.offset.{key}"), length.unwrap_or(0.0))?;
    }
    if mounting.axial == AxialSeat::Free && mounting.preload.is_given() {
        let why = "a ring that slides (axial = \"free\") takes no axial force: nothing would hold a preload";
        return Err(SceneError::conflict("bearing.mounting.preload", why));
    }
    Ok(())
}

fn shaft(shaft: &ShaftSection, of_several: bool) -> Result<(), SceneError> {
    if of_several {
        let inside =
            |source| SceneError::At { place: format!("shaft \"{}\"", shaft.name), source: Box::new(source) };
        if shaft.speed.is_some() && shaft.torque.is_some() {
            return Err(inside(SceneError::conflict("shaft", "give at most one of speed and torque")));
        }
        return keys_of_shaft(shaft).map_err(inside);
    }
    if shaft.speed.is_some() == shaft.torque.is_some() {
        return Err(SceneError::conflict("shaft", "give exactly one of speed and torque"));
    }
    keys_of_shaft(shaft)
}

fn keys_of_shaft(shaft: &ShaftSection) -> Result<(), SceneError> {
    for length in shaft.origin.iter().flatten() {
        POSITION.check("shaft.origin", length.0)?;
    }
    if shaft.flange && shaft.speed.is_none() {
        let why = "needs speed: it is driven by angle and speed; a shaft with torque has its angle and speed as outputs";
        return Err(SceneError::conflict("shaft.flange", why));
    }
    if shaft.start_speed.is_some() && shaft.speed.is_some() {
        return Err(SceneError::conflict(
            "shaft.start_speed",
            "needs torque: a speed says how fast the shaft turns",
        ));
    }
    let rigid = [
        ("shaft.mass", shaft.mass.map(|mass| mass.0), MASS),
        ("shaft.polar_inertia", shaft.polar_inertia.map(|inertia| inertia.0), INERTIA),
        ("shaft.transverse_inertia", shaft.transverse_inertia.map(|inertia| inertia.0), INERTIA),
    ];
    for (key, value, range) in rigid {
        if shaft.matrices.is_some() {
            match value {
                None => continue,
                Some(_) => return Err(SceneError::conflict(key, "is in the file of shaft.matrices")),
            }
        }
        match (value, shaft.section.is_empty()) {
            (Some(value), true) => range.check(key, value)?,
            (None, true) => {
                let why = "a rigid shaft needs mass, polar_inertia and transverse_inertia; a flexible one [[shaft.section]]";
                return Err(SceneError::conflict(key, why));
            }
            (Some(_), false) => {
                return Err(SceneError::conflict(
                    key,
                    "follows from [[shaft.section]]; add a [[shaft.disc]] instead",
                ));
            }
            (None, false) => {}
        }
    }
    if shaft.matrices.is_some() && !(shaft.section.is_empty() && shaft.disc.is_empty()) {
        let why = "the file has the whole shaft: take [[shaft.section]] and [[shaft.disc]] out";
        return Err(SceneError::conflict("shaft.matrices", why));
    }
    if shaft.section.is_empty() && (shaft.torsion == Some(true) || shaft.drive_position.is_some()) {
        let why = "is for beams: give [[shaft.section]]; a shaft without them is stiff about its axis";
        let key = if shaft.drive_position.is_some() { "shaft.drive_position" } else { "shaft.torsion" };
        return Err(SceneError::conflict(key, why));
    }
    if let Some(position) = shaft.drive_position {
        let ends = shaft.section.iter().flat_map(|section| [section.from.0, section.to.0]);
        let [low, high] =
            ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        Range::closed(low, high, "m").check("shaft.drive_position", position.0)?;
    }
    POSITION.check("shaft.centre", shaft.centre.map_or(0.0, |centre| centre.0))?;
    Range::closed(0.0, 1.0, "s")
        .check("shaft.retardation_time", shaft.retardation_time.map_or(0.0, |time| time.0))?;
    let modes = shaft.modes_up_to.map_or(1.0, |frequency| frequency.0);
    Range::closed(1.0, 1e9, "Hz").check("shaft.modes_up_to", modes)?;
    for disc in &shaft.disc {
        POSITION.check("shaft.disc.position", disc.position.0)?;
        MASS.check("shaft.disc.mass", disc.mass.0)?;
        INERTIA.check("shaft.disc.polar_inertia", disc.polar_inertia.0)?;
        INERTIA.check("shaft.disc.transverse_inertia", disc.transverse_inertia.0)?;
        let unbalance = disc.unbalance.map_or(0.0, |unbalance| unbalance.0);
        Range::closed(0.0, 1e3, "kg m").check("shaft.disc.unbalance", unbalance)?;
    }
    for (place, gear) in shaft.gear.iter().enumerate() {
        gear.check(&format!("shaft.gear[{place}]"))?;
        if gear.speed.is_some() {
            let why = "is of a race by itself: the ripple of a gear on a shaft follows the shaft";
            return Err(SceneError::conflict(format!("shaft.gear[{place}].speed"), why));
        }
    }
    for (place, part) in shaft.rotating.iter().enumerate() {
        let own = shaft.speed.clone().unwrap_or_default();
        part.check(&format!("shaft.rotating[{place}]"), &own)?;
    }
    for load in &shaft.load {
        POSITION.check("shaft.load.position", load.position.0)?;
        given_motion(&NamedLoad::of_shaft(load))?;
    }
    sections(shaft)
}

/// Beams that make one piece.
fn sections(shaft: &ShaftSection) -> Result<(), SceneError> {
    let mut ends: Vec<(f64, f64)> = vec![];
    for section in &shaft.section {
        let (from, to) = (section.from.0, section.to.0);
        POSITION.check("shaft.section.from", from)?;
        Range::above(from, POSITION.high, "m").check("shaft.section.to", to)?;
        let outer = section.outer_diameter.0;
        Range::above(0.0, 1e2, "m").check("shaft.section.outer_diameter", outer)?;
        let inner = section.inner_diameter.map_or(0.0, |diameter| diameter.0);
        Range::closed(0.0, 0.99 * outer, "m").check("shaft.section.inner_diameter", inner)?;
        ends.push((from, to));
    }
    let begins: Vec<f64> = ends.iter().map(|end| end.0).collect();
    for pair in ascending(&begins).windows(2) {
        let (left, right) = (ends[pair[0]].1, ends[pair[1]].0);
        if (right - left).abs() > 1e-9 {
            let why = format!(
                "{right} m: the section before it ends at {left} m, and sections must follow each other without gap or overlap"
            );
            return Err(SceneError::conflict("shaft.section.from", why));
        }
    }
    Ok(())
}

/// All bearings of a system are integrated together.
pub fn solvers(
    bearings: &[MountedScene],
    of_links: &Solver,
    shafts: &[ShaftSection],
) -> Result<(), SceneError> {
    let first = bearings.first().map_or(of_links, |bearing| &bearing.scene.solver);
    if first.level == Level::Equilibrium && shafts.iter().any(|shaft| shaft.speed.is_none()) {
        let why =
            "\"equilibrium\" needs a speed of the shaft: what shaft.torque does to it is a motion in time";
        return Err(SceneError::conflict("solver.level", why));
    }
    for bearing in bearings {
        alone(bearing)?;
        let own = &bearing.scene.solver;
        let same = own.method == first.method && own.alpha_f == first.alpha_f && own.level == first.level;
        if !same || own.goal != first.goal {
            let why = "all bearings of a system are integrated together: give method, alpha_f, level and an error goal in [solver] of \
                       the system";
            return Err(SceneError::conflict("solver", why));
        }
    }
    Ok(())
}

/// Keys that a bearing has by itself alone.
fn alone(bearing: &MountedScene) -> Result<(), SceneError> {
    let (scene, name) = (&bearing.scene, &bearing.name);
    let refuse = |key: &str, why: &str| Err(SceneError::conflict(format!("bearing \"{name}\": {key}"), why));
    if scene.effects.frame.section.is_some() {
        return refuse(
            "effects.frame",
            "is for a bearing without a shaft: a machine has one frame, the section [frame] of its file",
        );
    }
    if scene.effects.support.sections[0].is_some() {
        return refuse(
            "inner.support",
            "is for a bearing without a shaft: here the inner ring is a part of the shaft; springs and dampers that hold a shaft are a [[bearing]] \
             with stiffness",
        );
    }
    if bearing.mounting.axial == AxialSeat::Free {
        let Some(mass) = scene.outer.mass else {
            return refuse(
                "outer.mass",
                "is needed: the outer ring slides (mounting.axial = \"free\") and moves by its mass",
            );
        };
        let inside =
            |source| SceneError::At { place: format!("bearing \"{name}\""), source: Box::new(source) };
        MASS.check("outer.mass", mass.0).map_err(inside)?;
    }
    if scene.outer.drive == Drive::Wrench && bearing.mounting.preload.is_given() {
        return refuse(
            "bearing.mounting.preload",
            "is not for an outer race under a wrench (outer.drive), whose axial load is load.outer.x.force: give that, or \
             load.outer.x.displacement",
        );
    }
    Ok(())
}
