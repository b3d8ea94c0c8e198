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
use roulement_cli::report::json;

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
    let scene = load(&options.scene)?;
    let verdicts = estimate::verdicts(&scene, &Model::new(&scene)?)?;
    let text = if options.json {
        format!("{:#}\n", json::effects(&scene, &verdicts)?)
    } else {
        to_text(&scene, &verdicts)
    };
    Ok(say(&text)?)
}

/// Says what is on, and what is off and would matter; nothing more where nothing can be estimated but why.
pub fn announce(scene: &Scene, verdicts: &Verdicts) {
    let lines = match verdicts {
        Ok(verdicts) => missed(verdicts),
        Err(why) => vec![why.to_string()],
    };
    tell([scene.effects.simulated()].into_iter().chain(lines));
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

fn to_text(scene: &Scene, verdicts: &[Verdict]) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_text(&mut text, scene, verdicts);
    text
}

fn write_text(out: &mut String, scene: &Scene, verdicts: &[Verdict]) -> std::fmt::Result {
    if !scene.title.is_empty() {
        writeln!(out, "{}", scene.title)?;
    }
    writeln!(out, "{}", scene.effects.simulated())?;
    writeln!(
        out,
        "estimates of the equilibrium at the start, every race at the largest speed of its script"
    )?;
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
