//! `level = "auto"` of the bearings of a machine: which of them need states, by closed forms where the machine is in balance.
//!
//! What needs states is what balls need time for: a cage with mass and all else that is refused without states, lubrication that changes, a start from
//! rest, loads too light to drive the balls, and couples that friction does not hold. All else goes without.

use toml::{Table, Value};

use super::corners::{Corner, corners};
use super::estimate::{EstimateError, MOST_OF_SHAFT, judged_scene, on_shaft, times_of};
use crate::effects::cage::USUAL_CLEARANCE;
use crate::effects::estimate::{Estimate, digits, percent};
use crate::scene::Schedule;
use crate::scene::system::{MountedScene, SystemScene};
use crate::simulation::Simulation;
use crate::simulation::system::InBalance;

/// [-] load over the dynamic load rating below which balls may skid: the least load that makers ask of ball bearings.
const LIGHT: f64 = 0.01;
/// [-] gyroscopic moment over what friction holds, above which balls may spin by it: half, for what the speed does until then.
const HELD: f64 = 0.5;

/// The scene with the level of those bearings that ask for it, as if it had been written so, and what was done, a sentence each; for an
/// importer within the ranges that it and its scripts give, if it is `known` by them what will act.
///
/// # Errors
/// If the machine has no equilibrium, or cannot be read with these levels.
pub fn resolve(
    mut scene: SystemScene,
    for_importer: bool,
    known: bool,
) -> Result<(SystemScene, Vec<String>), EstimateError> {
    let asks: Vec<bool> = scene.bearings.iter().map(|mounted| mounted.finds_level).collect();
    with_states(&mut scene);
    // Of those that do not ask nothing is looked for.
    let reason = |(mounted, asks): (&MountedScene, &bool)| {
        if *asks { written(mounted, known) } else { Some(String::new()) }
    };
    let mut reasons: Vec<Option<String>> = scene.bearings.iter().zip(&asks).map(reason).collect();
    look(&scene, "", &mut reasons)?;
    let read = |text: &str| {
        let mut scene = SystemScene::of_package(text)?;
        with_states(&mut scene);
        Ok(scene)
    };
    let ranges = (&scene.ranges, MOST_OF_SHAFT);
    let corners = for_importer.then(|| corners((&scene, &scene.source), ranges, read, SystemScene::acting));
    for Corner { scene, place } in corners.into_iter().flatten() {
        // What cannot be has nothing to say.
        let _ = look(&scene, &place, &mut reasons);
    }
    let names = scene.bearings.iter().map(|mounted| mounted.name.as_str());
    let levels =
        names.zip(reasons).zip(asks).filter(|(_, asks)| *asks).map(|((name, reason), _)| match reason {
            Some(why) => (name, "dynamic", why),
            None => (name, "equilibrium", "nothing needs states".to_owned()),
        });
    let levels: Vec<_> = levels.collect();
    let unread = |why: &dyn std::fmt::Display| EstimateError::Start(why.to_string());
    let mut table: Table = toml::from_str(&scene.source).map_err(|why| unread(&why))?;
    let all = table.get_mut("bearing").and_then(Value::as_array_mut).into_iter().flatten();
    for keys in all.filter_map(Value::as_table_mut) {
        let own = keys.get("name").and_then(Value::as_str);
        if let Some((_, level, _)) = levels.iter().find(|(name, ..)| own == Some(name)) {
            keys.insert("level".into(), (*level).into());
        }
    }
    let mut found = SystemScene::of_package(&table.to_string()).map_err(|why| unread(&why))?;
    let mut notes = vec![];
    for (name, level, why) in levels {
        let note = format!("auto: level = \"{level}\": {why}");
        notes.push(format!("bearing {name}: {note}"));
        // Summaries and packages have it beside the effects that were found.
        if let Some(mounted) = found.bearings.iter_mut().find(|mounted| mounted.name == name) {
            let all = [mounted.scene.effects.auto.found.clone(), vec![note]].concat();
            mounted.scene.settle_effects(&[], &all);
        }
    }
    found.renew_source();
    Ok((found, notes))
}

/// All bearings have the level that they are read with, for as long as it is looked for.
fn with_states(scene: &mut SystemScene) {
    scene.bearings.iter_mut().for_each(|mounted| mounted.finds_level = false);
}

/// Why a bearing needs states by what is written of it.
fn written(mounted: &MountedScene, known: bool) -> Option<String> {
    let scene = &mounted.scene;
    let changes = |schedule: Option<&Schedule>| schedule.is_some_and(Schedule::is_scripted);
    if let Some(key) = mounted.needs_states() {
        return Some(format!("{key} needs them"));
    }
    if changes(scene.effects.film.schedule()) || changes(Some(&scene.friction.ball_race)) {
        return Some("its lubrication changes".into());
    }
    (!known).then(|| "an importer may set loads and speeds, of which the scene gives no range".into())
}

/// Adds why bearings need states by where the machine is in balance, at the start and at all kinks of what acts.
fn look(scene: &SystemScene, place: &str, reasons: &mut [Option<String>]) -> Result<(), EstimateError> {
    let times = times_of(scene.schedules(), scene.load.duration.0);
    for (number, time) in [0.0].into_iter().chain(times).enumerate() {
        let system = match InBalance::new(scene, time) {
            Ok(system) => system,
            Err(why) if number == 0 => return Err(EstimateError::Start(why.to_string())),
            // Where there is no equilibrium, the other times tell.
            Err(_) => continue,
        };
        for (index, (mounted, reason)) in scene.bearings.iter().zip(&mut *reasons).enumerate() {
            if reason.is_some() {
                continue;
            }
            let bearing = system.with(index, &judged_scene(&mounted.scene));
            let bearing = bearing.map_err(|why| EstimateError::Start(why.to_string()))?;
            *reason = acting(&bearing).map(|why| match (place.is_empty(), time) {
                (true, 0.0) => why,
                (true, _) => format!("{why}, at {} ms", digits(1e3 * time)),
                (false, _) => format!("{why}, {place}"),
            });
        }
    }
    Ok(())
}

/// Why a bearing in balance needs states.
fn acting(bearing: &Simulation) -> Option<String> {
    let estimate = match on_shaft(bearing) {
        Ok(estimate) => Estimate { power: bearing.outputs().losses.total(), ..estimate },
        Err(why) => return Some(why.to_string()),
    };
    let Estimate { spacing, rings, .. } = &estimate;
    if spacing.from_rest {
        return Some("it starts from rest".into());
    }
    if rings[0].speed == rings[1].speed {
        return Some("its races stand against each other".into());
    }
    let gyroscopic = estimate.gyroscopic();
    if gyroscopic > HELD {
        return Some(format!(
            "friction holds the gyroscopic moment of a ball by {} alone",
            percent(1.0 / gyroscopic)
        ));
    }
    let life = bearing.outputs().life.as_ref().map(|life| life.reference);
    if let Some(load) = life.map(|life| life.cbrt().recip()).filter(|load| *load < LIGHT) {
        return Some(format!("it carries {} of C: balls may skid below {}", percent(load), percent(LIGHT)));
    }
    let held = estimate.held_back(USUAL_CLEARANCE * 2.0 * estimate.ball_radius);
    // What is no number is no small part.
    if held < estimate.threshold {
        return None;
    }
    let part = if held.is_finite() {
        format!(", by {} of all losses without it", percent(held))
    } else {
        String::new()
    };
    Some(format!("a cage would hold balls back{part}"))
}
