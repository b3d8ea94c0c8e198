//! A body that forces move, in one trial step: motion from its unknown accelerations, residual, constraints.

use nalgebra::{DMatrix, DVector, Matrix6, UnitQuaternion, Vector3};

use super::directions::{D, SECOND_ROTATION, by_first, by_second, by_second_unknown, constant_race};
use super::reaction::Reaction;
use crate::contact::RaceMotion;
use crate::contact::body::BodyMotion;
use crate::model::bodies::{Bodies, Constraint, PerRace, Race, RigidBody, tilt_component, tilt_direction};
use crate::model::state::{BodyState, normalised};
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::{FrameInput, Pose, Wrench};
use crate::numerics::rotation::{from_rotation_vector, rotate, to_quaternion, turn};
use crate::numerics::scalar::{Scalar, constant_vector, values};
use crate::numerics::size::larger;

/// [rad/s] accepted violation of a speed constraint (paper section 5).
const SPEED_TOLERANCE: f64 = 1e-8;

/// Load and drive on a body from outside the bearing at the end of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyLoad {
    /// Where the frame of a race on a hinge is.
    pub frame: FrameInput,
    /// Applied wrench and weight, world axes.
    pub applied: Wrench,
    /// [rad/s] prescribed spin speed.
    pub speed: f64,
}

/// Lengths and time that a body's equations are scaled with.
#[derive(Clone, Copy, Debug)]
pub struct BodyScales {
    /// \[m] turns moments into forces.
    pub length: f64,
    /// \[m] accepted violation of a position constraint.
    pub length_tolerance: f64,
    /// \[s] end of the step.
    pub time: f64,
}

/// A body in a trial step. The rotation of the step is a conformal vector (paper section 2).
#[derive(Clone, Debug)]
pub struct BodyTrial {
    /// State at the end of the step.
    pub end: BodyState,
    /// Unknowns that [`BodyTrial::move_to`] was given.
    pub unknowns: Vec<f64>,
    /// Residual rows: force, moment over `length`, then constraints over their gains.
    pub residual: DVector<f64>,
    /// [-] largest constraint violation over its tolerance.
    pub violation: f64,
    /// \[W] power of applied loads and constraints at the end of the step.
    pub input_power: f64,
    /// Tangent of the residual by accelerations (angular ones times `length`) and multipliers (moments over `length`).
    pub block: DMatrix<f64>,
    /// Motion as the balls see it, with derivatives by the rotation.
    pub motion: RaceMotion<D>,
    /// Rotation vector of the step, with derivatives.
    rotation: Vector3<D>,
    /// Material angular velocity and acceleration, with derivatives.
    rate: Vector3<D>,
    rate_derivative: Vector3<D>,
    start_orientation: UnitQuaternion<f64>,
}

impl BodyTrial {
    /// Buffers for a body, as at the start of a step.
    pub fn new(body: &RigidBody, start: &BodyState) -> Self {
        let rows = 6 + body.constraints.len();
        let zero = constant_vector(&Vector3::zeros());
        Self {
            end: start.clone(),
            unknowns: vec![0.0; rows],
            residual: DVector::zeros(rows),
            violation: 0.0,
            input_power: 0.0,
            block: DMatrix::zeros(rows, rows),
            motion: constant_race(&start.motion()),
            rotation: zero,
            rate: zero,
            rate_derivative: zero,
            start_orientation: start.pose.orientation,
        }
    }

