//! Columns of numbers in a few bytes, for the page to read: offset, 32-bit numbers of 16 bits of precision, bytes of the same place of
//! all rows side by side, deflated, base64.
//!
//! A column is its least value and the distances from that, so that what is kept is 1.5e-5 of its range, not of its values; times are
//! kept to the last bit.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Map, Value, json};

/// Bits of a 32-bit number's 23 that are dropped: noise that a picture cannot show, and that cannot be deflated.
const DROPPED: u32 = 8;

/// Columns of equal length.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    columns: Vec<Column>,
    rows: usize,
}

#[derive(Clone, Debug)]
struct Column {
    name: String,
    unit: String,
    values: Vec<f64>,
    /// To the last bit?
    exact: bool,
}

impl Grid {
    /// Grid of so many rows.
    pub fn new(rows: usize) -> Self {
        Self { columns: vec![], rows }
    }

    /// Adds a column; values that are missing at its end are not numbers.
    pub fn push(&mut self, name: &str, unit: &str, mut values: Vec<f64>) {
        values.resize(self.rows, f64::NAN);
        let exact = name == "time";
        self.columns.push(Column { name: name.into(), unit: unit.into(), values, exact });
    }

    /// Rows of every column.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Names of the columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| column.name.as_str())
    }

    /// As the page reads it: number of rows; name, unit and value of columns that do not change; name, unit and offset of those that do,
    /// in the order of the data.
    pub fn to_json(&self) -> Value {
        let (mut constant, mut moving, mut bytes) = (vec![], vec![], vec![]);
        for column in &self.columns {
            let Column { name, unit, values, exact } = column;
            let first = values.first().copied().unwrap_or(f64::NAN);
            if *exact {
                moving.push(json!([name, unit, "f64"]));
                append(&mut bytes, &values.iter().map(|value| value.to_le_bytes()).collect::<Vec<_>>());
            } else if values.iter().all(|value| *value == first || (value.is_nan() && first.is_nan())) {
                constant.push(json!([name, unit, number(first)]));
            } else {
                let least =
                    values.iter().copied().filter(|value| value.is_finite()).fold(f64::INFINITY, f64::min);
                let offset = if least.is_finite() { least } else { 0.0 };
                moving.push(json!([name, unit, offset]));
                let kept = values.iter().map(|value| rounded((value - offset) as f32).to_le_bytes());
                append(&mut bytes, &kept.collect::<Vec<_>>());
            }
        }
        json!({ "rows": self.rows, "constant": constant, "moving": moving, "data": deflated(&bytes) })
    }
}

/// Number in JSON; null where it is not finite.
fn number(value: f64) -> Value {
    if value.is_finite() { value.into() } else { Value::Null }
}

/// A number with fewer bits, to the nearest.
fn rounded(value: f32) -> f32 {
    if !value.is_finite() {
        return value;
    }
    let half = 1 << (DROPPED - 1);
    let bits = value.to_bits().saturating_add(half) & !((1 << DROPPED) - 1);
    let rounded = f32::from_bits(bits);
    if rounded.is_finite() { rounded } else { value }
}

/// Bytes of the same place side by side: those of exponents are nearly all the same.
fn append<const N: usize>(bytes: &mut Vec<u8>, values: &[[u8; N]]) {
    for place in 0..N {
        bytes.extend(values.iter().map(|value| value[place]));
    }
}

/// Bytes deflated (zlib), in base64.
fn deflated(bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(vec![], Compression::new(8));
    // A vector takes everything.
    let _ = encoder.write_all(bytes);
    STANDARD.encode(encoder.finish().unwrap_or_default())
}

/// Reads columns back, by name: what the page does.
///
/// # Errors
/// If that is no such grid.
pub fn read(grid: &Value) -> Result<Vec<(String, Vec<f64>)>, String> {
    let wrong = |what: &str| format!("no columns: {what}");
    let rows = grid["rows"].as_u64().ok_or_else(|| wrong("rows"))? as usize;
    let list = |key: &str| grid[key].as_array().cloned().ok_or_else(|| wrong(key));
    let deflated = STANDARD
        .decode(grid["data"].as_str().ok_or_else(|| wrong("data"))?)
        .map_err(|why| why.to_string())?;
    let mut bytes = vec![];
    let mut decoder = flate2::write::ZlibDecoder::new(&mut bytes);
    decoder.write_all(&deflated).and_then(|()| decoder.try_finish()).map_err(|why| why.to_string())?;
    drop(decoder);
    let name = |column: &Value| column[0].as_str().unwrap_or_default().to_string();
    let mut columns: Vec<_> =
        list("constant")?.iter().map(|c| (name(c), vec![c[2].as_f64().unwrap_or(f64::NAN); rows])).collect();
    let mut at = 0;
    for column in list("moving")? {
        let offset = column[2].as_f64();
        let size = if offset.is_some() { 4 } else { 8 };
        let block = bytes.get(at..at + size * rows).ok_or_else(|| wrong("data end early"))?;
        at += size * rows;
        let byte = |row: usize, place: usize| block[place * rows + row];
        let value = |row: usize| match offset {
            Some(offset) => {
                offset + f64::from(f32::from_le_bytes(std::array::from_fn(|place| byte(row, place))))
            }
            None => f64::from_le_bytes(std::array::from_fn(|place| byte(row, place))),
        };
        columns.push((name(&column), (0..rows).map(value).collect()));
    }
    Ok(columns)
}

