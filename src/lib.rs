//! `roulement`: a 3-D dynamic ball bearing for gearbox co-simulation.

pub mod bearing;
pub mod contact;
pub mod kalker;
pub mod scalar;
pub mod scene;
pub mod units;
