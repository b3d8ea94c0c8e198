//! Studies that the program makes, and runs for which it measures energy and errors.
#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod cost;
mod cost_reference;
mod effect_verdicts;
mod error;
mod error_bars;
#[path = "../../../tests/shaft/common.rs"]
#[allow(dead_code)]
mod gears;
mod hard_cases;
mod law_comparison;
#[path = "../../../tests/common/random.rs"]
mod random;
mod random_machines;
mod random_scenes;
mod regret;
#[path = "../../../tests/common/tables.rs"]
mod tables;
