//! `effects.auto`: effects that a scene asks to be found out.

use roulement::Simulation;
use roulement::analysis::{auto, estimate};
use roulement::model::Model;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::System;

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const CAGE: &str = include_str!("../../scenes/cage.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");

/// Changes of a scene.
type Changes<'a> = &'a [(&'a str, &'a str)];

/// Which effects are found out in a scene with these changes, and its text.
fn found_out(text: &str, changes: Changes) -> (Scene, Vec<String>) {
    let asked = scene(text, changes);
    assert!(asked.effects.auto.on);
    let (resolved, notes) = auto::resolve(asked.clone()).unwrap();
    assert!(!resolved.effects.auto.on);
    // The text says the same, so that a package has it.
    let again = Scene::parse(&resolved.source).unwrap();
    let settings =
        |scene: &Scene| scene.effects.each().iter().map(|effect| effect.setting()).collect::<Vec<_>>();
    assert_eq!(settings(&again), settings(&resolved));
    // Simulations do it by themselves.
    assert_eq!(settings(Simulation::new(&asked).unwrap().scene()), settings(&resolved));
    // Once: nothing is left to be done.
    assert_eq!(auto::resolve(resolved.clone()).unwrap().1, Vec::<String>::new());
    (resolved, notes)
}

fn model(text: &str, changes: Changes) -> Model {
    Model::new(&scene(text, changes)).unwrap()
}

/// \[W] mean power that is lost in the second half of 20 ms.
fn power(scene: &Scene) -> f64 {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut lost = |end: f64| {
        simulation.advance_scripted(end).unwrap();
        simulation.outputs().dissipated
    };
    let half = lost(0.01);
    (lost(0.02) - half) / 0.01
}

#[test]
fn regression_an_effect_that_matters_later_in_the_script_stays_on() {
    // Little slip of grooves under a light radial load beside thrust, most of the power under a heavy one: it was switched off, by the
    // start alone.
    let auto = ("effects", "\"auto\"");
    let [thrust, end] = [("load.x", "{ force = 300 }"), ("load.duration", "\"20 ms\"")];
    let light = [auto, thrust, end, ("load.y.force", "100")];
    assert!(!found_out(RADIAL, &light).0.effects.groove_slip.on);
    let many: Vec<String> = (0..200)
        .map(|row| format!("[{}, {}]", 1e-4 * f64::from(row), if row == 173 { 8000 } else { 100 }))
        .collect();
    let many = format!("[{}]", many.join(", "));
    for (load, at) in [
        ("[[0, 100], [\"5 ms\", 100], [\"10 ms\", 8000]]", "at 10.0 ms"),
        ("{ step = [\"100 N\", \"8 kN\"], at = \"12 ms\" }", "at 12"),
        (
            "{ mean = \"4.05 kN\", amplitude = \"3.95 kN\", frequency = \"100 Hz\", phase = \"-90 deg\" }",
            " ms",
        ),
        (many.as_str(), "at 17.3 ms"),
    ] {
        let (found, notes) = found_out(RADIAL, &[auto, thrust, end, ("load.y.force", load)]);
        assert!(found.effects.groove_slip.on, "{load}: {notes:?}");
        let changes = [("effects.heathcote_slip", "false"), thrust, end, ("load.y.force", load)];
        let verdicts = estimate::verdicts(&scene(RADIAL, &changes), &model(RADIAL, &changes)).unwrap();
        let slip = verdicts.iter().find(|verdict| verdict.subject == "groove slip").unwrap();
        assert!(slip.matters && slip.sentence.contains(at), "{}", slip.sentence);
    }
    // And it does.
    let heavy = ("load.y.force", "[[0, 100], [\"5 ms\", 100], [\"10 ms\", 8000]]");
    let with = power(&found_out(RADIAL, &[auto, thrust, end, heavy]).0);
    let slipless = [("effects.creep", "\"kalker_table\""), ("effects.heathcote_slip", "false")];
    let without = power(&scene(RADIAL, &[slipless[0], slipless[1], thrust, end, heavy]));
    assert!(without < 0.9 * with, "{without} {with}");
}

