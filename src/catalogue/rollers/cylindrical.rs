//! Cylindrical roller bearings by their designations: N, NU, NJ and NUP of the series 10, 2, 22, 3 and 23.
//!
//! Diameters over and under the rollers, E and F, are those of the reinforced design (DIN 5412-1), which makers share as rings are exchanged. With them the diameter of
//! a roller and the circle of their centres are known. Length and count are estimated from the width and the circle; `tests/catalogue.rs` compares the ratings that
//! follow with makers'.

use std::f64::consts::PI;

use crate::catalogue::Clearance;
use crate::catalogue::designation::rollers;
use crate::catalogue::table::table;

/// [-] part of the circle of their centres that rollers fill at most, with a cage.
const FILL: f64 = 0.84;
/// \[mm] play between ribs over the bore: an estimate; spread a factor of 2.
const AXIAL_PLAY: f64 = 0.001;
/// First code of the bore, in steps of 5 mm.
const FIRST: usize = 4;

/// \[mm] diameters under and over the rollers, F and E, of the series 2 and 22.
#[rustfmt::skip]
const LIGHT: [[f64; 2]; 17] = [
    [26.5, 41.5], [31.5, 46.5], [37.5, 55.5], [44.0, 64.0], [49.5, 71.5], [54.5, 76.5], [59.5, 81.5], [66.0, 90.0], [72.0, 100.0],
    [78.5, 108.5], [83.5, 113.5], [88.5, 118.5], [95.3, 127.3], [100.5, 136.5], [107.0, 145.0], [112.5, 154.5], [119.0, 163.0],
];
/// \[mm] those of the series 3 and 23.
#[rustfmt::skip]
const HEAVY: [[f64; 2]; 17] = [
    [27.5, 45.5], [34.0, 54.0], [40.5, 62.5], [46.2, 70.2], [52.0, 80.0], [58.5, 88.5], [65.0, 97.0], [70.5, 106.5], [77.0, 115.0],
    [82.5, 124.5], [89.0, 133.0], [95.0, 143.0], [101.0, 151.0], [108.0, 160.0], [113.5, 169.5], [121.5, 177.5], [127.5, 191.5],
];
/// \[mm] those of the series 10; the first is that of 05.
#[rustfmt::skip]
const THIN: [[f64; 2]; 16] = [
    [30.5, 41.5], [36.5, 48.5], [42.0, 55.0], [47.0, 61.0], [52.5, 67.5], [57.5, 72.5], [64.5, 80.5], [69.5, 85.5], [74.5, 90.5],
    [80.0, 100.0], [85.0, 105.0], [91.5, 113.5], [96.5, 118.5], [103.0, 127.0], [108.0, 132.0], [113.0, 137.0],
];
/// \[mm] widths of the series 22 and 23, dimension series of ISO 15.
const WIDE: [[f64; 2]; 17] = [
    [18.0, 21.0],
    [18.0, 24.0],
    [20.0, 27.0],
    [23.0, 31.0],
    [23.0, 33.0],
    [23.0, 36.0],
    [23.0, 40.0],
    [25.0, 43.0],
    [28.0, 46.0],
    [31.0, 48.0],
    [31.0, 51.0],
    [31.0, 55.0],
    [33.0, 58.0],
    [36.0, 60.0],
    [40.0, 64.0],
    [43.0, 67.0],
    [46.0, 73.0],
];
/// Bores up to and including \[mm], and least and largest radial clearance \[um] of C2, CN, C3, C4, C5 of cylindrical roller bearings (ISO 5753-1).
#[rustfmt::skip]
const CLEARANCES: [(f64, [[f64; 2]; 5]); 7] = [
    (24.0, [[0.0, 25.0], [20.0, 45.0], [35.0, 60.0], [50.0, 75.0], [65.0, 90.0]]),
    (30.0, [[0.0, 25.0], [20.0, 45.0], [35.0, 60.0], [50.0, 75.0], [70.0, 95.0]]),
    (40.0, [[5.0, 30.0], [25.0, 50.0], [45.0, 70.0], [60.0, 85.0], [80.0, 105.0]]),
    (50.0, [[5.0, 35.0], [30.0, 60.0], [50.0, 80.0], [70.0, 100.0], [95.0, 125.0]]),
    (65.0, [[10.0, 40.0], [40.0, 70.0], [60.0, 90.0], [80.0, 110.0], [110.0, 140.0]]),
    (80.0, [[10.0, 45.0], [40.0, 75.0], [65.0, 100.0], [90.0, 125.0], [130.0, 165.0]]),
    (100.0, [[15.0, 50.0], [50.0, 85.0], [75.0, 110.0], [105.0, 140.0], [155.0, 190.0]]),
];

/// Its keys; none where the designation is of something else.
///
/// # Errors
/// What it is, if its size is not known.
pub(super) fn find(designation: &str) -> Option<Result<String, &'static str>> {
    let (kind, number, class) = rollers(designation)?;
    Some(keys(&kind, &number, class).ok_or("a cylindrical roller bearing of a size that is not known"))
}

fn keys(kind: &str, number: &str, class: Clearance) -> Option<String> {
    let (series, code) = number.split_at_checked(number.len().checked_sub(2)?)?;
    let code: usize = code.parse().ok()?;
    let place = code.checked_sub(FIRST)?;
    // Width of the ball bearing of the same dimension series.
    let width = |series: &str| {
        table().find(|row| row.designation == format!("{series}{code:02}")).map(|row| row.width)
    };
    let (diameters, width, part) = match series {
        "2" => (LIGHT.get(place)?, width("62")?, 0.545),
        "3" => (HEAVY.get(place)?, width("63")?, 0.55),
        "10" => (THIN.get(place.checked_sub(1)?)?, width("60")?, 0.48),
        "22" => (LIGHT.get(place)?, WIDE[place][0], 0.57),
        "23" => (HEAVY.get(place)?, WIDE[place][1], 0.61),
        _ => return None,
    };
    let [under, over] = *diameters;
    let (diameter, pitch) = (0.5 * (over - under), 0.5 * (over + under));
    let count = (FILL * PI * pitch / diameter).floor();
    let bore = 5.0 * code as f64;
    let (_, limits) = CLEARANCES.iter().find(|(largest, _)| bore <= *largest)?;
    let [least, largest] = limits[class as usize];
    let ribs = match kind {
        "NUP" => format!("axial_way = \"both\"\naxial_clearance = \"{} mm\"\n", AXIAL_PLAY * bore),
        "NJ" => "axial_way = \"+x\"\n".into(),
        _ => String::new(),
    };
    Some(format!(
        "count = {count}\ndiameter = \"{diameter} mm\"\nlength = \"{:.2} mm\"\npitch_diameter = \"{pitch} mm\"\ndiametral_clearance = \"{} um\"\n{ribs}",
        part * width,
        0.5 * (least + largest)
    ))
}
