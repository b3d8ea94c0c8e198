//! The file of a system: shafts, their bearings, and what loads them.
//!
//! It is TOML as the scene of one bearing is. Each `[[bearing]]` has the keys of such a scene by itself (`scene`, a file or the keys
//! themselves; or `catalogue`, a designation), changed by `[bearing.set]`, and where it sits on the shaft, `[bearing.mounting]`.

mod bearing;
mod check;
mod check_held;
mod check_housing;
mod check_motion;
pub(crate) mod linked;
pub mod mesh;
mod numbers;
mod planets;
mod ranges;
mod read;
mod roller_film;
mod rollers;
mod rows;
mod source;
pub mod spring;

use std::fmt;

use mesh::SceneMesh;
use nalgebra::Vector3;
pub use numbers::{ShaftNumber, ShaftParameter};
use serde::Deserialize;
use source::write_bearings;
use spring::SceneSpring;
use toml::Table;

use super::typical::unusual;
use super::{FrameMotion, Level, Ranges, Scene, SceneError};
use crate::effects::frame::FrameSection;
use crate::schema::units::{Acceleration, Force, Moment, Time};
use crate::schema::{
    AxialSeat, Components, DutySection, GearSection, GivenMotion, HousingLoad, HousingSection, Interface,
    Mounting, PhaseSection, PointLoad, RotatingSection, Schedule, ShaftSection, Solver,
};

/// A shaft with its bearings, as described by a file.
#[derive(Clone, Debug)]
pub struct SystemScene {
    /// One line for results.
    pub title: String,
    /// The shafts: one at least.
    pub shafts: Vec<ShaftSection>,
    /// Housings that outer races sit in.
    pub housings: Vec<HousingSection>,
    /// Gears in mesh.
    pub meshes: Vec<SceneMesh>,
    /// Bearings by their stiffness or by rollers, then couplings.
    pub springs: Vec<SceneSpring>,
    /// The bearings of balls.
    pub bearings: Vec<MountedScene>,
    /// Settings of the integration, if there are none.
    pub of_links: Solver,
    /// [m/s2] acceleration of gravity in the axes of the shaft.
    pub gravity: Components<Acceleration>,
    /// Interface of its FMU.
    pub interface: Interface,
    /// Ranges of its keys that a package can meet.
    pub ranges: Ranges,
    /// Motion of the machine's frame, which all places and velocities are seen from; none where it rests.
    pub frame: Option<FrameSection>,
    /// Simulated time, and distance of rows.
    pub load: SystemLoad,
    /// Named windows of the run, of the shaft and of all its bearings.
    pub phases: Vec<PhaseSection>,
    /// Loads over its life.
    pub duty: Vec<DutySection>,
    /// Its text, which stands alone: every bearing with its whole scene in place of a file or a designation.
    pub source: String,
}

/// A bearing of a system.
#[derive(Clone, Debug)]
pub struct MountedScene {
    /// Its name, which names of its variables begin with.
    pub name: String,
    /// Index of the shaft that it sits on.
    pub shaft: usize,
    /// Index of the shaft that its outer ring is a part of, if it is one of a shaft.
    pub outer_shaft: Option<usize>,
    /// Where it sits.
    pub mounting: Mounting,
    /// Has it states in the steps of the machine, or are its balls in balance at every place of its rings?
    pub level: Level,
    /// Number that a package changes the level by: 1 with states, 0 without; none where the level stays.
    pub dynamic: Option<f64>,
    /// Is the level found out by what acts, before a run? With states until then.
    pub finds_level: bool,
    /// The bearing by itself, in axes of its own; its inner race is moved by the shaft.
    pub scene: Scene,
}

impl MountedScene {
    /// Its level at present.
    pub fn level(&self) -> Level {
        match self.dynamic {
            Some(0.0) => Level::Equilibrium,
            Some(_) => Level::Dynamic,
            None => self.level,
        }
    }

    /// \[m] place x, y, z of its centre in the axes of all shafts, which are given.
    pub fn place(&self, shafts: &[ShaftSection]) -> [f64; 3] {
        shafts[self.shaft].place(self.mounting.position.0)
    }

    /// \[m, rad] place across the axis and tilt of the bore that its outer ring sits in, in the axes of the shaft.
    pub fn bore(&self) -> (Vector3<f64>, Vector3<f64>) {
        self.mounting.bore()
    }

    /// \[kg] mass of its outer ring, if that slides along the bore.
    pub fn sliding_mass(&self) -> Option<f64> {
        let slides = self.mounting.axial == AxialSeat::Free;
        self.scene.outer.mass.filter(|_| slides).map(|mass| mass.0)
    }
}

/// Force and moment at a named point of a shaft or a housing, in the shaft's axes.
#[derive(Clone, Copy, Debug)]
pub struct NamedLoad<'a> {
    /// Its name.
    pub name: &'a str,
    /// \[N] force.
    pub force: &'a Components<Force>,
    /// [N m] moment.
    pub moment: &'a Components<Moment>,
    on: On<'a>,
}

