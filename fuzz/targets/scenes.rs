//! Texts as scenes: of one bearing or of a machine, read or refused with a reason; what is read can be told of, and its own text reads again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use roulement::interface::documentation;
use roulement::scene::machine::MachineScene;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match MachineScene::parse(text) {
        Err(why) => assert!(!why.to_string().is_empty()),
        Ok(scene) => {
            let _ = (scene.notes(), scene.duration(), scene.has_arrays());
            if let MachineScene::Bearing(alone) = &scene {
                documentation::page(alone, &|_| true);
            }
            let again = MachineScene::edited(scene.source());
            assert!(again.is_ok(), "its own text is refused: {}", again.unwrap_err());
        }
    }
});
