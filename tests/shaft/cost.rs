//! Work of machines of many bearings, counted: it grows with their number alone.

use std::fs;
use std::path::Path;

use roulement::simulation::system::System;

use crate::caged::caged;
use crate::common::{system, train};

/// [-] price of a contact with derivatives over one without (docs/decisions/kept-matrices.md).
const TANGENT: f64 = 5.0;

/// As many 6205 in the ground, 20 mm apart, on a shaft of 25 mm that is pulled at in the middle, or on a rigid one.
fn plain(bearings: usize, rigid: bool) -> String {
    let (end, middle) = (20 * bearings, 20 * (bearings / 2));
    let mut text = match rigid {
        true => format!(
            "[shaft]\nspeed = \"600 rpm\"\nmass = {}\npolar_inertia = 1e-3\ntransverse_inertia = {}\ncentre = \"{} mm\"\n",
            0.1 * bearings as f64,
            1e-3 * (bearings as f64).powi(3),
            10 * bearings
        ),
        false => format!(
            "[shaft]\nspeed = \"600 rpm\"\n[[shaft.section]]\nfrom = \"-20 mm\"\nto = \"{end} mm\"\nouter_diameter = \"25 mm\"\n"
        ),
    };
    text += &format!(
        "[[shaft.load]]\nname = \"pull\"\nposition = \"{middle} mm\"\nforce = [0, {}, 0]\n",
        100 * bearings
    );
    for k in 0..bearings {
        let direction = if k % 2 == 0 { "+x" } else { "-x" };
        text += &format!(
            "[[bearing]]\nname = \"b{k}\"\ncatalogue = \"6205\"\n\
             mounting = {{ position = \"{} mm\", direction = \"{direction}\", preload = {{ force = \"100 N\" }} }}\n\
             [bearing.set]\neffects = {{ creep = \"saturated\", heathcote_slip = false }}\n",
            20 * k
        );
    }
    text + "[load]\nduration = \"1 ms\"\noutput_interval = \"100 us\"\n"
}

/// Contacts evaluated per step and bearing from 0.1 to 0.3 ms, those with derivatives at their price.
fn work(text: &str) -> f64 {
    let mut machine = system(text);
    let count = |machine: &System| {
        let of = machine.bearings().map(|(_, bearing)| bearing.state().statistics);
        of.fold([0.0; 2], |[contacts, steps], one| {
            let own = one.contact_values as f64 + TANGENT * one.contact_tangents as f64;
            [contacts + own, steps + one.steps as f64]
        })
    };
    machine.advance(1e-4).unwrap();
    let [before, first] = count(&machine);
    machine.advance(3e-4).unwrap();
    let [after, last] = count(&machine);
    (after - before) / (last - first)
}

#[test]
fn invariant_twenty_bearings_take_no_more_work_each_than_two() {
    let beams = |bearings| plain(bearings, false);
    let rigid = |bearings| plain(bearings, true);
    let caged = |bearings| caged(bearings, "");
    let machines =
        [("beams", [2, 20].map(beams)), ("rigid", [2, 20].map(rigid)), ("caged", [2, 20].map(caged))];
    for (name, texts) in machines {
        let [two, many] = texts.map(|text| work(&text));
        println!("{name}: {two:.1} contacts a step and bearing of two, {many:.1} of twenty");
        assert!(many < 1.1 * two, "{name}: {two} {many}");
    }
}

/// [-] corrections a step of a machine whose matrices are new in every step.
fn corrections(bearings: usize) -> f64 {
    let text = plain(bearings, false)
        .replace("heathcote_slip = false }", "heathcote_slip = false }\nsolver = { matrix_reuse = 0 }");
    let mut machine = system(&text);
    let count = |machine: &System| {
        let (_, first) = machine.bearings().next().unwrap();
        let work = first.state().statistics;
        [work.newton.iterations, work.steps]
    };
    machine.advance(2e-4).unwrap();
    let before = count(&machine);
    machine.advance(1e-3).unwrap();
    let after = count(&machine);
    (after[0] - before[0]) as f64 / (after[1] - before[1]) as f64
}

/// A correction is one of all bearings, as the shaft joins them, and the worst ball of all asks for it: with new matrices the second one of a
/// step comes as often as one of so many independent pairs asks for it.
#[test]
fn closed_form_corrections_of_many_bearings_are_those_of_the_worst() {
    let asked = corrections(2) - 1.0;
    for bearings in [5, 10, 20] {
        let pairs = bearings as f64 / 2.0;
        let (found, foreseen) = (corrections(bearings), 2.0 - (1.0 - asked).powf(pairs));
        println!("{bearings}: {found:.2} corrections a step, foreseen {foreseen:.2}");
        assert!((found - foreseen).abs() < 0.25 && found < 2.05, "{bearings}: {found} {foreseen}");
    }
    assert!(asked > 0.05 && asked < 0.5, "{asked}");
}

#[test]
fn regression_instructions_of_recorded_machines_grow_with_their_bearings() {
    let path = Path::new(roulement_tests::ROOT).join("docs/figures/shaft-cost.csv");
    let record = fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<&str>> = record.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let mut compared = 0;
    for two in rows.iter().filter(|row| row[2] == "2") {
        let many = rows.iter().find(|row| row[..2] == two[..2] && row[2] == "20").unwrap();
        let [two_cost, many_cost] = [two, many].map(|row| row[4].parse::<f64>().unwrap());
        assert!(many_cost < 1.1 * two_cost, "{} {}: {two_cost} {many_cost}", two[0], two[1]);
        compared += 1;
    }
    assert_eq!(compared, 4);
}

#[test]
fn invariant_bearings_of_a_train_of_nine_meshes_take_hardly_more_work_each_than_of_one() {
    let [one, nine] = [2, 10].map(|shafts| work(&train(shafts)));
    println!("{one:.1} contacts a step and bearing with one mesh, {nine:.1} with nine");
    // A second correction is asked for by the worst of all: of 20 bearings a tenth more often than of 4.
    assert!(nine < 1.2 * one, "{one} {nine}");
}

#[test]
fn regression_instructions_of_recorded_trains_grow_with_their_meshes() {
    let path = Path::new(roulement_tests::ROOT).join("docs/figures/mesh-cost.csv");
    let record = fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<f64>> = record
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|number| number.parse().unwrap()).collect())
        .collect();
    let [four, ten, twenty] = &rows[..] else { panic!("{record}") };
    assert_eq!([four, ten, twenty].map(|row| row[1]), [4.0, 10.0, 20.0]);
    // Of shafts by themselves, and of trains: from ten bearings on each takes as much. Of four each takes less.
    for column in [2, 3] {
        let [few, some, many] = [four, ten, twenty].map(|row| row[column] / row[1]);
        assert!(many < 1.1 * some && many < 1.5 * few, "{few} {some} {many}");
    }
    let [few, many] = [four, twenty].map(|row| (row[3] - row[2]) / row[0]);
    assert!(many < 2.0 * few, "{few} {many} thousand instructions a mesh");
}
