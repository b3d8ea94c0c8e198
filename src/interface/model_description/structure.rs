//! What outputs depend on.

use crate::interface::variables::{Causality, InputKind, Source, Variable};
use crate::scene::Dependencies;

/// An output, by its place among the variables.
pub struct Output {
    /// Its place.
    pub index: usize,
    /// Places of the inputs that it depends on at the end of a step.
    pub inputs: Vec<usize>,
    /// Is it 0 at the start, whatever the inputs are? Otherwise it depends on everything there.
    pub counted_from_start: bool,
}

/// Dependencies of the outputs (`docs/decisions/dependencies.md`). At a communication point none depends on an input as it is
/// set there: outputs are those of the last step. In a step, and at the start, they depend on all inputs, as the bearing is one
/// mechanism, at the start on all parameters, too; exceptions are few.
pub fn outputs(rows: &[Variable], dependencies: Dependencies) -> Vec<Output> {
    let outputs = rows.iter().enumerate().filter(|(_, row)| row.causality == Causality::Output);
    outputs
        .map(|(index, row)| Output {
            index,
            inputs: match dependencies {
                Dependencies::Point => vec![],
                Dependencies::Step => inputs_of_step(rows, row),
            },
            counted_from_start: is_counted_from_start(row),
        })
        .collect()
}

/// Places of the inputs that an output at the end of a step can depend on. The turn of a race about its own axis follows from
/// its prescribed speed and, where its axis is moved from outside, from how that tilts.
fn inputs_of_step(rows: &[Variable], output: &Variable) -> Vec<usize> {
    let turned = match output.source {
        Source::Race(race, ..) if output.name.ends_with(".turned") => Some(race),
        _ => None,
    };
    let reaches = |input: &Variable| match (turned, &input.source) {
        (None, _) => true,
        (Some(race), Source::Race(of, ..)) if *of == race => {
            matches!(input.input_kind(), Some(InputKind::Angle | InputKind::AngularVelocity))
        }
        (Some(_), _) => false,
    };
    let inputs = rows.iter().enumerate().filter(|(_, row)| row.causality == Causality::Input);
    inputs.filter(|(_, input)| reaches(input)).map(|(index, _)| index).collect()
}

/// Is an output 0 at the start, whatever the inputs are?
fn is_counted_from_start(row: &Variable) -> bool {
    // Also of a bearing or a shaft, whose name comes first.
    ["energy.work", "energy.dissipated", "energy.to_bearings", "inner.turned", "outer.turned"].iter().any(
        |name| {
            let before = row.name.strip_suffix(name);
            before.is_some_and(|before| before.is_empty() || before.ends_with('.'))
        },
    )
}
