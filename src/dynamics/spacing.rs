//! Balls that an ideal cage keeps apart, in one trial step.
//!
//! Coordinates of a ball are its place along the axis, its distance r from it and the turn phi of all. HHT's formulas hold for them, so that
//! balls stay where the turn has them, to rounding:
//!
//! ```text
//! m x'' = F_x,   m r'' = F_r + m r phi'^2,   sum of m r^2 phi'' = sum of r (F_t - 2 m r' phi')
//! ```
//! Unknowns and rows of a ball along the orbit, one of six each, are of no use: the unknown there is 0. What they would be is a share of the
//! turn's, which all balls have in common ([`Shared`]). The force of its pocket is what a ball lacks of its share ([`SpacingTrial::press`]).

use nalgebra::{Matrix6, Vector3, Vector6};

use super::Boundary;
use super::across::Across;
use super::group::Groups;
use crate::contact::BallMotion;
use crate::model::Model;
use crate::model::bodies::Race;
use crate::model::spacing::{CommonTurn, Directions, Spacing, wrapped};
use crate::model::state::{BallState, State};
use crate::numerics::arrowhead::{Block, SLOTS, Shared, Six};
use crate::numerics::hht::HhtStep;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::motion::Wrench;
use crate::numerics::scalar::Scalar;

/// The turn at the end of a step, as balls follow it.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    cos: f64,
    sin: f64,
    /// [rad/s] its rate.
    speed: f64,
    /// Centre \[m], its velocity [m/s] and its mean acceleration [m/s2] in the step: y and z.
    centre: [f64; 2],
    velocity: [f64; 2],
    drift: [f64; 2],
}

/// A ball in its place in a step, or several at a time.
#[derive(Clone, Copy, Debug)]
pub struct Apart<S: Scalar> {
    step: HhtStep,
    mass: f64,
    /// Cosine and sine of the azimuth where the turn is 0.
    azimuth: [S; 2],
    /// Those of the azimuth that is expected at the end: the axes of unknowns and residuals.
    ahead: [S; 2],
    /// \[m] way along the radius, [m/s] its rate: without what the unknown adds.
    way: S,
    rate: S,
    /// Share of the force at the start in that of the step, and what the last step left \[N].
    held: S,
    remainder: S,
    turn: Turn,
}

/// A ball at the end of the step, in its place.
#[derive(Clone, Copy, Debug)]
pub struct Placed<S: Scalar> {
    /// Cosine and sine of its azimuth.
    at: [S; 2],
    /// \[m] distance from the axis.
    radius: S,
    /// [m/s] its rate.
    rate: S,
}

/// Share of a ball in the equation of the turn.
#[derive(Clone, Copy, Debug)]
pub struct Share<S: Scalar> {
    /// [kg m2] moment of inertia.
    pub inertia: S,
    /// [N m] moment of all forces but that of its pocket.
    pub moment: S,
    /// \[m] distance from the axis.
    pub radius: S,
}

/// Turns the direction of an azimuth by an angle, all by cosine and sine.
#[inline(always)]
fn turned<S: Scalar>([c, s]: [S; 2], cos: f64, sin: f64) -> [S; 2] {
    [c.scale(cos) - s.scale(sin), c.scale(sin) + s.scale(cos)]
}

/// Components y and z along a direction and across it.
#[inline(always)]
fn along<S: Scalar>([c, s]: [S; 2], y: S, z: S) -> [S; 2] {
    [c * y + s * z, c * z - s * y]
}

impl<S: Scalar> Apart<S> {
    /// Balls of one lane each, which `lane` gives with their azimuths.
    #[inline(always)]
    pub fn new<'a>(
        lane: impl Fn(usize) -> (&'a BallState, [f64; 2]),
        trial: &SpacingTrial,
        mass: f64,
        step: &HhtStep,
    ) -> Self {
        let SpacingTrial { start, turned: (sin, cos), ahead, turn, .. } = trial;
        let component = |of: fn(&BallState) -> f64| S::by_lane(|index| of(lane(index).0));
        let azimuth = [0, 1].map(|k| S::by_lane(|index| lane(index).1[k]));
        let at = turned(azimuth, *cos, *sin);
        let constant = S::constant;
        let radial = |y: S, z: S| along(at, y, z)[0];
        let radius = radial(
            component(|ball| ball.position.y) - constant(start.centre.y),
            component(|ball| ball.position.z) - constant(start.centre.z),
        );
        let rate = radial(
            component(|ball| ball.velocity.y) - constant(start.velocity.y),
            component(|ball| ball.velocity.z) - constant(start.velocity.z),
        );
        let acceleration =
            radial(component(|ball| ball.acceleration.y), component(|ball| ball.acceleration.z));
        let h = step.h;
        Self {
            step: *step,
            mass,
            azimuth,
            ahead: turned(azimuth, ahead.1, ahead.0),
            way: radius + (rate + acceleration.scale((0.5 - step.beta) * h)).scale(h),
            rate: rate + acceleration.scale((1.0 - step.gamma) * h),
            held: radial(component(|ball| ball.total.force.y), component(|ball| ball.total.force.z))
                .scale(step.alpha_f),
            remainder: radial(
                component(|ball| ball.remainder.force.y),
                component(|ball| ball.remainder.force.z),
            ),
            turn: *turn,
        }
    }

