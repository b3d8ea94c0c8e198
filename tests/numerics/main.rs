//! Numerical methods.
#![allow(clippy::unwrap_used)]

mod arrowhead;
mod integrator;
#[path = "../common/random.rs"]
mod random;
