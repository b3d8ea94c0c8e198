//! Needle rollers with a cage between a shaft and a housing, or a planet and its pin, by their dimensions: K 50x58x25 runs on 50 mm, in 58 mm, and is 25 mm wide.
//!
//! Length and count of the rollers are estimated from these three.

use std::f64::consts::PI;

use crate::catalogue::designation::words_of;

/// [-] part of the circle of their centres that rollers fill: bars of the cage are about as wide as rollers. Spread 15 %.
const FILL: f64 = 0.55;
/// [-] length that carries over the width of the cage. Spread 10 %.
const LENGTH: f64 = 0.78;
/// \[um] play across the axis, and \[um/mm] how it grows with the shaft: the middle of a shaft h5 in a bore G6 (ISO 286-2), 18 um at 20 mm and 25 um at 50 mm.
const PLAY: [f64; 2] = [13.0, 0.24];
/// \[mm] shafts of the standard's cages, and diameters of their rollers over those of the shaft.
const SHAFTS: std::ops::RangeInclusive<f64> = 3.0..=300.0;
const ROLLERS: std::ops::RangeInclusive<f64> = 0.02..=0.5;

/// Its keys; none where the designation is of something else.
///
/// # Errors
/// What it is, if its dimensions are those of no such cage.
pub(super) fn find(designation: &str) -> Option<Result<String, &'static str>> {
    let upper = designation.to_ascii_uppercase().replace('\u{d7}', "X");
    let mut words = words_of(&upper).into_iter();
    let first = words.next()?;
    let dimensions = match first.strip_prefix('K')? {
        "" => words.next()?,
        together => together,
    };
    let mut numbers = dimensions.split('X').map(|number| number.parse::<f64>().ok());
    let [Some(shaft), Some(outside), Some(width)] = [numbers.next()?, numbers.next()?, numbers.next()?]
    else {
        return None;
    };
    let (diameter, pitch) = (0.5 * (outside - shaft), 0.5 * (outside + shaft));
    if words.any(|word| word.starts_with("ZW")) {
        return Some(Err("a cage with needle rollers in two rows"));
    }
    let fits = numbers.next().is_none()
        && SHAFTS.contains(&shaft)
        && ROLLERS.contains(&(diameter / shaft))
        && (diameter..=20.0 * diameter).contains(&width);
    if !fits {
        return Some(Err("a cage with needle rollers of a size that there is not"));
    }
    let count = (FILL * PI * pitch / diameter).floor();
    Some(Ok(format!(
        "count = {count}\ndiameter = \"{diameter} mm\"\nlength = \"{:.2} mm\"\npitch_diameter = \"{pitch} mm\"\ndiametral_clearance = \"{:.1} um\"\n",
        LENGTH * width,
        PLAY[0] + PLAY[1] * shaft,
    )))
}
