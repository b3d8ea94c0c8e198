//! What a bearing alone has, a shaft with its bearings has too: measured errors, one record and page, effects, fields, tables of sweeps, costs.

use super::sweep::{columns, good, numbers};
use super::*;

/// The pinion that is shipped, for 2 ms, with a load that rises: something to be wrong about.
fn pinion() -> String {
    let text = std::fs::read_to_string(scene("shafts/pinion")).unwrap();
    let short = text
        .replace("\"20 ms\"", "\"2 ms\"")
        .replace("\"100 us\"", "\"20 us\"")
        .replace("1260.5]", "[[0, 1260], [\"0.5 ms\", 1260], [\"0.6 ms\", 1900]]]");
    assert!(short.contains("1900") && short.contains("\"2 ms\""));
    short
}

/// A scene in a file, run with options; what it prints and says.
fn run(scratch: &Scratch, text: &str, to: &str, options: &[&str]) -> (Option<i32>, String, String) {
    let file = scratch.path(&format!("{to}.toml"));
    std::fs::write(&file, text).unwrap();
    let output = roulement(&[&["run", &file, "-o", &scratch.path(to)], options].concat());
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn independent_reference_errors_of_a_shaft_and_its_bearings_are_below_their_bars() {
    let scratch = Scratch::new("shaft-error");
    let coarse = pinion() + "[solver]\naccuracy = \"fast\"\n";
    let (code, said, told) = run(&scratch, &coarse, "measured", &["--error", "2e-3", "--rounds", "9"]);
    assert_eq!(code, Some(0), "{said}{told}");
    assert!(said.contains("error goal       2e-3 of means and histories: met"), "{said}");
    assert!(said.contains("round 2") && !said.contains("not measured"), "{said}");
    // Seats, torque and losses have their bars.
    for (line, bars) in [("shaft            ", 2), ("left             shaft at", 3), ("mean losses", 2)] {
        let found =
            said.lines().find(|other| other.contains(line)).unwrap_or_else(|| panic!("{line}: {said}"));
        assert_eq!(found.matches("(+- ").count(), bars, "{found}");
    }
    // The same goal in the file.
    let goal = pinion() + "[solver]\naccuracy = { error = 2e-3 }\n";
    let (code, said, _) = run(&scratch, &goal, "goal", &["--rounds", "9"]);
    assert!(code == Some(0) && said.contains("error goal       2e-3"), "{said}");
    // Against steps that no round took.
    let fixed = pinion() + "[solver]\nmax_step = \"0.4 us\"\ninitial_step = \"0.4 us\"\ntolerance = 1e-2\n";
    assert_eq!(run(&scratch, &fixed, "exact", &[]).0, Some(0));
    let mut compared = 0;
    for part in ["", "left/", "right/"] {
        let table = |run: &str| columns(&scratch.read(&format!("{run}/{part}means.csv")));
        let (measured, exact) = (table("measured"), table("exact"));
        assert_eq!(measured["quantity"], exact["quantity"]);
        // Lives stand below the means, and have no bars.
        let count = measured["error"].iter().filter(|bar| !bar.is_empty()).count();
        let [means, bars, truth] =
            [&measured["mean"], &measured["error"], &exact["mean"]].map(|column| numbers(&column[..count]));
        // What is 0 but for the rounding of the others of its kind.
        let units = &measured["unit"];
        let rounding = |i: usize| {
            let alike = (0..truth.len()).filter(|&j| units[j] == units[i]).map(|j| truth[j].abs());
            1e-9 * alike.fold(0.0, f64::max)
        };
        for i in 0..means.len() {
            let off = (means[i] - truth[i]).abs();
            let name = &measured["quantity"][i];
            assert!(off <= bars[i] + rounding(i), "{part}{name}: {off:e}, bar {:e}", bars[i]);
            compared += 1;
        }
    }
    assert!(compared > 40, "{compared}");
    // A goal that is not met has the same exit code as that of a bearing.
    let (code, said, _) = run(&scratch, &coarse, "unmet", &["--error", "1e-6", "--rounds", "2"]);
    assert!(code == Some(3) && said.contains("NOT MET"), "{said}");
}

#[test]
fn consistency_a_shaft_has_one_record_and_one_page_with_its_bearings() {
    let scratch = Scratch::new("shaft-page");
    let (code, said, _) = run(&scratch, &pinion(), "out", &["--json"]);
    assert_eq!(code, Some(0));
    let said: Value = serde_json::from_str(&said).unwrap();
    let record: Value = serde_json::from_str(&scratch.read("out/run.json")).unwrap();
    assert_eq!(record["summary"], said["shaft"]);
    let torque = record["summary"]["figures"]["end shaft.torque"].as_f64().unwrap();
    let table = columns(&scratch.read("out/shaft.csv"));
    let last = *numbers(&table["shaft.torque [N m]"]).last().unwrap();
    assert!((torque / last - 1.0).abs() < 1e-14, "{torque} {last}");
    for name in ["left", "right"] {
        let own: Value = serde_json::from_str(&scratch.read(&format!("out/{name}/run.json"))).unwrap();
        assert_eq!(own["summary"], said[name]);
    }
    let page = scratch.path("page.html");
    good(&roulement(&["report", &scratch.path("out"), "-o", &page]));
    let page = std::fs::read_to_string(page).unwrap();
    let data = page.split_once("<script type=\"application/json\"").map(|(_, rest)| rest).unwrap_or(&page);
    for part in ["\"shaft.left.x\"", "\"name\":\"left\"", "\"name\":\"right\"", "left", "Pinion shaft"] {
        assert!(data.contains(part), "{part}");
    }
    // A page of a bearing of it by itself.
    good(&roulement(&["report", &scratch.path("out/left"), "-o", &scratch.path("left.html")]));
}

#[test]
fn consistency_effects_and_fields_are_of_the_bearing_that_is_meant() {
    let scratch = Scratch::new("shaft-effects");
    let file = scratch.path("shaft.toml");
    std::fs::write(&file, pinion()).unwrap();
    let said = good(&roulement(&["effects", &file]));
    let [left, right] = ["bearing left", "bearing right"].map(|title| said.find(title).unwrap());
    assert!(left < right && said.matches("off, and would matter").count() == 2, "{said}");
    let json: Value = serde_json::from_str(&good(&roulement(&["effects", &file, "--json"]))).unwrap();
    let subject = |name: &str| json[name]["estimates"].as_array().unwrap().len();
    assert!(subject("left") > 10 && subject("left") == subject("right"));
    // The load of a contact where the run ends, from the field and from the run.
    let per_ball = pinion().replace("[load]", "[bearing.set.effects]\nper_ball_outputs = true\n[load]");
    assert_eq!(run(&scratch, &per_ball, "out", &[]).0, Some(0));
    let field = scratch.path("field.csv");
    let command = ["field", &file, "--contacts", "2.outer", "--cells", "24", "-o", &field];
    let refused = roulement(&command);
    let why = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success() && why.contains("--bearing: say which one of left, right"), "{why}");
    good(&roulement(&[&command[..], &["--bearing", "right"]].concat()));
    let table = columns(&scratch.read("field.csv"));
    let [area, pressure] = ["area [m2]", "pressure [Pa]"].map(|name| numbers(&table[name]));
    let carried: f64 = area.iter().zip(&pressure).map(|(area, pressure)| area * pressure).sum();
    let loads = columns(&scratch.read("out/right/results.csv"));
    let load = *numbers(&loads["ball[2].outer.load [N]"]).last().unwrap();
    assert!((carried / load - 1.0).abs() < 0.01, "{carried} of {load} N");
}

