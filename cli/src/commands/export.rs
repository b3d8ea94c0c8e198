//! `roulement export`: machines as files of other programs.

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use roulement_cli::rexs;

use super::{say, tell};

/// Options of `roulement export`.
#[derive(Args)]
pub struct Options {
    /// File of a machine whose shafts have sections.
    machine: PathBuf,
    /// REXS file to write, version 1.4 in XML; standard output if not given.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// Writes the file, and tells what of the machine it does not have.
///
/// # Errors
/// If the machine is refused, its shafts have no sections, or the file cannot be written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let (text, notes) = rexs::export(&options.machine)?;
    tell(notes.into_iter().map(|note| format!("note: {note}")));
    match &options.output {
        Some(path) => {
            std::fs::write(path, text).map_err(|why| format!("cannot write {}: {why}", path.display()))?;
            Ok(say(&format!("{}\n", path.display()))?)
        }
        None => Ok(say(&text)?),
    }
}
