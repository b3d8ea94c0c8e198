//! One case: from its scene to its row of the summary.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use roulement::interface::variables::{Source, Variables};
use roulement::scene::machine::MachineScene;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::motions::Motion;
use roulement::simulation::play::{Rows, play_observed};

use super::SweepError;
use super::columns::GatheredMachine;
use super::extremes::{Gathered, OF_BALLS, OfColumn};
use super::limits::all_bare;
use crate::duty::DutyRating;
use crate::error::{Compared, Refined, Run, refine};
use crate::modes::{Found, judged, told};
use crate::report::cells::{Cell, Column};
use crate::report::means::Means;
use crate::report::quantities::QUANTITIES;
use crate::report::results::{Choice, ResultsError};
use crate::report::tables::Tables;
use crate::watch::{BearingSeen, Life, Phase, Seen, Watch};

/// Wanted results of every case.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Variables whose mean, least, largest and last value the summary has, and whole tables have: names with `*` for any
    /// characters.
    pub columns: Vec<String>,
    /// Ending of the files of whole tables, `csv` or `parquet`; none where they are not wanted.
    pub tables: Option<String>,
    /// Growth or decay where a case starts, and whether races circle.
    pub growth: bool,
}

/// Column of what a plain run would have warned of.
pub const WARNINGS: &str = "warnings";

/// A row of the summary.
pub type Row = Vec<(Column, Cell)>;

/// Why a run has no result.
enum Ended {
    /// It was interrupted.
    Interrupted,
    /// It failed, or what is wanted of it is not there.
    Failed(String),
    /// Files cannot be written.
    Files(SweepError),
}

/// A run that came to its end.
struct Done {
    machine: Machine,
    seen: Seen,
    gathered: GatheredMachine,
    /// Motions about its start, the one that grows fastest first, where they are wanted and there are some.
    motions: Option<Option<Vec<Found>>>,
}

/// Runs a case and gives its row, which begins with how it ended; none if it was interrupted. A whole table goes to a file.
///
/// # Errors
/// If the file of the table cannot be written. A case that fails is no error.
pub fn run(
    scene: &MachineScene,
    wanted: &Wanted,
    table: Option<&Path>,
    interrupted: &AtomicBool,
) -> Result<Option<Row>, SweepError> {
    match measured(scene, wanted, table, interrupted) {
        Ok((done, goal)) => {
            let mut row = ended("done", "");
            row.push(number("time", "s", done.machine.time()));
            row.extend(done.motions.iter().flat_map(|motions| of_motions(motions.as_deref())));
            row.extend(of_machine(&done, goal));
            row.extend(of_duty(scene));
            Ok(Some(row))
        }
        Err(Ended::Failed(why)) => Ok(Some(ended("failed", &why))),
        Err(Ended::Interrupted) => Ok(None),
        Err(Ended::Files(why)) => Err(why),
    }
}

/// Runs a case from the text of a scene; one that is refused is a case that fails.
///
/// # Errors
/// As [`run`].
pub fn run_text(
    text: &str,
    wanted: &Wanted,
    table: Option<&Path>,
    interrupted: &AtomicBool,
) -> Result<Option<Row>, SweepError> {
    match MachineScene::edited(text) {
        Ok(scene) => run(&scene, wanted, table, interrupted),
        Err(why) => Ok(Some(failed(&why.to_string()))),
    }
}

/// The row of a case that has no result.
pub fn failed(why: &str) -> Row {
    ended("failed", why)
}

fn ended(status: &str, reason: &str) -> Row {
    let text = |name: &str, text: &str| (Column::text(name), Cell::Text(text.to_string()));
    vec![text("status", status), text("reason", reason)]
}

/// Runs a scene, again and again with smaller steps where it has an error goal, and says how that ended.
fn measured(
    scene: &MachineScene,
    wanted: &Wanted,
    table: Option<&Path>,
    interrupted: &AtomicBool,
) -> Result<(Done, Option<&'static str>), Ended> {
    let nothing = Wanted::default();
    let Refined { run: mut done, rounds } = refine(scene, |scene, keep| {
        let (wanted, table) = if keep { (wanted, table) } else { (&nothing, None) };
        played(scene, wanted, table, interrupted)
    })?;
    let Some((rounds, said)) = rounds else { return Ok((done, None)) };
    done.seen.set_means(rounds.means());
    Ok((done, Some(said)))
}

