//! Values of variables.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::{c_char, c_int, c_void};

use super::guarded;
use crate::fmi::outcome::{Outcome, error};
use crate::fmi::pointers::{list, list_mut};
use crate::fmi::state_machine::Call;
use crate::fmi::v2::types::{Boolean, Status};
use crate::interface::variables::Kind;

/// Reads real variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    values: *mut f64,
) -> Status {
    guarded(component, Call::Get, |instance| {
        // SAFETY: the importer's contract.
        let (references, values) = unsafe { (list(references, n)?, list_mut(values, n)?) };
        instance.get(references, Kind::Real, values)
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
    guarded(component, Call::Get, |instance| {
        // SAFETY: the importer's contract.
        let (references, results) = unsafe { (list(references, n)?, list_mut(values, n)?) };
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
pub extern "C" fn fmi2GetBoolean(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *mut Boolean,
) -> Status {
    guarded(component, Call::Get, |_| none_of_type(n, "boolean"))
}

/// There are no string variables.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetString(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *mut *const c_char,
) -> Status {
    guarded(component, Call::Get, |_| none_of_type(n, "string"))
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
    guarded(component, Call::Set, |instance| {
        // SAFETY: the importer's contract.
        let (references, values) = unsafe { (list(references, n)?, list(values, n)?) };
        instance.set(references, Kind::Real, values)
    })
}

/// There are no integer inputs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: *mut c_void,
    references: *const u32,
    n: usize,
    _values: *const c_int,
) -> Status {
    guarded(component, Call::Set, |instance| {
        // SAFETY: the importer's contract.
        let references = unsafe { list(references, n) }?;
        instance.set(references, Kind::Integer, &vec![0.0; references.len()])
    })
}

/// There are no boolean variables.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetBoolean(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *const Boolean,
) -> Status {
    guarded(component, Call::Set, |_| none_of_type(n, "boolean"))
}

/// There are no string variables.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetString(
    component: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *const *const c_char,
) -> Status {
    guarded(component, Call::Set, |_| none_of_type(n, "string"))
}
