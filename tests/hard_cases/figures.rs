//! The figures of cases in `docs/figures/stability`: those that are out of date are found.

use std::path::Path;

use roulement::model::state::Statistics;

use crate::gates::{corrections, failed};

/// [-] change of steps and corrections that is noise: blows fall a little differently where a sine ends in another last bit.
const NOISE: f64 = 0.05;

/// The row of a table by the start of what stands in it after the kind of run; none while `scripts/stability` writes it.
fn row(table: &str, start: &[&str]) -> Option<csv::StringRecord> {
    if std::env::var_os("ROULEMENT_RENEW").is_some() {
        return None;
    }
    let path =
        Path::new(roulement_tests::ROOT).join("docs/figures/stability").join(table).with_extension("csv");
    let rows: Vec<csv::StringRecord> =
        csv::Reader::from_path(path).unwrap().records().collect::<Result<_, _>>().unwrap();
    let row =
        rows.into_iter().find(|row| row.iter().skip(1).zip(start).all(|(written, given)| written == *given));
    Some(row.unwrap_or_else(|| panic!("{start:?}: no row in {table}; scripts/stability writes it")))
}

fn near(written: &str, now: f64, least: f64) -> bool {
    (written.parse::<f64>().unwrap() - now).abs() <= least + NOISE * now
}

/// Compares the counts of a case.
pub fn compare_case(name: &str, simulated: &str, s: &Statistics) {
    let Some(row) = row("cases", &[name, simulated]) else {
        return;
    };
    let same = near(&row[3], s.steps as f64, 1.0)
        && near(&row[5], s.rejected_error as f64, 2.0)
        && near(&row[6], failed(s) as f64, 2.0)
        && near(&row[7], corrections(s), 0.01);
    assert!(same, "{name}: the figures {row:?} are out of date, scripts/stability renews them: {s:?}");
}

/// Compares the steps of a free oscillation.
pub fn compare_oscillation(name: &str, cap: &str, s: &Statistics) {
    let Some(row) = row("free_oscillation", &[name, cap]) else {
        return;
    };
    let same = near(&row[4], s.steps as f64, 1.0) && near(&row[5], s.rejected_error as f64, 2.0);
    assert!(same, "{name}: the figures {row:?} are out of date, scripts/stability renews them: {s:?}");
}

/// Compares the words of a refusal; its numbers have noise.
pub fn compare_refusal(name: &str, error: &str) {
    let Some(row) = row("refusals", &[name]) else {
        return;
    };
    let words = |text: &str| text.chars().filter(|c| c.is_alphabetic() && *c != 'e').collect::<String>();
    let written = &row[2];
    assert_eq!(
        words(written),
        words(error),
        "{name}: `{written}` is out of date: scripts/stability renews it"
    );
}
