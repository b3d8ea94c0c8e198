//! Does a race that is free across its axis go round, or swing, by more than its loads explain?
//!
//! The force of the bearing and the applied loads accelerate it. In a race that is at rest under its loads both cancel; one
//! that whirls is accelerated by many times what is applied. Of a race on a shaft that is the force of the bearing but for its mean, which
//! carries the loads of the shaft, and for what turns with the shaft, as its unbalance does.

use super::Simulation;
use crate::model::bodies::{Constraint, Race, RigidBody};
use crate::scene::Schedule;
use crate::scene::system::SystemScene;
use nalgebra::{Complex, Matrix3, Vector2, Vector3};

/// [-] force that accelerates a race over what is applied across the axis, beyond which loads do not explain its motion.
const BEYOND: f64 = 2.0;
/// [-] of the largest force in all directions: less across the axis is no load to compare with.
const LEAST: f64 = 0.02;
/// [-] how round a motion is from which on it is called a circle: 1 is one.
const ROUND: f64 = 0.5;

/// A race across its axis at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// \[s] time.
    pub time: f64,
    /// \[m] its centre.
    centre: Vector2<f64>,
    /// [m/s] velocity of that.
    velocity: Vector2<f64>,
    /// \[N] force that accelerates it.
    accelerates: Vector2<f64>,
    /// \[N] what is applied; on a shaft the mean of what its bearing carries.
    applied: Vector2<f64>,
    /// [rad/s] speed of the race.
    pub spin: f64,
    /// \[N] the largest of all forces on it.
    pub largest: f64,
}

/// Unsteady loads on the shafts of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exciting {
    /// Do scripts come to other values?
    pub scripted: bool,
    /// Does a load swing?
    pub swings: bool,
    /// Is a disc out of balance?
    pub unbalance: bool,
}

impl Exciting {
    /// Excitation of the shafts of a scene.
    pub fn of(scene: &SystemScene) -> Self {
        let loads = scene.loads().flat_map(|load| load.force.0.iter().chain(&load.moment.0));
        let mut shafts = scene.shafts.iter();
        let drives = shafts.clone().flat_map(|shaft| shaft.speed.iter().chain(&shaft.torque));
        let gears = scene.gears().map(|gear| &gear.torque);
        let ripples = scene.gears().any(|gear| gear.ripple().is_some());
        Self {
            scripted: false,
            swings: ripples || loads.chain(drives).chain(gears).any(Schedule::swings),
            unbalance: shafts.any(|shaft| shaft.disc.iter().any(|disc| disc.unbalance.is_some())),
        }
    }
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
    /// \[N] largest force that is applied there; of a shaft the mean that its bearing carries.
    pub applied: f64,
    /// Does a shaft carry it?
    pub carried: bool,
    /// [-] how round the way is: 1 forwards in a circle, -1 backwards, 0 to and fro.
    pub round: f64,
}

/// The race that is looked at: that which a shaft carries, or which loads act on.
fn watched(simulation: &Simulation) -> Race {
    if simulation.model().is_carried(Race::Inner) { Race::Inner } else { Race::loaded(simulation.scene()) }
}

/// Is a race moved by forces across its axis, in both directions?
fn is_free(moved: &RigidBody) -> bool {
    let held = |constraint: &Constraint| matches!(constraint, Constraint::Position(axis, _) if *axis > 0);
    !moved.constraints.iter().any(held)
}

impl Place {
    /// Place of a bearing now; none of a race that is held across its axis, or rests on a support.
    pub fn of(simulation: &Simulation) -> Option<Self> {
        let race = watched(simulation);
        let model = simulation.model();
        let moved = model.bodies[race].as_ref()?;
        if !(moved.carried || is_free(moved)) || model.supports[race].is_some() {
            return None;
        }
        let output = simulation.race_output(race);
        let weight = simulation.inputs().effects.frame.motion.gravity * moved.mass;
        let applied = simulation.inputs()[race].applied.force + weight;
        let across = |v: &Vector3<f64>| Vector2::new(v.y, v.z);
        Some(Self {
            time: simulation.time(),
            centre: across(&output.pose.position),
            velocity: across(&output.twist.velocity),
            accelerates: across(&(output.wrench.force + applied)),
            applied: across(&applied),
            spin: simulation.state().race(race).rate.x,
            largest: applied.norm().max(output.wrench.force.norm()),
        })
    }
}

/// Forces across the axis of a race that accelerate it, of which what its loads explain was taken out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unexplained {
    /// \[N] the largest.
    pub force: f64,
    /// \[N] largest force that is applied across the axis; of a shaft the mean that its bearing carries.
    pub applied: f64,
    /// \[N] the largest force in all directions.
    pub largest: f64,
}

