//! Sweeps: many cases of one scene, on all cores.
//!
//! | file | contents |
//! |---|---|
//! | `cases` | which cases: a table of scene keys, CSV or TOML |
//! | `setting` | values of keys |
//! | `ranges` | cases from ranges: grid and Latin hypercube |
//! | `case` | one case, from its scene to its row of the summary |
//! | `columns` | columns that are chosen for the summary, of bearings and of a shaft |
//! | `limits` | when chosen columns first come to a limit |
//! | `extremes` | least and largest values of a run, means of chosen columns |
//! | `store` | rows of finished cases on the disk, by a hash of all that they follow from |
//! | `all` | all cases on some threads |
//! | `shard` | parts of a sweep on machines that share a disc, and how they are joined |
//! | `summary` | the summary of all cases, in their order |

pub mod all;
pub mod case;
pub mod cases;
mod columns;
mod extremes;
mod limits;
mod ranges;
pub mod setting;
pub mod shard;
pub mod store;
pub mod summary;

use thiserror::Error;

/// Why a sweep cannot be done. A case that cannot be run is no such error, but a row of the summary.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The table of cases.
    #[error("{file}: {why}")]
    Cases {
        /// File.
        file: String,
        /// Reason.
        why: String,
    },
    /// The base scene.
    #[error(transparent)]
    Scene(#[from] roulement::SceneError),
    /// A key, or all of them together, that no case can be read with.
    #[error("{what} can be read; the first: {why}")]
    NoneRuns {
        /// Which ones.
        what: String,
        /// Why the first of them cannot.
        why: String,
    },
    /// A column that is asked for.
    #[error(transparent)]
    Columns(#[from] crate::report::results::ResultsError),
    /// Files of results.
    #[error("{0}")]
    Files(String),
}

impl SweepError {
    fn file(what: &str, path: &std::path::Path, why: &std::io::Error) -> Self {
        Self::Files(format!("cannot {what} {}: {why}", path.display()))
    }
}
