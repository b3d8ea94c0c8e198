//! Where cargo leaves the library that it builds together with a program.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use memchr::memmem;
use roulement::fmi::BUILD;
use roulement::schema::regular::{self, LARGEST_BINARY};

use super::library::Candidates;
use super::{PackageError, file_error};

/// Path of the shared library that was built together with this executable.
///
/// # Errors
/// As of [`library_beside`].
pub fn library_beside_executable() -> Result<PathBuf, PackageError> {
    library_beside(&env::current_exe()?)
}

/// The library that was built together with a program, and those of other platforms that lie beside the program, as in the wheels: packages of all
/// of them need no compiler.
///
/// # Errors
/// As of [`library_beside`], and if the program's folder cannot be read.
pub fn libraries_beside(program: &Path) -> Result<Vec<PathBuf>, PackageError> {
    let own = library_beside(program)?;
    let folder = program.parent().unwrap_or(Path::new(""));
    let names = fs::read_dir(folder).map_err(file_error("cannot read", folder))?;
    let mut others: Vec<PathBuf> = names.filter_map(|entry| Some(entry.ok()?.path())).collect();
    // What cargo leaves beside a program is the own one.
    others.retain(|path| path.file_name() != own.file_name() && Candidates::of(path).is_some());
    others.sort();
    Ok([vec![own], others].concat())
}

/// Path of the shared library beside a program that was built together with the code that runs. Cargo has it in `deps`, and beside the
/// program only where the library was asked for; one that is left there from an earlier build is passed over.
///
/// # Errors
/// If it is not there, or cannot be read.
pub fn library_beside(program: &Path) -> Result<PathBuf, PackageError> {
    let name = format!("{}roulement{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    let beside = program.with_file_name(&name);
    let there = [program.with_file_name("deps").join(&name), beside.clone()];
    let there: Vec<&PathBuf> = there.iter().filter(|path| path.is_file()).collect();
    for &path in &there {
        let library = regular::bytes(path, LARGEST_BINARY).map_err(file_error("cannot read", path))?;
        if memmem::find(&library, BUILD.as_bytes()).is_some() {
            return Ok(path.clone());
        }
    }
    Err(match there.first() {
        Some(other) => PackageError::OtherBuild(other.display().to_string()),
        None => PackageError::NoLibrary(beside.display().to_string()),
    })
}
