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
mod digits;
mod double_row;
mod error;
mod estimate;
mod four_point;
mod request;
mod rings;
mod rollers;
mod self_aligning;
mod shelf;
mod table;
mod text;

use std::path::Path;

pub use clearance::Clearance;
pub use digits::two_digits;
pub use double_row::{DoubleRow, rows_of};
pub use error::CatalogueError;
pub use estimate::{Candidate, STEEL_OF_ISO_76};
pub use request::{Cage, Request};
pub use rings::Ring;
pub use rollers::rollers_of;
pub use shelf::{FILE, Shelf};
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
    /// \[deg] contact angle; 0 of deep-groove bearings, 90 of thrust bearings.
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
    /// \[rad] nominal contact angle; 0 is a deep-groove bearing, whose contact angle is that of its clearance, a right angle a thrust bearing.
    pub contact_angle: f64,
    /// Class of the radial clearance of a deep-groove bearing.
    pub clearance: Clearance,
    /// Are its balls of silicon nitride?
    pub hybrid: bool,
    /// Means by which a scene keeps its balls apart.
    pub cage: Cage,
    /// Parts of its designation that no scene has, with their meaning.
    pub ignored: Vec<String>,
    /// Balls and grooves that its maker tells; they are estimated without.
    pub inside: Option<Candidate>,
    /// \[m] diametral clearance in place of its class.
    pub own_clearance: Option<f64>,
}

impl Bearing {
    /// Is it a deep-groove bearing?
    pub fn is_deep_groove(&self) -> bool {
        self.contact_angle == 0.0
    }

    /// Is it a thrust bearing, two washers with a groove each?
    pub fn is_thrust(&self) -> bool {
        self.contact_angle == std::f64::consts::FRAC_PI_2
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

/// Scene of a bearing by its designation, as a text, and the mass of its outer ring \[kg]; one of the shelf beside a scene comes before the table.
///
/// # Errors
/// If there is no such bearing, or the shelf is refused, in words.
pub fn scene_of(designation: &str, beside: Option<&Path>) -> Result<(String, f64), String> {
    let shelf = beside.map(Shelf::beside).transpose().map_err(|why| why.to_string())?.unwrap_or_default();
    let request = Request { designation: Some(designation.into()), ..Request::default() };
    let bearing = request.of_shelf(&shelf).map_err(|why| why.to_string())?;
    let found = bearing.scene(1).and_then(|scene| Ok((scene, bearing.outer_ring_mass()?)));
    found.map_err(|why| why.to_string())
}
