//! Single contacts: `roulement contact`.

use super::*;

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
            note.contains("1 of these contacts rolls obliquely") && note.contains("0.007"),
            expected,
            "{note}"
        );
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 3);
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

#[cfg(unix)]
#[test]
fn interrupted_contacts_are_printed_as_far_as_they_came() {
    let scratch = Scratch::new("contacts-interrupted");
    let (head, row) = CONTACTS.split_once('\n').unwrap();
    let row = row.lines().next().unwrap().split_once(',').unwrap().1;
    // By a solver that takes a while for each.
    let rows: String = (0..20_000).map(|i| format!("{i},{row}\n")).collect();
    std::fs::write(scratch.path("cases.csv"), format!("{head}\n{rows}")).unwrap();
    let answers = std::fs::File::create(scratch.path("answers.csv")).unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_roulement"))
        .args(["contact", "--law", "reference", &scratch.path("cases.csv")])
        .stdout(answers)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(5));
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(told.contains("interrupted"), "{told}");
    let text = scratch.read("answers.csv");
    assert!(text.ends_with('\n') && text.lines().count() > 1, "{text}");
    assert!(text.lines().all(|line| line.split(',').count() == 6), "{text}");
}

/// The 6206 of the data in tests/data/effects/ehl_film.csv and ehl_traction.csv: its oil, isothermal.
const OILED: &str = r#"
[bearing]
balls = 9
ball_diameter = "9.525 mm"
pitch_diameter = "46 mm"
diametral_clearance = "10 um"
[film]
viscosity = "58.5 mPa s"
inlet_heating = false
supply = "flooded"
[effects]
hysteresis = true
heathcote_slip = false
ambient = { density = 50, viscosity = 5e-4 }
[load]
inner_speed = "3000 rpm"
y = { force = 500 }
duration = "1 ms"
output_interval = "1 ms"
"#;

/// Rows of a table by the names of their columns.
fn named(text: &str) -> Vec<std::collections::HashMap<String, f64>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let of = |row: csv::StringRecord| {
        let cells = header.iter().zip(&row).filter_map(|(name, cell)| {
            let name = name.split(' ').next().unwrap_or(name);
            Some((name.to_string(), cell.parse().ok()?))
        });
        cells.collect()
    };
    reader.records().map(|row| of(row.unwrap())).collect()
}

#[test]
fn independent_data_films_of_a_scene_over_load_speed_and_slip() {
    let scratch = Scratch::new("film-contact");
    std::fs::write(scratch.path("oiled.toml"), OILED).unwrap();
    let films = include_str!("../../../tests/data/effects/ehl_film.csv");
    let rolling = include_str!("../../../tests/data/effects/rolling_resistance.csv");
    let mut seen = 0;
    for race in ["inner", "outer"] {
        let of_race = |text: &str| {
            let kept: Vec<&str> = text
                .lines()
                .enumerate()
                .filter(|(k, line)| *k == 0 || line.starts_with(race))
                .map(|l| l.1)
                .collect();
            named(&kept.join("\n"))
        };
        for row in of_race(films) {
            let (load, speed) = (row["load_N"], row["speed_m_s"]);
            let (loads, speeds) = (format!("{load} N"), format!("{speed} m/s"));
            let film = scratch.path("oiled.toml");
            let folder = scratch.path("film");
            let output = roulement(&[
                "contact",
                "--film",
                &film,
                "--race",
                race,
                "--loads",
                &loads,
                "--speeds",
                &speeds,
                "--slips",
                "1e-4,0.01,0.3",
                "-o",
                &folder,
            ]);
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            let ours = named(&std::fs::read_to_string(scratch.path("film/film.csv")).unwrap());
            assert_eq!(ours.len(), 3);
            // Both have their own Hertz: the ellipse's axis ratio has five digits in common, and the film's power of the load is small.
            for ours in &ours {
                for (name, theirs) in [("film_central", "central_film_m"), ("film_minimum", "minimum_film_m")]
                {
                    let Some(theirs) = row.get(theirs) else { panic!("{:?}", row.keys()) };
                    assert!(
                        (ours[name] / theirs - 1.0).abs() < 1e-3,
                        "{race} {load} {speed}: {} {theirs}",
                        ours[name]
                    );
                }
                // Film and steel in series carry less than the film may, and more where they slip more.
                assert!(ours["traction"] < ours["friction_limit"] && ours["drag"] > 0.0, "{ours:?}");
                assert!(ours["hysteresis_power"] > 0.0);
            }
            assert!(ours[0]["traction"] < ours[1]["traction"]);
            // Sliding whole, the force is the limit.
            assert!(ours[2]["traction"] / ours[2]["friction_limit"] > 0.9, "{ours:?}");
            let power = ours[2]["traction"] * load * 0.3 * speed;
            assert!((ours[2]["slip_power"] / power - 1.0).abs() < 1e-9, "{ours:?}");
            let same = |other: &&std::collections::HashMap<String, f64>| {
                other["load_N"] == load && other["speed_m_s"] == speed
            };
            for theirs in of_race(rolling).iter().filter(same) {
                let ratio = ours[0]["rolling_force"] / theirs["rolling_force_N"];
                assert!((ratio - 1.0).abs() < 1e-3, "{race} {load} {speed}: {ratio}");
            }
            assert!(std::fs::read_to_string(scratch.path("film/film.svg")).unwrap().contains("<svg"));
            seen += 1;
        }
    }
    assert!(seen >= 6, "{seen}");
    std::fs::write(
        scratch.path("dry.toml"),
        OILED
            .replace("[film]\nviscosity = \"58.5 mPa s\"\ninlet_heating = false\nsupply = \"flooded\"\n", ""),
    )
    .unwrap();
    for (scene, loads, slips, part) in [
        ("dry.toml", "100 N", "0.1", "section [film]"),
        ("oiled.toml", "0 N", "0.1", "a number above 0"),
        ("oiled.toml", "100 kg", "0.1", "kg"),
        ("oiled.toml", "100 N", "3", "(0, 2]"),
    ] {
        let output = roulement(&[
            "contact",
            "--film",
            &scratch.path(scene),
            "--loads",
            loads,
            "--speeds",
            "5",
            "--slips",
            slips,
            "-o",
            &scratch.path("x"),
        ]);
        let message = String::from_utf8_lossy(&output.stderr).to_string();
        assert!(!output.status.success() && message.contains(part), "{message}\nshould have {part}");
    }
}

