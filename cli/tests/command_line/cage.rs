//! `roulement cage`: a scene of each verdict, text, JSON and figure; and what is said where nothing pushes a cage.

use super::*;

/// The scene of the example, symmetric: no gravity, no radial load.
fn symmetric(scratch: &Scratch, changes: &[(&str, &str)]) -> String {
    let mut text = std::fs::read_to_string(scene("cage")).unwrap();
    let plain = [("gravity = [0, 0, \"-9.81 m/s^2\"]\n", ""), ("z = { force = \"-300 N\" }\n", "")];
    for (from, to) in plain.iter().chain(changes) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let path = scratch.path("scene.toml");
    std::fs::write(&path, text).unwrap();
    path
}

fn motions(arguments: &[&str]) -> Value {
    let said = roulement(arguments);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    serde_json::from_slice(&said.stdout).unwrap()
}

fn push<'a>(cages: &'a Value, name: &str) -> &'a Value {
    let mut pushes = cages[0]["pushes"].as_array().unwrap().iter();
    pushes.find(|push| push["push"] == name).unwrap_or_else(|| panic!("{name}: {cages}"))
}

/// A symmetric bearing leaves its cage at the centre, where it takes nothing; its weight makes it fall on its land and bounce there.
#[test]
fn a_symmetric_scene_is_stable_as_it_is_and_rattles_under_its_weight() {
    let scratch = Scratch::new("cage");
    let path = symmetric(&scratch, &[("\"50 ms\"", "\"40 ms\"")]);
    let found = motions(&["cage", &path, "--json", "-o", &scratch.path("out")]);
    let as_it_is = push(&found, "as it is");
    assert_eq!(as_it_is["motion"], "stable");
    assert!(as_it_is["eccentricity"].as_f64().unwrap() < 1e-3, "{as_it_is}");
    let weight = push(&found, "weight");
    assert_eq!(weight["motion"], "rattles");
    // It weighs 0.2 N.
    assert!(weight["land_load"].as_f64().unwrap() > 1.0 && weight["eccentricity"].as_f64().unwrap() > 0.9);
    // Half of its play off its axis, 0.05 mm, its mass asks for 20 g x 0.05 mm x (2386 rpm)^2 = 0.06 N to go round.
    let unbalance = push(&found, "unbalance");
    assert_eq!(unbalance["motion"], "whirls");
    assert!(unbalance["eccentricity"].as_f64().unwrap() > 0.9, "{unbalance}");
    // It takes more power than its weight does.
    assert_eq!(found[0]["verdict"], "whirls");
    assert_eq!(found[0]["worst"], "unbalance");
    assert!((found[0]["play"].as_f64().unwrap() - 1e-4).abs() < 1e-12);
    let picture = scratch.read("out/cage.svg");
    for heading in ["as it is: stable", "weight: rattles", "kick: "] {
        assert!(picture.contains(heading), "{heading}");
    }
    // The same on one thread, to the bit.
    assert_eq!(motions(&["cage", &path, "--json", "--jobs", "1"]), found);
    let run = roulement(&["run", &path, "-o", &scratch.path("run")]);
    assert!(run.status.success());
    assert!(scratch.read("run/summary.txt").contains("is pushed by nothing here and stays at the centre"));
}

/// Balls hold the cage of the example on its land all the time: it stays there, at a price.
#[test]
fn a_cage_that_is_pressed_on_its_land_is_stable_and_takes_its_share() {
    let said = roulement(&["cage", &scene("cage")]);
    assert!(said.status.success());
    let text = String::from_utf8(said.stdout).unwrap();
    assert!(text.contains("verdict: stable (as it is, unbalance, offset, kick)"), "{text}");
    assert!(!text.contains("weight"), "the scene has it: {text}");
    let found = motions(&["cage", &scene("cage"), "--json"]);
    let share = push(&found, "kick")["share"].as_f64().unwrap();
    assert!((0.3..0.8).contains(&share), "{share}");
}

/// Friction in the pockets drives a cage that only its balls hold: its centre goes round much faster than it turns.
#[test]
fn friction_in_the_pockets_makes_a_cage_whirl() {
    let scratch = Scratch::new("cage-whirl");
    let lands = "guided_by = \"outer\"\nguidance_clearance = \"0.2 mm\"\nland_diameter = \"52 mm\"\nland_width = \"2 mm\"\n";
    let changes = [
        (lands, "guided_by = \"balls\"\n"),
        ("cage_race = 0.05\n", ""),
        ("ball_cage = 0.05", "ball_cage = 0.3"),
        ("\"50 ms\"", "\"120 ms\""),
    ];
    let found = motions(&["cage", &symmetric(&scratch, &changes), "--json"]);
    assert_eq!(found[0]["verdict"], "whirls", "{}", found[0]["sentence"]);
    let kick = push(&found, "kick");
    assert_eq!(kick["motion"], "whirls");
    assert!(
        kick["whirl_ratio"].as_f64().unwrap().abs() > 2.0 && kick["share"].as_f64().unwrap() > 0.2,
        "{}",
        found[0]["sentence"]
    );
}

#[test]
fn without_a_cage_or_a_motion_there_is_nothing_to_push() {
    let said = roulement(&["cage", &scene("thrust")]);
    let why = String::from_utf8(said.stderr).unwrap();
    assert!(
        !said.status.success() && why.contains("write [effects] cage = true, and [cage] with mass"),
        "{why}"
    );
    let scratch = Scratch::new("cage-level");
    // One that has no motion of its own is told apart from none.
    std::fs::write(scratch.path("ideal.toml"), edited("thrust", &[("effects.cage", "\"ideal\"")]).source)
        .unwrap();
    let said = roulement(&["cage", &scratch.path("ideal.toml")]);
    let why = String::from_utf8(said.stderr).unwrap();
    assert!(!said.status.success() && why.contains("the cage of this scene is ideal"), "{why}");
    let path = symmetric(&scratch, &[("[solver]\n", "[solver]\nlevel = \"equilibrium\"\n")]);
    let said = roulement(&["cage", &path]);
    let why = String::from_utf8(said.stderr).unwrap();
    assert!(!said.status.success() && why.contains("solver.level"), "{why}");
}
