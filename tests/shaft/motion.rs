//! A shaft and its bearings in motion.

use nalgebra::Vector3;
use roulement::Simulation;
use roulement::scene::Scene;

use crate::common::{GEARBOX, ROTOR, assert_order_two, forces, imbalance, run, stored, system};

/// The same bearing by the program for one: its inner race under a wrench has the mass and the inertia of the shaft.
#[test]
fn independent_code_a_shaft_on_one_bearing_moves_as_a_race_under_a_wrench() {
    let folder = std::path::Path::new(roulement_tests::ROOT).join("scenes");
    let text = std::fs::read_to_string(folder.join("thrust.toml")).unwrap();
    let changes = [
        ("solver", "{ max_step = \"4 us\", initial_step = \"4 us\", tolerance = 1e-2 }"),
        ("load.y.force", "[[0, 100], [\"0.5 ms\", 400], [\"1 ms\", -100]]"),
        ("load.rz.moment", "2.0"),
        ("inner.mass", "0.4"),
        ("inner.inertia", "[2e-4, 1.5e-4, 1.5e-4]"),
        ("load.inner_speed", "600.0"),
        ("load.x.force", "1500.0"),
    ];
    let scene = Scene::edited(&text, changes).unwrap();
    let mut alone = Simulation::new(&scene).unwrap();
    let of_system = r#"
[shaft]
speed = 600
mass = 0.4
polar_inertia = 2e-4
transverse_inertia = 1.5e-4
[[shaft.load]]
name = "all"
position = 0.0
force = [1500.0, [[0, 100], ["0.5 ms", 400], ["1 ms", -100]], 0]
moment = [0, 0, 2.0]
[[bearing]]
name = "one"
scene = "thrust.toml"
mounting = { position = 0.0 }
[solver]
max_step = "4 us"
initial_step = "4 us"
tolerance = 1e-2
[load]
duration = "2 ms"
output_interval = "100 us"
"#;
    let mut system = system(of_system);
    for row in 0..=20 {
        let time = 1e-4 * f64::from(row);
        if row > 0 {
            alone.advance_scripted(time).unwrap();
            system.advance(time).unwrap();
        }
        let (one, other) = (alone.outputs(), system.bearings().next().unwrap().1.outputs());
        let apart = (one.inner.pose.position - other.inner.pose.position).norm();
        // It goes 50 um and tilts by 2.4 mrad: what a linear shaft leaves out is of the square of that.
        assert!(apart < 1e-9, "{time}: {apart} m");
        let force = (one.inner.wrench.force - other.inner.wrench.force).norm();
        assert!(force < 1e-4 * one.inner.wrench.force.norm(), "{time}: {force} N");
        let torque = (one.inner.drive_torque - system.outputs().shafts[0].torque).abs();
        assert!(
            torque < 2e-3 * 1500.0 * 0.023,
            "{time}: {} {}",
            one.inner.drive_torque,
            system.outputs().shafts[0].torque
        );
    }
    // It has moved: that was no comparison of two things at rest.
    let moved = system.outputs().seats[0].displacement.y
        - crate::common::system(of_system).outputs().seats[0].displacement.y;
    assert!(moved.abs() > 1e-5, "{moved}");
}

/// Everything turned by half a turn about z.
#[test]
fn invariant_a_shaft_that_is_turned_around_moves_as_it_did() {
    let turned = GEARBOX
        .replace("\"6000 rpm\"", "\"-6000 rpm\"")
        .replace("[337.8, -475.0, 1260.5]", "[-337.8, 475.0, 1260.5]")
        .replace("[30.0, 0, -8.04]", "[-30.0, 0, -8.04]")
        .replace("\"-10 mm\"", "\"10 mm\"")
        .replace("\"-50 mm\", direction = \"+x\"", "\"HERE\", direction = \"-x\"")
        .replace("\"50 mm\", direction = \"-x\"", "\"-50 mm\", direction = \"+x\"")
        .replace("HERE", "50 mm");
    let (one, other) = (run(GEARBOX, 5e-4), run(&turned, 5e-4));
    for (a, b) in forces(&one).iter().zip(forces(&other)) {
        assert!((a - Vector3::new(-b.x, -b.y, b.z)).norm() < 1e-6 * a.norm(), "{a} {b}");
    }
    let loads = |system: &roulement::simulation::system::System| -> f64 {
        system.bearings().flat_map(|(_, b)| b.outputs().balls.iter().map(|ball| ball.inner.load)).sum()
    };
    assert!((loads(&one) / loads(&other) - 1.0).abs() < 1e-9);
}

