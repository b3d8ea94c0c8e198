//! Playing a simulation from start to end, row by row: the one loop of runs, studies and tests.

use std::ops::ControlFlow;

use super::machine::{Machine, MachineError};
use super::system::System;
use super::{Simulation, SimulationError};
use crate::scene::machine::MachineScene;

/// What plays its own script.
pub trait Scripted {
    /// Why it could not go on.
    type Error;

    /// Runs its own steps to exactly `end` \[s] by its script.
    ///
    /// # Errors
    /// If a step cannot be finished; it is then where the last one ended.
    fn advance_scripted(&mut self, end: f64) -> Result<(), Self::Error>;
}

impl Scripted for Simulation {
    type Error = SimulationError;

    fn advance_scripted(&mut self, end: f64) -> Result<(), SimulationError> {
        Self::advance_scripted(self, end)
    }
}

/// What sees every step of a run, not its rows alone.
pub trait Observer {
    /// A bearing alone, where a step has ended.
    fn bearing(&mut self, bearing: &Simulation);

    /// A shaft with its bearings, where a step has ended.
    fn shaft(&mut self, system: &System);
}

/// Two of them see the same.
impl<A: Observer, B: Observer> Observer for (A, B) {
    fn bearing(&mut self, bearing: &Simulation) {
        self.0.bearing(bearing);
        self.1.bearing(bearing);
    }

    fn shaft(&mut self, system: &System) {
        self.0.shaft(system);
        self.1.shaft(system);
    }
}

/// Rows of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows {
    /// \[s] from one row to the next.
    pub interval: f64,
    /// \[s] time of the last row, even if that is no multiple of the interval.
    pub duration: f64,
}

impl Rows {
    /// Those that the scene of a simulation asks for.
    pub fn of(simulation: &Simulation) -> Self {
        let load = &simulation.scene().load;
        Self { interval: load.output_interval.0, duration: load.duration.0 }
    }

    /// Those that a scene asks for.
    pub fn of_scene(scene: &MachineScene) -> Self {
        Self { interval: scene.output_interval(), duration: scene.duration() }
    }

    /// [-] number of rows after that of the start.
    pub fn count(&self) -> u64 {
        (self.duration / self.interval * (1.0 - 1e-9)).ceil().max(1.0) as u64
    }

    /// \[s] times of these rows.
    pub fn times(self) -> impl Iterator<Item = f64> {
        let count = self.count();
        (1..=count).map(move |row| if row == count { self.duration } else { row as f64 * self.interval })
    }
}

/// Plays the scene's own script, exactly in every step: the distance of rows has no part in the motion.
///
/// # Errors
/// See [`play_with`].
pub fn play<S: Scripted, B>(
    machine: &mut S,
    rows: Rows,
    row: impl FnMut(&S) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, S::Error> {
    play_with(machine, rows, S::advance_scripted, row)
}

/// Plays a machine: `advance` takes it to the time \[s] of the next row, `row` sees it at every row, that of the start included, and
/// may end the play.
///
/// # Errors
/// That of an `advance` which could not go on; `row` has then seen where it came to.
pub fn play_with<S, E, B>(
    machine: &mut S,
    rows: Rows,
    mut advance: impl FnMut(&mut S, f64) -> Result<(), E>,
    mut row: impl FnMut(&S) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, E> {
    let mut flow = row(machine);
    for end in rows.times() {
        if flow.is_break() {
            break;
        }
        let advanced = advance(machine, end);
        flow = row(machine);
        advanced?;
    }
    Ok(flow)
}

/// Plays the scene's own script while an observer sees every step, and `row` sees it at every row.
///
/// # Errors
/// See [`play_with`].
pub fn play_observed<W: Observer, B>(
    machine: &mut Machine,
    rows: Rows,
    observer: &mut W,
    mut row: impl FnMut(&Machine, &mut W) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, MachineError> {
    let mut flow = row(machine, observer);
    for end in rows.times() {
        if flow.is_break() {
            break;
        }
        let advanced = machine.advance_observed(end, observer);
        flow = row(machine, observer);
        advanced?;
    }
    Ok(flow)
}
