//! From the first call to the last: version, instances, log, phases.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::{c_char, c_int, c_void};

use super::guarded;
use crate::fmi::guard;
use crate::fmi::instance::Instance;
use crate::fmi::log::Log;
use crate::fmi::outcome::error;
use crate::fmi::pointers::{text, texts};
use crate::fmi::resources;
use crate::fmi::state_machine::Call;
use crate::fmi::stay::stay_loaded;
use crate::fmi::v2::logger::sink;
use crate::fmi::v2::types::{Boolean, CallbackFunctions, Status};

/// `"default"`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// `"2.0"`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Makes an instance, or returns null with a reason in the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    fmu_type: c_int,
    guid: *const c_char,
    resource_location: *const c_char,
    functions: Option<&CallbackFunctions>,
    _visible: Boolean,
    logging_on: Boolean,
) -> *mut c_void {
    let Some(callbacks) = functions.copied() else {
        return std::ptr::null_mut();
    };
    stay_loaded();
    // SAFETY: the importer's contract.
    let (name, guid, location) = unsafe { (text(name), text(guid), text(resource_location)) };
    let name = name.unwrap_or_default();
    let log = |on| Log::new(sink(callbacks, &name), on);
    guard::make(log, logging_on != 0, |log| {
        if fmu_type != 1 {
            return error("this package offers co-simulation only");
        }
        if name.trim().is_empty() {
            return error("the instance name is missing");
        }
        let (Some(guid), Some(location)) = (guid, location) else {
            return error("the guid or the resource location is missing");
        };
        Instance::new(&guid, &resources::path(&location)?, log)
    })
}

/// Ends an instance; null is ignored, and so is one that has ended already.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(component: *mut c_void) {
    guard::free::<Instance>(component);
}

/// Switches the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: *mut c_void,
    logging_on: Boolean,
    n: usize,
    categories: *const *const c_char,
) -> Status {
    guarded(component, Call::SetDebugLogging, |instance| {
        // SAFETY: the importer's contract.
        instance.log.set(logging_on != 0, unsafe { texts(categories, n) }?)
    })
}

/// Start and stop time; the tolerance is the scene's own.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    component: *mut c_void,
    _tolerance_defined: Boolean,
    _tolerance: f64,
    start_time: f64,
    stop_time_defined: Boolean,
    stop_time: f64,
) -> Status {
    guarded(component, Call::SetupExperiment, |instance| {
        instance.setup_experiment(start_time, (stop_time_defined != 0).then_some(stop_time))
    })
}

/// Begins initialization mode.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(component: *mut c_void) -> Status {
    guarded(component, Call::EnterInitializationMode, |instance| {
        instance.enter_initialization();
        Ok(())
    })
}

/// Starts from the inputs as set.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(component: *mut c_void) -> Status {
    guarded(component, Call::ExitInitializationMode, Instance::exit_initialization)
}

/// Ends the simulation; results can still be read.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(component: *mut c_void) -> Status {
    guarded(component, Call::Terminate, |instance| {
        instance.terminate();
        Ok(())
    })
}

/// Puts an instance back to how it was when freshly instantiated.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(component: *mut c_void) -> Status {
    guarded(component, Call::Reset, |instance| {
        instance.reset();
        Ok(())
    })
}
