//! Named windows of a run, `[[phase]]`: means, least and largest values, heat and life of each.

use roulement::scene::Scene;
use serde_json::Value;

use super::sweep::{columns, good};
use super::*;

/// A bearing under a load that comes down between two phases, none of whose ends is one of a step or a row.
const PHASES: &str = r#"[
    { name = "heavy", from = 0, to = "7.0123 ms" },
    { name = "between", from = "7.0123 ms", to = "10.00077 ms" },
    { name = "light", from = "10.00077 ms", to = "20 ms" },
    { name = "second-half", from = "10 ms", to = "20 ms" },
    { name = "whole", from = 0, to = "20 ms" },
]"#;

fn scene() -> Scene {
    edited(
        "thrust",
        &[
            ("load.x.force", "[[0, 6000], [\"7.1 ms\", 6000], [\"7.6 ms\", 1500]]"),
            ("load.duration", "\"20 ms\""),
            ("rating", "{}"),
            ("phase", PHASES),
        ],
    )
}

fn json(scratch: &Scratch, scene: &Scene, to: &str, options: &[&str]) -> Value {
    let output = scratch.run(scene, to, &[options, &["--json"]].concat());
    serde_json::from_str(&good(&output)).unwrap()
}

fn phase<'a>(summary: &'a Value, name: &str) -> &'a Value {
    let all = summary["phases"].as_array().unwrap();
    all.iter().find(|phase| phase["name"] == name).unwrap_or_else(|| panic!("{name}"))
}

fn quantity<'a>(of: &'a Value, name: &str) -> &'a Value {
    let all = of["quantities"].as_array().unwrap();
    all.iter().find(|mean| mean["quantity"] == name).unwrap_or_else(|| panic!("{name}"))
}

#[test]
fn invariant_phases_make_up_the_run_and_a_window_is_its_means() {
    let scratch = Scratch::new("phases");
    let scene = scene();
    let summary = json(&scratch, &scene, "out", &[]);
    let number = |phase_name: &str, key: &str| phase(&summary, phase_name)[key].as_f64().unwrap();
    let mean = |name: &str, of: &str| quantity(phase(&summary, name), of)["mean"].as_f64().unwrap();
    // Heat and damage of the parts are those of the whole, wherever a step is cut.
    for key in ["heat", "damage"] {
        let parts: f64 = ["heavy", "between", "light"].iter().map(|name| number(name, key)).sum();
        let whole = number("whole", key);
        assert!((parts / whole - 1.0).abs() < 1e-9 && whole > 0.0, "{key}: {parts} {whole}");
    }
    // The window of the means, as a phase.
    for all in summary["means"]["quantities"].as_array().unwrap() {
        let (name, wanted) = (all["quantity"].as_str().unwrap(), all["mean"].as_f64().unwrap());
        let found = mean("second-half", name);
        assert!((found - wanted).abs() <= 1e-9 * wanted.abs().max(1e-12), "{name}: {found} {wanted}");
    }
    let life = |of: &Value| of["life"]["L10r_hours"].as_f64().unwrap();
    let [found, wanted] = [life(phase(&summary, "second-half")), life(&summary)];
    assert!((found / wanted - 1.0).abs() < 1e-4, "{found} {wanted}");
    // Extremes are of the phase alone, and the mean lies between them.
    let extremes = |name: &str, of: &str| {
        let quantity = quantity(phase(&summary, name), of);
        ["least", "mean", "largest"].map(|key| quantity[key].as_f64().unwrap())
    };
    for name in ["heavy", "between", "light", "whole"] {
        let [least, mean, largest] = extremes(name, "friction power");
        assert!(0.0 < least && least <= mean && mean <= largest, "{name}: {least} {mean} {largest}");
    }
    let [heavy, light] = ["heavy", "light"].map(|name| extremes(name, "friction power"));
    assert!(heavy[0] > 1.5 * light[2], "{heavy:?} {light:?}");
    // A life of a phase is that of its loads: of a steady run.
    let steady =
        edited("thrust", &[("load.x.force", "6000"), ("load.duration", "\"7.0123 ms\""), ("rating", "{}")]);
    let steady = json(&scratch, &steady, "steady", &[]);
    let [found, wanted] = [life(phase(&summary, "heavy")), life(&steady)];
    assert!((found / wanted - 1.0).abs() < 0.01, "{found} {wanted}");
}

