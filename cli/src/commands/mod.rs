//! Commands and their options.

mod bearing;
mod cage;
#[cfg(not(target_family = "wasm"))]
mod check;
mod completions;
mod contact;
mod cost;
mod effects;
mod equilibrium;
mod examples;
mod export;
mod field;
mod film;
mod identify;
mod import;
mod interrupt;
mod modes;
mod place;
mod player;
mod rating;
mod report;
mod run;
mod scene;
mod summary;
mod sweep;
#[cfg(not(target_family = "wasm"))]
mod system;

use std::error::Error;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use roulement::analysis::auto;
use roulement::interface::model_description::{Edition, Version, all, render_as};
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement_cli::kinds::{Kind, other_kind};
#[cfg(not(target_family = "wasm"))]
use roulement_cli::package::{libraries_beside, library_beside_executable, name_of, write_fmu};
use roulement_cli::progress;

/// 3-D dynamic ball bearing for gearbox co-simulation.
#[derive(Parser)]
#[command(name = "roulement", version = env!("ROULEMENT_VERSION"), about, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

/// What is done. In a browser only what the page of a bearing asks for (docs/try.md).
#[derive(Subcommand)]
enum Command {
    /// Simulate a scene: result table, plots, summary.
    Run(run::Options),
    /// Say what files are, whether they can be read, what they would run and how long that would take; with notes on numbers that are unusual.
    #[cfg(not(target_family = "wasm"))]
    Check(check::Options),
    /// Solve the quasi-static equilibrium of a scene; of a shaft also its natural frequencies and critical speeds.
    Equilibrium(equilibrium::Options),
    /// Find the small motions of rings, shafts and cage about the running state, which grow or decay, over the speed.
    #[cfg(not(target_family = "wasm"))]
    Modes(modes::Options),
    /// Find the life of bearings under given loads, each with its speed and share of the time; prints CSV.
    Rating(rating::Options),
    /// Push the cage of a scene by its weight, an offset and a kick, and tell whether it is stable, rattles or whirls.
    #[cfg(not(target_family = "wasm"))]
    Cage(cage::Options),
    /// Simulate many cases of a scene on all cores: a table of keys and values, or ranges; resumable.
    #[cfg(not(target_family = "wasm"))]
    Sweep(sweep::Options),
    /// Print what may stand in a scene file: every key, or a JSON schema for editors.
    #[cfg(not(target_family = "wasm"))]
    Scene(scene::Options),
    /// Write a scene of a catalogue bearing, by name or by dimensions and load ratings, with estimated internal geometry.
    Bearing(bearing::Options),
    /// Read a gearbox from a REXS file, XML, JSON or zip, and write it as a machine: shafts, gears, bearings, oil, loads and their spectrum.
    #[cfg(not(target_family = "wasm"))]
    Import(import::Options),
    /// Write a machine as a REXS file, for programs that read gearboxes.
    #[cfg(not(target_family = "wasm"))]
    Export(export::Options),
    /// List the effects of a scene: which are on, which that are off would matter and by how much.
    Effects(effects::Options),
    /// Make one page of results: drawing, plots, spectra, playback; of a run, of several, or of a sweep.
    Report(report::Options),
    /// Pack a scene, or a shaft with its bearings, as a co-simulation FMU of FMI 2.0 or 3.0.
    #[cfg(not(target_family = "wasm"))]
    Fmu {
        /// Scene file, or file of a system.
        scene: PathBuf,
        /// Package to write.
        #[arg(short, long)]
        output: PathBuf,
        /// Shared library to pack, once per platform; the one built beside this program if not given.
        #[arg(long)]
        library: Vec<PathBuf>,
        /// Pack the libraries of all platforms that lie beside this program, as they do in the Python wheels.
        #[arg(long, conflicts_with = "library")]
        all_platforms: bool,
        /// Name of the model, and of its library; that of the package's file if not given.
        #[arg(long)]
        name: Option<String>,
        /// Outputs that the package has, with commas between, `*` for any characters, as of `run`: 'left.inner.force.*,shaft.*'; all if
        /// not given. Inputs and parameters are always there.
        #[arg(long, value_delimiter = ',', value_name = "LIST")]
        columns: Vec<String>,
        /// Version of FMI.
        #[arg(long, default_value = "2", value_name = "VERSION", value_parser = version())]
        fmi: Version,
        /// Author of the model, and the organisation: in the model description.
        #[arg(long)]
        author: Option<String>,
        /// Copyright of the model; that of the library is in the licences of the package.
        #[arg(long)]
        copyright: Option<String>,
        /// When it was made, in UTC, such as 2026-11-28T15:00:00Z; nothing if not given: the same scene then makes the same bytes.
        #[arg(long, value_parser = date)]
        date: Option<String>,
    },
    /// Write packages that are connected, as an SSP file and as an OSP system structure for libcosim, from one description.
    #[cfg(not(target_family = "wasm"))]
    System(system::Options),
    /// Write where chosen contacts of a run stick and slip at chosen times; CSV.
    #[cfg(not(target_family = "wasm"))]
    Field(field::Options),
    /// Evaluate single rolling contacts of a CSV table, and print CSV; or the oil film of a scene's contact over slip and speed.
    #[cfg(not(target_family = "wasm"))]
    Contact(contact::Options),
    /// Identify the spin coupling of the regularised creep law against Kalker's nonlinear theory.
    #[cfg(not(target_family = "wasm"))]
    Identify(identify::Options),
    /// Measure error against CPU time of every setting that trades accuracy for speed.
    #[cfg(not(target_family = "wasm"))]
    Cost(cost::Options),
    /// Print what a shell completes the commands and their options by: bash, elvish, fish, powershell or zsh.
    #[cfg(not(target_family = "wasm"))]
    Completions(completions::Options),
    /// Print the model description of a scene's package.
    #[cfg(not(target_family = "wasm"))]
    Describe {
        /// Scene file.
        scene: PathBuf,
        /// Version of FMI.
        #[arg(long, default_value = "2", value_name = "VERSION", value_parser = version())]
        fmi: Version,
    },
}

