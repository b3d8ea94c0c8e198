//! A machine is read from its file: its sections, what they have to agree on, and its text that stands alone.

use std::path::Path;

use serde::Deserialize;
use toml::{Table, Value};

use super::bearing::{Catalogue, Shared, WrittenBearing};
use super::source::standing_alone;
use super::{SystemLoad, SystemScene, check, check_held, linked, mesh, planets, rows, spring};
use crate::catalogue;
use crate::effects::frame::FrameSection;
use crate::scene::{Ranges, Scene, SceneError};
use crate::schema::units::Acceleration;
use crate::schema::{
    Components, CouplingSection, DutySection, HousingSection, Interface, Matrices, MeshSection, PhaseSection,
    Shafts, Solver, explain, regular,
};

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
pub struct Written {
    /// One line for plots and results.
    #[serde(default)]
    pub title: String,
    /// The shaft, or several of them as `[[shaft]]`.
    pub shaft: Shafts,
    /// Housings that outer races sit in.
    #[serde(default)]
    pub housing: Vec<HousingSection>,
    /// Gears in mesh.
    #[serde(default)]
    pub mesh: Vec<MeshSection>,
    /// Springs and dampers between two shafts.
    #[serde(default)]
    pub coupling: Vec<CouplingSection>,
    /// The bearings.
    pub bearing: Vec<WrittenBearing>,
    /// Simulated time, and distance of rows.
    pub load: SystemLoad,
    /// Named windows of the run, which have means and lives of their own.
    #[serde(default)]
    pub phase: Vec<PhaseSection>,
    /// Loads over its life, each with its part of the time: `roulement rating` adds up what they take of it.
    #[serde(default)]
    pub duty: Vec<DutySection>,
    /// [m/s2] acceleration of gravity along the shaft's x, y, z, each constant or a table: it acts on the shaft and inside the bearings. 0 if not given.
    #[serde(default)]
    pub gravity: Components<Acceleration>,
    /// Motion of the frame that shafts, housings and bearings are seen from, as `effects.frame` of a bearing alone; along the shaft's axes.
    pub frame: Option<FrameSection>,
    /// Time integration, as in the scene of a bearing; instead of those of the bearings' own scenes.
    #[serde(default)]
    pub solver: Table,
    /// Interface of the FMU: `arrays`, true or false, as in the scene of a bearing.
    #[serde(default)]
    pub interface: Interface,
    /// Keys of this file, each with the two ends of the range that a package can meet; `effects.auto` of a package is judged at all their corners.
    #[serde(default)]
    pub ranges: Ranges,
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
        let of_links = match bearings.is_empty() {
            true => linked::solver(&given.solver, &springs).map_err(placed)?,
            false => Solver::default(),
        };
        check::solvers(&bearings, &of_links, &shafts).map_err(placed)?;
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
            of_links,
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
}
