//! `effects.auto`: switches on the effects of a scene that matter by their estimates and have all the data they need.

use super::estimate::{self, EstimateError};
use crate::effects::estimate::{Standing, Verdict};
use crate::model::Model;
use crate::scene::Scene;

/// The scene with its effects found out, as if they had been written so, and what was done, a sentence each; the scene as it is where
/// it does not ask for that.
///
/// # Errors
/// If there is no equilibrium to estimate from.
pub fn resolve(mut scene: Scene) -> Result<(Scene, Vec<String>), EstimateError> {
    if !scene.effects.auto.on {
        return Ok((scene, vec![]));
    }
    let verdicts = match estimate::verdicts(&scene, &Model::new(&scene)?) {
        Ok(verdicts) => verdicts,
        Err(why @ EstimateError::Unloaded) => {
            scene.settle_effects(&[]);
            return Ok((scene, vec![format!("auto: nothing is switched: {why}")]));
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
    scene.settle_effects(&switches);
    Ok((scene, notes))
}
