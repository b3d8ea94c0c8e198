//! Bearings without states: how they join structures, and how their states are shown as those of bearings that have some.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{Vector2, Vector3};

use super::super::point::Point;
use super::super::together::{Stopped, Together};
use super::super::{Simulation, SimulationError, conditions_with};
use super::structures::Structures;
use crate::analysis::condensed::Condensed;
use crate::dynamics::system::elements::{
    CREEPS, Damping, ElementJoint, ElementState, ElementStep, FrictionPlace, KeptFriction, OnRaces, Seen,
    power_of, residual_of,
};
use crate::dynamics::system::{Joint, MayLeave};
use crate::dynamics::{Allowed, Boundary};
use crate::effects::rating::Turning;
use crate::equilibrium::MAX_APPROACH;
use crate::forces::{Contacts, kinetic_energy_of};
use crate::model::Conditions;
use crate::model::balance::may_be_left;
use crate::model::bearing::azimuth_directions;
use crate::model::bodies::{PerRace, Race};
use crate::model::energies::Powers;
use crate::model::link::LinkState;
use crate::model::state::{BodyState, State};
use crate::model::structure::{Carrier, StructureState};
use crate::quasi_static::bearing::{Balls, Rested};
use crate::scene::Level;
use crate::scene::system::SystemScene;

/// Steps to the passing of a ball.
const STEPS_PER_BALL: f64 = 16.0;
/// [rad/s] speed of the races against each other below which nothing is said of how balls roll.
const NO_SPEED: f64 = 1e-6;
/// [rad/s] speed of the cage against the outer race from which on contacts damp by creep.
const ROLLS: f64 = 0.1;

/// Marks the bearings of the scene that are without states, at its present levels; gives these with their seats, and the joints of the others, which are
/// counted without them.
pub fn joints(
    scene: &SystemScene,
    joints: &[Joint],
    bearings: &mut [Simulation],
) -> (Vec<ElementJoint>, Vec<Joint>) {
    let (mut elements, mut stepped, mut count) = (vec![], vec![], 0);
    for (index, (mounted, bearing)) in scene.bearings.iter().zip(bearings).enumerate() {
        let own = joints.iter().filter(|joint| joint.bearing == index);
        let without_states = mounted.level() == Level::Equilibrium;
        if bearing.model.without_states != without_states {
            Arc::make_mut(&mut bearing.model).without_states = without_states;
        }
        if !without_states {
            stepped.extend(own.map(|joint| Joint { bearing: count, ..joint.clone() }));
            count += 1;
            continue;
        }
        let seats = PerRace::new(|race| {
            let joint = joints.iter().find(|joint| joint.bearing == index && joint.race == race)?;
            Some((joint.structure, joint.seat.clone()))
        });
        elements.push(ElementJoint { bearing: index, seats });
    }
    (elements, stepped)
}

/// [-] speed of the cage against the outer race over that of the inner race against it, as balls roll at the start.
fn ratio(bearing: &Simulation) -> f64 {
    let [inner, outer] = Race::BOTH.map(|race| bearing.state.race(race).rate.x);
    let free = bearing.model.bearing.epicyclic_ratio(bearing.model.bearing.free_contact_angle);
    match inner - outer {
        none if none.abs() < NO_SPEED => free,
        relative => (bearing.outputs().rolling_speed - outer) / relative,
    }
}

/// Damping of the contacts of a bearing as its balls roll at the start; none where they hardly roll, as a contact that sticks is no damper.
fn damping(bearing: &Simulation) -> Option<Damping> {
    let [_, outer] = Race::BOTH.map(|race| bearing.state.race(race).rate.x);
    let outputs = bearing.outputs();
    let rate = outputs.rolling_speed - outer;
    let load: f64 = outputs.balls.iter().map(|ball| ball.inner.load).sum();
    if rate.abs() <= ROLLS || load <= 0.0 {
        return None;
    }
    let mut matrix = Condensed::new(&bearing.model, &bearing.state, &bearing.conditions()).damping;
    // What turns the race about its axis is friction, no damping.
    matrix.row_mut(3).fill(0.0);
    matrix.column_mut(3).fill(0.0);
    Some(Damping { matrix, load, rate })
}