#[test]
fn invariant_a_copy_goes_on_to_the_same_bits_and_rows_have_no_part_in_the_motion() {
    let mut one = run(GEARBOX, 2e-4);
    let mut copy = one.clone();
    for system in [&mut one, &mut copy] {
        system.advance(4e-4).unwrap();
    }
    assert_eq!(one.states(), copy.states());
    assert_eq!(one.outputs(), copy.outputs());
    assert!(one.bearings().zip(copy.bearings()).all(|(a, b)| a.1.state() == b.1.state()));
}

#[test]
fn invariant_energy_of_shaft_and_bearings_balances() {
    for (text, end) in [(GEARBOX, 2e-3), (ROTOR, 5e-3)] {
        let mut system = system(text);
        let before = stored(&system);
        system.advance(end).unwrap();
        let [shaft, bearings] = imbalance(&system, &before);
        assert!(shaft < 1e-6 && bearings < 1e-2, "{shaft:.2e} {bearings:.2e}");
    }
}

#[test]
fn order_of_convergence_of_a_shaft_under_a_load_that_changes_is_two() {
    let load = "[[0, 100], [\"1 ms\", 300], [\"2 ms\", 0]]";
    let text = ROTOR.replace("[0, \"100 N\", 0]", &format!("[0, {load}, 0]"));
    assert_order_two(&text, 2e-3, 2e-6, |system| system.outputs().loads[0].displacement);
}

#[test]
fn closed_form_a_shaft_under_a_torque_speeds_up_by_torque_over_inertia() {
    let text = GEARBOX
        .replace("speed = \"6000 rpm\"", "torque = 6.0\nstart_speed = 600.0")
        .replace("[337.8, -475.0, 1260.5]", "[0, 0, 0]")
        .replace("[30.0, 0, -8.04]", "[0, 0, 0]");
    let mut system = system(&text);
    let before = stored(&system);
    system.advance(2e-3).unwrap();
    let friction: f64 = system.bearings().map(|(_, b)| b.outputs().friction_torque).sum();
    // Friction of both bearings and the balls that are sped up take some of it.
    let gained = (system.outputs().shafts[0].spin.speed - 600.0) / 2e-3 * 6e-4;
    assert!((5.0..6.0).contains(&gained) && gained < 6.0 - 0.5 * friction, "{gained} {friction}");
    assert!(imbalance(&system, &before)[0] < 1e-6);
}

/// Beams so stiff that they are rigid, against the rigid body of the same mass.
#[test]
fn limit_stiff_beams_move_as_the_rigid_body_of_their_mass_and_inertia() {
    let beams = ROTOR.replace("[shaft]\n", "[shaft]\nmaterial = { youngs_modulus = 1e13, density = 7800 }\n");
    let beams = beams.replace("\"25 mm\"", "\"80 mm\"");
    let (radius, length) = (0.04f64, 0.44);
    let mass = 7800.0 * std::f64::consts::PI * radius * radius * length;
    let transverse = mass * (radius * radius / 4.0 + length * length / 12.0);
    let section = beams.find("[[shaft.section]]").unwrap();
    let disc = beams.find("[[shaft.disc]]").unwrap();
    let rigid = format!("{}{}", &beams[..section], &beams[disc..]).replace(
        "[shaft]\n",
        &format!(
            "[shaft]\nmass = {mass}\npolar_inertia = {}\ntransverse_inertia = {transverse}\ncentre = 0.2\n",
            0.5 * mass * radius * radius
        ),
    );
    let load = "[[0, 0], [\"0.5 ms\", 300], [\"1 ms\", 0]]";
    let [one, other] = [&beams, &rigid].map(|text| run(&text.replace("\"100 N\"", load), 1e-3));
    let (a, b) = (one.outputs().loads[0].displacement, other.outputs().loads[0].displacement);
    assert!((a - b).norm() < 0.02 * b.norm() && b.norm() > 1e-7, "{a} {b}");
}

