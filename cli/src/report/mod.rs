//! What a run leaves behind: its table and its plots.

pub mod plots;
pub mod results;
