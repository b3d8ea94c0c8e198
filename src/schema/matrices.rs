//! Matrices of a shaft or a housing from another program, as a JSON file.

use std::path::Path;

use nalgebra::{DMatrix, Dyn, OMatrix, U3, U6};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

use super::error::SceneError;
use super::{reader, regular};

/// \[m] how far a station may be from where it is asked for.
const SAME: f64 = 1e-6;
/// [-] asymmetry of a mass or stiffness matrix over its largest element that is rounding.
const ROUNDING: f64 = 1e-6;

/// A linear structure in `n` coordinates, as the file has it: matrices by rows, SI.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Matrices {
    /// Where it is from.
    #[serde(default)]
    pub title: String,
    /// Mass matrix, n x n, symmetric.
    pub mass: Vec<Vec<f64>>,
    /// Stiffness matrix, n x n, symmetric.
    pub stiffness: Vec<Vec<f64>>,
    /// Damping matrix, n x n; 0 if not given.
    pub damping: Option<Vec<Vec<f64>>>,
    /// Gyroscopic matrix of a spin of 1 rad/s, n x n, skew; 0 if not given, and of a housing.
    pub gyroscopic: Option<Vec<Vec<f64>>>,
    /// [kg m2] moment of inertia about the axis.
    #[serde(default)]
    pub polar_inertia: f64,
    /// Coordinates of a unit displacement of the whole along x, y and z, n x 3: the mass times these is what it weighs. Of a structure that is
    /// held, which has no such displacement, the inverse of the mass times its weights.
    pub translations: Vec<Vec<f64>>,
    /// Places where bearings sit and loads act.
    pub stations: Vec<MatrixStation>,
}

/// A place of a structure.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct MatrixStation {
    /// \[m] position along the shaft, or place x, y, z.
    pub position: StationPlace,
    /// Displacement x, y, z and rotation about x, y, z there by the coordinates, 6 x n.
    pub map: Vec<Vec<f64>>,
}

/// Where a station is.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub enum StationPlace {
    /// On the axis of the shaft.
    Along(f64),
    /// Anywhere.
    At([f64; 3]),
}

impl<'de> Deserialize<'de> for StationPlace {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = match &toml::Value::deserialize(deserializer)? {
            place @ toml::Value::Array(_) => reader::read(place).map(Self::At),
            place => reader::read(place).map(Self::Along),
        };
        read.map_err(|why| Error::custom(why.message()))
    }
}

impl StationPlace {
    /// \[m] x, y, z.
    fn place(self) -> [f64; 3] {
        match self {
            Self::Along(x) => [x, 0.0, 0.0],
            Self::At(place) => place,
        }
    }
}

/// A place in words: its x alone where it is on the axis.
fn in_words(place: [f64; 3]) -> String {
    match place {
        [x, 0.0, 0.0] => format!("{x}"),
        [x, y, z] => format!("[{x}, {y}, {z}]"),
    }
}

/// Matrices of a structure, checked.
#[derive(Clone, Debug)]
pub struct StructureMatrices {
    /// Mass.
    pub mass: DMatrix<f64>,
    /// Stiffness.
    pub stiffness: DMatrix<f64>,
    /// Damping.
    pub damping: DMatrix<f64>,
    /// Gyroscopic.
    pub gyroscopic: DMatrix<f64>,
    /// [kg m2] about the axis.
    pub polar_inertia: f64,
    /// Generalised forces of unit accelerations.
    pub weights: OMatrix<f64, Dyn, U3>,
    /// Place \[m] and map of every station.
    pub stations: Vec<([f64; 3], OMatrix<f64, U6, Dyn>)>,
}

impl Matrices {
    /// Those that a value gives: the name of a JSON file in a folder, or a table of the same keys. Errors name its `key`.
    ///
    /// # Errors
    /// With the file and what is wrong with it.
    pub fn of(given: &toml::Value, folder: &Path, key: &str) -> Result<Self, SceneError> {
        let wrong = |file: &str, why: String| SceneError::conflict(key, format!("{file}{why}"));
        match given {
            toml::Value::String(name) => {
                let path = folder.join(name);
                let file = path.display().to_string();
                let text = regular::named(&path, key)?;
                let wrong = |why: &dyn std::fmt::Display| wrong(&format!("{file}: "), why.to_string());
                let table: toml::Value = serde_json::from_str(&text).map_err(|why| wrong(&why))?;
                reader::read(&table).map_err(|why| wrong(&why))
            }
            table => reader::read(table).map_err(|why| wrong("", why.to_string())),
        }
    }
}

