//! What excites a machine while it turns: turns of its shafts, teeth that come into mesh, cage and damage of its bearings, as multiples of the turns of its first shaft.

use std::f64::consts::TAU;

use roulement::simulation::machine::Machine;

use super::{Found, Row};

/// [rad/s] speed below which nothing turns.
const STANDS: f64 = 1e-9;

/// What a line is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Turns of a shaft.
    Turn,
    /// Teeth of a mesh.
    Mesh,
    /// Cage or balls of a bearing.
    Bearing,
}

/// A frequency that goes with the speed.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its name: that of the shaft or the mesh, or `BPFO left`.
    pub name: String,
    /// What it is of.
    pub source: Source,
    /// [-] its frequency over the turns of the first shaft, or of the race that turns fastest.
    pub per_turn: f64,
}

/// Lines of a machine as it turns; none where it does not.
pub fn of(machine: &Machine) -> Vec<Line> {
    let line = |name: String, source, per_turn: f64| Line { name, source, per_turn: per_turn.abs() };
    let mut lines = vec![];
    let turn = match machine {
        Machine::Bearing(bearing) => {
            let inputs = bearing.inputs();
            let fastest = inputs.inner.speed.abs().max(inputs.outer.speed.abs());
            lines.push(line("the turn".into(), Source::Turn, 1.0));
            fastest
        }
        Machine::Shaft(system) => {
            let (scene, outputs) = (system.scene(), system.outputs());
            let speeds: Vec<f64> = outputs.shafts.iter().map(|shaft| shaft.spin.speed).collect();
            let first = speeds[0].abs();
            for (shaft, speed) in scene.shafts.iter().zip(&speeds) {
                let name = if scene.shafts.len() == 1 { "the turn".into() } else { shaft.name.clone() };
                lines.push(line(name, Source::Turn, speed / first));
            }
            for mesh in &scene.meshes {
                let teeth = f64::from(mesh.section.gears[0].teeth);
                lines.push(line(
                    mesh.section.name.clone(),
                    Source::Mesh,
                    teeth * speeds[mesh.shafts[0]] / first,
                ));
            }
            first
        }
    };
    if turn < STANDS {
        return vec![];
    }
    for (name, bearing) in machine.bearings() {
        let of = &bearing.outputs().frequencies;
        for (what, frequency) in [("FTF", of.cage), ("BPFO", of.outer), ("BPFI", of.inner), ("BSF", of.ball)]
        {
            let name = if name.is_empty() { what.to_string() } else { format!("{what} {name}") };
            lines.push(line(name, Source::Bearing, frequency * TAU / turn));
        }
    }
    lines.retain(|line| line.per_turn > 0.0);
    lines
}

/// [-] largest damping of a motion that a line excites enough to be told of.
const LIGHTLY: f64 = 0.1;
/// [-] frequencies of one motion at two speeds of the table differ by less.
const SAME: f64 = 0.1;
/// [-] multiples of a mesh that are looked at, and drawn.
pub const MULTIPLES: u32 = 3;

impl Line {
    /// [-] multiples of it that are looked at.
    pub fn multiples(&self) -> u32 {
        if self.source == Source::Mesh { MULTIPLES } else { 1 }
    }
}

/// Where a line meets a motion that decays slowly, or grows.
#[derive(Clone, Debug)]
pub struct Meeting {
    /// Name of the line.
    pub line: String,
    /// [-] its multiple.
    pub multiple: u32,
    /// [rad/s] speed of the first shaft.
    pub speed: f64,
    /// \[Hz] frequency.
    pub frequency: f64,
    /// [-] damping of the motion.
    pub damping: f64,
    /// The motion in words.
    pub shape: String,
}

/// Where lines of shafts and meshes meet motions between two speeds of a table, by growing speed.
pub fn meetings(lines: &[Line], rows: &[Row]) -> Vec<Meeting> {
    let mut found = vec![];
    for pair in rows.windows(2) {
        let [Ok(here), Ok(there)] = [&pair[0].motions, &pair[1].motions] else { continue };
        for one in here {
            let (motion, away) =
                (&one.motion, |other: &Found| (other.motion.frequency - one.motion.frequency).abs());
            let next = there.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
            let Some(next) = next.filter(|next| away(next) < SAME * motion.frequency) else { continue };
            if motion.damping() > LIGHTLY {
                continue;
            }
            for line in lines.iter().filter(|line| line.source != Source::Bearing) {
                for multiple in 1..=line.multiples() {
                    let beyond = |row: &Row, frequency: f64| {
                        f64::from(multiple) * line.per_turn * row.speed / TAU - frequency
                    };
                    let [before, after] =
                        [beyond(&pair[0], motion.frequency), beyond(&pair[1], next.motion.frequency)];
                    if before > 0.0 || after <= 0.0 {
                        continue;
                    }
                    let part = before / (before - after);
                    let between = |from: f64, to: f64| from + part * (to - from);
                    found.push(Meeting {
                        line: line.name.clone(),
                        multiple,
                        speed: between(pair[0].speed, pair[1].speed),
                        frequency: between(motion.frequency, next.motion.frequency),
                        damping: between(motion.damping(), next.motion.damping()),
                        shape: motion.shape.clone(),
                    });
                }
            }
        }
    }
    found.sort_by(|one, other| one.speed.total_cmp(&other.speed));
    found
}

#[cfg(test)]
mod tests {
    use roulement::simulation::motions::Motion;

    use super::*;

    #[test]
    fn closed_form_lines_meet_motions_at_their_frequency_over_the_multiple() {
        let found = |frequency: f64, growth: f64| Found {
            motion: Motion { frequency, growth, balls: 0.0, rolled_over: 10.0, shape: "swings".into() },
            spread: Some(0.0),
            held: false,
        };
        // One that softens by 1 Hz from row to row, one that is damped away, one out of reach.
        let row = |k: u32| Row {
            speed: 10.0 * f64::from(k) * TAU,
            after: 0.0,
            motions: Ok(vec![found(200.0 - f64::from(k), -10.0), found(300.0, -900.0), found(9000.0, -1.0)]),
        };
        let rows: Vec<Row> = (1..=3).map(row).collect();
        let line = |name: &str, source, per_turn| Line { name: name.into(), source, per_turn };
        let lines = [
            line("gears", Source::Mesh, 8.0),
            line("shaft", Source::Turn, 1.0),
            line("BPFO", Source::Bearing, 8.0),
        ];
        let met = meetings(&lines, &rows);
        let seen: Vec<(&str, u32)> = met.iter().map(|one| (one.line.as_str(), one.multiple)).collect();
        assert_eq!(seen, [("gears", 2), ("gears", 1)]);
        for (one, multiple) in met.iter().zip([2.0, 1.0]) {
            // 8 n = 200 - n/10 with n turns a second.
            let turns = 200.0 / (8.0 * multiple + 0.1);
            assert!(
                (one.speed / TAU - turns).abs() < 1e-9
                    && (one.frequency - (200.0 - 0.1 * turns)).abs() < 1e-9
            );
        }
    }
}
