//! `roulement run`: simulation with progress, results, plots and summary; with `--error`, as often as its error asks for.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;
use roulement::analysis::estimate::{self, Verdicts};
use roulement::scene::units::Time;
use roulement::scene::{ErrorGoal, ErrorOf, Scene, Solver};
use roulement::simulation::Simulation;
use roulement_cli::error::{Judgement, MOST_ROUNDS, Rounds, TWIN};
use roulement_cli::page::record;
use roulement_cli::report::figures::{Figures, Shown};
use roulement_cli::report::json;
use roulement_cli::report::plots::{title, write_plots};
use roulement_cli::report::results::{Choice, Columns, ResultsWriter, Window, is_parquet};
use roulement_cli::report::spectrum;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::effects::announce;
use super::player::{End, Played, Player, put};
use super::summary::summary;
use super::{load, say, shaft, system, tell};

/// Exit code of a program that Ctrl-C or SIGTERM ended: 128 and the number of Ctrl-C.
pub const INTERRUPTED: u8 = 130;
/// Exit code of a run whose results are there and whose error goal is not met.
const GOAL_NOT_MET: u8 = 3;

/// Options of `roulement run`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// Directory for the results, made if missing; or a file that ends in .parquet, for the table alone.
    #[arg(short, long, default_value = "results")]
    output: PathBuf,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
    /// Columns of results.csv: names with `*` for any characters, such as `inner.force.*,ball[1].*`; all if not given.
    #[arg(long, value_delimiter = ',')]
    columns: Vec<String>,
    /// Time window whose rows are written to results.csv, FROM:TO, such as `10 ms:20 ms`; either end may be left out.
    #[arg(long)]
    window: Option<Window>,
    /// Measure the numerical error: run again with half the steps, and again until it is below GOAL, such as `1e-3`, if one is
    /// given here or by `solver.accuracy`. Exit code 3 says that it is not. Without GOAL it stands behind the scene file.
    #[arg(long, value_name = "GOAL", num_args = 0..=1)]
    error: Option<Option<f64>>,
    /// The goal is one of means alone, not of histories.
    #[arg(long, requires = "error")]
    means_only: bool,
    /// Runs that `--error` may take, each with half the steps of the one before; a run that looks for chaos comes on top.
    #[arg(long, value_name = "N", default_value_t = MOST_ROUNDS, value_parser = clap::value_parser!(u32).range(2..=16))]
    rounds: u32,
}

/// Simulates a scene into a directory. What has been simulated until an error, Ctrl-C or SIGTERM is kept, with its summary and plots.
///
/// # Errors
/// If the simulation cannot start or go on, or files cannot be written.
pub fn run(options: Options) -> Result<ExitCode, Box<dyn Error>> {
    let Options { scene, output, json, columns, window, error, means_only, rounds } = options;
    if let Some(system) = system(&scene)? {
        if error.is_some() {
            return Err("--error is for the scene of one bearing: run a shaft again with a smaller solver.max_step and compare".into());
        }
        let choice = Choice { columns, window: window.unwrap_or_default() };
        let said = if json { Said::Json } else { Said::Text };
        return shaft::run(&heeded_interrupt()?, "", &system, &output, &choice, said);
    }
    let mut scene = load(&scene)?;
    if let Some(Some(error)) = error {
        scene.solver.goal = Some(ErrorGoal { error, of: ErrorOf::All });
        scene.check()?;
    }
    if let (Some(goal), true) = (&mut scene.solver.goal, means_only) {
        goal.of = ErrorOf::Means;
    }
    let output = Place {
        files: !is_parquet(&output),
        output,
        choice: Choice { columns, window: window.unwrap_or_default() },
        said: if json { Said::Json } else { Said::Text },
    };
    simulate(&Player::new(heeded_interrupt()?), &scene, &output, error.is_some(), rounds)
}

/// Set by Ctrl-C, and by SIGTERM, which queues of computing centres send; a second one does not wait for the row.
///
/// # Errors
/// If the system has no such signals.
pub fn heeded_interrupt() -> std::io::Result<Arc<AtomicBool>> {
    let interrupted = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        flag::register_conditional_shutdown(signal, INTERRUPTED.into(), Arc::clone(&interrupted))?;
        flag::register(signal, Arc::clone(&interrupted))?;
    }
    Ok(interrupted)
}

