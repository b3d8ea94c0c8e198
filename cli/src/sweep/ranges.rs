//! Cases from ranges of keys.

use roulement::scene::schedule::is_block;
use roulement::scene::units::split;
use toml::{Table, Value};

use super::setting::{Setting, leaves};

/// Settings of a case: key, unit of its column, value.
type Row = Vec<(String, Option<String>, Setting)>;

/// [-] most cases of a table: more are a slip of the pen.
const MOST: usize = 10_000_000;

/// A range of a key.
#[derive(Debug)]
struct Range {
    from: f64,
    to: f64,
    unit: Option<String>,
    steps: Option<usize>,
    is_log: bool,
}

impl Range {
    fn read(key: &str, table: &Table) -> Result<Self, String> {
        let allowed = ["from", "to", "steps", "scale"];
        if let Some(name) = table.keys().find(|name| !allowed.contains(&name.as_str())) {
            return Err(format!("{key}: unknown key {name}; a range has {}", allowed.join(", ")));
        }
        let end = |name: &str| -> Result<(f64, Option<String>), String> {
            let value = table.get(name).ok_or_else(|| format!("{key}: a range needs {name}"))?;
            number_with_unit(value)
                .ok_or_else(|| format!("{key}: {name} = {value} is neither a number nor one with a unit"))
        };
        let ((from, unit), (to, unit_of_to)) = (end("from")?, end("to")?);
        if unit != unit_of_to {
            return Err(format!("{key}: from and to need the same unit"));
        }
        let steps = match table.get("steps") {
            None => None,
            Some(steps) => Some(
                steps
                    .as_integer()
                    .and_then(|steps| usize::try_from(steps).ok())
                    .filter(|steps| (2..=MOST).contains(steps))
                    .ok_or_else(|| {
                        format!("{key}: steps = {steps} is out of range: allowed is [2, {MOST}]")
                    })?,
            ),
        };
        let is_log = match table.get("scale").map(|scale| scale.as_str()) {
            None | Some(Some("linear")) => false,
            Some(Some("log")) if from > 0.0 && to > 0.0 => true,
            Some(Some("log")) => return Err(format!("{key}: scale = \"log\" needs positive ends")),
            Some(_) => return Err(format!("{key}: scale is \"linear\" or \"log\"")),
        };
        Ok(Self { from, to, unit, steps, is_log })
    }

    /// The value at a share of the range, 0 to 1.
    fn at(&self, share: f64) -> Setting {
        let value = match share {
            0.0 => self.from,
            1.0 => self.to,
            _ if self.is_log => self.from * (self.to / self.from).powf(share),
            _ => self.from + (self.to - self.from) * share,
        };
        // An integer stays one, for keys that count; a scene takes it as a number, too.
        Setting::of_cell(&value.to_string(), self.unit.as_deref())
    }
}

/// A number, or a text of a number and a unit.
fn number_with_unit(value: &Value) -> Option<(f64, Option<String>)> {
    match value {
        Value::Integer(number) => Some((*number as f64, None)),
        Value::Float(number) => Some((*number, None)),
        Value::String(text) => {
            let (number, unit) = split(text)?;
            Some((number, (!unit.is_empty()).then(|| unit.to_string())))
        }
        _ => None,
    }
    .filter(|(number, _)| number.is_finite())
}

/// Is a table a range or a value over time, and no section?
fn is_value(table: &Table) -> bool {
    table.contains_key("from") || table.contains_key("to") || is_block(table)
}

/// Is such a table a value over time? A step is no key of a range, but it is easily written for `steps`.
fn is_script(table: &Table) -> bool {
    is_block(table) && (table.contains_key("ramp") || !table.contains_key("from"))
}

/// All combinations of the values of some keys; the last key changes fastest.
pub fn grid(section: &Table) -> Result<Vec<Row>, String> {
    let mut axes: Vec<(String, Option<String>, Vec<Setting>)> = vec![];
    for (key, value) in leaves(section, &is_value) {
        let name = format!("grid.{key}");
        let axis = match value {
            Value::Array(values) if !values.is_empty() => {
                (key, None, values.iter().map(Setting::of_value).collect())
            }
            Value::Table(block) if is_script(block) => (key, None, vec![Setting::of_value(value)]),
            Value::Table(range) => {
                let range = Range::read(&name, range)?;
                let steps = range.steps.ok_or_else(|| format!("{name}: a range of a grid needs steps"))?;
                let last = (steps - 1) as f64;
                let values = (0..steps).map(|step| range.at(step as f64 / last)).collect();
                (key, range.unit, values)
            }
            _ => {
                return Err(format!(
                    "{name}: a list of values, or a range such as {{ from = 1, to = 2, steps = 3 }}"
                ));
            }
        };
        axes.push(axis);
    }
    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.2.len()));
    let count =
        count.filter(|count| *count <= MOST).ok_or_else(|| format!("grid: more than {MOST} cases"))?;
    let row = |mut case: usize| {
        let mut row: Row = Vec::with_capacity(axes.len());
        for (key, unit, values) in axes.iter().rev() {
            row.push((key.clone(), unit.clone(), values[case % values.len()].clone()));
            case /= values.len();
        }
        row.reverse();
        row
    };
    Ok(if axes.is_empty() { vec![] } else { (0..count).map(row).collect() })
}

/// A Latin hypercube: every range is divided into as many equal parts as there are cases, and each part has one case somewhere
/// in it (McKay, Beckman and Conover, Technometrics 21, 1979).
pub fn latin_hypercube(section: &Table) -> Result<Vec<Row>, String> {
    let whole = |name: &str| section.get(name).and_then(Value::as_integer);
    let cases = whole("cases")
        .and_then(|cases| usize::try_from(cases).ok())
        .filter(|cases| (1..=MOST).contains(cases))
        .ok_or_else(|| format!("latin_hypercube.cases has to be a number of [1, {MOST}]"))?;
    let seed = match section.get("seed") {
        None => 0,
        Some(seed) => seed.as_integer().ok_or("latin_hypercube.seed has to be a whole number")?,
    };
    let mut random = Random(seed as u64);
    let mut rows: Vec<Row> = vec![vec![]; cases];
    let mut ranges: Vec<_> = leaves(section, &is_value);
    ranges.retain(|(key, _)| key != "cases" && key != "seed");
    for (key, value) in ranges {
        let name = format!("latin_hypercube.{key}");
        let range =
            value.as_table().ok_or_else(|| format!("{name}: a range such as {{ from = 1, to = 2 }}"))?;
        let range = Range::read(&name, range)?;
        if range.steps.is_some() {
            return Err(format!("{name}: the cases are its steps"));
        }
        let mut parts: Vec<usize> = (0..cases).collect();
        for last in (1..cases).rev() {
            parts.swap(last, (random.share() * (last + 1) as f64) as usize);
        }
        for (row, part) in rows.iter_mut().zip(parts) {
            let share = (part as f64 + random.share()) / cases as f64;
            row.push((key.clone(), range.unit.clone(), range.at(share)));
        }
    }
    Ok(rows)
}

/// Random numbers: splitmix64 (Steele, Lea and Flood, 2014).
struct Random(u64);

impl Random {
    /// A number in [0, 1).
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ bits >> 31) >> 11) as f64 / (1u64 << 53) as f64
    }
}
