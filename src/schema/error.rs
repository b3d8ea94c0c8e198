//! Why a scene is refused.

use thiserror::Error;

/// Why a scene was refused.
#[derive(Debug, Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("cannot read the scene file {path}: {source}")]
    Read {
        /// Path as given.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// Not TOML, an unknown or missing key, or a value of the wrong kind or dimension.
    #[error("{0}")]
    Format(String),
    /// Any of these, with its place.
    #[error("{place}: {source}")]
    At {
        /// File and line, or one of them.
        place: String,
        /// Error there.
        source: Box<SceneError>,
    },
    /// A value outside its range.
    #[error(
        "{key} = {value}{space}{unit} is out of range: allowed is {range}",
        space = if .unit.is_empty() { "" } else { " " }
    )]
    Range {
        /// Key with its section.
        key: String,
        /// Value in SI.
        value: f64,
        /// SI unit.
        unit: &'static str,
        /// Allowed range in words.
        range: String,
    },
    /// A key that cannot be set or taken out ([`Scene::edited`](crate::scene::Scene::edited)).
    #[error("{key} cannot be changed: {why}")]
    Change {
        /// Key with its section.
        key: String,
        /// Reason.
        why: String,
    },
    /// Keys that do not go together.
    #[error("{key}: {why}")]
    Conflict {
        /// Key with its section.
        key: String,
        /// Reason, and what would be right.
        why: String,
    },
}

impl SceneError {
    /// Keys that do not go together: the one to change, and what would be right.
    pub fn conflict(key: impl Into<String>, why: impl Into<String>) -> Self {
        Self::Conflict { key: key.into(), why: why.into() }
    }
}
