//! The file of a system: shafts, their bearings, and what loads them.
//!
//! It is TOML as the scene of one bearing is. Each `[[bearing]]` has the keys of such a scene by itself (`scene`, a file or the keys
//! themselves; or `catalogue`, a designation), changed by `[bearing.set]`, and where it sits on the shaft, `[bearing.mounting]`.

mod bearing;
mod check;
mod check_held;
mod check_housing;
mod check_motion;
pub mod mesh;
mod numbers;
mod planets;
mod ranges;
mod roller_film;
mod rollers;
mod rows;
mod source;
pub mod spring;

use std::fmt;
use std::path::Path;

use bearing::{Catalogue, Shared, WrittenBearing};
use mesh::SceneMesh;
use nalgebra::Vector3;
pub use numbers::{ShaftNumber, ShaftParameter};
use serde::Deserialize;
use source::{standing_alone, write_bearings};
use spring::SceneSpring;
use toml::{Table, Value};

use super::typical::unusual;
use super::{FrameMotion, Level, Ranges, Scene, SceneError};
use crate::catalogue;
use crate::effects::frame::FrameSection;
use crate::schema::units::{Acceleration, Force, Moment, Time};
use crate::schema::{
    AxialSeat, Components, CouplingSection, DutySection, GearSection, GivenMotion, HousingLoad,
    HousingSection, Interface, Matrices, MeshSection, Mounting, PhaseSection, PointLoad, RotatingSection,
    Schedule, ShaftSection, Shafts, Solver, explain, regular,
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
    /// The bearings.
    pub bearings: Vec<MountedScene>,
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
    /// Is that found out by what acts, before a run? With states until then.
    pub finds_level: bool,
    /// The bearing by itself, in axes of its own; its inner race is moved by the shaft.
    pub scene: Scene,
}

impl MountedScene {
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

/// The catalogue that files are read with: the shelf beside them, then the table.
const CATALOGUE: Catalogue = Catalogue {
    balls: |name, folder| catalogue::scene_of(name, Some(folder)),
    rollers: catalogue::rollers_of,
    rows: catalogue::rows_of,
};
/// The same without the shelf, for texts that stand alone.
const TABLE: Catalogue = Catalogue { balls: |name, _| catalogue::scene_of(name, None), ..CATALOGUE };

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    /// One line for plots and results.
    #[serde(default)]
    title: String,
    /// The shaft, or several of them as `[[shaft]]`.
    shaft: Shafts,
    /// Housings that outer races sit in.
    #[serde(default)]
    housing: Vec<HousingSection>,
    /// Gears in mesh.
    #[serde(default)]
    mesh: Vec<MeshSection>,
    /// Springs and dampers between two shafts.
    #[serde(default)]
    coupling: Vec<CouplingSection>,
    /// The bearings.
    bearing: Vec<WrittenBearing>,
    /// Simulated time, and distance of rows.
    load: SystemLoad,
    /// Named windows of the run, which have means and lives of their own.
    #[serde(default)]
    phase: Vec<PhaseSection>,
    /// Loads over its life, each with its part of the time: `roulement rating` adds up what they take of it.
    #[serde(default)]
    duty: Vec<DutySection>,
    /// [m/s2] acceleration of gravity along the shaft's x, y, z, each constant or a table: it acts on the shaft and inside the bearings. 0 if not given.
    #[serde(default)]
    gravity: Components<Acceleration>,
    /// Motion of the frame that shafts, housings and bearings are seen from, as `effects.frame` of a bearing alone; along the shaft's axes.
    frame: Option<FrameSection>,
    /// Time integration, as in the scene of a bearing; instead of those of the bearings' own scenes.
    #[serde(default)]
    solver: Table,
    /// Interface of the FMU: `arrays`, true or false, as in the scene of a bearing.
    #[serde(default)]
    interface: Interface,
    /// Keys of this file, each with the two ends of the range that a package can meet; `effects.auto` of a package is judged at all their corners.
    #[serde(default)]
    ranges: Ranges,
}

impl SystemScene {
    /// Is this text that of a system? It has a section `[shaft]`, which the scene of one bearing has not.
    pub fn is_system(text: &str) -> bool {
        toml::from_str::<Table>(text).is_ok_and(|table| table.contains_key("shaft"))
    }

    /// Reads the file of a system.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text = regular::scene(path)?;
        Self::parse(&text, Some(&path.display().to_string()), path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a system from text; its files are in a folder, and its own name stands in errors.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn parse(text: &str, file: Option<&str>, folder: &Path) -> Result<Self, SceneError> {
        let placed = |error| explain::with_place(error, text, None, file);
        let read = |text: &str, file: Option<&str>| {
            let place = |error, spot| explain::with_place(error, text, spot, file);
            Self::read(text, folder, CATALOGUE, &place)
        };
        match Scene::with_files(text, folder).map_err(placed)? {
            // Lines of the text with the tables are not those that the reader of a message has.
            Some(text) => read(&text, None),
            None => read(text, file),
        }
    }

    /// Reads a system from a text that stands alone, as [`SystemScene::source`] does; errors name no lines, which nobody has written.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn edited(text: &str) -> Result<Self, SceneError> {
        Self::alone(text, TABLE)
    }

    /// The same, with the catalogue that its bearings are looked up in.
    fn alone(text: &str, catalogue: Catalogue) -> Result<Self, SceneError> {
        Self::read(text, Path::new(""), catalogue, &|error, _| error)
    }

