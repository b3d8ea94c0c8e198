//! Teeth inside a ring, teeth that vary as they turn, friction between teeth: by hand, against Mathieu's borders, energy.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::common::{LIGHT, MODULE, gear_pair, scene, system};

/// Nothing but their turns moves.
const HEAVY: &str = "mass = 1e6\npolar_inertia = 1e-4\ntransverse_inertia = 1e6";

/// Two gears whose axes are apart along +z: keys of the first shaft, of the second, of the mesh; is the second one a ring; helix angle \[deg], and keys of both shafts.
fn pair(keys: [&str; 3], ring: bool, helix: f64, masses: &str) -> String {
    gear_pair(keys, masses, ring, helix, [1.0, 0.0])
}

#[test]
fn closed_form_forces_of_a_pinion_in_a_ring_of_both_hands_and_directions() {
    for (helix, turns, brakes) in
        [(15.0, 1.0, 1.0), (15.0, -1.0, 1.0), (-15.0, 1.0, -1.0), (-15.0, -1.0, -1.0)]
    {
        // Both turn the same way.
        let torque = -30.0 * turns * brakes;
        let keys = [&format!("speed = \"{} rpm\"", 300.0 * turns), &format!("torque = {torque}"), ""];
        let system = system(&pair([keys[0], keys[1], keys[2]], true, helix, LIGHT));
        let angle = f64::to_radians(helix);
        let radius = 0.5 * MODULE * 60.0 / angle.cos();
        // The ring's axis is at +z of the pinion's, so they touch at -z, where a pinion that turns about +x moves along +y: the ring, which is
        // braked, pushes it back, away from where they touch, and along the axis as any right-hand gear that drives about +x.
        let y = torque / radius;
        let hand = Vector3::new(-y * angle.tan(), y, y.abs() * 20f64.to_radians().tan() / angle.cos());
        let link = &system.outputs().links[0];
        let found = link.state.force.fixed_rows::<3>(0).into_owned();
        assert!((found - hand).norm() < 1e-6 * hand.norm(), "{helix} {turns} {brakes}: {found} {hand}");
        let speeds: Vec<f64> = system.outputs().shafts.iter().map(|shaft| shaft.spin.speed).collect();
        assert!((speeds[1] - speeds[0] / 3.0).abs() < 1e-12 * speeds[0].abs());
        // Moments of the axial force at the pitch radii, both at -z of their axes.
        let [first, second] = link.teeth.tilting_moments;
        let by_hand = [-0.5 * MODULE * 20.0 / angle.cos() * hand.x, radius * hand.x];
        assert!((first.y - by_hand[0]).abs() < 1e-6 * by_hand[0].abs(), "{first} {by_hand:?}");
        assert!((second.y - by_hand[1]).abs() < 1e-6 * by_hand[1].abs(), "{second} {by_hand:?}");
    }
}

#[test]
fn closed_form_misalignment_is_by_how_much_one_shaft_is_tilted_against_the_other_in_the_plane_of_action() {
    for (turns, brakes) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)] {
        let torque = 30.0 * turns * brakes;
        let point = |name: &str| format!("[[shaft.point]]\nname = \"at-{name}\"\nposition = 0\n");
        let one = format!("speed = \"{} rpm\"\n{}", 300.0 * turns, point("one"));
        let two = format!("torque = {torque}\n{}", point("two"));
        let system = system(&pair([&one, &two, ""], false, 20.0, LIGHT));
        let outputs = system.outputs();
        let tilt = outputs.points[0].tilt - outputs.points[1].tilt;
        // A tooth of the first gear at b along x moves by b (ry x -z, rz x y) against the second. The flank that presses faces the way of the force on
        // the second gear: along -y where the pinion drives about +x, as its teeth at +z go there, and towards +z in both cases, away from its axis.
        let working = (20f64.to_radians().tan() / 20f64.to_radians().cos()).atan();
        let along = -(turns * brakes);
        let by_hand = along * working.cos() * tilt.z - working.sin() * tilt.y;
        let found = outputs.links[0].teeth.misalignment;
        assert!(
            tilt.amax() > 1e-6 && (found - by_hand).abs() < 1e-9 * tilt.amax(),
            "{turns} {brakes}: {found:e} {by_hand:e}"
        );
    }
}

