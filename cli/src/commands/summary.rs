//! Summaries that `roulement run` leaves and prints at the end: of a bearing, and of a shaft with its bearings.

use std::fmt::Write;

use roulement::analysis::estimate::Verdicts;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement::simulation::Simulation;
use roulement::simulation::circling::Circling;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::system::System;
use roulement_cli::report::figures::Shown;
use roulement_cli::report::limits::Limits;
use roulement_cli::report::losses::Closed;
use roulement_cli::report::means::{Means, NEGLIGIBLE};
use roulement_cli::report::spectrum::is_wanted;
use roulement_cli::report::{phases, shaft};
use roulement_cli::watch::{BearingSeen, PerTurn, ShaftSeen, headlines};

use super::effects::idle_in;
use super::player::Played;

/// [-] of its play: a cage whose centre never leaves the axis by more is pushed by rounding alone.
const CENTRED: f64 = 1e-3;

/// Summary of a bearing in a run, with error bars where figures have them.
pub fn of_bearing(
    run: &Played,
    own: (&Simulation, &BearingSeen),
    shown: &Shown,
    verdicts: &Verdicts,
) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_bearing(&mut text, run, own, shown, verdicts);
    text
}

/// Summary of a shaft with its bearings, with error bars where their figures have them.
pub fn of_shaft(
    run: &Played,
    (system, seen): (&System, &ShaftSeen),
    shown: &Shown,
    bearings: &[Shown],
) -> String {
    let mut text = String::new();
    let bearings = bearings.iter().zip(&run.seen.bearings);
    // Writing to a string cannot fail.
    let _ = shaft::write_summary(&mut text, system, shown, bearings)
        .and_then(|()| write_shaft(&mut text, run, (system, seen), shown));
    text
}

fn write_shaft(
    out: &mut String,
    run: &Played,
    (system, seen): (&System, &ShaftSeen),
    shown: &Shown,
) -> std::fmt::Result {
    if let Some(closed) = &seen.part.closed {
        writeln!(
            out,
            "losses           {} W of all bearings, shaft and housings",
            shown.text(LOSSES[0].name, 1.0, 4)
        )?;
        write_closed(out, closed)?;
    }
    let bearings = system.bearings().zip(&run.seen.bearings);
    let bearings = bearings.map(|((name, _), seen)| (Some(name), seen.part.means.as_ref()));
    write_settled_of_all(out, bearings.chain([(None, seen.part.means.as_ref())]))?;
    for (index, phase) in seen.part.phases.iter().enumerate() {
        phases::head(out, phase)?;
        for ((name, _), seen) in system.bearings().zip(&run.seen.bearings) {
            // All parts come to the same phases.
            let Some(phase) = seen.part.phases.get(index) else { continue };
            let power = phase.means.of("friction power");
            write!(out, "  {name:<14} friction {power:.4} W, heat {:.4e} J", phase.heat.unwrap_or(f64::NAN))?;
            if let Some(life) = &phase.life {
                phases::say_life(out, "; life ", life)?;
            }
            writeln!(out)?;
        }
    }
    for warning in run.seen.warnings(&run.machine) {
        writeln!(out, "WARNING          {warning}")?;
    }
    if shown.bars.is_none() {
        write_unmeasured(out)?;
    }
    let s = run.machine.statistics();
    writeln!(
        out,
        "steps            {} accepted, {} rejected by error, {} by Newton; {:.2} Newton iterations a step",
        s.steps,
        s.rejected_error,
        s.rejected_newton,
        s.newton.iterations as f64 / s.steps.max(1) as f64
    )?;
    write_wall(out, run, system.time())
}

/// A single run cannot tell its own error: its local errors add up where motions keep them, and are forgotten where these are stable.
fn write_unmeasured(out: &mut String) -> std::fmt::Result {
    writeln!(out, "error            not measured: --error measures it, by a run with half the steps")
}

/// Wall time, for so much simulated time \[s].
fn write_wall(out: &mut String, run: &Played, simulated: f64) -> std::fmt::Result {
    let seconds = run.wall.as_secs_f64();
    let rate = seconds / simulated.max(f64::MIN_POSITIVE);
    writeln!(out, "wall time        {seconds:.3} s, {rate:.2} s per simulated second")
}

