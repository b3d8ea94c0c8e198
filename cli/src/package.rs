//! Packs a scene as an FMU: model description, shared library, scene and documentation in one zip file.

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use roulement::fmi::v2::SCENE_FILE;
use roulement::interface::documentation;
use roulement::interface::model_description::{MODEL_IDENTIFIER, render};
use roulement::scene::Scene;
use roulement::simulation::{Simulation, SimulationError};

/// Why a package was not written.
#[derive(Debug, Error)]
pub enum PackageError {
    /// The scene cannot be started, so that its package could not either.
    #[error(transparent)]
    Start(#[from] SimulationError),
    /// A file could not be read or written.
    #[error("{what} {path}: {source}")]
    File {
        /// What was tried.
        what: &'static str,
        /// File.
        path: String,
        /// What the operating system said.
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
    /// A library of no platform that packages know.
    #[error(
        "the shared library {0} ends neither in .so nor in .dll nor in .dylib: its platform is not known"
    )]
    Platform(String),
}

/// Folder in a package (FMI 2.0.4, section 2.3) and ending of the library, per platform; all are 64-bit x86.
const PLATFORMS: [(&str, &str); 3] = [("linux64", "so"), ("win64", "dll"), ("darwin64", "dylib")];

/// Folder and ending of a library.
fn platform(library: &Path) -> Result<(&'static str, &'static str), PackageError> {
    let ending = library.extension().unwrap_or_default();
    let found = PLATFORMS.into_iter().find(|(_, known)| ending == *known);
    found.ok_or_else(|| PackageError::Platform(library.display().to_string()))
}

/// Path of the shared library that was built together with this executable.
///
/// # Errors
/// If it is not there.
pub fn library_beside_executable() -> Result<PathBuf, PackageError> {
    let name = format!("{}{MODEL_IDENTIFIER}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let executable = std::env::current_exe()?;
    let path = executable.with_file_name(name);
    if path.is_file() { Ok(path) } else { Err(PackageError::NoLibrary(path.display().to_string())) }
}

/// Writes the package of a scene, with one library per platform, to `output`; an existing file is replaced only by a complete one.
///
/// # Errors
/// See [`PackageError`].
pub fn write_fmu(scene: &Scene, libraries: &[PathBuf], output: &Path) -> Result<(), PackageError> {
    if let Some(missing) = libraries.iter().find(|library| !library.is_file()) {
        return Err(PackageError::NoLibrary(missing.display().to_string()));
    }
    let file_error = |what: &'static str, path: &Path| {
        let path = path.display().to_string();
        move |source| PackageError::File { what, path, source }
    };
    let simulation = Simulation::new(scene)?;
    let description = render(&simulation)?;

    // Without time stamps: the same scene and library give the same bytes.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let mut add = |name: &str, content: &[u8]| -> Result<(), PackageError> {
        zip.start_file(name, options)?;
        Ok(zip.write_all(content)?)
    };
    add("modelDescription.xml", description.xml.as_bytes())?;
    for library in libraries {
        let (folder, ending) = platform(library)?;
        let binary = fs::read(library).map_err(file_error("cannot read", library))?;
        add(&format!("binaries/{folder}/{MODEL_IDENTIFIER}.{ending}"), &binary)?;
    }
    add(&format!("resources/{SCENE_FILE}"), scene.source.as_bytes())?;
    add("model.png", include_bytes!("../../assets/model.png"))?;
    add("documentation/licenses/licenses.txt", include_bytes!("../../assets/licenses.txt"))?;
    add("documentation/index.html", documentation::page(scene).as_bytes())?;
    let bytes = zip.finish()?.into_inner();

    let partial = output.with_extension("fmu.part");
    fs::write(&partial, bytes).map_err(file_error("cannot write", &partial))?;
    fs::rename(&partial, output).map_err(file_error("cannot write", output))
}
