//! Saved states.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::c_void;

use super::guarded;
use crate::fmi::state_machine::Call;
use crate::fmi::states_by_handle as states;
use crate::fmi::v2::types::Status;

/// Copies the state; a state passed in is overwritten.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetFMUstate(component: *mut c_void, state: Option<&mut *mut c_void>) -> Status {
    guarded(component, Call::FmuState, |instance| states::save(instance, state))
}

/// Goes to a copied state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(component: *mut c_void, state: *mut c_void) -> Status {
    guarded(component, Call::FmuState, |instance| states::restore(instance, state))
}

/// Frees a copied state; null is ignored.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeFMUstate(component: *mut c_void, state: Option<&mut *mut c_void>) -> Status {
    guarded(component, Call::FmuState, |_| states::free(state))
}

/// Bytes that a state takes.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializedFMUstateSize(
    component: *mut c_void,
    state: *mut c_void,
    size: Option<&mut usize>,
) -> Status {
    guarded(component, Call::FmuState, |instance| states::size(instance, state, size))
}

/// Writes a state as bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: *mut c_void,
    state: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: the importer's contract.
    guarded(component, Call::FmuState, |instance| unsafe { states::serialise(instance, state, bytes, size) })
}

/// Reads a state from bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: Option<&mut *mut c_void>,
) -> Status {
    // SAFETY: the importer's contract.
    guarded(component, Call::FmuState, |instance| unsafe {
        states::deserialise(instance, bytes, size, state)
    })
}
