//! What a run warns of while it goes on, of a bearing alone and of one on a shaft.

use super::*;

/// A run's warnings while it goes on, with their times \[ms]; they stand in its summary, its record and on its page, too.
fn alarms(scratch: &Scratch, text: &str) -> Vec<(f64, String)> {
    std::fs::write(scratch.path("scene.toml"), text).unwrap();
    let output = roulement(&["run", &scratch.path("scene.toml"), "-o", &scratch.path("out")]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{told}");
    let of = |line: &str| {
        let line = line.strip_prefix("warning: ")?;
        let (_, after) = line.split_once("at ")?;
        let (time, _) = after.split_once(" ms ")?;
        Some((time.parse().ok()?, line.to_string()))
    };
    let found: Vec<(f64, String)> = told.lines().filter_map(of).collect();
    let record: Value = serde_json::from_str(&scratch.read("out/run.json")).unwrap();
    let summary = scratch.read("out/summary.txt");
    let page = scratch.path("page.html");
    assert!(roulement(&["report", &scratch.path("out"), "-o", &page]).status.success());
    let page = std::fs::read_to_string(page).unwrap();
    for (_, line) in &found {
        let written = record["warnings"].as_array().unwrap().iter().any(|warning| warning == line.as_str());
        assert!(written, "{line}: {}", record["warnings"]);
        assert!(
            summary.contains(&format!("WARNING          {line}")) && page.contains(line.as_str()),
            "{line}: {summary}"
        );
    }
    found
}

/// 4.2 GPa come between the loads before and after a time that the script says.
#[test]
fn command_line_a_pressure_that_marks_races_is_told_when_it_comes() {
    let scratch = Scratch::new("alarms-pressure");
    let rising = |end: &str| format!("[[0, 1000], [\"2 ms\", 1000], [\"4 ms\", \"{end}\"]]");
    let alone = |end: &str| {
        let changes = [
            ("load.x.force", rising(end)),
            ("load.duration", "\"5 ms\"".into()),
            ("load.output_interval", "\"100 us\"".into()),
        ];
        edited("thrust", &changes.each_ref().map(|(key, value)| (*key, value.as_str()))).source
    };
    let on_shaft = |end: &str| {
        let bearing = |name: &str, mounting: &str| {
            format!(
                "[[bearing]]\nname = \"{name}\"\ncatalogue = \"6206\"\nmounting = {{ {mounting}, preload = {{ force = \"500 N\" }} }}\n"
            )
        };
        "[shaft]\nspeed = \"1500 rpm\"\nmass = 2\npolar_inertia = 1e-3\ntransverse_inertia = 4e-3\n"
            .to_string()
            + &format!(
                "[[shaft.load]]\nname = \"press\"\nposition = \"-10 mm\"\nforce = [0, {}, 0]\nmoment = [0, 0, 0]\n",
                rising(end)
            )
            + &bearing("left", "position = \"-50 mm\"")
            + &bearing("right", "position = \"50 mm\", direction = \"-x\"")
            + "[load]\nduration = \"5 ms\"\noutput_interval = \"100 us\"\n"
    };
    for (text, before) in [(alone("80 kN"), ""), (on_shaft("25 kN"), "bearing left: ")] {
        let found = alarms(&scratch, &text);
        let [(time, said)] = &found[..] else { panic!("{found:?}") };
        assert!(*time > 2.0 && *time < 4.1, "{said}");
        assert!(said.starts_with(before) && said.contains("MPa, above 4200 MPa"), "{said}");
        let pressure: f64 = said.split(" is ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        // Of the step in which it came.
        assert!(pressure > 4200.0 && pressure < 4500.0, "{said}");
    }
    for text in [alone("2 kN"), on_shaft("2 kN")] {
        assert_eq!(alarms(&scratch, &text), []);
    }
}

/// The ring of `error/high_speed`, held by one bearing, whirls, alone and as a shaft of its mass; two bearings hold it.
#[test]
fn command_line_a_motion_that_loads_do_not_explain_is_told_while_it_goes_on() {
    let scratch = Scratch::new("alarms-motion");
    std::fs::copy(scene("error/high_speed"), scratch.path("high.toml")).unwrap();
    std::fs::copy(scene("whirl/one"), scratch.path("one.toml")).unwrap();
    let alone = std::fs::read_to_string(scene("error/high_speed")).unwrap().replace("\"5 ms\"", "\"6 ms\"");
    let shaft = "[shaft]\nspeed = \"65217 rpm\"\nmass = \"0.2 kg\"\npolar_inertia = \"6e-5 kg m^2\"\n\
                 transverse_inertia = \"4e-5 kg m^2\"\ncentre = 0\n\
                 [[bearing]]\nname = \"only\"\nscene = \"high.toml\"\nmounting = { position = 0, direction = \"+x\" }\n\
                 [[shaft.load]]\nname = \"thrust\"\nposition = 0\nforce = [1500, 100, 0]\n\
                 [load]\nduration = \"6 ms\"\noutput_interval = \"10 us\"\n";
    for (text, before) in [(alone.as_str(), ""), (shaft, "bearing only: ")] {
        let found = alarms(&scratch, text);
        let moves =
            found.iter().find(|(_, said)| said.contains("the inner race goes round forwards by up to"));
        let (time, said) = moves.unwrap_or_else(|| panic!("{found:?}"));
        assert!(*time < 5.6 && said.starts_with(before), "{said}");
    }
    let two = std::fs::read_to_string(scene("whirl/two")).unwrap();
    assert_eq!(alarms(&scratch, &two), []);
    assert_eq!(alarms(&scratch, &std::fs::read_to_string(scene("cost/shock")).unwrap()), []);
}
