//! `roulement rating`: lives of given loads.

use super::*;

/// A 6206 with the ratings of its scene; outer race control has no part in slow bearings.
pub const SCENE: &str = r#"
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
    // Two bearings, and the machine.
    assert_eq!(all.len(), 3, "{text}");
    assert_eq!(text.lines().count(), 10, "{text}");
    // Lives by Weibull's slope of 10/9.
    for load in ["1,", "2,", "all,"] {
        let lines: String = text
            .lines()
            .take(1)
            .chain(text.lines().filter(|line| line.starts_with(load)))
            .collect::<Vec<_>>()
            .join("\n");
        let rows = table(&lines);
        let failures: f64 = rows[..2].iter().map(|row| row[6].powf(-10.0 / 9.0)).sum();
        assert!((rows[2][6] / failures.powf(-0.9) - 1.0).abs() < 1e-12, "{lines}");
        assert!(
            (rows[2][11] / (rows[0][11] + rows[1][11]) - 1.0).abs() < 1e-12 && rows[2][11] > 0.0,
            "{lines}"
        );
    }
    let mean =
        |line: &&str| (line.split(',').nth(3).unwrap().parse::<f64>().unwrap() / 1500.0 - 1.0).abs() < 1e-12;
    assert!(all[..2].iter().all(mean), "{text}");
}

/// The loads of the table above as entries of the scene.
const DUTY: &str = r#"
[[duty]]
name = "slow"
share = 0.5
set = { load = { inner_speed = "600 rpm", y = { force = 1000 }, x = { force = 0 } } }
[[duty]]
name = "fast"
share = 0.3
set = { "load.inner_speed" = "1500 rpm", "load.y.force" = "3 kN", "load.x.force" = 500 }
[[duty]]
name = "heavy"
share = 0.2
[duty.set.load]
inner_speed = "300 rpm"
y.force = "6000 N"
"#;

