//! Messages to the importer's logger.
#![allow(unsafe_code)]

use std::ffi::CString;

use super::types::{CallbackFunctions, Status};

/// Category of a status, as listed in the model description.
fn category(status: Status) -> &'static str {
    match status {
        Status::Ok | Status::Pending => "logEvents",
        Status::Warning => "logStatusWarning",
        Status::Discard => "logStatusDiscard",
        Status::Error => "logStatusError",
        Status::Fatal => "logStatusFatal",
    }
}

/// Where messages go, and which of them.
pub struct Log {
    callbacks: CallbackFunctions,
    instance: CString,
    /// Is logging on?
    on: bool,
    /// Categories asked for; empty is all.
    categories: Vec<String>,
}

/// Text without what a C formatter or an importer would interpret: NUL, percent, hash.
fn plain(text: &str) -> CString {
    let clean: String = text
        .chars()
        .map(|c| match c {
            '\0' => ' ',
            '%' => '/',
            '#' => 'n',
            other => other,
        })
        .collect();
    CString::new(clean).unwrap_or_default()
}

impl Log {
    /// A log that writes to an importer.
    pub fn new(callbacks: CallbackFunctions, instance: &str, on: bool) -> Self {
        Self { callbacks, instance: plain(instance), on, categories: vec![] }
    }

    /// Switches logging, for the named categories or, if there are none, for all.
    pub fn set(&mut self, on: bool, categories: Vec<String>) {
        self.on = on;
        self.categories = categories;
    }

    /// Writes a message. What went wrong is always told; events only with logging on.
    pub fn write(&self, status: Status, message: &str) {
        let category = category(status);
        let wanted = self.categories.is_empty() || self.categories.iter().any(|name| name == category);
        if !wanted || status == Status::Ok && !self.on {
            return;
        }
        if let Some(logger) = self.callbacks.logger {
            let (category, message) = (plain(category), plain(message));
            // The message is passed as the format: it has no percent sign, and importers whose logger is not variadic
            // (FMPy's is a Python function) would show nothing but "%s" otherwise.
            // SAFETY: the importer guarantees its logger for the instance's lifetime; all strings live through the
            // call; a format without percent signs reads no argument.
            unsafe {
                logger(
                    self.callbacks.component_environment,
                    self.instance.as_ptr(),
                    status,
                    category.as_ptr(),
                    message.as_ptr(),
                );
            }
        }
    }
}
