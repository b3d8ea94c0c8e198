//! Least and largest values over all rows of a run, and means of chosen columns.

use roulement::simulation::Simulation;
use roulement::simulation::outputs::{BallOutput, Outputs};

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
    /// Over all rows.
    pub extremes: Extremes,
    /// At the end.
    pub end: f64,
    sum: f64,
}

impl OfColumn {
    /// Before the first row.
    pub fn new(name: &str, unit: &str) -> Self {
        Self {
            name: name.to_string(),
            unit: unit.to_string(),
            extremes: Extremes::NONE,
            end: f64::NAN,
            sum: 0.0,
        }
    }

    /// Takes the value of a row, which counts for the mean or not.
    pub fn push(&mut self, value: f64, counts: bool) {
        self.extremes.push(value);
        self.end = value;
        if counts {
            self.sum += value;
        }
    }
}

/// Rows of a run, and those that means are over.
#[derive(Clone, Copy, Debug)]
pub struct Counted {
    /// First row of the window of means.
    begin: u64,
    rows: u64,
}

impl Counted {
    /// Of a run with so many rows, that of the start included.
    pub fn new(rows: u64) -> Self {
        Self { begin: Blocks::window_begins(rows), rows: 0 }
    }

    /// Is the present row in the window of means?
    pub fn counts(&self) -> bool {
        self.rows >= self.begin
    }

    /// Goes on to the next row.
    pub fn next(&mut self) {
        self.rows += 1;
    }

    /// Mean of a column over the window of means.
    pub fn mean(&self, of: &OfColumn) -> f64 {
        of.sum / (self.rows - self.begin.min(self.rows)) as f64
    }
}

/// All of them.
pub struct Gathered {
    /// Of the quantities whose means are reported.
    pub quantities: [Extremes; COUNT],
    /// Of the balls.
    pub balls: [Extremes; OF_BALLS.len()],
    /// Chosen columns.
    pub chosen: Vec<OfColumn>,
    columns: Option<Columns>,
    counted: Counted,
}

impl Gathered {
    /// Of a run with so many rows, that of the start included; of variables by their names with `*` for any characters.
    ///
    /// # Errors
    /// If a variable is not there.
    pub fn new(simulation: &Simulation, rows: u64, chosen: &[String]) -> Result<Self, ResultsError> {
        let columns = if chosen.is_empty() {
            None
        } else {
            let choice = Choice { columns: chosen.to_vec(), ..Choice::default() };
            Some(Columns::new(simulation.scene(), &choice)?)
        };
        Ok(Self {
            quantities: [Extremes::NONE; COUNT],
            balls: [Extremes::NONE; OF_BALLS.len()],
            // All but the time.
            chosen: columns
                .iter()
                .flat_map(|columns| columns.names().skip(1))
                .map(|(name, unit)| OfColumn::new(name, unit))
                .collect(),
            columns,
            counted: Counted::new(rows),
        })
    }

    /// Takes a row.
    pub fn push(&mut self, simulation: &Simulation) {
        let outputs: &Outputs = simulation.outputs();
        self.quantities.iter_mut().zip(values(outputs)).for_each(|(of, value)| of.push(value));
        for (of, (_, _, get)) in self.balls.iter_mut().zip(OF_BALLS) {
            outputs.balls.iter().for_each(|ball| of.push(get(ball)));
        }
        if let Some(row) = self.columns.as_ref().and_then(|columns| columns.row(simulation.inputs(), outputs))
        {
            for (of, value) in self.chosen.iter_mut().zip(row.skip(1)) {
                of.push(value, self.counted.counts());
            }
        }
        self.counted.next();
    }

    /// Mean of a chosen column over the window of means.
    pub fn mean(&self, of: &OfColumn) -> f64 {
        self.counted.mean(of)
    }
}