/// Simulates a scene into its place: again with smaller steps, `rounds` times at most, where its error is wanted or it has a goal
/// for it.
///
/// # Errors
/// As [`run`].
pub fn simulate(
    player: &Player,
    scene: &Scene,
    place: &Place,
    wants_error: bool,
    rounds: u32,
) -> Result<ExitCode, Box<dyn Error>> {
    let simulation = Simulation::new(scene)?;
    let verdicts = estimate::verdicts(simulation.scene(), simulation.model());
    if place.said != Said::Nothing {
        announce(simulation.scene(), &verdicts);
    }
    // Before anything of a former run goes.
    drop(Columns::new(scene, &place.choice)?);
    if place.files {
        record::begin(&place.output)
            .map_err(|why| format!("cannot begin in {}: {why}", place.output.display()))?;
    }
    let table = ResultsWriter::create(&place.results(), scene, &place.choice)?;
    if wants_error || scene.solver.goal.is_some() {
        return measured(player, simulation, table, place, &verdicts, rounds);
    }
    let played = player.play(simulation, Some(table), "")?;
    place.leave(&played, &verdicts, None, "")?;
    ended(played)
}

/// What the program says at the end of a run that was not compared with another.
fn ended(played: Played) -> Result<ExitCode, Box<dyn Error>> {
    match played.end {
        End::Reached => Ok(ExitCode::SUCCESS),
        End::Interrupted => {
            tell([format!("interrupted at {:.3} ms", played.simulation.time() * 1e3)]);
            Ok(ExitCode::from(INTERRUPTED))
        }
        End::Failed(why) => Err(why.into()),
    }
}

/// Runs a scene with smaller and smaller steps until its error is known, and kept if there is a goal. The files are those of
/// the finest run that came to its end.
fn measured(
    player: &Player,
    simulation: Simulation,
    table: ResultsWriter,
    place: &Place,
    verdicts: &Verdicts,
    most: u32,
) -> Result<ExitCode, Box<dyn Error>> {
    let scene = simulation.scene().clone();
    let with = |solver: Solver| {
        let mut scene = scene.clone();
        scene.solver = solver;
        scene
    };
    let mut rounds = Rounds::new(scene.solver.goal, most);
    let mut played = player.play(simulation, Some(table), "round 1: ")?;
    if !matches!(played.end, End::Reached) {
        place.leave(&played, verdicts, None, "")?;
        return ended(played);
    }
    rounds.push(played.take_comparable());
    let (judgement, end) = loop {
        let judgement = rounds.judge();
        let next = match judgement {
            Judgement::Refine => {
                let finer = with(scene.solver.refined(rounds.refinements()));
                let simulation = Simulation::new(&finer)?;
                let table = ResultsWriter::create(&place.results_of_round(), &finer, &place.choice)?;
                let words = format!("round {}: ", rounds.count() + 1);
                let mut next = player.play(simulation, Some(table), &words)?;
                if matches!(next.end, End::Reached) {
                    put(&place.results_of_round(), &place.results())?;
                    rounds.push(next.take_comparable());
                    played = next;
                    continue;
                }
                // Rows of a run that is not whole.
                let _ = fs::remove_file(place.results_of_round());
                next
            }
            Judgement::Twin => {
                let Some(coarser) = rounds.coarser() else { break (judgement, End::Reached) };
                let twin = Simulation::new(&with(changed(coarser.solver)))?;
                let mut next = player.play(twin, None, &format!("round {}: ", rounds.count() + 1))?;
                if matches!(next.end, End::Reached) {
                    rounds.push_twin(&next.take_comparable());
                    continue;
                }
                next
            }
            Judgement::Done | Judgement::TooShort | Judgement::TooMany => break (judgement, End::Reached),
        };
        break (judgement, next.end);
    };
    played.seen.means = rounds.means();
    place.leave(&played, verdicts, rounds.bars(), &rounds.report())?;
    let round = rounds.count() + 1;
    match (end, judgement) {
        (End::Interrupted, _) => {
            tell([format!(
                "interrupted in round {round}; the results are of the last round that came to its end"
            )]);
            Ok(ExitCode::from(INTERRUPTED))
        }
        (End::Failed(why), _) => Err(format!("in round {round}: {why}").into()),
        (End::Reached, Judgement::TooShort | Judgement::TooMany) => Ok(ExitCode::from(GOAL_NOT_MET)),
        (End::Reached, _) => Ok(ExitCode::SUCCESS),
    }
}

