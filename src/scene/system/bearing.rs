//! A bearing of a system as it is written, and how its own scene becomes that of a bearing on a shaft.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::{Table, Value};

use super::rollers::{bearing, way_of_preload};
use super::spring::SceneSpring;
use super::{MountedScene, SystemLoad};
use crate::catalogue::{CatalogueError, DoubleRow};
use crate::effects::cage::IDEAL_CAGE_NEEDS;
use crate::effects::defects::On;
use crate::model::state::stack;
use crate::scene::{Drive, Level, Scene, SceneError};
use crate::schema::units::Acceleration;
use crate::schema::{
    AxialSeat, BearingLevel, Components, HousingSection, Method, Mounting, MountingDirection, RollersSection,
    ShaftSection, StiffnessSection, explain, reader, regular,
};

/// A bearing as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WrittenBearing {
    /// Its name: letters, digits, _ and -.
    pub name: String,
    /// Its scene: a file beside this one, or the keys of a scene; or `catalogue`.
    pub scene: Option<Value>,
    /// Its designation in the catalogue, such as 7206 B.
    pub catalogue: Option<String>,
    /// Level of its model: its motion in time (`"dynamic"`, if not given), elements in balance at every place of its rings, without states
    /// (`"equilibrium"`; rollers always are), or the one that what acts on it asks for (`"auto"`).
    pub level: Option<BearingLevel>,
    /// May a package change that level from one communication step to the next, by its parameter `NAME.dynamic`?
    #[serde(default)]
    pub level_changes: bool,
    /// Its stiffness, in place of a scene: springs instead of balls.
    pub stiffness: Option<StiffnessSection>,
    /// Its cylindrical or tapered rollers, in place of a scene.
    pub rollers: Option<RollersSection>,
    /// Name of the shaft that it sits on; needed where there are several.
    pub shaft: Option<String>,
    /// Where it sits on the shaft.
    pub mounting: Mounting,
    /// Keys of its scene that are changed, section by section.
    #[serde(default)]
    pub set: Table,
}

/// Data that all bearings of a system share.
pub struct Shared {
    /// [m/s2] gravity in the axes of the shaft.
    pub gravity: Components<Acceleration>,
    /// Name of every shaft, and its speed [rad/s] at the start.
    pub shafts: Vec<(String, f64)>,
    /// Simulated time, and distance of rows.
    pub load: SystemLoad,
    /// Keys of the time integration.
    pub solver: Table,
    /// Where files are.
    pub folder: PathBuf,
    /// Where designations are looked up.
    pub catalogue: Catalogue,
}

/// Scene of a ball bearing, as a text, and the mass of its outer ring \[kg]; or why there is none.
type Looked = Result<(String, f64), String>;

/// Where bearings are looked up by their designation. Packages have none, so that their library is spared the tables and their estimates.
#[derive(Clone, Copy)]
pub struct Catalogue {
    /// Ball bearings by their designation, in files of a folder.
    pub balls: fn(&str, &Path) -> Looked,
    /// Keys of the rollers of a roller bearing, as a text; none of another one.
    pub rollers: fn(&str) -> Option<Result<String, CatalogueError>>,
    /// Rows of a double-row ball bearing; none of another one.
    pub rows: fn(&str) -> Option<Result<DoubleRow, CatalogueError>>,
}

impl WrittenBearing {
    /// Takes the rollers of a designation in place of it, changed by what `set` says of them; gives their keys.
    ///
    /// # Errors
    /// With its name and what is wrong.
    pub fn find_rollers(&mut self, catalogue: Catalogue) -> Result<Option<Table>, SceneError> {
        let Some(found) = self.catalogue.as_deref().filter(|_| !self.links()).and_then(catalogue.rollers)
        else {
            return Ok(None);
        };
        let refuse = |key: String, why: String| SceneError::At {
            place: format!("bearing \"{}\"", self.name),
            source: Box::new(SceneError::conflict(key, why)),
        };
        let text = found.map_err(|why| refuse("bearing.catalogue".into(), why.to_string()))?;
        let mut keys = toml::from_str::<Table>(&text).unwrap_or_default();
        if let Some(Value::Table(changes)) = self.set.get("rollers") {
            keys.extend(changes.clone());
        }
        let read = reader::read(&Value::Table(keys.clone()));
        let rollers =
            read.map_err(|why| refuse(format!("bearing.set.rollers.{}", why.key()), why.message().into()))?;
        self.set.remove("rollers");
        (self.rollers, self.catalogue) = (Some(rollers), None);
        Ok(Some(keys))
    }

