//! Lists and texts that importers pass by pointer.
#![allow(unsafe_code)]

use std::ffi::{CStr, c_char};
use std::slice;

use crate::fmi::outcome::{Outcome, error};

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
///
/// # Safety
/// The pointer is null, or valid for reading `n` elements for as long as the slice is used.
pub unsafe fn list<'a, T>(pointer: *const T, n: usize) -> Outcome<&'a [T]> {
    if !check_list(pointer.is_null(), n)? {
        return Ok(&[]);
    }
    // SAFETY: not null and not empty, and valid for n elements as the caller promises.
    Ok(unsafe { slice::from_raw_parts(pointer, n) })
}

/// A writable slice of `n` elements.
///
/// # Safety
/// The pointer is null, or valid for `n` elements that nothing else uses for as long as the slice is used.
pub unsafe fn list_mut<'a, T>(pointer: *mut T, n: usize) -> Outcome<&'a mut [T]> {
    if !check_list(pointer.is_null(), n)? {
        return Ok(&mut []);
    }
    // SAFETY: not null and not empty, and valid for n elements as the caller promises.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, n) })
}

/// A text; none for a null pointer.
///
/// # Safety
/// The pointer is null or that of a C string.
pub unsafe fn text(pointer: *const c_char) -> Option<String> {
    // SAFETY: not null, and a C string as the caller promises.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned())
}

/// The texts of a list; null pointers among them are left out.
///
/// # Safety
/// As of [`list`], and every pointer is null or that of a C string.
pub unsafe fn texts(pointer: *const *const c_char, n: usize) -> Outcome<Vec<String>> {
    // SAFETY: as the caller promises.
    Ok(unsafe { list(pointer, n) }?.iter().filter_map(|one| unsafe { text(*one) }).collect())
}

/// A place for a result.
///
/// # Errors
/// If there is none.
pub fn place<'a, T>(place: Option<&'a mut T>, what: &str) -> Outcome<&'a mut T> {
    place.map_or_else(|| error(format!("the place for {what} is a null pointer")), Ok)
}
