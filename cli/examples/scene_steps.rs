//! Plays the first milliseconds of a scene and prints how many steps it took: `scene_steps SCENE.toml MILLISECONDS`.
//! `scripts/step-instructions` counts the instructions of these.

use std::error::Error;
use std::ops::ControlFlow;

use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, milliseconds] = &arguments[..] else {
        return Err("usage: scene_steps SCENE.toml MILLISECONDS".into());
    };
    let text = std::fs::read_to_string(scene)?;
    let scene = Scene::edited(&text, [("load.duration", format!("\"{milliseconds} ms\""))])?;
    let mut simulation = Simulation::new(&scene)?;
    let rows = Rows::of(&simulation);
    let _: ControlFlow<()> = play(&mut simulation, rows, |_| ControlFlow::Continue(()))?;
    println!("{}", simulation.state().statistics.steps);
    Ok(())
}