    /// Reads the system of a package, whose text is that of [`SystemScene::source`]: its bearings have scenes and no designations.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn of_package(text: &str) -> Result<Self, SceneError> {
        let none = Catalogue {
            balls: |_, _| Err("a package has the scenes of its bearings, and no catalogue".into()),
            rollers: |_| None,
            rows: |_| None,
        };
        Self::alone(text, none)
    }

    /// Reads a system whose schedules name no files.
    fn read(
        text: &str,
        folder: &Path,
        catalogue: Catalogue,
        place: &dyn Fn(SceneError, Option<usize>) -> SceneError,
    ) -> Result<Self, SceneError> {
        // Lines of the text with the rows are not those that the reader of a message has.
        if let Some(text) = rows::in_rows(text, catalogue).map_err(|why| place(why, None))? {
            return Self::read(&text, folder, catalogue, &|why, _| place(why, None));
        }
        check::elsewhere(text).map_err(|why| place(why, None))?;
        let mut written: Written = explain::read(text).map_err(|(why, spot)| place(why, spot))?;
        let placed = |error| place(error, None);
        let rollers = written.bearing.iter_mut().map(|bearing| bearing.find_rollers(catalogue));
        let rollers = rollers.collect::<Result<Vec<_>, _>>().map_err(placed)?;
        check::check(&written).map_err(placed)?;
        let Written {
            title,
            shaft: Shafts(mut shafts),
            mut housing,
            mesh,
            coupling,
            bearing,
            load,
            phase: phases,
            duty,
            gravity,
            frame,
            solver,
            interface,
            ranges,
        } = written;
        let matrices = |given: &Option<Value>, key: &str| {
            let read = given.as_ref().map(|given| Matrices::of(given, folder, key)).transpose()?;
            let checked = read.as_ref().map(|matrices| matrices.checked(key)).transpose()?;
            Ok((read, checked))
        };
        let mut of_shafts = vec![];
        for shaft in &mut shafts {
            let (read, checked) = matrices(&shaft.matrices, "shaft.matrices").map_err(placed)?;
            shaft.read = checked;
            of_shafts.push(read);
        }
        let mut of_housings = vec![];
        for housing in &mut housing {
            let key = format!("housing \"{}\": housing.matrices", housing.name);
            let (read, checked) = matrices(&housing.matrices, &key).map_err(placed)?;
            housing.read = checked;
            of_housings.push(read);
        }
        let meshes = mesh.into_iter().map(|mesh| mesh::read(mesh, &shafts));
        let mut meshes = meshes.collect::<Result<Vec<_>, _>>().map_err(placed)?;
        let (springs, bearing): (Vec<_>, Vec<_>) = bearing.into_iter().partition(WrittenBearing::links);
        let springs = springs.into_iter().map(|spring| Ok(spring.spring(&shafts, &housing)));
        let couplings = coupling.iter().map(|coupling| spring::coupling(coupling, &shafts));
        let springs = springs.chain(couplings).collect::<Result<Vec<_>, _>>().map_err(placed)?;
        mesh::check_trains(&shafts, &meshes, &springs).map_err(placed)?;
        planets::place(&shafts, &mut meshes).map_err(placed)?;
        let speed = |train: mesh::InTrain| {
            train.ratio * shafts[train.root].speed.as_ref().map_or(0.0, |speed| speed.at(0.0))
        };
        let turning = shafts.iter().zip(mesh::trains(&shafts, &meshes, &springs));
        let shafts_turn = turning.map(|(shaft, train)| (shaft.name.clone(), speed(train))).collect();
        let given = Shared {
            gravity: gravity.clone(),
            shafts: shafts_turn,
            load,
            solver,
            folder: folder.to_path_buf(),
            catalogue,
        };
        let bearings = bearing.into_iter().map(|bearing| bearing.read(&given));
        let mut bearings = bearings.collect::<Result<Vec<_>, _>>().map_err(placed)?;
        check::solvers(&bearings, &shafts).map_err(placed)?;
        check_held::held(&shafts, &bearings, &springs).map_err(placed)?;
        for mounted in &mut bearings {
            let (place, direction) = (mounted.place(&shafts), mounted.mounting.direction.sign());
            let effects = &mut mounted.scene.effects;
            effects.frame.section = frame.as_ref().map(|frame| frame.at_bearing(&place.into(), direction));
            effects.gravity.is_input = frame.is_some();
            effects.cage.check_frame(frame.is_some()).map_err(placed)?;
        }
        let weighs = gravity.largest() != 0.0;
        let source = standing_alone(text, (&bearings, &rollers), &of_shafts, &of_housings, weighs);
        ranges.check(&source, |text| Self::alone(text, catalogue).map(drop)).map_err(placed)?;
        Ok(Self {
            title,
            shafts,
            housings: housing,
            meshes,
            springs,
            bearings,
            gravity,
            frame,
            load,
            phases,
            duty,
            interface,
            ranges,
            source,
        })
    }

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

    /// Settings of the integration: those that steps of all bearings need.
    pub fn solver(&self) -> Solver {
        let mut solver = self.bearings[0].scene.solver;
        for bearing in &self.bearings {
            let own = bearing.scene.solver;
            let smaller = |a: Time, b: Time| if b.0 < a.0 { b } else { a };
            solver.max_step = smaller(solver.max_step, own.max_step);
            solver.initial_step = smaller(solver.initial_step, own.initial_step);
            solver.min_step = smaller(solver.min_step, own.min_step);
        }
        solver
    }
}
