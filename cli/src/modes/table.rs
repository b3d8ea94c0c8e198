//! Small motions as text, JSON and CSV.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::io;

use serde_json::{Value, json};

use super::{Found, Meeting, Modes, Row, meetings};

/// Motions of a row of the text that are shown: those that matter lie low.
const SHOWN: usize = 6;

/// Meetings of lines and motions that the text has.
const TOLD: usize = 16;

/// \[rpm] of a speed [rad/s].
pub(super) fn rpm(speed: f64) -> f64 {
    speed * 60.0 / TAU
}

/// As text.
pub fn to_text(modes: &Modes) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut text, modes);
    text
}

fn write(out: &mut String, modes: &Modes) -> std::fmt::Result {
    if !modes.title.is_empty() {
        writeln!(out, "{}", modes.title)?;
    }
    let Row { speed, after, motions } = &modes.own;
    if modes.freed {
        writeln!(
            out,
            "balls are free here, as in pockets with play: the scene's ideal cage holds them, and changes what a ring does by micrometres"
        )?;
        for Found { motion, .. } in &modes.held {
            writeln!(
                out,
                "with balls held by that cage, as in a run: {:.2} Hz {:.2} 1/s GROWS: {}",
                motion.frequency, motion.growth, motion.shape
            )?;
        }
    }
    writeln!(
        out,
        "motions at {:.2} rpm, {} to {} ms after the start: frequency, growth (+- half its range there)",
        rpm(*speed),
        1e3 * after,
        2e3 * after
    )?;
    match motions {
        Err(why) => writeln!(out, "  {why}")?,
        Ok(motions) if motions.is_empty() => writeln!(out, "  none: nothing is free to move")?,
        Ok(motions) => {
            for found in motions {
                let motion = &found.motion;
                let grows = if found.grows() { "GROWS" } else { "" };
                let spread = found.spread.map_or("unsteady".into(), |spread| format!("+-{spread:8.2}"));
                writeln!(
                    out,
                    "{:>12.2} Hz {:>10.2} {spread} 1/s {grows:<5} damping {:8.5}, {:4.1} % of balls: {}",
                    motion.frequency,
                    motion.growth,
                    motion.damping(),
                    100.0 * motion.balls,
                    motion.shape
                )?;
            }
        }
    }
    if modes.rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nspeed [rpm]    frequency [Hz] and growth [1/s]: * grows")?;
    for Row { speed, motions, .. } in &modes.rows {
        match motions {
            Err(why) => writeln!(out, "{:>11.1}    {why}", rpm(*speed))?,
            Ok(motions) => {
                let one = |found: &Found| {
                    let mark = if found.grows() { "*" } else { " " };
                    format!("{:9.2} {:+9.1}{mark}", found.motion.frequency, found.motion.growth)
                };
                let shown: Vec<String> = motions.iter().take(SHOWN).map(one).collect();
                writeln!(out, "{:>11.1}    {}", rpm(*speed), shown.join(" "))?;
            }
        }
    }
    let grows = |row: &&Row| row.motions.as_ref().is_ok_and(|motions| motions.iter().any(Found::grows));
    match modes.rows.iter().find(grows) {
        Some(row) => writeln!(out, "\nfirst growth in this table at {:.1} rpm", rpm(row.speed))?,
        None => writeln!(out, "\nnothing grows at any speed of this table")?,
    }
    write_meetings(out, &meetings(&modes.lines, &modes.rows))
}

fn write_meetings(out: &mut String, met: &[Meeting]) -> std::fmt::Result {
    if met.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nturns and teeth meet motions of little damping (up to 10 %):")?;
    // Teeth themselves before their multiples.
    let mut met: Vec<&Meeting> = met.iter().collect();
    met.sort_by_key(|meeting| meeting.multiple);
    for Meeting { line, multiple, speed, frequency, damping, shape } in met.iter().take(TOLD) {
        let times = if *multiple == 1 { String::new() } else { format!("{multiple} x ") };
        writeln!(
            out,
            "{:>11.1} rpm {frequency:9.2} Hz, damping {damping:7.5}: {times}{line} meets {shape}",
            rpm(*speed)
        )?;
    }
    match met.len().saturating_sub(TOLD) {
        0 => Ok(()),
        more => writeln!(
            out,
            "            and {more} more, of multiples of teeth or at higher speeds: --json has all of them"
        ),
    }
}

/// As JSON.
pub fn to_json(modes: &Modes) -> Value {
    let motion = |found: &Found| {
        let motion = &found.motion;
        json!({
            "frequency": motion.frequency,
            "growth": motion.growth,
            "growth_spread": found.spread,
            "damping": motion.damping(),
            "balls": motion.balls,
            "grows": found.grows(),
            "shape": motion.shape,
        })
    };
    let row = |Row { speed, after, motions }: &Row| {
        json!({
            "speed": speed,
            "after": after,
            "motions": motions.as_ref().ok().map(|motions| motions.iter().map(motion).collect::<Vec<_>>()),
            "error": motions.as_ref().err(),
        })
    };
    json!({
        "title": modes.title,
        "balls_freed": modes.freed,
        "growing_in_ideal_cage": modes.held.iter().map(motion).collect::<Vec<_>>(),
        "own": row(&modes.own),
        "speeds": modes.rows.iter().map(row).collect::<Vec<_>>(),
        "lines": modes.lines.iter().map(|line| json!({ "name": line.name, "per_turn": line.per_turn })).collect::<Vec<_>>(),
        "meetings": meetings(&modes.lines, &modes.rows).into_iter().map(|met| json!({
            "line": met.line,
            "multiple": met.multiple,
            "speed": met.speed,
            "frequency": met.frequency,
            "damping": met.damping,
            "shape": met.shape,
        })).collect::<Vec<_>>(),
    })
}

/// As CSV: a line for each motion at each speed.
///
/// # Errors
/// If a number cannot be written.
pub fn to_csv(modes: &Modes) -> io::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(vec![]);
    table.write_record([
        "speed [rpm]",
        "frequency [Hz]",
        "growth [1/s]",
        "spread of growth [1/s]",
        "damping [-]",
        "share of balls [-]",
        "grows",
        "shape",
    ])?;
    for Row { speed, motions, .. } in std::iter::once(&modes.own).chain(&modes.rows) {
        for found in motions.iter().flatten() {
            let motion = &found.motion;
            table.write_record([
                format!("{:?}", rpm(*speed)),
                format!("{:?}", motion.frequency),
                format!("{:?}", motion.growth),
                found.spread.map_or(String::new(), |spread| format!("{spread:?}")),
                format!("{:?}", motion.damping()),
                format!("{:?}", motion.balls),
                found.grows().to_string(),
                motion.shape.clone(),
            ])?;
        }
    }
    table.into_inner().map_err(|why| io::Error::other(why.to_string()))
}