#[test]
fn closed_form_a_slow_second_gear_follows_the_transmission_error() {
    // Forty waves in a turn, of which a fifth is seen; the error pushes the braked gear on, which turns about -x.
    let error = "transmission_error = [{ over = \"first\", order = 40, amplitude = \"20 um\", phase = \"90 deg\" }]\n\
                 stiffness = 2e9\ndamping_ratio = 0.2";
    let mut system = system(&pair(["speed = \"60 rpm\"", "torque = 30", error], false, 0.0, HEAVY));
    let base = 0.5 * MODULE * 40.0 * 20f64.to_radians().cos();
    let at = |system: &System| {
        let [one, two] = [0, 1].map(|shaft| system.outputs().shafts[shaft].spin.angle);
        (one, two + 0.5 * one)
    };
    let (at_rest, mut worst) = (at_rest(), 0.0f64);
    for step in 1..=20 {
        system.advance(2e-4 * f64::from(step)).unwrap();
        let (one, behind) = at(&system);
        // Both are given at their start as 0, with the teeth pressed together.
        let error = 20e-6 * (40.0 * one).sin();
        if step > 5 {
            worst = worst.max((behind - at_rest + error / base).abs() * base);
        }
    }
    assert!(worst < 4e-7, "{worst:e} m of 20e-6");
    // No energy is made by what varies.
    let mesh = &system.outputs().links[0].state;
    let worked: f64 =
        system.outputs().shafts.iter().map(|shaft| shaft.energies.turned_over()).fold(0.0, f64::max);
    assert!(mesh.unaccounted().abs() < 1e-3 * worked, "{:e} of {worked:e}", mesh.unaccounted());
}

/// \[rad] turn of the second gear against the first one's at the start, which presses the teeth together by 30 N m.
fn at_rest() -> f64 {
    let keys = ["speed = \"60 rpm\"", "torque = 30", "stiffness = 2e9\ndamping_ratio = 0.2"];
    let still = system(&pair(keys, false, 0.0, HEAVY));
    let [one, two] = [0, 1].map(|shaft| still.outputs().shafts[shaft].spin.angle);
    two + 0.5 * one
}

#[test]
fn closed_form_friction_takes_the_tooth_loss_factor_of_the_power() {
    let of = |mesh: &str| {
        let system = system(&pair(["speed = \"3000 rpm\"", "torque = 30", mesh], false, 20.0, LIGHT));
        let outputs = system.outputs();
        (outputs.shafts[0].torque, outputs.shafts[0].spin.speed, outputs.links[0].clone())
    };
    let (without, speed, _) = of("");
    let (with, _, link) = of("friction = 0.05");
    // ISO 21771 by hand: tips of one module above the reference cylinders, no profile shift.
    let helix = 20f64.to_radians();
    let transverse = (20f64.to_radians().tan() / helix.cos()).atan();
    let base_helix = (helix.sin() * 20f64.to_radians().cos()).asin();
    let [one, two] = [20.0, 40.0].map(|teeth| {
        let radius = 0.5 * MODULE * teeth / helix.cos();
        let base = radius * transverse.cos();
        let tip = radius + MODULE;
        let way = (tip * tip - base * base).sqrt() - base * transverse.tan();
        way / (PI * MODULE / helix.cos() * transverse.cos())
    });
    let factor = PI * 3.0 / (40.0 * base_helix.cos()) * (1.0 - one - two + one * one + two * two);
    let base = 0.5 * MODULE * 20.0 / helix.cos() * transverse.cos();
    let through = link.teeth.normal_force.abs() * base_helix.cos() * base * speed;
    let loss = 0.05 * factor * through;
    assert!((link.teeth.friction_power / loss - 1.0).abs() < 1e-6, "{} {loss}", link.teeth.friction_power);
    // The shaft that drives brings it; what the bearings take changes little.
    let brought = (with - without) * speed;
    assert!((brought / loss - 1.0).abs() < 0.02, "{brought} {loss}");
    assert!((loss / (30.0 * 0.5 * speed) - 0.05 * factor).abs() < 0.02 * 0.05 * factor);
}

