//! `roulement effects`: which effects a scene has, and which matter there.

use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use roulement::analysis::estimate::{self, Verdicts};
use roulement::effects::estimate::{Standing, Verdict, digits, missed, percent, signed_percent};
use roulement::model::Model;
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement_cli::measure::{self, measure};
use roulement_cli::modes::warnings;
use roulement_cli::report::json;
use roulement_cli::report::limits::Limits;
use roulement_cli::report::shaft::unknown_to_rollers;
use roulement_cli::sweep::all::threads;
use serde_json::{Map, Value};

use super::interrupt::heeded_interrupt;
use super::{load, say, tell, with_count_of_runs};

/// Options of `roulement effects`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Run the scene with and without each effect, instead of estimating what that would change.
    #[arg(long)]
    measure: bool,
    /// Runs at a time, of those to measure; as many as there are cores if not given.
    #[arg(long, value_name = "N", requires = "measure", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

/// Lists the effects of a scene with their estimates.
///
/// # Errors
/// If the scene cannot be read, or there is no equilibrium to estimate from.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    if options.measure {
        return measured(options);
    }
    let scene = match load(&options.scene)? {
        MachineScene::Bearing(scene) => {
            let verdicts = estimate::verdicts(&scene, &Model::new(&scene)?)?;
            let text = match options.json {
                true => format!("{:#}\n", json::effects(&scene, &verdicts)?),
                false => to_text(&scene.title, UNDER_SCRIPTS, &scene, &verdicts),
            };
            say(&text)?;
            tell_growing(&MachineScene::Bearing(scene));
            return Ok(());
        }
        scene @ MachineScene::Shaft(_) => scene,
    };
    let machine = Machine::new(&scene)?;
    let mut values = Map::new();
    let mut text = String::new();
    for ((name, bearing), verdicts) in machine.bearings().zip(estimate::verdicts_of(&machine)) {
        let (scene, verdicts) =
            (bearing.scene(), verdicts.map_err(|why| format!("bearing \"{name}\": {why}"))?);
        values.insert(name.to_string(), json::effects(scene, &verdicts)?);
        let title = format!("bearing {name}");
        text += &format!("{}\n", to_text(&title, UNDER_SHAFT, scene, &verdicts));
    }
    if let MachineScene::Shaft(scene) = &scene {
        text.extend(unknown_to_rollers(scene).map(|sentence| format!("{sentence}\n")));
    }
    if options.json {
        text = format!("{:#}", Value::Object(values));
    }
    Ok(say(&format!("{}\n", text.trim_end_matches('\n')))?)
}

/// Runs with and without each effect, with the progress on stderr.
fn measured(options: &Options) -> Result<(), Box<dyn Error>> {
    let scene = load(&options.scene)?;
    let interrupted = heeded_interrupt()?;
    let jobs = options.jobs.map_or_else(threads, usize::from);
    let measured = with_count_of_runs(|another| measure(&scene, jobs, &interrupted, another))?;
    let text = match options.json {
        true => format!("{:#}\n", measure::to_json(&measured)),
        false => {
            let heading =
                "runs of the scene without and with each, and again with half the steps: change +- error bar";
            format!("{}\n{heading}\n\n{}", scene.title(), measure::to_text(&measured))
        }
    };
    say(&text)?;
    tell_growing(&scene);
    Ok(())
}

/// Says what grows, where something does: then changes are those of what a disturbance becomes, and not of what it is.
fn tell_growing(scene: &MachineScene) {
    let growing = warnings(scene, 0.0);
    let what_then = "warning: what disturbs this scene, such as gravity or waves, starts that motion: settled states know nothing of it, and runs are of it";
    let more = (!growing.is_empty()).then(|| what_then.to_string());
    tell(growing.iter().map(|warning| format!("warning: {warning}")).chain(more));
}

/// States that estimates of a bearing alone are of.
const UNDER_SCRIPTS: &str =
    "settled states at the start with and without each, every race at the largest speed of its script";
/// States that those of a bearing on a shaft are of.
const UNDER_SHAFT: &str = "settled states at the start with and without each, the whole shaft in balance";

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

/// Effects that were on in a run and did not matter, a line each; but for those whose limit it met.
pub fn idle_in(verdicts: &Verdicts, limits: &Limits) -> Vec<String> {
    let met: Vec<_> = limits.met().filter_map(|limit| limit.subject).collect();
    let idle =
        verdicts.iter().flatten().filter(|verdict| verdict.is_idle() && !met.contains(&verdict.subject));
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

/// Cost of an effect in words.
fn price(scene: &Scene, verdict: &Verdict) -> String {
    let is_own = |key: &str| verdict.key.is_some_and(|own| own == key || own.starts_with(&format!("{key}.")));
    let price = scene.effects.each().into_iter().find(|effect| is_own(effect.info().key));
    price.map_or(String::new(), |effect| format!("; it costs {}", effect.info().price))
}

/// The largest change with its sign, or what a closed form gives.
fn value(verdict: &Verdict) -> String {
    let change = verdict.changes.and_then(|changes| changes.largest());
    match (change, verdict.unit) {
        (Some((_, change)), _) => signed_percent(change),
        (None, "") => percent(verdict.value),
        (None, unit) => format!("{} {unit}", digits(verdict.value)),
    }
}

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
    writeln!(
        out,
        "{of}; what changes a quantity by more than {} matters, {} by gravity, by support or by groove slip, a tenth beside a cage",
        percent(scene.effects.auto.threshold()),
        percent(estimate::unsettled(scene.effects.auto.threshold()))
    )?;
    let verdicts = json::ranked(verdicts);
    for (heading, is_in) in GROUPS {
        let of: Vec<_> = verdicts.iter().copied().filter(|verdict| is_in(verdict)).collect();
        if of.is_empty() {
            continue;
        }
        writeln!(out, "\n{heading}")?;
        for verdict in of {
            writeln!(
                out,
                "  {:<25} {:>9}  of {:<16}  {}",
                verdict.subject,
                value(verdict),
                verdict.quantity,
                verdict.sentence
            )?;
            if verdict.standing == Standing::Off && verdict.matters {
                writeln!(out, "  {:<58}  write {}{}", "", verdict.write, price(scene, verdict))?;
            }
        }
    }
    Ok(())
}
