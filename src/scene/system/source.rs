//! The text of a system that stands alone: without files and designations, for packages, sweeps and edits.

use toml::{Table, Value};

use super::MountedScene;
use crate::schema::Matrices;

/// The text of a system with the whole scene of every bearing, rollers in place of their designation, and the matrices of its shafts and housings in it; does
/// gravity act?
pub fn standing_alone(
    text: &str,
    (bearings, rollers): (&[MountedScene], &[Option<Table>]),
    of_shafts: &[Option<Matrices>],
    of_housings: &[Option<Matrices>],
    weighs: bool,
) -> String {
    let Ok(mut table) = toml::from_str::<Table>(text) else {
        return text.to_string();
    };
    let put = |into: Option<&mut Value>, matrices: Option<&Matrices>| {
        let matrices = matrices.and_then(|matrices| Value::try_from(matrices).ok());
        if let (Some(keys), Some(matrices)) = (into.and_then(Value::as_table_mut), matrices) {
            keys.insert("matrices".into(), matrices);
        }
    };
    let mut shafts: Vec<&mut Value> = match table.get_mut("shaft") {
        Some(Value::Array(several)) => several.iter_mut().collect(),
        one => one.into_iter().collect(),
    };
    for (keys, matrices) in shafts.iter_mut().zip(of_shafts) {
        put(Some(keys), matrices.as_ref());
    }
    let housings = table.get_mut("housing").and_then(Value::as_array_mut).into_iter().flatten();
    for (keys, matrices) in housings.zip(of_housings) {
        put(Some(keys), matrices.as_ref());
    }
    let written = table.get_mut("bearing").and_then(Value::as_array_mut).into_iter().flatten();
    for (keys, rollers) in written.filter_map(Value::as_table_mut).zip(rollers) {
        if let Some(rollers) = rollers {
            keys.remove("catalogue");
            keys.remove("set");
            keys.insert("rollers".into(), rollers.clone().into());
        }
    }
    write_bearings(&mut table, bearings, weighs);
    table.to_string()
}

/// Puts the scenes of its bearings into the text of a system; `weighs` where the system has gravity.
pub fn write_bearings(table: &mut Table, bearings: &[MountedScene], weighs: bool) {
    let solver = table.contains_key("solver");
    let written = table.get_mut("bearing").and_then(Value::as_array_mut).into_iter().flatten();
    let simulated = written
        .filter_map(Value::as_table_mut)
        .filter(|keys| !keys.contains_key("stiffness") && !keys.contains_key("rollers"));
    for (keys, bearing) in simulated.zip(bearings) {
        keys.remove("catalogue");
        keys.remove("set");
        let mut scene = toml::from_str::<Table>(&bearing.scene.source).unwrap_or_default();
        // What the system says of all its bearings stands there alone: who changes it there changes it.
        if solver {
            scene.remove("solver");
        }
        if let (Some(effects), true) = (scene.get_mut("effects").and_then(Value::as_table_mut), weighs) {
            effects.remove("gravity");
        }
        // The shaft that an outer ring is a part of has its speed.
        if let (Some(load), Some(_)) =
            (scene.get_mut("load").and_then(Value::as_table_mut), bearing.outer_shaft)
        {
            load.remove("outer_speed");
        }
        keys.insert("scene".into(), scene.into());
    }
}
