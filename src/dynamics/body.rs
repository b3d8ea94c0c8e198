//! A body that forces move, in one trial step: motion from its unknown accelerations, residual, constraints.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Vector3};

use super::body_sums::{Along, BodyLoad, BodyStep, Held, Sums, in_moving_frame};
use super::carried::SeatMotion;
use super::directions::{D, SECOND_ROTATION, by_first, by_second};
use super::reaction::Reaction;
use super::step_turn::{Own, StepTurn, as_second};
use super::support::{Flange, on_race};
use super::unbalance::{balanced, of_unbalance, power_of_weight};
use crate::contact::RaceMotion;
use crate::contact::motion::BodyMotion;
use crate::effects::moving_frame::MovingFrame;
use crate::model::bodies::{Bodies, Constraint, PerRace, Race, RigidBody, tilt_direction};
use crate::model::state::{BodyState, normalised};
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::{Pose, Wrench};
use crate::numerics::rotation::to_quaternion;
use crate::numerics::scalar::{Scalar, constant_vector, values};
use crate::numerics::size::larger;

/// [rad/s] accepted violation of a speed constraint (paper section 5).
const SPEED_TOLERANCE: f64 = 1e-8;

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
    /// Tangent of the residual by accelerations (angular ones times `length`) and multipliers (moments over `length`), as
    /// computed last.
    pub block: DMatrix<f64>,
    /// Rotation of the step.
    pub turn: StepTurn<f64>,
    /// Rotation vector that it was made from.
    turn_vector: Vector3<f64>,
    /// The rotation with derivatives, where those were asked for.
    derived: Option<StepTurn<Own>>,
    /// Where it is carried, of a race that is part of a structure.
    seat: Option<SeatMotion>,
    /// Motion of a carried race as the balls see it, with derivatives by the rotation, where those were asked for.
    carried: Option<RaceMotion<D>>,
}

impl BodyTrial {
    /// Buffers for a body, as at the start of a step.
    pub fn new(body: &RigidBody, start: &BodyState) -> Self {
        let rows = 6 + body.constraints.len();
        let zero = Vector3::zeros();
        Self {
            end: start.clone(),
            unknowns: vec![0.0; rows],
            residual: DVector::zeros(rows),
            violation: 0.0,
            input_power: 0.0,
            block: DMatrix::zeros(rows, rows),
            turn: StepTurn::new(&zero, zero, zero, start.pose.orientation),
            turn_vector: zero,
            derived: None,
            seat: body.carried.then(SeatMotion::default),
            carried: None,
        }
    }

    /// Does a structure carry it?
    pub fn is_carried(&self) -> bool {
        self.seat.is_some()
    }

    /// Moves a carried race to where its seat is.
    pub fn carry(&mut self, seat: &SeatMotion) {
        let Pose { position, orientation } = seat.pose();
        let twist = seat.twist();
        let Self { end, turn, .. } = self;
        end.pose = Pose { position, orientation };
        end.velocity = twist.velocity;
        end.rate = orientation.inverse() * twist.angular_velocity;
        end.acceleration = seat.acceleration;
        turn.axis = seat.columns().column(0).into_owned();
        turn.angular_velocity = twist.angular_velocity;
        self.seat = Some(*seat);
    }

    /// Where a carried race is.
    pub fn seat(&self) -> Option<&SeatMotion> {
        self.seat.as_ref()
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
        self.turn_vector = step.displacement(&start.rate, &start.rate_derivative, &angular);
        let rate = step.velocity(&start.rate, &start.rate_derivative, &angular);
        self.turn = StepTurn::new(&self.turn_vector, rate, angular, start.pose.orientation);
        self.derived = None;
        let orientation = normalised(start.pose.orientation * to_quaternion(&self.turn.rotation));
        self.end.pose = Pose { position, orientation };
        self.end.rate = rate;
        self.end.rate_derivative = angular;
    }

