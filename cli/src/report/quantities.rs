//! The quantities whose means are reported, and whose errors are measured: those of a bearing, and those of a shaft with its housings.

use std::borrow::Cow;

use roulement::interface::variables::{Causality, MachineVariables, Source, Variable};
use roulement::model::bodies::Race;
use roulement::simulation::Simulation;
use roulement::simulation::instant::Instant;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::system::System;

/// Measure of the size of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Its own mean.
    Own,
    /// The largest force.
    Force,
    /// The largest force at the pitch radius.
    Moment,
    /// The largest component of the position.
    Position,
    /// The largest speed of a race or of the cage.
    Speed,
    /// The largest tilt.
    Tilt,
    /// 1.
    One,
    /// The mean of all losses: of their parts, shares matter.
    Losses,
}

/// Quantity that is watched of a bearing or a shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// Name.
    pub name: Cow<'static, str>,
    /// Unit.
    pub unit: &'static str,
    /// Measure of its size.
    pub size: Size,
    /// Is its mean reported?
    pub shown: bool,
}

/// A quantity whose mean is reported.
#[derive(Debug)]
pub struct Quantity {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Measure of its size.
    pub size: Size,
    shown: fn(Parts) -> bool,
    get: fn(&Instant) -> f64,
    weight: fn(&Instant) -> f64,
}

/// Parts of a bearing that some quantities are of.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    /// Is there a cage?
    pub cage: bool,
    /// Does a wrench move the outer race?
    pub moving_outer: bool,
    /// Which losses can there be?
    pub losses: [bool; LOSSES.len()],
}

impl Parts {
    /// Those of a simulation.
    pub fn of(simulation: &Simulation) -> Self {
        Self {
            cage: simulation.outputs().cage.is_some(),
            moving_outer: Race::loaded(simulation.scene()) == Race::Outer,
            losses: LOSSES.map(|part| (part.is_of)(&simulation.scene().effects)),
        }
    }
}

impl Quantity {
    /// Is it reported of a bearing of these parts?
    pub fn is_of(&self, parts: Parts) -> bool {
        (self.shown)(parts)
    }
}

const fn quantity(name: &'static str, unit: &'static str, size: Size, get: fn(&Instant) -> f64) -> Quantity {
    Quantity { name, unit, size, shown: |_| true, get, weight: |_| 1.0 }
}

/// A slip: its mean is the mean speed of slip over the mean speed of rolling.
const fn slip(name: &'static str, get: fn(&Instant) -> f64) -> Quantity {
    Quantity { weight: |o| o.rolling_speed.abs(), ..quantity(name, "1", Size::One, get) }
}

const fn of_cage(name: &'static str, get: fn(&Instant) -> f64) -> Quantity {
    Quantity { shown: |parts| parts.cage, ..quantity(name, "W", Size::Own, get) }
}

const fn of_moving_outer(name: &'static str, get: fn(&Instant) -> f64) -> Quantity {
    Quantity { shown: |parts| parts.moving_outer, ..quantity(name, "m", Size::Position, get) }
}

const fn loss<const PART: usize>() -> Quantity {
    let size = if PART == 0 { Size::Own } else { Size::Losses };
    let own = quantity(LOSSES[PART].name, "W", size, |o| (LOSSES[PART].get)(&o.losses));
    Quantity { shown: |parts| parts.losses[PART], ..own }
}

/// [-] their number.
pub const COUNT: usize = 22 + LOSSES.len();

