//! Where the results of a run go: tables, plots, means, summaries, records.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use roulement::analysis::estimate::Verdicts;
use roulement::scene::machine::MachineScene;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::System;
use roulement_cli::page::record;
use roulement_cli::report::figures::{Figures, Shown};
use roulement_cli::report::json;
use roulement_cli::report::losses::Closed;
use roulement_cli::report::phases;
use roulement_cli::report::plots::{title, write_plots};
use roulement_cli::report::results::{Choice, MachineColumns, PartColumns, ResultsError, is_parquet};
use roulement_cli::report::shaft;
use roulement_cli::report::spectrum;
use roulement_cli::report::tables::Tables;
use roulement_cli::watch::{BearingSeen, Phase, ShaftSeen};

use super::player::{End, Played};
use super::summary;
use super::{say, tell};

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

/// Where the results of a run go. Those of a shaft are a directory with one of each bearing in it.
pub struct Place {
    /// Directory, or the file of the table.
    pub output: PathBuf,
    /// What the tables have.
    pub choice: Choice,
    /// How the summary is said.
    pub said: Said,
}

impl Place {
    /// Is it a directory, and has all files?
    fn has_files(&self) -> bool {
        !is_parquet(&self.output)
    }

    /// Directory of a bearing.
    fn of_bearing(&self, name: &str) -> PathBuf {
        if name.is_empty() { self.output.clone() } else { self.output.join(name) }
    }

    /// Table of a bearing; of a round until it is whole.
    fn table(&self, name: &str, of_round: bool) -> PathBuf {
        match (self.has_files(), of_round) {
            (true, false) => self.of_bearing(name).join("results.csv"),
            (true, true) => self.of_bearing(name).join("results.csv.round"),
            (false, false) => self.output.clone(),
            (false, true) => self.output.with_extension("round.parquet"),
        }
    }

    /// Table of the shaft; of a round until it is whole.
    fn table_of_shaft(&self, of_round: bool) -> PathBuf {
        self.output.join(if of_round { "shaft.csv.round" } else { "shaft.csv" })
    }

    /// Takes the place for a run: nothing of a former one stays that could be taken for a part of it.
    ///
    /// # Errors
    /// If a chosen column is not there, or files cannot be written or removed.
    pub fn begin(&self, scene: &MachineScene, machine: &Machine) -> Result<(), Box<dyn Error>> {
        // Before anything of a former run goes.
        if self.has_files() {
            PartColumns::new(scene, &self.choice)?;
        } else {
            MachineColumns::new(machine, &self.choice)?;
        }
        let begin = |directory: &Path| {
            record::begin(directory).map_err(|why| format!("cannot begin in {}: {why}", directory.display()))
        };
        if self.has_files() {
            begin(&self.output)?;
            for (name, _) in scene.bearings().into_iter().filter(|(name, _)| !name.is_empty()) {
                begin(&self.of_bearing(name))?;
            }
        }
        Ok(())
    }

    /// Begins the tables of a run; of a round beside those that are there.
    ///
    /// # Errors
    /// If files cannot be written.
    pub fn tables(
        &self,
        scene: &MachineScene,
        machine: &Machine,
        of_round: bool,
    ) -> Result<Tables, ResultsError> {
        let of_bearing = |name: &str| self.table(name, of_round);
        match self.has_files() {
            true => Tables::each(scene, &self.choice, of_bearing, &self.table_of_shaft(of_round)),
            false => Tables::whole(machine, &self.choice, &of_bearing("")),
        }
    }

    /// Puts the finished tables of a round in the place of those that are there.
    ///
    /// # Errors
    /// If a file cannot be moved.
    pub fn put_round(&self, scene: &MachineScene) -> Result<(), String> {
        for [from, to] in self.rounds(scene) {
            fs::rename(&from, &to)
                .map_err(|why| format!("cannot move {} to {}: {why}", from.display(), to.display()))?;
        }
        Ok(())
    }

    /// Removes the tables of a round that is not whole.
    pub fn drop_round(&self, scene: &MachineScene) {
        for [from, _] in self.rounds(scene) {
            // It may not have been begun.
            let _ = fs::remove_file(from);
        }
    }

    /// Tables of a round, and where they belong.
    fn rounds(&self, scene: &MachineScene) -> impl Iterator<Item = [PathBuf; 2]> {
        let names = match self.has_files() {
            true => scene.bearings().into_iter().map(|(name, _)| name).collect(),
            false => vec![""],
        };
        let shaft = scene.shaft().filter(|_| self.has_files());
        let shaft = shaft.map(|_| [true, false].map(|round| self.table_of_shaft(round)));
        let tables = names.into_iter().map(|name| [true, false].map(|round| self.table(name, round)));
        tables.chain(shaft)
    }

