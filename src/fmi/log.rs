//! Messages to the importer's logger.

use std::ffi::{CStr, CString};

use super::outcome::{Outcome, Status, error};
use crate::interface::model_description::LOG_CATEGORIES;

/// Where messages go: status, category, text.
pub type Sink = Box<dyn Fn(Status, &CStr, &str) + Send>;

/// Category of a status, as listed in the model description.
fn category(status: Status) -> &'static CStr {
    match status {
        Status::Ok => c"logEvents",
        Status::Warning => c"logStatusWarning",
        Status::Discard => c"logStatusDiscard",
        Status::Error => c"logStatusError",
        Status::Fatal => c"logStatusFatal",
    }
}

/// Where messages go, and which of them.
pub struct Log {
    sink: Sink,
    /// Is logging on?
    on: bool,
    /// Categories asked for; empty is all.
    categories: Vec<String>,
}

/// Text without the one character that ends a C text.
pub fn plain(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

impl Log {
    /// A log that writes to an importer.
    pub fn new(sink: Sink, on: bool) -> Self {
        Self { sink, on, categories: vec![] }
    }

    /// Switches logging, for the named categories or, if there are none, for all.
    ///
    /// # Errors
    /// If there is no such category.
    pub fn set(&mut self, on: bool, categories: Vec<String>) -> Outcome {
        let known = |name: &String| LOG_CATEGORIES.iter().any(|(known, _)| known == name);
        if let Some(unknown) = categories.iter().find(|name| !known(name)) {
            return error(format!("there is no log category {unknown}"));
        }
        self.on = on;
        self.categories = categories;
        Ok(())
    }

    /// Writes a message. What went wrong is always told; events only with logging on.
    pub fn write(&self, status: Status, message: &str) {
        if self.tells(status) {
            (self.sink)(status, category(status), message);
        }
    }

    /// Are messages of a status wanted?
    pub fn tells(&self, status: Status) -> bool {
        let category = category(status);
        let wanted = self.categories.is_empty()
            || self.categories.iter().any(|name| name.as_bytes() == category.to_bytes());
        wanted && (status != Status::Ok || self.on)
    }
}