#[test]
fn consistency_whole_tables_of_a_sweep_have_shaft_and_bearings() {
    let scratch = Scratch::new("shaft-tables");
    let (base, cases, to) = (scratch.path("shaft.toml"), scratch.path("cases.csv"), scratch.path("sweep"));
    std::fs::write(&base, pinion()).unwrap();
    std::fs::write(&cases, "shaft.mass\n2 kg\n3 kg\n").unwrap();
    good(&roulement(&["sweep", &cases, "--scene", &base, "-o", &to, "--tables", "csv"]));
    let summary = columns(&scratch.read("sweep/summary.csv"));
    let table = columns(&scratch.read(&format!("sweep/tables/{}.csv", summary["file"][1])));
    let heavier = pinion().replace("\"1.8 kg\"", "\"3 kg\"");
    assert_eq!(run(&scratch, &heavier, "out", &[]).0, Some(0));
    let shaft = columns(&scratch.read("out/shaft.csv"));
    assert_eq!(table["shaft.torque [N.m]"], shaft["shaft.torque [N m]"]);
    assert_eq!(table["left.seat.displacement.z [m]"], shaft["shaft.left.z [m]"]);
    let right = columns(&scratch.read("out/right/results.csv"));
    for name in ["inner.force.x [N]", "friction_power [W]"] {
        assert_eq!(table[&format!("right.{name}")], right[name]);
    }
}

