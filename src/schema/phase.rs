//! Named windows of a run: the entries `[[phase]]` of a scene.

use serde::Deserialize;

use super::error::SceneError;
use super::numbers::Range;
use super::units::Time;

/// [-] phases of a scene at most.
const MOST: usize = 64;

/// A named window of a run, which has means, least and largest values, heat and life of its own: an entry `[[phase]]`. Phases may overlap.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PhaseSection {
    /// Its name: letters, digits, _ and -.
    pub name: String,
    /// \[s] where it begins.
    pub from: Time,
    /// \[s] where it ends, within `load.duration`.
    pub to: Time,
}

/// Checks phases of a run of a duration \[s]: names of their own, and times inside the run.
///
/// # Errors
/// Names the key, the value and what is allowed.
pub fn check_phases(phases: &[PhaseSection], duration: f64) -> Result<(), SceneError> {
    if phases.len() > MOST {
        let why = format!("{} phases are too many: allowed is [0, {MOST}]", phases.len());
        return Err(SceneError::conflict("phase", why));
    }
    for (place, PhaseSection { name, from, to }) in phases.iter().enumerate() {
        let key = |of: &str| format!("phase[{place}].{of}");
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(plain) {
            let why = format!("\"{name}\" is no name: allowed are letters, digits, _ and -, such as aligned");
            return Err(SceneError::conflict(key("name"), why));
        }
        if phases[..place].iter().any(|other| other.name == *name) {
            let why = format!("\"{name}\" is the name of another phase: each needs one of its own");
            return Err(SceneError::conflict(key("name"), why));
        }
        Range::closed(0.0, duration, "s").check(&key("from"), from.0)?;
        Range::above(from.0, duration, "s").check(&key("to"), to.0)?;
    }
    Ok(())
}
