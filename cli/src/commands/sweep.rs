//! `roulement sweep`: many cases of a scene on all cores, with progress, and a summary of them all.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, ValueEnum};
use roulement::scene::machine::MachineScene;
use roulement_cli::error::MOST_ROUNDS;
use roulement_cli::kinds::Kind;
use roulement_cli::page::record;
use roulement_cli::progress;
use roulement_cli::report::results::Choice;
use roulement_cli::sweep::all::{Sweep, threads as cores};
use roulement_cli::sweep::case::Wanted;
use roulement_cli::sweep::cases::{Cases, base_of};
use roulement_cli::sweep::shard::{self, Identity, Shard};
use roulement_cli::sweep::store::aside;

use super::interrupt::{INTERRUPTED, heeded_interrupt};
use super::place::{Place, Said};
use super::player::Player;
use super::run::simulate;
use super::{or_kind, say, tell};

/// Exit code of a sweep whose summary is there, but not a result of every case.
const INCOMPLETE: u8 = 4;

/// Options of `roulement sweep`.
#[derive(Args)]
pub struct Options {
    /// Table of cases, CSV or TOML: columns are keys of the scene.
    cases: PathBuf,
    /// Base scene that the cases change; that of the table if not given.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Directory for the results; made if missing. Cases that are done there already are not run again.
    #[arg(short, long, default_value = "sweep")]
    output: PathBuf,
    /// Variables whose mean, least, largest and last value the summary has, too: names with `*` for any characters, such as
    /// `ball[*].inner.load`. Whole tables have these alone. With a limit in SI, such as `clearance<0`, also when a case comes there first.
    #[arg(long, value_delimiter = ',')]
    columns: Vec<String>,
    /// Keep the whole table of every case, too.
    #[arg(long, value_enum)]
    tables: Option<Format>,
    /// Look at what grows about the start of each case, and at races that circle, as `roulement run` does: columns `grows`, `growth`,
    /// `growth.frequency`, `growth.motion` and, of every bearing, `circles`. It costs 2 ms of run and some eigenvalues a case.
    #[arg(long)]
    growth: bool,
    /// Cases at a time; as many as there are cores if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Run every N-th case alone, from the K-th on, into `shards/K-of-N` of the directory: for job arrays of clusters. `--collect` joins
    /// all shards.
    #[arg(long, value_name = "K/N", conflicts_with = "collect")]
    shard: Option<Shard>,
    /// Run nothing, but join what shards have done: the directory is then that of a sweep which was not divided. Shards that are missing
    /// or unfinished are named.
    #[arg(long)]
    collect: bool,
    /// Keep all that `roulement run` writes of these cases, too, such as `3,7`: `roulement report` shows their drawing, playback
    /// and plots.
    #[arg(long, value_name = "CASES", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    runs: Vec<u32>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    /// Text with units in the header.
    Csv,
    /// Columns, deflated.
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    fn ending(self) -> String {
        match self {
            Self::Csv => "csv".to_string(),
            #[cfg(feature = "parquet")]
            Self::Parquet => "parquet".to_string(),
        }
    }
}