#[test]
fn regression_groove_slip_stays_on_where_there_is_a_cage() {
    // It is 0.4 % of the power of the balls, and without it all loses 14 % more: it changes how balls push the cage.
    let (found, notes) = found_out(CAGE, &[("effects.auto", "true")]);
    assert!(found.effects.groove_slip.on, "{notes:?}");
    let on = if found.effects.hysteresis.on { "true" } else { "false" };
    let off = scene(CAGE, &[("effects.heathcote_slip", "false"), ("effects.hysteresis", on)]);
    let [with, without] = [power(&found), power(&off)];
    assert!((without / with - 1.0).abs() > 0.05, "{without} {with}");
}

#[test]
fn effects_that_matter_are_switched_on_where_the_data_are_there() {
    let table: Changes = &[("effects", "{ auto = true, creep = \"saturated\" }")];
    // Under a radial load all friction is the slip of grooves.
    let (radial, notes) = found_out(RADIAL, table);
    assert!(radial.effects.groove_slip.on);
    assert!(notes.iter().any(|note| note.starts_with("auto: effects.heathcote_slip = true: ")), "{notes:?}");
    // Under thrust it is next to nothing; hysteresis is not.
    let (thrust, notes) = found_out(THRUST, table);
    assert!(
        !thrust.effects.groove_slip.on
            && thrust.effects.hysteresis.on
            && thrust.effects.each().iter().filter(|e| e.setting().is_some()).count() == 2
    );
    assert!(
        notes[0].starts_with("auto: effects.hysteresis = true: would change torque +")
            && notes[1].ends_with(
                "at hand: waviness, growth by temperature, drag, support, film, rolling resistance"
            ),
        "{notes:?}"
    );
    // The word alone: the default creep law, without the groove slip that comes with it.
    let (thrust, notes) = found_out(THRUST, &[("effects", "\"auto\"")]);
    assert!(
        !thrust.effects.groove_slip.on && thrust.effects.creep.law == roulement::scene::CreepLaw::KalkerTable
    );
    assert!(notes.iter().any(|note| note.starts_with("auto: effects.heathcote_slip = false: ")), "{notes:?}");
    // What the scene says stays.
    let given = "{ auto = true, creep = \"saturated\", heathcote_slip = false }";
    assert!(!found_out(RADIAL, &[("effects", given)]).0.effects.groove_slip.on);
    // Another threshold, of which a tenth is enough: 0.14 % of the torque.
    let strict = "{ auto = true, auto_threshold = 0.01, creep = \"saturated\" }";
    assert!(found_out(THRUST, &[("effects", strict)]).0.effects.groove_slip.on);
    // Rotation where the seat is known.
    let seated = [
        ("effects", "{ auto = true, auto_threshold = 0.01, creep = \"saturated\" }"),
        ("growth.shaft.diameter", "\"30 mm\""),
        ("growth.inner", "20"),
        ("load.inner_speed", "\"20000 rpm\""),
        ("load.x.force", "800"),
    ];
    let (fast, notes) = found_out(THRUST, &seated);
    assert!(fast.effects.growth.section.as_ref().is_some_and(|section| section.rotation), "{notes:?}");
    // Ellipses that are cut are reported.
    let cut = [
        ("inner.shoulder_height", "[1.5e-3, 1.5e-3]"),
        ("load.x.force", "\"4 kN\""),
        ("effects", "{ auto = true, creep = \"saturated\" }"),
    ];
    assert!(found_out(THRUST, &cut).0.effects.shoulder.on);
}

#[test]
fn a_word_that_is_not_auto_is_refused() {
    let refused = |effects: &str| {
        let changes = [("effects", effects)];
        Scene::edited(THRUST, changes).unwrap_err().to_string()
    };
    let message = refused("\"automatic\"");
    for part in ["effects = \"automatic\" is not known", "allowed are auto"] {
        assert!(message.contains(part), "{message}");
    }
    let message = refused("{ auto_threshold = 2 }");
    assert!(message.contains("effects.auto_threshold = 2") && message.contains("(0, 1]"), "{message}");
    assert!(refused("7").contains("effects wants a table of effects or \"auto\""), "{}", refused("7"));
}

