//! Packages through the C interface.
#![allow(clippy::unwrap_used, unsafe_code)]
#![allow(clippy::undocumented_unsafe_blocks)] // every pointer in here lives through its call

mod asked;
mod calls;
mod damage;
mod dependencies;
mod film;
#[path = "../fmi2_abi/mod.rs"]
mod fmi2_abi;
mod fmi3_abi;
mod given;
mod growth;
mod housing;
mod orientations;
mod outer;
mod outputs;
mod parameters;
#[path = "../common/random.rs"]
mod random;
mod reload;
#[path = "../common/scenes.rs"]
mod scenes;
mod scripts;
mod several;
mod system;
mod version3;
mod version3_arrays;
mod version3_calls;
mod version3_updates;
