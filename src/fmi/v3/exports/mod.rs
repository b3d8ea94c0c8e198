//! The 75 functions of FMI 3.0. Each checks its pointers, hands over to [`Slave`] and [`crate::fmi::Instance`], and turns the outcome into a
//! status; no panic crosses this boundary. What packages do not offer is refused, with one line in the log.
//!
//! The importer's contract is the same for all functions: pointers are null or valid for the lengths that go with them
//! until the call ends (FMI 3.0, section 2.2). A pointer to a single value is an optional reference, which is the same
//! to a caller in C. An instance or a state is a handle that is looked up and never read from.

mod lifecycle;
mod not_offered;
mod states;
mod steps;
mod variables;

use std::ffi::c_void;

use super::allowed::RULES;
use super::slave::Slave;
use super::types::Status;
use crate::fmi::guard::guard;
use crate::fmi::outcome::Outcome;
use crate::fmi::state_machine::Call;

/// Runs a call on a slave.
fn guarded(instance: *mut c_void, call: Call, work: impl FnOnce(&mut Slave) -> Outcome) -> Status {
    guard(instance, &RULES, call, work).into()
}
