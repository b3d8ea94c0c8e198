//! The one table of variables: names, units, causality, and how each is read and set.
//!
//! Model description, value references, CSV headers and the documentation of a package all derive from it.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::motion::{Pose, Twist, Wrench};
use crate::outputs::{BallOutput, ContactOutput, Outputs, RaceOutput};
use crate::scene::{Drive, Orientation, Scene};
use crate::simulation::{Inputs, RaceInput};

/// A unit with its SI dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Name as written in the model description.
    pub name: &'static str,
    /// Exponents of kg, m, s, rad.
    pub exponents: [i8; 4],
    /// Display unit and how many of it make one unit, where another one is customary.
    pub display: Option<(&'static str, f64)>,
}

const fn unit(name: &'static str, exponents: [i8; 4]) -> Unit {
    Unit {
        name,
        exponents,
        display: None,
    }
}

const fn shown(name: &'static str, exponents: [i8; 4], display: &'static str, factor: f64) -> Unit {
    Unit {
        name,
        exponents,
        display: Some((display, factor)),
    }
}

/// All units in use.
pub mod units {
    use super::{Unit, shown, unit};

    const DEGREE: f64 = 180.0 / std::f64::consts::PI;
    /// Pure number.
    pub const ONE: Unit = unit("1", [0, 0, 0, 0]);
    /// Position.
    pub const METRE: Unit = shown("m", [0, 1, 0, 0], "um", 1e6);
    /// Velocity.
    pub const METRE_PER_SECOND: Unit = unit("m/s", [0, 1, -1, 0]);
    /// Angle.
    pub const RADIAN: Unit = shown("rad", [0, 0, 0, 1], "deg", DEGREE);
    /// Angular velocity.
    pub const RADIAN_PER_SECOND: Unit = shown("rad/s", [0, 0, -1, 1], "rev/min", 30.0 / std::f64::consts::PI);
    /// Force.
    pub const NEWTON: Unit = unit("N", [1, 1, -2, 0]);
    /// Moment.
    pub const NEWTON_METRE: Unit = unit("N.m", [1, 2, -2, 0]);
    /// Power.
    pub const WATT: Unit = unit("W", [1, 2, -3, 0]);
    /// Energy.
    pub const JOULE: Unit = unit("J", [1, 2, -2, 0]);
    /// Pressure.
    pub const PASCAL: Unit = shown("Pa", [1, -1, -2, 0], "MPa", 1e-6);
    /// Spin creepage.
    pub const PER_METRE: Unit = unit("1/m", [0, -1, 0, 0]);
    /// Time.
    pub const SECOND: Unit = unit("s", [0, 0, 1, 0]);
    /// Every unit, in the order of the model description.
    pub const ALL: [Unit; 12] = [
        ONE,
        METRE,
        METRE_PER_SECOND,
        RADIAN,
        RADIAN_PER_SECOND,
        NEWTON,
        NEWTON_METRE,
        WATT,
        JOULE,
        PASCAL,
        PER_METRE,
        SECOND,
    ];
}

/// FMI causality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Set by the importer.
    Input,
    /// Read by the importer.
    Output,
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
}

type FromOutputs = fn(&Outputs) -> f64;
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
    /// A ball.
    Ball(usize, FromBall),
    /// A ball's contact with a race.
    Contact(usize, Race, FromContact),
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
const AXES: [&str; 3] = ["x", "y", "z"];

/// The table of a scene.
#[derive(Clone, Debug)]
pub struct Variables {
    rows: Vec<Variable>,
    cardan: bool,
}

impl Variables {
    /// The variables of a scene's package.
    pub fn new(scene: &Scene) -> Self {
        Self::with_balls(scene, scene.effects.per_ball_outputs)
    }

    /// The variables of a scene, with or without those of every ball.
    pub fn with_balls(scene: &Scene, per_ball: bool) -> Self {
        let cardan = scene.interface.orientation == Orientation::Cardan;
        let mut table = Self { rows: vec![], cardan };
        table.add_race(Race::Inner, scene.inner.drive);
        table.add_race(Race::Outer, scene.outer.drive);
        table.add_bearing();
        if per_ball {
            for ball in 0..scene.bearing.balls {
                table.add_ball(ball);
            }
        }
        table
    }

