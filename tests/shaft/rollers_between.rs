//! Rollers between two shafts, both of which turn.

use nalgebra::Vector3;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::{MachineEquilibrium, System};

use crate::common::{run, scene, system};

/// A journal in two 6308, and a gear on it on needles and on cylindrical rollers, whose ribs hold it along the axis.
const IDLER: &str = include_str!("../../scenes/shafts/idler.toml");

/// The same at these speeds of the journal and of the gear.
fn idler(journal: &str, gear: &str) -> String {
    IDLER.replace("1500 rpm", journal).replace("-700 rpm", gear)
}

/// Links of a system by their names.
fn link<'a>(system: &'a System, name: &str) -> &'a roulement::simulation::system::LinkOutputs {
    let place = system.scene().link_names().position(|own| own == name).unwrap();
    &system.outputs().links[place]
}

/// Force on the journal of a bearing.
fn on_journal(system: &System, name: &str) -> Vector3<f64> {
    link(system, name).state.force.fixed_rows::<3>(0).into_owned()
}

#[test]
fn closed_form_rollers_between_two_shafts_carry_the_load_of_the_outer_one() {
    let system = system(&idler("1500 rpm", "-700 rpm"));
    let [needles, rib] = ["needles", "rib"].map(|name| on_journal(&system, name));
    let load = Vector3::new(0.0, 6000.0, -2400.0);
    assert!((needles + rib - load).norm() < 1e-6 * load.norm(), "{needles} {rib}");
    // Moments about the middle of the needles: 4 mm of the load, 30 mm of the other row, and what rows carry by their tilt.
    let tilting =
        ["needles", "rib"].map(|name| link(&system, name).state.force.fixed_rows::<3>(3).into_owned());
    let arm = |x: f64, force: Vector3<f64>| Vector3::new(x, 0.0, 0.0).cross(&force);
    let mut moment = arm(0.03, rib) + tilting[0] + tilting[1] - arm(0.004, load);
    moment.x = 0.0;
    assert!(moment.norm() < 1e-5 * 0.004 * load.norm(), "{moment}");
}

#[test]
fn closed_form_a_cage_that_stands_lets_no_roller_pass() {
    // Both rows have one ratio k, and a coupling holds the gear along the axis.
    let rows = |gear: f64| {
        idler("3000 rpm", &format!("{gear} rpm")).replace("NUP 206", "K 30x35x27").replace(
            "[load]",
            "[[coupling]]\nname = \"slide\"\nshafts = [\"journal\", \"gear\"]\nposition = 0\nstiffness = { axial = \"50 N/um\" }\n\n[load]",
        )
    };
    let ratio =
        scene(&rows(0.0)).springs.iter().find_map(|spring| Some(spring.rollers.as_ref()?.ratio())).unwrap();
    // How far the largest load of a roller goes up and down.
    let swing = |gear: f64| {
        let mut system = system(&rows(gear));
        let loads = (1..=40).map(|step| {
            system.advance(f64::from(step) * 25e-6).unwrap();
            link(&system, "needles").rollers().unwrap().largest_load
        });
        let [low, high] = loads.fold([f64::MAX, 0.0], |[low, high], load| [load.min(low), load.max(high)]);
        (high - low) / high
    };
    // The cage turns by k w_i + (1 - k) w_o.
    let (stands, turns) = (swing(-3000.0 * ratio / (1.0 - ratio)), swing(3000.0));
    println!("{ratio} {stands:e} {turns:e}");
    // What is left is that of the balls that hold the journal, which pass in both.
    assert!(stands < 0.05 * turns, "{stands:e} {turns:e}");
}

#[test]
fn invariant_energy_is_kept_where_both_rings_turn() {
    for [journal, gear] in [["2000 rpm", "-3000 rpm"], ["0 rpm", "3000 rpm"], ["3000 rpm", "3000 rpm"]] {
        let system = run(&idler(journal, gear), 2e-3);
        for name in ["needles", "rib"] {
            let state = &link(&system, name).state;
            let turned = state.taken.abs().max(state.stored);
            assert!(
                state.unaccounted().abs() < 1e-4 * turned,
                "{name}: {:e} of {turned:e}",
                state.unaccounted()
            );
        }
    }
}

