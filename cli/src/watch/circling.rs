//! Does a race that is free across its axis go round, or swing, by more than its loads explain?
//!
//! What accelerates it is the force of the bearing and what is applied to it. In a race that is at rest under its loads both cancel; one
//! that whirls is accelerated by many times what is applied.

use nalgebra::Vector2;
use roulement::model::bodies::{Constraint, Race, RigidBody};
use roulement::simulation::Simulation;

use crate::report::thinned::Thinned;

/// [-] force that accelerates a race over what is applied across the axis, beyond which loads do not explain its motion.
const BEYOND: f64 = 2.0;
/// [-] of the largest force in all directions: less across the axis is no load to compare with.
const LEAST: f64 = 0.02;
/// [-] how round a motion is from which on it is called a circle: 1 is one.
const ROUND: f64 = 0.5;

/// A race across its axis in a row.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// \[s] time.
    time: f64,
    /// \[m] its centre.
    centre: Vector2<f64>,
    /// [m/s] velocity of that.
    velocity: Vector2<f64>,
    /// \[N] force that accelerates it.
    accelerates: Vector2<f64>,
    /// \[N] what is applied.
    applied: Vector2<f64>,
    /// \[N] the largest of all forces on it.
    largest: f64,
}

/// Gathers while a bearing runs; nothing of a race that is held across its axis.
#[derive(Debug, Default)]
pub struct CirclingWatch {
    places: Thinned<Place>,
}

/// A race that moves by more than its loads explain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circling {
    /// The race.
    pub race: Race,
    /// \[m] largest distance of its centre from the middle of its way.
    pub radius: f64,
    /// \[N] largest force that accelerates it across its axis.
    pub force: f64,
    /// \[N] largest force that is applied there.
    pub applied: f64,
    /// [-] how round the way is: 1 forwards in a circle, -1 backwards, 0 to and fro.
    pub round: f64,
}

/// Is a race moved by forces across its axis, in both directions?
fn is_free(moved: &RigidBody) -> bool {
    let held = |constraint: &Constraint| matches!(constraint, Constraint::Position(axis, _) if *axis > 0);
    !moved.carried && !moved.constraints.iter().any(held)
}

impl CirclingWatch {
    /// Takes a row.
    pub fn push(&mut self, simulation: &Simulation) {
        let race = Race::loaded(simulation.scene());
        let model = simulation.model();
        let Some(moved) = &model.bodies[race] else {
            return;
        };
        if !is_free(moved) || model.supports[race].is_some() {
            return;
        }
        let output = simulation.race_output(race);
        let weight = simulation.inputs().effects.frame.motion.gravity * moved.mass;
        let applied = simulation.inputs()[race].applied.force + weight;
        let across = |v: &nalgebra::Vector3<f64>| Vector2::new(v.y, v.z);
        self.places.push(Place {
            time: simulation.time(),
            centre: across(&output.pose.position),
            velocity: across(&output.twist.velocity),
            accelerates: across(&(output.wrench.force + applied)),
            applied: across(&applied),
            largest: applied.norm().max(output.wrench.force.norm()),
        });
    }

    /// What was seen from a time \[s] on, where that is beyond what loads explain.
    pub fn finish(self, simulation: &Simulation, from: f64) -> Option<Circling> {
        let places: Vec<Place> =
            self.places.finish().into_iter().filter(|place| place.time >= from).collect();
        let most = |of: &dyn Fn(&Place) -> f64| places.iter().map(of).fold(0.0, f64::max);
        let force = most(&|place| place.accelerates.norm());
        let applied = most(&|place| place.applied.norm());
        let explained = BEYOND * applied.max(LEAST * most(&|place| place.largest));
        if force <= explained || places.is_empty() {
            return None;
        }
        let middle = places.iter().map(|place| place.centre).sum::<Vector2<f64>>() / places.len() as f64;
        let from_middle = |place: &Place| place.centre - middle;
        // r x v over |r| |v|, weighted by these.
        let (turn, size) = places.iter().fold((0.0, 0.0), |(turn, size), place| {
            let offset = from_middle(place);
            (turn + offset.perp(&place.velocity), size + offset.norm() * place.velocity.norm())
        });
        let race = Race::loaded(simulation.scene());
        let spin = simulation.state().race(race).rate.x.signum();
        let radius = most(&|place| from_middle(place).norm());
        Some(Circling { race, radius, force, applied, round: spin * turn / size.max(f64::MIN_POSITIVE) })
    }
}

impl Circling {
    /// In a sentence.
    pub fn warning(&self) -> String {
        let Self { race, radius, force, applied, round } = self;
        let way = match round {
            round if *round > ROUND => "goes round forwards",
            round if *round < -ROUND => "goes round backwards",
            _ => "swings",
        };
        format!(
            "the {} race {way} by up to {:.3} um about the middle of its way: {force:.1} N accelerate it across its axis where {applied:.1} N \
             are applied; its means are those of this motion (docs/holding-a-bearing.md)",
            race.name(),
            radius * 1e6
        )
    }
}
