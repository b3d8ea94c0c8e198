//! The rows of meshes, of bearings by their stiffness or by rollers, and of couplings.

use crate::model::link::roller_friction::FrictionOutputs;
use crate::schema::variable_units::{self as units, Unit};
use crate::simulation::system::LinkOutputs;

/// A row: end of its name, unit and typical size, what it is, and its value.
pub struct LinkRow {
    /// End of its name.
    pub key: &'static str,
    /// Unit and typical size.
    pub unit: (Unit, f64),
    /// What it is, before the name of the link.
    pub what: &'static str,
    /// \[unit] value.
    pub get: fn(&LinkOutputs) -> f64,
}

const fn row(
    key: &'static str,
    unit: (Unit, f64),
    what: &'static str,
    get: fn(&LinkOutputs) -> f64,
) -> LinkRow {
    LinkRow { key, unit, what, get }
}

const FORCE: (Unit, f64) = (units::NEWTON, 1e3);
const MOMENT: (Unit, f64) = (units::NEWTON_METRE, 1.0);
const ANGLE: (Unit, f64) = (units::RADIAN, 1e-3);
const POWER: (Unit, f64) = (units::WATT, 1.0);
const ENERGY: (Unit, f64) = (units::JOULE, 1.0);

/// Those of every link.
const ENERGIES: &[LinkRow] = &[
    row("energy.stored", ENERGY, "energy stored in the springs of", |link| link.state.stored),
    row("energy.dissipated", ENERGY, "energy lost to the damping since the start of", |link| {
        link.state.damped
    }),
];

/// Those of a mesh alone.
const OF_MESH: &[LinkRow] = &[
    row("force.x", FORCE, "force on the first gear, x component, axes of the shaft, of", |link| {
        link.state.force[0]
    }),
    row("force.y", FORCE, "force on the first gear, y component, axes of the shaft, of", |link| {
        link.state.force[1]
    }),
    row("force.z", FORCE, "force on the first gear, z component, axes of the shaft, of", |link| {
        link.state.force[2]
    }),
    row(
        "normal_force",
        FORCE,
        "force normal to the teeth, positive where the first gear drives as it turns about +x, of",
        |link| link.teeth.normal_force,
    ),
    row(
        "misalignment",
        ANGLE,
        "misalignment of the teeth in their plane of action, positive where the flank of the first gear leans into the other towards +x, of",
        |link| link.teeth.misalignment,
    ),
    row(
        "first.moment.y",
        MOMENT,
        "moment of the axial force on the first gear about its axis, y component, axes of the shaft, of",
        |link| link.teeth.tilting_moments[0].y,
    ),
    row(
        "first.moment.z",
        MOMENT,
        "moment of the axial force on the first gear about its axis, z component, axes of the shaft, of",
        |link| link.teeth.tilting_moments[0].z,
    ),
    row(
        "second.moment.y",
        MOMENT,
        "moment of the axial force on the second gear about its axis, y component, axes of the shaft, of",
        |link| link.teeth.tilting_moments[1].y,
    ),
    row(
        "second.moment.z",
        MOMENT,
        "moment of the axial force on the second gear about its axis, z component, axes of the shaft, of",
        |link| link.teeth.tilting_moments[1].z,
    ),
    row("friction_power", POWER, "power lost to friction of the teeth of", |link| link.teeth.friction_power),
];

/// Those of a bearing by its stiffness alone.
const OF_SPRING: &[LinkRow] = &[
    row("force.x", FORCE, "force on the shaft, x component, axes of the shaft, of", |link| {
        link.state.force[0]
    }),
    row("force.y", FORCE, "force on the shaft, y component, axes of the shaft, of", |link| {
        link.state.force[1]
    }),
    row("force.z", FORCE, "force on the shaft, z component, axes of the shaft, of", |link| {
        link.state.force[2]
    }),
    row("moment.y", MOMENT, "moment on the shaft, y component, axes of the shaft, of", |link| {
        link.state.force[4]
    }),
    row("moment.z", MOMENT, "moment on the shaft, z component, axes of the shaft, of", |link| {
        link.state.force[5]
    }),
];

