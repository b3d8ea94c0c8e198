//! Packs a scene as an FMU: model description, shared library, scene and documentation in one zip file.

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::fmi2::SCENE_FILE;
use crate::model_description::{MODEL_IDENTIFIER, render};
use crate::scene::{Drive, Scene};
use crate::simulation::{Simulation, SimulationError};
use crate::variables::{Causality, Variables};

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
    add("documentation/index.html", documentation(&simulation).as_bytes())?;
    let bytes = zip.finish()?.into_inner();

    let partial = output.with_extension("fmu.part");
    fs::write(&partial, bytes).map_err(file_error("cannot write", &partial))?;
    fs::rename(&partial, output).map_err(file_error("cannot write", output))
}

/// The page that an importer shows for the package.
fn documentation(simulation: &Simulation) -> String {
    let escape = |text: &str| quick_xml::escape::escape(text).into_owned();
    let scene = simulation.scene();
    let title = if scene.title.is_empty() { "Ball bearing" } else { &scene.title };
    let drive = |drive: Drive| match drive {
        Drive::Pose => "pose and twist are inputs, the bearing's wrench is an output",
        Drive::Wrench => "a rigid body: applied wrench and spin speed are inputs, pose and twist are outputs",
        Drive::Fixed => "rests in its frame",
        Drive::Hinge => {
            "a rigid body on a hinge to its frame: pose, twist and the reaction of the hinge are outputs"
        }
    };
    let mut rows = String::new();
    for row in Variables::new(scene).rows() {
        let causality = if row.causality == Causality::Input { "input" } else { "output" };
        rows += &format!(
            "<tr><td><code>{}</code></td><td>{}</td><td>{causality}</td><td>{}</td></tr>\n",
            escape(&row.name),
            escape(row.unit.name),
            escape(&row.description)
        );
    }
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>body{{font:16px sans-serif;max-width:60em;margin:2em auto}}td,th{{text-align:left;padding:.2em .6em}}\
         </style></head><body>\n<h1>{title}</h1>\n\
         <p>A ball bearing in three dimensions (Bovet, Linares, Zamponi, Mermoz 2013), FMI 2.0 co-simulation.</p>\n\
         <h2>Frames</h2>\n<p>Right-handed, x is the bearing axis; the origin is the bearing centre. Wrenches are what \
         the bearing exerts on a race, in world axes, about the race frame's origin. The pose inputs are those at the \
         start of a step; the motion within it is a cubic without jumps.</p>\n\
         <p>Inner race: {}. Outer race: {}.</p>\n\
         <h2>Effects</h2>\n<p>Creep law {:?}, contact damping {} s/m, {} balls.</p>\n\
         <h2>Interface</h2>\n<table><tr><th>name</th><th>unit</th><th>causality</th><th>meaning</th></tr>\n{rows}\
         </table>\n<h2>Scene</h2>\n<pre>{}</pre>\n</body></html>\n",
        drive(scene.inner.drive),
        drive(scene.outer.drive),
        scene.effects.creep,
        scene.effects.damping.0,
        scene.bearing.balls,
        escape(&scene.source),
        title = escape(title),
    )
}
