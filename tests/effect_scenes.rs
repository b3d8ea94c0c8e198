//! Scenes of `scenes/effects`: each says what it is for, and runs to its end.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::path::Path;

use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};

/// Texts of the scenes by their names.
fn scenes() -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/effects");
    let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    scenes
        .map(|path| {
            let name = path.file_stem().unwrap().to_str().unwrap().to_string();
            (name, std::fs::read_to_string(&path).unwrap())
        })
        .collect()
}

#[test]
fn every_scene_says_its_purpose_and_runs_with_finite_numbers() {
    let scenes = scenes();
    assert!(scenes.len() >= 4, "{:?}", scenes.keys());
    for (name, text) in scenes {
        let purpose = text.lines().next().unwrap().strip_prefix("# Purpose: ");
        assert!(purpose.is_some_and(|purpose| purpose.len() > 40 && purpose.ends_with('.')), "{name}");
        let scene = Scene::parse(&text).unwrap_or_else(|why| panic!("{name}: {why}"));
        let rows = Variables::moving(&scene, true);
        let mut simulation = Simulation::new(&scene).unwrap_or_else(|why| panic!("{name}: {why}"));
        let span = Rows::of(&simulation);
        let played = play(&mut simulation, span, |simulation| {
            for (row, value) in rows.rows().iter().zip(rows.values(simulation.inputs(), simulation.outputs()))
            {
                assert!(value.is_finite(), "{name}: {} = {value}", row.name);
            }
            std::ops::ControlFlow::<()>::Continue(())
        });
        assert!(played.unwrap_or_else(|why| panic!("{name}: {why}")).is_continue());
        let outputs = simulation.outputs();
        assert_eq!(outputs.time, scene.load.duration.0, "{name}");
        let turned_over = outputs.work.abs().max(outputs.dissipated);
        assert!(turned_over > 0.0, "{name}: nothing moved");
    }
}
