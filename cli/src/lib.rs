//! Parts of the command line: packages, results of runs, and the study of accuracy against CPU time.

pub mod cost;
pub mod package;
pub mod report;
