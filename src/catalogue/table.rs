//! Common sizes: boundary dimensions of ISO 15, load ratings of a maker's catalogue.

use super::Entry;

/// Where the load ratings are from.
pub const SOURCE: &str = "NSK, Rolling Bearings, CAT. No. E1102";
/// Rows of [`table`], below a line of names.
const ROWS: &str = include_str!("table.csv");

/// Common sizes, series by series.
pub fn table() -> impl Iterator<Item = Entry> {
    ROWS.lines().skip(1).filter_map(row)
}

/// A row; none if it is none, which the tests of the table would find.
fn row(line: &'static str) -> Option<Entry> {
    let mut cells = line.split(',');
    let designation = cells.next()?;
    let mut number = || cells.next()?.parse().ok();
    Some(Entry {
        designation,
        bore: number()?,
        outside: number()?,
        width: number()?,
        dynamic: number()?,
        static_: number()?,
        contact_angle: number()?,
    })
}
