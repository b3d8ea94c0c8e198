//! C types of FMI 2.0 (fmi2TypesPlatform.h, fmi2FunctionTypes.h).

use std::ffi::{c_char, c_int, c_void};

use crate::fmi::outcome;

/// `fmi2Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// All well.
    Ok = 0,
    /// Done, but not quite as asked.
    Warning = 1,
    /// Not done; the instance is as before.
    Discard = 2,
    /// Refused; the instance can be reset or freed.
    Error = 3,
    /// The instance is lost.
    Fatal = 4,
    /// Not used: steps are synchronous.
    Pending = 5,
}

impl From<outcome::Status> for Status {
    fn from(status: outcome::Status) -> Self {
        match status {
            outcome::Status::Ok => Self::Ok,
            outcome::Status::Warning => Self::Warning,
            outcome::Status::Discard => Self::Discard,
            outcome::Status::Error => Self::Error,
            outcome::Status::Fatal => Self::Fatal,
        }
    }
}

/// `fmi2Boolean`.
pub type Boolean = c_int;

/// The importer's variadic logger.
pub type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct CallbackFunctions {
    /// Logger; may be null.
    pub logger: Option<Logger>,
    /// Allocator of the importer; not used.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Its counterpart; not used.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// End of an asynchronous step; not used.
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, Status)>,
    /// Handed back to the logger.
    pub component_environment: *mut c_void,
}
