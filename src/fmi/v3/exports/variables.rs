//! Values of variables: real numbers and counts. There are none of the other types.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::{c_char, c_void};

use super::guarded;
use crate::fmi::outcome::{Outcome, error};
use crate::fmi::pointers::{list, list_mut};
use crate::fmi::state_machine::Call;
use crate::fmi::v3::types::Status;
use crate::interface::variables::Kind;

/// Reads real variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const u32,
    n: usize,
    values: *mut f64,
    n_values: usize,
) -> Status {
    guarded(instance, Call::Get, |slave| {
        // SAFETY: the importer's contract.
        let (references, values) = unsafe { (list(references, n)?, list_mut(values, n_values)?) };
        slave.get(references, Kind::Real, values)
    })
}

/// Reads counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetInt64(
    instance: *mut c_void,
    references: *const u32,
    n: usize,
    values: *mut i64,
    n_values: usize,
) -> Status {
    guarded(instance, Call::Get, |slave| {
        // SAFETY: the importer's contract.
        let (references, results) = unsafe { (list(references, n)?, list_mut(values, n_values)?) };
        let mut values = vec![0.0; results.len()];
        slave.get(references, Kind::Integer, &mut values)?;
        results.iter_mut().zip(values).for_each(|(result, value)| *result = value as i64);
        Ok(())
    })
}

/// Sets real inputs and parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const u32,
    n: usize,
    values: *const f64,
    n_values: usize,
) -> Status {
    guarded(instance, Call::Set, |slave| {
        // SAFETY: the importer's contract.
        let (references, values) = unsafe { (list(references, n)?, list(values, n_values)?) };
        slave.set(references, Kind::Real, values)
    })
}

/// There are no inputs that count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetInt64(
    instance: *mut c_void,
    references: *const u32,
    n: usize,
    _values: *const i64,
    _n_values: usize,
) -> Status {
    guarded(instance, Call::Set, |slave| {
        // SAFETY: the importer's contract.
        let references = unsafe { list(references, n) }?;
        slave.set(references, Kind::Integer, &vec![0.0; references.len()])
    })
}

fn none_of_type(n: usize, kind: &str) -> Outcome {
    if n == 0 { Ok(()) } else { error(format!("there are no {kind} variables that this could mean")) }
}

macro_rules! no_variables {
    ($($get:ident, $set:ident: $type:ty, $kind:literal;)*) => {$(
        #[doc = concat!("There are no ", $kind, " variables.")]
        #[unsafe(no_mangle)]
        pub extern "C" fn $get(
            instance: *mut c_void,
            _references: *const u32,
            n: usize,
            _values: *mut $type,
            _n_values: usize,
        ) -> Status {
            guarded(instance, Call::Get, |_| none_of_type(n, $kind))
        }

        #[doc = concat!("There are no ", $kind, " variables.")]
        #[unsafe(no_mangle)]
        pub extern "C" fn $set(
            instance: *mut c_void,
            _references: *const u32,
            n: usize,
            _values: *const $type,
            _n_values: usize,
        ) -> Status {
            guarded(instance, Call::Set, |_| none_of_type(n, $kind))
        }
    )*};
}

no_variables! {
    fmi3GetFloat32, fmi3SetFloat32: f32, "Float32";
    fmi3GetInt8, fmi3SetInt8: i8, "Int8";
    fmi3GetUInt8, fmi3SetUInt8: u8, "UInt8";
    fmi3GetInt16, fmi3SetInt16: i16, "Int16";
    fmi3GetUInt16, fmi3SetUInt16: u16, "UInt16";
    fmi3GetInt32, fmi3SetInt32: i32, "Int32";
    fmi3GetUInt32, fmi3SetUInt32: u32, "UInt32";
    fmi3GetUInt64, fmi3SetUInt64: u64, "UInt64";
    fmi3GetBoolean, fmi3SetBoolean: bool, "Boolean";
    fmi3GetString, fmi3SetString: *const c_char, "String";
}

/// There are no binary variables.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetBinary(
    instance: *mut c_void,
    _references: *const u32,
    n: usize,
    _sizes: *mut usize,
    _values: *mut *const u8,
    _n_values: usize,
) -> Status {
    guarded(instance, Call::Get, |_| none_of_type(n, "Binary"))
}

/// There are no binary variables.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetBinary(
    instance: *mut c_void,
    _references: *const u32,
    n: usize,
    _sizes: *const usize,
    _values: *const *const u8,
    _n_values: usize,
) -> Status {
    guarded(instance, Call::Set, |_| none_of_type(n, "Binary"))
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetClock(
    instance: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *mut bool,
) -> Status {
    guarded(instance, Call::Get, |_| none_of_type(n, "Clock"))
}

/// There are no clocks.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetClock(
    instance: *mut c_void,
    _references: *const u32,
    n: usize,
    _values: *const bool,
) -> Status {
    guarded(instance, Call::Set, |_| none_of_type(n, "Clock"))
}
