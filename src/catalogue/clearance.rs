//! Classes of the radial internal clearance of deep-groove ball bearings (ISO 5753-1).

use super::error::CatalogueError;

/// Class of the radial internal clearance before mounting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clearance {
    /// Smaller than normal.
    C2,
    /// Normal.
    #[default]
    CN,
    /// Larger than normal.
    C3,
    /// Larger than C3.
    C4,
    /// Larger than C4.
    C5,
}

const CLASSES: [(Clearance, &str); 5] = [
    (Clearance::C2, "C2"),
    (Clearance::CN, "CN"),
    (Clearance::C3, "C3"),
    (Clearance::C4, "C4"),
    (Clearance::C5, "C5"),
];

/// Bores up to and including \[mm], and least and largest clearance \[um] of C2, CN, C3, C4, C5. The first row is that of bores above 2.5 mm.
#[rustfmt::skip]
const LIMITS: [(f64, [[f64; 2]; 5]); 15] = [
    (10.0, [[0.0, 7.0], [2.0, 13.0], [8.0, 23.0], [14.0, 29.0], [20.0, 37.0]]),
    (18.0, [[0.0, 9.0], [3.0, 18.0], [11.0, 25.0], [18.0, 33.0], [25.0, 45.0]]),
    (24.0, [[0.0, 10.0], [5.0, 20.0], [13.0, 28.0], [20.0, 36.0], [28.0, 48.0]]),
    (30.0, [[1.0, 11.0], [5.0, 20.0], [13.0, 28.0], [23.0, 41.0], [30.0, 53.0]]),
    (40.0, [[1.0, 11.0], [6.0, 20.0], [15.0, 33.0], [28.0, 46.0], [40.0, 64.0]]),
    (50.0, [[1.0, 11.0], [6.0, 23.0], [18.0, 36.0], [30.0, 51.0], [45.0, 73.0]]),
    (65.0, [[1.0, 15.0], [8.0, 28.0], [23.0, 43.0], [38.0, 61.0], [55.0, 90.0]]),
    (80.0, [[1.0, 15.0], [10.0, 30.0], [25.0, 51.0], [46.0, 71.0], [65.0, 105.0]]),
    (100.0, [[1.0, 18.0], [12.0, 36.0], [30.0, 58.0], [53.0, 84.0], [75.0, 120.0]]),
    (120.0, [[2.0, 20.0], [15.0, 41.0], [36.0, 66.0], [61.0, 97.0], [90.0, 140.0]]),
    (140.0, [[2.0, 23.0], [18.0, 48.0], [41.0, 81.0], [71.0, 114.0], [105.0, 160.0]]),
    (160.0, [[2.0, 23.0], [18.0, 53.0], [46.0, 91.0], [81.0, 130.0], [120.0, 180.0]]),
    (180.0, [[2.0, 25.0], [20.0, 61.0], [53.0, 102.0], [91.0, 147.0], [135.0, 200.0]]),
    (200.0, [[2.0, 30.0], [25.0, 71.0], [63.0, 117.0], [107.0, 163.0], [150.0, 230.0]]),
    (225.0, [[2.0, 35.0], [25.0, 85.0], [75.0, 140.0], [125.0, 195.0], [175.0, 265.0]]),
];

/// \[mm] bores that the table is of are larger.
const SMALLEST: f64 = 2.5;

impl Clearance {
    /// Reads a class by its name.
    ///
    /// # Errors
    /// Names the classes there are.
    pub fn parse(name: &str) -> Result<Self, CatalogueError> {
        let found = CLASSES.iter().find(|(_, of)| of.eq_ignore_ascii_case(name.trim()));
        found.map(|(class, _)| *class).ok_or_else(|| CatalogueError::Range {
            key: "clearance",
            value: format!("\"{name}\""),
            range: "C2, CN, C3, C4, C5".into(),
        })
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        CLASSES.iter().find(|(class, _)| *class == self).map_or("", |(_, name)| name)
    }

    /// \[m] least and largest clearance of a bearing with a bore \[m].
    ///
    /// # Errors
    /// Bores that the standard's table is not of here.
    pub fn limits(self, bore: f64) -> Result<[f64; 2], CatalogueError> {
        let millimetres = 1e3 * bore;
        // A last digit beyond is not beyond.
        let row = LIMITS.iter().find(|(largest, _)| millimetres <= largest * (1.0 + 1e-12));
        match row {
            Some((_, limits)) if millimetres > SMALLEST => Ok(limits[self as usize].map(|um| um * 1e-6)),
            _ => Err(CatalogueError::Range {
                key: "bore",
                value: format!("{millimetres} mm"),
                range: format!(
                    "({SMALLEST}, {}] mm, where clearance classes are known",
                    LIMITS[LIMITS.len() - 1].0
                ),
            }),
        }
    }
}
