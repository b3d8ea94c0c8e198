//! The rows of a system's shaft and housings: loads and drive, turn, energies, and the motion of stations.

use super::link_rows::{self, LinkRow};
use super::{Causality, Kind, Source, Variable, level_rows};
use crate::effects::frame::FrameSection;
use crate::scene::system::{NamedLoad, ShaftParameter, SystemScene};
use crate::schema::variable_units::{self as units, Unit};
use crate::simulation::system::{
    HousingOutputs, LevelJump, LinkOutputs, PointOutput, ShaftInputs, ShaftOutputs, SystemOutputs,
};

/// Where the value of a variable of the shaft comes from.
#[derive(Clone, Copy, Debug)]
pub enum ShaftSource {
    /// A component of the force at a named load: which load, which component.
    Force(usize, usize),
    /// A component of its moment, likewise.
    Moment(usize, usize),
    /// Torque of a gear.
    Gear(usize),
    /// Speed or torque, whichever drives a shaft.
    Drive(usize),
    /// A component of the motion of the frame: which quantity ([`crate::scene::FrameMotion::vector`]), which component.
    Frame(usize, usize),
    /// A number of the scene.
    Number(ShaftParameter),
    /// What changes of a bearing's level did.
    Jump(usize, fn(&LevelJump) -> f64),
    /// A shaft as a whole, by its index.
    Whole(usize, fn(&ShaftOutputs) -> f64),
    /// A component of what a mesh or a bearing by its stiffness does, by its index.
    Link(usize, fn(&LinkOutputs) -> f64),
    /// A housing as a whole, by its index.
    Housing(usize, fn(&HousingOutputs) -> f64),
    /// Force or moment that holds a motion which is given, by its index among all of them.
    Holding(usize),
    /// Such a motion or its rate; an input of the rate has the rate of that, too.
    Given(usize, MotionPart),
    /// Angle or speed of the flange of a shaft, by its index; that of the speed has its rate, too.
    Flange(usize, MotionPart),
    /// Motion of a station.
    Motion(Station, PointQuantity, usize),
}

/// Part of a motion that is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionPart {
    /// [m, rad] where it is.
    Value,
    /// [m/s, rad/s] its rate.
    Rate,
}

/// A place on the shaft, or on the housing with this index, by its index among those of its kind.
#[derive(Clone, Copy, Debug)]
pub enum Station {
    /// Under a race of a bearing.
    Seat(Option<usize>, usize),
    /// Where a named load acts.
    Load(Option<usize>, usize),
    /// A named point.
    Point(Option<usize>, usize),
}

impl Station {
    /// The housing that it is on; none on the shaft.
    fn housing(self) -> Option<usize> {
        let (Self::Seat(housing, _) | Self::Load(housing, _) | Self::Point(housing, _)) = self;
        housing
    }

    /// Its motion.
    fn of(self, outputs: &SystemOutputs) -> &PointOutput {
        let (seats, loads, points) = match self.housing().map(|housing| &outputs.housings[housing]) {
            Some(housing) => (&housing.seats, &housing.loads, &housing.points),
            None => (&outputs.seats, &outputs.loads, &outputs.points),
        };
        match self {
            Self::Seat(_, index) => &seats[index],
            Self::Load(_, index) => &loads[index],
            Self::Point(_, index) => &points[index],
        }
    }
}

/// A quantity of a station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointQuantity {
    /// \[m]
    Displacement,
    /// [m/s]
    Velocity,
    /// \[rad]
    Tilt,
    /// [rad/s], where it is given.
    TiltRate,
}

impl PointQuantity {
    const ALL: [Self; 4] = [Self::Displacement, Self::Velocity, Self::Tilt, Self::TiltRate];

    /// Component of a motion (displacements 0 to 2, rotations 3 to 5) along or about an axis, and whether it is that or its rate.
    fn of_motion(self, axis: usize) -> (usize, MotionPart) {
        match self {
            Self::Displacement => (axis, MotionPart::Value),
            Self::Velocity => (axis, MotionPart::Rate),
            Self::Tilt => (3 + axis, MotionPart::Value),
            Self::TiltRate => (3 + axis, MotionPart::Rate),
        }
    }

