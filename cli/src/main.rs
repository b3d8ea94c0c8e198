//! Command line of roulement.
// In a browser there are fewer commands.
#![cfg_attr(target_family = "wasm", allow(dead_code, unused_imports))]

mod commands;

use std::error::Error;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::run() {
        Ok(code) => code,
        // Who closes the pipe has read enough: `roulement ... | head`.
        Err(why) if reader_left(why.as_ref()) => ExitCode::SUCCESS,
        Err(why) => {
            // Where even this cannot be written, the exit code tells.
            let _ = writeln!(std::io::stderr(), "error: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Was it the closed pipe of standard output?
fn reader_left(error: &(dyn Error + 'static)) -> bool {
    let mut cause = Some(error);
    while let Some(error) = cause {
        if error.downcast_ref::<std::io::Error>().is_some_and(|why| why.kind() == ErrorKind::BrokenPipe) {
            return true;
        }
        cause = error.source();
    }
    false
}
