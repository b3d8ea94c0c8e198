//! Checks of motions that are given at named loads of shafts and housings.

use super::NamedLoad;
use super::ranges::{GIVEN_DISPLACEMENT, GIVEN_ROTATION};
use crate::schema::SceneError;

/// Motions of a named load that are given: within their ranges, without a jump in speed, and not beside a force or a moment of their own.
pub fn given_motion(load: &NamedLoad<'_>) -> Result<(), SceneError> {
    for (key, component, motion) in load.motion() {
        let key = format!("{load}: {key}");
        let (range, other, effort) = match component {
            0..3 => (GIVEN_DISPLACEMENT, "force", &load.force.0[component]),
            _ => (GIVEN_ROTATION, "moment", &load.moment.0[component - 3]),
        };
        motion.values().into_iter().try_for_each(|value| range.check(&key, value))?;
        if !motion.begins_at_rest() {
            let why = "a motion begins at rest, and a sine does so with phase = \"90 deg\" or \"-90 deg\"";
            return Err(SceneError::conflict(key, why));
        }
        if effort.values().into_iter().any(|value| value != 0.0) {
            let why = format!(
                "is given and so is {other}: what it takes follows from the motion; give one of both"
            );
            return Err(SceneError::conflict(key, why));
        }
    }
    Ok(())
}
