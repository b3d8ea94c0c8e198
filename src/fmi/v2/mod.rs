//! The FMI 2.0 co-simulation interface of the shared library.
//!
//! ```text
//! exports.rs        the 34 C functions: pointers in, statuses out, nothing else
//! handles.rs         instances and states held by importers
//! state_machine.rs  which call is allowed when, as data
//! instance.rs       what the calls do, safe
//! directional.rs    derivatives of the outputs by the inputs
//! log.rs            messages to the importer
//! ```

mod directional;
mod exports;
mod handles;
mod instance;
mod log;
mod state_machine;
mod types;

pub use instance::SCENE_FILE;
pub use state_machine::{Call, Phase, allowed};
pub use types::{CallbackFunctions, Status};