#[test]
fn consistency_a_duty_of_the_scene_is_a_table_of_loads() {
    let scratch = Scratch::new("rating-duty");
    std::fs::write(scratch.path("scene.toml"), format!("{SCENE}{DUTY}")).unwrap();
    std::fs::write(scratch.path("loads.csv"), LOADS).unwrap();
    let scene = scratch.path("scene.toml");
    let printed = |arguments: &[&str]| {
        let output = roulement(arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let (own, told) = printed(&["rating", &scene]);
    let (of_table, _) = printed(&["rating", &scene, "--loads", &scratch.path("loads.csv")]);
    let cells = |text: &str| {
        text.lines().skip(1).map(|line| line.split_once(',').unwrap().1.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(cells(&own), cells(&of_table));
    let names: Vec<&str> = own.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(names, ["slow", "fast", "heavy", "all"]);
    // Which takes most, by hand.
    let rows = table(&own);
    let taken: Vec<f64> = rows[..3].iter().map(|row| row[2] / row[8]).collect();
    let most = 100.0 * taken[2] / taken.iter().sum::<f64>();
    assert!(told.contains(&format!("load heavy takes most of the life, {most:.0} %")), "{told}");
    // Torques and losses by time.
    for column in [10, 11] {
        let mean: f64 = rows[..3].iter().map(|row| row[2] * row[column]).sum();
        assert!(mean > 0.0 && (rows[3][column] / mean - 1.0).abs() < 1e-12, "{own}");
    }
    // The rest of the program reads over it.
    printed(&["equilibrium", &scene]);
}

#[test]
fn closed_form_hours_of_a_duty_take_their_part_of_the_life() {
    let scratch = Scratch::new("rating-hours");
    let duty = DUTY.replace("share = 0.", "hours = ");
    std::fs::write(scratch.path("scene.toml"), format!("{SCENE}{duty}")).unwrap();
    let output = roulement(&["rating", &scratch.path("scene.toml")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let rows = table(&String::from_utf8(output.stdout).unwrap());
    let mut whole = 0.0;
    for (row, hours) in rows.iter().zip([5.0, 3.0, 2.0]) {
        assert!((row[2] - 0.1 * hours).abs() < 1e-12);
        assert!((row[12] / (hours / row[8]) - 1.0).abs() < 1e-12, "{row:?}");
        whole += row[12];
    }
    assert!((rows[3][12] / whole - 1.0).abs() < 1e-12, "{rows:?}");
}

#[test]
fn duties_that_cannot_be_are_refused_with_the_key() {
    let scratch = Scratch::new("rating-wrong-duty");
    for (duty, parts) in [
        ("", &["--loads", "[[duty]]"][..]),
        ("[[duty]]\nname = \"a\"\n", &["duty[0].share", "hours"]),
        ("[[duty]]\nname = \"a b\"\nshare = 1\n", &["duty[0].name", "a b"]),
        ("[[duty]]\nname = \"a\"\nshare = 0\n", &["duty[0].share", "0"]),
        (
            "[[duty]]\nname = \"a\"\nshare = 1\n[[duty]]\nname = \"b\"\nhours = 1\n",
            &["duty[1].share", "same in all"],
        ),
        (
            "[[duty]]\nname = \"a\"\nshare = 1\n[[duty]]\nname = \"a\"\nshare = 1\n",
            &["duty[1].name", "another"],
        ),
        ("[[duty]]\nname = \"a\"\nshare = 1\nset = { load = { y = { farce = 1 } } }\n", &["duty a", "farce"]),
        (
            "[[duty]]\nname = \"a\"\nshare = 1\nset = { \"load.y.force\" = \"1 kg\" }\n",
            &["duty a", "load.y.force", "kg"],
        ),
    ] {
        std::fs::write(scratch.path("scene.toml"), format!("{SCENE}{duty}")).unwrap();
        let output = roulement(&["rating", &scratch.path("scene.toml")]);
        let message = String::from_utf8_lossy(&output.stderr).to_string();
        assert!(!output.status.success(), "{duty}");
        for part in parts {
            assert!(message.contains(part), "{message}\nshould have {part}");
        }
    }
}

/// The public three-stage gearbox under ten torques, of which the largest takes most of every life.
#[test]
fn consistency_a_gearbox_under_ten_loads() {
    let scratch = Scratch::new("rating-gearbox");
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/gearbox/three_stage.toml"))
            .unwrap();
    let duty: String = (1..=10)
        .map(|k| {
            format!(
                "[[duty]]\nname = \"load{k}\"\nhours = 100\n[duty.set.shaft.output]\ntorque = {}\n",
                50.0 * f64::from(k)
            )
        })
        .collect();
    std::fs::write(scratch.path("scene.toml"), format!("{text}\n{duty}")).unwrap();
    let output = roulement(&["rating", &scratch.path("scene.toml")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let machine: Vec<Vec<f64>> = text
        .lines()
        .filter(|line| line.contains("(machine)"))
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    assert_eq!(machine.len(), 11, "{text}");
    let damage: f64 = machine[..10].iter().map(|row| row[12]).sum();
    // Heavier loads take more, and losses grow with them.
    assert!(machine[..10].windows(2).all(|pair| pair[1][12] > pair[0][12]), "{text}");
    assert!(machine[9][12] > 0.25 * damage, "{text}");
}

#[test]
fn closed_form_lives_of_rollers_add_up_as_those_of_balls() {
    let scratch = Scratch::new("rating-rollers");
    let machine = |speed: f64, force: f64| {
        format!(
            "[shaft]\nspeed = \"{speed} rpm\"\nmass = 2.0\npolar_inertia = 1e-3\ntransverse_inertia = 3e-3\n\
             [[shaft.load]]\nname = \"pull\"\nposition = \"60 mm\"\nforce = [0, {force}, 0]\n\
             [[bearing]]\nname = \"ball\"\ncatalogue = \"6206\"\nmounting = {{ position = 0 }}\n\
             [[bearing]]\nname = \"roller\"\ncatalogue = \"NU 206\"\nmounting = {{ position = \"100 mm\" }}\n\
             [load]\nduration = \"1 ms\"\noutput_interval = \"1 ms\"\n"
        )
    };
    let duty = "[[duty]]\nname = \"1\"\nhours = 3000\n[[duty]]\nname = \"2\"\nhours = 1000\nset = { shaft = { speed = \"500 rpm\", load = { pull = { force = [0, 9000, 0] } } } }\n";
    std::fs::write(scratch.path("machine.toml"), machine(1500.0, 4000.0) + duty).unwrap();
    let output = roulement(&["rating", &scratch.path("machine.toml")]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && told.contains("rollers have no friction here"), "{told}");
    let text = String::from_utf8(output.stdout).unwrap();
    let row = |load: &str, bearing: &str| -> Vec<f64> {
        let line = text
            .lines()
            .find(|line| line.starts_with(&format!("{load},{bearing},")))
            .unwrap_or_else(|| panic!("{text}"));
        line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    };
    let near =
        |ours: f64, theirs: f64| assert!((ours / theirs - 1.0).abs() < 1e-6, "{ours} {theirs}\n{text}");
    let loads = [("1", 1500.0, 4000.0, 3000.0), ("2", 500.0, 9000.0, 1000.0)];
    let mut used = 0.0;
    for (load, speed, force, hours) in loads {
        // Each is the life of an equilibrium.
        std::fs::write(scratch.path("one.toml"), machine(speed, force)).unwrap();
        let output = roulement(&["equilibrium", &scratch.path("one.toml"), "--json"]);
        let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let own = row(load, "roller");
        near(own[6], found["bearings_by_stiffness"]["roller"]["L10r_hours"].as_f64().unwrap());
        near(own[12], hours / own[6]);
        assert!(own[10].is_nan() && own[11].is_nan(), "{text}");
        used += hours / own[6];
    }
    near(row("all", "roller")[12], used);
    near(row("all", "roller")[6], 4000.0 / used);
    // Of the machine: both fail by Weibull's law (ISO 281's slope of 10/9).
    let lives = ["ball", "roller"].map(|name| row("all", name)[6].powf(-10.0 / 9.0));
    near(row("all", "(machine)")[6], (lives[0] + lives[1]).powf(-0.9));
}

#[test]
fn invariant_rollers_in_oil_have_torque_and_losses() {
    let scratch = Scratch::new("rating-rollers-in-oil");
    let machine = "[shaft]\nspeed = \"1500 rpm\"\nmass = 2.0\npolar_inertia = 1e-3\ntransverse_inertia = 3e-3\n\
         [[shaft.load]]\nname = \"pull\"\nposition = \"60 mm\"\nforce = [0, 4000, 0]\n\
         [[bearing]]\nname = \"ball\"\ncatalogue = \"6206\"\nmounting = { position = 0 }\n\
         [[bearing]]\nname = \"roller\"\ncatalogue = \"NU 206\"\nmounting = { position = \"100 mm\" }\n\
         set = { rollers = { film = { iso_vg = 68, temperature = \"70 degC\" } } }\n\
         [load]\nduration = \"1 ms\"\noutput_interval = \"1 ms\"\n[[duty]]\nname = \"1\"\nhours = 10\n";
    std::fs::write(scratch.path("machine.toml"), machine).unwrap();
    let output = roulement(&["rating", &scratch.path("machine.toml")]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && !told.contains("no friction here"), "{told}");
    let text = String::from_utf8(output.stdout).unwrap();
    let cells = |bearing: &str| -> Vec<f64> {
        let line = text.lines().find(|line| line.starts_with(&format!("1,{bearing},"))).unwrap();
        line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    };
    let own = cells("roller");
    let output = roulement(&["equilibrium", &scratch.path("machine.toml"), "--json"]);
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let friction = &found["bearings_by_stiffness"]["roller"]["friction"];
    for (cell, key) in [(10, "torque"), (11, "loss")] {
        assert!((own[cell] / friction[key].as_f64().unwrap() - 1.0).abs() < 1e-6, "{text}");
    }
    assert!((cells("(machine)")[11] - cells("ball")[11] - own[11]).abs() < 1e-9 * own[11], "{text}");
    // `effects` names what is left out, and what is in is no part of that.
    let output = roulement(&["effects", &scratch.path("machine.toml")]);
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told.contains("slip and its losses") && !told.contains("friction and losses"), "{told}");
}
