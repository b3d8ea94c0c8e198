//! Spalls of races ([`crate::contact::spall`]) and balls ([`crate::contact::ball_spall`]), and the frequencies of a damaged bearing.

use super::reports::Frequencies;
use std::f64::consts::TAU;

use serde::Deserialize;

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::keys::keys;
use crate::contact::spall::Spall;
use crate::schema::SceneError;
use crate::schema::numbers::Range;
use crate::schema::units::{Angle, Length};
use crate::schema::variable_units::HERTZ;

/// Damaged body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum On {
    /// The inner race.
    Inner,
    /// The outer race.
    Outer,
    /// A ball.
    Ball,
}

/// A rectangular spall with sharp edges: an entry `[[defect]]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DefectSection {
    /// Where it is.
    pub on: On,
    /// [-] the ball that it is on, counted from 1; of a spall of a ball alone.
    pub ball: Option<u32>,
    /// \[rad] azimuth of its middle, from the race's own y axis towards z; 0 if not given. On a ball it goes about the ball's own x axis, about
    /// which the ball rolls: 0 is where the ball stands on the outer race at the start, pi on the inner race
    /// ([`crate::model::damage::DamagedBalls::at_start`]).
    #[serde(default = "no_angle")]
    pub azimuth: Angle,
    /// \[rad] contact angle of its middle; the free contact angle if not given. On a ball it is the angle from the circle that rolls on both
    /// races towards the ball's own x axis; 0 if not given.
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

impl DefectSection {
    /// The spall, with its angle \[rad] where that is not given.
    fn spall(&self, angle: f64) -> Spall {
        Spall {
            azimuth: self.azimuth.0,
            angle: self.angle.map_or(angle, |angle| angle.0),
            length: self.length.0,
            width: self.width.0,
            depth: self.depth.0,
        }
    }

    /// Is its ball one of so many?
    fn check_ball(&self, key: &str, balls: usize) -> Result<(), SceneError> {
        match (self.on, self.ball) {
            (On::Ball, None) => Err(SceneError::conflict(key, format!("give the ball, one of 1 to {balls}"))),
            (On::Ball, Some(ball)) => Range::closed(1.0, balls as f64, "1").check(key, f64::from(ball)),
            (On::Inner | On::Outer, Some(ball)) => {
                Err(SceneError::conflict(key, format!("{ball} needs on = \"ball\": this spall is on a race")))
            }
            (On::Inner | On::Outer, None) => Ok(()),
        }
    }
}

keys! {
    /// Are the frequencies of damage reported (`frequency.*`)? With a defect they always are.
    "frequency_outputs" => frequencies: bool = false,
    ;
    /// The entries `[[defect]]`.
    sections: Vec<DefectSection> = vec![],
}

impl Settings {
    /// Are the frequencies of damage reported?
    pub fn reports_frequencies(&self) -> bool {
        self.frequencies || !self.sections.is_empty()
    }

    /// Spalls on one of the races of a bearing with a free contact angle \[rad].
    pub fn on(&self, race: On, free_contact_angle: f64) -> Vec<Spall> {
        let of = |section: &DefectSection| section.spall(free_contact_angle);
        self.sections.iter().filter(|section| section.on == race).map(of).collect()
    }

    /// Spalls of balls (0 is the first).
    pub fn on_balls(&self) -> Vec<(usize, Spall)> {
        let of = |section: &DefectSection| Some((section.ball?.checked_sub(1)? as usize, section.spall(0.0)));
        self.sections.iter().filter(|section| section.on == On::Ball).filter_map(of).collect()
    }
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
        adds: "spalls of races and balls, by which balls drop towards a race, and the frequencies of damage from the running cage speed",
        states: "the orientation of each ball with a spall",
        source: "fit of elastic boundary elements (contact::spall); frequencies after Harris 2001, chapter 25",
        price: "of a step of a 6206 at 3000 rpm, no ball near / one over it: 3 / 38 % for a spall of a race, 15 / 53 % for one of a ball; near it \
                steps are 6 times shorter",
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
            defect.check_ball(&of("ball"), setup.bearing.balls)?;
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
        if self.reports_frequencies() { ROWS.into_iter().map(row).collect() } else { vec![] }
    }
}
