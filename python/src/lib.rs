//! Functions in Rust that the Python package `roulement` calls. Its users see the Python files beside it, which give arrays and names.

#![allow(missing_docs)]
// Arguments of Python come by value.
#![allow(clippy::needless_pass_by_value)]

mod arrays;
mod catalogues;
mod contacts;
mod failures;
mod modes;
mod runs;
mod scenes;
mod simulations;
mod sweeps;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::catalogues::{catalogue_candidates, catalogue_names, catalogue_scene};
    #[pymodule_export]
    use crate::contacts::{contact, laws};
    #[pymodule_export]
    use crate::modes::modes;
    #[pymodule_export]
    use crate::runs::{run, write_parquet};
    #[pymodule_export]
    use crate::scenes::{Scene, check, cost, library_beside, package};
    #[pymodule_export]
    use crate::simulations::{Simulation, State};
    #[pymodule_export]
    use crate::sweeps::{Sweep, base_scene, case_row, version};
}
