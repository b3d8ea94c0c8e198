//! Forces on a body in a trial step: its load, its constraints, and their sums, with derivatives or without.

use nalgebra::Vector3;

use super::step_turn::StepTurn;
use super::support::Flange;
use crate::effects::moving_frame::MovingFrame;
use crate::model::bodies::{Constraint, RigidBody, tilt_component, tilt_direction};
use crate::model::state::BodyState;
use crate::numerics::hht::HhtStep;
use crate::numerics::motion::{FrameInput, Wrench};
use crate::numerics::scalar::{Scalar, constant_vector, cross};

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

/// Given quantities of a body in a trial step.
#[derive(Clone, Copy, Debug)]
pub struct BodyStep<'a> {
    /// The body.
    pub body: &'a RigidBody,
    /// Its state at the start.
    pub start: &'a BodyState,
    /// Load from outside.
    pub load: BodyLoad,
    /// The flange of its support, where it rests on one.
    pub flange: Option<Flange<'a>>,
    /// The bearing's frame, where it moves.
    pub moving: Option<&'a MovingFrame>,
    /// The step.
    pub step: &'a HhtStep,
    /// Scales of its equations.
    pub scales: BodyScales,
}

/// Sums of what acts on a body, in a trial step.
pub struct Sums<S: Scalar> {
    /// \[N] force.
    pub force: Vector3<S>,
    /// [N m] moment, world axes.
    pub moment: Vector3<S>,
    /// [N m] moment about the body's own axis.
    pub drive: S,
}

impl<S: Scalar> Sums<S> {
    /// Adds a load from outside.
    pub fn add_load(&mut self, load: &Wrench) {
        self.force += constant_vector(&load.force);
        self.moment += constant_vector(&load.moment);
    }

    /// Adds the reaction of a constraint.
    pub fn hold(&mut self, held: &Held<S>) {
        match &held.direction {
            Along::Force(axis) => self.force[*axis] += held.multiplier,
            Along::Moment(direction) => self.moment += direction * held.multiplier,
            Along::Drive => self.drive += held.multiplier,
        }
    }

    /// [N m] total moment in the body's own axes, with the gyroscopic one.
    pub fn material_moment(&self, turn: &StepTurn<S>, body: &RigidBody) -> Vector3<S> {
        let momentum = |i: usize| turn.rate[i].scale(body.inertia[i]);
        let momentum = Vector3::new(momentum(0), momentum(1), momentum(2));
        let mut moment = turn.material(&self.moment) - cross(&turn.rate, &momentum);
        moment[0] = self.drive + moment[0];
        moment
    }
}

/// Forces of inertia of a moving frame on a body at a position \[m] with a velocity [m/s]: force (spatial) and moment (material).
#[cold]
pub fn in_moving_frame<S: Scalar>(
    frame: &MovingFrame,
    body: &RigidBody,
    turn: &StepTurn<S>,
    (position, velocity): (&Vector3<S>, &Vector3<S>),
) -> Wrench<S> {
    let field = frame.seen(constant_vector).field(position, velocity);
    Wrench {
        force: field.map(|component| component.scale(body.mass)),
        moment: frame.moment(&body.inertia, &turn.rate, |v| turn.material(&constant_vector(v))),
    }
}

/// A constraint at the end of a trial step (paper eq. 3, 4).
pub struct Held<S: Scalar> {
    /// Value that shall be 0 \[m, rad, rad/s].
    pub value: S,
    /// Derivative of a coordinate or speed by its acceleration [s2, s].
    pub gain: f64,
    /// [-, m] turns values into lengths, and unknowns into multipliers.
    pub scale: f64,
    /// Multiplier with its penalty [N, N m].
    pub multiplier: S,
    /// Where its reaction acts.
    pub direction: Along<S>,
}

impl<S: Scalar> Held<S> {
    /// A constraint of a body with its multiplier's unknown \[N], the body's turn and its position \[m].
    pub fn new(
        given: &BodyStep<'_>,
        constraint: &Constraint,
        unknown: f64,
        turn: &StepTurn<S>,
        position: &Vector3<S>,
    ) -> Self {
        let BodyStep { body, load, step, scales, .. } = given;
        let (value, gain, scale, inertia, direction) = match constraint {
            Constraint::Position(axis, schedule) => {
                let target = schedule.smooth_at(scales.time).0 + load.frame.position[*axis];
                let value = position[*axis] - S::constant(target);
                (value, step.position_gain(), 1.0, body.mass, Along::Force(*axis))
            }
            Constraint::Tilt(axis, _) => {
                let (other, sign) = tilt_component(*axis);
                let target = body.tilt_target(*axis, scales.time, &load.frame.tilt);
                let value = turn.axis[other].scale(sign) - S::constant(target);
                let direction = Along::Moment(tilt_direction(*axis, &turn.axis));
                (value, step.position_gain(), scales.length, body.inertia[*axis], direction)
            }
            Constraint::Spin => {
                let value = turn.rate[0] - S::constant(load.speed);
                (value, step.velocity_gain(), scales.length, body.inertia[0], Along::Drive)
            }
        };
        let multiplier = S::constant(unknown * scale) + value.scale(inertia / gain);
        Self { value, gain, scale, multiplier, direction }
    }
}

/// Direction of the reaction of a constraint.
#[allow(clippy::large_enum_variant)]
pub enum Along<S: Scalar> {
    /// A force along a world axis.
    Force(usize),
    /// World direction of a moment.
    Moment(Vector3<S>),
    /// The body's own axis.
    Drive,
}
