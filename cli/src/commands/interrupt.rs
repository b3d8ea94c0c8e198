//! Ctrl-C and SIGTERM: what a command has done so far is kept.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Exit code of a program that Ctrl-C or SIGTERM ended: 128 and the number of Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// Set by Ctrl-C, and by SIGTERM, which queues of computing centres send; a second one does not wait for the row.
///
/// # Errors
/// If the system has no such signals.
pub fn heeded_interrupt() -> std::io::Result<Arc<AtomicBool>> {
    let interrupted = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        flag::register_conditional_shutdown(signal, INTERRUPTED.into(), Arc::clone(&interrupted))?;
        flag::register(signal, Arc::clone(&interrupted))?;
    }
    Ok(interrupted)
}
