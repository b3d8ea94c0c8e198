//! `roulement run`: simulation with progress, results, plots and summary.

use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};
use roulement_cli::report::plots::write_plots;
use roulement_cli::report::results::ResultsWriter;

use super::summary::summary;
use super::{say, tell};

/// Simulates a scene into a directory.
///
/// # Errors
/// If the simulation cannot start or go on, or files cannot be written. Results up to an interruption are kept.
pub fn run(scene: &Scene, directory: &Path) -> Result<(), Box<dyn Error>> {
    let mut simulation = Simulation::new(scene)?;
    fs::create_dir_all(directory).map_err(|why| format!("cannot make {}: {why}", directory.display()))?;
    let mut results = ResultsWriter::create(&directory.join("results.csv"), scene)?;
    let rows = Rows::of(&simulation);
    let progress = progress_bar(rows.count());
    let begin = Instant::now();
    let mut history = Vec::new();
    let played = play(&mut simulation, rows, |simulation| {
        if let Err(why) = results.write(simulation.inputs(), simulation.outputs()) {
            return ControlFlow::Break(why);
        }
        let time = simulation.time();
        progress.set_message(format!("{:.3} of {} ms", time * 1e3, rows.duration * 1e3));
        progress.set_position(history.len() as u64);
        history.push(simulation.outputs().clone());
        ControlFlow::Continue(())
    });
    progress.finish_and_clear();
    if let Ok(ControlFlow::Break(why)) = played {
        return Err(why.into());
    }
    let wall = begin.elapsed();
    results.finish()?;
    let plots = write_plots(scene, simulation.model(), &history, directory)?;
    let mut text = summary(&simulation, &history, wall);
    text += &format!("\nresults          {}\n", directory.join("results.csv").display());
    for plot in plots {
        text += &format!("plot             {}\n", plot.display());
    }
    let contacts =
        history.iter().flat_map(|outputs| &outputs.balls).flat_map(|ball| [&ball.inner, &ball.outer]);
    tell(scene.pressure_note(contacts.map(|contact| contact.peak_pressure).fold(0.0, f64::max)));
    // Why a run has ended early is said even where nobody reads the summary.
    let said = say(&text);
    let _ = played?;
    Ok(said?)
}

/// A bar with simulated time and an estimate of what is left.
fn progress_bar(points: u64) -> ProgressBar {
    let bar = ProgressBar::new(points);
    let template = "simulated {msg} [{bar:40}] {percent} %, {elapsed} elapsed, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
