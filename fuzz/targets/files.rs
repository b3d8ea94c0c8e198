//! Bytes as the files that scenes name (measured loads, profiles of races, curves of teeth, matrices of shafts and housings) and that commands read (cases, duties,
//! connected packages, gearboxes of other programs): read or refused with a reason, and a scene that is read stands alone.
#![no_main]

use std::fs;
use std::path::PathBuf;
use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use roulement::scene::machine::MachineScene;
use roulement_cli::duty::loads::Duty;
use roulement_cli::rexs;
use roulement_cli::sweep::cases::Cases;
use roulement_cli::system::Description;

/// Scenes that name the file `given`, by the kind of file.
const SCENES: [&str; 5] = [
    include_str!("../scenes/loads.toml"),
    include_str!("../scenes/profile.toml"),
    include_str!("../scenes/teeth.toml"),
    include_str!("../scenes/shaft.toml"),
    include_str!("../scenes/housing.toml"),
];
/// The scene whose keys tables of cases and duties change.
const BASE: &str = include_str!("../../scenes/thrust.toml");

/// [-] most cases whose scenes are looked at, and longest table of cases \[byte]: some keys of one make many.
const CASES: usize = 3;
const LONGEST_TABLE: usize = 1000;

/// A folder of this process with the scenes.
struct Place {
    folder: PathBuf,
    base: MachineScene,
}

impl Place {
    fn new() -> Self {
        let folder = std::env::temp_dir().join(format!("roulement-fuzz-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder for files");
        let place = Self { folder, base: MachineScene::parse(BASE).expect("the scene of the paper") };
        for (kind, text) in SCENES.iter().enumerate() {
            place.write(&format!("{kind}.toml"), text.as_bytes());
        }
        place
    }

    fn write(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.folder.join(name);
        fs::write(&path, content).expect("a file");
        path
    }
}

/// What is read stands alone; what is refused has a reason.
fn check<Error: ToString>(read: Result<MachineScene, Error>) {
    match read {
        Err(why) => assert!(!why.to_string().is_empty()),
        Ok(scene) => {
            let again = MachineScene::edited(scene.source());
            assert!(again.is_ok(), "its own text is refused: {}", again.unwrap_err());
        }
    }
}

fn check_cases<Error: ToString>(read: Result<Cases, Error>, base: &MachineScene) {
    match read {
        Err(why) => assert!(!why.to_string().is_empty()),
        Ok(cases) => {
            for case in 0..cases.rows.len().min(CASES) {
                match cases.text_of(base.source(), case) {
                    Err(why) => assert!(!why.to_string().is_empty()),
                    Ok(text) => check(MachineScene::edited(&text)),
                }
            }
        }
    }
}

static PLACE: OnceLock<Place> = OnceLock::new();

fuzz_target!(|bytes: &[u8]| {
    let place = PLACE.get_or_init(Place::new);
    let Some((kind, content)) = bytes.split_first() else { return };
    let kind = usize::from(*kind) % (SCENES.len() + 5);
    let Some(table) = kind.checked_sub(SCENES.len()) else {
        place.write("given", content);
        return check(MachineScene::load(&place.folder.join(format!("{kind}.toml"))));
    };
    let text = std::str::from_utf8(content);
    match (table, text) {
        (0, _) => check_cases(Cases::load(&place.write("given.csv", content)), &place.base),
        (1, Ok(text)) if text.len() <= LONGEST_TABLE => check_cases(Cases::from_toml(text), &place.base),
        (2, _) => {
            if let Ok(duty) = Duty::of_table(&place.write("given.csv", content), &place.base) {
                assert!(!duty.loads.is_empty() && duty.loads.iter().all(|load| load.part > 0.0));
            }
        }
        (3, Ok(text)) => drop(Description::read(text)),
        (4, _) => match rexs::import(&place.write("given.rexs", content)) {
            Err(why) => assert!(!why.to_string().is_empty()),
            // Another program's gearbox may have what no machine may.
            Ok(imported) => check(MachineScene::parse(&imported.text)),
        },
        _ => {}
    }
});
