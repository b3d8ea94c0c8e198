//! The scenes of the effects: each says what it is for, starts in balance, runs, and keeps its energy.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use roulement::scene::{Level, Scene};
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/effects");
    let mut scenes: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    scenes.sort();
    scenes
}

#[test]
fn every_scene_of_an_effect_says_what_it_is_for_and_runs() {
    let mut count = 0;
    for path in scenes() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let purpose = text.lines().next().unwrap();
        assert!(
            purpose.starts_with("# ") && purpose.ends_with('.') && purpose.len() > 40,
            "{name}: {purpose}"
        );
        let scene = Scene::load(&path).unwrap_or_else(|why| panic!("{name}: {why}"));
        let mut simulation = Simulation::new(&scene).unwrap_or_else(|why| panic!("{name}: {why}"));
        let first = simulation.outputs().clone();
        let rows = Rows::of(&simulation);
        let mut turned_over = 0.0;
        let mut work = first.work;
        let played = play(&mut simulation, rows, |simulation| {
            let outputs = simulation.outputs();
            turned_over += (outputs.work - work).abs();
            work = outputs.work;
            assert!(outputs.inner.wrench.force.iter().all(|force| force.is_finite()), "{name}");
            std::ops::ControlFlow::<()>::Continue(())
        });
        let _ = played.unwrap_or_else(|why| panic!("{name}: {why}"));
        assert!((simulation.time() / scene.load.duration.0 - 1.0).abs() < 1e-12, "{name}");
        let last = simulation.outputs();
        if scene.solver.level == Level::Dynamic {
            let open = last.work - last.dissipated - (last.stored_energy - first.stored_energy);
            let size = turned_over + last.dissipated;
            println!("{name}: energy open by {:.1e}", open.abs() / size);
            assert!(open.abs() < 1e-2 * size, "{name}: {open} of {size} J");
        }
        count += 1;
    }
    assert!(count >= 6, "{count}");
}
