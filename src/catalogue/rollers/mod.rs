//! Roller bearings by their designations: keys of `[bearing.rollers]`.

mod cylindrical;
mod needles;
mod tapered;

use super::CatalogueError;

/// Keys of `[bearing.rollers]` of a designation, as a text; none where it is no cylindrical or tapered roller bearing of one row, and no cage with needle rollers.
///
/// # Errors
/// If its size is not known.
pub fn rollers_of(designation: &str) -> Option<Result<String, CatalogueError>> {
    let found =
        [cylindrical::find, tapered::find, needles::find].into_iter().find_map(|find| find(designation))?;
    Some(found.map_err(|kind| CatalogueError::Kind { name: designation.into(), kind }))
}
