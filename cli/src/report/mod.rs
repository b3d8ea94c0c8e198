//! Results of a run: its table, its means, its energy and its plots; and the style of all plots.

pub mod acceleration;
pub mod cells;
pub mod energy;
pub mod figures;
pub mod fine;
pub mod interval;
pub mod json;
pub mod limits;
pub mod losses;
pub mod machine_columns;
pub mod means;
pub mod number;
#[cfg(feature = "parquet")]
pub mod parquet;
pub mod phases;
pub mod plots;
pub mod polar;
pub mod quantities;
pub mod results;
pub mod shaft;
pub mod spectrum;
pub mod style;
pub mod tables;
pub mod thinned;
