//! Summary that `roulement run` prints at the end.

use std::fmt::Write;

use roulement::analysis::estimate::Verdicts;
use roulement::model::bodies::Race;
use roulement::scene::Scene;
use roulement_cli::report::figures::Shown;
use roulement_cli::report::limits::Limits;
use roulement_cli::report::means::{Means, NEGLIGIBLE};
use roulement_cli::report::spectrum::is_wanted;
use roulement_cli::watch::Seen;

use super::effects::idle_in;
use super::player::Played;

/// Summary of a run, with error bars where figures have them.
pub fn summary(run: &Played, shown: &Shown, verdicts: &Verdicts) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_summary(&mut text, run, shown, verdicts);
    text
}

/// Means over the window.
fn write_means(out: &mut String, means: &Means, shown: &Shown, has_cage: bool) -> std::fmt::Result {
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
    writeln!(out, "friction power   {} W", text("friction power", 1.0, 4))?;
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

/// What the creep law of the scene misses.
fn write_law(out: &mut String, scene: &Scene) -> std::fmt::Result {
    let (law, slip) = (scene.effects.creep.law, scene.effects.groove_slip.on);
    let Some(missing) = law.misses(slip) else {
        return Ok(());
    };
    let (name, with): (&str, _) = (law.into(), if slip { " with groove slip" } else { "" });
    writeln!(out, "creep law        {name}{with} {missing} (default: kalker_table with heathcote_slip)")
}

/// Said of runs in which bodies strike each other.
const BLOWS: &str = "\n                 balls without a cage or the cage strike now and then: powers at blows are further off";

/// Whether the means have settled.
fn write_settled(out: &mut String, means: &Means) -> std::fmt::Result {
    if !means.can_tell() {
        return writeln!(out, "settled?         too few rows to tell: lower load.output_interval");
    }
    if means.unsettled().next().is_none() {
        return writeln!(
            out,
            "settled          all means: no drift beyond noise or {NEGLIGIBLE} of their size"
        );
    }
    for (mean, trend) in means.unsettled() {
        writeln!(
            out,
            "NOT SETTLED      {}: {:.5e} {}, drifts by {:.2e}, noise {:.1e}",
            mean.name, mean.mean, mean.unit, trend.drift, trend.noise
        )?;
    }
    match means.needed() {
        Some(needed) => {
            writeln!(out, "                 load.duration of about {:.4} s would settle them", needed)
        }
        None => writeln!(
            out,
            "                 no decay to be seen: more than twice the duration, or they never settle"
        ),
    }
}

/// What a run met of shoulders and neighbouring balls; nothing where it met none.
fn write_limits(out: &mut String, limits: &Limits, shown: &Shown) -> std::fmt::Result {
    if limits.over_shoulders != [0.0; 2] {
        let [inner, outer] =
            ["over inner shoulders", "over outer shoulders"].map(|name| shown.text(name, 100.0, 2));
        writeln!(out, "over shoulders   inner up to {inner} %, outer up to {outer} % of a load")?;
    }
    if limits.between_balls > 0.0 {
        let largest = shown.text("between balls", 1.0, 3);
        writeln!(out, "between balls    up to {largest} N: they touch, as no cage keeps them apart")?;
    }
    Ok(())
}

fn write_summary(out: &mut String, run: &Played, shown: &Shown, verdicts: &Verdicts) -> std::fmt::Result {
    let Played { simulation, seen, wall, .. } = run;
    let Seen { means, spectrum, energy, limits, estimate, .. } = seen;
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
        write_means(out, means, shown, now.cage.is_some())?;
        write_law(out, simulation.scene())?;
        write_settled(out, means)?;
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
    if let Some(warning) = energy.warning(simulation) {
        writeln!(out, "WARNING          {warning}")?;
    }
    if let (None, Some([histories, means])) = (&shown.bars, estimate.errors(simulation)) {
        writeln!(
            out,
            "error, estimate  histories {histories:.0e}, means {means:.0e} of their size, within a factor of ten or so, and no \
             promise: --error measures it{}",
            if estimate.has_blows() { BLOWS } else { "" }
        )?;
    }
    for line in idle_in(verdicts, limits.over_shoulders != [0.0; 2]) {
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
    let seconds = wall.as_secs_f64();
    let simulated = now.time - energy.begin();
    writeln!(out, "wall time        {seconds:.3} s, {:.2} s per simulated second", seconds / simulated)
}
