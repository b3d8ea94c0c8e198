//! `roulement cost`: the work-precision study with progress, table, plots and report.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use clap::Args;
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement_cli::cost::json::of_study;
use roulement_cli::cost::levers::Lever;
use roulement_cli::cost::{Choice, SCENES, SceneStudy, StudyError, report, study_of};
use roulement_cli::progress;
use serde_json::Value;

use super::interrupt::{INTERRUPTED, heeded_interrupt};
use super::{say, tell};

/// Options of `roulement cost`.
#[derive(Args)]
pub struct Options {
    /// Scene file; the six standard scenes if not given.
    scene: Option<PathBuf>,
    /// Directory for table, plots and report; made if missing.
    #[arg(short, long, default_value = "cost")]
    output: PathBuf,
    /// Levers that are studied, with commas between them; all if not given.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LEVERS")]
    only: Vec<Lever>,
    /// Runs at a time; as many as there are cores if not given. Times are CPU times of single runs, but runs side by side
    /// share the memory of the machine: give 1 for the best of them.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print the studies as JSON.
    #[arg(long)]
    json: bool,
}

/// Studies one scene file, or the standard scenes if there is none, into a directory. What is there at Ctrl-C is kept.
///
/// # Errors
/// If a scene has no reference, or files cannot be written.
pub fn run(options: Options) -> Result<ExitCode, Box<dyn Error>> {
    let Options { scene, output: directory, only, threads, json } = options;
    let interrupted = heeded_interrupt()?;
    let threads = threads.map_or(Choice::default().threads, usize::from);
    let choice = Choice { only, threads, interrupted: Arc::clone(&interrupted) };
    let scenes: Vec<(String, MachineScene)> = match &scene {
        Some(path) => {
            let name = path.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy().into_owned());
            vec![(name, super::load(path)?)]
        }
        None => SCENES
            .iter()
            .map(|(name, text)| Ok((name.to_string(), Scene::parse(text)?.into())))
            .collect::<Result<_, Box<dyn Error>>>()?,
    };
    fs::create_dir_all(&directory).map_err(|why| format!("cannot make {}: {why}", directory.display()))?;
    let bar = progress::bar(None, "[{bar:30}] {percent} %, {elapsed} elapsed, about {eta} left: {msg}");
    let mut studies: Vec<SceneStudy> = Vec::with_capacity(scenes.len());
    for (name, scene) in &scenes {
        match study_of(name, scene, &choice, &bar) {
            Ok(study) => studies.push(study),
            // It has no reference yet: nothing can be told of it.
            Err(StudyError::Interrupted) => break,
            Err(why) => return Err(format!("{name}: {why}").into()),
        }
        // What is done is kept if a later scene fails.
        report::write(&studies, &directory)?;
        if interrupted.load(Ordering::Relaxed) {
            break;
        }
    }
    bar.finish_and_clear();
    let paths = if studies.is_empty() { vec![] } else { report::write(&studies, &directory)? };
    if json {
        let all: Vec<_> = studies.iter().map(of_study).collect();
        say(&format!("{:#}\n", Value::from(all)))?;
    } else {
        for path in paths {
            say(&format!("{}\n", path.display()))?;
        }
        for study in &studies {
            let said = [study.settled.join(" ")].into_iter().chain(study.promise());
            for sentence in said.chain([study.advice.join(" ")]) {
                say(&format!("{}: {sentence}\n", study.name))?;
            }
        }
    }
    if interrupted.load(Ordering::Relaxed) {
        let what = if studies.is_empty() {
            "before any reference was there"
        } else {
            "runs that are missing say so"
        };
        tell([format!("interrupted: {what}")]);
        return Ok(ExitCode::from(INTERRUPTED));
    }
    Ok(ExitCode::SUCCESS)
}
