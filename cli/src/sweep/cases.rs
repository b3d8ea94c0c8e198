//! Tables of cases. Columns are keys of the scene, rows are cases; what a row leaves empty is as in the base scene.
//!
//! As CSV, the header has the keys, `friction.ball_race` or, with the unit of all rows, `load.x.force [kN]`; cells are numbers in
//! SI, texts with a unit such as `6000 rpm`, or anything else that a scene file may have. As TOML:
//!
//! ```toml
//! scene = "thrust.toml"                  # beside this file
//! remove = ["load.y"]                    # keys taken out of the scene first
//!
//! [set]                                  # then the same for every case
//! load.duration = "20 ms"
//! load.y.force = { mean = "1 kN", amplitude = "100 N", frequency = "2 kHz" }     # a value over time is one value
//!
//! [[case]]                               # cases one by one
//! friction.ball_race = 0.05
//!
//! [grid]                                 # all combinations, the last key changes fastest
//! friction.ball_race = [0.05, 0.1]
//! load.x.force = { from = "0.5 kN", to = "2 kN", steps = 4 }     # scale = "log" for equal ratios
//!
//! [latin_hypercube]
//! cases = 50
//! seed = 1
//! bearing.inner_conformity = { from = 0.51, to = 0.54 }
//! ```
//!
//! Parts of lists of a shaft's scene go by their names: `bearing.left.set.friction.ball_race`, `shaft.load.mesh.force.y`.

use std::path::{Path, PathBuf};

use roulement::scene::machine::MachineScene;
use roulement::scene::schedule::{files, is_block};
use roulement::schema::regular;
use roulement::{Scene, SceneError};
use toml::{Table, Value};

use super::SweepError;
use super::ranges::{grid, latin_hypercube};
use super::setting::{Setting, leaves};
use super::shard::Shard;

/// A column: a key of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    /// Key with its sections.
    pub name: String,
    /// Unit of all cells, where the header has one.
    pub unit: Option<String>,
}

/// A table of cases.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cases {
    /// Base scene that the table names.
    pub scene: Option<PathBuf>,
    /// Changes of the base scene that all cases have; an empty value takes the key out.
    pub common: Vec<(String, String)>,
    /// Columns.
    pub keys: Vec<Key>,
    /// Cases, a setting for each key that they set.
    pub rows: Vec<Vec<Option<Setting>>>,
    /// Numbers of the cases in the table that they are a part of, counted from 1; empty where all of it is there.
    pub numbers: Vec<usize>,
}

