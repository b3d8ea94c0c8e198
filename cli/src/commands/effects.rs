//! `roulement effects`: which effects a scene has, and which matter there.

use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use roulement::analysis::estimate::{self, Verdicts};
use roulement::effects::estimate::{Standing, Verdict, digits, missed};
use roulement::effects::shoulder::SUBJECT as SHOULDERS;
use roulement::model::Model;
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement_cli::report::json;
use serde_json::{Map, Value};

use super::{load, say, tell};

/// Options of `roulement effects`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Lists the effects of a scene with their estimates.
///
/// # Errors
/// If the scene cannot be read, or there is no equilibrium to estimate from.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let scene = match load(&options.scene)? {
        MachineScene::Bearing(scene) => {
            let verdicts = estimate::verdicts(&scene, &Model::new(&scene)?)?;
            let text = match options.json {
                true => format!("{:#}\n", json::effects(&scene, &verdicts)?),
                false => to_text(&scene.title, UNDER_SCRIPTS, &scene, &verdicts),
            };
            return Ok(say(&text)?);
        }
        scene @ MachineScene::Shaft(_) => scene,
    };
    let machine = Machine::new(&scene)?;
    let mut values = Map::new();
    let mut text = String::new();
    for ((name, bearing), verdicts) in machine.bearings().zip(verdicts(&machine)) {
        let (scene, verdicts) =
            (bearing.scene(), verdicts.map_err(|why| format!("bearing \"{name}\": {why}"))?);
        values.insert(name.to_string(), json::effects(scene, &verdicts)?);
        let title = format!("bearing {name}");
        text += &format!("{}\n", to_text(&title, UNDER_SHAFT, scene, &verdicts));
    }
    if options.json {
        text = format!("{:#}", Value::Object(values));
    }
    Ok(say(&format!("{}\n", text.trim_end_matches('\n')))?)
}

/// What estimates of a bearing alone are of.
const UNDER_SCRIPTS: &str =
    "estimates of the equilibrium at the start, every race at the largest speed of its script";
/// What those of a bearing on a shaft are of.
const UNDER_SHAFT: &str = "estimates of the equilibrium at the start, where shaft and housings put its races";

/// What estimates say of the effects of every bearing of a machine that was just started.
pub fn verdicts(machine: &Machine) -> Vec<Verdicts> {
    let of = |bearing: &Simulation| match machine {
        Machine::Bearing(_) => estimate::verdicts(bearing.scene(), bearing.model()),
        Machine::Shaft(_) => {
            estimate::verdicts_under(bearing.scene(), bearing.model(), &bearing.equilibrium_input())
        }
    };
    machine.bearings().map(|(_, bearing)| of(bearing)).collect()
}

/// Says what is on, and what is off and would matter; nothing more where nothing can be estimated but why. The name of a bearing that is
/// not alone stands before it.
pub fn announce(name: &str, scene: &Scene, verdicts: &Verdicts) {
    let lines = match verdicts {
        Ok(verdicts) => missed(verdicts),
        Err(why) => vec![why.to_string()],
    };
    let before = if name.is_empty() { String::new() } else { format!("bearing {name}: ") };
    let all = [scene.effects.simulated()].into_iter().chain(lines);
    tell(all.map(|line| format!("{before}{line}")));
}

/// What was on in a run and did not matter, a line each; `cut` tells whether a shoulder cut a contact in it.
pub fn idle_in(verdicts: &Verdicts, cut: bool) -> Vec<String> {
    let idle = verdicts
        .iter()
        .flatten()
        .filter(|verdict| verdict.is_idle() && !(cut && verdict.subject == SHOULDERS));
    idle.map(|verdict| format!("{}: {}", verdict.subject, verdict.sentence)).collect()
}

/// Groups of the table: heading, and what is in it.
type InGroup = fn(&Verdict) -> bool;
const GROUPS: [(&str, InGroup); 6] = [
    ("on, and matters", |v| v.standing == Standing::On && v.matters),
    ("on, and does not matter", Verdict::is_idle),
    ("off, and would matter", |v| v.standing == Standing::Off && v.matters),
    ("off, and would not matter", |v| v.standing == Standing::Off && !v.matters),
    ("simulated in every scene", |v| v.standing == Standing::Always),
    ("not simulated by any effect yet", |v| v.standing == Standing::Missing),
];

fn to_text(title: &str, of: &str, scene: &Scene, verdicts: &[Verdict]) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_text(&mut text, title, of, scene, verdicts);
    text
}

fn write_text(
    out: &mut String,
    title: &str,
    of: &str,
    scene: &Scene,
    verdicts: &[Verdict],
) -> std::fmt::Result {
    if !title.is_empty() {
        writeln!(out, "{title}")?;
    }
    writeln!(out, "{}", scene.effects.simulated())?;
    writeln!(out, "{of}")?;
    for (heading, is_in) in GROUPS {
        let of: Vec<_> = verdicts.iter().filter(|verdict| is_in(verdict)).collect();
        if of.is_empty() {
            continue;
        }
        writeln!(out, "\n{heading}")?;
        for verdict in of {
            let unit = if verdict.unit.is_empty() { String::new() } else { format!(" {}", verdict.unit) };
            let value = format!("{}{unit}", digits(verdict.value));
            let against = if verdict.threshold.is_finite() {
                format!(
                    "matters {} {}",
                    if verdict.unit == "rad" { "under" } else { "over" },
                    digits(verdict.threshold)
                )
            } else {
                String::new()
            };
            writeln!(out, "  {:<25} {value:>9}  {against:<20}  {}", verdict.subject, verdict.sentence)?;
            if verdict.standing == Standing::Off && verdict.matters {
                writeln!(out, "  {:<58}  write {}", "", verdict.write)?;
            }
        }
    }
    Ok(())
}
