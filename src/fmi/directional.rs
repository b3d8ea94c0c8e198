//! Directional derivatives: how the outputs at the last communication point depend on the inputs that led there.
//!
//! After a step they are the derivatives of that step, from its start with everything but the inputs as it was: what
//! repeating the step from a saved state with slightly different inputs would show, without the noise of the
//! iteration. Every internal step contributes by its Newton matrix with the balls eliminated
//! ([`crate::dynamics::advance_perturbed`]). Before the first step they are those of the equilibrium that the simulation starts
//! from.

use super::instance::Instance;
use super::outcome::{Outcome, error};
use super::state::Phase;
use crate::interface::variables::{Causality, Kind};

/// What derivatives are by.
#[derive(Clone, Copy, Debug)]
pub enum Known {
    /// An input, by its value reference.
    Input(usize),
    /// The rate of an input.
    Rate(usize),
}

impl Instance {
    /// Changes of unknowns (outputs) for a change of knowns (inputs).
    ///
    /// # Errors
    /// If a reference is not of its kind, or the derivatives do not exist here.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        changes: &[f64],
        results: &mut [f64],
    ) -> Outcome {
        let known = |reference: &u32| Ok(Known::Input(self.known(*reference)?));
        let knowns = knowns.iter().map(known).collect::<Outcome<Vec<_>>>()?;
        self.forward_derivative(unknowns, &knowns, changes, results)
    }

    /// The same by inputs or their rates.
    ///
    /// # Errors
    /// As of [`Instance::directional_derivative`].
    pub fn forward_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[Known],
        changes: &[f64],
        results: &mut [f64],
    ) -> Outcome {
        let unknowns = self.unknowns(unknowns)?;
        let columns = self.columns_by(knowns, changes)?;
        for (unknown, result) in unknowns.iter().zip(&mut *results) {
            *result = columns.iter().zip(changes).map(|(column, change)| column[*unknown] * change).sum();
        }
        all_finite(results)
    }

    /// Changes that knowns (inputs or their rates) make for weights of the unknowns (outputs): the weights times the matrix.
    ///
    /// # Errors
    /// As of [`Instance::directional_derivative`].
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[Known],
        weights: &[f64],
        results: &mut [f64],
    ) -> Outcome {
        let unknowns = self.unknowns(unknowns)?;
        let columns = self.columns_by(knowns, weights)?;
        for (column, result) in columns.iter().zip(&mut *results) {
            *result = unknowns.iter().zip(weights).map(|(unknown, weight)| column[*unknown] * weight).sum();
        }
        all_finite(results)
    }

    /// Place of an input that there are derivatives by.
    ///
    /// # Errors
    /// If it is none.
    pub fn known(&self, reference: u32) -> Outcome<usize> {
        self.check(reference, Causality::Input, "a known")
    }

    fn unknowns(&self, references: &[u32]) -> Outcome<Vec<usize>> {
        references.iter().map(|unknown| self.check(*unknown, Causality::Output, "an unknown")).collect()
    }

    fn check(&self, reference: u32, causality: Causality, role: &str) -> Outcome<usize> {
        let index = self.row(reference, Kind::Real)?;
        let row = &self.unit.rows()[index];
        if row.causality == causality {
            return Ok(index);
        }
        error(format!("{} cannot be {role} of a directional derivative", row.name))
    }

    /// Derivatives of all variables by knowns, one column each; `factors` are what they are multiplied by.
    fn columns_by(&mut self, knowns: &[Known], factors: &[f64]) -> Outcome<Vec<&[f64]>> {
        if let Some(value) = factors.iter().find(|value| !value.is_finite()) {
            return error(format!("{value} is no change of a known"));
        }
        match self.state.phase {
            Phase::Initialization => self.refresh()?,
            Phase::StepFailed | Phase::Error => {
                return error("there are no directional derivatives of a step that was not finished");
            }
            Phase::Instantiated
            | Phase::StepComplete
            | Phase::Terminated
            | Phase::Intermediate
            | Phase::Fatal => {}
        }
        let of_inputs = |known: &Known| match known {
            Known::Input(index) => Some(*index),
            Known::Rate(_) => None,
        };
        let inputs: Vec<usize> = knowns.iter().filter_map(of_inputs).collect();
        self.find_columns(&inputs)?;
        if inputs.len() < knowns.len() && self.rate_columns.is_none() {
            let before = self.state.before.as_ref();
            self.rate_columns = Some(self.unit.derivatives_by_rates(before, &self.state.played)?);
        }
        let column = |known: &Known| match *known {
            Known::Input(index) => self.columns.as_ref().and_then(|columns| columns.get(index)),
            Known::Rate(index) => self.rate_columns.as_ref().and_then(|columns| columns.get(index)),
        };
        Ok(knowns.iter().filter_map(column).map(Vec::as_slice).collect())
    }

    /// Derivatives of all variables, one column per variable: those by inputs that were asked for at this communication point. Where some are
    /// missing they are computed together; the first time at a point with those that were asked for at the last one, as an importer
    /// that takes a matrix input by input asks for the same ones again.
    fn find_columns(&mut self, knowns: &[usize]) -> Outcome {
        let kept = self.columns.take();
        let count = self.unit.rows().len();
        let mut wanted = if kept.is_none() { std::mem::take(&mut self.asked) } else { vec![] };
        for list in [&mut wanted, &mut self.asked] {
            list.resize(count, false);
            knowns.iter().for_each(|known| list[*known] = true);
        }
        let mut columns = kept.unwrap_or_else(|| vec![vec![]; count]);
        let missing: Vec<usize> =
            (0..count).filter(|known| wanted[*known] && columns[*known].is_empty()).collect();
        if !missing.is_empty() {
            let found = self.unit.derivatives(self.state.before.as_ref(), &self.state.played, &missing)?;
            missing.into_iter().zip(found).for_each(|(input, column)| columns[input] = column);
        }
        self.columns = Some(columns);
        Ok(())
    }
}

/// Refuses results that are none: of inputs so large that their changes vanish beside them, or of changes whose product overflows.
fn all_finite(results: &[f64]) -> Outcome {
    match results.iter().find(|result| !result.is_finite()) {
        Some(result) => error(format!("a derivative is {result}: an input or a change is too large for it")),
        None => Ok(()),
    }
}
