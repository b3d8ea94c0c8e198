//! The one table of variables: names, units, causality, and how each is read and set.
//!
//! Model description, value references, CSV headers and the documentation of a package all derive from it.

mod rows;
pub mod units;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::numerics::motion::{Pose, Twist, Wrench};
use crate::scene::parameters::Parameter;
use crate::scene::{Orientation, Scene};
use crate::simulation::inputs::{Inputs, RaceInput};
use crate::simulation::outputs::{BallOutput, CageOutput, ContactOutput, Outputs, RaceOutput};
use units::Unit;

/// FMI causality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Set by the importer.
    Input,
    /// Read by the importer.
    Output,
    /// A number of the scene, set by the importer before the start or, if tunable, between steps.
    Parameter,
}

/// FMI type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `fmi2Real`.
    Real,
    /// `fmi2Integer`.
    Integer,
}

/// Which of the two races.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Race {
    /// Inner race.
    Inner,
    /// Outer race.
    Outer,
}

impl Race {
    /// First part of its variables' names.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Inner => "inner",
            Self::Outer => "outer",
        }
    }
}

/// A quantity of a race, with its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RaceQuantity {
    /// Position of the race frame's origin.
    Position(usize),
    /// Quaternion component w, x, y, z.
    Orientation(usize),
    /// Cardan angle.
    Angle(usize),
    /// Velocity of the origin.
    Velocity(usize),
    /// Angular velocity.
    AngularVelocity(usize),
    /// Force of the bearing on the race.
    Force(usize),
    /// Moment of the bearing on the race.
    Moment(usize),
    /// External force.
    AppliedForce(usize),
    /// External moment.
    AppliedMoment(usize),
    /// Prescribed spin speed.
    Speed,
    /// Torque that keeps it.
    DriveTorque,
    /// Force of the hinge on the race.
    ReactionForce(usize),
    /// Moment of the hinge on the race.
    ReactionMoment(usize),
}

/// A component of the condensed stiffness or damping: row of the load, column of the displacement or velocity; force
/// or translation x, y, z first, then moment or rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coefficient {
    /// Load by displacement.
    Stiffness(usize, usize),
    /// Load by velocity.
    Damping(usize, usize),
}

type FromOutputs = fn(&Outputs) -> f64;
type FromCage = fn(&CageOutput) -> f64;
type FromBall = fn(&BallOutput) -> f64;
type FromContact = fn(&ContactOutput) -> f64;

/// Where a variable's value comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// A race.
    Race(Race, RaceQuantity),
    /// The friction coefficient.
    Friction,
    /// The bearing as a whole.
    Bearing(FromOutputs),
    /// Stiffness or damping of the running bearing.
    Condensed(Coefficient),
    /// The cage.
    Cage(FromCage),
    /// A ball.
    Ball(usize, FromBall),
    /// A ball's contact with a race.
    Contact(usize, Race, FromContact),
    /// A number of the scene, and its value there.
    Parameter(&'static Parameter, f64),
}

/// One variable.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Structured name.
    pub name: String,
    /// Unit.
    pub unit: Unit,
    /// Real or integer.
    pub kind: Kind,
    /// Input or output.
    pub causality: Causality,
    /// [unit] typical size.
    pub nominal: f64,
    /// [unit] smallest and largest value, where there are some.
    pub limits: [Option<f64>; 2],
    /// One sentence.
    pub description: String,
    /// Where the value comes from.
    pub source: Source,
}

/// Why an input was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum InputError {
    /// NaN or infinite.
    #[error("{name} = {value} is not a finite number")]
    NotFinite {
        /// Variable.
        name: String,
        /// Value.
        value: f64,
    },
    /// The quaternion is not near unit length.
    #[error("{name} has norm {norm}: a unit quaternion is expected, to within 0.001")]
    Quaternion {
        /// Variable without component.
        name: String,
        /// [-] its norm.
        norm: f64,
    },
    /// A negative friction coefficient, or one that no surface has.
    #[error("friction = {0} is out of range: allowed is [0, 2]")]
    Friction(f64),
}

/// [-] deviation of a quaternion's norm from 1 that is corrected; more is refused.
const NORM_TOLERANCE: f64 = 1e-3;
/// [-] largest friction coefficient that an importer may give.
const MAX_FRICTION: f64 = 2.0;

/// The table of a scene.
#[derive(Clone, Debug)]
pub struct Variables {
    rows: Vec<Variable>,
    cardan: bool,
}

impl Variables {
    /// The variables of a scene's package.
    pub fn new(scene: &Scene) -> Self {
        let mut table = Self::moving(scene, scene.effects.per_ball_outputs);
        table.add_parameters(scene);
        table
    }