    /// Where these unknowns take it.
    #[inline(always)]
    fn placed(&self, unknowns: &Six<S>) -> Placed<S> {
        let [acceleration, _] = along(self.ahead, unknowns[1], unknowns[2]);
        Placed {
            at: turned(self.azimuth, self.turn.cos, self.turn.sin),
            radius: self.way + acceleration.scale(self.step.position_gain()),
            rate: self.rate + acceleration.scale(self.step.velocity_gain()),
        }
    }

    /// Sets the motion across the axis to that in its place.
    #[inline(always)]
    pub fn move_to(&self, unknowns: &Six<S>, motion: &mut BallMotion<S>) {
        let Placed { at: [c, s], radius, rate } = self.placed(unknowns);
        let Turn { speed, centre, velocity, .. } = self.turn;
        let along = radius.scale(speed);
        motion.position.y = S::constant(centre[0]) + radius * c;
        motion.position.z = S::constant(centre[1]) + radius * s;
        motion.velocity.y = S::constant(velocity[0]) + (rate * c - along * s);
        motion.velocity.z = S::constant(velocity[1]) + (rate * s + along * c);
    }

    /// Sets what the total force leaves of its equations, and of that force what moves it along the radius; gives what it adds to the
    /// equation of the turn.
    #[inline(always)]
    pub fn balance(
        &self,
        unknowns: &Six<S>,
        total: &mut Wrench<S>,
        remainder: &mut Wrench<S>,
        residual: &mut Six<S>,
    ) -> Share<S> {
        let Placed { at: [c, s], radius, rate } = self.placed(unknowns);
        let Self { step, mass, turn, ahead, .. } = self;
        let speed = turn.speed;
        let field = |i: usize| total.force[1 + i] - S::constant(mass * turn.drift[i]);
        let [outward, forward] = along([c, s], field(0), field(1));
        let outward = outward + radius.scale(mass * speed * speed);
        let forward = forward - rate.scale(2.0 * mass * speed);
        let [acceleration, idle] = along(*ahead, unknowns[1], unknowns[2]);
        let left =
            acceleration.scale(*mass) - (outward.scale(1.0 - step.alpha_f) + self.held) + self.remainder;
        let idle = idle.scale(*mass);
        (total.force.y, total.force.z) = (outward * c, outward * s);
        (remainder.force.y, remainder.force.z) = (left * c, left * s);
        residual[1] = left * ahead[0] - idle * ahead[1];
        residual[2] = left * ahead[1] + idle * ahead[0];
        Share { inertia: (radius * radius).scale(*mass), moment: radius * forward, radius }
    }
}

impl Apart<Lanes> {
    /// Goes on with another turn.
    pub fn follow(&mut self, turn: &Turn) {
        self.turn = *turn;
    }

    /// Unit vector along the orbit of the ball in a lane, where it is expected at the end.
    #[inline]
    pub fn along(&self, lane: usize) -> Vector3<f64> {
        let [c, s] = self.ahead.map(|of| of.0[lane]);
        Vector3::new(0.0, -s, c)
    }

    /// That in a lane.
    pub fn in_lane(&self, lane: usize) -> Apart<f64> {
        let one = |of: Lanes| of.0[lane];
        Apart {
            step: self.step,
            mass: self.mass,
            azimuth: self.azimuth.map(one),
            ahead: self.ahead.map(one),
            way: one(self.way),
            rate: one(self.rate),
            held: one(self.held),
            remainder: one(self.remainder),
            turn: self.turn,
        }
    }
}

impl Apart<f64> {
    /// The axes of unknowns and residuals: along the radius and along the orbit.
    fn axes(&self) -> [Across; 2] {
        let [c, s] = self.ahead;
        [Across([c, s]), Across([-s, c])]
    }

