//! Corners of the ranges of what an importer may set: those that a scene gives by its section `[ranges]`, and those of its scripts.

use crate::scene::ranges::without;
use crate::scene::{Ranges, SceneError, Schedule};

/// A scene in which all that acts is at one end of its range.
pub(super) struct Corner<S> {
    /// The scene.
    pub scene: S,
    /// Where it is, in words.
    pub place: String,
}

/// All corners of the ranges of a scene with this text that can be read: those of its keys, and those of its scripts, as long as all are not more
/// than `most`. `read` reads a text, `acting` finds the schedules of what acts.
pub(super) fn corners<S: Clone>(
    (scene, text): (&S, &str),
    (ranges, most): (&Ranges, usize),
    read: impl Fn(&str) -> Result<S, SceneError>,
    acting: impl Fn(&mut S) -> Vec<&mut Schedule>,
) -> Vec<Corner<S>> {
    // They were found to be right when the scene was read.
    let given = ranges.all().unwrap_or_default();
    let at = |bits: usize| -> Option<(S, String)> {
        if given.is_empty() {
            return Some((scene.clone(), String::new()));
        }
        let ends =
            given.iter().enumerate().map(|(k, one)| (one.key.as_str(), one.ends[bits >> k & 1].as_str()));
        let place = ends.clone().map(|(key, end)| format!("{key} = {}", end.trim_matches('"')));
        let place = place.collect::<Vec<_>>().join(", ");
        Some((read(&without(text, ends).ok()?).ok()?, place))
    };
    let mut all = vec![];
    for (mut scene, place) in (0..1 << given.len()).filter_map(at) {
        // A key that has a range is no script there.
        let scripted: Vec<usize> = acting(&mut scene)
            .iter()
            .enumerate()
            .filter(|(_, one)| one.is_scripted())
            .map(|(k, _)| k)
            .collect();
        let scripted = &scripted[..scripted.len().min(most.saturating_sub(given.len()))];
        for bits in 0..1usize << scripted.len() {
            let mut there = scene.clone();
            let mut schedules = acting(&mut there);
            for (k, index) in scripted.iter().enumerate() {
                let end = if bits >> k & 1 == 0 { f64::min } else { f64::max };
                let value = schedules[*index].values().into_iter().reduce(end);
                *schedules[*index] = Schedule::Constant(value.unwrap_or(0.0));
            }
            let place = match (place.is_empty(), scripted.is_empty()) {
                (true, true) => continue,
                (true, false) => "at a corner of the ranges of the scripts".to_string(),
                (false, true) => format!("at {place}"),
                (false, false) => format!("at {place} and a corner of the ranges of the scripts"),
            };
            all.push(Corner { scene: there, place });
        }
    }
    all
}
