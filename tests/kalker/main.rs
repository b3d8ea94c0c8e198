//! Rolling contact theories of one scaled patch.
#![allow(clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod half_space;
mod linear;
mod nonlinear;
mod oblique_net;
mod printed;
#[path = "../common/random.rs"]
mod random;
mod table;
