//! `roulement system`: connected packages as an SSP file and as an OSP system structure.

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use roulement_cli::kinds::Kind;
use roulement_cli::system;

use super::{or_kind, say, tell};

/// Options of `roulement system`.
#[derive(Args)]
pub struct Options {
    /// Description of the system, TOML: components, connections, start values, step.
    description: PathBuf,
    /// Directory for NAME.ssp and NAME-osp; made if missing.
    #[arg(short, long)]
    output: PathBuf,
    /// Shared library to pack with scenes, once per platform; the one built beside this program if not given.
    #[arg(long)]
    library: Vec<PathBuf>,
}

/// Writes the system in both forms and prints their paths.
///
/// # Errors
/// If the description or a package is wrong, or files cannot be read or written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let written = system::write(&options.description, &options.output, &options.library)
        .map_err(|why| or_kind(&options.description, &[Kind::System], why))?;
    tell(written.notes.into_iter().map(|note| format!("note: {note}")));
    Ok(say(&format!("{}\n{}\n", written.ssp.display(), written.osp.display()))?)
}
