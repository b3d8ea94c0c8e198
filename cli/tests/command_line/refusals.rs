//! Scenes, libraries and pipes that are wrong, and what is told of them.

use super::*;

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
        std::fs::write(&file, edited("thrust", changes).source).unwrap();
        let output = roulement(&[&[command[0], &file], &command[1..]].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(told(&[], &["equilibrium"]), "");
    let conformities = [("bearing.inner_conformity", ""), ("bearing.outer_conformity", "")];
    let note = told(&conformities, &["equilibrium", "--json"]);
    assert!(note.contains("inner_conformity = 0.52 and bearing.outer_conformity = 0.53"), "{note}");
    // 70,000 rpm on 46 mm are n dm = 3.22e6, but on the bore no more than 2.1e6: what is known to run is said of the bore.
    assert_eq!(told(&[("load.inner_speed", "\"70000 rpm\"")], &["describe"]), "");
    let fast = told(&[("load.inner_speed", "\"110000 rpm\"")], &["describe"]);
    assert!(fast.contains("DN = 3.33e6 mm/min"), "{fast}");
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
fn a_missing_library_is_named() {
    let scratch = Scratch::new("library");
    let package = scratch.path("x.fmu");
    let output = roulement(&["fmu", &scene("thrust"), "-o", &package, "--library", &scratch.path("none.so")]);
    assert!(!output.status.success());
    assert!(String::from_utf8(output.stderr).unwrap().contains("none.so"));
    assert!(!Path::new(&package).exists());
}

/// Header of an ELF library of 64 bits with a piece to load, for a machine by its number.
pub fn elf(machine: u8) -> Vec<u8> {
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
    std::fs::write(&library, elf(243)).unwrap();
    let message = pack(&[&library]);
    for part in ["a.so", "linux64 or aarch64-linux", "Riscv64", "x86-64 or aarch64"] {
        assert!(message.contains(part), "{message}");
    }
    std::fs::write(&library, elf(62)).unwrap();
    std::fs::write(&other, elf(62)).unwrap();
    let message = pack(&[&library, &other]);
    assert!(message.contains("two libraries for linux64"), "{message}");
    assert_eq!(pack(&[&library]), "");
    // One for each machine of a system.
    std::fs::write(&other, elf(183)).unwrap();
    assert_eq!(pack(&[&library, &other]), "");
    for folder in ["linux64", "aarch64-linux"] {
        assert_eq!(system::unzipped(&package, &format!("binaries/{folder}/x.so")).len(), 120);
    }
}

/// What the program says of input that it must refuse at once: one that waits is ended, and fails the test.
#[cfg(unix)]
fn refusal(arguments: &[&str]) -> String {
    let mut child = Command::new(env!("CARGO_BIN_EXE_roulement"))
        .args(arguments)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let begin = std::time::Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begin.elapsed().as_secs() > 20 {
            child.kill().unwrap();
            panic!("{arguments:?} waits");
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
    message
}

#[cfg(unix)]
#[test]
fn regression_only_regular_files_are_read_and_no_huge_ones() {
    let scratch = Scratch::new("regular");
    let (pipe, huge) = (scratch.path("pipe"), scratch.path("huge"));
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    // Takes no room on the disk.
    std::fs::File::create(&huge).unwrap().set_len(501_000_000).unwrap();
    let file = |name: &str, text: &str| {
        std::fs::write(scratch.path(name), text).unwrap();
        scratch.path(name)
    };
    let text = std::fs::read_to_string(scene("thrust")).unwrap();
    let shaft = std::fs::read_to_string(scene("shafts/pinion")).unwrap();
    let catalogue = shaft.lines().find(|line| line.starts_with("catalogue = ")).unwrap();
    for (path, why) in [
        (pipe.as_str(), "it is a pipe or a device, not a regular file"),
        ("/dev/zero", "it is a pipe or a device, not a regular file"),
        (&scratch.path(""), "it is a folder, not a regular file"),
        (&huge, "it is larger than 500 MB, the limit of such a file"),
    ] {
        let cases = file("cases.csv", "friction.ball_race\n0.05\n");
        let measured = text.replace(
            "x = { force = \"1500 N\" }",
            &format!("x = {{ force = {{ file = \"{path}\", time = \"t [s]\", value = \"F [N]\" }} }}"),
        );
        let profile = text.clone() + &format!("\n[form]\ninner = {{ profile = \"{path}\" }}\n");
        let included = shaft.replacen(catalogue, &format!("scene = \"{path}\""), 1);
        let rigid = ["mass = ", "polar_inertia = ", "transverse_inertia = "];
        let bare = shaft.lines().filter(|line| !rigid.iter().any(|key| line.starts_with(key)));
        let matrices = bare.collect::<Vec<_>>().join("\n");
        let matrices = matrices.replacen("[shaft]", &format!("[shaft]\nmatrices = \"{path}\""), 1);
        let (measured, profile) = (file("measured.toml", &measured), file("profile.toml", &profile));
        let (included, matrices) = (file("included.toml", &included), file("matrices.toml", &matrices));
        for (arguments, key) in [
            (&["run", path][..], ""),
            (&["equilibrium", path], ""),
            (&["describe", path], ""),
            (&["fmu", path, "-o", "x.fmu"], ""),
            (&["cost", path], ""),
            (&["system", path, "-o", &scratch.path("system")], ""),
            (&["contact", "--law", "saturated", path], ""),
            (&["sweep", path, "--scene", &scene("thrust")], ""),
            (&["sweep", &cases, "--scene", path], ""),
            (&["run", &measured], "load.x.force"),
            (&["run", &profile], "form.inner.profile"),
            (&["run", &included], "bearing.scene"),
            (&["run", &matrices], "shaft.matrices"),
        ] {
            let message = refusal(arguments);
            for part in [why, path, key] {
                assert!(message.contains(part), "{arguments:?}: {message}\nshould say {part}");
            }
        }
    }
}

#[test]
fn regression_oil_that_hardly_flows_is_named_where_no_step_can_be_made() {
    let scratch = Scratch::new("thick-oil");
    let oil = [
        ("effects.damping", "\"0.02 s/m\""),
        ("film", "{ iso_vg = 5000, temperature = \"-20 degC\" }"),
        ("effects.creep", "\"kalker_table\""),
    ];
    let output = scratch.run(&edited("radial", &oil), "out", &[]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    let error = message.lines().find(|line| line.starts_with("error: ")).unwrap();
    println!("{error}");
    // Walther's law with the slope of the grade: tests/effects has the viscosity.
    for part in
        ["the oil is too thick: ISO VG 5000 at -20 degC has 17860 Pa s", "film.temperature", "at 0 s "]
    {
        assert!(error.contains(part), "{error}\nshould say {part}");
    }
    // No number of the message has more than four digits: it is what a run came to, and no input.
    for number in error.split(|c: char| !c.is_ascii_digit() && c != '.') {
        let digits = number.trim_matches('.').trim_start_matches(['0', '.']).replace('.', "");
        assert!(digits.trim_end_matches('0').len() <= 4, "{number} in {error}");
    }
}