    /// Name, unit, typical size, first component and what it is, of a shaft or a housing.
    fn words(self, of_shaft: bool) -> (&'static str, Unit, f64, usize, &'static str) {
        match (self, of_shaft) {
            (Self::Displacement, true) => {
                ("displacement", units::METRE, 1e-5, 0, "displacement of the shaft")
            }
            (Self::Displacement, false) => {
                ("displacement", units::METRE, 1e-5, 0, "displacement of the housing")
            }
            (Self::Velocity, true) => ("velocity", units::METRE_PER_SECOND, 1e-3, 0, "velocity of the shaft"),
            (Self::Velocity, false) => {
                ("velocity", units::METRE_PER_SECOND, 1e-3, 0, "velocity of the housing")
            }
            (Self::Tilt, true) => {
                ("tilt", units::RADIAN, 1e-3, 1, "tilt of the shaft about an axis of its own")
            }
            (Self::Tilt, false) => ("rotation", units::RADIAN, 1e-3, 0, "rotation of the housing"),
            (Self::TiltRate, true) => (
                "tilt_rate",
                units::RADIAN_PER_SECOND,
                1.0,
                1,
                "rate of the tilt of the shaft about an axis of its own",
            ),
            (Self::TiltRate, false) => {
                ("rotation_rate", units::RADIAN_PER_SECOND, 1.0, 0, "rate of the rotation of the housing")
            }
        }
    }

    fn read(self, point: &PointOutput, axis: usize) -> f64 {
        match self {
            Self::Displacement => point.displacement[axis],
            Self::Velocity => point.velocity[axis],
            Self::Tilt => point.tilt[axis],
            // It is an input or not there at all.
            Self::TiltRate => f64::NAN,
        }
    }
}

impl ShaftSource {
    /// \[unit] value: inputs as set, outputs from the outputs.
    pub fn value(self, inputs: &ShaftInputs, outputs: &SystemOutputs) -> f64 {
        match self {
            Self::Force(load, axis) => inputs.loads[load].force[axis],
            Self::Moment(load, axis) => inputs.loads[load].moment[axis],
            Self::Gear(index) => inputs.gears[index],
            Self::Drive(shaft) => inputs.drives[shaft],
            Self::Frame(quantity, axis) => {
                inputs.frame.map_or(0.0, |frame| frame.motion.vector(quantity)[axis])
            }
            Self::Number(parameter) => parameter.start,
            Self::Jump(bearing, get) => get(&outputs.jumps[bearing]),
            Self::Whole(shaft, get) => get(&outputs.shafts[shaft]),
            Self::Link(index, get) => get(&outputs.links[index]),
            Self::Housing(index, get) => get(&outputs.housings[index]),
            Self::Holding(index) => outputs.holding[index],
            Self::Given(index, MotionPart::Value) => inputs.motions[index].value,
            Self::Given(index, MotionPart::Rate) => inputs.motions[index].rate,
            Self::Flange(shaft, part) => inputs.flanges[shaft].map_or(0.0, |turn| match part {
                MotionPart::Value => turn.value,
                MotionPart::Rate => turn.rate,
            }),
            Self::Motion(station, quantity, axis) => quantity.read(station.of(outputs), axis),
        }
    }

    /// [unit/s] rate that an input was given with; 0 where it takes none.
    pub fn rate(self, inputs: &ShaftInputs) -> f64 {
        match self {
            Self::Given(index, MotionPart::Rate) => inputs.motions[index].acceleration,
            Self::Flange(shaft, MotionPart::Rate) => {
                inputs.flanges[shaft].map_or(0.0, |turn| turn.acceleration)
            }
            Self::Frame(quantity, axis) => {
                inputs.frame.map_or(0.0, |frame| frame.rate.vector(quantity)[axis])
            }
            _ => 0.0,
        }
    }

    /// Is it a velocity that is given, whose rate may be given, too?
    pub fn is_given_velocity(self) -> bool {
        matches!(self, Self::Given(_, MotionPart::Rate) | Self::Flange(_, MotionPart::Rate))
    }