    /// Adds derivatives to the motion, where they are not there yet.
    pub fn differentiate(&mut self, start: &BodyState, step: &HhtStep, length: f64) {
        if let Some(seat) = &self.seat {
            self.carried = Some(seat.differentiated(step, length, self.motion_value().across));
            return;
        }
        if self.derived.is_some() {
            return;
        }
        let variable = |v: &Vector3<f64>, gain: f64| Vector3::from_fn(|i, _| Own::variable(v[i], i, gain));
        self.derived = Some(StepTurn::new(
            &variable(&self.turn_vector, step.position_gain() / length),
            variable(&self.turn.rate, step.velocity_gain() / length),
            variable(&self.turn.rate_derivative, 1.0 / length),
            start.pose.orientation,
        ));
    }

    /// Motion as the balls see it.
    pub fn motion_value(&self) -> RaceMotion<f64> {
        RaceMotion {
            position: self.end.pose.position,
            axis: self.turn.axis,
            across: self.end.pose.orientation * Vector3::y(),
            velocity: self.end.velocity,
            angular_velocity: self.turn.angular_velocity,
        }
    }

    /// Motion with derivatives by the rotation, after [`BodyTrial::differentiate`].
    pub fn motion(&self) -> RaceMotion<D> {
        match (&self.carried, &self.derived) {
            (Some(carried), _) => *carried,
            (None, Some(turned)) => RaceMotion {
                position: constant_vector(&self.end.pose.position),
                axis: as_second(&turned.axis),
                across: self.end.pose.orientation * Vector3::y(),
                velocity: constant_vector(&self.end.velocity),
                angular_velocity: as_second(&turned.angular_velocity),
            },
            (None, None) => {
                debug_assert!(false, "derivatives of this motion were not computed");
                self.motion_value().constant()
            }
        }
    }

    /// Residual under the sum of all pairs on the body.
    pub fn assemble(&mut self, given: &BodyStep<'_>, pairs: &Wrench) {
        let BodyStep { body, start, load, flange, moving, step, scales } = given;
        let (fraction, length) = (1.0 - step.alpha_f, scales.length);
        let carried = self.is_carried();
        let Self { end, turn, residual, violation, input_power, unknowns, .. } = self;
        *violation = 0.0;
        if carried {
            // Its structure has the equations; to the bearing its motion is prescribed.
            residual.fill(0.0);
            *input_power = -(pairs.force.dot(&end.velocity) + pairs.moment.dot(&turn.angular_velocity));
            end.bearing_wrench = *pairs;
            return;
        }
        *input_power =
            load.applied.force.dot(&end.velocity) + load.applied.moment.dot(&turn.angular_velocity);
        let mut sums = Sums { force: pairs.force, moment: pairs.moment, drive: 0.0 };
        sums.add_load(&load.applied);
        for (k, constraint) in body.constraints.iter().enumerate() {
            let held = Held::new(given, constraint, unknowns[6 + k], turn, &end.pose.position);
            sums.hold(&held);
            end.multipliers[k] = held.multiplier;
            residual[6 + k] = held.value * held.scale / held.gain;
            let (size, power) = match &held.direction {
                Along::Force(axis) => (held.value.abs() / scales.length_tolerance, end.velocity[*axis]),
                Along::Moment(direction) => (
                    held.value.abs() * length / scales.length_tolerance,
                    direction.dot(&turn.angular_velocity),
                ),
                Along::Drive => (held.value.abs() / SPEED_TOLERANCE, end.rate[0]),
            };
            *violation = larger(*violation, size);
            *input_power += power * held.multiplier;
        }
        let mut moment = sums.material_moment(turn, body);
        if let Some(frame) = moving {
            let inertial = in_moving_frame(frame, body, turn, (&end.pose.position, &end.velocity));
            sums.force += inertial.force;
            moment += inertial.moment;
            *input_power += inertial.force.dot(&end.velocity) + inertial.moment.dot(&end.rate);
        }
        if let Some(flange) = flange {
            let held = flange.holds(turn, (&end.pose.position, &end.velocity));
            sums.force += held.force;
            moment += held.moment;
        }
        if let Some(unbalance) = &body.unbalance {
            let gravity = load.applied.force / body.mass;
            let inertial = of_unbalance(unbalance, turn, &(end.acceleration - gravity));
            sums.force += inertial.force;
            moment += inertial.moment;
            *input_power += power_of_weight(unbalance, end, &gravity);
        }
        end.total = Wrench { force: sums.force, moment };
        end.bearing_wrench = *pairs;

        // What the last step left of these rows is made good here: added up it would move a body that nothing else holds.
        let carried_over = &start.remainder;
        for i in 0..3 {
            let translation = end.acceleration[i] * body.mass
                - fraction * sums.force[i]
                - step.alpha_f * start.total.force[i]
                + carried_over.force[i];
            let rotation = turn.rate_derivative[i].scale(body.inertia[i]) - moment[i].scale(fraction);
            let rest = rotation - step.alpha_f * start.total.moment[i] + carried_over.moment[i];
            residual[i] = translation;
            residual[3 + i] = rest / length;
            (end.remainder.force[i], end.remainder.moment[i]) = (translation, rest);
        }
    }

