//! What a package tells its importers: names, dependencies, variables, parameters, its page.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;

use roulement::interface::documentation::page;
use roulement::interface::model_description::{all, identifier, render};
use roulement::interface::variables::{Causality, Variables};
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::system::System;

#[path = "common/scenes.rs"]
mod scenes;

use scenes::scene;

const THRUST: &str = include_str!("../scenes/thrust.toml");
const CAGE: &str = include_str!("../scenes/cage.toml");

fn names(scene: &Scene, causality: Causality) -> Vec<String> {
    let table = Variables::new(scene);
    let rows = table.rows().iter().filter(|row| row.causality == causality);
    rows.map(|row| row.name.clone()).collect()
}

/// Value of a variable of a simulation.
fn value(simulation: &Simulation, name: &str) -> f64 {
    let table = Variables::new(simulation.scene());
    let row = table.rows().iter().find(|row| row.name == name).unwrap();
    table.value(row, simulation.inputs(), simulation.outputs())
}

/// Elements of a name, with their text up to the end of the tag.
fn elements<'a>(xml: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!("<{name} ");
    xml.split(&start).skip(1).map(|rest| rest.split('>').next().unwrap()).collect()
}

#[test]
fn names_are_those_that_were_asked_for_and_identifiers_are_those_of_c() {
    for (name, wanted) in [
        ("front_bearing", "front_bearing"),
        ("7008 C, \u{fc}ber", "_7008_C___ber"),
        ("", "_"),
        ("x-1.2", "x_1_2"),
    ] {
        assert_eq!(identifier(name), wanted, "{name}");
    }
    let simulation = Simulation::new(&Scene::parse(THRUST).unwrap()).unwrap();
    let xml = render(&simulation, "front bearing", &all).unwrap().xml;
    assert!(xml.contains("modelName=\"front bearing\"") && xml.contains("modelIdentifier=\"front_bearing\""));
}

/// How many outputs depend on nothing, how many have no list, and how many there are: after a step and at the start.
fn dependencies(xml: &str) -> [[usize; 3]; 2] {
    let (outputs, initial) = xml.split_once("<InitialUnknowns>").unwrap();
    [outputs.split_once("<Outputs>").unwrap().1, initial].map(|lists| {
        let unknowns = elements(lists, "Unknown");
        let count = |wanted: fn(&str) -> bool| unknowns.iter().filter(|unknown| wanted(unknown)).count();
        let empty = count(|unknown| unknown.contains("dependencies=\"\""));
        [empty, count(|unknown| !unknown.contains("dependencies")), unknowns.len()]
    })
}

#[test]
fn dependencies_are_those_that_the_scene_asks_for() {
    // None at a communication point; the inputs of the step, written out; at the start everything, without lists, but for
    // turn, work and loss.
    let of = |changes: &[(&str, &str)]| {
        dependencies(&render(&Simulation::new(&scene(THRUST, changes)).unwrap(), "thrust", &all).unwrap().xml)
    };
    let [point, start] = of(&[]);
    let all = names(&Scene::parse(THRUST).unwrap(), Causality::Output).len();
    assert_eq!([point, start], [[all, 0, all], [3, all - 3, all]]);
    assert_eq!(of(&[("interface.dependencies", "\"point\"")]), [point, start]);
    assert_eq!(of(&[("interface.dependencies", "\"step\"")]), [[0, 0, all], start]);
    // A shaft counts work, loss and what it gave away, each of its two bearings work, loss and the turn of its inner race.
    let [point, start] = dependencies(&shaft());
    let all = point[2];
    assert_eq!([point, start], [[all, 0, all], [9, all - 9, all]]);
}

/// The model description of a shaft on two bearings.
fn shaft() -> String {
    let text = include_str!("../scenes/shafts/pinion.toml");
    let system = SystemScene::parse(text, None, "".as_ref()).unwrap();
    render(&System::new(&system).unwrap(), "shaft", &all).unwrap().xml
}

/// Values of an attribute, in the order of the text, within the element of a name.
fn attributes<'a>(xml: &'a str, within: &str, attribute: &str) -> Vec<&'a str> {
    let inner = xml.split_once(&format!("<{within}>")).unwrap().1;
    let inner = inner.split_once(&format!("</{within}>")).unwrap().0;
    let start = format!(" {attribute}=\"");
    inner.split(&start).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

