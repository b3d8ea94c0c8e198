//! What holds the shafts of a system along their axes.

use super::spring::SceneSpring;
use super::{MountedScene, Scene};
use crate::schema::{AxialSeat, Drive, Race, SceneError, ShaftSection};

/// Checks that every shaft is held along its axis.
///
/// # Errors
/// Names the key that leaves it free.
pub fn held(
    shafts: &[ShaftSection],
    bearings: &[MountedScene],
    springs: &[SceneSpring],
) -> Result<(), SceneError> {
    for (index, shaft) in shafts.iter().enumerate() {
        let on = |bearing: &&MountedScene| bearing.shaft == index || bearing.outer_shaft == Some(index);
        let own = || bearings.iter().filter(on);
        // What the other shaft of a coupling holds is held.
        let mut by_spring =
            springs.iter().filter(|spring| spring.shaft == index || spring.second == Some(index));
        let driven = shaft.load.iter().any(|load| load.displacement.x.is_some());
        let held = driven
            || own().any(|bearing| bearing.mounting.axial == AxialSeat::Held && !goes_along(&bearing.scene))
            || by_spring.any(SceneSpring::holds_axially);
        if shaft.matrices.is_some() || held {
            continue;
        }
        let which = if shafts.len() == 1 { "the shaft".into() } else { format!("shaft \"{}\"", shaft.name) };
        let on_it = if shafts.len() == 1 { "" } else { " on it" };
        if let Some(bearing) = own().find(|bearing| goes_along(&bearing.scene)) {
            let why = format!(
                "\"wrench\": nothing would hold {which} along its axis, as this outer race goes along; give it load.outer.x.displacement, or \
                 another bearing{on_it} that is held"
            );
            return Err(SceneError::conflict(format!("bearing \"{}\": outer.drive", bearing.name), why));
        }
        if own().next().is_none() {
            let why = format!(
                "nothing would hold {which} along its axis: at least one bearing{on_it} needs ribs (rollers.axial_way), tapered rollers, balls or an \
                 axial stiffness, or a load displacement.x"
            );
            return Err(SceneError::conflict("bearing", why));
        }
        let why = format!(
            "nothing would hold {which} along its axis: at least one bearing{on_it} needs axial = \"held\""
        );
        return Err(SceneError::conflict("bearing.mounting.axial = \"free\"", why));
    }
    Ok(())
}

/// Does the outer race follow the inner one along the axis, under a wrench that does not hold it there?
fn goes_along(scene: &Scene) -> bool {
    scene.outer.drive == Drive::Wrench && Race::Outer.directions(scene)[0].motion.is_none()
}
