//! The functional mock-up interface of the shared library.
//!
//! ```text
//! instance.rs     an instance: its start, its phases, its variables
//! step.rs         communication steps and derivatives by time
//! directional.rs  derivatives of the outputs by the inputs
//! unit/           what an instance simulates: a bearing, or a shaft with its bearings
//! state.rs        the changing part of an instance: saved, restored, as bytes
//! resources.rs    the folder that a package was unpacked to
//! handles.rs      instances and states held by importers
//! log.rs          messages to the importer
//! outcome.rs      outcome of a call
//! build.rs        which build a library is of
//! v2/             FMI 2.0: its C functions, its types, what it allows when
//! ```
//!
//! Only the folder of a version knows C types and pointers.

mod build;
mod directional;
mod handles;
mod instance;
mod log;
mod outcome;
mod resources;
mod saved_state;
mod state;
mod step;
mod unit;
#[allow(non_snake_case)]
pub mod v2;

pub use build::BUILD;
pub use instance::Instance;
pub use log::{Log, Sink};
pub use outcome::{Outcome, Status};
pub use resources::SCENE_FILE;
pub use saved_state::FmuState;
