//! Double-row angular contact ball bearings by their designations: both rows are single-row bearings back to back on common rings.
//!
//! Load ratings of a row follow from those of both by ISO 281 and ISO 76: `C = 2^0.7 C_row`, `C0 = 2 C0_row`; its balls are then estimated as those of
//! single-row bearings. The table is SKF's as remembered; it was not at hand.

use super::designation::double_row;
use super::{CatalogueError, Request, four_point, self_aligning};
use crate::schema::units::{Angle, Force, Length};

/// Rows of the table, below a line of names.
const ROWS: &str = include_str!("double_row.csv");
/// \[deg] contact angle, and that of the design that FAG calls B.
const ANGLE: f64 = 30.0;
const ANGLE_OF_B: f64 = 25.0;
/// [-] distance of both rows over the width: with it contact lines of 3206 A and 3208 A meet the axis 36 and 47 mm apart, as makers have it. Spread 10 %.
const DISTANCE: f64 = 0.43;

/// Both rows of a bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct DoubleRow {
    /// Scene of a row, as a text.
    pub scene: String,
    /// \[m] distance of the rows.
    pub distance: f64,
    /// \[m] how far the inner ring goes along the axis from where one row touches without load to where the other one does.
    pub axial_play: f64,
    /// \[N] basic dynamic load rating of both.
    pub dynamic_load_rating: f64,
    /// Do their contact lines meet the axis outside of the rows, and not between them?
    pub back_to_back: bool,
}

/// The rows of a designation; none where it is no double-row ball bearing.
///
/// # Errors
/// If its size is not known.
pub fn rows_of(designation: &str) -> Option<Result<DoubleRow, CatalogueError>> {
    let Some((number, is_b)) = double_row(designation) else {
        return self_aligning::rows_of(designation).or_else(|| four_point::rows_of(designation));
    };
    Some(found(designation, &number, if is_b { ANGLE_OF_B } else { ANGLE }))
}

fn found(designation: &str, number: &str, angle: f64) -> Result<DoubleRow, CatalogueError> {
    let unknown = || CatalogueError::Kind {
        name: designation.into(),
        kind: "a double-row angular contact ball bearing of a size that the table lacks",
    };
    let size = Size::of(number, ROWS).ok_or_else(unknown)?;
    Ok(DoubleRow {
        scene: size.row(angle, 0.5 * size.width)?,
        distance: 1e-3 * DISTANCE * size.width,
        axial_play: 0.0,
        dynamic_load_rating: 1e3 * size.dynamic,
        back_to_back: true,
    })
}

/// What a table says of a bearing of two rows: millimetres, kilonewtons.
pub(super) struct Size {
    pub bore: f64,
    outside: f64,
    pub width: f64,
    pub dynamic: f64,
    static_: f64,
}

impl Size {
    /// That of a number in a table; none where it lacks it.
    pub fn of(number: &str, table: &str) -> Option<Self> {
        let line = table.lines().skip(1).find(|line| line.split(',').next() == Some(number))?;
        let numbers: Option<Vec<f64>> = line.split(',').skip(1).map(|cell| cell.parse().ok()).collect();
        let [bore, outside, width, dynamic, static_] = numbers?[..] else { return None };
        Some(Self { bore, outside, width, dynamic, static_ })
    }

    /// Scene of a row of this contact angle \[deg] that has so much \[mm] of the width.
    pub fn row(&self, angle: f64, width: f64) -> Result<String, CatalogueError> {
        let row = Request {
            bore: Some(Length(1e-3 * self.bore)),
            outside: Some(Length(1e-3 * self.outside)),
            width: Some(Length(1e-3 * width)),
            dynamic_load_rating: Some(Force(1e3 * self.dynamic / 2f64.powf(0.7))),
            static_load_rating: Some(Force(0.5e3 * self.static_)),
            contact_angle: Some(Angle(angle.to_radians())),
            ..Request::default()
        };
        row.bearing()?.scene(1)
    }
}
