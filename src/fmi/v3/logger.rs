//! The importer's logger.
#![allow(unsafe_code)]

use std::ffi::{CStr, c_void};

use super::types::LogMessage;
use crate::fmi::log::{Sink, plain};
use crate::fmi::outcome::Status;

/// Something of the importer's that is handed back to it.
#[derive(Clone, Copy)]
pub struct Environment(pub *mut c_void);

// SAFETY: an importer may call an instance from any of its threads, one at a time, with the pointers that it gave when it
// made the instance (FMI 3.0, section 2.2.1); they are handed back and never read from.
unsafe impl Send for Environment {}

impl Environment {
    fn write(self, log: LogMessage, status: Status, category: &CStr, message: &str) {
        let message = plain(message);
        // SAFETY: the importer guarantees its logger for the instance's lifetime; both texts live through the call.
        unsafe { log(self.0, status.into(), category.as_ptr(), message.as_ptr()) };
    }
}

/// Where messages of an instance go.
pub fn sink(environment: Environment, log: Option<LogMessage>) -> Sink {
    Box::new(move |status, category, message| {
        if let Some(log) = log {
            environment.write(log, status, category, message);
        }
    })
}
