//! What the command line is made of: packages, results of runs, and the study of what accuracy costs.

pub mod cost;
pub mod package;
pub mod report;
