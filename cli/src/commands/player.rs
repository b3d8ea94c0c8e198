//! Plays a scene from start to end for `roulement run`: progress, result table, and what its summary and plots need.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use indicatif::{ProgressBar, ProgressStyle};
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::{Rows, play};
use roulement_cli::error::Run;
use roulement_cli::report::figures::Figures;
use roulement_cli::report::results::{ResultsError, ResultsWriter};
use roulement_cli::report::thinned::Thinned;
use roulement_cli::watch::{Seen, Watch};

/// A run that has ended.
pub struct Played {
    /// The bearing at the end.
    pub simulation: Simulation,
    /// Rows for the plots.
    pub plotted: Vec<Outputs>,
    /// What was gathered of its rows.
    pub seen: Seen,
    /// Time that it took.
    pub wall: Duration,
    /// \[s] CPU time that it took.
    pub cpu: f64,
    /// Did it come to its time?
    pub end: End,
}

/// How a run ended.
pub enum End {
    /// At its time.
    Reached,
    /// By Ctrl-C.
    Interrupted,
    /// With a step that could not be finished.
    Failed(String),
}

impl Played {
    /// Figures of its summary.
    pub fn figures(&self) -> Figures {
        self.seen.figures(&self.simulation)
    }

    /// What is kept for comparison with other runs; its rows move there.
    pub fn take_comparable(&mut self) -> Run {
        self.seen.take_comparable(&self.simulation, self.cpu)
    }
}

/// What a run ends early for.
enum Stop {
    Interrupted,
    Results(ResultsError),
}

/// Plays scenes until Ctrl-C.
pub struct Player {
    /// Set by Ctrl-C.
    pub interrupted: Arc<AtomicBool>,
    /// What progress begins with.
    pub words: String,
}

impl Player {
    /// Whose progress is that of one run.
    pub fn new(interrupted: Arc<AtomicBool>) -> Self {
        Self { interrupted, words: String::new() }
    }

    /// Plays a simulation, with its rows into a table if there is one; `words` of this run follow those that progress
    /// begins with.
    ///
    /// # Errors
    /// If the table cannot be written. A run that fails on its way is no error here.
    pub fn play(
        &self,
        mut simulation: Simulation,
        mut table: Option<ResultsWriter>,
        words: &str,
    ) -> Result<Played, ResultsError> {
        let rows = Rows::of(&simulation);
        let progress = progress_bar(rows.count(), &format!("{}{words}", self.words));
        let begin = Instant::now();
        let cpu = ThreadTime::now();
        let mut plotted = Thinned::default();
        let mut watch = Watch::of(&simulation);
        let played = play(&mut simulation, rows, |simulation| {
            let outputs = simulation.outputs();
            if let Some(Err(why)) = table.as_mut().map(|table| table.write(simulation.inputs(), outputs)) {
                return ControlFlow::Break(Stop::Results(why));
            }
            progress.set_message(format!("{:.3} of {:.3} ms", outputs.time * 1e3, rows.duration * 1e3));
            progress.set_position(plotted.seen());
            watch.push(simulation);
            plotted.push(outputs.clone());
            if self.interrupted.load(Ordering::Relaxed) {
                ControlFlow::Break(Stop::Interrupted)
            } else {
                ControlFlow::Continue(())
            }
        });
        progress.finish_and_clear();
        let (wall, cpu) = (begin.elapsed(), cpu.elapsed().as_secs_f64());
        let end = match played {
            // A full disk takes nothing else either.
            Ok(ControlFlow::Break(Stop::Results(why))) => return Err(why),
            Ok(ControlFlow::Break(Stop::Interrupted)) => End::Interrupted,
            Ok(ControlFlow::Continue(())) => End::Reached,
            Err(why) => End::Failed(why.to_string()),
        };
        if let Some(table) = table {
            table.finish()?;
        }
        Ok(Played { simulation, plotted: plotted.finish(), seen: watch.finish(), wall, cpu, end })
    }
}

/// Moves a finished table to its place.
///
/// # Errors
/// If the file cannot be moved.
pub fn put(from: &Path, to: &Path) -> Result<(), String> {
    std::fs::rename(from, to)
        .map_err(|why| format!("cannot move {} to {}: {why}", from.display(), to.display()))
}

/// A bar with simulated time and an estimate of what is left.
pub(super) fn progress_bar(points: u64, words: &str) -> ProgressBar {
    let bar = ProgressBar::new(points);
    let template =
        format!("{words}simulated {{msg}} [{{bar:40}}] {{percent}} %, {{elapsed}} elapsed, {{eta}} left");
    if let Ok(style) = ProgressStyle::with_template(&template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
