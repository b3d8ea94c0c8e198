//! Ctrl-C and SIGTERM: what a command has done so far is kept.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Exit code of a program that Ctrl-C or SIGTERM ended: 128 and the number of Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// Set by Ctrl-C, and by SIGTERM, which queues of computing centres send; a second one does not wait for the row.
///
/// # Errors
/// If the system has no such signals. In a browser, which ends what it runs by itself, there are none.
pub fn heeded_interrupt() -> std::io::Result<Arc<AtomicBool>> {
    let interrupted = Arc::new(AtomicBool::new(false));
    #[cfg(not(target_family = "wasm"))]
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register_conditional_shutdown(
            signal,
            INTERRUPTED.into(),
            Arc::clone(&interrupted),
        )?;
        signal_hook::flag::register(signal, Arc::clone(&interrupted))?;
    }
    Ok(interrupted)
}