/// A grid without columns of names that are in another one, whose rows are at the same times.
pub fn without(grid: &Value, names: &[String]) -> Value {
    let rows = grid["rows"].as_u64().unwrap_or(0) as usize;
    rebuilt(grid, |name| name == "time" || !names.iter().any(|n| n == name), &Vec::from_iter(0..rows))
}

/// A grid of every n-th row and the last one, so that it has at most so many, two or more.
pub fn thinned(grid: &Value, most: usize) -> Value {
    let rows = grid["rows"].as_u64().unwrap_or(0) as usize;
    if rows <= most.max(2) {
        return grid.clone();
    }
    // Places of the last row and of every n-th one.
    let stride = rows.div_ceil(most.max(2) - 1);
    let kept: Vec<usize> = (0..rows - 1).step_by(stride).chain([rows - 1]).collect();
    rebuilt(grid, |_| true, &kept)
}

/// A grid of some columns and rows of another one.
fn rebuilt(grid: &Value, wanted: impl Fn(&str) -> bool, rows: &[usize]) -> Value {
    let keep = |column: &&Value| column[0].as_str().is_none_or(&wanted);
    let Ok(columns) = read(grid) else { return grid.clone() };
    let mut left = Grid::new(rows.len());
    let described: Map<String, Value> = ["constant", "moving"]
        .iter()
        .filter_map(|key| grid[key].as_array())
        .flatten()
        .filter(keep)
        .map(|column| (column[0].as_str().unwrap_or_default().to_string(), column[1].clone()))
        .collect();
    for (name, values) in columns {
        if let Some(unit) = described.get(&name) {
            let values = rows.iter().map(|&row| values[row]).collect();
            left.push(&name, unit.as_str().unwrap_or_default(), values);
        }
    }
    left.to_json()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_columns_are_read_back_to_their_precision() {
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-4).collect();
        let wave: Vec<f64> = time.iter().map(|t| 1500.0 + 1e-3 * (700.0 * t).sin()).collect();
        let mut grid = Grid::new(time.len());
        grid.push("time", "s", time.clone());
        grid.push("wave", "N", wave.clone());
        grid.push("speed", "rad/s", vec![628.3; 1000]);
        grid.push("short", "1", vec![f64::INFINITY, -1.0, 2.0]);
        let json = grid.to_json();
        assert_eq!(json["constant"], json!([["speed", "rad/s", 628.3]]));
        let columns = read(&json).unwrap_or_default();
        let of =
            |name: &str| &columns.iter().find(|column| column.0 == name).expect("a column of that name").1;
        assert_eq!((of("time"), of("speed")), (&time, &vec![628.3; 1000]));
        for (read, written) in of("wave").iter().zip(&wave) {
            assert!((read - written).abs() <= 2e-3 * 1.6e-5 + 1e-12, "{read} {written}");
        }
        let short = of("short");
        assert_eq!((short[0], short[1]), (f64::INFINITY, -1.0));
        assert!((short[2] - 2.0).abs() < 1e-4 && short[3].is_nan());
        let rest = read(&without(&json, &["wave".into()])).unwrap_or_default();
        let names: Vec<_> = rest.iter().map(|column| column.0.as_str()).collect();
        assert_eq!(names, ["speed", "time", "short"]);
        for most in [2, 3, 7, 500, 999] {
            let few = read(&thinned(&json, most)).unwrap_or_default();
            let times = &few.iter().find(|column| column.0 == "time").expect("a time").1;
            assert!(times.len() <= most && (times[0], times.last()) == (time[0], time.last()), "{most}");
            assert!(times.len() == most || times.len() > most / 2, "{most}: {}", times.len());
        }
        assert_eq!(thinned(&json, 1000), json);
        assert!(read(&json!({ "rows": 3 })).is_err());
    }
}
