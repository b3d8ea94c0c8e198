//! Packs a scene as an FMU: model description, shared library, scene and documentation in one zip file.

mod beside;
mod library;
mod paths;
mod strip;

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

pub use beside::{libraries_beside, library_beside, library_beside_executable};
use library::{Candidates, Platform};
use thiserror::Error;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use roulement::fmi::SCENE_FILE;
use roulement::interface::documentation;
use roulement::interface::model_description::{Edition, ModelDescription, Version, identifier, render_as};
use roulement::interface::terminals;
use roulement::interface::variables::{Causality, MachineVariables, Variable};
use roulement::scene::machine::MachineScene;
use roulement::schema::regular::{self, LARGEST_BINARY};
use roulement::simulation::machine::{Machine, MachineError};

use crate::report::results::fits;

/// Why a package was not written.
#[derive(Debug, Error)]
pub enum PackageError {
    /// The scene cannot be started, so that its package could not either.
    #[error(transparent)]
    Start(#[from] MachineError),
    /// A file could not be read or written.
    #[error("{what} {path}: {source}")]
    File {
        /// The operation that failed.
        what: &'static str,
        /// File.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// Something in memory failed.
    #[error("cannot write the package: {0}")]
    Write(#[from] std::io::Error),
    /// The zip writer failed.
    #[error("cannot write the package: {0}")]
    Zip(#[from] zip::result::ZipError),
    /// The shared library is not there.
    #[error(
        "the shared library {0} is missing: build it with `cargo build --release`, or name it with --library"
    )]
    NoLibrary(String),
    /// There are shared libraries, but none that was built together with the program.
    #[error(
        "the shared library {0} is of another build than this program: build both with `cargo build --release`, or name one with --library"
    )]
    OtherBuild(String),
    /// A library of no platform that packages know.
    #[error(
        "the shared library {0} ends neither in .so nor in .dll nor in .dylib: its platform is not known"
    )]
    Platform(String),
    /// A library that the platform its name promises does not load.
    #[error("the library {path} cannot be packed for {folder}: it is {found}; needed is {wanted}")]
    Library {
        /// File.
        path: String,
        /// Folders of the platforms that have such libraries.
        folder: String,
        /// Kind of the file.
        found: String,
        /// Kind of file that they load.
        wanted: String,
    },
    /// No output is chosen by a name.
    #[error("--columns {0}: no output of the package has such a name; `*` stands for any characters")]
    Column(String),
    /// Two libraries for one platform.
    #[error("there are two libraries for {0}")]
    Twice(&'static str),
}

/// A library as packages carry it, and its platform, after a look at its header.
///
/// # Errors
/// If it cannot be read, its ending is of no platform, or it is not what its ending says.
fn read_library(path: &Path) -> Result<(Platform, Vec<u8>), PackageError> {
    let name = || path.display().to_string();
    let platforms = Candidates::of(path).ok_or_else(|| PackageError::Platform(name()))?;
    let library = regular::bytes(path, LARGEST_BINARY).map_err(file_error("cannot read", path))?;
    let refused = |found| PackageError::Library {
        path: name(),
        folder: platforms.folders(),
        found,
        wanted: platforms.wanted(),
    };
    let platform = platforms.loading(&library).map_err(refused)?;
    let mut library = strip::stripped(library);
    paths::hide(&mut library);
    Ok((platform, library))
}

/// Turns an error of the operating system with a file into a [`PackageError`].
fn file_error(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> PackageError {
    let path = path.display().to_string();
    move |source| PackageError::File { what, path, source }
}

/// Name of a package that is given none: that of its file.
pub fn name_of(file: &Path) -> String {
    file.file_stem().map_or_else(|| "bearing".into(), |stem| stem.to_string_lossy().into_owned())
}

/// Contents of a package beside its libraries.
struct Content<'a> {
    /// Version of the standard.
    version: Version,
    description: ModelDescription,
    /// Its terminals.
    terminals: String,
    /// The text that its library reads.
    source: &'a str,
    /// Its documentation.
    page: String,
}

