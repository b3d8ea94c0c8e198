//! Loads over time on machines: gravity, forces that turn, motions that are given.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use roulement::interface::variables::{Causality, MachineVariables};
use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::{System, Whirl};

use crate::common::{GEARBOX, ROTOR, assert_order_two, forces, held, imbalance, run, scene, stored, system};

/// \[s] how far runs go.
const END: f64 = 1.5e-3;

/// Forces of the bearings at the end of a run, one behind the other.
fn at_end(text: &str) -> Vec<Vector3<f64>> {
    forces(&run(text, END))
}

fn assert_alike(one: &str, other: &str, within: f64) {
    let pairs: Vec<_> = at_end(one).into_iter().zip(at_end(other)).collect();
    let size = pairs.iter().map(|(one, _)| one.norm()).fold(0.0, f64::max);
    for (one, other) in pairs {
        assert!((one - other).norm() <= within * size, "{one} {other}");
    }
}

/// The gearbox shaft under a gravity.
fn under(gravity: &str) -> String {
    GEARBOX.replace("gravity = [0, 0, -9.81]", gravity)
}

/// What acts on all mass is gravity less the acceleration of the frame, whatever way the bearings face.
#[test]
fn identity_gravity_over_time_is_an_acceleration_of_the_frame_against_it() {
    let gravity =
        under("gravity = [[[0, 0], [0.001, 60]], { mean = 10, amplitude = 300, frequency = 400 }, -9.81]");
    let frame = under(
        "gravity = [0, 0, 0]\n[frame]\nacceleration = [[[0, 0], [0.001, -60]], { mean = -10, amplitude = -300, frequency = 400 }, 9.81]",
    );
    assert_alike(&gravity, &frame, 1e-9);
    // It acts: without it the forces are others.
    let without = at_end(&under("gravity = [0, 0, 0]"));
    let with = at_end(&gravity);
    assert!(with.iter().zip(without).any(|(with, without)| (with - without).norm() > 20.0));
}

/// The balance at a time of the script carries the weight of then: that of the shaft by its own scene, that of the balls by theirs.
#[test]
fn closed_form_the_balance_at_a_time_carries_the_weight_of_then() {
    let text = under("gravity = [0, [[0, 0], [0.002, 4000]], 0]");
    let of = |time: f64| {
        let system = System::starting_at(&scene(&text), time).unwrap();
        held(&system).iter().map(|[force, _]| *force).sum::<Vector3<f64>>()
    };
    let change = of(1e-3) - of(0.0);
    let expected = Vector3::new(0.0, -1.8 * 2000.0, 0.0);
    assert!((change - expected).norm() < 1e-5 * expected.norm(), "{change}");
}

#[test]
fn refusal_gravity_out_of_range_names_its_component() {
    let text = under("gravity = [0, [[0, 0], [1, 2e6]], 0]");
    let why = SystemScene::edited(&text).unwrap_err().to_string();
    assert!(why.contains("gravity.y") && why.contains("1000000"), "{why}");
}

/// A force that turns by itself is that of two sines at a named load; one that turns with the shaft is that of a disc's unbalance.
#[test]
fn identity_forces_that_turn_are_those_of_sines_and_of_an_unbalance() {
    let (force, frequency) = (300.0, 250.0);
    let [y, z] = [0.25, 0.0].map(|turn: f64| {
        format!("{{ mean = 0, amplitude = {force}, frequency = {frequency}, phase = {} }}", turn * TAU + 0.4)
    });
    let sines =
        format!("{GEARBOX}\n[[shaft.load]]\nname = \"turns\"\nposition = 0.03\nforce = [0, {y}, {z}]\n");
    let rotating = format!(
        "{GEARBOX}\n[[shaft.rotating]]\nforce = {force}\nspeed = {}\nphase = 0.4\noffset = 0.03\n",
        frequency * TAU
    );
    assert_alike(&rotating, &sines, 1e-9);

    let unbalance = 2e-5;
    let speed = 600.0 / 60.0 * TAU;
    let disc = ROTOR.replacen(
        "position = \"200 mm\"",
        &format!("position = \"200 mm\"\nunbalance = {unbalance}\nunbalance_azimuth = 1"),
        1,
    );
    let of_force = format!("force = {}", unbalance * speed * speed);
    for key in [format!("unbalance = {unbalance}"), of_force] {
        let rotating = format!("{ROTOR}\n[[shaft.rotating]]\n{key}\nphase = 1\noffset = 0.2\n");
        assert_alike(&rotating, &disc, 1e-9);
    }
}