    /// Rows; the index of a row is its value reference.
    pub fn rows(&self) -> &[Variable] {
        &self.rows
    }

    fn add(
        &mut self,
        name: String,
        unit: Unit,
        causality: Causality,
        nominal: f64,
        description: String,
        source: Source,
    ) {
        self.rows.push(Variable {
            name,
            unit,
            kind: Kind::Real,
            causality,
            nominal,
            description,
            source,
        });
    }

    fn add_race(&mut self, race: Race, drive: Drive) {
        use RaceQuantity as Q;
        let prefix = if race == Race::Inner { "inner" } else { "outer" };
        let motion = match drive {
            Drive::Pose => Some(Causality::Input),
            Drive::Wrench => Some(Causality::Output),
            Drive::Fixed => None,
        };
        let mut vector = |quantity: fn(usize) -> Q, name: &str, unit, causality, nominal, what: &str| {
            for (i, axis) in AXES.iter().enumerate() {
                let description = format!("{what} of the {prefix} race, {axis} component, world axes");
                let source = Source::Race(race, quantity(i));
                self.add(
                    format!("{prefix}.{name}.{axis}"),
                    unit,
                    causality,
                    nominal,
                    description,
                    source,
                );
            }
        };
        if let Some(causality) = motion {
            vector(
                Q::Position,
                "position",
                units::METRE,
                causality,
                1e-5,
                "position of the origin",
            );
        }
        if let Some(causality) = motion {
            self.add_orientation(race, prefix, causality);
        }
        let mut vector = |quantity: fn(usize) -> Q, name: &str, unit, causality, nominal, what: &str| {
            for (i, axis) in AXES.iter().enumerate() {
                let description = format!("{what} {prefix} race, {axis} component, world axes");
                let source = Source::Race(race, quantity(i));
                self.add(
                    format!("{prefix}.{name}.{axis}"),
                    unit,
                    causality,
                    nominal,
                    description,
                    source,
                );
            }
        };
        if let Some(causality) = motion {
            let (linear, angular) = (units::METRE_PER_SECOND, units::RADIAN_PER_SECOND);
            vector(
                Q::Velocity,
                "velocity",
                linear,
                causality,
                1e-3,
                "velocity of the origin of the",
            );
            vector(
                Q::AngularVelocity,
                "angular_velocity",
                angular,
                causality,
                100.0,
                "angular velocity of the",
            );
        }
        let output = Causality::Output;
        vector(
            Q::Force,
            "force",
            units::NEWTON,
            output,
            1e3,
            "force that the bearing exerts on the",
        );
        let about = "moment that the bearing exerts about the origin of the";
        vector(Q::Moment, "moment", units::NEWTON_METRE, output, 1.0, about);
        if drive == Drive::Wrench {
            let input = Causality::Input;
            vector(
                Q::AppliedForce,
                "applied_force",
                units::NEWTON,
                input,
                1e3,
                "external force on the",
            );
            let about = "external moment about the origin of the";
            vector(
                Q::AppliedMoment,
                "applied_moment",
                units::NEWTON_METRE,
                input,
                1.0,
                about,
            );
            let speed = format!("prescribed spin of the {prefix} race about its own axis");
            let source = Source::Race(race, Q::Speed);
            self.add(
                format!("{prefix}.speed"),
                units::RADIAN_PER_SECOND,
                input,
                100.0,
                speed,
                source,
            );
            let torque = format!("torque that keeps the {prefix} race at its prescribed speed");
            let source = Source::Race(race, Q::DriveTorque);
            self.add(
                format!("{prefix}.drive_torque"),
                units::NEWTON_METRE,
                output,
                0.1,
                torque,
                source,
            );
        }
    }

