//! `roulement contact`: single rolling contacts of a table, their forces or with `--field` their tractions; with `--film` those of a scene ([`super::film`]).

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use roulement::analysis::single_contact::{ContactError, Law, RollingContact, RollingForces, ScaledContact};
use roulement::kalker::half_space::LARGEST_CHANGE;
use roulement::schema::regular;
use roulement_cli::exact::answer;
use roulement_cli::exact::cache::Cache;
use roulement_cli::field::{figure, write_cells, write_head};
use roulement_cli::progress::{self, ProgressBar};

use super::interrupt::{INTERRUPTED, heeded_interrupt};
use super::{film, tell};

/// Options of `roulement contact`.
#[derive(Args)]
pub struct Options {
    /// Table of cases: id, poisson_ratio, shear_modulus \[Pa], friction, peak_pressure \[Pa], semi_axis_x \[m],
    /// semi_axis_y \[m], rolling_angle \[rad], creep_x, creep_y, spin [1/m]; other columns are ignored.
    #[arg(required_unless_present = "film")]
    cases: Option<PathBuf>,
    /// Creep law.
    #[arg(long, value_enum, required_unless_present_any = ["film", "field"])]
    law: Option<LawChoice>,
    /// Degree of the traction polynomials of `kalker`, 1 to 7.
    #[arg(long, default_value_t = 5)]
    degree: usize,
    /// Cells across the ellipse of the coarser grid of `reference`, 4 to 128.
    #[arg(long, default_value_t = 16)]
    grid: usize,
    /// With `kalker_table`: the nonlinear theory itself in place of its table, in any direction of rolling. The half-space
    /// solver computes every contact on grids as fine as it needs; answers are kept in the user's cache directory.
    #[arg(long, conflicts_with_all = ["degree", "grid"])]
    exact: bool,
    /// With `--exact`: neither read nor write the cache.
    #[arg(long, requires = "exact")]
    no_cache: bool,
    /// Writes where each contact of the table sticks and slips, by the half-space solver: `field.csv` and `field.svg` in this folder,
    /// slip over the speed of rolling.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["film", "law", "degree", "grid", "exact"])]
    field: Option<PathBuf>,
    /// With `--field`: cells across the ellipse, 8 to 128.
    #[arg(long, default_value_t = 32, requires = "field", value_parser = clap::value_parser!(u16).range(8..=128))]
    cells: u16,
    #[command(flatten)]
    film: film::Options,
}

/// A creep law by its name in the one list of laws.
#[derive(Clone, Copy, PartialEq)]
struct LawChoice {
    name: &'static str,
    what: &'static str,
}

/// Name of the law that `--exact` replaces.
const TABLE: &str = "kalker_table";
/// All but that of `--exact`, which is an option of its own.
static CHOICES: LazyLock<Vec<LawChoice>> = LazyLock::new(|| {
    Law::names().filter(|(name, _)| *name != "exact").map(|(name, what)| LawChoice { name, what }).collect()
});

impl ValueEnum for LawChoice {
    fn value_variants<'a>() -> &'a [Self] {
        &CHOICES
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let value = PossibleValue::new(self.name).help(self.what.trim_end_matches('.'));
        Some(if self.name == TABLE { value.alias("kalker-table") } else { value })
    }
}

/// Evaluates the contacts and prints their forces; at Ctrl-C those that are there.
///
/// # Errors
/// If a case cannot be read or evaluated.
pub fn run(options: &Options) -> Result<ExitCode, Box<dyn Error>> {
    let Some(cases) = &options.cases else { return film::run(&options.film) };
    let cannot_read = |why: csv::Error| format!("{}: {why}", cases.display());
    let text = regular::text(cases).map_err(|why| cannot_read(why.into()))?;
    let mut table = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let cases = table.deserialize::<RollingContact>().map(|case| case.map_err(cannot_read));
    let Some(choice) = options.law else {
        return match &options.field {
            Some(folder) => fields(&cases.collect::<Result<Vec<_>, _>>()?, folder, options.cells.into()),
            None => Err("--law says by what the contacts of the table are computed".into()),
        };
    };
    if options.exact && choice.name != TABLE {
        return Err(format!(
            "--exact is an option of --law kalker_table, not of {}: it puts the nonlinear theory itself in the place of its \
             table",
            choice.name
        )
        .into());
    }
    let mut answers = csv::Writer::from_writer(std::io::stdout().lock());
    let interrupted = heeded_interrupt()?;
    let ended = || {
        let ended = interrupted.load(Ordering::Relaxed);
        tell(ended.then(|| "interrupted: the contacts that were evaluated are printed".to_string()));
        if ended { ExitCode::from(INTERRUPTED) } else { ExitCode::SUCCESS }
    };
    if options.exact {
        for forces in exact(&cases.collect::<Result<Vec<_>, _>>()?, options.no_cache, &interrupted)? {
            answers.serialize(forces)?;
        }
        answers.flush()?;
        return Ok(ended());
    }
    let law = Law::named(choice.name, options.degree, options.grid).ok_or("no such law")?;
    let mut rough: Option<([f64; 2], u32)> = None;
    for case in cases {
        if interrupted.load(Ordering::Relaxed) {
            break;
        }
        let case = case?;
        answers.serialize(case.evaluate(law)?)?;
        if let Some(error) = case.expected_error(law) {
            rough = Some((error, rough.map_or(0, |(_, count)| count) + 1));
        }
    }
    answers.flush()?;
    tell(rough.map(|([force, moment], count)| {
        let roll = if count == 1 { "rolls" } else { "roll" };
        format!(
            "{count} of these contacts {roll} obliquely to the axes of their ellipse, where `kalker_table` is expected \
             to be wrong by {force} of mu N (moment {moment} of mu N c) in the mean; --exact computes them to 0.003"
        )
    }));
    Ok(ended())
}

