//! `roulement`: a 3-D dynamic ball bearing for gearbox co-simulation.

pub mod kalker;
pub mod scene;
pub mod units;
