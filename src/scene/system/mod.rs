//! The file of a system: a shaft, its bearings, and what loads it.
//!
//! It is TOML as the scene of one bearing is. Each `[[bearing]]` has the keys of such a scene by itself (`scene`, a file or the keys
//! themselves; or `catalogue`, a designation), changed by `[bearing.set]`, and where it sits on the shaft, `[bearing.mounting]`.

mod check;
mod check_housing;

use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use serde::Deserialize;
use toml::{Table, Value};

use super::{Scene, SceneError};
use crate::catalogue::Request;
use crate::schema::units::{Acceleration, Force, Moment, Time};
use crate::schema::{
    Components, HousingSection, Matrices, Mounting, MountingDirection, ShaftSection, Solver, explain,
};

/// A shaft with its bearings, as described by a file.
#[derive(Clone, Debug)]
pub struct SystemScene {
    /// One line for results.
    pub title: String,
    /// The shaft.
    pub shaft: ShaftSection,
    /// Housings that outer races sit in.
    pub housings: Vec<HousingSection>,
    /// The bearings.
    pub bearings: Vec<MountedScene>,
    /// [m/s2] acceleration of gravity in the axes of the shaft, constant.
    pub gravity: Vector3<f64>,
    /// Simulated time, and distance of rows.
    pub load: SystemLoad,
    /// Its text, which stands alone: every bearing with its whole scene in place of a file or a designation.
    pub source: String,
}

/// A bearing of a system.
#[derive(Clone, Debug)]
pub struct MountedScene {
    /// Its name, which names of its variables begin with.
    pub name: String,
    /// Where it sits.
    pub mounting: Mounting,
    /// The bearing by itself, in axes of its own; its inner race is moved by the shaft.
    pub scene: Scene,
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
}

impl NamedLoad<'_> {
    /// Does a table give something of it?
    pub fn is_scripted(&self) -> bool {
        self.force.is_scripted() || self.moment.is_scripted()
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

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    /// One line for plots and results.
    #[serde(default)]
    title: String,
    /// The shaft.
    shaft: ShaftSection,
    /// Housings that outer races sit in.
    #[serde(default)]
    housing: Vec<HousingSection>,
    /// The bearings.
    bearing: Vec<WrittenBearing>,
    /// Simulated time, and distance of rows.
    load: SystemLoad,
    /// [m/s2] acceleration of gravity along the shaft's x, y, z, constant: it acts on the shaft and inside the bearings. 0 if not given.
    #[serde(default)]
    gravity: Components<Acceleration>,
    /// Time integration, as in the scene of a bearing; instead of those of the bearings' own scenes.
    #[serde(default)]
    solver: Table,
}

