//! Several bearings on one shaft.
#![allow(clippy::unwrap_used)]

mod breakaway;
mod caged;
mod common;
mod cost;
mod coupling;
mod double_row;
mod equilibrium;
mod flange;
mod four_point;
mod frame;
mod gear_hard;
mod hard;
mod housing;
mod hub;
mod level;
mod level_changes;
mod level_found;
mod level_friction;
mod loads;
mod mesh;
mod motion;
mod outer_wrench;
mod planets;
mod quasi_static;
mod reference;
mod roller_friction;
mod rollers;
mod rollers_alone;
mod rollers_between;
mod seats;
mod self_aligning;
mod several;
#[path = "../scene/reference/sources.rs"]
#[allow(dead_code)]
mod sources;
mod statics;
#[path = "../common/tables.rs"]
#[allow(dead_code)]
mod tables;
mod teeth;
mod three_stage;
mod torsion;
