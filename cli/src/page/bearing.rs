//! Dimensions, materials, drives and loads of a bearing, for drawings.

use roulement::analysis::estimate;
use roulement::effects::estimate::Outline;
use roulement::model::Model;
use roulement::model::bodies::Race;
use roulement::scene::{Direction, Drive, Guidance, RaceSection, Scene, Schedule};
use serde_json::{Value, json};

/// Names of the directions of a load.
const DIRECTIONS: [&str; 5] = ["x", "y", "z", "ry", "rz"];

/// Bore, outside diameter and width in the title of a scene, as those of catalogue bearings have them: "25 x 52 x 15 mm".
fn outline_of(title: &str) -> Option<Outline> {
    let of = |part: &str| -> Option<[f64; 3]> {
        let lengths: Vec<f64> = part
            .trim()
            .strip_suffix("mm")?
            .split('x')
            .map(|length| length.trim().parse().ok())
            .collect::<Option<_>>()?;
        lengths.try_into().ok()
    };
    let [bore, outside, width] = title.split(',').find_map(of)?.map(|length| 1e-3 * length);
    Some(Outline { bore, outside, width })
}

/// All of it; lengths \[m], angles \[rad].
pub fn describe(scene: &Scene, model: &Model) -> Value {
    let bearing = &model.bearing;
    let (ball, pitch) = (2.0 * bearing.ball.radius, bearing.pitch_diameter);
    let usual = Outline::usual(pitch, ball);
    let gravity = scene.effects.gravity.at(0.0);
    let misaligned = |race: &RaceSection| json!({ "ry": schedule(&race.misalignment.ry), "rz": schedule(&race.misalignment.rz) });
    let outline = estimate::of(scene, model).map_or(usual, |estimate| estimate.outline);
    let named = outline_of(&scene.title)
        .filter(|named| outline == usual && named.bore < pitch - ball && pitch + ball < named.outside);
    let outline = named.unwrap_or(outline);
    let race = |race: Race| {
        let (raceway, section) =
            (bearing.raceway(race), if race == Race::Inner { &scene.inner } else { &scene.outer });
        json!({
            "conformity": raceway.groove_radius / ball,
            "groove_radius": raceway.groove_radius,
            "groove_circle_radius": raceway.groove_circle_radius,
            "groove_offset": raceway.groove_offset,
            "shoulders": bearing.shoulders[race].ends,
            "drive": drive(section.drive),
        })
    };
    json!({
        "balls": bearing.n_balls,
        "ball_diameter": ball,
        "pitch_diameter": pitch,
        "contact_angle": bearing.free_contact_angle,
        "clearance": scene.bearing.diametral_clearance.as_ref().map(|clearance| clearance.0),
        "first_ball_azimuth": bearing.first_ball_azimuth,
        "is_thrust_bearing": bearing.is_thrust_bearing(),
        "inner": race(Race::Inner),
        "outer": race(Race::Outer),
        "outline": {
            "bore": outline.bore,
            "outside": outline.outside,
            "width": outline.width,
            "usual": outline == usual,
        },
        "cage": scene.effects.cage.section.as_ref().filter(|_| scene.effects.cage.is_body()).map(|cage| json!({
            "mass": cage.mass.0,
            "pocket_clearance": cage.pocket_clearance.0,
            "guided_by": guide(cage.guided_by),
            "guidance_clearance": cage.guidance_clearance.as_ref().map(|clearance| clearance.0),
            "land_diameter": cage.land_diameter.as_ref().map(|diameter| diameter.0),
            "land_width": cage.land_width.as_ref().map(|width| width.0),
        })),
        "friction": schedule(&scene.friction.ball_race),
        "creep": <&str>::from(scene.effects.creep.law),
        "loaded": Race::loaded(scene).name(),
        "speeds": { "inner": schedule(&scene.load.inner_speed), "outer": schedule(&scene.load.outer_speed) },
        "loads": { "inner": loads(scene.load.of_inner()), "outer": loads(scene.load.of_outer()) },
        "gravity": [gravity.x, gravity.y, gravity.z],
        "misalignment": { "inner": misaligned(&scene.inner), "outer": misaligned(&scene.outer) },
        "duration": scene.load.duration.0,
    })
}

fn drive(drive: Drive) -> &'static str {
    match drive {
        Drive::Fixed => "fixed",
        Drive::Pose => "pose",
        Drive::Wrench => "wrench",
        Drive::Hinge => "hinge",
    }
}

fn guide(guidance: Guidance) -> &'static str {
    match guidance {
        Guidance::Inner => "inner",
        Guidance::Outer => "outer",
        Guidance::Balls => "balls",
    }
}

/// Value at the start, least and largest value.
pub fn schedule(schedule: &Schedule) -> Value {
    let values = schedule.values();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    json!({ "start": schedule.at(0.0), "least": least, "most": most })
}

/// Loads or motions that are given for directions of a race.
fn loads(directions: [Direction<'_>; 5]) -> Value {
    let given = DIRECTIONS.iter().zip(directions).filter_map(|(name, direction)| {
        let (kind, given) = direction
            .load
            .map(|load| ("load", load))
            .or(direction.motion.map(|motion| ("motion", motion)))?;
        let mut value = schedule(given);
        value["kind"] = kind.into();
        Some((name.to_string(), value))
    });
    Value::Object(given.collect())
}