/// Under a torque the turn is a coordinate, and the force follows it.
#[test]
fn identity_an_unbalance_of_a_shaft_under_a_torque_follows_its_turn() {
    let torque = ROTOR.replace("speed = \"600 rpm\"", "torque = 20\nstart_speed = \"6000 rpm\"");
    let unbalance = 2e-5;
    let disc = torque.replacen(
        "position = \"200 mm\"",
        &format!("position = \"200 mm\"\nunbalance = {unbalance}"),
        1,
    );
    let rotating = format!("{torque}\n[[shaft.rotating]]\nunbalance = {unbalance}\noffset = 0.2\n");
    assert_alike(&rotating, &disc, 1e-9);
}

#[test]
fn refusal_forces_that_turn_name_their_keys() {
    for (entry, [key, why]) in [
        ("force = 1\nunbalance = 1e-5", ["shaft.rotating[0]", "exactly one of unbalance and force"]),
        ("force = 1e10", ["shaft.rotating[0].force", "allowed"]),
        ("force = 1\noffset = 20", ["shaft.rotating[0].offset", "allowed"]),
    ] {
        let text = format!("{ROTOR}\n[[shaft.rotating]]\n{entry}\n");
        let said = SystemScene::edited(&text).unwrap_err().to_string();
        assert!(said.contains(key) && said.contains(why), "{said}");
    }
}

/// What a bearing alone is held by names what a machine has instead.
#[test]
fn refusal_a_support_of_the_inner_ring_names_a_bearing_by_its_stiffness() {
    let support = "support = { mass = 0.1, inertia = [1e-4, 1e-4, 1e-4], stiffness = [1e8, 1e8, 1e8, 1e5, 1e5, 1e5], damping = [1e3, 1e3, 1e3, 1, 1, 1] }";
    let text = ROTOR.replacen("[bearing.set]", &format!("[bearing.set]\ninner = {{ {support} }}"), 1);
    let said = SystemScene::edited(&text).unwrap_err().to_string();
    assert!(said.contains("inner.support") && said.contains("[[bearing]] with stiffness"), "{said}");
}

/// What a bearing alone has in its file names what a machine has in its place.
#[test]
fn refusal_keys_of_a_bearing_alone_name_those_of_a_machine() {
    for (key, section, instead) in [
        ("interface", "interface = { orientation = \"cardan\" }", "[bearing.set] interface"),
        ("effects", "effects = { cage = \"ideal\" }", "[bearing.set]"),
    ] {
        let said = SystemScene::edited(&format!("{section}\n{ROTOR}")).unwrap_err().to_string();
        assert!(said.contains(key) && said.contains(instead), "{said}");
    }
    for (key, value, instead) in [
        ("x", "{ displacement = 1e-5 }", "[[shaft.load]]"),
        ("rz", "{ rotation = 1e-4 }", "[[shaft.load]]"),
        ("rotating", "[{ force = 5 }]", "[[shaft.rotating]]"),
        ("outer_speed", "5", "mounting.outer_shaft"),
    ] {
        let text = ROTOR.replace("[load]", &format!("[load]\n{key} = {value}"));
        let said = SystemScene::edited(&text).unwrap_err().to_string();
        assert!(said.contains(&format!("load.{key}")) && said.contains(instead), "{said}");
    }
}

/// A shaft on one bearing, whose motion is given at a point.
fn given(motion: &str) -> String {
    format!(
        r#"[shaft]
speed = 300
mass = 1.2
centre = 0.03
polar_inertia = 6e-4
transverse_inertia = 4e-3
[[shaft.load]]
name = "hold"
position = 0.01
{motion}
[[bearing]]
name = "left"
catalogue = "6206"
mounting = {{ position = 0.01 }}
[bearing.set]
effects = {{ creep = "saturated", heathcote_slip = false }}
[load]
duration = 0.002
output_interval = 0.0002
"#
    )
}

