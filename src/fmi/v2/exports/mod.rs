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
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::state_machine::{Call, after, allowed};
use super::types::Status;
use crate::fmi::handles;
use crate::fmi::instance::Instance;
use crate::fmi::outcome::{self, Outcome, error};

/// Runs a call on an instance: handle, phase check, panic guard, log, status.
fn guard(component: *mut c_void, call: Call, work: impl FnOnce(&mut Instance) -> Outcome) -> Status {
    let guarded = |instance: &mut Instance| {
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            let phase = instance.state.phase;
            if !allowed(call, phase) {
                return error(format!("{call:?} is not allowed in phase {phase:?}"));
            }
            work(instance)
        }));
        let status = match outcome {
            Ok(Ok(())) => outcome::Status::Ok,
            Ok(Err((status, why))) => {
                instance.log.write(status, &why);
                status
            }
            Err(_) => {
                let why = format!("{call:?} failed inside; this is a fault of the model");
                instance.log.write(outcome::Status::Fatal, &why);
                outcome::Status::Fatal
            }
        };
        instance.state.phase = after(call, status, instance.state.phase);
        status.into()
    };
    handles::with(component, guarded).unwrap_or(Status::Error)
}
