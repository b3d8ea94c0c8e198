//! Several shafts whose gears mesh in one package, through the C interface.

use roulement::interface::variables::Causality;
use roulement::simulation::system::System;

use crate::fmi2_abi::*;
use crate::system::{STEP, advance, bits, get, native_outputs, outputs, replay, run, scene, set};

/// Rigid shafts of 20 and 40 teeth, the first one driven by its speed, the other one braked by a torque.
fn text(torque: &str) -> String {
    let shaft = |name: &str, keys: &str| {
        let bearing = |side: &str, at: &str, way: &str| {
            format!(
                "[[bearing]]\nname = \"{name}-{side}\"\nshaft = \"{name}\"\ncatalogue = \"6205\"\n\
                 mounting = {{ position = \"{at}\", direction = \"{way}\", preload = {{ force = \"200 N\" }} }}\n"
            )
        };
        format!(
            "[[shaft]]\nname = \"{name}\"\n{keys}\nmass = 2\npolar_inertia = 1e-3\ntransverse_inertia = 3e-3\n"
        ) + &bearing("left", "-40 mm", "+x")
            + &bearing("right", "40 mm", "-x")
    };
    format!(
        "{}{}[[mesh]]\nname = \"mesh\"\nnormal_module = \"2 mm\"\ngears = [\n\
         {{ shaft = \"fast\", position = \"-5 mm\", teeth = 20, face_width = \"20 mm\" }},\n\
         {{ shaft = \"slow\", position = 0, teeth = 40, face_width = \"20 mm\" }}]\n\
         [load]\nduration = \"2 ms\"\noutput_interval = \"100 us\"\n",
        shaft("fast", "speed = \"600 rpm\""),
        shaft("slow", &format!("origin = [0, 0, \"60 mm\"]\ntorque = {torque}")),
    )
}

#[test]
fn invariant_a_package_of_several_shafts_makes_the_steps_of_the_native_system() {
    let text = text("[[0, 30], [\"0.31 ms\", 40]]");
    let package = Package::of_system("several-steps", &text);
    let c = package.start();
    let mut native = System::new(&scene(&text)).unwrap();
    assert_eq!(bits(&outputs(&package, c)), bits(&native_outputs(&native)), "start");
    for k in 0..30 {
        run(c, k..k + 1);
        advance(&mut native, k..k + 1);
        assert_eq!(bits(&outputs(&package, c)), bits(&native_outputs(&native)), "step {k}");
    }
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn closed_form_each_shaft_has_its_drive_and_its_outputs_by_its_name() {
    let package = Package::of_system("several-drives", &text("30"));
    let causality = |name: &str| package.rows[package.reference(name) as usize].causality;
    for (input, output) in [("fast.speed", "fast.torque"), ("slow.torque", "slow.speed")] {
        assert_eq!((causality(input), causality(output)), (Causality::Input, Causality::Output), "{input}");
    }
    assert!(!package.rows.iter().any(|row| row.name.starts_with("shaft.")));
    let c = package.start();
    let speed = get(&package, c, "fast.speed");
    assert!((speed - 600.0 * std::f64::consts::TAU / 60.0).abs() < 1e-9 * speed);
    assert!((get(&package, c, "slow.speed") + 0.5 * speed).abs() < 1e-9 * speed);
    // Of 40 teeth of 2 mm: radius 40 mm, pressure angle 20 degrees; the second gear is at +z of the first.
    let force = |c: Component| get(&package, c, "mesh.force.y");
    assert!((force(c) / (30.0 / 0.04) - 1.0).abs() < 1e-6, "{}", force(c));
    // Twice as much, reached over one step: what the teeth do not hold speeds the shaft up, friction of bearings being some N mm.
    set(&package, c, "slow.torque", 60.0);
    let (points, before) = (50, get(&package, c, "slow.speed"));
    let mut impulse = 0.0;
    for k in 0..points {
        let left = force(c);
        run(c, k..k + 1);
        impulse += 0.5 * STEP * (left + force(c));
    }
    let time = f64::from(points) * STEP;
    let gained = 1e-3 * (get(&package, c, "slow.speed") - before);
    let open = 60.0 * time - 0.5 * 30.0 * STEP - 0.04 * impulse - gained;
    assert!(gained.abs() > 0.01 * 60.0 * time && open.abs() < 2e-3 * 60.0 * time, "{open:e} {gained:e}");
    unsafe { fmi2FreeInstance(c) };
}

#[test]
fn invariant_a_state_of_several_shafts_is_replayed_to_the_bit_here_and_elsewhere() {
    let package = Package::of_system("several-replay", &text("30"));
    let c = package.start();
    run(c, 0..10);
    set(&package, c, "slow.torque", 45.0);
    set(&package, c, "fast.speed", 65.0);
    run(c, 10..15);
    replay(&package, c, |c| {
        run(c, 15..20);
        set(&package, c, "slow.torque", -20.0);
        run(c, 20..30);
    });
    unsafe { fmi2FreeInstance(c) };
}