/// With all five directions given, the inner ring goes as that of a bearing alone does whose scene gives them, whatever the mass of the shaft.
#[test]
fn independent_code_a_shaft_whose_motion_is_given_moves_its_bearing_as_one_alone() {
    let motions = [
        ("x", "[[0, 100e-6], [0.001, 110e-6], [0.0015, 105e-6]]"),
        ("y", "{ mean = 5e-6, amplitude = 4e-6, frequency = 500, phase = \"90 deg\" }"),
        ("z", "-3e-6"),
        ("ry", "[[0, 0], [0.0012, 4e-4]]"),
        ("rz", "1e-4"),
    ];
    let of = |some: &[(&str, &str)]| {
        some.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>().join(", ")
    };
    let motion =
        format!("displacement = {{ {} }}\nrotation = {{ {} }}", of(&motions[..3]), of(&motions[3..]));
    let mut shaft = system(&given(&motion));
    let mounted = &shaft.scene().bearings[0].scene;
    let changes = motions.iter().map(|(key, value)| {
        let what = if key.len() == 1 { "displacement" } else { "rotation" };
        (format!("load.{key}.{what}"), value.to_string())
    });
    let changes: Vec<_> = changes.collect();
    let changes = changes.iter().map(|(key, value)| (key.as_str(), value.as_str()));
    let mut alone = Simulation::new(&Scene::edited(&mounted.source, changes).unwrap()).unwrap();
    for time in [0.0, 3e-4, 9e-4, END] {
        if time > 0.0 {
            shaft.advance(time).unwrap();
            alone.advance_scripted(time).unwrap();
        }
        let (one, other) = (&shaft.bearings().next().unwrap().1.outputs().inner, &alone.outputs().inner);
        assert!((one.pose.position - other.pose.position).norm() < 1e-15, "{time}: {one:?} {other:?}");
        assert!(one.pose.orientation.angle_to(&other.pose.orientation) < 1e-7, "{time}: {one:?} {other:?}");
        assert!((one.twist.velocity - other.twist.velocity).norm() < 1e-12, "{time}: {one:?} {other:?}");
        let turning = (one.twist.angular_velocity - other.twist.angular_velocity).norm();
        assert!(turning < 1e-4, "{time}: {one:?} {other:?}");
        // Both start alike; their steps are not the same ones.
        let (size, allowed) = (other.wrench.force.norm(), if time > 0.0 { 2e-3 } else { 1e-10 });
        let apart = (one.wrench.force - other.wrench.force).norm();
        assert!(apart < allowed * size && size > 300.0, "{time}: {one:?} {other:?}");
    }
}

/// What holds a given displacement is the force that makes it: in balance, of a shaft that bends, and in its run.
#[test]
fn identity_what_holds_a_displacement_is_the_force_that_makes_it() {
    let text = |load: &str| ROTOR.replace("force = [0, \"100 N\", 0]", load);
    let mut moved = system(&text("displacement = { y = \"40 um\" }\nforce = [50, 0, 80]"));
    // The bearings hold all of it.
    let force = -held(&moved).iter().map(|[force, _]| force.y).sum::<f64>();
    let pushed = system(&text(&format!("force = [50, {force}, 80]")));
    let way = pushed.outputs().loads[0].displacement.y;
    assert!((way - 40e-6).abs() < 1e-6 * 40e-6, "{way} {force}");
    assert!(force > 20.0, "{force}");
    moved.advance(2e-3).unwrap();
    assert_eq!(moved.outputs().loads[0].displacement.y, 40e-6);
    let holding = moved.outputs().holding[0];
    // Balls have come a tenth of a turn on: the force swings as each enters the load.
    assert!((holding - force).abs() < 0.03 * force, "{holding} {force}");
}

/// A shaft that swings about the point that moves it: work of what holds it is all that comes in, and steps are of second order.
#[test]
fn invariant_energy_and_order_of_a_shaft_that_is_moved() {
    let motion = "displacement = { y = { mean = 0, amplitude = 20e-6, frequency = 300, phase = \"90 deg\" }, x = \"100 um\" }";
    let text = given(motion).replace("position = 0.01\ndisplacement", "position = 0.05\ndisplacement");
    let mut system = system(&text);
    let before = stored(&system);
    system.advance(4e-3).unwrap();
    let [of_shaft, of_bearings] = imbalance(&system, &before);
    assert!(of_shaft < 2e-3 && of_bearings < 1e-2, "{of_shaft} {of_bearings}");
    let expected = 20e-6 * (300.0 * TAU * system.time()).cos();
    assert!((system.outputs().loads[0].displacement.y - expected).abs() < 1e-15);
    let moved = "displacement = { y = [[0, 0], [\"1 ms\", \"30 um\"], [\"2 ms\", 0]] }";
    let rotor = ROTOR.replace("force = [0, \"100 N\", 0]", moved);
    assert_order_two(&rotor, 2e-3, 2e-6, |system| system.outputs().seats[0].displacement);
}

