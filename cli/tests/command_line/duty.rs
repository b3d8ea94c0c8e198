//! The `[[duty]]` of a scene wherever it is told: equilibria, runs, sweeps and records have one sum.

use serde_json::Value;

use super::*;

/// Three loads of the 6206 of [`rating`]; the last one changes oil and temperature as well.
const LOADS: &str = r#"
[[duty]]
name = "climb"
hours = 300
set = { load = { inner_speed = "600 rpm", y = { force = "6 kN" } } }
[[duty]]
name = "cruise"
hours = 4000
set = { "load.inner_speed" = "1500 rpm" }
[[duty]]
name = "warm"
hours = 700
set = { load = { inner_speed = "3000 rpm", y = { force = "2 kN" } }, rating = { viscosity = "8 mm^2/s" } }
"#;

/// It with them.
fn scene_of_three() -> String {
    format!("{}{LOADS}", rating::SCENE)
}

fn json(arguments: &[&str]) -> Value {
    let output = roulement(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn near(ours: f64, theirs: f64, tolerance: f64) {
    assert!((ours / theirs - 1.0).abs() < tolerance, "{ours} {theirs}");
}

#[test]
fn closed_form_equilibria_runs_and_sweeps_have_the_hand_sum_of_a_duty() {
    let scratch = Scratch::new("duty");
    std::fs::write(scratch.path("scene.toml"), scene_of_three()).unwrap();
    let found = json(&["equilibrium", &scratch.path("scene.toml"), "--json"]);
    let duty = &found["duty"];
    // By hand: hours over the life of an equilibrium under each load alone, that of its oil.
    let alone = [
        ("600 rpm", "6 kN", "15", 300.0),
        ("1500 rpm", "1 kN", "15", 4000.0),
        ("3000 rpm", "2 kN", "8", 700.0),
    ];
    let mut damage = [0.0; 2];
    let mut cubes = 0.0;
    for (place, (speed, force, viscosity, hours)) in alone.iter().enumerate() {
        let text = rating::SCENE
            .replace("\"1000 rpm\"", &format!("\"{speed}\""))
            .replace("force = 1000", &format!("force = \"{force}\""))
            .replace("\"15 mm^2/s\"", &format!("\"{viscosity} mm^2/s\""));
        std::fs::write(scratch.path("one.toml"), text).unwrap();
        let one = json(&["equilibrium", &scratch.path("one.toml"), "--gyroscopic", "friction", "--json"]);
        assert!(one.get("duty").is_none());
        let rpm: f64 = speed.strip_suffix(" rpm").unwrap().parse().unwrap();
        let life = |name: &str| one["life"][name].as_f64().unwrap() * 1e6 / (60.0 * rpm);
        for (sum, name) in damage.iter_mut().zip(["L10r", "modified"]) {
            *sum += hours / life(name);
        }
        let own = &duty["loads"][place]["bearings"][""];
        // The states of a run have their balls balanced in spin: loads agree to 1e-3, lives are their cube.
        near(own["L10r_hours"].as_f64().unwrap(), life("L10r"), 3e-3);
        near(own["modified_hours"].as_f64().unwrap(), life("modified"), 6e-3);
        let load = one["life"]["equivalent_load"].as_f64().unwrap();
        cubes += hours * rpm * load.powi(3);
    }
    let all = &duty["bearings"][""];
    let get = |name: &str| all[name].as_f64().unwrap();
    assert_eq!(duty["hours"], 5000.0);
    near(get("L10r_hours"), 5000.0 / damage[0], 3e-3);
    near(get("modified_hours"), 5000.0 / damage[1], 6e-3);
    near(get("damage"), damage[1], 6e-3);
    let revolutions = 300.0 * 600.0 + 4000.0 * 1500.0 + 700.0 * 3000.0;
    near(get("equivalent_load"), (cubes / revolutions).cbrt(), 1e-3);
    // Static safety is that of the largest load, heat is that of each load by its time.
    let of_loads =
        |name: &str| [0, 1, 2].map(|i: usize| duty["loads"][i]["bearings"][""][name].as_f64().unwrap());
    assert_eq!(get("static_safety"), of_loads("static_safety")[0]);
    let [a, b, c] = of_loads("loss");
    near(get("loss"), (300.0 * a + 4000.0 * b + 700.0 * c) / 5000.0, 1e-12);
    let used = of_loads("damage");
    let most = used.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert_eq!(all["worst"]["load"], ["climb", "cruise", "warm"][most.0]);
    near(all["worst"]["taken"].as_f64().unwrap(), most.1 / used.iter().sum::<f64>(), 1e-12);

    // The same numbers to the bit: in words of the equilibrium, in the summary and record of a run, in the table of a sweep.
    let run = json(&["run", &scratch.path("scene.toml"), "-o", &scratch.path("results"), "--json"]);
    assert_eq!(&run["duty"], duty);
    let record: Value = serde_json::from_str(&scratch.read("results/run.json")).unwrap();
    assert_eq!(&record["duty"], duty);
    let words = roulement(&["equilibrium", &scratch.path("scene.toml")]);
    let words = String::from_utf8(words.stdout).unwrap();
    assert!(words.contains("duty             3 loads in balance over 5000 h"), "{words}");
    let line = words.lines().find(|line| line.contains(" takes ")).unwrap_or_else(|| panic!("{words}"));
    assert!(scratch.read("results/summary.txt").contains(line), "{line}");
    std::fs::write(scratch.path("cases.csv"), "rating.contamination\n0.6\n0.3\n").unwrap();
    let cases = scratch.path("cases.csv");
    let output =
        roulement(&["sweep", &cases, "--scene", &scratch.path("scene.toml"), "-o", &scratch.path("sweep")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary = scratch.read("sweep/summary.csv");
    let mut rows = csv::Reader::from_reader(summary.as_bytes());
    let heads = rows.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    let cell = |row: usize, name: &str| {
        rows[row][heads.iter().position(|head| head == name).unwrap_or_else(|| panic!("{name}: {heads:?}"))]
            .to_owned()
    };
    for (column, name) in [
        ("duty.L10r.hours [h]", "L10r_hours"),
        ("duty.modified.hours [h]", "modified_hours"),
        ("duty.equivalent_load [N]", "equivalent_load"),
        ("duty.static_safety [1]", "static_safety"),
        ("duty.loss [W]", "loss"),
        ("duty.damage [1]", "damage"),
    ] {
        // JSON is read here to 15 digits.
        near(cell(0, column).parse().unwrap(), get(name), 1e-14);
    }
    assert_eq!(cell(0, "duty.worst_load"), all["worst"]["load"].as_str().unwrap());
    // Dirt takes life.
    let damage = [0, 1].map(|row| cell(row, "duty.damage [1]").parse::<f64>().unwrap());
    assert!(damage[1] > 1.2 * damage[0], "{damage:?}");
}

#[test]
fn loads_of_a_duty_that_cannot_be_read_are_named_before_anything_is_run() {
    let scratch = Scratch::new("duty-refused");
    std::fs::write(
        scratch.path("scene.toml"),
        scene_of_three().replace("rating = { viscosity", "rating = { viscocity"),
    )
    .unwrap();
    for command in [&["equilibrium"][..], &["run", "-o", &scratch.path("results")]] {
        let scene = scratch.path("scene.toml");
        let output = roulement(&[&[command[0], scene.as_str()], &command[1..]].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            !output.status.success() && message.contains("duty warm") && message.contains("viscocity"),
            "{message}"
        );
    }
    assert!(!std::path::Path::new(&scratch.path("results")).exists());
}

#[test]
fn closed_form_a_duty_that_is_run_has_the_means_and_lives_of_its_runs() {
    let scratch = Scratch::new("duty-runs");
    let scene = rating::SCENE
        .replace("duration = \"1 ms\"", "duration = \"40 ms\"")
        .replace("output_interval = \"1 ms\"", "output_interval = \"0.2 ms\"");
    std::fs::write(scratch.path("scene.toml"), format!("{scene}{LOADS}")).unwrap();
    let output = roulement(&["rating", &scratch.path("scene.toml"), "--runs"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8(output.stdout).unwrap();
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let heads = rows.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
    let cell = |row: usize, name: &str| -> f64 {
        rows[row][heads.iter().position(|head| head == name).unwrap()].parse().unwrap()
    };
    let text = scene.replace("\"1000 rpm\"", "\"1500 rpm\"");
    std::fs::write(scratch.path("one.toml"), text).unwrap();
    let one = json(&["run", &scratch.path("one.toml"), "-o", &scratch.path("one"), "--json"]);
    let mean = |name: &str| {
        let all = one["means"]["quantities"].as_array().unwrap_or_else(|| panic!("{}", one["means"]));
        all.iter().find(|mean| mean["quantity"] == name).unwrap()["mean"].as_f64().unwrap()
    };
    // JSON is read here to 15 digits.
    near(cell(1, "friction_torque [N m]"), mean("friction torque").abs(), 1e-12);
    near(cell(1, "loss [W]"), mean("loss.total"), 1e-12);
    near(cell(1, "L10r [1e6]"), one["life"]["L10r"].as_f64().unwrap(), 1e-12);
    let damage: f64 = (0..3).map(|row| cell(row, "damage")).sum();
    near(cell(3, "damage"), damage, 1e-9);
    // What turns a bearing brings its losses, in runs and in statics.
    let statics = roulement(&["rating", &scratch.path("scene.toml")]);
    let statics = String::from_utf8(statics.stdout).unwrap();
    let row = statics.lines().find(|line| line.starts_with("cruise")).unwrap();
    let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    near(numbers[10] * numbers[3] * std::f64::consts::PI / 30.0, numbers[11], 1e-12);
    near(numbers[10], cell(1, "friction_torque [N m]"), 0.05);
}
