//! Plays the first milliseconds of a scene and prints how many steps it took: `scene_steps SCENE.toml MILLISECONDS [EFFECT]`, with
//! the example of an effect (by its key) in the scene if one is named. A scene of a shaft also tells how many coordinates its structures
//! have. `scripts/measure step-instructions` and `scripts/measure shaft-cost` count the instructions of these.

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use roulement::effects::Effects;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};
use roulement::simulation::system::System;
use toml::{Table, Value};

/// Adds a part of a scene to it.
fn join(scene: &mut Table, part: Table) {
    for (key, value) in part {
        match (scene.get_mut(&key), value) {
            (Some(Value::Table(there)), Value::Table(more)) => join(there, more),
            (_, value) => drop(scene.insert(key, value)),
        }
    }
}

/// The scene with an effect on.
fn with(text: &str, key: &str) -> Result<String, Box<dyn Error>> {
    let effects = Effects::default();
    let list = effects.each();
    let Some(effect) = list.iter().find(|effect| effect.info().key == key) else {
        let keys: Vec<_> = list.iter().map(|effect| effect.info().key).collect();
        return Err(format!("no effect has the key {key}; there are {}", keys.join(", ")).into());
    };
    let mut scene: Table = text.parse()?;
    join(&mut scene, effect.info().example.parse()?);
    Ok(scene.to_string())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (scene, milliseconds, effect) = match &arguments[..] {
        [scene, milliseconds] => (scene, milliseconds, None),
        [scene, milliseconds, effect] => (scene, milliseconds, Some(effect)),
        _ => return Err("usage: scene_steps SCENE.toml MILLISECONDS [EFFECT]".into()),
    };
    let mut text = std::fs::read_to_string(scene)?;
    if let Some(key) = effect {
        text = with(&text, key)?;
    }
    if SystemScene::is_system(&text) {
        let mut system = System::new(&SystemScene::load(Path::new(scene))?)?;
        system.advance(milliseconds.parse::<f64>()? * 1e-3)?;
        let steps = system.bearings().next().map_or(0, |(_, bearing)| bearing.state().statistics.steps);
        println!("{steps} {}", system.shafts()[0].structure.size());
        return Ok(());
    }
    let scene = Scene::edited(&text, [("load.duration", format!("\"{milliseconds} ms\""))])?;
    let mut simulation = Simulation::new(&scene)?;
    let rows = Rows::of(&simulation);
    let _: ControlFlow<()> = play(&mut simulation, rows, |_| ControlFlow::Continue(()))?;
    println!("{}", simulation.state().statistics.steps);
    Ok(())
}
