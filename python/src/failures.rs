//! Errors of the program as exceptions of Python, with the same texts.

use std::fmt::Display;

use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use roulement::SceneError;

/// A value that is not allowed.
pub fn value(why: impl Display) -> PyErr {
    PyValueError::new_err(why.to_string())
}

/// Something that could not be done.
pub fn runtime(why: impl Display) -> PyErr {
    PyRuntimeError::new_err(why.to_string())
}

/// A file that could not be read or written.
pub fn file(why: impl Display) -> PyErr {
    PyOSError::new_err(why.to_string())
}

/// A scene that is refused.
pub fn scene(why: SceneError) -> PyErr {
    match &why {
        SceneError::Read { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            PyFileNotFoundError::new_err(why.to_string())
        }
        SceneError::Read { .. } => file(why),
        _ => value(why),
    }
}
