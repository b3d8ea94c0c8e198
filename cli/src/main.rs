//! Command line of roulement.

mod commands;

use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::run() {
        Ok(code) => code,
        Err(why) => {
            // Where even this cannot be written, the exit code tells.
            let _ = writeln!(std::io::stderr(), "error: {why}");
            ExitCode::FAILURE
        }
    }
}
