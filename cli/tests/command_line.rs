//! The command line as a user meets it.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use roulement::scene::Scene;
use serde_json::Value;

fn roulement(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_roulement")).args(arguments).output().unwrap()
}

fn scene(name: &str) -> String {
    format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// Text of a scene with keys changed.
fn edited(name: &str, changes: &[(&str, &str)]) -> String {
    let text = std::fs::read_to_string(scene(name)).unwrap();
    Scene::edited(&text, changes.iter().copied()).unwrap().source
}

/// A directory of its own for a test, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("roulement-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn equilibrium_json_has_the_documented_keys() {
    for choice in ["outer-race-control", "none", "friction"] {
        let output = roulement(&["equilibrium", &scene("radial"), "--json", "--gyroscopic", choice]);
        assert!(output.status.success());
        let json: Value = serde_json::from_slice(&output.stdout).unwrap();
        for (group, keys) in [
            ("displacement", &["x", "y", "z", "ry", "rz"][..]),
            ("load", &["Fx", "Fy", "Fz", "My", "Mz"]),
            ("balls", &["azimuth", "inner_load", "outer_load", "inner_contact_angle", "outer_contact_angle"]),
        ] {
            for key in keys {
                assert!(!json[group][key].is_null(), "{group}.{key}");
            }
        }
        assert_eq!(json["stiffness"].as_array().unwrap().len(), 5);
        assert_eq!(json["balls"]["inner_load"].as_array().unwrap().len(), 9);
        assert!(json["cage_speed"].as_f64().unwrap() > 200.0 && json["residual"].as_f64().unwrap() < 1e-9);
        assert!((json["load"]["Fy"].as_f64().unwrap() - 1500.0).abs() < 1e-6);
    }
}

#[test]
fn equilibrium_text_has_units() {
    let output = roulement(&["equilibrium", &scene("thrust")]);
    let text = String::from_utf8(output.stdout).unwrap();
    for part in ["um", "mrad", "N m", "rad/s", "[deg]", "load inner, outer [N]"] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn run_writes_table_plots_and_summary() {
    let scratch = Scratch::new("run");
    let text = edited("thrust", &[("load.duration", "\"2 ms\"")]);
    std::fs::write(scratch.path("short.toml"), text).unwrap();
    let output = roulement(&["run", &scratch.path("short.toml"), "-o", &scratch.path("out")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    let table = std::fs::read_to_string(scratch.path("out/results.csv")).unwrap();
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header[0], "time [s]");
    for name in ["inner.force.x [N]", "cage.speed [rad/s]", "ball[10].outer.creepage_spin [1/m]"] {
        assert!(header.contains(&name), "{name}");
    }
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 21);
    assert!(rows.iter().all(|row| row.len() == header.len() && row.iter().all(|value| value.is_finite())));
    assert_eq!(rows[20][0], 0.002);

    for (name, labels) in [
        ("contacts.svg", &["contact angle [deg]", "spin moment [N mm]", "friction power [W]"][..]),
        ("bearing.svg", &["cage speed [rad/s]", "inner race position [um]"]),
        ("balls.svg", &["azimuth [deg]", "peak pressure [MPa]"]),
    ] {
        let picture = std::fs::read_to_string(Path::new(&scratch.path("out")).join(name)).unwrap();
        assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
        for label in labels {
            assert!(picture.contains(label), "{name}: {label}");
        }
        assert!(!picture.contains("NaN"));
    }

    let summary = String::from_utf8(output.stdout).unwrap();
    for part in [
        "cage speed",
        "epicyclic",
        "friction power",
        "accepted",
        "rejected",
        "Newton",
        "per simulated second",
    ] {
        assert!(summary.contains(part), "{summary}");
    }
}

#[test]
fn cost_studies_the_levers_that_are_asked_for_and_ends_with_advice() {
    let scratch = Scratch::new("only");
    let text = edited("cost/thrust", &[("load.duration", "\"1 ms\"")]);
    std::fs::write(scratch.path("short.toml"), text).unwrap();
    let arguments =
        ["cost", &scratch.path("short.toml"), "-o", &scratch.path("out"), "--only", "goal,step-cap"];
    let output = roulement(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout).unwrap();
    let advice = said.lines().last().unwrap();
    assert!(advice.starts_with("short: For 1 % of the mean power take saturated with "), "{said}");
    let report = std::fs::read_to_string(scratch.path("out/report.md")).unwrap();
    assert!(report.contains(advice.strip_prefix("short: ").unwrap()), "{report}");
    let table = std::fs::read_to_string(scratch.path("out/cost.csv")).unwrap();
    assert!(table.contains("step cap") && !table.contains("alpha_f") && !table.contains("frictionless"));
    let refused = roulement(&["cost", "--only", "speed"]);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("step-cap"));
}