/// A bearing as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenBearing {
    /// Its name: letters, digits, _ and -.
    name: String,
    /// Its scene: a file beside this one, or the keys of a scene; or `catalogue`.
    scene: Option<Value>,
    /// Its designation in the catalogue, such as 7206 B.
    catalogue: Option<String>,
    /// Where it sits on the shaft.
    mounting: Mounting,
    /// Keys of its scene that are changed, section by section.
    #[serde(default)]
    set: Table,
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
        let text = std::fs::read_to_string(path)
            .map_err(|source| SceneError::Read { path: path.display().to_string(), source })?;
        Self::parse(&text, Some(&path.display().to_string()), path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a system from text; its files are in a folder, and its own name stands in errors.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn parse(text: &str, file: Option<&str>, folder: &Path) -> Result<Self, SceneError> {
        let placed = |error| explain::with_place(error, text, None, file);
        match Scene::with_files(text, folder).map_err(placed)? {
            // Lines of the text with the tables are not those that the reader of a message has.
            Some(text) => {
                Self::read(&text, folder, |error, spot| explain::with_place(error, &text, spot, None))
            }
            None => Self::read(text, folder, |error, spot| explain::with_place(error, text, spot, file)),
        }
    }

    /// Reads a system from a text that stands alone, as [`SystemScene::source`] does; errors name no lines, which nobody has written.
    ///
    /// # Errors
    /// See [`SceneError`].
    pub fn edited(text: &str) -> Result<Self, SceneError> {
        Self::read(text, Path::new(""), |error, _| error)
    }

    /// Reads a system whose schedules name no files.
    fn read(
        text: &str,
        folder: &Path,
        place: impl Fn(SceneError, Option<usize>) -> SceneError,
    ) -> Result<Self, SceneError> {
        let written: Written = toml::from_str(text).map_err(|why| {
            let spot = why.span().map(|span| span.start);
            place(explain::format_error(text, &why), spot)
        })?;
        let placed = |error| place(error, None);
        check::check(&written).map_err(placed)?;
        let Written { title, mut shaft, mut housing, bearing, load, gravity, solver } = written;
        let gravity = gravity.at(0.0);
        let matrices = |given: &Option<Value>, key: &str| {
            let read = given.as_ref().map(|given| Matrices::of(given, folder, key)).transpose()?;
            let checked = read.as_ref().map(|matrices| matrices.checked(key)).transpose()?;
            Ok((read, checked))
        };
        let of_shaft;
        (of_shaft, shaft.read) = matrices(&shaft.matrices, "shaft.matrices").map_err(placed)?;
        let mut of_housings = vec![];
        for housing in &mut housing {
            let key = format!("housing \"{}\": housing.matrices", housing.name);
            let (read, checked) = matrices(&housing.matrices, &key).map_err(placed)?;
            housing.read = checked;
            of_housings.push(read);
        }
        let speed = shaft.speed.as_ref().map_or(0.0, |speed| speed.at(0.0));
        let given = Shared { gravity, speed, load, solver, folder: folder.to_path_buf() };
        let bearings = bearing.into_iter().map(|bearing| bearing.read(&given));
        let bearings = bearings.collect::<Result<Vec<_>, _>>().map_err(placed)?;
        check::solvers(&bearings).map_err(placed)?;
        let source = standing_alone(text, &bearings, of_shaft.as_ref(), &of_housings);
        Ok(Self { title, shaft, housings: housing, bearings, gravity, load, source })
    }

    /// What the reader of each bearing's scene should know.
    pub fn notes(&self) -> Vec<String> {
        let of = |mounted: &MountedScene| {
            let name = mounted.name.clone();
            mounted.scene.notes().into_iter().map(move |note| format!("bearing {name}: {note}"))
        };
        self.bearings.iter().flat_map(of).collect()
    }

    /// Named loads of the shaft, then those of every housing.
    pub fn loads(&self) -> impl Iterator<Item = NamedLoad<'_>> {
        let shaft = self.shaft.load.iter();
        let shaft =
            shaft.map(|load| NamedLoad { name: &load.name, force: &load.force, moment: &load.moment });
        let housings = self.housings.iter().flat_map(|housing| &housing.load);
        shaft.chain(housings.map(|load| NamedLoad {
            name: &load.name,
            force: &load.force,
            moment: &load.moment,
        }))
    }

    /// Housing that the outer race of a bearing sits in, by their indices.
    pub fn housing_of(&self, bearing: usize) -> Option<usize> {
        let wanted = self.bearings[bearing].mounting.housing.as_ref()?;
        self.housings.iter().position(|housing| housing.name == *wanted)
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

/// What all bearings of a system are given.
struct Shared {
    gravity: Vector3<f64>,
    speed: f64,
    load: SystemLoad,
    solver: Table,
    folder: PathBuf,
}

impl WrittenBearing {
    /// The bearing with its scene.
    fn read(self, given: &Shared) -> Result<MountedScene, SceneError> {
        let Self { name, scene, catalogue, mounting, set } = self;
        let inside =
            |source| SceneError::At { place: format!("bearing \"{name}\""), source: Box::new(source) };
        let (text, folder, file) = match (scene, catalogue) {
            (Some(Value::Table(keys)), None) => (keys.to_string(), given.folder.clone(), None),
            (Some(Value::String(file)), None) => {
                let path = given.folder.join(&file);
                let text = std::fs::read_to_string(&path)
                    .map_err(|source| SceneError::Read { path: path.display().to_string(), source })
                    .map_err(inside)?;
                (text, path.parent().unwrap_or(Path::new("")).to_path_buf(), Some(file))
            }
            (None, Some(designation)) => {
                let request = Request { designation: Some(designation.clone()), ..Request::default() };
                let text = request.bearing().and_then(|bearing| bearing.scene(1));
                let refuse =
                    |why| inside(SceneError::conflict("bearing.catalogue", format!("{designation}: {why}")));
                (text.map_err(refuse)?, given.folder.clone(), None)
            }
            _ => {
                let why = "give exactly one of scene (a file, or its keys) and catalogue (a designation)";
                return Err(inside(SceneError::conflict("bearing", why)));
            }
        };
        let mut table: Table = toml::from_str(&text)
            .map_err(|why| explain::format_error(&text, &why))
            .map_err(|why| explain::with_place(why, &text, None, file.as_deref()))
            .map_err(inside)?;
        merge(&mut table, set);
        if mounting.housing.is_some() {
            in_housing(&mut table).map_err(inside)?;
        }
        mount(&mut table, given, mounting.direction);
        let scene = Scene::parse_of(&table.to_string(), None, &folder).map_err(inside)?;
        Ok(MountedScene { name, mounting, scene })
    }
}

/// The text of a system with the whole scene of every bearing and the matrices of its shaft and housings in it.
fn standing_alone(
    text: &str,
    bearings: &[MountedScene],
    of_shaft: Option<&Matrices>,
    of_housings: &[Option<Matrices>],
) -> String {
    let Ok(mut table) = toml::from_str::<Table>(text) else {
        return text.to_string();
    };
    let put = |into: Option<&mut Value>, matrices: Option<&Matrices>| {
        let matrices = matrices.and_then(|matrices| Value::try_from(matrices).ok());
        if let (Some(keys), Some(matrices)) = (into.and_then(Value::as_table_mut), matrices) {
            keys.insert("matrices".into(), matrices);
        }
    };
    put(table.get_mut("shaft"), of_shaft);
    let housings = table.get_mut("housing").and_then(Value::as_array_mut).into_iter().flatten();
    for (keys, matrices) in housings.zip(of_housings) {
        put(Some(keys), matrices.as_ref());
    }
    let written = table.get_mut("bearing").and_then(Value::as_array_mut).into_iter().flatten();
    for (keys, bearing) in written.filter_map(Value::as_table_mut).zip(bearings) {
        keys.remove("catalogue");
        keys.remove("set");
        let scene = toml::from_str::<Table>(&bearing.scene.source).unwrap_or_default();
        keys.insert("scene".into(), scene.into());
    }
    table.to_string()
}

/// Sets keys of a table, section by section.
fn merge(into: &mut Table, changes: Table) {
    for (key, value) in changes {
        match (into.get_mut(&key), value) {
            (Some(Value::Table(section)), Value::Table(changes)) => merge(section, changes),
            (_, value) => {
                into.insert(key, value);
            }
        }
    }
}

/// Takes a section out of a table; an empty one if there is none.
fn section(table: &mut Table, name: &str) -> Table {
    match table.remove(name) {
        Some(Value::Table(section)) => section,
        _ => Table::new(),
    }
}

/// Makes a bearing's own scene that of a bearing whose outer race a housing moves.
fn in_housing(table: &mut Table) -> Result<(), SceneError> {
    let mut outer = section(table, "outer");
    let why = "the outer race sits in mounting.housing, which moves it";
    if let Some(key) = ["support", "misalignment"].into_iter().find(|key| outer.contains_key(*key)) {
        return Err(SceneError::conflict(format!("outer.{key}"), why));
    }
    if outer.get("drive").and_then(Value::as_str).is_some_and(|drive| drive != "fixed" && drive != "pose") {
        return Err(SceneError::conflict("outer.drive", why));
    }
    if let Some(load) = table.get_mut("load").and_then(Value::as_table_mut)
        && load.contains_key("outer_speed")
    {
        return Err(SceneError::conflict("load.outer_speed", why));
    }
    outer.insert("drive".into(), "pose".into());
    table.insert("outer".into(), outer.into());
    Ok(())
}

/// Makes a bearing's own scene that of a bearing whose inner race the shaft moves.
fn mount(table: &mut Table, given: &Shared, direction: MountingDirection) {
    let mut inner = section(table, "inner");
    inner.insert("drive".into(), "pose".into());
    table.insert("inner".into(), inner.into());
    let mut load = section(table, "load");
    let outer_speed = load.remove("outer_speed");
    let mut load = Table::new();
    load.extend(outer_speed.map(|speed| ("outer_speed".to_string(), speed)));
    load.insert("duration".into(), given.load.duration.0.into());
    load.insert("output_interval".into(), given.load.output_interval.0.into());
    load.insert("inner_speed".into(), (direction.sign() * given.speed).into());
    for (direction, key) in [
        ("x", "displacement"),
        ("y", "displacement"),
        ("z", "displacement"),
        ("ry", "rotation"),
        ("rz", "rotation"),
    ] {
        load.insert(direction.into(), Table::from_iter([(key.to_string(), Value::from(0.0))]).into());
    }
    table.insert("load".into(), load.into());
    if !given.solver.is_empty() {
        table.insert("solver".into(), given.solver.clone().into());
    }
    let mut effects = section(table, "effects");
    if given.gravity != Vector3::zeros() {
        let sign = direction.sign();
        let turned = [sign * given.gravity.x, sign * given.gravity.y, given.gravity.z];
        effects.insert("gravity".into(), turned.map(Value::from).to_vec().into());
    }
    table.insert("effects".into(), effects.into());
}
