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
fn a_shelf_is_looked_up_before_the_table_and_checked() {
    let scratch = Scratch::new("bearing-shelf");
    let own = "[[bearing]]\ndesignation = \"HB 7205 X\"\nbore = \"25 mm\"\noutside = \"52 mm\"\nwidth = \"15 mm\"\n\
               dynamic_load_rating = \"16 kN\"\nstatic_load_rating = \"10 kN\"\ncontact_angle = \"18 deg\"\nballs = 14\n\
               ball_diameter = \"7.144 mm\"\n";
    std::fs::write(scratch.path("catalogue.toml"), own).unwrap();
    let shelf = scratch.path("catalogue.toml");
    let output = roulement(&["bearing", "HB", "7205", "X", "--shelf", &shelf]);
    let scene = String::from_utf8(output.stdout).unwrap();
    assert!(scene.contains("balls = 14\n") && scene.contains("ball_diameter = \"7.144 mm\""), "{scene}");
    let checked = roulement(&["check", &shelf]);
    let told = String::from_utf8(checked.stdout).unwrap();
    assert!(
        checked.status.success() && told.contains("a shelf of bearings") && told.contains("HB 7205 X"),
        "{told}"
    );
    std::fs::write(&shelf, own.replace("balls = 14", "balls = 0")).unwrap();
    let checked = roulement(&["check", &shelf]);
    let told = String::from_utf8(checked.stdout).unwrap();
    assert!(!checked.status.success() && told.contains("balls = 0") && told.contains("[3, "), "{told}");
    let refused = roulement(&["run", &shelf]);
    let told = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && told.contains("is a shelf of bearings"), "{told}");
}

