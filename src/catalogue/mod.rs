//! Catalogue bearings: from what a catalogue says (boundary dimensions, load ratings, contact angle) to a scene with estimated
//! internal geometry.
//!
//! Number and diameter of the balls are those that give both load ratings by ISO 281 and ISO 76; the rest is estimated from the
//! dimensions. Every estimate of a scene is marked in its comments, with its source and spread; docs/catalogue.md compares them with
//! what the maker says.
//!
//! ```
//! use roulement::Scene;
//! use roulement::catalogue::Request;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let request = Request { designation: Some("6205 C3".into()), ..Request::default() };
//! let bearing = request.bearing()?;
//! let candidates = bearing.candidates()?;
//! assert_eq!((candidates[0].geometry.balls, candidates[0].geometry.ball_diameter), (9, 7.9375e-3));
//! let scene = Scene::parse(&bearing.scene(1)?)?;
//! assert_eq!(scene.bearing.balls, 9);
//! # Ok(())
//! # }
//! ```

mod cage;
mod clearance;
mod designation;
mod estimate;
mod request;
mod rings;
mod table;
mod text;

use thiserror::Error;

pub use clearance::Clearance;
pub use estimate::{Candidate, STEEL_OF_ISO_76};
pub use request::{Cage, Request};
pub use rings::Ring;
pub use table::{SOURCE, table};

/// A row of the table of common sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Its name in ISO's series: 61805 is also written 6805.
    pub designation: &'static str,
    /// \[mm] bore.
    pub bore: f64,
    /// \[mm] outside diameter.
    pub outside: f64,
    /// \[mm] width.
    pub width: f64,
    /// \[kN] basic dynamic load rating C.
    pub dynamic: f64,
    /// \[kN] basic static load rating C0.
    pub static_: f64,
    /// \[deg] contact angle; 0 of deep-groove bearings.
    pub contact_angle: f64,
}

/// Entry of a catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct Bearing {
    /// Its name; empty where only numbers are given.
    pub designation: String,
    /// Where its load ratings are from.
    pub source: String,
    /// \[m] bore.
    pub bore: f64,
    /// \[m] outside diameter.
    pub outside: f64,
    /// \[m] width.
    pub width: f64,
    /// \[N] basic dynamic load rating C.
    pub dynamic_load_rating: f64,
    /// \[N] basic static load rating C0.
    pub static_load_rating: f64,
    /// \[rad] nominal contact angle; 0 is a deep-groove bearing, whose contact angle is that of its clearance.
    pub contact_angle: f64,
    /// Class of the radial clearance of a deep-groove bearing.
    pub clearance: Clearance,
    /// Are its balls of silicon nitride?
    pub hybrid: bool,
    /// Means by which a scene keeps its balls apart.
    pub cage: Cage,
    /// Parts of its designation that no scene has, with their meaning.
    pub ignored: Vec<String>,
}

impl Bearing {
    /// Is it a deep-groove bearing?
    pub fn is_deep_groove(&self) -> bool {
        self.contact_angle == 0.0
    }

    /// \[m] pitch diameter: midway between bore and outside diameter.
    pub fn pitch_diameter(&self) -> f64 {
        0.5 * (self.bore + self.outside)
    }

    /// \[m] height of its section.
    pub fn section_height(&self) -> f64 {
        0.5 * (self.outside - self.bore)
    }
}

/// Scene of a bearing by its designation, as a text, and the mass of its outer ring \[kg].
///
/// # Errors
/// If there is no such bearing, in words.
pub fn scene_of(designation: &str) -> Result<(String, f64), String> {
    let request = Request { designation: Some(designation.into()), ..Request::default() };
    let bearing = request.bearing().map_err(|why| why.to_string())?;
    let found = bearing.scene(1).and_then(|scene| Ok((scene, bearing.outer_ring_mass()?)));
    found.map_err(|why| why.to_string())
}

/// Why there is no catalogue bearing.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CatalogueError {
    /// Not TOML, an unknown key, or a value of the wrong kind or dimension.
    #[error("{0}")]
    Format(String),
    /// A name that the table lacks.
    #[error(
        "{name} is not in the table, which has {}deep groove 60, 62, 63, 160, 618, 619 (bores of 10 to 200 mm) and 60x to 69x (3 to 9 mm) \
         and angular contact 70, 72, 73 and 719 with A (30 deg), AC (25 deg), B (40 deg), C (15 deg) as a maker has them (`roulement bearing \
         --list`); give bore, outside, width, dynamic_load_rating and static_load_rating instead",
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
        "{name} is {kind}: only single-row deep-groove and angular-contact ball bearings are simulated; a machine can have it by its \
         stiffness ([bearing.stiffness])"
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
