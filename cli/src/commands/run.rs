//! `roulement run`: simulation with progress, results, plots and summary.

use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use roulement::model::bodies::Race;
use roulement::simulation::Simulation;
use roulement::simulation::play::{Rows, play};
use roulement_cli::report::energy::EnergyWatch;
use roulement_cli::report::limits::Limits;
use roulement_cli::report::means::{Blocks, Parts};
use roulement_cli::report::plots::write_plots;
use roulement_cli::report::results::{Choice, ResultsError, ResultsWriter, Window};
use roulement_cli::report::thinned::Thinned;
use signal_hook::consts::SIGINT;
use signal_hook::flag;

use super::summary::{Run, summary};
use super::{load, say, tell};

/// Exit code of a program that Ctrl-C ended: 128 and the number of the signal.
const INTERRUPTED: u8 = 130;

/// Options of `roulement run`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// Directory for the results; made if missing.
    #[arg(short, long, default_value = "results")]
    output: PathBuf,
    /// Columns of results.csv: names with `*` for any characters, such as `inner.force.*,ball[1].*`; all if not given.
    #[arg(long, value_delimiter = ',')]
    columns: Vec<String>,
    /// Time window whose rows are written to results.csv, FROM:TO, such as `10 ms:20 ms`; either end may be left out.
    #[arg(long)]
    window: Option<Window>,
}

/// Why a run ends before its time.
enum End {
    Interrupted,
    Results(ResultsError),
}

/// Simulates a scene into a directory. What has been simulated until an error or Ctrl-C is kept, with its summary and plots.
///
/// # Errors
/// If the simulation cannot start or go on, or files cannot be written.
pub fn run(options: Options) -> Result<ExitCode, Box<dyn Error>> {
    let Options { scene, output: directory, columns, window } = options;
    let scene = load(&scene)?;
    let mut simulation = Simulation::new(&scene)?;
    fs::create_dir_all(&directory).map_err(|why| format!("cannot make {}: {why}", directory.display()))?;
    let choice = Choice { columns, window: window.unwrap_or_default() };
    let mut results = ResultsWriter::create(&directory.join("results.csv"), &scene, &choice)?;
    let interrupted = Arc::new(AtomicBool::new(false));
    // A second Ctrl-C does not wait for the row.
    flag::register_conditional_shutdown(SIGINT, INTERRUPTED.into(), Arc::clone(&interrupted))?;
    flag::register(SIGINT, Arc::clone(&interrupted))?;

    let rows = Rows::of(&simulation);
    let progress = progress_bar(rows.count());
    let begin = Instant::now();
    let mut plotted = Thinned::default();
    let mut energy = EnergyWatch::default();
    let mut limits = Limits::default();
    let parts = Parts {
        cage: simulation.outputs().cage.is_some(),
        moving_outer: Race::loaded(&scene) == Race::Outer,
    };
    let mut blocks = Blocks::new(parts, 0.5 * simulation.model().bearing.pitch_diameter);
    let played = play(&mut simulation, rows, |simulation| {
        let outputs = simulation.outputs();
        if let Err(why) = results.write(simulation.inputs(), outputs) {
            return ControlFlow::Break(End::Results(why));
        }
        progress.set_message(format!("{:.3} of {:.3} ms", outputs.time * 1e3, rows.duration * 1e3));
        progress.set_position(plotted.seen());
        blocks.push(outputs);
        energy.push(outputs);
        limits.push(outputs);
        plotted.push(outputs.clone());
        if interrupted.load(Ordering::Relaxed) {
            ControlFlow::Break(End::Interrupted)
        } else {
            ControlFlow::Continue(())
        }
    });
    progress.finish_and_clear();
    let wall = begin.elapsed();
    // A full disk takes no plots either.
    let played = match played {
        Ok(ControlFlow::Break(End::Results(why))) => return Err(why.into()),
        played => played,
    };
    results.finish()?;
    let plots = write_plots(&scene, simulation.model(), &plotted.finish(), &directory)?;
    let means = blocks.means();
    if let Some(means) = &means {
        write(&directory.join("means.csv"), |path| means.write(path))?;
    }
    let text = summary(&Run {
        simulation: &simulation,
        means: means.as_ref(),
        energy: &energy,
        limits: &limits,
        wall,
    });
    write(&directory.join("summary.txt"), |path| fs::write(path, &text))?;
    let mut listed = format!("{text}\nresults          {}\n", directory.join("results.csv").display());
    for plot in plots {
        listed += &format!("plot             {}\n", plot.display());
    }
    tell(scene.pressure_note(limits.peak_pressure));
    // Why a run has ended early is said even where nobody reads the summary.
    let said = say(&listed);
    if let ControlFlow::Break(End::Interrupted) = played? {
        tell([format!("interrupted at {:.3} ms", simulation.time() * 1e3)]);
        return Ok(ExitCode::from(INTERRUPTED));
    }
    said?;
    Ok(ExitCode::SUCCESS)
}

/// Writes a file, with its name in the error.
fn write(path: &Path, write: impl FnOnce(&Path) -> std::io::Result<()>) -> Result<(), String> {
    write(path).map_err(|why| format!("cannot write {}: {why}", path.display()))
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
