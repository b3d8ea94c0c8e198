//! `roulement cost`.

use super::*;

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
