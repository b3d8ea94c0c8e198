//! The study as a table: `cost.csv`, one row a setting.

use std::path::Path;

use strum::VariantArray;

use super::levers::ReferenceKind;
use super::norms::{Comparison, Errors, Norm};
use super::regret::Judged;
use super::{Measured, SceneStudy};

/// Columns before the errors, and after them.
const KEYS: [&str; 5] = ["scene", "comparison", "reference", "lever", "setting"];
const COSTS: [&str; 13] = [
    "worst [-]",
    "cpu [s/s]",
    "instructions [1/s]",
    "steps",
    "rejected by error",
    "rejected by Newton",
    "iterations",
    "factorisations",
    "contact values",
    "contact tangents",
    // Of the lever `default` alone.
    "error over the promise [-]",
    "cost over the cheapest that keeps it [-]",
    "status",
];

/// Writes the rows of all studies. Counts are of the whole run; a field that has no value is empty.
///
/// # Errors
/// If the file cannot be written.
pub fn write(studies: &[SceneStudy], path: &Path) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_path(path)?;
    let errors = Norm::VARIANTS.iter().map(|norm| format!("{} [-]", norm.name()));
    let text = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Vec<_>>();
    writer.write_record(text(&KEYS).into_iter().chain(errors).chain(text(&COSTS)))?;
    for study in studies {
        for kind in [ReferenceKind::Numerical, ReferenceKind::Model] {
            let mut row = |lever: &str, label: &str, errors: Option<&Errors>, costs, status: &str| {
                let comparison = match study.comparison {
                    Comparison::Pointwise => "pointwise",
                    Comparison::WindowMeans => "window means",
                };
                let mut fields = text(&[&study.name, comparison, kind.into(), lever, label]);
                fields.extend(Norm::VARIANTS.iter().map(|&norm| number(errors.and_then(|e| e.get(norm)))));
                fields.push(number(errors.and_then(Errors::worst)));
                fields.extend::<Vec<String>>(costs);
                fields.push(status.to_string());
                writer.write_record(&fields)
            };
            // Between the largest error and the status.
            let none = || vec![String::new(); COSTS.len() - 2];
            row("reference", "error bar", Some(study.error_bar(kind)), none(), "ok")?;
            for point in study.points_of(kind) {
                let lever = point.lever.name();
                match &point.result {
                    Ok(measured) => {
                        let costs = costs(measured, study.judged(point));
                        row(lever, &point.label, Some(&measured.errors), costs, "ok")?;
                    }
                    Err(why) => row(lever, &point.label, None, none(), why)?,
                }
            }
        }
    }
    writer.flush()?;
    Ok(())
}

fn number(value: Option<f64>) -> String {
    value.map(|value| format!("{value:.4e}")).unwrap_or_default()
}

fn costs(measured: &Measured, judged: Option<(Judged, Option<f64>)>) -> Vec<String> {
    let work = &measured.work;
    let counts = [
        work.steps,
        work.rejected_error,
        work.rejected_newton,
        work.newton.iterations,
        work.newton.factorisations,
        work.contact_values,
        work.contact_tangents,
    ];
    let rates = [number(Some(measured.cpu)), number(measured.instructions)];
    let promise = [judged.map(|(judged, _)| judged.over), judged.and_then(|(_, regret)| regret)];
    rates.into_iter().chain(counts.map(|count| count.to_string())).chain(promise.map(number)).collect()
}