    /// Leaves plots, means, summaries and records of a run, and says the summary. Verdicts are those of every bearing; error bars, of
    /// every bearing and then of the shaft, and a report of errors are those of runs that were compared.
    ///
    /// # Errors
    /// If files cannot be written, or nothing can be said.
    pub fn leave(
        &self,
        played: &Played,
        verdicts: &[Verdicts],
        bars: Option<Vec<Figures>>,
        errors: &str,
    ) -> Result<(), Box<dyn Error>> {
        let figures = played.seen.figures(&played.machine).into_iter();
        let shown: Vec<Shown> = match bars {
            Some(bars) => {
                figures.zip(bars).map(|(figures, bars)| Shown { figures, bars: Some(bars) }).collect()
            }
            None => figures.map(|figures| Shown { figures, bars: None }).collect(),
        };
        let is_shaft = played.machine.shaft().is_some();
        let mut text = String::new();
        let mut listed = String::new();
        for (index, (name, bearing)) in played.machine.bearings().enumerate() {
            let (shown, seen) = (&shown[index], &played.seen.bearings[index]);
            let of_bearing = summary::of_bearing(played, (bearing, seen), shown, &verdicts[index]);
            let of_bearing = if is_shaft { of_bearing } else { of_bearing + errors };
            let directory = self.of_bearing(name);
            if self.has_files() {
                let own = Own { simulation: bearing, seen, shown, verdicts: &verdicts[index] };
                let plots = self.write_bearing(played, index, &own, &directory, &of_bearing)?;
                if is_shaft {
                    let directory = directory.display();
                    listed += &format!("bearing          {directory} (roulement report {directory})\n");
                } else {
                    plots.iter().for_each(|plot| listed += &format!("plot             {}\n", plot.display()));
                }
            }
            if !is_shaft {
                text = of_bearing;
                listed = format!("results          {}\n{listed}", self.table(name, false).display());
            }
        }
        if let (Some(system), Some(seen), Some((of_shaft, of_bearings))) =
            (played.machine.shaft(), &played.seen.shaft, shown.split_last())
        {
            text = summary::of_shaft(played, (system, seen), of_shaft, of_bearings) + errors;
            listed = match self.has_files() {
                true => {
                    let plot = self.write_shaft(played, (system, seen), of_shaft, &text)?;
                    format!(
                        "results          {}\nplot             {}\n{listed}",
                        self.table_of_shaft(false).display(),
                        plot.display()
                    )
                }
                false => format!("results          {}\n", self.output.display()),
            };
        }
        let listed = match self.said {
            Said::Nothing => return Ok(()),
            Said::Json => format!("{:#}\n", json::of_machine(&played.machine, &played.seen, &shown)),
            Said::Text => format!("{text}\n{listed}"),
        };
        tell(played.seen.remarks(&played.machine));
        let said = say(&listed);
        // Why a run has ended early is said even where nobody reads the summary.
        if matches!(played.end, End::Reached) {
            said?;
        }
        Ok(())
    }

    /// Writes all files of a bearing beside its table; gives those of the plots.
    fn write_bearing(
        &self,
        played: &Played,
        index: usize,
        own: &Own<'_>,
        directory: &Path,
        text: &str,
    ) -> Result<Vec<PathBuf>, Box<dyn Error>> {
        let Own { simulation, seen, shown, verdicts } = *own;
        let (scene, rows) = (simulation.scene(), &played.plotted[index]);
        let mut plots = write_plots(scene, rows, directory)?;
        if let Some(means) = &seen.part.means {
            let life = seen.life.map_or(vec![], |life| life.numbers());
            let closed = seen.part.closed.iter().flat_map(Closed::numbers);
            let others: Vec<_> = closed.chain(life).collect();
            write(&directory.join("means.csv"), |path| means.write(path, &others))?;
        }
        write_phases(directory, &seen.part.phases, shown)?;
        if let Some(spectrum) = &seen.spectrum {
            write(&directory.join("spectrum.csv"), |path| spectrum.write(path))?;
            let picture = directory.join("spectrum.svg");
            spectrum::picture::write(spectrum, title(scene), &picture)?;
            plots.push(picture);
        }
        write(&directory.join("summary.txt"), |path| fs::write(path, text))?;
        let record = record::Run {
            simulation,
            rows,
            seen,
            shown,
            verdicts,
            summary: text,
            took: [played.wall.as_secs_f64(), played.cpu],
            ended_early: played.end.early(),
        };
        write(&directory.join(record::FILE), |path| record.write(path))?;
        Ok(plots)
    }

    /// Writes all files of a shaft beside its table; gives that of the plot.
    fn write_shaft(
        &self,
        played: &Played,
        (system, seen): (&System, &ShaftSeen),
        shown: &Shown,
        text: &str,
    ) -> Result<PathBuf, Box<dyn Error>> {
        let plot = shaft::write_plot(system.scene(), &played.plotted_shaft, &self.output)?;
        if let Some(means) = &seen.part.means {
            write(&self.output.join("means.csv"), |path| means.write(path, &[]))?;
        }
        write_phases(&self.output, &seen.part.phases, shown)?;
        write(&self.output.join("summary.txt"), |path| fs::write(path, text))?;
        let record = record::ShaftRun {
            system,
            rows: &played.plotted_shaft,
            seen,
            shown,
            warnings: played.seen.warnings(&played.machine),
            summary: text,
            took: [played.wall.as_secs_f64(), played.cpu],
            ended_early: played.end.early(),
        };
        write(&self.output.join(record::FILE), |path| record.write(path))?;
        Ok(plot)
    }
}

/// A bearing at the end of a run, and what is said of it.
struct Own<'a> {
    simulation: &'a Simulation,
    seen: &'a BearingSeen,
    shown: &'a Shown,
    verdicts: &'a Verdicts,
}

/// Writes the table of phases, where there are some.
fn write_phases(directory: &Path, phases: &[Phase], shown: &Shown) -> Result<(), String> {
    if phases.is_empty() {
        return Ok(());
    }
    write(&directory.join(phases::FILE), |path| phases::write(path, phases, shown.bars.as_ref()))
}

/// Writes a file, with its name in the error.
fn write(path: &Path, write: impl FnOnce(&Path) -> std::io::Result<()>) -> Result<(), String> {
    write(path).map_err(|why| format!("cannot write {}: {why}", path.display()))
}