/// Those of a bearing by rollers alone.
const OF_ROLLERS: &[LinkRow] = &[
    row("largest_load", FORCE, "largest load of a roller on the inner race of", |link| {
        link.rollers().map_or(0.0, |rollers| rollers.largest_load)
    }),
    row("largest_rib_load", FORCE, "largest force of a rib on the end of a roller of", |link| {
        link.rollers().map_or(0.0, |rollers| rollers.largest_rib_load)
    }),
    row("peak_pressure", (units::PASCAL, 1e9), "largest contact pressure of", |link| {
        link.rollers().map_or(0.0, |rollers| rollers.peak_pressure)
    }),
    row("loaded_rollers", (units::ONE, 10.0), "number of rollers that the inner race presses, of", |link| {
        link.rollers().map_or(0.0, |rollers| rollers.loaded as f64)
    }),
    row(
        "life.L10r",
        (units::ONE, 1e3),
        "reference rating life in million revolutions under the loads of this moment, of",
        |link| link.rollers().map_or(0.0, |rollers| rollers.life),
    ),
    row(
        "life.static_safety",
        (units::ONE, 1.0),
        "load that leaves a mark over that at the largest pressure of",
        |link| link.rollers().map_or(0.0, |rollers| rollers.static_safety),
    ),
];

/// [N m, N m, N m, W, m, -] friction of rollers; none of others.
fn friction(link: &LinkOutputs) -> FrictionOutputs {
    link.rollers().and_then(|rollers| rollers.friction).unwrap_or_default()
}

/// Those of a bearing by rollers that has friction.
const OF_FRICTION: &[LinkRow] = &[
    row(
        "friction_torque",
        MOMENT,
        "moment of friction that holds the rings back against each other, of",
        |link| friction(link).torque(),
    ),
    row("loss.total", POWER, "all power lost to friction of", |link| friction(link).loss),
    row("loss.rolling", POWER, "power lost to rolling resistance of the oil in", |link| {
        friction(link).loss_of(0)
    }),
    row("loss.ribs", POWER, "power lost to sliding of roller ends on ribs of", |link| {
        friction(link).loss_of(1)
    }),
    row("loss.drag", POWER, "power that rollers lose to what is around them in", |link| {
        friction(link).loss_of(2)
    }),
    row("film.thickness", (units::METRE, 1e-6), "least central film of a loaded line of", |link| {
        friction(link).film
    }),
    row("film.ratio", (units::ONE, 1.0), "least film of a loaded line over the roughness, of", |link| {
        friction(link).film_ratio
    }),
];

/// Those of a coupling alone.
const OF_COUPLING: &[LinkRow] = &[
    row("force.x", FORCE, "force on the first shaft, x component, axes of the shaft, of", |link| {
        link.state.force[0]
    }),
    row("force.y", FORCE, "force on the first shaft, y component, axes of the shaft, of", |link| {
        link.state.force[1]
    }),
    row("force.z", FORCE, "force on the first shaft, z component, axes of the shaft, of", |link| {
        link.state.force[2]
    }),
    row("moment.x", MOMENT, "moment on the first shaft, x component, axes of the shaft, of", |link| {
        link.state.force[3]
    }),
    row("moment.y", MOMENT, "moment on the first shaft, y component, axes of the shaft, of", |link| {
        link.state.force[4]
    }),
    row("moment.z", MOMENT, "moment on the first shaft, z component, axes of the shaft, of", |link| {
        link.state.force[5]
    }),
    row("twist", ANGLE, "turn of the first shaft against the second one, at", |link| {
        link.state.displacement[3]
    }),
];

/// Rows of a mesh.
pub const MESH: &[&[LinkRow]] = &[OF_MESH, ENERGIES];
/// Rows of a bearing by its stiffness.
pub const SPRING: &[&[LinkRow]] = &[OF_SPRING, ENERGIES];
/// Rows of a bearing by rollers.
pub const ROLLERS: &[&[LinkRow]] = &[OF_SPRING, OF_ROLLERS, ENERGIES];
/// Rows of one with friction.
pub const RUBBING: &[&[LinkRow]] = &[OF_SPRING, OF_ROLLERS, OF_FRICTION, ENERGIES];
/// Rows of a coupling.
pub const COUPLING: &[&[LinkRow]] = &[OF_COUPLING, ENERGIES];