    /// Is it a link between the shaft and what it sits in, by its stiffness or by rollers?
    pub fn links(&self) -> bool {
        self.stiffness.is_some() || self.rollers.is_some()
    }

    /// The bearing by its stiffness or by rollers.
    pub fn spring(self, shafts: &[ShaftSection], housings: &[HousingSection]) -> SceneSpring {
        let Self { name, stiffness, rollers, shaft, mounting, .. } = self;
        let (offset, tilt) = mounting.bore();
        let named = |name: &Option<String>| shafts.iter().position(|own| name.as_ref() == Some(&own.name));
        SceneSpring {
            name,
            shaft: named(&shaft).unwrap_or(0),
            position: mounting.position.0,
            second: named(&mounting.outer_shaft),
            bore: mounting.bore(),
            housing: mounting.housing.and_then(|wanted| housings.iter().position(|own| own.name == wanted)),
            stiffness: stiffness.unwrap_or_default(),
            rollers: rollers.map(|rollers| {
                // That there is one was checked.
                let preload = way_of_preload(&rollers, &mounting.preload).unwrap_or_default();
                bearing(&rollers, mounting.direction.sign(), stack(&offset, &tilt), preload)
            }),
        }
    }

    /// The bearing with its scene.
    ///
    /// # Errors
    /// With its name and what is wrong.
    pub fn read(self, given: &Shared) -> Result<MountedScene, SceneError> {
        let Self { name, scene, catalogue, level, level_changes, shaft, mounting, set, .. } = self;
        let finds_level = level == Some(BearingLevel::Auto);
        let level = match level {
            Some(BearingLevel::Equilibrium) => Level::Equilibrium,
            Some(BearingLevel::Dynamic | BearingLevel::Auto) | None => Level::Dynamic,
        };
        // That there is such a shaft was checked.
        let named =
            |name: &Option<String>| given.shafts.iter().position(|(own, _)| name.as_ref() == Some(own));
        let (shaft, outer_shaft) = (named(&shaft).unwrap_or(0), named(&mounting.outer_shaft));
        let inside =
            |source| SceneError::At { place: format!("bearing \"{name}\""), source: Box::new(source) };
        if finds_level && level_changes {
            let why = "level = \"auto\" finds the level before the run; give the one to begin with, \"dynamic\" or \"equilibrium\"";
            return Err(inside(SceneError::conflict("bearing.level_changes", why)));
        }
        let mut estimated_mass = None;
        let catalogued = catalogue.is_some();
        let (text, folder, file) = match (scene, catalogue) {
            (Some(Value::Table(keys)), None) => (keys.to_string(), given.folder.clone(), None),
            (Some(Value::String(file)), None) => {
                let path = given.folder.join(&file);
                let text = regular::named(&path, "bearing.scene").map_err(inside)?;
                (text, path.parent().unwrap_or(Path::new("")).to_path_buf(), Some(file))
            }
            (None, Some(designation)) => {
                let (text, outer_ring_mass) =
                    (given.catalogue.balls)(&designation, &given.folder).map_err(|why| {
                        inside(SceneError::conflict("bearing.catalogue", format!("{designation}: {why}")))
                    })?;
                estimated_mass = (mounting.axial == AxialSeat::Free).then_some(outer_ring_mass);
                (text, given.folder.clone(), None)
            }
            _ => {
                let why = "give exactly one of scene (a file, or its keys) and catalogue (a designation)";
                return Err(inside(SceneError::conflict("bearing", why)));
            }
        };
        let mut table = explain::table(&text)
            .map_err(|(why, _)| explain::with_place(why, &text, None, file.as_deref()))
            .map_err(inside)?;
        if catalogued {
            leave_balls_free(&mut table);
        }
        let is_under_wrench = drive_of_outer(&set).or(drive_of_outer(&table)) == Some("wrench");
        check_changes(&set, is_under_wrench).map_err(inside)?;
        merge(&mut table, set);
        if level == Level::Equilibrium && has_ideal_cage(&table) {
            // At this level all cages are.
            leave_balls_free(&mut table);
        }
        if mounting.seats_outer_ring() {
            seat_outer_ring(&mut table, &mounting, estimated_mass).map_err(inside)?;
        }
        let outer_speed = outer_shaft.map(|shaft| given.shafts[shaft].1);
        mount(&mut table, given, (given.shafts[shaft].1, outer_speed), mounting.direction);
        let mut scene = Scene::parse_of(&table.to_string(), None, &folder).map_err(inside)?;
        if given.gravity.is_scripted() {
            scene.effects.gravity.acceleration = match mounting.direction {
                MountingDirection::Along => given.gravity.clone(),
                MountingDirection::Against => given.gravity.half_turned(),
            };
        }
        // A housing, a hub or the bore that a ring slides in moves it by forces.
        if mounting.seats_outer_ring() && scene.effects.cage.is_ideal() {
            return Err(inside(SceneError::conflict("effects.cage", IDEAL_CAGE_NEEDS)));
        }
        if level == Level::Equilibrium || level_changes {
            without_states(&scene).map_err(inside)?;
        }
        if level_changes && (scene.effects.cage.is_ideal() || scene.solver.level == Level::Equilibrium) {
            let (key, why) = match scene.effects.cage.is_ideal() {
                true => (
                    "effects.cage",
                    "an ideal cage is for a bearing whose level stays: take it out, or level_changes",
                ),
                false => (
                    "solver.level",
                    "\"equilibrium\" takes the states of all bearings away: take it out, or level_changes",
                ),
            };
            return Err(inside(SceneError::conflict(key, why)));
        }
        let dynamic = level_changes.then(|| f64::from(level == Level::Dynamic));
        Ok(MountedScene { name, shaft, outer_shaft, mounting, level, dynamic, finds_level, scene })
    }
}

