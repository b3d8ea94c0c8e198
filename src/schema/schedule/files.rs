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
        Value::Table(table) if table.contains_key("file") && table.contains_key("column") => {
            let values = column(table, folder).map_err(|why| SceneError::conflict(key, why))?;
            *value = Value::Array(values);
            Ok(true)
        }
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

/// A text that a file has to have.
fn text_of<'a>(block: &'a Table, key: &str) -> Result<&'a str, String> {
    match block.get(key) {
        Some(Value::String(text)) => Ok(text.as_str()),
        Some(other) => Err(format!("{key} = {other} is no text")),
        None => Err(format!(
            "a file needs {key}, such as {{ file = \"measured.csv\", time = \"t [ms]\", value = \"Fy [N]\" }}"
        )),
    }
}

/// The table in a file.
fn read(block: &Table, folder: &Path) -> Result<Table, String> {
    let text_of = |key: &str| text_of(block, key);
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

/// The values of one column of a file, each as text with the unit of its header.
fn column(block: &Table, folder: &Path) -> Result<Vec<Value>, String> {
    if let Some(other) = block.keys().find(|key| !["file", "column"].contains(&key.as_str())) {
        return Err(format!("a column has no key {other}: there are file and column"));
    }
    let (name, column) = (text_of(block, "file")?, text_of(block, "column")?);
    let path = folder.join(name);
    let text = regular::text(&path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
    let values = values(&text, column).map_err(|why| format!("{}, {why}", path.display()))?;
    let unit = unit(column).filter(|unit| *unit != "-");
    let written = |value: f64| unit.map_or_else(|| value.into(), |unit| format!("{value} {unit}").into());
    Ok(values.into_iter().map(written).collect())
}

/// Numbers of a column of a CSV text.
fn values(text: &str, column: &str) -> Result<Vec<f64>, String> {
    let (line, head, rows) = lines(text)?;
    let at = place(line, &head, column)?;
    let values = rows.map(|(line, row)| number((line, &row), &head, (at, column)));
    let values: Vec<f64> = values.take(MOST_ROWS + 1).collect::<Result<_, _>>()?;
    match values.len() {
        0 => Err(format!("line {line}: there is no row after the header")),
        many if many > MOST_ROWS => Err(format!("more than {MOST_ROWS} rows: allowed is [1, {MOST_ROWS}]")),
        _ => Ok(values),
    }
}

/// Rows of a CSV text with the numbers of their lines, after its header and the line of that.
#[expect(clippy::type_complexity, reason = "used twice, here")]
fn lines(text: &str) -> Result<(usize, Vec<&str>, impl Iterator<Item = (usize, Vec<&str>)>), String> {
    let text = text.trim_start_matches('\u{feff}');
    let lines = text.lines().enumerate().map(|(place, line)| (place + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (line, head) = lines.next().ok_or("line 1: there is no header")?;
    Ok((line, cells(head).collect(), lines.map(|(line, row)| (line, cells(row).collect()))))
}

/// Place of a column in the header.
fn place(line: usize, head: &[&str], name: &str) -> Result<usize, String> {
    let found = head.iter().position(|cell| *cell == name.trim());
    found.ok_or_else(|| format!("line {line}: there is no column \"{name}\"; it has {}", head.join(", ")))
}

/// Number of a row in a column.
fn number((line, row): (usize, &[&str]), head: &[&str], (at, name): (usize, &str)) -> Result<f64, String> {
    match row.get(at).map(|cell| cell.parse::<f64>()) {
        Some(Ok(number)) if number.is_finite() => Ok(number),
        Some(_) => Err(format!("line {line}: {name} = \"{}\" is no number", row[at])),
        None => Err(format!("line {line}: {} cells, not {}", row.len(), head.len())),
    }
}

/// Rows `[time [s], value]` of two columns of a CSV text, and the unit of the values.
fn columns(text: &str, time: &str, value: &str) -> Result<(Vec<Value>, String), String> {
    let (line, head, body) = lines(text)?;
    let (time_at, value_at) = (place(line, &head, time)?, place(line, &head, value)?);
    let time_unit: Unit = match unit(time) {
        Some(unit) => Time::DIMENSION.unit(unit).map_err(|why| format!("column \"{time}\": {why}")),
        None => Err(format!("column \"{time}\" has no unit in its header, such as \"{time} [ms]\"")),
    }
    .map_err(|why| format!("line {line}: {why}"))?;
    let mut rows: Vec<Value> = vec![];
    let mut last: Option<f64> = None;
    for (line, row) in body {
        let now = number((line, &row), &head, (time_at, time))?;
        if let Some(last) = last.filter(|last| now <= *last) {
            return Err(format!("line {line}: {time} = {now} comes after {last}: times must grow"));
        }
        last = Some(now);
        let value = number((line, &row), &head, (value_at, value))?;
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
