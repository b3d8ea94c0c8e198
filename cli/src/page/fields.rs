//! Where contacts stick and slip, for the page.

use std::collections::BTreeMap;
use std::path::Path;

use roulement::analysis::stick_slip::{Field, FieldCause};
use roulement::model::bodies::Race;
use roulement::schema::regular;
use roulement::simulation::Simulation;
use serde_json::{Value, json};

use super::grid::Grid;

/// [-] cells across an ellipse.
const CELLS: usize = 24;

/// Causes of the fields of the contacts of the ball with the largest and of the one with the least load as they are now; those
/// without load or without friction are left out. The fields themselves take longer than a short run: they are solved for a page.
pub fn causes(simulation: &Simulation) -> Vec<Value> {
    let load = |ball: usize| simulation.outputs().balls[ball].inner.load;
    let balls = 0..simulation.outputs().balls.len();
    let most = balls.clone().max_by(|a, b| load(*a).total_cmp(&load(*b)));
    let least = balls.filter(|ball| load(*ball) > 0.0).min_by(|a, b| load(*a).total_cmp(&load(*b)));
    let chosen = most
        .into_iter()
        .chain(least.filter(|ball| Some(*ball) != most && differs(load(*ball), most.map(load))));
    let of = |(ball, race): (usize, Race)| {
        let (model, state) = (simulation.model(), simulation.state());
        let cause = FieldCause::of(model, state, &simulation.conditions(), (ball, race))?;
        Some(json!({ "time": simulation.time(), "ball": ball + 1, "race": race.name(), "cause": cause }))
    };
    chosen.flat_map(|ball| Race::BOTH.map(|race| (ball, race))).filter_map(of).collect()
}

/// The fields of causes; those without a solution are left out.
pub fn solved(causes: &Value) -> Vec<Value> {
    let of = |contact: &Value| {
        let cause: FieldCause = serde_json::from_value(contact["cause"].clone()).ok()?;
        let (ball, race) = (contact["ball"].as_u64()?, contact["race"].as_str()?);
        Some(to_json(contact["time"].as_f64()?, ball as usize, race, &cause.field(CELLS).ok()?))
    };
    causes.as_array().into_iter().flatten().filter_map(of).collect()
}

/// Is a load another one than the largest?
fn differs(load: f64, most: Option<f64>) -> bool {
    most.is_none_or(|most| load < 0.99 * most)
}

fn to_json(time: f64, ball: usize, race: &str, field: &Field) -> Value {
    let mut cells = Grid::new(field.points.len());
    type Get = fn(&roulement::analysis::stick_slip::FieldPoint) -> f64;
    let columns: [(&str, &str, Get); 9] = [
        ("x", "m", |p| p.place[0]),
        ("y", "m", |p| p.place[1]),
        ("area", "m2", |p| p.area),
        ("pressure", "Pa", |p| p.pressure),
        ("traction.x", "Pa", |p| p.traction[0]),
        ("traction.y", "Pa", |p| p.traction[1]),
        ("slip.x", "m/s", |p| p.slip[0]),
        ("slip.y", "m/s", |p| p.slip[1]),
        ("sticks", "1", |p| f64::from(u8::from(p.sticks))),
    ];
    for (name, unit, get) in columns {
        cells.push(name, unit, field.points.iter().map(get).collect());
    }
    json!({
        "time": time, "ball": ball, "race": race,
        "semi_axes": field.semi_axes, "stick": field.stick, "cells": cells.to_json(),
    })
}

/// Columns of the table of `roulement field` after time, ball and race.
const READ: [(&str, &str); 9] = [
    ("x", "m"),
    ("y", "m"),
    ("area", "m2"),
    ("pressure", "Pa"),
    ("traction.x", "Pa"),
    ("traction.y", "Pa"),
    ("slip.x", "m/s"),
    ("slip.y", "m/s"),
    ("sticks", "1"),
];

/// Reads what `roulement field` wrote.
///
/// # Errors
/// If the file cannot be read, or is no such table.
pub fn read(path: &Path) -> Result<Vec<Value>, String> {
    let wrong =
        |why: &dyn std::fmt::Display| format!("{} is no table of roulement field: {why}", path.display());
    let table = regular::open(path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
    let mut table = csv::Reader::from_reader(table);
    let head: Vec<String> = table.headers().map_err(|why| wrong(&why))?.iter().map(str::to_string).collect();
    let wanted = READ.iter().map(|(name, unit)| format!("{name} [{unit}]"));
    let at = wanted
        .map(|name| {
            head.iter().position(|column| *column == name).ok_or_else(|| wrong(&format!("{name} is missing")))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let of = |name: &str| {
        head.iter().position(|column| column == name).ok_or_else(|| wrong(&format!("{name} is missing")))
    };
    let keys = [of("time [s]")?, of("ball [1]")?, of("race")?];
    let mut contacts: BTreeMap<(usize, [String; 3]), Vec<[f64; 9]>> = BTreeMap::new();
    let mut order: Vec<[String; 3]> = vec![];
    for record in table.records() {
        let record = record.map_err(|why| wrong(&why))?;
        let cell = |at: usize| record.get(at).unwrap_or_default();
        let key = keys.map(|at| cell(at).to_string());
        let place = order.iter().position(|known| *known == key).unwrap_or_else(|| {
            order.push(key.clone());
            order.len() - 1
        });
        let mut row = [0.0; 9];
        for (value, column) in row.iter_mut().zip(&at) {
            *value = cell(*column).parse().map_err(|why| wrong(&why))?;
        }
        contacts.entry((place, key)).or_default().push(row);
    }
    let of_contact = |((_, [time, ball, race]), rows): ((usize, [String; 3]), Vec<[f64; 9]>)| {
        let mut cells = Grid::new(rows.len());
        for (index, (name, unit)) in READ.into_iter().enumerate() {
            cells.push(name, unit, rows.iter().map(|row| row[index]).collect());
        }
        let (total, sticks) =
            rows.iter().fold((0.0, 0.0), |(total, sticks), row| (total + row[2], sticks + row[2] * row[8]));
        // The area of the ellipse's cells, by their extent along both axes.
        let reach = |index: usize| rows.iter().map(|row| row[index].abs()).fold(0.0, f64::max);
        let half = (rows.first().map_or(0.0, |row| row[2])).sqrt() / 2.0;
        Ok(json!({
            "time": time.parse::<f64>().map_err(|why| wrong(&why))?,
            "ball": ball.parse::<usize>().map_err(|why| wrong(&why))?,
            "race": race,
            "semi_axes": [reach(0) + half, reach(1) + half],
            "stick": if total > 0.0 { sticks / total } else { 0.0 },
            "cells": cells.to_json(),
        }))
    };
    contacts.into_iter().map(of_contact).collect()
}
