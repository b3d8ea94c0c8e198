//! Form of races and balls: waviness, roundness, measured profiles, ovality from a housing, balls of different sizes
//! ([`crate::contact::form`]).

use std::path::Path;

use serde::Deserialize;
use serde::de::{Deserializer, Error};

use super::Effects;
use super::effect::{Effect, Info, Setup};
use super::estimate::{Estimate, digits};
use super::keys::Keys;
use super::twin::{Switch, Twin};
use crate::contact::form::{Form, Wave};
use crate::schema::numbers::Range;
use crate::schema::units::{Angle, Length, Quantity};
use crate::schema::{SceneError, reader, regular};

/// Amplitudes and heights: beyond, a race is no torus with small waves.
const HEIGHT: Range = Range::closed(-1e-3, 1e-3, "m");
const PHASE: Range = Range::closed(-7.0, 7.0, "rad");
/// More waves around a race than these are shorter than any contact.
const ORDER: Range = Range::closed(1.0, 10_000.0, "");
/// Points of a profile.
const POINTS: Range = Range::closed(8.0, 20_000.0, "");
/// [-] deviation of a ball's diameter over that diameter.
const LARGEST_DEVIATION: f64 = 0.01;
/// [-] distance of a profile's point from where it would be at equal distances, over that distance.
const UNEVEN: f64 = 1e-3;

/// Way in which a wave moves the groove.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Along {
    /// Away from the axis.
    #[default]
    Radial,
    /// Along the axis.
    Axial,
}

/// A wave: `amplitude cos(order th - phase)`, th from the race's own y axis towards z.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveSection {
    /// [-] waves around the race.
    pub order: u32,
    /// \[m] amplitude; positive is away from the axis, or towards +x.
    pub amplitude: Length,
    /// \[rad] phase; 0 if not given.
    #[serde(default = "no_angle")]
    pub phase: Angle,
    /// Way in which it moves the groove; radial if not given.
    #[serde(default)]
    pub direction: Along,
}

fn no_angle() -> Angle {
    Angle(0.0)
}

/// Shape of a race.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A sum of waves.
    Waves(Vec<Wave>),
    /// Points at equal distances around the race, the first on its y axis: away from the axis and along it \[m].
    Points(Vec<[f64; 2]>),
    /// The file with these points, before it was read.
    File(String),
}

/// The section `[form]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FormSection {
    /// Inner race.
    pub inner: Option<Shape>,
    /// Outer race.
    pub outer: Option<Shape>,
    /// \[m] deviations of the balls' diameters, one per ball.
    pub balls: Vec<Length>,
}

const SHAPE: &str = "a shape is a list of waves such as [{ order = 2, amplitude = \"2 um\" }], or \
                     { profile = \"file.csv\" }, or { profile = [[radial, axial], ...] }";

impl<'de> Deserialize<'de> for Shape {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match &toml::Value::deserialize(deserializer)? {
            toml::Value::Array(waves) => {
                let wave = |value: &toml::Value| {
                    let wave: WaveSection =
                        reader::read(value).map_err(|why| D::Error::custom(why.message()))?;
                    Ok(Wave {
                        order: wave.order as usize,
                        amplitude: wave.amplitude.0,
                        phase: wave.phase.0,
                        axial: wave.direction == Along::Axial,
                    })
                };
                Ok(Self::Waves(waves.iter().map(wave).collect::<Result<_, D::Error>>()?))
            }
            toml::Value::Table(table) if table.len() == 1 => match table.get("profile") {
                Some(toml::Value::String(path)) => Ok(Self::File(path.clone())),
                Some(toml::Value::Array(rows)) => {
                    let row = |row: &toml::Value| match row {
                        toml::Value::Array(row) => match row.as_slice() {
                            [radial, axial] => Ok([length(radial)?, length(axial)?]),
                            _ => Err(D::Error::custom(SHAPE)),
                        },
                        radial => Ok([length(radial)?, 0.0]),
                    };
                    Ok(Self::Points(rows.iter().map(row).collect::<Result<_, D::Error>>()?))
                }
                _ => Err(D::Error::custom(SHAPE)),
            },
            _ => Err(D::Error::custom(SHAPE)),
        }
    }
}

