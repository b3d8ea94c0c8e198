//! Signs that docs/frames.md promises.

use serde_json::Value;

use crate::common::{Scratch, roulement};

const THRUST: &str = include_str!("../../../scenes/misalignment.toml");

/// The scene with its `load` changed, and twelve balls, so that one stands at every quarter.
fn changed(changes: &[(&str, &str)]) -> String {
    let mut text = THRUST.replace("balls = 10", "balls = 12");
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    text
}

struct Seen(Value);

impl Seen {
    fn of(name: &str, changes: &[(&str, &str)]) -> Self {
        let scratch = Scratch::new(&format!("signs-{name}"));
        std::fs::write(scratch.path("scene.toml"), changed(changes)).unwrap();
        let output = roulement(&["equilibrium", &scratch.path("scene.toml"), "--json"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Self(serde_json::from_slice(&output.stdout).unwrap())
    }

    /// Azimuths of the largest and the smallest load [deg].
    fn ends(&self) -> (f64, f64) {
        let list = |key: &str| -> Vec<f64> {
            self.0["balls"][key].as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
        };
        let (azimuths, loads) = (list("azimuth"), list("inner_load"));
        let at = |best: fn(&f64, &f64) -> bool| {
            let place =
                (0..loads.len()).reduce(|a, b| if best(&loads[b], &loads[a]) { b } else { a }).unwrap();
            azimuths[place].to_degrees().round()
        };
        (at(|a, b| a > b), at(|a, b| a < b))
    }

    fn load(&self, name: &str) -> f64 {
        self.0["load"][name].as_f64().unwrap()
    }
}

#[test]
fn closed_form_pushes_load_the_side_that_they_point_to() {
    let x = Seen::of("x", &[]);
    for race in ["inner", "outer"] {
        let angles = x.0["balls"][format!("{race}_contact_angle")].as_array().unwrap();
        assert!(angles.iter().all(|angle| angle.as_f64().unwrap() > 0.3), "{angles:?}");
    }
    let y = Seen::of("y", &[("y = { displacement = 0.0 }", "y = { force = \"500 N\" }")]);
    assert_eq!(y.ends(), (0.0, 180.0));
    assert!((y.load("Fy") - 500.0).abs() < 1e-6);
    let z = Seen::of("z", &[("z = { displacement = 0.0 }", "z = { force = \"500 N\" }")]);
    assert_eq!(z.ends(), (90.0, 270.0));
}

#[test]
fn closed_form_tilts_follow_the_right_hand_rule() {
    let rz = Seen::of("rz", &[("rz = { rotation = 0.0 }", "rz = { rotation = \"0.5 mrad\" }")]);
    assert_eq!(rz.ends(), (180.0, 0.0));
    assert!(rz.load("Mz") > 1.0, "{}", rz.load("Mz"));
    let ry = Seen::of("ry", &[("ry = { rotation = 0.0 }", "ry = { rotation = \"0.5 mrad\" }")]);
    assert_eq!(ry.ends(), (90.0, 270.0));
    assert!(ry.load("My") > 1.0, "{}", ry.load("My"));
}

#[test]
fn closed_form_a_run_has_the_bearing_s_forces_on_the_race_and_balls_that_go_with_it() {
    let scratch = Scratch::new("signs-run");
    let text = changed(&[
        ("y = { displacement = 0.0 }", "y = { force = \"500 N\" }"),
        ("duration = \"60 ms\"", "duration = \"4 ms\""),
        (
            "drive = \"pose\"",
            "drive = \"wrench\"\nmass = \"0.2 kg\"\ninertia = [\"6e-5 kg m^2\", \"4e-5 kg m^2\", \"4e-5 kg m^2\"]",
        ),
    ]);
    std::fs::write(scratch.path("scene.toml"), text).unwrap();
    let columns = "inner.force.*,friction_torque,ball[1].azimuth,inner.drive_torque";
    let output =
        roulement(&["run", &scratch.path("scene.toml"), "-o", &scratch.path("out"), "--columns", columns]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = scratch.read("out/results.csv");
    let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let column = |name: &str| {
        let place = names.iter().position(|of| of.split(" [").next() == Some(name)).unwrap();
        rows.iter().map(|row| row[place]).collect::<Vec<f64>>()
    };
    let mean = |name: &str| column(name).iter().sum::<f64>() / rows.len() as f64;
    assert!((mean("inner.force.x") + 1500.0).abs() < 30.0, "{}", mean("inner.force.x"));
    assert!((mean("inner.force.y") + 500.0).abs() < 30.0, "{}", mean("inner.force.y"));
    let azimuths = column("ball[1].azimuth");
    assert!(azimuths.windows(2).all(|pair| pair[1] > pair[0]), "{azimuths:?}");
    assert!(mean("friction_torque") > 0.0 && mean("inner.drive_torque") > 0.0);
}