    /// Tangent of the residual that was assembled last, with the derivatives of reactions that have some by the body's own
    /// unknowns; after [`BodyTrial::differentiate`].
    pub fn assemble_block<'a>(
        &mut self,
        given: &BodyStep<'_>,
        reactions: &(impl Iterator<Item = &'a Reaction> + Clone),
    ) {
        let BodyStep { body, load, flange, moving, step, scales, .. } = given;
        let (fraction, length) = (1.0 - step.alpha_f, scales.length);
        if self.is_carried() {
            let of_pairs = |sum, reaction| sum + self.own_coupling(reaction, step, length);
            let own: Matrix6<f64> = reactions.clone().fold(Matrix6::zeros(), of_pairs);
            self.block.copy_from(&own);
            return;
        }
        let Self { end, derived, block, unknowns, turn: value, .. } = self;
        let Some(turn) = derived else {
            debug_assert!(false, "derivatives of this motion were not computed");
            return;
        };
        // Derivatives by the rotation; those by the translation are those of reactions and of what holds positions.
        let mut sums = Sums {
            force: constant_vector::<Own>(&end.bearing_wrench.force),
            moment: constant_vector(&end.bearing_wrench.moment),
            drive: Own::constant(0.0),
        };
        let (mut force_by_place, mut moment_by_place) = (Matrix3::zeros(), Matrix3::zeros());
        for reaction in reactions.clone() {
            for i in 0..3 {
                for k in 0..3 {
                    sums.force[i].derivatives[k] += reaction.force[i].derivatives[SECOND_ROTATION + k];
                    sums.moment[i].derivatives[k] += reaction.moment[i].derivatives[SECOND_ROTATION + k];
                    force_by_place[(i, k)] -= reaction.force[i].derivatives[k];
                    moment_by_place[(i, k)] -= reaction.moment[i].derivatives[k];
                }
            }
        }
        sums.add_load(&load.applied);
        let position = constant_vector(&end.pose.position);
        block.as_mut_slice().fill(0.0);
        for (k, constraint) in body.constraints.iter().enumerate() {
            let row = 6 + k;
            let held = Held::new(given, constraint, unknowns[row], turn, &position);
            sums.hold(&held);
            let (force, moment) = match &held.direction {
                Along::Force(axis) => (unit(*axis), Vector3::zeros()),
                Along::Moment(direction) => {
                    (Vector3::zeros(), end.pose.orientation.inverse() * values(direction))
                }
                Along::Drive => (Vector3::zeros(), Vector3::x()),
            };
            // The unknown is the multiplier over `scale`; the moment rows are divided by `length`.
            for i in 0..3 {
                block[(i, row)] = -fraction * force[i] * held.scale;
                block[(3 + i, row)] = -fraction * moment[i] * held.scale / length;
            }
            for i in 0..3 {
                block[(row, 3 + i)] = held.value.derivatives[i] * held.scale / held.gain;
            }
            if let Along::Force(axis) = held.direction {
                // the value is the position's own
                block[(row, axis)] = step.position_gain() * held.scale / held.gain;
                force_by_place[(axis, axis)] += step.position_gain() * (body.mass / held.gain);
            }
        }
        let mut moment = sums.material_moment(turn, body);
        let mut moment_by_place =
            Matrix3::from_columns(&[0, 1, 2].map(|k| value.material(&moment_by_place.column(k).into())));
        if moving.is_some() || flange.is_some() {
            let add = |turn: &StepTurn<Own>, (position, velocity): (Vector3<Own>, Vector3<Own>)| {
                let inertial = moving.map(|frame| in_moving_frame(frame, body, turn, (&position, &velocity)));
                let held = flange.as_ref().map(|flange| flange.holds(turn, (&position, &velocity)));
                [inertial, held].into_iter().flatten()
            };
            for wrench in add(turn, (position, constant_vector(&end.velocity))) {
                sums.force += wrench.force;
                moment += wrench.moment;
            }
            let variable =
                |v: &Vector3<f64>, gain: f64| Vector3::from_fn(|i, _| Own::variable(v[i], i, gain));
            let moved = (
                variable(&end.pose.position, step.position_gain()),
                variable(&end.velocity, step.velocity_gain()),
            );
            for wrench in add(&value.constant(), moved) {
                force_by_place += by(&wrench.force);
                moment_by_place += by(&wrench.moment);
            }
        }
        if let Some(unbalance) = &body.unbalance {
            let falling = end.acceleration - load.applied.force / body.mass;
            let by_rotation = of_unbalance(unbalance, turn, &constant_vector(&falling));
            sums.force += by_rotation.force;
            moment += by_rotation.moment;
            let falling = Vector3::from_fn(|i, _| Own::variable(falling[i], i, 1.0));
            moment_by_place += by(&of_unbalance(unbalance, &value.constant(), &falling).moment);
        }
        for i in 0..3 {
            let rotation = turn.rate_derivative[i].scale(body.inertia[i]) - moment[i].scale(fraction);
            for k in 0..3 {
                let inertia = if i == k { body.mass } else { 0.0 };
                block[(i, k)] = inertia - fraction * force_by_place[(i, k)];
                block[(i, 3 + k)] = -fraction * sums.force[i].derivatives[k];
                block[(3 + i, k)] = -fraction * moment_by_place[(i, k)] / length;
                block[(3 + i, 3 + k)] = rotation.derivatives[k] / length;
            }
        }
    }