    fn add_orientation(&mut self, race: Race, prefix: &str, causality: Causality) {
        if self.cardan {
            for (i, axis) in AXES.iter().enumerate() {
                let description =
                    format!("Cardan angle {axis} of the {prefix} race, intrinsic x-y-z (x without limit)");
                let source = Source::Race(race, RaceQuantity::Angle(i));
                let name = format!("{prefix}.angle.{axis}");
                self.add(name, units::RADIAN, causality, 1e-3, description, source);
            }
        } else {
            for (i, component) in ["w", "x", "y", "z"].iter().enumerate() {
                let description =
                    format!("orientation of the {prefix} race, unit quaternion component {component}");
                let source = Source::Race(race, RaceQuantity::Orientation(i));
                let name = format!("{prefix}.orientation.{component}");
                self.add(name, units::ONE, causality, 1.0, description, source);
            }
        }
    }

    fn add_bearing(&mut self) {
        let friction = "friction coefficient of the ball-race contacts".to_string();
        self.add(
            "friction".into(),
            units::ONE,
            Causality::Input,
            0.1,
            friction,
            Source::Friction,
        );
        let mut output = |name: &str, unit, nominal, description: &str, get: FromOutputs| {
            let source = Source::Bearing(get);
            self.add(
                name.into(),
                unit,
                Causality::Output,
                nominal,
                description.into(),
                source,
            );
        };
        output(
            "cage.speed",
            units::RADIAN_PER_SECOND,
            100.0,
            "mean orbital speed of the balls",
            |o| o.cage_speed,
        );
        let slip = "1 - cage speed over its epicyclic value";
        output("cage.slip", units::ONE, 1e-2, slip, |o| o.cage_slip);
        let power = "power lost to friction in all contacts";
        output("friction_power", units::WATT, 1.0, power, |o| o.friction_power);
        let power = "power lost to contact damping";
        output("damping_power", units::WATT, 1e-2, power, |o| o.damping_power);
        let torque = "friction torque against the rotation of the inner race";
        output("friction_torque", units::NEWTON_METRE, 0.1, torque, |o| {
            o.friction_torque
        });
        output(
            "energy.stored",
            units::JOULE,
            1.0,
            "kinetic and elastic energy",
            |o| o.stored_energy,
        );
        output(
            "energy.work",
            units::JOULE,
            1.0,
            "work put in since the start",
            |o| o.work,
        );
        output(
            "energy.dissipated",
            units::JOULE,
            1.0,
            "energy lost since the start",
            |o| o.dissipated,
        );
        let mut count = |name: &str, description: &str, get: FromOutputs| {
            self.rows.push(Variable {
                name: name.into(),
                unit: units::ONE,
                kind: Kind::Integer,
                causality: Causality::Output,
                nominal: 1.0,
                description: description.into(),
                source: Source::Bearing(get),
            });
        };
        count("integrator.steps", "accepted steps since the start", |o| {
            o.statistics.steps as f64
        });
        count("integrator.rejections", "rejected steps since the start", |o| {
            (o.statistics.rejected_error + o.statistics.rejected_newton) as f64
        });
        count(
            "integrator.newton_iterations",
            "Newton iterations since the start",
            |o| o.statistics.newton.iterations as f64,
        );
    }