    /// What can change in a run, with or without every ball.
    pub fn moving(scene: &Scene, per_ball: bool) -> Self {
        let cardan = scene.interface.orientation == Orientation::Cardan;
        let mut table = Self { rows: vec![], cardan };
        table.add_race(Race::Inner, scene.inner.drive);
        table.add_race(Race::Outer, scene.outer.drive);
        table.add_bearing();
        if scene.effects.stiffness_outputs {
            table.add_condensed();
        }
        if let Some(cage) = &scene.cage {
            table.add_cage(cage.guided_by);
        }
        if per_ball {
            for ball in 0..scene.bearing.balls {
                table.add_ball(ball, scene.effects.cage);
            }
        }
        table
    }

    /// Rows; the index of a row is its value reference.
    pub fn rows(&self) -> &[Variable] {
        &self.rows
    }

    /// Value of a row: inputs from the inputs as set, outputs from the outputs.
    pub fn value(&self, row: &Variable, inputs: &Inputs, outputs: &Outputs) -> f64 {
        match row.source {
            Source::Friction => inputs.friction,
            Source::Parameter(_, value) => value,
            Source::Bearing(get) => get(outputs),
            Source::Condensed(coefficient) => outputs.condensed.as_ref().map_or(0.0, |c| match coefficient {
                Coefficient::Stiffness(i, k) => c.stiffness[(i, k)],
                Coefficient::Damping(i, k) => c.damping[(i, k)],
            }),
            Source::Cage(get) => outputs.cage.as_ref().map_or(0.0, get),
            Source::Ball(ball, get) => outputs.balls.get(ball).map_or(0.0, get),
            Source::Contact(ball, race, get) => outputs
                .balls
                .get(ball)
                .map_or(0.0, |ball| get(if race == Race::Inner { &ball.inner } else { &ball.outer })),
            Source::Race(race, quantity) => {
                let (input, output) = match race {
                    Race::Inner => (&inputs.inner, &outputs.inner),
                    Race::Outer => (&inputs.outer, &outputs.outer),
                };
                match row.causality {
                    Causality::Input => {
                        race_value(quantity, &input.pose, &input.twist, &input.applied, input, output, 0.0)
                    }
                    Causality::Output | Causality::Parameter => {
                        let (pose, twist) = (&output.pose, &output.twist);
                        race_value(quantity, pose, twist, &output.wrench, input, output, output.turned)
                    }
                }
            }
        }
    }

    /// Start values of all rows.
    pub fn values(&self, inputs: &Inputs, outputs: &Outputs) -> Vec<f64> {
        self.rows.iter().map(|row| self.value(row, inputs, outputs)).collect()
    }

    /// Writes the parameters among the values of all rows into a scene.
    pub fn set_parameters(&self, scene: &mut Scene, values: &[f64]) {
        for (row, value) in self.rows.iter().zip(values) {
            if let Source::Parameter(parameter, _) = row.source {
                parameter.set(scene, *value);
            }
        }
    }

    /// Is a parameter among the values of all rows different?
    pub fn parameters_differ(&self, one: &[f64], other: &[f64]) -> bool {
        let differs = |((row, one), other): ((&Variable, &f64), &f64)| {
            row.causality == Causality::Parameter && one != other
        };
        self.rows.iter().zip(one).zip(other).any(differs)
    }

    /// Rates of all rows that inputs were given with: those of a twist.
    pub fn rates(&self, inputs: &Inputs) -> Vec<f64> {
        let rate = |row: &Variable| match row.source {
            Source::Race(race, quantity) if row.causality == Causality::Input => {
                let rate = match race {
                    Race::Inner => &inputs.inner.twist_rate,
                    Race::Outer => &inputs.outer.twist_rate,
                };
                match quantity {
                    RaceQuantity::Velocity(i) => rate.velocity[i],
                    RaceQuantity::AngularVelocity(i) => rate.angular_velocity[i],
                    _ => 0.0,
                }
            }
            _ => 0.0,
        };
        self.rows.iter().map(rate).collect()
    }

