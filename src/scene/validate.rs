//! Ranges of all scene values, in one place.

use super::parameters::{PARAMETERS, Range};
use super::{CageSection, Condition, CreepLaw, Drive, Guidance, Scene, SceneError, Schedule};
use crate::contact::regularised::Parameters;

/// [-] smallest diametral clearance of a pocket over the ball diameter.
const SMALLEST_POCKET_CLEARANCE: f64 = 0.005;

fn check_all(range: &Range, key: &str, schedule: &Schedule) -> Result<(), SceneError> {
    schedule.values().into_iter().try_for_each(|value| range.check(key, value))
}

fn conflict(key: &str, why: &str) -> SceneError {
    SceneError::Conflict { key: key.to_string(), why: why.to_string() }
}

/// Checks every value of a scene against its range, and the keys against one another.
pub(super) fn validate(scene: &Scene) -> Result<(), SceneError> {
    let mut copy = scene.clone();
    for parameter in &PARAMETERS {
        if let Some(&mut value) = parameter.place(&mut copy) {
            parameter.range.check(parameter.key, value)?;
        }
    }
    bearing(scene)?;
    Range::closed(1.0, 1e5, "kg/m3").check("race.density", scene.race.density.0)?;
    Range::closed(0.0, 2.0, "").check("friction.ball_race", scene.friction.ball_race)?;
    races(scene)?;
    start(scene)?;
    let (min, initial, max) = (scene.solver.min_step.0, scene.solver.initial_step.0, scene.solver.max_step.0);
    Range::closed(1e-15, max, "s").check("solver.min_step", min)?;
    Range::closed(min, max, "s").check("solver.initial_step", initial)?;
    Range::closed(0.0, 1.0, "").check("solver.matrix_reuse", scene.solver.matrix_reuse)?;
    creep(scene)?;
    cage(scene)?;
    load(scene)
}

/// Creep law of the ball-race contacts and what it needs.
fn creep(scene: &Scene) -> Result<(), SceneError> {
    Range::closed(1.0, 7.0, "").check("effects.kalker_degree", scene.effects.kalker_degree as f64)?;
    Range::closed(0.0, 1.0, "").check("effects.epsilon_switch", scene.effects.epsilon_switch)?;
    if scene.effects.heathcote_slip
        && matches!(scene.effects.creep, CreepLaw::Frictionless | CreepLaw::Linear)
    {
        let why = "needs a creep law that saturates: regularised, saturated, kalker_table or kalker";
        return Err(conflict("effects.heathcote_slip", why));
    }
    for (race, parameters) in [("inner", scene.regularised.inner), ("outer", scene.regularised.outer)] {
        if let Some(Parameters { eta, beta, alpha }) = parameters {
            for (name, values) in [("eta", &eta[..]), ("beta", &beta), ("alpha", &alpha)] {
                let key = format!("regularised.{race}.{name}");
                values.iter().try_for_each(|value| Range::closed(-1e6, 1e6, "").check(&key, *value))?;
            }
            // Denominators without a zero at positive arguments, so that every creepage has a force.
            let positive = |linear: f64, square: f64| square > 0.0 && linear > -2.0 * square.sqrt();
            if !(positive(eta[1], eta[2]) && positive(beta[1], beta[0]) && positive(alpha[1], alpha[2])) {
                let why = "a denominator vanishes: eta_1 > -2 sqrt(eta_2), beta_1 > -2 sqrt(beta_0) and \
                           alpha_1 > -2 sqrt(alpha_2) with eta_2, beta_0, alpha_2 > 0 are needed";
                return Err(conflict(&format!("regularised.{race}"), why));
            }
        }
    }
    Ok(())
}

fn bearing(scene: &Scene) -> Result<(), SceneError> {
    let bearing = &scene.bearing;
    let (ball, pitch) = (bearing.ball_diameter.0, bearing.pitch_diameter.0);
    Range::closed(1.0, 200.0, "").check("bearing.balls", bearing.balls as f64)?;
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
            return Err(conflict("bearing", why));
        }
    }
    let spacing = pitch * (std::f64::consts::PI / bearing.balls as f64).sin();
    if bearing.balls > 1 && spacing < ball {
        let why = format!(
            "{} balls of {ball} m do not fit on a pitch diameter of {pitch} m: their spacing is {spacing} m",
            bearing.balls
        );
        return Err(conflict("bearing.balls", &why));
    }
    Ok(())
}

