//! Packs a scene as an FMU: model description, shared library, scene and documentation in one zip file.

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::documentation;
use crate::fmi2::SCENE_FILE;
use crate::model_description::{MODEL_IDENTIFIER, render};
use crate::scene::Scene;
use crate::simulation::{Simulation, SimulationError};

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
}

/// Folder and file ending of this platform's library in a package (FMI 2.0.4, section 2.3).
const PLATFORM: (&str, &str) = if cfg!(windows) {
    ("win64", "dll")
} else if cfg!(target_os = "macos") {
    ("darwin64", "dylib")
} else {
    ("linux64", "so")
};

/// Path of the shared library that was built together with this executable.
///
/// # Errors
/// If it is not there.
pub fn library_beside_executable() -> Result<PathBuf, PackageError> {
    let name =
        if cfg!(windows) { "roulement.dll".into() } else { format!("lib{MODEL_IDENTIFIER}.{}", PLATFORM.1) };
    let executable = std::env::current_exe()?;
    let path = executable.with_file_name(name);
    if path.is_file() { Ok(path) } else { Err(PackageError::NoLibrary(path.display().to_string())) }
}

/// Writes the package of a scene to `output`; an existing file is replaced only by a complete one.
///
/// # Errors
/// See [`PackageError`].
pub fn write_fmu(scene: &Scene, library: &Path, output: &Path) -> Result<(), PackageError> {
    if !library.is_file() {
        return Err(PackageError::NoLibrary(library.display().to_string()));
    }
    let file_error = |what: &'static str, path: &Path| {
        let path = path.display().to_string();
        move |source| PackageError::File { what, path, source }
    };
    let simulation = Simulation::new(scene)?;
    let description = render(&simulation)?;
    let binary = fs::read(library).map_err(file_error("cannot read", library))?;

    // Without time stamps: the same scene and library give the same bytes.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let mut add = |name: &str, content: &[u8]| -> Result<(), PackageError> {
        zip.start_file(name, options)?;
        Ok(zip.write_all(content)?)
    };
    add("modelDescription.xml", description.xml.as_bytes())?;
    let (folder, ending) = PLATFORM;
    add(&format!("binaries/{folder}/{MODEL_IDENTIFIER}.{ending}"), &binary)?;
    add(&format!("resources/{SCENE_FILE}"), scene.source.as_bytes())?;
    add("model.png", include_bytes!("../assets/model.png"))?;
    add("documentation/licenses/licenses.txt", include_bytes!("../assets/licenses.txt"))?;
    add("documentation/index.html", documentation::page(scene).as_bytes())?;
    let bytes = zip.finish()?.into_inner();

    let partial = output.with_extension("fmu.part");
    fs::write(&partial, bytes).map_err(file_error("cannot write", &partial))?;
    fs::rename(&partial, output).map_err(file_error("cannot write", output))
}
