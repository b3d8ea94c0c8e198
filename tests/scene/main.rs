//! The scene file.
#![allow(clippy::unwrap_used)]

#[path = "../fmi2_abi/mod.rs"]
mod fmi2_abi;
mod hostile;
mod hostile_files;
#[path = "../common/random.rs"]
mod random;
mod reference;
mod units;
#[path = "../common/whole.rs"]
mod whole;
