//! Means of a run: over time and not over rows, the life over their window, and when they have settled.

use super::sweep::{columns, good, numbers};
use super::*;

/// Runs a text into a directory; what it prints, and its means by name.
fn run(scratch: &Scratch, text: &str, to: &str) -> (String, impl Fn(&str) -> f64 + use<>) {
    let file = scratch.path(&format!("{to}.toml"));
    std::fs::write(&file, text).unwrap();
    let said = good(&roulement(&["run", &file, "-o", &scratch.path(to)]));
    let means = columns(&scratch.read(&format!("{to}/means.csv")));
    let of = move |name: &str| {
        let at = means["quantity"].iter().position(|other| other == name).unwrap_or_else(|| panic!("{name}"));
        means["mean"][at].parse::<f64>().unwrap()
    };
    (said, of)
}

#[test]
fn regression_a_mean_is_over_time_and_no_matter_of_rows() {
    let scratch = Scratch::new("mean-of-rows");
    let text = include_str!("../../../tests/data/means/spall.toml");
    for interval in ["0.1 ms", "37 us", "1 ms"] {
        let (_, mean) = run(&scratch, &text.replace("\"0.1 ms\"", &format!("\"{interval}\"")), "out");
        let torque = mean("friction torque");
        // By rows of 0.1 ms it was 0.01254.
        assert!((torque / 0.01404 - 1.0).abs() < 0.02, "rows of {interval}: {torque}");
    }
}

#[test]
fn invariant_rows_do_not_move_the_motion() {
    let scratch = Scratch::new("rows-of-a-motion");
    let shaft = include_str!("../../../scenes/shafts/housing.toml");
    for (text, tables, means) in [
        (edited("cage", &[("load.duration", "\"4 ms\"")]).source, &["results.csv"][..], &["means.csv"][..]),
        (
            shaft.replace("duration = \"20 ms\"", "duration = \"4 ms\""),
            &["shaft.csv", "left/results.csv"],
            &["means.csv", "left/means.csv"],
        ),
    ] {
        let with = |interval: &str| {
            let at = text.find("output_interval").unwrap();
            let end = at + text[at..].find('\n').unwrap();
            format!("{}output_interval = \"{interval}\"{}", &text[..at], &text[end..])
        };
        for (interval, to) in [("0.5 ms", "coarse"), ("50 us", "fine")] {
            let file = scratch.path(&format!("{to}.toml"));
            std::fs::write(&file, with(interval)).unwrap();
            good(&roulement(&["run", &file, "-o", &scratch.path(to)]));
        }
        for file in means {
            assert_eq!(
                scratch.read(&format!("coarse/{file}")),
                scratch.read(&format!("fine/{file}")),
                "{file}"
            );
        }
        for file in tables {
            let [coarse, fine] = ["coarse", "fine"].map(|to| columns(&scratch.read(&format!("{to}/{file}"))));
            for (name, values) in &coarse {
                let every: Vec<&String> = fine[name].iter().step_by(10).collect();
                assert_eq!(values.iter().collect::<Vec<_>>(), every, "{file}: {name}");
            }
        }
    }
}

/// A bearing whose load comes down to what it stays at.
fn unloaded(force: &str, duration: &str) -> String {
    let scene = edited(
        "thrust",
        &[
            ("load.x.force", force),
            ("load.duration", duration),
            ("rating", "{ viscosity = 1e-5, contamination = 0.5 }"),
        ],
    );
    scene.source
}

