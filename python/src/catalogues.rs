//! Catalogue bearings as texts of scenes.

use std::path::PathBuf;

use pyo3::prelude::*;
use roulement::catalogue::{Bearing, Request, Shelf, table};
use serde_json::json;

use crate::failures::{scene as refused, value};

fn bearing(request: &str, shelf: Option<PathBuf>) -> PyResult<Bearing> {
    let shelf = shelf.map(|path| Shelf::load(&path)).transpose().map_err(refused)?.unwrap_or_default();
    Request::parse(request).and_then(|request| request.of_shelf(&shelf)).map_err(value)
}

/// The scene of a bearing, as text; the request is TOML.
#[pyfunction]
pub fn catalogue_scene(request: &str, candidate: usize, shelf: Option<PathBuf>) -> PyResult<String> {
    bearing(request, shelf)?.scene(candidate).map_err(value)
}

/// Balls that come near its ratings, as JSON.
#[pyfunction]
pub fn catalogue_candidates(request: &str, shelf: Option<PathBuf>) -> PyResult<String> {
    let bearing = bearing(request, shelf)?;
    let candidates = bearing.candidates().map_err(value)?;
    let rows: Vec<_> = candidates
        .iter()
        .map(|of| {
            let [inner, outer] = bearing.rings(of);
            json!({
                "balls": of.geometry.balls,
                "ball_diameter": of.geometry.ball_diameter,
                "pitch_diameter": of.geometry.pitch_diameter,
                "inner_conformity": of.geometry.conformities[0],
                "outer_conformity": of.geometry.conformities[1],
                "dynamic_load_rating": of.dynamic_load_rating,
                "static_load_rating": of.static_load_rating,
                "dynamic_error": of.errors[0],
                "static_error": of.errors[1],
                "inner_mass": inner.mass,
                "outer_mass": outer.mass,
            })
        })
        .collect();
    Ok(json!(rows).to_string())
}

/// Names of the table of common sizes.
#[pyfunction]
pub fn catalogue_names() -> Vec<&'static str> {
    table().map(|row| row.designation).collect()
}
