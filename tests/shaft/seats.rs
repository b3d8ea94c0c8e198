//! How outer rings sit: floating bearings, whose rings slide along their bores, and bores that are tilted or lie off.

use std::f64::consts::TAU;
use std::path::Path;

use nalgebra::Vector3;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::{MachineEquilibrium, System};

use crate::common::{GEARBOX, assert_order_two, forces, imbalance, run, scene, stored, system};

/// \[N] axial force of the mesh on the shaft.
const AXIAL: f64 = 337.8;

/// A rigid shaft on two 6205 of which the left one floats, with a radial and an axial load, in these directions.
fn floating(direction: &str) -> String {
    format!(
        r#"
[shaft]
speed = "3000 rpm"
mass = "1.8 kg"
polar_inertia = "6e-4 kg m^2"
transverse_inertia = "4e-3 kg m^2"
[[shaft.load]]
name = "mesh"
position = "-10 mm"
force = [{AXIAL}, -475.0, 1260.5]
[[bearing]]
name = "left"
catalogue = "6205"
mounting = {{ position = "-50 mm", direction = "{direction}", axial = "free" }}
[[bearing]]
name = "right"
catalogue = "6205"
mounting = {{ position = "50 mm", direction = "{direction}" }}
[load]
duration = "20 ms"
output_interval = "100 us"
"#
    )
}

const CASE: &str = r#"
[[housing]]
name = "case"
mass = "12 kg"
inertia = [0.06, 0.08, 0.09]
centre = [0.01, 0, "-20 mm"]
stiffness = [2e8, 2e8, 2e8, 1e6, 1e6, 1e6]
damping = [2e3, 2e3, 2e3, 5, 5, 5]
"#;

/// The same with both bearings in a housing.
fn in_case(text: &str) -> String {
    text.replace("mounting = {", "mounting = { housing = \"case\",").replacen(
        "[[bearing]]",
        &format!("{CASE}[[bearing]]"),
        1,
    )
}

/// Any load on the shaft along its axis is the located bearing's, at rest and in the mean of a run.
#[test]
fn closed_form_a_floating_bearing_takes_no_axial_force() {
    for direction in ["+x", "-x"] {
        for text in [floating(direction), in_case(&floating(direction))] {
            let found = MachineEquilibrium::of(&scene(&text), 0.0, 400.0).unwrap();
            let [left, right] = [0, 1].map(|index| found.bearings[index].force);
            assert!(left.x.abs() < 1e-6 * AXIAL, "{direction}: {left}");
            assert!((right.x + AXIAL).abs() < 1e-6 * AXIAL, "{direction}: {right}");
            // The lever of the radial load: 60 and 40 of 100 mm.
            assert!((left.z + 0.6 * 1260.5).abs() < 0.05 * 1260.5, "{direction}: {left}");

            let mut system = system(&text);
            let mut sums = [0.0; 2];
            for row in 1..=400 {
                system.advance(f64::from(row) * 5e-5).unwrap();
                let now = forces(&system);
                // What it swings by at the start, as balls take their places, dies out.
                if row > 200 {
                    sums = [0, 1].map(|index| sums[index] + now[index].x / 200.0);
                }
            }
            assert!(sums[0].abs() < 1e-3 * AXIAL, "{direction}: {sums:?}");
            assert!((sums[1] + AXIAL).abs() < 1e-3 * AXIAL, "{direction}: {sums:?}");
        }
    }
    // Without the key they share it.
    let held = floating("+x").replace(", axial = \"free\"", "");
    let found = MachineEquilibrium::of(&scene(&held), 0.0, 400.0).unwrap();
    assert!(found.bearings[0].force.x < -0.2 * AXIAL, "{}", found.bearings[0].force);
}

/// On a vertical shaft the balls and the outer ring of a floating bearing hang on its inner race.
#[test]
fn closed_form_a_floating_ring_weighs_what_it_weighs() {
    let (mass, gravity) = (0.5, 9.81);
    let text = format!("gravity = [-{gravity}, 0, 0]\n{}", floating("+x")).replacen(
        "[[bearing]]\nname = \"right\"",
        "[bearing.set]\nouter.mass = 0.5\n[[bearing]]\nname = \"right\"",
        1,
    );
    for text in [text.clone(), in_case(&text)] {
        let found = MachineEquilibrium::of(&scene(&text), 0.0, 400.0).unwrap();
        let system = system(&text);
        let (_, bearing) = system.bearings().next().unwrap();
        let balls = bearing.model().bearing.ball.mass * bearing.state().balls.len() as f64;
        let expected = -(mass + balls) * gravity;
        let force = found.bearings[0].force.x;
        assert!((force - expected).abs() < 1e-3 * expected.abs(), "{force} {expected}");
    }
}

