//! Bearings without states between structures: their elements are in balance at every place of the rings ([`crate::quasi_static`]).

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Dyn, Matrix3, Matrix6, OMatrix, U6, UnitQuaternion, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::step::{MayLeave, StructureStep};
use super::structure::{Seat, StructureTrial};
use crate::dynamics::carried::SeatMotion;
use crate::model::bodies::{PerRace, Race};
use crate::model::state::stack;
use crate::model::structure::{Carrier, StructureState, Turning};
use crate::model::{Conditions, Model};
use crate::numerics::motion::{Pose, Twist, Wrench};
use crate::numerics::tilt;
use crate::quasi_static::bearing::{Balls, Forces, Rested, RingMotion};
use crate::quasi_static::rings::Placed;
use crate::schema::Solver;

/// [-] share of a load that a residual may leave, over the local error that a step may make, in rolling elements, and at most. Contacts give way by a
/// thousandth of an element, so that this is a tenth of what the step may be wrong by; and what is left is made good by the next step.
const SHARE_OF_LOAD: [f64; 2] = [100.0, 1e-5];
/// [rad/s] speed of the races against each other below which friction goes with it: what sticks is not known at this level.
pub const CREEPS: f64 = 1e-3;
/// \[N] residual that is small enough for any bearing.
const FORCE_TOLERANCE: f64 = 1e-6;

/// \[N] residual that is small enough where the largest load \[N] is this, with settings of the steps.
pub fn residual_of(largest: f64, solver: &Solver) -> f64 {
    let [share, most] = SHARE_OF_LOAD;
    FORCE_TOLERANCE.max((share * solver.tolerance_without_states()).min(most) * largest)
}

/// A bearing without states, between its seats.
#[derive(Clone, Debug)]
pub struct ElementJoint {
    /// Index of the bearing.
    pub bearing: usize,
    /// Structure and seat of each race that a structure carries.
    pub seats: PerRace<Option<(usize, Seat)>>,
}

/// Damping of contacts that roll.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Damping {
    /// Force and moment on the inner race against its twist as seen from the outer one.
    pub matrix: Matrix6<f64>,
    /// \[N] sum of the loads on the inner race that it is of.
    pub load: f64,
    /// [rad/s] speed of the cage against the outer race that it is of.
    pub rate: f64,
}

impl Damping {
    /// As it is in another state: in proportion to the loads, and as creep is a slip over a speed, to its inverse, but no more than it was.
    fn at(&self, state: &ElementState, rate: f64) -> Matrix6<f64> {
        self.matrix * ((state.load() / self.load).min(1.0) * (self.rate / rate).abs().min(1.0))
    }
}

/// State of a bearing without states: where its elements are, which is where they are looked for next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ElementState {
    /// \[rad] turn of the elements since the start.
    pub turn: f64,
    /// [rad/s] its rate.
    pub rate: f64,
    /// [-] speed of the cage against the outer race over that of the inner race against it, as balls rolled where this level began.
    pub ratio: f64,
    /// [-] share of the spin of balls that is on the outer race, as they rolled where this level began.
    pub spin_share: f64,
    /// Damping of its contacts, by creep too, where its balls rolled there.
    pub damping: Option<Damping>,
    /// The elements.
    pub rested: Vec<Rested>,
    /// \[N] largest load.
    pub largest: f64,
    /// Friction of its contacts.
    pub friction: KeptFriction,
}

/// Friction of the contacts of a bearing without states: it changes slowly, and serves as long as the bearing is near where it was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KeptFriction {
    /// [N m] torque that brings the losses of the contacts.
    pub torque: f64,
    /// Where it was found; nowhere before the first.
    pub found: Option<FrictionPlace>,
}

/// What the friction of a bearing without states depends on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionPlace {
    /// \[rad] turn of the elements.
    pub turn: f64,
    /// \[N] sum of the loads on the inner race.
    pub load: f64,
    /// [rad/s] speed of the inner race against the outer one.
    pub speed: f64,
    /// Conditions of the contacts.
    pub conditions: Conditions,
}

