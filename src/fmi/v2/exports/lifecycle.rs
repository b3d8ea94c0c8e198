//! From the first call to the last: version, instances, log, phases.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::{c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::guard;
use crate::fmi::handles;
use crate::fmi::instance::Instance;
use crate::fmi::log::Log;
use crate::fmi::outcome::{self, Outcome, error};
use crate::fmi::v2::logger::sink;
use crate::fmi::v2::pointers::{list, text};
use crate::fmi::v2::state_machine::Call;
use crate::fmi::v2::stay::stay_loaded;
use crate::fmi::v2::types::{Boolean, CallbackFunctions, Status};
use crate::interface::model_description::LOG_CATEGORIES;

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
    let made = catch_unwind(AssertUnwindSafe(|| -> Outcome<Instance> {
        if fmu_type != 1 {
            return error("this package offers co-simulation only");
        }
        if name.trim().is_empty() {
            return error("the instance name is missing");
        }
        let (Some(guid), Some(location)) = (guid, location) else {
            return error("the guid or the resource location is missing");
        };
        Instance::new(&guid, &location, log(logging_on != 0))
    }));
    match made {
        Ok(Ok(instance)) => {
            instance.log.write(outcome::Status::Ok, "instantiated");
            handles::give(instance)
        }
        Ok(Err((status, why))) => {
            log(true).write(status, &why);
            std::ptr::null_mut()
        }
        Err(_) => {
            log(true).write(outcome::Status::Fatal, "the model failed inside while it was instantiated");
            std::ptr::null_mut()
        }
    }
}

/// Ends an instance; null is ignored, and so is one that has ended already.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(component: *mut c_void) {
    // A panic in a destructor must not cross either.
    let _ = catch_unwind(AssertUnwindSafe(|| drop(handles::take::<Instance>(component))));
}

/// Switches the log.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: *mut c_void,
    logging_on: Boolean,
    n: usize,
    categories: *const *const c_char,
) -> Status {
    guard(component, Call::SetDebugLogging, |instance| {
        // SAFETY: the importer's contract.
        let categories = unsafe { list(categories, n) }?.iter();
        // SAFETY: the importer's contract.
        let names: Vec<String> = categories.filter_map(|name| unsafe { text(*name) }).collect();
        let known = |name: &String| LOG_CATEGORIES.iter().any(|(known, _)| known == name);
        if let Some(unknown) = names.iter().find(|name| !known(name)) {
            return error(format!("there is no log category {unknown}"));
        }
        instance.log.set(logging_on != 0, names);
        Ok(())
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
    guard(component, Call::SetupExperiment, |instance| {
        instance.setup_experiment(start_time, (stop_time_defined != 0).then_some(stop_time))
    })
}

/// Begins initialization mode.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(component: *mut c_void) -> Status {
    guard(component, Call::EnterInitializationMode, |instance| {
        instance.enter_initialization();
        Ok(())
    })
}

/// Starts from the inputs as set.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(component: *mut c_void) -> Status {
    guard(component, Call::ExitInitializationMode, Instance::exit_initialization)
}

/// Ends the simulation; results can still be read.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(component: *mut c_void) -> Status {
    guard(component, Call::Terminate, |instance| {
        instance.terminate();
        Ok(())
    })
}

/// Puts an instance back to how it was when freshly instantiated.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(component: *mut c_void) -> Status {
    guard(component, Call::Reset, |instance| {
        instance.reset();
        Ok(())
    })
}
