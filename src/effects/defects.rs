//! Spalls of the races ([`crate::contact::spall`]), and the frequencies of a damaged bearing.

use std::f64::consts::TAU;

use serde::Deserialize;

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::keys::keys;
use crate::contact::spall::Spall;
use crate::schema::SceneError;
use crate::schema::numbers::Range;
use crate::schema::units::{Angle, Length};
use crate::schema::variable_units::HERTZ;

/// What is damaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum On {
    /// The inner race.
    Inner,
    /// The outer race.
    Outer,
}

/// A rectangular spall with sharp edges: an entry `[[defect]]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DefectSection {
    /// Where it is.
    pub on: On,
    /// \[rad] azimuth of its middle, from the race's own y axis towards z; 0 if not given.
    #[serde(default = "no_angle")]
    pub azimuth: Angle,
    /// \[rad] contact angle of its middle; the free contact angle if not given.
    pub angle: Option<Angle>,
    /// \[m] length along rolling.
    pub length: Length,
    /// \[m] width across.
    pub width: Length,
    /// \[m] depth.
    pub depth: Length,
}

fn no_angle() -> Angle {
    Angle(0.0)
}

keys! {
    /// Are the frequencies of damage reported (`frequency.*`)? With a defect they always are.
    "frequency_outputs" => frequencies: bool = false,
    ;
    /// The entries `[[defect]]`.
    sections: Vec<DefectSection> = vec![],
}

impl Settings {
    /// Spalls on one of the races of a bearing with a free contact angle \[rad].
    pub fn on(&self, race: On, free_contact_angle: f64) -> Vec<Spall> {
        let of = |section: &DefectSection| Spall {
            azimuth: section.azimuth.0,
            angle: section.angle.map_or(free_contact_angle, |angle| angle.0),
            length: section.length.0,
            width: section.width.0,
            depth: section.depth.0,
        };
        self.sections.iter().filter(|section| section.on == race).map(of).collect()
    }
}

/// Frequencies \[Hz] of cage and damage by the speeds of cage and races as they are; of a bearing whose balls roll without slip
/// they are those of its geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Turns of the cage (FTF).
    pub cage: f64,
    /// Balls over a place of the outer race (BPFO).
    pub outer: f64,
    /// Balls over a place of the inner race (BPFI).
    pub inner: f64,
    /// Turns of a ball about its own axis, seen from the cage (BSF): a place of it meets a race twice in each.
    pub ball: f64,
}

impl Frequencies {
    /// By speeds of cage, inner and outer race [rad/s], of a bearing with a number of balls, their diameter over the pitch
    /// diameter, and the cosine of the contact angle.
    pub fn new([cage, inner, outer]: [f64; 3], balls: usize, ball_over_pitch: f64, cosine: f64) -> Self {
        let [past_outer, past_inner] = [(cage - outer).abs() / TAU, (inner - cage).abs() / TAU];
        let gamma = ball_over_pitch * cosine;
        // Rolling on the outer race, whose contact runs at (1 + gamma) of the pitch radius.
        let ball = past_outer * (1.0 + gamma) / ball_over_pitch;
        let balls = balls as f64;
        Self { cage: cage.abs() / TAU, outer: balls * past_outer, inner: balls * past_inner, ball }
    }
}

/// How a frequency is found in a report.
type FromFrequencies = fn(&Frequencies) -> f64;

/// Frequencies: name, what it is, and its value.
const ROWS: [(&str, &str, FromFrequencies); 4] = [
    ("ftf", "turns of the cage", |f| f.cage),
    ("bpfo", "balls over a place of the outer race", |f| f.outer),
    ("bpfi", "balls over a place of the inner race", |f| f.inner),
    ("bsf", "turns of a ball about its own axis, seen from the cage", |f| f.ball),
];

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "defect",
        adds: "spalls of the races that balls drop into, and the frequencies of damage from the running cage speed",
        states: "none",
        source: "fit of elastic boundary elements (contact::spall); frequencies after Harris 2001, chapter 25",
        price: "a step that sees the edge while a ball is near; not measured",
        example: "[[defect]]\non = \"outer\"\nlength = \"1 mm\"\nwidth = \"3 mm\"\ndepth = \"0.1 mm\"\n",
    };

    fn setting(&self) -> Option<String> {
        match (self.sections.len(), self.frequencies) {
            (0, false) => None,
            (0, true) => Some("frequencies".into()),
            (1, _) => Some("1 spall".into()),
            (count, _) => Some(format!("{count} spalls")),
        }
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        let ball = setup.bearing.ball_diameter.0;
        let size = Range::above(0.0, 0.5 * ball, "m");
        self.sections.iter().enumerate().try_for_each(|(index, defect)| {
            let of = |name: &str| format!("defect[{index}].{name}");
            Range::closed(-7.0, 7.0, "rad").check(&of("azimuth"), defect.azimuth.0)?;
            if let Some(angle) = defect.angle {
                Range::closed(-1.6, 1.6, "rad").check(&of("angle"), angle.0)?;
            }
            size.check(&of("length"), defect.length.0)?;
            size.check(&of("width"), defect.width.0)?;
            // Shallower ones are finer than the finish of a race.
            Range::closed(1e-7, 0.1 * ball, "m").check(&of("depth"), defect.depth.0)
        })
    }

    fn rows(&self) -> Vec<Row> {
        let row = |(name, what, get): (&str, &str, FromFrequencies)| Row {
            name: format!("frequency.{name}"),
            unit: HERTZ,
            nominal: 100.0,
            description: format!("{what}, per second"),
            get: Getter::new(move |reports| get(reports.frequencies)),
        };
        if self.setting().is_some() { ROWS.into_iter().map(row).collect() } else { vec![] }
    }
}
