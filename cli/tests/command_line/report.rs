//! `roulement report`: one page that needs nothing beside itself.

use super::*;
use base64::Engine;
use roulement_cli::page::grid;
use roulement_cli::report::cells::Column;

/// [byte] a usual run's page is smaller.
const MOST: usize = 2_000_000;

/// What a page's element of an id holds.
fn element<'a>(page: &'a str, id: &str) -> &'a str {
    let from = page.find(&format!("id=\"{id}\">")).unwrap() + id.len() + 6;
    let to = page[from..].find("</script>").unwrap();
    &page[from..from + to]
}

fn data(page: &str) -> Value {
    serde_json::from_str(element(page, "data")).unwrap()
}

fn written(scratch: &Scratch, arguments: &[&str]) -> String {
    let page = scratch.path("report.html");
    let output = roulement(&[&["report", "-o", &page], arguments].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), page);
    std::fs::read_to_string(page).unwrap()
}

/// Columns of all grids of a run on a page.
fn columns(run: &Value) -> Vec<(String, Vec<f64>)> {
    let tables = run["tables"].as_array().unwrap().iter().chain([&run["history"]]);
    tables.flat_map(|table| grid::read(table).unwrap()).collect()
}

#[test]
fn independent_a_page_holds_the_table_and_needs_nothing_else() {
    let scratch = Scratch::new("report");
    let title = "\"</script><b>Thrust & \\\"rest\\\"</b>\"";
    let scene = edited("thrust", &[("load.duration", "\"2 ms\""), ("title", title)]);
    assert!(scratch.run(&scene, "run", &[]).status.success());
    let page = written(&scratch, &[&scratch.path("run")]);

    // No address of anything, and a rule that forbids the browser to load any.
    for address in ["http:", "https:", "src=", "@import", "//cdn"] {
        assert!(!page.contains(address), "{address}");
    }
    assert!(
        page.contains("Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline';")
    );
    // Texts of users stay texts: the only ends of scripts are those of the page's own three.
    assert_eq!(page.matches("</script>").count(), 3);
    assert!(
        !page.contains("<b>")
            && page.contains("<title>&lt;/script&gt;&lt;b&gt;Thrust &amp; &quot;rest&quot;")
    );
    let run = &data(&page)["runs"][0];
    assert_eq!(run["title"], "</script><b>Thrust & \"rest\"</b>");
    assert_eq!(run["scene"], scene.source.as_str());

    // Every column of the table is there, to the digits that a picture needs.
    let mut table = csv::Reader::from_path(scratch.path("run/results.csv")).unwrap();
    let names: Vec<String> =
        table.headers().unwrap().iter().map(|head| Column::from_header(head).name).collect();
    let rows: Vec<Vec<f64>> =
        table.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(run["table_rows"], rows.len());
    let held = columns(run);
    for (place, name) in names.iter().enumerate() {
        let values = &held.iter().find(|column| column.0 == *name).unwrap_or_else(|| panic!("{name}")).1;
        let wanted: Vec<f64> = rows.iter().map(|row| row[place]).collect();
        assert_eq!(values.len(), wanted.len(), "{name}");
        let (least, most) =
            wanted.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        for (value, wanted) in values.iter().zip(&wanted) {
            let error = (value - wanted).abs();
            assert!(error <= 2e-5 * (most - least) + 1e-15 * wanted.abs(), "{name}: {value} {wanted}");
        }
    }
    // And what the table has not: places of balls on the pitch circle, their turns, ellipses, parts of the power.
    let of = |name: &str| {
        held.iter().find(|column| column.0 == name).unwrap_or_else(|| panic!("{name}")).1.last().unwrap()
    };
    let [y, z] = ["y", "z"].map(|axis| of(&format!("ball[3].position.{axis}")));
    assert!((y.hypot(*z) - 0.023).abs() < 1e-4, "{y} {z}");
    assert!(of("ball[3].angular_velocity.x").abs() > 100.0);
    let [a, b] = ["rolling", "transverse"].map(|axis| of(&format!("ball[3].outer.semi_axis_{axis}")));
    let pressure = 1.5 * of("ball[3].outer.load") / (std::f64::consts::PI * a * b);
    assert!((pressure / of("ball[3].outer.peak_pressure") - 1.0).abs() < 1e-4, "{pressure}");
    let friction = of("power.inner.friction") + of("power.outer.friction");
    assert!((friction / of("friction_power") - 1.0).abs() < 1e-4, "{friction}");
    // Nothing is there twice.
    let mut all: Vec<&str> =
        held.iter().map(|column| column.0.as_str()).filter(|name| *name != "time").collect();
    let count = all.len();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), count);

    // The summary is that of the run.
    let figure = run["summary"]["figures"]["largest inner load"].as_f64().unwrap();
    let summary = scratch.read("run/summary.txt");
    assert!(
        summary.contains(&format!(
            "inner {:.3}",
            run["summary"]["figures"]["least inner load"].as_f64().unwrap()
        ))
    );
    assert!(summary.contains(&format!("to {figure:.3} N")) && run["summary_text"] == summary.as_str());
    // Contacts at the end: cells carry the load of their ball.
    let field = &run["fields"][0];
    let cells = grid::read(&field["cells"]).unwrap();
    let of_cell = |name: &str| &cells.iter().find(|column| column.0 == name).unwrap().1;
    let carried: f64 =
        of_cell("area").iter().zip(of_cell("pressure")).map(|(area, pressure)| area * pressure).sum();
    let load = of(&format!("ball[{}].{}.load", field["ball"], field["race"].as_str().unwrap()));
    assert!((carried / load - 1.0).abs() < 0.01, "{carried} {load}");
}