    /// Motion at the end of the step: `unknowns` are acceleration [m/s2], material angular acceleration times
    /// `length` [m/s2], multipliers [N, N m over `length`].
    pub fn move_to(&mut self, unknowns: &[f64], start: &BodyState, step: &HhtStep, length: f64) {
        self.unknowns.copy_from_slice(unknowns);
        let acceleration = Vector3::from_row_slice(&unknowns[0..3]);
        let angular = Vector3::from_row_slice(&unknowns[3..6]) / length;
        self.end.acceleration = acceleration;
        self.end.velocity = step.velocity(&start.velocity, &start.acceleration, &acceleration);
        let position =
            start.pose.position + step.displacement(&start.velocity, &start.acceleration, &acceleration);
        // Newmark's formulas on the material rate, whose increment is a rotation vector of the step (Bruls, Cardona and
        // Arnold 2012): a steady spin is then an exact solution. With c'' as the unknown it is not, since c' grows
        // with c although the speed is constant; at 6000 rpm and 10 us that made the drive torque 2 % too low.
        let turn_vector = step.displacement(&start.rate, &start.rate_derivative, &angular);
        let rate = step.velocity(&start.rate, &start.rate_derivative, &angular);
        let variable = |v: &Vector3<f64>, gain: f64| {
            Vector3::from_fn(|i, _| D::variable(v[i], SECOND_ROTATION + i, gain))
        };
        self.rotation = from_rotation_vector(&variable(&turn_vector, step.position_gain() / length));
        self.rate = variable(&rate, step.velocity_gain() / length);
        self.rate_derivative = variable(&angular, 1.0 / length);
        self.start_orientation = start.pose.orientation;
        let orientation = normalised(start.pose.orientation * to_quaternion(&values(&self.rotation)));
        self.end.pose = Pose { position, orientation };
        self.end.rate = values(&self.rate);
        self.end.rate_derivative = values(&self.rate_derivative);
        let spatial = |v: &Vector3<D>| turn(&start.pose.orientation, &rotate(&self.rotation, v));
        self.motion = RaceMotion {
            position: constant_vector(&position),
            axis: spatial(&constant_vector(&Vector3::x())),
            across: orientation * Vector3::y(),
            velocity: constant_vector(&self.end.velocity),
            angular_velocity: spatial(&self.rate),
        };
    }

    /// Motion as the balls see it.
    pub fn motion_value(&self) -> RaceMotion<f64> {
        RaceMotion {
            position: self.end.pose.position,
            axis: values(&self.motion.axis),
            across: self.motion.across,
            velocity: self.end.velocity,
            angular_velocity: values(&self.motion.angular_velocity),
        }
    }

