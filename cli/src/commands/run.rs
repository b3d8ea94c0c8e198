//! `roulement run`: simulation with progress, results, plots and summary; with `--error`, as often as its error asks for.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use roulement::analysis::estimate;
use roulement::scene::machine::MachineScene;
use roulement::scene::{ErrorGoal, ErrorOf};
use roulement::simulation::machine::Machine;
use roulement::simulation::play::Rows;
use roulement_cli::duty::DutyRating;
use roulement_cli::error::{Judgement, MOST_ROUNDS, Rounds, finer, twin_of_coarser};
use roulement_cli::modes::warnings;
use roulement_cli::report::results::{Choice, Window};
use roulement_cli::report::tables::Tables;
use roulement_cli::sweep::all::threads;

use super::effects::announce;
use super::interrupt::{INTERRUPTED, heeded_interrupt};
use super::place::{Judged, Place, Said};
use super::player::{End, Played, Player};
use super::{load, tell};

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
    /// End a step at every row, as a package does at every communication point. Without it, rows are read from steps and move nothing.
    #[arg(long, conflicts_with = "error")]
    steps_end_at_rows: bool,
}

/// Simulates a scene into a directory. What has been simulated until an error, Ctrl-C or SIGTERM is kept, with its summary and plots.
///
/// # Errors
/// If the simulation cannot start or go on, or files cannot be written.
pub fn run(options: Options) -> Result<ExitCode, Box<dyn Error>> {
    let Options { scene, output, json, columns, window, error, means_only, rounds, steps_end_at_rows } =
        options;
    let mut scene = load(&scene)?;
    if let Some(Some(error)) = error {
        scene.change_solver(|solver| solver.goal = Some(ErrorGoal { error, of: ErrorOf::All }));
        scene.check()?;
    }
    if means_only {
        scene.change_solver(|solver| {
            solver.goal.iter_mut().for_each(|goal| goal.of = ErrorOf::Means);
        });
    }
    let place = Place {
        output,
        choice: Choice { columns, window: window.unwrap_or_default() },
        said: if json { Said::Json } else { Said::Text },
    };
    if steps_end_at_rows && scene.solver().goal.is_some() {
        return Err(
            "--steps-end-at-rows: an error goal asks for steps that rows do not move; leave out one of them"
                .into(),
        );
    }
    let player = Player::new(heeded_interrupt()?);
    simulate(&player, &scene, &place, error.is_some(), rounds, steps_end_at_rows)
}

/// Simulates a scene into its place: again with smaller steps, `rounds` times at most, where its error is wanted or it has a goal
/// for it.
///
/// # Errors
/// As [`run`].
pub fn simulate(
    player: &Player,
    scene: &MachineScene,
    place: &Place,
    wants_error: bool,
    rounds: u32,
    end_steps: bool,
) -> Result<ExitCode, Box<dyn Error>> {
    let machine = Machine::new(scene)?;
    // Before what takes seconds, and before anything of a former run goes.
    place.check_columns(scene, &machine)?;
    if machine.shaft().is_some() && place.said != Said::Nothing {
        // It may take seconds.
        tell(["effects: the whole shaft in balance with and without each".to_string()]);
    }
    let verdicts = estimate::verdicts_of(&machine);
    if place.said != Said::Nothing {
        for ((name, bearing), verdicts) in machine.bearings().zip(&verdicts) {
            announce(name, bearing.scene(), verdicts);
        }
    }
    let duty = DutyRating::of_scene(scene, threads())?;
    let judged = Judged { verdicts, duty, growing: warnings(scene, 0.0) };
    tell(judged.growing.iter().map(|warning| format!("warning: {warning}")));
    place.begin(scene)?;
    let tables = place.tables(scene, &machine, false)?;
    if wants_error || scene.solver().goal.is_some() {
        return measured(player, scene, (machine, tables), place, &judged, rounds);
    }
    let rows = Rows { end_steps, ..Rows::of_scene(scene) };
    let mut played = player.play(machine, rows, Some(tables), "")?;
    played.seen.set_growing(&judged.growing);
    place.leave(&played, &judged, None, "")?;
    ended(&played)
}

/// Exit code and last words of a run that was not compared with another.
fn ended(played: &Played) -> Result<ExitCode, Box<dyn Error>> {
    match &played.end {
        End::Reached => Ok(ExitCode::SUCCESS),
        End::Interrupted => {
            tell([format!("interrupted at {:.3} ms", played.machine.time() * 1e3)]);
            Ok(ExitCode::from(INTERRUPTED))
        }
        End::Failed(why) => Err(why.clone().into()),
    }
}

/// Runs a scene with smaller and smaller steps until its error is known, and kept if there is a goal. The files are those of
/// the finest run that came to its end.
fn measured(
    player: &Player,
    scene: &MachineScene,
    (machine, tables): (Machine, Tables),
    place: &Place,
    judged: &Judged,
    most: u32,
) -> Result<ExitCode, Box<dyn Error>> {
    let times = Rows::of_scene(scene);
    let mut rounds = Rounds::new(scene.solver().goal, most);
    let mut played = player.play(machine, times, Some(tables), "round 1: ")?;
    if !matches!(played.end, End::Reached) {
        place.leave(&played, judged, None, "")?;
        return ended(&played);
    }
    rounds.push(played.take_comparable());
    let (judgement, end) = loop {
        let judgement = rounds.judge();
        let words = format!("round {}: ", rounds.count() + 1);
        let next = match judgement {
            Judgement::Refine => {
                let finer = finer(scene, rounds.refinements());
                let machine = Machine::new(&finer)?;
                let tables = place.tables(&finer, &machine, true)?;
                let mut next = player.play(machine, times, Some(tables), &words)?;
                if matches!(next.end, End::Reached) {
                    place.put_round(scene)?;
                    rounds.push(next.take_comparable());
                    played = next;
                    continue;
                }
                place.drop_round(scene);
                next
            }
            Judgement::Twin => {
                let twin = Machine::new(&twin_of_coarser(scene, rounds.refinements()))?;
                let mut next = player.play(twin, times, None, &words)?;
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
    played.seen.set_means(rounds.means());
    played.seen.set_growing(&judged.growing);
    place.leave(&played, judged, rounds.bars(), &rounds.report())?;
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
