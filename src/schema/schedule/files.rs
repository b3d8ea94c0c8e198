//! Measured values: a CSV file that a schedule names becomes the table that is in it, before a scene is read, so that the scene's
//! text stands alone.

use std::path::Path;

use toml::{Table, Value};

use crate::schema::SceneError;
use crate::schema::regular;
use crate::schema::units::{Quantity, Time, Unit};

/// Keys of a file.
pub(super) const KEYS: [&str; 5] = ["file", "time", "value", "scale", "offset"];
/// [-] most rows of a file.
const MOST_ROWS: usize = 1_000_000;

/// Replaces the files of all schedules in a value of a scene, or in a whole scene, by the tables in them. Paths are relative to
/// `folder`; `key` is where the value stands. Was there a file?
///
/// # Errors
/// If a file cannot be read or has not what is asked of it; names the key, the file, and the line.
pub fn embed(value: &mut Value, folder: &Path, key: &str) -> Result<bool, SceneError> {
    match value {
        Value::Table(table) if is_file(table) => {
            *value = Value::Table(read(table, folder).map_err(|why| SceneError::conflict(key, why))?);
            Ok(true)
        }
        Value::Table(table) => {
            let mut found = false;
            for (name, inner) in table.iter_mut() {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                found |= embed(inner, folder, &key)?;
            }
            Ok(found)
        }
        Value::Array(values) => {
            let mut found = false;
            for (place, inner) in values.iter_mut().enumerate() {
                // Long tables have no tables in them.
                if matches!(inner, Value::Table(_) | Value::Array(_)) {
                    found |= embed(inner, folder, &format!("{key}[{place}]"))?;
                }
            }
            Ok(found)
        }
        _ => Ok(false),
    }
}

/// Is it a file of a schedule with keys that it may have? What is wrong with other keys is said where schedules are read.
fn is_file(table: &Table) -> bool {
    table.contains_key("file") && table.keys().all(|key| KEYS.contains(&key.as_str()))
}

/// The table in a file.
fn read(block: &Table, folder: &Path) -> Result<Table, String> {
    let text_of = |key: &str| match block.get(key) {
        Some(Value::String(text)) => Ok(text.as_str()),
        Some(other) => Err(format!("{key} = {other} is no text")),
        None => Err(format!(
            "a file needs {key}, such as {{ file = \"measured.csv\", time = \"t [ms]\", value = \"Fy [N]\" }}"
        )),
    };
    let (name, time, value) = (text_of("file")?, text_of("time")?, text_of("value")?);
    let path = folder.join(name);
    let text = regular::text(&path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
    let (rows, unit) = columns(&text, time, value).map_err(|why| format!("{}, {why}", path.display()))?;
    let mut table = Table::new();
    table.insert("table".into(), Value::Array(rows));
    table.insert("unit".into(), unit.into());
    table.insert("source".into(), format!("{name}, {value}").into());
    for key in ["scale", "offset"] {
        if let Some(given) = block.get(key) {
            table.insert(key.into(), given.clone());
        }
    }
    Ok(table)
}

/// Rows `[time [s], value]` of two columns of a CSV text, and the unit of the values.
fn columns(text: &str, time: &str, value: &str) -> Result<(Vec<Value>, String), String> {
    let text = text.trim_start_matches('\u{feff}');
    let lines = text.lines().enumerate().map(|(place, line)| (place + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (line, head) = lines.next().ok_or("line 1: there is no header")?;
    let head: Vec<&str> = cells(head).collect();
    let find = |name: &str| {
        let found = head.iter().position(|cell| *cell == name.trim());
        found.ok_or_else(|| format!("line {line}: there is no column \"{name}\"; it has {}", head.join(", ")))
    };
    let (time_at, value_at) = (find(time)?, find(value)?);
    let time_unit: Unit = match unit(time) {
        Some(unit) => Time::DIMENSION.unit(unit).map_err(|why| format!("column \"{time}\": {why}")),
        None => Err(format!("column \"{time}\" has no unit in its header, such as \"{time} [ms]\"")),
    }
    .map_err(|why| format!("line {line}: {why}"))?;
    let mut rows: Vec<Value> = vec![];
    let mut last: Option<f64> = None;
    for (line, cells_of) in lines.map(|(line, row)| (line, cells(row).collect::<Vec<_>>())) {
        let number = |at: usize, name: &str| match cells_of.get(at).map(|cell| cell.parse::<f64>()) {
            Some(Ok(number)) if number.is_finite() => Ok(number),
            Some(_) => Err(format!("line {line}: {name} = \"{}\" is no number", cells_of[at])),
            None => Err(format!("line {line}: {} cells, not {}", cells_of.len(), head.len())),
        };
        let now = number(time_at, time)?;
        if let Some(last) = last.filter(|last| now <= *last) {
            return Err(format!("line {line}: {time} = {now} comes after {last}: times must grow"));
        }
        last = Some(now);
        let value = number(value_at, value)?;
        rows.push(Value::Array(vec![time_unit.si(now).into(), value.into()]));
        if rows.len() > MOST_ROWS {
            return Err(format!("line {line}: more than {MOST_ROWS} rows: allowed is [1, {MOST_ROWS}]"));
        }
    }
    if rows.is_empty() {
        return Err(format!("line {line}: there is no row after the header"));
    }
    // No unit, or a dash, is that of a ratio.
    let unit = unit(value).filter(|unit| *unit != "-").unwrap_or("1");
    Ok((rows, unit.to_string()))
}

fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|cell| cell.trim().trim_matches('"').trim())
}

/// The unit in brackets at the end of a header.
fn unit(header: &str) -> Option<&str> {
    let (_, unit) = header.trim().strip_suffix(']')?.rsplit_once('[')?;
    Some(unit.trim())
}
