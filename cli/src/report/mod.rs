//! Results of a run: its table and its plots; and the style of all plots.

pub mod plots;
pub mod results;
pub mod style;
