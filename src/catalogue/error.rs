//! Refusals of catalogue bearings.

use thiserror::Error;

/// Why there is no catalogue bearing.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CatalogueError {
    /// Not TOML, an unknown key, or a value of the wrong kind or dimension.
    #[error("{0}")]
    Format(String),
    /// A name that the table lacks.
    #[error(
        "{name} is not in the table, which has {}deep groove 60, 62, 63, 160, 618, 619 (bores of 10 to 200 mm) and 60x to 69x (3 to 9 mm) \
         and angular contact 70, 72, 73 and 719 with A (30 deg), AC (25 deg), B (40 deg), C (15 deg) and thrust 511 to 514 as a maker has them \
         (`roulement bearing --list`); give bore, outside, width, dynamic_load_rating and static_load_rating instead",
        if near.is_empty() { String::new() } else { format!("{near}; ") }
    )]
    Unknown {
        /// As it was given.
        name: String,
        /// Names of the table with the same number.
        near: String,
    },
    /// A name of a bearing that is not of balls in one row and one arc.
    #[error(
        "{name} is {kind}: only single-row deep-groove, angular-contact and single-direction thrust ball bearings are simulated ball by ball; a machine can have double-row \
         angular contact ones of 32 and 33, self-aligning ones of 12, 13, 22 and 23, four-point ones of QJ 2 and QJ 3, N, NU, NJ and NUP of the series 10, 2, 22, 3 and 23, tapered ones of 302, 303, 313, 320, 322, 323 and 330, and K with its three dimensions as catalogue \
         of a [[bearing]], rollers of other sizes by [bearing.rollers], and any by its stiffness ([bearing.stiffness])"
    )]
    Kind {
        /// As it was given.
        name: String,
        /// Kind of bearing, with its article.
        kind: &'static str,
    },
    /// Something that is needed is not given.
    #[error(
        "{0} is missing: give a name of the table, such as 6205, or bore, outside, width, dynamic_load_rating and static_load_rating"
    )]
    Missing(&'static str),
    /// A value outside its range.
    #[error("{key} = {value} is out of range: allowed is {range}")]
    Range {
        /// Given value.
        key: &'static str,
        /// Its value, with its unit.
        value: String,
        /// Allowed values.
        range: String,
    },
    /// Things that do not go together.
    #[error("{0}")]
    Conflict(String),
    /// No balls come near both load ratings.
    #[error(
        "no balls that fit into {dimensions} give C = {dynamic} N and C0 = {static_} N within {percent} %: the nearest are {nearest}"
    )]
    NoBalls {
        /// Boundary dimensions in words.
        dimensions: String,
        /// \[N] C as given.
        dynamic: f64,
        /// \[N] C0 as given.
        static_: f64,
        /// \[%] largest error that is taken.
        percent: f64,
        /// The best there are, in words.
        nearest: String,
    },
}
