//! Guard of the C functions of all versions: handle, phase, panics, log, status.

use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::handles;
use super::instance::Instance;
use super::log::Log;
use super::outcome::{Outcome, Status, error};
use super::state_machine::{Call, Rules};

/// What importers hold: an instance, perhaps with what only one version has.
pub trait Held: Send + 'static {
    /// The instance.
    fn instance(&mut self) -> &mut Instance;
}

impl Held for Instance {
    fn instance(&mut self) -> &mut Instance {
        self
    }
}

/// Makes what an importer holds; a null handle, with the reason in the log, if that fails. `log` gives the log of the instance,
/// switched on or off.
pub fn make<T: Held>(
    log: impl Fn(bool) -> Log,
    on: bool,
    work: impl FnOnce(Log) -> Outcome<T>,
) -> *mut c_void {
    match catch_unwind(AssertUnwindSafe(|| work(log(on)))) {
        Ok(Ok(mut held)) => {
            held.instance().log.write(Status::Ok, "instantiated");
            handles::give(held)
        }
        Ok(Err((status, why))) => {
            log(true).write(status, &why);
            std::ptr::null_mut()
        }
        Err(_) => {
            log(true).write(Status::Fatal, "the model failed inside while it was instantiated");
            std::ptr::null_mut()
        }
    }
}

/// Ends what is behind a handle; null is ignored, and so is what has ended already.
pub fn free<T: Held>(handle: *mut c_void) {
    // A panic in a destructor must not cross the boundary either.
    let _ = catch_unwind(AssertUnwindSafe(|| drop(handles::take::<T>(handle))));
}

/// Runs a call on what is behind a handle; an error where there is nothing of this version.
pub fn guard<T: Held>(
    handle: *mut c_void,
    rules: &Rules,
    call: Call,
    work: impl FnOnce(&mut T) -> Outcome,
) -> Status {
    let mut work = Some(work);
    // Once per version and not once per function: the rest is the same for all.
    guarded(handle, rules, call, &mut |held| work.take().map_or(Ok(()), |work| work(held)))
}

fn guarded<T: Held>(
    handle: *mut c_void,
    rules: &Rules,
    call: Call,
    work: &mut dyn FnMut(&mut T) -> Outcome,
) -> Status {
    let checked = |held: &mut T| {
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            let phase = held.instance().state.phase;
            if !rules.allow(call, phase) {
                return error(format!("{call:?} is not allowed in phase {phase:?}"));
            }
            work(held)
        }));
        conclude(held.instance(), rules, call, outcome.ok())
    };
    handles::with(handle, checked).unwrap_or(Status::Error)
}

/// Status and phase after an outcome; there is none of a call that has failed inside.
fn conclude(instance: &mut Instance, rules: &Rules, call: Call, outcome: Option<Outcome>) -> Status {
    let status = match outcome {
        Some(Ok(())) => Status::Ok,
        Some(Err((status, why))) => {
            instance.log.write(status, &why);
            status
        }
        None => {
            let why = format!("{call:?} failed inside; this is a fault of the model");
            instance.log.write(Status::Fatal, &why);
            Status::Fatal
        }
    };
    instance.state.phase = rules.after(call, status, instance.state.phase);
    status
}