/// Of a shaft it is the bearing that is named: what the scene of that alone has.
#[test]
fn a_film_of_a_shaft_is_that_of_the_bearing_that_is_named() {
    let scratch = Scratch::new("film-of-a-shaft");
    std::fs::write(scratch.path("oiled.toml"), OILED).unwrap();
    let dry = OILED
        .replace("[film]\nviscosity = \"58.5 mPa s\"\ninlet_heating = false\nsupply = \"flooded\"\n", "");
    std::fs::write(scratch.path("dry.toml"), dry).unwrap();
    let bearing = |name: &str, file: &str, direction: &str, set: &str| {
        format!(
            "[[bearing]]\nname = \"{name}\"\nscene = \"{file}.toml\"\nmounting = {{ position = 0, direction = \"{direction}\" }}\n{set}"
        )
    };
    let thin = "[bearing.set]\nfilm = { viscosity = \"10 mPa s\" }\n";
    let shaft = [
        "[shaft]\nspeed = 300\nmass = 1\npolar_inertia = 1e-3\ntransverse_inertia = 1e-3\n",
        &bearing("left", "oiled", "+x", ""),
        &bearing("right", "oiled", "-x", thin),
        &bearing("bare", "dry", "-x", ""),
        "[load]\nduration = 1e-3\noutput_interval = 1e-4\n",
    ];
    std::fs::write(scratch.path("shaft.toml"), shaft.concat()).unwrap();
    let film = |scene: &str, options: &[&str]| {
        let (scene, folder) = (scratch.path(scene), scratch.path("film"));
        let asked = [
            "contact", "--film", &scene, "--loads", "100 N", "--speeds", "5", "--slips", "0.1", "-o", &folder,
        ];
        let output = roulement(&[&asked[..], options].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        (
            output.status.success(),
            said,
            std::fs::read_to_string(scratch.path("film/film.csv")).unwrap_or_default(),
        )
    };
    let (_, _, alone) = film("oiled.toml", &[]);
    let (good, said, left) = film("shaft.toml", &["--bearing", "left"]);
    assert!(good, "{said}");
    assert_eq!(alone, left);
    assert!(scratch.read("film/film.svg").contains("bearing left: "));
    assert_ne!(film("shaft.toml", &["--bearing", "right"]).2, left);
    for (options, part) in [
        (&[][..], "say which one of left, right, bare"),
        (&["--bearing", "bare"][..], "bearing bare: "),
        (&["--bearing", "middle"][..], "no bearing middle, but left, right, bare"),
    ] {
        let (good, said, _) = film("shaft.toml", options);
        assert!(!good && said.contains(part), "{said}");
    }
}
