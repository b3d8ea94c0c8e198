//! Messages to the importer's logger.

use std::ffi::{CStr, CString};

use super::outcome::Status;

/// Where messages go: status, category, format.
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

/// Text without the one character that ends a C text.
pub fn plain(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// Text as the format of a message, which an importer's `printf` shows as it is: percent signs, and hashes, which name a
/// variable, stand twice (FMI 2.0.4, section 2.1.5).
pub fn format_of(text: &str) -> CString {
    plain(&text.replace('%', "%%").replace('#', "##"))
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
        if self.tells(status) {
            (self.sink)(status, category(status), &format_of(message));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_and_hash_stand_twice_in_formats_and_once_in_names() {
        assert_eq!(format_of("100 % of #3\0").as_c_str(), c"100 %% of ##3 ");
        assert_eq!(plain("50%\0#1").as_c_str(), c"50% #1");
    }
}