    /// Goes from the tangent of a ball that is free, by its acceleration, to that of one that is kept in its place, with its couplings to
    /// the bodies in some slots and to the turn, whose unknown is an acceleration times `length` \[m].
    pub fn share(
        &self,
        block: &mut Block,
        unknowns: &Vector6<f64>,
        slots: impl Iterator<Item = usize>,
        length: f64,
    ) {
        let [out, on] = self.axes();
        let Placed { radius, rate, .. } = self.placed(&(*unknowns).into());
        let scale = radius / length;
        let Block { diagonal, right, left, shared, .. } = block;
        self.lean(diagonal, &out, &on);
        let lean = self.velocity_by_radius();
        let (column, row) = (on.column_of(diagonal), on.row_of(diagonal));
        let own = on.dot(&column);
        // What inertia forces of the turn's rate add.
        let gain = (1.0 - self.step.alpha_f) * 2.0 * self.mass * self.step.velocity_gain();
        let outward = -gain * radius * self.turn.speed / length;
        let forward = gain * rate / length;
        let mut right_of_turn = [Vector6::zeros(); SLOTS];
        let mut left_of_turn = right_of_turn;
        for slot in slots {
            let of_turn = on.column_of(&left[slot]);
            out.add_to_columns(&mut left[slot], &(of_turn * lean));
            on.add_to_columns(&mut left[slot], &-of_turn);
            left_of_turn[slot] = of_turn * scale;
            let of_turn = on.row_of(&right[slot]);
            on.add_to_rows(&mut right[slot], &-of_turn);
            right_of_turn[slot] = of_turn * scale;
        }
        *shared = Shared {
            column: (column - on.times(own)) * scale + out.times(outward),
            row: (row - on.times(own)) * scale,
            own: scale * (scale * own + forward),
            right: right_of_turn,
            left: left_of_turn,
        };
        self.leave_orbit(diagonal, &on);
    }

    /// The tangent of a ball that is kept in its place, with the turn as it is.
    pub fn tangent_alone(&self, mut tangent: Matrix6<f64>) -> Matrix6<f64> {
        let [out, on] = self.axes();
        self.lean(&mut tangent, &out, &on);
        self.leave_orbit(&mut tangent, &on);
        tangent
    }

    /// [-] velocity along the orbit by that along the radius, both by the acceleration along the radius.
    fn velocity_by_radius(&self) -> f64 {
        self.turn.speed * self.step.position_gain() / self.step.velocity_gain()
    }

    /// Adds to the column of the radius that a ball farther out is faster, and its inertia forces.
    fn lean(&self, tangent: &mut Matrix6<f64>, out: &Across, on: &Across) {
        let Self { step, mass, turn, .. } = self;
        let fraction = 1.0 - step.alpha_f;
        // Forces by the velocity along the orbit: what its column has beside the mass. The place there changes them by less than 1e-3 of that.
        let faster = (on.column_of(tangent) - on.times(*mass)) * self.velocity_by_radius();
        let outward = out.times(-fraction * mass * turn.speed * turn.speed * step.position_gain());
        let forward = on.times(fraction * 2.0 * mass * turn.speed * step.velocity_gain());
        out.add_to_columns(tangent, &(faster + outward + forward));
    }

    /// Empties the row and column along the orbit of a tangent, where the mass alone is left.
    fn leave_orbit(&self, tangent: &mut Matrix6<f64>, on: &Across) {
        let (column, row) = (on.column_of(tangent), on.row_of(tangent));
        let own = on.dot(&column);
        on.add_to_columns(tangent, &(on.times(own + self.mass) - column));
        on.add_to_rows(tangent, &-row);
    }
}

/// The common turn in a trial step.
#[derive(Clone, Debug)]
pub struct SpacingTrial {
    /// At the start, without its pockets.
    start: CommonTurn,
    /// Sine and cosine of its angle.
    turned: (f64, f64),
    /// At the end.
    pub end: CommonTurn,
    /// The same, as balls follow it.
    pub turn: Turn,
    /// [m/s2] unknown: angular acceleration times the race length.
    unknown: f64,
    /// \[N] residual: moment over the race length.
    pub residual: f64,
    /// \[N] share of each ball in it.
    pub each: f64,
    /// Sine and cosine of the angle that is expected at the end.
    ahead: (f64, f64),
}

impl SpacingTrial {
    /// A turn in a step that ends under a boundary.
    pub fn new(start: &CommonTurn, boundary: &Boundary, step: &HhtStep) -> Self {
        let mut end = start.clone();
        (end.centre, end.velocity) = centre(boundary);
        let ahead = start.angle + (start.speed + 0.5 * start.acceleration * step.h) * step.h;
        let turned = start.angle.sin_cos();
        let across = |v: &Vector3<f64>| [v.y, v.z];
        let turn = Turn {
            cos: turned.1,
            sin: turned.0,
            speed: start.speed,
            centre: across(&end.centre),
            velocity: across(&end.velocity),
            drift: across(&((end.velocity - start.velocity) / step.h)),
        };
        Self {
            ahead: ahead.sin_cos(),
            start: CommonTurn { pockets: vec![], ..*start },
            turned,
            end,
            turn,
            unknown: f64::NAN,
            residual: 0.0,
            each: 0.0,
        }
    }

