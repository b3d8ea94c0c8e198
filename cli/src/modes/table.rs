//! Small motions as text, JSON and CSV.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::io;

use roulement::simulation::motions::Motion;
use serde_json::{Value, json};

use super::{Modes, Row};

/// Motions of a row of the text that are shown: those that matter lie low.
const SHOWN: usize = 6;

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
    let Row { speed, motions } = &modes.own;
    writeln!(out, "motions at {:.2} rpm, after {} ms", rpm(*speed), 1e3 * modes.after)?;
    match motions {
        Err(why) => writeln!(out, "  {why}")?,
        Ok(motions) if motions.is_empty() => writeln!(out, "  none: nothing is free to move")?,
        Ok(motions) => {
            for motion in motions {
                let Motion { frequency, growth, balls, shape } = motion;
                let grows = if motion.grows() { "GROWS" } else { "" };
                writeln!(
                    out,
                    "{frequency:>12.2} Hz {growth:>11.2} 1/s  {grows:<5}  damping {:8.5}, {:5.1} % of balls: {shape}",
                    motion.damping(),
                    100.0 * balls
                )?;
            }
        }
    }
    if modes.rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nspeed [rpm]    frequency [Hz] and growth [1/s]: * grows")?;
    for Row { speed, motions } in &modes.rows {
        match motions {
            Err(why) => writeln!(out, "{:>11.1}    {why}", rpm(*speed))?,
            Ok(motions) => {
                let one = |motion: &Motion| {
                    let mark = if motion.grows() { "*" } else { " " };
                    format!("{:9.2} {:+9.1}{mark}", motion.frequency, motion.growth)
                };
                let shown: Vec<String> = motions.iter().take(SHOWN).map(one).collect();
                writeln!(out, "{:>11.1}    {}", rpm(*speed), shown.join(" "))?;
            }
        }
    }
    let grows = |row: &&Row| row.motions.as_ref().is_ok_and(|motions| motions.iter().any(Motion::grows));
    match modes.rows.iter().find(grows) {
        Some(row) => writeln!(out, "\nfirst growth in this table at {:.1} rpm", rpm(row.speed)),
        None => writeln!(out, "\nnothing grows at any speed of this table"),
    }
}

/// As JSON.
pub fn to_json(modes: &Modes) -> Value {
    let row = |Row { speed, motions }: &Row| {
        let motion = |motion: &Motion| {
            json!({
                "frequency": motion.frequency,
                "growth": motion.growth,
                "damping": motion.damping(),
                "balls": motion.balls,
                "grows": motion.grows(),
                "shape": motion.shape,
            })
        };
        json!({
            "speed": speed,
            "motions": motions.as_ref().ok().map(|motions| motions.iter().map(motion).collect::<Vec<_>>()),
            "error": motions.as_ref().err(),
        })
    };
    json!({
        "title": modes.title,
        "after": modes.after,
        "own": row(&modes.own),
        "speeds": modes.rows.iter().map(row).collect::<Vec<_>>(),
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
        "damping [-]",
        "share of balls [-]",
        "grows",
        "shape",
    ])?;
    for Row { speed, motions } in std::iter::once(&modes.own).chain(&modes.rows) {
        for motion in motions.iter().flatten() {
            table.write_record([
                format!("{:?}", rpm(*speed)),
                format!("{:?}", motion.frequency),
                format!("{:?}", motion.growth),
                format!("{:?}", motion.damping()),
                format!("{:?}", motion.balls),
                motion.grows().to_string(),
                motion.shape.clone(),
            ])?;
        }
    }
    table.into_inner().map_err(|why| io::Error::other(why.to_string()))
}
