//! What a run leaves behind: its table and its plots; and how all plots look.

pub mod plots;
pub mod results;
pub mod style;
