//! Checks of the keys of a scene against each other; ranges of single numbers stand in their table.

use super::numbers::STEP;
use super::{BearingSection, Condition, Drive, Giver, Group, Scene, SceneError, Schedule};
use crate::effects::cage::IDEAL_CAGE_NEEDS;
use crate::effects::defects::On;
use crate::schema::numbers::Range;
use crate::schema::{Method, Race, Solver, check_duty, check_phases};

/// The directions of a race, in the order of their conditions.
const DIRECTIONS: [&str; 5] = ["x", "y", "z", "ry", "rz"];

/// Checks every value of a scene against its range, and the keys against one another.
pub(super) fn validate(scene: &Scene) -> Result<(), SceneError> {
    scene.check_numbers()?;
    bearing(scene)?;
    races(scene)?;
    start(scene)?;
    steps(&scene.solver)?;
    method(scene)?;
    scene.effects.agree(&scene.setup())?;
    inputs(scene)?;
    load(scene)?;
    check_duty(&scene.duty)?;
    check_phases(&scene.phase, scene.load.duration.0)
}

/// The master can only give what a package has as an input.
fn inputs(scene: &Scene) -> Result<(), SceneError> {
    let driven = |drive| [&scene.inner, &scene.outer].iter().any(|race| race.drive == drive);
    let (wrench, pose) = (driven(Drive::Wrench), driven(Drive::Pose));
    let frame = scene.effects.frame.section.is_some();
    for (group, has_input, needed) in [
        (Group::Loads, wrench, "a race with drive = \"wrench\""),
        (Group::Speeds, wrench, "a race with drive = \"wrench\""),
        (Group::Tilts, pose, "a race with drive = \"pose\""),
        (Group::Temperatures, scene.effects.growth.section.is_some(), "a section [growth]"),
        (Group::Frame, frame, "effects.frame"),
        (Group::Lubrication, scene.effects.film.section.is_some(), "a section [film]"),
    ] {
        if scene.interface.inputs.of(group) == Giver::Master && !has_input {
            let why = format!("\"master\" needs {needed}: the package has no such input otherwise");
            return Err(SceneError::conflict(format!("interface.inputs.{group}"), why));
        }
    }
    Ok(())
}

/// [-] error of a radius that is written with six digits.
const ROUNDED: f64 = 1e-6;

fn bearing(scene: &Scene) -> Result<(), SceneError> {
    let bearing = &scene.bearing;
    let (ball, pitch) = (bearing.ball_diameter.0, bearing.pitch_diameter.0);
    Range::closed(1.2 * ball, 1e3 * ball, "m").check("bearing.pitch_diameter", pitch)?;
    match (bearing.contact_angle, bearing.diametral_clearance) {
        (Some(_), None) => {}
        (None, Some(clearance)) => {
            // Beyond this, groove centres could not come together inside the groove any more.
            let play = 2.0 * (bearing.inner_conformity + bearing.outer_conformity - 1.0) * ball;
            Range::closed(-0.1 * ball, play, "m").check("bearing.diametral_clearance", clearance.0)?;
        }
        _ => {
            let why = "give exactly one of contact_angle and diametral_clearance";
            return Err(SceneError::conflict("bearing", why));
        }
    }
    let cosine = bearing.contact_angle.map_or(1.0, |angle| angle.0.cos().max(1e-3));
    let (sphere, given) = (0.5 + 0.5 * pitch / (ball * cosine), bearing.outer_conformity);
    // Its last digits are those of who writes it.
    if given > 1.0 && (given / sphere - 1.0).abs() > ROUNDED {
        let why = format!("allowed is (0.5, 1], or {sphere}: a sphere about the middle of the axis");
        return Err(SceneError::conflict(format!("bearing.outer_conformity = {given}"), why));
    }
    // Without load the orbit of the balls is the pitch circle, with a contact angle or a clearance.
    let (balls, fit) = (bearing.balls, BearingSection::most_balls(ball, pitch));
    if balls > fit {
        let why = format!(
            "{balls} balls of {ball} m do not fit on a pitch diameter of {pitch} m: allowed is [1, {fit}]"
        );
        return Err(SceneError::conflict("bearing.balls", why));
    }
    Ok(())
}