/// What is given does not swing.
#[test]
fn identity_a_shaft_that_is_held_along_its_axis_has_no_axial_mode() {
    let held = GEARBOX.replace("force = [337.8,", "displacement = { x = 0 }\nforce = [0,");
    let axial = |text: &str| {
        let system = system(text);
        let modes = system.modes().unwrap().unwrap();
        let motions = system.motions().unwrap();
        let of_modes = modes.iter().filter(|mode| mode.whirl == Whirl::Axial).count();
        (of_modes, motions.iter().filter(|motion| motion.shape.contains("axial")).count())
    };
    assert_eq!(axial(GEARBOX), (1, 1));
    assert_eq!(axial(&held), (0, 0));
}

#[test]
fn refusal_motions_that_are_given_name_their_keys() {
    let refused = |load: &str| {
        let text = GEARBOX.replace("force = [337.8, -475.0, 1260.5]", load);
        match SystemScene::edited(&text) {
            Err(why) => why.to_string(),
            Ok(scene) => System::new(&scene).map(drop).unwrap_err().to_string(),
        }
    };
    let twice =
        "displacement = { x = 0 }\n[[shaft.load]]\nname = \"end\"\nposition = 0\ndisplacement = { x = 0 }";
    for (load, parts) in [
        ("displacement = { y = 0.2 }", ["shaft.load \"mesh\": displacement.y", "0.1"]),
        ("force = [0, 1, 0]\ndisplacement = { y = 0 }", ["displacement.y", "so is force"]),
        (
            "displacement = { y = { mean = 0, amplitude = 1e-5, frequency = 100 } }",
            ["displacement.y", "begins at rest"],
        ),
        (twice, ["shaft.load \"end\": displacement.x", "take it out"]),
    ] {
        let said = refused(load);
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
    }
}

/// In a package what holds a given motion is an output, and motion and rate are inputs.
#[test]
fn rows_of_a_given_motion_are_inputs_and_what_holds_it_an_output() {
    let machine = Machine::new(&MachineScene::from(scene(&given(
        "displacement = { x = \"100 um\", y = 0 }\nrotation = { rz = 0 }",
    ))))
    .unwrap();
    let table = MachineVariables::new(&machine);
    let row = |name: &str| {
        let reference = table.rows().iter().position(|row| row.name == name).unwrap();
        (table.rows()[reference].causality, table.value(reference, &machine))
    };
    let (causality, force) = row("hold.force.x");
    assert_eq!(causality, Causality::Output);
    let Machine::Shaft(system) = &machine else { unreachable!("a shaft") };
    let bearing = forces(system)[0].x;
    assert!((force + bearing).abs() < 1e-6 * bearing.abs(), "{force} {bearing}");
    assert_eq!(row("hold.moment.z").0, Causality::Output);
    assert_eq!(row("hold.force.z").0, Causality::Input);
    assert_eq!(row("hold.displacement.x"), (Causality::Input, 100e-6));
    for (name, causality) in [
        ("hold.velocity.x", Causality::Input),
        ("hold.displacement.y", Causality::Input),
        ("hold.displacement.z", Causality::Output),
        ("hold.velocity.z", Causality::Output),
        ("hold.tilt.y", Causality::Output),
        ("hold.tilt.z", Causality::Input),
        ("hold.tilt_rate.z", Causality::Input),
    ] {
        assert_eq!(row(name).0, causality, "{name}");
    }
    assert!(
        !table.rows().iter().any(|row| row.name == "hold.tilt_rate.y"),
        "no output has a rate of its tilt"
    );
}

/// A shaft on two bearings, one of them in a housing on a foot, each with a named load.
fn housed(of_shaft: &str, of_housing: &str) -> String {
    format!(
        r#"[shaft]
speed = 300
mass = 1.2
centre = 0.03
polar_inertia = 6e-4
transverse_inertia = 4e-3
[[shaft.load]]
name = "press"
position = 0.03
{of_shaft}
[[housing]]
name = "case"
mass = 3
inertia = [0.01, 0.01, 0.01]
centre = [0.06, 0, 0]
stiffness = [1e8, 1e8, 1e8, 1e6, 1e6, 1e6]
damping = [2e3, 2e3, 2e3, 20, 20, 20]
[[housing.load]]
name = "shaker"
position = [0.06, 0, 0]
{of_housing}
[[bearing]]
name = "left"
catalogue = "6206"
mounting = {{ position = 0 }}
[bearing.set]
effects = {{ creep = "saturated", heathcote_slip = false }}
[[bearing]]
name = "right"
catalogue = "6206"
mounting = {{ position = 0.06, housing = "case", axial = "free" }}
[bearing.set]
effects = {{ creep = "saturated", heathcote_slip = false }}
[load]
duration = 0.002
output_interval = 0.0002
"#
    )
}

