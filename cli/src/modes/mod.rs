//! Small motions of a machine about its running state, over the speed: which grow, which decay.

mod figure;
mod table;

use roulement::scene::Schedule;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::{Machine, MachineError};
use roulement::simulation::motions::Motion;
use roulement::simulation::system::{at_speed, largest_speed};

pub use figure::write as write_figure;
pub use table::{to_csv, to_json, to_text};

/// [-] largest speed of the scene, that of the table.
const BEYOND: f64 = 1.5;

/// Motions at a speed.
pub struct Row {
    /// [rad/s] speed of the shaft, or of the race that turns fastest.
    pub speed: f64,
    /// By growing frequency; or why there are none.
    pub motions: Result<Vec<Motion>, String>,
}

/// Motions over the speed.
pub struct Modes {
    /// Title of the scene.
    pub title: String,
    /// \[s] how long it ran before they were looked at.
    pub after: f64,
    /// At the speed of the scene.
    pub own: Row,
    /// At other speeds, by growing speed; none where nothing turns.
    pub rows: Vec<Row>,
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// \[s] time of the scene's script.
    pub time: f64,
    /// \[s] how long it runs before motions are looked at.
    pub after: f64,
    /// [rad/s] speed that the table goes up to; 1.5 times that of the scene if not given.
    pub up_to: Option<f64>,
    /// Speeds of the table.
    pub speeds: usize,
}

impl Modes {
    /// Those of a scene.
    ///
    /// # Errors
    /// If the machine cannot start or run at its own speed.
    pub fn of(scene: &MachineScene, asked: &Asked) -> Result<Self, MachineError> {
        let own = speed_of(scene, asked.time);
        let motions = at(scene, asked)?;
        let up_to = asked.up_to.unwrap_or(match scene {
            MachineScene::Bearing(_) => BEYOND * own,
            MachineScene::Shaft(scene) => largest_speed(scene),
        });
        let row = |speed: f64| Row {
            speed,
            motions: match at(&turning(scene, asked.time, speed), asked) {
                Ok(motions) => motions,
                Err(why) => Err(why.to_string()),
            },
        };
        let speeds = if own > 0.0 { asked.speeds } else { 0 };
        let rows = (1..=speeds).map(|k| row(up_to * k as f64 / speeds as f64)).collect();
        let title = match scene {
            MachineScene::Bearing(scene) => scene.title.clone(),
            MachineScene::Shaft(scene) => scene.title.clone(),
        };
        Ok(Self { title, after: asked.after, own: Row { speed: own, motions }, rows })
    }
}

/// What those grow that do, in a sentence each: what whoever runs this machine should know.
pub fn warnings(machine: &Machine) -> Vec<String> {
    let mut growing: Vec<Motion> = machine.motions().unwrap_or_default();
    growing.retain(Motion::grows);
    growing.sort_by(|a, b| b.growth.total_cmp(&a.growth));
    let rest = growing.len().saturating_sub(1);
    let others = if rest > 0 { format!(" (and {rest} more)") } else { String::new() };
    let first = growing.first();
    first.map(|Motion { frequency, growth, shape, .. }| {
        format!("a motion grows: {shape}, {frequency:.2} Hz, growth {growth:.1} 1/s{others}; `roulement modes` has all")
    })
    .into_iter()
    .collect()
}

/// Motions of a scene that has run for a while.
fn at(scene: &MachineScene, asked: &Asked) -> Result<Result<Vec<Motion>, String>, MachineError> {
    let mut machine = Machine::starting_at(scene, asked.time)?;
    if asked.after > 0.0 {
        let end = asked.time + asked.after;
        match &mut machine {
            Machine::Bearing(bearing) => bearing.advance_scripted(end)?,
            Machine::Shaft(system) => system.advance(end)?,
        }
    }
    let none = "no eigenvalues were found, or the frame of the bearing moves";
    Ok(machine.motions().ok_or_else(|| none.to_string()))
}

/// [rad/s] speed of a machine at a time \[s].
fn speed_of(scene: &MachineScene, time: f64) -> f64 {
    match scene {
        MachineScene::Bearing(scene) => {
            let load = &scene.load;
            load.inner_speed.at(time).abs().max(load.outer_speed.at(time).abs())
        }
        MachineScene::Shaft(scene) => {
            let scripted = scene.shaft.speed.as_ref().map(|speed| speed.at(time));
            scripted.or(scene.shaft.start_speed.map(|speed| speed.0)).unwrap_or(0.0).abs()
        }
    }
}

/// The scene with another speed; both races of a bearing turn as fast against each other as before.
fn turning(scene: &MachineScene, time: f64, speed: f64) -> MachineScene {
    match scene {
        MachineScene::Bearing(own) => {
            let factor = speed / speed_of(scene, time);
            let mut scene = own.clone();
            for race in [&mut scene.load.inner_speed, &mut scene.load.outer_speed] {
                *race = Schedule::Constant(factor * race.at(time));
            }
            MachineScene::Bearing(scene)
        }
        MachineScene::Shaft(scene) => MachineScene::Shaft(Box::new(at_speed(scene, speed))),
    }
}