    /// Writes a value and its rate [unit, unit/s] into inputs; nothing where it is an output.
    pub fn set(self, inputs: &mut ShaftInputs, value: f64, rate: f64) {
        match self {
            Self::Force(load, axis) => inputs.loads[load].force[axis] = value,
            Self::Moment(load, axis) => inputs.loads[load].moment[axis] = value,
            Self::Gear(index) => inputs.gears[index] = value,
            Self::Drive(shaft) => inputs.drives[shaft] = value,
            Self::Frame(quantity, axis) => {
                if let Some(frame) = &mut inputs.frame {
                    frame.motion.vector_mut(quantity)[axis] = value;
                    frame.rate.vector_mut(quantity)[axis] = rate;
                }
            }
            Self::Given(index, MotionPart::Value) => inputs.motions[index].value = value,
            Self::Given(index, MotionPart::Rate) => {
                (inputs.motions[index].rate, inputs.motions[index].acceleration) = (value, rate);
            }
            Self::Flange(shaft, part) => {
                if let Some(turn) = &mut inputs.flanges[shaft] {
                    match part {
                        MotionPart::Value => turn.value = value,
                        MotionPart::Rate => (turn.rate, turn.acceleration) = (value, rate),
                    }
                }
            }
            Self::Number(_)
            | Self::Jump(..)
            | Self::Whole(..)
            | Self::Link(..)
            | Self::Housing(..)
            | Self::Holding(_)
            | Self::Motion(..) => {}
        }
    }
}

/// A name as a part of structured names: in single quotes where it is no plain word.
pub fn quoted(name: &str) -> String {
    let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if plain && !name.starts_with(|c: char| c.is_ascii_digit()) { name.into() } else { format!("'{name}'") }
}

const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn row(
    name: String,
    (unit, nominal): (Unit, f64),
    causality: Causality,
    description: String,
    source: ShaftSource,
) -> Variable {
    Variable {
        name,
        unit,
        kind: Kind::Real,
        causality,
        nominal,
        limits: match source {
            ShaftSource::Number(ShaftParameter { number, .. }) => {
                [number.range.low, number.range.high].map(Some)
            }
            _ => [None; 2],
        },
        description,
        source: Source::Shaft(source),
    }
}