#[test]
fn units_and_types_are_defined_where_a_variable_has_them() {
    let mut texts = vec![shaft()];
    for text in [THRUST, CAGE, include_str!("../scenes/effects/stiffness.toml")] {
        texts.push(
            render(&Simulation::new(&Scene::parse(text).unwrap()).unwrap(), "bearing", &all).unwrap().xml,
        );
    }
    for xml in texts {
        let set = |within: &str, attribute: &str| -> BTreeSet<&str> {
            attributes(&xml, within, attribute).into_iter().collect()
        };
        let types = attributes(&xml, "TypeDefinitions", "name");
        assert_eq!(types, attributes(&xml, "TypeDefinitions", "quantity"));
        assert_eq!(types.iter().copied().collect::<BTreeSet<_>>(), set("ModelVariables", "declaredType"));
        // Names of units, and of those that they are shown in.
        let units: BTreeSet<_> =
            set("ModelVariables", "unit").union(&set("ModelVariables", "displayUnit")).copied().collect();
        assert_eq!(set("UnitDefinitions", "name"), units);
        let names = attributes(&xml, "UnitDefinitions", "name");
        assert_eq!(names.len(), units.len(), "{names:?}");
    }
}

#[test]
fn regression_a_model_description_says_nothing_twice() {
    // 173.6 kB with a list of all knowns for each output at the start, with all units, and with what the standard takes anyway.
    let misalignment = include_str!("../scenes/misalignment.toml");
    let xml = render(&Simulation::new(&Scene::parse(misalignment).unwrap()).unwrap(), "misalignment", &all)
        .unwrap()
        .xml;
    assert!(xml.len() < 125_000, "{}", xml.len());
}

#[test]
fn regression_counters_are_local_and_inputs_and_parameters_have_starts() {
    let simulation = Simulation::new(&Scene::parse(CAGE).unwrap()).unwrap();
    let xml = render(&simulation, "cage", &all).unwrap().xml;
    for variable in xml.split("<ScalarVariable ").skip(1) {
        let variable = variable.split("</ScalarVariable>").next().unwrap();
        let is = |causality: &str| variable.contains(&format!("causality=\"{causality}\""));
        assert_eq!(variable.contains("<Integer"), is("local"), "{variable}");
        assert_eq!(variable.contains(" start="), is("input") || is("parameter"), "{variable}");
    }
    assert_eq!(names(simulation.scene(), Causality::Local).len(), 3);
}

#[test]
fn the_speed_of_the_outer_race_is_an_input_where_no_script_says_it() {
    let is_input = |changes: &[(&str, &str)]| {
        names(&scene(THRUST, changes), Causality::Input).contains(&"outer.speed".to_string())
    };
    let hinge =
        [("outer.drive", "\"hinge\""), ("outer.mass", "0.3"), ("outer.inertia", "[3e-4, 2e-4, 2e-4]")];
    assert!(is_input(&[]) && is_input(&hinge) && is_input(&[("outer.drive", "\"pose\"")]));
    assert!(!is_input(&[("load.outer_speed", "[[0.0, 0.0], [0.01, 100.0]]")]));
    let quaternion = [("outer.drive", "\"pose\""), ("interface.orientation", "\"quaternion\"")];
    assert!(!is_input(&quaternion));
}

#[test]
fn invariant_an_outer_speed_from_outside_is_that_of_the_scene() {
    // Given before the start: the same bits. Given later: the same steady state.
    let turning = scene(THRUST, &[("load.outer_speed", "-200.0")]);
    let advance = |simulation: &mut Simulation| {
        for point in 1..=60 {
            simulation.advance(f64::from(point) * 1e-4).unwrap();
        }
        simulation.outputs().cage_speed
    };
    let expected = advance(&mut Simulation::new(&turning).unwrap());
    for before_the_start in [true, false] {
        let mut simulation = Simulation::new(&Scene::parse(THRUST).unwrap()).unwrap();
        let mut inputs = *simulation.inputs();
        inputs.outer.speed = -200.0;
        simulation.set_inputs(inputs);
        if before_the_start {
            simulation.initialise().unwrap();
        }
        let got = advance(&mut simulation);
        let tolerance = if before_the_start { 1e-9 } else { 1e-2 };
        assert!((got / expected - 1.0).abs() < tolerance, "{before_the_start} {got} {expected}");
        let spin = simulation.outputs().outer.twist.angular_velocity.x;
        assert!((spin + 200.0).abs() < 1e-9, "{spin}");
    }
}