fn cage(scene: &Scene) -> Result<(), SceneError> {
    let cage = match (scene.effects.cage, &scene.cage) {
        (true, Some(cage)) => cage,
        (true, None) => {
            return Err(conflict("effects.cage", "give the cage's mass, inertia and clearances in [cage]"));
        }
        (false, Some(_)) => return Err(conflict("cage", "allowed with effects.cage = true only")),
        (false, None) => {
            let friction = &scene.friction;
            for (key, given) in [("ball_cage", friction.ball_cage), ("cage_race", friction.cage_race)] {
                if given.is_some() {
                    let why = "allowed with effects.cage = true only";
                    return Err(conflict(&format!("friction.{key}"), why));
                }
            }
            return Ok(());
        }
    };
    let (ball, pitch) = (scene.bearing.ball_diameter.0, scene.bearing.pitch_diameter.0);
    Range::above(0.0, 1e4, "kg").check("cage.mass", cage.mass.0)?;
    for moment in cage.inertia {
        Range::above(0.0, 1e4, "kg m2").check("cage.inertia", moment.0)?;
    }
    // Below, ball and pocket fit so closely that they are no half-spaces any more, which Hertz takes them for.
    Range::closed(SMALLEST_POCKET_CLEARANCE * ball, 0.5 * ball, "m")
        .check("cage.pocket_clearance", cage.pocket_clearance.0)?;
    let spacing = pitch * (std::f64::consts::PI / scene.bearing.balls as f64).sin();
    if scene.bearing.balls > 1 && spacing <= ball + cage.pocket_clearance.0 {
        let why = format!("pockets overlap: balls are {spacing} m apart and pockets wider");
        return Err(conflict("cage.pocket_clearance", &why));
    }
    if let Some(modulus) = cage.youngs_modulus {
        Range::closed(1e6, 1e13, "Pa").check("cage.youngs_modulus", modulus.0)?;
    }
    if let Some(ratio) = cage.poisson_ratio {
        Range::closed(0.0, 0.5, "").check("cage.poisson_ratio", ratio)?;
    }
    if let Some(damping) = cage.damping {
        Range::closed(0.0, 10.0, "s/m").check("cage.damping", damping.0)?;
    }
    let friction = &scene.friction;
    for (key, given) in [("ball_cage", friction.ball_cage), ("cage_race", friction.cage_race)] {
        Range::closed(0.0, 2.0, "").check(&format!("friction.{key}"), given.unwrap_or(0.0))?;
    }
    lands(cage, friction.cage_race.is_some(), ball, pitch)
}

/// Lands that guide have all their dimensions; without lands there are none.
fn lands(cage: &CageSection, friction: bool, ball: f64, pitch: f64) -> Result<(), SceneError> {
    let given = [
        ("cage.guidance_clearance", cage.guidance_clearance.map(|length| length.0)),
        ("cage.land_diameter", cage.land_diameter.map(|length| length.0)),
        ("cage.land_width", cage.land_width.map(|length| length.0)),
    ];
    let diameters = match cage.guided_by {
        Guidance::Inner => Range::closed((pitch - 2.0 * ball).max(0.0), pitch, "m"),
        Guidance::Outer => Range::closed(pitch, pitch + 2.0 * ball, "m"),
        Guidance::Balls => {
            let keys = given.iter().filter(|(_, value)| value.is_some()).map(|(key, _)| *key);
            let keys = keys.chain(friction.then_some("friction.cage_race"));
            return keys.into_iter().next().map_or(Ok(()), |key| {
                Err(conflict(key, "allowed with cage.guided_by = \"inner\" or \"outer\" only"))
            });
        }
    };
    for ((key, value), range) in
        given.into_iter().zip([Range::above(0.0, ball, "m"), diameters, Range::above(0.0, 2.0 * ball, "m")])
    {
        let Some(value) = value else {
            return Err(conflict(
                key,
                "needed where lands guide the cage: guided_by = \"inner\" or \"outer\"",
            ));
        };
        range.check(key, value)?;
    }
    Ok(())
}

