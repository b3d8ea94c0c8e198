//! Numerical errors that are measured on the scene at hand: rounds of refinement, chaos, and the program's `run --error`.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use roulement::scene::{ErrorGoal, ErrorOf, Scene, Solver};
use roulement::simulation::Simulation;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Observer, Rows, play_observed};
use roulement_cli::error::{Course, Difference, Judgement, Lengths, Rounds, Run, Sample, sizes};
use roulement_cli::report::figures::Figures;
use roulement_cli::report::means::{Blocks, Means};
use roulement_cli::report::quantities::{COUNT, Parts, QUANTITIES, Watched, of_bearing};

use crate::common::{Scratch, edited};

/// A start of the thrust case that has something to be wrong about: the load rises within 0.1 ms.
fn short(changes: &[(&str, &str)]) -> Scene {
    let own = [
        ("solver", "{ accuracy = \"fast\" }"),
        ("load.duration", "\"2 ms\""),
        ("load.output_interval", "\"20 us\""),
        ("load.x.force", "[[0.0, 1500], [\"0.5 ms\", 1500], [\"0.6 ms\", 1700]]"),
    ];
    edited("thrust", &own.iter().chain(changes).copied().collect::<Vec<_>>())
}

/// Columns of a table by name: a name and values of each.
fn table(text: &str) -> Vec<(String, Vec<String>)> {
    let mut lines = text.lines().map(|line| line.split(',').map(String::from).collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let rows: Vec<_> = lines.collect();
    let column = |i: usize| rows.iter().map(|row| row[i].clone()).collect();
    header.into_iter().enumerate().map(|(i, name)| (name, column(i))).collect()
}

fn column<'a>(table: &'a [(String, Vec<String>)], name: &str) -> &'a [String] {
    &table.iter().find(|(title, _)| title == name).unwrap_or_else(|| panic!("{name}")).1
}

/// A run of 1 s in which every quantity is 1 but for what is added to the friction power.
fn synthetic(solver: Solver, added: impl Fn(f64) -> f64) -> Run {
    let index = QUANTITIES.iter().position(|quantity| quantity.name == "friction power").unwrap();
    let mut outputs = Simulation::new(&edited("thrust", &[])).unwrap().outputs().clone();
    let quantities = of_bearing(Parts { cage: false, moving_outer: false, losses: [false; LOSSES.len()] });
    let mut blocks = Blocks::new(quantities.clone(), 1.0, 1.0);
    let mut samples = Vec::new();
    for row in 0..=1000 {
        outputs.time = f64::from(row) * 1e-3;
        outputs.friction_power = 100.0 * (1.0 + added(outputs.time));
        blocks.push(&(&outputs).into());
        let mut values = vec![1.0; COUNT];
        values[index] = outputs.friction_power;
        samples.push(Sample { time: outputs.time, values, largest_load: 1.0 });
    }
    let lengths = Lengths { pitch_radius: 1.0, ball_diameter: 0.1 };
    run_of(solver, (quantities, lengths), samples, &blocks)
}

/// A run of a bearing of these quantities and lengths.
fn run_of(
    solver: Solver,
    (quantities, lengths): (Vec<Watched>, Lengths),
    samples: Vec<Sample>,
    blocks: &Blocks,
) -> Run {
    let sizes = sizes(&samples, &quantities, lengths, 0.0);
    let (name, means) = (String::new(), blocks.means());
    let part = Course { name, quantities, samples, means, figures: Figures::default(), sizes };
    Run { solver, cpu: 1.0, parts: vec![part] }
}

fn means_of(rounds: &Rounds) -> Means {
    rounds.means().remove(0).unwrap()
}

fn goal(error: f64) -> Option<ErrorGoal> {
    Some(ErrorGoal { error, of: ErrorOf::All })
}

