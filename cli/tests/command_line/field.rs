//! `roulement field`: where contacts of a run stick and slip.

use super::*;

/// Numbers of a table by column.
fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let at =
        lines.next().unwrap().split(',').position(|other| other == name).unwrap_or_else(|| panic!("{name}"));
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

#[test]
fn invariant_a_field_carries_the_load_of_its_contact_within_the_friction_limit() {
    let scratch = Scratch::new("field");
    let scene = edited("thrust", &[("load.duration", "\"0.3 ms\""), ("effects.per_ball_outputs", "true")]);
    let run = scratch.run(&scene, "run", &["--columns", "ball*.load"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let loads = column(&scratch.read("run/results.csv"), "ball[2].outer.load [N]");

    let output = roulement(&[
        "field",
        &scratch.path("scene.toml"),
        "--contacts",
        "2.outer",
        "--cells",
        "24",
        "-o",
        &scratch.path("field.csv"),
    ]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("0.300000 ms, ball 2 on the outer race: ") && said.contains(" % sticks"), "{said}");

    let text = scratch.read("field.csv");
    let of = |name: &str| column(&text, name);
    let (area, pressure) = (of("area [m2]"), of("pressure [Pa]"));
    let carried: f64 = area.iter().zip(&pressure).map(|(area, pressure)| area * pressure).sum();
    let load = loads.last().unwrap();
    assert!((carried / load - 1.0).abs() < 0.01, "{carried} of {load} N");
    let (sticks, along, across) = (of("sticks [1]"), of("traction.x [Pa]"), of("traction.y [Pa]"));
    let slip: Vec<f64> = of("slip.x [m/s]").iter().zip(of("slip.y [m/s]")).map(|(x, y)| x.hypot(y)).collect();
    for i in 0..area.len() {
        let (traction, limit) = (along[i].hypot(across[i]), 0.08 * pressure[i]);
        // Cells that slip are at the limit, to the solver's tolerance, the others within it.
        assert!(traction <= limit * (1.0 + 1e-5), "{traction} {limit}");
        assert!(sticks[i] == 1.0 || traction > limit * (1.0 - 1e-5), "{traction} {limit}");
    }
    let mean = |wanted: f64| {
        let of = || (0..area.len()).filter(|&i| sticks[i] == wanted);
        of().map(|i| slip[i]).sum::<f64>() / of().count().max(1) as f64
    };
    assert!(mean(0.0) > 0.0 && mean(1.0) < 1e-3 * mean(0.0), "{} {}", mean(0.0), mean(1.0));
}

#[test]
fn what_is_no_contact_of_the_bearing_is_refused() {
    for (contact, part) in
        [("11.inner", "ball 11 is not there: allowed is [1, 10]"), ("3.middle", "3.middle is no contact")]
    {
        let output = roulement(&["field", &scene("thrust"), "--contacts", contact]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(part), "{said}");
    }
}

#[test]
fn independent_data_fields_of_a_table_sum_up_to_the_forces_of_boundary_elements() {
    let scratch = Scratch::new("fields");
    let data = include_str!("../../../tests/data/contact/random.csv");
    let head = data.lines().next().unwrap();
    // One that rolls along an axis, and one that rolls obliquely.
    let oblique = column(data, "rolling_angle").iter().position(|angle| *angle != 0.0).unwrap() + 1;
    let rows: Vec<&str> = [2, oblique].iter().map(|line| data.lines().nth(*line).unwrap()).collect();
    std::fs::write(scratch.path("cases.csv"), format!("{head}\n{}\n{}\n", rows[0], rows[1])).unwrap();
    let folder = scratch.path("fields");
    let output = roulement(&["contact", &scratch.path("cases.csv"), "--field", &folder, "--cells", "64"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let printed = String::from_utf8(output.stdout).unwrap();
    let cases = scratch.read("cases.csv");
    let of_case = |name: &str, k: usize| column(&cases, name)[k];
    let table = scratch.read("fields/field.csv");
    assert!(
        table.starts_with(
            "id,x [m],y [m],area [m2],pressure [Pa],traction.x [Pa],traction.y [Pa],slip.x [1],"
        )
    );
    for (k, row) in rows.iter().enumerate() {
        let id = row.split(',').next().unwrap();
        let cells: Vec<&str> = table.lines().skip(1).filter(|line| line.starts_with(id)).collect();
        let text = format!("{}\n{}", table.lines().next().unwrap(), cells.join("\n"));
        // The ids are no numbers.
        let text: String =
            text.lines().map(|line| format!("{}\n", line.split_once(',').unwrap().1)).collect();
        let (area, x, y) =
            (column(&text, "area [m2]"), column(&text, "traction.x [Pa]"), column(&text, "traction.y [Pa]"));
        let load = 2.0 / 3.0
            * std::f64::consts::PI
            * of_case("semi_axis_x", k)
            * of_case("semi_axis_y", k)
            * of_case("peak_pressure", k);
        let limit = of_case("friction", k) * load;
        let sum = |traction: &[f64]| area.iter().zip(traction).map(|(a, t)| a * t).sum::<f64>() / limit;
        for (name, traction) in [("fx", &x), ("fy", &y)] {
            let wanted = of_case(name, k);
            assert!((sum(traction) - wanted).abs() < 0.01, "{id} {name}: {} {wanted}", sum(traction));
            let line = printed.lines().nth(k + 1).unwrap().split_once(',').unwrap().1;
            let head = printed.lines().next().unwrap().split_once(',').unwrap().1;
            let said = column(&format!("{head}\n{line}\n"), name)[0];
            // The cells at the edge have a part of the load that is known to a half of a percent.
            assert!((said - sum(traction)).abs() < 5e-3, "{id} {name}: {said} {}", sum(traction));
        }
    }
    assert_eq!(scratch.read("fields/field.svg").matches("traction over its bound").count(), 2);
}

#[cfg(unix)]
#[test]
fn an_interrupted_field_keeps_the_times_that_were_reached() {
    let scratch = Scratch::new("field-interrupted");
    let text = edited("thrust", &[("load.duration", "\"1000 s\"")]).source;
    std::fs::write(scratch.path("long.toml"), text).unwrap();
    for name in ["-INT", "-TERM"] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_roulement"))
            .args(["field", &scratch.path("long.toml"), "--contacts", "1.inner", "--times", "0.1 ms,900 s"])
            .args(["--cells", "8", "-o", &scratch.path("field.csv")])
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        // It says when it has the first time.
        let mut said = std::io::BufReader::new(child.stderr.take().unwrap());
        let mut line = String::new();
        while !line.contains("0.100000 ms, ball 1") {
            line.clear();
            assert!(std::io::BufRead::read_line(&mut said, &mut line).unwrap() > 0, "it ended");
        }
        assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        line.clear();
        std::io::BufRead::read_line(&mut said, &mut line).unwrap();
        assert!(line.starts_with("interrupted at "), "{line}");
        let times = column(&scratch.read("field.csv"), "time [s]");
        assert!(times.len() > 16 && times.iter().all(|time| *time == 1e-4), "{times:?}");
        std::fs::remove_file(scratch.path("field.csv")).unwrap();
    }
}