/// [-] change of load or speed with which friction is taken anew. Torques follow the load with its power 4/3 and the speed with its square, in drag, at
/// most: they are wrong by 2 %.
const FRICTION_CHANGE: f64 = 0.01;
/// Times that friction is taken to the passing of a ball, at least: what changes with it, changes once in it.
const FRICTIONS_PER_BALL: f64 = 4.0;

impl KeptFriction {
    /// Does it serve at a place of so many elements?
    pub fn serves(&self, count: usize, at: &FrictionPlace) -> bool {
        let near = |now: f64, then: f64| (now - then).abs() <= FRICTION_CHANGE * then.abs();
        let passing = TAU / count as f64;
        self.found.is_some_and(|then| {
            (at.turn - then.turn).abs() * FRICTIONS_PER_BALL <= passing
                && near(at.load, then.load)
                && near(at.speed, then.speed)
                && at.conditions == then.conditions
        })
    }
}

impl ElementState {
    /// \[N] sum of the loads on the inner race.
    pub fn load(&self) -> f64 {
        self.rested.iter().map(|ball| ball.loads[0]).sum()
    }
}

/// A bearing without states in a step.
#[derive(Clone, Debug)]
pub struct ElementStep<'a> {
    /// Between what.
    pub joint: &'a ElementJoint,
    /// State at the start.
    pub start: &'a ElementState,
    /// Its elements.
    pub balls: Balls,
    /// Given motion of races that nothing carries.
    pub given: &'a PerRace<(Pose, Twist)>,
    /// Damping of contacts that roll, by the twist of the inner race as seen from the outer one.
    pub damping: Option<Matrix6<f64>>,
    /// \[s] time since the start.
    pub elapsed: f64,
    /// What the step may leave.
    pub may_leave: MayLeave,
}

/// Both races in a trial.
#[derive(Clone, Debug)]
pub struct Seen {
    seats: PerRace<Option<SeatMotion>>,
    /// Poses and twists.
    pub races: PerRace<(Pose, Twist)>,
    /// The outer race's axes, without its spin.
    frame: UnitQuaternion<f64>,
    /// The inner race from there.
    pub motion: RingMotion,
    /// [-] axis of the inner race.
    axis: Vector3<f64>,
    /// [rad/s] its speed about that against the outer race.
    pub speed: f64,
}

/// What the elements do to both races.
#[derive(Clone, Copy, Debug, Default)]
pub struct OnRaces {
    /// Force and moment on each, about its origin, world axes.
    pub wrenches: PerRace<Wrench>,
    /// \[J] elastic energy.
    pub elastic: f64,
    /// \[W] lost to damping.
    pub damped: f64,
    /// \[W] lost to friction.
    pub rubbed: f64,
}

impl<'a> ElementStep<'a> {
    /// A step of `h` \[s] of these balls.
    pub fn new(
        joint: &'a ElementJoint,
        start: &'a ElementState,
        balls: Balls,
        given: &'a PerRace<(Pose, Twist)>,
        h: f64,
        may_leave: MayLeave,
    ) -> Self {
        let damping = start.damping.as_ref().map(|damping| damping.at(start, start.rate));
        Self { joint, start, balls, given, damping, elapsed: h, may_leave }
    }

