//! Columns of accelerations: by Newton's second law from the columns of forces, of a bearing alone and on a shaft, in CSV and as one table.

use std::collections::BTreeMap;

use super::sweep::columns;
use super::*;

/// Columns of a table by their names without units, as numbers.
fn table(text: &str) -> BTreeMap<String, Vec<f64>> {
    let of = |(name, cells): (String, Vec<String>)| {
        let name = name.split(" [").next().unwrap().to_string();
        (name, cells.iter().map(|cell| cell.parse().unwrap()).collect())
    };
    columns(text).into_iter().map(of).collect()
}

/// A scene of the project with other values of keys of its section `[load]`.
fn with(name: &str, duration: &str, output_interval: &str) -> String {
    let text = std::fs::read_to_string(scene(name)).unwrap();
    let line = |line: &str| match line.split_once(" = ") {
        Some(("duration", _)) => format!("duration = \"{duration}\"\n"),
        Some(("output_interval", _)) => format!("output_interval = \"{output_interval}\"\n"),
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// Runs a scene, and gives a table of its results.
fn run(scratch: &Scratch, text: &str, options: &[&str], file: &str) -> String {
    let path = scratch.path("scene.toml");
    std::fs::write(&path, text).unwrap();
    let output = roulement(&[&["run", &path, "-o", &scratch.path("out")], options].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    scratch.read(&format!("out/{file}"))
}

#[test]
fn independent_acceleration_of_a_race_is_that_of_its_forces_over_its_mass() {
    let scratch = Scratch::new("acceleration");
    let text = with("effects/spall", "4 ms", "1 us");
    let rows = table(&run(&scratch, &text, &["--columns", "*,*.acceleration.*"], "results.csv"));
    let (time, own) = (&rows["time"], &rows["inner.acceleration.y"]);
    let force = |i: usize| rows["inner.force.y"][i] + rows["inner.applied_force.y"][i];
    // None comes before the first row.
    assert_eq!(own[0], 0.0);
    let (mut velocity, mut by_newton, mut off, mut size) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    for i in 1..time.len() {
        // Both over time, as blows are shorter than the microsecond between two rows; of 0.2 kg.
        velocity += own[i] * (time[i] - time[i - 1]);
        by_newton += 0.5 * (force(i) + force(i - 1)) / 0.2 * (time[i] - time[i - 1]);
        off = off.max((velocity - by_newton).abs());
        size = size.max(velocity.abs());
    }
    let blow = own.iter().fold(0.0f64, |most, of| most.max(of.abs()));
    // Forces are summed by trapezoids between rows, and the velocity keeps what a step's tolerance leaves: 2e-3 holds both.
    assert!(blow > 500.0 && off < 2e-3 * size, "{blow} m/s2; {off} of {size} m/s");
    // The rows of a window are those of the whole run, its first one, too.
    let part =
        run(&scratch, &text, &["--window", "2 ms:3 ms", "--columns", "inner.acceleration.y"], "results.csv");
    assert!(part.starts_with("time [s],inner.acceleration.y [m/s2]\n"), "{part}");
    let part = table(&part);
    assert_eq!(part["inner.acceleration.y"], own[2000..=3000]);
}

#[test]
fn independent_acceleration_of_a_shaft_and_of_its_housing_is_that_of_their_places() {
    let scratch = Scratch::new("acceleration-shaft");
    let text = with("shafts/housing", "2 ms", "2 us");
    let plain = run(&scratch, &text, &[], "shaft.csv");
    // They go by the distance of rows, which no other column does: who wants them names them.
    assert!(plain.contains("case.top.velocity.z [m/s]") && !plain.contains("acceleration"));
    let rows = table(&run(&scratch, &text, &["--columns", "*,*.acceleration.*"], "shaft.csv"));
    let step = 2e-6;
    for place in ["shaft.mesh", "shaft.left", "case.top", "case.left"] {
        for axis in ["y", "z"] {
            let (own, at) =
                (&rows[&format!("{place}.acceleration.{axis}")], &rows[&format!("{place}.{axis}")]);
            // Over two rows on either side; what differs within them is what a sensor of that rate cannot tell.
            let by_places: Vec<f64> = (4..at.len() - 4)
                .map(|i| (at[i + 4] - 2.0 * at[i] + at[i - 4]) / (16.0 * step * step))
                .collect();
            let smooth: Vec<f64> = (4..at.len() - 4)
                .map(|i| {
                    (-3..=4)
                        .map(|k| own[(i as i32 + k) as usize] * (4.0 - (f64::from(k) - 0.5).abs()) / 16.0)
                        .sum()
                })
                .collect();
            let size = by_places.iter().fold(0.0f64, |most, of| most.max(of.abs()));
            let off = by_places.iter().zip(&smooth).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
            // Places and velocities are read from two polynomials of a step, whose second derivatives differ by a per cent or two.
            assert!(size > 0.1 && off < 0.02 * size, "{place} {axis}: {off} of {size} m/s2");
        }
    }
    // As one table, whose columns have the names of packages, of the shaft and of its bearings.
    let whole = scratch.path("whole.parquet");
    let path = scratch.path("scene.toml");
    let output =
        roulement(&["run", &path, "-o", &whole, "--columns", "top.acceleration.*,mesh.acceleration.z"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let refused = roulement(&["run", &path, "-o", &whole, "--columns", "bottom.acceleration.*"]);
    let why = String::from_utf8(refused.stderr).unwrap();
    assert!(!refused.status.success() && why.contains("bottom.acceleration.*"), "{why}");
}

#[test]
fn regression_a_sweep_has_accelerations_of_its_cases() {
    let scratch = Scratch::new("acceleration-sweep");
    std::fs::write(scratch.path("cases.csv"), "load.duration [ms]\n1\n2\n").unwrap();
    let sweep =
        ["sweep", &scratch.path("cases.csv"), "--scene", &scene("effects/spall"), "-o", &scratch.path("out")];
    let output = roulement(&[&sweep[..], &["--columns", "inner.acceleration.y"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = columns(&scratch.read("out/summary.csv"));
    let largest =
        table.iter().find(|(name, _)| name.starts_with("inner.acceleration.y") && name.contains(".largest"));
    let (name, cells) = largest.unwrap_or_else(|| panic!("{:?}", table.keys()));
    assert!(name.ends_with("[m/s2]"), "{name}");
    assert!(cells.iter().all(|cell| cell.parse::<f64>().unwrap() > 0.0), "{cells:?}");
}
