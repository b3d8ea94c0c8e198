//! `roulement cost`: the work-precision study with progress, table, plots and report.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use roulement::scene::Scene;
use roulement_cli::cost::levers::Lever;
use roulement_cli::cost::{Choice, SCENES, SceneStudy, report, study_of};

use super::say;

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
}

/// Studies one scene file, or the standard scenes if there is none, into a directory.
///
/// # Errors
/// If a scene has no reference, or files cannot be written.
pub fn run(options: Options) -> Result<(), Box<dyn Error>> {
    let Options { scene, output: directory, only, threads } = options;
    let choice = Choice { only, threads: threads.map_or(Choice::default().threads, usize::from) };
    let scenes: Vec<(String, Scene)> = match &scene {
        Some(path) => {
            let name = path.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy().into_owned());
            vec![(name, super::load(path)?)]
        }
        None => SCENES
            .iter()
            .map(|(name, text)| Ok((name.to_string(), Scene::parse(text)?)))
            .collect::<Result<_, Box<dyn Error>>>()?,
    };
    fs::create_dir_all(&directory).map_err(|why| format!("cannot make {}: {why}", directory.display()))?;
    let bar = ProgressBar::no_length();
    if let Ok(style) =
        ProgressStyle::with_template("[{bar:30}] {percent} %, {elapsed} elapsed, about {eta} left: {msg}")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let mut studies: Vec<SceneStudy> = Vec::with_capacity(scenes.len());
    for (name, scene) in &scenes {
        studies.push(study_of(name, scene, &choice, &bar).map_err(|why| format!("{name}: {why}"))?);
        // What is done is kept if a later scene fails.
        report::write(&studies, &directory)?;
    }
    bar.finish_and_clear();
    for path in report::write(&studies, &directory)? {
        say(&format!("{}\n", path.display()))?;
    }
    for study in &studies {
        say(&format!("{}: {}\n", study.name, study.settled.join(" ")))?;
        say(&format!("{}: {}\n", study.name, study.advice.join(" ")))?;
    }
    Ok(())
}
