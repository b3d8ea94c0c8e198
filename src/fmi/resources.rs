//! Where a package's resources are.

use std::path::PathBuf;

use percent_encoding::percent_decode_str;

use super::outcome::{Outcome, Status, error};

/// Name of the scene inside a package's resources folder.
pub const SCENE_FILE: &str = "scene.toml";

/// Path of a resource location: a `file:` URI, or a plain path as some importers pass.
pub fn path(location: &str) -> Outcome<PathBuf> {
    let rest = match location.strip_prefix("file:") {
        None if location.contains("://") => {
            return error(format!("the resource location \"{location}\" is not a file: URI"));
        }
        None => return Ok(PathBuf::from(location)),
        Some(rest) => rest,
    };
    // file:/path, file:///path and file://localhost/path
    let path = match rest.strip_prefix("//") {
        Some(authority) => authority.find('/').map_or("", |slash| &authority[slash..]),
        None => rest,
    };
    let path = percent_decode_str(path)
        .decode_utf8()
        .map_err(|_| (Status::Error, format!("the resource location \"{location}\" is not UTF-8")))?;
    // file:///C:/path is C:/path on Windows
    let drive = path.len() > 2 && path.as_bytes()[2] == b':' && path.starts_with('/');
    Ok(PathBuf::from(if drive { &path[1..] } else { &path }))
}