fn length<E: Error>(value: &toml::Value) -> Result<f64, E> {
    Length::DIMENSION.read(value).map_err(E::custom)
}

impl Shape {
    /// As a contact sees it; none where it departs from a torus nowhere.
    pub fn form(&self) -> Option<Form> {
        match self {
            Self::Waves(waves) => Form::of_waves(waves),
            Self::Points(points) => Form::of_profile(points),
            Self::File(_) => None,
        }
    }

    fn check(&self, key: &str) -> Result<(), SceneError> {
        match self {
            Self::Waves(waves) => waves.iter().enumerate().try_for_each(|(index, wave)| {
                let of = |name: &str| format!("{key}[{index}].{name}");
                ORDER.check(&of("order"), wave.order as f64)?;
                HEIGHT.check(&of("amplitude"), wave.amplitude)?;
                PHASE.check(&of("phase"), wave.phase)
            }),
            Self::Points(points) => {
                POINTS.check(&format!("{key}.profile: number of points"), points.len() as f64)?;
                let key = format!("{key}.profile");
                points.iter().flatten().try_for_each(|height| HEIGHT.check(&key, *height))
            }
            Self::File(_) => {
                Err(SceneError::conflict(key.to_string(), "the file of the profile was not read"))
            }
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Waves(waves) => format!("{} waves", waves.len()),
            Self::Points(points) => format!("profile of {} points", points.len()),
            Self::File(path) => format!("profile {path}"),
        }
    }
}

impl FormSection {
    /// Reads the files of profiles, relative to a folder; gives the values that stand for them in the scene's text.
    ///
    /// # Errors
    /// If one cannot be read, or is no profile.
    pub fn read_files(&mut self, folder: &Path) -> Result<Vec<(&'static str, toml::Value)>, SceneError> {
        let mut read = vec![];
        for (race, shape) in [("inner", &mut self.inner), ("outer", &mut self.outer)] {
            if let Some(Shape::File(path)) = shape {
                let path = folder.join(&*path);
                let key = format!("form.{race}.profile");
                let text = regular::named(&path, &key)?;
                let points = profile(&text)
                    .map_err(|why| SceneError::conflict(key, format!("{}: {why}", path.display())))?;
                let rows = points.iter().map(|row| toml::Value::from(row.to_vec())).collect();
                read.push((race, toml::Value::Array(rows)));
                *shape = Some(Shape::Points(points));
            }
        }
        Ok(read)
    }
}

/// Points of a table of azimuths \[rad] at equal distances from 0, heights away from the axis, and along it \[m] if there is a third
/// column.
fn profile(text: &str) -> Result<Vec<[f64; 2]>, String> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let head: Vec<&str> = lines.next().unwrap_or("").split(',').map(str::trim).collect();
    if head != ["azimuth_rad", "radial_m"] && head != ["azimuth_rad", "radial_m", "axial_m"] {
        return Err("its first line must be azimuth_rad,radial_m or azimuth_rad,radial_m,axial_m".into());
    }
    let mut points = vec![];
    let mut azimuths = vec![];
    for (index, line) in lines.enumerate() {
        let row: Vec<f64> = line
            .split(',')
            .map(|cell| {
                cell.trim().parse::<f64>().map_err(|_| format!("row {}: {cell} is no number", index + 1))
            })
            .collect::<Result<_, _>>()?;
        if row.len() != head.len() {
            return Err(format!("row {} has {} numbers, not {}", index + 1, row.len(), head.len()));
        }
        azimuths.push(row[0]);
        points.push([row[1], row.get(2).copied().unwrap_or(0.0)]);
    }
    let spacing = std::f64::consts::TAU / points.len() as f64;
    let even = |(index, azimuth): (usize, &f64)| (azimuth - index as f64 * spacing).abs() <= UNEVEN * spacing;
    match azimuths.iter().enumerate().find(|row| !even(*row)) {
        Some((index, azimuth)) => Err(format!(
            "row {} is at {azimuth} rad: azimuths must be at equal distances of {spacing} rad from 0 around the race",
            index + 1
        )),
        None => Ok(points),
    }
}

/// The effect as a scene has it.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The section `[form]`.
    pub section: FormSection,
}

impl Keys for Settings {
    const NAMES: &'static [&'static str] = &[];

    fn read<'de, A: serde::de::MapAccess<'de>>(&mut self, _: &str, _: &mut A) -> Result<(), A::Error> {
        Ok(())
    }
}

