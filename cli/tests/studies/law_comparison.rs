//! The comparison of creep laws in docs/creep-laws.md is that of the program as it is.

#[path = "../../examples/law_comparison.rs"]
mod program;

use program::{ANGLES, LAWS, at_angle, head, settled, with_law};

const DOCUMENT: &str = include_str!("../../../docs/creep-laws.md");

/// Numbers of the row that begins like this.
fn printed(head: &str) -> Vec<f64> {
    let row = DOCUMENT.lines().find_map(|line| line.strip_prefix(&format!("| {head} |"))).unwrap();
    row.split(['|', '/']).filter_map(|cell| cell.trim().parse().ok()).collect()
}

/// Are they those of the document, to their last digit and a percent (processors differ in last bits, and runs then by more)?
fn compare(head: &str, means: &program::Means) {
    let fresh = program::row(head, means);
    let fresh: Vec<f64> = fresh.split(['|', '/']).filter_map(|cell| cell.trim().parse().ok()).collect();
    let old = printed(head);
    let fresh = &fresh[fresh.len() - 5..];
    for (old, fresh) in old.iter().zip(fresh) {
        assert!(
            (old - fresh).abs() <= 1.0 + 0.01 * old.abs(),
            "{head}: {old} printed, {fresh} now: run scripts/laws"
        );
    }
    assert!(old.len() >= fresh.len(), "{head}");
}

#[test]
fn the_table_of_the_document_has_all_laws() {
    let table = DOCUMENT.split_once("<!-- begin laws -->").unwrap().1.split_once("<!-- end -->").unwrap().0;
    for (law, slip) in LAWS {
        assert_eq!(table.matches(&format!("| {} |", head(law, slip))).count(), 1, "{law}: run scripts/laws");
    }
}

#[test]
#[ignore = "half a minute"]
fn regression_the_table_of_laws_is_not_stale() {
    for (law, slip) in LAWS {
        match with_law(law, slip) {
            Ok(means) => compare(&head(law, slip), &means),
            Err(why) => {
                assert!(DOCUMENT.contains(&format!("| {} | refused", head(law, slip))), "{law}: {why}");
                assert!(why.to_string().contains("linear"), "{why}");
            }
        }
    }
    for angle in ANGLES {
        compare(&angle.to_string(), &at_angle(angle).unwrap());
    }
}

#[test]
fn regression_the_default_law_is_the_richest_and_starts_settled() {
    let named = with_law("kalker_table", true).unwrap();
    let default = settled(&[("effects.creep", "")]).unwrap();
    assert_eq!((default.power, default.spin_share), (named.power, named.spin_share));
    compare(&head("kalker_table", true), &default);
    // The settled state, from the first rows on.
    assert!(default.drift.abs() < 1e-3, "{}", default.drift);
    // A law that a scene names adds no groove slip.
    let alone = settled(&[("effects.creep", "\"kalker_table\"")]).unwrap();
    assert!(alone.power[0] < 0.8 * default.power[0], "{alone:?} {default:?}");
}
