//! Small motions about the running state.

use pyo3::prelude::*;
use roulement_cli::modes::{Asked, Modes, to_json};

use crate::failures::{runtime, value};
use crate::scenes::Scene;

/// [rad/s] largest speed of a table.
const FASTEST: f64 = 1e5;
/// Speeds of a table, at most.
const MOST_SPEEDS: usize = 1000;

/// Motions of a scene that has run for a while, over its speed, as JSON.
#[pyfunction]
pub fn modes(
    py: Python<'_>,
    scene: &Scene,
    time: f64,
    after: f64,
    up_to: Option<f64>,
    speeds: i64,
) -> PyResult<String> {
    for (name, duration) in [("time", time), ("after", after)] {
        if !(duration.is_finite() && duration >= 0.0) {
            return Err(value(format!("{name} = {duration} s is out of [0, inf)")));
        }
    }
    if let Some(speed) = up_to.filter(|speed| !(*speed > 0.0 && *speed <= FASTEST)) {
        return Err(value(format!("up_to = {speed} rad/s is out of (0, {FASTEST}]")));
    }
    let Some(speeds) = usize::try_from(speeds).ok().filter(|speeds| *speeds <= MOST_SPEEDS) else {
        return Err(value(format!("speeds = {speeds} is out of [0, {MOST_SPEEDS}]")));
    };
    py.detach(|| {
        let asked = Asked { time, after, up_to, speeds };
        let modes = Modes::of(&scene.resolved()?, &asked).map_err(runtime)?;
        Ok(to_json(&modes).to_string())
    })
}