/// States of the elements where a run starts.
pub fn started(
    elements: &[ElementJoint],
    carriers: &[Carrier],
    states: &[StructureState],
    bearings: &mut [Simulation],
) -> Vec<ElementState> {
    elements
        .iter()
        .map(|joint| started_at(0.0, joint, (carriers, states), &mut bearings[joint.bearing]))
        .collect()
}

/// State of the elements of a bearing that is in equilibrium, where they have turned by so much \[rad].
pub fn started_at(
    turn: f64,
    joint: &ElementJoint,
    (carriers, states): (&[Carrier], &[StructureState]),
    bearing: &mut Simulation,
) -> ElementState {
    let boundary = bearing.boundary(bearing.state.time);
    let nothing = ElementState {
        turn,
        rate: 0.0,
        ratio: ratio(bearing),
        spin_share: 0.0,
        damping: damping(bearing),
        rested: vec![],
        largest: 0.0,
        friction: KeptFriction::default(),
    };
    let mut step = step(joint, &nothing, bearing, &boundary, 0.0);
    let seen = step.seen_in(carriers, states);
    let speeds = seen.speeds();
    step.balls = Balls::new(&bearing.model, &boundary.conditions, [speeds[0], speeds[2]]);
    if nothing.damping.is_some() {
        step.balls.leave_damping();
    }
    let placed = step.balls.placed(&bearing.model, &boundary.conditions, &seen.motion);
    let [_, rate] = seen.motion.turn;
    // As balls roll there, in the plane of each.
    let angular = bearing.state.balls.iter().map(|ball| {
        let [place, angular] = [ball.position - seen.races.outer.0.position, ball.angular_velocity]
            .map(|vector| seen.in_outer(&vector));
        Vector2::new(angular.x, angular.yz().dot(&place.yz().normalize()))
    });
    let spin_share = step.balls.spin_share(&placed, angular, speeds);
    let mut state = ElementState { rate, rested: placed, spin_share, ..nothing };
    // The second time with the friction that the first one finds.
    for _ in 0..2 {
        let start = state;
        let step = ElementStep { start: &start, ..step.clone() };
        let (rested, on) = step.rest(&bearing.model, &boundary.conditions, &seen);
        state = bearing.rest(&step, (&seen, &on), rested, &boundary, None);
    }
    state
}

/// The elements of all bearings in a step of `h` \[s] to these boundaries.
pub fn steps<'a>(
    elements: &'a [ElementJoint],
    states: &'a [ElementState],
    bearings: &[Simulation],
    boundaries: &'a [Boundary],
    h: f64,
) -> Vec<ElementStep<'a>> {
    let of = |(joint, state): (&'a ElementJoint, &'a ElementState)| {
        step(joint, state, &bearings[joint.bearing], &boundaries[joint.bearing], h)
    };
    elements.iter().zip(states).map(of).collect()
}

/// The elements of a bearing in a step of `h` \[s] to a boundary.
pub fn step<'a>(
    joint: &'a ElementJoint,
    start: &'a ElementState,
    bearing: &Simulation,
    boundary: &'a Boundary,
    h: f64,
) -> ElementStep<'a> {
    let model = &bearing.model;
    let solver = &model.solver;
    let outer = bearing.state.race(Race::Outer).rate.x;
    let unresolved = (solver.unresolved > 0.0).then(|| solver.unresolved_share() * start.largest);
    let length = solver.tolerance_without_states() * 2.0 * model.bearing.ball.radius;
    let error = Allowed { length, unresolved };
    let may_leave = MayLeave { force: residual_of(start.largest, solver), error };
    // Inertia follows the speeds of the start of the step.
    let mut balls = Balls::new(model, &boundary.conditions, [start.rate, outer]);
    if start.damping.is_some() {
        balls.leave_damping();
    }
    ElementStep::new(joint, start, balls, &boundary.motion, h, may_leave)
}

impl Structures {
    /// Bearings without states in a step of `h` \[s] to these boundaries.
    pub fn element_steps<'a>(
        &'a self,
        bearings: &[Simulation],
        boundaries: &'a [Boundary],
        h: f64,
    ) -> Vec<ElementStep<'a>> {
        steps(&self.elements, &self.element_states, bearings, boundaries, h)
    }
}

impl Structures {
    /// Refuses rollers that are out of balance; what is not a number is no balance.
    fn check_links(&self, time: f64) -> Result<(), SimulationError> {
        let balanced = |state: &LinkState| state.unbalanced <= 1.0;
        match self.link_states.iter().position(|state| !balanced(state)) {
            Some(link) => Err(rollers_out_of_balance(&self.scene, link, time)),
            None => Ok(()),
        }
    }
}

