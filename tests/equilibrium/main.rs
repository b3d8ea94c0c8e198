//! The quasi-static solution.
#![allow(clippy::unwrap_used)]

mod elements;
#[path = "../common/equilibria.rs"]
mod equilibria;
mod guess;
mod gyroscopic;
#[path = "../common/mechanics.rs"]
mod mechanics;
#[path = "../common/random.rs"]
mod random;
#[path = "../common/reference.rs"]
mod reference;
mod reference_cases;
mod rollers;
#[path = "../common/scenes.rs"]
mod scenes;
mod thrust_bearing;
