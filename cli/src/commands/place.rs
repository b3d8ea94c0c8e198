//! Where the results of a run go: tables, plots, means, summaries, records.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use roulement::analysis::estimate::Verdicts;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement_cli::duty::DutyRating;
use roulement_cli::duty::say::with_duty;
use roulement_cli::page::{self, history, record};
use roulement_cli::report;
use roulement_cli::report::figures::{Figures, Shown};
use roulement_cli::report::json;
use roulement_cli::report::losses::Closed;
use roulement_cli::report::machine_columns::{MachineColumns, PartColumns};
use roulement_cli::report::phases;
use roulement_cli::report::plots::{title, write_plots};
use roulement_cli::report::results::{Choice, ResultsError, is_parquet};
use roulement_cli::report::spectrum;
use roulement_cli::report::tables::Tables;
use roulement_cli::watch::{Life, Part};

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

/// What is found about a scene beside its run.
pub struct Judged {
    /// Verdicts on effects, of every bearing.
    pub verdicts: Vec<Verdicts>,
    /// Rating over its duty, if it has one.
    pub duty: Option<DutyRating>,
    /// Warnings of motions that grow.
    pub growing: Vec<String>,
}

/// Where the results of a run go. Those of a shaft are a directory with one of each bearing in it.
pub struct Place {
    /// Directory, or the file of the table.
    pub output: PathBuf,
    /// Columns and time window of the tables.
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

    /// Table of a bearing, or of the shaft; of a round until it is whole.
    fn table(&self, name: &str, of_shaft: bool, of_round: bool) -> PathBuf {
        let file = if of_shaft { "shaft.csv" } else { "results.csv" };
        match (self.has_files(), of_round) {
            (true, false) => self.of_bearing(name).join(file),
            (true, true) => self.of_bearing(name).join(format!("{file}.round")),
            (false, false) => self.output.clone(),
            (false, true) => self.output.with_extension("round.parquet"),
        }
    }

    /// Looks whether the chosen columns are there.
    ///
    /// # Errors
    /// If one is not.
    pub fn check_columns(&self, scene: &MachineScene, machine: &Machine) -> Result<(), ResultsError> {
        match self.has_files() {
            true => PartColumns::new(scene, &self.choice).map(drop),
            false => MachineColumns::new(machine, &self.choice).map(drop),
        }
    }