impl MountedScene {
    /// Key of what needs states in it, if something does.
    pub fn needs_states(&self) -> Option<&'static str> {
        stateful(&self.scene)
    }
}

/// Refuses what needs states in a bearing that has none.
fn without_states(scene: &Scene) -> Result<(), SceneError> {
    let why = "is for a bearing with states: one of level = \"equilibrium\", or with level_changes, has balls in balance wherever its rings are; \
               take it out, or give level = \"dynamic\" alone";
    stateful(scene).map_or(Ok(()), |key| Err(SceneError::conflict(key, why)))
}

/// Key of what needs states in a scene, if something does.
fn stateful(scene: &Scene) -> Option<&'static str> {
    let effects = &scene.effects;
    let waves = [true, false].into_iter().any(|inner| effects.form.of(inner).is_some());
    let damaged = [On::Inner, On::Outer].into_iter().any(|on| !effects.defects.on(on, 0.0).is_empty());
    let needing = [
        (scene.outer.drive == Drive::Wrench, "outer.drive = \"wrench\""),
        (effects.support.sections.iter().any(Option::is_some), "outer.support"),
        (waves || !effects.form.larger_radii().is_empty(), "form"),
        (damaged || !effects.defects.on_balls().is_empty(), "defect"),
        (effects.cage.section.is_some(), "effects.cage"),
        (effects.heat_balance.section.is_some(), "heat_balance"),
        (effects.heat.on, "effects.heat_outputs"),
        (effects.means.on, "effects.mean_outputs"),
        (scene.solver.method != Method::Hht, "solver.method"),
    ];
    needing.into_iter().find(|(is, _)| *is).map(|(_, key)| key)
}

/// Drive of the outer race, where a table gives it.
fn drive_of_outer(table: &Table) -> Option<&str> {
    table.get("outer")?.get("drive")?.as_str()
}

/// Keys of `[load]` that are those of an outer race under a wrench.
const OF_WRENCH: [&str; 3] = ["outer", "rotating", "gear"];

