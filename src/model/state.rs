//! The complete state of a running bearing: plain data, cloned to save and restore.

use nalgebra::{Matrix3, UnitQuaternion, Vector3, Vector6};
use serde::{Deserialize, Serialize};

pub use super::ball_state::BallState;
use super::bodies::{Bodies, Body, Constraint, PerRace, Race, RigidBody};
use super::energies::{Energies, Powers};
use super::spacing::CommonTurn;
use crate::contact::RaceMotion;
use crate::contact::motion::BodyMotion;
use crate::effects::growth::Grown;
use crate::effects::reports::SupportState;
use crate::effects::reports::Warm;
use crate::effects::{heat, means, rating};
use crate::kalker::scaled_law::Difference;
use crate::numerics::arrowhead::Eliminated;
use crate::numerics::motion::{Pose, Twist, Wrench};
use crate::numerics::newton::NewtonWork;
use crate::numerics::step_control::StepControl;

impl BallState {
    /// [rad/s] orbital speed about the axis of the outer race.
    pub fn orbital_speed(&self, outer: &BodyState) -> f64 {
        let frame = outer.pose.orientation.inverse();
        let offset = frame * (self.position - outer.pose.position);
        let relative = frame * (self.velocity - outer.velocity);
        (offset.y * relative.z - offset.z * relative.y) / (offset.y * offset.y + offset.z * offset.z)
    }
}

/// A race or the cage. Rates of rotation are material (components along the body's own axes), those of translation spatial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyState {
    /// Pose in world axes.
    pub pose: Pose,
    /// [m/s] velocity of the origin.
    pub velocity: Vector3<f64>,
    /// [rad/s] material angular velocity.
    pub rate: Vector3<f64>,
    /// [m/s2] acceleration of the origin; 0 where the motion is prescribed.
    pub acceleration: Vector3<f64>,
    /// [rad/s2] material angular acceleration; 0 where the motion is prescribed.
    pub rate_derivative: Vector3<f64>,
    /// Total force (spatial) and moment (material), the `g` of the HHT scheme; 0 where the motion is prescribed.
    pub total: Wrench,
    /// Remainder of the equations of motion that the last step left, within their tolerance: force (spatial) and moment (material).
    pub remainder: Wrench,
    /// Lagrange multipliers of its constraints [N, N m].
    pub multipliers: Vec<f64>,
    /// Force and moment of balls and lands on the body, about its origin, world axes.
    pub bearing_wrench: Wrench,
    /// [-] unit vectors of its own axes, as its pairs saw them.
    pub axes: [Vector3<f64>; 3],
    /// [rad/s] angular velocity in world axes, as its pairs saw it: that of `rate` but for rounding.
    pub angular_velocity: Vector3<f64>,
    /// \[rad] turned about the own axis since the start, without limit.
    pub turned: f64,
    /// \[rad] rounding error of `turned` so far (compensated summation): millions of rounded additions would drift.
    pub turned_rest: f64,
}

impl BodyState {
    /// A body with a pose and a twist, free of forces.
    pub fn new(pose: Pose, twist: &Twist, n_constraints: usize) -> Self {
        let rate = pose.orientation.inverse() * twist.angular_velocity;
        Self {
            pose,
            velocity: twist.velocity,
            rate,
            axes: axes_of(&pose.orientation),
            angular_velocity: pose.orientation * rate,
            acceleration: Vector3::zeros(),
            rate_derivative: Vector3::zeros(),
            total: Wrench::default(),
            remainder: Wrench::default(),
            multipliers: vec![0.0; n_constraints],
            bearing_wrench: Wrench::default(),
            turned: 0.0,
            turned_rest: 0.0,
        }
    }

    /// Takes axes and angular velocity, as pairs see them, from pose and rate: after these were changed from outside.
    pub fn refresh_motion(&mut self) {
        self.axes = axes_of(&self.pose.orientation);
        self.angular_velocity = self.pose.orientation * self.rate;
    }

    /// Goes on counting the turn from before a step in which the body turned by `angle` \[rad] (Kahan's summation).
    pub fn count_turn(&mut self, (turned, rest): (f64, f64), angle: f64) {
        let added = angle + rest;
        self.turned = turned + added;
        self.turned_rest = added - (self.turned - turned);
    }

    /// Twist in world axes.
    pub fn twist(&self) -> Twist {
        Twist { velocity: self.velocity, angular_velocity: self.pose.orientation * self.rate }
    }

