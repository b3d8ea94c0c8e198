//! `roulement run` and `equilibrium`: what they write and print, also when they are interrupted.

use roulement::scene::Scene;

use super::*;

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
    let text = edited("thrust", &[("load.duration", "\"2 ms\"")]).source;
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
        // Ten units in a pixel: curves have no stairs.
        assert_eq!(units_in_a_pixel(&picture), 10.0);
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
    std::fs::write(scratch.path("short.toml"), edited("thrust", &[("load.duration", "\"0.1 ms\"")]).source)
        .unwrap();
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
    std::fs::write(scratch.path("outer.toml"), edited("thrust", &outer).source).unwrap();
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
fn an_interrupted_run_keeps_what_it_has() {
    let scratch = Scratch::new("interrupted");
    // A smallest step that contact cannot be resolved with, after a start that it can.
    let steps = [
        ("solver.initial_step", "\"10 us\""),
        ("solver.min_step", "\"9 us\""),
        ("solver.tolerance", "1e-12"),
    ];
    std::fs::write(scratch.path("hard.toml"), edited("thrust", &steps).source).unwrap();
    let output = roulement(&["run", &scratch.path("hard.toml"), "-o", &scratch.path("out")]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    for part in ["solver.min_step", "ball", "inner load", "tolerance"] {
        assert!(message.contains(part), "{message}");
    }
    assert!(std::fs::read_to_string(scratch.path("out/results.csv")).unwrap().lines().count() >= 2);
}

#[test]
fn columns_and_window_choose_what_is_written() {
    let scratch = Scratch::new("columns");
    std::fs::write(scratch.path("short.toml"), edited("thrust", &[("load.duration", "\"3 ms\"")]).source)
        .unwrap();
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

/// A run that takes long, once some of its rows are in its table, as yet without any of another run.
#[cfg(unix)]
fn long_run(scratch: &Scratch) -> std::process::Child {
    let text =
        edited("thrust", &[("load.duration", "\"1000 s\""), ("load.output_interval", "\"20 us\"")]).source;
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
    // The head and fifty rows, and one that may not be whole yet.
    while rows() < 52 {
        assert!(begin.elapsed().as_secs() < 120, "no rows come");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    child
}

#[cfg(unix)]
fn signal(child: &std::process::Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// The table of a run.
#[cfg(unix)]
fn table_of(scratch: &Scratch) -> String {
    std::fs::read_to_string(scratch.path("out/results.csv")).unwrap()
}

/// Rows of a table, all whole.
#[cfg(unix)]
fn whole_rows(table: &str) -> usize {
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
    for name in ["-INT", "-TERM"] {
        ends_with_what_it_has(name);
    }
}

#[cfg(unix)]
fn ends_with_what_it_has(name: &str) {
    let scratch = Scratch::new("interrupt");
    let child = long_run(&scratch);
    signal(&child, name);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(whole_rows(&table_of(&scratch)) >= 50);
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.contains("friction torque") && summary.contains("energy"), "{summary}");
    for name in ["contacts.svg", "bearing.svg", "balls.svg", "means.csv", "summary.txt"] {
        assert!(std::fs::read_to_string(scratch.path(&format!("out/{name}"))).unwrap().len() > 100, "{name}");
    }
    assert!(String::from_utf8(output.stderr).unwrap().contains("interrupted at"));
}

/// A folder has the files of one run, whatever ended it: what a former run left is gone before the first row.
#[cfg(unix)]
#[test]
fn regression_a_killed_run_is_not_taken_for_the_one_before_it() {
    let scratch = Scratch::new("owned");
    let page = scratch.path("page.html");
    let report = |of: &str| roulement(&["report", &scratch.path(of), "-o", &page]);
    let short = edited("thrust", &[("load.duration", "\"5 ms\"")]);
    let whole = scratch.run(&short, "out", &[]);
    assert!(whole.status.success(), "{}", String::from_utf8_lossy(&whole.stderr));
    let made = |of: &str| -> Vec<String> {
        let files = std::fs::read_dir(scratch.path(of)).unwrap();
        let mut names: Vec<String> =
            files.map(|file| file.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    };
    assert!(made("out").len() >= 7 && report("out").status.success(), "{:?}", made("out"));
    let mine = scratch.path("out/notes.txt");
    std::fs::write(&mine, "mine").unwrap();
    std::fs::remove_file(scratch.path("out/results.csv")).unwrap();

    let mut child = long_run(&scratch);
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(made("out"), ["notes.txt", "results.csv", "run.json"]);
    let refused = report("out");
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success() && message.contains("is unfinished"), "{message}");

    // The next run has the folder again; one that is refused leaves it as it is.
    assert!(scratch.run(&short, "out", &[]).status.success());
    let before = made("out");
    assert!(!scratch.run(&short, "out", &["--columns", "inner.farce.x"]).status.success());
    assert!(made("out") == before && report("out").status.success());
    let record = scratch.read("out/run.json");
    assert!(record.contains("\"ended_early\":null") && !record.contains("unfinished"));
}

#[cfg(unix)]
#[test]
fn regression_a_shaft_that_is_killed_is_not_taken_for_the_one_before_it() {
    let scratch = Scratch::new("owned-shaft");
    let text = std::fs::read_to_string(scene("shafts/pinion")).unwrap();
    let run = |duration: &str| {
        std::fs::write(scratch.path("shaft.toml"), text.replace("\"20 ms\"", duration)).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_roulement"));
        command.args(["run", &scratch.path("shaft.toml"), "-o", &scratch.path("out")]);
        command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap()
    };
    let table =
        || std::fs::read_to_string(scratch.path("out/shaft.csv")).map_or(0, |text| text.lines().count());
    let report = || roulement(&["report", &scratch.path("out/left"), "-o", &scratch.path("page.html")]);
    assert!(run("\"0.5 ms\"").wait_with_output().unwrap().status.success() && report().status.success());
    std::fs::remove_file(scratch.path("out/shaft.csv")).unwrap();
    let there = |name: &str| Path::new(&scratch.path(&format!("out/{name}"))).exists();
    for name in ["-KILL", "-TERM"] {
        let child = run("\"1000 s\"");
        let begin = std::time::Instant::now();
        while table() < 8 {
            assert!(begin.elapsed().as_secs() < 120, "no rows come");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        let ended = name == "-TERM";
        assert_eq!(output.status.code(), ended.then_some(130));
        for file in ["summary.txt", "shaft.svg", "left/summary.txt", "right/means.csv", "right/bearing.svg"] {
            assert_eq!(there(file), ended, "{name}: {file}");
        }
        assert_eq!(report().status.success(), ended, "{name}");
        if !ended {
            std::fs::remove_file(scratch.path("out/shaft.csv")).unwrap();
        }
    }
}

#[cfg(unix)]
#[test]
fn a_killed_run_leaves_whole_rows() {
    let scratch = Scratch::new("killed");
    let mut child = long_run(&scratch);
    child.kill().unwrap();
    child.wait().unwrap();
    // Linux stops a write of a killed program between two pages: the last row may have no end. 1 of 60 runs left such a one.
    let table = table_of(&scratch);
    let (whole, _) = table.split_at(table.rfind('\n').unwrap() + 1);
    assert!(whole_rows(whole) >= 50);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error_and_no_panic() {
    let scratch = Scratch::new("full");
    std::fs::write(scratch.path("short.toml"), edited("thrust", &[("load.duration", "\"1 ms\"")]).source)
        .unwrap();
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
        // A run that failed has taken away what it could not write anew.
        let _ = std::fs::remove_file(&path);
        std::os::unix::fs::symlink("/dev/full", &path).unwrap();
        let message = run(false);
        assert!(message.contains(name) && !message.contains("panicked"), "{message}");
        std::fs::remove_file(&path).unwrap();
    }
}

/// Lines of the summary of a run that begin with a word.
fn summary_of(scratch: &Scratch, name: &str, changes: &[(&str, &str)], word: &str) -> Vec<String> {
    std::fs::write(scratch.path("scene.toml"), edited(name, changes).source).unwrap();
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
        ("solver.max_step", "1e-4"),
        ("solver.initial_step", "1e-4"),
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
        ("solver.max_step", "1e-4"),
        ("solver.initial_step", "1e-4"),
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

#[test]
fn run_at_the_level_equilibrium_writes_an_equilibrium_per_row() {
    let scratch = Scratch::new("statics");
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/effects/statics.toml");
    let output = roulement(&["run", scene, "-o", &scratch.path("out")]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !said.contains("energy"), "{said}");
    let mut table = csv::Reader::from_path(scratch.path("out/results.csv")).unwrap();
    let header = table.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|column| column == name).unwrap();
    let [force, place, stiffness] =
        ["inner.force.y [N]", "inner.position.y [m]", "stiffness.y.y [N/m]"].map(column);
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 21);
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    for row in 2..20 {
        assert!((number(row, force) + 150.0 * row as f64).abs() < 1.0);
        // The stiffness is the slope of the load deflection curve.
        let slope = 300.0 / (number(row + 1, place) - number(row - 1, place));
        assert!((number(row, stiffness) / slope - 1.0).abs() < 0.05, "{row}: {slope}");
    }
}

#[test]
fn pictures_leave_out_what_is_nothing_and_show_all_balls_where_they_differ() {
    let scratch = Scratch::new("pictures");
    let picture = |scene: &str, changes: &[(&str, &str)], name: &str| {
        let changes = [&[("load.duration", "\"2 ms\"")], changes].concat();
        assert!(scratch.run(&edited(scene, &changes), scene, &[]).status.success());
        scratch.read(&format!("{scene}/{name}"))
    };
    // Under thrust there is no moment across the axis, and all balls are alike; under a radial load they are not.
    let bearing = picture("thrust", &[], "bearing.svg");
    assert!(
        !bearing.contains("moment of the bearing")
            && bearing.contains("force of the bearing on inner race [N]")
    );
    // The title has these words, too.
    let keys = |contacts: &str| contacts.matches("all balls\n</text>").count() - 1;
    assert_eq!(keys(&scratch.read("thrust/contacts.svg")), 0);
    let contacts = picture("cage", &[], "contacts.svg");
    assert!(keys(&contacts) > 5 && contacts.contains("peak pressure [MPa]"));
    // Of balls without friction nothing is lost.
    let balls = picture("thrust", &[("effects.creep", "\"frictionless\"")], "balls.svg");
    assert!(balls.contains("load [N]") && !balls.contains("friction power [W]"));
}

/// A bearing that stops, turns back or swings, with another script of its speed where one is given.
fn resting(text: &str, speed: Option<&str>) -> Scene {
    Scene::edited(text, speed.map(|speed| ("load.inner_speed", speed))).unwrap()
}

/// A column of a table.
fn column(table: &str, name: &str) -> Vec<f64> {
    let at = table.lines().next().unwrap().split(',').position(|head| head == name).unwrap();
    table.lines().skip(1).map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

#[test]
fn closed_form_mean_slip_is_the_speed_of_slip_over_the_speed_of_rolling() {
    let stop = include_str!("../../../tests/data/rest/stop_and_reverse.toml");
    let swing = include_str!("../../../tests/data/rest/oscillating.toml");
    for (text, speed) in
        [(stop, None), (swing, None), (stop, Some("0")), (stop, Some("[[0, \"300 rpm\"], [0.02, 0]]"))]
    {
        let scratch = Scratch::new("rest");
        let output = scratch.run(&resting(text, speed), "out", &["--json"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let json: Value = serde_json::from_slice(&output.stdout).unwrap();
        let figure =
            |name: &str| json["figures"][name].as_f64().unwrap_or_else(|| panic!("{speed:?} {name}"));
        assert!(json["figures"].as_object().unwrap().values().all(Value::is_number), "{}", json["figures"]);
        let table = scratch.read("out/results.csv");
        let speeds = column(&table, "cage.speed [rad/s]");
        let begin = json["means"]["window"][0].as_f64().unwrap();
        let times = column(&table, "time [s]");
        for (name, of) in [("cage slip", "cage.slip [1]"), ("ball slip", "balls.slip [1]")] {
            // By rows: slip is behind/rolling, and rolling is the cage's speed but for its own slip.
            let (cage, slips) = (column(&table, "cage.slip [1]"), column(&table, of));
            let (mut behind, mut rolled) = (0.0, 0.0);
            for i in (0..times.len()).filter(|i| times[*i] >= begin - 1e-9) {
                let rolling = speeds[i].abs() / (1.0 - cage[i]);
                (behind, rolled) = (behind + slips[i] * rolling, rolled + rolling);
            }
            let expected = behind / rolled;
            // Below 1e-3 m/s the row's slip is not the quotient that gives the speed of rolling, within a thousandth of it.
            assert!(
                (figure(name) - expected).abs() < 2e-3 * expected.abs() + 1e-9,
                "{name} {expected} {}",
                figure(name)
            );
            assert!(figure(name).abs() < 2e-3, "{name} {}", figure(name));
        }
        for mean in scratch.read("out/means.csv").lines().skip(1) {
            assert!(!mean.contains("NaN") && !mean.contains("inf"), "{mean}");
        }
        let text = String::from_utf8(scratch.run(&resting(text, speed), "out", &[]).stdout).unwrap();
        let line = text.lines().find(|line| line.contains("% below epicyclic")).unwrap();
        assert!(line.split_whitespace().all(|word| word.len() < 12), "{line}");
    }
}

#[test]
fn a_bearing_that_stands_has_no_error_of_its_creep() {
    // What creeps by nanometres a second has no exact speed, and nobody asks for it.
    let stop = include_str!("../../../tests/data/rest/stop_and_reverse.toml");
    for speed in ["0", "[[0, \"300 rpm\"], [0.02, 0]]"] {
        let scratch = Scratch::new("stands");
        let output = scratch.run(&resting(stop, Some(speed)), "out", &["--error", "1e-3"]);
        let text = String::from_utf8_lossy(&output.stdout);
        let errs = ["CHAOTIC          cage speed", " inf", "NaN"].iter().any(|word| text.contains(word));
        assert!(output.status.success() && !errs, "{speed}: {text}");
    }
}

#[test]
fn consistency_methods_of_order_two_and_three_agree_within_their_error_bars() {
    let scratch = Scratch::new("methods");
    let of = |method: &str| {
        let method = format!("\"{method}\"");
        let scene = edited("radial", &[("solver.method", method.as_str()), ("load.duration", "\"4 ms\"")]);
        let output = scratch.run(&scene, "out", &["--error", "--json"]);
        let summary: Value = serde_json::from_str(&super::sweep::good(&output)).unwrap();
        summary["means"]["quantities"].as_array().unwrap().clone()
    };
    let (two, three) = (of("hht"), of("esdirk3"));
    let mut compared = 0;
    for (one, other) in two.iter().zip(&three) {
        assert_eq!(one["quantity"], other["quantity"]);
        let [mean, error] = ["mean", "error"].map(|key| [one, other].map(|of| of[key].as_f64().unwrap()));
        // Below a millionth of 1500 N nothing was asked for.
        let floor = 1e-6 * mean[0].abs();
        assert!((mean[0] - mean[1]).abs() <= error[0] + error[1] + floor, "{one} {other}");
        compared += usize::from(error.iter().all(|error| *error > 0.0));
    }
    assert!(compared >= 5, "{compared}");
}
