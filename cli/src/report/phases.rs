//! Words and tables of the phases of a run.

use std::fmt::{self, Write};
use std::io;
use std::path::Path;

use super::figures::{Figures, Shown};
use crate::watch::{Life, Phase};

/// Name of the table.
pub const FILE: &str = "phases.csv";

/// Writes the table of phases: a row for each quantity of each, with its mean, its least and its largest value; then heat and life.
/// `bars` has errors of the means where they were measured.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, phases: &[Phase], bars: Option<&Figures>) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(vec![]);
    table.write_record([
        "phase",
        "quantity",
        "unit",
        "begin [s]",
        "end [s]",
        "mean",
        "least",
        "largest",
        "drift",
        "drift_of_noise",
        "settled",
        "interval_95",
        "error",
    ])?;
    let text = |number: Option<f64>| {
        number.filter(|number| !number.is_nan()).map_or(String::new(), |number| number.to_string())
    };
    for phase in phases {
        let window = phase.means.window.map(|time| time.to_string());
        let mut row = |name: &str, unit: &str, rest: [String; 8]| {
            let [begin, end] = &window;
            let first = [&phase.name, name, unit, begin, end].map(str::to_string);
            table.write_record(first.into_iter().chain(rest))
        };
        for mean in &phase.means.means {
            let extreme = phase.extreme(&mean.name);
            let trend = mean.trend.as_ref();
            let settled = trend.map(|trend| (trend.settled && !phase.means.scripted).to_string());
            row(
                &mean.name,
                mean.unit,
                [
                    mean.mean.to_string(),
                    text(extreme.map(|extreme| extreme.least)),
                    text(extreme.map(|extreme| extreme.largest)),
                    text(trend.map(|trend| trend.drift)),
                    text(trend.map(|trend| trend.noise)),
                    settled.unwrap_or_default(),
                    text(mean.interval),
                    text(bars.map(|bars| bars.get(&phase.figure(&mean.name)))),
                ],
            )?;
        }
        for peak in phase.peaks() {
            let mut rest: [String; 8] = Default::default();
            (rest[1], rest[2]) = (peak.least.to_string(), peak.largest.to_string());
            row(&peak.name, peak.unit, rest)?;
        }
        for (name, unit, value) in numbers(phase) {
            let mut rest: [String; 8] = Default::default();
            rest[0] = value.to_string();
            row(name, unit, rest)?;
        }
    }
    let table = table.into_inner().map_err(|why| io::Error::other(why.to_string()))?;
    std::fs::write(path, table)
}

/// Names, units and values of what a phase has beside means: heat and life.
pub fn numbers(phase: &Phase) -> Vec<(&'static str, &'static str, f64)> {
    let heat = phase.heat.map(|heat| ("heat of friction", "J", heat));
    let life = phase.life.iter().flat_map(|life| {
        let damage = ("damage", "1", life.life.damage);
        life.numbers().into_iter().chain([damage])
    });
    heat.into_iter().chain(life).collect()
}

/// Says what a bearing did in a phase.
///
/// # Errors
/// None, of a string.
pub fn say(out: &mut String, phase: &Phase, shown: &Shown) -> fmt::Result {
    head(out, phase)?;
    let text = |name: &str, factor, digits| shown.text(&phase.figure(name), factor, digits);
    let range = |name: &str, factor: f64, digits: usize| {
        let [least, largest] = phase.extreme(name).map_or([f64::NAN; 2], |own| [own.least, own.largest]);
        format!("{:.digits$} to {:.digits$}", least * factor, largest * factor)
    };
    let vector = ["x", "y", "z"].map(|axis| text(&format!("force.{axis} on the inner race"), 1.0, 3));
    let [x, y, z] = vector;
    writeln!(out, "  mean force     x {x}  y {y}  z {z} N on the inner race")?;
    writeln!(
        out,
        "  friction       {} W ({}), torque {} N m, heat {:.4e} J",
        text("friction power", 1.0, 4),
        range("friction power", 1.0, 4),
        text("friction torque", 1.0, 5),
        phase.heat.unwrap_or(f64::NAN)
    )?;
    writeln!(
        out,
        "  cage speed     {} rad/s, {} % below epicyclic; balls {} %",
        text("cage speed", 1.0, 4),
        text("cage slip", 100.0, 4),
        text("ball slip", 100.0, 4)
    )?;
    let pressure = |race: &str| range(&format!("peak pressure on the {race} race"), 1e-6, 1);
    writeln!(out, "  peak pressure  inner {} MPa, outer {} MPa", pressure("inner"), pressure("outer"))?;
    if let Some(life) = &phase.life {
        say_life(out, "  life           ", life)?;
        writeln!(out, "; damage {:.4e}", life.life.damage)?;
    }
    Ok(())
}

/// Says when a phase was, and whether it has settled.
///
/// # Errors
/// None, of a string.
pub fn head(out: &mut String, phase: &Phase) -> fmt::Result {
    let [begin, end] = phase.means.window.map(|time| time * 1e3);
    writeln!(out, "phase {:<10} {begin:.3} to {end:.3} ms, {}", phase.name, phase.settled())
}

/// Says a life, without the end of the line.
///
/// # Errors
/// None, of a string.
pub fn say_life(out: &mut String, words: &str, Life { life, hours, modified_hours }: &Life) -> fmt::Result {
    let of = |million: f64, hours: &Option<f64>| {
        let hours = hours.map_or(String::new(), |hours| format!(" ({hours:.0} h)"));
        format!("{million:.4e} million revolutions{hours}")
    };
    write!(out, "{words}L10r {}", of(life.reference, hours))?;
    if let Some(modified) = life.modified {
        write!(out, ", modified {}", of(modified, modified_hours))?;
    }
    write!(out, "; P {:.1} N, static safety {:.2}", life.equivalent_load, life.static_safety)
}
