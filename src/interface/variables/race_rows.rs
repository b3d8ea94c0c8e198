//! The variables that each race has: one row each, with what reads it, what sets it, and when it is there.

use nalgebra::UnitQuaternion;

use super::Causality;
use super::race_setting::{InputAccess, InputKind, NORM_TOLERANCE, RaceMotion};
use crate::model::bodies::Race;
use crate::numerics::tilt;
use crate::scene::{Drive, Group, Orientation};
use crate::schema::variable_units::{self as units, Unit};
use crate::simulation::inputs::RaceInput;
use crate::simulation::outputs::RaceOutput;

/// A quantity of a race; a variable per component.
#[derive(Debug)]
pub struct RaceVariable {
    /// Name after that of the race.
    name: &'static str,
    /// Last part of the names; one that is empty for a scalar.
    pub components: &'static [&'static str],
    /// Unit.
    pub unit: Unit,
    /// \[unit] typical size.
    pub nominal: f64,
    /// \[unit] smallest and largest value, where there are some.
    pub limits: [Option<f64>; 2],
    /// One sentence, with `{race}` and `{component}` in it.
    description: &'static str,
    /// Causality by the motion of the race; none where there is no such variable.
    pub causality: fn(RaceMotion) -> Option<Causality>,
    /// \[unit] component as an output.
    pub read: fn(&RaceOutput, usize) -> f64,
    /// Access to the quantity as an input, where it can be one.
    pub input: Option<InputAccess>,
}

impl RaceVariable {
    /// Name of a component.
    pub fn name_of(&self, race: Race, component: usize) -> String {
        let (race, name, component) = (race.name(), self.name, self.components[component]);
        if component.is_empty() { format!("{race}.{name}") } else { format!("{race}.{name}.{component}") }
    }

    /// Description of a component.
    pub fn description_of(&self, race: Race, component: usize) -> String {
        self.description.replace("{race}", race.name()).replace("{component}", self.components[component])
    }
}

/// Rate of a pose, which has none of its own: it is the twist.
fn no_rate(_: &RaceInput, _: usize) -> f64 {
    0.0
}

const AXES: &[&str] = &["x", "y", "z"];
/// Those across the axis.
const ACROSS: &[&str] = &["y", "z"];
const SCALAR: &[&str] = &[""];
const NO_LIMITS: [Option<f64>; 2] = [None; 2];