#[test]
fn a_page_of_a_usual_run_is_small_and_its_program_is_the_bundle() {
    let scratch = Scratch::new("report-size");
    let scene = edited("cage", &[]);
    assert!(scratch.run(&scene, "run", &[]).status.success());
    let page = written(&scratch, &[&scratch.path("run")]);
    assert!(page.len() < MOST, "{}", page.len());
    let bundle = base64::engine::general_purpose::STANDARD.decode(element(&page, "bundle")).unwrap();
    let committed = format!("{}/../report/bundle/report.js.gz", env!("CARGO_MANIFEST_DIR"));
    assert_eq!(bundle, std::fs::read(committed).unwrap());
}

#[test]
fn runs_stand_side_by_side_and_long_tables_are_thinned_with_their_ends() {
    let scratch = Scratch::new("report-runs");
    let scene = edited("thrust", &[("load.duration", "\"1 ms\""), ("load.output_interval", "\"10 us\"")]);
    assert!(scratch.run(&scene, "one", &[]).status.success());
    assert!(scratch.run(&scene, "two", &["--columns", "inner.force.*"]).status.success());
    let page = written(
        &scratch,
        &[&scratch.path("one"), &scratch.path("two"), "--rows", "20", "--columns", "inner.force.x"],
    );
    let all = data(&page);
    let runs = all["runs"].as_array().unwrap();
    assert_eq!([&runs[0]["name"], &runs[1]["name"]], ["one", "two"]);
    for run in runs {
        assert_eq!((&run["table_rows"], &run["strides"]), (&101.into(), &serde_json::json!([6])));
        let table = grid::read(&run["tables"][0]).unwrap();
        let time = &table.iter().find(|column| column.0 == "time").unwrap().1;
        assert_eq!((time.len(), time[0], time[time.len() - 1]), (18, 0.0, 1e-3));
        assert_eq!(table.len(), 2);
    }
}

