//! From the first call to the last: version, instances, log, phases.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::{c_char, c_void};
use std::path::Path;

use super::guarded;
use crate::fmi::guard;
use crate::fmi::instance::Instance;
use crate::fmi::log::Log;
use crate::fmi::outcome::{self, error};
use crate::fmi::pointers::{list, text, texts};
use crate::fmi::state_machine::Call;
use crate::fmi::stay::stay_loaded;
use crate::fmi::v3::logger::{Environment, sink};
use crate::fmi::v3::slave::Slave;
use crate::fmi::v3::types::{IntermediateUpdate, LogMessage, Status};
use crate::fmi::v3::updates::Updates;

/// `"3.0"`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Makes an instance, or returns null with a reason in the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resource_path: *const c_char,
    _visible: bool,
    logging_on: bool,
    event_mode_used: bool,
    early_return_allowed: bool,
    required_intermediate_variables: *const u32,
    n_required: usize,
    environment: *mut c_void,
    log_message: Option<LogMessage>,
    intermediate_update: Option<IntermediateUpdate>,
) -> *mut c_void {
    stay_loaded();
    // SAFETY: the importer's contract.
    let (name, token, folder) = unsafe { (text(name), text(token), text(resource_path)) };
    let log = |on| Log::new(sink(Environment(environment), log_message), on);
    guard::make(log, logging_on, |log| {
        if name.is_none_or(|name| name.trim().is_empty()) {
            return error("the instance name is missing");
        }
        if event_mode_used {
            // fmi-rs says so of every package.
            log.write(outcome::Status::Warning, "this package has no event mode: it has no events");
        }
        let (Some(token), Some(folder)) = (token, folder) else {
            return error("the instantiation token or the path of the resources is missing");
        };
        // SAFETY: the importer's contract.
        let required = unsafe { list(required_intermediate_variables, n_required) }?;
        let updates = intermediate_update.map(|callback| Updates {
            callback,
            environment: Environment(environment),
            early_return: early_return_allowed,
        });
        Slave::new(Instance::new(&token, Path::new(&folder), log)?, updates, required)
    })
}

/// Ends an instance; null is ignored, and so is one that has ended already.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    guard::free::<Slave>(instance);
}

/// Switches the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    logging_on: bool,
    n: usize,
    categories: *const *const c_char,
) -> Status {
    guarded(instance, Call::SetDebugLogging, |slave| {
        // SAFETY: the importer's contract.
        slave.instance.log.set(logging_on, unsafe { texts(categories, n) }?)
    })
}

/// Start and stop time; the tolerance is the scene's own. Begins initialization mode.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    _tolerance_defined: bool,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: bool,
    stop_time: f64,
) -> Status {
    guarded(instance, Call::EnterInitializationMode, |slave| {
        slave.instance.setup_experiment(start_time, stop_time_defined.then_some(stop_time))?;
        slave.instance.enter_initialization();
        Ok(())
    })
}

/// Starts from the inputs as set.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(instance: *mut c_void) -> Status {
    guarded(instance, Call::ExitInitializationMode, |slave| slave.instance.exit_initialization())
}

/// Ends the simulation; results can still be read.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(instance: *mut c_void) -> Status {
    guarded(instance, Call::Terminate, |slave| {
        slave.instance.terminate();
        Ok(())
    })
}

/// Puts an instance back to how it was when freshly instantiated.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(instance: *mut c_void) -> Status {
    guarded(instance, Call::Reset, |slave| {
        slave.instance.reset();
        Ok(())
    })
}
