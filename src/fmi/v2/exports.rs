//! The 34 functions of FMI 2.0 for co-simulation. Each checks its pointers, hands over to [`Instance`], and turns the
//! outcome into a status; no panic crosses this boundary.
#![allow(unsafe_code)]
// The importer's contract: pointers are valid for the lengths that go with them, an instance is used by one thread
// at a time and not after it was freed (FMI 2.0.4, section 2.1). It is the same for all functions.
#![allow(clippy::missing_safety_doc)]

use std::ffi::{CStr, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use super::handles;
use super::instance::{FmuState, Instance, Outcome, error};
use super::log::Log;
use super::state_machine::Call;
use super::types::{Boolean, CallbackFunctions, Status};
use crate::interface::variables::Kind;

/// Runs a call on an instance: null check, phase check, panic guard, log, status.
fn guard(component: *mut c_void, call: Call, work: impl FnOnce(&mut Instance) -> Outcome) -> Status {
    let Some(instance) = handles::borrow::<Instance>(component) else {
        return Status::Error;
    };
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        instance.check(call)?;
        work(instance)
    }));
    let status = match outcome {
        Ok(Ok(())) => Status::Ok,
        Ok(Err((status, why))) => {
            instance.log.write(status, &why);
            status
        }
        Err(_) => {
            instance
                .log
                .write(Status::Fatal, &format!("{call:?} failed inside; this is a fault of the model"));
            Status::Fatal
        }
    };
    instance.settle(call, status);
    status
}

/// Longest list that an importer may pass; every sensible one is far shorter, and a count gone wild is longer.
const LONGEST_LIST: usize = 1 << 24;

/// Checks pointer and length of a list; false if it is empty.
fn check_list(is_null: bool, n: usize) -> Outcome<bool> {
    match (is_null, n) {
        (_, 0) => Ok(false),
        (true, _) => error("a list is a null pointer"),
        (false, n) if n > LONGEST_LIST => error(format!("a list of {n} elements is too long")),
        (false, _) => Ok(true),
    }
}

/// A slice of `n` elements.
fn list<'a, T>(pointer: *const T, n: usize) -> Outcome<&'a [T]> {
    if !check_list(pointer.is_null(), n)? {
        return Ok(&[]);
    }
    // SAFETY: not null and not empty, and valid for n elements by the importer's contract.
    Ok(unsafe { slice::from_raw_parts(pointer, n) })
}

/// A writable slice of `n` elements.
fn list_mut<'a, T>(pointer: *mut T, n: usize) -> Outcome<&'a mut [T]> {
    if !check_list(pointer.is_null(), n)? {
        return Ok(&mut []);
    }
    // SAFETY: not null and not empty, and valid for n elements by the importer's contract.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, n) })
}

fn text(pointer: *const c_char) -> Option<String> {
    // SAFETY: not null, and a C string by the importer's contract.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned())
}

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
    functions: *const CallbackFunctions,
    _visible: Boolean,
    logging_on: Boolean,
) -> *mut c_void {
    // SAFETY: null or a valid struct by the importer's contract.
    let Some(callbacks) = (unsafe { functions.as_ref() }).copied() else {
        return std::ptr::null_mut();
    };
    let name = text(name).unwrap_or_default();
    let log = Log::new(callbacks, &name, true);
    let made = catch_unwind(|| -> Outcome<Instance> {
        if fmu_type != 1 {
            return Err((Status::Error, "this package offers co-simulation only".into()));
        }
        if name.trim().is_empty() {
            return Err((Status::Error, "the instance name is missing".into()));
        }
        let (Some(guid), Some(location)) = (text(guid), text(resource_location)) else {
            return Err((Status::Error, "the guid or the resource location is missing".into()));
        };
        Instance::new(&name, &guid, &location, callbacks, logging_on != 0)
    });
    match made {
        Ok(Ok(instance)) => {
            instance.log.write(Status::Ok, "instantiated");
            handles::give(instance)
        }
        Ok(Err((status, why))) => {
            log.write(status, &why);
            std::ptr::null_mut()
        }
        Err(_) => {
            log.write(Status::Fatal, "the model failed inside while it was instantiated");
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
        let names: Vec<String> = list(categories, n)?.iter().filter_map(|name| text(*name)).collect();
        let known = |name: &String| {
            crate::interface::model_description::LOG_CATEGORIES.iter().any(|(known, _)| known == name)
        };
        if let Some(unknown) = names.iter().find(|name| !known(name)) {
            return error(format!("there is no log category {unknown}"));
        }
        instance.log.set(logging_on != 0, names);
        Ok(())
    })
}

