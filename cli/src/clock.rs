//! CPU time of this thread; in a browser, which has none, the time that passes.

#[cfg(not(target_family = "wasm"))]
pub use cpu_time::ThreadTime;
#[cfg(target_family = "wasm")]
pub use std::time::Instant as ThreadTime;