impl Unexplained {
    /// Motion of places in the order of time, which lose what is explained. Nothing is known of a shaft whose loads change or swing.
    pub fn of(places: &mut [Place], simulation: &Simulation, exciting: Exciting) -> Option<Self> {
        if simulation.model().is_carried(watched(simulation)) {
            if exciting.scripted || exciting.swings {
                return None;
            }
            take_explained(places, exciting.unbalance);
        }
        let most = |of: fn(&Place) -> f64| places.iter().map(of).fold(0.0, f64::max);
        let force = most(|place| place.accelerates.norm());
        let applied = most(|place| place.applied.norm());
        Some(Self { force, applied, largest: most(|place| place.largest) })
    }

    /// Is it beyond what loads explain?
    pub fn is_beyond(&self) -> bool {
        self.force > BEYOND * self.applied.max(LEAST * self.largest)
    }
}

/// Takes what steady loads and unbalance of a shaft explain out of the forces of its bearing: the mean and, by least squares, what turns
/// with the shaft, forwards and backwards. The mean is what is applied then.
fn take_explained(places: &mut [Place], unbalance: bool) {
    let complex = |v: Vector2<f64>| Complex::new(v.x, v.y);
    let mut angle = 0.0;
    let turns = |unbalance: bool, angle: f64| {
        let turn = if unbalance { Complex::cis(angle) } else { Complex::from(0.0) };
        Vector3::new(Complex::from(1.0), turn, turn.conj())
    };
    let mut rows = Vec::with_capacity(places.len());
    for (index, place) in places.iter().enumerate() {
        let before = &places[index.saturating_sub(1)];
        angle += 0.5 * (before.spin + place.spin) * (place.time - before.time);
        rows.push(turns(unbalance, angle));
    }
    let (mut square, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (row, place) in rows.iter().zip(&*places) {
        square += row.conjugate() * row.transpose();
        right += row.conjugate() * complex(place.accelerates);
    }
    if !unbalance {
        square[(1, 1)] = Complex::from(1.0);
        square[(2, 2)] = Complex::from(1.0);
    }
    // Too few rows to tell them apart: then all of it is explained.
    let parts = square.lu().solve(&right);
    for (row, place) in rows.iter().zip(places) {
        let explained = parts.map_or(complex(place.accelerates), |parts| row.dot(&parts));
        place.accelerates -= Vector2::new(explained.re, explained.im);
        place.applied = parts.map_or(Vector2::zeros(), |parts| Vector2::new(parts[0].re, parts[0].im));
    }
}

impl Circling {
    /// Circling at places in the order of time, where it is beyond what loads explain.
    pub fn of(mut places: Vec<Place>, simulation: &Simulation, exciting: Exciting) -> Option<Self> {
        let unexplained = Unexplained::of(&mut places, simulation, exciting)?;
        if !unexplained.is_beyond() {
            return None;
        }
        let race = watched(simulation);
        let middle = places.iter().map(|place| place.centre).sum::<Vector2<f64>>() / places.len() as f64;
        let from_middle = |place: &Place| place.centre - middle;
        // r x v over |r| |v|, weighted by these.
        let (turn, size) = places.iter().fold((0.0, 0.0), |(turn, size), place| {
            let offset = from_middle(place);
            (turn + offset.perp(&place.velocity), size + offset.norm() * place.velocity.norm())
        });
        let spin = simulation.state().race(race).rate.x.signum();
        let Unexplained { force, applied, .. } = unexplained;
        Some(Self {
            race,
            radius: places.iter().map(|place| from_middle(place).norm()).fold(0.0, f64::max),
            force,
            applied,
            carried: simulation.model().is_carried(race),
            round: spin * turn / size.max(f64::MIN_POSITIVE),
        })
    }

    /// In a sentence of a run that has ended.
    pub fn warning(&self) -> String {
        format!("{}; its means are those of this motion (docs/holding-a-bearing.md)", self.motion())
    }

    /// In a sentence of a run that goes on.
    pub fn motion(&self) -> String {
        let Self { race, radius, force, applied, carried, round } = self;
        let way = match round {
            round if *round > ROUND => "goes round forwards",
            round if *round < -ROUND => "goes round backwards",
            _ => "swings",
        };
        let beyond = if *carried {
            format!(
                "its bearing's force across the axis swings by {force:.1} N about a mean of {applied:.1} N"
            )
        } else {
            format!("{force:.1} N accelerate it across its axis where {applied:.1} N are applied")
        };
        format!(
            "the {} race {way} by up to {:.3} um about the middle of its way: {beyond}",
            race.name(),
            radius * 1e6
        )
    }
}