#[test]
fn closed_form_rounds_end_where_the_error_of_order_two_is_below_the_goal() {
    let error_of = |halvings: u32| 0.05 * 0.25f64.powi(halvings as i32);
    for (target, needed) in [(0.08, 2), (0.05, 3), (1e-2, 3), (1e-3, 5), (1e-4, 7)] {
        let mut rounds = Rounds::new(goal(target), 10);
        while rounds.judge() == Judgement::Refine {
            let halvings = rounds.refinements();
            rounds.push(synthetic(Solver::default().refined(halvings), |_| error_of(halvings)));
        }
        // The difference of two runs is three times the error of the finer one; twice as much counts while nothing tells that it falls.
        let known = if needed == 2 { 6.0 } else { 3.0 } * error_of(rounds.refinements() - 1);
        assert_eq!((rounds.judge(), rounds.refinements()), (Judgement::Done, needed), "{target}: {known}");
        assert!(known <= target && rounds.report().contains("met"), "{}", rounds.report());
        let means = means_of(&rounds);
        let error = means.find("friction power").unwrap().error.unwrap();
        assert!((error.mean / (100.0 * known) - 1.0).abs() < 0.1, "{error:?}");
        assert!((error.history.unwrap() / error.mean - 1.0).abs() < 1e-9);
        assert_eq!(means.find("cage speed").unwrap().error.unwrap().mean, 0.0);
    }
    // What does not get there says so.
    let mut rounds = Rounds::new(goal(1e-6), 3);
    while rounds.judge() == Judgement::Refine {
        let halvings = rounds.refinements();
        rounds.push(synthetic(Solver::default().refined(halvings), |_| error_of(halvings)));
    }
    assert_eq!((rounds.judge(), rounds.refinements()), (Judgement::TooMany, 3));
    let report = rounds.report();
    assert!(report.contains("NOT MET") && report.contains("about 7 more rounds"), "{report}");
    // Means that agree by chance are not believed.
    let mut rounds = Rounds::new(goal(1e-3), 10);
    for error in [0.08, 0.02, 0.02] {
        rounds.push(synthetic(Solver::default(), |_| error));
    }
    assert_eq!(rounds.judge(), Judgement::Refine);
}

/// Noise that looks random, another for every seed.
fn noise(seed: u32) -> impl Fn(f64) -> f64 {
    move |time: f64| {
        // Steele, Lea and Flood 2014 (splitmix64).
        let mut state =
            ((time * 1e4).round() as u64 | u64::from(seed) << 40).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (state ^ (state >> 31)) as f64 / u64::MAX as f64 - 0.5
    }
}

#[test]
fn closed_form_chaos_is_told_from_coarse_steps_and_has_an_interval() {
    // Histories that have nothing to do with each other, whatever the steps: two rounds, then the twin, which is as far.
    let mut rounds = Rounds::new(goal(2e-2), 10);
    for seed in 1..=3 {
        assert_eq!(rounds.judge(), Judgement::Refine);
        rounds.push(synthetic(Solver::default(), noise(seed)));
    }
    assert_eq!(rounds.judge(), Judgement::Twin);
    rounds.push_twin(&synthetic(Solver::default(), noise(4)));
    // The mean of 500 numbers of deviation 1/sqrt(12) is known to 2 sqrt(1/12/500) = 2.6 %, and the two runs differ, too.
    assert_eq!(rounds.judge(), Judgement::TooShort);
    let report = rounds.report();
    for part in ["CHAOTIC          friction power", "NOT MET", "load.duration of about"] {
        assert!(report.contains(part), "{report}");
    }
    let means = means_of(&rounds);
    let power = means.find("friction power").unwrap();
    let error = power.error.unwrap();
    assert!((power.mean - 100.0).abs() < error.mean && error.mean > 2.0 && error.mean < 8.0, "{power:?}");
    assert_eq!(error.history, None);
    // The same with a goal that the interval keeps.
    let mut rounds = Rounds::new(goal(0.1), 10);
    for seed in 1..=3 {
        rounds.push(synthetic(Solver::default(), noise(seed)));
    }
    rounds.push_twin(&synthetic(Solver::default(), noise(4)));
    assert_eq!(rounds.judge(), Judgement::Done);
    // Steps that are too coarse for a vibration: differences do not fall, but the twin stays.
    let mut rounds = Rounds::new(goal(1e-2), 10);
    for seed in 1..=3 {
        rounds.push(synthetic(Solver::default(), noise(seed)));
    }
    rounds.push_twin(&synthetic(Solver::default(), |time| noise(2)(time) + 1e-7));
    assert_eq!(rounds.judge(), Judgement::Refine);
    assert!(!rounds.report().contains("CHAOTIC"));
}

