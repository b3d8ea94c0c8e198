//! Fits by the words of drawings: tolerances of shafts and holes (ISO 286-1), and of the rings of radial bearings (ISO 492). The tables are
//! recalled, without the standards at hand; fits that makers print for one bearing agree (tests).

use serde::Deserialize;

/// Where between the ends of all tolerances a fit is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Within {
    /// The mean of both ends.
    #[default]
    Mean,
    /// The least interference, or the greatest gap.
    Least,
    /// The greatest interference, or the least gap.
    Greatest,
}

/// Class of the dimensions of a bearing's rings (ISO 492).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RingClass {
    /// The normal one, PN.
    #[default]
    Normal,
    /// Class 6.
    P6,
    /// Class 5.
    P5,
}

/// \[mm] upper ends of the ranges of sizes of ISO 286-1.
const SIZES: [f64; 13] = [3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0];
/// \[um] standard tolerances of the grades 3 to 8.
#[rustfmt::skip]
const GRADES: [[f32; 13]; 6] = [
    [ 2.0,  2.5,  2.5,  3.0,  4.0,  4.0,  5.0,  6.0,  8.0, 10.0, 12.0, 13.0, 15.0],
    [ 3.0,  4.0,  4.0,  5.0,  6.0,  7.0,  8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0],
    [ 4.0,  5.0,  6.0,  8.0,  9.0, 11.0, 13.0, 15.0, 18.0, 20.0, 23.0, 25.0, 27.0],
    [ 6.0,  8.0,  9.0, 11.0, 13.0, 16.0, 19.0, 22.0, 25.0, 29.0, 32.0, 36.0, 40.0],
    [10.0, 12.0, 15.0, 18.0, 21.0, 25.0, 30.0, 35.0, 40.0, 46.0, 52.0, 57.0, 63.0],
    [14.0, 18.0, 22.0, 27.0, 33.0, 39.0, 46.0, 54.0, 63.0, 72.0, 81.0, 89.0, 97.0],
];
/// \[um] fundamental deviations of shafts away from the size: upper ones of f and g (below it), lower ones of k (grades 4 to 7), m, n and p (above it).
#[rustfmt::skip]
const DEVIATIONS: [(&str, [u8; 13]); 6] = [
    ("f", [6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68]),
    ("g", [2,  4,  5,  6,  7,  9, 10, 12, 14, 15, 17, 18, 20]),
    ("k", [0,  1,  1,  1,  2,  2,  2,  3,  3,  4,  4,  4,  5]),
    ("m", [2,  4,  6,  7,  8,  9, 11, 13, 15, 17, 20, 21, 23]),
    ("n", [4,  8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40]),
    ("p", [6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68]),
];
/// \[um] lower deviations of shafts j5 and j6, and j7, below the size; upper ones of holes J6, J7 and J8.
#[rustfmt::skip]
const ABOUT: [(&str, [u8; 13]); 6] = [
    ("j5", [2, 2, 2,  3,  4,  5,  7,  9, 11, 13, 16, 18, 20]),
    ("j6", [2, 2, 2,  3,  4,  5,  7,  9, 11, 13, 16, 18, 20]),
    ("j7", [4, 4, 5,  6,  8, 10, 12, 15, 18, 21, 26, 28, 32]),
    ("J6", [2, 5, 5,  6,  8, 10, 13, 16, 18, 22, 25, 29, 33]),
    ("J7", [4, 6, 8, 10, 12, 14, 18, 22, 26, 30, 36, 39, 43]),
    ("J8", [6, 10, 12, 15, 20, 24, 28, 34, 41, 47, 55, 60, 66]),
];
/// \[um] how far mean bores of inner rings may be below their size, by [`SIZES`] and classes.
const BORES: [[u8; 13]; 3] = [
    [8, 8, 8, 8, 10, 12, 15, 20, 25, 30, 35, 40, 45],
    [7, 7, 7, 7, 8, 10, 12, 15, 18, 22, 25, 30, 35],
    [5, 5, 5, 5, 6, 8, 9, 10, 13, 15, 18, 23, 28],
];
/// \[um] how far mean outside diameters of outer rings may be below their size, likewise; and those above 120 up to 150 mm.
const OUTSIDES: [([u8; 13], u8); 3] = [
    ([8, 8, 8, 8, 9, 11, 13, 15, 25, 30, 35, 40, 45], 18),
    ([7, 7, 7, 7, 8, 9, 11, 13, 18, 20, 25, 28, 33], 15),
    ([5, 5, 5, 5, 6, 7, 9, 10, 13, 15, 18, 20, 23], 11),
];

