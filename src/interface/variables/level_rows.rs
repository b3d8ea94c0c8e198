//! Rows of the bearings whose level changes.

use super::shaft_rows::{ShaftSource, quoted, row};
use super::{Causality, Variable};
use crate::scene::system::SystemScene;
use crate::schema::variable_units::{self as units, Unit};
use crate::simulation::system::LevelJump;

/// A row: key, unit with a typical size, what it is, and its value.
type LevelRow = (&'static str, (Unit, f64), &'static str, fn(&LevelJump) -> f64);

const ROWS: [LevelRow; 3] = [
    ("changes", (units::ONE, 1.0), "changes of the level since the start", |jump| f64::from(jump.changes)),
    (
        "force_jump",
        (units::NEWTON, 1.0),
        "size of the jump of the force on the inner ring at the last change of the level",
        |jump| jump.force,
    ),
    (
        "moment_jump",
        (units::NEWTON_METRE, 1e-2),
        "size of the jump of the moment on the inner ring at the last change of the level",
        |jump| jump.moment,
    ),
];

/// What the changes of level did, of every bearing of a scene that may change it.
pub fn rows(scene: &SystemScene) -> impl Iterator<Item = Variable> {
    let changing = scene.bearings.iter().enumerate().filter(|(_, own)| own.dynamic.is_some());
    changing.flat_map(|(index, bearing)| {
        ROWS.map(|(key, unit, what, get)| {
            let name = format!("{}.level.{key}", quoted(&bearing.name));
            let description = format!("{what} of bearing {}", bearing.name);
            row(name, unit, Causality::Output, description, ShaftSource::Jump(index, get))
        })
    })
}