/// A ring that is far heavier than the shaft swings along its bore as its mass on what a little gravity along it finds yielding.
#[test]
fn closed_form_a_floating_ring_swings_as_its_mass_on_its_bearing() {
    let text = floating("+x");
    let mass = scene(&text).bearings[0].sliding_mass().unwrap();
    // The maker's bearing has 0.128 kg, two races of about the same mass and nine balls of 2 g.
    assert!((0.04..0.08).contains(&mass), "{mass}");
    let heavy = text.replacen(
        "[[bearing]]\nname = \"right\"",
        "[bearing.set]\nouter.mass = 5000.0\n[[bearing]]\nname = \"right\"",
        1,
    );
    let found = MachineEquilibrium::of(&scene(&heavy), 0.0, 400.0).unwrap();
    let of_ring: Vec<f64> = found
        .modes
        .iter()
        .filter(|mode| mode.place == "the outer ring of left")
        .map(|mode| mode.frequency)
        .collect();
    let gravity = 1e-3;
    let position = |gravity: f64| {
        let system = system(&format!("gravity = [{gravity}, 0, 0]\n{heavy}"));
        let (_, bearing) = system.bearings().next().unwrap();
        bearing.outputs().outer.pose.position.x
    };
    let sag = 0.5 * (position(gravity) - position(-gravity));
    let expected = (gravity / sag).sqrt() / TAU;
    assert!(of_ring.len() == 1 && (of_ring[0] / expected - 1.0).abs() < 3e-3, "{of_ring:?} {expected}");
}

#[test]
fn hard_case_an_axial_blow_on_a_shaft_with_a_floating_bearing() {
    let blow =
        format!("[[[0, {AXIAL}], [\"1 ms\", {AXIAL}], [\"1.2 ms\", 3000], [\"1.4 ms\", {AXIAL}]], -475.0");
    for text in [floating("+x"), in_case(&floating("-x"))] {
        let text = text.replace(&format!("[{AXIAL}, -475.0"), &blow);
        let mut system = system(&text);
        let before = stored(&system);
        let mut largest = 0.0f64;
        for row in 1..=40 {
            system.advance(f64::from(row) * 1e-4).unwrap_or_else(|why| panic!("{why}"));
            largest = largest.max(forces(&system)[0].x.abs());
        }
        // Its ring is light: 50 g that swing at the acceleration of a shaft of 1.8 kg.
        assert!((1.0..600.0).contains(&largest), "{largest}");
        let [shaft, bearings] = imbalance(&system, &before);
        let outputs = system.outputs();
        let carried = outputs.ground.unwrap_or_else(|| outputs.housings[0].energies);
        let of_ring = carried.unaccounted().abs() / outputs.shafts[0].energies.turned_over();
        assert!(
            shaft < 1e-2 && bearings < 1e-2 && of_ring < 1e-3,
            "{shaft:.2e} {bearings:.2e} {of_ring:.2e}"
        );
    }
}

/// Nothing holds the ring of a bearing with play and without a load: it stays where it is.
#[test]
fn hard_case_a_floating_bearing_without_a_load() {
    let text = floating("+x").replace("-475.0, 1260.5", "0, 0").replace("-10 mm", "50 mm");
    for text in [text.clone(), in_case(&text)] {
        let system = run(&text, 2e-3);
        let now = forces(&system);
        assert!(now[0].x.abs() < 1.0 && (now[1].x + AXIAL).abs() < 1.0, "{now:?}");
    }
}

#[test]
fn order_of_convergence_of_a_floating_bearing_is_two() {
    let text =
        floating("+x").replace(&format!("[{AXIAL}, "), &format!("[[[0, {AXIAL}], [\"300 us\", 500]], "));
    assert_order_two(&text, 2e-4, 1e-6, |system| {
        let (_, bearing) = system.bearings().next().unwrap();
        Vector3::x() * bearing.outputs().outer.pose.position.x
    });
}