#[test]
fn invariant_the_files_are_those_of_the_finest_run_and_its_figures_have_error_bars() {
    let scratch = Scratch::new("error-finest");
    let coarse = short(&[]);
    let output = scratch.run(&coarse, "measured", &["--error", "1e-2"]);
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{summary}{}", String::from_utf8_lossy(&output.stderr));
    assert!(summary.contains("error goal       1e-2 of means and histories: met"), "{summary}");
    let rounds = summary.lines().filter(|line| line.starts_with("round ")).count() as u32;
    assert!(rounds >= 2 && summary.contains("s CPU; means"), "{summary}");
    for figure in ["bearing's force  x ", "inner race at ", "ball loads ", "friction power ", "cage speed "] {
        let line = summary.lines().find(|line| line.starts_with(figure)).unwrap();
        assert!(line.contains("(+- "), "{line}");
    }
    let left: Vec<_> = std::fs::read_dir(scratch.path("measured")).unwrap().collect();
    assert!(left.iter().all(|file| !file.as_ref().unwrap().path().display().to_string().contains("round")));
    // The same settings in a plain run, to the bit.
    let solver = coarse.solver.refined(rounds - 1);
    let settings = format!(
        "{{ tolerance = {:e}, max_step = {:e}, initial_step = {:e}, min_step = {:e} }}",
        solver.tolerance, solver.max_step.0, solver.initial_step.0, solver.min_step.0
    );
    let fine = Scene::edited(&coarse.source, [("solver", settings)]).unwrap();
    let plain = scratch.run(&fine, "plain", &[]);
    assert!(plain.status.success() && !String::from_utf8(plain.stdout).unwrap().contains("+-"));
    assert_eq!(scratch.read("measured/results.csv"), scratch.read("plain/results.csv"));
}

#[test]
fn independent_reference_errors_are_below_the_error_bars_and_below_the_goal() {
    let scratch = Scratch::new("error-reference");
    let coarse = short(&[("solver", "{ accuracy = { error = 2e-3 } }")]);
    let output = scratch.run(&coarse, "measured", &["--rounds", "9"]);
    let summary = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && summary.contains("2e-3 of means and histories: met"), "{summary}");
    // Against steps that no round took.
    let fixed = "{ max_step = \"0.2 us\", initial_step = \"0.2 us\", tolerance = 1e-2 }";
    let exact = scratch.run(&short(&[("solver", fixed)]), "exact", &[]);
    assert!(exact.status.success());
    let [measured, exact] =
        ["measured", "exact"].map(|run| table(&scratch.read(&format!("{run}/means.csv"))));
    // Behind means are the four numbers that close the losses, without bars.
    let count = column(&measured, "quantity").iter().position(|name| name == "torque times speed").unwrap();
    let numbers = |table, name| -> Vec<f64> {
        column(table, name)[..count].iter().map(|text| text.parse().unwrap_or(f64::NAN)).collect()
    };
    let (means, truth) = (numbers(&measured, "mean"), numbers(&exact, "mean"));
    let (errors, histories) = (numbers(&measured, "error"), numbers(&measured, "history_error"));
    assert!(histories.iter().all(|error| error.is_finite()), "{histories:?}");
    // Components that are 0 have the rounding of the others of their kind, nine digits of a load in a step.
    let units = column(&measured, "unit");
    let rounding = |i: usize| {
        let alike = (0..truth.len()).filter(|&j| units[j] == units[i]).map(|j| truth[j].abs());
        1e-9 * alike.fold(0.0, f64::max)
    };
    for i in 0..means.len() {
        let name = &column(&measured, "quantity")[i];
        let error = (means[i] - truth[i]).abs();
        assert!(error <= errors[i] + rounding(i), "{name}: {error:e}, bar {:e}", errors[i]);
    }
    let power = column(&measured, "quantity").iter().position(|name| name == "friction power").unwrap();
    assert!(errors[power] > 0.0 && errors[power] <= 2e-3 * truth[power]);
    // Without the option a run is one run, which says how its error is measured; with it alone, two, and no goal.
    let plain = scratch.run(&short(&[]), "plain", &[]);
    let plain = String::from_utf8_lossy(&plain.stdout);
    assert!(
        !plain.contains("round 1") && plain.contains("error            not measured: --error"),
        "{plain}"
    );
    assert!(!summary.contains("not measured"));
    let pair = String::from_utf8(scratch.run(&short(&[]), "pair", &["--error"]).stdout).unwrap();
    assert!(pair.contains("round 2") && !pair.contains("error goal"), "{pair}");
}

