//! Ranges of all scene values, in one place.

use super::{Condition, CreepLaw, Drive, Scene, SceneError, Schedule};
use crate::contact::regularised::Parameters;

/// Bounds of a range; an open bound is not itself allowed.
struct Range {
    low: f64,
    low_open: bool,
    high: f64,
    unit: &'static str,
}

const fn closed(low: f64, high: f64, unit: &'static str) -> Range {
    Range { low, low_open: false, high, unit }
}

const fn above(low: f64, high: f64, unit: &'static str) -> Range {
    Range { low, low_open: true, high, unit }
}

impl Range {
    fn check(&self, key: &str, value: f64) -> Result<(), SceneError> {
        let inside = value <= self.high && if self.low_open { value > self.low } else { value >= self.low };
        if inside {
            return Ok(());
        }
        let bracket = if self.low_open { "(" } else { "[" };
        let range = format!("{bracket}{}, {}] {}", self.low, self.high, self.unit);
        Err(SceneError::Range { key: key.to_string(), value, unit: self.unit, range })
    }

    fn check_all(&self, key: &str, schedule: &Schedule) -> Result<(), SceneError> {
        schedule.values().into_iter().try_for_each(|value| self.check(key, value))
    }
}

fn conflict(key: &str, why: &str) -> SceneError {
    SceneError::Conflict { key: key.to_string(), why: why.to_string() }
}

/// Checks every value of a scene against its range, and the keys against one another.
pub(super) fn validate(scene: &Scene) -> Result<(), SceneError> {
    bearing(scene)?;
    for (section, material) in [("ball", &scene.ball), ("race", &scene.race)] {
        closed(1e6, 1e13, "Pa").check(&format!("{section}.youngs_modulus"), material.youngs_modulus.0)?;
        closed(0.0, 0.5, "").check(&format!("{section}.poisson_ratio"), material.poisson_ratio)?;
        closed(1.0, 1e5, "kg/m3").check(&format!("{section}.density"), material.density.0)?;
    }
    closed(0.0, 2.0, "").check("friction.ball_race", scene.friction.ball_race)?;
    closed(0.0, 10.0, "s/m").check("effects.damping", scene.effects.damping.0)?;
    closed(1.0, 5.0, "").check("effects.kalker_degree", scene.effects.kalker_degree as f64)?;
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
                values.iter().try_for_each(|value| closed(-1e6, 1e6, "").check(&key, *value))?;
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
    for component in scene.effects.gravity {
        closed(-1e6, 1e6, "m/s2").check("effects.gravity", component.0)?;
    }
    races(scene)?;
    start(scene)?;
    let solver = &scene.solver;
    above(0.0, 1.0 / 3.0, "").check("solver.alpha_f", solver.alpha_f)?;
    closed(1e-14, 1e-2, "").check("solver.tolerance", solver.tolerance)?;
    closed(1e-14, 1e-2, "s").check("solver.max_step", solver.max_step.0)?;
    closed(1e-15, solver.max_step.0, "s").check("solver.min_step", solver.min_step.0)?;
    closed(solver.min_step.0, solver.max_step.0, "s").check("solver.initial_step", solver.initial_step.0)?;
    load(scene)
}

fn bearing(scene: &Scene) -> Result<(), SceneError> {
    let bearing = &scene.bearing;
    let (ball, pitch) = (bearing.ball_diameter.0, bearing.pitch_diameter.0);
    closed(1.0, 200.0, "").check("bearing.balls", bearing.balls as f64)?;
    closed(1e-4, 1.0, "m").check("bearing.ball_diameter", ball)?;
    closed(1.2 * ball, 1e3 * ball, "m").check("bearing.pitch_diameter", pitch)?;
    above(0.5, 1.0, "").check("bearing.inner_conformity", bearing.inner_conformity)?;
    above(0.5, 1.0, "").check("bearing.outer_conformity", bearing.outer_conformity)?;
    closed(-7.0, 7.0, "rad").check("bearing.first_ball_azimuth", bearing.first_ball_azimuth.0)?;
    match (bearing.contact_angle, bearing.diametral_clearance) {
        (Some(angle), None) => closed(0.0, 1.5, "rad").check("bearing.contact_angle", angle.0)?,
        (None, Some(clearance)) => {
            // Beyond this, groove centres could not come together inside the groove any more.
            let play = 2.0 * (bearing.inner_conformity + bearing.outer_conformity - 1.0) * ball;
            closed(-0.1 * ball, play, "m").check("bearing.diametral_clearance", clearance.0)?;
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

fn races(scene: &Scene) -> Result<(), SceneError> {
    for (section, race) in [("inner", &scene.inner), ("outer", &scene.outer)] {
        for (key, angle) in [("ry", &race.misalignment.ry), ("rz", &race.misalignment.rz)] {
            closed(-0.2, 0.2, "rad").check_all(&format!("{section}.misalignment.{key}"), angle)?;
        }
        if let Some(mass) = race.mass {
            above(0.0, 1e5, "kg").check(&format!("{section}.mass"), mass.0)?;
        }
        for moment in race.inertia.into_iter().flatten() {
            above(0.0, 1e5, "kg m2").check(&format!("{section}.inertia"), moment.0)?;
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
        closed(-1e5, 1e5, "rad/s").check("start.orbital_speed", speed.0)?;
    }
    for component in start.ball_angular_velocity.into_iter().flatten() {
        closed(-1e6, 1e6, "rad/s").check("start.ball_angular_velocity", component.0)?;
    }
    for component in start.inner_velocity.into_iter().flatten() {
        closed(-1e4, 1e4, "m/s").check("start.inner_velocity", component.0)?;
    }
    if start.inner_velocity.is_some() && scene.inner.drive != Drive::Wrench {
        return Err(conflict("start.inner_velocity", "needs inner.drive = \"wrench\""));
    }
    Ok(())
}

fn load(scene: &Scene) -> Result<(), SceneError> {
    let load = &scene.load;
    above(0.0, 1e6, "s").check("load.duration", load.duration.0)?;
    closed(1e-9, load.duration.0, "s").check("load.output_interval", load.output_interval.0)?;
    closed(-1e5, 1e5, "rad/s").check_all("load.inner_speed", &load.inner_speed)?;
    closed(-1e5, 1e5, "rad/s").check_all("load.outer_speed", &load.outer_speed)?;
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
            Condition::Load(schedule) if direction < 3 => (closed(-1e9, 1e9, "N"), schedule),
            Condition::Load(schedule) => (closed(-1e8, 1e8, "N m"), schedule),
            Condition::Motion(schedule) if direction < 3 => (closed(-0.1, 0.1, "m"), schedule),
            Condition::Motion(schedule) => (closed(-0.2, 0.2, "rad"), schedule),
        };
        range.check_all(key, schedule)?;
    }
    Ok(())
}