fn races(scene: &Scene) -> Result<(), SceneError> {
    for (section, race) in [("inner", &scene.inner), ("outer", &scene.outer)] {
        for (key, angle) in [("ry", &race.misalignment.ry), ("rz", &race.misalignment.rz)] {
            check_all(&Range::closed(-0.2, 0.2, "rad"), &format!("{section}.misalignment.{key}"), angle)?;
        }
        if let Some(mass) = race.mass {
            Range::above(0.0, 1e5, "kg").check(&format!("{section}.mass"), mass.0)?;
        }
        for moment in race.inertia.into_iter().flatten() {
            Range::above(0.0, 1e5, "kg m2").check(&format!("{section}.inertia"), moment.0)?;
        }
        let is_body = matches!(race.drive, Drive::Wrench | Drive::Hinge);
        if is_body && (race.mass.is_none() || race.inertia.is_none()) {
            let why = "a race driven by a wrench or on a hinge is a rigid body: give its mass and its inertia [Ix, Iy, \
                       Iz]";
            return Err(conflict(section, why));
        }
    }
    if scene.outer.drive == Drive::Wrench {
        let why = "wrench drive is offered for the inner race; allowed: fixed, pose, hinge";
        return Err(conflict("outer.drive", why));
    }
    if scene.inner.drive == Drive::Hinge {
        let why = "a hinge is offered for the outer race; hold the inner race by displacements and rotations in \
                   [load] under drive = \"wrench\"";
        return Err(conflict("inner.drive", why));
    }
    Ok(())
}

fn start(scene: &Scene) -> Result<(), SceneError> {
    let start = &scene.start;
    if let Some(speed) = start.orbital_speed {
        Range::closed(-1e5, 1e5, "rad/s").check("start.orbital_speed", speed.0)?;
    }
    for component in start.ball_angular_velocity.into_iter().flatten() {
        Range::closed(-1e6, 1e6, "rad/s").check("start.ball_angular_velocity", component.0)?;
    }
    for component in start.inner_velocity.into_iter().flatten() {
        Range::closed(-1e4, 1e4, "m/s").check("start.inner_velocity", component.0)?;
    }
    if start.inner_velocity.is_some() && scene.inner.drive != Drive::Wrench {
        return Err(conflict("start.inner_velocity", "needs inner.drive = \"wrench\""));
    }
    if start.spin_balance && (start.orbital_speed.is_some() || start.ball_angular_velocity.is_some()) {
        return Err(conflict("start.spin_balance", "not with given velocities of the balls"));
    }
    Ok(())
}

fn load(scene: &Scene) -> Result<(), SceneError> {
    let load = &scene.load;
    Range::above(0.0, 1e6, "s").check("load.duration", load.duration.0)?;
    Range::closed(1e-9, load.duration.0, "s").check("load.output_interval", load.output_interval.0)?;
    let speeds = Range::closed(-1e5, 1e5, "rad/s");
    check_all(&speeds, "load.inner_speed", &load.inner_speed)?;
    check_all(&speeds, "load.outer_speed", &load.outer_speed)?;
    let both = "give at most one of a load and a motion";
    for (key, direction) in [("load.x", &load.x), ("load.y", &load.y), ("load.z", &load.z)] {
        if direction.force.is_some() && direction.displacement.is_some() {
            return Err(conflict(key, both));
        }
    }
    for (key, direction) in [("load.ry", &load.ry), ("load.rz", &load.rz)] {
        if direction.moment.is_some() && direction.rotation.is_some() {
            return Err(conflict(key, both));
        }
    }
    let varies = |condition: &Condition| matches!(condition, Condition::Load(Schedule::Table(_)));
    if scene.inner.drive != Drive::Wrench && load.conditions().iter().any(varies) {
        let why = "a load that changes needs inner.drive = \"wrench\": otherwise the race is held where the load at \
                   the start puts it";
        return Err(conflict("load", why));
    }
    let keys = ["load.x", "load.y", "load.z", "load.ry", "load.rz"];
    for (direction, (key, condition)) in keys.into_iter().zip(load.conditions()).enumerate() {
        let (range, schedule) = match &condition {
            Condition::Load(schedule) if direction < 3 => (Range::closed(-1e9, 1e9, "N"), schedule),
            Condition::Load(schedule) => (Range::closed(-1e8, 1e8, "N m"), schedule),
            Condition::Motion(schedule) if direction < 3 => (Range::closed(-0.1, 0.1, "m"), schedule),
            Condition::Motion(schedule) => (Range::closed(-0.2, 0.2, "rad"), schedule),
        };
        check_all(&range, key, schedule)?;
    }
    Ok(())
}
