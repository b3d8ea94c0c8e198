//! Saved states.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::c_void;

use super::guarded;
use crate::fmi::state_machine::Call;
use crate::fmi::states_by_handle as states;
use crate::fmi::v3::types::Status;

/// Copies the state; a state passed in is overwritten.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetFMUState(instance: *mut c_void, state: Option<&mut *mut c_void>) -> Status {
    guarded(instance, Call::FmuState, |slave| states::save(&slave.instance, state))
}

/// Goes to a copied state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(instance: *mut c_void, state: *mut c_void) -> Status {
    guarded(instance, Call::FmuState, |slave| states::restore(&mut slave.instance, state))
}

/// Frees a copied state; null is ignored.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeFMUState(instance: *mut c_void, state: Option<&mut *mut c_void>) -> Status {
    guarded(instance, Call::FmuState, |_| states::free(state))
}

/// Bytes that a state takes.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut c_void,
    state: *mut c_void,
    size: Option<&mut usize>,
) -> Status {
    guarded(instance, Call::FmuState, |slave| states::size(&slave.instance, state, size))
}

/// Writes a state as bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut c_void,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> Status {
    guarded(instance, Call::FmuState, |slave| {
        // SAFETY: the importer's contract.
        unsafe { states::serialise(&slave.instance, state, bytes, size) }
    })
}

/// Reads a state from bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: Option<&mut *mut c_void>,
) -> Status {
    guarded(instance, Call::FmuState, |slave| {
        // SAFETY: the importer's contract.
        unsafe { states::deserialise(&slave.instance, bytes, size, state) }
    })
}
