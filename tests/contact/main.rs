//! One contact, from motion to forces.
#![allow(clippy::unwrap_used)]

mod creep_laws;
mod damping;
mod film;
mod heathcote;
mod identification;
mod kernel;
#[path = "../common/laws.rs"]
mod laws;
mod polynomials;
#[path = "../common/scenes.rs"]
mod scenes;
mod shoulder;
mod stick_slip;