#[test]
fn a_goal_that_is_not_met_or_makes_no_sense_is_said() {
    let scratch = Scratch::new("error-unmet");
    let output = scratch.run(&short(&[]), "out", &["--error", "1e-6", "--rounds", "2"]);
    let summary = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(3), "{summary}");
    assert!(summary.contains("NOT MET") && summary.contains("--rounds"), "{summary}");
    let refused = scratch.run(&short(&[]), "out", &["--error", "2"]);
    let message = String::from_utf8_lossy(&refused.stderr);
    assert!(message.contains("solver.accuracy.error") && message.contains("[0.0000001, 0.5]"), "{message}");
    let refused = Scene::edited(&short(&[]).source, [("solver.accuracy", "{ error = 0.0 }")]).unwrap_err();
    assert!(refused.to_string().contains("solver.accuracy.error = 0"), "{refused}");
}

/// What is kept of a bearing that is played.
struct Kept {
    blocks: Blocks,
    samples: Vec<Sample>,
}

impl Observer for Kept {
    fn step(&mut self, machine: &Machine) {
        machine.bearings().for_each(|(_, bearing)| self.blocks.push(&bearing.instant()));
    }
}

/// Plays a scene with other settings.
fn played(scene: &Scene, solver: Solver) -> Run {
    let mut scene = scene.clone();
    scene.solver = solver;
    let simulation = Simulation::new(&scene).unwrap();
    let bearing = &simulation.model().bearing;
    let lengths =
        Lengths { pitch_radius: 0.5 * bearing.pitch_diameter, ball_diameter: 2.0 * bearing.ball.radius };
    let quantities = of_bearing(Parts::of(&simulation));
    let mut kept = Kept { blocks: Blocks::of_bearing(&simulation), samples: vec![] };
    let rows = Rows::of(&simulation);
    let mut machine = Machine::from(simulation);
    let _: ControlFlow<()> = play_observed(&mut machine, rows, &mut kept, |machine, kept| {
        let (_, bearing) = machine.bearings().next().unwrap();
        kept.samples.push(Sample::new(bearing.outputs()));
        ControlFlow::Continue(())
    })
    .unwrap();
    run_of(solver, (quantities, lengths), kept.samples, &kept.blocks)
}

/// [-] root mean square over rows of a quantity's error over its size, without the hundredth of the rows where it is largest.
fn usual(run: &Run, fine: &Run, name: &str) -> f64 {
    let (run, fine) = (&run.parts[0], &fine.parts[0]);
    let i = QUANTITIES.iter().position(|quantity| quantity.name == name).unwrap();
    let rows = run.samples.iter().zip(&fine.samples);
    let mut squares: Vec<f64> =
        rows.map(|(one, other)| ((one.values[i] - other.values[i]) / fine.sizes[i]).powi(2)).collect();
    squares.sort_by(f64::total_cmp);
    let usual = &squares[..squares.len() - squares.len() / 100];
    (usual.iter().sum::<f64>() / usual.len() as f64).sqrt()
}

/// Largest errors of a scene that says nothing about steps, against steps of an eighth.
struct Errors {
    name: &'static str,
    means: f64,
    /// Without the friction torque.
    histories: f64,
    torque: f64,
    /// Of the friction power, without the hundredth of the rows where it is largest.
    usual_power: f64,
}

impl Errors {
    fn of(name: &'static str) -> Self {
        let scene = edited(&format!("error/{name}"), &[]);
        assert!(!scene.source.contains("[solver]"));
        Self::of_scene(name, &scene)
    }

