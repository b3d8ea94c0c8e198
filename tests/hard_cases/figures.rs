//! The figures of cases in `docs/figures/stability`: those that are out of date are found.

use std::path::Path;

use roulement::model::state::Statistics;

use crate::gates::{corrections, failed};

/// [-] change of steps and corrections that is noise: blows fall a little differently where a sine ends in another last bit.
const NOISE: f64 = 0.05;

/// Compares the counts of a case with its row in the table, except where `scripts/stability` is writing it.
pub fn compare(name: &str, simulated: &str, s: &Statistics) {
    if std::env::var_os("ROULEMENT_RENEW").is_some() {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures/stability/cases.csv");
    let rows: Vec<csv::StringRecord> =
        csv::Reader::from_path(path).unwrap().records().collect::<Result<_, _>>().unwrap();
    let row = rows.iter().find(|row| &row[1] == name && &row[2] == simulated);
    let row =
        row.unwrap_or_else(|| panic!("{name}, {simulated}: no row of figures; scripts/stability writes it"));
    let number = |column: usize| -> f64 { row[column].parse().unwrap() };
    let near = |written: f64, now: f64, least: f64| (written - now).abs() <= least + NOISE * now;
    let same = near(number(3), s.steps as f64, 1.0)
        && near(number(5), s.rejected_error as f64, 2.0)
        && near(number(6), failed(s) as f64, 2.0)
        && near(number(7), corrections(s), 0.01);
    assert!(same, "{name}: the figures {row:?} are out of date, scripts/stability renews them: {s:?}");
}