    /// Becomes a copy of another without taking memory.
    pub fn copy_from(&mut self, other: &Self) {
        let mut multipliers = std::mem::take(&mut self.multipliers);
        multipliers.clone_from(&other.multipliers);
        *self = Self { multipliers, ..*other };
    }

    /// The motion that contacts depend on.
    pub fn motion(&self) -> RaceMotion<f64> {
        RaceMotion {
            position: self.pose.position,
            axis: self.axes[0],
            across: self.axes[1],
            velocity: self.velocity,
            angular_velocity: self.angular_velocity,
        }
    }

    /// The motion with all axes, for contacts of the cage.
    pub fn body_motion(&self) -> BodyMotion<f64> {
        BodyMotion {
            position: self.pose.position,
            axes: self.axes,
            velocity: self.velocity,
            angular_velocity: self.angular_velocity,
        }
    }
}

/// [-] unit vectors of the axes of a frame.
pub fn axes_of(orientation: &UnitQuaternion<f64>) -> [Vector3<f64>; 3] {
    [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| orientation * axis)
}

/// The motion of a race that contacts depend on.
pub fn race_motion(pose: &Pose, twist: &Twist) -> RaceMotion<f64> {
    RaceMotion {
        position: pose.position,
        axis: pose.orientation * Vector3::x(),
        across: pose.orientation * Vector3::y(),
        velocity: twist.velocity,
        angular_velocity: twist.angular_velocity,
    }
}

/// Counters of the integrator since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Steps rejected because of their local error.
    pub rejected_error: u64,
    /// Steps rejected because Newton's method did not converge.
    pub rejected_newton: u64,
    /// Solves that Newton's method began anew from steady motion, because the first guess led nowhere.
    pub second_guesses: u64,
    /// Newton corrections and factorisations, of rejected steps too.
    pub newton: NewtonWork,
    /// Evaluations of a ball-race contact for its value.
    pub contact_values: u64,
    /// Evaluations of a ball-race contact with exact derivatives.
    pub contact_tangents: u64,
    /// Solutions of Kalker's polynomials.
    pub polynomials: u64,
    /// Solutions of Kalker's polynomials that did not converge; the difference to the table then stayed as it was.
    pub polynomial_failures: u64,
}

impl Statistics {
    /// Are these counts that a run can have? A check for states that come from outside.
    pub fn plausible(&self) -> bool {
        // Results show them as exact floating-point numbers.
        const MOST: u64 = 1 << f64::MANTISSA_DIGITS;
        let Self {
            steps,
            rejected_error,
            rejected_newton,
            second_guesses,
            newton,
            contact_values,
            contact_tangents,
            polynomials,
            polynomial_failures,
        } = *self;
        let work = [newton.iterations, newton.factorisations, contact_values, contact_tangents];
        [steps, rejected_error, rejected_newton, second_guesses, polynomials, polynomial_failures]
            .iter()
            .chain(&work)
            .all(|count| *count < MOST)
    }
}

/// Everything that changes while the bearing runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// \[s] time.
    pub time: f64,
    /// Balls, by azimuth at the start.
    pub balls: Vec<BallState>,
    /// Races, and the cage where it is simulated.
    pub bodies: Bodies<BodyState>,
    /// The turn of balls that an ideal cage keeps apart.
    pub spacing: Option<CommonTurn>,
    /// Flexible supports of the races, where they rest on some.
    pub supports: PerRace<Option<SupportState>>,
    /// By ball, the differences of Kalker's polynomials from the table at its contacts with the races; empty where they
    /// are not simulated.
    pub differences: Vec<PerRace<Difference>>,
    /// Step size.
    pub control: StepControl,
    /// \[N] residual that counts as converged in the next step.
    pub force_tolerance: f64,
    /// Newton matrix of the last steps, as far as it is kept.
    pub matrix: KeptMatrix,
    /// How accelerations have changed in the last step: first guesses go on with it.
    pub trend: Trend,
    /// Powers now.
    pub powers: Powers,
    /// Energies since the start.
    pub energies: Energies,
    /// Work since the start.
    pub statistics: Statistics,
    /// Growth of rings and balls; none where growth is not simulated.
    pub grown: Option<Grown>,
    /// Loads since the start as life counts them; none where it is not asked for.
    pub rating: Option<rating::Sums>,
    /// Temperatures from the heat of friction; none where that is not simulated.
    pub warm: Option<Warm>,
    /// Heat since the start by contact; none where it is not reported.
    pub heat: Option<heat::Sums>,
    /// Integrals since the start of what has means; none where they are not reported.
    pub means: Option<means::Sums>,
    /// Orientation of each damaged ball, in world axes; none where all balls are whole.
    pub orientations: Option<Vec<UnitQuaternion<f64>>>,
}

