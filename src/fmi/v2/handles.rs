//! Instances and states that importers hold by pointer. Every handle given out is listed, so that one that is null,
//! already freed, of the other kind or never given out is told from a live one without being looked at.
#![allow(unsafe_code)]

use std::any::TypeId;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::sync::{Mutex, MutexGuard, PoisonError};

static LIVE: Mutex<BTreeMap<usize, TypeId>> = Mutex::new(BTreeMap::new());

fn live() -> MutexGuard<'static, BTreeMap<usize, TypeId>> {
    // The list is sound even if a thread panicked while it held the lock.
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Hands a value out.
pub fn give<T: 'static>(value: T) -> *mut c_void {
    let pointer = Box::into_raw(Box::new(value));
    live().insert(pointer as usize, TypeId::of::<T>());
    pointer.cast()
}

/// The value behind a live handle of its type.
///
/// The importer uses an instance, and a state, from one thread at a time (FMI 2.0.4, section 2.1): that is what makes the
/// reference exclusive.
pub fn borrow<'a, T: 'static>(handle: *mut c_void) -> Option<&'a mut T> {
    let known = live().get(&(handle as usize)) == Some(&TypeId::of::<T>());
    // SAFETY: listed, hence made by `give` from a box of this type and not taken back; exclusive as said above.
    if known { unsafe { handle.cast::<T>().as_mut() } } else { None }
}

/// Takes a value back; its handle is dead from now on.
pub fn take<T: 'static>(handle: *mut c_void) -> Option<Box<T>> {
    let mut live = live();
    if live.get(&(handle as usize)) != Some(&TypeId::of::<T>()) {
        return None;
    }
    live.remove(&(handle as usize));
    // SAFETY: it was listed, hence made by `give` from a box of this type, and nobody else can take it any more.
    Some(unsafe { Box::from_raw(handle.cast::<T>()) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_live_handles_of_the_right_type_are_known() {
        let handle = give(7u32);
        assert_eq!(borrow::<u32>(handle).copied(), Some(7));
        assert!(borrow::<u64>(handle).is_none() && take::<u64>(handle).is_none());
        assert!(borrow::<u32>(std::ptr::null_mut()).is_none());
        assert!(borrow::<u32>(std::ptr::without_provenance_mut(0x1234_5678)).is_none());
        assert_eq!(take::<u32>(handle).as_deref(), Some(&7));
        assert!(borrow::<u32>(handle).is_none() && take::<u32>(handle).is_none());
    }
}