/// Means over the window.
fn write_means(
    out: &mut String,
    (means, closed): (&Means, Option<&Closed>),
    shown: &Shown,
    has_cage: bool,
) -> std::fmt::Result {
    let [begin, end] = means.window;
    let text = |name: &str, factor, digits| shown.text(name, factor, digits);
    writeln!(out, "means over the last {:.3} ms", (end - begin) * 1e3)?;
    writeln!(
        out,
        "cage speed       {} rad/s, {} % below epicyclic; balls {} %",
        text("cage speed", 1.0, 4),
        text("cage slip", 100.0, 4),
        text("ball slip", 100.0, 4)
    )?;
    write_losses(out, means, shown)?;
    if let Some(closed) = closed {
        write_closed(out, closed)?;
    }
    writeln!(out, "friction power   {} W of all contacts", text("friction power", 1.0, 4))?;
    writeln!(
        out,
        "per ball         inner {} mW, outer {} mW",
        text("inner power per ball", 1e3, 4),
        text("outer power per ball", 1e3, 4)
    )?;
    if has_cage {
        writeln!(out, "cage centre      at most {} um off axis", text("largest eccentricity", 1e6, 3))?;
        let [pocket, land] = ["largest pocket load", "largest land load"].map(|name| text(name, 1.0, 3));
        writeln!(out, "largest load     pocket {pocket} N, land {land} N")?;
        let [pocket, land] = ["pocket power", "land power"].map(|name| text(name, 1.0, 4));
        writeln!(out, "cage friction    pockets {pocket} W, lands {land} W")?;
    }
    writeln!(out, "friction torque  {} N m", text("friction torque", 1.0, 5))
}

/// All losses, a line each with its share.
fn write_losses(out: &mut String, means: &Means, shown: &Shown) -> std::fmt::Result {
    let [whole, parts @ ..] = LOSSES;
    writeln!(out, "losses           {} W", shown.text(whole.name, 1.0, 4))?;
    let all = means.of(whole.name);
    for part in parts.iter().filter(|part| means.find(part.name).is_some()) {
        let share = if all > 0.0 { 100.0 * means.of(part.name) / all } else { 0.0 };
        writeln!(out, "{:16} {} W, {share:.1} %: {}", "", shown.text(part.name, 1.0, 4), part.words)?;
    }
    Ok(())
}

/// Balance of losses.
fn write_closed(out: &mut String, closed: &Closed) -> std::fmt::Result {
    closed.lines().into_iter().try_for_each(|line| writeln!(out, "{:16} {line}", ""))
}

/// Effects that the creep law of the scene misses.
fn write_law(out: &mut String, scene: &Scene) -> std::fmt::Result {
    let (law, slip) = (scene.effects.creep.law, scene.effects.groove_slip.on);
    let Some(missing) = law.misses(slip) else {
        return Ok(());
    };
    let (name, with): (&str, _) = (law.into(), if slip { " with groove slip" } else { "" });
    writeln!(out, "creep law        {name}{with} {missing} (default: kalker_table with heathcote_slip)")
}

/// Whether the means have settled.
fn write_settled(out: &mut String, means: &Means) -> std::fmt::Result {
    write_settled_of_all(out, [(None, Some(means))].into_iter())
}

/// Whether the means of several bearings and of the shaft that carries them have settled; names stand before what has not.
fn write_settled_of_all<'a>(
    out: &mut String,
    all: impl Iterator<Item = (Option<&'a str>, Option<&'a Means>)>,
) -> std::fmt::Result {
    let all: Vec<_> = all.filter_map(|(name, means)| Some((name, means?))).collect();
    if let Some((_, means)) = all.iter().find(|(_, means)| means.scripted) {
        let [begin, end] = means.window.map(|time| time * 1e3);
        writeln!(
            out,
            "NOT SETTLED      the script changes between {begin:.3} and {end:.3} ms: means are over what it passes through"
        )?;
    } else if all.iter().any(|(_, means)| !means.can_tell()) {
        return writeln!(
            out,
            "settled?         too few steps to tell: a longer load.duration, or a smaller solver.max_step, has more"
        );
    }
    if all.iter().any(|(_, means)| means.unstable) {
        writeln!(
            out,
            "NOT SETTLED      a motion grows, or is beyond what loads explain: means are those of this motion"
        )?;
    }
    if all.iter().all(|(_, means)| means.settled() == Some(true)) {
        return writeln!(
            out,
            "settled          all means: no drift beyond noise or {NEGLIGIBLE} of their size"
        );
    }
    for (name, means) in &all {
        let name = name.map_or(String::new(), |name| format!("{name}: "));
        for (mean, trend) in means.unsettled() {
            writeln!(
                out,
                "NOT SETTLED      {name}{}: {:.5e} {}, drifts by {:.2e}, noise {:.1e}",
                mean.name, mean.mean, mean.unit, trend.drift, trend.noise
            )?;
        }
    }
    if all.iter().any(|(_, means)| means.scripted || means.unstable) {
        return Ok(());
    }
    let needed = all.iter().try_fold(0.0, |longest, (_, means)| Some(f64::max(longest, means.needed()?)));
    match needed {
        Some(needed) => {
            writeln!(out, "                 load.duration of about {:.4} s would settle them", needed)
        }
        None => writeln!(
            out,
            "                 no decay to be seen: more than twice the duration, or they never settle"
        ),
    }
}

/// Limits that a run met.
fn write_limits(out: &mut String, limits: &Limits, shown: &Shown) -> std::fmt::Result {
    limits.met().try_for_each(|limit| {
        let (factor, digits) = limit.shown;
        let texts = limit.quantities.iter().map(|quantity| shown.text(quantity.name, factor, digits));
        writeln!(out, "{:<16} {}", limit.title, (limit.line)(&texts.collect::<Vec<_>>()))
    })
}

