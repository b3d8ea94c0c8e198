//! Summary that `roulement run` prints at the end.

use std::fmt::Write;
use std::time::Duration;

use roulement::contact::shoulder::largest_share;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::{CageOutput, Outputs};

/// Summary of a finished run; means are over the second half.
pub fn summary(simulation: &Simulation, history: &[Outputs], wall: Duration) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_summary(&mut text, simulation, history, wall);
    text
}

/// What a run met of shoulders and neighbouring balls; nothing where it met none.
fn write_limits(out: &mut String, history: &[Outputs]) -> std::fmt::Result {
    let contacts = |outputs: &Outputs| {
        [
            largest_share(outputs.balls.iter().map(|ball| (ball.inner.load, ball.inner.shoulder_share))),
            largest_share(outputs.balls.iter().map(|ball| (ball.outer.load, ball.outer.shoulder_share))),
        ]
    };
    let most = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].max(b[1])];
    let over = history.iter().map(contacts).fold([0.0; 2], most);
    if over != [0.0; 2] {
        let [inner, outer] = over.map(|share| share * 100.0);
        writeln!(out, "over shoulders   inner up to {inner:.2} %, outer up to {outer:.2} % of a load")?;
    }
    let loads = history.iter().filter_map(|outputs| outputs.neighbours).map(|n| n.largest_load);
    let largest = loads.fold(0.0, f64::max);
    if largest > 0.0 {
        writeln!(out, "between balls    up to {largest:.3} N: they touch, as no cage keeps them apart")?;
    }
    Ok(())
}

fn write_summary(
    out: &mut String,
    simulation: &Simulation,
    history: &[Outputs],
    wall: Duration,
) -> std::fmt::Result {
    let half = &history[history.len() / 2..];
    let mean = |get: fn(&Outputs) -> f64| half.iter().map(get).sum::<f64>() / half.len() as f64;
    let now = simulation.outputs();
    let (force, moment) = (now.inner.wrench.force, now.inner.wrench.moment);
    let position = now.inner.pose.position * 1e6;
    let title = &simulation.scene().title;
    if !title.is_empty() {
        writeln!(out, "{title}")?;
    }
    writeln!(out, "at {:.3} ms", now.time * 1e3)?;
    writeln!(out, "force on inner   x {:.3}  y {:.3}  z {:.3} N", force.x, force.y, force.z)?;
    writeln!(out, "moment on inner  x {:.5}  y {:.5}  z {:.5} N m", moment.x, moment.y, moment.z)?;
    writeln!(out, "inner race at    x {:.4}  y {:.4}  z {:.4} um", position.x, position.y, position.z)?;
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
    write_limits(out, history)?;
    writeln!(out, "means over the last {:.3} ms", (now.time - half[0].time) * 1e3)?;
    let slip = mean(|o| o.cage_slip);
    writeln!(
        out,
        "cage speed       {:.4} rad/s, {:.4} % below epicyclic",
        mean(|o| o.cage_speed),
        slip * 100.0
    )?;
    writeln!(out, "friction power   {:.4} W", mean(|o| o.friction_power))?;
    let inner = mean(|o| o.balls.iter().map(|b| b.inner.power).sum::<f64>() / o.balls.len() as f64);
    let outer = mean(|o| o.balls.iter().map(|b| b.outer.power).sum::<f64>() / o.balls.len() as f64);
    writeln!(out, "per ball         inner {:.4} mW, outer {:.4} mW", inner * 1e3, outer * 1e3)?;
    if let Some(cage) = &now.cage {
        let mean = |get: fn(&CageOutput) -> f64| {
            half.iter().filter_map(|o| o.cage.as_ref()).map(get).sum::<f64>() / half.len() as f64
        };
        let largest = |get: fn(&Outputs) -> f64| half.iter().map(get).fold(0.0, f64::max);
        let radius = |o: &Outputs| o.cage.map_or(0.0, |cage| cage.eccentricity.yz().norm());
        writeln!(
            out,
            "cage centre      off axis {:.3} um, at most {:.3} um",
            cage.eccentricity.yz().norm() * 1e6,
            largest(radius) * 1e6
        )?;
        let pocket = |o: &Outputs| {
            o.balls.iter().filter_map(|b| b.pocket).map(|pocket| pocket.load).fold(0.0, f64::max)
        };
        let land = |o: &Outputs| o.cage.map_or(0.0, |cage| cage.land_loads[0].max(cage.land_loads[1]));
        writeln!(out, "largest load     pocket {:.3} N, land {:.3} N", largest(pocket), largest(land))?;
        writeln!(
            out,
            "cage friction    pockets {:.4} W, lands {:.4} W",
            mean(|c| c.pocket_power),
            mean(|c| c.land_power)
        )?;
    }
    writeln!(out, "friction torque  {:.5} N m", mean(|o| o.friction_torque))?;
    let balance = now.work - now.dissipated - (now.stored_energy - history[0].stored_energy);
    writeln!(
        out,
        "energy           work {:.5} J, lost {:.5} J, stored {:.5} J, balance {balance:.2e} J",
        now.work, now.dissipated, now.stored_energy
    )?;
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
    let simulated = now.time - history[0].time;
    writeln!(out, "wall time        {seconds:.3} s, {:.2} s per simulated second", seconds / simulated)
}
