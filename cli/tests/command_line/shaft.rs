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

/// A shaft on two bearings under a torque that is to be given.
const DRIVEN: &str = r#"
[shaft]
torque = "0.005 N m"
start_speed = 0
mass = "2 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "4e-3 kg m^2"
[[shaft.load]]
name = "weight"
position = "0 mm"
force = [0, 2000, 0]
moment = [0, 0, 0]
[[bearing]]
name = "left"
catalogue = "6206"
mounting = { position = "-50 mm", preload = { force = "500 N" } }
[[bearing]]
name = "right"
catalogue = "6206"
mounting = { position = "50 mm", direction = "-x", preload = { force = "500 N" } }
[load]
duration = "10 ms"
output_interval = "500 us"
"#;

#[test]
fn limit_a_shaft_that_creeps_below_breakaway_is_said_to() {
    let scratch = Scratch::new("shaft-creeps");
    let with = |torque: &str, options: &[&str]| {
        let text = DRIVEN.replace("torque = \"0.005 N m\"\nstart_speed = 0", torque);
        assert!(text == DRIVEN || !torque.contains("0.005"));
        std::fs::write(scratch.path("shaft.toml"), text).unwrap();
        let (file, to) = (scratch.path("shaft.toml"), scratch.path("out"));
        let output = roulement(&[&["run", &file, "-o", &to], options].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        [output.stdout, output.stderr].map(|said| String::from_utf8(said).unwrap())
    };
    let below = "torque = \"0.005 N m\"\nstart_speed = 0";
    let [said, _] = with(below, &[]);
    for part in [
        "WARNING          the shaft creeps at 1.",
        "e-3 rad/s under 5.000e-3 N m",
        "below v0 = 1e-3 m/s",
        "stands still",
    ] {
        assert!(said.contains(part), "{said}\nshould have {part}");
    }
    assert!(scratch.read("out/summary.txt").contains("the shaft creeps"));
    let [_, said] = with(below, &["--json"]);
    assert!(said.contains("warning: the shaft creeps at 1."), "{said}");
    // Above breakaway it starts; one that is turned this slowly is not creeping.
    for torque in ["torque = \"0.5 N m\"\nstart_speed = 0", "speed = 1.3e-3"] {
        let said = with(torque, &[]).concat();
        assert!(!said.contains("the shaft creeps"), "{torque}: {said}");
    }
}

/// What a machine loses is what its bearings lose, and what its drive and its loads bring; drag in one of them is in it.
#[test]
fn invariant_losses_of_a_machine_are_those_of_its_bearings_and_close() {
    let scratch = Scratch::new("shaft-losses");
    let text = std::fs::read_to_string(scene("shafts/pinion")).unwrap();
    let mist = "catalogue = \"7206 B\"\nset.effects.ambient = { density = 200.0, viscosity = 18e-6 }";
    let text = text.replacen("catalogue = \"7206 B\"", mist, 1).replace("\"20 ms\"", "\"60 ms\"");
    // What is tested are sums, not the error of steps.
    let text = text + "\n[solver]\ntolerance = 1e-8\nmax_step = \"60 us\"\n";
    std::fs::write(scratch.path("shaft.toml"), text).unwrap();
    let (file, to) = (scratch.path("shaft.toml"), scratch.path("out"));
    let json: Value = serde_json::from_str(&run(&["run", &file, "-o", &to, "--json"])).unwrap();
    let of = |part: &str, name: &str| json[part]["losses"][name].as_f64().unwrap();
    let lost = ["left", "right"].map(|bearing| json[bearing]["figures"]["loss.total"].as_f64().unwrap());
    let all = of("shaft", "lost");
    // Sums are kept up to 1/512 of the run apart, and taken in between where the window of means begins.
    assert!(((lost[0] + lost[1]) / all - 1.0).abs() < 1e-5, "{lost:?} {all}");
    assert!(of("shaft", "left_open").abs() < 1e-5 * all, "{}", json["shaft"]["losses"]);
    // Drive and gear together, of 19 kW that pass through; steady, so that nothing is stored.
    let brought = of("shaft", "torque_times_speed") + of("shaft", "other_work");
    assert!((brought / all - 1.0).abs() < 2e-3, "{}", json["shaft"]["losses"]);
    assert!(of("shaft", "torque_times_speed") < -1e4);
    // Of each bearing by itself, too: torque times the speed of the shaft.
    for (bearing, lost) in ["left", "right"].into_iter().zip(lost) {
        assert!(
            (of(bearing, "torque_times_speed") / lost - 1.0).abs() < 2e-3,
            "{bearing} {}",
            json[bearing]["losses"]
        );
    }
    let parts = |bearing: &str| -> Vec<String> {
        let parts = json[bearing]["losses"]["parts"].as_array().unwrap();
        parts.iter().map(|part| part["name"].as_str().unwrap().to_string()).collect()
    };
    assert_eq!(parts("left"), ["loss.sliding", "loss.drag", "loss.damping"]);
    assert_eq!(parts("right"), ["loss.sliding", "loss.damping"]);
    let drag = json["left"]["figures"]["loss.drag"].as_f64().unwrap();
    assert!(drag > 0.05 * lost[0], "{drag} {lost:?}");
    let said = scratch.read("out/summary.txt");
    assert!(
        said.contains(&format!("losses           {all:.4} W of all bearings, shaft and housings")),
        "{said}"
    );
    assert!(said.contains(&format!("mean losses {:.3} W", lost[0])) && said.contains("left open"), "{said}");
}