/// A link whose rollers are out of balance at a time \[s].
pub fn rollers_out_of_balance(scene: &SystemScene, link: usize, time: f64) -> SimulationError {
    let bearing = scene.link_names().nth(link).unwrap_or_default().to_owned();
    SimulationError::RollersOutOfBalance { time, bearing }
}

impl Together<'_> {
    /// Takes the elements of bearings without states to where the structures are, after a step of `h` \[s].
    pub fn rest_elements(&mut self, boundaries: &[Boundary], h: f64) {
        let Some(structures) = &mut self.structures else { return };
        let mut states = vec![];
        for step in structures.element_steps(self.bearings, boundaries, h) {
            let (bearing, boundary) =
                (&mut self.bearings[step.joint.bearing], &boundaries[step.joint.bearing]);
            let seen = step.seen_in(&structures.carriers, &structures.states);
            let (state, on) = step.rest(&bearing.model, &boundary.conditions, &seen);
            states.push(bearing.rest(&step, (&seen, &on), state, boundary, Some(h)));
        }
        structures.element_states = states;
    }

    /// Refuses contacts of bearings without states which no material takes, or where no groove is, and rollers out of balance.
    pub fn check_elements(&self) -> Result<(), Stopped> {
        let Some(structures) = &self.structures else { return Ok(()) };
        structures.check_links(self.time()).map_err(|why| (0, why))?;
        for (joint, state) in structures.elements.iter().zip(&structures.element_states) {
            self.bearings[joint.bearing].check_rested(state).map_err(|why| (joint.bearing, why))?;
        }
        Ok(())
    }
}

impl Simulation {
    /// \[s] longest step of a bearing without states, with the shortest period \[s] of what the script gives: one in which no ball passes unseen.
    pub(in super::super) fn longest_of_elements(&self, script: Option<f64>) -> Option<f64> {
        let rate =
            self.state.balls.first().map_or(0.0, |ball| ball.orbital_speed(self.state.race(Race::Outer)));
        let passing = TAU / (self.state.balls.len() as f64 * rate.abs());
        script.into_iter().chain([passing]).map(|period| period / STEPS_PER_BALL).reduce(f64::min)
    }

    /// Shows elements as balls, after a step of `h` \[s] or none; gives their state with the friction that their contacts have there.
    fn rest(
        &mut self,
        step: &ElementStep<'_>,
        (seen, on): (&Seen, &OnRaces),
        mut after: ElementState,
        boundary: &Boundary,
        h: Option<f64>,
    ) -> ElementState {
        let model = &self.model;
        let state = &mut self.state;
        let before = (state.time, state.powers);
        state.time = boundary.time;
        for race in Race::BOTH {
            let (pose, twist) = &seen.races[race];
            let body = &mut state.bodies[race];
            let (turned, rest, spin) = (body.turned, body.turned_rest, body.rate.x);
            let mut moved = BodyState::new(*pose, twist, 0);
            moved.bearing_wrench = on.wrenches[race];
            moved.count_turn((turned, rest), 0.5 * (boundary.time - before.0) * (spin + moved.rate.x));
            *body = moved;
        }
        let kinetic = |state: &State| {
            let each = state.balls.iter().map(|ball| kinetic_energy_of(&model.bearing.ball, &ball.motion()));
            each.fold(0.0, |sum, energy| sum + energy)
        };
        let moving = kinetic(state);
        let speeds = seen.speeds();
        let outer = &seen.races.outer;
        for (index, (ball, rested)) in state.balls.iter_mut().zip(&after.rested).enumerate() {
            let (radial, across) = azimuth_directions(step.balls.azimuth(index, after.turn));
            let [position, angular] = step.balls.motion(rested, &radial, speeds, after.spin_share);
            let along = across * (speeds[0] * position.dot(&radial));
            ball.position = outer.0.position + seen.in_world(&position);
            ball.velocity = outer.1.velocity + seen.in_world(&along);
            ball.angular_velocity = seen.in_world(&angular);
            ball.acceleration = Vector3::zeros();
            ball.angular_acceleration = Vector3::zeros();
        }
        state.powers = Powers {
            input: power_of(seen, on),
            damping: on.damped,
            friction: on.rubbed,
            ..Powers::default()
        };
        if let Some(grown) = &mut state.grown {
            grown.warmth = boundary.conditions.warmth;
        }
        let loads = after.rested.iter().map(|ball| ball.loads);
        let force = on.wrenches.inner.force;
        let turning = Turning {
            force: [-force.y, -force.z],
            spins: Race::BOTH.map(|race| state.race(race).rate.x),
            load_speed: 0.0,
        };
        if let (Some(rating), Some(sums)) = (&model.rating, &mut state.rating) {
            let now = rating.at(loads, turning);
            match h {
                Some(h) => sums.add(now, h),
                None => sums.begin(now),
            }
        }
        let moved = kinetic(state);
        if let Some(h) = h {
            state.statistics.steps += 1;
            let put_in = step.balls.put_in(&step.start.rested, &after.rested) + moved - moving;
            let left = state.energies.add((&before.1, &state.powers), h, put_in);
            state.energies.close(left, on.elastic + moved);
        } else {
            state.energies.stored = on.elastic + moved;
        }
        let Conditions { friction, lubrication, .. } = boundary.conditions;
        let conditions = conditions_with(friction, lubrication, &self.state);
        let at = FrictionPlace { turn: after.turn, load: after.load(), speed: seen.speed, conditions };
        if at.speed.abs() > CREEPS && !after.friction.serves(after.rested.len(), &at) {
            let contacts = Contacts::new(&self.model, &self.state, &conditions);
            self.point = Point::rested(conditions, contacts);
            let lost = self.sums().losses;
            // Damping is in the forces.
            let torque = (lost.total() - lost.damping) / at.speed.abs();
            after.friction = KeptFriction { torque, found: Some(at) };
        } else {
            self.point = Point::new(conditions, false);
        }
        after
    }