    /// Moves to the end of the step; has the unknown changed?
    pub fn move_to(&mut self, unknown: f64, step: &HhtStep, length: f64) -> bool {
        let changed = self.unknown != unknown;
        self.unknown = unknown;
        let (h, before, after) = (step.h, self.start.acceleration, unknown / length);
        let mean = before * (0.5 - step.beta) + after * step.beta;
        self.end.angle = wrapped(self.start.angle + (self.start.speed + mean * h) * h);
        self.end.speed = self.start.speed + (before * (1.0 - step.gamma) + after * step.gamma) * h;
        self.end.acceleration = after;
        (self.turn.sin, self.turn.cos) = self.end.angle.sin_cos();
        self.turn.speed = self.end.speed;
        changed
    }

    /// Sums what the balls add to its equation.
    pub fn assemble(&mut self, groups: &Groups, step: &HhtStep, length: f64) {
        let Self { start, end, .. } = self;
        let balls = end.pockets.len();
        let (mut inertia, mut moment) = (0.0, 0.0);
        for (index, share) in groups.shares().enumerate() {
            for lane in 0..WIDTH.min(balls - WIDTH * index) {
                inertia += share.inertia.0[lane];
                moment += share.moment.0[lane];
            }
        }
        end.total = moment / inertia;
        end.remainder = end.acceleration - ((1.0 - step.alpha_f) * end.total + step.alpha_f * start.total)
            + start.remainder;
        self.residual = end.remainder * (inertia / length);
        self.each = self.residual / balls as f64;
    }

    /// Finds the forces of the pockets in a step that is solved: what each ball lacks of its share.
    pub fn press(&mut self, groups: &Groups) {
        let end = &mut self.end;
        for (share, pockets) in groups.shares().zip(end.pockets.chunks_mut(WIDTH)) {
            let forces = (share.inertia.scale(end.total) - share.moment) / share.radius;
            pockets.iter_mut().zip(forces.0).for_each(|(pocket, force)| *pocket = force);
        }
    }

    /// [rad/s2] angular acceleration at start and end of the step.
    pub fn accelerations(&self) -> [f64; 2] {
        [self.start.acceleration, self.end.acceleration]
    }
}

/// Centre of the orbits \[m] and its velocity [m/s] under a boundary: those of the outer race, whose motion is given.
fn centre(boundary: &Boundary) -> (Vector3<f64>, Vector3<f64>) {
    let (pose, twist) = &boundary.motion[Race::Outer];
    (pose.position, twist.velocity)
}

/// Makes accelerations and forces of balls that are kept apart consistent with the total force on each \[N], and the turn with what is
/// imposed.
pub fn make_consistent(spacing: &Spacing, model: &Model, state: &mut State, boundary: &Boundary) {
    let Some(turn) = &mut state.spacing else { return };
    (turn.centre, turn.velocity) = centre(boundary);
    let mass = model.bearing.ball.mass;
    let (mut inertia, mut moment) = (0.0, 0.0);
    let turned = turn.angle.sin_cos();
    for ((ball, azimuth), pocket) in state.balls.iter_mut().zip(&spacing.azimuths).zip(&mut turn.pockets) {
        let Directions { radial, tangential } = Directions::turned(turned, *azimuth);
        let radius = radial.dot(&(ball.position - turn.centre));
        let rate = radial.dot(&(ball.velocity - turn.velocity));
        let force = ball.total.force;
        let forward = tangential.dot(&force) - 2.0 * mass * rate * turn.speed;
        let outward = radial.dot(&force) + mass * radius * turn.speed * turn.speed;
        ball.total.force = Vector3::x() * force.x + radial * outward;
        ball.acceleration = ball.total.force / mass;
        inertia += mass * radius * radius;
        moment += radius * forward;
        // Of its share of the turn the rest follows below.
        *pocket = -forward;
    }
    turn.total = moment / inertia;
    turn.acceleration = turn.total;
    turn.remainder = 0.0;
    for (ball, pocket) in state.balls.iter().zip(&mut turn.pockets) {
        let at = ball.position - turn.centre;
        *pocket += mass * f64::hypot(at.y, at.z) * turn.total;
    }
}

/// Force and moment of the guide that holds the centre of an ideal cage: on the outer race about its origin \[m].
pub fn on_guide(spacing: &Spacing, turn: &CommonTurn, places: impl Iterator<Item = Vector3<f64>>) -> Wrench {
    let mut sum = Wrench::default();
    let turned = turn.angle.sin_cos();
    for ((azimuth, pocket), place) in spacing.azimuths.iter().zip(&turn.pockets).zip(places) {
        let force = Directions::turned(turned, *azimuth).tangential * -*pocket;
        sum.force += force;
        sum.moment += (place - turn.centre).cross(&force);
    }
    sum
}