impl StructureMatrices {
    /// Displacement and rotation at a place \[m].
    ///
    /// # Errors
    /// A sentence with the stations that there are.
    pub fn station(&self, place: [f64; 3]) -> Result<OMatrix<f64, U6, Dyn>, String> {
        let here = |at: &[f64; 3]| at.iter().zip(place).all(|(at, place)| (at - place).abs() <= SAME);
        let found = self.stations.iter().find(|(at, _)| here(at));
        found.map(|(_, map)| map.clone()).ok_or_else(|| {
            let there: Vec<String> = self.stations.iter().map(|(at, _)| in_words(*at)).collect();
            format!("the matrices have no station at {} m; they have {} m", in_words(place), there.join(", "))
        })
    }
}

impl Matrices {
    /// Matrices of the file. Errors name their `key`.
    ///
    /// # Errors
    /// With the matrix and what is wrong with it.
    pub fn checked(&self, key: &str) -> Result<StructureMatrices, SceneError> {
        self.read().map_err(|why| SceneError::conflict(key, why))
    }

    fn read(&self) -> Result<StructureMatrices, String> {
        let n = self.mass.len();
        let square = |name: &str, rows: &[Vec<f64>]| matrix(name, rows, n, n);
        let symmetric = |name: &str, rows: &[Vec<f64>], sign: f64| {
            let matrix = square(name, rows)?;
            let left = (&matrix - matrix.transpose() * sign).amax();
            if left > ROUNDING * matrix.amax() {
                let kind = if sign > 0.0 { "symmetric" } else { "skew" };
                return Err(format!("{name} is not {kind}: elements differ by up to {left}"));
            }
            Ok((&matrix + matrix.transpose() * sign) * 0.5)
        };
        if n == 0 {
            return Err("mass has no rows".into());
        }
        let mass = symmetric("mass", &self.mass, 1.0)?;
        if mass.clone().cholesky().is_none() {
            return Err("mass is not positive definite: every coordinate needs some inertia".into());
        }
        let zero = || DMatrix::zeros(n, n);
        let weights = &mass * matrix("translations", &self.translations, n, 3)?;
        if weights.column(1).amax() == 0.0 {
            return Err("translations along y move nothing".into());
        }
        let stations = self.stations.iter().map(|station| {
            let place = station.position.place();
            if place.iter().any(|value| !value.is_finite()) {
                return Err(format!("a station at {} m", in_words(place)));
            }
            let map = matrix(&format!("map of the station at {} m", in_words(place)), &station.map, 6, n)?;
            Ok((place, OMatrix::from_fn_generic(U6, Dyn(n), |i, k| map[(i, k)])))
        });
        if !(self.polar_inertia >= 0.0 && self.polar_inertia.is_finite()) {
            return Err(format!(
                "polar_inertia = {} kg m2 is out of range: allowed is 0 or more",
                self.polar_inertia
            ));
        }
        Ok(StructureMatrices {
            stiffness: symmetric("stiffness", &self.stiffness, 1.0)?,
            damping: self.damping.as_ref().map_or(Ok(zero()), |rows| square("damping", rows))?,
            gyroscopic: self
                .gyroscopic
                .as_ref()
                .map_or(Ok(zero()), |rows| symmetric("gyroscopic", rows, -1.0))?,
            polar_inertia: self.polar_inertia,
            weights: OMatrix::from_fn_generic(Dyn(n), U3, |i, k| weights[(i, k)]),
            stations: stations.collect::<Result<_, String>>()?,
            mass,
        })
    }
}

/// A matrix from its rows.
fn matrix(name: &str, rows: &[Vec<f64>], height: usize, width: usize) -> Result<DMatrix<f64>, String> {
    if rows.len() != height || rows.iter().any(|row| row.len() != width) {
        let widths = rows.first().map_or(0, Vec::len);
        return Err(format!(
            "{name} has {} rows of {widths}; it should have {height} of {width}",
            rows.len()
        ));
    }
    if rows.iter().flatten().any(|value| !value.is_finite()) {
        return Err(format!("{name} has an element that is no number"));
    }
    Ok(DMatrix::from_fn(height, width, |i, k| rows[i][k]))
}