/// Reads a version of FMI.
fn version() -> impl TypedValueParser<Value = Version> {
    PossibleValuesParser::new(["2", "3"]).map(|text| if text == "3" { Version::V3 } else { Version::V2 })
}

/// Reads a date with its time as model descriptions have it.
fn date(text: &str) -> Result<String, String> {
    const FORM: &str = "0000-00-00T00:00:00Z";
    let fits = |(own, form): (char, char)| if form == '0' { own.is_ascii_digit() } else { own == form };
    let formed = text.chars().count() == FORM.len() && text.chars().zip(FORM.chars()).all(fits);
    let number =
        |at: std::ops::Range<usize>| text.get(at).and_then(|digits| digits.parse().ok()).unwrap_or(0);
    let within = |at, range: std::ops::RangeInclusive<u32>| range.contains(&number(at));
    match formed
        && within(5..7, 1..=12)
        && within(8..10, 1..=31)
        && within(11..13, 0..=23)
        && within(14..16, 0..=59)
    {
        true => Ok(text.to_string()),
        false => Err("a date and time in UTC is needed, such as 2026-11-28T15:00:00Z".to_string()),
    }
}

/// Reads a scene and finds out its effects where it asks for that; what its reader should know goes to standard error.
fn load(path: &Path) -> Result<MachineScene, Box<dyn Error>> {
    load_for(path, false)
}

/// The same, for an importer of its package or not.
fn load_for(path: &Path, importer: bool) -> Result<MachineScene, Box<dyn Error>> {
    let scene =
        MachineScene::load(path).map_err(|why| or_kind(path, &[Kind::Bearing, Kind::Machine], why))?;
    tell(scene.notes());
    let (scene, found_out) = auto::resolve_machine(scene, importer)?;
    tell(found_out);
    Ok(scene)
}

/// Why a file is refused: as it is of another kind than a command takes, or as it says itself.
fn or_kind(path: &Path, wanted: &[Kind], why: impl Error + 'static) -> Box<dyn Error> {
    other_kind(path, wanted).map_or_else(|| why.into(), Into::into)
}

/// Notes and warnings.
fn tell(notes: impl IntoIterator<Item = String>) {
    for note in notes {
        // Nobody is there to be told if that fails.
        let _ = writeln!(io::stderr(), "{note}");
    }
}

/// Results. A closed pipe or a full device is an error here and no panic.
fn say(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|why| io::Error::new(why.kind(), format!("cannot write to the standard output: {why}")))
}

/// Makes a study of many runs, which tells of another one that has ended, and of how many, and shows them on stderr.
fn with_count_of_runs<T>(study: impl FnOnce(&(dyn Fn(usize) + Sync)) -> T) -> T {
    let bar = progress::bar(Some(0), "{pos} of {len} runs [{bar:40}] {elapsed} elapsed, {eta} left");
    let made = study(&|runs| {
        bar.set_length(runs as u64);
        bar.inc(1);
    });
    bar.finish_and_clear();
    made
}

/// Reads the command line and does what it says.
///
/// # Errors
/// Whatever went wrong, as a sentence.
pub fn run() -> Result<ExitCode, Box<dyn Error>> {
    let commands = examples::with_examples(Arguments::command());
    let given = Arguments::from_arg_matches(&commands.clone().get_matches())?;
    match given.command {
        Command::Run(options) => return run::run(options),
        #[cfg(not(target_family = "wasm"))]
        Command::Sweep(options) => return sweep::run(options),
        Command::Equilibrium(options) => equilibrium::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Modes(options) => modes::run(&options)?,
        Command::Rating(options) => rating::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Cage(options) => cage::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Fmu {
            scene,
            output,
            library,
            all_platforms,
            name,
            columns,
            fmi,
            author,
            copyright,
            date,
        } => {
            let libraries = match all_platforms {
                true => libraries_beside(&std::env::current_exe()?)?,
                false if library.is_empty() => vec![library_beside_executable()?],
                false => library,
            };
            let name = name.unwrap_or_else(|| name_of(&output));
            let edition = Edition { version: fmi, author, copyright, date };
            write_fmu(&load_for(&scene, true)?, &edition, &name, &columns, &libraries, &output)?;
            say(&format!("{}\n", output.display()))?;
        }
        #[cfg(not(target_family = "wasm"))]
        Command::Scene(options) => scene::run(&options)?,
        Command::Bearing(options) => bearing::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Check(options) => return check::run(&options),
        #[cfg(not(target_family = "wasm"))]
        Command::Import(options) => import::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Export(options) => export::run(&options)?,
        Command::Effects(options) => effects::run(&options)?,
        Command::Report(options) => report::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::System(options) => system::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Field(options) => return field::run(&options),
        #[cfg(not(target_family = "wasm"))]
        Command::Contact(options) => return contact::run(&options),
        #[cfg(not(target_family = "wasm"))]
        Command::Identify(options) => identify::run(&options)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Cost(options) => return cost::run(options),
        #[cfg(not(target_family = "wasm"))]
        Command::Completions(options) => completions::run(&options, commands)?,
        #[cfg(not(target_family = "wasm"))]
        Command::Describe { scene, fmi } => {
            let name = name_of(&scene);
            let machine = Machine::new(&load_for(&scene, true)?)?;
            say(&render_as(&fmi.into(), &machine, &name, &all)?.xml)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
