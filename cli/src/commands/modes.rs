//! `roulement modes`: small motions of rings, shafts and cage about the running state, over the speed.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use roulement_cli::modes::{Asked, Modes, to_csv, to_json, to_text, write_figure, write_growths};
use serde_json::Value;

use super::equilibrium::Speed;
use super::field::Moment;
use super::{load, say};

/// Options of `roulement modes`.
#[derive(Args)]
pub struct Options {
    /// Scene files.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Directory for modes.csv and campbell.svg, made if missing; of several scenes one each in 1, 2 and so on, and growth.svg of all.
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
/// If a machine cannot start or run, or files cannot be written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let asked = Asked {
        time: options.time.0,
        after: options.after.0,
        up_to: options.up_to.map(|Speed(speed)| speed),
        speeds: options.speeds as usize,
    };
    let of_scene = |path: &PathBuf| -> Result<Modes, Box<dyn Error>> { Ok(Modes::of(&load(path)?, &asked)?) };
    let all = options.scenes.iter().map(of_scene).collect::<Result<Vec<_>, _>>()?;
    let text = match (options.json, &all[..]) {
        (true, [one]) => format!("{:#}\n", to_json(one)),
        (true, all) => format!("{:#}\n", Value::from(all.iter().map(to_json).collect::<Vec<_>>())),
        (false, all) => all.iter().map(to_text).collect::<Vec<_>>().join("\n"),
    };
    say(&text)?;
    let Some(directory) = &options.output else {
        return Ok(());
    };
    let failed = |path: &Path, why: &dyn Error| format!("cannot write {}: {why}", path.display());
    for (index, modes) in all.iter().enumerate() {
        let own = match all.len() {
            1 => directory.clone(),
            _ => directory.join((index + 1).to_string()),
        };
        fs::create_dir_all(&own).map_err(|why| failed(&own, &why))?;
        let table = own.join("modes.csv");
        fs::write(&table, to_csv(modes)?).map_err(|why| failed(&table, &why))?;
        if !modes.rows.is_empty() {
            write_figure(modes, &own.join("campbell.svg"))?;
        }
    }
    if all.len() > 1 {
        write_growths(&all, &directory.join("growth.svg"))?;
    }
    Ok(())
}
