//! Instances and states that importers hold by handle. A handle is a number that is given out once, not an address: one
//! that is null, ended, of the other kind or never given out is told from a live one without being looked at. A value is
//! with one caller at a time; another call finds it in use.

use std::any::Any;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// None while the value is in use.
type Held = Option<Box<dyn Any + Send>>;

static HELD: Mutex<BTreeMap<usize, Held>> = Mutex::new(BTreeMap::new());
static NEXT: AtomicUsize = AtomicUsize::new(1);

fn held() -> MutexGuard<'static, BTreeMap<usize, Held>> {
    // The list is valid even if a thread panicked while it held the lock.
    HELD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Hands a value out.
pub fn give<T: Send + 'static>(value: T) -> *mut c_void {
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    held().insert(number, Some(Box::new(value)));
    std::ptr::without_provenance_mut(number)
}

/// A value in use, which is put back at the end, also if that is a panic.
struct InUse<T: Send + 'static> {
    number: usize,
    value: Option<Box<T>>,
}

impl<T: Send + 'static> Drop for InUse<T> {
    fn drop(&mut self) {
        if let (Some(place), Some(value)) = (held().get_mut(&self.number), self.value.take()) {
            *place = Some(value);
        }
    }
}

/// Does something with the value behind a handle; nothing if there is none of this type or it is in use.
pub fn with<T: Send + 'static, R>(handle: *mut c_void, work: impl FnOnce(&mut T) -> R) -> Option<R> {
    let number = handle.addr();
    let value = {
        let mut held = held();
        let place = held.get_mut(&number)?;
        place.take_if(|value| value.is::<T>())?.downcast::<T>().ok()
    };
    let mut used = InUse { number, value };
    used.value.as_deref_mut().map(work)
}

/// Takes a value back; its handle is dead from now on.
pub fn take<T: Send + 'static>(handle: *mut c_void) -> Option<Box<T>> {
    let mut held = held();
    let value = held.get_mut(&handle.addr())?.take_if(|value| value.is::<T>())?;
    held.remove(&handle.addr());
    value.downcast().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(handle: *mut c_void) -> Option<u32> {
        with(handle, |value: &mut u32| *value)
    }

    #[test]
    fn only_live_handles_of_the_right_type_are_known() {
        let handle = give(7u32);
        assert!(!handle.is_null());
        assert_eq!(value(handle), Some(7));
        assert!(with(handle, |_: &mut u64| ()).is_none() && take::<u64>(handle).is_none());
        assert!(value(std::ptr::null_mut()).is_none());
        assert!(value(std::ptr::without_provenance_mut(usize::MAX)).is_none());
        with(handle, |value: &mut u32| *value += 1);
        assert_eq!(value(handle), Some(8));
        assert_eq!(take::<u32>(handle).as_deref(), Some(&8));
        assert!(value(handle).is_none() && take::<u32>(handle).is_none());
        // A dead handle does not come to life again.
        let other = give(9u32);
        assert!(other != handle && value(handle).is_none());
        assert!(take::<u32>(other).is_some());
    }

    #[test]
    fn a_value_is_with_one_caller_at_a_time() {
        let (handle, other) = (give(1u32), give(2u32));
        let inside = with(handle, |_: &mut u32| (value(handle), take::<u32>(handle), value(other)));
        assert_eq!(inside, Some((None, None, Some(2))));
        assert_eq!(value(handle), Some(1));
        // A panic does not keep it.
        let panicked = std::panic::catch_unwind(|| with(handle, |_: &mut u32| panic!("on purpose")));
        assert!(panicked.is_err());
        assert_eq!(value(handle), Some(1));
        assert!(take::<u32>(handle).is_some() && take::<u32>(other).is_some());
    }
}
