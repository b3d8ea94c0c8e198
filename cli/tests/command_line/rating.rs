//! `roulement rating`: lives of given loads.

use super::*;

/// A 6206 with the ratings of its scene; outer race control has no part in slow bearings.
const SCENE: &str = r#"
[bearing]
balls = 9
ball_diameter = "9.525 mm"
pitch_diameter = "46 mm"
diametral_clearance = "10 um"
[rating]
dynamic_load_rating = "20 kN"
viscosity = "15 mm^2/s"
contamination = 0.6
[load]
inner_speed = "1000 rpm"
y = { force = 1000 }
duration = "1 ms"
output_interval = "1 ms"
"#;

const LOADS: &str = "share,load.inner_speed [rpm],load.y.force [N],load.x.force\n\
                     0.5,600,1000,0\n\
                     0.3,1500,3000,500\n\
                     0.2,300,6000,\n";

fn table(text: &str) -> Vec<Vec<f64>> {
    text.lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect()
}

/// Lives, speed and equivalent load of each row by the equilibrium alone.
fn alone(scratch: &Scratch, speed: &str, y: &str, x: &str) -> serde_json::Value {
    let scene = SCENE
        .replace("\"1000 rpm\"", &format!("\"{speed} rpm\""))
        .replace("y = { force = 1000 }", &format!("y = {{ force = {y} }}\nx = {{ force = {x} }}"));
    std::fs::write(scratch.path("one.toml"), scene).unwrap();
    let output = roulement(&["equilibrium", &scratch.path("one.toml"), "--gyroscopic", "friction", "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()["life"].clone()
}

#[test]
fn closed_form_loads_add_up_by_the_revolutions_that_they_take() {
    let scratch = Scratch::new("rating");
    std::fs::write(scratch.path("scene.toml"), SCENE).unwrap();
    std::fs::write(scratch.path("loads.csv"), LOADS).unwrap();
    let output = roulement(&["rating", &scratch.path("scene.toml"), "--loads", &scratch.path("loads.csv")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let rows = table(&text);
    assert_eq!(rows.len(), 4, "{text}");
    let near = |ours: f64, theirs: f64, tolerance: f64| {
        assert!((ours / theirs - 1.0).abs() < tolerance, "{ours} {theirs}\n{text}");
    };
    // Each row is the life of an equilibrium.
    for (row, [speed, y, x]) in
        rows.iter().zip([["600", "1000", "0"], ["1500", "3000", "500"], ["300", "6000", "0"]])
    {
        let life = alone(&scratch, speed, y, x);
        let get = |name: &str| life[name].as_f64().unwrap();
        // The states of a run have their balls balanced in spin: loads agree to 1e-3, lives are their cube.
        near(row[4], get("equivalent_load"), 1e-3);
        near(row[5], get("L10r"), 3e-3);
        near(row[7], get("modified"), 6e-3);
        near(row[6], row[5] * 1e6 / (60.0 * speed.parse::<f64>().unwrap()), 1e-12);
    }
    // By hand: 300, 450 and 60 revolutions in a minute.
    let revolutions = [300.0, 450.0, 60.0];
    for column in [5, 7] {
        let used: f64 = rows.iter().zip(revolutions).map(|(row, n)| n / row[column]).sum();
        near(rows[3][column], 810.0 / used, 1e-12);
        near(rows[3][column + 1], rows[3][column] * 1e6 / (60.0 * 810.0), 1e-12);
    }
    near(rows[3][3], 810.0, 1e-12);
    // A cube of the load over revolutions, as of one load.
    let cubes: f64 = rows.iter().zip(revolutions).map(|(row, n)| n / 810.0 * row[4].powi(3)).sum();
    near(rows[3][4], cubes.cbrt(), 1e-12);
    near(rows[3][4], 20e3 / rows[3][5].cbrt(), 1e-12);
    // The largest load is that of the third row.
    near(rows[3][9], rows[2][9], 1e-15);
}

#[test]
fn tables_of_loads_that_are_wrong_are_refused_by_row_and_column() {
    let scratch = Scratch::new("rating-refused");
    std::fs::write(
        scratch.path("scene.toml"),
        SCENE.replace("[rating]", "[effects]\nstiffness_outputs = false\n[rating]"),
    )
    .unwrap();
    for (loads, parts) in [
        ("load.y.force\n1000\n", &["`share`"][..]),
        ("share,load.y.force\n0,1000\n", &["load 1", "share = 0", "above 0"]),
        ("share,load.y.force\n1,1000\n,2000\n", &["load 2", "share", "above 0"]),
        ("share,load.y.farce\n1,1000\n", &["load 1", "farce"]),
        ("share,load.y.force\n1,1000 kg\n", &["load 1", "kg"]),
        ("share\n", &["no case"]),
    ] {
        std::fs::write(scratch.path("loads.csv"), loads).unwrap();
        let output =
            roulement(&["rating", &scratch.path("scene.toml"), "--loads", &scratch.path("loads.csv")]);
        let message = String::from_utf8_lossy(&output.stderr).to_string();
        assert!(!output.status.success(), "{loads}");
        for part in parts {
            assert!(message.contains(part), "{message}\nshould have {part}");
        }
    }
    // Shares in per cent are shares too, and that is told.
    std::fs::write(scratch.path("loads.csv"), "share,load.y.force\n60,1000\n40,2000\n").unwrap();
    let output = roulement(&["rating", &scratch.path("scene.toml"), "--loads", &scratch.path("loads.csv")]);
    let rows = table(&String::from_utf8(output.stdout).unwrap());
    assert_eq!((rows[0][2], rows[1][2], rows[2][2]), (0.6, 0.4, 1.0));
    assert!(String::from_utf8_lossy(&output.stderr).contains("shares come to 100"));
}

#[test]
fn a_shaft_has_a_life_of_each_bearing() {
    let scratch = Scratch::new("rating-shaft");
    std::fs::write(scratch.path("loads.csv"), "share,shaft.speed [rpm]\n0.5,1000\n0.5,2000\n").unwrap();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/shafts/pinion.toml");
    let output = roulement(&["rating", scene, "--loads", &scratch.path("loads.csv")]);
    let text = String::from_utf8_lossy(&output.stdout).to_string();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let all: Vec<&str> = text.lines().filter(|line| line.starts_with("all,")).collect();
    assert_eq!(all.len(), 2, "{text}");
    assert_eq!(text.lines().count(), 7, "{text}");
    let mean =
        |line: &&str| (line.split(',').nth(3).unwrap().parse::<f64>().unwrap() / 1500.0 - 1.0).abs() < 1e-12;
    assert!(all.iter().all(mean), "{text}");
}
