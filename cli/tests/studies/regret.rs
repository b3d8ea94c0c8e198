//! What steps where nothing is said cost beside the cheapest tolerance that keeps the same promise: means within 1 %, histories but that of
//! the torque within 2 %.

use std::ops::ControlFlow;

use roulement::scene::Solver;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::{Machine, MachineError};
use roulement::simulation::play::{Rows, play_observed};
use roulement_cli::error::{Difference, Run};
use roulement_cli::watch::Watch;

use crate::common::edited;
use crate::random::Random;
use crate::random_machines::machine;

/// Contact evaluations of a run whose reference takes longer than anyone would wait for.
const MOST_WORK: f64 = 4e6;
/// [-] price of an evaluation with exact derivatives, in evaluations.
const TANGENT: u64 = 3;

/// Plays a scene: what comes of it, and contact evaluations.
fn played(scene: &MachineScene) -> Result<(Run, f64), MachineError> {
    let mut machine = Machine::new(scene)?;
    let mut watch = Watch::of(&machine);
    let _: ControlFlow<()> =
        play_observed(&mut machine, Rows::of_scene(scene), &mut watch, |machine, watch| {
            watch.push(machine);
            ControlFlow::Continue(())
        })?;
    let work = machine.bearings().map(|(_, bearing)| {
        let counted = bearing.state().statistics;
        counted.contact_values + TANGENT * counted.contact_tangents
    });
    let work = work.sum::<u64>() as f64;
    Ok((watch.finish(&machine).take_comparable(&machine, 0.0), work))
}

/// A scene with other steps: this many times the tolerance, all followed.
fn with_tolerance(scene: &MachineScene, factor: f64) -> MachineScene {
    let mut other = scene.clone();
    for bearing in other.bearings_mut() {
        bearing.solver.tolerance *= factor;
        bearing.solver.unresolved = 0.0;
    }
    other
}

/// [-] largest error of a run over what is promised, and of the torque's history.
fn kept(run: &Run, reference: &Run) -> [f64; 2] {
    let difference = Difference::of(run, reference);
    let (mut worst, mut torque) = (0.0f64, 0.0f64);
    for (i, (part, own)) in run.quantities().enumerate() {
        worst = worst.max(difference.means[i] / 0.01);
        match part.quantities[own].name.contains("torque") {
            true => torque = torque.max(difference.histories[i]),
            false => worst = worst.max(difference.histories[i] / 0.02),
        }
    }
    [worst, torque]
}

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
    for (name, scene) in scenes() {
        let (run, work) = match played(&scene) {
            Ok(run) => run,
            Err(why) => {
                println!("| {name} | refused: {why} | | |");
                continue;
            }
        };
        if work > MOST_WORK {
            println!("| {name} | left out: {work:.1e} evaluations | | |");
            continue;
        }
        let mut fine = with_tolerance(&scene, 2.0);
        for bearing in fine.bearings_mut() {
            bearing.solver = Solver { energy_error: 0.0, ..bearing.solver.refined(2) };
        }
        let Ok((reference, _)) = played(&fine) else {
            println!("| {name} | no reference | | |");
            continue;
        };
        let cheapest = [2e4, 2e3, 2e2, 2e1, 2.0, 0.2].map(|factor| {
            let (run, work) = played(&with_tolerance(&scene, factor)).ok()?;
            Some((kept(&run, &reference)[0] <= 1.0, work))
        });
        let before = cheapest[4].map(|(_, work)| work);
        let keep = |tried: Option<(bool, f64)>| tried.and_then(|(keeps, work)| keeps.then_some(work));
        let cheapest = cheapest.into_iter().filter_map(keep).reduce(f64::min);
        let [worst, torque] = kept(&run, &reference);
        let regret = cheapest.map(|cheapest| work / cheapest);
        let cost = regret.map_or("none keeps it".into(), |regret| format!("{regret:.2}"));
        let before = before
            .zip(cheapest)
            .map_or(String::new(), |(before, cheapest)| format!("{:.2}", before / cheapest));
        println!("| {name} | {worst:.2} | {torque:.1e} | {cost} | {before} |");
        match regret {
            None => none += 1,
            Some(regret) => {
                regrets.push(regret);
                if worst > 1.0 {
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
