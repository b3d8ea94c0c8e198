//! Four-point contact ball bearings by their designations: two sets of balls at one place, one for each direction of thrust.
//!
//! Both races are two arcs. A ball that is pressed along the axis touches one arc of each, across from each other; with a radial load it touches all four. Where both
//! races are alike, in their conformity and in how far the centres of their arcs are apart, and no force acts on a ball but that of the rings, the places at
//! which it is in balance between either pair of arcs are one and the same, so that two sets of balls, a pair of arcs each, load the rings as the balls do
//! (`tests/shaft/four_point.rs`). So both grooves have here the conformity of the inner one.
//!
//! Makers rate these bearings as two rows: `C = 2^0.7 C_row`, `C0 = 2 C0_row` at 35 degrees. With a thrust alone ISO's factors of two rows and of one then give the same life,
//! `C/1.07 = C_row/0.66`. The table is SKF's, the axial clearance that of DIN 628, both as remembered; they were not at hand.

use super::CatalogueError;
use super::clearance::Clearance;
use super::designation::four_point;
use super::double_row::{DoubleRow, Size};

/// Rows of the table, below a line of names.
const ROWS: &str = include_str!("four_point.csv");
/// \[deg] contact angle.
const ANGLE: f64 = 35.0;
/// Bores up to and including \[mm], and least and largest axial clearance \[um] of C2, CN, C3, C4.
#[rustfmt::skip]
const LIMITS: [(f64, [[f64; 2]; 4]); 5] = [
    (18.0, [[15.0, 65.0], [50.0, 95.0], [85.0, 130.0], [120.0, 165.0]]),
    (40.0, [[25.0, 75.0], [65.0, 110.0], [100.0, 150.0], [135.0, 185.0]]),
    (60.0, [[35.0, 85.0], [75.0, 125.0], [110.0, 165.0], [150.0, 200.0]]),
    (80.0, [[45.0, 100.0], [85.0, 140.0], [125.0, 175.0], [165.0, 215.0]]),
    (100.0, [[55.0, 110.0], [95.0, 150.0], [135.0, 190.0], [180.0, 235.0]]),
];

/// Both sets of a designation; none where it is no four-point contact ball bearing.
///
/// # Errors
/// If its size or the class of its clearance is not known.
pub fn rows_of(designation: &str) -> Option<Result<DoubleRow, CatalogueError>> {
    let (number, class) = four_point(designation)?;
    Some(found(designation, &number, class))
}

fn found(designation: &str, number: &str, class: Clearance) -> Result<DoubleRow, CatalogueError> {
    let kind = "a four-point contact ball bearing of a size that the table lacks";
    let size =
        Size::of(number, ROWS).ok_or_else(|| CatalogueError::Kind { name: designation.into(), kind })?;
    let limits = LIMITS.iter().find(|(bore, _)| size.bore <= *bore);
    let [least, most] =
        limits.and_then(|(_, classes)| classes.get(class as usize)).ok_or_else(|| CatalogueError::Range {
            key: "clearance",
            value: format!("\"{}\"", class.name()),
            range: "C2, CN, C3, C4".into(),
        })?;
    Ok(DoubleRow {
        scene: alike(&size.row(ANGLE, size.width)?),
        distance: 0.0,
        axial_play: 0.5e-6 * (least + most),
        dynamic_load_rating: 1e3 * size.dynamic,
        back_to_back: true,
    })
}

/// A scene whose outer groove is as narrow as the inner one.
fn alike(scene: &str) -> String {
    let inner = scene.lines().find_map(|line| line.strip_prefix("inner_conformity = ")).unwrap_or_default();
    let outer = format!("outer_conformity = {inner}");
    let lines = scene.lines().map(|line| if line.starts_with("outer_conformity = ") { &outer } else { line });
    lines.map(|line| format!("{line}\n")).collect()
}