/// Refuses changes that would count for nothing. A scene may have such keys: it is that of a bearing alone, too.
fn check_changes(set: &Table, is_under_wrench: bool) -> Result<(), SceneError> {
    let keys = |section: &str| {
        let table = set.get(section).and_then(Value::as_table);
        table.into_iter().flat_map(Table::keys).cloned().collect::<Vec<_>>()
    };
    let counts = |key: &str| key == "outer_speed" || is_under_wrench && OF_WRENCH.contains(&key);
    let loads = keys("load").into_iter().find(|key| !counts(key));
    let inner = keys("inner").into_iter().find(|key| ["drive", "mass", "inertia"].contains(&key.as_str()));
    let refused = [
        (
            loads.map(|key| format!("load.{key}")),
            "loads and speed are those of the shaft: [[shaft.load]], [[shaft.rotating]], [[shaft.gear]], shaft.speed; an outer race with \
             outer.drive = \"wrench\" has load.outer",
        ),
        (
            inner.map(|key| format!("inner.{key}")),
            "the inner ring is a part of the shaft, which moves it and has its mass",
        ),
        (
            set.contains_key("phase").then(|| "phase".into()),
            "phases are those of the machine: [[phase]] beside the shaft",
        ),
        (
            set.contains_key("duty").then(|| "duty".into()),
            "the duty is that of the machine: [[duty]] beside the shaft",
        ),
    ];
    refused.into_iter().try_for_each(|(key, why)| match key {
        Some(key) => Err(SceneError::conflict(format!("bearing.set.{key}"), why)),
        None => Ok(()),
    })
}

/// Takes the ideal cage out of a scene of the catalogue. Balls that one keeps apart cannot go along with a ring that shifts, which damps a
/// shaft's vibrations many times too much (docs/model.md, section 19), and it may not stand in a housing.
pub fn leave_balls_free(table: &mut Table) {
    if let Some(effects) = table.get_mut("effects").and_then(Value::as_table_mut) {
        effects.remove("cage");
    }
}

/// Does an ideal cage keep the balls apart?
fn has_ideal_cage(table: &Table) -> bool {
    let cage = table.get("effects").and_then(|effects| effects.get("cage"));
    cage.and_then(Value::as_str) == Some("ideal")
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

/// Makes a bearing's own scene that of a bearing whose outer race sits as its mounting says.
fn seat_outer_ring(
    table: &mut Table,
    mounting: &Mounting,
    estimated_mass: Option<f64>,
) -> Result<(), SceneError> {
    let mut outer = section(table, "outer");
    let why = match (&mounting.housing, &mounting.outer_shaft) {
        (_, Some(_)) => "the outer ring is a part of mounting.outer_shaft, which moves it",
        (Some(_), None) => {
            "the outer race sits in mounting.housing, which moves it; a tilt of its bore is mounting.misalignment"
        }
        (None, None) => "mounting.axial, misalignment and offset say how the outer race sits",
    };
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
    if let Some(mass) = estimated_mass.filter(|_| !outer.contains_key("mass")) {
        outer.insert("mass".into(), mass.into());
    }
    table.insert("outer".into(), outer.into());
    Ok(())
}

/// Makes a bearing's own scene that of a bearing whose inner race a shaft moves; with its speed [rad/s], and that of the shaft that moves the
/// outer one, if one does. Loads on an outer race under a wrench stay.
fn mount(
    table: &mut Table,
    given: &Shared,
    (speed, of_outer): (f64, Option<f64>),
    direction: MountingDirection,
) {
    let mut inner = section(table, "inner");
    inner.insert("drive".into(), "pose".into());
    table.insert("inner".into(), inner.into());
    let mut load = section(table, "load");
    // Phases and duty, too, are those of the shaft.
    table.remove("phase");
    table.remove("duty");
    let of_outer = of_outer.map(|speed| Value::from(direction.sign() * speed));
    let outer_speed = load.remove("outer_speed").or(of_outer);
    let is_under_wrench = drive_of_outer(table) == Some("wrench");
    let mut load: Table =
        load.into_iter().filter(|(key, _)| is_under_wrench && OF_WRENCH.contains(&key.as_str())).collect();
    load.extend(outer_speed.map(|speed| ("outer_speed".to_string(), speed)));
    load.insert("duration".into(), given.load.duration.0.into());
    load.insert("output_interval".into(), given.load.output_interval.0.into());
    load.insert("inner_speed".into(), (direction.sign() * speed).into());
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
    if given.gravity.largest() != 0.0 {
        let (sign, gravity) = (direction.sign(), given.gravity.at(0.0));
        let turned = [sign * gravity.x, sign * gravity.y, gravity.z];
        effects.insert("gravity".into(), turned.map(Value::from).to_vec().into());
    }
    table.insert("effects".into(), effects.into());
}