/// Trace of what a period of the teeth does to a small motion of the second gear, where their stiffness varies by a part: from the
/// difference of two runs, one of which is pushed at the start. `speed` is that of the first gear [rad/s].
fn of_a_period(speed: f64, part: f64) -> f64 {
    let mesh = format!(
        "stiffness = 2e8\ndamping_ratio = 0\nbacklash = 0\n\
         stiffness_variation = [{{ amplitude = {part}, phase = \"90 deg\" }}]"
    );
    // So large that the balls, which go round with the shaft, add nothing to it.
    let heavy = HEAVY.replace("1e-4", "1e-2");
    let run = |torque: &str| system(&pair([&format!("speed = {speed}"), torque, &mesh], false, 0.0, &heavy));
    let pushed = "torque = [[0, 30], [\"1 us\", 33], [\"0.2 ms\", 33], [\"0.201 ms\", 30], [1, 30]]";
    let mut both = [run("torque = 30"), run(pushed)];
    let period = TAU / (20.0 * speed);
    let apart: Vec<f64> = (1..=9)
        .map(|count| {
            let [one, other] = both.each_mut().map(|system| {
                system.advance(period * f64::from(count)).unwrap();
                assert!(system.outputs().links[0].teeth.normal_force != 0.0, "the teeth came apart");
                system.outputs().shafts[1].spin.angle
            });
            one - other
        })
        .collect();
    // x[n+1] + x[n-1] = trace x[n] where nothing damps (Floquet), by least squares.
    let [above, below] = apart
        .windows(3)
        .fold([0.0; 2], |[above, below], x| [above + x[1] * (x[0] + x[2]), below + x[1] * x[1]]);
    above / below
}

/// Trace of what a period does to `x'' + w^2 (1 + p sin W t) x = 0`, by 4000 steps of Runge and Kutta.
fn of_mathieu(natural: f64, part: f64, frequency: f64) -> f64 {
    let h = TAU / frequency / 4000.0;
    let rate = |t: f64, [x, v]: [f64; 2]| [v, -natural * natural * (1.0 + part * (frequency * t).sin()) * x];
    let moved = |x: [f64; 2], by: [f64; 2], h: f64| [x[0] + h * by[0], x[1] + h * by[1]];
    let over = |start: [f64; 2]| {
        (0..4000).fold(start, |x, step| {
            let t = h * f64::from(step);
            let one = rate(t, x);
            let two = rate(t + 0.5 * h, moved(x, one, 0.5 * h));
            let three = rate(t + 0.5 * h, moved(x, two, 0.5 * h));
            let four = rate(t + h, moved(x, three, h));
            [0, 1].map(|k| x[k] + h / 6.0 * (one[k] + 2.0 * two[k] + 2.0 * three[k] + four[k]))
        })
    };
    over([1.0, 0.0])[0] + over([0.0, 1.0])[1]
}

#[test]
fn independent_teeth_that_vary_grow_between_the_borders_of_mathieu_and_nowhere_else() {
    // The small motion of one inertia: it grows where the trace is beyond 2, between W = 2 w (1 - p/4) and 2 w (1 + p/4).
    let natural = 0.5 * MODULE * 40.0 * 20f64.to_radians().cos() * (2e8f64 / 1e-2).sqrt();
    let part = 0.2;
    for (off, grows) in [(0.0, true), (0.6, true), (-0.6, true), (1.6, false), (-1.6, false)] {
        let frequency = 2.0 * natural * (1.0 + 0.25 * part * off);
        let exact = of_mathieu(natural, part, frequency);
        let trace = of_a_period(frequency / 20.0, part);
        assert_eq!(exact.abs() > 2.0, grows, "{off}: {exact}");
        assert_eq!(trace.abs() > 2.0, grows, "{off}: {trace} {exact}");
        assert!((trace - exact).abs() < 1e-3, "{off}: {trace} {exact}");
    }
}