/// Runs all cases that are not done yet into a directory. What is done is kept if it is interrupted. Exit code 4 says that a case has
/// failed or was not run.
///
/// # Errors
/// If the cases or the scene cannot be read, no case can be run, or files cannot be written.
pub fn run(options: Options) -> Result<ExitCode, Box<dyn Error>> {
    let Options { cases: table, scene, mut output, columns, tables, growth, shard, collect, threads, runs } =
        options;
    let cases = Cases::load(&table).map_err(|why| or_kind(&table, &[Kind::Sweep, Kind::Csv], why))?;
    let Some(scene) = scene.or_else(|| cases.scene.clone()) else {
        return Err(format!("{}: name the base scene by --scene", table.display()).into());
    };
    let runs: Vec<usize> = runs.into_iter().map(|case| case as usize).collect();
    if let Some(case) = runs.iter().find(|case| **case > cases.rows.len()) {
        return Err(format!("--runs {case}: {} has {} cases", table.display(), cases.rows.len()).into());
    }
    let (base, notes) = base_of(&scene)?;
    tell(notes);
    let wanted = Wanted { columns, tables: tables.map(Format::ending), growth };
    let mut left = vec![];
    let sweep = if let Some(shard) = shard {
        let sweep = Sweep::of_shard(cases, base, wanted, &output, shard)?;
        output = shard.folder(&output);
        say(&format!("shard {} of {}: {} cases\n", shard.number, shard.of, sweep.names.len()))?;
        sweep
    } else if collect {
        let identity = Identity::new(&cases, &base, &wanted);
        let sweep = Sweep::new(cases, base, wanted, &output)?;
        left = shard::collect(&sweep, &identity, &output)?;
        sweep
    } else {
        Sweep::new(cases, base, wanted, &output)?
    };
    let missing = if collect { vec![] } else { sweep.missing() };
    let damaged = missing.iter().filter(|case| sweep.is_damaged(**case)).count();
    tell(
        (damaged > 0).then(|| format!("{damaged} of the finished cases were damaged or changed: run again")),
    );
    let interrupted = heeded_interrupt()?;
    let bar = progress::bar(
        Some(missing.len() as u64),
        "{pos} of {len} cases [{bar:40}] {percent} %, {elapsed} elapsed, {eta} left",
    );
    let ran = sweep.run(&missing, threads.map_or_else(cores, usize::from), &interrupted, || bar.inc(1));
    bar.finish_and_clear();
    // Also of a sweep that could not go on.
    let counts = sweep.write_summary(&output)?;
    ran?;
    let there = sweep.names.iter().filter(|name| name.is_ok()).count() - missing.len();
    let there = if collect { String::new() } else { format!("; {there} of them were there already") };
    say(&format!(
        "{} done, {} failed, {} not run{there}\nsummary          {}\n",
        counts.done,
        counts.failed,
        counts.not_run,
        output.join("summary.csv").display()
    ))?;
    for number in runs {
        // Those of other shards are theirs.
        if let Some(case) = (0..sweep.names.len()).find(|case| sweep.cases.number(*case) == number) {
            keep_run(&sweep, case, &interrupted)?;
        }
    }
    tell(shard::told(&left));
    // In the end, where it is seen.
    if let Some((case, warning)) = &counts.first_warning {
        say(&format!("WARNINGS         in {} cases, as in case {case}: {warning}\n", counts.warned))?;
    }
    if interrupted.load(Ordering::Relaxed) {
        tell(["interrupted; the same command goes on".to_string()]);
        return Ok(ExitCode::from(INTERRUPTED));
    }
    if counts.failed + counts.not_run > 0 {
        return Ok(ExitCode::from(INCOMPLETE));
    }
    Ok(ExitCode::SUCCESS)
}

/// Keeps the whole run of a case, counted from 0, if it is not kept yet; that of a case that fails, too, as far as it came.
fn keep_run(sweep: &Sweep, case: usize, interrupted: &Arc<AtomicBool>) -> Result<(), Box<dyn Error>> {
    let number = sweep.cases.number(case);
    let name = match &sweep.names[case] {
        Ok(name) => name,
        Err(why) => {
            tell([format!("case {number} has no run: {why}")]);
            return Ok(());
        }
    };
    let kept = sweep.store.run(name)?;
    if !kept.is_dir() {
        let part = aside(&kept);
        let words = format!("case {number}: ");
        let ended = match MachineScene::edited(&sweep.cases.text_of(&sweep.base, case)?) {
            Ok(scene) => {
                let place = Place { output: part.clone(), choice: Choice::default(), said: Said::Nothing };
                let player = Player { interrupted: Arc::clone(interrupted), words };
                simulate(&player, &scene, &place, false, MOST_ROUNDS, false).map(drop)
            }
            Err(why) => Err(why.into()),
        };
        if let Err(why) = ended {
            tell([format!("case {number}: {why}")]);
        }
        if interrupted.load(Ordering::Relaxed) || !part.join(record::FILE).is_file() {
            // It may not have been begun.
            let _ = fs::remove_dir_all(part);
            return Ok(());
        }
        fs::rename(&part, &kept).map_err(|why| format!("cannot write {}: {why}", kept.display()))?;
    }
    Ok(say(&format!("{:<17}{}\n", format!("run {number}"), kept.display()))?)
}