#[test]
fn invariant_a_phase_is_judged_by_itself_and_stands_in_all_that_is_written() {
    let scratch = Scratch::new("phases-written");
    let scene = scene();
    let said = good(&scratch.run(&scene, "out", &["--error"]));
    let line = |name: &str| said.lines().find(|line| line.starts_with(&format!("phase {name}"))).unwrap();
    assert!(line("between").ends_with("NOT SETTLED: the script changes in it"), "{said}");
    assert!(line("whole").ends_with("NOT SETTLED: the script changes in it"), "{said}");
    assert!(!line("heavy").contains("script"), "{said}");
    assert!(said.contains("  life           L10r ") && said.contains("; damage "), "{said}");
    // Errors of its means, where they were measured.
    let power = said.lines().find(|line| line.starts_with("  friction ")).unwrap();
    assert!(power.contains("(+- "), "{power}");
    let table = columns(&scratch.read("out/phases.csv"));
    let row = |phase: &str, quantity: &str| {
        let of = |row: &usize| table["phase"][*row] == phase && table["quantity"][*row] == quantity;
        (0..table["phase"].len()).find(of).unwrap_or_else(|| panic!("{phase} {quantity}"))
    };
    let at = row("between", "friction power");
    let number = |name: &str, at: usize| table[name][at].parse::<f64>().unwrap();
    for (end, wanted) in [("begin [s]", 7.0123e-3), ("end [s]", 10.00077e-3)] {
        assert!((number(end, at) - wanted).abs() < 1e-15, "{end}: {}", number(end, at));
    }
    assert!(number("error", at) > 0.0 && number("error", at) < 0.01 * number("mean", at));
    assert_eq!(table["settled"][at], "false");
    assert!(number("mean", row("heavy", "damage")) > number("mean", row("light", "damage")));
    assert!(number("largest", row("heavy", "peak pressure on the inner race")) > 1e9);
    // A sweep has them as columns.
    std::fs::write(scratch.path("scene.toml"), &scene.source).unwrap();
    std::fs::write(scratch.path("cases.csv"), "load.inner_speed\n4000 rpm\n").unwrap();
    let paths = ["scene.toml", "cases.csv", "sweep"].map(|name| scratch.path(name));
    good(&roulement(&["sweep", &paths[1], "--scene", &paths[0], "-o", &paths[2]]));
    let rows = columns(&scratch.read("sweep/summary.csv"));
    for column in [
        "phase.heavy.friction_power.mean",
        "phase.heavy.inner.peak_pressure.largest",
        "phase.light.heat",
        "phase.light.life.L10r.hours",
        "phase.light.damage",
    ] {
        let cell = rows.iter().find(|(head, _)| head.split(" [").next() == Some(column));
        let (_, cell) = cell.unwrap_or_else(|| panic!("{column}"));
        assert!(cell[0].parse::<f64>().unwrap() > 0.0, "{column}");
    }
    assert_eq!(rows["phase.whole.settled"][0], "no: the script changes");
    // A run that has none leaves no table of the one before.
    good(&scratch.run(&edited("thrust", &[("load.duration", "\"1 ms\"")]), "out", &[]));
    assert!(!std::path::Path::new(&scratch.path("out/phases.csv")).exists());
}

#[test]
fn invariant_phases_of_a_shaft_are_of_all_its_parts() {
    let scratch = Scratch::new("phases-shaft");
    let text = std::fs::read_to_string(common::scene("shafts/pinion")).unwrap();
    let text = text.replace("\"20 ms\"", "\"4 ms\"").replace(
        "[load]",
        "[[phase]]\nname = \"early\"\nfrom = 0\nto = \"1.503 ms\"\n[[phase]]\nname = \"late\"\nfrom = \"2 ms\"\nto = \"4 ms\"\n[load]",
    );
    std::fs::write(scratch.path("shaft.toml"), &text).unwrap();
    let out = scratch.path("out");
    let said = good(&roulement(&["run", &scratch.path("shaft.toml"), "-o", &out, "--json"]));
    let summary: Value = serde_json::from_str(&said).unwrap();
    for part in ["left", "right", "shaft"] {
        let late = phase(&summary[part], "late");
        assert_eq!(late["window"][0].as_f64(), Some(2e-3), "{part}");
        assert_eq!(phase(&summary[part], "early")["window"][1].as_f64(), Some(1.503e-3));
        // The second half of the run, again.
        for all in summary[part]["means"]["quantities"].as_array().unwrap() {
            let (name, wanted) = (all["quantity"].as_str().unwrap(), all["mean"].as_f64().unwrap());
            let found = quantity(late, name)["mean"].as_f64().unwrap();
            assert!(
                (found - wanted).abs() <= 1e-9 * wanted.abs().max(1e-9),
                "{part} {name}: {found} {wanted}"
            );
        }
    }
    assert!(phase(&summary["left"], "early")["heat"].as_f64().unwrap() > 0.0);
    for table in ["out/phases.csv", "out/left/phases.csv"] {
        assert!(scratch.read(table).contains("early,"), "{table}");
    }
    let said = scratch.read("out/summary.txt");
    assert!(
        said.contains("phase late       2.000 to 4.000 ms") && said.contains("  left           friction "),
        "{said}"
    );
    // What is refused names the key, the value and what is allowed.
    for (from, to, parts) in [
        ("to = \"4 ms\"", "to = \"5 ms\"", &["phase[1].to = 0.005 s", "(0.002, 0.004] s"][..]),
        ("name = \"late\"", "name = \"early\"", &["phase[1].name", "\"early\"", "another phase"]),
    ] {
        std::fs::write(scratch.path("bad.toml"), text.replace(from, to)).unwrap();
        let output = roulement(&["run", &scratch.path("bad.toml"), "-o", &out]);
        let why = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && parts.iter().all(|part| why.contains(part)), "{why}");
    }
}

#[test]
fn refused_phases_name_key_value_and_range() {
    for (phases, parts) in [
        ("[{ name = \"a\", from = -1e-3, to = 1e-3 }]", &["phase[0].from = -0.001 s", "[0, 0.02] s"][..]),
        ("[{ name = \"a\", from = 3e-3, to = 3e-3 }]", &["phase[0].to = 0.003 s", "(0.003, 0.02] s"]),
        ("[{ name = \"a\", from = 0, to = \"1 m\" }]", &["phase", "1 m"]),
        ("[{ name = \"a b\", from = 0, to = 1e-3 }]", &["phase[0].name", "\"a b\"", "letters"]),
        ("[{ from = 0, to = 1e-3 }]", &["name"]),
        ("[{ name = \"a\", from = 0, to = 1e-3, mean = 1 }]", &["mean"]),
    ] {
        let text = edited("thrust", &[("load.duration", "\"20 ms\"")]).source;
        let why = Scene::edited(&text, [("phase", phases)]).unwrap_err().to_string();
        assert!(parts.iter().all(|part| why.contains(part)), "{phases}: {why}");
    }
}