    /// Residual and tangent for force and moment of all pairs on the body.
    pub fn assemble(
        &mut self,
        body: &RigidBody,
        start: &BodyState,
        load: &BodyLoad,
        pairs: &Reaction,
        step: &HhtStep,
        scales: &BodyScales,
    ) {
        let (fraction, length) = (1.0 - step.alpha_f, scales.length);
        let motion = &self.motion;
        let mut force = pairs.force + constant_vector(&load.applied.force);
        let mut world_moment = pairs.moment + constant_vector(&load.applied.moment);
        let mut material_moment = Vector3::from_element(D::constant(0.0));
        self.block.fill(0.0);
        self.violation = 0.0;
        self.input_power = load.applied.force.dot(&self.end.velocity)
            + load.applied.moment.dot(&values(&motion.angular_velocity));

        // constraints: value, direction of the reaction, and multiplier with its penalty (paper eq. 3, 4)
        for (k, constraint) in body.constraints.iter().enumerate() {
            let row = 6 + k;
            let unknown = self.unknowns[row];
            let (value, gain, scale, inertia, direction) = match constraint {
                Constraint::Position(axis, schedule) => {
                    let target = schedule.smooth_at(scales.time).0 + load.frame.position[*axis];
                    let direction = Vector3::from_fn(|i, _| if i == *axis { 1.0 } else { 0.0 });
                    // Directions 0 to 2 are those of the balls, which are minus the race's.
                    let position = D::variable(self.end.pose.position[*axis], *axis, -step.position_gain());
                    let value = position - D::constant(target);
                    (value, step.position_gain(), 1.0, body.mass, Along::Force(direction))
                }
                Constraint::Tilt(axis, _) => {
                    let (other, sign) = tilt_component(*axis);
                    let target = body.tilt_target(*axis, scales.time, &load.frame.tilt);
                    let value = motion.axis[other].scale(sign) - D::constant(target);
                    let direction = tilt_direction(*axis, &motion.axis);
                    (value, step.position_gain(), length, body.inertia[*axis], Along::Moment(direction))
                }
                Constraint::Spin => {
                    let value = self.rate[0] - D::constant(load.speed);
                    (value, step.velocity_gain(), length, body.inertia[0], Along::Drive)
                }
            };
            let penalty = inertia / gain;
            let multiplier = D::constant(unknown * scale) + value.scale(penalty);
            self.end.multipliers[k] = multiplier.value;
            self.residual[row] = value.value * scale / gain;
            for i in 0..6 {
                self.block[(row, i)] = by_second_unknown(&value, i) * scale / gain;
            }
            let (column, power) = match &direction {
                Along::Force(direction) => {
                    force += direction.map(D::constant) * multiplier;
                    self.violation = larger(self.violation, value.value.abs() / scales.length_tolerance);
                    ((*direction, Vector3::zeros()), direction.dot(&self.end.velocity))
                }
                Along::Moment(direction) => {
                    world_moment += direction * multiplier;
                    self.violation =
                        larger(self.violation, value.value.abs() * length / scales.length_tolerance);
                    let material = self.end.pose.orientation.inverse() * values(direction);
                    ((Vector3::zeros(), material), values(direction).dot(&values(&motion.angular_velocity)))
                }
                Along::Drive => {
                    material_moment[0] += multiplier;
                    self.violation = larger(self.violation, value.value.abs() / SPEED_TOLERANCE);
                    ((Vector3::zeros(), Vector3::x()), self.end.rate[0])
                }
            };
            self.input_power += power * multiplier.value;
            // The unknown is the multiplier over `scale`; the moment rows are divided by `length`.
            for i in 0..3 {
                self.block[(i, row)] = -fraction * column.0[i] * scale;
                self.block[(3 + i, row)] = -fraction * column.1[i] * scale / length;
            }
        }

        // total force (spatial) and moment (material) with the gyroscopic term
        let momentum = Vector3::from_fn(|i, _| self.rate[i].scale(body.inertia[i]));
        let seen = turn(&self.start_orientation.inverse(), &world_moment);
        material_moment += rotate(&-self.rotation, &seen) - self.rate.cross(&momentum);
        self.end.total = Wrench { force: values(&force), moment: values(&material_moment) };
        self.end.bearing_wrench = Wrench { force: values(&pairs.force), moment: values(&pairs.moment) };

        // What the last step left of these rows is made good here: added up it would move a body that nothing else holds.
        let owed = &start.remainder;
        for i in 0..3 {
            let translation = self.end.acceleration[i] * body.mass
                - fraction * force[i].value
                - step.alpha_f * start.total.force[i]
                + owed.force[i];
            let rotation =
                self.rate_derivative[i].scale(body.inertia[i]) - material_moment[i].scale(fraction);
            self.residual[i] = translation;
            let rest = rotation.value - step.alpha_f * start.total.moment[i] + owed.moment[i];
            self.residual[3 + i] = rest / length;
            (self.end.remainder.force[i], self.end.remainder.moment[i]) = (translation, rest);
            for k in 0..6 {
                let inertia = if i == k { body.mass } else { 0.0 };
                self.block[(i, k)] = inertia - fraction * by_second_unknown(&force[i], k);
                self.block[(3 + i, k)] = by_second_unknown(&rotation, k) / length;
            }
        }
    }

    /// Motion with all axes, with derivatives by the rotation, for contacts of a cage.
    pub fn body_motion(&self) -> BodyMotion<D> {
        let axis = |axis: Vector3<f64>| {
            turn(&self.start_orientation, &rotate(&self.rotation, &constant_vector(&axis)))
        };
        let axes = [axis(Vector3::x()), axis(Vector3::y()), axis(Vector3::z())];
        BodyMotion {
            position: constant_vector(&self.end.pose.position),
            axes,
            velocity: constant_vector(&self.end.velocity),
            angular_velocity: turn(&self.start_orientation, &rotate(&self.rotation, &self.rate)),
        }
    }