/// Writes the package of a machine as an edition under a name, with one library per platform, to `output`; an existing file is replaced only by a complete one.
/// It has those outputs alone whose names fit one of the patterns, as [`crate::report::results::Choice`] has them; all if there is none.
///
/// # Errors
/// See [`PackageError`].
pub fn write_fmu(
    scene: &MachineScene,
    edition: &Edition,
    name: &str,
    columns: &[String],
    libraries: &[PathBuf],
    output: &Path,
) -> Result<(), PackageError> {
    let libraries = read_libraries(libraries)?;
    let machine = Machine::new(scene)?;
    let variables = MachineVariables::new(&machine);
    let wanted = wanted(columns, variables.rows())?;
    let terminals = terminals::terminals(variables.rows(), edition.version, scene.has_arrays(), &wanted);
    let terminals = terminals::render(&terminals)?;
    let description = render_as(edition, &machine, name, &wanted)?;
    let page = match &machine {
        Machine::Bearing(bearing) => documentation::page(bearing.scene(), &wanted),
        Machine::Shaft(system) => documentation::system_page(system, &wanted),
    };
    write(
        &Content { version: edition.version, description, terminals, source: scene.source(), page },
        name,
        &libraries,
        output,
    )
}

/// Names of outputs that fit one of the patterns.
fn wanted<'a>(
    columns: &'a [String],
    rows: &[Variable],
) -> Result<impl Fn(&str) -> bool + use<'a>, PackageError> {
    let outputs = || rows.iter().filter(|row| row.causality == Causality::Output);
    let missing = |pattern: &&String| !outputs().any(|row| fits(&row.name, pattern));
    match columns.iter().find(missing) {
        Some(pattern) => Err(PackageError::Column(pattern.clone())),
        None => Ok(move |name: &str| columns.is_empty() || columns.iter().any(|pattern| fits(name, pattern))),
    }
}

/// Reads one library per platform.
fn read_libraries(libraries: &[PathBuf]) -> Result<Vec<(Platform, Vec<u8>)>, PackageError> {
    if let Some(missing) = libraries.iter().find(|library| !library.is_file()) {
        return Err(PackageError::NoLibrary(missing.display().to_string()));
    }
    let libraries: Vec<_> = libraries.iter().map(|path| read_library(path)).collect::<Result<_, _>>()?;
    for (index, (platform, _)) in libraries.iter().enumerate() {
        if libraries[..index].iter().any(|(other, _)| other == platform) {
            return Err(PackageError::Twice(platform.folder));
        }
    }
    Ok(libraries)
}

/// May a file be put in the place of what is there? Not of a device or a folder: as root `-o /dev/null` would take that away from the machine.
///
/// # Errors
/// Says that it is no file.
pub fn replaceable(path: &Path) -> std::io::Result<()> {
    match fs::metadata(path) {
        Ok(there) if !there.is_file() => {
            Err(std::io::Error::other("it is there and is no file: nothing is put in its place"))
        }
        _ => Ok(()),
    }
}

fn write(
    content: &Content<'_>,
    name: &str,
    libraries: &[(Platform, Vec<u8>)],
    output: &Path,
) -> Result<(), PackageError> {
    replaceable(output).map_err(file_error("cannot write", output))?;
    let identifier = identifier(name);
    let version = content.version;
    // Without time stamps: the same scene and library give the same bytes.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let mut add = |name: &str, content: &[u8]| -> Result<(), PackageError> {
        zip.start_file(name, options)?;
        Ok(zip.write_all(content)?)
    };
    add("modelDescription.xml", content.description.xml.as_bytes())?;
    for (platform, library) in libraries {
        let (folder, ending) = (platform.folder_of(version), platform.ending);
        add(&format!("binaries/{folder}/{identifier}.{ending}"), library)?;
    }
    add(&format!("resources/{SCENE_FILE}"), content.source.as_bytes())?;
    let icon = include_bytes!("../../../assets/model.png");
    if version == Version::V2 {
        // Where importers look that know nothing of 2.0.4.
        add("model.png", icon)?;
    }
    add("terminalsAndIcons/icon.png", icon)?;
    add("terminalsAndIcons/terminalsAndIcons.xml", content.terminals.as_bytes())?;
    add("documentation/licenses/license.txt", include_bytes!("../../../assets/licenses.txt"))?;
    add("documentation/index.html", content.page.as_bytes())?;
    let bytes = zip.finish()?.into_inner();

    let partial = output.with_extension("fmu.part");
    let written = fs::write(&partial, bytes).map_err(file_error("cannot write", &partial));
    let written =
        written.and_then(|()| fs::rename(&partial, output).map_err(file_error("cannot write", output)));
    if written.is_err() {
        // The error is told already; where nothing was written, there is nothing to remove.
        let _ = fs::remove_file(&partial);
    }
    written
}
