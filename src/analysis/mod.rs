//! Analyses of a model or a state without running it: stiffness and damping, natural frequency, small motions of all bodies, single
//! rolling contacts.

pub mod auto;
pub mod condensed;
mod corners;
pub mod estimate;
mod kept_apart;
mod level;
mod looked_at;
pub mod natural_frequency;
mod settled;
pub mod single_contact;
pub mod small_motions;
pub mod stick_slip;
mod tangents;