/// A name chooses of one bearing with its own before it, of all of them without, and of the shaft as in its table.
#[test]
fn columns_of_a_machine_are_chosen_by_their_names_with_those_of_the_bearings() {
    let scratch = Scratch::new("shaft-columns");
    let of = |to: &str, columns: &str| {
        let (code, _, told) = run(&scratch, &pinion(), to, &["--columns", columns]);
        assert_eq!(code, Some(0), "{told}");
        ["left/results.csv", "right/results.csv", "shaft.csv"].map(|file| {
            let table = columns_in_order(&scratch.read(&format!("{to}/{file}")));
            table.into_iter().map(|name| name.split(" [").next().unwrap().to_string()).collect::<Vec<_>>()
        })
    };
    let [left, right, shaft] = of("one", "left.inner.force.*,*.friction_torque,shaft.torque");
    assert_eq!(left, ["time", "inner.force.x", "inner.force.y", "inner.force.z", "friction_torque"]);
    assert_eq!(right, ["time", "friction_torque"]);
    assert_eq!(shaft, ["time", "shaft.torque"]);
    let [left, right, shaft] = of("all", "inner.force.x");
    assert_eq!([left, right], [["time", "inner.force.x"]; 2]);
    assert!(shaft.len() > 10, "{shaft:?}");
    let (code, _, told) =
        run(&scratch, &pinion(), "none", &["--columns", "left.inner.force.x,middle.inner.force.x"]);
    assert_eq!(code, Some(1), "{told}");
    assert!(told.contains("--columns middle.inner.force.x") && told.contains("no such column"), "{told}");
    assert!(!told.contains("effects"), "nothing that takes time comes before: {told}");

    // A sweep has the same names, of the shaft too.
    let (base, cases, to) = (scratch.path("one.toml"), scratch.path("cases.csv"), scratch.path("sweep"));
    std::fs::write(&cases, "shaft.mass\n2 kg\n").unwrap();
    let chosen = "left.inner.force.x,shaft.torque,right.seat.displacement.*";
    good(&roulement(&["sweep", &cases, "--scene", &base, "-o", &to, "--tables", "csv", "--columns", chosen]));
    let summary = columns(&scratch.read("sweep/summary.csv"));
    assert!(summary.contains_key("left.inner.force.x.end [N]"), "{:?}", summary.keys());
    let table = columns_in_order(&scratch.read(&format!("sweep/tables/{}.csv", summary["file"][0])));
    let names: Vec<&str> = table.iter().map(|name| name.split(" [").next().unwrap()).collect();
    let seats = ["x", "y", "z"].map(|axis| format!("right.seat.displacement.{axis}"));
    let expected =
        [&["time", "shaft.torque"], &seats.each_ref().map(String::as_str)[..], &["left.inner.force.x"]]
            .concat();
    assert_eq!(names, expected);
}

/// Heads of a table's columns, as they stand.
fn columns_in_order(table: &str) -> Vec<String> {
    table.lines().next().unwrap().split(',').map(String::from).collect()
}

