//! `roulement modes`: small motions of rings, shafts and cage about the running state, over the speed.

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use clap::Args;
use roulement_cli::modes::{Asked, Modes, to_csv, to_json, to_text, write_figure};

use super::equilibrium::Speed;
use super::field::Moment;
use super::{load, say};

/// Options of `roulement modes`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// Directory for modes.csv and campbell.svg, made if missing.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Time of the scene's scripts, such as `5 ms`.
    #[arg(long, default_value = "0")]
    time: Moment,
    /// How long the machine runs at each speed before its motions are looked at, such as `2 ms`: balls then have the speeds of running. What
    /// grows has little time in it; a state that is moved by what grows is none to look at.
    #[arg(long, default_value = "2 ms")]
    after: Moment,
    /// Speed that the table goes up to, such as `12000 rpm`; 1.5 times that of the scene if not given.
    #[arg(long)]
    up_to: Option<Speed>,
    /// Speeds of the table.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(0..=1000))]
    speeds: u32,
}

/// Finds them, prints them, and writes table and figure where a directory is given.
///
/// # Errors
/// If the machine cannot start or run, or files cannot be written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let scene = load(&options.scene)?;
    let asked = Asked {
        time: options.time.0,
        after: options.after.0,
        up_to: options.up_to.map(|Speed(speed)| speed),
        speeds: options.speeds as usize,
    };
    let modes = Modes::of(&scene, &asked)?;
    say(&if options.json { format!("{:#}\n", to_json(&modes)) } else { to_text(&modes) })?;
    if let Some(directory) = &options.output {
        let failed = |path: &PathBuf, why: &dyn Error| format!("cannot write {}: {why}", path.display());
        fs::create_dir_all(directory).map_err(|why| failed(directory, &why))?;
        let table = directory.join("modes.csv");
        fs::write(&table, to_csv(&modes)?).map_err(|why| failed(&table, &why))?;
        if !modes.rows.is_empty() {
            write_figure(&modes, &directory.join("campbell.svg"))?;
        }
    }
    Ok(())
}