/// A housing whose motion is given: its springs and the bearing in it are what the shaker holds, and the place is where it was put.
#[test]
fn identity_what_holds_a_housing_is_what_its_springs_and_its_bearing_take() {
    let all =
        "displacement = { x = 0, y = \"20 um\", z = \"-10 um\" }\nrotation = { rx = 0, ry = 0, rz = 0 }";
    let text = housed("force = [150, 0, -300]", all);
    let mut system = system(&text);
    let check = |system: &System, allowed: f64| {
        let [y, z] = [1, 2].map(|axis| system.outputs().holding[axis]);
        let outer = system.bearings().nth(1).unwrap().1.outputs().outer.wrench.force;
        for (held, spring, bearing) in [(y, 1e8 * 20e-6, outer.y), (z, -1e8 * 10e-6, outer.z)] {
            assert!((held + bearing - spring).abs() < allowed * spring.abs(), "{held} {spring} {bearing}");
        }
        assert!(outer.norm() > 100.0, "{outer}");
    };
    check(&system, 1e-9);
    assert_eq!(system.outputs().holding.len(), 6);
    system.advance(1e-3).unwrap();
    check(&system, 1e-9);
    let place = &system.outputs().housings[0].loads[0];
    assert_eq!(place.displacement, Vector3::new(0.0, 20e-6, -10e-6));
    assert_eq!(place.tilt, Vector3::zeros());
}

/// A housing that is moved is a shaft that is moved the other way: the force of the bearing between both knows nothing else.
#[test]
fn invariant_a_bearing_sees_where_its_races_are_to_each_other() {
    let still = "displacement = { x = 0, y = 0, z = 0 }\nrotation = { ry = 0, rz = 0 }";
    let fixed = "displacement = { x = 0, y = 0, z = 0 }\nrotation = { rx = 0, ry = 0, rz = 0 }";
    let moved = |text: &str, y: &str| text.replace("x = 0, y = 0,", &format!("x = 0, y = \"{y} um\","));
    let force = |text: &str| {
        let system = system(text);
        system.bearings().nth(1).unwrap().1.outputs().inner.wrench.force
    };
    let by_housing = force(&housed(still, &moved(fixed, "-20")));
    let by_shaft = force(&housed(&moved(still, "20"), fixed));
    assert!((by_housing - by_shaft).norm() < 1e-9 * by_shaft.norm(), "{by_housing} {by_shaft}");
    assert!(by_shaft.y < -500.0, "{by_shaft}");
}

/// A housing that is shaken through its foot's place: energy that the shaker puts in is accounted for, and steps are of second order.
#[test]
fn invariant_energy_and_order_of_a_housing_that_is_shaken() {
    let shaken = "displacement = { z = [[0, 0], [\"0.5 ms\", \"15 um\"], [\"1.5 ms\", \"-5 um\"]] }";
    let text = housed("force = [30, 0, -200]", shaken);
    let mut system = system(&text);
    let before = stored(&system);
    system.advance(2e-3).unwrap();
    let [of_shaft, of_bearings] = imbalance(&system, &before);
    assert!(of_shaft < 2e-3 && of_bearings < 1e-2, "{of_shaft} {of_bearings}");
    let energies = &system.outputs().housings[0].energies;
    let left = energies.unaccounted() / (energies.input.abs() + energies.bearings.abs());
    assert!(left.abs() < 2e-3 && energies.input.abs() > 1e-6, "{left} {energies:?}");
    assert_order_two(&text, 1e-3, 2e-6, |system| system.outputs().seats[1].displacement);
}

#[test]
fn refusal_motions_of_a_housing_name_their_keys() {
    for (load, parts) in [
        ("displacement = { y = 0.2 }", ["housing.load \"shaker\": displacement.y", "0.1"]),
        (
            "rotation = { rx = 0 }\nmoment = [3, 0, 0]",
            ["housing.load \"shaker\": rotation.rx", "so is moment"],
        ),
        (
            "displacement = { y = 0 }\n[[housing.load]]\nname = \"end\"\nposition = [0.06, 0, 0]\ndisplacement = { y = 0 }",
            ["housing.load \"end\": displacement.y", "take it out"],
        ),
    ] {
        let why = match SystemScene::edited(&housed("", load)) {
            Err(why) => why.to_string(),
            Ok(scene) => System::new(&scene).map(drop).unwrap_err().to_string(),
        };
        assert!(parts.iter().all(|part| why.contains(part)), "{why}");
    }
}
