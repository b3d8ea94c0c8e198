//! FMI 2.0 for co-simulation.
//!
//! ```text
//! exports/    the 34 C functions: pointers in, statuses out, nothing else
//! types.rs    C types
//! logger.rs   the importer's logger
//! allowed.rs  which call is allowed when, as data
//! ```

mod allowed;
mod exports;
mod logger;
mod types;

pub use types::{CallbackFunctions, Status};
