//! `roulement check`: what files are, notes on unusual numbers, and other commands that meet a file of another kind.

use super::*;

/// What is said of a file, and whether it may be run.
fn check(path: &str) -> (String, bool) {
    let output = roulement(&["check", path]);
    (String::from_utf8(output.stdout).unwrap(), output.status.success())
}

fn in_project(name: &str) -> String {
    format!("{}/../{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn every_kind_of_file_is_named_with_what_it_runs() {
    for (name, words) in [
        (
            "scenes/thrust.toml",
            &["the scene of a bearing", "one bearing of", "roulement run simulates", "time: about"][..],
        ),
        ("scenes/shafts/pinion.toml", &["a machine", "1 shaft, 2 bearings", "time: about"]),
        ("examples/sweeps/misalignment.toml", &["a sweep", "1000 cases over", "roulement sweep takes about"]),
        ("examples/gearbox/system.toml", &["a system of packages", "connections"]),
        ("examples/gearbox/two_shafts.rexsj", &["a gearbox in REXS", "2 of 2 shafts", "feather key"]),
    ] {
        let (text, good) = check(&in_project(name));
        assert!(good, "{text}");
        words.iter().for_each(|word| assert!(text.contains(word), "{name}: {word}: {text}"));
    }
    // One that is refused is told of, and the others are checked all the same.
    let scratch = Scratch::new("check");
    std::fs::write(scratch.path("wrong.toml"), "[bearing]\nballs = 9\nball_diametre = 1\n").unwrap();
    let output = roulement(&["check", &scratch.path("wrong.toml"), &scene("thrust")]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        !output.status.success() && text.contains("ball_diametre") && text.contains("one bearing of"),
        "{text}"
    );
}

#[test]
fn other_commands_say_which_kind_a_file_is() {
    for (command, name, words) in [
        ("run", "examples/sweeps/misalignment.toml", ["a sweep", "check, sweep"]),
        ("equilibrium", "examples/gearbox/system.toml", ["a system of packages", "system"]),
        ("run", "examples/gearbox/two_shafts.rexsj", ["a gearbox in REXS", "import"]),
        ("sweep", "scenes/thrust.toml", ["the scene of a bearing", "run, equilibrium"]),
        ("sweep", "examples/gearbox/three_stage.toml", ["a machine", "run, equilibrium"]),
    ] {
        let output = roulement(&[command, &in_project(name)]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success());
        words.iter().for_each(|word| assert!(told.contains(word), "{command} {name}: {word}: {told}"));
    }
}

#[test]
fn closed_form_a_number_in_another_unit_is_noted() {
    let scratch = Scratch::new("check-units");
    let text = std::fs::read_to_string(in_project("scenes/shafts/pinion.toml")).unwrap();
    std::fs::write(scratch.path("fast.toml"), text.replace("speed = \"6000 rpm\"", "speed = 6000")).unwrap();
    let (text, good) = check(&scratch.path("fast.toml"));
    // 6000 rad/s are 57,296 rpm, at which a ball leaves its groove: that is found out, too.
    assert!(!good && text.contains("error: a run stops:") && text.contains("shoulder"), "{text}");
    assert!(
        text.contains("note: shaft.speed = 6000 has no unit and is 57300 rpm")
            && text.contains("\"6000 rpm\" meant?"),
        "{text}"
    );
    let (text, _) = check(&in_project("scenes/shafts/pinion.toml"));
    assert!(!text.contains("has no unit"), "{text}");
}
