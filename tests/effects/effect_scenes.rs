//! Scenes of `scenes/effects`: each says what it is for, and runs to its end with finite numbers and its energy in balance.

use std::path::{Path, PathBuf};

use roulement::effects::Effects;
use roulement::interface::variables::Variables;
use roulement::scene::{Level, Scene};
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};

/// Scenes by their paths, in order.
fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(roulement_tests::ROOT).join("scenes/effects");
    let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let mut paths: Vec<_> =
        files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    paths.sort();
    paths
}

#[test]
fn every_scene_says_its_purpose_and_runs_with_finite_numbers_and_its_energy_in_balance() {
    let paths = scenes();
    assert!(paths.len() >= 8, "{paths:?}");
    for path in paths {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let purpose = text.lines().next().unwrap().strip_prefix("# ");
        assert!(purpose.is_some_and(|purpose| purpose.len() > 40 && purpose.ends_with('.')), "{name}");
        let scene = Scene::load(&path).unwrap_or_else(|why| panic!("{name}: {why}"));
        let rows = Variables::moving(&scene, true);
        let mut simulation = Simulation::new(&scene).unwrap_or_else(|why| panic!("{name}: {why}"));
        let stored = simulation.outputs().stored_energy;
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
        // Equilibria count no work.
        if scene.solver.level == Level::Equilibrium {
            continue;
        }
        let turned_over = outputs.work.abs().max(outputs.dissipated);
        assert!(turned_over > 0.0, "{name}: nothing moved");
        let imbalance = (outputs.stored_energy - stored + outputs.dissipated - outputs.work).abs();
        let size = turned_over + stored;
        println!(
            "{name}: {} steps, imbalance {:.1e} of {size:.2e} J",
            outputs.statistics.steps,
            imbalance / size
        );
        assert!(imbalance < 1e-3 * size, "{name}: {imbalance:e} of {size:e} J");
    }
}

#[test]
fn every_effect_is_on_in_one_of_these_scenes() {
    let scenes: Vec<Scene> = scenes().iter().map(|path| Scene::load(path).unwrap()).collect();
    for effect in Effects::default().each() {
        let key = effect.info().key;
        let is_on = |scene: &Scene| {
            scene.effects.each().iter().any(|other| other.info().key == key && other.setting().is_some())
        };
        assert!(scenes.iter().any(is_on), "no scene of scenes/effects has {key}");
    }
}
