//! `roulement rating`: the life under several loads, each with its part of the time: those of a table, or of the `[[duty]]` of the scene; in balance or run.

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use roulement_cli::duty::DutyRating;
use roulement_cli::duty::loads::Duty;
use roulement_cli::fits::{self, WITHIN};
use roulement_cli::sweep::all::threads;

use super::{load, say, tell};

/// Options of `roulement rating`.
#[derive(Args)]
pub struct Options {
    /// Scene file of a bearing, or of a shaft with its bearings.
    scene: PathBuf,
    /// Table of loads: a column `share` of the time, and keys of the scene such as `load.inner_speed [rpm]` and `load.y.force [kN]`, as
    /// `roulement sweep` has them; the scene's own `[[duty]]` if not given.
    #[arg(long)]
    loads: Option<PathBuf>,
    /// Run the scene under each load for its `load.duration`, with friction, skidding and temperatures as they come, in place of its
    /// equilibrium.
    #[arg(long)]
    runs: bool,
}

/// Finds the life under each of the loads, by its equilibrium or its run, adds all up, and prints CSV.
///
/// # Errors
/// If a load has no equilibrium, its run fails, or there are none.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let base = load(&options.scene)?;
    let duty = match &options.loads {
        Some(path) => Duty::of_table(path, &base)?,
        None => Duty::of_scene(&base)?,
    };
    tell(duty.note());
    let rating = match options.runs {
        true => DutyRating::in_runs(&duty, threads())?,
        false => DutyRating::of(&duty, threads())?,
    };
    tell(rating.notes());
    if fits::are_of(&base) {
        for (name, within) in WITHIN {
            let of = DutyRating::of(&duty.with(|scene| fits::at(scene, within)), threads())?;
            tell([format!("note: fits at their {name}: {}", of.to_string().trim_end())]);
        }
    }
    Ok(say(&rating.to_csv())?)
}
