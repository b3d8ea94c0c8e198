//! Do error bars hold? Random scenes of all effects and of shafts whose error is measured as `roulement run --error` does, against runs
//! with a quarter of the last steps, whose error is a sixteenth.

use std::ops::ControlFlow;
use std::path::Path;

use roulement::scene::machine::MachineScene;
use roulement::scene::{ErrorGoal, ErrorOf};
use roulement::simulation::machine::{Machine, MachineError};
use roulement::simulation::play::{Rows, play_observed};
use roulement_cli::error::{Compared, Difference, Refined, Rounds, Run, finer, refine};
use roulement_cli::watch::Watch;

use crate::random::Random;
use crate::random_machines::machine;

/// Goals that are drawn.
const GOALS: [f64; 3] = [1e-2, 3e-3, 1e-3];
/// Steps times balls of the first run, beyond which a scene is left out: its reference takes more than a hundred times as many.
const MOST_BALL_STEPS: u64 = 100_000;
/// [-] over the size of a quantity: the rounding of what is nothing, beside the others of its kind.
const ROUNDING: f64 = 1e-9;

/// A run that came to its end.
#[derive(Clone)]
struct Kept {
    run: Run,
    ball_steps: u64,
}

impl Compared for Kept {
    fn comparable(&mut self) -> Run {
        self.run.clone()
    }
}

/// Plays a scene.
fn played(scene: &MachineScene) -> Result<Kept, MachineError> {
    let mut machine = Machine::new(scene)?;
    let mut watch = Watch::of(&machine);
    let rows = Rows::of_scene(scene);
    let _: ControlFlow<()> = play_observed(&mut machine, rows, &mut watch, |machine, watch| {
        watch.push(machine);
        ControlFlow::Continue(())
    })?;
    let of_bearing = machine.bearings().map(|(_, bearing)| {
        let state = bearing.state();
        state.statistics.steps * state.balls.len() as u64
    });
    let ball_steps = of_bearing.sum();
    let run = watch.finish(&machine).take_comparable(&machine, 0.0);
    Ok(Kept { run, ball_steps })
}

/// How many errors of means and histories are inside their bars, and of how many.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    all: u32,
    means: u32,
    histories: u32,
}

impl Count {
    fn add(&mut self, [mean, history]: [bool; 2]) {
        self.all += 1;
        self.means += u32::from(mean);
        self.histories += u32::from(history);
    }

    /// [-] shares inside.
    fn shares(&self) -> [f64; 2] {
        [self.means, self.histories].map(|inside| f64::from(inside) / f64::from(self.all))
    }
}

/// What came of a number of scenes.
#[derive(Debug, Default)]
struct Found {
    scenes: u32,
    met: u32,
    rounds: u32,
    /// Rounds, and bars that hold, if the difference of the last two runs were the bar.
    rounds_of_differences: u32,
    of_differences: Count,
    /// Bars of goals that are met, and of all.
    of_met: Count,
    of_all: Count,
    /// Quantities of met goals whose true error is above the goal.
    above: u32,
}

/// Runs that the difference of the last two as a bar would take, and whether its bars hold; none where they are not enough.
fn of_differences(runs: &[Run], reference: &Run, goal: f64, count: &mut Count) -> Option<u32> {
    let differences: Vec<_> = runs.windows(2).map(|pair| Difference::of(&pair[0], &pair[1])).collect();
    let bars = |k: usize, i: usize| {
        let quarter =
            |of: fn(&Difference) -> &[f64]| if k == 0 { 0.0 } else { 0.25 * of(&differences[k - 1])[i] };
        let last = &differences[k];
        let mean = last.means[i].max(last.scatter[i]).max(quarter(|difference| &difference.means));
        [mean, last.histories[i].max(quarter(|difference| &difference.histories))]
    };
    let quantities: Vec<_> = runs[0].quantities().enumerate().collect();
    let met = |k: &usize| quantities.iter().all(|(i, _)| bars(*k, *i).iter().all(|bar| *bar <= goal));
    let k = (0..differences.len()).find(met)?;
    let truth = Difference::of(&runs[k + 1], reference);
    for (i, _) in quantities.into_iter().filter(|(_, (part, own))| part.quantities[*own].shown) {
        let [mean, history] = bars(k, i);
        count.add([truth.means[i] <= mean + ROUNDING, truth.histories[i] <= history + ROUNDING]);
    }
    Some(k as u32 + 2)
}

/// Compares the bars of a scene with the errors against a reference.
fn compare(rounds: &Rounds, met: bool, last: &Run, reference: &Run, goal: f64, found: &mut Found) {
    let truth = Difference::of(last, reference);
    let mut first = 0;
    for ((part, finest), means) in last.parts.iter().zip(&reference.parts).zip(rounds.means()) {
        let means = means.unwrap();
        for (own, quantity) in part.quantities.iter().enumerate().filter(|(_, quantity)| quantity.shown) {
            let (i, size) = (first + own, finest.sizes[own]);
            let error = means.find(&quantity.name).and_then(|mean| mean.error).unwrap();
            // Histories of what is chaotic have no bar, and its means differ from run to run.
            let Some(history) = error.history else { continue };
            let [of_mean, of_history] = [error.mean, history].map(|bar| bar / size + ROUNDING);
            let inside = [truth.means[i] <= of_mean, truth.histories[i] <= of_history];
            found.of_all.add(inside);
            if met {
                found.of_met.add(inside);
                found.above += u32::from(truth.means[i].max(truth.histories[i]) > goal);
            }
            if inside.contains(&false) {
                println!(
                    "  {}: mean {:.1e} of {of_mean:.1e}, history {:.1e} of {of_history:.1e}",
                    part.name_of(own),
                    truth.means[i],
                    truth.histories[i]
                );
            }
        }
        first += part.quantities.len();
    }
}

