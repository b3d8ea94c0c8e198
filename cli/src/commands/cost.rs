//! `roulement cost`: the work-precision study with progress, table, plots and report.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use roulement::scene::Scene;
use roulement_cli::cost::{SCENES, SceneStudy, report, study};

use super::say;

/// Studies one scene file, or the standard scenes if there is none, into a directory.
///
/// # Errors
/// If a scene has no reference, or files cannot be written.
pub fn run(scene: Option<&Path>, directory: &Path) -> Result<(), Box<dyn Error>> {
    let scenes: Vec<(String, Scene)> = match scene {
        Some(path) => {
            let name = path.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy().into_owned());
            vec![(name, Scene::load(path)?)]
        }
        None => SCENES
            .iter()
            .map(|(name, text)| Ok((name.to_string(), Scene::parse(text)?)))
            .collect::<Result<_, Box<dyn Error>>>()?,
    };
    fs::create_dir_all(directory).map_err(|why| format!("cannot make {}: {why}", directory.display()))?;
    let bar = ProgressBar::no_length();
    if let Ok(style) = ProgressStyle::with_template("[{bar:30}] {pos} of {len}, {elapsed}: {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let mut studies: Vec<SceneStudy> = Vec::with_capacity(scenes.len());
    for (name, scene) in &scenes {
        studies.push(study(name, scene, &bar).map_err(|why| format!("{name}: {why}"))?);
        // What is done is kept if a later scene fails.
        report::write(&studies, directory)?;
    }
    bar.finish_and_clear();
    for path in report::write(&studies, directory)? {
        say(format_args!("{}\n", path.display()))?;
    }
    Ok(())
}
