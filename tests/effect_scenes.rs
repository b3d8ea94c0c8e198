//! Every scene of an effect (scenes/effects) says what it is for, runs to its end, and switches its effect on.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use roulement::scene::Scene;
use roulement::simulation::Simulation;

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/effects");
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.sort();
    paths
}

#[test]
fn scenes_of_effects_run_and_keep_their_energy() {
    let paths = scenes();
    assert!(paths.len() >= 4, "{paths:?}");
    for path in paths {
        let text = std::fs::read_to_string(&path).unwrap();
        let purpose = text.lines().next().unwrap();
        assert!(purpose.starts_with("# ") && purpose.ends_with('.'), "{}: {purpose}", path.display());
        let scene = Scene::load(&path).unwrap();
        let mut simulation = Simulation::new(&scene).unwrap();
        let before = simulation.outputs().stored_energy;
        simulation.advance_scripted(scene.load.duration.0).unwrap();
        let after = simulation.outputs();
        let imbalance = (after.stored_energy - before + after.dissipated - after.work).abs();
        let size = after.work.abs() + after.dissipated + before;
        println!(
            "{}: {} steps, imbalance {:.1e} of {size:.2e} J",
            path.file_name().unwrap().to_string_lossy(),
            after.statistics.steps,
            imbalance / size
        );
        assert!(imbalance < 1e-3 * size, "{}: {imbalance:e} of {size:e}", path.display());
    }
}