#[test]
fn invariant_a_hinge_that_is_moved_from_outside_carries_the_bearing_along() {
    let hinge =
        [("outer.drive", "\"hinge\""), ("outer.mass", "0.3"), ("outer.inertia", "[3e-4, 2e-4, 2e-4]")];
    let scripted = [&hinge[..], &[("outer.misalignment", "{ ry = 2e-4, rz = -1e-4 }")]].concat();
    let inputs = names(&scene(THRUST, &hinge), Causality::Input);
    for name in ["outer.frame.position.x", "outer.frame.position.z", "outer.frame.rotation.y"] {
        assert!(inputs.contains(&name.to_string()), "{name}");
    }
    assert!(
        !names(&Scene::parse(THRUST).unwrap(), Causality::Input).iter().any(|name| name.contains("frame"))
    );
    let run = |changes: &[(&str, &str)], tilt: [f64; 2], offset: f64, before_the_start: bool| {
        let mut simulation = Simulation::new(&scene(THRUST, changes)).unwrap();
        let mut inputs = *simulation.inputs();
        inputs.outer.frame.tilt = [0.0, tilt[0], tilt[1]].into();
        inputs.outer.frame.position.x = offset;
        simulation.set_inputs(inputs);
        if before_the_start {
            simulation.initialise().unwrap();
        }
        for point in 1..=100 {
            simulation.advance(f64::from(point) * 1e-4).unwrap();
        }
        simulation.outputs().clone()
    };
    let misaligned = run(&scripted, [0.0; 2], 0.0, false);
    for before_the_start in [true, false] {
        // Tilted by its hinge, the race is as if the scene had misaligned it; moved along the axis, it takes all along.
        let moved = run(&hinge, [2e-4, -1e-4], 1e-5, before_the_start);
        let (one, other) = (&moved.outer.pose, &misaligned.outer.pose);
        let axes = [one, other].map(|pose| pose.orientation * nalgebra::Vector3::x());
        assert!((axes[0] - axes[1]).norm() < 1e-8, "{before_the_start}");
        assert!((one.position.x - 1e-5).abs() < 1e-9, "{}", one.position);
        if !before_the_start {
            // The inner race still swings on the bearing.
            continue;
        }
        let way = moved.inner.pose.position.x - misaligned.inner.pose.position.x;
        assert!((way / 1e-5 - 1.0).abs() < 0.05, "{before_the_start} {way}");
        assert!((moved.outer.wrench.force.x / misaligned.outer.wrench.force.x - 1.0).abs() < 0.02);
    }
}

#[test]
fn numbers_of_the_cage_and_of_a_hinged_race_are_parameters() {
    let cage = names(&Scene::parse(CAGE).unwrap(), Causality::Parameter);
    for key in [
        "mass",
        "inertia.x",
        "inertia.z",
        "pocket_clearance",
        "guidance_clearance",
        "land_diameter",
        "land_width",
    ] {
        assert!(cage.contains(&format!("cage.{key}")), "{key} {cage:?}");
    }
    let hinge =
        [("outer.drive", "\"hinge\""), ("outer.mass", "0.3"), ("outer.inertia", "[3e-4, 2e-4, 2e-4]")];
    let hinged = names(&scene(THRUST, &hinge), Causality::Parameter);
    assert!(["outer.mass", "outer.inertia.y"].iter().all(|key| hinged.contains(&(*key).to_string())));
    assert!(
        !names(&Scene::parse(THRUST).unwrap(), Causality::Parameter)
            .iter()
            .any(|key| key.starts_with("cage."))
    );
    // Each is the number of the scene that it is named after.
    let text = CAGE.to_string();
    let mut changed = Scene::parse(&text).unwrap();
    changed.set_number("cage.land_width", 1.25e-3);
    changed.set_number("cage.inertia.y", 7e-6);
    let section = changed.effects.cage.section.unwrap();
    assert_eq!((section.land_width.unwrap().0, section.inertia[1].0), (1.25e-3, 7e-6));
}

