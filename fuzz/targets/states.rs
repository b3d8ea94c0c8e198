//! Bytes as states of an instance, as they are or with a head that vouches for them: refused or used, and the true state leads where it led.
#![no_main]

use std::cell::OnceCell;

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/fmi2_abi/mod.rs"]
mod fmi2_abi;
#[path = "../../tests/scene/hostile.rs"]
mod hostile;
#[path = "../../tests/common/random.rs"]
mod random;

thread_local! {
    static READER: OnceCell<hostile::StateReader> = const { OnceCell::new() };
}

fuzz_target!(|bytes: &[u8]| {
    READER.with(|reader| {
        let reader = reader.get_or_init(|| hostile::StateReader::new("fuzz", "wrench"));
        let Some((forged, rest)) = bytes.split_first() else { return };
        match forged % 3 {
            0 => drop(reader.check(rest)),
            1 => drop(reader.check(&reader.forge(rest))),
            // The true content with pieces written over it: a place, and what goes there.
            _ => {
                let mut content = reader.content().to_vec();
                for piece in rest.chunks(10) {
                    let [low, high, new @ ..] = piece else { break };
                    let at = usize::from(u16::from_le_bytes([*low, *high])) * content.len() >> 16;
                    content.iter_mut().skip(at).zip(new).for_each(|(byte, new)| *byte = *new);
                }
                reader.check(&reader.forge(&content));
            }
        }
    });
});