impl Compared for Done {
    fn comparable(&mut self) -> Run {
        // What it costs is no result.
        self.seen.take_comparable(&self.machine, 0.0)
    }
}

/// Plays a scene to its end.
fn played(
    scene: &MachineScene,
    wanted: &Wanted,
    table: Option<&Path>,
    interrupted: &AtomicBool,
) -> Result<Done, Ended> {
    let failed = |why: &dyn std::fmt::Display| Ended::Failed(why.to_string());
    let written = |why: ResultsError| match why {
        ResultsError::Column(_) | ResultsError::Limit(_) => Ended::Failed(why.to_string()),
        ResultsError::Write { .. } => Ended::Files(SweepError::Files(why.to_string())),
    };
    let mut machine = Machine::new(scene).map_err(|why| failed(&why))?;
    let rows = Rows::of_scene(scene);
    let gathered = GatheredMachine::new(scene, &machine, rows.duration, &wanted.columns).map_err(written)?;
    let mut observers = (Watch::of(&machine), gathered);
    let choice = Choice { columns: all_bare(&wanted.columns), ..Choice::default() };
    let begun = |path: &Path| Tables::whole(&machine, &choice, path);
    let mut table = table.map(begun).transpose().map_err(written)?;
    let flow = play_observed(&mut machine, rows, &mut observers, |machine, (watch, _)| {
        if interrupted.load(Ordering::Relaxed) {
            return ControlFlow::Break(Ended::Interrupted);
        }
        if let Some(Err(why)) = table.as_mut().map(|table| table.write(machine)) {
            return ControlFlow::Break(written(why));
        }
        watch.push(machine);
        ControlFlow::Continue(())
    });
    match flow {
        Err(why) => return Err(failed(&why)),
        Ok(ControlFlow::Break(why)) => return Err(why),
        Ok(ControlFlow::Continue(())) => {}
    }
    table.map(Tables::finish).transpose().map_err(written)?;
    let (watch, gathered) = observers;
    let mut seen = watch.finish(&machine);
    let motions = wanted.growth.then(|| judged(scene, 0.0));
    if let Some(Some(motions)) = &motions {
        seen.set_growing(&told(motions, scene));
    }
    Ok(Done { machine, seen, gathered, motions })
}

/// The rating over the duty of a scene that has one, or why there is none.
fn of_duty(scene: &MachineScene) -> Row {
    // Cases have the threads.
    match DutyRating::of_scene(scene, 1) {
        Ok(duty) => duty.map_or(vec![], |duty| duty.to_row()),
        Err(why) => vec![(Column::text("duty.reason"), Cell::Text(why.to_string()))],
    }
}

/// Growth of the motion that grows fastest or decays slowest, its frequency, what it is, and whether something grows.
fn of_motions(motions: Option<&[Found]>) -> Row {
    let first = motions.and_then(<[Found]>::first).map(|found| &found.motion);
    let of = |get: fn(&Motion) -> f64| first.map(get);
    let grows = match motions {
        None => "cannot tell",
        Some(motions) if motions.iter().any(Found::grows) => "yes",
        Some(_) => "no",
    };
    let shape = first.map_or(String::new(), |motion| motion.shape.clone());
    vec![
        (Column::text("grows"), Cell::Text(grows.to_string())),
        optional("growth", "1/s", of(|motion| motion.growth)),
        optional("growth.frequency", "Hz", of(|motion| motion.frequency)),
        (Column::text("growth.motion"), Cell::Text(shape)),
    ]
}

