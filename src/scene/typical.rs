//! What keys usually have: numbers without a unit that are right in SI alone, and were perhaps meant in another unit; and numbers whose sign was another one.

use toml::{Table, Value};

use crate::schema::numbers::four;

/// Keys whose numbers are of one kind.
struct Kind {
    /// Last parts of the keys.
    keys: &'static [&'static str],
    /// Least and largest number in SI that is usual.
    usual: [f64; 2],
    /// Unit that such a number is perhaps meant in.
    meant: &'static str,
    /// Unit in which what it is now is told, and its size in SI.
    told: (&'static str, f64),
}

const MM: (&str, f64) = ("mm", 1e-3);
const METRE: (&str, f64) = ("m", 1.0);
const RPM: (&str, f64) = ("rpm", std::f64::consts::TAU / 60.0);
const DEGREE: (&str, f64) = ("deg", std::f64::consts::PI / 180.0);
const SECOND: (&str, f64) = ("s", 1.0);

#[rustfmt::skip]
const KINDS: [Kind; 11] = [
    // 20,000 rpm: faster ones are written with their unit.
    Kind { keys: &["inner_speed", "outer_speed", "start_speed", "speed"], usual: [-2100.0, 2100.0], meant: "rpm", told: RPM },
    Kind { keys: &["temperature", "cold_temperature"], usual: [-60.0, 200.0], meant: "K", told: ("degC", 1.0) },
    Kind { keys: &["diametral_clearance"], usual: [-5e-4, 2e-3], meant: "mm", told: MM },
    Kind { keys: &["displacement", "offset.y", "offset.z"], usual: [-1e-3, 1e-3], meant: "mm", told: MM },
    Kind { keys: &["ry", "rz"], usual: [-0.03, 0.03], meant: "deg", told: DEGREE },
    Kind { keys: &["ball_diameter", "pitch_diameter", "position", "drive_position", "from", "to", "outer_diameter", "inner_diameter", "face_width", "origin",
                   "tip_diameter", "outside", "bore"], usual: [-5.0, 5.0], meant: "mm", told: METRE },
    Kind { keys: &["normal_module"], usual: [1e-4, 0.1], meant: "mm", told: METRE },
    Kind { keys: &["duration"], usual: [0.0, 10.0], meant: "ms", told: SECOND },
    Kind { keys: &["output_interval"], usual: [0.0, 0.1], meant: "ms", told: SECOND },
    Kind { keys: &["film.viscosity"], usual: [0.0, 1.0], meant: "mPa s", told: ("Pa s", 1.0) },
    Kind { keys: &["density"], usual: [500.0, 25e3], meant: "g/cm^3", told: ("kg/m^3", 1.0) },
];

/// Sections whose numbers are no quantities of the scene, or those of a gas; and what a machine gives the scenes of its bearings.
const APART: [&str; 4] = ["set", "ranges", "ambient", "scene.load"];

/// Notes on numbers without unit beyond what is usual, and on those whose meaning has changed, a sentence each.
pub fn unusual(text: &str) -> Vec<String> {
    let mut notes = vec![];
    if let Ok(table) = text.parse::<Table>() {
        tables(&table, "", &mut notes);
        for section in ["load", "shaft"] {
            gears(table.get(section), section, &mut notes);
        }
    }
    notes
}

/// Gears whose helix angle had the other sign up to version 0.1.
fn gears(section: Option<&Value>, key: &str, notes: &mut Vec<String>) {
    match section {
        Some(Value::Array(shafts)) => shafts.iter().for_each(|shaft| gears(Some(shaft), key, notes)),
        Some(Value::Table(keys)) => {
            let all = keys.get("gear").and_then(Value::as_array).into_iter().flatten();
            notes.extend(all.filter_map(|gear| gear.get("helix_angle")).filter(|angle| !is_zero(angle)).map(|angle| {
                format!(
                    "note: {key}.gear.helix_angle = {angle}: positive for right-hand teeth, as of a [[mesh]] (ISO 21771); files of version 0.1, where \
                     left-hand ones were positive, need the other sign"
                )
            }));
        }
        _ => {}
    }
}

/// Is it 0, in whatever unit?
fn is_zero(angle: &Value) -> bool {
    let text = angle.to_string();
    let number = text.trim_matches('"').split_whitespace().next().map(str::parse::<f64>);
    matches!(number, Some(Ok(number)) if number == 0.0)
}

fn tables(table: &Table, before: &str, notes: &mut Vec<String>) {
    for (name, value) in table {
        let key = if before.is_empty() { name.clone() } else { format!("{before}.{name}") };
        if !APART.iter().any(|apart| is_end(&key, apart)) {
            look(value, &key, notes);
        }
    }
}

