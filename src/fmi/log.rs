//! Messages to the importer's logger.

use std::ffi::{CStr, CString};

use super::outcome::Status;

/// Where messages go: status, category, text.
pub type Sink = Box<dyn Fn(Status, &CStr, &CStr) + Send>;

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

/// Text without what a C formatter or an importer would interpret: NUL, percent, hash.
pub fn plain(text: &str) -> CString {
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
    pub fn new(sink: Sink, on: bool) -> Self {
        Self { sink, on, categories: vec![] }
    }

    /// Switches logging, for the named categories or, if there are none, for all.
    pub fn set(&mut self, on: bool, categories: Vec<String>) {
        self.on = on;
        self.categories = categories;
    }

    /// Writes a message. What went wrong is always told; events only with logging on.
    pub fn write(&self, status: Status, message: &str) {
        let category = category(status);
        let wanted = self.categories.is_empty()
            || self.categories.iter().any(|name| name.as_bytes() == category.to_bytes());
        if wanted && (status != Status::Ok || self.on) {
            (self.sink)(status, category, &plain(message));
        }
    }
}
