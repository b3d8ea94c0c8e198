//! Plays a machine from start to end for `roulement run`: progress, result tables, and what its summary and plots need.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use roulement::simulation::machine::Machine;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::{Rows, play_observed};
use roulement::simulation::system::SystemOutputs;
use roulement_cli::clock::ThreadTime;
use roulement_cli::error::Run;
use roulement_cli::progress::{self, ProgressBar};
use roulement_cli::report::results::ResultsError;
use roulement_cli::report::tables::Tables;
use roulement_cli::report::thinned::Thinned;
use roulement_cli::watch::{Seen, Watch};

use super::tell;

/// A run that has ended.
pub struct Played {
    /// The machine at the end.
    pub machine: Machine,
    /// Rows of every bearing for the plots.
    pub plotted: Vec<Vec<Outputs>>,
    /// Rows of the shaft for the plots.
    pub plotted_shaft: Vec<SystemOutputs>,
    /// Gathered figures.
    pub seen: Seen,
    /// Time that it took.
    pub wall: Duration,
    /// \[s] CPU time that it took.
    pub cpu: f64,
    /// Did it come to its time?
    pub end: End,
}

/// How a run ended.
#[derive(Clone)]
pub enum End {
    /// At its time.
    Reached,
    /// By Ctrl-C.
    Interrupted,
    /// With a step that could not be finished.
    Failed(String),
}

impl End {
    /// Why it ended before its time.
    pub fn early(&self) -> Option<String> {
        match self {
            Self::Reached => None,
            Self::Interrupted => Some("interrupted".to_string()),
            Self::Failed(why) => Some(why.clone()),
        }
    }
}

impl Played {
    /// Sample for comparison with other runs; its rows move there.
    pub fn take_comparable(&mut self) -> Run {
        self.seen.take_comparable(&self.machine, self.cpu)
    }
}

/// Reason to end a run early.
enum Stop {
    Interrupted,
    Results(ResultsError),
}

/// Plays scenes until Ctrl-C.
pub struct Player {
    /// Set by Ctrl-C.
    pub interrupted: Arc<AtomicBool>,
    /// Words before the progress.
    pub words: String,
}

impl Player {
    /// Whose progress is that of one run.
    pub fn new(interrupted: Arc<AtomicBool>) -> Self {
        Self { interrupted, words: String::new() }
    }

    /// Plays a machine, with its rows into tables if there are some; `words` of this run follow those that progress begins with.
    ///
    /// # Errors
    /// If a table cannot be written. A run that fails on its way is no error here.
    pub fn play(
        &self,
        mut machine: Machine,
        rows: Rows,
        mut tables: Option<Tables>,
        words: &str,
    ) -> Result<Played, ResultsError> {
        let progress = progress_bar(rows.count(), &format!("{}{words}", self.words));
        let begin = Instant::now();
        let cpu = ThreadTime::now();
        let mut plotted: Vec<Thinned<Outputs>> = machine.bearings().map(|_| Thinned::default()).collect();
        let mut plotted_shaft = Thinned::default();
        let mut watch = Watch::of(&machine);
        let mut seen = 0;
        let played = play_observed(&mut machine, rows, &mut watch, |machine, watch| {
            if let Some(Err(why)) = tables.as_mut().map(|tables| tables.write(machine)) {
                return ControlFlow::Break(Stop::Results(why));
            }
            progress.set_message(format!("{:.3} of {:.3} ms", machine.time() * 1e3, rows.duration * 1e3));
            progress.set_position(seen);
            seen += 1;
            watch.push(machine);
            for alarm in watch.take_alarms(machine) {
                progress.suspend(|| tell([format!("warning: {alarm}")]));
            }
            for ((_, bearing), plotted) in machine.bearings().zip(&mut plotted) {
                plotted.push(bearing.outputs().clone());
            }
            if let Some(system) = machine.shaft() {
                plotted_shaft.push(system.outputs().clone());
            }
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
        if let Some(tables) = tables {
            tables.finish()?;
        }
        let plotted = plotted.into_iter().map(Thinned::finish).collect();
        let plotted_shaft = plotted_shaft.finish();
        let seen = watch.finish(&machine);
        Ok(Played { machine, plotted, plotted_shaft, seen, wall, cpu, end })
    }
}

/// A bar with simulated time and an estimate of what is left.
fn progress_bar(points: u64, words: &str) -> ProgressBar {
    let template =
        format!("{words}simulated {{msg}} [{{bar:40}}] {{percent}} %, {{elapsed}} elapsed, {{eta}} left");
    progress::bar(Some(points), &template)
}
