//! `roulement effects`, and what runs and packages say of effects.

use super::*;

fn said(output: &std::process::Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn effects_are_listed_as_a_table_and_as_json() {
    let text = said(&roulement(&["effects", &scene("thrust")]));
    for part in [
        "effects on: creep (saturated), damping (0.02 s/m)",
        "off, and would matter\n",
        "growth by temperature",
        "10 K between the inner ring and the rest",
        "write [growth]",
        "off, and would not matter\n",
        "groove slip",
        "simulated in every scene\n",
        "centrifugal force",
        "not simulated by any effect yet\n",
        "rolling resistance",
        "ISO VG 68 at 40 degC",
    ] {
        assert!(text.contains(part), "{text}\nshould have {part}");
    }
    let json: Value =
        serde_json::from_str(&said(&roulement(&["effects", "--json", &scene("thrust")]))).unwrap();
    assert_eq!(json["settings"]["effects.creep"], "saturated");
    assert_eq!(json["settings"]["growth"], Value::Null);
    let estimates = json["estimates"].as_array().unwrap();
    let of = |subject: &str| estimates.iter().find(|estimate| estimate["subject"] == subject).unwrap();
    let growth = of("growth by temperature");
    assert_eq!((&growth["standing"], &growth["matters"]), (&Value::from("off"), &Value::from(true)));
    // By an equilibrium at 10 K: -6.51 % of the life.
    assert!((growth["changes"]["life"].as_f64().unwrap() / -0.0651 - 1.0).abs() < 1e-2, "{growth}");
    assert_eq!(
        (&growth["quantity"], &growth["from"]),
        (&Value::from("displacement"), &Value::from("two settled states"))
    );
    assert_eq!(growth["threshold"], 0.05);
    // Ranked by what they change.
    let shares: Vec<f64> =
        estimates.iter().filter(|one| one["unit"] == "").map(|one| one["value"].as_f64().unwrap()).collect();
    assert!(shares.is_sorted_by(|a, b| a >= b), "{shares:?}");
}

#[test]
fn effects_are_measured_by_runs_whatever_runs_at_a_time() {
    let scratch = Scratch::new("effects-measure");
    let path = scratch.path("short.toml");
    std::fs::write(&path, &edited("thrust", &[("load.duration", "\"2 ms\"")]).source).unwrap();
    let measured = |jobs: &str| -> Value {
        let output = roulement(&["effects", "--measure", "--json", "--jobs", jobs, &path]);
        let mut json: Value = serde_json::from_str(&said(&output)).unwrap();
        // CPU times are of the moment.
        for one in json["measured"].as_array_mut().unwrap() {
            assert!(one.as_object_mut().unwrap().remove("cpu").unwrap().is_number());
        }
        json
    };
    let (one, two) = (measured("1"), measured("2"));
    assert_eq!(one, two);
    let all = one["measured"].as_array().unwrap();
    let of = |subject: &str| all.iter().find(|one| one["subject"] == subject).unwrap();
    for (one, least, most) in [(of("drag"), 0.04, 0.07), (of("hysteresis"), 0.24, 0.30)] {
        let torque = |of: &str| one[of]["torque"].as_f64().unwrap();
        let (change, error) = (torque("changes"), torque("errors"));
        assert!(change > least && change < most && error < 0.1 * change && one["standing"] == "off", "{one}");
    }
    assert_eq!(of("damping")["standing"], "on");
    assert!(all.iter().any(|one| one["subject"] == "cage"));
    // Of several ways to take one in, each says which it is.
    for (subject, ways) in [
        ("gravity", &["(-x)", "(-y)", "(-z)"][..]),
        ("waviness", &["(a wave for each ball)", "(a wave for every other ball)"]),
    ] {
        let lines = all.iter().filter(|one| one["subject"] == subject);
        let mut settings: Vec<&str> = lines.map(|one| one["setting"].as_str().unwrap()).collect();
        settings.sort_unstable_by_key(|setting| ways.iter().position(|way| setting.ends_with(way)));
        assert!(settings.iter().zip(ways).all(|(setting, way)| setting.ends_with(way)), "{settings:?}");
        assert_eq!(settings.len(), ways.len(), "{subject}");
    }
    let refused = roulement(&["effects", "--jobs", "2", &path]);
    assert!(!refused.status.success());
}

#[test]
fn a_run_says_what_is_on_what_would_matter_and_what_did_not() {
    let scratch = Scratch::new("effects-run");
    let light = edited(
        "thrust",
        &[
            ("load.duration", "\"0.2 ms\""),
            ("effects.gravity", "[0, -9.81, 0]"),
            ("load.output_interval", "\"20 us\""),
        ],
    );
    let output = scratch.run(&light, "run", &[]);
    let summary = said(&output);
    let notes = String::from_utf8(output.stderr).unwrap();
    let lines = |start: &str| notes.lines().filter(|line| line.starts_with(start)).count();
    assert_eq!(lines("effects on: creep (saturated), damping (0.02 s/m), gravity"), 1, "{notes}");
    for subject in ["hysteresis", "waviness", "growth by temperature", "support"] {
        assert_eq!(lines(&format!("off, would matter: {subject}: ")), 1, "{notes}");
    }
    assert_eq!(lines("off, would matter: rolling resistance: "), 1, "{notes}");
    // Silent about what is off and does not matter.
    assert!(!notes.contains("rotation"), "{notes}");
    assert!(summary.contains("did not matter   gravity: "), "{summary}");
    assert!(scratch.read("run/summary.txt").contains("did not matter   gravity: "));
}

#[test]
fn auto_says_what_it_switches_and_packages_have_it_switched() {
    let scratch = Scratch::new("effects-auto");
    let text = edited(
        "radial",
        &[("effects", "{ auto = true, creep = \"saturated\" }"), ("load.duration", "\"0.1 ms\"")],
    );
    assert!(text.effects.auto.on);
    std::fs::write(scratch.path("auto.toml"), &text.source).unwrap();
    let output = roulement(&["describe", &scratch.path("auto.toml")]);
    assert!(said(&output).contains("\"power.groove\""));
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(notes.contains("auto: effects.heathcote_slip = true: would change torque +"), "{notes}");
    // The same description as of the scene with the effects written out; of what an importer sets nothing is known, so that all are on.
    let written = edited(
        "radial",
        &[
            (
                "effects",
                "{ heathcote_slip = true, hysteresis = true, shoulder_outputs = true, creep = \"saturated\" }",
            ),
            ("load.duration", "\"0.1 ms\""),
        ],
    );
    std::fs::write(scratch.path("written.toml"), &written.source).unwrap();
    let rows = |xml: &str| {
        xml.lines().filter(|line| line.contains("<ScalarVariable")).map(str::to_string).collect::<Vec<_>>()
    };
    let plain = said(&roulement(&["describe", &scratch.path("written.toml")]));
    assert_eq!(rows(&plain), rows(&String::from_utf8(output.stdout).unwrap()));

    std::fs::write(scratch.path("word.toml"), text.source.replace("auto = true", "auto = 1")).unwrap();
    let refused = roulement(&["effects", &scratch.path("word.toml")]);
    assert!(!refused.status.success());
    let thrust = std::fs::read_to_string(scene("thrust")).unwrap();
    let from = thrust.find("[effects]").unwrap();
    let to = thrust.find("[inner]").unwrap();
    let word = format!("effects = \"all\"\n{}{}", &thrust[..from], &thrust[to..]);
    std::fs::write(scratch.path("word.toml"), word).unwrap();
    let refused = roulement(&["effects", &scratch.path("word.toml")]);
    let message = String::from_utf8(refused.stderr).unwrap();
    assert!(message.contains("effects = \"all\" is not known") && message.contains("auto"), "{message}");
}

/// A machine whose outer rings turn, and the same one seen from these: verdicts are the same. Drag is not, as its medium rests in the frame.
#[test]
fn identity_verdicts_in_a_frame_that_turns_are_those_of_the_machine_seen_from_outside() {
    let scratch = Scratch::new("effects-frame");
    let turn = 400.0;
    let judged = |name: &str, frame: &str, speed: f64, outer: f64| -> Value {
        let bearing = |name: &str, position: f64, direction: &str, outer: f64| {
            format!(
                "[[bearing]]\nname = \"{name}\"\ncatalogue = \"6206\"\n\
                 mounting = {{ position = {position}, direction = \"{direction}\", preload = {{ force = 300 }} }}\n\
                 [bearing.set]\nload = {{ outer_speed = {outer:?} }}\neffects = {{ creep = \"saturated\" }}\n"
            )
        };
        let text = [
            frame,
            &format!(
                "[shaft]\nspeed = {speed:?}\nmass = 1.8\npolar_inertia = 6e-4\ntransverse_inertia = 4e-3\n"
            ),
            "[[shaft.load]]\nname = \"pull\"\nposition = 0.02\nforce = [100, 0, 0]\n",
            &bearing("left", -0.05, "+x", outer),
            &bearing("right", 0.05, "-x", -outer),
            "[load]\nduration = 0.002\noutput_interval = 0.0002\n",
        ];
        let file = scratch.path(&format!("{name}.toml"));
        std::fs::write(&file, text.concat()).unwrap();
        serde_json::from_str(&said(&roulement(&["effects", "--json", &file]))).unwrap()
    };
    let still = judged("still", "", 1000.0, turn);
    let seen = judged("seen", "[frame]\nangular_velocity = [400, 0, 0]\n", 1000.0 - turn, 0.0);
    for bearing in ["left", "right"] {
        let values = |of: &Value| -> std::collections::BTreeMap<String, (f64, bool)> {
            let all = of[bearing]["estimates"].as_array().unwrap().iter();
            let told = all.filter(|one| !["drag", "cage"].contains(&one["subject"].as_str().unwrap()));
            told.map(|one| {
                let value = one["value"].as_f64().unwrap();
                (one["subject"].as_str().unwrap().to_string(), (value, one["matters"] == true))
            })
            .collect()
        };
        let (still, seen) = (values(&still), values(&seen));
        assert!(still.len() > 8 && still.contains_key("growth by rotation"), "{still:?}");
        assert_eq!(still.keys().collect::<Vec<_>>(), seen.keys().collect::<Vec<_>>());
        for (subject, (value, matters)) in &still {
            let (other, also) = seen[subject];
            assert!(
                (value - other).abs() < 2e-3 * value.abs() + 1e-6 && *matters == also,
                "{subject}: {value} {other}"
            );
        }
    }
}
