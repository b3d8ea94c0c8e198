//! `roulement`: a 3-D dynamic ball bearing for gearbox co-simulation.

pub mod analysis;
pub mod contact;
pub mod dynamics;
pub mod effects;
pub mod equilibrium;
pub mod fmi;
pub mod forces;
pub mod interface;
pub mod kalker;
pub mod model;
pub mod numerics;
pub mod scene;
pub mod schema;
pub mod simulation;