#[test]
fn what_an_importer_may_set_is_judged_at_the_corners_of_its_ranges() {
    let importer = |changes: Changes| auto::resolve_for_importer(scene(THRUST, changes)).unwrap();
    let auto = ("effects", "{ auto = true, creep = \"saturated\" }");
    // Nothing is known of what may be set.
    let (constant, notes) = importer(&[auto]);
    assert!(constant.effects.groove_slip.on, "{notes:?}");
    assert!(!found_out(THRUST, &[auto]).0.effects.groove_slip.on);
    // What scripts give is what there is.
    let (within, notes) = importer(&[auto, ("load.x.force", "[[0, 1500], [\"10 ms\", 2000]]")]);
    assert!(!within.effects.groove_slip.on, "{notes:?}");
    // In no instant of the scripts is the radial load large while the thrust is small; they may be set so.
    let together: Changes = &[
        auto,
        ("load.x.force", "[[0, 1500], [\"10 ms\", 6000]]"),
        ("load.y.force", "[[0, 0], [\"10 ms\", 1000]]"),
    ];
    assert!(!found_out(THRUST, together).0.effects.groove_slip.on);
    let (corners, notes) = importer(together);
    assert!(corners.effects.groove_slip.on, "{notes:?}");
    assert!(notes.iter().any(|note| note.contains("at a corner of the ranges")), "{notes:?}");
    // What was found out stands in the text of the package.
    assert_eq!(Scene::parse(&corners.source).unwrap().effects.auto.found, notes);
}

#[test]
fn bearings_of_a_shaft_have_their_effects_found_out_under_what_the_shaft_carries() {
    let text = include_str!("../../scenes/shafts/pinion.toml");
    let asks = "name = \"left\"\nset = { effects.auto = true, effects.damping = \"0.02 s/m\" }";
    let read = |text: &str| SystemScene::parse(text, None, "".as_ref()).unwrap();
    let asked = read(&text.replacen("name = \"left\"", asks, 1));
    assert!(asked.bearings[0].scene.effects.auto.on && !asked.bearings[1].scene.effects.auto.on);
    let (resolved, notes) = auto::resolve_shaft(asked.clone(), false).unwrap();
    // What is said of the effect is what is said of it where nothing is to be found out.
    let plain = read(text);
    let verdicts = estimate::verdicts_of_shaft(&plain).remove(0).unwrap();
    let hysteresis = verdicts.iter().find(|verdict| verdict.subject == "hysteresis").unwrap();
    let told = format!("bearing left: auto: effects.hysteresis = true: {}", hysteresis.sentence);
    assert!(hysteresis.matters && notes.contains(&told), "{notes:?}");
    assert!(
        resolved.bearings[0].scene.effects.hysteresis.on && !resolved.bearings[1].scene.effects.hysteresis.on
    );
    // The text has it, and is asked nothing more; a shaft that is started from what was asked does the same.
    let again = read(&resolved.source);
    assert!(again.bearings[0].scene.effects.hysteresis.on && !again.bearings[0].scene.effects.auto.on);
    let started = System::new(&asked).unwrap();
    let (_, left) = started.bearings().next().unwrap();
    assert!(left.scene().effects.hysteresis.on && !left.scene().effects.auto.found.is_empty());
    // Nothing is known of what an importer sets where no script says it.
    let (unknown, notes) = auto::resolve_shaft(asked, true).unwrap();
    let all = "an importer may set loads and speeds, of which the scene gives no range";
    assert!(notes.iter().any(|note| note.ends_with(all)), "{notes:?}");
    assert!(unknown.bearings[0].scene.effects.groove_slip.on);
}