#[test]
fn cost_says_whether_its_window_has_settled_and_how_long_the_scene_should_run() {
    // Balls that start rolling, without spin in balance, need 150 ms to settle; at 1 rpm without friction nothing has to.
    let scratch = Scratch::new("settled");
    for (speed, law, begins) in
        [("6000 rpm", "saturated", "NOT SETTLED: over"), ("1 rpm", "frictionless", "All means over")]
    {
        let changes = [
            ("load.duration", "\"8 ms\""),
            ("load.inner_speed", &format!("\"{speed}\"")),
            ("effects.creep", &format!("\"{law}\"")),
            ("start.spin_balance", "false"),
            ("solver.max_step", "\"20 us\""),
            ("inner.drive", "\"pose\""),
            ("inner.mass", ""),
            ("inner.inertia", ""),
        ];
        std::fs::write(scratch.path("drift.toml"), edited("cost/thrust", &changes)).unwrap();
        let output =
            roulement(&["cost", &scratch.path("drift.toml"), "-o", &scratch.path("out"), "--only", "level"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let said = String::from_utf8(output.stdout).unwrap();
        println!("{said}");
        let report = std::fs::read_to_string(scratch.path("out/report.md")).unwrap();
        let line = said.lines().find(|line| line.contains("window of the reference")).unwrap();
        assert!(report.contains(line.strip_prefix("drift: ").unwrap()), "{report}");
        let (reference, richest) = line.split_once("window of the richest model").unwrap();
        let start = format!("drift: {begins} the window of the reference, 2.0000 to 8.0000 ms,");
        assert!(reference.starts_with(&start), "{line}");
        if law != "frictionless" {
            // Both say so, with drift and noise, and what to do.
            for of_one in [reference, richest] {
                assert!(of_one.contains("inner power per ball by"), "{line}");
                assert!(of_one.contains(" W (noise "), "{line}");
                let ends = ["; load.duration of about ", "; no decay to be seen"];
                assert!(ends.iter().any(|end| of_one.contains(end)), "{line}");
            }
        }
        // Contacts have their columns and a table of their own.
        for name in ["inner race power", "outer race power", "spin share", "largest load", "peak pressure"] {
            let table = std::fs::read_to_string(scratch.path("out/cost.csv")).unwrap();
            assert!(table.lines().next().unwrap().contains(&format!("{name} [-]")), "{name}");
            assert!(report.contains(&format!("| {name} ")), "{name}");
        }
    }
}

#[test]
fn cost_writes_table_plots_and_report() {
    let scratch = Scratch::new("cost");
    let text = edited("cost/thrust", &[("load.duration", "\"1 ms\"")]);
    std::fs::write(scratch.path("short.toml"), text).unwrap();
    let output = roulement(&["cost", &scratch.path("short.toml"), "-o", &scratch.path("out")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    let table = std::fs::read_to_string(scratch.path("out/cost.csv")).unwrap();
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).unwrap_or_else(|| panic!("{name}"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let of = |reference: &str| rows.iter().filter(|r| r[column("reference")] == reference).count();
    assert!(of("numerical") > 30 && of("model") > 5 && of("numerical") + of("model") == rows.len());
    for row in &rows {
        assert_eq!((row.len(), row[column("status")]), (header.len(), "ok"), "{row:?}");
        let is_bar = row[column("lever")] == "reference";
        assert_eq!(row[column("cpu [s/s]")].parse::<f64>().is_ok_and(|cpu| cpu > 0.0), !is_bar, "{row:?}");
        assert!(row[column("worst [-]")].parse::<f64>().unwrap() >= 0.0);
    }
    for name in ["overview", "numerical", "model"] {
        let picture = std::fs::read_to_string(scratch.path(&format!("out/short-{name}.svg"))).unwrap();
        assert!(picture.trim_end().ends_with("</svg>") && !picture.contains("NaN"));
        assert!(picture.contains("CPU seconds per simulated second") && picture.contains("Pareto front"));
    }
    let report = std::fs::read_to_string(scratch.path("out/report.md")).unwrap();
    let page = std::fs::read_to_string(scratch.path("out/report.html")).unwrap();
    for part in ["Thrust", "fixed step", "creep law", "balanced", "short-overview.svg"] {
        assert!(report.contains(part) && page.contains(part), "{part}");
    }
}

#[test]
fn wrong_scenes_are_refused_with_key_value_and_range() {
    let scratch = Scratch::new("wrong");
    let text = std::fs::read_to_string(scene("thrust")).unwrap();
    for (from, to, parts) in [
        ("ball_race = 0.08", "ball_race = -1", &["friction.ball_race = -1", "[0, 2]"][..]),
        ("\"46 mm\"", "\"4.6 mm\"", &["bearing.pitch_diameter", "0.0046", "m"]),
        ("[load]", "[lod]", &["lod"]),
        ("\"1500 N\"", "\"1 MN\"", &["beyond elastic Hertzian contact"]),
    ] {
        assert!(text.contains(from));
        std::fs::write(scratch.path("wrong.toml"), text.replace(from, to)).unwrap();
        for command in ["run", "equilibrium", "describe"] {
            let output = roulement(&[command, &scratch.path("wrong.toml")]);
            let message = String::from_utf8(output.stderr).unwrap();
            assert!(!output.status.success());
            for part in parts {
                assert!(message.contains(part), "{command}: {message}");
            }
        }
    }
    let output = roulement(&["run", &scratch.path("nowhere.toml")]);
    assert!(String::from_utf8(output.stderr).unwrap().contains("nowhere.toml"));
}

#[test]
fn regression_wrong_scenes_are_refused_in_plain_words() {
    let scratch = Scratch::new("words");
    let file = scratch.path("wrong.toml");
    let text = std::fs::read_to_string(scene("thrust")).unwrap();
    let thrust = "x = { force = \"1500 N\" }";
    for (from, to, parts) in [
        ("balls = 10 ", "bals = 10 ", &["bearing.bals is no known key: did you mean balls?"][..]),
        ("balls = 10 ", "balls = \"ten\" ", &["bearing.balls wants a whole number, not \"ten\""]),
        ("balls = 10 ", "", &["bearing.balls is missing", "balls = 10"]),
        ("[load]", "[lod]", &["lod is no known key: did you mean load?"]),
        (thrust, "y = 300", &["load.y wants a table { force = ... } or { displacement = ... }, not 300"]),
        (thrust, "rz = 0.5", &["load.rz wants a table { moment = ... } or { rotation = ... }, not 0.5"]),
        (thrust, "x = { force = true }", &["load.x.force", "wants a force", "1.5 kN", "not true"]),
        (thrust, "x = { force = \"1500\" }", &["load.x.force", "\"1500\"", "unit is missing"]),
        ("\"6000 rpm\"", "\"100 Hz\"", &["load.inner_speed", "100 Hz", "rpm, rad/s or deg/s"]),
        ("creep = \"saturated\"", "creep = \"saturatd\"", &["effects.creep", "did you mean saturated?"]),
        ("ball_race = 0.08", "ball_race = -1", &["friction.ball_race = -1", "[0, 2]"]),
        (
            "drive = \"fixed\"",
            "drive = \"wrench\"\nmass = 1\ninertia = [1, 1, 1]",
            &["outer.drive: \"wrench\" beside inner.drive = \"wrench\": nothing would hold the bearing"],
        ),
        ("balls = 10 ", "balls = = 10 ", &["not TOML"]),
    ] {
        assert!(text.contains(from));
        std::fs::write(&file, text.replace(from, to)).unwrap();
        let output = roulement(&["describe", &file]);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success());
        let line = 1 + text[..text.find(from).unwrap()].matches('\n').count();
        // A key that is missing is missed in its section.
        let line = if to.is_empty() { line - 1 } else { line };
        assert!(message.starts_with(&format!("error: {file}, line {line}: ")), "{message}");
        for part in parts {
            assert!(message.contains(part), "{message}\nshould say {part}");
        }
        for word in ["expected", "invalid", "struct", "untagged", "usize", "integer"] {
            assert!(!message.contains(word), "{message}");
        }
    }
}

#[test]
fn defaults_and_numbers_without_sense_are_told_of() {
    let scratch = Scratch::new("notes");
    let file = scratch.path("scene.toml");
    let told = |changes: &[(&str, &str)], command: &[&str]| {
        std::fs::write(&file, edited("thrust", changes)).unwrap();
        let output = roulement(&[&[command[0], &file], &command[1..]].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(told(&[], &["equilibrium"]), "");
    let conformities = [("bearing.inner_conformity", ""), ("bearing.outer_conformity", "")];
    let note = told(&conformities, &["equilibrium", "--json"]);
    assert!(note.contains("inner_conformity = 0.52 and bearing.outer_conformity = 0.53"), "{note}");
    let fast = told(&[("load.inner_speed", "\"70000 rpm\"")], &["describe"]);
    assert!(fast.contains("n dm = 3.22e6 mm/min"), "{fast}");
    // 4200 MPa are passed between 40 and 60 kN.
    assert_eq!(told(&[("load.x.force", "\"40 kN\"")], &["equilibrium"]), "");
    let heavy = [("load.x.force", "\"60 kN\""), ("load.duration", "\"0.1 ms\"")];
    for command in [&["equilibrium"][..], &["run", "-o", &scratch.path("out")]] {
        let warning = told(&heavy, command);
        assert!(warning.contains("warning: the largest contact pressure is 4"), "{warning}");
    }
}

#[test]
fn regression_a_closed_pipe_ends_quietly() {
    for arguments in [&["describe"][..], &["equilibrium"], &["equilibrium", "--json"]] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_roulement"))
            .args([arguments[0], &scene("thrust")])
            .args(&arguments[1..])
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        // The reader goes before anything is printed.
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{arguments:?}");
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    }
}

#[test]
fn prints_say_whose_force_it_is() {
    let output = roulement(&["equilibrium", &scene("thrust")]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("external load Fx 1500.000 N") && text.contains("the bearing's force on it"),
        "{text}"
    );
    let output = roulement(&["equilibrium", &scene("thrust"), "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["load_is"].as_str().unwrap().contains("external load on the inner race"));
    assert_eq!(json["race"], "inner");
    let scratch = Scratch::new("whose");
    std::fs::write(scratch.path("short.toml"), edited("thrust", &[("load.duration", "\"0.1 ms\"")])).unwrap();
    let output = roulement(&["run", &scratch.path("short.toml"), "-o", &scratch.path("out")]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("bearing's force  x -1") && text.contains("of the bearing on the inner race"),
        "{text}"
    );
    // That of an outer race under a wrench, which moves instead.
    let outer = [
        ("inner.drive", "\"fixed\""),
        ("outer", "{ drive = \"wrench\", mass = 0.2, inertia = [6e-5, 4e-5, 4e-5] }"),
        ("load.x", ""),
        ("load.outer.x.force", "\"-1500 N\""),
        ("load.duration", "\"0.1 ms\""),
    ];
    std::fs::write(scratch.path("outer.toml"), edited("thrust", &outer)).unwrap();
    let output = roulement(&["equilibrium", &scratch.path("outer.toml")]);
    let text = String::from_utf8(output.stdout).unwrap();
    for part in ["outer race    x -", "external load Fx -1500.000 N", "(on the outer race;"] {
        assert!(text.contains(part), "{text}");
    }
    let output = roulement(&["run", &scratch.path("outer.toml"), "-o", &scratch.path("outer")]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("of the bearing on the outer race") && text.contains("outer race at    x -"),
        "{text}"
    );
    let plot = std::fs::read_to_string(scratch.path("outer/bearing.svg")).unwrap();
    assert!(plot.contains("force of the bearing on outer race [N]"));
    let plot = std::fs::read_to_string(scratch.path("out/bearing.svg")).unwrap();
    assert!(plot.contains("force of the bearing on inner race [N]"));
}

#[test]
fn a_missing_library_is_named() {
    let scratch = Scratch::new("library");
    let package = scratch.path("x.fmu");
    let output = roulement(&["fmu", &scene("thrust"), "-o", &package, "--library", &scratch.path("none.so")]);
    assert!(!output.status.success());
    assert!(String::from_utf8(output.stderr).unwrap().contains("none.so"));
    assert!(!Path::new(&package).exists());
}

/// Header of an ELF library of 64 bits with a piece to load, for a machine by its number.
fn elf(machine: u8) -> Vec<u8> {
    let mut file = vec![0; 120];
    file[..7].copy_from_slice(b"\x7fELF\x02\x01\x01");
    // kind, machine, version; where the table of pieces is, its entries' size, their number
    for (at, value) in [(16, 3), (18, machine), (20, 1), (32, 64), (52, 64), (54, 56), (56, 1)] {
        file[at] = value;
    }
    // a piece to load, from the start to the end of the file
    (file[64], file[96]) = (1, 120);
    file
}

#[test]
fn only_libraries_of_the_platform_are_packed() {
    let scratch = Scratch::new("platforms");
    let (package, library, other) = (scratch.path("x.fmu"), scratch.path("a.so"), scratch.path("b.so"));
    let pack = |libraries: &[&str]| {
        let mut arguments = vec!["fmu".to_string(), scene("thrust"), "-o".into(), package.clone()];
        arguments.extend(libraries.iter().flat_map(|library| ["--library".into(), library.to_string()]));
        let output = roulement(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(output.status.success(), Path::new(&package).exists());
        String::from_utf8(output.stderr).unwrap()
    };
    std::fs::write(&library, elf(183)).unwrap();
    let message = pack(&[&library]);
    for part in ["a.so", "linux64", "Aarch64", "x86-64"] {
        assert!(message.contains(part), "{message}");
    }
    std::fs::write(&library, elf(62)).unwrap();
    std::fs::write(&other, elf(62)).unwrap();
    let message = pack(&[&library, &other]);
    assert!(message.contains("two libraries for linux64"), "{message}");
    assert_eq!(pack(&[&library]), "");
}

#[test]
fn an_interrupted_run_keeps_what_it_has() {
    let scratch = Scratch::new("interrupted");
    // A smallest step that contact cannot be resolved with, after a start that it can.
    let steps = [
        ("solver.initial_step", "\"10 us\""),
        ("solver.min_step", "\"9 us\""),
        ("solver.tolerance", "1e-12"),
    ];
    std::fs::write(scratch.path("hard.toml"), edited("thrust", &steps)).unwrap();
    let output = roulement(&["run", &scratch.path("hard.toml"), "-o", &scratch.path("out")]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    for part in ["solver.min_step", "ball", "inner load", "tolerance"] {
        assert!(message.contains(part), "{message}");
    }
    assert!(std::fs::read_to_string(scratch.path("out/results.csv")).unwrap().lines().count() >= 2);
}

#[test]
fn contact_prints_the_documented_columns_for_any_column_order() {
    let scratch = Scratch::new("contact");
    let table = "spin,note,id,creep_y,creep_x,semi_axis_y,semi_axis_x,peak_pressure,friction,shear_modulus,poisson_ratio,rolling_angle\n\
                 0,x,one,0,1e-3,1e-4,1e-4,1.2e9,0.08,8.1e10,0.3,0\n\
                 0,y,two,0,1e-1,1e-4,1e-4,1.2e9,0.08,8.1e10,0.3,0\n";
    std::fs::write(scratch.path("cases.csv"), table).unwrap();
    for law in ["frictionless", "linear", "regularised", "saturated", "kalker"] {
        let output = roulement(&["contact", "--law", law, &scratch.path("cases.csv"), "--degree", "3"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).unwrap();
        let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(lines[0], ["id", "fx", "fy", "mz", "power", "stick"]);
        assert_eq!((lines[1][0], lines[2][0], lines.len()), ("one", "two", 3));
        // A stick fraction only where the law has one.
        assert_eq!(lines[1][5].is_empty(), law != "kalker");
        let sliding: f64 = lines[2][1].parse().unwrap();
        if ["regularised", "saturated", "kalker"].contains(&law) {
            assert!((sliding - 1.0).abs() < 5e-3, "{law}: {sliding}");
        }
    }
    std::fs::write(scratch.path("cases.csv"), table.replace("1.2e9", "-1")).unwrap();
    let output = roulement(&["contact", "--law", "kalker", &scratch.path("cases.csv")]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(
        !output.status.success() && message.contains("peak_pressure") && message.contains("one"),
        "{message}"
    );
}

#[test]
fn contact_says_what_error_to_expect_where_the_table_rolls_obliquely() {
    let scratch = Scratch::new("oblique");
    let table = "id,creep_x,creep_y,spin,semi_axis_x,semi_axis_y,peak_pressure,friction,shear_modulus,poisson_ratio,rolling_angle\n\
                 one,1e-3,0,5,1e-4,1e-3,1.2e9,0.08,8.1e10,0.3,0.7\n\
                 two,1e-3,0,5,1e-4,1e-3,1.2e9,0.08,8.1e10,0.3,0\n";
    std::fs::write(scratch.path("cases.csv"), table).unwrap();
    for (law, expected) in [("kalker_table", true), ("kalker", false)] {
        let output = roulement(&["contact", "--law", law, &scratch.path("cases.csv")]);
        let note = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{note}");
        assert_eq!(
            note.contains("1 of these contacts rolls obliquely") && note.contains("0.03"),
            expected,
            "{note}"
        );
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 3);
    }
}

#[test]
fn columns_and_window_choose_what_is_written() {
    let scratch = Scratch::new("columns");
    std::fs::write(scratch.path("short.toml"), edited("thrust", &[("load.duration", "\"3 ms\"")])).unwrap();
    let run = |more: &[&str]| {
        let arguments = ["run", &scratch.path("short.toml"), "-o", &scratch.path("out")];
        roulement(&[&arguments[..], more].concat())
    };
    let output =
        run(&["--columns", "inner.force.*,ball[2].outer.load,friction_torque", "--window", "1 ms:0.002"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = std::fs::read_to_string(scratch.path("out/results.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[0],
        "time [s],inner.force.x [N],inner.force.y [N],inner.force.z [N],friction_torque [N.m],ball[2].outer.load [N]"
    );
    let times: Vec<f64> =
        lines[1..].iter().map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert_eq!((times.len(), times[0]), (11, 0.001));
    assert!((times[10] - 0.002).abs() < 1e-15);
    // Means are those of the run, whatever is written.
    assert!(String::from_utf8(output.stdout).unwrap().contains("means over the last 1.500 ms"));

    let output = run(&["--columns", "inner.farce.x"]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && message.contains("inner.farce.x"), "{message}");
    assert!(!run(&["--window", "2:1"]).status.success());
}

/// A run that takes long, once some of its rows are in its table.
#[cfg(unix)]
fn long_run(scratch: &Scratch) -> std::process::Child {
    let text = edited("thrust", &[("load.duration", "\"1000 s\""), ("load.output_interval", "\"20 us\"")]);
    std::fs::write(scratch.path("long.toml"), text).unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_roulement"))
        .args(["run", &scratch.path("long.toml"), "-o", &scratch.path("out")])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let rows =
        || std::fs::read_to_string(scratch.path("out/results.csv")).map_or(0, |table| table.lines().count());
    let begin = std::time::Instant::now();
    while rows() < 50 {
        assert!(begin.elapsed().as_secs() < 120, "no rows come");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    child
}

#[cfg(unix)]
fn signal(child: &std::process::Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// Rows of the table of a run, all whole.
#[cfg(unix)]
fn whole_rows(scratch: &Scratch) -> usize {
    let table = std::fs::read_to_string(scratch.path("out/results.csv")).unwrap();
    assert!(table.ends_with('\n'));
    let mut lines = table.lines();
    let columns = lines.next().unwrap().split(',').count();
    for line in lines.clone() {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        assert_eq!(fields.len(), columns);
    }
    lines.count()
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_the_row_and_gives_summary_and_plots() {
    let scratch = Scratch::new("interrupt");
    let child = long_run(&scratch);
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(whole_rows(&scratch) >= 50);
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.contains("friction torque") && summary.contains("energy"), "{summary}");
    for name in ["contacts.svg", "bearing.svg", "balls.svg", "means.csv", "summary.txt"] {
        assert!(std::fs::read_to_string(scratch.path(&format!("out/{name}"))).unwrap().len() > 100, "{name}");
    }
    assert!(String::from_utf8(output.stderr).unwrap().contains("interrupted at"));
}

#[cfg(unix)]
#[test]
fn a_killed_run_leaves_whole_rows() {
    let scratch = Scratch::new("killed");
    let mut child = long_run(&scratch);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(whole_rows(&scratch) >= 50);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error_and_no_panic() {
    let scratch = Scratch::new("full");
    std::fs::write(scratch.path("short.toml"), edited("thrust", &[("load.duration", "\"1 ms\"")])).unwrap();
    let run = |full: bool| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_roulement"));
        command.args(["run", &scratch.path("short.toml"), "-o", &scratch.path("out")]);
        if full {
            command.stdout(std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap());
        }
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        String::from_utf8(output.stderr).unwrap()
    };
    let message = run(true);
    assert!(
        message.contains("cannot write to the standard output") && !message.contains("panicked"),
        "{message}"
    );
    for name in ["results.csv", "bearing.svg", "means.csv", "summary.txt"] {
        let path = scratch.path(&format!("out/{name}"));
        std::fs::remove_file(&path).unwrap();
        std::os::unix::fs::symlink("/dev/full", &path).unwrap();
        let message = run(false);
        assert!(message.contains(name) && !message.contains("panicked"), "{message}");
        std::fs::remove_file(&path).unwrap();
    }
}

/// Lines of the summary of a run that begin with a word.
fn summary_of(scratch: &Scratch, name: &str, changes: &[(&str, &str)], word: &str) -> Vec<String> {
    std::fs::write(scratch.path("scene.toml"), edited(name, changes)).unwrap();
    let output = roulement(&["run", &scratch.path("scene.toml"), "-o", &scratch.path("out")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let file = std::fs::read_to_string(scratch.path("out/summary.txt")).unwrap();
    assert!(text.starts_with(&file));
    text.lines().filter(|line| line.starts_with(word)).map(str::to_string).collect()
}

#[test]
fn a_run_says_whether_its_means_have_settled() {
    let scratch = Scratch::new("settled");
    // The balls start at a tenth of their speed: friction brings them up within half a millisecond.
    let slow = [("start.orbital_speed", "26.0"), ("load.output_interval", "\"10 us\"")];
    let short = [&slow[..], &[("load.duration", "\"0.4 ms\"")]].concat();
    let unsettled = summary_of(&scratch, "thrust", &short, "NOT SETTLED");
    assert!(unsettled.iter().any(|line| line.contains("cage speed")), "{unsettled:?}");
    let table = std::fs::read_to_string(scratch.path("out/means.csv")).unwrap();
    let cage: Vec<&str> =
        table.lines().find(|line| line.starts_with("cage speed")).unwrap().split(',').collect();
    assert_eq!(cage[8], "false", "{table}");
    let long = [&slow[..], &[("load.duration", "\"4 ms\"")]].concat();
    let unsettled = summary_of(&scratch, "thrust", &long, "NOT SETTLED");
    assert!(!unsettled.iter().any(|line| line.contains("cage speed")), "{unsettled:?}");
    // Where the loads go on to change, nothing settles.
    let ramp = [("load.inner_speed", "[[0, 500], [1, 1000]]"), ("load.duration", "\"10 ms\"")];
    let unsettled = summary_of(&scratch, "thrust", &ramp, "NOT SETTLED");
    assert!(unsettled.iter().any(|line| line.contains("cage speed")), "{unsettled:?}");
}

#[test]
fn a_run_whose_energy_does_not_close_says_so_with_the_cause() {
    let scratch = Scratch::new("energy");
    // Steps of 0.1 ms without damping, where a ball swings with 45 kHz.
    let long_steps = [
        ("solver.max_step", "1e-3"),
        ("solver.initial_step", "1e-3"),
        ("solver.tolerance", "1e-2"),
        ("effects.damping", "0.0"),
        ("friction.ball_race", "0.001"),
        ("load.x.force", "[[0, 1500], [\"0.1 ms\", 4000]]"),
        ("load.duration", "\"10 ms\""),
    ];
    let warnings = summary_of(&scratch, "thrust", &long_steps, "WARNING");
    let parts = ["energy does not close to 1 %", "natural frequency", "steps a period", "solver.max_step"];
    assert!(warnings.len() == 1 && parts.iter().all(|part| warnings[0].contains(part)), "{warnings:?}");
    // Balls that lose and find their contacts, in long steps.
    let impacts = [
        ("solver.max_step", "2e-4"),
        ("solver.initial_step", "2e-4"),
        ("solver.tolerance", "1e-2"),
        ("effects.creep", "\"frictionless\""),
        ("effects.damping", "0.0"),
        (
            "load.y.force",
            "[[0, 1500], [\"2 ms\", -1500], [\"4 ms\", 1500], [\"6 ms\", -1500], [\"50 ms\", 1500]]",
        ),
    ];
    let warnings = summary_of(&scratch, "radial", &impacts, "WARNING");
    assert!(
        warnings.len() == 1 && warnings[0].contains("likely impacts: contacts opened or closed"),
        "{warnings:?}"
    );
    // One that closes says nothing, whatever its friction.
    for friction in ["0.08", "0.0"] {
        let good = [("load.duration", "\"5 ms\""), ("friction.ball_race", friction)];
        assert_eq!(summary_of(&scratch, "thrust", &good, "WARNING"), Vec::<String>::new());
    }
}

const CONTACTS: &str = "id,creep_x,creep_y,spin,semi_axis_x,semi_axis_y,peak_pressure,friction,shear_modulus,poisson_ratio,rolling_angle\n\
                        one,1e-2,0,5,1e-4,3e-4,1.2e9,0.08,8.1e10,0.3,0.7\n\
                        two,1e-2,3e-3,20,1e-4,3e-4,1.2e9,0.08,8.1e10,0.3,-0.4\n\
                        again,1e-2,0,5,1e-4,3e-4,1.2e9,0.08,8.1e10,0.3,0.7\n";

/// `contact --law kalker_table --exact` of a table, with a cache directory: forces, and what is told.
fn exact(scratch: &Scratch, table: &str) -> (String, String) {
    std::fs::write(scratch.path("cases.csv"), table).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_roulement"))
        .args(["contact", "--law", "kalker_table", "--exact", &scratch.path("cases.csv")])
        .env("XDG_CACHE_HOME", scratch.path("cache"))
        .output()
        .unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{told}");
    (String::from_utf8(output.stdout).unwrap(), told)
}

#[test]
fn exact_contacts_are_kept_and_computed_anew_where_anything_differs() {
    let scratch = Scratch::new("exact");
    let (computed, told) = exact(&scratch, CONTACTS);
    let file = scratch.path("cache/roulement/contacts.csv");
    // The third contact is the first again.
    assert!(told.contains("3 contacts, 2 of them computed") && told.contains(&file), "{told}");
    let rows: Vec<&str> = computed.lines().collect();
    assert_eq!((rows[0], rows.len()), ("id,fx,fy,mz,power,stick", 4));
    assert_eq!(rows[1].strip_prefix("one"), rows[3].strip_prefix("again"));
    let kept = exact(&scratch, CONTACTS);
    assert!(kept.1.contains("3 contacts, 0 of them computed"), "{}", kept.1);
    assert_eq!(kept.0, computed);
    // Whatever an answer depends on.
    for (from, to) in [
        ("two,1e-2", "two,2e-2"),
        (",3e-3,20", ",2e-3,20"),
        (",20,", ",19,"),
        ("20,1e-4,", "20,1.1e-4,"),
        ("0.3,-0.4", "0.29,-0.4"),
        ("0.3,-0.4", "0.3,-0.41"),
    ] {
        let (forces, told) = exact(&scratch, &CONTACTS.replace(from, to));
        assert!(told.contains("3 contacts, 1 of them computed"), "{to}: {told}");
        let line = forces.lines().nth(2).unwrap();
        assert!(line.starts_with("two,") && line != rows[2], "{to}: {line}");
    }
    // Load and friction alone are nothing but a scale: the answer is kept.
    let (_, told) = exact(&scratch, &CONTACTS.replace("1.2e9,0.08", "0.6e9,0.16"));
    assert!(told.contains("3 contacts, 0 of them computed"), "{told}");
    // Nothing but the file is there.
    assert_eq!(std::fs::read_dir(scratch.path("cache/roulement")).unwrap().count(), 1);
}

#[test]
fn exact_contacts_of_a_damaged_or_older_cache_are_computed_anew() {
    let scratch = Scratch::new("damaged");
    let (computed, _) = exact(&scratch, CONTACTS);
    let file = scratch.path("cache/roulement/contacts.csv");
    let text = std::fs::read_to_string(&file).unwrap();
    let [title, first, _] = text.lines().collect::<Vec<_>>()[..] else { panic!("{text}") };
    let older = text.replace(title, "# rolling contacts of roulement 0.0.1, form 1");
    // A force that reads as one and is none, half a file, another version, and no text at all.
    let place = first.match_indices(',').nth(7).unwrap().0 - 3;
    let digit = if &first[place..=place] == "1" { "2" } else { "1" };
    let altered = text.replace(first, &format!("{}{digit}{}", &first[..place], &first[place + 1..]));
    for (damaged, count, words) in [
        (altered.as_bytes(), 1, "1 line of"),
        (&text.as_bytes()[..text.len() - 40], 1, "1 line of"),
        (older.as_bytes(), 2, "another version"),
        (&[0xff, 0xfe, 0x00, 0x80][..], 2, "is damaged or"),
    ] {
        assert_ne!(damaged, text.as_bytes());
        std::fs::write(&file, damaged).unwrap();
        let (forces, told) = exact(&scratch, CONTACTS);
        assert!(told.contains(&format!("{count} of them computed")) && told.contains(words), "{told}");
        assert_eq!(forces, computed);
        let (_, told) = exact(&scratch, CONTACTS);
        assert!(told.contains(" 0 of them computed") && !told.contains(words), "{told}");
    }
    // A directory in its place: told, and no obstacle.
    std::fs::remove_file(&file).unwrap();
    std::fs::create_dir(&file).unwrap();
    let (forces, told) = exact(&scratch, CONTACTS);
    assert!(told.contains("cannot read") && told.contains("cannot write") && told.contains(&file), "{told}");
    assert_eq!(forces, computed);
}

#[test]
fn exact_is_refused_where_it_has_no_meaning() {
    let scratch = Scratch::new("exact-options");
    let cases = scratch.path("cases.csv");
    std::fs::write(&cases, CONTACTS).unwrap();
    let refused = |arguments: &[&str]| {
        let output = roulement(&[&["contact", &cases], arguments].concat());
        assert!(!output.status.success() && output.stdout.is_empty());
        String::from_utf8(output.stderr).unwrap()
    };
    let message = refused(&["--law", "kalker", "--exact"]);
    assert!(message.contains("--exact is an option of --law kalker_table, not of kalker"), "{message}");
    for other in ["--grid", "--degree"] {
        let message = refused(&["--law", "kalker_table", "--exact", other, "5"]);
        assert!(message.contains("'--exact' cannot be used with") && message.contains(other), "{message}");
    }
    let message = refused(&["--law", "kalker_table", "--no-cache"]);
    assert!(message.contains("--exact"), "{message}");
    // Nothing is computed, and nothing printed, before all contacts are known to be in range.
    std::fs::write(&cases, CONTACTS.replace("again,1e-2,0,5,1e-4", "again,1e-2,0,5,1e-6")).unwrap();
    let message = refused(&["--law", "kalker_table", "--exact", "--no-cache"]);
    assert!(message.contains("case again") && message.contains("[0.018, 55]"), "{message}");
}

#[test]
fn exact_contacts_need_no_cache() {
    let scratch = Scratch::new("no-cache");
    std::fs::write(scratch.path("cases.csv"), CONTACTS).unwrap();
    let told = |extra: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_roulement"))
            .args(["contact", "--law", "kalker_table", "--exact", &scratch.path("cases.csv")])
            .args(extra)
            .env("XDG_CACHE_HOME", "relative/paths/do/not/count")
            .env_remove("HOME")
            .env_remove("LOCALAPPDATA")
            .output()
            .unwrap();
        assert!(output.status.success() && output.stdout.len() > 100);
        String::from_utf8(output.stderr).unwrap()
    };
    let nowhere = told(&[]);
    assert!(nowhere.contains("nothing is kept") && nowhere.contains("2 of them computed"), "{nowhere}");
    let unwanted = told(&["--no-cache"]);
    assert!(!unwanted.contains("kept") && unwanted.contains("2 of them computed"), "{unwanted}");
}
