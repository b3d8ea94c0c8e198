//! `roulement run`: simulation with progress, results, plots and summary.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement_cli::report::plots::write_plots;
use roulement_cli::report::results::ResultsWriter;

use super::summary::summary;

/// Simulates a scene into a directory.
///
/// # Errors
/// If the simulation cannot start or go on, or files cannot be written. Results up to an interruption are kept.
pub fn run(scene: &Scene, directory: &Path) -> Result<(), Box<dyn Error>> {
    let mut simulation = Simulation::new(scene)?;
    fs::create_dir_all(directory).map_err(|why| format!("cannot make {}: {why}", directory.display()))?;
    let mut results = ResultsWriter::create(&directory.join("results.csv"), scene)?;
    results.write(simulation.inputs(), simulation.outputs())?;

    let interval = scene.load.output_interval.0;
    // The last interval ends with the duration, even if that is no multiple.
    let points = (scene.load.duration.0 / interval * (1.0 - 1e-9)).ceil().max(1.0) as u64;
    let progress = progress_bar(points);
    let begin = Instant::now();
    let mut history = vec![simulation.outputs().clone()];
    let mut interrupted = None;
    for point in 1..=points {
        let end = if point == points { scene.load.duration.0 } else { point as f64 * interval };
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        let advanced = simulation.advance(end);
        results.write(simulation.inputs(), simulation.outputs())?;
        history.push(simulation.outputs().clone());
        if let Err(why) = advanced {
            interrupted = Some(why);
            break;
        }
        progress.set_message(format!("{:.3} of {} ms", end * 1e3, scene.load.duration.0 * 1e3));
        progress.inc(1);
    }
    progress.finish_and_clear();
    let wall = begin.elapsed();
    results.finish()?;
    let plots = write_plots(scene, simulation.model(), &history, directory)?;
    print!("{}", summary(&simulation, &history, wall));
    println!("\nresults          {}", directory.join("results.csv").display());
    for plot in plots {
        println!("plot             {}", plot.display());
    }
    interrupted.map_or(Ok(()), |why| Err(why.into()))
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
