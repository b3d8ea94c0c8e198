//! Least and largest values over all steps of a run, and means of chosen columns over its window.

use roulement::simulation::Simulation;
use roulement::simulation::outputs::{BallOutput, Outputs};

use super::limits::{Limit, all_bare};
use crate::report::means::Blocks;
use crate::report::quantities::{COUNT, values};
use crate::report::results::{Choice, Columns, ResultsError};

/// Quantities of which each ball has one: name, unit, value.
type OfBall = (&'static str, &'static str, fn(&BallOutput) -> f64);
/// Their least and largest values are those of all balls.
pub const OF_BALLS: [OfBall; 4] = [
    ("ball.inner.load", "N", |ball| ball.inner.load),
    ("ball.outer.load", "N", |ball| ball.outer.load),
    ("ball.inner.contact_angle", "rad", |ball| ball.inner.contact_angle),
    ("ball.outer.contact_angle", "rad", |ball| ball.outer.contact_angle),
];

/// Least and largest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Least.
    pub least: f64,
    /// Largest.
    pub largest: f64,
}

impl Extremes {
    const NONE: Self = Self { least: f64::INFINITY, largest: f64::NEG_INFINITY };

    fn push(&mut self, value: f64) {
        self.least = self.least.min(value);
        self.largest = self.largest.max(value);
    }
}

/// A chosen column over a run.
#[derive(Clone, Debug)]
pub struct OfColumn {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Over all steps.
    pub extremes: Extremes,
    /// At the end.
    pub end: f64,
    /// Limits of it, and \[s] when each was met first.
    pub met: Vec<(Limit, Option<f64>)>,
    /// \[s] where the window of means begins.
    begin: f64,
    /// \[s] of the last value.
    time: f64,
    /// \[unit s] and \[s] of the window so far.
    integral: f64,
    duration: f64,
}

impl OfColumn {
    /// Before the start of a run of a duration \[s], with the limits that it has among some.
    pub fn new(name: &str, unit: &str, duration: f64, limits: &[Limit]) -> Self {
        let own = limits.iter().filter(|limit| limit.is_of(name));
        Self {
            name: name.to_string(),
            unit: unit.to_string(),
            extremes: Extremes::NONE,
            end: f64::NAN,
            met: own.map(|limit| (limit.clone(), None)).collect(),
            begin: Blocks::window_begins(duration),
            time: f64::NAN,
            integral: 0.0,
            duration: 0.0,
        }
    }

    /// Goes on to the value at a time \[s]. A time that was there already adds nothing.
    pub fn push(&mut self, time: f64, value: f64) {
        if self.time >= time {
            return;
        }
        self.extremes.push(value);
        for (limit, met) in self.met.iter_mut().filter(|(_, met)| met.is_none()) {
            *met = limit.is_met(value).then_some(time);
        }
        if time > self.begin && !self.time.is_nan() {
            let from = self.time.max(self.begin);
            let share = (from - self.time) / (time - self.time);
            let first = self.end + share * (value - self.end);
            self.integral += 0.5 * (time - from) * (first + value);
            self.duration += time - from;
        }
        (self.time, self.end) = (time, value);
    }

    /// Limits of columns, and \[s] when the first column met each; none where none has.
    pub fn limits(columns: &[Self]) -> Vec<(String, Option<f64>)> {
        let mut all: Vec<(String, Option<f64>)> = vec![];
        for (limit, met) in columns.iter().flat_map(|column| &column.met) {
            match all.iter_mut().find(|(text, _)| *text == limit.text) {
                Some((_, first)) => *first = [*first, *met].into_iter().flatten().reduce(f64::min),
                None => all.push((limit.text.clone(), *met)),
            }
        }
        all
    }

    /// Over the window of means.
    pub fn mean(&self) -> f64 {
        self.integral / self.duration
    }
}

/// All of them.
pub struct Gathered {
    /// Extremes of the quantities whose means are reported.
    pub quantities: [Extremes; COUNT],
    /// Extremes of the balls.
    pub balls: [Extremes; OF_BALLS.len()],
    /// Chosen columns.
    pub chosen: Vec<OfColumn>,
    columns: Option<Columns>,
}

impl Gathered {
    /// Gatherer of a run of a duration \[s]; of variables by their names with `*` for any characters.
    ///
    /// # Errors
    /// If a variable is not there, or a limit cannot be read.
    pub fn new(simulation: &Simulation, duration: f64, chosen: &[String]) -> Result<Self, ResultsError> {
        let columns = if chosen.is_empty() {
            None
        } else {
            let choice = Choice { columns: all_bare(chosen), ..Choice::default() };
            Some(Columns::new(simulation.scene(), &choice)?)
        };
        let limits = Limit::all(chosen)?;
        Ok(Self {
            quantities: [Extremes::NONE; COUNT],
            balls: [Extremes::NONE; OF_BALLS.len()],
            // All but the time.
            chosen: columns
                .iter()
                .flat_map(|columns| columns.names().skip(1))
                .map(|(name, unit)| OfColumn::new(name, unit, duration, &limits))
                .collect(),
            columns,
        })
    }

    /// Takes where a step has ended.
    pub fn push(&mut self, simulation: &Simulation) {
        let outputs: &Outputs = simulation.outputs();
        self.quantities.iter_mut().zip(values(&outputs.into())).for_each(|(of, value)| of.push(value));
        for (of, (_, _, get)) in self.balls.iter_mut().zip(OF_BALLS) {
            outputs.balls.iter().for_each(|ball| of.push(get(ball)));
        }
        if let Some(row) = self.columns.as_mut().and_then(|columns| columns.row(simulation.inputs(), outputs))
        {
            for (of, value) in self.chosen.iter_mut().zip(row.skip(1)) {
                of.push(outputs.time, value);
            }
        }
    }
}
