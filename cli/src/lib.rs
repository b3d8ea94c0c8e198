//! Parts of the command line: packages, results of runs, their numerical errors, pages that show them, motions of cages, doubt about catalogue bearings, life over a duty, tolerances of fits, sweeps of many cases, systems of
//! connected packages, gearboxes from other programs' files, kinds of files and what is in them, and the study of accuracy against CPU time.

pub mod cage;
#[cfg(not(target_family = "wasm"))]
pub mod check;
pub mod clock;
pub mod cost;
pub mod doubt;
pub mod duty;
pub mod error;
pub mod exact;
pub mod field;
pub mod film;
pub mod fits;
pub mod in_machine;
pub mod kinds;
pub mod measure;
pub mod modes;
#[cfg(not(target_family = "wasm"))]
pub mod package;
pub mod page;
pub mod progress;
pub mod report;
pub mod rexs;
pub mod sweep;
#[cfg(not(target_family = "wasm"))]
pub mod system;
pub mod watch;
