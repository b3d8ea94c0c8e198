//! Parts of the command line: packages, results of runs, their numerical errors, pages that show them, motions of cages, doubt about catalogue bearings, life over a duty, tolerances of fits, sweeps of many cases, systems of
//! connected packages, gearboxes from other programs' files, kinds of files and what is in them, and the study of accuracy against CPU time.

pub mod cage;
pub mod check;
pub mod cost;
pub mod doubt;
pub mod duty;
pub mod error;
pub mod exact;
pub mod field;
pub mod film;
pub mod fits;
pub mod kinds;
pub mod measure;
pub mod modes;
pub mod package;
pub mod page;
pub mod report;
pub mod rexs;
pub mod sweep;
pub mod system;
pub mod watch;