/// What goes on in time by one method alone.
fn method(scene: &Scene) -> Result<(), SceneError> {
    if scene.solver.method == Method::Esdirk3 && scene.effects.cage.is_ideal() {
        let why = "\"esdirk3\" moves balls freely: with effects.cage = \"ideal\", which keeps them at even spacing, allowed is \"hht\"";
        return Err(SceneError::conflict("solver.method", why));
    }
    Ok(())
}

fn races(scene: &Scene) -> Result<(), SceneError> {
    let bearing = &scene.bearing;
    for (section, race, conformity) in
        [("inner", &scene.inner, bearing.inner_conformity), ("outer", &scene.outer, bearing.outer_conformity)]
    {
        if let Some(heights) = race.shoulder_height {
            let key = format!("{section}.shoulder_height");
            if race.shoulder_angle.is_some() {
                return Err(SceneError::conflict(
                    key,
                    "give at most one of shoulder_height and shoulder_angle",
                ));
            }
            let range = Range::closed(0.0, conformity * bearing.ball_diameter.0, "m");
            for (side, height) in ["minus_x", "plus_x"].into_iter().zip(heights) {
                range.check(&format!("{key}.{side}"), height.0)?;
            }
        }
        let on = if section == "inner" { On::Inner } else { On::Outer };
        let carries =
            scene.effects.form.of(on == On::Inner).is_some() || !scene.effects.defects.on(on, 0.0).is_empty();
        if race.turn.is_some() && !carries {
            let why = format!(
                "it places waves and spalls of the race, and there are none: it needs form.{section} or a [[defect]] with \
                 on = \"{section}\""
            );
            return Err(SceneError::conflict(format!("{section}.turn"), why));
        }
        let is_body = matches!(race.drive, Drive::Wrench | Drive::Hinge);
        if is_body && (race.mass.is_none() || race.inertia.is_none()) {
            let why = "a race driven by a wrench or on a hinge is a rigid body: give its mass and its inertia [Ix, Iy, \
                       Iz]";
            return Err(SceneError::conflict(section, why));
        }
    }
    if scene.outer.drive == Drive::Wrench {
        if scene.inner.drive == Drive::Wrench {
            let why = "\"wrench\" beside inner.drive = \"wrench\": nothing would hold the bearing; allowed here: fixed, \
                       pose, hinge, or this with inner.drive = \"fixed\" or \"pose\"";
            return Err(SceneError::conflict("outer.drive", why));
        }
        let misalignment = &scene.outer.misalignment;
        for (key, tilt) in [("ry", &misalignment.ry), ("rz", &misalignment.rz)] {
            if *tilt != Schedule::default() {
                let (value, key) = (tilt.at(0.0), format!("outer.misalignment.{key}"));
                let why = format!(
                    "{value} rad is of the frame of a fixed or hinged race, and a race under a wrench has none; its tilt \
                     is held by load.outer.ry and load.outer.rz, each a rotation"
                );
                return Err(SceneError::conflict(key, why));
            }
        }
    }
    let is_given = matches!(scene.outer.drive, Drive::Fixed | Drive::Pose);
    if scene.effects.cage.is_ideal() && (!is_given || scene.effects.support.sections[1].is_some()) {
        return Err(SceneError::conflict("effects.cage", IDEAL_CAGE_NEEDS));
    }
    scene.effects.cage.check_frame(scene.effects.frame.section.is_some())?;
    if scene.inner.drive == Drive::Hinge {
        let why = "a hinge is offered for the outer race; hold the inner race by displacements and rotations in \
                   [load] under drive = \"wrench\"";
        return Err(SceneError::conflict("inner.drive", why));
    }
    Ok(())
}

fn start(scene: &Scene) -> Result<(), SceneError> {
    let start = &scene.start;
    if start.inner_velocity.is_some() && scene.inner.drive != Drive::Wrench {
        return Err(SceneError::conflict("start.inner_velocity", "needs inner.drive = \"wrench\""));
    }
    if start.contradicts() {
        return Err(SceneError::conflict("start.spin_balance", "not with given velocities of the balls"));
    }
    Ok(())
}