    /// Turns the values of all rows (those of outputs are ignored) and their rates into inputs, on top of `base`.
    ///
    /// # Errors
    /// If a value is not finite, a quaternion far from unit length, or friction out of range; names the variable.
    pub fn inputs(&self, values: &[f64], rates: &[f64], base: &Inputs) -> Result<Inputs, InputError> {
        let mut inputs = *base;
        let mut components = [[None::<f64>; 4]; 2];
        for ((row, &value), &rate) in self.rows.iter().zip(values).zip(rates) {
            if row.causality != Causality::Input {
                continue;
            }
            for number in [value, rate] {
                if !number.is_finite() {
                    return Err(InputError::NotFinite { name: row.name.clone(), value: number });
                }
            }
            match row.source {
                Source::Friction if (0.0..=MAX_FRICTION).contains(&value) => inputs.friction = value,
                Source::Friction => return Err(InputError::Friction(value)),
                Source::Race(race, quantity) => {
                    let (input, index) = match race {
                        Race::Inner => (&mut inputs.inner, 0),
                        Race::Outer => (&mut inputs.outer, 1),
                    };
                    match quantity {
                        RaceQuantity::Orientation(i) | RaceQuantity::Angle(i) => {
                            components[index][i] = Some(value);
                        }
                        other => set_race_value(other, value, rate, input),
                    }
                }
                Source::Bearing(_)
                | Source::Condensed(_)
                | Source::Cage(_)
                | Source::Ball(..)
                | Source::Contact(..)
                | Source::Parameter(..) => {}
            }
        }
        for (index, name) in [(0, "inner"), (1, "outer")] {
            let input = if index == 0 { &mut inputs.inner } else { &mut inputs.outer };
            match components[index] {
                [Some(w), Some(x), Some(y), Some(z)] => {
                    let quaternion = Quaternion::new(w, x, y, z);
                    let norm = quaternion.norm();
                    if (norm - 1.0).abs() > NORM_TOLERANCE {
                        return Err(InputError::Quaternion { name: format!("{name}.orientation"), norm });
                    }
                    input.pose.orientation = UnitQuaternion::new_normalize(quaternion);
                }
                [Some(x), Some(y), Some(z), None] => input.pose.orientation = from_cardan(x, y, z),
                _ => {}
            }
        }
        Ok(inputs)
    }
}

/// Orientation of Cardan angles, intrinsic x-y-z: `R = Rx(x) Ry(y) Rz(z)`.
fn from_cardan(x: f64, y: f64, z: f64) -> UnitQuaternion<f64> {
    let turn = |axis: Vector3<f64>, angle: f64| UnitQuaternion::new(axis * angle);
    turn(Vector3::x(), x) * turn(Vector3::y(), y) * turn(Vector3::z(), z)
}

/// Cardan angles of an orientation; the first is the one nearest to `turned` [rad].
fn to_cardan(orientation: &UnitQuaternion<f64>, turned: f64) -> [f64; 3] {
    let m = orientation.to_rotation_matrix();
    let y = m[(0, 2)].clamp(-1.0, 1.0).asin();
    let x = (-m[(1, 2)]).atan2(m[(2, 2)]);
    let z = (-m[(0, 1)]).atan2(m[(0, 0)]);
    let turns = ((turned - x) / std::f64::consts::TAU).round();
    [x + turns * std::f64::consts::TAU, y, z]
}

fn race_value(
    quantity: RaceQuantity,
    pose: &Pose,
    twist: &Twist,
    wrench: &Wrench,
    input: &RaceInput,
    output: &RaceOutput,
    turned: f64,
) -> f64 {
    match quantity {
        RaceQuantity::Position(i) => pose.position[i],
        RaceQuantity::Orientation(0) => pose.orientation.w,
        RaceQuantity::Orientation(i) => pose.orientation.imag()[i - 1],
        RaceQuantity::Angle(i) => to_cardan(&pose.orientation, turned)[i],
        RaceQuantity::Velocity(i) => twist.velocity[i],
        RaceQuantity::AngularVelocity(i) => twist.angular_velocity[i],
        RaceQuantity::Force(i) | RaceQuantity::AppliedForce(i) => wrench.force[i],
        RaceQuantity::Moment(i) | RaceQuantity::AppliedMoment(i) => wrench.moment[i],
        RaceQuantity::Speed => input.speed,
        RaceQuantity::DriveTorque => output.drive_torque,
        RaceQuantity::ReactionForce(i) => output.reaction.force[i],
        RaceQuantity::ReactionMoment(i) => output.reaction.moment[i],
    }
}

/// Sets an input other than an orientation. A rate says how the velocity goes on; those of positions and angles are
/// what the twist says already.
fn set_race_value(quantity: RaceQuantity, value: f64, rate: f64, input: &mut RaceInput) {
    match quantity {
        RaceQuantity::Position(i) => input.pose.position[i] = value,
        RaceQuantity::Velocity(i) => {
            input.twist.velocity[i] = value;
            input.twist_rate.velocity[i] = rate;
        }
        RaceQuantity::AngularVelocity(i) => {
            input.twist.angular_velocity[i] = value;
            input.twist_rate.angular_velocity[i] = rate;
        }
        RaceQuantity::AppliedForce(i) => input.applied.force[i] = value,
        RaceQuantity::AppliedMoment(i) => input.applied.moment[i] = value,
        RaceQuantity::Speed => input.speed = value,
        RaceQuantity::Orientation(_)
        | RaceQuantity::Angle(_)
        | RaceQuantity::Force(_)
        | RaceQuantity::Moment(_)
        | RaceQuantity::DriveTorque
        | RaceQuantity::ReactionForce(_)
        | RaceQuantity::ReactionMoment(_) => {}
    }
}
