//! Value references of FMI 3.0: the rows have those that they have in 2.0; time, the accelerations of inputs and arrays, where there are
//! some, come behind them.

use std::borrow::Cow;

use super::arrays::{self, Array, Element};
use super::variables::{Causality, InputKind, Source, Variable};
use crate::schema::variable_units::{self as units, Unit};

/// What a value reference is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A row of the table.
    Row(usize),
    /// The independent variable.
    Time,
    /// The rate of an input, by the row of that.
    Rate(usize),
}

/// The value references of a table.
#[derive(Clone, Debug)]
pub struct References {
    rows: usize,
    /// Rows whose rates are inputs, too.
    rates: Vec<usize>,
    arrays: Vec<Array>,
}

/// An input that is the rate of another one.
#[derive(Clone, Debug, PartialEq)]
pub struct RateRow {
    /// Structured name.
    pub name: String,
    /// Unit.
    pub unit: Unit,
    /// One sentence.
    pub description: String,
}

impl References {
    /// Those of a table, of scalars alone.
    pub fn new(rows: &[Variable]) -> Self {
        let rates = (0..rows.len()).filter(|index| takes_rate(rows, &rows[*index])).collect();
        Self { rows: rows.len(), rates, arrays: vec![] }
    }

    /// Those of a table, with arrays or without (`interface.arrays`).
    pub fn of(rows: &[Variable], arrays: bool) -> Self {
        if arrays { Self::with_arrays(rows) } else { Self::new(rows) }
    }

    fn with_arrays(rows: &[Variable]) -> Self {
        let scalars = Self::new(rows);
        let rates: Vec<_> =
            scalars.rates().map(|(reference, row)| (reference, &rows[row], rate_row(&rows[row]))).collect();
        let own = rows.iter().enumerate().map(|(reference, row)| Element {
            reference: reference as u32,
            name: &row.name,
            description: &row.description,
            row,
            unit: row.unit.name,
        });
        let of_rates = rates.iter().map(|(reference, row, rate)| Element {
            reference: *reference as u32,
            name: &rate.name,
            description: &rate.description,
            row,
            unit: rate.unit.name,
        });
        let all: Vec<_> = own.chain(of_rates).collect();
        Self { arrays: arrays::arrays(&all), ..scalars }
    }

    /// The arrays with their references.
    pub fn arrays(&self) -> impl Iterator<Item = (usize, &Array)> {
        (self.rows + 1 + self.rates.len()..).zip(&self.arrays)
    }

    /// The scalars that a reference is of: the elements of an array, or itself.
    pub fn scalars<'a>(&'a self, reference: &'a u32) -> &'a [u32] {
        let index = (*reference as usize).checked_sub(self.rows + 1 + self.rates.len());
        let array = index.and_then(|index| self.arrays.get(index));
        array.map_or(std::slice::from_ref(reference), |array| &array.elements)
    }

    /// How many scalars references are of.
    pub fn number(&self, references: &[u32]) -> usize {
        references.iter().map(|reference| self.scalars(reference).len()).sum()
    }

    /// The scalars that references are of, one after another.
    pub fn spread<'a>(&self, references: &'a [u32]) -> Cow<'a, [u32]> {
        if self.arrays.is_empty() {
            return Cow::Borrowed(references);
        }
        references.iter().flat_map(|reference| self.scalars(reference)).copied().collect()
    }

    /// How many references there are.
    pub fn count(&self) -> usize {
        self.rows + 1 + self.rates.len() + self.arrays.len()
    }

    /// Of each reference, the array that it is an element of with the reference of that; of arrays alone all of whose elements a package tells of.
    pub fn whole_arrays(&self, told: impl Fn(usize) -> bool) -> Vec<Option<(usize, &Array)>> {
        let mut whole = vec![None; self.count()];
        for (own, array) in
            self.arrays().filter(|(_, array)| array.elements.iter().all(|one| told(*one as usize)))
        {
            array.elements.iter().for_each(|one| whole[*one as usize] = Some((own, array)));
        }
        whole
    }

    /// That of the independent variable.
    pub fn time(&self) -> usize {
        self.rows
    }

    /// Those of the rates, and the rows that they are of.
    pub fn rates(&self) -> impl Iterator<Item = (usize, usize)> {
        self.rates.iter().enumerate().map(|(index, row)| (self.rows + 1 + index, *row))
    }

    /// What a reference is of; none if it is of nothing.
    pub fn place(&self, reference: u32) -> Option<Place> {
        let index = reference as usize;
        match index.checked_sub(self.rows) {
            None => Some(Place::Row(index)),
            Some(0) => Some(Place::Time),
            Some(behind) => self.rates.get(behind - 1).map(|row| Place::Rate(*row)),
        }
    }
}

/// Is the rate of a row an input of packages of FMI 3.0, which has no derivatives of inputs? Those of velocities that are given are.
fn takes_rate(rows: &[Variable], row: &Variable) -> bool {
    let velocity = match &row.source {
        Source::Shaft(source) => source.is_given_velocity(),
        Source::Race(..) => {
            matches!(row.input_kind(), Some(InputKind::Velocity | InputKind::AngularVelocity))
        }
        _ => false,
    };
    // A speed is taken as it is in each step, but for that of a race whose whole motion is given.
    let led = |race: &str| {
        let name = format!("{race}.rotation_rate.y");
        rows.iter().any(|other| other.causality == Causality::Input && other.name == name)
    };
    let of_race = matches!(row.source, Source::Race(..));
    row.causality == Causality::Input
        && velocity
        && row.name.strip_suffix(".speed").filter(|_| of_race).is_none_or(led)
}

/// Can steps of a machine with these variables be taken in pieces, with inputs that are set between them? Motions of a shaft that are given
/// are announced for a whole one.
pub fn updates_are_offered(rows: &[Variable]) -> bool {
    !rows.iter().any(|row| matches!(&row.source, Source::Shaft(source) if source.is_given_velocity()))
}

/// The rate of an input as a variable of its own.
pub fn rate_row(row: &Variable) -> RateRow {
    let axis = ["x", "y", "z"].into_iter().find(|axis| row.name.ends_with(&format!(".{axis}")));
    let stem = axis.map_or(&*row.name, |axis| &row.name[..row.name.len() - axis.len() - 1]);
    let (before, quantity) = stem.rsplit_once('.').unwrap_or(("", stem));
    let quantity = match quantity {
        "velocity" => "acceleration",
        "angular_velocity" => "angular_acceleration",
        "rotation_rate" => "rotation_acceleration",
        "tilt_rate" => "tilt_acceleration",
        _ => "speed_rate",
    };
    let name = [before, quantity].into_iter().chain(axis).collect::<Vec<_>>().join(".");
    let unit = match row.unit.name {
        "m/s" => units::METRE_PER_SECOND_SQUARED,
        _ => units::RADIAN_PER_SECOND_SQUARED,
    };
    RateRow { name, unit, description: format!("rate of the {}; 0 where it is not known", row.description) }
}
