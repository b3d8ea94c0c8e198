//! Any text is a scene or is refused.
#![no_main]

#[path = "../../tests/fmi2_abi/mod.rs"]
mod fmi2_abi;
#[path = "../../tests/hostile/mod.rs"]
mod hostile;
#[path = "../../tests/random/mod.rs"]
mod random;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    hostile::read_scene(text);
});
