//! Files that a user names, read whole: regular ones alone, and none that is larger than any scene or table. A pipe would be waited
//! for without end, and a device such as `/dev/zero` would fill the memory.

use std::fs::{File, metadata};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

use super::SceneError;

/// \[byte] largest scene, table or description: ten tables of a million rows have no more, and a scene may hold them.
pub const LARGEST_TEXT: u64 = 500_000_000;
/// \[byte] largest library or package.
pub const LARGEST_BINARY: u64 = 1_000_000_000;

/// Opens a file to be read.
///
/// # Errors
/// If it cannot be opened, or is a folder, a pipe or a device.
pub fn open(path: &Path) -> Result<File> {
    // Before it is opened: that alone would wait for the writer of a pipe.
    let kind = metadata(path)?.file_type();
    if !kind.is_file() {
        let is = if kind.is_dir() { "a folder" } else { "a pipe or a device" };
        return Err(Error::new(ErrorKind::InvalidInput, format!("it is {is}, not a regular file")));
    }
    File::open(path)
}

/// Reads a file of at most `limit` bytes.
///
/// # Errors
/// As [`open`], and if the file is larger.
pub fn bytes(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let too_large = || {
        let why = format!("it is larger than {} MB, the limit of such a file", limit / 1_000_000);
        Error::new(ErrorKind::FileTooLarge, why)
    };
    let file = open(path)?;
    if file.metadata()?.len() > limit {
        return Err(too_large());
    }
    let mut bytes = vec![];
    // Sizes of files in /proc are not told before.
    file.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit { Err(too_large()) } else { Ok(bytes) }
}

/// Reads a text.
///
/// # Errors
/// As [`bytes`], with the limit [`LARGEST_TEXT`], and if it is not UTF-8.
pub fn text(path: &Path) -> Result<String> {
    let bytes = bytes(path, LARGEST_TEXT)?;
    String::from_utf8(bytes).map_err(|_| Error::new(ErrorKind::InvalidData, "it is not UTF-8"))
}

/// Reads the text of a scene.
///
/// # Errors
/// As [`text`].
pub fn scene(path: &Path) -> std::result::Result<String, SceneError> {
    text(path).map_err(|source| SceneError::Read { path: path.display().to_string(), source })
}

/// Reads the text of a file that a key of a scene names.
///
/// # Errors
/// As [`text`]; with the key and the path.
pub fn named(path: &Path, key: &str) -> std::result::Result<String, SceneError> {
    text(path).map_err(|why| SceneError::conflict(key, format!("cannot read {}: {why}", path.display())))
}
