//! C types of FMI 3.0 (fmi3PlatformTypes.h, fmi3FunctionTypes.h). `fmi3Boolean` and `fmi3Clock` are `bool`, value references `u32`.

use std::ffi::{c_char, c_void};

use crate::fmi::outcome;

/// `fmi3Status`.
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

/// `fmi3LogMessageCallback`.
pub type LogMessage = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// `fmi3IntermediateUpdateCallback`: environment, time, may inputs be set, may values be read, was a step finished, may the step end
/// here, and the importer's answer to the last.
pub type IntermediateUpdate =
    unsafe extern "C" fn(*mut c_void, f64, bool, bool, bool, bool, *mut bool, *mut f64);
