//! Outcome of a call, independent of the version of the interface.

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// All well.
    Ok,
    /// Done, but probably not what was meant.
    Warning,
    /// Not done; the instance is at the last time it reached.
    Discard,
    /// Refused.
    Error,
    /// A fault of the model: the instance is lost.
    Fatal,
}

/// A refusal or failure: its status and why.
pub type Outcome<T = ()> = Result<T, (Status, String)>;

/// A refusal.
pub fn error<T>(why: impl Into<String>) -> Outcome<T> {
    Err((Status::Error, why.into()))
}