/// All of them of a bearing.
pub static QUANTITIES: [Quantity; COUNT] = [
    quantity("force.x on the inner race", "N", Size::Force, |o| o.inner.wrench.force.x),
    quantity("force.y on the inner race", "N", Size::Force, |o| o.inner.wrench.force.y),
    quantity("force.z on the inner race", "N", Size::Force, |o| o.inner.wrench.force.z),
    quantity("moment.y on the inner race", "N.m", Size::Moment, |o| o.inner.wrench.moment.y),
    quantity("moment.z on the inner race", "N.m", Size::Moment, |o| o.inner.wrench.moment.z),
    quantity("position.x of the inner race", "m", Size::Position, |o| o.inner.pose.position.x),
    quantity("position.y of the inner race", "m", Size::Position, |o| o.inner.pose.position.y),
    quantity("position.z of the inner race", "m", Size::Position, |o| o.inner.pose.position.z),
    of_moving_outer("position.x of the outer race", |o| o.outer.pose.position.x),
    of_moving_outer("position.y of the outer race", |o| o.outer.pose.position.y),
    of_moving_outer("position.z of the outer race", |o| o.outer.pose.position.z),
    quantity("inner race speed", "rad/s", Size::Speed, |o| o.spin(Race::Inner)),
    quantity("outer race speed", "rad/s", Size::Speed, |o| o.spin(Race::Outer)),
    quantity("cage speed", "rad/s", Size::Speed, |o| o.cage_speed),
    slip("cage slip", |o| o.cage_slip),
    slip("ball slip", |o| o.ball_slip),
    quantity("friction power", "W", Size::Own, |o| o.friction_power),
    quantity("friction torque", "N.m", Size::Own, |o| o.friction_torque),
    quantity("inner power per ball", "W", Size::Own, |o| o.power_per_ball[0]),
    quantity("outer power per ball", "W", Size::Own, |o| o.power_per_ball[1]),
    of_cage("pocket power", |o| o.cage.map_or(0.0, |cage| cage.pocket_power)),
    of_cage("land power", |o| o.cage.map_or(0.0, |cage| cage.land_power)),
    loss::<0>(),
    loss::<1>(),
    loss::<2>(),
    loss::<3>(),
    loss::<4>(),
    loss::<5>(),
    loss::<6>(),
    loss::<7>(),
];

/// All of them, as they are watched in a bearing of these parts.
pub fn of_bearing(parts: Parts) -> Vec<Watched> {
    let watched = |quantity: &Quantity| Watched {
        name: quantity.name.into(),
        unit: quantity.unit,
        size: quantity.size,
        shown: quantity.is_of(parts),
    };
    QUANTITIES.iter().map(watched).collect()
}

/// Quantities that are watched of a shaft and its housings: speed, torque, displacements and tilts, by the names that variables of packages have.
#[derive(Clone, Debug)]
pub struct ShaftQuantities {
    variables: MachineVariables,
    references: Vec<usize>,
}

impl ShaftQuantities {
    /// Those of a shaft.
    pub fn of(system: &System) -> Self {
        let variables = MachineVariables::new(system);
        let rows = variables.rows().iter().enumerate();
        let own = rows.filter(|(_, row)| matches!(row.source, Source::Shaft(_)));
        let own = own.filter(|(_, row)| size_of(row).is_some());
        let references = own.map(|(reference, _)| reference).collect();
        Self { variables, references }
    }

    /// Their names and sizes.
    pub fn watched(&self) -> Vec<Watched> {
        let rows = self.references.iter().map(|reference| &self.variables.rows()[*reference]);
        let watched = rows.filter_map(|row| {
            let size = size_of(row)?;
            Some(Watched { name: row.name.clone().into(), unit: row.unit.name, size, shown: true })
        });
        watched.collect()
    }

    /// Their values.
    pub fn values(&self, system: &System) -> Vec<f64> {
        self.references.iter().map(|reference| self.variables.value(*reference, system)).collect()
    }
}

/// Measure of the size of a shaft's variable; none of one that is no quantity with a mean: angle, velocities, energies, and loads,
/// which are given. Forces that are not given are those of meshes and of bearings by their stiffness.
fn size_of(row: &Variable) -> Option<Size> {
    let of_whole = row.name.split_once('.').map_or(row.name.as_str(), |(_, key)| key);
    match (of_whole, row.unit.name) {
        ("speed", _) => Some(Size::Speed),
        ("torque", _) => Some(Size::Own),
        ("angle", _) => None,
        (_, "m") => Some(Size::Position),
        (_, "rad") => Some(Size::Tilt),
        (_, "N") if row.causality == Causality::Output => Some(Size::Force),
        (_, "N.m") if row.causality == Causality::Output => Some(Size::Moment),
        _ => None,
    }
}

/// All of them at an instant.
pub fn values(instant: &Instant) -> [f64; COUNT] {
    std::array::from_fn(|i| (QUANTITIES[i].get)(instant))
}

/// Weights of an instant in the means of all of them.
pub fn weights(instant: &Instant) -> [f64; COUNT] {
    std::array::from_fn(|i| (QUANTITIES[i].weight)(instant))
}
