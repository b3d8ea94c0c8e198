//! The summary of a sweep for the page, with what there is of whole tables.

use std::path::Path;

use roulement::schema::regular;
use serde_json::{Value, json};

use super::grid::Grid;
use super::table;
use crate::report::cells::Column;

/// [-] numbers of whole tables of cases, all together.
const ROOM: usize = 400_000;

/// Name of the file that makes a directory one of a sweep.
pub const FILE: &str = "summary.csv";

/// Reads a sweep's directory: columns of numbers as a grid, of texts as lists; tables of cases by the name of their file.
///
/// # Errors
/// If its summary cannot be read.
pub fn read(directory: &Path) -> Result<Value, String> {
    let path = directory.join(FILE);
    let cannot = |why: csv::Error| format!("cannot read {}: {why}", path.display());
    let mut summary = csv::Reader::from_reader(regular::open(&path).map_err(|why| cannot(why.into()))?);
    let columns: Vec<Column> = summary.headers().map_err(cannot)?.iter().map(Column::from_header).collect();
    let records = summary.records().collect::<Result<Vec<_>, _>>().map_err(cannot)?;
    let mut numbers = Grid::new(records.len());
    let mut texts = vec![];
    for (index, column) in columns.iter().enumerate() {
        let cells = || records.iter().map(|record| record.get(index).unwrap_or_default());
        let parsed = || cells().map(|cell| cell.parse::<f64>().ok());
        // Columns without a unit may be of texts or of numbers: what their cells are decides.
        let is_number = column.unit.is_some()
            || cells().any(|cell| !cell.is_empty())
                && cells().zip(parsed()).all(|(cell, number)| cell.is_empty() || number.is_some());
        if is_number && column.name != "file" {
            numbers.push(
                &column.name,
                column.unit.as_deref().unwrap_or_default(),
                parsed().map(|n| n.unwrap_or(f64::NAN)).collect(),
            );
        } else {
            texts.push(json!({ "name": column.name, "cells": cells().collect::<Vec<_>>() }));
        }
    }
    let names: Vec<String> = columns.iter().map(|column| column.name.clone()).collect();
    let status = names.iter().position(|name| name == "status").unwrap_or(0);
    Ok(json!({
        "keys": names[1.min(names.len())..status.max(1).min(names.len())].iter().filter(|name| *name != "file").collect::<Vec<_>>(),
        "order": names,
        "numbers": numbers.to_json(),
        "texts": texts,
        "tables": tables(directory, &names, &records)?,
    }))
}

/// Number and file of every case of a sweep that was read.
pub fn files(sweep: &Value) -> Vec<(usize, String)> {
    let texts = sweep["texts"].as_array().map(Vec::as_slice).unwrap_or_default();
    let column = texts.iter().find(|text| text["name"] == "file");
    let cells = column.and_then(|column| column["cells"].as_array()).map(Vec::as_slice).unwrap_or_default();
    let named = |(index, cell): (usize, &Value)| {
        Some((index + 1, cell.as_str().filter(|file| !file.is_empty())?.to_string()))
    };
    cells.iter().enumerate().filter_map(named).collect()
}

/// Tables of cases, with as many rows each as there is room for; none where the sweep has not written them.
fn tables(directory: &Path, names: &[String], records: &[csv::StringRecord]) -> Result<Value, String> {
    let Some(file) = names.iter().position(|name| name == "file") else { return Ok(json!({})) };
    let of = |record: &csv::StringRecord| {
        let name = record.get(file).filter(|name| !name.is_empty())?;
        let path = directory.join("tables").join(format!("{name}.csv"));
        path.is_file().then(|| (name.to_string(), path))
    };
    let files: Vec<_> = records.iter().filter_map(of).collect();
    let mut tables = serde_json::Map::new();
    for (name, path) in &files {
        let rows = columns_of(path).map(|columns| ROOM / files.len() / columns.max(1)).unwrap_or(0);
        // Of fewer rows there is nothing to be seen.
        if rows >= 16 {
            let read = table::read(path, &table::Choice { columns: vec![], rows: Some(rows), share: 1 })?;
            tables.insert(name.clone(), read.grids.iter().map(Grid::to_json).collect());
        }
    }
    Ok(tables.into())
}

/// [-] columns of a table.
fn columns_of(path: &Path) -> Option<usize> {
    csv::Reader::from_reader(regular::open(path).ok()?).headers().ok().map(csv::StringRecord::len)
}