    /// Those of a scene with its own steps.
    fn of_scene(name: &'static str, scene: &Scene) -> Self {
        let run = played(scene, scene.solver);
        let fine = played(scene, scene.solver.refined(3));
        let difference = Difference::of(&run, &fine);
        let is_torque = |i: &usize| QUANTITIES[*i].name == "friction torque";
        let others = (0..COUNT).filter(|i| !is_torque(i)).map(|i| difference.histories[i]);
        let torque = (0..COUNT).find(is_torque).map(|i| difference.histories[i]).unwrap();
        let (means, histories) =
            (difference.means.into_iter().fold(0.0, f64::max), others.fold(0.0, f64::max));
        let Solver { max_step, tolerance, .. } = scene.solver;
        println!(
            "| `{name}` | {:.3} us | {tolerance:.1e} | {means:.1e} | {histories:.1e} | {torque:.1e} |",
            max_step.0 * 1e6,
        );
        Self { name, means, histories, torque, usual_power: usual(&run, &fine, "friction power") }
    }

    /// Those of the scenes that take little time.
    fn quick() -> &'static [Self] {
        static ERRORS: OnceLock<Vec<Errors>> = OnceLock::new();
        let names = ["thrust_step", "load_step", "unbalance", "spindle", "miniature", "high_speed"];
        ERRORS.get_or_init(|| names.map(Self::of).into())
    }
}

#[test]
fn invariant_where_nothing_is_said_means_keep_one_and_histories_two_percent() {
    for Errors { name, means, histories, torque, .. } in Errors::quick() {
        assert!(*means < 0.01 && *histories < 0.02, "{name}: {means} {histories}");
        // The torque after the step of a radial load has the bounce of unloaded balls in it.
        assert!(*torque < if *name == "load_step" { 0.1 } else { 0.02 }, "{name}: {torque}");
    }
}

#[test]
#[ignore = "half a minute, without optimisation three"]
fn invariant_a_run_up_through_its_resonance_keeps_its_means_and_says_what_blows_leave_of_histories() {
    assert!(Errors::of("run_up").means < 0.01);
    // Which blow a row meets takes steps of a tolerance that follows all.
    let scene = edited("error/run_up", &[("solver", "{ tolerance = 1e-8, max_step = \"91.6 us\" }")]);
    let run_up = Errors::of_scene("run_up", &scene);
    assert!(run_up.means < 0.01, "{}", run_up.means);
    // Balls strike each other: a blow of some microseconds that comes a microsecond earlier or later is another power at equal times. It has
    // a hundred times the power of the rest, so that the few rows that it is in make the error of the history, which is then a matter of
    // chance. All others keep to a few per cent.
    let usual = run_up.usual_power;
    println!("run_up: friction power without a hundredth of the rows {usual:.1e}");
    assert!(usual < 0.05 && run_up.torque < 0.1 && run_up.histories > usual, "{usual} {}", run_up.torque);
    // Measured with one pair of runs, every mean is right within its error bar: those that agree by chance, too.
    // Such steps have no budget of energy, which blows use up differently: the runs' steps are exactly 1 to 2 to 8.
    let [run, half, fine] = [0, 1, 3].map(|finer| played(&scene, scene.solver.refined(finer)));
    let truth = Difference::of(&half, &fine);
    let pair = Difference::of(&run, &half);
    let mut rounds = Rounds::new(None, 2);
    rounds.push(run);
    rounds.push(half.clone());
    let (measured, sizes) = (means_of(&rounds), &half.parts[0].sizes);
    let mut by_chance = 0;
    for (i, quantity) in QUANTITIES.iter().enumerate() {
        let Some(mean) = measured.find(quantity.name) else { continue };
        let bar = mean.error.unwrap();
        let [of_mean, of_history] = [bar.mean, bar.history.unwrap()].map(|error| error / sizes[i]);
        println!(
            "{}: mean {:.1e}, bar {of_mean:.1e}; history {:.1e}, bar {of_history:.1e}",
            quantity.name, truth.means[i], truth.histories[i]
        );
        // Components that are 0 have the rounding of the others of their kind.
        assert!(truth.means[i] <= of_mean + 1e-9, "{}: {:e}, bar {of_mean:e}", quantity.name, truth.means[i]);
        by_chance += u32::from(truth.means[i] > 3.0 * pair.means[i] && truth.means[i] > 1e-6);
        assert!(truth.histories[i] <= of_history + 1e-9, "{}", quantity.name);
    }
    assert!(by_chance > 0, "nothing agreed by chance: a scene without blows");
}

