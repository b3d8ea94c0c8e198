//! `roulement cost`.

use std::collections::HashMap;

use roulement::Scene;

use super::sweep::{columns, good, numbers};
use super::*;

/// What `cost` says as JSON of the default steps of a scene, and its table.
fn judged(scratch: &Scratch, scene: &Scene) -> (Value, Value, HashMap<String, Vec<String>>) {
    let file = scratch.path("judged.toml");
    std::fs::write(&file, &scene.source).unwrap();
    let said = good(&roulement(&["cost", &file, "-o", &scratch.path("out"), "--only", "default", "--json"]));
    let said: Value = serde_json::from_str(&said).unwrap();
    let table = columns(&scratch.read("out/cost.csv"));
    (said[0]["promise"].clone(), said[0]["says"]["promise"].clone(), table)
}

#[test]
fn regression_cost_says_what_the_default_steps_cost_and_where_they_do_not_keep_their_promise() {
    // As in the table of docs/accuracy-cost.md: 2.58 times the cheapest, and a blow whose history is off by twice the promise.
    let scratch = Scratch::new("promise");
    let run = |scene: &Scene| -> f64 {
        good(&scratch.run(scene, "run", &[]));
        let record: Value = serde_json::from_str(&scratch.read("run/run.json")).unwrap();
        // One with derivatives counts as three.
        record["cost"]["contact_values"].as_f64().unwrap()
            + 3.0 * record["cost"]["contact_tangents"].as_f64().unwrap()
    };
    let short = [("solver", "{}"), ("load.duration", "\"10 ms\""), ("load.output_interval", "\"100 us\"")];
    for (scene, kept, costs) in
        [("error/miniature", true, 2.0..3.2), ("effects/soft_housing", false, 0.4..0.7)]
    {
        let changes = if kept { &short[..1] } else { &short };
        let scene = edited(scene, changes);
        let (promise, says, table) = judged(&scratch, &scene);
        let [steps] = &promise["steps"].as_array().unwrap()[..] else { panic!("{promise}") };
        let of = |key: &str| steps[key].as_f64().unwrap();
        let (over, cost) = (of("error_over_promise"), of("cost_over_cheapest"));
        assert!(steps["kept"] == kept && (over <= 1.0) == kept && costs.contains(&cost), "{promise}");
        assert_eq!(run(&scene), of("contact_evaluations"));
        // The cheapest that keeps it is among those that were tried, and none that is cheaper keeps it.
        let tolerances = promise["tolerances"].as_array().unwrap();
        let cheapest =
            tolerances.iter().find(|tried| tried["tolerance"] == promise["cheapest_tolerance"]).unwrap();
        let evaluations = |tried: &Value| tried["contact_evaluations"].as_f64().unwrap();
        assert!(
            cheapest["kept"] == true
                && (evaluations(steps) / evaluations(cheapest) / cost - 1.0).abs() < 1e-12
        );
        assert!(
            tolerances
                .iter()
                .all(|tried| tried["kept"] == false || evaluations(tried) >= evaluations(cheapest))
        );
        // The sentence and the table say the same.
        let sentence = says[0].as_str().unwrap();
        let words = match kept {
            true => format!(
                "default steps: {cost:.2} times the cost of the cheapest tolerance that keeps 1 % of means and 2 % of histories ("
            ),
            false => format!(
                "default steps do NOT keep 1 % of means and 2 % of histories here: errors are up to {over:.2} times that; "
            ),
        };
        assert!(sentence.starts_with(&words), "{sentence}");
        assert!(scratch.read("out/report.md").contains(sentence));
        let row = table["setting"].iter().position(|setting| setting == "default steps").unwrap();
        let number = |name: &str| table[name][row].parse::<f64>().unwrap();
        for (name, value) in
            [("error over the promise [-]", over), ("cost over the cheapest that keeps it [-]", cost)]
        {
            assert!((number(name) / value - 1.0).abs() < 1e-4, "{name}");
        }
    }
}