#[test]
fn regression_a_saved_state_with_a_floating_bearing_goes_on_to_the_same_bits() {
    let off = "axial = \"free\", misalignment = { ry = 1e-3 }, offset = { z = 1e-5 }";
    for text in [floating("+x"), in_case(&floating("-x"))] {
        let text = text.replace("axial = \"free\"", off);
        let mut system = system(&text);
        system.advance(1.5e-4).unwrap();
        let saved = system.snapshot();
        let mut other = System::new(system.scene()).unwrap();
        assert!(other.restore(&saved));
        for one in [&mut system, &mut other] {
            one.advance(3e-4).unwrap();
        }
        assert_eq!(system.outputs(), other.outputs());
        assert_eq!(system.snapshot(), other.snapshot());
        // A snapshot of the shaft whose bearings are held is refused.
        let held = crate::common::system(&text.replace("axial = \"free\", ", ""));
        assert!(!other.restore(&held.snapshot()));
        // The text that stands alone is the same system.
        let again = SystemScene::parse(&system.scene().source, None, Path::new("")).unwrap();
        assert_eq!(System::new(&again).unwrap().outputs(), crate::common::system(&text).outputs());
    }
}

/// The same angle in the bearing's own scene: tilted bores in the ground, and in a housing that cannot move.
#[test]
fn invariant_a_tilted_bore_is_a_misaligned_outer_race() {
    // A preload by force is that of races that are not tilted.
    let plain = GEARBOX.replace("preload = { force = \"1500 N\" }", "preload = { displacement = \"20 um\" }");
    let tilted = |more: &str| {
        plain
            .replace(
                "direction = \"+x\"",
                &format!("direction = \"+x\", misalignment = {{ ry = 8e-4, rz = -5e-4 }}{more}"),
            )
            .replace(
                "direction = \"-x\"",
                &format!("direction = \"-x\", misalignment = {{ ry = 8e-4, rz = -5e-4 }}{more}"),
            )
    };
    // Axes of the right bearing are turned by half a turn about z.
    let own = plain
        .replacen(
            "[[bearing]]\nname = \"right\"",
            "[bearing.set.outer.misalignment]\nry = 8e-4\nrz = -5e-4\n[[bearing]]\nname = \"right\"",
            1,
        )
        .replacen("[load]", "[bearing.set.outer.misalignment]\nry = -8e-4\nrz = -5e-4\n[load]", 1);
    let stiff = "[[housing]]\nname = \"case\"\nmass = \"12 kg\"\ninertia = [0.06, 0.08, 0.09]\n\
                 stiffness = [1e14, 1e14, 1e14, 1e12, 1e12, 1e12]\n[[bearing]]";
    let housed = tilted(", housing = \"case\"").replacen("[[bearing]]", stiff, 1);
    let [own, ground, housed, plain] = [own, tilted(""), housed, plain].map(|text| run(&text, 5e-4));
    for (index, expected) in forces(&own).iter().enumerate() {
        let off = |other: &System| (forces(other)[index] - expected).norm() / expected.norm();
        assert!(off(&ground) < 1e-8, "{index}: {:.2e}", off(&ground));
        assert!(off(&housed) < 1e-5, "{index}: {:.2e}", off(&housed));
        assert!(off(&plain) > 1e-2, "{index}: {:.2e}", off(&plain));
    }
}

