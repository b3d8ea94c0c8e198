//! One implicit step of all bodies.
#![allow(clippy::unwrap_used)]

mod last_correction;
mod rigid_body;
#[path = "../common/scenes.rs"]
mod scenes;
#[path = "../common/stepping.rs"]
mod stepping;