/// Part of a machine that a load acts on.
#[derive(Clone, Copy, Debug)]
enum On<'a> {
    Shaft(&'a PointLoad),
    Housing(&'a HousingLoad),
}

impl<'a> NamedLoad<'a> {
    fn of_shaft(load: &'a PointLoad) -> Self {
        Self { name: &load.name, force: &load.force, moment: &load.moment, on: On::Shaft(load) }
    }

    fn of_housing(load: &'a HousingLoad) -> Self {
        Self { name: &load.name, force: &load.force, moment: &load.moment, on: On::Housing(load) }
    }

    /// Does it give a component (displacements 0 to 2, rotations 3 to 5) of the motion there?
    pub fn gives(&self, component: usize) -> bool {
        self.motion().any(|(_, given, _)| given == component)
    }

    /// Components of the motion there that are given.
    pub fn motion(&self) -> impl Iterator<Item = GivenMotion<'a>> + use<'a> {
        let (shaft, housing) = match self.on {
            On::Shaft(load) => (Some(load), None),
            On::Housing(load) => (None, Some(load)),
        };
        let of_shaft = shaft.into_iter().flat_map(PointLoad::motion);
        of_shaft.chain(housing.into_iter().flat_map(HousingLoad::motion))
    }

    /// Does a table give something of it?
    pub fn is_scripted(&self) -> bool {
        self.force.is_scripted() || self.moment.is_scripted()
    }
}

impl fmt::Display for NamedLoad<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let section = match self.on {
            On::Shaft(_) => "shaft.load",
            On::Housing(_) => "housing.load",
        };
        write!(f, "{section} \"{}\"", self.name)
    }
}

/// Simulated time, and distance of rows.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SystemLoad {
    /// \[s] simulated time.
    pub duration: Time,
    /// \[s] distance of two rows of results.
    pub output_interval: Time,
}

impl SystemScene {
    /// Notes for the reader of each bearing's scene.
    pub fn notes(&self) -> Vec<String> {
        let of = |mounted: &MountedScene| {
            let name = mounted.name.clone();
            mounted.scene.doubts().into_iter().map(move |note| format!("bearing {name}: {note}"))
        };
        self.bearings.iter().flat_map(of).chain(unusual(&self.source)).collect()
    }

    /// Motion of the machine's frame at a time \[s], and gravity in it.
    pub fn frame_at(&self, time: f64) -> FrameMotion {
        let motion = self.frame.as_ref().map(|section| section.at(time)).unwrap_or_default();
        FrameMotion { gravity: self.gravity.at(time), ..motion }
    }