/// Start and stop time; the tolerance is the scene's own.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
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
pub unsafe extern "C" fn fmi2EnterInitializationMode(component: *mut c_void) -> Status {
    guard(component, Call::EnterInitializationMode, |instance| {
        instance.enter_initialization();
        Ok(())
    })
}

/// Starts from the inputs as set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(component: *mut c_void) -> Status {
    guard(component, Call::ExitInitializationMode, Instance::exit_initialization)
}

/// Ends the simulation; results can still be read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: *mut c_void) -> Status {
    guard(component, Call::Terminate, |instance| {
        instance.terminate();
        Ok(())
    })
}

/// As freshly instantiated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: *mut c_void) -> Status {
    guard(component, Call::Reset, |instance| {
        instance.reset();
        Ok(())
    })
}

/// Reads real variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    values: *mut f64,
) -> Status {
    guard(component, Call::Get, |instance| {
        instance.get(list(references, n)?, Kind::Real, list_mut(values, n)?)
    })
}

/// Reads integer variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    values: *mut c_int,
) -> Status {
    guard(component, Call::Get, |instance| {
        let (references, results) = (list(references, n)?, list_mut(values, n)?);
        let mut values = vec![0.0; n];
        instance.get(references, Kind::Integer, &mut values)?;
        for (result, value) in results.iter_mut().zip(values) {
            // Counters beyond what fmi2Integer holds stay at its largest value.
            *result = value.min(f64::from(c_int::MAX)) as c_int;
        }
        Ok(())
    })
}

/// There are no boolean variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *mut Boolean,
) -> Status {
    guard(component, Call::Get, |_| none_of_type(n, "boolean"))
}

/// There are no string variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *mut *const c_char,
) -> Status {
    guard(component, Call::Get, |_| none_of_type(n, "string"))
}

fn none_of_type(n: usize, kind: &str) -> Outcome {
    if n == 0 { Ok(()) } else { error(format!("there are no {kind} variables that this could mean")) }
}

/// Sets real inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    values: *const f64,
) -> Status {
    guard(component, Call::Set, |instance| instance.set(list(references, n)?, Kind::Real, list(values, n)?))
}

/// There are no integer inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    _values: *const c_int,
) -> Status {
    guard(component, Call::Set, |instance| {
        let references = list(references, n)?;
        instance.set(references, Kind::Integer, &vec![0.0; references.len()])
    })
}

/// There are no boolean variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *const Boolean,
) -> Status {
    guard(component, Call::Set, |_| none_of_type(n, "boolean"))
}

/// There are no string variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *const *const c_char,
) -> Status {
    guard(component, Call::Set, |_| none_of_type(n, "string"))
}

fn refuse_state<T>() -> Outcome<T> {
    error("the FMU state is a null pointer, freed already, or none of ours")
}

/// A place for a result.
fn place<'a, T>(pointer: *mut T, what: &str) -> Outcome<&'a mut T> {
    // SAFETY: null or a valid place by the importer's contract.
    match unsafe { pointer.as_mut() } {
        Some(place) => Ok(place),
        None => error(format!("the place for {what} is a null pointer")),
    }
}

/// Copies the state; a state passed in is overwritten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: *mut c_void, state: *mut *mut c_void) -> Status {
    guard(component, Call::FmuState, |instance| {
        let place = place(state, "the FMU state")?;
        if place.is_null() {
            *place = handles::give(instance.state());
        } else {
            *handles::borrow::<FmuState>(*place).map_or_else(refuse_state, Ok)? = instance.state();
        }
        Ok(())
    })
}

/// Goes to a copied state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: *mut c_void, state: *mut c_void) -> Status {
    guard(component, Call::FmuState, |instance| {
        instance.set_state(handles::borrow::<FmuState>(state).map_or_else(refuse_state, Ok)?)
    })
}

/// Frees a copied state; null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: *mut c_void, state: *mut *mut c_void) -> Status {
    guard(component, Call::FmuState, |_| {
        // SAFETY: null or a valid place by the importer's contract.
        let Some(place) = (unsafe { state.as_mut() }) else {
            return Ok(());
        };
        if !place.is_null() {
            drop(handles::take::<FmuState>(*place).map_or_else(refuse_state, Ok)?);
            *place = std::ptr::null_mut();
        }
        Ok(())
    })
}

