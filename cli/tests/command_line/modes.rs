//! `roulement modes`: which motions grow, as text, JSON, CSV and figures; and what runs and equilibria say of them.

use super::*;

fn whirl(name: &str) -> String {
    scene(&format!("whirl/{name}"))
}

fn json(arguments: &[&str]) -> Value {
    let said = roulement(arguments);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    serde_json::from_slice(&said.stdout).unwrap()
}

/// [1/s] growth of what grows at the speed of the scene, and what it is.
fn growing(of: &Value) -> Vec<(f64, String)> {
    let motions = of["own"]["motions"].as_array().unwrap().iter();
    let growing = motions.filter(|motion| motion["grows"] == true);
    growing
        .map(|motion| (motion["growth"].as_f64().unwrap(), motion["shape"].as_str().unwrap().into()))
        .collect()
}

/// Growth in runs that were kicked (tests/analysis/small_motions.rs): none at 12,000 rpm, 112 1/s at 24,000 rpm.
#[test]
fn a_free_ring_under_thrust_grows_from_some_speed_on_and_on_two_bearings_at_none() {
    let at = |name: &str, speed: &str| {
        let scratch = Scratch::new("modes");
        let text = std::fs::read_to_string(whirl(name)).unwrap().replace("40000 rpm", speed);
        std::fs::write(scratch.path("one.toml"), std::fs::read_to_string(whirl("one")).unwrap()).unwrap();
        std::fs::write(scratch.path("scene.toml"), text).unwrap();
        growing(&json(&["modes", &scratch.path("scene.toml"), "--speeds", "0", "--json"]))
    };
    assert_eq!(at("one", "12000 rpm"), []);
    let found = at("one", "24000 rpm");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].0 / 112.0 - 1.0).abs() < 0.05, "{found:?}");
    assert_eq!(found[0].1, "inner ring tilts and shifts forward");
    assert_eq!(at("two", "24000 rpm"), []);
}

#[test]
fn a_table_and_a_figure_over_the_speed_are_written() {
    let scratch = Scratch::new("modes-files");
    let arguments = ["--speeds", "3", "--up-to", "30000 rpm", "-o", &scratch.path("out")];
    let said = roulement(&[&["modes", &whirl("one"), &whirl("hybrid")], &arguments[..]].concat());
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let text = String::from_utf8(said.stdout).unwrap();
    for part in ["one bearing\n", "hybrid balls\n", "GROWS", "first growth in this table at 30000.0 rpm"] {
        assert!(text.contains(part), "{text}\nshould have {part}");
    }
    let table = scratch.read("out/1/modes.csv");
    let mut lines = table.lines();
    assert!(lines.next().unwrap().starts_with("speed [rpm],frequency [Hz],growth [1/s],"), "{table}");
    let speeds: Vec<f64> = lines.map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    // The speed of the scene, then those of the table.
    for speed in [40000.0, 10000.0, 20000.0, 30000.0] {
        assert!(speeds.iter().any(|found| (found - speed).abs() < 1e-6), "{speed} {speeds:?}");
    }
    for picture in ["out/1/campbell.svg", "out/2/campbell.svg", "out/growth.svg"] {
        let drawn = scratch.read(picture);
        assert!(drawn.contains("growth") && units_in_a_pixel(&drawn) > 5.0, "{picture}");
    }
}

#[test]
fn equilibria_and_runs_say_what_grows_and_call_nothing_settled_that_does() {
    let scratch = Scratch::new("modes-run");
    let told = roulement(&["equilibrium", &whirl("one")]);
    let notes = String::from_utf8(told.stderr).unwrap();
    assert!(notes.contains("warning: a motion grows: inner ring tilts and shifts forward"), "{notes}");
    let run = |name: &str, to: &str| {
        let output = roulement(&["run", name, "-o", &scratch.path(to)]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    // So symmetric a run stays where it is for long, and its means do not drift.
    let (summary, notes) = run(&whirl("one"), "one");
    assert!(notes.contains("warning: a motion grows"), "{notes}");
    assert!(summary.contains("WARNING          a motion grows"), "{summary}");
    assert!(
        summary.contains("NOT SETTLED      a motion grows") && !summary.contains("settled   "),
        "{summary}"
    );
    let record: Value = serde_json::from_str(&scratch.read("one/run.json")).unwrap();
    assert!(record["warnings"][0].as_str().unwrap().starts_with("a motion grows"), "{record}");
    // 1370 N across the axis where 100 N are asked for.
    let (summary, notes) = run(&scene("error/high_speed"), "fast");
    for said in [&summary, &notes] {
        assert!(said.contains("the inner race goes round forwards by up to"), "{said}");
    }
    assert!(!summary.contains("settled   "), "{summary}");
    let (summary, notes) = run(&scene("thrust"), "slow");
    assert!(summary.contains("settled          all means") && !summary.contains("WARNING"), "{summary}");
    assert!(!notes.contains("warning:"), "{notes}");
}

#[test]
fn speeds_and_times_that_cannot_be_are_refused() {
    for (option, value, allowed) in [
        ("--up-to", "-3", "allowed is (0, 100000] rad/s"),
        ("--after", "-1 ms", "before the start"),
        ("--speeds", "5000", "0..=1000"),
    ] {
        let output = roulement(&["modes", &scene("thrust"), &format!("{option}={value}")]);
        assert!(!output.status.success());
        let why = String::from_utf8(output.stderr).unwrap();
        assert!(why.contains(allowed) && why.contains(option), "{why}");
    }
}
