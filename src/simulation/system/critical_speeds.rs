//! Natural frequencies of shafts on their bearings over the speed of the first, and the speeds at which one of them is that of its turn.
//!
//! At every speed the statics are solved anew: bearings change their stiffness with the centrifugal forces of their balls.

use super::linear::{ShaftMode, Whirl};
use super::{System, SystemError};
use crate::scene::Schedule;
use crate::scene::system::SystemScene;
use crate::schema::ShaftSection;
use crate::schema::units::AngularVelocity;

/// Speeds of the table.
const ROWS: usize = 9;
/// [-] of the largest speed: how close a critical speed is found.
const CLOSE: f64 = 1e-6;
/// Most solutions for one of them.
const MOST: usize = 30;
/// [rad/s] largest speed of a table where a scene has no speed.
const USUAL: f64 = 1000.0;
/// [-] of the largest speed of a scene, that of its table.
const BEYOND: f64 = 1.5;

/// Natural frequencies over the speed.
#[derive(Clone, Debug)]
pub struct Campbell {
    /// By growing speed.
    pub rows: Vec<CampbellRow>,
    /// By growing speed.
    pub critical: Vec<CriticalSpeed>,
}

/// Natural frequencies at a speed.
#[derive(Clone, Debug)]
pub struct CampbellRow {
    /// [rad/s] speed of the first shaft.
    pub speed: f64,
    /// By growing frequency.
    pub modes: Vec<ShaftMode>,
}

/// A speed at which a natural frequency is that of the turn.
#[derive(Clone, Debug)]
pub struct CriticalSpeed {
    /// [rad/s] speed of the shaft.
    pub speed: f64,
    /// Mode that swings there.
    pub mode: ShaftMode,
}

impl CriticalSpeed {
    /// Does an unbalance drive it? It pushes across the axis, and goes round forwards.
    pub fn is_driven_by_unbalance(&self) -> bool {
        matches!(self.mode.whirl, Whirl::Forward | Whirl::Planar)
    }
}

/// [rad/s] a speed that the table of a scene goes to: beyond the largest of its script.
pub fn largest_speed(scene: &SystemScene) -> f64 {
    let shaft = &scene.shafts[0];
    let scripted = shaft.speed.iter().flat_map(Schedule::values);
    let start = shaft.start_speed.map(|speed| speed.0);
    let largest = scripted.chain(start).map(f64::abs).fold(0.0, f64::max);
    if largest > 0.0 { BEYOND * largest } else { USUAL }
}

/// Natural frequencies up to a speed [rad/s] under the loads at a time \[s].
///
/// # Errors
/// If the shaft finds no balance at one of the speeds.
pub fn campbell(scene: &SystemScene, time: f64, up_to: f64) -> Result<Campbell, SystemError> {
    let row = |speed: f64| -> Result<CampbellRow, SystemError> {
        let system = System::starting_at(&at_speed(scene, speed), time)?;
        Ok(CampbellRow { speed, modes: system.modes()?.unwrap_or_default() })
    };
    let speeds = (0..ROWS).map(|k| up_to * k as f64 / (ROWS - 1) as f64);
    let rows = speeds.map(row).collect::<Result<Vec<_>, _>>()?;
    let mut critical = vec![];
    for pair in rows.windows(2) {
        let modes = pair[0].modes.len().min(pair[1].modes.len());
        for k in 0..modes {
            let beyond = |row: &CampbellRow| {
                row.modes.get(k).map(|mode| mode.frequency * std::f64::consts::TAU - row.speed)
            };
            let crosses = |row: &CampbellRow| beyond(row).is_some_and(|beyond| beyond > 0.0);
            if crosses(&pair[0]) != crosses(&pair[1]) {
                critical.extend(crossing(&pair[0], &pair[1], up_to, &beyond, &row)?.and_then(|row| {
                    let mode = row.modes.get(k)?.clone();
                    Some(CriticalSpeed { speed: row.speed, mode })
                }));
            }
        }
    }
    critical.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    Ok(Campbell { rows, critical })
}

/// The row between two others at which a frequency is that of the turn (Illinois variant of the false position).
fn crossing(
    below: &CampbellRow,
    above: &CampbellRow,
    up_to: f64,
    beyond: &impl Fn(&CampbellRow) -> Option<f64>,
    row: &impl Fn(f64) -> Result<CampbellRow, SystemError>,
) -> Result<Option<CampbellRow>, SystemError> {
    let (Some(mut low), Some(mut high)) = (beyond(below), beyond(above)) else { return Ok(None) };
    let (mut from, mut to) = (below.speed, above.speed);
    for _ in 0..MOST {
        let found = row(from + (to - from) * low / (low - high))?;
        let Some(value) = beyond(&found) else { return Ok(None) };
        if value.abs() <= CLOSE * up_to || (to - from).abs() <= CLOSE * up_to {
            return Ok(Some(found));
        }
        if (value > 0.0) == (low > 0.0) {
            (from, low, high) = (found.speed, value, 0.5 * high);
        } else {
            (to, high, low) = (found.speed, value, 0.5 * low);
        }
    }
    Ok(None)
}

/// [rad/s] speed of a shaft at a time \[s], where the scene gives it.
fn speed_at(shaft: &ShaftSection, time: f64) -> f64 {
    let scripted = shaft.speed.as_ref().map(|speed| speed.at(time));
    scripted.or(shaft.start_speed.map(|speed| speed.0)).unwrap_or(0.0)
}

/// The scene of a shaft that turns at a speed [rad/s], whatever its own drives it by; of several shafts the first one, and the others faster
/// and slower with it.
pub fn at_speed(scene: &SystemScene, speed: f64) -> SystemScene {
    let mut scene = scene.clone();
    match &mut scene.shafts[..] {
        [shaft] => {
            (shaft.speed, shaft.torque, shaft.start_speed) = (Some(Schedule::Constant(speed)), None, None);
        }
        shafts => {
            let first = speed_at(&shafts[0], 0.0);
            let factor = if first == 0.0 { 1.0 } else { speed / first };
            for shaft in shafts {
                let scaled = speed_at(shaft, 0.0) * factor;
                match &mut shaft.speed {
                    Some(given) => *given = Schedule::Constant(scaled),
                    None => shaft.start_speed = Some(AngularVelocity(scaled)),
                }
            }
        }
    }
    for bearing in &mut scene.bearings {
        let speed = speed_at(&scene.shafts[bearing.shaft], 0.0);
        bearing.scene.load.inner_speed = Schedule::Constant(bearing.mounting.direction.sign() * speed);
    }
    scene
}
