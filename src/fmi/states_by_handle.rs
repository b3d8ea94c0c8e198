//! Saved states that importers hold by handle, and as bytes behind pointers.
#![allow(unsafe_code)]

use std::ffi::c_void;

use super::handles;
use super::instance::Instance;
use super::outcome::{Outcome, error};
use super::pointers::{list, list_mut, place};
use super::saved_state::FmuState;

/// Runs a call on a saved state; a refusal if the handle is not that of one.
fn with_state<T>(state: *mut c_void, work: impl FnOnce(&mut FmuState) -> Outcome<T>) -> Outcome<T> {
    handles::with(state, work).unwrap_or_else(refuse_state)
}

fn refuse_state<T>() -> Outcome<T> {
    error("the FMU state is a null pointer, freed already, or none of ours")
}

/// Copies the state; a state passed in is overwritten.
pub fn save(instance: &Instance, state: Option<&mut *mut c_void>) -> Outcome {
    let place = place(state, "the FMU state")?;
    if place.is_null() {
        *place = handles::give(instance.save());
        return Ok(());
    }
    with_state(*place, |state| {
        *state = instance.save();
        Ok(())
    })
}

/// Goes to a copied state.
pub fn restore(instance: &mut Instance, state: *mut c_void) -> Outcome {
    with_state(state, |state| instance.restore(state))
}

/// Frees a copied state; null is ignored.
pub fn free(state: Option<&mut *mut c_void>) -> Outcome {
    if let Some(place) = state.filter(|place| !place.is_null()) {
        drop(handles::take::<FmuState>(*place).map_or_else(refuse_state, Ok)?);
        *place = std::ptr::null_mut();
    }
    Ok(())
}

/// Bytes that a state takes.
pub fn size(instance: &Instance, state: *mut c_void, size: Option<&mut usize>) -> Outcome {
    let content = with_state(state, |state| instance.serialise(state))?;
    *place(size, "the size of the FMU state")? = content.len();
    Ok(())
}

/// Writes a state as bytes.
///
/// # Safety
/// The pointer is null or valid for writing so many bytes.
pub unsafe fn serialise(instance: &Instance, state: *mut c_void, bytes: *mut u8, size: usize) -> Outcome {
    let content = with_state(state, |state| instance.serialise(state))?;
    if size < content.len() {
        return error(format!("the FMU state takes {} bytes, not {size}", content.len()));
    }
    // SAFETY: as the caller promises.
    unsafe { list_mut(bytes, content.len()) }?.copy_from_slice(&content);
    Ok(())
}

/// Reads a state from bytes.
///
/// # Safety
/// The pointer is null or valid for reading so many bytes.
pub unsafe fn deserialise(
    instance: &Instance,
    bytes: *const u8,
    size: usize,
    state: Option<&mut *mut c_void>,
) -> Outcome {
    let place = place(state, "the FMU state")?;
    // SAFETY: as the caller promises.
    let bytes = unsafe { list(bytes, size) }?;
    *place = handles::give(instance.deserialise(bytes)?);
    Ok(())
}
