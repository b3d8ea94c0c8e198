//! `roulement rating`: the life under several loads, each with its part of the time: those of a table, or of the `[[duty]]` of the scene.

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use roulement_cli::duty::DutyRating;
use roulement_cli::duty::loads::Duty;
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
}

/// Finds the equilibrium and the life under each of the loads, adds them up, and prints CSV.
///
/// # Errors
/// If a load has no equilibrium, or there are none.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let base = load(&options.scene)?;
    let duty = match &options.loads {
        Some(path) => Duty::of_table(path, &base)?,
        None => Duty::of_scene(&base)?,
    };
    tell(duty.note());
    let rating = DutyRating::of(&duty, threads())?;
    tell(rating.notes());
    Ok(say(&rating.to_csv())?)
}
