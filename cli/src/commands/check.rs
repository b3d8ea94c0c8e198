//! `roulement check`: what a file is, what it would run, and how long that would take.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use roulement_cli::check::check;

use super::say;

/// Options of `roulement check`.
#[derive(Args)]
pub struct Options {
    /// Files: scenes, machines, sweeps, systems, shelves of bearings, REXS files.
    #[arg(required = true)]
    files: Vec<PathBuf>,
}

/// Says of each file what it is. Exit code 1 says that one is refused; the others are checked all the same.
///
/// # Errors
/// If nothing can be printed.
pub fn run(options: &Options) -> Result<ExitCode, Box<dyn Error>> {
    let mut code = ExitCode::SUCCESS;
    for path in &options.files {
        let found = check(path);
        if !found.good {
            code = ExitCode::FAILURE;
        }
        let lines: String = found.lines.iter().map(|line| format!("  {line}\n")).collect();
        say(&format!("{}: {}\n{lines}", path.display(), found.kind))?;
    }
    Ok(code)
}
