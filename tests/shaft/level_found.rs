//! `level = "auto"` of the bearings of a machine: which of them need states.

use roulement::analysis::auto;
use roulement::scene::Level;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::{scene, system};

/// A shaft in three bearings, two of which carry a load beside them; the third one is far away and hangs on it.
const THREE: &str = r#"
[shaft]
speed = "3000 rpm"
mass = "3 kg"
polar_inertia = "2e-3 kg m^2"
transverse_inertia = "3e-2 kg m^2"

[[shaft.load]]
name = "pull"
position = "50 mm"
force = [0, "2 kN", "-3 kN"]

[[bearing]]
name = "left"
catalogue = "6205"
level = "auto"
mounting = { position = 0 }

[[bearing]]
name = "right"
catalogue = "6205"
level = "auto"
mounting = { position = "100 mm", axial = "free" }

[[bearing]]
name = "tail"
catalogue = "6205"
level = "auto"
mounting = { position = "160 mm", axial = "free" }
set = { bearing = { diametral_clearance = "60 um" } }

[load]
duration = "2 ms"
output_interval = "200 us"
"#;

/// Levels that are found, in the order of the bearings, with what is said of them.
fn found(text: &str, for_importer: bool) -> (Vec<Level>, String) {
    let (found, notes) = auto::resolve_shaft(scene(text), for_importer).unwrap_or_else(|why| panic!("{why}"));
    assert!(found.bearings.iter().all(|mounted| !mounted.finds_level));
    // Its text says the same.
    let again = SystemScene::of_package(&found.source).unwrap();
    let levels: Vec<Level> = found.bearings.iter().map(|mounted| mounted.level).collect();
    assert_eq!(levels, again.bearings.iter().map(|mounted| mounted.level).collect::<Vec<_>>());
    // And why, where results and packages tell it.
    for (mounted, note) in again.bearings.iter().zip(&notes) {
        let told = &mounted.scene.effects.auto.found;
        assert!(
            told.last().is_some_and(|told| *note == format!("bearing {}: {told}", mounted.name)),
            "{told:?}"
        );
    }
    (levels, notes.join("\n"))
}

use Level::{Dynamic, Equilibrium};

#[test]
fn consistency_loaded_bearings_go_without_states_and_idle_ones_do_not() {
    let (levels, notes) = found(THREE, false);
    assert_eq!(levels, [Equilibrium, Equilibrium, Dynamic], "{notes}");
    assert!(notes.contains("bearing left: auto: level = \"equilibrium\": nothing needs states"), "{notes}");
    assert!(
        notes.contains("bearing tail: auto: level = \"dynamic\": no estimates of effects: no ball is loaded"),
        "{notes}"
    );
    // In a run it is what the words say, to the bit.
    let written = ["left", "right", "tail"].iter().zip(["equilibrium", "equilibrium", "dynamic"]).fold(
        THREE.to_string(),
        |text, (name, level)| {
            let own = format!("name = \"{name}\"\ncatalogue = \"6205\"\nlevel = ");
            text.replace(&format!("{own}\"auto\""), &format!("{own}\"{level}\""))
        },
    );
    let [mut one, mut other] = [THREE, &written].map(system);
    for system in [&mut one, &mut other] {
        system.advance(1e-3).unwrap();
    }
    assert_eq!(one.outputs(), other.outputs());
}

#[test]
fn consistency_what_needs_states_is_named() {
    let cases = [
        (
            "level = \"auto\"\nmounting = { position = 0 }",
            "level = \"auto\"\nmounting = { position = 0 }\nset = { effects = { mean_outputs = true } }",
            "effects.mean_outputs needs them",
        ),
        (
            "level = \"auto\"\nmounting = { position = 0 }",
            "level = \"auto\"\nmounting = { position = 0 }\nset = { friction = { ball_race = [[0, 0.05], [\"1 ms\", 0.2]] } }",
            "its lubrication changes",
        ),
        (
            "speed = \"3000 rpm\"",
            "speed = [[0, 0], [\"2 ms\", \"3000 rpm\"]]",
            "races stand against each other",
        ),
        // 14 kN of load rating: 1 % is 140 N.
        ("force = [0, \"2 kN\", \"-3 kN\"]", "force = [0, \"110 N\", \"80 N\"]", "balls may skid below 1"),
        // The load goes away.
        (
            "force = [0, \"2 kN\", \"-3 kN\"]",
            "force = [0, [[0, \"2 kN\"], [\"1 ms\", \"90 N\"]], 0]",
            "balls may skid below 1",
        ),
    ];
    for (from, to, why) in cases {
        assert!(THREE.contains(from), "{from}");
        let (levels, notes) = found(&THREE.replace(from, to), false);
        let left = notes.lines().find(|line| line.starts_with("bearing left")).unwrap();
        assert!(levels[0] == Dynamic && left.contains(why), "{why}: {notes}");
    }
}

#[test]
fn consistency_balls_that_a_cage_holds_back_are_said_so_in_parts_of_the_losses() {
    // Both rows of a double-row bearing under a load and a thrust: contact angles differ from ball to ball, and so do their speeds.
    let text = THREE
        .replace(
            "catalogue = \"6205\"\nlevel = \"auto\"\nmounting = { position = 0 }",
            "catalogue = \"3206 A\"\nlevel = \"auto\"\nmounting = { position = 0 }",
        )
        .replace("force = [0, \"2 kN\", \"-3 kN\"]", "force = [\"500 N\", \"2 kN\", \"-3 kN\"]");
    let (levels, notes) = found(&text, false);
    let left = notes.lines().find(|line| line.starts_with("bearing left-1")).unwrap();
    assert!(levels[0] == Dynamic && left.contains("a cage would hold balls back, by "), "{notes}");
    assert!(!left.contains("inf") && !left.contains("NaN"), "{left}");
}

#[test]
fn consistency_a_package_goes_by_the_ranges_that_an_importer_has() {
    let (levels, notes) = found(THREE, true);
    assert_eq!(levels, [Dynamic; 3], "{notes}");
    assert!(notes.contains("an importer may set loads and speeds"), "{notes}");
    let ranged = format!("{THREE}\n[ranges]\nshaft.speed = [\"1000 rpm\", \"5000 rpm\"]\n");
    let (levels, notes) = found(&ranged, true);
    assert_eq!(levels[..2], [Equilibrium; 2], "{notes}");
}

#[test]
fn refusals_of_levels_name_what_there_is() {
    let why = SystemScene::parse(&THREE.replace("\"auto\"", "\"automatic\""), None, std::path::Path::new(""))
        .unwrap_err();
    assert!(why.to_string().contains("level") && why.to_string().contains("auto"), "{why}");
    // Rollers have one level: auto is that.
    let rollers = THREE.replace(
        "catalogue = \"6205\"\nlevel = \"auto\"\nmounting = { position = \"100 mm\", axial = \"free\" }",
        "catalogue = \"NU 205\"\nlevel = \"auto\"\nmounting = { position = \"100 mm\" }",
    );
    assert_ne!(rollers, THREE);
    let system = System::new(&scene(&rollers)).unwrap();
    assert!(system.outputs().links[0].rollers().unwrap().loaded > 2);
}