/// The matrices of the beams, written to a file as another program would.
#[test]
fn invariant_a_shaft_from_a_file_of_matrices_moves_as_the_beams_they_are_of() {
    let beams = run(ROTOR, 5e-4);
    let shaft = &beams.shafts()[0];
    let rows = |matrix: &nalgebra::DMatrix<f64>| -> Vec<Vec<f64>> {
        matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
    };
    let station = |(position, map): (f64, &roulement::model::structure::Map)| {
        let map: Vec<Vec<f64>> = map.row_iter().map(|row| row.iter().copied().collect()).collect();
        serde_json::json!({ "position": position, "map": map })
    };
    let stations: Vec<_> = [0.0, 0.4, 0.2].into_iter().zip(&shaft.stations).map(station).collect();
    let structure = &shaft.structure;
    let weights = nalgebra::DMatrix::from_fn(structure.size(), 3, |i, k| structure.weights[(i, k)]);
    let translations = (*structure.mass).clone().lu().solve(&weights).unwrap();
    let mut file = serde_json::json!({
        "mass": rows(&structure.mass),
        "stiffness": rows(&structure.stiffness),
        "gyroscopic": rows(&structure.gyroscopic),
        "polar_inertia": structure.polar_inertia,
        "translations": rows(&translations),
        "stations": stations,
    });
    let folder = std::env::temp_dir().join(format!("roulement-matrices-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let section = ROTOR.find("[[shaft.section]]").unwrap();
    let load = ROTOR.find("[[shaft.load]]").unwrap();
    let text = format!("{}{}", &ROTOR[..section], &ROTOR[load..])
        .replace("[shaft]\n", "[shaft]\nmatrices = \"rotor.json\"\n");
    let read = |text: &str, file: &serde_json::Value| {
        std::fs::write(folder.join("rotor.json"), file.to_string()).unwrap();
        roulement::scene::system::SystemScene::parse(text, None, &folder)
    };
    let mut other = roulement::simulation::system::System::new(&read(&text, &file).unwrap()).unwrap();
    other.advance(5e-4).unwrap();
    // Weights are computed from what was computed from them.
    let apart = (&other.states()[0].coordinates - &beams.states()[0].coordinates).amax();
    assert!(apart < 1e-12 * beams.states()[0].coordinates.amax(), "{apart}");
    // What does not fit is refused with its place.
    for (text, key, value, part) in [
        (text.clone(), "mass", serde_json::json!([[1.0]]), "should have 1 of 3"),
        (text.clone(), "stiffness", serde_json::json!("none"), "rotor.json"),
        (
            text.replace("0.0, direction", "0.1, direction"),
            "title",
            serde_json::json!("other"),
            "no station at 0.1 m",
        ),
        (text.clone(), "translations", serde_json::json!([[1.0]]), "translations has"),
        (
            text.replace("[shaft]\n", "[shaft]\nmass = 1.0\n"),
            "title",
            serde_json::json!("other"),
            "shaft.mass",
        ),
    ] {
        let kept = file[key].clone();
        file[key] = value;
        let refusal = match read(&text, &file) {
            Ok(scene) => {
                roulement::simulation::system::System::new(&scene).map(drop).unwrap_err().to_string()
            }
            Err(why) => why.to_string(),
        };
        assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        match kept.is_null() {
            true => drop(file.as_object_mut().unwrap().remove(key)),
            false => file[key] = kept,
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
