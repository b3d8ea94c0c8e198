//! `roulement`: a 3-D dynamic ball bearing for gearbox co-simulation.

pub mod arrowhead;
pub mod bearing;
pub mod cage;
pub mod condensed;
pub mod contact;
pub mod cost;
pub mod documentation;
pub mod dynamics;
pub mod equilibrium;
#[allow(non_snake_case)]
pub mod fmi2;
pub mod hht;
pub mod inputs;
pub mod kalker;
pub mod lanes;
pub mod model;
pub mod model_description;
pub mod motion;
pub mod newton;
pub mod outputs;
pub mod package;
pub mod path;
pub mod plots;
pub mod results;
pub mod rolling_contact;
pub mod rotation;
pub mod scalar;
pub mod scene;
pub mod simulation;
pub mod spin_balance;
pub mod start;
pub mod state;
pub mod step_control;
pub mod units;
pub mod variables;
