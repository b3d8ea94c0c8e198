//! A rating over a duty as CSV, JSON and words.

use std::f64::consts::PI;
use std::fmt;

use serde_json::{Map, Value, json};

use super::rated::Rated;
use super::{DutyRating, OfMachine, UnderLoad, of_machine};
use crate::report::cells::{Cell, Column};

/// Name of the machine in the column of its bearings.
const MACHINE: &str = "(machine)";
/// Name of all loads in the column of loads.
const ALL: &str = "all";
/// Header of the table.
const HEADER: &str = "load,bearing,share,speed [rpm],equivalent_load [N],L10r [1e6],L10r [h],modified [1e6],modified [h],static_safety,\
                      friction_torque [N m],loss [W],damage\n";

/// [rpm] of a speed [rad/s].
const RPM: f64 = 30.0 / PI;

impl DutyRating {
    /// A row for each bearing under each load, and of all bearings together; then under all loads.
    pub fn to_csv(&self) -> String {
        let mut text = HEADER.to_string();
        for UnderLoad { name, part, bearings, .. } in &self.loads {
            self.rows(&mut text, name, bearings, *part);
        }
        self.rows(&mut text, ALL, &self.together, self.whole);
        text
    }

    fn rows(&self, text: &mut String, load: &str, bearings: &[(String, Rated)], part: f64) {
        let mut say = |bearing: &str, numbers: [Option<f64>; 11]| {
            let cells = numbers.map(|value| value.map_or(String::new(), |value| value.to_string()));
            text.push_str(&format!("{load},{bearing},{}\n", cells.join(",")));
        };
        for (name, rated) in bearings {
            let [reference, modified] = rated.lives;
            let [reference_hours, modified_hours] = rated.hours();
            say(
                name,
                [
                    Some(rated.share),
                    Some(rated.speed * RPM),
                    Some(rated.equivalent_load),
                    reference,
                    reference_hours,
                    modified,
                    modified_hours,
                    Some(rated.safety),
                    rated.torque,
                    rated.loss,
                    self.damage(rated, part),
                ],
            );
        }
        let Some(of) = of_machine(bearings) else { return };
        let [reference, modified] = of.hours;
        let share = bearings.first().map(|(_, rated)| rated.share);
        say(
            MACHINE,
            [
                share,
                None,
                None,
                None,
                reference,
                None,
                modified,
                Some(of.safety),
                None,
                of.loss,
                self.damage_of(&of, part),
            ],
        );
    }

    fn damage_of(&self, machine: &OfMachine, part: f64) -> Option<f64> {
        self.by_hours.then_some(part).zip(machine.used()).map(|(part, used)| part * used)
    }

    /// What its reader should know: which load takes most, and what is left out.
    pub fn notes(&self) -> Vec<String> {
        let without = self.without_losses().then(|| {
            "note: some rollers have no friction here: their torques and losses are empty, and those of the machine are without them; bearing.rollers.film gives them oil".to_owned()
        });
        let worst = self.together.iter().filter_map(|(name, _)| {
            let worst = self.worst(name)?;
            let who = if name.is_empty() { String::new() } else { format!("bearing {name}: ") };
            Some(format!(
                "note: {who}load {} takes most of the life, {:.0} %",
                worst.load,
                100.0 * worst.taken
            ))
        });
        let unsettled: Vec<&str> =
            self.loads.iter().filter(|load| load.unsettled).map(|load| load.name.as_str()).collect();
        let unsettled = (!unsettled.is_empty()).then(|| {
            format!(
                "note: means of runs that had not settled: load {}; a longer load.duration tells more",
                unsettled.join(", ")
            )
        });
        without.into_iter().chain(unsettled).chain(worst).collect()
    }

    /// `loads`, a list with `name`, `share`, `bearings` and `machine`; and what all of them come to, `bearings` and `machine`. Units: speed
    /// \[rad/s], loads \[N], lives [1e6 revolutions] and \[h], torque [N m], losses \[W].
    pub fn to_json(&self) -> Value {
        let machine = |bearings: &[(String, Rated)], part: f64| {
            of_machine(bearings).map(|of| {
                json!({
                    "L10r_hours": of.hours[0],
                    "modified_hours": of.hours[1],
                    "static_safety": of.safety,
                    "loss": of.loss,
                    "damage": self.damage_of(&of, part),
                })
            })
        };
        let bearings = |of: &[(String, Rated)], part: f64| -> Map<String, Value> {
            of.iter().map(|(name, rated)| (name.clone(), self.bearing(rated, part))).collect()
        };
        let loads: Vec<Value> = self
            .loads
            .iter()
            .map(|load| {
                json!({
                    "name": load.name,
                    "share": load.part / self.whole,
                    "bearings": bearings(&load.bearings, load.part),
                    "machine": machine(&load.bearings, load.part),
                })
            })
            .collect();
        let mut all = bearings(&self.together, self.whole);
        for (name, of) in &mut all {
            of["worst"] =
                self.worst(name).map(|worst| json!({ "load": worst.load, "taken": worst.taken })).into();
        }
        json!({
            "hours": self.hours(),
            "loads": loads,
            "bearings": all,
            "machine": machine(&self.together, self.whole),
        })
    }