    /// Derivatives of this body's residual by the unknowns of the other body of a pair, from the reaction on this one.
    pub fn coupling(&self, reaction: &Reaction, step: &HhtStep, length: f64) -> Matrix6<f64> {
        self.rows(&by_first(&reaction.force, &reaction.moment), step, length)
    }

    /// Derivatives of this body's residual by its own unknowns through a pair, from the reaction on it.
    pub fn own_coupling(&self, reaction: &Reaction, step: &HhtStep, length: f64) -> Matrix6<f64> {
        self.rows(&by_second(&reaction.force, &reaction.moment), step, length)
    }

    /// Rows of the residual from derivatives of force and moment.
    fn rows(&self, world: &Matrix6<f64>, step: &HhtStep, length: f64) -> Matrix6<f64> {
        let fraction = 1.0 - step.alpha_f;
        let to_material = self.end.pose.orientation.inverse().to_rotation_matrix();
        let mut rows = world * -fraction;
        let moments = to_material.matrix() * world.fixed_rows::<3>(3) * (-fraction / length);
        rows.fixed_rows_mut::<3>(3).copy_from(&moments);
        rows
    }
}

/// A race as the balls see it in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct RaceSeen<'a> {
    /// Its motion.
    pub motion: &'a RaceMotion<f64>,
    /// Its motion with derivatives by the rotation, where forces move it.
    pub moved: Option<&'a RaceMotion<D>>,
}

impl<'a> RaceSeen<'a> {
    /// A race from the motions of all races and the trials of those that forces move.
    pub fn new(
        race: Race,
        motions: &'a PerRace<RaceMotion<f64>>,
        bodies: &'a Bodies<Option<BodyTrial>>,
    ) -> Self {
        Self { motion: &motions[race], moved: bodies[race].as_ref().map(|trial| &trial.motion) }
    }

    /// Motion with derivatives by the rotation, all zero where it is prescribed.
    pub fn with_derivatives(&self) -> RaceMotion<D> {
        self.moved.copied().unwrap_or_else(|| constant_race(self.motion))
    }
}

/// Accelerations and multipliers of a body that follow from its load and the wrench of its pairs, with the
/// constrained directions at rest or in steady rotation. Returns the power of loads and constraints \[W].
pub fn make_consistent(state: &mut BodyState, body: &RigidBody, load: &BodyLoad) -> f64 {
    let mut force = state.bearing_wrench.force + load.applied.force;
    let to_material = state.pose.orientation.inverse();
    let mut moment = to_material * (state.bearing_wrench.moment + load.applied.moment);
    let momentum = state.rate.component_mul(&body.inertia);
    moment -= state.rate.cross(&momentum);
    let mut power = load.applied.force.dot(&state.velocity)
        + load.applied.moment.dot(&(state.pose.orientation * state.rate));
    for (constraint, multiplier) in body.constraints.iter().zip(&mut state.multipliers) {
        match constraint {
            Constraint::Position(axis, _) => {
                *multiplier = -force[*axis];
                power += *multiplier * state.velocity[*axis];
                force[*axis] = 0.0;
            }
            Constraint::Tilt(axis, _) => {
                let race_axis = state.pose.orientation * Vector3::x();
                let direction = to_material * tilt_direction(*axis, &race_axis);
                *multiplier = -moment.dot(&direction) / direction.norm_squared();
                power += *multiplier * state.rate.dot(&direction);
                moment += direction * *multiplier;
            }
            Constraint::Spin => {
                *multiplier = -moment.x;
                power += *multiplier * state.rate.x;
                moment.x = 0.0;
            }
        }
    }
    state.total = Wrench { force, moment };
    state.remainder = Wrench::default();
    state.acceleration = force / body.mass;
    state.rate_derivative = moment.component_div(&body.inertia);
    power
}

/// Direction of the reaction of a constraint.
#[allow(clippy::large_enum_variant)]
enum Along {
    /// World direction of a force.
    Force(Vector3<f64>),
    /// World direction of a moment.
    Moment(Vector3<D>),
    /// The body's own axis.
    Drive,
}