/// Bores along another line: all bearings at places on it and tilted with it, under loads that are turned with it, are the same.
#[test]
fn invariant_a_shaft_along_another_line_of_bores_has_the_same_forces() {
    let (y, z, ry, rz) = (12e-6, -20e-6, 4e-4, -3e-4);
    let plain = GEARBOX.replace("gravity = [0, 0, -9.81]", "gravity = [0, 0, 0]");
    let stiff = "[[housing]]\nname = \"case\"\nmass = \"12 kg\"\ninertia = [0.06, 0.08, 0.09]\n\
                 stiffness = [1e14, 1e14, 1e14, 1e12, 1e12, 1e12]\n[[bearing]]";
    for housing in ["", ", housing = \"case\""] {
        let mut text = plain.clone();
        for (direction, at) in [("+x", -0.05), ("-x", 0.05)] {
            // A tilt about y moves what lies at +x towards -z, one about z towards +y.
            let bore = format!(
                "direction = \"{direction}\", offset = {{ y = {}, z = {} }}, misalignment = {{ ry = {ry}, rz = {rz} }}{housing}",
                y + rz * at,
                z - ry * at
            );
            text = text.replace(&format!("direction = \"{direction}\""), &bore);
        }
        if !housing.is_empty() {
            text = text.replacen("[[bearing]]", stiff, 1);
        }
        let turn = |v: [f64; 3]| nalgebra::Rotation3::new(Vector3::new(0.0, ry, rz)) * Vector3::from(v);
        // The point where the mesh acts goes with the line, its moment with the force there.
        let force = turn([337.8, -475.0, 1260.5]);
        let moment = turn([30.0, 0.0, -8.04]);
        text = text
            .replace("force = [337.8, -475.0, 1260.5]", &format!("force = {:?}", force.as_slice()))
            .replace("moment = [30.0, 0, -8.04]", &format!("moment = {:?}", moment.as_slice()));
        let [moved, still] = [text, plain.clone()].map(|text| system(&text));
        for (index, (found, expected)) in forces(&moved).iter().zip(forces(&still)).enumerate() {
            let off = (found - turn(expected.into())).norm() / expected.norm();
            // Levers of a structure are those of its undeformed axis: axial forces times the tilt are left out, 0.05 N m of some 20.
            assert!(off < 2e-3, "{housing} {index}: {off:.2e} {found} {expected}");
        }
        let [moved, still] = [&moved, &still].map(|one| one.outputs().seats[0]);
        let went = moved.displacement - turn(still.displacement.into());
        let expected = Vector3::new(0.0, y - rz * 0.05, z + ry * 0.05);
        assert!((went - expected).norm() < 1e-7, "{went} {expected}");
        assert!((moved.tilt - still.tilt - Vector3::new(0.0, ry, rz)).norm() < 1e-6, "{moved:?} {still:?}");
    }
}

#[test]
fn refusals_of_seats_name_key_value_and_allowed_range() {
    let good = floating("+x");
    let left = "axial = \"free\" }";
    for (from, to, parts) in [
        (left, "axial = \"loose\" }", &["loose", "held", "free"][..]),
        (left, "axial = \"free\", preload = { force = 100 } }", &["mounting.preload", "axial = \"free\""]),
        (
            left,
            "axial = \"free\", misalignment = { ry = 0.1 } }",
            &["mounting.misalignment.ry = 0.1", "0.05"],
        ),
        (left, "axial = \"free\", offset = { z = \"20 mm\" } }", &["mounting.offset.z = 0.02", "0.01"]),
        (left, "axial = \"free\", offset = { x = \"20 um\" } }", &["x", "y", "z"]),
        ("direction = \"+x\" }", "axial = \"free\" }", &["mounting.axial", "at least one bearing", "held"]),
        (
            "[[bearing]]\nname = \"right\"",
            "[bearing.set]\nouter.mass = -1.0\n[[bearing]]\nname = \"right\"",
            &["\"left\"", "outer.mass = -1 kg"],
        ),
        (
            "[[bearing]]\nname = \"right\"",
            "[bearing.set.outer]\ndrive = \"hinge\"\n[[bearing]]\nname = \"right\"",
            &["\"left\"", "outer.drive", "mounting.axial"],
        ),
        (
            "[[bearing]]\nname = \"right\"",
            "[bearing.set.outer.misalignment]\nry = 1e-3\n[[bearing]]\nname = \"right\"",
            &["\"left\"", "outer.misalignment", "misalignment"],
        ),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        let refusal = SystemScene::parse(&text, None, Path::new("")).unwrap_err().to_string();
        for part in parts {
            assert!(refusal.contains(part), "{refusal}\nshould name {part}");
        }
    }
    // A scene of its own says what its ring weighs.
    let folder = Path::new(roulement_tests::ROOT).join("scenes");
    let own = good.replacen("catalogue = \"6205\"", "scene = \"radial.toml\"", 1);
    let refusal = SystemScene::parse(&own, None, &folder).unwrap_err().to_string();
    assert!(refusal.contains("outer.mass") && refusal.contains("\"left\""), "{refusal}");
}