#[test]
fn hard_case_a_tooth_that_is_missing_makes_no_energy_and_goes_on_from_a_saved_state() {
    let mut values = vec!["0"; 80];
    for (place, value) in [(9, "-0.4"), (10, "-0.9"), (11, "-0.9"), (12, "-0.4")] {
        values[place] = value;
    }
    let mesh = format!(
        "transmission_error = [{{ amplitude = \"2 um\" }}]\nfriction = 0.05\n\
         stiffness_variation = [{{ over = \"first\", values = [{}] }}]",
        values.join(", ")
    );
    let text = pair(["speed = \"6000 rpm\"", "torque = 30", &mesh], false, 15.0, LIGHT);
    let mut one = system(&text);
    let (mut least, mut most, mut saved) = (f64::INFINITY, 0.0f64, None);
    for step in 1..=40 {
        one.advance(5e-5 * f64::from(step)).unwrap();
        let force = one.outputs().links[0].teeth.normal_force.abs();
        (least, most) = (least.min(force), most.max(force));
        if step == 20 {
            saved = Some(one.snapshot());
        }
    }
    let outputs = one.outputs();
    let mesh = &outputs.links[0].state;
    let worked: f64 = outputs.shafts.iter().map(|shaft| shaft.energies.turned_over()).fold(0.0, f64::max);
    assert!(mesh.unaccounted().abs() < 1e-2 * worked, "{:e} of {worked:e}", mesh.unaccounted());
    assert!(least < 0.5 * most && most > 800.0, "{least} {most}");
    let mut other = system(&text);
    assert!(other.restore(&saved.unwrap()));
    (21..=40).for_each(|step| other.advance(5e-5 * f64::from(step)).unwrap());
    assert_eq!(one.outputs(), other.outputs());
}

#[test]
fn regression_a_column_of_a_file_is_what_stands_in_the_scene() {
    let folder = std::env::temp_dir().join(format!("roulement-teeth-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("te.csv"), "turn [-],error [um]\n0,1\n0.25,0\n0.5,-1\n0.75,0\n").unwrap();
    let keys = |values: &str| {
        let mesh = format!("transmission_error = [{{ over = \"second\", values = {values} }}]");
        pair(["speed = \"300 rpm\"", "torque = 30", &mesh], false, 0.0, LIGHT)
    };
    let read = |values: &str| SystemScene::parse(&keys(values), None, &folder);
    let values = |scene: SystemScene| -> Vec<f64> {
        let of = &scene.meshes[0].section.transmission_error[0];
        of.values.iter().flatten().map(|value| value.0).collect()
    };
    let found = values(read("{ file = \"te.csv\", column = \"error [um]\" }").unwrap());
    assert_eq!(found, values(scene(&keys("[\"1 um\", \"0 um\", \"-1 um\", \"0 um\"]"))));
    for (wrong, told) in [
        ("{ file = \"no.csv\", column = \"error [um]\" }", "cannot read"),
        (
            "{ file = \"te.csv\", column = \"error [mm]\" }",
            "there is no column \"error [mm]\"; it has turn [-], error [um]",
        ),
        ("{ file = \"te.csv\", column = \"error [um]\", scale = 2 }", "a column has no key scale"),
        ("[\"1 um\", \"0 um\"]", "number of points"),
    ] {
        let why = read(wrong).unwrap_err().to_string();
        assert!(why.contains(told) && why.contains("transmission_error"), "{why}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn regression_teeth_that_cannot_be_are_refused_with_the_key() {
    for (mesh, told) in [
        (
            "stiffness_variation = [{ amplitude = 0.95 }, { order = 2, amplitude = 0.95 }]",
            "the stiffness comes down to",
        ),
        (
            "stiffness_variation = [{ over = \"second\", values = [0, 0, -0.9, 0, 0, 0, 0, 0] }, { over = \"first\", amplitude = 0.5 }]",
            "the stiffness comes down to",
        ),
        ("stiffness_variation = [{ order = 2 }]", "it needs amplitude"),
        ("transmission_error = [{ amplitude = 1e-6, values = [0, 0, 0, 0] }]", "one entry for each"),
        ("friction = -0.1", "mesh.friction"),
    ] {
        let text = pair(["speed = 30", "torque = 30", mesh], false, 0.0, LIGHT);
        let why = SystemScene::parse(&text, None, std::path::Path::new("")).unwrap_err().to_string();
        assert!(why.contains("mesh") && why.contains(told), "{why}");
    }
    let small = pair(["speed = 30", "torque = 30", ""], true, 0.0, LIGHT).replace("teeth = 60", "teeth = 18");
    let why = SystemScene::parse(&small, None, std::path::Path::new("")).unwrap_err().to_string();
    assert!(why.contains("mesh.gears.inside"), "{why}");
}