#[test]
fn invariant_a_life_is_of_the_window_of_the_means() {
    let scratch = Scratch::new("life-of-window");
    let (_, steady) = run(&scratch, &unloaded("1500", "\"20 ms\""), "steady");
    let (said, after) =
        run(&scratch, &unloaded("[[0, 6000], [\"4 ms\", 6000], [\"5 ms\", 1500]]", "\"20 ms\""), "after");
    // The modified life falls with a high power of the load.
    let allowed = [
        ("life L10r", 0.01),
        ("life L10r in hours", 0.01),
        ("modified life", 0.03),
        ("equivalent load", 0.003),
    ];
    for (name, allowed) in allowed {
        let (steady, after) = (steady(name), after(name));
        assert!((after / steady - 1.0).abs() < allowed, "{name}: {after}, steady {steady}");
    }
    assert!(said.contains("life             L10r ") && said.contains(" h)"), "{said}");
    // What counts from the start is far shorter, and its damage gives the life of a phase by difference.
    let table = columns(&scratch.read("after/results.csv"));
    let life = *numbers(&table["life.L10r [1]"]).last().unwrap();
    assert!(life < 0.5 * steady("life L10r"), "{life}");
    let (time, damage) = (numbers(&table["time [s]"]), numbers(&table["life.damage [1]"]));
    let half = time.iter().position(|time| *time > 0.01).unwrap();
    let last = time.len() - 1;
    let hours = (time[last] - time[half]) / (damage[last] - damage[half]) / 3600.0;
    assert!((hours / steady("life L10r in hours") - 1.0).abs() < 0.01, "{hours}");
    let json: Value = serde_json::from_str(&good(&roulement(&[
        "run",
        &scratch.path("after.toml"),
        "-o",
        &scratch.path("json"),
        "--json",
    ])))
    .unwrap();
    assert_eq!(
        json["life"]["L10r_hours"].as_f64().map(f64::round),
        Some(after("life L10r in hours").round())
    );
}

#[test]
fn regression_means_over_a_change_of_the_script_have_not_settled() {
    let scratch = Scratch::new("settled-script");
    let inside = unloaded("[[0, 2000], [\"14 ms\", 2000], [\"15 ms\", 1500]]", "\"20 ms\"");
    let (said, _) = run(&scratch, &inside, "inside");
    assert!(said.contains("NOT SETTLED      the script changes between 10.000 and 20.000 ms"), "{said}");
    let json: Value = serde_json::from_str(&scratch.read("inside/run.json")).unwrap();
    assert_eq!(json["summary"]["means"]["settled"], false);
    // A table that holds its value there changes nothing.
    let before = unloaded("[[0, 2000], [\"4 ms\", 2000], [\"5 ms\", 1500], [\"15 ms\", 1500]]", "\"20 ms\"");
    let (said, _) = run(&scratch, &before, "before");
    assert!(!said.contains("the script changes"), "{said}");
}

#[test]
fn every_effect_that_is_on_has_a_line_in_the_summary() {
    let scratch = Scratch::new("headlines");
    for (name, lines) in [
        (
            "effects/loss_of_lubrication",
            &["film.ratio", "rolling_power.inner", "temperature_rise.inner", "heat.out"][..],
        ),
        ("effects/growth", &["clearance"]),
        ("effects/stiffness", &["stiffness.x.x"]),
        ("effects/rating", &["life "]),
    ] {
        let Ok(text) = std::fs::read_to_string(scene(name)) else { panic!("{name}") };
        let scene = roulement::Scene::edited(&text, [("load.duration", "\"2 ms\"")]).unwrap();
        let said = good(&scratch.run(&scene, "out", &[]));
        for line in lines {
            assert!(said.lines().any(|other| other.starts_with(line)), "{name}: {said}");
        }
    }
}

/// The bearing of 120 mm bore that NASA ran at 3e6 DN, in a mist: drag takes most of the power.
const MIST: &str = r#"
[bearing]
balls = 15
ball_diameter = "20.6375 mm"
pitch_diameter = "155 mm"
contact_angle = "24 deg"
inner_conformity = 0.54
outer_conformity = 0.52
[effects]
hysteresis = true
ambient = { density = 19.0, viscosity = 18e-6 }
[film]
viscosity = 0.0035
pressure_viscosity = 1.2e-8
[inner]
drive = "wrench"
mass = "2 kg"
inertia = ["8e-3 kg m^2", "5e-3 kg m^2", "5e-3 kg m^2"]
[load]
duration = "60 ms"
output_interval = "2 ms"
inner_speed = "25000 rpm"
x = { force = "6672 N" }
y = { displacement = 0.0 }
z = { displacement = 0.0 }
ry = { rotation = 0.0 }
rz = { rotation = 0.0 }
# What is tested are sums, not the error of steps.
[solver]
tolerance = 1e-8
max_step = "60 us"
"#;