/// The first step lies between the smallest and the largest.
pub(super) fn steps(solver: &Solver) -> Result<(), SceneError> {
    let (min, initial, max) = (solver.min_step.0, solver.initial_step.0, solver.max_step.0);
    Range { high: max, ..STEP }.check("solver.min_step", min)?;
    Range { low: min, high: max, ..STEP }.check("solver.initial_step", initial)
}

fn load(scene: &Scene) -> Result<(), SceneError> {
    let load = &scene.load;
    Range::closed(1e-9, load.duration.0, "s").check("load.output_interval", load.output_interval.0)?;
    let both = "give at most one of a load and a motion";
    for (section, directions) in [("load", load.of_inner()), ("load.outer", load.of_outer())] {
        for (name, direction) in DIRECTIONS.into_iter().zip(directions) {
            if direction.load.is_some() && direction.motion.is_some() {
                return Err(SceneError::conflict(format!("{section}.{name}"), both));
            }
        }
    }
    if scene.outer.drive == Drive::Wrench {
        for (name, direction) in DIRECTIONS.into_iter().zip(load.of_inner()) {
            if let Some(given) = direction.load {
                let quantity = if name.starts_with('r') { "moment" } else { "force" };
                let why = format!(
                    "{} at the start is no load that could move the inner race, which is held while outer.drive = \
                     \"wrench\"; give load.outer.{name}",
                    given.at(0.0)
                );
                return Err(SceneError::conflict(format!("load.{name}.{quantity}"), why));
            }
        }
    } else if load.outer.is_some() {
        let why = "needs outer.drive = \"wrench\": another drive holds the outer race, whatever its load";
        return Err(SceneError::conflict("load.outer", why));
    }
    let machine = load.machine(Race::loaded(scene).scripted_speed(scene));
    if !machine.is_empty() && ![scene.inner.drive, scene.outer.drive].contains(&Drive::Wrench) {
        let key = if load.rotating.is_empty() { "load.gear" } else { "load.rotating" };
        let why = "needs inner.drive = \"wrench\" or outer.drive = \"wrench\": a race with another drive is held, whatever \
                   its load";
        return Err(SceneError::conflict(key, why));
    }
    machine.check()?;
    motions(scene)?;
    let varies = |condition: &Condition| matches!(condition, Condition::Load(of) if of.is_scripted());
    if scene.inner.drive != Drive::Wrench && load.conditions().iter().any(varies) {
        let why = "a load that changes needs inner.drive = \"wrench\": otherwise the race is held where the load at \
                   the start puts it";
        return Err(SceneError::conflict("load", why));
    }
    Ok(())
}

/// Scripted motions of races begin at rest: a sine among them at one of its turning points.
fn motions(scene: &Scene) -> Result<(), SceneError> {
    let load = &scene.load;
    let mut motions: Vec<(String, &Schedule)> = vec![];
    for (section, directions) in [("load", load.of_inner()), ("load.outer", load.of_outer())] {
        for (name, direction) in DIRECTIONS.into_iter().zip(directions) {
            let quantity = if name.starts_with('r') { "rotation" } else { "displacement" };
            motions.extend(direction.motion.map(|motion| (format!("{section}.{name}.{quantity}"), motion)));
        }
    }
    for (section, race) in [("inner", &scene.inner), ("outer", &scene.outer)] {
        for (name, tilt) in [("ry", &race.misalignment.ry), ("rz", &race.misalignment.rz)] {
            motions.push((format!("{section}.misalignment.{name}"), tilt));
        }
    }
    match motions.into_iter().find(|(_, motion)| !motion.begins_at_rest()) {
        None => Ok(()),
        Some((key, _)) => {
            let why = "a motion begins at rest, and a sine does so with phase = \"90 deg\" or \"-90 deg\": allowed are these, \
                       counted at its begin or at time 0";
            Err(SceneError::conflict(key, why))
        }
    }
}
