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
//! states_by_handle.rs what is done with saved states by their handles
//! log.rs          messages to the importer
//! outcome.rs      outcome of a call
//! state_machine.rs calls, and what versions say of them
//! guard.rs        what every C function is run within
//! pointers.rs     lists and texts behind pointers
//! stay.rs         the library stays loaded
//! build.rs        which build a library is of
//! v2/             FMI 2.0: its C functions, its types, what it allows when
//! v3/             FMI 3.0, likewise
//! ```
//!
//! Only the folder of a version knows its C types; what both do with pointers is in `pointers.rs` and `states_by_handle.rs`.

mod build;
mod directional;
mod guard;
mod handles;
mod instance;
mod log;
mod outcome;
mod pointers;
mod resources;
mod saved_state;
mod state;
mod state_machine;
mod states_by_handle;
mod stay;
mod step;
mod unit;
#[allow(non_snake_case)]
pub mod v2;
#[allow(non_snake_case)]
pub mod v3;

pub use build::BUILD;
pub use instance::Instance;
pub use log::{Log, Sink};
pub use outcome::{Outcome, Status};
pub use resources::SCENE_FILE;
pub use saved_state::FmuState;