#[test]
fn regression_a_load_that_no_bearing_bears_is_warned_of_on_a_shaft_too() {
    let scratch = Scratch::new("shaft-overload");
    let heavy = pinion().replace("1500 N", "178 kN");
    let (code, said, told) = run(&scratch, &heavy, "out", &[]);
    assert_eq!(code, Some(0), "{told}");
    for name in ["left", "right"] {
        let warned = format!("warning: bearing {name}: the largest contact pressure is ");
        assert!(told.contains(&warned), "{told}");
        assert!(
            said.contains(&format!("WARNING          bearing {name}: the largest contact pressure is ")),
            "{said}"
        );
    }
    // The page shows those of the record.
    let record: Value = serde_json::from_str(&scratch.read("out/run.json")).unwrap();
    let warnings = record["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), said.matches("WARNING          ").count());
    assert!(warnings.iter().all(|warning| said.contains(warning.as_str().unwrap())), "{warnings:?}");
    let (_, said, told) = run(&scratch, &pinion(), "out", &[]);
    assert!(!said.contains("WARNING") && !told.contains("warning"), "{said}{told}");
}

#[test]
fn what_accuracy_costs_on_a_shaft_is_measured() {
    let scratch = Scratch::new("shaft-cost");
    let file = scratch.path("shaft.toml");
    std::fs::write(&file, pinion().replace("\"2 ms\"", "\"1 ms\"")).unwrap();
    let to = scratch.path("cost");
    let only = "default,step-cap,creep-law,communication-held,communication-ahead";
    let said = good(&roulement(&["cost", &file, "-o", &to, "--only", only]));
    assert!(said.contains("For 1 % of the mean power take "), "{said}");
    let table = std::fs::read_dir(&to).unwrap().map(|file| file.unwrap().path());
    let table =
        table.into_iter().find(|path| path.extension().is_some_and(|ending| ending == "csv")).unwrap();
    let table = columns(&std::fs::read_to_string(table).unwrap());
    let levers = &table["lever"];
    assert!(
        levers.iter().any(|lever| lever == "step cap") && levers.iter().any(|lever| lever == "creep law")
    );
    // What the default costs, once for the whole machine.
    let at = levers.iter().position(|lever| lever == "default").unwrap();
    let regret = numbers(&table["cost over the cheapest that keeps it [-]"][at..=at])[0];
    assert!(numbers(&table["error over the promise [-]"][at..=at])[0] <= 1.0);
    let sentence =
        format!("shaft: default steps: {regret:.2} times the cost of the cheapest tolerance that keeps ");
    assert_eq!(said.matches("shaft: default steps: ").count(), 1);
    assert!(said.contains(&sentence), "{said}");
    // An importer that knows the load at the end of a step is nearer than one that knows it at the start.
    let (shown, errors) = (&table["setting"], &table["worst [-]"]);
    let of = |lever: &str| {
        let found = (0..levers.len()).find(|&i| levers[i] == lever && shown[i] == "20 us");
        errors[found.unwrap_or_else(|| panic!("{lever}: {levers:?} {shown:?}"))].parse::<f64>().unwrap()
    };
    let [held, ahead] = [of("communication (held)"), of("communication (ahead)")];
    assert!(ahead < 0.3 * held && held > 1e-4, "{held} {ahead}");
}

/// Two shafts with 20 and 40 teeth of 2 mm in mesh, the second one braked by 30 N m.
pub fn meshed() -> String {
    let shaft = |name: &str, origin: &str, drive: &str| {
        let bearing = |side: &str, at: &str, way: &str| {
            format!(
                "[[bearing]]\nname = \"{name}-{side}\"\nshaft = \"{name}\"\ncatalogue = \"6205\"\n\
                 mounting = {{ position = \"{at}\", direction = \"{way}\", preload = {{ force = \"200 N\" }} }}\n"
            )
        };
        format!(
            "[[shaft]]\nname = \"{name}\"\norigin = {origin}\nmass = 2\npolar_inertia = 1e-3\ntransverse_inertia = 3e-3\n{drive}\n"
        ) + &bearing("left", "-40 mm", "+x")
            + &bearing("right", "40 mm", "-x")
    };
    shaft("one", "[0, 0, 0]", "speed = \"300 rpm\"")
        + &shaft("two", "[0, 0, \"60 mm\"]", "torque = 30")
        + "[[mesh]]\nname = \"gears\"\nnormal_module = \"2 mm\"\ndamping_ratio = 0.1\n\
           gears = [{ shaft = \"one\", position = \"-5 mm\", teeth = 20, face_width = \"20 mm\" }, \
           { shaft = \"two\", position = 0, teeth = 40, face_width = \"24 mm\" }]\n\
           [load]\nduration = \"2 ms\"\noutput_interval = \"20 us\"\n"
}

/// Forces of a mesh are in the table, among the means and on the page, and its gears where they are.
#[test]
fn closed_form_a_mesh_has_its_forces_and_its_place_in_what_a_run_leaves() {
    let scratch = Scratch::new("shaft-mesh");
    let (code, said, told) = run(&scratch, &meshed(), "out", &["--error"]);
    assert_eq!(code, Some(0), "{said}{told}");
    // Torque over the pitch radius of 40 mm.
    let tangential = 30.0 / 0.04;
    let table = columns(&scratch.read("out/shaft.csv"));
    let [y, normal] = ["gears.force.y [N]", "gears.normal_force [N]"].map(|name| numbers(&table[name]));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    assert!((mean(&y).abs() / tangential - 1.0).abs() < 0.02, "{}", mean(&y));
    assert!((mean(&normal) * 20f64.to_radians().cos() / tangential - 1.0).abs() < 0.02, "{}", mean(&normal));
    let means = columns(&scratch.read("out/means.csv"));
    let at = means["quantity"].iter().position(|name| name == "gears.normal_force").unwrap();
    let [value, bar] = ["mean", "error"].map(|column| means[column][at].parse::<f64>().unwrap());
    assert!(
        (value * 20f64.to_radians().cos() / tangential - 1.0).abs() < 0.02 && bar < 0.02 * value,
        "{value} {bar}"
    );
    let record: Value = serde_json::from_str(&scratch.read("out/run.json")).unwrap();
    let gears = [0, 1].map(|shaft| &record["shaft"]["shafts"][shaft]["gears"][0]);
    for (gear, [radius, turned, teeth, position, width]) in
        gears.into_iter().zip([[0.02, 0.5, 20.0, -0.005, 0.02], [0.04, -0.5, 40.0, 0.0, 0.024]])
    {
        let of = |key: &str| gear[key].as_f64().unwrap();
        // The second axis is at +z of the first.
        let azimuth = turned * std::f64::consts::PI;
        let expected = [
            ("pitch_radius", radius),
            ("azimuth", azimuth),
            ("teeth", teeth),
            ("position", position),
            ("face_width", width),
        ];
        for (key, value) in expected {
            assert!((of(key) - value).abs() < 1e-9, "{key}: {gear}");
        }
        assert_eq!(gear["mesh"], "gears");
    }
    assert_eq!(record["shaft"]["meshes"], serde_json::json!(["gears"]));
}

/// A ring around its pinion: the page drew it with a radius below 0, which is none.
#[test]
fn regression_a_ring_has_a_radius_on_the_page() {
    let scratch = Scratch::new("shaft-ring");
    let text = meshed()
        .replace("\"60 mm\"]", "\"40 mm\"]")
        .replace("teeth = 40", "teeth = 60, inside = true")
        .replace("\"2 ms\"", "\"0.1 ms\"");
    let (code, said, told) = run(&scratch, &text, "out", &[]);
    assert_eq!(code, Some(0), "{said}{told}");
    let record: Value = serde_json::from_str(&scratch.read("out/run.json")).unwrap();
    // Both touch at -z of their axes.
    for (shaft, radius) in [(0, 0.02), (1, 0.06)] {
        let gear = &record["shaft"]["shafts"][shaft]["gears"][0];
        let [found, azimuth] = ["pitch_radius", "azimuth"].map(|key| gear[key].as_f64().unwrap());
        assert!((found - radius).abs() < 1e-9, "{gear}");
        assert!((azimuth + 0.5 * std::f64::consts::PI).abs() < 1e-9, "{gear}");
    }
}
