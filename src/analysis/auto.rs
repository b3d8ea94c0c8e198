//! `effects.auto`: switches on the effects of a scene that matter by their estimates and have all the data they need.

use super::estimate::{self, EstimateError, Verdicts};
use super::level;
use crate::effects::estimate::{Standing, Verdict};
use crate::model::Model;
use crate::scene::machine::MachineScene;
use crate::scene::system::{MountedScene, SystemScene};
use crate::scene::{Group, Scene, Schedule};
use crate::simulation::scripted_groups;

/// A scene with its effects found out, and what was done, a sentence each.
pub type FoundOut<S> = Result<(S, Vec<String>), EstimateError>;

/// The scene with its effects found out, as if they had been written so, and what was done, a sentence each; the scene as it is where
/// it does not ask for that.
///
/// # Errors
/// If there is no equilibrium to estimate from.
pub fn resolve(mut scene: Scene) -> FoundOut<Scene> {
    if !scene.effects.auto.on {
        return Ok((scene, vec![]));
    }
    let verdicts = estimate::verdicts(&scene, &Model::new(&scene)?);
    let notes = settle(&mut scene, verdicts)?;
    Ok((scene, notes))
}

/// Effects found out of a scene whose inputs an importer may set: within the ranges that it and its scripts give. Where it gives none for loads, poses or
/// speeds nothing is known of them, and effects that can be switched on are.
///
/// # Errors
/// If there is no equilibrium to estimate from.
pub fn resolve_for_importer(mut scene: Scene) -> FoundOut<Scene> {
    if !scene.effects.auto.on {
        return Ok((scene, vec![]));
    }
    let mut verdicts = estimate::verdicts_in_ranges(&scene);
    let groups = [Group::Loads, Group::Speeds, Group::Tilts];
    let scripted = groups.into_iter().any(|group| scripted_groups(&scene).contains(group));
    if scene.ranges.is_empty() && !scripted {
        take_all(&mut verdicts);
    }
    let notes = settle(&mut scene, verdicts)?;
    Ok((scene, notes))
}

/// Effects and levels found out of the bearings of a shaft that ask for it, by the settled states of the whole shaft; for an importer, who may set loads and
/// speeds, within the ranges that it and its scripts give, and all that can be switched on where nothing gives these.
///
/// # Errors
/// If there is no equilibrium to estimate from.
pub fn resolve_shaft(mut scene: SystemScene, for_importer: bool) -> FoundOut<SystemScene> {
    let asks = |mounted: &MountedScene| mounted.scene.effects.auto.on;
    let known = !for_importer || !scene.ranges.is_empty() || scene.schedules().any(Schedule::is_scripted);
    let mut notes = vec![];
    if scene.bearings.iter().any(asks) {
        let mut written = scene.clone();
        written.bearings.iter_mut().for_each(|mounted| mounted.scene.effects.auto.on = false);
        let all = match for_importer {
            true => estimate::verdicts_of_shaft_in_ranges(&written),
            false => estimate::verdicts_of_shaft(&written),
        };
        let asking = scene.bearings.iter_mut().zip(all).filter(|(mounted, _)| asks(mounted));
        for (mounted, mut verdicts) in asking {
            if !known {
                take_all(&mut verdicts);
            }
            let own = settle(&mut mounted.scene, verdicts)?;
            notes.extend(own.into_iter().map(|note| format!("bearing {}: {note}", mounted.name)));
        }
        scene.renew_source();
    }
    if scene.bearings.iter().any(|mounted| mounted.finds_level) {
        let (found, own) = level::resolve(scene, for_importer, known)?;
        (scene, notes) = (found, [notes, own].concat());
    }
    Ok((scene, notes))
}

/// Effects found out of whatever a scene describes.
///
/// # Errors
/// If there is no equilibrium to estimate from.
pub fn resolve_machine(scene: MachineScene, for_importer: bool) -> FoundOut<MachineScene> {
    Ok(match scene {
        MachineScene::Bearing(scene) => {
            let (scene, notes) = if for_importer { resolve_for_importer(*scene) } else { resolve(*scene) }?;
            (scene.into(), notes)
        }
        MachineScene::Shaft(scene) => {
            let (scene, notes) = resolve_shaft(*scene, for_importer)?;
            (scene.into(), notes)
        }
    })
}

/// All that can be switched on matters: nothing is known of what will act.
fn take_all(verdicts: &mut Verdicts) {
    let all = verdicts.iter_mut().flatten();
    for verdict in all.filter(|verdict| verdict.auto.is_some() && !verdict.matters) {
        verdict.matters = true;
        verdict.sentence += "; an importer may set loads and speeds, of which the scene gives no range";
    }
}

/// Writes what verdicts say into a scene; what was done, a sentence each.
fn settle(scene: &mut Scene, verdicts: Verdicts) -> Result<Vec<String>, EstimateError> {
    let verdicts = match verdicts {
        Ok(verdicts) => verdicts,
        Err(why @ EstimateError::Unloaded) => {
            let notes = vec![format!("auto: nothing is switched: {why}")];
            scene.settle_effects(&[], &notes);
            return Ok(notes);
        }
        Err(why) => return Err(why),
    };
    let given = &scene.effects.auto.given;
    let is_given = |key: &str| key.strip_prefix("effects.").is_some_and(|key| given.contains(&key));
    let switched = |verdict: &Verdict| {
        let key = verdict.auto.filter(|key| !is_given(key))?;
        let on = verdict.standing == Standing::On;
        // What a section of its own has switched on stays.
        let leaves = on && !verdict.matters && key.starts_with("effects.");
        (leaves || !on && verdict.matters).then_some((key, verdict.matters))
    };
    let switches: Vec<_> = verdicts.iter().filter_map(switched).collect();
    let sentences = verdicts.iter().filter(|verdict| switched(verdict).is_some()).map(|verdict| {
        let key = verdict.auto.unwrap_or_default();
        format!("auto: {key} = {}: {}", verdict.matters, verdict.sentence)
    });
    let mut notes: Vec<String> = sentences.collect();
    if notes.is_empty() {
        notes.push("auto: no effect is switched".into());
    }
    let lacking: Vec<&str> = verdicts
        .iter()
        .filter(|verdict| verdict.is_missed() && switched(verdict).is_none())
        .map(|verdict| verdict.subject)
        .collect();
    if !lacking.is_empty() {
        let lacking = lacking.join(", ");
        notes.push(format!("auto: would matter and cannot be switched on with the data at hand: {lacking}"));
    }
    scene.settle_effects(&switches, &notes);
    Ok(notes)
}
