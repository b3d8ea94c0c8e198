//! An instance as version 3 sees it: values by references that may also be those of time, of rates, and of arrays of all of them.

use std::borrow::Cow;

use super::updates::{Underway, Updates};
use crate::fmi::directional::Known;
use crate::fmi::guard::Held;
use crate::fmi::instance::Instance;
use crate::fmi::log::Log;
use crate::fmi::outcome::{Outcome, error};
use crate::fmi::state::Phase;
use crate::interface::references::{Place, References, rate_row, updates_are_offered};
use crate::interface::variables::{Causality, Kind};

/// A slave.
pub struct Slave {
    /// The instance.
    pub instance: Instance,
    /// What references are of.
    references: References,
    /// The importer's callback, where it has one and steps can be taken in pieces.
    pub updates: Option<Updates>,
    /// A communication step that has begun and not ended.
    pub underway: Option<Underway>,
}

impl Held for Slave {
    fn log_and_phase(&mut self) -> (&Log, &mut Phase) {
        self.instance.log_and_phase()
    }
}

impl Slave {
    /// A slave around an instance that was just made.
    ///
    /// # Errors
    /// If one of the variables that it should read or set within steps is none of its inputs and outputs.
    pub fn new(mut instance: Instance, updates: Option<Updates>, required: &[u32]) -> Outcome<Self> {
        // There are no derivatives of inputs, but inputs that are the rates of others.
        instance.keeps_rates = true;
        let updates = updates.filter(|_| updates_are_offered(instance.rows()));
        let references = References::of(instance.rows(), instance.has_arrays());
        let slave = Self { references, instance, updates, underway: None };
        for reference in required.iter().flat_map(|reference| slave.references.scalars(reference)) {
            if let Place::Row(row) = slave.place(*reference)?
                && let Some(row) = slave.instance.rows().get(row)
                && !matches!(row.causality, Causality::Input | Causality::Output)
            {
                return error(format!("{} cannot be read or set within a step", row.name));
            }
        }
        Ok(slave)
    }

    fn place(&self, reference: u32) -> Outcome<Place> {
        match self.references.place(reference) {
            Some(place) => Ok(place),
            None => error(format!("there is no variable with value reference {reference}")),
        }
    }

    /// References of scalars, where there are as many values as variables have.
    fn scalars<'a>(&self, references: &'a [u32], values: usize) -> Outcome<Cow<'a, [u32]>> {
        match self.references.number(references) {
            number if number == values => Ok(self.references.spread(references)),
            number => error(format!("{} variables have {number} values, not {values}", references.len())),
        }
    }

    fn are_rows(&self, references: &[u32]) -> bool {
        references.iter().all(|reference| matches!(self.references.place(*reference), Some(Place::Row(_))))
    }

    /// Values of variables of one type.
    ///
    /// # Errors
    /// As of [`Instance::get`], and if there are more or fewer values than that.
    pub fn get(&mut self, references: &[u32], kind: Kind, values: &mut [f64]) -> Outcome {
        let references = self.scalars(references, values.len())?;
        if kind != Kind::Real || self.are_rows(&references) {
            return self.instance.get(&references, kind, values);
        }
        for (reference, value) in references.iter().zip(values) {
            match self.place(*reference)? {
                Place::Row(_) => self.instance.get(&[*reference], kind, std::slice::from_mut(value))?,
                Place::Time => *value = self.instance.time(),
                Place::Rate(row) => *value = self.instance.state.rates[row],
            }
        }
        Ok(())
    }

    /// Sets inputs, their rates, and parameters.
    ///
    /// # Errors
    /// As of [`Instance::set`], and if there are more or fewer values than variables; nothing is then set.
    pub fn set(&mut self, references: &[u32], kind: Kind, values: &[f64]) -> Outcome {
        let references = self.scalars(references, values.len())?;
        self.check_set(&references)?;
        if kind != Kind::Real || self.are_rows(&references) {
            return self.instance.set(&references, kind, values);
        }
        let (mut rows, mut row_values, mut rates) = (vec![], vec![], vec![]);
        for (reference, value) in references.iter().zip(values) {
            match self.place(*reference)? {
                Place::Row(_) => {
                    rows.push(*reference);
                    row_values.push(*value);
                }
                Place::Time => return error("time is the independent variable and cannot be set"),
                Place::Rate(row) if value.is_finite() => rates.push((row, *value)),
                Place::Rate(row) => {
                    let name = rate_row(&self.instance.rows()[row]).name;
                    return error(format!("{name} = {value} is not a finite number"));
                }
            }
        }
        self.instance.set(&rows, kind, &row_values)?;
        for (row, value) in rates {
            self.instance.state.rates[row] = value;
            self.instance.take_over(row);
        }
        Ok(())
    }

    /// Refuses parameters within a step.
    fn check_set(&self, references: &[u32]) -> Outcome {
        let rows = self.instance.rows();
        let within = references.iter().filter(|_| self.underway.is_some());
        let mut set = within.filter_map(|reference| rows.get(*reference as usize));
        match set.find(|row| row.causality == Causality::Parameter) {
            Some(row) => error(format!("{} is a parameter and cannot be set within a step", row.name)),
            None => Ok(()),
        }
    }

    fn knowns(&self, references: &[u32]) -> Outcome<Vec<Known>> {
        let known = |reference: &u32| match self.place(*reference)? {
            Place::Row(_) => Ok(Known::Input(self.instance.known(*reference)?)),
            Place::Rate(row) => Ok(Known::Rate(row)),
            Place::Time => error("time cannot be a known of a directional derivative"),
        };
        references.iter().map(known).collect()
    }

    /// Changes of outputs for a change of inputs or their rates.
    ///
    /// # Errors
    /// As of [`Instance::directional_derivative`], and if there are more or fewer values than variables.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Outcome {
        let (knowns, unknowns) =
            (self.scalars(knowns, seed.len())?, self.scalars(unknowns, sensitivity.len())?);
        self.instance.forward_derivative(&unknowns, &self.knowns(&knowns)?, seed, sensitivity)
    }

    /// Weights of outputs times their derivatives by inputs or their rates.
    ///
    /// # Errors
    /// As of [`Slave::directional_derivative`].
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Outcome {
        let (unknowns, knowns) =
            (self.scalars(unknowns, seed.len())?, self.scalars(knowns, sensitivity.len())?);
        self.instance.adjoint_derivative(&unknowns, &self.knowns(&knowns)?, seed, sensitivity)
    }

    /// First derivatives of outputs by time.
    ///
    /// # Errors
    /// As of [`Instance::output_derivatives`], and if there are more or fewer values than variables.
    pub fn output_derivatives(&mut self, references: &[u32], orders: &[i32], values: &mut [f64]) -> Outcome {
        let scalars = self.scalars(references, values.len())?;
        // An order is of a whole variable.
        let each = references.iter().zip(orders);
        let orders: Vec<i32> = each
            .flat_map(|(reference, order)| self.references.scalars(reference).iter().map(|_| *order))
            .collect();
        self.instance.output_derivatives(&scalars, &orders, values)
    }
}