/// Settings whose steps differ by next to nothing.
fn changed(solver: Solver) -> Solver {
    let [max_step, initial_step] =
        [solver.max_step, solver.initial_step].map(|step| Time(step.0 * (1.0 + TWIN)));
    Solver { max_step, initial_step, ..solver }
}

/// How a run's summary is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Said {
    /// In words.
    Text,
    /// As JSON.
    Json,
    /// It stands in the files alone.
    Nothing,
}

/// Where the results of a run go.
pub struct Place {
    /// Directory, or the file of the table.
    pub output: PathBuf,
    /// Is it a directory, and has all files?
    pub files: bool,
    /// What the table has.
    pub choice: Choice,
    /// How the summary is said.
    pub said: Said,
}

impl Place {
    fn results(&self) -> PathBuf {
        if self.files { self.output.join("results.csv") } else { self.output.clone() }
    }

    /// The table of a round until it is whole.
    fn results_of_round(&self) -> PathBuf {
        if self.files {
            self.output.join("results.csv.round")
        } else {
            self.output.with_extension("round.parquet")
        }
    }

    /// Leaves plots, means and summary of a run, and says the summary. Error bars and a report of errors are those of runs that
    /// were compared.
    pub(super) fn leave(
        &self,
        played: &Played,
        verdicts: &Verdicts,
        bars: Option<Figures>,
        errors: &str,
    ) -> Result<(), Box<dyn Error>> {
        let scene = played.simulation.scene();
        let shown = Shown { figures: played.figures(), bars };
        let text = summary(played, &shown, verdicts) + errors;
        let mut plots = vec![];
        if self.files {
            plots = self.write_files(played, verdicts, &shown, &text)?;
        }
        let listed = match self.said {
            Said::Nothing => return Ok(()),
            Said::Json => format!("{:#}\n", json::summary(&played.simulation, &played.seen, &shown)),
            Said::Text => {
                let mut listed = format!("{text}\nresults          {}\n", self.results().display());
                for plot in plots {
                    listed += &format!("plot             {}\n", plot.display());
                }
                listed
            }
        };
        tell(scene.pressure_note(played.seen.limits.peak_pressure));
        tell(played.simulation.outputs().life.and_then(|life| life.warning()));
        let said = say(&listed);
        // Why a run has ended early is said even where nobody reads the summary.
        if matches!(played.end, End::Reached) {
            said?;
        }
        Ok(())
    }

    /// Writes all files beside the table; gives those of the plots.
    fn write_files(
        &self,
        played: &Played,
        verdicts: &Verdicts,
        shown: &Shown,
        text: &str,
    ) -> Result<Vec<PathBuf>, Box<dyn Error>> {
        let (scene, directory) = (played.simulation.scene(), &self.output);
        let mut plots = write_plots(scene, &played.plotted, directory)?;
        if let Some(means) = &played.seen.means {
            write(&directory.join("means.csv"), |path| means.write(path))?;
        }
        if let Some(spectrum) = &played.seen.spectrum {
            write(&directory.join("spectrum.csv"), |path| spectrum.write(path))?;
            let picture = directory.join("spectrum.svg");
            spectrum::picture::write(spectrum, title(scene), &picture)?;
            plots.push(picture);
        }
        write(&directory.join("summary.txt"), |path| fs::write(path, text))?;
        let record = record::Run {
            simulation: &played.simulation,
            rows: &played.plotted,
            seen: &played.seen,
            shown,
            verdicts,
            summary: text,
            took: [played.wall.as_secs_f64(), played.cpu],
            ended_early: match &played.end {
                End::Reached => None,
                End::Interrupted => Some("interrupted".to_string()),
                End::Failed(why) => Some(why.clone()),
            },
        };
        write(&directory.join(record::FILE), |path| record.write(path))?;
        Ok(plots)
    }
}

/// Writes a file, with its name in the error.
fn write(path: &Path, write: impl FnOnce(&Path) -> std::io::Result<()>) -> Result<(), String> {
    write(path).map_err(|why| format!("cannot write {}: {why}", path.display()))
}