impl State {
    /// Becomes a copy of another without taking memory, where both are of one bearing.
    pub fn copy_from(&mut self, other: &Self) {
        let Self {
            time,
            balls,
            bodies,
            spacing,
            supports,
            differences,
            control,
            force_tolerance,
            matrix,
            trend,
            powers,
            energies,
            statistics,
            grown,
            rating,
            warm,
            heat,
            means,
            orientations,
        } = self;
        (*time, *force_tolerance, *statistics) = (other.time, other.force_tolerance, other.statistics);
        balls.clone_from(&other.balls);
        match bodies.len() == other.bodies.len() {
            true => bodies
                .iter_mut()
                .zip(other.bodies.iter())
                .for_each(|((_, own), (_, other))| own.copy_from(other)),
            false => bodies.clone_from(&other.bodies),
        }
        matrix.copy_from(&other.matrix);
        trend.step = other.trend.step;
        trend.changes.clone_from(&other.trend.changes);
        trend.smooth.clone_from(&other.trend.smooth);
        spacing.clone_from(&other.spacing);
        supports.clone_from(&other.supports);
        differences.clone_from(&other.differences);
        control.clone_from(&other.control);
        powers.clone_from(&other.powers);
        energies.clone_from(&other.energies);
        grown.clone_from(&other.grown);
        rating.clone_from(&other.rating);
        warm.clone_from(&other.warm);
        heat.clone_from(&other.heat);
        means.clone_from(&other.means);
        orientations.clone_from(&other.orientations);
    }

    /// Force and moment of the bearing on what holds a race: on its flange where it rests on a support.
    pub fn wrench_on(&self, race: Race) -> Wrench {
        self.supports[race].as_ref().map_or(self.race(race).bearing_wrench, |support| support.wrench)
    }

    /// [N m] torque that keeps a race at its prescribed speed; against that of the bearing where nothing does. `body` is the race as
    /// it is moved.
    pub fn drive_torque(&self, body: Option<&RigidBody>, race: Race) -> f64 {
        let spin = body.and_then(|body| body.constraints.iter().position(|c| matches!(c, Constraint::Spin)));
        let state = self.race(race);
        match spin {
            Some(index) => state.multipliers[index],
            None => -self.wrench_on(race).moment.dot(&(state.pose.orientation * Vector3::x())),
        }
    }

    /// [rad/s] spin of the cage about its own axis; without a cage, mean orbital speed of the balls.
    pub fn cage_speed(&self) -> f64 {
        if let Some(turn) = &self.spacing {
            return turn.speed;
        }
        let outer = self.race(Race::Outer);
        let orbits =
            || self.balls.iter().map(|ball| ball.orbital_speed(outer)).sum::<f64>() / self.balls.len() as f64;
        self.cage().map_or_else(orbits, |cage| cage.rate.x)
    }

    /// The state of a race.
    pub fn race(&self, race: Race) -> &BodyState {
        &self.bodies[race]
    }

    /// Pose and twist that are given for a race: those of its flange where it rests on a support, else its own.
    pub fn given_motion(&self, race: Race) -> (Pose, Twist) {
        match &self.supports[race] {
            Some(support) => (support.flange, support.flange_twist),
            None => (self.race(race).pose, self.race(race).twist()),
        }
    }

    /// The state of the cage, where it is simulated.
    pub fn cage(&self) -> Option<&BodyState> {
        self.bodies.get(Body::Cage)
    }