/// The rows of the shafts and the housings of a scene.
pub fn rows(scene: &SystemScene) -> Vec<Variable> {
    let mut rows = vec![];
    let on_shafts = scene.shafts.iter().map(|shaft| shaft.load.len()).sum();
    // An input, or what holds a motion that is given there.
    let mut holding = 0;
    let mut effort = |load: &NamedLoad<'_>, component: usize, input: ShaftSource| match load.gives(component)
    {
        true => {
            holding += 1;
            (Causality::Output, ShaftSource::Holding(holding - 1), ", which holds the given motion there")
        }
        false => (Causality::Input, input, ""),
    };
    for (index, load) in scene.loads().enumerate() {
        let what = if index < on_shafts { "shaft" } else { "housing" };
        for (axis, letter) in AXES.into_iter().enumerate() {
            let name = format!("{}.force.{letter}", quoted(load.name));
            let (causality, source, more) = effort(&load, axis, ShaftSource::Force(index, axis));
            let description =
                format!("force on the {what} at {}, {letter} component, axes of the shaft{more}", load.name);
            rows.push(row(name, (units::NEWTON, 1e3), causality, description, source));
        }
        for (axis, letter) in AXES.into_iter().enumerate() {
            let name = format!("{}.moment.{letter}", quoted(load.name));
            let (causality, source, more) = effort(&load, 3 + axis, ShaftSource::Moment(index, axis));
            let description =
                format!("moment on the {what} at {}, {letter} component, axes of the shaft{more}", load.name);
            rows.push(row(name, (units::NEWTON_METRE, 1.0), causality, description, source));
        }
    }
    let gears = scene.shafts.iter().flat_map(|shaft| (1..=shaft.gear.len()).map(move |gear| (shaft, gear)));
    for (index, (shaft, gear)) in gears.enumerate() {
        let name = format!("{}.gear[{gear}].torque", quoted(&shaft.name));
        let description = format!("torque about +x that the mesh of gear {gear} exerts on the shaft");
        let unit = (units::NEWTON_METRE, 1.0);
        rows.push(row(name, unit, Causality::Input, description, ShaftSource::Gear(index)));
    }
    // Where the mass of a structure is not known, a frame cannot turn.
    let turns = scene.shafts.iter().all(|shaft| shaft.matrices.is_none())
        && scene.housings.iter().all(|housing| housing.matrices.is_none());
    let quantities =
        scene.frame.iter().flat_map(FrameSection::inputs).filter(|(quantity, ..)| turns || *quantity < 2);
    for (quantity, name, unit, nominal, what) in quantities {
        for (axis, letter) in AXES.into_iter().enumerate() {
            let what = what.replace("the bearing's frame", "the machine's frame");
            let description = format!("{what}, {letter} component along the frame's own axes");
            let source = ShaftSource::Frame(quantity, axis);
            rows.push(row(
                format!("frame.{name}.{letter}"),
                (unit, nominal),
                Causality::Input,
                description,
                source,
            ));
        }
    }
    (0..scene.shafts.len()).for_each(|shaft| turn(scene, shaft, &mut rows));
    for (index, load) in scene.shafts.iter().flat_map(|shaft| &shaft.load).enumerate() {
        let given = given(scene, &load.name);
        motion(&mut rows, Station::Load(None, index), &quoted(&load.name), &load.name, &given);
    }
    for (index, point) in scene.shafts.iter().flat_map(|shaft| &shaft.point).enumerate() {
        motion(&mut rows, Station::Point(None, index), &quoted(&point.name), &point.name, &[]);
    }
    for (index, bearing) in scene.bearings.iter().enumerate() {
        let prefix = format!("{}.seat", quoted(&bearing.name));
        let place = format!("the seat of bearing {}", bearing.name);
        motion(&mut rows, Station::Seat(None, index), &prefix, &place, &[]);
    }
    for (index, name) in scene.link_names().enumerate() {
        let of = match index.checked_sub(scene.meshes.len()).map(|own| &scene.springs[own]) {
            None => link_rows::MESH,
            Some(spring) if spring.is_coupling() => link_rows::COUPLING,
            Some(spring) if spring.rubs() => link_rows::RUBBING,
            Some(spring) if spring.rollers.is_some() => link_rows::ROLLERS,
            Some(_) => link_rows::SPRING,
        };
        rows.extend(of.iter().copied().flatten().map(|LinkRow { key, unit, what, get }| {
            let (name, description) = (format!("{}.{key}", quoted(name)), format!("{what} {name}"));
            row(name, *unit, Causality::Output, description, ShaftSource::Link(index, *get))
        }));
    }
    for index in 0..scene.housings.len() {
        housing(scene, index, &mut rows);
    }
    rows.extend(level_rows::rows(scene));
    for (name, parameter) in scene.parameters() {
        let number = parameter.number;
        let nominal = if parameter.start == 0.0 { 1.0 } else { parameter.start.abs() };
        let unit = (units::of_parameter(number.range.unit), nominal);
        let (description, source) = (number.description.to_string(), ShaftSource::Number(parameter));
        let name = name.split_once('.').map_or(name.clone(), |(part, key)| format!("{}.{key}", quoted(part)));
        rows.push(row(name, unit, Causality::Parameter, description, source));
    }
    rows
}

/// Energies and motion of a housing.
fn housing(scene: &SystemScene, index: usize, rows: &mut Vec<Variable>) {
    let housing = &scene.housings[index];
    let mut energy = |name: &str, what: &str, get: fn(&HousingOutputs) -> f64| {
        let name = format!("{}.energy.{name}", quoted(&housing.name));
        let description = format!("{what} of the housing {}", housing.name);
        let source = ShaftSource::Housing(index, get);
        rows.push(row(name, (units::JOULE, 1.0), Causality::Output, description, source));
    };
    energy("stored", "kinetic and elastic energy", |o| o.energies.stored);
    energy("work", "work of loads and weight since the start,", |o| o.energies.input);
    energy("to_bearings", "energy given to its bearings since the start,", |o| o.energies.bearings);
    energy("dissipated", "energy lost to the damping since the start,", |o| o.energies.damping);
    for (own, load) in housing.load.iter().enumerate() {
        let given = given(scene, &load.name);
        motion(rows, Station::Load(Some(index), own), &quoted(&load.name), &load.name, &given);
    }
    for (own, point) in housing.point.iter().enumerate() {
        motion(rows, Station::Point(Some(index), own), &quoted(&point.name), &point.name, &[]);
    }
    for (own, bearing) in scene.bearings_in(index).enumerate() {
        let bearing = &scene.bearings[bearing].name;
        let prefix = format!("{}.housing", quoted(bearing));
        motion(
            rows,
            Station::Seat(Some(index), own),
            &prefix,
            &format!("the seat of bearing {bearing}"),
            &[],
        );
    }
}