/// Bytes that a state takes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    component: *mut c_void,
    state: *mut c_void,
    size: *mut usize,
) -> Status {
    guard(component, Call::FmuState, |instance| {
        let state = handles::borrow::<FmuState>(state).map_or_else(refuse_state, Ok)?;
        *place(size, "the size of the FMU state")? = instance.serialise(state)?.len();
        Ok(())
    })
}

/// Writes a state as bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: *mut c_void,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> Status {
    guard(component, Call::FmuState, |instance| {
        let content =
            instance.serialise(handles::borrow::<FmuState>(state).map_or_else(refuse_state, Ok)?)?;
        if size < content.len() {
            return error(format!("the FMU state takes {} bytes, not {size}", content.len()));
        }
        list_mut(bytes, content.len())?.copy_from_slice(&content);
        Ok(())
    })
}

/// Reads a state from bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> Status {
    guard(component, Call::FmuState, |instance| {
        let place = place(state, "the FMU state")?;
        *place = handles::give(instance.deserialise(list(bytes, size)?)?);
        Ok(())
    })
}

/// Changes of outputs for a change of inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: *mut c_void,
    unknowns: *const u32,
    n_unknowns: usize,
    knowns: *const u32,
    n_knowns: usize,
    known_changes: *const f64,
    unknown_changes: *mut f64,
) -> Status {
    guard(component, Call::GetDirectionalDerivative, |instance| {
        let (unknowns, knowns) = (list(unknowns, n_unknowns)?, list(knowns, n_knowns)?);
        let (changes, results) = (list(known_changes, n_knowns)?, list_mut(unknown_changes, n_unknowns)?);
        instance.directional_derivative(unknowns, knowns, changes, results)
    })
}

/// First derivatives of inputs, for the next step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    orders: *const c_int,
    values: *const f64,
) -> Status {
    guard(component, Call::SetRealInputDerivatives, |instance| {
        instance.set_input_derivatives(list(references, n)?, list(orders, n)?, list(values, n)?)
    })
}

/// First derivatives of outputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    orders: *const c_int,
    values: *mut f64,
) -> Status {
    guard(component, Call::GetRealOutputDerivatives, |instance| {
        instance.output_derivatives(list(references, n)?, list(orders, n)?, list_mut(values, n)?)
    })
}

/// Advances to the next communication point.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    component: *mut c_void,
    time: f64,
    step: f64,
    _no_set_state_prior: Boolean,
) -> Status {
    guard(component, Call::DoStep, |instance| instance.do_step(time, step))
}

/// Steps are synchronous: there is none to cancel.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(component: *mut c_void) -> Status {
    guard(component, Call::CancelStep, |_| Ok(()))
}

/// Status of an asynchronous step: there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(component: *mut c_void, _kind: c_int, _value: *mut Status) -> Status {
    guard(component, Call::GetStatus, |_| discard_status())
}

/// `fmi2LastSuccessfulTime`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(component: *mut c_void, kind: c_int, value: *mut f64) -> Status {
    const LAST_SUCCESSFUL_TIME: c_int = 2;
    guard(component, Call::GetStatus, |instance| {
        let value = place(value, "the status")?;
        if kind != LAST_SUCCESSFUL_TIME {
            return discard_status();
        }
        *value = instance.time();
        Ok(())
    })
}

/// There is no integer status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(
    component: *mut c_void,
    _kind: c_int,
    _value: *mut c_int,
) -> Status {
    guard(component, Call::GetStatus, |_| discard_status())
}

/// `fmi2Terminated`: the model never ends a simulation by itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    component: *mut c_void,
    kind: c_int,
    value: *mut Boolean,
) -> Status {
    const TERMINATED: c_int = 3;
    guard(component, Call::GetStatus, |_| {
        let value = place(value, "the status")?;
        if kind != TERMINATED {
            return discard_status();
        }
        *value = 0;
        Ok(())
    })
}

/// There is no pending status to describe.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(
    component: *mut c_void,
    _kind: c_int,
    _value: *mut *const c_char,
) -> Status {
    guard(component, Call::GetStatus, |_| discard_status())
}

fn discard_status() -> Outcome {
    Err((Status::Discard, "steps are synchronous: there is no such status".into()))
}
