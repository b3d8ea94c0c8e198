//! `roulement equilibrium`: the quasi-static equilibrium of a bearing, or of a shaft with its bearings and how it swings.

use std::error::Error;
use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use roulement::effects::reports::LifeOutput;
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::model::Model;
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::scene::system::SystemScene;
use roulement::scene::units::{AngularVelocity, Quantity};
use roulement::simulation::system::{MachineEquilibrium, largest_speed};

use roulement_cli::duty::DutyRating;
use roulement_cli::duty::say::with_duty;
use roulement_cli::fits::{Fits, with_fits};
use roulement_cli::modes::warnings;
use roulement_cli::sweep::all::threads;
use serde_json::Value;

use super::field::Moment;
use super::{load, say, tell};

/// Note on races on supports.
const SUPPORTS_LEFT_OUT: &str = "note: displacements are those of one race against the other; flexible supports give way beside them, \
                                 as a run shows from its start";

/// Options of `roulement equilibrium`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    /// How the gyroscopic moment of the balls is carried: outer-race-control if not given, on a shaft friction.
    #[arg(long, value_enum)]
    gyroscopic: Option<GyroscopicChoice>,
    /// Time of the scene's scripts, such as `5 ms`.
    #[arg(long, default_value = "0")]
    time: Moment,
    /// Speed of a shaft that its natural frequencies are given up to, such as `12000 rpm`; 1.5 times the largest of the scene if not
    /// given.
    #[arg(long)]
    up_to: Option<Speed>,
}

/// How the gyroscopic moment of the balls is carried.
#[derive(Clone, Copy, ValueEnum)]
enum GyroscopicChoice {
    /// By friction at the outer race alone, whatever it takes (Jones).
    OuterRaceControl,
    /// By friction at the inner race alone, whatever it takes.
    InnerRaceControl,
    /// By friction at the race where spin would cost more, for each ball.
    LeastHeat,
    /// Ignored.
    None,
    /// By friction at both races, at most the friction limit.
    Friction,
}

impl From<GyroscopicChoice> for Gyroscopic {
    fn from(choice: GyroscopicChoice) -> Self {
        match choice {
            GyroscopicChoice::OuterRaceControl => Self::OuterRaceControl,
            GyroscopicChoice::InnerRaceControl => Self::InnerRaceControl,
            GyroscopicChoice::LeastHeat => Self::LeastHeat,
            GyroscopicChoice::None => Self::None,
            GyroscopicChoice::Friction => Self::Friction,
        }
    }
}

/// [rad/s] a speed above 0, a number or a text with a unit.
#[derive(Clone, Copy, Debug)]
pub struct Speed(pub f64);

impl FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let speed = text.trim().parse().or_else(|_| AngularVelocity::DIMENSION.parse(text.trim()))?;
        if speed > 0.0 && speed <= 1e5 {
            Ok(Self(speed))
        } else {
            Err(format!("{text} is out of range: allowed is (0, 100000] rad/s"))
        }
    }
}

/// What a scene asks for beside its equilibrium: life over its duty, and what the tolerances of its fits leave open.
struct Rated {
    duty: Option<DutyRating>,
    fits: Option<Fits>,
}

/// Solves it and says what is found.
///
/// # Errors
/// If there is no equilibrium.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let Moment(time) = options.time;
    let scene = load(&options.scene)?;
    let rated = Rated { duty: DutyRating::of_scene(&scene, threads())?, fits: Fits::of(&scene, threads())? };
    match scene {
        MachineScene::Bearing(scene) => {
            if options.up_to.is_some() {
                return Err(
                    "--up-to is for a shaft: a bearing alone has no natural frequencies of one".into()
                );
            }
            let gyroscopic = options.gyroscopic.unwrap_or(GyroscopicChoice::OuterRaceControl);
            of_bearing(&scene, time, options.json, gyroscopic.into(), &rated)
        }
        MachineScene::Shaft(scene) => {
            if options.gyroscopic.is_some_and(|choice| !matches!(choice, GyroscopicChoice::Friction)) {
                return Err(
                    "--gyroscopic: on a shaft friction carries the gyroscopic moments of balls".into()
                );
            }
            of_shaft(&scene, time, options.json, options.up_to, &rated)
        }
    }
}

fn of_shaft(
    scene: &SystemScene,
    time: f64,
    json: bool,
    up_to: Option<Speed>,
    rated: &Rated,
) -> Result<(), Box<dyn Error>> {
    let up_to = up_to.map_or_else(|| largest_speed(scene), |Speed(speed)| speed);
    let found = MachineEquilibrium::of(scene, time, up_to)?;
    say_found(json, || found.to_json(), &found, rated)?;
    for (of, mounted) in found.bearings.iter().zip(&scene.bearings) {
        let pressure = mounted.scene.pressure_note(of.peak_pressure());
        let life = of.outputs.life.as_ref().and_then(LifeOutput::warning);
        let bare = |note: String| note.trim_start_matches("warning: ").to_string();
        tell(
            pressure
                .into_iter()
                .chain(life)
                .map(|note| format!("warning: bearing {}: {}", of.name, bare(note))),
        );
    }
    tell_growing(&MachineScene::Shaft(Box::new(scene.clone())), time);
    Ok(())
}

/// Says what grows about it, where something does.
fn tell_growing(scene: &MachineScene, time: f64) {
    tell(warnings(scene, time).into_iter().map(|warning| format!("warning: {warning}")));
}

/// Says an equilibrium, and behind it what else its scene asks for.
fn say_found(
    json: bool,
    as_json: impl FnOnce() -> Value,
    in_words: &impl std::fmt::Display,
    rated: &Rated,
) -> std::io::Result<()> {
    let Rated { duty, fits } = rated;
    if !json {
        let [duty, fits] = [duty.as_ref().map(ToString::to_string), fits.as_ref().map(ToString::to_string)]
            .map(|words| words.map_or(String::new(), |words| format!("\n{words}")));
        return say(&format!("{in_words}{duty}{fits}"));
    }
    say(&format!("{:#}\n", with_fits(with_duty(as_json(), duty.as_ref()), fits.as_ref())))
}

fn of_bearing(
    scene: &Scene,
    time: f64,
    json: bool,
    gyroscopic: Gyroscopic,
    rated: &Rated,
) -> Result<(), Box<dyn Error>> {
    let input = EquilibriumInput::at(scene, gyroscopic, time);
    let model = Model::new(scene)?;
    let solution = equilibrium::solve(&model, &input)?;
    say_found(json, || solution.to_json(), &solution, rated)?;
    tell(scene.pressure_note(solution.peak_pressure(&model)));
    tell(solution.warning());
    tell(solution.life.and_then(|life| life.warning()));
    tell_growing(&scene.clone().into(), time);
    if model.supports.iter().any(Option::is_some) {
        tell([SUPPORTS_LEFT_OUT.to_string()]);
    }
    Ok(())
}
