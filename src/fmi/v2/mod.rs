//! FMI 2.0 for co-simulation.
//!
//! ```text
//! exports/          the 34 C functions: pointers in, statuses out, nothing else
//! pointers.rs       lists and texts behind pointers
//! types.rs          C types
//! logger.rs         the importer's logger
//! state_machine.rs  which call is allowed when, as data
//! ```

mod exports;
mod logger;
mod pointers;
mod state_machine;
mod stay;
mod types;

pub use types::{CallbackFunctions, Status};