/// A tolerance of a shaft or a hole of a size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerance {
    /// \[m] least and greatest deviation from the size.
    deviations: [f64; 2],
    /// Is it one of holes?
    hole: bool,
}

/// Range of a diameter \[m] among [`SIZES`].
fn range(diameter: f64) -> Option<usize> {
    // A size in metres may be off its millimetres by rounding.
    SIZES.iter().position(|most| 1e3 * diameter <= most + 1e-6)
}

impl Tolerance {
    /// Reads a class such as k6 or P7 of a diameter \[m].
    ///
    /// # Errors
    /// What is allowed, where there is no such class.
    pub(super) fn read(word: &str, diameter: f64) -> Result<Self, &'static str> {
        const ALLOWED: &str = "allowed are f, g, h, j, js, k, m, n, p of shafts and F, G, H, J, JS, K, M, N, P of holes with a grade from 4 to 8 \
                               (j: 5 to 7, J: 6 to 8), such as \"k6\" or \"H7\", for seats up to 500 mm (ISO 286-1)";
        let split = word.len().saturating_sub(1);
        let (letters, grade) = (word.get(..split), word.get(split..).and_then(|grade| grade.parse().ok()));
        let (letters, grade) = letters.zip(grade).ok_or(ALLOWED)?;
        let of = range(diameter).ok_or(ALLOWED)?;
        let grade: usize = Some(grade).filter(|grade| (4..=8).contains(grade)).ok_or(ALLOWED)?;
        let [finer, width] = [grade - 4, grade - 3].map(|row| f64::from(GRADES[row][of]));
        let hole = letters.chars().all(|letter: char| letter.is_ascii_uppercase());
        let lower = letters.to_ascii_lowercase();
        if !hole && lower != letters {
            return Err(ALLOWED);
        }
        let row = |table: &[(&str, [u8; 13])], name: &str| {
            table.iter().find(|(own, _)| *own == name).map(|(_, values)| f64::from(values[of]))
        };
        // Of a shaft; a hole of the same letter is its mirror image, but for what follows.
        let [least, greatest] = match lower.as_str() {
            "h" => [-width, 0.0],
            "js" => [-0.5 * width, 0.5 * width],
            "j" => {
                let far = row(&ABOUT, word).ok_or(ALLOWED)?;
                [-far, width - far]
            }
            // From grade 8 on k begins at the size itself.
            "k" if grade == 8 && !hole => [0.0, width],
            letter => {
                let deviation = row(&DEVIATIONS, letter).ok_or(ALLOWED)?;
                match letter {
                    "f" | "g" => [-deviation - width, -deviation],
                    _ => [deviation, deviation + width],
                }
            }
        };
        let deviations = if hole {
            // Fits of the system of holes and of that of shafts are alike where the hole is one grade coarser.
            let tight = matches!(lower.as_str(), "k" | "m" | "n") || lower == "p" && grade < 8;
            let mut shift = if tight && of > 0 { width - finer } else { 0.0 };
            if word == "M6" && of == 10 {
                shift += 2.0;
            }
            [shift - greatest, shift - least]
        } else {
            [least, greatest]
        };
        Ok(Self { deviations: deviations.map(|deviation| 1e-6 * deviation), hole })
    }

    /// Is it one of the seat of the inner (0) or outer (1) ring?
    pub(super) fn is_of(&self, ring: usize) -> bool {
        self.hole == (ring == 1)
    }

    /// \[m] interference of a ring of a diameter \[m] on its seat; none of sizes that the class of rings does not have.
    pub(super) fn interference(self, diameter: f64, class: RingClass, within: Within) -> Option<f64> {
        let of = range(diameter)?;
        let [lower, upper] = self.deviations;
        let ends = if self.hole {
            let (below, to_150) = &OUTSIDES[class as usize];
            let below = if of == 8 && 1e3 * diameter <= 150.0 + 1e-6 { *to_150 } else { below[of] };
            [-1e-6 * f64::from(below) - upper, -lower]
        } else {
            [lower, upper + 1e-6 * f64::from(BORES[class as usize][of])]
        };
        Some(match within {
            Within::Least => ends[0],
            Within::Mean => 0.5 * (ends[0] + ends[1]),
            Within::Greatest => ends[1],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deviations as the tables of ISO 286-2 print them.
    #[test]
    fn published_deviations_of_shafts_and_holes() {
        for (word, millimetres, printed) in [
            ("f7", 25.0, [-41.0, -20.0]),
            ("g6", 80.0, [-29.0, -10.0]),
            ("h5", 180.0, [-18.0, 0.0]),
            ("j6", 50.0, [-5.0, 11.0]),
            ("j7", 100.0, [-15.0, 20.0]),
            ("js5", 12.0, [-4.0, 4.0]),
            ("k5", 60.0, [2.0, 15.0]),
            ("k6", 3.0, [0.0, 6.0]),
            ("k8", 40.0, [0.0, 39.0]),
            ("m5", 200.0, [17.0, 37.0]),
            ("n6", 120.0, [23.0, 45.0]),
            ("p6", 500.0, [68.0, 108.0]),
            ("F8", 30.0, [20.0, 53.0]),
            ("G6", 65.0, [10.0, 29.0]),
            ("H6", 132.5, [0.0, 25.0]),
            ("J6", 47.0, [-6.0, 10.0]),
            ("J8", 90.0, [-20.0, 34.0]),
            ("JS6", 9.0, [-4.5, 4.5]),
            ("K5", 22.0, [-8.0, 1.0]),
            ("K6", 150.0, [-21.0, 4.0]),
            ("K7", 3.0, [-10.0, 0.0]),
            ("K8", 35.0, [-27.0, 12.0]),
            ("M6", 300.0, [-41.0, -9.0]),
            ("M7", 110.0, [-35.0, 0.0]),
            ("N6", 72.0, [-33.0, -14.0]),
            ("N7", 400.0, [-73.0, -16.0]),
            ("P6", 26.0, [-31.0, -18.0]),
            ("P7", 52.0, [-51.0, -21.0]),
            ("P8", 52.0, [-78.0, -32.0]),
        ] {
            let found = Tolerance::read(word, 1e-3 * millimetres).unwrap();
            for (ours, theirs) in found.deviations.into_iter().zip(printed) {
                assert!((1e6 * ours - theirs).abs() < 1e-9, "{word} {millimetres}: {found:?}");
            }
            assert!(found.is_of(usize::from(word.starts_with(|letter: char| letter.is_ascii_uppercase()))));
        }
        for word in ["", "k", "6", "kk6", "Js6", "h9", "h3", "j8", "J5", "é6", "k66", "H"] {
            assert!(Tolerance::read(word, 0.03).is_err(), "{word}");
        }
        assert!(Tolerance::read("h6", 0.501).is_err());
    }

    /// Rings as the tables of ISO 492 print them: an outside diameter of 150 mm is not yet of the next range.
    #[test]
    fn published_deviations_of_rings() {
        let greatest = |word: &str, millimetres: f64, class: RingClass| {
            let diameter = 1e-3 * millimetres;
            let ends = [Within::Least, Within::Mean, Within::Greatest].map(|within| {
                Tolerance::read(word, diameter).unwrap().interference(diameter, class, within).unwrap()
            });
            assert!((ends[0] + ends[2] - 2.0 * ends[1]).abs() < 1e-15);
            ends.map(|end| (1e7 * end).round() / 10.0)
        };
        assert_eq!(greatest("h6", 25.0, RingClass::Normal)[2], 10.0);
        assert_eq!(greatest("h6", 25.0, RingClass::P6)[2], 8.0);
        assert_eq!(greatest("h6", 25.0, RingClass::P5)[2], 6.0);
        assert_eq!(greatest("h6", 120.0, RingClass::Normal)[2], 20.0);
        assert_eq!(greatest("H7", 150.0, RingClass::Normal)[0], -58.0);
        assert_eq!(greatest("H7", 151.0, RingClass::Normal)[0], -65.0);
        assert_eq!(greatest("H7", 150.0, RingClass::P6)[0], -55.0);
        assert_eq!(greatest("H7", 80.0, RingClass::P5)[0], -39.0);
    }
}
