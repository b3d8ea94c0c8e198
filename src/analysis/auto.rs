//! `effects.auto`: switches on the effects of a scene that matter by their estimates and have all the data they need.

use super::estimate::{self, EstimateError, Verdicts};
use crate::effects::estimate::{Standing, Verdict};
use crate::model::Model;
use crate::scene::{Group, Scene};
use crate::simulation::scripted_groups;

/// The scene with its effects found out, as if they had been written so, and what was done, a sentence each; the scene as it is where
/// it does not ask for that.
///
/// # Errors
/// If there is no equilibrium to estimate from.
pub fn resolve(scene: Scene) -> Result<(Scene, Vec<String>), EstimateError> {
    resolve_by(scene, |scene| estimate::verdicts(scene, &Model::new(scene)?))
}

/// The same of a scene whose inputs an importer may set: within the ranges that its scripts give. Where it gives none for loads, poses or
/// speeds nothing is known of them, and effects that can be switched on are.
///
/// # Errors
/// If there is no equilibrium to estimate from.
pub fn resolve_for_importer(scene: Scene) -> Result<(Scene, Vec<String>), EstimateError> {
    resolve_by(scene, |scene| {
        let mut verdicts = estimate::verdicts_in_ranges(scene)?;
        let groups = [Group::Loads, Group::Speeds, Group::Tilts];
        if !groups.into_iter().any(|group| scripted_groups(scene).contains(group)) {
            for verdict in verdicts.iter_mut().filter(|verdict| verdict.auto.is_some() && !verdict.matters) {
                verdict.matters = true;
                verdict.sentence +=
                    "; an importer may set loads and speeds, of which the scene gives no range";
            }
        }
        Ok(verdicts)
    })
}

fn resolve_by(
    mut scene: Scene,
    verdicts: impl Fn(&Scene) -> Verdicts,
) -> Result<(Scene, Vec<String>), EstimateError> {
    if !scene.effects.auto.on {
        return Ok((scene, vec![]));
    }
    let verdicts = match verdicts(&scene) {
        Ok(verdicts) => verdicts,
        Err(why @ EstimateError::Unloaded) => {
            let notes = vec![format!("auto: nothing is switched: {why}")];
            scene.settle_effects(&[], &notes);
            return Ok((scene, notes));
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
    let said = verdicts.iter().filter(|verdict| switched(verdict).is_some()).map(|verdict| {
        let key = verdict.auto.unwrap_or_default();
        format!("auto: {key} = {}: {}", verdict.matters, verdict.sentence)
    });
    let mut notes: Vec<String> = said.collect();
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
    Ok((scene, notes))
}
