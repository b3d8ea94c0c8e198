//! Tapered roller bearings by their designations: series 302, 303, 313, 320, 322, 323 and 330.
//!
//! Bore and outside diameter are those of the ball bearing of the same diameter series, width and contact angle those of ISO 355, from memory.
//! Diameter, length and number of the rollers are estimated from the section, in two shares per series. These were fitted to C and C0 of one maker for bores up to
//! 35 mm, and give both within 10 % (`published_ratings_of_tapered_roller_bearings` in `tests/catalogue.rs`).

use std::f64::consts::PI;

use crate::catalogue::designation::tapered;
use crate::catalogue::table::table;

/// [-] part of the circle of their centres that rollers fill at most, with a cage.
const FILL: f64 = 0.9;
/// Rounds in which the angle of a roller and that of its middle agree.
const ROUNDS: usize = 20;

/// A series.
struct Series {
    number: &'static str,
    /// Series of ball bearings that have its diameters.
    diameters: &'static str,
    /// First code of the bore, in steps of 5 mm; 3 is 17 mm.
    first: usize,
    /// [-] mean diameter of the rollers over half of the section's height, and their length along the axis over the width.
    shares: [f64; 2],
    /// \[mm, deg] width T, and angle between the axis and the outer race.
    sizes: &'static [[f64; 2]],
}

/// \[deg] contact angles of the series 302 and 322 (ISO 355: 12 deg 57' 10", 14 deg 2' 10", 15 deg 6' 34", 15 deg 38' 32", 16 deg 10' 20").
const A: f64 = 12.953;
const B: f64 = 14.036;
const C: f64 = 15.109;
const D: f64 = 15.642;
const E: f64 = 16.172;
/// \[deg] those of the series 303 and 323 (10 deg 45' 29", 11 deg 18' 36", 11 deg 51' 35"; larger ones have A), and of 313 (28 deg 48' 39").
const F: f64 = 10.758;
const G: f64 = 11.310;
const H: f64 = 11.860;
const STEEP: f64 = 28.811;

#[rustfmt::skip]
const SERIES: [Series; 7] = [
    Series { number: "302", diameters: "62", first: 3, shares: [0.475, 0.58], sizes: &[
        [13.25, A], [15.25, A], [16.25, B], [17.25, B], [18.25, B], [19.75, B], [20.75, C], [21.75, D], [22.75, C], [23.75, C],
        [24.75, C], [26.25, D], [27.25, E], [28.25, D], [30.5, D], [32.5, D], [34.5, D], [37.0, D],
    ] },
    Series { number: "322", diameters: "62", first: 6, shares: [0.48, 0.635], sizes: &[
        [21.25, B], [24.25, B], [24.75, B], [24.75, C], [24.75, D], [26.75, C], [29.75, C], [32.75, C], [33.25, D], [33.25, E],
        [35.25, D], [38.5, D], [42.5, D], [45.5, D], [49.0, D],
    ] },
    Series { number: "303", diameters: "63", first: 3, shares: [0.495, 0.63], sizes: &[
        [15.25, F], [16.25, G], [18.25, G], [20.75, H], [22.75, H], [25.25, A], [27.25, A], [29.25, A], [31.5, A], [33.5, A],
        [36.0, A], [38.0, A], [40.0, A], [42.5, A], [44.5, A], [46.5, A], [49.5, A], [51.5, A],
    ] },
    Series { number: "323", diameters: "63", first: 4, shares: [0.49, 0.63], sizes: &[
        [22.25, G], [25.25, G], [28.75, H], [32.75, H], [35.25, A], [38.25, A], [42.25, A], [45.5, A], [48.5, A], [51.0, A],
        [54.0, A], [58.0, A], [61.5, A], [63.5, A], [67.5, A], [71.5, A], [77.5, A],
    ] },
    Series { number: "313", diameters: "63", first: 5, shares: [0.44, 0.515], sizes: &[
        [18.25, STEEP], [20.75, STEEP], [22.75, STEEP], [25.25, STEEP], [27.25, STEEP], [29.25, STEEP], [31.5, STEEP], [33.5, STEEP],
        [36.0, STEEP], [38.0, STEEP], [40.0, STEEP],
    ] },
    Series { number: "320", diameters: "60", first: 4, shares: [0.47, 0.61], sizes: &[
        [15.0, 14.0], [15.0, 16.0], [17.0, 16.0], [18.0, 16.833], [19.0, 14.167], [20.0, 14.667], [20.0, 15.75], [23.0, 15.167],
        [23.0, 16.0], [23.0, 17.0], [25.0, 16.167], [25.0, 17.0], [29.0, 15.75], [29.0, 16.417], [32.0, 15.75], [32.0, 16.417],
        [32.0, 17.0],
    ] },
    Series { number: "330", diameters: "60", first: 5, shares: [0.375, 0.61], sizes: &[
        [17.0, 10.917], [20.0, 11.0], [21.0, 11.5], [22.0, 10.667], [24.0, 11.083], [24.0, 11.917], [27.0, 11.75], [27.0, 12.333],
        [27.0, 13.083], [31.0, 10.75], [31.0, 11.25], [36.0, 10.5], [36.0, 11.0], [39.0, 10.167], [39.0, 10.5], [39.0, 10.75],
    ] },
];

/// Its keys; none where the designation is of something else.
///
/// # Errors
/// What it is, if its size is not known.
pub(super) fn find(designation: &str) -> Option<Result<String, &'static str>> {
    let number = tapered(designation)?;
    Some(
        number.and_then(|number| keys(&number)).ok_or("a tapered roller bearing of a size that is not known"),
    )
}

fn keys(number: &str) -> Option<String> {
    let (series, code) = number.split_at_checked(3)?;
    let series = SERIES.iter().find(|of| of.number == series)?;
    let place = code.parse::<usize>().ok()?.checked_sub(series.first)?;
    let [width, contact_angle] = *series.sizes.get(place)?;
    let of_balls = table().find(|row| row.designation == format!("{}{code}", series.diameters))?;
    let (bore, outside) = (of_balls.bore, of_balls.outside);
    let [of_height, of_width] = series.shares;
    let (diameter, pitch) = (of_height * 0.5 * (outside - bore), 0.5 * (outside + bore));
    let angle = contact_angle.to_radians();
    // Cones of races and rollers have one apex on the axis.
    let half = (0..ROUNDS).fold(0.0, |half: f64, _| (diameter * (angle - half).sin() / pitch).atan());
    Some(format!(
        "count = {}\ndiameter = \"{diameter:.3} mm\"\nlength = \"{:.2} mm\"\npitch_diameter = \"{pitch} mm\"\ncontact_angle = \"{contact_angle} deg\"\n\
         roller_angle = \"{:.3} deg\"\n",
        (FILL * PI * pitch / diameter).floor(),
        of_width * width / angle.cos(),
        2.0 * half.to_degrees(),
    ))
}