impl Cases {
    /// Reads a table of cases: TOML where the file's name ends so, else CSV.
    ///
    /// # Errors
    /// If the file cannot be read, or is no table of cases; with what is wrong.
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        let failed = |why: String| SweepError::Cases { file: path.display().to_string(), why };
        let text = regular::text(path).map_err(|why| failed(why.to_string()))?;
        let mut cases = if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
            Self::from_toml(&text).map_err(failed)?
        } else {
            Self::from_csv(&text).map_err(failed)?
        };
        if cases.rows.is_empty() {
            return Err(failed("there is no case in it".to_string()));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        cases.embed_files(folder).map_err(failed)?;
        cases.scene = cases.scene.map(|scene| folder.join(scene));
        Ok(cases)
    }

    /// Reads CSV.
    ///
    /// # Errors
    /// If the text is no table of cases; the reason is given.
    pub fn from_csv(text: &str) -> Result<Self, String> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let header = reader.headers().map_err(|why| why.to_string())?.clone();
        let mut cases = Self::default();
        for name in &header {
            let (name, unit) = match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
                Some((name, unit)) => (name.trim(), Some(unit.trim().to_string())),
                None => (name, None),
            };
            cases.add_key(name, unit)?;
        }
        for record in reader.records() {
            let record = record.map_err(|why| why.to_string())?;
            let cell = |(cell, key): (&str, &Key)| {
                (!cell.is_empty()).then(|| Setting::of_cell(cell, key.unit.as_deref()))
            };
            cases.rows.push(record.iter().zip(&cases.keys).map(cell).collect());
        }
        Ok(cases)
    }

    /// Reads TOML.
    ///
    /// # Errors
    /// If the text is no table of cases; the reason is given.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        let table: Table = text.parse().map_err(|why: toml::de::Error| why.to_string())?;
        let mut cases = Self::default();
        for (name, value) in &table {
            let section = || value.as_table().ok_or_else(|| format!("{name} has to be a section"));
            match name.as_str() {
                "scene" => {
                    let path = value.as_str().ok_or("scene has to be the path of a scene file")?;
                    cases.scene = Some(path.into());
                }
                "remove" | "set" | "case" | "grid" | "latin_hypercube" => {}
                _ => {
                    return Err(format!(
                        "unknown key {name}; expected one of scene, remove, set, case, grid, latin_hypercube"
                    ));
                }
            }
            if matches!(name.as_str(), "set" | "grid" | "latin_hypercube") {
                section()?;
            }
        }
        if let Some(remove) = table.get("remove") {
            let keys =
                remove.as_array().and_then(|keys| keys.iter().map(Value::as_str).collect::<Option<Vec<_>>>());
            let keys = keys.ok_or("remove has to be a list of keys")?;
            cases.common.extend(keys.into_iter().map(|key| (key.to_string(), String::new())));
        }
        let of = |name: &str| table.get(name).and_then(Value::as_table);
        for (key, value) in of("set").map(settings).unwrap_or_default() {
            cases.common.push((key, value.to_string()));
        }
        if let Some(listed) = table.get("case") {
            let listed = listed.as_array().ok_or("cases are written as [[case]]")?;
            for case in listed {
                let case = case.as_table().ok_or("cases are written as [[case]]")?;
                let row =
                    settings(case).into_iter().map(|(key, value)| (key, None, Setting::of_value(value)));
                cases.add_row(row.collect())?;
            }
        }
        for row in of("grid").map(grid).transpose()?.unwrap_or_default() {
            cases.add_row(row)?;
        }
        for row in of("latin_hypercube").map(latin_hypercube).transpose()?.unwrap_or_default() {
            cases.add_row(row)?;
        }
        Ok(cases)
    }

    /// Puts the tables of measured files in the place of the files, whose paths are relative to a folder: a case then follows from its
    /// text alone.
    ///
    /// # Errors
    /// If a file cannot be read; names the key and the file.
    pub fn embed_files(&mut self, folder: &Path) -> Result<(), String> {
        let common = self.common.iter_mut().map(|(key, value)| (&*key, value));
        let keys = &self.keys;
        let own = self.rows.iter_mut().flat_map(|row| row.iter_mut().zip(keys));
        let own = own.filter_map(|(setting, key)| Some((&key.name, &mut setting.as_mut()?.toml)));
        for (key, text) in common.chain(own).filter(|(_, text)| text.contains("file")) {
            // What is no value is refused where it is set.
            let Ok(mut value) = text.parse::<Value>() else { continue };
            if files::embed(&mut value, folder, key).map_err(|why| why.to_string())? {
                *text = value.to_string();
            }
        }
        Ok(())
    }

    /// Position of a column, new if it is not there.
    fn column(&mut self, name: &str, unit: &Option<String>) -> Result<usize, String> {
        match self.keys.iter().position(|key| key.name == name && key.unit == *unit) {
            Some(column) => Ok(column),
            None => {
                self.add_key(name, unit.clone())?;
                Ok(self.keys.len() - 1)
            }
        }
    }

    fn add_key(&mut self, name: &str, unit: Option<String>) -> Result<(), String> {
        if name.is_empty() {
            return Err(format!("column {} has no key", self.keys.len() + 1));
        }
        let key = Key { name: name.to_string(), unit };
        if self.keys.contains(&key) {
            return Err(format!("{name} stands there twice"));
        }
        self.keys.push(key);
        Ok(())
    }

    fn add_row(&mut self, settings: Vec<(String, Option<String>, Setting)>) -> Result<(), String> {
        let mut row = vec![None; self.keys.len()];
        for (key, unit, setting) in settings {
            let column = self.column(&key, &unit)?;
            row.resize(self.keys.len(), None);
            row[column] = Some(setting);
        }
        self.rows.push(row);
        Ok(())
    }

    /// Number of a case in its table, counted from 1.
    pub fn number(&self, case: usize) -> usize {
        self.numbers.get(case).copied().unwrap_or(case + 1)
    }

    /// Takes out all cases but those of a shard. They keep their numbers.
    pub fn keep(&mut self, shard: Shard) {
        let numbers = (1..=self.rows.len()).filter(|number| shard.has(number - 1)).collect();
        let mut case = 0;
        self.rows.retain(|_| {
            case += 1;
            shard.has(case - 1)
        });
        self.numbers = numbers;
    }

    /// The text of the scene of a case, from that of the base scene. A scene of that text may still be refused.
    ///
    /// # Errors
    /// If a key cannot be changed so; names it.
    pub fn text_of(&self, base: &str, case: usize) -> Result<String, SceneError> {
        let own = self.keys.iter().zip(&self.rows[case]);
        let own = own.filter_map(|(key, setting)| Some((key.name.as_str(), setting.as_ref()?.toml.as_str())));
        let common = self.common.iter().map(|(key, value)| (key.as_str(), value.as_str()));
        Scene::edited_text(base, common.chain(own))
    }
}

/// Text of the base scene in a file, which stands alone, and what its reader should know.
///
/// # Errors
/// If the scene is refused.
pub fn base_of(path: &Path) -> Result<(String, Vec<String>), SceneError> {
    MachineScene::load(path).map(|scene| (scene.source().to_string(), scene.notes()))
}

/// All keys of a section with their own sections, down to values.
fn settings(table: &Table) -> Vec<(String, &Value)> {
    leaves(table, &is_block)
}