#[test]
fn closed_form_means_that_agree_by_chance_have_the_error_of_what_differs_now_and_then() {
    // Four blows of 1/50 of the power in the second half, two more and two less: the means agree to the last digit.
    let blows = |time: f64| {
        let blow = |at: f64| if (time - at).abs() < 5.5e-3 { 0.02 } else { 0.0 };
        blow(0.55) - blow(0.7) + blow(0.85) - blow(0.95)
    };
    let mut rounds = Rounds::new(goal(0.1), 10);
    rounds.push(synthetic(Solver::default(), |_| 0.0));
    rounds.push(synthetic(Solver::default().refined(1), blows));
    let means = means_of(&rounds);
    let error = means.find("friction power").unwrap().error.unwrap().mean / 100.0;
    // Of eight groups of 62 rows four have 11 rows of a blow; divisions into 16 and 32 have narrower intervals.
    let expected = 2.365 * (4.0f64 / 7.0 / 8.0).sqrt() * 11.0 * 0.02 / 62.0;
    assert!((error / expected - 1.0).abs() < 1e-3, "{error} {expected}");
    // An offset is an error of the mean, twice as it is while nothing tells how it falls, and of its scatter nothing.
    let mut rounds = Rounds::new(goal(0.1), 10);
    rounds.push(synthetic(Solver::default(), |_| 0.0));
    rounds.push(synthetic(Solver::default().refined(1), |_| 1e-3));
    let error = means_of(&rounds).find("friction power").unwrap().error.unwrap().mean / 100.0;
    assert!((error / 2e-3 - 1.0).abs() < 1e-6, "{error}");
}

#[test]
fn closed_form_bars_are_all_that_smaller_steps_would_still_change() {
    // Errors of which halved steps leave a share. What the last run is from the end of them is its error: exactly where a half to three
    // quarters are left; where less is left the last difference, or a quarter of the one before, is more, and where more is left it is not known, and the goal not met.
    for (left, over) in [(0.125, 14.0), (0.25, 3.0), (0.5, 1.0), (0.6, 1.0), (0.75, 1.0), (0.9, 3.0 / 9.0)] {
        let mut rounds = Rounds::new(goal(1e-3), 10);
        let error_of = |run: i32| 0.01 * f64::powi(left, run);
        (0..4).for_each(|run| rounds.push(synthetic(Solver::default(), |_| error_of(run))));
        let means = means_of(&rounds);
        let error = means.find("friction power").unwrap().error.unwrap();
        for bar in [error.mean, error.history.unwrap()] {
            let found = bar / 100.0 / error_of(3);
            assert!((found / over - 1.0).abs() < 0.02, "{left}: {found} {over}");
        }
        // A goal of which the last difference alone is a half: met where it falls, and not where it hardly does.
        let target = 2.0 * (error_of(2) - error_of(3));
        let mut rounds = Rounds::new(goal(target), 10);
        (0..4).for_each(|run| rounds.push(synthetic(Solver::default(), |_| error_of(run))));
        let judged = if left > 0.7 { Judgement::Twin } else { Judgement::Done };
        assert_eq!(rounds.judge(), judged, "{left}");
    }
}

#[test]
#[ignore = "two minutes"]
fn invariant_where_nothing_is_said_means_of_large_slow_bearings_and_cages_keep_one_percent() {
    let ring = Errors::of("slewing_ring");
    assert!(ring.means < 0.01 && ring.histories < 0.02 && ring.torque < 0.02);
    // Chaotic: its power is known to the interval of a run of that length.
    let cage = Errors::of("rattling_cage");
    assert!(cage.means < 0.1, "{}", cage.means);
}