/// Measures errors of so many random scenes.
fn study(seed: u64, count: u32) -> Found {
    let mut random = Random::new(seed);
    let (mut found, mut left_out) = (Found::default(), 0);
    while found.scenes < count {
        let goal = random.pick(&GOALS);
        let Some(mut scene) = machine(&mut random) else { continue };
        // What is refused, or meets its limits, has no error; what takes long has it as others have.
        if !played(&scene).is_ok_and(|first| first.ball_steps <= MOST_BALL_STEPS) {
            left_out += 1;
            continue;
        }
        scene.change(|scene| scene.solver.goal = Some(ErrorGoal { error: goal, of: ErrorOf::All }));
        let mut runs = vec![];
        let ended = refine(&scene, |scene, keep| {
            let kept = played(scene)?;
            if keep {
                runs.push(kept.run.clone());
            }
            Ok::<_, MachineError>(kept)
        });
        let Ok(Refined { run: Kept { run: last, .. }, rounds: Some((rounds, said)) }) = ended else {
            left_out += 1;
            continue;
        };
        let Ok(reference) = played(&finer(&scene, rounds.refinements() + 1)) else {
            left_out += 1;
            continue;
        };
        println!("scene {}: goal {goal:e} {said} in {} rounds", found.scenes, rounds.count());
        found.scenes += 1;
        found.met += u32::from(said == "met");
        compare(&rounds, said == "met", &last, &reference.run, goal, &mut found);
        if said == "met" {
            found.rounds += rounds.refinements();
            let before = of_differences(&runs, &reference.run, goal, &mut found.of_differences);
            found.rounds_of_differences += before.unwrap_or(rounds.refinements());
        }
    }
    let percent = |count: &Count| count.shares().map(|share| format!("{:.2} %", 100.0 * share));
    println!("seed {seed}: {} scenes, {left_out} left out, {} goals met", found.scenes, found.met);
    println!(
        "| bars | quantities | means inside | histories inside | runs of a scene |\n|---|---:|---:|---:|---:|"
    );
    let row = |name: &str, count: &Count, rounds: u32| {
        let [means, histories] = percent(count);
        let rounds = f64::from(rounds) / f64::from(found.met);
        println!("| {name} | {} | {means} | {histories} | {rounds:.2} |", count.all);
    };
    row("the last difference", &found.of_differences, found.rounds_of_differences);
    row("goals met", &found.of_met, found.rounds);
    let [means, histories] = percent(&found.of_all);
    println!("| all | {} | {means} | {histories} | |", found.of_all.all);
    println!("{} true errors are above a goal that is met", found.above);
    found
}

/// 99 % of means and 97 % of histories inside their bars, for less than half a run more in the mean.
fn check(found: &Found) {
    let [means, histories] = found.of_met.shares();
    assert!(means >= 0.99 && histories >= 0.97, "{found:?}");
    assert_eq!(found.above, 0, "{found:?}");
    assert!(found.of_met.all > 10 * found.met && found.met > found.scenes / 2, "{found:?}");
    assert!(f64::from(found.rounds) < f64::from(found.rounds_of_differences) + 0.5 * f64::from(found.met));
}

#[test]
#[ignore = "minutes"]
fn independent_reference_bars_of_sixty_random_scenes_of_all_effects_hold() {
    // Another seed than those that the factors were found with (21, 11 and 13).
    check(&study(22, 60));
}

#[test]
#[ignore = "minutes"]
fn independent_reference_bars_hold_for_the_scenes_that_the_factors_were_found_with() {
    check(&study(21, 60));
}

#[test]
fn regression_bars_of_histories_of_two_runs_hold() {
    // The last difference alone was met after two rounds, with 9 of 11 histories outside their bar (tests/data/error).
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/error/history_bar_too_small.toml");
    let mut scene = MachineScene::load(&data).unwrap();
    let goal = 1e-3;
    scene.change(|scene| scene.solver.goal = Some(ErrorGoal { error: goal, of: ErrorOf::All }));
    let Refined { run, rounds } = refine(&scene, |scene, _| played(scene)).unwrap();
    let (rounds, said) = rounds.unwrap();
    let reference = played(&finer(&scene, rounds.refinements() + 1)).unwrap();
    let mut found = Found::default();
    compare(&rounds, said == "met", &run.run, &reference.run, goal, &mut found);
    assert_eq!(said, "met");
    assert_eq!(found.of_met.histories, found.of_met.all, "{found:?}");
    assert_eq!(found.of_met.means, found.of_met.all, "{found:?}");
    assert!(found.of_met.all >= 11 && found.above == 0, "{found:?}");
}