    fn add_ball(&mut self, index: usize) {
        let number = index + 1;
        let mut output = |name: &str, unit, nominal, what: &str, get: FromBall| {
            let (name, description) = (
                format!("ball[{number}].{name}"),
                format!("{what} of ball {number}"),
            );
            self.add(
                name,
                unit,
                Causality::Output,
                nominal,
                description,
                Source::Ball(index, get),
            );
        };
        output("azimuth", units::RADIAN, 1.0, "azimuth from +y towards +z", |b| {
            b.azimuth
        });
        output(
            "orbital_speed",
            units::RADIAN_PER_SECOND,
            100.0,
            "orbital speed",
            |b| b.orbital_speed,
        );
        for (race, name) in [(Race::Inner, "inner"), (Race::Outer, "outer")] {
            let mut output = |quantity: &str, unit, nominal, what: &str, get: FromContact| {
                let description = format!("{what} of ball {number} and the {name} race");
                let source = Source::Contact(index, race, get);
                let name = format!("ball[{number}].{name}.{quantity}");
                self.add(name, unit, Causality::Output, nominal, description, source);
            };
            output("load", units::NEWTON, 100.0, "normal load", |c| c.load);
            output("contact_angle", units::RADIAN, 0.1, "contact angle", |c| {
                c.contact_angle
            });
            let what = "longitudinal creepage";
            output("creepage_longitudinal", units::ONE, 1e-3, what, |c| {
                c.creepage_longitudinal
            });
            output("creepage_lateral", units::ONE, 1e-3, "lateral creepage", |c| {
                c.creepage_lateral
            });
            output("creepage_spin", units::PER_METRE, 10.0, "spin creepage", |c| {
                c.creepage_spin
            });
            let what = "longitudinal creep force on the ball";
            output("force_longitudinal", units::NEWTON, 1.0, what, |c| {
                c.force_longitudinal
            });
            output(
                "force_lateral",
                units::NEWTON,
                1.0,
                "lateral creep force on the ball",
                |c| c.force_lateral,
            );
            output(
                "spin_moment",
                units::NEWTON_METRE,
                1e-3,
                "spin moment on the ball",
                |c| c.spin_moment,
            );
            output("power", units::WATT, 0.1, "power lost to friction", |c| c.power);
            output("peak_pressure", units::PASCAL, 1e9, "peak pressure", |c| {
                c.peak_pressure
            });
        }
    }

    /// Value of a row: inputs from the inputs as set, outputs from the outputs.
    pub fn value(&self, row: &Variable, inputs: &Inputs, outputs: &Outputs) -> f64 {
        match row.source {
            Source::Friction => inputs.friction,
            Source::Bearing(get) => get(outputs),
            Source::Ball(ball, get) => outputs.balls.get(ball).map_or(0.0, get),
            Source::Contact(ball, race, get) => outputs.balls.get(ball).map_or(0.0, |ball| {
                get(if race == Race::Inner {
                    &ball.inner
                } else {
                    &ball.outer
                })
            }),
            Source::Race(race, quantity) => {
                let (input, output) = match race {
                    Race::Inner => (&inputs.inner, &outputs.inner),
                    Race::Outer => (&inputs.outer, &outputs.outer),
                };
                match row.causality {
                    Causality::Input => race_value(
                        quantity,
                        &input.pose,
                        &input.twist,
                        &input.applied,
                        input,
                        output,
                        0.0,
                    ),
                    Causality::Output => {
                        let (pose, twist) = (&output.pose, &output.twist);
                        race_value(
                            quantity,
                            pose,
                            twist,
                            &output.wrench,
                            input,
                            output,
                            output.turned,
                        )
                    }
                }
            }
        }
    }

    /// Start values of all rows.
    pub fn values(&self, inputs: &Inputs, outputs: &Outputs) -> Vec<f64> {
        self.rows
            .iter()
            .map(|row| self.value(row, inputs, outputs))
            .collect()
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
                    return Err(InputError::NotFinite {
                        name: row.name.clone(),
                        value: number,
                    });
                }
            }
            match row.source {
                Source::Friction if (0.0..=2.0).contains(&value) => inputs.friction = value,
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
                Source::Bearing(_) | Source::Ball(..) | Source::Contact(..) => {}
            }
        }
        for (index, name) in [(0, "inner"), (1, "outer")] {
            let input = if index == 0 {
                &mut inputs.inner
            } else {
                &mut inputs.outer
            };
            match components[index] {
                [Some(w), Some(x), Some(y), Some(z)] => {
                    let quaternion = Quaternion::new(w, x, y, z);
                    let norm = quaternion.norm();
                    if (norm - 1.0).abs() > NORM_TOLERANCE {
                        return Err(InputError::Quaternion {
                            name: format!("{name}.orientation"),
                            norm,
                        });
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
        | RaceQuantity::DriveTorque => {}
    }
}
