//! A case of a shaft with its bearings: the row of each bearing with its name before the columns, and the shaft's own columns.

use std::sync::atomic::{AtomicBool, Ordering};

use roulement::interface::variables::{Causality, Source, SystemVariables, Variable};
use roulement::scene::system::SystemScene;
use roulement::simulation::play::Rows;
use roulement::simulation::system::System;

use super::SweepError;
use super::case::{Ended, Row, Wanted, number, summary};
use super::extremes::{Counted, Gathered, OfColumn};
use crate::report::results::{Choice, Columns, ResultsError, fits};
use crate::watch::Watch;

/// Columns that are wanted of each bearing, by the names that its own table has: those that begin with its name, or with `*`.
fn chosen(scene: &SystemScene, wanted: &Wanted) -> Vec<Vec<String>> {
    let of = |name: &str| -> Vec<String> {
        let own = |pattern: &String| {
            let (bearing, column) = pattern.split_once('.')?;
            fits(name, bearing).then(|| column.to_string())
        };
        wanted.columns.iter().filter_map(own).collect()
    };
    scene.bearings.iter().map(|bearing| of(&bearing.name)).collect()
}

/// Is all there that is wanted?
///
/// # Errors
/// If a column is not there, or whole tables are wanted.
pub fn check(scene: &SystemScene, wanted: &Wanted) -> Result<(), SweepError> {
    if wanted.tables.is_some() {
        let why = "--tables: a shaft has a table for every bearing; --runs keeps them for some cases, --columns has columns of all";
        return Err(SweepError::Files(why.to_string()));
    }
    for (mounted, columns) in scene.bearings.iter().zip(chosen(scene, wanted)) {
        Columns::new(&mounted.scene, &Choice { columns, ..Choice::default() })?;
    }
    let names: Vec<&str> = scene.bearings.iter().map(|bearing| bearing.name.as_str()).collect();
    let known = |pattern: &str| {
        pattern.split_once('.').is_some_and(|(bearing, _)| names.iter().any(|name| fits(name, bearing)))
    };
    match wanted.columns.iter().find(|pattern| !known(pattern)) {
        Some(pattern) => Err(ResultsError::Column(pattern.clone()).into()),
        None => Ok(()),
    }
}

/// Runs a shaft to its end and gives its columns.
pub fn run(scene: &SystemScene, wanted: &Wanted, interrupted: &AtomicBool) -> Result<Row, Ended> {
    let failed = |why: &dyn std::fmt::Display| Ended::Failed(why.to_string());
    let mut system = System::new(scene).map_err(|why| failed(&why))?;
    let rows = Rows { interval: scene.load.output_interval.0, duration: scene.load.duration.0 };
    let count = rows.count() + 1;
    let variables = SystemVariables::new(&system);
    let of_shaft =
        |row: &Variable| matches!(row.source, Source::Shaft(_)) && row.causality == Causality::Output;
    let mut columns: Vec<(usize, OfColumn)> = variables
        .rows()
        .iter()
        .enumerate()
        .filter(|(_, row)| of_shaft(row))
        .map(|(reference, row)| (reference, OfColumn::new(&row.name, row.unit.name)))
        .collect();
    let mut counted = Counted::new(count);
    let gathered = system.bearings().zip(chosen(scene, wanted));
    let gathered = gathered.map(|((_, bearing), columns)| Gathered::new(bearing, count, &columns));
    let mut gathered = gathered.collect::<Result<Vec<_>, _>>().map_err(|why| failed(&why))?;
    let mut watches: Vec<Watch> = system.bearings().map(|(_, bearing)| Watch::of(bearing)).collect();
    let mut times = rows.times();
    loop {
        for ((_, bearing), (watch, gathered)) in system.bearings().zip(watches.iter_mut().zip(&mut gathered))
        {
            watch.push(bearing);
            gathered.push(bearing);
        }
        for (reference, column) in &mut columns {
            column.push(variables.value(*reference, &system), counted.counts());
        }
        counted.next();
        if interrupted.load(Ordering::Relaxed) {
            return Err(Ended::Interrupted);
        }
        let Some(next) = times.next() else { break };
        system.advance(next).map_err(|why| failed(&why))?;
    }
    let mut row = vec![number("time", "s", system.time())];
    for (_, column) in &columns {
        let of = |what: &str| format!("{}.{what}", column.name);
        row.push(number(&of("mean"), &column.unit, counted.mean(column)));
        row.push(number(&of("least"), &column.unit, column.extremes.least));
        row.push(number(&of("largest"), &column.unit, column.extremes.largest));
        row.push(number(&of("end"), &column.unit, column.end));
    }
    for (((name, bearing), watch), gathered) in system.bearings().zip(watches).zip(&gathered) {
        let own = summary(bearing, &watch.finish(), gathered, None);
        row.extend(own.into_iter().map(|(mut column, cell)| {
            column.name = format!("{name}.{}", column.name);
            (column, cell)
        }));
    }
    Ok(row)
}