impl Settings {
    /// Shape of the inner or the outer race.
    pub fn of(&self, inner: bool) -> Option<&Shape> {
        let FormSection { inner: of_inner, outer: of_outer, .. } = &self.section;
        if inner { of_inner.as_ref() } else { of_outer.as_ref() }
    }

    /// \[m] deviations of the balls' radii; none where all are alike.
    pub fn larger_radii(&self) -> Vec<f64> {
        self.section.balls.iter().map(|deviation| 0.5 * deviation.0).collect()
    }
}

/// \[m] height that the estimate is for, where the scene gives none.
const TYPICAL_HEIGHT: f64 = 1e-6;

impl Shape {
    /// \[m] largest height of it above or below the torus.
    fn height(&self) -> f64 {
        match self {
            Self::Waves(waves) => waves.iter().map(|wave| wave.amplitude.abs()).sum(),
            Self::Points(points) => points.iter().flatten().fold(0.0, |most, height| height.abs().max(most)),
            Self::File(_) => 0.0,
        }
    }
}

impl FormSection {
    /// \[m] largest height of races, or deviation of a ball's diameter.
    fn height(&self) -> f64 {
        let shapes = [&self.inner, &self.outer].into_iter().flatten().map(Shape::height);
        shapes.chain(self.balls.iter().map(|deviation| deviation.0.abs())).fold(0.0, f64::max)
    }
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "form",
        adds: "waves and measured profiles of the races, radial and axial, and balls of different sizes",
        states: "none",
        source: "Wardle 1988; Johnson 1985, chapter 4 for the contact",
        price: "39 % of a step, of any number of waves (thrust case), and steps that see every wave",
        example: "[form]\nouter = [{ order = 9, amplitude = \"0.3 um\" }]\n",
    };
    const ESTIMATE: &'static str =
        "settled states with and without waves of its largest height, 1 um where it is off";

    fn setting(&self) -> Option<String> {
        let FormSection { inner, outer, balls } = &self.section;
        let of = |race: &str, shape: &Option<Shape>| {
            shape.as_ref().map(|shape| format!("{race}: {}", shape.words()))
        };
        let sizes = (!balls.is_empty()).then(|| "balls of different sizes".to_string());
        let parts: Vec<String> =
            of("inner", inner).into_iter().chain(of("outer", outer)).chain(sizes).collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }

    fn twins(&self, estimate: &Estimate) -> Vec<Twin> {
        let on = self.setting().is_some();
        let height = if on { self.section.height() } else { TYPICAL_HEIGHT };
        // All balls on crests, and every other one in a trough: of a height, which balls meet it is a matter of the instant.
        let waved = |order: usize| {
            move |effects: &mut Effects| {
                let wave = Wave { order, amplitude: height, phase: 0.0, axial: false };
                effects.form.section =
                    FormSection { inner: Some(Shape::Waves(vec![wave])), ..FormSection::default() };
            }
        };
        let twin = Twin::new("form", "waviness", on, waved(estimate.balls))
            .or(waved((estimate.balls / 2).max(1)))
            .named(&["a wave for each ball", "a wave for every other ball"]);
        let smooth: Switch = Box::new(|effects| effects.form.section = FormSection::default());
        vec![
            Twin { passing: true, common: Some(smooth), ..twin }
                .taken_as(format!("{} um on the inner race", digits(height * 1e6)))
                .written("[form] with waves or profiles; amplitudes are not known here"),
        ]
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        let FormSection { inner, outer, balls } = &self.section;
        for (key, shape) in [("form.inner", inner), ("form.outer", outer)] {
            shape.as_ref().map_or(Ok(()), |shape| shape.check(key))?;
        }
        if !balls.is_empty() && balls.len() != setup.bearing.balls {
            let why = format!(
                "has {} deviations, and there are {} balls: give one for each",
                balls.len(),
                setup.bearing.balls
            );
            return Err(SceneError::conflict("form.balls", why));
        }
        let most = LARGEST_DEVIATION * setup.bearing.ball_diameter.0;
        let range = Range::closed(-most, most, "m");
        balls.iter().try_for_each(|deviation| range.check("form.balls", deviation.0))
    }
}
