//! `roulement completions`: what a shell completes commands and options by.

use std::error::Error;

use clap::{Args, Command};
use clap_complete::Shell;

use super::say;

/// Options of `roulement completions`.
#[derive(Args)]
pub struct Options {
    /// Shell that the script is for.
    shell: Shell,
}

/// Prints the script of a shell for these commands.
///
/// # Errors
/// If nothing can be printed.
pub fn run(options: &Options, mut commands: Command) -> Result<(), Box<dyn Error>> {
    let mut script = vec![];
    clap_complete::generate(options.shell, &mut commands, "roulement", &mut script);
    Ok(say(&String::from_utf8_lossy(&script))?)
}