/// Writes the fields of contacts, and prints the forces that their tractions have; at Ctrl-C those that are there.
fn fields(cases: &[RollingContact], folder: &Path, cells: usize) -> Result<ExitCode, Box<dyn Error>> {
    // Whatever is out of range is told before anything is computed.
    let causes = cases.iter().map(RollingContact::field_cause).collect::<Result<Vec<_>, _>>()?;
    if cases.is_empty() {
        return Err("the table has no contact".into());
    }
    let interrupted = heeded_interrupt()?;
    let mut answers = csv::Writer::from_writer(std::io::stdout().lock());
    let mut drawn = vec![];
    let progress = progress_bar();
    progress.set_length(cases.len() as u64);
    std::fs::create_dir_all(folder).map_err(|why| format!("cannot make {}: {why}", folder.display()))?;
    let (path, picture) = (folder.join("field.csv"), folder.join("field.svg"));
    let cannot_write = |why: csv::Error| format!("{}: {why}", path.display());
    let mut table = csv::Writer::from_path(&path).map_err(cannot_write)?;
    write_head(&mut table, &["id"], false).map_err(cannot_write)?;
    for (case, cause) in cases.iter().zip(&causes) {
        if interrupted.load(Ordering::Relaxed) {
            break;
        }
        let field = cause.field(cells).map_err(|why| ContactError::Reference(case.id.clone(), why))?;
        write_cells(&mut table, std::slice::from_ref(&case.id), &field).map_err(cannot_write)?;
        answers.serialize(RollingForces { stick: Some(field.stick), ..case.with_forces(&field.forces) })?;
        if drawn.len() < figure::MOST {
            drawn.push((case.id.clone(), case.friction, field));
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    table.flush().map_err(|why| cannot_write(why.into()))?;
    answers.flush()?;
    figure::write(&picture, "Tractions and slip over the contact ellipse", &drawn)?;
    tell([format!("{} and {}", path.display(), picture.display())]);
    tell(
        (cases.len() > figure::MOST).then(|| format!("the picture has the first {} contacts", figure::MOST)),
    );
    let ended = interrupted.load(Ordering::Relaxed);
    tell(ended.then(|| "interrupted: the fields that were computed are written".to_string()));
    Ok(if ended { ExitCode::from(INTERRUPTED) } else { ExitCode::SUCCESS })
}

/// Forces of contacts by the half-space solver, from the cache where it has them.
fn exact(
    cases: &[RollingContact],
    no_cache: bool,
    interrupted: &AtomicBool,
) -> Result<Vec<RollingForces>, Box<dyn Error>> {
    // Whatever is out of range is told before anything is computed.
    let contacts = cases.iter().map(RollingContact::scaled).collect::<Result<Vec<ScaledContact>, _>>()?;
    let (mut cache, note) =
        if no_cache { (Cache::none(), None) } else { Cache::open(env!("ROULEMENT_VERSION")) };
    tell(note);
    let begin = Instant::now();
    let progress = progress_bar();
    let found = answer(&contacts, &mut cache, interrupted, &progress);
    progress.finish_and_clear();
    let mut forces = Vec::with_capacity(cases.len());
    let (mut rough, mut largest) = (0, 0.0f64);
    for (case, answer) in cases.iter().zip(&found.answers) {
        let Some(answer) = answer else { continue };
        let answer = answer.as_ref().map_err(|why| ContactError::Reference(case.id.clone(), *why))?;
        forces.push(case.with_forces(&answer.forces));
        if answer.change > LARGEST_CHANGE {
            rough += 1;
            largest = largest.max(answer.change);
        }
    }
    let place =
        cache.path().map_or(String::new(), |path| format!("; answers are kept in {}", path.display()));
    tell([format!(
        "{} contacts, {} of them computed in {:.1} s{place}",
        cases.len(),
        found.computed,
        begin.elapsed().as_secs_f64()
    )]);
    tell(found.unsaved);
    tell((rough > 0).then(|| {
        format!("{rough} of these contacts still change by up to {largest:.3} with the grid: expect errors of a third of that")
    }));
    Ok(forces)
}

fn progress_bar() -> ProgressBar {
    progress::bar(Some(0), "contacts {pos} of {len} [{bar:40}] {elapsed} elapsed, {eta} left")
}
