//! The 34 functions of FMI 2.0 for co-simulation. Each checks its pointers, hands over to [`Instance`], and turns the
//! outcome into a status; no panic crosses this boundary.
//!
//! The importer's contract is the same for all functions: pointers are null or valid for the lengths that go with them
//! until the call ends (FMI 2.0.4, section 2.1). A pointer to a single value is an optional reference, which is the same
//! to a caller in C. A component or a state is a handle that is looked up and never read from.

mod lifecycle;
mod states;
mod steps;
mod variables;

use std::ffi::c_void;

use super::allowed::RULES;
use super::types::Status;
use crate::fmi::guard::guard;
use crate::fmi::instance::Instance;
use crate::fmi::outcome::Outcome;
use crate::fmi::state_machine::Call;

/// Runs a call on an instance.
fn guarded(component: *mut c_void, call: Call, work: impl FnOnce(&mut Instance) -> Outcome) -> Status {
    guard(component, &RULES, call, work).into()
}