    /// Refuses loads and places of elements.
    fn check_rested(&self, of: &ElementState) -> Result<(), SimulationError> {
        let bearing = &self.model.bearing;
        let time = self.state.time;
        let deepest = MAX_APPROACH * 2.0 * bearing.ball.radius;
        let most = deepest * deepest.sqrt();
        let [least_angle, most_angle] = bearing.contact_angles();
        // What is not a number is no balance.
        let balanced = |ball: &Rested| ball.unbalanced <= may_be_left(ball.loads);
        if let Some(index) = of.rested.iter().position(|ball| !balanced(ball)) {
            let unbalanced = of.rested[index].unbalanced;
            return Err(SimulationError::OutOfBalance { time, ball: index + 1, unbalanced });
        }
        for race in Race::BOTH {
            let k = race as usize;
            let towards = |ball: usize| {
                let rested = &of.rested[ball];
                let arm = if race == Race::Inner { rested.crossing - rested.place } else { rested.place };
                [arm.x, arm.y]
            };
            for (index, ball) in of.rested.iter().enumerate().filter(|(_, ball)| ball.loads[k] > 0.0) {
                let (load, stiffness) = (ball.loads[k], ball.stiffness[k]);
                let approach = || (load / stiffness).powf(2.0 / 3.0);
                let [x, y] = towards(index);
                if load > most * stiffness {
                    let (ball, race, approach) = (index + 1, race.name(), approach());
                    return Err(SimulationError::Overload { time, ball, race, approach });
                }
                let off = match bearing.is_thrust_bearing() {
                    true => !(least_angle..=most_angle).contains(&x.atan2(y)),
                    false => y < 0.0,
                };
                if off {
                    let (ball, race, approach) = (index + 1, race.name(), approach());
                    return Err(SimulationError::LeftGroove { time, ball, race, approach });
                }
            }
            // The normal of the inner race points from its groove to the ball.
            let side = if race == Race::Inner { -1.0 } else { 1.0 };
            let sides = |ball: usize| {
                let [x, y] = towards(ball);
                (side * x, y.abs())
            };
            let clear = bearing.shoulders[race].clear();
            if (0..of.rested.len()).all(|ball| clear(sides(ball))) {
                continue;
            }
            let angle = |ball: usize| sides(ball).0.atan2(sides(ball).1);
            bearing
                .check_shoulders(race, of.rested.iter().map(|ball| ball.loads[k]), angle)
                .map_err(|contact| SimulationError::BeyondShoulder { time, contact })?;
        }
        Ok(())
    }
}