/// All of them, in the order of their value references.
pub static RACE_VARIABLES: [RaceVariable; 18] = [
    RaceVariable {
        name: "position",
        components: AXES,
        unit: units::METRE,
        nominal: 1e-5,
        limits: NO_LIMITS,
        description: "position of the origin of the {race} race, {component} component, world axes",
        causality: RaceMotion::pose,
        read: |race, i| race.pose.position[i],
        input: Some(InputAccess {
            get: |race, i| race.pose.position[i],
            set: |race, i, value, _| race.input.pose.position[i] = value,
            rate: no_rate,
            kind: InputKind::Displacement,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "rotation",
        components: ACROSS,
        unit: units::RADIAN,
        nominal: 1e-3,
        limits: NO_LIMITS,
        description: "rotation vector that tilts the axis of the {race} race away from x, {component} component",
        causality: |motion| motion.pose_as(Orientation::Shaft),
        read: |race, i| tilt::coordinates(&race.pose.orientation)[i + 1],
        input: Some(InputAccess {
            get: |race, i| {
                race.axis.map_or_else(|| tilt::coordinates(&race.pose.orientation), |axis| axis.tilt)[i + 1]
            },
            set: |race, i, value, _| {
                race.axis.tilt[i + 1] = value;
                race.tilted = true;
            },
            rate: no_rate,
            kind: InputKind::Angle,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "orientation",
        components: &["w", "x", "y", "z"],
        unit: units::ONE,
        nominal: 1.0,
        // A quaternion a little longer than 1 is normalised.
        limits: [Some(-1.0 - NORM_TOLERANCE), Some(1.0 + NORM_TOLERANCE)],
        description: "orientation of the {race} race, unit quaternion component {component}",
        causality: |motion| motion.pose_as(Orientation::Quaternion),
        read: |race, i| quaternion(&race.pose.orientation, i),
        input: Some(InputAccess {
            get: |race, i| quaternion(&race.pose.orientation, i),
            set: |race, i, value, _| race.quaternion[i] = Some(value),
            rate: no_rate,
            kind: InputKind::Quaternion,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "angle",
        components: AXES,
        unit: units::RADIAN,
        nominal: 1e-3,
        limits: NO_LIMITS,
        description: "Cardan angle {component} of the {race} race: tilts y, z, then the turn x about its own axis, without limit",
        causality: |motion| motion.pose_as(Orientation::Cardan),
        read: |race, i| to_cardan(&race.pose.orientation, race.turned)[i],
        input: Some(InputAccess {
            get: |race, i| to_cardan(&race.pose.orientation, 0.0)[i],
            set: |race, i, value, _| race.angles[i] = Some(value),
            rate: no_rate,
            kind: InputKind::Angle,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "velocity",
        components: AXES,
        unit: units::METRE_PER_SECOND,
        nominal: 1e-3,
        limits: NO_LIMITS,
        description: "velocity of the origin of the {race} race, {component} component, world axes",
        causality: RaceMotion::pose,
        read: |race, i| race.twist.velocity[i],
        input: Some(InputAccess {
            get: |race, i| race.twist.velocity[i],
            set: |race, i, value, rate| {
                race.input.twist.velocity[i] = value;
                race.input.twist_rate.velocity[i] = rate;
            },
            rate: |race, i| race.twist_rate.velocity[i],
            kind: InputKind::Velocity,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "rotation_rate",
        components: ACROSS,
        unit: units::RADIAN_PER_SECOND,
        nominal: 1.0,
        limits: NO_LIMITS,
        description: "rate of the rotation vector of the {race} race's axis, {component} component",
        causality: |motion| motion.pose_as(Orientation::Shaft),
        read: |race, i| {
            tilt::rates(&tilt::coordinates(&race.pose.orientation), &race.twist.angular_velocity)[i + 1]
        },
        input: Some(InputAccess {
            get: |race, i| race.axis.map_or(0.0, |axis| axis.rate[i + 1]),
            set: |race, i, value, rate| {
                race.axis.rate[i + 1] = value;
                race.axis.acceleration[i + 1] = rate;
            },
            rate: |race, i| race.axis.map_or(0.0, |axis| axis.acceleration[i + 1]),
            kind: InputKind::AngularVelocity,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "angular_velocity",
        components: AXES,
        unit: units::RADIAN_PER_SECOND,
        nominal: 100.0,
        limits: NO_LIMITS,
        description: "angular velocity of the {race} race, {component} component, world axes",
        causality: |motion| motion.pose().filter(|_| motion.orientation != Orientation::Shaft),
        read: |race, i| race.twist.angular_velocity[i],
        input: Some(InputAccess {
            get: |race, i| race.twist.angular_velocity[i],
            set: |race, i, value, rate| {
                race.input.twist.angular_velocity[i] = value;
                race.input.twist_rate.angular_velocity[i] = rate;
            },
            rate: |race, i| race.twist_rate.angular_velocity[i],
            kind: InputKind::AngularVelocity,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "force",
        components: AXES,
        unit: units::NEWTON,
        nominal: 1e3,
        limits: NO_LIMITS,
        description: "force that the bearing exerts on the {race} race, {component} component, world axes",
        causality: |_| Some(Causality::Output),
        read: |race, i| race.wrench.force[i],
        input: None,
    },
    RaceVariable {
        name: "moment",
        components: AXES,
        unit: units::NEWTON_METRE,
        nominal: 1.0,
        limits: NO_LIMITS,
        description: "moment that the bearing exerts about the origin of the {race} race, {component} component, world axes",
        causality: |_| Some(Causality::Output),
        read: |race, i| race.wrench.moment[i],
        input: None,
    },
    RaceVariable {
        name: "reaction_force",
        components: AXES,
        unit: units::NEWTON,
        nominal: 1e3,
        limits: NO_LIMITS,
        description: "force of the hinge on the {race} race, {component} component, world axes",
        causality: |motion| motion.output(&[Drive::Hinge]),
        read: |race, i| race.reaction.force[i],
        input: None,
    },
    RaceVariable {
        name: "reaction_moment",
        components: AXES,
        unit: units::NEWTON_METRE,
        nominal: 1.0,
        limits: NO_LIMITS,
        description: "moment of the hinge and its drive about the origin of the {race} race, {component} component, world axes",
        causality: |motion| motion.output(&[Drive::Hinge]),
        read: |race, i| race.reaction.moment[i],
        input: None,
    },
    RaceVariable {
        name: "applied_force",
        components: AXES,
        unit: units::NEWTON,
        nominal: 1e3,
        limits: NO_LIMITS,
        description: "external force on the {race} race, {component} component, world axes",
        causality: |motion| motion.input(&[Drive::Wrench]),
        read: |_, _| 0.0,
        input: Some(InputAccess {
            get: |race, i| race.applied.force[i],
            set: |race, i, value, _| race.input.applied.force[i] = value,
            rate: no_rate,
            kind: InputKind::Force,
            group: Group::Loads,
        }),
    },
    RaceVariable {
        name: "applied_moment",
        components: AXES,
        unit: units::NEWTON_METRE,
        nominal: 1.0,
        limits: NO_LIMITS,
        description: "external moment about the origin of the {race} race, {component} component, world axes",
        causality: |motion| motion.input(&[Drive::Wrench]),
        read: |_, _| 0.0,
        input: Some(InputAccess {
            get: |race, i| race.applied.moment[i],
            set: |race, i, value, _| race.input.applied.moment[i] = value,
            rate: no_rate,
            kind: InputKind::Moment,
            group: Group::Loads,
        }),
    },
    RaceVariable {
        name: "speed",
        components: SCALAR,
        unit: units::RADIAN_PER_SECOND,
        nominal: 100.0,
        limits: NO_LIMITS,
        description: "prescribed spin of the {race} race about its own axis",
        causality: RaceMotion::speed,
        read: |_, _| 0.0,
        input: Some(InputAccess {
            get: |race, _| race.speed,
            set: |race, _, value, rate| {
                race.input.speed = value;
                race.axis.rate.x = value;
                race.axis.acceleration.x = rate;
            },
            rate: |race, _| race.axis.map_or(0.0, |axis| axis.acceleration.x),
            kind: InputKind::AngularVelocity,
            group: Group::Speeds,
        }),
    },
    RaceVariable {
        name: "turned",
        components: SCALAR,
        unit: units::RADIAN,
        nominal: 100.0,
        limits: NO_LIMITS,
        description: "turn of the {race} race about its own axis since the start",
        causality: |motion| motion.pose_as(Orientation::Shaft).map(|_| Causality::Output),
        read: |race, _| race.turned,
        input: None,
    },
    RaceVariable {
        name: "frame.position",
        components: AXES,
        unit: units::METRE,
        nominal: 1e-5,
        limits: NO_LIMITS,
        description: "position of the hinge of the {race} race, {component} component, world axes",
        causality: |motion| motion.input(&[Drive::Hinge]),
        read: |_, _| 0.0,
        input: Some(InputAccess {
            get: |race, i| race.frame.position[i],
            set: |race, i, value, _| race.input.frame.position[i] = value,
            rate: no_rate,
            kind: InputKind::Displacement,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "frame.rotation",
        components: ACROSS,
        unit: units::RADIAN,
        nominal: 1e-3,
        limits: NO_LIMITS,
        description: "rotation vector of the hinge of the {race} race, {component} component, beside its misalignment",
        causality: |motion| motion.input(&[Drive::Hinge]),
        read: |_, _| 0.0,
        input: Some(InputAccess {
            get: |race, i| race.frame.tilt[i + 1],
            set: |race, i, value, _| race.input.frame.tilt[i + 1] = value,
            rate: no_rate,
            kind: InputKind::Angle,
            group: Group::Tilts,
        }),
    },
    RaceVariable {
        name: "drive_torque",
        components: SCALAR,
        unit: units::NEWTON_METRE,
        nominal: 0.1,
        limits: NO_LIMITS,
        description: "torque that keeps the {race} race at its prescribed speed",
        causality: |motion| motion.output(&[Drive::Wrench, Drive::Hinge]),
        read: |race, _| race.drive_torque,
        input: None,
    },
];

/// Component w, x, y, z of a unit quaternion.
fn quaternion(orientation: &UnitQuaternion<f64>, component: usize) -> f64 {
    if component == 0 { orientation.w } else { orientation.imag()[component - 1] }
}

/// Cardan angles of an orientation; x is the one nearest to `turned` \[rad].
fn to_cardan(orientation: &UnitQuaternion<f64>, turned: f64) -> [f64; 3] {
    let m = orientation.to_rotation_matrix();
    let z = m[(1, 0)].clamp(-1.0, 1.0).asin();
    let y = (-m[(2, 0)]).atan2(m[(0, 0)]);
    let x = (-m[(1, 2)]).atan2(m[(1, 1)]);
    let turns = ((turned - x) / std::f64::consts::TAU).round();
    [x + turns * std::f64::consts::TAU, y, z]
}