#[test]
fn cost_judges_the_steps_of_a_scene_beside_the_default() {
    let scratch = Scratch::new("own-steps");
    let duration = ("load.duration", "\"2 ms\"");
    let fixed = edited("cost/thrust", &[duration, ("solver", "{ max_step = \"2 us\", tolerance = 1e-6 }")]);
    let (promise, says, table) = judged(&scratch, &fixed);
    let [usual, own] = &promise["steps"].as_array().unwrap()[..] else { panic!("{promise}") };
    let of = |steps: &Value, key: &str| steps[key].as_f64().unwrap();
    assert!(of(own, "tolerance") == 1e-6 && of(usual, "tolerance") <= 5e-9, "{promise}");
    assert_eq!(table["setting"][1..3], ["default steps", "steps of the scene"]);
    assert!(says[1].as_str().unwrap().starts_with("steps of the scene"), "{says}");
    // Steps of 2 us are short, and every one of them is taken.
    let row = numbers(&table["steps"][1..3]);
    assert!(
        row[1] >= 1000.0 && of(own, "cost_over_cheapest") > 1.5 * of(usual, "cost_over_cheapest"),
        "{promise}"
    );
    // The default does not depend on what the scene says.
    let (nothing, _, _) = judged(&scratch, &edited("cost/thrust", &[duration, ("solver", "{}")]));
    assert_eq!((&nothing["steps"][0], &nothing["tolerances"]), (usual, &promise["tolerances"]));
}

#[test]
fn cost_studies_the_levers_that_are_asked_for_and_ends_with_advice() {
    let scratch = Scratch::new("only");
    let text = edited("cost/thrust", &[("load.duration", "\"1 ms\"")]).source;
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
fn cost_compares_steps_of_a_machine_without_states_by_its_own_evaluations() {
    let scratch = Scratch::new("stateless");
    let text = std::fs::read_to_string(scene("shafts/pinion")).unwrap();
    let text = text.replace("catalogue = \"7206 B\"", "catalogue = \"7206 B\"\nlevel = \"equilibrium\"");
    std::fs::write(scratch.path("short.toml"), text.replace("\"20 ms\"", "\"2 ms\"")).unwrap();
    let arguments = ["cost", &scratch.path("short.toml"), "-o", &scratch.path("out"), "--only", "default"];
    let output = roulement(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout).unwrap();
    let (_, times) = said.split_once("default steps: ").unwrap_or_else(|| panic!("{said}"));
    let (times, _) = times.split_once(" times the cost").unwrap_or_else(|| panic!("{said}"));
    assert!((0.2..20.0).contains(&times.parse::<f64>().unwrap()), "{said}");
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
        std::fs::write(scratch.path("drift.toml"), edited("cost/thrust", &changes).source).unwrap();
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
    let text = edited("cost/thrust", &[("load.duration", "\"1 ms\"")]).source;
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
        assert_eq!(units_in_a_pixel(&picture), 10.0);
        assert!(picture.contains("CPU seconds per simulated second") && picture.contains("Pareto front"));
    }
    let report = std::fs::read_to_string(scratch.path("out/report.md")).unwrap();
    let page = std::fs::read_to_string(scratch.path("out/report.html")).unwrap();
    for part in ["Thrust", "fixed step", "creep law", "balanced", "short-overview.svg"] {
        assert!(report.contains(part) && page.contains(part), "{part}");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_keeps_what_it_has() {
    let scratch = Scratch::new("cost-interrupted");
    let study = |duration: &str, seconds: f64| {
        let text = edited("cost/thrust", &[("load.duration", duration)]).source;
        std::fs::write(scratch.path("study.toml"), text).unwrap();
        let child = Command::new(env!("CARGO_BIN_EXE_roulement"))
            .args(["cost", &scratch.path("study.toml"), "-o", &scratch.path("out"), "--threads", "1"])
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_secs_f64(seconds));
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    };
    let said = study("\"1000 s\"", 1.0);
    assert!(said.contains("interrupted: before any reference was there"), "{said}");
    assert!(!Path::new(&scratch.path("out/cost.csv")).exists());
}