    fn bearing(&self, rated: &Rated, part: f64) -> Value {
        let [reference_hours, modified_hours] = rated.hours();
        json!({
            "speed": rated.speed,
            "equivalent_load": rated.equivalent_load,
            "L10r": rated.lives[0],
            "L10r_hours": reference_hours,
            "modified": rated.lives[1],
            "modified_hours": modified_hours,
            "static_safety": rated.safety,
            "friction_torque": rated.torque,
            "loss": rated.loss,
            "damage": self.damage(rated, part),
        })
    }

    /// Columns of a row of a sweep: of the machine, then of every bearing with its name before them.
    pub fn to_row(&self) -> Vec<(Column, Cell)> {
        let mut row = vec![];
        if let Some(of) = of_machine(&self.together) {
            let damage = self.damage_of(&of, self.whole);
            row.extend(numbers("", of.hours, [Some(of.safety), of.loss, damage, None]));
        }
        for (name, rated) in &self.together {
            let damage = self.damage(rated, self.whole);
            let rest = [Some(rated.safety), rated.loss, damage, Some(rated.equivalent_load)];
            row.extend(numbers(name, rated.hours(), rest));
            if let Some(worst) = self.worst(name) {
                row.push((Column::text(&key(name, "worst_load")), Cell::Text(worst.load.to_string())));
            }
        }
        row
    }
}

/// Name of a column of a bearing, or of the machine, whose name is empty.
fn key(of: &str, what: &str) -> String {
    if of.is_empty() { format!("duty.{what}") } else { format!("{of}.duty.{what}") }
}

/// Columns of a bearing or the machine, those that it has: lives \[h], static safety, losses \[W], damage, equivalent load \[N].
fn numbers(of: &str, hours: [Option<f64>; 2], rest: [Option<f64>; 4]) -> Vec<(Column, Cell)> {
    let names = [
        ("L10r.hours", "h"),
        ("modified.hours", "h"),
        ("static_safety", "1"),
        ("loss", "W"),
        ("damage", "1"),
        ("equivalent_load", "N"),
    ];
    let values = hours.into_iter().chain(rest);
    let of = |((name, unit), value): ((&str, &str), Option<f64>)| {
        Some((Column::number(&key(of, name), unit), Cell::Number(value?)))
    };
    names.into_iter().zip(values).filter_map(of).collect()
}

/// A report with the rating over the duty of its scene, `duty`, where that has one.
pub fn with_duty(mut report: Value, duty: Option<&DutyRating>) -> Value {
    if let Some(duty) = duty {
        report["duty"] = duty.to_json();
    }
    report
}

/// A number in three digits; nothing where it is none.
fn three(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.digits$}")
}

impl fmt::Display for DutyRating {
    /// A line for each bearing, and one of the machine.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hours = self.hours().map_or(String::new(), |hours| format!(" over {} h", three(hours)));
        writeln!(
            out,
            "duty             {} loads {}{hours}, added up by Miner's rule",
            self.loads.len(),
            if self.by_runs { "run" } else { "in balance" }
        )?;
        let life = |[reference, modified]: [Option<f64>; 2]| {
            let of = |name: &str, hours: Option<f64>| hours.map(|hours| format!("{name} {} h", three(hours)));
            [of("L10r", reference), of("modified", modified)].into_iter().flatten().collect::<Vec<_>>()
        };
        let rest = |safety: f64, loss: Option<f64>, damage: Option<f64>| {
            [
                Some(format!("static safety {}", three(safety))),
                loss.map(|loss| format!("losses {} W", three(loss))),
                damage.map(|damage| format!("damage {}", three(damage))),
            ]
        };
        for (name, rated) in &self.together {
            let mut words = vec![format!("equivalent load {} N", three(rated.equivalent_load))];
            words.push(format!("{} rpm", three(rated.speed * RPM)));
            words.extend(life(rated.hours()));
            words
                .extend(rest(rated.safety, rated.loss, self.damage(rated, self.whole)).into_iter().flatten());
            words.extend(
                self.worst(name).map(|worst| format!("{} takes {:.0} %", worst.load, 100.0 * worst.taken)),
            );
            writeln!(out, "  {:<14} {}", if name.is_empty() { "bearing" } else { name }, words.join(", "))?;
        }
        if let Some(of) = of_machine(&self.together) {
            let mut words = life(of.hours);
            words.extend(rest(of.safety, of.loss, self.damage_of(&of, self.whole)).into_iter().flatten());
            writeln!(out, "  {:<15}{}", "machine", words.join(", "))?;
        }
        Ok(())
    }
}
