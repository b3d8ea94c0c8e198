//! What steps where nothing is said cost beside the cheapest tolerance that keeps the same promise: means within 1 %, histories but that of
//! the torque within 2 %.

use indicatif::ProgressBar;
use roulement::scene::machine::MachineScene;
use roulement_cli::cost::Choice;
use roulement_cli::cost::regret::{played, regret};

use crate::common::edited;
use crate::random::Random;
use crate::random_machines::machine;

/// Contact evaluations of a run whose reference takes longer than anyone would wait for.
const MOST_WORK: u64 = 4_000_000;
/// Scenes of this project as they are but for their steps, with what is changed.
fn scenes() -> Vec<(String, MachineScene)> {
    let radial: &[(&str, &str)] = &[("load.duration", "\"20 ms\"")];
    let richest =
        [radial, &[("effects.creep", "\"kalker_table\""), ("effects.heathcote_slip", "true")]].concat();
    let oil = [&richest[..], &[("film", "{ iso_vg = 68, temperature = \"70 degC\" }")]].concat();
    let with =
        |list: &[(&'static str, &'static str)], more: &[(&'static str, &'static str)]| [list, more].concat();
    let short = [("load.duration", "\"10 ms\""), ("load.output_interval", "\"100 us\"")];
    let bearings = [
        ("radial", "radial", with(radial, &[])),
        ("radial, richest law", "radial", richest.clone()),
        ("radial in oil", "radial", oil.clone()),
        ("radial in oil, 20,000 rpm", "radial", with(&oil, &[("load.inner_speed", "\"20000 rpm\"")])),
        ("radial 60 N", "radial", with(radial, &[("load.y", "{ force = \"60 N\" }")])),
        ("radial 60 N in oil", "radial", with(&oil, &[("load.y", "{ force = \"60 N\" }")])),
        ("radial 10 kN", "radial", with(&richest, &[("load.y", "{ force = \"10 kN\" }")])),
        ("radial with thrust", "radial", with(&richest, &[("load.x", "{ force = \"600 N\" }")])),
        (
            "run-up under load",
            "radial",
            with(&richest, &[("load.inner_speed", "[[0, 100], [\"20 ms\", 800]]")]),
        ),
        ("cage", "cage", with(radial, &[])),
        ("cage in oil", "cage", with(radial, &[("film", "{ iso_vg = 68, temperature = \"70 degC\" }")])),
        ("load zone", "cost/load_zone", vec![]),
        ("reversal", "cost/reversal", vec![]),
        ("speed ramp", "cost/speed_ramp", vec![]),
        ("thrust", "cost/thrust", vec![]),
        ("high speed", "error/high_speed", vec![]),
        ("load step", "error/load_step", vec![]),
        ("miniature", "error/miniature", vec![]),
        ("slewing ring", "error/slewing_ring", vec![]),
        ("spindle", "error/spindle", with(&short[..1], &[])),
        ("thrust step", "error/thrust_step", vec![]),
        ("unbalance", "error/unbalance", vec![]),
        ("oil mist", "effects/oil_mist", vec![]),
        ("soft housing", "effects/soft_housing", short.to_vec()),
        ("spall", "effects/spall", short.to_vec()),
        ("waviness", "effects/waviness", short.to_vec()),
    ];
    let of = |(name, file, changes): &(&str, &str, Vec<(&'static str, &'static str)>)| {
        let nothing_said = [("solver", "{}")];
        (name.to_string(), MachineScene::from(edited(file, &[&nothing_said[..], changes].concat())))
    };
    let mut all: Vec<_> = bearings.iter().map(of).collect();
    for name in ["pinion", "housing"] {
        let text = std::fs::read_to_string(crate::common::scene(&format!("shafts/{name}"))).unwrap();
        let text = text.replace("duration = \"20 ms\"", "duration = \"5 ms\"");
        all.push((format!("shaft: {name}"), MachineScene::parse(&text).unwrap()));
    }
    let mut random = Random::new(31);
    let drawn = std::iter::from_fn(|| Some(machine(&mut random))).flatten();
    all.extend(drawn.take(24).enumerate().map(|(k, scene)| (format!("random {}", k + 1), scene)));
    all
}

#[test]
#[ignore = "minutes"]
fn invariant_steps_where_nothing_is_said_keep_the_promise_and_cost_little_more_than_the_cheapest_that_do() {
    println!(
        "| scene | largest error over the promise | torque's history | cost over the cheapest tolerance that keeps it | so of a tolerance of 1e-8 alone |"
    );
    println!("|---|---:|---:|---:|---:|");
    let (mut regrets, mut broken, mut none) = (vec![], vec![], 0);
    let choice = Choice::default();
    for (name, scene) in scenes() {
        match played(&scene, &choice.interrupted) {
            Ok((_, work)) if work <= MOST_WORK => {}
            Ok((_, work)) => {
                println!("| {name} | left out: {work} evaluations | | |");
                continue;
            }
            Err(why) => {
                println!("| {name} | refused: {why} | | |");
                continue;
            }
        }
        let Ok(found) = regret(&name, &scene, &choice, &ProgressBar::hidden()) else {
            println!("| {name} | no reference | | |");
            continue;
        };
        let [usual] = &found.steps[..] else { panic!("{name} says something of its steps") };
        let usual = usual.result.as_ref().unwrap();
        let cost = found.of(usual).map_or("none keeps it".into(), |regret| format!("{regret:.2}"));
        let before = found.tolerances[4].result.as_ref().ok().and_then(|before| found.of(before));
        let before = before.map(|before| format!("{before:.2}")).unwrap_or_default();
        println!("| {name} | {:.2} | {:.1e} | {cost} | {before} |", usual.over, usual.torque);
        match found.of(usual) {
            None => none += 1,
            Some(regret) => {
                regrets.push(regret);
                if !usual.keeps() {
                    broken.push(name);
                }
            }
        }
    }
    let mean = (regrets.iter().map(|regret| regret.ln()).sum::<f64>() / regrets.len() as f64).exp();
    let most = regrets.iter().copied().fold(0.0, f64::max);
    println!(
        "{} scenes, regret {mean:.2} in the mean, {most:.2} at most; not kept: {broken:?}; none keeps it in {none}",
        regrets.len()
    );
    // The mean was 1.6 when this was written, and 3.0 with a tolerance of 1e-8 alone.
    assert!(regrets.len() >= 30 && mean < 1.8 && broken.len() * 20 <= regrets.len(), "{broken:?}");
}