#[test]
fn closed_form_totals_of_the_balls_are_those_of_every_ball() {
    let text = scene(CAGE, &[("effects.heathcote_slip", "true"), ("effects.per_ball_outputs", "true")]);
    let mut simulation = Simulation::new(&text).unwrap();
    for point in 1..=20 {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(f64::from(point) * 1e-4).unwrap();
    }
    let balls = simulation.outputs().balls.len();
    let every = |quantity: &str| -> Vec<f64> {
        let of = |j: usize| value(&simulation, &format!("ball[{j}].{quantity}"));
        (1..=balls).map(of).collect()
    };
    let (inner, outer) = (every("inner.load"), every("outer.load"));
    let loads = || inner.iter().chain(&outer).copied();
    let get = |name: &str| value(&simulation, name);
    assert_eq!(get("balls.largest_load"), loads().fold(0.0, f64::max));
    assert_eq!(get("balls.smallest_load"), loads().fold(f64::INFINITY, f64::min));
    let loaded = inner.iter().zip(&outer).filter(|(i, o)| **i > 0.0 && **o > 0.0).count();
    assert_eq!(get("balls.loaded"), loaded as f64);
    let pressures = [every("inner.peak_pressure"), every("outer.peak_pressure")].concat();
    assert_eq!(get("balls.largest_pressure"), pressures.into_iter().fold(0.0, f64::max));
    // Powers by kind: of the races and the cage all of it, by translation, spin and groove that of the races.
    let sum = |values: Vec<f64>| values.into_iter().sum::<f64>();
    let close = |one: f64, other: f64| (one - other).abs() < 1e-12 * get("friction_power");
    assert!(close(get("power.inner"), sum(every("inner.power"))));
    assert!(close(get("power.outer"), sum(every("outer.power"))));
    assert!(close(get("power.inner") + get("power.outer") + get("cage.power"), get("friction_power")));
    // Spin moment times relative angular velocity about the normal; the rest is slip in x and y.
    let mut translation = 0.0;
    for ball in &simulation.outputs().balls {
        for (contact, race) in
            [(&ball.inner, &simulation.outputs().inner), (&ball.outer, &simulation.outputs().outer)]
        {
            let slips = [contact.creepage_longitudinal, contact.creepage_lateral];
            let forces = [-contact.force_longitudinal, -contact.force_lateral];
            // The rolling speed of the contact, from spin power and moment.
            if contact.spin_power != 0.0 {
                let spin = contact.spin_power / -contact.spin_moment;
                let speed = spin / contact.creepage_spin;
                assert!(speed > 0.1 && speed < 60.0, "{speed} {race:?}");
                translation += (slips[0] * forces[0] + slips[1] * forces[1]) * speed;
            }
        }
    }
    let races = get("power.inner") + get("power.outer");
    let parts = translation + get("power.spin") + get("power.groove");
    assert!((parts - races).abs() < 1e-9 * races, "{parts} {races}");
    assert!(get("power.spin") > 0.0 && get("power.groove") != 0.0);
}

#[test]
fn the_page_says_how_orientations_are_written() {
    for (form, wanted) in
        [("shaft", "spins about that axis"), ("quaternion", "unit quaternions"), ("cardan", "tilts by y")]
    {
        let form = format!("\"{form}\"");
        assert!(page(&scene(THRUST, &[("interface.orientation", &form)]), &all).contains(wanted), "{form}");
    }
    assert!(page(&Scene::parse(THRUST).unwrap(), &all).contains("inner.rotation_rate.y"));
}

#[test]
fn the_page_says_what_dependencies_are_about() {
    for (meaning, wanted) in
        [("point", "none follows an input before the next step"), ("step", "these derivatives")]
    {
        let meaning = format!("\"{meaning}\"");
        assert!(
            page(&scene(THRUST, &[("interface.dependencies", &meaning)]), &all).contains(wanted),
            "{meaning}"
        );
    }
}

#[test]
fn the_recommended_step_holds_a_shaft_that_moves_by_leapfrog() {
    let step = |changes: &[(&str, &str)]| -> f64 {
        let xml = render(&Simulation::new(&scene(THRUST, changes)).unwrap(), "thrust", &all).unwrap().xml;
        let step = xml.split("stepSize=\"").nth(1).unwrap();
        step.split('"').next().unwrap().parse().unwrap()
    };
    // The 0.2 kg of the scene on about 2e8 N/m; 1 kg where it gives none.
    let pose = ("inner.drive", "\"pose\"");
    assert_eq!(step(&[pose]), 1e-5);
    assert_eq!(step(&[pose, ("inner.mass", "")]), 2e-5);
    // The passing of the balls asks for less than a heavy shaft allows, or one whose motion is not from outside.
    assert_eq!([step(&[pose, ("inner.mass", "20.0")]), step(&[])], [5e-5; 2]);
}