    /// Takes the place for a run: nothing of a former one stays that could be taken for a part of it.
    ///
    /// # Errors
    /// If files cannot be written or removed.
    pub fn begin(&self, scene: &MachineScene) -> Result<(), Box<dyn Error>> {
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
        let of_bearing = |name: &str| self.table(name, false, of_round);
        match self.has_files() {
            true => Tables::each(scene, &self.choice, of_bearing, &self.table("", true, of_round)),
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
        let mut tables = vec![];
        if self.has_files() {
            tables.extend(scene.bearings().into_iter().map(|(name, _)| (name, false)));
            tables.extend(scene.shaft().map(|_| ("", true)));
        } else {
            tables.push(("", false));
        }
        let path = |(name, of_shaft)| [true, false].map(|round| self.table(name, of_shaft, round));
        tables.into_iter().map(path)
    }

    /// Leaves plots, means, summaries and records of a run, and says the summary. Error bars, of every bearing and then of the shaft, and a report
    /// of errors are those of runs that were compared.
    ///
    /// # Errors
    /// If files cannot be written, or nothing can be said.
    pub fn leave(
        &self,
        played: &Played,
        judged: &Judged,
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
        let (mut text, mut listed) = (String::new(), String::new());
        for (index, ((name, part), own)) in played.seen.parts(&played.machine).zip(&shown).enumerate() {
            text = match part {
                Part::Bearing(bearing, seen) => {
                    summary::of_bearing(played, (bearing, seen), own, &judged.verdicts[index])
                }
                Part::Shaft(system, seen) => summary::of_shaft(played, (system, seen), own, &shown[..index]),
            };
            // The last part stands for the machine.
            let is_whole = index + 1 == shown.len();
            let duty = judged.duty.as_ref().filter(|_| is_whole);
            if is_whole {
                text += errors;
                text += &duty.map_or(String::new(), |duty| format!("\n{duty}"));
            }
            let plots = match self.has_files() {
                true => self.write_part(
                    played,
                    (index, name, part),
                    own,
                    (judged.verdicts.get(index), duty),
                    &text,
                )?,
                false => vec![],
            };
            if is_whole {
                let table = self.table("", matches!(part, Part::Shaft(..)), false);
                let plots = plots.iter().map(|plot| format!("plot             {}\n", plot.display()));
                listed =
                    format!("results          {}\n{}{listed}", table.display(), plots.collect::<String>());
            } else if self.has_files() {
                let directory = self.of_bearing(name);
                let directory = directory.display();
                listed += &format!("bearing          {directory} (roulement report {directory})\n");
            }
        }
        let listed = match self.said {
            Said::Nothing => return Ok(()),
            Said::Json => {
                let report = json::of_machine(&played.machine, &played.seen, &shown);
                format!("{:#}\n", with_duty(report, judged.duty.as_ref()))
            }
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

    /// Writes all files of a part of the machine beside its table; gives those of the plots.
    fn write_part(
        &self,
        played: &Played,
        (index, name, part): (usize, &str, Part<'_>),
        shown: &Shown,
        (verdicts, duty): (Option<&Verdicts>, Option<&DutyRating>),
        text: &str,
    ) -> Result<Vec<PathBuf>, Box<dyn Error>> {
        let directory = self.of_bearing(name);
        let (gathered, mut plots, mut numbers) = (part.gathered(), vec![], vec![]);
        let (history, work);
        match part {
            Part::Bearing(bearing, seen) => {
                let rows = &played.plotted[index];
                plots.extend(write_plots(bearing.scene(), rows, &directory)?);
                if let Some(spectrum) = &seen.spectrum {
                    write(&directory.join("spectrum.csv"), |path| spectrum.write(path))?;
                    let picture = directory.join("spectrum.svg");
                    spectrum::picture::write(spectrum, title(bearing.scene()), &picture)?;
                    plots.push(picture);
                }
                numbers.extend(gathered.closed.iter().flat_map(Closed::numbers));
                numbers.extend(seen.life.iter().flat_map(Life::numbers));
                (history, work) = (history::columns(rows), bearing.outputs().statistics);
            }
            Part::Shaft(system, _) => {
                let rows = &played.plotted_shaft;
                plots.push(report::shaft::write_plot(system.scene(), rows, &directory)?);
                (history, work) = (page::shaft::columns(system, rows), played.machine.statistics());
            }
        }
        if let Some(means) = &gathered.means {
            write(&directory.join("means.csv"), |path| means.write(path, &numbers))?;
        }
        if !gathered.phases.is_empty() {
            let bars = shown.bars.as_ref();
            write(&directory.join(phases::FILE), |path| phases::write(path, &gathered.phases, bars))?;
        }
        write(&directory.join("summary.txt"), |path| fs::write(path, text))?;
        let record = record::Run {
            part,
            history,
            shown,
            warnings: if name.is_empty() { played.seen.warnings(&played.machine) } else { part.warnings() },
            verdicts,
            duty,
            summary: text,
            took: [played.wall.as_secs_f64(), played.cpu],
            work,
            ended_early: played.end.early(),
        };
        write(&directory.join(record::FILE), |path| record.write(path))?;
        Ok(plots)
    }
}

/// Writes a file, with its name in the error.
fn write(path: &Path, write: impl FnOnce(&Path) -> std::io::Result<()>) -> Result<(), String> {
    write(path).map_err(|why| format!("cannot write {}: {why}", path.display()))
}
