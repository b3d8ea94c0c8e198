//! Rows of the tables in docs/evidence.md, to find those that are out of date.

const DOCUMENT: &str = include_str!("../../docs/evidence.md");

/// Figures behind a row's first cell, in their order.
pub fn row(head: &str) -> Vec<f64> {
    let start = format!("| {head} |");
    let row =
        DOCUMENT.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{start}"));
    row.split(['|', '/']).filter_map(|cell| cell.trim().trim_matches('*').parse().ok()).collect()
}

/// Compares figures with those behind a row's first cell, to the last digit printed: a percent and a half.
#[allow(dead_code)] // figures of documents are drawn without it
pub fn compare(head: &str, figures: &[f64]) {
    let printed = row(head);
    assert_eq!(printed.len(), figures.len(), "{head} {printed:?} {figures:?}");
    for (printed, now) in printed.iter().zip(figures) {
        assert!((printed - now).abs() <= 0.015 * now.abs(), "docs/evidence.md, {head}: {printed}, now {now}");
    }
}