/// Results of a machine: of a shaft its own columns, then those of every bearing with its name before them.
fn of_machine(done: &Done, goal: Option<&'static str>) -> Row {
    let Done { machine, seen, gathered, .. } = done;
    let mut row = vec![];
    if let (Some(system), Some(seen)) = (machine.shaft(), &seen.shaft) {
        let warnings: Vec<String> = seen.part.growing.iter().cloned().chain(seen.warnings(system)).collect();
        row.push((Column::text(WARNINGS), Cell::Text(warnings.join("; "))));
        row.extend(goal.map(|goal| (Column::text("error_goal"), Cell::Text(goal.to_string()))));
        if let Some(closed) = &seen.part.closed {
            row.push(number("loss.total.mean", "W", closed.lost));
            row.push(number("torque_power.mean", "W", closed.torque));
            row.push(number("loss.left_open", "W", closed.left()));
        }
        let error = |name: &str| seen.part.means.as_ref()?.find(name)?.error;
        for column in &gathered.shaft {
            let of = |what: &str| format!("{}.{what}", column.name);
            row.push(number(&of("mean"), &column.unit, column.mean()));
            row.push(number(&of("least"), &column.unit, column.extremes.least));
            row.push(number(&of("largest"), &column.unit, column.extremes.largest));
            row.push(number(&of("end"), &column.unit, column.end));
            if let Some(error) = error(&column.name) {
                row.push(number(&of("error"), &column.unit, error.mean));
            }
        }
        row.extend(times_of(&gathered.shaft));
        row.extend(seen.part.phases.iter().flat_map(|phase| of_phase(phase, str::to_string)));
    }
    let goal = goal.filter(|_| machine.shaft().is_none());
    for (((name, bearing), seen), gathered) in machine.bearings().zip(&seen.bearings).zip(&gathered.bearings)
    {
        let mut own = summary(bearing, seen, gathered, goal);
        if done.motions.is_some() {
            let circles = if seen.circling.is_some() { "yes" } else { "no" };
            own.insert(1, (Column::text("circles"), Cell::Text(circles.to_string())));
        }
        row.extend(own.into_iter().map(|(mut column, cell)| {
            if !name.is_empty() {
                column.name = format!("{name}.{}", column.name);
            }
            (column, cell)
        }));
    }
    row
}

/// The key of a quantity, as the variables of packages are named: `inner.force.x` for "force.x on the inner race".
pub fn key_of(quantity: &str) -> String {
    let of_race = |race: &str| {
        let end = format!(" {race} race");
        let what = quantity.strip_suffix(&end)?.strip_suffix(" the")?;
        let what = what.strip_suffix(" on").or(what.strip_suffix(" of"))?;
        Some(format!("{race}.{}", what.replace(' ', "_")))
    };
    of_race("inner").or_else(|| of_race("outer")).unwrap_or_else(|| quantity.replace(' ', "_"))
}

fn number(name: &str, unit: &str, value: f64) -> (Column, Cell) {
    (Column::number(name, unit), if value.is_nan() { Cell::Empty } else { Cell::Number(value) })
}

fn optional(name: &str, unit: &str, value: Option<f64>) -> (Column, Cell) {
    number(name, unit, value.unwrap_or(f64::NAN))
}

fn settled(means: &Means) -> &'static str {
    match (means.scripted, means.settled()) {
        (true, _) => "no: the script changes",
        _ if means.unstable => "no: a motion grows or circles",
        (false, None) => "too few steps to tell",
        (false, Some(true)) => "yes",
        (false, Some(false)) => "no",
    }
}

/// Results of a phase; `key` gives the name of a quantity.
fn of_phase(phase: &Phase, key: impl Fn(&str) -> String) -> Row {
    let of = |what: &str| format!("phase.{}.{what}", phase.name);
    let mut row = vec![(Column::text(&of("settled")), Cell::Text(settled(&phase.means).to_string()))];
    for mean in &phase.means.means {
        row.push(number(&of(&format!("{}.mean", key(&mean.name))), mean.unit, mean.mean));
    }
    for extreme in &phase.extremes {
        let key = key(&extreme.name);
        row.push(number(&of(&format!("{key}.least")), extreme.unit, extreme.least));
        row.push(number(&of(&format!("{key}.largest")), extreme.unit, extreme.largest));
    }
    if let Some(heat) = phase.heat {
        row.push(number(&of("heat"), "J", heat));
    }
    if let Some(Life { life, hours, modified_hours }) = &phase.life {
        row.push(number(&of("life.L10r"), "1", life.reference));
        row.push(optional(&of("life.L10r.hours"), "h", *hours));
        if life.modified.is_some() {
            row.push(optional(&of("life.modified"), "1", life.modified));
            row.push(optional(&of("life.modified.hours"), "h", *modified_hours));
        }
        row.push(number(&of("damage"), "1", life.damage));
    }
    row
}