    /// The races where the structures are.
    pub fn see(&self, trials: &[StructureTrial], structures: &[StructureStep<'_>]) -> Seen {
        let seats = PerRace::new(|race| {
            let (structure, seat) = self.joint.seats[race].as_ref()?;
            Some(trials[*structure].seat(structures[*structure].model, seat))
        });
        self.seen(seats)
    }

    /// The races where structures are in these states.
    pub fn seen_in(&self, carriers: &[Carrier], states: &[StructureState]) -> Seen {
        let seats = PerRace::new(|race| {
            let (structure, seat) = self.joint.seats[race].as_ref()?;
            let StructureState { coordinates, rates, accelerations, spin, .. } = &states[*structure];
            let given = (carriers[*structure].structure.turning == Turning::Given).then_some(spin);
            Some(seat.motion([coordinates, rates, accelerations], given))
        });
        self.seen(seats)
    }

    fn seen(&self, seats: PerRace<Option<SeatMotion>>) -> Seen {
        let races = PerRace::new(|race| {
            seats[race].as_ref().map_or(self.given[race], |seat: &SeatMotion| (seat.pose(), seat.twist()))
        });
        let axes = PerRace::new(|race| {
            let (pose, _): &(Pose, Twist) = &races[race];
            pose.orientation * Vector3::x()
        });
        let frame = UnitQuaternion::new(tilt::of_axis(&races.outer.0.orientation));
        let [inner, outer] = [&races.inner, &races.outer];
        let speeds = PerRace::new(|race| {
            let (_, twist): &(Pose, Twist) = &races[race];
            twist.angular_velocity.dot(&axes[race])
        });
        let arm = inner.0.position - outer.0.position;
        let tilting = outer.1.angular_velocity - axes.outer * speeds.outer;
        let velocity = inner.1.velocity - outer.1.velocity - tilting.cross(&arm);
        let back = |v: Vector3<f64>| frame.inverse() * v;
        let rate = speeds.outer + self.start.ratio * (speeds.inner - speeds.outer);
        let turn = self.start.turn + 0.5 * self.elapsed * (self.start.rate + rate);
        let motion = RingMotion {
            placed: Placed { position: back(arm), axis: back(axes.inner) },
            twist: stack(&back(velocity), &back(inner.1.angular_velocity - tilting)),
            turn: [turn, rate],
        };
        let axis = axes.inner;
        let speed = (inner.1.angular_velocity - outer.1.angular_velocity).dot(&axis);
        Seen { seats, races, frame, motion, axis, speed }
    }

    /// Forces there.
    pub fn forces(&self, seen: &Seen) -> OnRaces {
        self.on_races(seen, &self.balls.forces(&seen.motion, &self.start.rested, |_, _, _| ()))
    }

    /// Forces of the elements as those on both races.
    fn on_races(&self, seen: &Seen, of: &Forces) -> OnRaces {
        let held = self.damping.map_or_else(Vector6::zeros, |damping| damping * seen.motion.twist);
        let wrench = of.wrench - held;
        let halves = |from: usize| seen.frame * wrench.fixed_rows::<3>(from);
        let (force, moment) = (halves(0), halves(3));
        let [inner, outer] = [&seen.races.inner.0, &seen.races.outer.0];
        // A cage of given speed hands the moment that it takes to the rings, as their speeds make its own.
        let friction = self.start.friction.torque * seen.speed / seen.speed.hypot(CREEPS);
        let moment = moment + seen.axis * (self.start.ratio * of.turning - friction);
        let arm = inner.position - outer.position;
        OnRaces {
            wrenches: PerRace {
                inner: Wrench { force, moment },
                outer: Wrench { force: -force, moment: -(moment + arm.cross(&force)) },
            },
            elastic: of.elastic,
            damped: of.damped + held.dot(&seen.motion.twist),
            rubbed: friction * seen.speed,
        }
    }

    /// State of the elements where the races are, and their forces.
    pub fn rest(&self, model: &Model, conditions: &Conditions, seen: &Seen) -> (ElementState, OnRaces) {
        let mut rested = self.start.rested.clone();
        let forces = self.balls.rest(model, conditions, &seen.motion, &mut rested);
        let [turn, rate] = seen.motion.turn;
        let largest = rested.iter().flat_map(|ball| ball.loads).fold(0.0, f64::max);
        (ElementState { turn, rate, rested, largest, ..*self.start }, self.on_races(seen, &forces))
    }

    /// Adds the forces to trials of the structures.
    pub fn add(&self, seen: &Seen, on: &OnRaces, trials: &mut [StructureTrial]) {
        for race in Race::BOTH {
            if let (Some((structure, seat)), Some(motion)) = (&self.joint.seats[race], &seen.seats[race]) {
                trials[*structure].add(seat, motion, &on.wrenches[race]);
            }
        }
    }

    /// Adds the derivatives of the structures' residuals by their coordinates and by their rates, times these gains, to a matrix, whose first rows of each
    /// structure are these.
    pub fn add_tangent(
        &self,
        (seen, on): (&Seen, &OnRaces),
        [by_coordinates, by_rates]: [f64; 2],
        rows: &[usize],
        matrix: &mut DMatrix<f64>,
    ) {
        let tangents = self.balls.tangents(&seen.motion, &self.start.rested);
        let mut by_displacement = tangents.by_displacement;
        // A ring that spins turns the elements along.
        let mut by_spin = by_displacement.column_mut(3);
        by_spin += tangents.by_turn * self.start.ratio;
        let mut by_rate = tangents.by_rate - self.damping.unwrap_or_else(Matrix6::zeros);
        // Of `W/sqrt(W^2 + w^2)`.
        by_rate[(3, 3)] -= self.start.friction.torque * CREEPS * CREEPS / seen.speed.hypot(CREEPS).powi(3);
        let gains = by_displacement * by_coordinates + by_rate * by_rates;
        let ends = PerRace::new(|race| self.relative(race, seen));
        for row in Race::BOTH {
            let (Some((structure, seat)), Some(of_row)) = (&self.joint.seats[row], &ends[row]) else {
                continue;
            };
            let at = rows[*structure];
            for column in Race::BOTH {
                let (Some((other, seat_of_column)), Some(of_column)) =
                    (&self.joint.seats[column], &ends[column])
                else {
                    continue;
                };
                let block = -of_row.tr_mul(&(gains * of_column));
                let to = rows[*other];
                for (i, row) in seat.coordinates().iter().enumerate() {
                    for (k, column) in seat_of_column.coordinates().iter().enumerate() {
                        matrix[(at + row, to + column)] += block[(i, k)];
                    }
                }
            }
            if let Some(motion) = &seen.seats[row] {
                let moment = &on.wrenches[row].moment;
                let turned = StructureTrial::turned_moments(seat, motion, moment, by_coordinates);
                for (i, row) in seat.coordinates().iter().enumerate() {
                    for (k, column) in seat.coordinates().iter().enumerate() {
                        matrix[(at + row, at + column)] += turned[(i, k)];
                    }
                }
            }
        }
    }

    /// Motion of the inner race as seen from the outer one by the coordinates of the seat of a race.
    fn relative(&self, race: Race, seen: &Seen) -> Option<OMatrix<f64, U6, Dyn>> {
        let ((_, seat), motion) = (self.joint.seats[race].as_ref()?, seen.seats[race].as_ref()?);
        let back: Matrix3<f64> = seen.frame.inverse().to_rotation_matrix().into_inner();
        let columns = motion.columns();
        let mut by_seat = Matrix6::zeros();
        match race {
            Race::Inner => {
                by_seat.fixed_view_mut::<3, 3>(0, 0).copy_from(&back);
                by_seat.fixed_view_mut::<3, 3>(3, 3).copy_from(&(back * columns));
            }
            Race::Outer => {
                let arm = seen.races.inner.0.position - seen.races.outer.0.position;
                // Its spin is none of the frame.
                let axis = seen.races.outer.0.orientation * Vector3::x();
                let tilting = columns - axis * (axis.transpose() * columns);
                by_seat.fixed_view_mut::<3, 3>(0, 0).copy_from(&-back);
                by_seat.fixed_view_mut::<3, 3>(0, 3).copy_from(&(back * arm.cross_matrix() * tilting));
                by_seat.fixed_view_mut::<3, 3>(3, 3).copy_from(&-(back * tilting));
            }
        }
        Some(by_seat * seat.map())
    }
}

impl Seen {
    /// [rad/s] speeds of the cage, the inner and the outer race.
    pub fn speeds(&self) -> [f64; 3] {
        let (pose, twist) = &self.races.outer;
        let outer = twist.angular_velocity.dot(&(pose.orientation * Vector3::x()));
        [self.motion.turn[1], outer + self.speed, outer]
    }

    /// A vector of the world in the outer race's axes, which do not spin.
    pub fn in_outer(&self, v: &Vector3<f64>) -> Vector3<f64> {
        self.frame.inverse() * v
    }

    /// A vector of the outer race's axes in those of the world.
    pub fn in_world(&self, v: &Vector3<f64>) -> Vector3<f64> {
        self.frame * v
    }
}

/// \[W] what both races put into the elements.
pub fn power_of(seen: &Seen, on: &OnRaces) -> f64 {
    let of = |race: Race| -seen.races[race].1.power(&on.wrenches[race]);
    of(Race::Inner) + of(Race::Outer)
}