/// What `--candidates` says of an input is the equilibrium of a scene with that input.
#[test]
fn consistency_the_spread_of_what_is_estimated_is_that_of_scenes_with_it() {
    let scratch = Scratch::new("bearing-doubt");
    let set = ["--set", "load.y.force=1.5 kN", "--set", "load.inner_speed=\"3000 rpm\""];
    let listed = roulement(&[&["bearing", "6205", "--candidates"][..], &set].concat());
    let listed = String::from_utf8(listed.stdout).unwrap();
    let line = |name: &str| -> Vec<String> {
        let line = listed
            .lines()
            .find(|line| line.trim_start().starts_with(name))
            .unwrap_or_else(|| panic!("{listed}"));
        line.trim_start()[name.len()..].split_whitespace().map(str::to_owned).collect()
    };
    roulement(&["bearing", "6205", "-o", &scratch.path("scene.toml")]);
    let text = scratch.read("scene.toml");
    let edited = |from: &str, to: &str| {
        let loaded: String = text
            .replace(from, to)
            .lines()
            .map(|line| match line.split(' ').next() {
                Some("inner_speed") => "inner_speed = \"3000 rpm\"\n".to_owned(),
                Some("y") => "y = { force = \"1.5 kN\" }\n".to_owned(),
                _ => format!("{line}\n"),
            })
            .collect();
        std::fs::write(scratch.path("edited.toml"), loaded).unwrap();
        let found =
            roulement(&["equilibrium", &scratch.path("edited.toml"), "--gyroscopic", "friction", "--json"]);
        let found: Value = serde_json::from_slice(&found.stdout).unwrap();
        let loads: Vec<f64> = found["balls"]["inner_load"]
            .as_array()
            .unwrap()
            .iter()
            .map(|load| load.as_f64().unwrap())
            .collect();
        [
            found["life"]["L10r"].as_f64().unwrap() * 1e6 / (60.0 * 3000.0),
            loads.into_iter().fold(0.0, f64::max),
        ]
    };
    let near = |told: &str, own: f64| {
        let told: f64 = told.parse().unwrap();
        assert!((told / own - 1.0).abs() < 0.01, "{told} {own}\n{listed}");
    };
    // "life L10r  412 h  310 to 420 h  bearing.inner_conformity = 0.505: 310".
    let [life, load] = edited("none", "none");
    let (told, of_load) = (line("life L10r"), line("largest ball load"));
    near(&told[0], life);
    near(&of_load[0], load);
    let spans = |told: &[String]| [told[2].parse::<f64>().unwrap(), told[4].parse::<f64>().unwrap()];
    let [least, most] = spans(&told);
    // Clearance: the class CN of a bore of 25 mm, 5 to 20 um.
    for clearance in ["5 um", "20 um"] {
        let [life, load] =
            edited("diametral_clearance = \"12.5 um\"", &format!("diametral_clearance = \"{clearance}\""));
        assert!(life > 0.99 * least && life < 1.01 * most, "{clearance}: {life}\n{listed}");
        let [least, most] = spans(&of_load);
        assert!(load > 0.99 * least && load < 1.01 * most, "{clearance}: {load}\n{listed}");
    }
    // The other candidate that is likely, and a groove that is close, widen the span of the peak pressure.
    let pressure = line("peak pressure");
    let [least, most] = spans(&pressure);
    assert!(most > 1.1 * least && listed.contains("_conformity = "), "{listed}");
    // What is given is known.
    let known =
        [&set[..], &["--set", "bearing.inner_conformity=0.52", "--set", "bearing.outer_conformity=0.53"]]
            .concat();
    let known = roulement(&[&["bearing", "6205", "--candidates"][..], &known].concat());
    let known = String::from_utf8(known.stdout).unwrap();
    assert!(known.contains("life L10r") && !known.contains("conformity ="), "{known}");
    let refused = roulement(&["bearing", "6205", "--candidates", "--set", "load.y.farce=1"]);
    assert!(!refused.status.success() && String::from_utf8_lossy(&refused.stderr).contains("load.y.farce"));
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

#[test]
fn fits_by_words_are_told_at_their_ends_and_their_mean() {
    let scratch = Scratch::new("fits");
    let path = scratch.path("scene.toml");
    let written = roulement(&["bearing", "6206", "--shaft-fit", "k6", "--housing-fit", "H7", "-o", &path]);
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));
    let solved = |path: &str| -> Value {
        let output = roulement(&["equilibrium", "--json", path]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let all = solved(&path);
    let fits = all["fits"].as_array().unwrap();
    // Makers print 2 to 25 um of interference, and a gap of 0 to 43 um.
    for (of, name, shaft, housing) in [
        (&fits[0], "least", 2e-6, -43e-6),
        (&fits[1], "mean", 13.5e-6, -21.5e-6),
        (&fits[2], "greatest", 25e-6, 0.0),
    ] {
        assert_eq!(of["fits"], name);
        let get = |ring: &str| of["interference"][ring].as_f64().unwrap();
        assert!((get("inner") - shaft).abs() < 1e-12 && (get("outer") - housing).abs() < 1e-12, "{of}");
    }
    // Each is what the scene with that interference has.
    let text = scratch.read("scene.toml");
    for (of, shaft, housing) in [(&fits[0], 2e-6, -43e-6), (&fits[2], 25e-6, 0.0)] {
        let given = text
            .replace("fit = \"k6\"", &format!("interference = {shaft:e}"))
            .replace("fit = \"H7\"", &format!("interference = {housing:e}"));
        std::fs::write(scratch.path("given.toml"), given).unwrap();
        let output =
            roulement(&["equilibrium", "--json", "--gyroscopic", "friction", &scratch.path("given.toml")]);
        let one: Value = serde_json::from_slice(&output.stdout).unwrap();
        let clearance = one["growth"]["clearance"].as_f64().unwrap();
        assert!((of["clearance"].as_f64().unwrap() - clearance).abs() < 1e-12, "{of} {clearance}");
        assert!(one.get("fits").is_none());
    }
    let words = roulement(&["equilibrium", &path]);
    assert!(
        String::from_utf8(words.stdout)
            .unwrap()
            .contains("  greatest       interference 25.0 um on the shaft")
    );
    // What is open moves the candidates, too.
    let listed = roulement(&["bearing", "6206", "--shaft-fit", "k6", "--candidates"]);
    let listed = String::from_utf8(listed.stdout).unwrap();
    assert!(listed.contains("growth.fits = greatest"), "{listed}");
    let refused = roulement(&["bearing", "6206", "--shaft-fit", "K6"]);
    assert!(!refused.status.success());
    assert!(String::from_utf8_lossy(&refused.stderr).contains("growth.shaft.fit"), "{refused:?}");
}

#[test]
fn bearings_that_a_machine_alone_has_are_machines_that_run() {
    let scratch = Scratch::new("in_machine");
    let path = scratch.path("machine.toml");
    // Load in kN: a tenth of C.
    for (name, part, load) in [
        ("NU 206", "diametral_clearance = ", 3.8),
        ("30206", "contact_angle = ", 4.3),
        ("K 30x35x27", "[bearing.rollers]", 2.6),
        ("3206 A", "catalogue = \"3206 A\"", 3.0),
        ("1206", "catalogue = \"1206\"", 1.6),
        ("QJ 208", "catalogue = \"QJ 208\"", 5.6),
    ] {
        let output = roulement(&["bearing", name, "-o", &path]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = scratch.read("machine.toml");
        let size = format!("\"{} N\"", 1e3 * load);
        // Four-point bearings are made for thrusts.
        let force = match name.starts_with("QJ") {
            true => format!("force = [{size}, 0, 0]"),
            false => format!("force = [0, {size}, 0]"),
        };
        assert!([part, &force].iter().all(|part| text.contains(part)), "{name}: {text}");
        let short = text.replace("duration = \"20 ms\"", "duration = \"0.5 ms\"");
        std::fs::write(&path, short).unwrap();
        let ran = roulement(&["run", "--json", &path, "-o", &scratch.path("run")]);
        assert!(ran.status.success(), "{name}: {}", String::from_utf8_lossy(&ran.stderr));
    }
    let refused = roulement(&["bearing", "NU 206", "--clearance", "C3"]);
    let why = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success() && why.contains("--clearance") && why.contains("NU 206"), "{why}");
    let unknown = roulement(&["bearing", "NU 2999"]);
    assert!(!unknown.status.success() && String::from_utf8_lossy(&unknown.stderr).contains("NU 2999"));
}

#[test]
fn a_machine_of_rollers_alone_has_its_error_measured_and_no_costs_compared() {
    let scratch = Scratch::new("rollers_alone");
    let path = scratch.path("machine.toml");
    roulement(&["bearing", "NU 206", "-o", &path]);
    let text = scratch.read("machine.toml").replace("duration = \"20 ms\"", "duration = \"2 ms\"");
    std::fs::write(&path, text).unwrap();
    let ran = roulement(&["run", "--error", "1e-2", "--json", &path, "-o", &scratch.path("run")]);
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    // Where no bearing has friction, the machine has no losses to tell of.
    let second =
        "\n[[bearing]]\nname = \"second\"\ncatalogue = \"NU 206\"\nmounting = { position = \"20 mm\" }\n";
    let duty = "\n[[duty]]\nname = \"all\"\nshare = 1\n";
    let rated = scratch.read("machine.toml") + second + duty;
    std::fs::write(scratch.path("rated.toml"), rated).unwrap();
    let rating = roulement(&["rating", &scratch.path("rated.toml")]);
    let rating = String::from_utf8(rating.stdout).unwrap();
    let machine = rating.lines().find(|line| line.starts_with("all,(machine),")).unwrap();
    assert!(machine.ends_with(",,"), "{machine}");
    let cost = roulement(&["cost", &path]);
    let why = String::from_utf8_lossy(&cost.stderr).into_owned();
    assert!(
        !cost.status.success() && why.contains("no bearings of balls") && !why.contains("panicked"),
        "{why}"
    );
}