    /// Named loads of the shafts, then those of every housing.
    pub fn loads(&self) -> impl Iterator<Item = NamedLoad<'_>> {
        let shafts = self.shafts.iter().flat_map(|shaft| &shaft.load).map(NamedLoad::of_shaft);
        let housings = self.housings.iter().flat_map(|housing| &housing.load).map(NamedLoad::of_housing);
        shafts.chain(housings)
    }

    /// Writes the scenes of its bearings into the text, after they were changed.
    pub(crate) fn renew_source(&mut self) {
        if let Ok(mut table) = toml::from_str::<Table>(&self.source) {
            write_bearings(&mut table, &self.bearings, self.gravity.largest() != 0.0);
            self.source = table.to_string();
        }
    }

    /// Meshes `[[shaft.gear]]` of the first shaft, then of the next.
    pub fn gears(&self) -> impl Iterator<Item = &GearSection> {
        self.shafts.iter().flat_map(|shaft| &shaft.gear)
    }

    /// Motions that are given at named loads, with the load of each, in the order of [`SystemScene::loads`].
    pub fn motions(&self) -> impl Iterator<Item = (NamedLoad<'_>, GivenMotion<'_>)> {
        self.loads().flat_map(|load| load.motion().map(move |given| (load, given)))
    }

    /// Motions that are given at named loads of a structure (shafts, then housings), with the index of the load among those of the structure.
    pub fn held(&self, structure: usize) -> impl Iterator<Item = (usize, GivenMotion<'_>)> {
        let shaft = self.shafts.get(structure).into_iter().flat_map(|shaft| shaft.load.iter().enumerate());
        let housing = structure.checked_sub(self.shafts.len()).and_then(|index| self.housings.get(index));
        let housing = housing.into_iter().flat_map(|housing| housing.load.iter().enumerate());
        let of_shaft = shaft.flat_map(|(own, load)| load.motion().map(move |given| (own, given)));
        of_shaft.chain(housing.flat_map(|(own, load)| load.motion().map(move |given| (own, given))))
    }

    /// Forces that turn of the first shaft, then of the next.
    pub fn rotating(&self) -> impl Iterator<Item = &RotatingSection> {
        self.shafts.iter().flat_map(|shaft| &shaft.rotating)
    }

    /// Names of meshes, then of bearings by their stiffness, then of couplings.
    pub fn link_names(&self) -> impl Iterator<Item = &str> {
        let meshes = self.meshes.iter().map(|mesh| mesh.section.name.as_str());
        meshes.chain(self.springs.iter().map(|spring| spring.name.as_str()))
    }

    /// Does a shaft twist? Of beams that carry a torque between gears, if the file does not say so.
    pub fn twists(&self, shaft: usize) -> bool {
        let section = &self.shafts[shaft];
        let coupled = self.springs.iter().filter_map(SceneSpring::couples);
        let mut tied = self.meshes.iter().map(|mesh| mesh.shafts).chain(coupled);
        let meshed = tied.any(|shafts| shafts.contains(&shaft));
        !section.section.is_empty() && section.torsion.unwrap_or(meshed)
    }

    /// Bearings of which a ring is a part of a shaft, by their indices.
    pub fn bearings_on(&self, shaft: usize) -> impl Iterator<Item = usize> {
        (0..self.bearings.len()).filter(move |bearing| {
            let MountedScene { shaft: inner, outer_shaft, .. } = &self.bearings[*bearing];
            *inner == shaft || *outer_shaft == Some(shaft)
        })
    }

    /// Schedules of what acts on the shafts, their housings and bearings.
    pub fn schedules(&self) -> impl Iterator<Item = &Schedule> {
        let loads = self.loads().flat_map(|load| load.force.0.iter().chain(&load.moment.0));
        let drive = self.shafts.iter().flat_map(|shaft| shaft.speed.iter().chain(&shaft.torque));
        let gears = self.gears().map(|gear| &gear.torque);
        let frictions = self.bearings.iter().map(|mounted| &mounted.scene.friction.ball_race);
        let oils = self.bearings.iter().filter_map(|mounted| mounted.scene.effects.film.schedule());
        let frame = self.frame.iter().flat_map(FrameSection::schedules).chain(&self.gravity.0);
        let rotating = self.rotating().flat_map(RotatingSection::schedules);
        let held = self.motions().map(|(_, (.., schedule))| schedule);
        loads.chain(held).chain(drive).chain(gears).chain(rotating).chain(frictions).chain(oils).chain(frame)
    }

    /// Those of loads, speeds and torques, which an importer may set, to be changed.
    pub(crate) fn acting(&mut self) -> Vec<&mut Schedule> {
        let Self { shafts, housings, .. } = self;
        let mut all = vec![];
        for shaft in shafts {
            all.extend(shaft.speed.iter_mut().chain(&mut shaft.torque));
            all.extend(
                shaft.load.iter_mut().flat_map(|load| load.force.0.iter_mut().chain(&mut load.moment.0)),
            );
            all.extend(shaft.gear.iter_mut().map(|gear| &mut gear.torque));
        }
        let of_housing = housings.iter_mut().flat_map(|housing| &mut housing.load);
        all.extend(of_housing.flat_map(|load| load.force.0.iter_mut().chain(&mut load.moment.0)));
        all
    }

    /// Housing that the outer race of a bearing sits in, by their indices.
    pub fn housing_of(&self, bearing: usize) -> Option<usize> {
        let wanted = self.bearings[bearing].mounting.housing.as_ref()?;
        self.housings.iter().position(|housing| housing.name == *wanted)
    }

    /// Bearings whose outer rings sit in bores of the ground that are tilted, lie off, or let them slide, by their indices.
    pub fn bearings_in_ground(&self) -> impl Iterator<Item = usize> {
        (0..self.bearings.len()).filter(|bearing| {
            let mounting = &self.bearings[*bearing].mounting;
            mounting.housing.is_none() && mounting.has_bore()
        })
    }

    /// Bearings that sit in a housing, by their indices.
    pub fn bearings_in(&self, housing: usize) -> impl Iterator<Item = usize> {
        (0..self.bearings.len()).filter(move |bearing| self.housing_of(*bearing) == Some(housing))
    }

    /// \[m] smallest diameter of a ball; of a roller where there are none.
    pub fn smallest_element(&self) -> f64 {
        let balls = self.bearings.iter().map(|bearing| bearing.scene.bearing.ball_diameter.0);
        balls.reduce(f64::min).unwrap_or_else(|| linked::smallest_roller(&self.springs))
    }

    /// Settings of the integration, to be changed: those of a bearing by its index, or the only ones where there is none of balls.
    pub(crate) fn solver_of(&mut self, index: usize) -> Option<&mut Solver> {
        match self.bearings.is_empty() {
            true => (index == 0).then_some(&mut self.of_links),
            false => self.bearings.get_mut(index).map(|bearing| &mut bearing.scene.solver),
        }
    }

    /// Settings of the integration: those that steps of all bearings need.
    pub fn solver(&self) -> Solver {
        let Some((first, others)) = self.bearings.split_first() else { return self.of_links };
        let mut solver = first.scene.solver;
        for bearing in others {
            let own = bearing.scene.solver;
            let smaller = |a: Time, b: Time| if b.0 < a.0 { b } else { a };
            solver.max_step = smaller(solver.max_step, own.max_step);
            solver.initial_step = smaller(solver.initial_step, own.initial_step);
            solver.min_step = smaller(solver.min_step, own.min_step);
        }
        solver
    }
}