    /// Motion with all axes, for contacts of a cage.
    pub fn body_motion_value(&self) -> BodyMotion<f64> {
        BodyMotion {
            position: self.end.pose.position,
            axes: [self.turn.axis, self.turn.own_axis(1), self.turn.own_axis(2)],
            velocity: self.end.velocity,
            angular_velocity: self.turn.angular_velocity,
        }
    }

    /// Motion with derivatives by the rotation, after [`BodyTrial::differentiate`].
    pub fn body_motion(&self) -> Option<BodyMotion<D>> {
        let turn = self.derived.as_ref()?;
        let RaceMotion { position, axis, velocity, angular_velocity, .. } = self.motion();
        let axes = [axis, as_second(&turn.own_axis(1)), as_second(&turn.own_axis(2))];
        Some(BodyMotion { position, axes, velocity, angular_velocity })
    }

    /// Derivatives of this body's residual by the unknowns of the other body of a pair, from the reaction on this one.
    pub fn coupling(&self, reaction: &Reaction, step: &HhtStep, length: f64) -> Matrix6<f64> {
        self.rows(&by_first(&reaction.force, &reaction.moment), step, length)
    }

    /// Derivatives of this body's residual by its own unknowns through a pair, from the reaction on it.
    pub fn own_coupling(&self, reaction: &Reaction, step: &HhtStep, length: f64) -> Matrix6<f64> {
        self.rows(&by_second(&reaction.force, &reaction.moment), step, length)
    }