#[test]
fn ranges_that_a_scene_gives_tell_what_an_importer_may_set() {
    let importer = |changes: Changes| auto::resolve_for_importer(scene(THRUST, changes)).unwrap();
    let auto = ("effects", "{ auto = true, creep = \"saturated\" }");
    // Nothing is scripted, and what is known is a range in which groove slip does not matter.
    let thrust = ("ranges.load.x.force", "[\"1500 N\", \"2 kN\"]");
    let (within, notes) = importer(&[auto, thrust]);
    assert!(!within.effects.groove_slip.on, "{notes:?}");
    // A radial load beside the thrust, at one corner alone.
    let wide: Changes = &[
        auto,
        ("load.y.force", "0.0"),
        ("ranges.load.x.force", "[\"1500 N\", \"6 kN\"]"),
        ("ranges.load.y.force", "[\"0 N\", \"1 kN\"]"),
    ];
    let (corners, notes) = importer(wide);
    assert!(corners.effects.groove_slip.on, "{notes:?}");
    let told = notes.iter().find(|note| note.contains("heathcote_slip = true")).unwrap();
    assert!(told.contains("load.y.force = 1 kN") && told.contains(" %"), "{told}");
    // What was found out stands in the text of the package, with its numbers.
    assert_eq!(Scene::parse(&corners.source).unwrap().effects.auto.found, notes);
    // A run knows what it is asked for.
    assert!(!found_out(THRUST, wide).0.effects.groove_slip.on);
    // Ranges of a temperature and of a speed.
    let warm: Changes = &[
        ("effects", "{ auto = true, creep = \"saturated\" }"),
        ("film", "{ iso_vg = 68, temperature = \"70 degC\" }"),
        ("ranges.film.temperature", "[\"40 degC\", \"120 degC\"]"),
        ("ranges.load.inner_speed", "[\"600 rpm\", \"12000 rpm\"]"),
    ];
    let (_, notes) = importer(warm);
    assert!(!notes.is_empty() && notes.iter().all(|note| !note.contains("gives no range")), "{notes:?}");
}

#[test]
fn ranges_of_keys_and_values_that_no_scene_has_are_refused() {
    let refused = |key: &str, value: &str| Scene::edited(THRUST, [(key, value)]).unwrap_err().to_string();
    for (key, value, parts) in [
        ("ranges.load.x.force", "[\"1 mm\", \"2 kN\"]", &["ranges", "load.x.force", "1 mm", "N"][..]),
        ("ranges.load.x.forse", "[1, 2]", &["ranges", "forse"]),
        ("ranges.load.inner_speed", "[0, 1e9]", &["ranges", "load.inner_speed", "1000000000", "allowed"]),
        ("ranges.load.inner_speed", "\"6000 rpm\"", &["ranges.load.inner_speed", "two ends"]),
        ("ranges.load.inner_speed", "[1, 2, 3]", &["ranges.load.inner_speed", "two ends"]),
        ("ranges.ranges.x", "[1, 2]", &["ranges.ranges"]),
    ] {
        let why = refused(key, value);
        assert!(parts.iter().all(|part| why.contains(part)), "{key} = {value}: {why}");
    }
}

#[test]
fn a_shaft_is_judged_at_the_corners_of_its_ranges() {
    let text = include_str!("../../scenes/shafts/pinion.toml");
    let asks = "name = \"left\"\nset = { effects.auto = true, effects.auto_threshold = 0.23, effects.damping = \"0.02 s/m\" }";
    let ranged = |ranges: &str| text.replacen("name = \"left\"", asks, 1) + ranges;
    let read = |text: &str| SystemScene::parse(text, None, "".as_ref());
    let found = |ranges: &str| auto::resolve_shaft(read(&ranged(ranges)).unwrap(), true).unwrap();
    let (scene, notes) = found("\n[ranges]\nshaft.speed = [\"600 rpm\", \"20000 rpm\"]\n");
    assert!(notes.iter().all(|note| !note.contains("gives no range")), "{notes:?}");
    // At 6000 rpm hysteresis changes the torque by 22 %: it matters where the shaft is slow alone, and that is told.
    let told = notes.iter().find(|note| note.contains("effects.hysteresis = true")).unwrap();
    assert!(told.ends_with("at shaft.speed = 600 rpm") && told.contains("torque +23"), "{told}");
    let (run, notes) = auto::resolve_shaft(read(&ranged("")).unwrap(), false).unwrap();
    assert!(!run.bearings[0].scene.effects.hysteresis.on, "{notes:?}");
    // The text of the package can be read again.
    read(&scene.source).unwrap();
    for (wrong, part) in
        [("shaft.sped = [1, 2]", "sped"), ("shaft.speed = [\"1 N\", \"2 N\"]", "shaft.speed")]
    {
        let why = read(&ranged(&format!("\n[ranges]\n{wrong}\n"))).unwrap_err().to_string();
        assert!(why.contains("ranges") && why.contains(part), "{why}");
    }
}
