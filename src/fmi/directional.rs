//! Directional derivatives: how the outputs at the last communication point depend on the inputs that led there.
//!
//! After a step they are the derivatives of that step, from its start with everything but the inputs as it was: what
//! repeating the step from a saved state with slightly different inputs would show, without the noise of the
//! iteration. Every internal step contributes by its Newton matrix with the balls eliminated
//! ([`crate::dynamics::advance_perturbed`]). Before the first step they are those of the equilibrium that the simulation starts
//! from.

use std::collections::BTreeSet;

use super::instance::Instance;
use super::outcome::{Outcome, error};
use super::state::Phase;
use crate::interface::variables::{Causality, Kind};

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
        let check = |reference: &u32, causality: Causality, role: &str| -> Outcome<usize> {
            let index = self.row(*reference, Kind::Real)?;
            let row = &self.unit.rows()[index];
            if row.causality == causality {
                return Ok(index);
            }
            error(format!("{} cannot be {role} of a directional derivative", row.name))
        };
        let find = |list: &[u32], causality: Causality, role: &str| -> Outcome<Vec<usize>> {
            list.iter().map(|reference| check(reference, causality, role)).collect()
        };
        let unknowns = find(unknowns, Causality::Output, "an unknown")?;
        let knowns = find(knowns, Causality::Input, "a known")?;
        if let Some(value) = changes.iter().find(|value| !value.is_finite()) {
            return error(format!("{value} is no change of a known"));
        }
        match self.state.phase {
            Phase::Initialization => self.refresh()?,
            Phase::StepFailed | Phase::Error => {
                return error("there are no directional derivatives of a step that was not finished");
            }
            Phase::Instantiated | Phase::StepComplete | Phase::Terminated | Phase::Fatal => {}
        }
        let columns = self.columns_by(&knowns)?;
        for (unknown, result) in unknowns.iter().zip(results) {
            *result =
                knowns.iter().zip(changes).map(|(known, change)| columns[*known][*unknown] * change).sum();
        }
        Ok(())
    }

    /// Derivatives of all variables, one column per variable: those by inputs that were asked for at this communication point. Where some are
    /// missing they are computed together; the first time at a point with those that were asked for at the last one, as an importer
    /// that takes a matrix input by input asks for the same ones again.
    fn columns_by(&mut self, knowns: &[usize]) -> Outcome<&[Vec<f64>]> {
        let kept = self.columns.take();
        let mut wanted = if kept.is_none() { std::mem::take(&mut self.asked) } else { BTreeSet::new() };
        wanted.extend(knowns);
        self.asked.extend(knowns);
        let mut columns = kept.unwrap_or_else(|| vec![vec![]; self.unit.rows().len()]);
        let missing: Vec<usize> = wanted.into_iter().filter(|known| columns[*known].is_empty()).collect();
        if !missing.is_empty() {
            let found = self.unit.derivatives(self.state.before.as_ref(), &self.state.played, &missing)?;
            missing.into_iter().zip(found).for_each(|(input, column)| columns[input] = column);
        }
        Ok(self.columns.insert(columns))
    }
}