/// Results of a bearing.
fn summary(
    simulation: &Simulation,
    seen: &BearingSeen,
    gathered: &Gathered,
    goal: Option<&'static str>,
) -> Row {
    let warnings = seen.warnings(simulation).join("; ");
    let mut row = vec![(Column::text(WARNINGS), Cell::Text(warnings))];
    if let Some(means) = &seen.part.means {
        row.push((Column::text("settled"), Cell::Text(settled(means).to_string())));
        let needed = means.needed().filter(|_| means.unsettled().next().is_some());
        row.push(optional("needed_duration", "s", needed));
        if let Some(goal) = goal {
            row.push((Column::text("error_goal"), Cell::Text(goal.to_string())));
        }
        for mean in &means.means {
            let key = key_of(&mean.name);
            let of = |what: &str| format!("{key}.{what}");
            row.push(number(&of("mean"), mean.unit, mean.mean));
            if let Some(place) = QUANTITIES.iter().position(|quantity| quantity.name == mean.name) {
                let extremes = gathered.quantities[place];
                row.push(number(&of("least"), mean.unit, extremes.least));
                row.push(number(&of("largest"), mean.unit, extremes.largest));
            }
            row.push(optional(&of("interval_95"), mean.unit, mean.interval));
            if let Some(error) = mean.error {
                row.push(number(&of("error"), mean.unit, error.mean));
            }
        }
    }
    for ((name, unit, _), extremes) in OF_BALLS.iter().zip(&gathered.balls) {
        row.push(number(&format!("{name}.least"), unit, extremes.least));
        row.push(number(&format!("{name}.largest"), unit, extremes.largest));
    }
    row.push(number("peak_pressure.largest", "Pa", seen.limits.peak_pressure));
    for (quantity, largest) in seen.limits.all() {
        row.push(number(&format!("{}.largest", quantity.column), quantity.unit.name, largest));
    }
    row.push(number("energy_balance", "J", seen.energy.balance(simulation.outputs())));
    if let Some(closed) = &seen.part.closed {
        row.push(number("torque_power.mean", "W", closed.torque));
        row.push(number("loss.left_open", "W", closed.left()));
    }
    row.push(optional("entering_slip_load.per_turn", "W", seen.entering.map(|of| of.mean)));
    if let Some(Life { life, hours, modified_hours }) = &seen.life {
        row.push(number("life.L10r.window", "1", life.reference));
        row.push(optional("life.L10r.hours", "h", *hours));
        if life.modified.is_some() {
            row.push(optional("life.modified.window", "1", life.modified));
            row.push(optional("life.modified.hours", "h", *modified_hours));
        }
    }
    row.extend(seen.part.phases.iter().flat_map(|phase| of_phase(phase, key_of)));
    // What effects report at the end: life, heat, growth.
    let variables = Variables::moving(simulation.scene(), false);
    for report in variables.rows().iter().filter(|row| matches!(row.source, Source::Effect(_))) {
        let value = variables.value(report, simulation.inputs(), simulation.outputs());
        row.push(number(&format!("{}.end", report.name), report.unit.name, value));
    }
    for of in &gathered.chosen {
        let mut push = |what: &str, value| {
            let (column, cell) = number(&format!("{}.{what}", of.name), &of.unit, value);
            // Some are reported of every case.
            if !row.iter().any(|(there, _)| there.name == column.name) {
                row.push((column, cell));
            }
        };
        push("mean", of.mean());
        push("least", of.extremes.least);
        push("largest", of.extremes.largest);
        push("end", of.end);
    }
    row.extend(times_of(&gathered.chosen));
    row
}

/// When limits of columns were met first; empty where they were not.
fn times_of(columns: &[OfColumn]) -> Row {
    let limits = OfColumn::limits(columns).into_iter();
    limits.map(|(limit, time)| optional(&format!("{limit}.time"), "s", time)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_quantities_are_named_as_variables_are() {
        assert_eq!(key_of("force.x on the inner race"), "inner.force.x");
        assert_eq!(key_of("position.y of the outer race"), "outer.position.y");
        assert_eq!(key_of("inner race speed"), "inner_race_speed");
        assert_eq!(key_of("peak pressure on the inner race"), "inner.peak_pressure");
        assert_eq!(key_of("friction power"), "friction_power");
    }
}
