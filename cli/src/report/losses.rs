//! Do losses close? What torque times speed brings over the window of means, against what is lost.

use roulement::scene::Level;
use roulement::simulation::Simulation;
use roulement::simulation::instant::Instant;
use roulement::simulation::system::System;

use super::thinned::Thinned;

/// Sums since the start at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// \[s] time.
    time: f64,
    /// \[J] work of torques that turn races, or a shaft.
    torque: f64,
    /// \[J] all work, that of torques and contacts whose stiffness changes included.
    put_in: f64,
    /// \[J] kinetic and elastic energy.
    stored: f64,
    /// \[J] losses.
    lost: f64,
}

/// Gathers them from step to step.
#[derive(Clone, Debug, Default)]
pub struct LossWatch {
    kept: Thinned<Sums>,
    /// Sums where the last step has ended, and powers of torques and losses \[W] there.
    last: Option<(Sums, [f64; 2])>,
}

/// Mean powers \[W] over a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closed {
    /// Torque times speed: of both races about their own axes, or of what drives a shaft.
    pub torque: f64,
    /// All other work that is put in: of forces, weight, moving frames, growth.
    pub other: f64,
    /// Power into motion and springs.
    pub stored: f64,
    /// Losses.
    pub lost: f64,
    /// Is it of motion? Friction of an equilibrium is not in balance, and work is not known.
    pub in_motion: bool,
}

impl LossWatch {
    /// Takes where a step of a bearing has ended.
    pub fn step(&mut self, simulation: &Simulation, instant: &Instant) {
        let Instant { time, torque_power, stored_energy: stored, losses, .. } = *instant;
        let energies = &simulation.state().energies;
        let put_in = energies.input + energies.stiffened;
        let sums = Sums { time, torque: 0.0, put_in, stored, lost: 0.0 };
        // Equilibria follow one another without work.
        let at_rest = simulation.scene().solver.level == Level::Equilibrium;
        let sums = if at_rest { Sums { put_in: f64::NAN, ..sums } } else { sums };
        self.add(sums, torque_power, Some(losses.total()));
    }

    /// Takes where a step of a shaft with its housings has ended, after its bearings have taken it.
    pub fn step_of_shaft(&mut self, system: &System, bearings: impl Iterator<Item = Sums>) {
        let outputs = system.outputs();
        let mut sums = Sums { time: system.time(), ..Sums::default() };
        let shafts = outputs.shafts.iter().map(|o| &o.energies);
        for energies in shafts.chain(outputs.housings.iter().map(|o| &o.energies)) {
            // What bearings are given is in their own sums.
            sums.put_in += energies.input - energies.bearings;
            sums.stored += energies.stored;
            sums.lost += energies.damping;
        }
        for link in &outputs.links {
            sums.put_in += link.state.taken;
            sums.stored += link.state.stored;
            sums.lost += link.state.damped;
        }
        for of_bearing in bearings {
            sums.put_in += of_bearing.put_in;
            sums.stored += of_bearing.stored;
            sums.lost += of_bearing.lost;
        }
        let torque = outputs.shafts.iter().map(|o| o.torque * o.spin.speed).sum();
        self.add(sums, torque, None);
    }

    /// Takes sums, and the powers \[W] that are summed here by the trapezoidal rule, as energies are: of torques, and of losses where their
    /// sum is not known. A time that was there already adds nothing.
    fn add(&mut self, mut sums: Sums, torque: f64, losses: Option<f64>) {
        let powers = [torque, losses.unwrap_or(0.0)];
        if let Some((before, then)) = &self.last {
            if before.time >= sums.time {
                return;
            }
            let half = 0.5 * (sums.time - before.time);
            sums.torque += before.torque + half * (then[0] + powers[0]);
            if losses.is_some() {
                sums.lost += before.lost + half * (then[1] + powers[1]);
            }
        }
        self.kept.push(sums);
        self.last = Some((sums, powers));
    }

    /// Where the last step has ended.
    pub fn last(&self) -> Sums {
        self.last.map_or_else(Sums::default, |(sums, _)| sums)
    }

    /// Means over a window \[s] up to the end; none without a step.
    pub fn over(self, window: [f64; 2]) -> Option<Closed> {
        let kept = self.kept.finish();
        let (end, begin) = (*kept.last()?, at(&kept, window[0])?);
        let duration = end.time - begin.time;
        let power = |of: fn(&Sums) -> f64| (of(&end) - of(&begin)) / duration;
        let (torque, put_in) = (power(|sums| sums.torque), power(|sums| sums.put_in));
        let in_motion = put_in.is_finite();
        let closed = Closed {
            torque,
            other: if in_motion { put_in - torque } else { 0.0 },
            stored: if in_motion { power(|sums| sums.stored) } else { 0.0 },
            lost: power(|sums| sums.lost),
            in_motion,
        };
        (duration > 0.0).then_some(closed)
    }
}

/// Sums at a time \[s], in between the two that are next to it: all of them alike, so that what they leave open is that of these two.
fn at(kept: &[Sums], time: f64) -> Option<Sums> {
    let next = kept.partition_point(|sums| sums.time <= time);
    let before = kept.get(next.checked_sub(1)?)?;
    let Some(after) = kept.get(next) else { return Some(*before) };
    let share = (time - before.time) / (after.time - before.time);
    let between = |of: fn(&Sums) -> f64| of(before) + share * (of(after) - of(before));
    Some(Sums {
        time,
        torque: between(|sums| sums.torque),
        put_in: between(|sums| sums.put_in),
        stored: between(|sums| sums.stored),
        lost: between(|sums| sums.lost),
    })
}

impl Closed {
    /// \[W] what is put in, but neither stored nor lost; not a number of equilibria.
    pub fn left(&self) -> f64 {
        if self.in_motion { self.torque + self.other - self.stored - self.lost } else { f64::NAN }
    }

    /// Names, units and values, for the table of means.
    pub fn numbers(&self) -> Vec<(&'static str, &'static str, f64)> {
        let mut numbers = vec![("torque times speed", "W", self.torque)];
        if self.in_motion {
            numbers.push(("other work", "W", self.other));
            numbers.push(("into motion and springs", "W", self.stored));
            numbers.push(("losses left open", "W", self.left()));
        }
        numbers
    }

    /// In words, a line each.
    pub fn lines(&self) -> Vec<String> {
        let Self { torque, other, stored, lost, in_motion } = self;
        if !in_motion {
            let why =
                "equilibria do not close: there is no work, and friction of their balls is not in balance";
            return vec![format!("torque times speed {torque:.4} W; {why}")];
        }
        let left = self.left();
        let share =
            if *lost > 0.0 { format!(", {:.1e} of the losses", left.abs() / lost) } else { String::new() };
        vec![
            format!("brought by torque times speed {torque:.4} W, other work {other:.4} W"),
            format!("gone into motion and springs {stored:.4} W; left open {left:.1e} W{share}"),
        ]
    }
}
