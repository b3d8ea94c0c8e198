//! Saved states.
#![allow(unsafe_code)]
#![allow(clippy::missing_safety_doc)] // the contract is in the parent module

use std::ffi::c_void;

use super::guard;
use crate::fmi::handles;
use crate::fmi::outcome::{Outcome, error};
use crate::fmi::saved_state::FmuState;
use crate::fmi::v2::pointers::{list, list_mut, place};
use crate::fmi::v2::state_machine::Call;
use crate::fmi::v2::types::Status;

/// Runs a call on a saved state; a refusal if the handle is not that of one.
fn with_state<T>(state: *mut c_void, work: impl FnOnce(&mut FmuState) -> Outcome<T>) -> Outcome<T> {
    handles::with(state, work).unwrap_or_else(refuse_state)
}

fn refuse_state<T>() -> Outcome<T> {
    error("the FMU state is a null pointer, freed already, or none of ours")
}

/// Copies the state; a state passed in is overwritten.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetFMUstate(component: *mut c_void, state: Option<&mut *mut c_void>) -> Status {
    guard(component, Call::FmuState, |instance| {
        let place = place(state, "the FMU state")?;
        if place.is_null() {
            *place = handles::give(instance.save());
            return Ok(());
        }
        with_state(*place, |state| {
            *state = instance.save();
            Ok(())
        })
    })
}

/// Goes to a copied state.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(component: *mut c_void, state: *mut c_void) -> Status {
    guard(component, Call::FmuState, |instance| with_state(state, |state| instance.restore(state)))
}

/// Frees a copied state; null is ignored.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeFMUstate(component: *mut c_void, state: Option<&mut *mut c_void>) -> Status {
    guard(component, Call::FmuState, |_| {
        if let Some(place) = state.filter(|place| !place.is_null()) {
            drop(handles::take::<FmuState>(*place).map_or_else(refuse_state, Ok)?);
            *place = std::ptr::null_mut();
        }
        Ok(())
    })
}

/// Bytes that a state takes.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializedFMUstateSize(
    component: *mut c_void,
    state: *mut c_void,
    size: Option<&mut usize>,
) -> Status {
    guard(component, Call::FmuState, |instance| {
        let content = with_state(state, |state| instance.serialise(state))?;
        *place(size, "the size of the FMU state")? = content.len();
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
        let content = with_state(state, |state| instance.serialise(state))?;
        if size < content.len() {
            return error(format!("the FMU state takes {} bytes, not {size}", content.len()));
        }
        // SAFETY: the importer's contract.
        unsafe { list_mut(bytes, content.len()) }?.copy_from_slice(&content);
        Ok(())
    })
}

/// Reads a state from bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: *mut c_void,
    bytes: *const u8,
    size: usize,
    state: Option<&mut *mut c_void>,
) -> Status {
    guard(component, Call::FmuState, |instance| {
        let place = place(state, "the FMU state")?;
        // SAFETY: the importer's contract.
        let bytes = unsafe { list(bytes, size) }?;
        *place = handles::give(instance.deserialise(bytes)?);
        Ok(())
    })
}
