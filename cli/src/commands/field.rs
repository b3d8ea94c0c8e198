//! `roulement field`: where chosen contacts stick and slip at chosen times of a run.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use std::str::FromStr;
use std::sync::atomic::Ordering;

use clap::Args;
use roulement::analysis::stick_slip::field;
use roulement::model::bodies::Race;
use roulement::scene::machine::MachineScene;
use roulement::scene::units::{Quantity, Time};
use roulement::simulation::machine::Machine;
use roulement::simulation::play::Scripted;
use roulement_cli::field::{write_cells, write_head};

use super::interrupt::{INTERRUPTED, heeded_interrupt};
use super::{load, tell};

/// Options of `roulement field`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// The bearing, by its name, of a shaft with several.
    #[arg(long)]
    bearing: Option<String>,
    /// Contacts, such as `1.inner,4.outer`: ball, counted from 1, and race.
    #[arg(long, value_delimiter = ',', required = true)]
    contacts: Vec<Contact>,
    /// Times, such as `5 ms,10 ms`; the end of the run if not given.
    #[arg(long, value_delimiter = ',')]
    times: Vec<Moment>,
    /// Cells across the ellipse, 8 to 128.
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u16).range(8..=128))]
    cells: u16,
    /// Table to write.
    #[arg(short, long, default_value = "field.csv")]
    output: PathBuf,
}

/// A contact of a ball and a race.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Contact {
    /// Counted from 1.
    ball: usize,
    race: Race,
}

impl FromStr for Contact {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || format!("{text} is no contact: write ball and race, such as 1.inner or 4.outer");
        let (ball, race) = text.trim().split_once('.').ok_or_else(wanted)?;
        let race = Race::BOTH.into_iter().find(|known| known.name() == race).ok_or_else(wanted)?;
        let ball = ball.parse().ok().filter(|ball| *ball > 0).ok_or_else(wanted)?;
        Ok(Self { ball, race })
    }
}

/// \[s] a time, a number or a text with a unit.
#[derive(Clone, Copy, Debug)]
pub struct Moment(pub f64);

impl FromStr for Moment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let time = text.trim().parse().or_else(|_| Time::DIMENSION.parse(text.trim()))?;
        if time >= 0.0 { Ok(Self(time)) } else { Err(format!("{text} is before the start")) }
    }
}

/// Simulates a scene up to each of the times, by its rows as `roulement run` does, and writes the fields of the contacts there. Those
/// that are there at Ctrl-C are kept.
///
/// # Errors
/// If the simulation cannot start or go on, a ball is not there, or the table cannot be written.
pub fn run(options: &Options) -> Result<ExitCode, Box<dyn Error>> {
    let scene = load(&options.scene)?;
    let index = bearing(&scene, options.bearing.as_deref())?;
    let balls = scene.bearings()[index].1.bearing.balls;
    if let Some(contact) = options.contacts.iter().find(|contact| contact.ball > balls) {
        return Err(format!("--contacts: ball {} is not there: allowed is [1, {balls}]", contact.ball).into());
    }
    let mut times: Vec<f64> = options.times.iter().map(|moment| moment.0).collect();
    if times.is_empty() {
        times.push(scene.duration());
    }
    times.sort_by(f64::total_cmp);
    let mut machine = Machine::new(&scene)?;
    let cannot_write = |why: csv::Error| format!("{}: {why}", options.output.display());
    let mut table = csv::Writer::from_path(&options.output).map_err(cannot_write)?;
    write_head(&mut table, &["time [s]", "ball [1]", "race"], true).map_err(cannot_write)?;
    let interrupted = heeded_interrupt()?;
    // The steps are those of a whole run.
    let end = times.iter().copied().fold(scene.duration(), f64::max);
    let mut course = machine.begin(end)?;
    for time in times {
        while machine.time() < time {
            if interrupted.load(Ordering::Relaxed) {
                table.flush().map_err(|why| cannot_write(why.into()))?;
                tell([format!("interrupted at {:.3} ms", machine.time() * 1e3)]);
                return Ok(ExitCode::from(INTERRUPTED));
            }
            machine.step(&mut course, time)?;
        }
        machine.look_back(&mut course, time);
        let Some((_, simulation)) = machine.bearings().nth(index) else { continue };
        for Contact { ball, race } in &options.contacts {
            let (model, state, conditions) =
                (simulation.model(), simulation.state(), simulation.conditions());
            let what = format!("{:.6} ms, ball {ball} on the {} race", simulation.time() * 1e3, race.name());
            let Some(field) = field(model, state, &conditions, (ball - 1, *race), options.cells.into())?
            else {
                tell([format!("{what}: no load, or no friction")]);
                continue;
            };
            let whose = [simulation.time().to_string(), ball.to_string(), race.name().to_string()];
            write_cells(&mut table, &whose, &field).map_err(cannot_write)?;
            let [a, b] = field.semi_axes.map(|axis| axis * 1e6);
            tell([format!("{what}: {:.1} % sticks, ellipse {a:.1} x {b:.1} um", 100.0 * field.stick)]);
        }
        machine.look_up(&mut course);
    }
    table.flush().map_err(|why| cannot_write(why.into()))?;
    Ok(ExitCode::SUCCESS)
}

/// The index of the bearing that is meant.
pub(super) fn bearing(scene: &MachineScene, name: Option<&str>) -> Result<usize, String> {
    let bearings = scene.bearings();
    let names = bearings.iter().map(|(name, _)| *name).collect::<Vec<_>>();
    match name {
        None if names.len() == 1 => Ok(0),
        None => Err(format!("--bearing: say which one of {}", names.join(", "))),
        Some(name) => names.iter().position(|known| *known == name && !known.is_empty()).ok_or_else(|| {
            match scene.shaft() {
                Some(_) => format!("--bearing: there is no bearing {name}, but {}", names.join(", ")),
                None => "--bearing is for a shaft with several".to_string(),
            }
        }),
    }
}
