//! FMI 3.0 for co-simulation, beside 2.0 on the same instances.
//!
//! ```text
//! exports/    the 75 C functions: pointers in, statuses out, nothing else
//! slave.rs    an instance with what version 3 knows of it
//! types.rs    C types
//! updates.rs  intermediate update of inputs within a step
//! logger.rs   the importer's logger
//! allowed.rs  which call is allowed when, as data
//! ```

mod allowed;
mod exports;
mod logger;
mod slave;
mod types;
mod updates;

pub use types::{IntermediateUpdate, LogMessage, Status};