    /// Are all numbers finite that outputs are computed from? Powers and energies are those of all contacts.
    pub fn is_finite(&self) -> bool {
        let of_ball = |ball: &BallState| {
            let BallState { position, velocity, angular_velocity, .. } = ball;
            let BallState { acceleration, angular_acceleration, total, .. } = ball;
            position.sum()
                + velocity.sum()
                + angular_velocity.sum()
                + acceleration.sum()
                + angular_acceleration.sum()
                + wrench_sum(total)
        };
        let of_body = |(_, body): (Body, &BodyState)| {
            let Pose { position, orientation } = &body.pose;
            let rest = position.sum() + orientation.coords.sum() + body.velocity.sum() + body.rate.sum();
            rest + wrench_sum(&body.bearing_wrench) + body.multipliers.iter().sum::<f64>() + body.turned
        };
        let of_support = |support: &SupportState| wrench_sum(&support.wrench) + support.energy;
        let Powers { input, friction, damping, around } = self.powers;
        let warm = self.warm.map_or(0.0, |warm| warm.rises.iter().sum::<f64>() + warm.out);
        let energies = self.energies.input + self.energies.lost() + self.energies.stiffened;
        // A sum of numbers of which one is not finite is not finite.
        let sum = self.balls.iter().map(of_ball).sum::<f64>()
            + self.bodies.iter().map(of_body).sum::<f64>()
            + self.supports.iter().flatten().map(of_support).sum::<f64>()
            + self.spacing.as_ref().map_or(0.0, CommonTurn::sum);
        (sum + self.time + input + friction + damping + around + energies + warm).is_finite()
    }

    /// Difference of Kalker's polynomials from the table at a ball's contact with a race, where they are simulated.
    pub fn difference(&self, ball: usize, race: Race) -> Option<&Difference> {
        self.differences.get(ball).map(|differences| &differences[race])
    }
}

/// How the unknowns of a step, accelerations and multipliers, have changed in the last one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Trend {
    /// \[s] size of that step.
    pub step: f64,
    /// Changes of the unknowns beyond the turn of orbits, in their units; where steps have stages, unknowns at the start and at a stage over those
    /// at the end. Empty before the first step.
    pub changes: Vec<f64>,
    /// Were they small, and nearer to what the step before led to expect than to nothing? Of each ball between races of prescribed motion, which
    /// it follows alone; else one for all.
    pub smooth: Vec<bool>,
}

/// Newton matrix as far as steps share it: the balls, eliminated. It is part of the state, as many steps use it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KeptMatrix {
    /// \[s] size of the steps that it is for.
    pub step: f64,
    /// Blocks of all balls; empty while there is no matrix.
    pub balls: Vec<KeptBlock>,
    /// The blocks themselves, several in the lanes of one, and their couplings to the bodies that forces move.
    pub blocks: Vec<Eliminated>,
    /// Rows of the bodies that forces move.
    pub border: KeptBorder,
}

impl KeptMatrix {
    /// Becomes a copy of another without taking memory, where both have as many blocks.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { step, balls, blocks, border } = self;
        *step = other.step;
        balls.clone_from(&other.balls);
        blocks.truncate(other.blocks.len());
        blocks.iter_mut().zip(&other.blocks).for_each(|(own, other)| own.copy_from(other));
        blocks.extend_from_slice(&other.blocks[blocks.len()..]);
        border.rows.clone_from(&other.border.rows);
        border.axes.clone_from(&other.border.axes);
    }
}

/// Rows of the bodies that forces move, and of an ideal cage, with what the balls leave in them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KeptBorder {
    /// The rows, column by column; none while there is no matrix.
    pub rows: Vec<f64>,
    /// What turned world axes into those of each body's moments when they were computed.
    pub axes: Vec<Matrix3<f64>>,
}

impl KeptBorder {
    /// Are these so many rows, of so many bodies, or none? A check for those that come from outside.
    pub fn fits(&self, rows: usize, bodies: usize) -> bool {
        self.rows.is_empty() || (self.rows.len() == rows * rows && self.axes.len() == bodies)
    }
}

/// Age and place of the eliminated block of one ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeptBlock {
    /// \[m] where the ball was, seen from the outer race: the block turns with the orbit of its ball.
    pub offset: Vector3<f64>,
    /// When it is to be computed anew.
    pub renewal: BlockRenewal,
}

/// Costs of a kept block, and the back-off by which steps begin with a new one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlockRenewal {
    /// [-] price of the corrections that it was not good enough for, over that of a new one.
    pub price: f64,
    /// Steps to come that begin with a new one, because old ones were no good.
    pub due: u8,
    /// Steps that were to begin with a new one when that happened last; 0 once an old one was good enough.
    pub pause: u8,
    /// Was it computed for the present step?
    pub new: bool,
}

fn wrench_sum(wrench: &Wrench) -> f64 {
    wrench.force.sum() + wrench.moment.sum()
}

/// Force and moment as one vector.
pub fn stack(force: &Vector3<f64>, moment: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Unit quaternion kept at unit length after many products.
pub fn normalised(q: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(q.into_inner())
}
