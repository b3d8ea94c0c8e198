//! Any bytes are a state of the instance or are refused; so are any contents that a true head vouches for.
#![no_main]

#[path = "../../tests/fmi2_abi/mod.rs"]
mod fmi2_abi;
#[path = "../../tests/hostile/mod.rs"]
mod hostile;
#[path = "../../tests/random/mod.rs"]
mod random;

use std::cell::LazyCell;

use hostile::StateReader;
use libfuzzer_sys::fuzz_target;

thread_local! {
    static READER: LazyCell<StateReader> = LazyCell::new(|| StateReader::new("fuzz", "wrench"));
}

fuzz_target!(|bytes: &[u8]| {
    READER.with(|reader| {
        reader.check(bytes);
        reader.check(&reader.forge(bytes));
        // Alterations of the true state, which no random bytes come near.
        let mut content = reader.content().to_vec();
        for place in bytes.chunks_exact(4) {
            let at = usize::from(u16::from_le_bytes([place[0], place[1]])) % content.len();
            content[at] = place[2];
        }
        reader.check(&reader.forge(&content));
    });
});
