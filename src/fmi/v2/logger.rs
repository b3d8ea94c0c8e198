//! The importer's logger.
#![allow(unsafe_code)]

use std::ffi::{CStr, CString};

use super::types::CallbackFunctions;
use crate::fmi::log::{Sink, plain};
use crate::fmi::outcome::Status;

/// The logger, and the name that the importer gave the instance.
struct Logger {
    callbacks: CallbackFunctions,
    instance: CString,
}

// SAFETY: an importer may call an instance from any of its threads, one at a time, with the pointers that it gave when it
// made the instance (FMI 2.0.4, section 2.1).
unsafe impl Send for Logger {}

impl Logger {
    fn write(&self, status: Status, category: &CStr, message: &CStr) {
        let Some(logger) = self.callbacks.logger else {
            return;
        };
        // The message is the format: importers whose logger is not variadic (FMPy's is a Python function) would show
        // nothing but "%s" otherwise.
        // SAFETY: the importer guarantees its logger for the instance's lifetime; all strings live through the call; a
        // format whose percent signs all stand twice reads no argument.
        unsafe {
            logger(
                self.callbacks.component_environment,
                self.instance.as_ptr(),
                status.into(),
                category.as_ptr(),
                message.as_ptr(),
            );
        }
    }
}

/// Where messages of an instance go.
pub fn sink(callbacks: CallbackFunctions, instance: &str) -> Sink {
    let logger = Logger { callbacks, instance: plain(instance) };
    Box::new(move |status, category, message| logger.write(status, category, &format_of(message)))
}

/// Text as the format of a message, which an importer's `printf` shows as it is: percent signs, and hashes, which name a
/// variable, stand twice (FMI 2.0.4, section 2.1.5).
fn format_of(text: &str) -> CString {
    plain(&text.replace('%', "%%").replace('#', "##"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_and_hash_stand_twice_in_formats_and_once_in_names() {
        assert_eq!(format_of("100 % of #3\0").as_c_str(), c"100 %% of ##3 ");
        assert_eq!(plain("50%\0#1").as_c_str(), c"50% #1");
    }
}
