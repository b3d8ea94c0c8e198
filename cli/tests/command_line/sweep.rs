//! `roulement sweep`: its numbers, order, failures and interruptions; `run` as JSON and Parquet.

use std::collections::HashMap;
use std::process::{Child, Output};
use std::time::{Duration, Instant};

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use super::*;

/// A table by its columns.
pub fn columns(text: &str) -> HashMap<String, Vec<String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let column = |i: usize| rows.iter().map(|row| row[i].to_string()).collect();
    header.iter().enumerate().map(|(i, name)| (name.to_string(), column(i))).collect()
}

fn sweep(scratch: &Scratch, cases: &str, to: &str, options: &[&str]) -> Output {
    let (base, cases, to) = (scene("thrust"), scratch.path(cases), scratch.path(to));
    roulement(&[&["sweep", &cases, "--scene", &base, "-o", &to], options].concat())
}

pub fn good(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What a sweep says that has no result of every case.
fn incomplete(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(4), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub fn numbers(texts: &[String]) -> Vec<f64> {
    texts.iter().map(|text| text.parse().unwrap()).collect()
}

#[test]
fn consistency_numbers_of_a_case_are_those_of_a_run() {
    let scratch = Scratch::new("sweep-run");
    let text = "load.x.force,friction.ball_race,rating,load.duration\n0.8 kN,0.05,{ },4 ms\n1500,,,3 ms\n";
    std::fs::write(
        scratch.path("cases.csv"),
        text.replace("{ }", "\"{ contamination = 0.5, viscosity = 1e-5 }\""),
    )
    .unwrap();
    let chosen = "inner.force.x,ball[*].outer.load";
    good(&sweep(&scratch, "cases.csv", "out", &["--columns", chosen, "--tables", "csv"]));
    let summary = columns(&scratch.read("out/summary.csv"));
    let first: &[(&str, &str)] = &[
        ("load.x.force", "\"0.8 kN\""),
        ("friction.ball_race", "0.05"),
        ("rating", "{ contamination = 0.5, viscosity = 1e-5 }"),
        ("load.duration", "\"4 ms\""),
    ];
    let second: &[(&str, &str)] = &[("load.x.force", "1500"), ("load.duration", "\"3 ms\"")];
    for (case, changes) in [first, second].into_iter().enumerate() {
        good(&scratch.run(&edited("thrust", changes), "run", &[]));
        let (means, table) =
            (columns(&scratch.read("run/means.csv")), columns(&scratch.read("run/results.csv")));
        let mut compared = 0;
        for (place, name) in means["quantity"].iter().enumerate() {
            let key = match name.as_str() {
                "force.x on the inner race" => "inner.force.x",
                "friction power" => "friction_power",
                "cage speed" => "cage_speed",
                "loss.total" => "loss.total",
                _ => continue,
            };
            let unit = &means["unit"][place];
            for (of, in_run) in [("mean", "mean"), ("interval_95", "interval_95")] {
                let value: f64 = summary[&format!("{key}.{of} [{unit}]")][case].parse().unwrap();
                assert_eq!(
                    value.to_bits(),
                    means[in_run][place].parse::<f64>().unwrap().to_bits(),
                    "{name} {of}"
                );
                compared += 1;
            }
        }
        assert_eq!(compared, 8);
        let of = |name: &str| numbers(&table[name]);
        let extreme = |name: &str| -> f64 { summary[name][case].parse().unwrap() };
        let least = |values: Vec<f64>| values.into_iter().fold(f64::INFINITY, f64::min);
        let largest = |values: Vec<f64>| values.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // Steps see more than rows: extremes are no less, and hardly more, as loads swing slower than rows are apart.
        let beyond = |name: &str, of_rows: f64, sign: f64| {
            let more = sign * (extreme(name) - of_rows);
            assert!(more >= 0.0 && more < 1e-2 * of_rows.abs(), "{name}: {} {of_rows}", extreme(name));
        };
        beyond("friction_power.largest [W]", largest(of("friction_power [W]")), 1.0);
        beyond("inner.force.x.least [N]", least(of("inner.force.x [N]")), -1.0);
        let loads: Vec<f64> = (1..=10).flat_map(|ball| of(&format!("ball[{ball}].inner.load [N]"))).collect();
        beyond("ball.inner.load.largest [N]", largest(loads.clone()), 1.0);
        beyond("ball.inner.load.least [N]", least(loads), -1.0);
        // A chosen column: its mean over the window of the means.
        let one = of("ball[3].outer.load [N]");
        assert_eq!(extreme("ball[3].outer.load.end [N]"), *one.last().unwrap());
        beyond("ball[3].outer.load.least [N]", least(one.clone()), -1.0);
        let begin: f64 = means["window_begin [s]"][0].parse().unwrap();
        let window: Vec<f64> = of("time [s]")
            .into_iter()
            .zip(one)
            .filter(|(time, _)| *time >= begin)
            .map(|(_, load)| load)
            .collect();
        let mean = window.iter().sum::<f64>() / window.len() as f64;
        // Over time, and not over rows.
        assert!((extreme("ball[3].outer.load.mean [N]") / mean - 1.0).abs() < 1e-4);
        // What an effect reports is there where it is on.
        let life = &summary["life.L10r.end [1]"];
        assert_eq!(life[case].is_empty(), case == 1);
        // The whole table has the chosen columns of the run's.
        let file = &summary["file"][case];
        let whole = columns(&scratch.read(&format!("out/tables/{file}.csv")));
        assert_eq!(whole.len(), 12);
        assert!(whole.iter().all(|(name, values)| *values == table[name]));
    }
}

#[test]
fn invariant_order_and_bits_whatever_finishes_first() {
    let scratch = Scratch::new("sweep-order");
    let durations = ["8 ms", "0.2 ms", "4 ms", "0.3 ms", "0.1 ms", "2 ms"];
    let text = "load.duration\n".to_string() + &durations.join("\n");
    std::fs::write(scratch.path("cases.csv"), text).unwrap();
    good(&sweep(&scratch, "cases.csv", "one", &["--threads", "1"]));
    good(&sweep(&scratch, "cases.csv", "two", &["--threads", "2"]));
    let summary = scratch.read("one/summary.csv");
    assert_eq!(summary, scratch.read("two/summary.csv"));
    let summary = columns(&summary);
    assert_eq!(numbers(&summary["time [s]"]), [8e-3, 2e-4, 4e-3, 3e-4, 1e-4, 2e-3]);
    assert_eq!(summary["case"], ["1", "2", "3", "4", "5", "6"]);
    // The same in Parquet, to the last bit.
    let file = std::fs::File::open(scratch.path("two/summary.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let mut compared = 0;
    for (case, row) in reader.get_row_iter(None).unwrap().enumerate() {
        for (name, field) in row.unwrap().get_column_iter() {
            if let Field::Double(value) = field {
                let names = summary.iter().filter(|(header, _)| header.split(" [").next() == Some(name));
                for (_, texts) in names {
                    assert_eq!(texts[case].parse::<f64>().unwrap().to_bits(), value.to_bits(), "{name}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 6 * 60, "{compared}");
}

#[test]
fn a_failed_case_is_a_row_with_its_reason() {
    let scratch = Scratch::new("sweep-failed");
    // A value out of range, a step that cannot be finished, and a good case.
    let text = "friction.ball_race,solver.min_step,solver.initial_step,solver.tolerance,load.duration\n\
                -1,,,,1 ms\n,9 us,10 us,1e-12,1 ms\n0.05,,,,1 ms\n";
    std::fs::write(scratch.path("cases.csv"), text).unwrap();
    let said = incomplete(&sweep(&scratch, "cases.csv", "out", &[]));
    assert!(said.contains("1 done, 2 failed, 0 not run"), "{said}");
    let summary = columns(&scratch.read("out/summary.csv"));
    assert_eq!(summary["status"], ["failed", "failed", "done"]);
    assert!(summary["reason"][0].contains("friction.ball_race = -1"), "{:?}", summary["reason"]);
    assert!(
        summary["reason"][1].contains("at ") && summary["reason"][1].contains("step"),
        "{:?}",
        summary["reason"]
    );
    assert!(summary["reason"][2].is_empty() && summary["time [s]"][0].is_empty());
    // It is not tried again.
    let said = incomplete(&sweep(&scratch, "cases.csv", "out", &[]));
    assert!(said.contains("3 of them were there already"), "{said}");
}

/// A sweep of many cases that has finished some of them.
fn begun(scratch: &Scratch, to: &str) -> Child {
    let rows: String = (0..24).map(|i| format!("{}\n", 0.05 + 0.001 * f64::from(i))).collect();
    let text = "friction.ball_race\n".to_string() + &rows;
    std::fs::write(scratch.path("cases.csv"), text).unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_roulement"))
        .args(["sweep", &scratch.path("cases.csv"), "--scene", &scene("thrust"), "--threads", "2"])
        .args(["-o", &scratch.path(to)])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    while finished(scratch, to).len() < 3 {
        assert!(begin.elapsed() < Duration::from_secs(120));
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

/// Files of cases with the times they were written at.
fn finished(scratch: &Scratch, to: &str) -> HashMap<String, std::time::SystemTime> {
    let Ok(files) = std::fs::read_dir(scratch.path(&format!("{to}/cases"))) else { return HashMap::new() };
    let files =
        files.map(|file| file.unwrap()).filter(|file| !file.file_name().to_string_lossy().starts_with('.'));
    files
        .filter_map(|file| {
            let written = file.metadata().ok()?.modified().ok()?;
            Some((file.file_name().to_string_lossy().into_owned(), written))
        })
        .collect()
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_goes_on_where_it_was() {
    let scratch = Scratch::new("sweep-interrupted");
    for (signal, to) in [("-INT", "interrupted"), ("-TERM", "ended"), ("-KILL", "killed")] {
        let mut child = begun(&scratch, to);
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        let code = child.wait().unwrap().code();
        let kept = finished(&scratch, to);
        assert!((3..24).contains(&kept.len()), "{}", kept.len());
        if signal != "-KILL" {
            assert_eq!(code, Some(130));
            let summary = columns(&scratch.read(&format!("{to}/summary.csv")));
            let count = |status: &str| summary["status"].iter().filter(|s| *s == status).count();
            assert_eq!((count("done"), count("not run")), (kept.len(), 24 - kept.len()));
        }
        let said = good(&sweep(&scratch, "cases.csv", to, &[]));
        assert!(said.contains(&format!("24 done, 0 failed, 0 not run; {} of them", kept.len())), "{said}");
        // What was there was not written again.
        let all = finished(&scratch, to);
        assert_eq!(all.len(), 24);
        assert!(kept.iter().all(|(name, written)| all[name] == *written));
    }
    assert_eq!(scratch.read("interrupted/summary.csv"), scratch.read("killed/summary.csv"));
}

#[test]
fn keys_have_the_units_of_scene_files() {
    let scratch = Scratch::new("sweep-units");
    let table = "load.x.force [kN],load.inner_speed [min^-1],load.duration\n0.8,3000,1 ms\n";
    let cells = "load.x.force,load.inner_speed,load.duration\n800 N,50 Hz,0.001\n";
    let toml = "[[case]]\nload.x.force = 800\nload.inner_speed = \"3000 rpm\"\nload.duration = \"1000 us\"\n";
    let mut numbers = vec![];
    for (name, text) in [("a.csv", table), ("b.csv", &cells.replace("50 Hz", "3000 rpm")), ("c.toml", toml)] {
        std::fs::write(scratch.path(name), text).unwrap();
        good(&sweep(&scratch, name, "out", &[]));
        let summary = columns(&scratch.read("out/summary.csv"));
        assert_eq!(summary["status"], ["done"]);
        numbers.push(summary["friction_power.mean [W]"].clone());
    }
    assert!(numbers.iter().all(|power| *power == numbers[0]), "{numbers:?}");
    let base = columns(&{
        std::fs::write(scratch.path("d.csv"), "load.duration\n1 ms\n").unwrap();
        good(&sweep(&scratch, "d.csv", "out", &[]));
        scratch.read("out/summary.csv")
    });
    assert_ne!(numbers[0], base["friction_power.mean [W]"]);
}

#[test]
fn refusals_name_what_is_wrong() {
    let scratch = Scratch::new("sweep-refused");
    for (name, text, parts) in [
        (
            "a.csv",
            "friction.bal_race\n0.05\n0.1\n",
            &["no case that sets friction.bal_race", "did you mean ball_race?"][..],
        ),
        ("b.csv", "load.x.force [kg]\n1\n", &["load.x.force", "kg measures something else"]),
        (
            "c.csv",
            "friction.ball_race,friction.ball_race\n1,2\n",
            &["c.csv", "friction.ball_race stands there twice"],
        ),
        ("d.csv", "friction.ball_race\n", &["d.csv", "no case"]),
        ("e.csv", "friction.ball_race\n1,2\n", &["e.csv", "field"]),
        ("f.toml", "[gird]\n", &["f.toml", "gird", "grid"]),
        (
            "g.toml",
            "[grid]\nload.x.force = { from = 1, to = \"2 N\", steps = 3 }\n",
            &["grid.load.x.force", "same unit"],
        ),
        ("h.toml", "[grid]\nload.x.force = { from = 1, to = 2 }\n", &["grid.load.x.force", "steps"]),
        (
            "i.toml",
            "[grid]\nload.x.force = { from = 1, to = 2, step = 3 }\n",
            &["grid.load.x.force", "step", "steps"],
        ),
        ("j.toml", "[latin_hypercube]\ncases = 0\n", &["latin_hypercube.cases"]),
        (
            "k.toml",
            "[grid]\nload.x.force = { from = -1, to = 2, steps = 3, scale = \"log\" }\n",
            &["positive"],
        ),
        ("l.csv", "load.x.force\n1\n", &["such column", "inner.forc"]),
    ] {
        std::fs::write(scratch.path(name), text).unwrap();
        let options: &[&str] = if name == "l.csv" { &["--columns", "inner.forc"] } else { &[] };
        let output = sweep(&scratch, name, "out", options);
        assert!(!output.status.success(), "{name}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        for part in parts {
            assert!(message.contains(part), "{name}: {message}\nshould say {part}");
        }
    }
    let output = roulement(&["sweep", &scratch.path("a.csv"), "-o", &scratch.path("out")]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("--scene"));
}

#[test]
fn closed_form_grids_and_latin_hypercubes() {
    let scratch = Scratch::new("sweep-ranges");
    let text = format!(
        "scene = {:?}\nremove = [\"effects.damping\"]\n[set]\nload.duration = \"0.1 ms\"\n\
         [grid]\nbearing.balls = [8, 9]\nload.x.force = {{ from = \"0.5 kN\", to = \"2 kN\", steps = 3, scale = \"log\" }}\n\
         [latin_hypercube]\ncases = 8\nseed = 3\nfriction.ball_race = {{ from = 0.04, to = 0.12 }}\n\
         load.inner_speed = {{ from = \"1000 rpm\", to = \"9000 rpm\" }}\n",
        scene("thrust")
    );
    std::fs::write(scratch.path("cases.toml"), text).unwrap();
    good(&roulement(&["sweep", &scratch.path("cases.toml"), "-o", &scratch.path("out")]));
    let summary = columns(&scratch.read("out/summary.csv"));
    assert_eq!(summary["status"].iter().filter(|status| *status == "done").count(), 14);
    assert_eq!(summary["bearing.balls"][..6], ["8", "8", "8", "9", "9", "9"]);
    let forces = numbers(&summary["load.x.force [kN]"][..6]);
    for (force, expected) in forces.into_iter().zip([0.5, 1.0, 2.0, 0.5, 1.0, 2.0]) {
        assert!((force - expected).abs() < 1e-12);
    }
    for (name, from, to) in [("friction.ball_race", 0.04, 0.12), ("load.inner_speed [rpm]", 1e3, 9e3)] {
        // One in each eighth, and not in the order of the eighths.
        let values = numbers(&summary[name][6..]);
        let part = |value: &f64| ((value - from) / (to - from) * 8.0) as usize;
        let parts: Vec<usize> = values.iter().map(part).collect();
        let mut sorted = parts.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_ne!(parts, sorted);
    }
}

#[test]
fn consistency_a_case_with_an_error_goal_has_the_error_bars_of_the_run() {
    let scratch = Scratch::new("sweep-error");
    let changes = [("solver.accuracy", "{ error = 1e-2 }"), ("load.duration", "\"2 ms\"")];
    good(&scratch.run(&edited("thrust", &changes), "run", &[]));
    std::fs::write(scratch.path("cases.csv"), "solver.accuracy,load.duration\n{ error = 1e-2 },2 ms\n")
        .unwrap();
    good(&sweep(&scratch, "cases.csv", "out", &[]));
    let (means, summary) =
        (columns(&scratch.read("run/means.csv")), columns(&scratch.read("out/summary.csv")));
    let place = means["quantity"].iter().position(|name| name == "friction torque").unwrap();
    let number = |text: &str| text.parse::<f64>().unwrap();
    assert_eq!(number(&summary["friction_torque.error [N.m]"][0]), number(&means["error"][place]));
    assert_eq!(number(&summary["friction_torque.mean [N.m]"][0]), number(&means["mean"][place]));
    assert!(number(&means["error"][place]) > 0.0 && summary["error_goal"] == ["met"]);
}

#[test]
fn a_run_is_written_as_parquet_and_json_with_the_same_bits() {
    let scratch = Scratch::new("run-parquet");
    let short = edited("thrust", &[("load.duration", "\"1 ms\"")]);
    let printed = good(&scratch.run(&short, "out", &["--json"]));
    good(&scratch.run(&short, "table.parquet", &["--columns", "inner.*,ball[2].*"]));
    let table = columns(&scratch.read("out/results.csv"));
    let reader =
        SerializedFileReader::new(std::fs::File::open(scratch.path("table.parquet")).unwrap()).unwrap();
    let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap().clone();
    let units = metadata.iter().find(|entry| entry.key == "units").unwrap().value.clone().unwrap();
    let units: Value = serde_json::from_str(&units).unwrap();
    let mut rows = 0;
    for (index, row) in reader.get_row_iter(None).unwrap().enumerate() {
        let row = row.unwrap();
        assert!(row.len() > 20 && row.len() < 80);
        for (name, field) in row.get_column_iter() {
            let Field::Double(value) = field else { panic!("{name}: {field}") };
            let header = format!("{name} [{}]", units[name].as_str().unwrap());
            assert_eq!(table[&header][index].parse::<f64>().unwrap().to_bits(), value.to_bits(), "{header}");
        }
        rows += 1;
    }
    assert_eq!(rows, 11);
    let json: Value = serde_json::from_str(&printed).unwrap();
    let means = columns(&scratch.read("out/means.csv"));
    let listed = json["means"]["quantities"].as_array().unwrap();
    // Behind means are the four numbers that close the losses.
    assert_eq!(means["quantity"][listed.len()..].first().map(String::as_str), Some("torque times speed"));
    assert_eq!(listed.len() + 4, means["mean"].len());
    for (of, text) in listed.iter().zip(&means["mean"]) {
        assert!(
            (of["mean"].as_f64().unwrap() - text.parse::<f64>().unwrap()).abs()
                <= 1e-15 * of["mean"].as_f64().unwrap().abs()
        );
    }
    assert_eq!(json["time"], 1e-3);
    assert!(json["figures"]["largest inner load"].as_f64().unwrap() > 100.0);
}

#[test]
fn a_run_of_a_shaft_is_written_as_one_parquet_table_with_the_bits_of_its_bearings() {
    let scratch = Scratch::new("shaft-parquet");
    let text = include_str!("../../../scenes/shafts/pinion.toml");
    let short = text.replace("duration = \"20 ms\"", "duration = \"300 us\"");
    assert_ne!(text, short);
    let file = scratch.path("scene.toml");
    std::fs::write(&file, short).unwrap();
    let run =
        |to: &str, columns: &str| roulement(&["run", &file, "-o", &scratch.path(to), "--columns", columns]);
    good(&run("out", "inner.force.*"));
    let said = good(&run("table.parquet", "left.inner.force.*,shaft.angle"));
    assert!(said.contains(&scratch.path("table.parquet")) && !said.contains("plot"), "{said}");
    let [bearing, shaft] = ["out/left/results.csv", "out/shaft.csv"].map(|path| columns(&scratch.read(path)));
    let reader =
        SerializedFileReader::new(std::fs::File::open(scratch.path("table.parquet")).unwrap()).unwrap();
    let mut rows = 0;
    for (index, row) in reader.get_row_iter(None).unwrap().enumerate() {
        let row = row.unwrap();
        let number = |wanted: &str| {
            let field = row.get_column_iter().find(|(name, _)| *name == wanted).unwrap().1;
            let Field::Double(value) = field else { panic!("{wanted}: {field}") };
            *value
        };
        assert_eq!(row.len(), 5);
        for axis in ["x", "y", "z"] {
            let own: f64 = bearing[&format!("inner.force.{axis} [N]")][index].parse().unwrap();
            assert_eq!(number(&format!("left.inner.force.{axis}")).to_bits(), own.to_bits());
        }
        assert_eq!(number("time"), bearing["time [s]"][index].parse::<f64>().unwrap());
        assert!(number("shaft.angle") >= 0.0 && shaft["time [s]"].len() > index);
        rows += 1;
    }
    assert_eq!(rows, bearing["time [s]"].len());
    let refused = run("other.parquet", "left.inner.farce");
    assert!(
        !refused.status.success() && String::from_utf8_lossy(&refused.stderr).contains("left.inner.farce")
    );
}

#[test]
fn consistency_a_kept_run_is_that_of_its_scene_and_stands_on_the_page() {
    let scratch = Scratch::new("sweep-runs");
    // The second case cannot finish a step; the third has no scene.
    let text = "friction.ball_race,solver.min_step,solver.initial_step,solver.tolerance,load.duration\n\
                0.05,,,,1 ms\n,9 us,10 us,1e-12,1 ms\n-1,,,,1 ms\n";
    std::fs::write(scratch.path("cases.csv"), text).unwrap();
    let output = sweep(&scratch, "cases.csv", "out", &["--runs", "1,2,3"]);
    let said = incomplete(&output);
    let summary = columns(&scratch.read("out/summary.csv"));
    let file = &summary["file"];
    assert!(said.contains("run 1 ") && said.contains(&format!("runs/{}", file[0])), "{said}");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        told.contains("case 2: ") && told.contains("case 3: ") && told.contains("friction.ball_race = -1"),
        "{told}"
    );

    let changes = [("friction.ball_race", "0.05"), ("load.duration", "\"1 ms\"")];
    good(&scratch.run(&edited("thrust", &changes), "run", &[]));
    for name in ["results.csv", "means.csv", "bearing.svg"] {
        assert_eq!(
            scratch.read(&format!("out/runs/{}/{name}", file[0])),
            scratch.read(&format!("run/{name}"))
        );
    }
    // What is kept is not run again, and nothing that is not whole stays.
    let record = scratch.path(&format!("out/runs/{}/run.json", file[0]));
    let written = || std::fs::metadata(&record).unwrap().modified().unwrap();
    let before = written();
    incomplete(&sweep(&scratch, "cases.csv", "out", &["--runs", "1"]));
    assert_eq!(written(), before);
    let kept = std::fs::read_dir(scratch.path("out/runs")).unwrap();
    let kept: Vec<String> = kept.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert!(kept.contains(&file[0]) && kept.iter().all(|name| file.contains(name)), "{kept:?}");

    let page = scratch.path("sweep.html");
    good(&roulement(&["report", &scratch.path("out"), "-o", &page]));
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains(&format!("\"{}\":{{", file[0])) && page.contains("\"name\":\"case 1\""));

    let refused = sweep(&scratch, "cases.csv", "out", &["--runs", "4"]);
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(
        !refused.status.success() && told.contains("--runs 4: ") && told.contains("has 3 cases"),
        "{told}"
    );
}

#[test]
fn consistency_a_case_sets_a_value_over_time_in_csv_and_toml() {
    let scratch = Scratch::new("sweep-blocks");
    let measured = "t [ms],F [N]\n0,0\n0.5,80\n1,-20\n";
    std::fs::write(scratch.path("measured.csv"), measured).unwrap();
    let ramp = "{ ramp = ['0 N', '0.1 kN'], from = '0.2 ms', to = '0.8 ms' }";
    let sine = "{ mean = 20, amplitude = 50, frequency = '2 kHz' }";
    let file = "{ file = 'measured.csv', time = 't [ms]', value = 'F [N]' }";
    let gear =
        "[{ torque = '5 N m', pitch_radius = 0.02, pressure_angle = '20 deg', teeth = 23, ripple = 0.1 }]";
    // The unit of a column is that of plain numbers alone.
    let table = format!(
        "load.y.force [kN],load.gear,load.duration\n\"{ramp}\",,1 ms\n\"{sine}\",,1 ms\n\"{file}\",,1 ms\n0.03,\"{gear}\",1 ms\n"
    );
    let toml = format!(
        "[set]\nload.duration = \"1 ms\"\n[[case]]\nload.y.force = {ramp}\n[[case]]\nload.y.force = {sine}\n\
         [[case]]\nload.y.force = {file}\n[[case]]\nload.y.force = 30\nload.gear = {gear}\n"
    );
    let grid = format!(
        "[set]\nload.duration = \"1 ms\"\n[grid]\nload.y.force = [{ramp}, {sine}]\n[[case]]\nload.x.force = 1500\n"
    );
    let powers = |name: &str, text: &str, count: usize| {
        std::fs::write(scratch.path(name), text).unwrap();
        let said = good(&sweep(&scratch, name, "out", &[]));
        assert!(said.contains(&format!("{count} done, 0 failed")), "{said}");
        let summary = columns(&scratch.read("out/summary.csv"));
        numbers(&summary["friction_power.mean [W]"])
    };
    let of_table = powers("cases.csv", &table, 4);
    assert_eq!(of_table, powers("cases.toml", &toml, 4));
    assert_eq!(of_table[..2], powers("grid.toml", &grid, 3)[1..]);
    // Those of a run.
    let points = "[[0, 0], [0.0005, 80], [0.001, -20]]";
    for (case, changes) in
        [[("load.y.force", ramp)], [("load.y.force", sine)], [("load.y.force", points)]].iter().enumerate()
    {
        let changes = [&changes[..], &[("load.duration", "\"1 ms\"")]].concat();
        good(&scratch.run(&edited("thrust", &changes), "run", &[]));
        let means = columns(&scratch.read("run/means.csv"));
        let place = means["quantity"].iter().position(|name| name == "friction power").unwrap();
        assert_eq!(means["mean"][place].parse::<f64>().unwrap(), of_table[case], "{case}");
    }
    let apart = |a: usize, b: usize| of_table[a] != of_table[b];
    assert!(apart(0, 1) && apart(1, 2) && apart(2, 3) && apart(0, 3), "{of_table:?}");
    // What is in the file is in the name of the case: it is run again when the file changes, and only then.
    let again = |there: usize| {
        let said = good(&sweep(&scratch, "cases.csv", "out", &[]));
        assert!(said.contains(&format!("4 done, 0 failed, 0 not run; {there} of them")), "{said}");
        numbers(&columns(&scratch.read("out/summary.csv"))["friction_power.mean [W]"])
    };
    assert_eq!(again(4), of_table);
    std::fs::write(scratch.path("measured.csv"), measured.replace("80", "90")).unwrap();
    let changed = again(3);
    assert!(changed[2] != of_table[2] && changed[1] == of_table[1], "{changed:?}");
    // A file that is not there, or has no such column.
    for (name, word) in [("'no.csv'", "no.csv"), ("'measured.csv'", "no column \"F [kN]\"")] {
        let cell = format!("{{ file = {name}, time = 't [ms]', value = 'F [kN]' }}");
        std::fs::write(scratch.path("bad.csv"), format!("load.y.force\n\"{cell}\"\n")).unwrap();
        let output = sweep(&scratch, "bad.csv", "out", &[]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && message.contains(word), "{message}");
        assert!(message.contains("bad.csv") && message.contains("load.y.force"), "{message}");
    }
}

#[test]
fn invariant_a_run_reads_a_measured_file_beside_its_scene() {
    let scratch = Scratch::new("run-measured");
    std::fs::create_dir_all(scratch.path("scenes")).unwrap();
    std::fs::write(scratch.path("scenes/m.csv"), "t [ms],Fy [kN]\n0,0\n0.5,0.08\n1,0.02\n").unwrap();
    let base = std::fs::read_to_string(scene("thrust")).unwrap();
    let text = |force: &str| {
        let changes = [("load.y.force", force), ("load.duration", "\"1 ms\"")];
        roulement::Scene::edited_text(&base, changes).unwrap()
    };
    let file = text("{ file = 'm.csv', time = 't [ms]', value = 'Fy [kN]' }");
    std::fs::write(scratch.path("scenes/file.toml"), file).unwrap();
    std::fs::write(scratch.path("scenes/table.toml"), text("[[0, 0], ['0.5 ms', 80], ['1 ms', 20]]"))
        .unwrap();
    let results = ["file", "table"].map(|name| {
        let path = scratch.path(&format!("scenes/{name}.toml"));
        good(&roulement(&["run", &path, "-o", &scratch.path(name), "--json"]));
        scratch.read(&format!("{name}/results.csv"))
    });
    assert_eq!(results[0], results[1]);
    std::fs::write(scratch.path("scenes/m.csv"), "t [ms],Fy [kN]\n0,0\n0,1\n").unwrap();
    let output = roulement(&["run", &scratch.path("scenes/file.toml"), "-o", &scratch.path("bad")]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    for part in ["file.toml", "load.y.force", "m.csv, line 3", "t [ms] = 0 comes after 0: times must grow"] {
        assert!(message.contains(part), "{message}\nshould say {part}");
    }
}

/// Whatever happens to what is kept of a case, it is found out and the case is run again, to the same bits.
#[test]
fn regression_a_damaged_case_is_run_again() {
    let scratch = Scratch::new("sweep-damaged");
    std::fs::write(scratch.path("cases.csv"), "friction.ball_race,load.duration\n0.05,1 ms\n0.06,1 ms\n")
        .unwrap();
    let run = || sweep(&scratch, "cases.csv", "out", &["--tables", "csv", "--threads", "2"]);
    good(&run());
    let summary = scratch.read("out/summary.csv");
    let file = columns(&summary)["file"][1].clone();
    let (case, table) = (format!("out/cases/{file}.csv"), format!("out/tables/{file}.csv"));
    // Another digit: the last of a number in its last row.
    let altered = |text: &[u8]| -> Vec<u8> {
        let mut text = text.to_vec();
        let at = text.iter().position(|byte| *byte == b'\n').unwrap();
        let digit = at + text[at..].iter().position(u8::is_ascii_digit).unwrap();
        text[digit] = if text[digit] == b'1' { b'2' } else { b'1' };
        text
    };
    let shorter = |text: &[u8]| text[..text.len() / 2].to_vec();
    let empty = |_: &[u8]| vec![];
    let no_text = |_: &[u8]| vec![0xff, 0xfe, 0x00];
    type Damage<'a> = &'a dyn Fn(&[u8]) -> Vec<u8>;
    let damages: [(&str, Damage<'_>); 4] =
        [("digit", &altered), ("shorter", &shorter), ("empty", &empty), ("no text", &no_text)];
    for (of, (what, damage)) in
        [&case, &table].into_iter().flat_map(|of| damages.iter().map(move |d| (of, d)))
    {
        let whole = std::fs::read(scratch.path(of)).unwrap();
        std::fs::write(scratch.path(of), damage(&whole)).unwrap();
        let output = run();
        let said = good(&output);
        assert!(said.contains("2 done, 0 failed, 0 not run; 1 of them were there"), "{what}: {said}");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(told.contains("1 of the finished cases were damaged or changed"), "{what}: {told}");
        assert_eq!(std::fs::read(scratch.path(of)).unwrap(), whole, "{what}");
        assert_eq!(scratch.read("out/summary.csv"), summary, "{what}");
    }
    std::fs::remove_file(scratch.path(&table)).unwrap();
    assert!(good(&run()).contains("1 of them were there"));
    let output = run();
    assert!(good(&output).contains("2 of them were there"));
    assert!(!String::from_utf8_lossy(&output.stderr).contains("damaged"));
}

/// A row of the summary has what a run of the case warns of.
#[test]
fn regression_a_sweep_has_the_warnings_of_its_runs() {
    let scratch = Scratch::new("sweep-warnings");
    good(&roulement(&["bearing", "6206", "-o", &scratch.path("6206.toml")]));
    let cases = "scene = \"6206.toml\"\n[set]\nload.duration = \"3 ms\"\nload.y.force = \"4 kN\"\n\
                 solver.accuracy = \"fast\"\n[grid]\n\
                 load.rz.rotation = { from = \"0 mrad\", to = \"30 mrad\", steps = 3 }\n";
    std::fs::write(scratch.path("cases.toml"), cases).unwrap();
    let output =
        roulement(&["sweep", &scratch.path("cases.toml"), "-o", &scratch.path("out"), "--runs", "3"]);
    let said = good(&output);
    let summary = columns(&scratch.read("out/summary.csv"));
    println!("{:?}", summary["warnings"]);
    assert_eq!(summary["status"], ["done", "done", "done"]);
    assert!(summary["warnings"][0].is_empty(), "{:?}", summary["warnings"]);
    let warning = &summary["warnings"][2];
    let pressure: f64 = summary["peak_pressure.largest [Pa]"][2].parse().unwrap();
    let largest = format!("the largest contact pressure is {:.0} MPa", pressure * 1e-6);
    assert!(pressure > 5e9 && warning.contains(&largest), "{pressure} {warning}");
    for race in ["inner", "outer"] {
        let share: f64 = summary[&format!("over_{race}_shoulders.largest [1]")][2].parse().unwrap();
        let said = format!("up to {:.2} % of a load is beyond the {race} shoulders", 100.0 * share);
        assert_eq!(share > 0.0, warning.contains(&said), "{share} {warning}");
    }
    assert!(warning.contains("% of a load is beyond the"), "{warning}");
    let warned = summary["warnings"].iter().filter(|text| !text.is_empty()).count();
    let last = said.lines().last().unwrap();
    assert!(last.starts_with(&format!("WARNINGS         in {warned} cases, as in case ")), "{said}");
    // The kept run of the case says the same.
    let kept = scratch.read(&format!("out/runs/{}/summary.txt", summary["file"][2]));
    assert!(kept.contains("over shoulders "), "{kept}");
}

#[test]
fn limits_of_columns_are_times_at_which_cases_come_there_first() {
    let scratch = Scratch::new("sweep-limits");
    // The speed goes from 100 to 200 rad/s within 10 ms.
    let scene = edited(
        "thrust",
        &[
            ("load.duration", "0.01"),
            ("load.inner_speed", "[[0.0, 100.0], [0.01, 200.0]]"),
            ("solver.max_step", "1e-5"),
        ],
    );
    std::fs::write(scratch.path("scene.toml"), &scene.source).unwrap();
    std::fs::write(scratch.path("cases.csv"), "friction.ball_race\n0.08\n").unwrap();
    let sweep = |columns: &str| {
        let cases = scratch.path("cases.csv");
        roulement(&[
            "sweep",
            &cases,
            "--scene",
            &scratch.path("scene.toml"),
            "--columns",
            columns,
            "-o",
            &scratch.path("out"),
        ])
    };
    let output = sweep("inner.speed>150,inner.speed<50,ball[*].inner.load>=1");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary = scratch.read("out/summary.csv");
    let mut rows = csv::Reader::from_reader(summary.as_bytes());
    let heads = rows.headers().unwrap().clone();
    let row = rows.records().next().unwrap().unwrap();
    let cell =
        |name: &str| &row[heads.iter().position(|head| head == name).unwrap_or_else(|| panic!("{heads:?}"))];
    let time: f64 = cell("inner.speed>150.time [s]").parse().unwrap();
    // The end of the first step that goes beyond.
    assert!((0.005..=0.00502).contains(&time), "{time}");
    assert_eq!(cell("inner.speed<50.time [s]"), "");
    assert_eq!(cell("ball[*].inner.load>=1.time [s]").parse::<f64>().unwrap(), 0.0);
    for (wrong, says) in [("balls.slip<", "a limit is a column"), ("balls.slap<1", "no such column")] {
        let output = sweep(wrong);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && message.contains(says), "{message}");
    }
}

#[test]
fn independent_slip_load_of_entering_balls_by_turns_is_that_of_the_table() {
    let scratch = Scratch::new("sweep-smearing");
    // Balls that a medium holds back outside of the load zone, for seven turns of the cage.
    let changes = [
        ("load.duration", "0.1"),
        ("load.output_interval", "1e-5"),
        ("load.inner_speed", "\"12000 rpm\""),
        ("load.y.force", "300.0"),
        ("friction.ball_race", "0.01"),
        ("effects.ambient", "{ density = 60.0, viscosity = 2e-5 }"),
        ("solver.max_step", "1e-5"),
    ];
    std::fs::write(scratch.path("scene.toml"), edited("radial", &changes).source).unwrap();
    let scene = scratch.path("scene.toml");
    let output = roulement(&[
        "run",
        &scene,
        "-o",
        &scratch.path("run"),
        "--json",
        "--columns",
        "cage.speed,balls.entering_slip_load",
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let of = |name: &str| summary["entering_slip_load"][name].as_f64().unwrap_or_else(|| panic!("{summary}"));
    // By hand from rows: turns of the cage from the start on, the largest of each, those that begin in the second half.
    let table = scratch.read("run/results.csv");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let rows: Vec<Vec<f64>> =
        reader.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect()).collect();
    let (mut turned, mut begin, mut largest, mut turns) = (0.0, 0.0, rows[0][2], vec![]);
    for pair in rows.windows(2) {
        turned += pair[1][1] * (pair[1][0] - pair[0][0]);
        largest = f64::max(largest, pair[1][2]);
        if turned >= std::f64::consts::TAU {
            turns.push((begin, largest));
            (turned, begin, largest) = (turned - std::f64::consts::TAU, pair[1][0], pair[1][2]);
        }
    }
    let seen: Vec<f64> =
        turns.iter().filter(|(begin, _)| *begin >= 0.05).map(|(_, largest)| *largest).collect();
    assert!(seen.len() >= 2, "{turns:?}");
    assert_eq!(of("turns") as usize, seen.len());
    let mean = seen.iter().sum::<f64>() / seen.len() as f64;
    assert!((of("mean") / mean - 1.0).abs() < 0.05, "{} {mean}", of("mean"));
    assert!(of("largest") > 5.0);
}
