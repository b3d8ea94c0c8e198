//! Hard cases: each tries to break the model; its physics and the gates of `gates.rs` are the assertion.
//!
//! `scripts/stability` runs them and writes the figures that they print to `docs/figures/stability`; `docs/stability.md` is
//! about them.
#![allow(clippy::unwrap_used)]

mod cage;
mod communication;
mod contact_loss;
mod creep_laws;
mod effects;
mod equilibrium_scenes;
mod extremes;
mod figures;
mod free_oscillation;
mod friction;
mod gates;
mod growth;
#[path = "../common/laws.rs"]
mod laws;
mod loads;
mod oil;
mod outside;
#[path = "../common/random.rs"]
mod random;
mod refusals;
mod rolling_laws;
mod scenes;
mod shaft;
mod start_and_stop;
mod stops;