/// Drive, turn and energies.
fn turn(scene: &SystemScene, shaft: usize, rows: &mut Vec<Variable>) {
    let section = &scene.shafts[shaft];
    let prefix = quoted(&section.name);
    let (speed, torque) = ((units::RADIAN_PER_SECOND, 100.0), (units::NEWTON_METRE, 1.0));
    let drive = (Causality::Input, ShaftSource::Drive(shaft));
    let given_speed = section.speed.is_some();
    let flange = |part| (Causality::Input, ShaftSource::Flange(shaft, part));
    let speed_from = match given_speed {
        true if section.flange => flange(MotionPart::Rate),
        true => drive,
        false => (Causality::Output, ShaftSource::Whole(shaft, |o| o.spin.speed)),
    };
    let torque_from = match given_speed {
        true => (Causality::Output, ShaftSource::Whole(shaft, |o| o.torque)),
        false => drive,
    };
    let mut add = |name: &str, unit, (causality, source), description: &str| {
        rows.push(row(format!("{prefix}.{name}"), unit, causality, description.into(), source));
    };
    add("speed", speed, speed_from, "speed of the shaft about its axis");
    add("torque", torque, torque_from, "torque that drives the shaft");
    let angle = "turn of the shaft since time 0 at a given speed, since the start under a torque";
    let angle_from = match section.flange {
        true => flange(MotionPart::Value),
        false => (Causality::Output, ShaftSource::Whole(shaft, |o| o.spin.angle)),
    };
    add("angle", (units::RADIAN, 100.0), angle_from, angle);
    let mut output = |name: &str, unit, description: &str, get: fn(&ShaftOutputs) -> f64| {
        let source = ShaftSource::Whole(shaft, get);
        rows.push(row(format!("{prefix}.{name}"), unit, Causality::Output, description.into(), source));
    };
    let joule = (units::JOULE, 1.0);
    output("energy.stored", joule, "kinetic and elastic energy of the shaft", |o| o.energies.stored);
    let work = "work of loads, weight and drive on the shaft since the start";
    output("energy.work", joule, work, |o| o.energies.input);
    let given = "energy that the shaft gave to its bearings since the start";
    output("energy.to_bearings", joule, given, |o| o.energies.bearings);
    let lost = "energy lost to the damping of the shaft since the start";
    output("energy.dissipated", joule, lost, |o| o.energies.damping);
}

/// Components that are given of the motion at a named load, with the index of each among all motions that are given.
fn given(scene: &SystemScene, name: &str) -> Vec<(usize, usize)> {
    let all = scene.motions().enumerate().filter(|(_, (load, _))| load.name == name);
    all.map(|(index, (_, (_, component, _)))| (component, index)).collect()
}

/// Motion of a station: outputs, and inputs where components of it are given.
fn motion(rows: &mut Vec<Variable>, station: Station, prefix: &str, place: &str, given: &[(usize, usize)]) {
    for quantity in PointQuantity::ALL {
        let (name, unit, nominal, first, what) = quantity.words(station.housing().is_none());
        for (axis, letter) in AXES.into_iter().enumerate().skip(first) {
            let name = format!("{prefix}.{name}.{letter}");
            let description = format!("{what} at {place}, {letter} component, axes of the shaft");
            let (component, part) = quantity.of_motion(axis);
            let input = given.iter().find(|(own, _)| *own == component);
            let (causality, source) = match input {
                Some((_, index)) => (Causality::Input, ShaftSource::Given(*index, part)),
                None if quantity == PointQuantity::TiltRate => continue,
                None => (Causality::Output, ShaftSource::Motion(station, quantity, axis)),
            };
            rows.push(row(name, (unit, nominal), causality, description, source));
        }
    }
}