    /// Turns world axes into those that its moments and rotations have in the Newton matrix: its own, but the world's where it is
    /// carried.
    pub fn own_axes(&self) -> Matrix3<f64> {
        match self.seat {
            None => self.end.pose.orientation.inverse().to_rotation_matrix().into_inner(),
            Some(_) => Matrix3::identity(),
        }
    }

    /// Rows of the residual from derivatives of force and moment.
    fn rows(&self, world: &Matrix6<f64>, step: &HhtStep, length: f64) -> Matrix6<f64> {
        let fraction = 1.0 - step.alpha_f;
        let mut rows = world * -fraction;
        let moments = self.own_axes() * world.fixed_rows::<3>(3) * (-fraction / length);
        rows.fixed_rows_mut::<3>(3).copy_from(&moments);
        rows
    }
}

/// A race as the balls see it in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct RaceSeen<'a> {
    /// Its motion.
    pub motion: &'a RaceMotion<f64>,
    /// Its trial, where forces move it.
    trial: Option<&'a BodyTrial>,
}

impl<'a> RaceSeen<'a> {
    /// A race from the motions of all races and the trials of those that forces move.
    pub fn new(
        race: Race,
        motions: &'a PerRace<RaceMotion<f64>>,
        bodies: &'a Bodies<Option<BodyTrial>>,
    ) -> Self {
        Self { motion: &motions[race], trial: bodies[race].as_ref() }
    }

    /// Its motion with derivatives by the rotation, where forces move it; after [`BodyTrial::differentiate`].
    pub fn moved(&self) -> Option<RaceMotion<D>> {
        self.trial.map(BodyTrial::motion)
    }

    /// Motion with derivatives by the rotation, all zero where it is prescribed.
    pub fn with_derivatives(&self) -> RaceMotion<D> {
        self.moved().unwrap_or_else(|| self.motion.constant())
    }
}

/// Accelerations and multipliers of a body that follow from its load and the wrench of its pairs, with the
/// constrained directions at rest or in steady rotation. Returns the power of loads and constraints \[W].
pub fn make_consistent(
    state: &mut BodyState,
    body: &RigidBody,
    load: &BodyLoad,
    (flange, moving): (Option<Flange<'_>>, Option<&MovingFrame>),
) -> f64 {
    if body.carried {
        return -state.twist().power(&state.bearing_wrench);
    }
    let mut force = state.bearing_wrench.force + load.applied.force;
    let to_material = state.pose.orientation.inverse();
    let mut moment = to_material * (state.bearing_wrench.moment + load.applied.moment);
    let momentum = state.rate.component_mul(&body.inertia);
    moment -= state.rate.cross(&momentum);
    if let Some(flange) = &flange {
        let held = on_race(flange, &state.pose, &state.twist());
        force += held.force;
        moment += held.moment;
    }
    let mut inertial_power = 0.0;
    if let Some(frame) = moving {
        let inertial = Wrench {
            force: frame.field(&state.pose.position, &state.velocity) * body.mass,
            moment: frame.moment(&body.inertia, &state.rate, |v| to_material * v),
        };
        force += inertial.force;
        moment += inertial.moment;
        inertial_power = inertial.force.dot(&state.velocity) + inertial.moment.dot(&state.rate);
    }
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
    if moving.is_some() {
        power += inertial_power;
    }
    if let Some(unbalance) = &body.unbalance {
        let gravity = load.applied.force / body.mass;
        power += power_of_weight(unbalance, state, &gravity);
        (force, moment) = balanced(body, unbalance, state, (&force, &moment), &gravity);
    }
    state.total = Wrench { force, moment };
    state.remainder = Wrench::default();
    state.acceleration = force / body.mass;
    state.rate_derivative = moment.component_div(&body.inertia);
    power
}

/// Derivatives of a vector (rows) by three unknowns.
fn by(v: &Vector3<Own>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, k| v[i].derivatives[k])
}

/// [-] unit vector along a world axis.
fn unit(axis: usize) -> Vector3<f64> {
    Vector3::from_fn(|i, _| if i == axis { 1.0 } else { 0.0 })
}
