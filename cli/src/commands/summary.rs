//! Summary that `roulement run` prints at the end.

use std::fmt::Write;
use std::time::Duration;

use roulement::model::bodies::Race;
use roulement::simulation::Simulation;
use roulement_cli::report::energy::EnergyWatch;
use roulement_cli::report::limits::Limits;
use roulement_cli::report::means::{Means, NEGLIGIBLE};

/// A run that has ended.
pub struct Run<'a> {
    /// The bearing at the end.
    pub simulation: &'a Simulation,
    /// Means over the second half.
    pub means: Option<&'a Means>,
    /// Its energy.
    pub energy: &'a EnergyWatch,
    /// Limits of the bearing that it met.
    pub limits: &'a Limits,
    /// Time that it took.
    pub wall: Duration,
}

/// Summary of a run.
pub fn summary(run: &Run<'_>) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_summary(&mut text, run);
    text
}

/// Means, and whether they have settled.
fn write_means(out: &mut String, means: &Means, has_cage: bool) -> std::fmt::Result {
    let [begin, end] = means.window;
    writeln!(out, "means over the last {:.3} ms", (end - begin) * 1e3)?;
    writeln!(
        out,
        "cage speed       {:.4} rad/s, {:.4} % below epicyclic; balls {:.4} %",
        means.of("cage speed"),
        means.of("cage slip") * 100.0,
        means.of("ball slip") * 100.0
    )?;
    writeln!(out, "friction power   {:.4} W", means.of("friction power"))?;
    writeln!(
        out,
        "per ball         inner {:.4} mW, outer {:.4} mW",
        means.of("inner power per ball") * 1e3,
        means.of("outer power per ball") * 1e3
    )?;
    if has_cage {
        let [eccentricity, pocket, land] = means.largest;
        writeln!(out, "cage centre      at most {:.3} um off axis", eccentricity * 1e6)?;
        writeln!(out, "largest load     pocket {pocket:.3} N, land {land:.3} N")?;
        writeln!(
            out,
            "cage friction    pockets {:.4} W, lands {:.4} W",
            means.of("pocket power"),
            means.of("land power")
        )?;
    }
    writeln!(out, "friction torque  {:.5} N m", means.of("friction torque"))?;
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
fn write_limits(out: &mut String, limits: &Limits) -> std::fmt::Result {
    if limits.over_shoulders != [0.0; 2] {
        let [inner, outer] = limits.over_shoulders.map(|share| share * 100.0);
        writeln!(out, "over shoulders   inner up to {inner:.2} %, outer up to {outer:.2} % of a load")?;
    }
    if limits.between_balls > 0.0 {
        let largest = limits.between_balls;
        writeln!(out, "between balls    up to {largest:.3} N: they touch, as no cage keeps them apart")?;
    }
    Ok(())
}

fn write_summary(out: &mut String, run: &Run<'_>) -> std::fmt::Result {
    let Run { simulation, means, energy, limits, wall } = run;
    let now = simulation.outputs();
    let loaded = Race::loaded(simulation.scene());
    let (force, moment) = (now[loaded].wrench.force, now[loaded].wrench.moment);
    let position = now[loaded].pose.position * 1e6;
    let race = loaded.name();
    let title = &simulation.scene().title;
    if !title.is_empty() {
        writeln!(out, "{title}")?;
    }
    writeln!(out, "at {:.3} ms", now.time * 1e3)?;
    writeln!(
        out,
        "bearing's force  x {:.3}  y {:.3}  z {:.3} N   (of the bearing on the {race} race; the external load is the opposite,",
        force.x, force.y, force.z
    )?;
    writeln!(
        out,
        "bearing's moment x {:.5}  y {:.5}  z {:.5} N m   but for what accelerates the race)",
        moment.x, moment.y, moment.z
    )?;
    writeln!(out, "{race} race at    x {:.4}  y {:.4}  z {:.4} um", position.x, position.y, position.z)?;
    let extremes = |get: fn(&roulement::simulation::outputs::BallOutput) -> f64| {
        let values = now.balls.iter().map(get);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        format!("{low:.3} to {high:.3}")
    };
    writeln!(
        out,
        "ball loads       inner {} N, outer {} N",
        extremes(|b| b.inner.load),
        extremes(|b| b.outer.load)
    )?;
    writeln!(
        out,
        "contact angles   inner {} deg, outer {} deg",
        extremes(|b| b.inner.contact_angle.to_degrees()),
        extremes(|b| b.outer.contact_angle.to_degrees())
    )?;
    write_limits(out, limits)?;
    if let Some(cage) = &now.cage {
        writeln!(out, "cage centre      {:.3} um off axis", cage.eccentricity.yz().norm() * 1e6)?;
    }
    if let Some(means) = means {
        write_means(out, means, now.cage.is_some())?;
    }
    let balance = energy.balance(now);
    writeln!(
        out,
        "energy           work {:.5} J, lost {:.5} J, stored {:.5} J, balance {balance:.2e} J",
        now.work, now.dissipated, now.stored_energy
    )?;
    if let Some(warning) = energy.warning(simulation) {
        writeln!(out, "WARNING          {warning}")?;
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
