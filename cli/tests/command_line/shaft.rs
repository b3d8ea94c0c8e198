//! A shaft with its bearings in a housing: its run, and sweeps of it.

use super::sweep::{columns, good, numbers};
use super::*;

/// The shaft in a housing that is shipped, for 0.4 ms.
fn shipped() -> String {
    let text = std::fs::read_to_string(scene("shafts/housing")).unwrap();
    let short = text.replace("\"20 ms\"", "\"0.4 ms\"").replace("\"50 us\"", "\"20 us\"");
    assert_ne!(short, text);
    short
}

fn run(command: &[&str]) -> String {
    good(&roulement(command))
}

/// Races of bearings are, in their own tables, where the shaft and the housing are.
#[test]
fn consistency_races_are_where_shaft_and_housing_are() {
    let scratch = Scratch::new("shaft-run");
    let base_text = shipped();
    std::fs::write(scratch.path("shaft.toml"), &base_text).unwrap();
    let said = run(&["run", &scratch.path("shaft.toml"), "-o", &scratch.path("out")]);
    assert!(said.contains("case             at its first bearing"), "{said}");
    let shaft = columns(&scratch.read("out/shaft.csv"));
    for (name, sign) in [("left", 1.0), ("right", -1.0)] {
        let own = columns(&scratch.read(&format!("out/{name}/results.csv")));
        for (race, of) in [("inner", "shaft"), ("outer", "case")] {
            for (axis, sign) in [("y", sign), ("z", 1.0)] {
                let race = numbers(&own[&format!("{race}.position.{axis} [m]")]);
                let seat = numbers(&shaft[&format!("{of}.{name}.{axis} [m]")]);
                assert_eq!(race.len(), 21);
                assert!(race.iter().any(|value| *value != race[0]), "{race:?}");
                for (race, seat) in race.iter().zip(seat) {
                    assert!((race - sign * seat).abs() < 1e-15, "{name} {axis}: {race} {seat}");
                }
            }
            // The tilt about z keeps its sign in a bearing that is turned about z.
            let rotation = numbers(&own[&format!("{race}.rotation.z [rad]")]);
            let tilt = numbers(&shaft[&format!("{of}.{name}.rz [rad]")]);
            for (rotation, tilt) in rotation.iter().zip(tilt) {
                assert!((rotation - tilt).abs() < 1e-12, "{name} {race}: {rotation} {tilt}");
            }
        }
    }
    assert!(scratch.read("out/shaft.svg").contains("housing, displacement z"));
}

#[test]
fn consistency_cases_of_a_shaft_are_runs_of_its_changed_file() {
    let scratch = Scratch::new("shaft-sweep");
    let base_text = shipped();
    std::fs::write(scratch.path("shaft.toml"), &base_text).unwrap();
    let cases = "bearing.left.set.friction.ball_race,shaft.load.mesh.force.z [kN],housing.case.mass\n0.05,1.5,\n,,20 kg\n";
    std::fs::write(scratch.path("cases.csv"), cases).unwrap();
    let (base, table, to) = (scratch.path("shaft.toml"), scratch.path("cases.csv"), scratch.path("sweep"));
    let command =
        ["sweep", &table, "--scene", &base, "-o", &to, "--columns", "left.ball[1].inner.load", "--runs", "2"];
    run(&command);
    let summary = columns(&scratch.read("sweep/summary.csv"));
    assert_eq!(summary["status"], ["done", "done"]);
    let changed = [
        base_text
            .replacen(
                "[[bearing]]\nname = \"right\"",
                "[bearing.set]\nfriction.ball_race = 0.05\n[[bearing]]\nname = \"right\"",
                1,
            )
            .replace("1260.5]", "\"1.5 kN\"]"),
        base_text.replace("\"12 kg\"", "\"20 kg\""),
    ];
    for (case, text) in changed.iter().enumerate() {
        assert_ne!(*text, base_text);
        std::fs::write(scratch.path("changed.toml"), text).unwrap();
        run(&["run", &scratch.path("changed.toml"), "-o", &scratch.path("run")]);
        let left = columns(&scratch.read("run/left/results.csv"));
        let loads = numbers(&left["ball[1].inner.load [N]"]);
        let figure = |name: &str| summary[name][case].parse::<f64>().unwrap();
        assert_eq!(figure("left.ball[1].inner.load.end [N]"), loads[20]);
        assert_eq!(figure("left.ball[1].inner.load.largest [N]"), loads.iter().copied().fold(0.0, f64::max));
        let shaft = columns(&scratch.read("run/shaft.csv"));
        let seat = numbers(&shaft["case.right.z [m]"]);
        assert_eq!(figure("right.housing.displacement.z.end [m]"), seat[20]);
        assert_eq!(figure("shaft.torque.end [N.m]"), numbers(&shaft["shaft.torque [N m]"])[20]);
        if case == 1 {
            let kept = format!("sweep/runs/{}/left/results.csv", summary["file"][1]);
            assert_eq!(scratch.read(&kept), scratch.read("run/left/results.csv"));
        }
    }
    for (cases, options, parts) in [
        ("bearing.middle.set.friction.ball_race\n0.05\n", &[][..], &["bearing.middle", "left, right"][..]),
        ("shaft.masss\n2\n", &[], &["masss"]),
        ("shaft.mass\n2\n", &["--columns", "middle.ball[1].inner.load"], &["middle.ball[1].inner.load"]),
        ("shaft.mass\n2\n", &["--tables", "csv"], &["--tables", "--runs"]),
    ] {
        let bad = scratch.path("bad.csv");
        std::fs::write(&bad, cases).unwrap();
        let command = [&["sweep", &bad, "--scene", &base, "-o", &to][..], options].concat();
        let output = roulement(&command);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && parts.iter().all(|part| said.contains(part)), "{said}");
    }
}

/// Feet close together hardly hold a housing against tilting: no bearing is blamed for that.
#[test]
fn regression_a_soft_housing_is_named_and_no_groove() {
    let scratch = Scratch::new("soft-housing");
    let mut text = shipped().replace("1260.5]", "20000]");
    for (wide, near) in [("80 mm\", \"-90", "1.6 mm\", \"-1.8"), ("80 mm\", \"90", "1.6 mm\", \"1.8")] {
        assert!(text.contains(wide));
        text = text.replace(wide, near);
    }
    for stiffness in ["[\"60 N/um\", \"60 N/um\", \"120 N/um\"]", "[\"3 N/um\", \"3 N/um\", \"3 N/um\"]"] {
        let soft = text.replace("[\"60 N/um\", \"60 N/um\", \"120 N/um\"]", stiffness);
        std::fs::write(scratch.path("shaft.toml"), soft).unwrap();
        let output = roulement(&["run", &scratch.path("shaft.toml"), "-o", &scratch.path("out")]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        println!("{message}");
        assert!(!output.status.success());
        assert!(message.contains("housing \"case\" gives way"), "{message}");
        assert!(!message.contains("groove") && !message.contains("shoulder"), "{message}");
    }
}
