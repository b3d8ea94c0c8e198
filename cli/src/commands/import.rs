//! `roulement import`: gearboxes from the files of other programs.

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Args;
use roulement::scene::system::SystemScene;
use roulement_cli::rexs;

use super::{say, tell};

/// Options of `roulement import`.
#[derive(Args)]
pub struct Options {
    /// REXS file of versions 1.0 to 1.7: .rexs, .rexsj or .rexsz.
    gearbox: PathBuf,
    /// File of the machine to write; standard output if not given.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// Writes the machine, and tells what of the gearbox it does not have.
///
/// # Errors
/// If the file cannot be read or written, or the machine would be refused: it is written all the same then, to be mended.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let found = rexs::import(&options.gearbox)?;
    tell(found.notes.iter().map(|note| format!("note: {note}")).chain([found.summary.clone()]));
    let folder = match &options.output {
        Some(path) => {
            std::fs::write(path, &found.text)
                .map_err(|why| format!("cannot write {}: {why}", path.display()))?;
            say(&format!("{}\n", path.display()))?;
            path.parent().unwrap_or(Path::new(""))
        }
        None => {
            say(&found.text)?;
            Path::new("")
        }
    };
    SystemScene::parse(&found.text, None, folder)
        .map(|_| ())
        .map_err(|why| format!("the machine was written, and is refused as it stands: {why}").into())
}
