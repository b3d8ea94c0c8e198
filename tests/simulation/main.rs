//! The running bearing.
#![allow(clippy::unwrap_used)]

mod closed_forms;
mod dense;
mod entering;
#[path = "../common/evidence.rs"]
mod evidence;
mod hinge;
mod ideal_cage;
mod instants;
mod invariance;
mod load_cases;
mod margins;
#[path = "../common/mechanics.rs"]
mod mechanics;
mod outer_wrench;
mod outputs;
mod paper;
mod published_torque;
#[path = "../common/random.rs"]
mod random;
#[path = "../common/reference.rs"]
mod reference;
mod runs;
#[path = "../common/scenes.rs"]
mod scenes;
mod schedule;
mod scripts;
mod stages;
mod standstill;
mod start;
#[path = "../common/statics.rs"]
mod statics;
mod steady_state;
#[path = "../common/tables.rs"]
mod tables;
