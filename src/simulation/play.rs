//! Playing a simulation from start to end, row by row: the one loop of runs, studies and tests.

use std::iter::Peekable;
use std::ops::ControlFlow;

use super::Simulation;
use super::course::Course;
use super::machine::{Machine, MachineError};
use super::system::Played;
use super::together::{Stopped, Together};
use crate::scene::machine::MachineScene;

/// Simulation that plays its own script step by step, and shows its motion at any time within the last one.
pub trait Scripted {
    /// Why it could not go on.
    type Error;

    /// \[s] time.
    fn time(&self) -> f64;

    /// All that takes its steps together.
    fn together(&mut self) -> Together<'_>;

    /// Message about a bearing that could not go on.
    fn stopped(&self, why: Stopped) -> Self::Error;

    /// All scripts.
    fn scripts(&self) -> Played;

    /// Sets the inputs to what the scripts say now.
    fn script_inputs(&mut self);

    /// Goes to a time \[s] by its scripts, where a step ends.
    ///
    /// # Errors
    /// If a step cannot be finished, or if there is no equilibrium.
    fn advance_by_script(&mut self, end: f64) -> Result<(), Self::Error>;

    /// Begins a run to `end` \[s] by its script.
    ///
    /// # Errors
    /// If that is no later time.
    fn begin(&mut self, end: f64) -> Result<Course, Self::Error> {
        let checked = self.together().check_end(end);
        checked.map_err(|why| self.stopped(why))?;
        self.script_inputs();
        let played = self.scripts();
        Ok(self.together().begin_course(end, played))
    }

    /// Takes one step, which ends where the motion wants it, whatever `row` \[s] is: only that time may then be looked back
    /// to. What goes from equilibrium to equilibrium goes to that row.
    ///
    /// # Errors
    /// If the step cannot be finished; it is then where the last one ended.
    fn step(&mut self, course: &mut Course, row: f64) -> Result<(), Self::Error> {
        if self.together().is_quasi_static() {
            return self.advance_by_script(row);
        }
        let stepped = self.together().step(course, row);
        stepped.map_err(|why| self.stopped(why))
    }

    /// Shows what it did at a time \[s] within the last step, until it looks up.
    fn look_back(&mut self, course: &mut Course, time: f64) {
        self.together().look_back(course, time);
    }

    /// Is where the last step ended again. What is reported since the last row begins anew at the time that was looked at.
    fn look_up(&mut self, course: &mut Course) {
        self.together().look_up(course);
    }

    /// Ends a run; `accepted` where its last step was.
    fn end(&mut self, course: Course, accepted: bool) {
        self.together().end(&course, accepted);
    }
}

/// Observer of the start of a run and of every step, not of its rows alone.
pub trait Observer {
    /// A machine at its start, or where a step has ended.
    fn step(&mut self, machine: &Machine);
}

/// Two of them see the same.
impl<A: Observer, B: Observer> Observer for (A, B) {
    fn step(&mut self, machine: &Machine) {
        self.0.step(machine);
        self.1.step(machine);
    }
}

/// Rows of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows {
    /// \[s] from one row to the next.
    pub interval: f64,
    /// \[s] time of the last row, even if that is no multiple of the interval.
    pub duration: f64,
    /// Does a step end at every row, as that of a package does at every communication point?
    pub end_steps: bool,
}

impl Rows {
    /// Rows that are read from steps.
    pub fn new(interval: f64, duration: f64) -> Self {
        Self { interval, duration, end_steps: false }
    }

    /// Those that the scene of a simulation asks for.
    pub fn of(simulation: &Simulation) -> Self {
        let load = &simulation.scene().load;
        Self::new(load.output_interval.0, load.duration.0)
    }

    /// Those that a scene asks for.
    pub fn of_scene(scene: &MachineScene) -> Self {
        Self::new(scene.output_interval(), scene.duration())
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

/// Occasion at which a run is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seen {
    /// The start, or where a step has ended.
    Step,
    /// A row.
    Row,
}

/// Plays the scene's own script, exactly in every step: where rows are has no part in the motion. `row` sees it at every row, that of the start
/// included, and may end the play.
///
/// # Errors
/// If a step cannot be finished; `row` has then seen where it came to.
pub fn play<S: Scripted, B>(
    machine: &mut S,
    rows: Rows,
    mut row: impl FnMut(&S) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, S::Error> {
    play_seen(machine, rows, |machine, seen| match seen {
        Seen::Row => row(machine),
        Seen::Step => ControlFlow::Continue(()),
    })
}

/// Plays while an observer sees the start and every step.
///
/// # Errors
/// As [`play`].
pub fn play_observed<W: Observer, B>(
    machine: &mut Machine,
    rows: Rows,
    observer: &mut W,
    mut row: impl FnMut(&Machine, &mut W) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, MachineError> {
    play_seen(machine, rows, |machine, seen| match seen {
        Seen::Row => row(machine, observer),
        Seen::Step => {
            observer.step(machine);
            ControlFlow::Continue(())
        }
    })
}

/// Rows within a step come before its end, in the order of time.
fn play_seen<S: Scripted, B>(
    machine: &mut S,
    rows: Rows,
    mut see: impl FnMut(&S, Seen) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, S::Error> {
    let mut flow = see(machine, Seen::Step);
    if flow.is_continue() {
        flow = see(machine, Seen::Row);
    }
    let mut times = rows.times().peekable();
    while flow.is_continue()
        && let Some(&next) = times.peek()
    {
        let end = if rows.end_steps { next } else { rows.duration };
        flow = play_to(machine, end, &mut times, &mut see)?;
    }
    Ok(flow)
}

fn play_to<S: Scripted, B>(
    machine: &mut S,
    end: f64,
    rows: &mut Peekable<impl Iterator<Item = f64>>,
    see: &mut impl FnMut(&S, Seen) -> ControlFlow<B>,
) -> Result<ControlFlow<B>, S::Error> {
    let mut course = machine.begin(end)?;
    let (mut shown, mut flow) = (machine.time(), ControlFlow::Continue(()));
    while flow.is_continue() && machine.time() < end {
        let next = rows.peek().copied().unwrap_or(end);
        if let Err(why) = machine.step(&mut course, next) {
            if machine.time() > shown {
                let _ = see(machine, Seen::Row);
            }
            machine.end(course, false);
            return Err(why);
        }
        let now = machine.time();
        while flow.is_continue()
            && let Some(row) = rows.next_if(|row| *row < now)
        {
            machine.look_back(&mut course, row);
            flow = see(machine, Seen::Row);
            machine.look_up(&mut course);
            shown = row;
        }
        if flow.is_continue() {
            flow = see(machine, Seen::Step);
        }
        if flow.is_continue() && rows.next_if(|row| *row == now).is_some() {
            flow = see(machine, Seen::Row);
            machine.look_up(&mut course);
            shown = now;
        }
    }
    machine.end(course, true);
    Ok(flow)
}

/// Plays a machine from row to row, as an importer does from one communication point to the next: `advance` takes it to the time \[s] of the next row, `row` sees it at every row, that of the start included, and
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