/// The friction power of the contacts is a third of it, and was all that a summary said.
#[test]
fn regression_losses_are_what_the_shaft_brings_and_not_friction_of_contacts_alone() {
    let scratch = Scratch::new("losses");
    let (said, mean) = run(&scratch, MIST, "mist");
    let (all, torque) = (mean("loss.total"), mean("torque times speed"));
    let brought = mean("friction torque") * mean("inner race speed");
    println!("{said}");
    // Sums are kept up to 1/512 of the run apart, and taken in between where the window of means begins.
    assert!((torque / brought - 1.0).abs() < 1e-5, "{torque} {brought}");
    // The balls come to their speed in some 10 ms; what is left of that is stored.
    assert!((all / brought - 1.0).abs() < 2e-3, "{all} {brought}");
    assert!(mean("losses left open").abs() < 1e-5 * all, "{}", mean("losses left open"));
    assert!(
        (torque + mean("other work") - mean("into motion and springs") - mean("losses left open") - all)
            .abs()
            < 1e-6 * all
    );
    // Drag of the order of the two thirds that were missing, and every part a line with its share.
    assert!(mean("loss.drag") > 0.6 * all && mean("friction power") < 0.4 * all);
    let mut shares = 0.0;
    for (part, words) in [
        ("loss.sliding", "sliding of balls"),
        ("loss.hysteresis", "hysteresis of rolling"),
        ("loss.rolling", "rolling resistance of the oil"),
        ("loss.drag", "drag of the medium"),
    ] {
        let share = 100.0 * mean(part) / all;
        let line = format!("{:.4} W, {share:.1} %: {words}", mean(part));
        assert!(said.contains(&line), "{line}: {said}");
        shares += share;
    }
    assert!((shares - 100.0).abs() < 1e-9, "{shares}");
    assert!(
        said.contains(&format!("losses           {all:.4} W")) && !said.contains("friction of the cage"),
        "{said}"
    );
    let file = scratch.path("mist.toml");
    let json = good(&roulement(&["run", &file, "-o", &scratch.path("json"), "--json"]));
    let json: Value = serde_json::from_str(&json).unwrap();
    let losses = &json["losses"];
    let parts = losses["parts"].as_array().unwrap();
    let sum = |of: &str| parts.iter().map(|part| part[of].as_f64().unwrap()).sum::<f64>();
    assert_eq!(parts.len(), 4);
    assert!((sum("share") - 1.0).abs() < 1e-12 && (sum("power") / all - 1.0).abs() < 1e-12);
    // Read back from text, perhaps but for the last bit.
    for (value, expected) in [(&losses["torque_times_speed"], torque), (&json["figures"]["loss.total"], all)]
    {
        assert!((value.as_f64().unwrap() / expected - 1.0).abs() < 1e-14, "{value} {expected}");
    }
}

#[test]
fn invariant_losses_close_where_speeds_change() {
    // A run up, in mist and with a cage: half of what is brought goes into motion.
    let changes = [
        ("load.inner_speed", "[[0, 100], [\"20 ms\", 2000]]"),
        ("effects.ambient", "{ density = 50.0, viscosity = 18e-6 }"),
        ("load.duration", "\"20 ms\""),
    ];
    let scratch = Scratch::new("losses-run-up");
    let (said, mean) = run(&scratch, &edited("cage", &changes).source, "out");
    let all = mean("loss.total");
    assert!(mean("into motion and springs") > 0.3 * all, "{said}");
    assert!(mean("losses left open").abs() < 2e-3 * all, "{said}");
    let parts = ["loss.sliding", "loss.cage", "loss.drag", "loss.damping"].map(&mean);
    assert!((parts.iter().sum::<f64>() / all - 1.0).abs() < 1e-12);
}
