//! Numerical error of a run, measured on its own scene (`roulement run --error`).
//!
//! A scene is run again at half the steps, with a tolerance of the local error that asks for half the steps, too; what then
//! differs is the error of the coarser run, and more than that of the finer one. It is refined until the finer run keeps the
//! goal. Errors of means and of histories are told apart: where a run is chaotic its histories have no promise, and its means
//! one of statistics.

mod difference;
mod refine;
mod rounds;
mod sample;

pub use difference::Difference;
pub use refine::{Compared, MOST_ROUNDS, Refined, finer, refine, twin_of_coarser};
pub use rounds::{Judgement, Rounds, TWIN};
pub use sample::{Course, Lengths, Run, Sample, sizes};
