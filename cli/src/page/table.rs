//! The table of a run for the page: all columns, of so many rows as there is room for.

use std::io::BufReader;
use std::path::Path;

use roulement::schema::regular;

use super::grid::Grid;
use crate::report::cells::Column;
use crate::report::results::fits;

/// [-] numbers that are taken of the columns of balls, and of all others: together about a megabyte of the page.
const ROOM: usize = 300_000;

/// Columns and rows that are taken of a table.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Names of columns with `*` for any characters; all if empty.
    pub columns: Vec<String>,
    /// Rows at most; as many as there is room for, if not given.
    pub rows: Option<usize>,
    /// Tables that share the room, those of a shaft and the bearings on it; one by itself if 0.
    pub share: usize,
}

/// Columns of the bearing, and of its balls where these have fewer rows.
#[derive(Debug)]
pub struct Read {
    /// Columns, those of the bearing first.
    pub grids: Vec<Grid>,
    /// [-] rows of the table.
    pub rows: usize,
    /// [-] of how many rows each grid has one.
    pub strides: Vec<usize>,
}

/// Reads a table; every n-th row and the last one where there are more than there is room for.
///
/// # Errors
/// If it cannot be read, or a chosen column is not there.
pub fn read(path: &Path, choice: &Choice) -> Result<Read, String> {
    let cannot = |why: &dyn std::fmt::Display| format!("cannot read {}: {why}", path.display());
    let open = || regular::open(path).map(BufReader::new).map_err(|why| cannot(&why));
    let mut table = csv::Reader::from_reader(open()?);
    let columns: Vec<Column> =
        table.headers().map_err(|why| cannot(&why))?.iter().map(Column::from_header).collect();
    let time = columns
        .iter()
        .position(|column| column.name == "time")
        .ok_or_else(|| cannot(&"it has no column time"))?;
    if let Some(missing) = choice.columns.iter().find(|p| !columns.iter().any(|column| fits(&column.name, p)))
    {
        return Err(format!(
            "--columns {missing}: {} has no such column; `*` stands for any characters",
            path.display()
        ));
    }
    let wanted =
        |name: &str| choice.columns.is_empty() || choice.columns.iter().any(|pattern| fits(name, pattern));
    let chosen: Vec<usize> = (0..columns.len()).filter(|&i| i != time && wanted(&columns[i].name)).collect();
    let rows = table.byte_records().filter(Result::is_ok).count();
    let is_of_ball = |i: &usize| columns[*i].name.starts_with("ball[");
    let (of_balls, of_bearing): (Vec<usize>, Vec<usize>) = chosen.iter().copied().partition(is_of_ball);
    let room = ROOM / choice.share.max(1);
    let stride = |count: usize| {
        let most = choice.rows.unwrap_or(room / count.max(1)).max(2);
        // Places of the last row and of every n-th one.
        rows.div_ceil(most - 1).max(1)
    };
    let mut groups = vec![];
    if rows * (of_balls.len() + of_bearing.len()) <= 2 * room && choice.rows.is_none_or(|most| rows <= most) {
        groups.push((1, chosen));
    } else {
        groups.extend(
            [of_bearing, of_balls]
                .into_iter()
                .filter(|group| !group.is_empty())
                .map(|g| (stride(g.len()), g)),
        );
    }
    let mut values: Vec<Vec<Vec<f64>>> =
        groups.iter().map(|(_, group)| vec![vec![]; group.len() + 1]).collect();
    let mut table = csv::Reader::from_reader(open()?);
    let mut record = csv::ByteRecord::new();
    for row in 0..rows {
        if !table.read_byte_record(&mut record).map_err(|why| cannot(&why))? {
            break;
        }
        for ((stride, group), values) in groups.iter().zip(&mut values) {
            if row % stride != 0 && row + 1 != rows {
                continue;
            }
            for (column, values) in [&time].into_iter().chain(group).zip(values) {
                let text = record.get(*column).and_then(|bytes| std::str::from_utf8(bytes).ok());
                values.push(text.and_then(|text| text.parse().ok()).unwrap_or(f64::NAN));
            }
        }
    }
    let grids = groups.iter().zip(values).map(|((_, group), values)| {
        let mut grid = Grid::new(values[0].len());
        for (column, values) in [&time].into_iter().chain(group).zip(values) {
            grid.push(&columns[*column].name, columns[*column].unit.as_deref().unwrap_or_default(), values);
        }
        grid
    });
    Ok(Read { grids: grids.collect(), rows, strides: groups.iter().map(|group| group.0).collect() })
}