#[test]
fn closed_form_life_goes_by_which_ring_the_load_goes_around() {
    let at = |journal: f64, gear: f64| {
        let system = system(&idler(&format!("{journal} rpm"), &format!("{gear} rpm")));
        let own = link(&system, "needles");
        let (life, hours) = (own.rollers().unwrap().life, own.hours());
        if let Some(hours) = hours {
            let turns = (journal - gear).abs() * 60.0 * hours;
            assert!((turns / (life * 1e6) - 1.0).abs() < 1e-9, "{journal} {gear}: {turns:e} {life}");
        }
        (life, hours)
    };
    // The mean over the rollers is by the power 4 on a ring that the load goes around, and by 4.5 where it stands still. Of a fifth of the rollers loaded alike
    // the first is f^(1/4 - 1/4.5) = 4.5 % less: lives differ by its fourth power at most, 1.2.
    let (inner, outer, both) = (at(1500.0, 0.0).0, at(0.0, -1500.0).0, at(1000.0, -500.0).0);
    println!("{inner} {outer} {both}");
    assert!(outer < inner && inner < both && both < 1.2 * inner, "{inner} {outer} {both}");
    // Nothing rolls where both turn alike.
    assert_eq!(at(1500.0, 1500.0).1, None);
}

#[test]
fn invariant_a_package_of_rollers_between_shafts_is_the_scene() {
    let whole = scene(&idler("1500 rpm", "-700 rpm"));
    let again = SystemScene::of_package(&whole.source).unwrap();
    assert_eq!(again.source, whole.source);
    let mut first = System::new(&whole).unwrap();
    first.advance(0.2e-3).unwrap();
    let saved = first.snapshot();
    first.advance(0.5e-3).unwrap();
    let mut second = System::new(&again).unwrap();
    assert!(second.restore(&saved));
    second.advance(0.5e-3).unwrap();
    assert_eq!(first.outputs(), second.outputs());
    let found = MachineEquilibrium::of(&whole, 0.0, 100.0).unwrap();
    let of = found.to_json()["bearings_by_stiffness"]["needles"].clone();
    let rolled = of["L10r_hours"].as_f64().unwrap() * 2200.0 * 60.0 / 1e6;
    assert!((rolled / of["L10r"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{of}");
}

#[test]
fn refusals_of_bearings_between_shafts_name_the_key() {
    let refuse = |from: &str, to: &str| {
        let text = idler("1500 rpm", "-700 rpm");
        assert!(text.contains(from));
        SystemScene::parse(&text.replace(from, to), None, std::path::Path::new("")).unwrap_err().to_string()
    };
    let own = "position = 0, outer_shaft = \"gear\"";
    for (to, parts) in [
        (
            "position = 0, outer_shaft = \"gears\"",
            ["bearing.mounting.outer_shaft = \"gears\"", "journal, gear"],
        ),
        (
            "position = 0, outer_shaft = \"journal\"",
            ["bearing.mounting.outer_shaft = \"journal\"", "give another one"],
        ),
        (
            "position = 0, outer_shaft = \"gear\", offset = { y = 1e-5 }",
            ["bearing.mounting.outer_shaft", "take housing, axial, misalignment and offset out"],
        ),
    ] {
        let why = refuse(own, to);
        assert!(parts.iter().all(|part| why.contains(part)), "{why}");
    }
    let oiled = "catalogue = \"K 30x35x27\"\nset = { rollers = { film = { iso_vg = 68, temperature = \"70 degC\" } } }";
    let why = refuse("catalogue = \"K 30x35x27\"", oiled);
    assert!(why.contains("bearing.rollers") && why.contains("between two shafts"), "{why}");
    let springs = "stiffness = { radial = 1e8, axial = 1e8 }\nmounting = { position = 0, outer_shaft";
    let why = refuse("catalogue = \"K 30x35x27\"\nmounting = { position = 0, outer_shaft", springs);
    assert!(why.contains("bearing.mounting.outer_shaft") && why.contains("[[coupling]]"), "{why}");
}
