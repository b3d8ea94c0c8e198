//! Pressure, traction and slip over the ellipses of contacts, as tables and pictures.

pub mod figure;

use std::io::Write;

use roulement::analysis::stick_slip::{Field, FieldPoint};

/// Columns of a cell, after those that say which contact it is of.
const CELL: [&str; 9] = [
    "x [m]",
    "y [m]",
    "area [m2]",
    "pressure [Pa]",
    "traction.x [Pa]",
    "traction.y [Pa]",
    "slip.x [m/s]",
    "slip.y [m/s]",
    "sticks [1]",
];

/// Writes the head of a table of fields. `whose` names the columns that say which contact a cell is of; where the speed of rolling is not
/// known, slip is over it.
///
/// # Errors
/// If the table cannot be written.
pub fn write_head(table: &mut csv::Writer<impl Write>, whose: &[&str], has_speed: bool) -> csv::Result<()> {
    let unit = |column: &str| if has_speed { column.to_string() } else { column.replace("[m/s]", "[1]") };
    table.write_record(whose.iter().map(|name| (*name).to_string()).chain(CELL.map(unit)))
}

/// Writes the cells of a field, each after the values that say which contact it is of.
///
/// # Errors
/// If the table cannot be written.
pub fn write_cells(table: &mut csv::Writer<impl Write>, whose: &[String], field: &Field) -> csv::Result<()> {
    for FieldPoint { place, area, pressure, traction, slip, sticks } in &field.points {
        let sticks = f64::from(u8::from(*sticks));
        let ([x, y], [tx, ty], [sx, sy]) = (place, traction, slip);
        let cells = [*x, *y, *area, *pressure, *tx, *ty, *sx, *sy, sticks].map(|value| value.to_string());
        table.write_record(whose.iter().cloned().chain(cells))?;
    }
    Ok(())
}
