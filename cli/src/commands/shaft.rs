//! `roulement run` of a shaft with its bearings: a table of the shaft, and of every bearing all that a run of it alone leaves.

use std::error::Error;
use std::fs;
use std::io;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use cpu_time::ThreadTime;
use roulement::analysis::estimate;
use roulement::scene::system::SystemScene;
use roulement::schema::regular;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::Rows;
use roulement::simulation::system::{System, SystemOutputs};
use roulement_cli::page::record;
use roulement_cli::report::figures::Shown;
use roulement_cli::report::json;
use roulement_cli::report::results::{Choice, Columns, ResultsWriter, is_parquet};
use roulement_cli::report::shaft::{self, ShaftTable};
use roulement_cli::report::thinned::Thinned;
use roulement_cli::watch::Watch;

use super::player::{End, Played, progress_bar};
use super::run::{INTERRUPTED, Place, Said};
use super::{say, tell};

/// Is this the file of a shaft with bearings? One that cannot be read is not.
pub fn is_system(path: &Path) -> bool {
    regular::text(path).is_ok_and(|text| SystemScene::is_system(&text))
}

/// What is gathered of a bearing while its shaft runs.
struct Gathered {
    table: ResultsWriter,
    plotted: Thinned<Outputs>,
    watch: Watch,
}

/// Simulates a shaft into a directory, with words before its progress. What has been simulated until an error or Ctrl-C is kept.
///
/// # Errors
/// If the simulation cannot start or go on, or files cannot be written.
pub fn run(
    interrupted: &Arc<AtomicBool>,
    words: &str,
    scene: &SystemScene,
    output: &Path,
    choice: &Choice,
    said: Said,
) -> Result<ExitCode, Box<dyn Error>> {
    if is_parquet(output) {
        return Err(format!(
            "{}: a shaft's results are a directory, a table for each bearing",
            output.display()
        )
        .into());
    }
    let mut system = System::new(scene)?;
    // Before anything of a former run goes.
    for (_, bearing) in system.bearings() {
        drop(Columns::new(bearing.scene(), choice)?);
    }
    let begun = |directory: &Path, begun: io::Result<()>| {
        begun.map_err(|why| format!("cannot begin in {}: {why}", directory.display()))
    };
    begun(output, record::begin_shaft(output))?;
    let gathered = |(name, bearing): (&str, &roulement::Simulation)| -> Result<Gathered, Box<dyn Error>> {
        let directory = output.join(name);
        begun(&directory, record::begin(&directory))?;
        Ok(Gathered {
            table: ResultsWriter::create(&directory.join("results.csv"), bearing.scene(), choice)?,
            plotted: Thinned::default(),
            watch: Watch::of(bearing),
        })
    };
    let mut gathered = system.bearings().map(gathered).collect::<Result<Vec<_>, _>>()?;
    let written = |why: std::io::Error| format!("cannot write {}: {why}", output.join("shaft.csv").display());
    let mut table = ShaftTable::create(&output.join("shaft.csv"), scene, choice.window).map_err(written)?;
    let rows = Rows { interval: scene.load.output_interval.0, duration: scene.load.duration.0 };
    let progress = progress_bar(rows.count(), words);
    let (begin, cpu) = (Instant::now(), ThreadTime::now());
    let mut shaft_rows: Thinned<SystemOutputs> = Thinned::default();
    let mut end = End::Reached;
    let mut times = rows.times();
    loop {
        table.write(system.outputs()).map_err(written)?;
        shaft_rows.push(system.outputs().clone());
        for ((_, bearing), gathered) in system.bearings().zip(&mut gathered) {
            gathered.table.write(bearing.inputs(), bearing.outputs())?;
            gathered.watch.push(bearing);
            gathered.plotted.push(bearing.outputs().clone());
        }
        progress.set_message(format!("{:.3} of {:.3} ms", system.time() * 1e3, rows.duration * 1e3));
        progress.set_position(shaft_rows.seen());
        if !matches!(end, End::Reached) {
            break;
        }
        if interrupted.load(Ordering::Relaxed) {
            end = End::Interrupted;
            break;
        }
        let Some(next) = times.next() else { break };
        if let Err(why) = system.advance(next) {
            end = End::Failed(why.to_string());
        }
    }
    progress.finish_and_clear();
    let (wall, cpu) = (begin.elapsed(), cpu.elapsed().as_secs_f64());
    let mut means = vec![];
    let mut values = serde_json::Map::new();
    for ((name, bearing), gathered) in system.bearings().zip(gathered) {
        gathered.table.finish()?;
        let own_end = match &end {
            End::Reached => End::Reached,
            End::Interrupted => End::Interrupted,
            End::Failed(why) => End::Failed(why.clone()),
        };
        let played = Played {
            simulation: bearing.clone(),
            plotted: gathered.plotted.finish(),
            seen: gathered.watch.finish(),
            wall,
            cpu,
            end: own_end,
        };
        let place =
            Place { output: output.join(name), files: true, choice: choice.clone(), said: Said::Nothing };
        let verdicts = estimate::verdicts(bearing.scene(), bearing.model());
        place.leave(&played, &verdicts, None, "")?;
        if said != Said::Nothing {
            let warning = bearing.outputs().life.and_then(|life| life.warning());
            tell(warning.map(|warning| format!("bearing {name}: {warning}")));
        }
        let shown = Shown { figures: played.figures(), bars: None };
        values.insert(name.to_string(), json::summary(bearing, &played.seen, &shown));
        let figure = |name: &str| shown.figures.get(name);
        let settled = played.seen.means.as_ref();
        means.push(settled.map(|_| [figure("friction power"), figure("friction torque")]));
    }
    let mut text = shaft::summary(&system, &means);
    let creeping = shaft::creeping(&system);
    if let Some(creeping) = &creeping {
        text += &format!("WARNING          {creeping}\n");
    }
    let statistics =
        system.bearings().next().map(|(_, bearing)| bearing.state().statistics).unwrap_or_default();
    let seconds = wall.as_secs_f64();
    text += &format!(
        "steps            {} accepted, {} rejected by error, {} by Newton; {:.2} Newton iterations a step\n\
         wall time        {seconds:.3} s, {:.2} s per simulated second\n",
        statistics.steps,
        statistics.rejected_error,
        statistics.rejected_newton,
        statistics.newton.iterations as f64 / statistics.steps.max(1) as f64,
        seconds / system.time().max(f64::MIN_POSITIVE)
    );
    let summary = output.join("summary.txt");
    fs::write(&summary, &text).map_err(|why| format!("cannot write {}: {why}", summary.display()))?;
    let plot = shaft::write_plot(scene, &shaft_rows.finish(), output)?;
    if said == Said::Json {
        tell(creeping.map(|creeping| format!("warning: {creeping}")));
        text = format!("{:#}\n", serde_json::Value::Object(values));
    } else {
        text += &format!(
            "\nresults          {}\nplot             {}\n",
            output.join("shaft.csv").display(),
            plot.display()
        );
        for mounted in &scene.bearings {
            let directory = output.join(&mounted.name);
            text += &format!(
                "bearing          {} (roulement report {})\n",
                directory.display(),
                directory.display()
            );
        }
    }
    let said = if said == Said::Nothing { Ok(()) } else { say(&text) };
    match end {
        End::Reached => said.map(|()| ExitCode::SUCCESS).map_err(Into::into),
        End::Interrupted => {
            tell([format!("interrupted at {:.3} ms", system.time() * 1e3)]);
            Ok(ExitCode::from(INTERRUPTED))
        }
        End::Failed(why) => Err(why.into()),
    }
}
