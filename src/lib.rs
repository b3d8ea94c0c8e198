//! `roulement`: a 3-D dynamic ball bearing for gearbox co-simulation.

pub mod bearing;
pub mod contact;
pub mod hht;
pub mod kalker;
pub mod motion;
pub mod newton;
pub mod path;
pub mod rotation;
pub mod scalar;
pub mod scene;
pub mod step_control;
pub mod units;
