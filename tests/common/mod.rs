//! Reference cases of rolling contact (tests/data/contact/README.md).

use roulement::kalker::{Patch, ScaledCreepage};

/// A reference case, scaled as Kalker's problem scales.
pub struct Case {
    /// general, bearing or oblique; not every test asks.
    #[allow(dead_code)]
    pub kind: String,
    pub patch: Patch,
    pub creepage: ScaledCreepage,
    /// fx, fy, mz.
    pub expected: [f64; 3],
    /// Adhesion area over contact area.
    #[allow(dead_code)]
    pub stick: f64,
}

/// Independent data of random contacts.
pub fn cases() -> Vec<Case> {
    read(include_str!("../data/contact/random.csv"))
}

/// Independent data along curves of one creepage.
#[allow(dead_code)]
pub fn curves() -> Vec<Case> {
    read(include_str!("../data/contact/curves.csv"))
}

/// Cases of a file, scaled as Kalker's problem scales.
fn read(text: &str) -> Vec<Case> {
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    text.lines()
        .skip(1)
        .map(|line| {
            let row: Vec<&str> = line.split(',').collect();
            let get = |name: &str| row[header.iter().position(|h| *h == name).unwrap()];
            let number = |name: &str| get(name).parse::<f64>().unwrap();
            let (a, b) = (number("semi_axis_x"), number("semi_axis_y"));
            let scale = number("shear_modulus") / (number("friction") * number("peak_pressure"));
            Case {
                kind: get("kind").to_string(),
                patch: Patch {
                    axis_ratio: a / b,
                    poisson_ratio: number("poisson_ratio"),
                    rolling_angle: number("rolling_angle"),
                },
                creepage: ScaledCreepage {
                    x: number("creep_x") * scale,
                    y: number("creep_y") * scale,
                    spin: number("spin") * (a * b).sqrt() * scale,
                    curvature: 0.0,
                },
                expected: [number("fx"), number("fy"), number("mz")],
                stick: number("stick"),
            }
        })
        .collect()
}
