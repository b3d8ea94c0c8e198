//! Effects that a scene can switch on.
#![allow(clippy::unwrap_used)]

mod ambient;
mod auto;
mod ball_spalls;
mod defects;
mod effect_scenes;
#[path = "../common/energy.rs"]
mod energy;
mod estimates;
#[path = "../fmi2_abi/mod.rs"]
mod fmi2_abi;
mod form;
mod growth;
mod heat;
mod heat_balance;
#[path = "../common/kernel.rs"]
mod kernel;
mod line_contact;
mod list;
mod losses;
mod means;
mod oil_runs;
mod oil_torque;
mod quasi_static;
mod rating;
#[path = "../common/scenes.rs"]
mod scenes;
#[path = "../common/stepping.rs"]
mod stepping;
mod support;
#[path = "../common/tables.rs"]
mod tables;