fn write_bearing(
    out: &mut String,
    run: &Played,
    (simulation, seen): (&Simulation, &BearingSeen),
    shown: &Shown,
    verdicts: &Verdicts,
) -> std::fmt::Result {
    let BearingSeen { part, spectrum, energy, limits, .. } = seen;
    let means = &part.means;
    let now = simulation.outputs();
    let text = |name: &str, factor, digits| shown.text(name, factor, digits);
    let range = |[least, most]: [&str; 2]| format!("{} to {}", text(least, 1.0, 3), text(most, 1.0, 3));
    let vector = |name: &str, factor, digits| {
        let [x, y, z] = ["x", "y", "z"].map(|axis| text(&format!("end {name}.{axis}"), factor, digits));
        format!("x {x}  y {y}  z {z}")
    };
    let race = Race::loaded(simulation.scene()).name();
    let title = &simulation.scene().title;
    if !title.is_empty() {
        writeln!(out, "{title}")?;
    }
    writeln!(out, "at {:.3} ms", now.time * 1e3)?;
    writeln!(
        out,
        "bearing's force  {} N   (of the bearing on the {race} race; the external load is the opposite,",
        vector("force", 1.0, 3)
    )?;
    writeln!(out, "bearing's moment {} N m   but for what accelerates the race)", vector("moment", 1.0, 5))?;
    writeln!(out, "{race} race at    {} um", vector("position", 1e6, 4))?;
    writeln!(
        out,
        "ball loads       inner {} N, outer {} N",
        range(["least inner load", "largest inner load"]),
        range(["least outer load", "largest outer load"])
    )?;
    writeln!(
        out,
        "contact angles   inner {} deg, outer {} deg",
        range(["least inner angle", "largest inner angle"]),
        range(["least outer angle", "largest outer angle"])
    )?;
    write_limits(out, limits, shown)?;
    if now.cage.is_some() {
        writeln!(out, "cage centre      {} um off axis", text("end eccentricity", 1e6, 3))?;
    }
    if let Some(means) = means {
        write_means(out, (means, seen.part.closed.as_ref()), shown, now.cage.is_some())?;
        if let Some(PerTurn { turns, mean, largest }) = &seen.entering {
            writeln!(
                out,
                "entering balls   {mean:.3} W of load times slip speed, the mean over {turns} turns of the largest of each; at most {largest:.3} W"
            )?;
        }
        if let Some(life) = &seen.life {
            phases::say_life(out, "life             ", life)?;
            writeln!(out)?;
        }
        write_law(out, simulation.scene())?;
        if let Some(cage) = &simulation.model().cage
            && means.largest[0] < CENTRED * cage.play()
        {
            writeln!(
                out,
                "cage             is pushed by nothing here and stays at the centre, as all is symmetric: `roulement cage` pushes it"
            )?;
        }
        write_settled(out, means)?;
    }
    seen.part.phases.iter().try_for_each(|phase| phases::say(out, phase, shown))?;
    for (row, value) in headlines(simulation) {
        writeln!(out, "{:<16} {value:.5e} {} at the end: {}", row.name, row.unit.name, row.description)?;
    }
    match spectrum {
        Some(spectrum) => write!(out, "{spectrum}")?,
        None if is_wanted(simulation.scene()) => {
            writeln!(out, "spectrum         none: fewer than 16 rows in the second half")?;
        }
        None => {}
    }
    writeln!(
        out,
        "energy           work {} J, lost {} J, stored {} J, balance {:.2e} J",
        text("work", 1.0, 5),
        text("lost", 1.0, 5),
        text("stored", 1.0, 5),
        energy.balance(now)
    )?;
    let circling = seen.circling.as_ref().map(Circling::warning);
    let alarms = seen.alarms.iter().map(|alarm| alarm.text(""));
    for warning in
        seen.part.growing.iter().cloned().chain(alarms).chain(circling).chain(energy.warning(simulation))
    {
        writeln!(out, "WARNING          {warning}")?;
    }
    if shown.bars.is_none() {
        write_unmeasured(out)?;
    }
    for line in &simulation.scene().effects.auto.found {
        writeln!(out, "found out        {}", line.trim_start_matches("auto: "))?;
    }
    for line in idle_in(verdicts, limits) {
        writeln!(out, "did not matter   {line}")?;
    }
    let s = &now.statistics;
    let steps = s.steps.max(1) as f64;
    writeln!(
        out,
        "steps            {} accepted, {} rejected by error, {} by Newton",
        s.steps, s.rejected_error, s.rejected_newton
    )?;
    writeln!(
        out,
        "Newton           {} iterations ({:.2} a step), {} factorisations",
        s.newton.iterations,
        s.newton.iterations as f64 / steps,
        s.newton.factorisations
    )?;
    writeln!(out, "contacts         {} values, {} with derivatives", s.contact_values, s.contact_tangents)?;
    if s.polynomials > 0 {
        writeln!(
            out,
            "polynomials      {} solutions, {} without convergence",
            s.polynomials, s.polynomial_failures
        )?;
    }
    write_wall(out, run, now.time - energy.begin())
}
