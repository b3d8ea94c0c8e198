//! `roulement bearing`: scenes of catalogue bearings.

use super::*;

#[test]
fn a_bearing_by_name_is_a_scene_that_runs() {
    let scratch = Scratch::new("bearing");
    let path = scratch.path("6205.toml");
    let output = roulement(&["bearing", "6205", "C3", "-o", &path]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = scratch.read("6205.toml");
    for part in [
        "title = \"6205 C3, deep groove, 25 x 52 x 15 mm, internal geometry estimated\"",
        "NSK",
        "balls = 9\n",
        "ball_diameter = \"7.9375 mm\"",
        "# Spread, the next in this order: 9 x 8 mm (",
        "ISO 5753-1, spread 13 to 28 um",
        "diametral_clearance = \"20.5 um\"",
    ] {
        assert!(text.contains(part), "{text}\nshould have {part}");
    }
    let solved = roulement(&["equilibrium", "--json", &path]);
    let solved: Value = serde_json::from_slice(&solved.stdout).unwrap();
    assert!((solved["load"]["Fy"].as_f64().unwrap() - 1400.0).abs() < 1e-6, "{solved}");
    // The whole scene, shorter.
    let short = text.replace("duration = \"20 ms\"", "duration = \"1 ms\"");
    std::fs::write(&path, short).unwrap();
    let ran = roulement(&["run", "--json", &path, "-o", &scratch.path("run")]);
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let summary: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert!(summary.to_string().contains("6205 C3"), "{summary}");
}

#[test]
fn candidates_are_listed_with_their_errors_and_can_be_chosen() {
    let listed = roulement(&["bearing", "7206", "B", "--candidates"]);
    let listed = String::from_utf8(listed.stdout).unwrap();
    let first = listed.lines().find(|line| line.starts_with(" 1 ")).unwrap();
    assert_eq!(first.split_whitespace().take(3).collect::<Vec<_>>(), ["1", "13", "9.5250"], "{listed}");
    let second = listed.lines().find(|line| line.starts_with(" 2 ")).unwrap();
    let balls = second.split_whitespace().nth(1).unwrap();
    let chosen = roulement(&["bearing", "7206 B", "--candidate", "2"]);
    let chosen = String::from_utf8(chosen.stdout).unwrap();
    assert!(
        chosen.contains(&format!("\nballs = {balls}\n")) && chosen.contains("contact_angle = \"40 deg\""),
        "{chosen}"
    );
    let numbers = [
        "bearing",
        "--bore",
        "30 mm",
        "--outside",
        "62 mm",
        "--width",
        "0.016",
        "--c",
        "20.5 kN",
        "--c0",
        "13500",
        "--contact-angle",
        "40 deg",
        "--candidates",
    ];
    let same = String::from_utf8(roulement(&numbers).stdout).unwrap();
    assert_eq!(listed.lines().skip(3).collect::<Vec<_>>(), same.lines().skip(3).collect::<Vec<_>>());
    let table = String::from_utf8(roulement(&["bearing", "--list"]).stdout).unwrap();
    assert!(table.lines().count() > 120 && table.contains("6205") && table.contains("NSK"), "{table}");
}

#[test]
fn bearings_that_are_not_there_are_refused() {
    for (arguments, part) in [
        (vec!["bearing", "6299"], "6299 is not in the table"),
        (vec!["bearing"], "bore is missing"),
        (vec!["bearing", "6205", "--bore", "25 kg"], "kg measures something else"),
        (vec!["bearing", "6205", "--candidate", "13"], "candidate = 13 is out of range: allowed is [1, 12]"),
        (vec!["bearing", "6205", "-o", "/nowhere/scene.toml"], "/nowhere/scene.toml"),
    ] {
        let output = roulement(&arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(part), "{said}\nshould have {part}");
    }
}
