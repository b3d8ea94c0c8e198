//! Systems: packages that are connected, written as an SSP file and as an OSP system structure from one description.
//!
//! | file | contents |
//! |---|---|
//! | `description` | the description, a TOML file |
//! | `nearest` | the known name that is nearest to an unknown one |
//! | `interface` | variables and units of a package, from its model description |
//! | `components` | packages of all components: those that are there, and those that are made of scenes |
//! | `connections` | connections of single variables, checked against the packages; signs of mountings, factors of units |
//! | `start` | start values, checked against the packages |
//! | `ssp` | the SSP 1.0 file |
//! | `osp` | the folder for libcosim |

mod components;
mod connections;
mod description;
mod interface;
mod nearest;
mod osp;
mod ssp;
mod start;

use std::path::{Path, PathBuf};

use roulement::schema::regular;
use thiserror::Error;

pub use description::Description;

/// Why a system was not written.
#[derive(Debug, Error)]
pub enum SystemError {
    /// The description, or what it says of a package.
    #[error("{file}: {why}")]
    Description {
        /// File.
        file: String,
        /// Key, value and what is allowed.
        why: String,
    },
    /// A file could not be read or written.
    #[error("cannot {what} {path}: {source}")]
    File {
        /// Action that failed.
        what: &'static str,
        /// File.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The package of a component cannot be used, or its scene not be packed.
    #[error("component {component}: {why}")]
    Component {
        /// Name of the component.
        component: String,
        /// Why.
        why: String,
    },
    /// The zip writer failed.
    #[error("cannot write the SSP file: {0}")]
    Zip(#[from] zip::result::ZipError),
    /// Something in memory failed.
    #[error("cannot write the system: {0}")]
    Write(#[from] std::io::Error),
}

/// An error of the operating system with a file.
fn file_error(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> SystemError {
    let path = path.display().to_string();
    move |source| SystemError::File { what, path, source }
}

/// A system that is checked: what both forms are written from.
struct System {
    name: String,
    /// [s]
    step: f64,
    /// [s]
    stop: f64,
    components: Vec<components::Component>,
    connections: Vec<connections::Connection>,
    /// Start values of each component, in the order of its variables.
    starts: Vec<Vec<start::Start>>,
}

/// Files that were written.
pub struct Written {
    /// The SSP file.
    pub ssp: PathBuf,
    /// The folder for libcosim.
    pub osp: PathBuf,
    /// Notes for the reader.
    pub notes: Vec<String>,
}

/// What a description is of, in one line: its components and connections.
///
/// # Errors
/// If it cannot be read.
pub fn summary(file: &Path) -> Result<String, SystemError> {
    let text = regular::text(file).map_err(file_error("read", file))?;
    let refused = |why| SystemError::Description { file: file.display().to_string(), why };
    let of = Description::read(&text).map_err(refused)?;
    let names: Vec<&str> = of.components.iter().map(|of| of.name.as_str()).collect();
    let (step, stop) = (of.step * 1e6, of.stop * 1e3);
    Ok(format!("{}, {} connections; steps of {step} us to {stop} ms", names.join(", "), of.connections.len()))
}

/// Writes both forms of the system that a file describes into a folder, which is made if missing. Scenes are packed with
/// these libraries.
///
/// # Errors
/// See [`SystemError`]. Where the description is wrong, nothing but packages of its scenes has been written.
pub fn write(file: &Path, folder: &Path, libraries: &[PathBuf]) -> Result<Written, SystemError> {
    let refused = |why| SystemError::Description { file: file.display().to_string(), why };
    let text = regular::text(file).map_err(file_error("read", file))?;
    let description = Description::read(&text).map_err(refused)?;
    let osp = folder.join(format!("{}-osp", description.name));
    std::fs::create_dir_all(&osp).map_err(file_error("make the folder", &osp))?;
    let beside = file.parent().unwrap_or(Path::new(""));
    let (components, mut notes) = components::prepare(&description.components, beside, &osp, libraries)?;
    let (connections, converted) =
        connections::expand(&description.connections, &components).map_err(refused)?;
    notes.extend(converted);
    let starts = start::resolve(&description.start, &components).map_err(refused)?;
    let Description { name, step, stop, .. } = description;
    let system = System { name, step, stop, components, connections, starts };
    osp::write(&system, &osp)?;
    let ssp = folder.join(format!("{}.ssp", system.name));
    ssp::write(&system, &osp, &ssp)?;
    Ok(Written { ssp, osp, notes })
}