fn look(value: &Value, key: &str, notes: &mut Vec<String>) {
    match value {
        Value::Table(table) => tables(table, key, notes),
        Value::Array(entries) => {
            for (index, entry) in entries.iter().enumerate() {
                match entry {
                    Value::Table(table) => {
                        let name = table.get("name").and_then(Value::as_str);
                        tables(
                            table,
                            &name.map_or_else(|| format!("{key}.{index}"), |name| format!("{key}.{name}")),
                            notes,
                        );
                    }
                    // A point of a table over time.
                    Value::Array(point) if point.len() == 2 => look(&point[1], key, notes),
                    entry => look(entry, key, notes),
                }
            }
        }
        Value::Float(number) => note(*number, key, notes),
        Value::Integer(number) => note(*number as f64, key, notes),
        _ => {}
    }
}

/// Is it the last part of a key, or the last parts?
fn is_end(key: &str, end: &str) -> bool {
    key.strip_suffix(end).is_some_and(|before| before.is_empty() || before.ends_with('.'))
}

fn note(number: f64, key: &str, notes: &mut Vec<String>) {
    let is_of = |kind: &&Kind| {
        kind.keys
            .iter()
            .any(|end| key == *end || key.strip_suffix(end).is_some_and(|before| before.ends_with('.')))
    };
    let Some(kind) = KINDS.iter().find(is_of) else { return };
    let [least, largest] = kind.usual;
    if (least..=largest).contains(&number)
        || notes.iter().any(|note| note.starts_with(&format!("note: {key} = ")))
    {
        return;
    }
    let (unit, size) = kind.told;
    notes.push(format!(
        "note: {key} = {number} has no unit and is {} {unit}, where {} to {} {unit} is usual: \"{number} {}\" meant?",
        four(&(number / size)),
        four(&(least / size)),
        four(&(largest / size)),
        kind.meant
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_numbers_in_other_units_are_noted() {
        for (text, words) in [
            ("[load]\ninner_speed = 6000", ["load.inner_speed = 6000", "57300 rpm", "\"6000 rpm\" meant"]),
            ("[film]\ntemperature = 353", ["film.temperature = 353", "353 degC", "\"353 K\" meant"]),
            (
                "[bearing]\ndiametral_clearance = 0.02",
                ["bearing.diametral_clearance", "20 mm", "\"0.02 mm\" meant"],
            ),
            ("[load]\nduration = 20", ["load.duration", "20 s", "\"20 ms\" meant"]),
            ("[outer.misalignment]\nrz = 0.1", ["outer.misalignment.rz", "5.73 deg", "\"0.1 deg\" meant"]),
            (
                "[[shaft]]\nname = \"input\"\nspeed = [[0, 0], [1, 3000]]",
                ["shaft.input.speed", "28650 rpm", "3000 rpm"],
            ),
            ("[ball]\ndensity = 7.8", ["ball.density", "7.8 kg/m^3", "7.8 g/cm^3"]),
        ] {
            let notes = unusual(text);
            assert_eq!(notes.len(), 1, "{text}: {notes:?}");
            words.iter().for_each(|word| assert!(notes[0].contains(word), "{word}: {notes:?}"));
        }
        // Gears in a file of an earlier version had the other sign.
        for text in [
            "[[load.gear]]\ntorque = 1\nhelix_angle = \"15 deg\"",
            "[shaft]\n[[shaft.gear]]\nhelix_angle = 0.2",
            "[[shaft]]\n[[shaft.gear]]\nhelix_angle = 0.2\n[[shaft]]",
        ] {
            let notes = unusual(text);
            assert!(
                notes.len() == 1
                    && notes[0].contains("gear.helix_angle = ")
                    && notes[0].contains("need the other sign"),
                "{notes:?}"
            );
        }
        // What has a unit is meant, and what is usual has no note.
        for text in [
            "[load]\ninner_speed = \"57300 rpm\"\nduration = \"20 s\"",
            "[load]\ninner_speed = 628\ny = { force = 1500, displacement = 2e-5 }\nduration = 0.02\noutput_interval = 1e-5",
            "[film]\ntemperature = 80\nviscosity = 0.015",
            "title = 6000",
            "[[load.gear]]\nhelix_angle = \"0 deg\"\n[[load.gear]]\nhelix_angle = 0",
        ] {
            assert_eq!(unusual(text), Vec::<String>::new(), "{text}");
        }
    }
}