#[test]
fn a_sweep_is_a_table_whose_failures_are_said() {
    let scratch = Scratch::new("report-sweep");
    std::fs::write(scratch.path("scene.toml"), &edited("thrust", &[("load.duration", "\"0.5 ms\"")]).source)
        .unwrap();
    std::fs::write(scratch.path("cases.csv"), "load.x.force [kN],effects.creep\n1,\n2,saturated\n1,linear\n")
        .unwrap();
    let [cases, scene, sweep] = ["cases.csv", "scene.toml", "sweep"].map(|name| scratch.path(name));
    roulement(&["sweep", &cases, "--scene", &scene, "-o", &sweep, "--tables", "csv"]);
    let all = data(&written(&scratch, &[&sweep]));
    let sweep = &all["sweeps"][0];
    assert_eq!(sweep["keys"], serde_json::json!(["load.x.force", "effects.creep"]));
    let numbers = grid::read(&sweep["numbers"]).unwrap();
    let force = &numbers.iter().find(|column| column.0 == "load.x.force").unwrap().1;
    assert!(
        force.iter().zip([1.0, 2.0, 1.0]).all(|(force, wanted)| (force - wanted).abs() < 1e-4),
        "{force:?}"
    );
    let text = |name: &str| {
        sweep["texts"].as_array().unwrap().iter().find(|column| column["name"] == name).unwrap()["cells"]
            .clone()
    };
    assert_eq!(text("status"), serde_json::json!(["done", "done", "failed"]));
    assert!(text("reason")[2].as_str().unwrap().len() > 10);
    // Whole tables of the cases that have one.
    let tables = sweep["tables"].as_object().unwrap();
    assert_eq!(tables.len(), 2);
    let table = &tables[text("file")[0].as_str().unwrap()];
    assert!(grid::read(&table[0]).unwrap().iter().any(|column| column.0 == "inner.force.x"));
}

#[test]
fn fields_of_other_contacts_are_added() {
    let scratch = Scratch::new("report-field");
    let scene = edited("thrust", &[("load.duration", "\"0.3 ms\"")]);
    assert!(scratch.run(&scene, "run", &[]).status.success());
    let [file, field] = ["scene.toml", "field.csv"].map(|name| scratch.path(name));
    let output = roulement(&[
        "field",
        &file,
        "--contacts",
        "2.outer,7.inner",
        "--times",
        "0.1 ms,0.2 ms",
        "--cells",
        "12",
        "-o",
        &field,
    ]);
    assert!(output.status.success());
    let all = data(&written(&scratch, &[&scratch.path("run"), "--field", &field]));
    let fields = all["runs"][0]["fields"].as_array().unwrap();
    let added = &fields[fields.len() - 4..];
    let names: Vec<_> = added
        .iter()
        .map(|f| (f["time"].as_f64().unwrap(), f["ball"].as_u64().unwrap(), f["race"].as_str().unwrap()))
        .collect();
    assert_eq!(names, [(1e-4, 2, "outer"), (1e-4, 7, "inner"), (2e-4, 2, "outer"), (2e-4, 7, "inner")]);
    // Their ellipses are those of the loads: as that of the record, which the solver gave itself.
    let axes = |field: &Value| [0, 1].map(|i| field["semi_axes"][i].as_f64().unwrap());
    let own = fields.iter().find(|field| field["race"] == "outer").unwrap();
    for (read, given) in axes(&added[0]).iter().zip(axes(own)) {
        assert!((read / given - 1.0).abs() < 0.15, "{read} {given}");
    }
}

#[test]
fn error_what_is_no_result_is_refused_with_its_name() {
    let scratch = Scratch::new("report-refused");
    let refused = |arguments: &[&str], parts: &[&str]| {
        let output = roulement(&[&["report", "-o", &scratch.path("x.html")], arguments].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && parts.iter().all(|part| said.contains(part)), "{said}");
    };
    let directory = scratch.path("old");
    std::fs::create_dir_all(&directory).unwrap();
    refused(&[&directory], &["old/run.json", "roulement run SCENE -o"]);
    std::fs::write(scratch.path("old/run.json"), "{\"form\": 0}").unwrap();
    refused(&[&directory], &["old/run.json has form 0, this program reads 1"]);
    std::fs::write(scratch.path("old/run.json"), "no JSON").unwrap();
    refused(&[&directory], &["old/run.json is no record of a run"]);
    let scene = edited("thrust", &[("load.duration", "\"0.2 ms\"")]);
    assert!(scratch.run(&scene, "run", &[]).status.success());
    refused(
        &[&scratch.path("run"), "--columns", "inner.fource.x"],
        &["--columns inner.fource.x", "no such column"],
    );
    refused(
        &[&scratch.path("run"), "--field", &scratch.path("run/means.csv")],
        &["means.csv is no table of roulement field"],
    );
    assert!(!Path::new(&scratch.path("x.html")).exists());
}
