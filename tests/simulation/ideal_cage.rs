//! Balls that an ideal cage keeps apart (`effects.cage = "ideal"`): single bearings.

use std::ops::ControlFlow;

use nalgebra::Vector3;
use roulement::model::bodies::Race;
use roulement::model::spacing::{CommonTurn, Spacing};
use roulement::model::state::BallState;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::play::{Rows, play};

/// A free inner race with a shaft's mass, under load across the axis and along it.
const FREE: &str = r#"
[bearing]
balls = 9
ball_diameter = "7.938 mm"
pitch_diameter = "38.5 mm"
diametral_clearance = "10 um"
[effects]
cage = "ideal"
damping = "0.02 s/m"
gravity = [0.0, -9.81, 0.0]
[inner]
drive = "wrench"
mass = "0.5 kg"
inertia = ["1e-4 kg m^2", "1e-4 kg m^2", "1e-4 kg m^2"]
[load]
duration = "20 ms"
inner_speed = "6000 rpm"
y = { force = "-800 N" }
x = { force = "200 N" }
ry = { rotation = 0.0 }
rz = { rotation = 0.0 }
"#;
/// A thrust bearing whose inner race is moved.
const THRUST: &str = include_str!("../../scenes/thrust.toml");

fn scene(text: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::edited(text, changes.iter().copied()).unwrap()
}

/// A run by the script with rows at an interval until an end \[s], which are shown.
fn run(scene: &Scene, [interval, end]: [f64; 2], mut see: impl FnMut(&Outputs, &Simulation)) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    let _: ControlFlow<()> = play(&mut simulation, Rows::new(interval, end), |simulation| {
        let outputs = simulation.outputs().clone();
        see(&outputs, simulation);
        ControlFlow::Continue(())
    })
    .unwrap();
    simulation
}

/// \[rad] largest distance of a ball from even spacing, and [-] of its speed along the orbit from the common one.
fn unevenness(simulation: &Simulation) -> [f64; 2] {
    let (state, spacing) = (simulation.state(), Spacing::new(&simulation.model().bearing));
    let turn = state.spacing.as_ref().unwrap();
    let of = |(ball, azimuth): (&BallState, &[f64; 2])| {
        let directions = turn.directions(*azimuth);
        let (at, v) = (ball.position - turn.centre, ball.velocity - turn.velocity);
        let radius = at.yz().norm();
        let along = v.dot(&directions.tangential) - radius * turn.speed;
        [(at.dot(&directions.tangential) / radius).abs(), along.abs()]
    };
    let all = state.balls.iter().zip(&spacing.azimuths).map(of);
    all.fold([0.0, 0.0], |[a, b], [c, d]| [f64::max(a, c), f64::max(b, d)])
}

const RUN_UP: [(&str, &str); 1] =
    [("load.inner_speed", "[[0, \"0 rpm\"], [\"10 ms\", \"6000 rpm\"], [\"20 ms\", \"-3000 rpm\"]]")];

#[test]
fn invariant_spacing_is_even_from_rest_through_a_reversal() {
    let mut largest = [0.0f64; 2];
    let mut pockets = 0.0f64;
    run(&scene(FREE, &RUN_UP), [5e-4, 20e-3], |outputs, simulation| {
        let now = unevenness(simulation);
        largest = [0, 1].map(|k| largest[k].max(now[k]));
        pockets =
            outputs.balls.iter().filter_map(|ball| ball.pocket).fold(pockets, |most, of| most.max(of.load));
    });
    println!("{largest:?} rad, m/s; pocket {pockets} N");
    assert!(largest[0] < 1e-12 && largest[1] < 1e-12 && pockets > 0.1);
}

#[test]
fn invariant_moments_of_pockets_add_up_to_nothing_and_forces_to_the_change_of_momentum() {
    let mut simulation = run(&scene(FREE, &[]), [1e-3, 10e-3], |outputs, simulation| {
        let turn = simulation.state().spacing.clone().unwrap();
        let (mut sum, mut size) = (0.0, 0.0);
        for (ball, pocket) in outputs.balls.iter().zip(&turn.pockets) {
            let moment = pocket * (ball.position - turn.centre).yz().norm();
            sum += moment;
            size += f64::abs(moment);
        }
        assert!(f64::abs(sum) <= 1e-9 * size.max(1e-9), "{sum} {size}");
    });
    // Over a time all forces on the balls, the weight and those of races and guide, change their momentum.
    let azimuths = Spacing::new(&simulation.model().bearing).azimuths;
    let mass = simulation.model().bearing.ball.mass;
    let momentum = |simulation: &Simulation| {
        simulation.state().balls.iter().map(|ball| ball.velocity * mass).sum::<Vector3<f64>>()
    };
    let (before, start) = (momentum(&simulation), simulation.state().time);
    let force = |simulation: &Simulation| -> Vector3<f64> {
        let state = simulation.state();
        let weight = Vector3::y() * (mass * azimuths.len() as f64 * -9.81);
        // The force of the guide is one on the outer race.
        weight
            - Race::BOTH.map(|race| state.race(race).bearing_wrench.force).into_iter().sum::<Vector3<f64>>()
    };
    let guide = |turn: &CommonTurn| -> Vector3<f64> {
        azimuths
            .iter()
            .zip(&turn.pockets)
            .map(|(azimuth, pocket)| turn.directions(*azimuth).tangential * *pocket)
            .sum()
    };
    let (mut impulse, mut of_guide, mut time) = (Vector3::zeros(), Vector3::zeros(), start);
    for end in (1..=2000).map(|k| start + 1e-6 * f64::from(k)) {
        let first = force(&simulation);
        simulation.advance(end).unwrap();
        let h = simulation.state().time - time;
        impulse += (first + force(&simulation)) * (0.5 * h);
        of_guide += guide(simulation.state().spacing.as_ref().unwrap()) * h;
        time += h;
    }
    let gained = momentum(&simulation) - before;
    println!("{:?} {:?}, guide {:?}", impulse.yz(), gained.yz(), of_guide.yz());
    assert!((impulse - gained).yz().norm() < 0.01 * of_guide.yz().norm());
}

/// Under thrust every ball rolls alike: the common speed is that of each ball by itself, and no pocket has anything to do.
#[test]
fn closed_form_under_thrust_the_cage_turns_at_the_speed_of_rolling() {
    let [ideal, none] = ["\"ideal\"", "\"none\""].map(|word| scene(THRUST, &[("effects.cage", word)]));
    let last = |scene: &Scene| {
        let mut last = None;
        run(scene, [1e-3, 5e-3], |outputs, _| last = Some(outputs.clone()));
        last.unwrap()
    };
    let (with, without) = (last(&ideal), last(&none));
    let pocket =
        with.balls.iter().filter_map(|ball| ball.pocket).fold(0.0, |most: f64, of| most.max(of.load));
    println!("{} {} rad/s, slip {}, pocket {pocket} N", with.cage_speed, without.cage_speed, with.cage_slip);
    assert!((with.cage_speed / without.cage_speed - 1.0).abs() < 1e-7);
    assert!(with.cage_slip.abs() < 2e-3 && pocket < 1e-4 * with.balls[0].outer.load);
    assert!((with.friction_torque / without.friction_torque - 1.0).abs() < 1e-4);
}

#[test]
fn invariant_energy_closes_as_without_a_cage() {
    for changes in [vec![], RUN_UP.to_vec()] {
        let of = |word: &str| {
            let mut ends = vec![];
            let mut changes = changes.clone();
            changes.push(("effects.cage", word));
            run(&scene(FREE, &changes), [10e-3, 10e-3], |outputs, _| ends.push(outputs.clone()));
            let [before, after] = &ends[..] else { unreachable!() };
            let open = after.work - after.dissipated - (after.stored_energy - before.stored_energy);
            open.abs() / after.work.abs().max(after.dissipated).max(after.stored_energy)
        };
        let [with, without] = ["\"ideal\"", "\"none\""].map(of);
        println!("{with:e} {without:e}");
        assert!(with < 1e-3 && with < 3.0 * without.max(1e-5), "{with:e} {without:e}");
    }
}

#[test]
fn order_of_convergence_is_two() {
    let end = |h: f64| {
        let solver =
            format!("{{ initial_step = {h:e}, max_step = {h:e}, tolerance = 0.01, energy_error = 0 }}");
        let load = "[[0, -800], [\"0.5 ms\", -1000], [\"1 ms\", -700]]";
        let force = format!("{{ force = {load} }}");
        let scene = scene(FREE, &[("solver", &solver), ("load.y", &force)]);
        let simulation = run(&scene, [1e-3, 1e-3], |_, _| ());
        let (state, turn) = (simulation.state(), simulation.state().spacing.clone().unwrap());
        let at = state.bodies[Race::Inner].pose.position;
        [at.x, at.y, turn.angle * 0.02]
    };
    // Over a factor of eight in the step, against a step that is a fourth of the least.
    let [exact, least, most] = [1.25e-7, 5e-7, 4e-6].map(end);
    for (i, name) in ["x", "y", "angle of the cage"].into_iter().enumerate() {
        let error = |of: [f64; 3]| (of[i] - exact[i]).abs();
        let order = (error(most) / error(least)).log2() / 3.0;
        println!("{name}: {order} {:e} {:e}", error(most), error(least));
        assert!(order > 1.8, "{name}: {order}");
    }
}

/// Steps that follow all forces, as those of a cage that is a body do.
const FINE: (&str, &str) = ("solver.tolerance", "2e-9");

/// A cage that is a body, light and smooth: the less play it has, the nearer its speed is to that of an ideal one. With play balls roll at speeds
/// of their own while they are loaded. Torque is not compared: balls knock in the pockets of a body, which takes a few per cent.
#[test]
fn limit_a_light_smooth_cage_goes_to_an_ideal_one_with_its_play() {
    let body = |clearance: f64| {
        let section = format!(
            "{{ mass = \"0.5 g\", inertia = [2e-7, 1e-7, 1e-7], pocket_clearance = {clearance:e}, guided_by = \"outer\", \
             guidance_clearance = \"20 um\", land_diameter = \"42 mm\", land_width = \"2 mm\" }}"
        );
        let friction = [("friction.ball_cage", "0.0"), ("friction.cage_race", "0.0")];
        scene(FREE, &[("effects.cage", "true"), ("cage", &section), friction[0], friction[1], FINE])
    };
    let mean = |scene: &Scene| {
        let (mut sums, mut count) = ([0.0; 2], 0.0);
        run(scene, [5e-5, 30e-3], |outputs, _| {
            if outputs.time > 10e-3 {
                let now = [outputs.cage_speed, outputs.inner.pose.position.y];
                sums = [0, 1].map(|k| sums[k] + now[k]);
                count += 1.0;
            }
        });
        sums.map(|sum| sum / count)
    };
    let ideal = mean(&scene(FREE, &[FINE]));
    let [tight, loose] = [40e-6, 320e-6].map(|clearance| {
        let body = mean(&body(clearance));
        [0, 1].map(|k| (body[k] / ideal[k] - 1.0).abs())
    });
    println!("{ideal:?}; {tight:?} {loose:?}");
    assert!(tight[0] < 0.4 * loose[0] && tight[0] < 2e-3, "speed {} {}", tight[0], loose[0]);
    assert!(tight[1] < 0.01, "displacement {}", tight[1]);
}

/// From rest balls without load stay behind, and strike each other unless something keeps them apart.
#[test]
fn limit_a_start_from_rest_has_no_blows() {
    let start = [
        ("bearing.balls", "14"),
        ("load.duration", "\"60 ms\""),
        ("load.inner_speed", "[[0, \"0 rpm\"], [\"3 ms\", \"9000 rpm\"]]"),
        ("load.y", "{ force = \"-300 N\" }"),
    ];
    let most = |word: &str| {
        let (mut most, mut blow) = (0.0f64, 0.0f64);
        let mut changes = start.to_vec();
        changes.push(("effects.cage", word));
        run(&scene(FREE, &changes), [2e-5, 60e-3], |outputs, _| {
            most = outputs.loads().fold(most, f64::max);
            blow = outputs.neighbours.as_ref().map_or(blow, |own| own.largest_load.max(blow));
        });
        [most, blow]
    };
    let [[with, none], [without, blow]] = ["\"ideal\"", "\"none\""].map(most);
    println!("{with} {none} N with, {without} {blow} N without");
    assert_eq!(none, 0.0);
    assert!(blow > 1.0 && with < without, "{with} {without} {blow}");
}

#[test]
fn invariant_a_snapshot_goes_on_to_the_same_bits() {
    let scene = scene(FREE, &RUN_UP);
    let mut one = run(&scene, [3e-3, 3e-3], |_, _| ());
    let snapshot = one.snapshot();
    let outputs = one.outputs().clone();
    one.advance(5e-3).unwrap();
    let mut other = Simulation::new(&scene).unwrap();
    assert!(other.restore(&snapshot));
    assert_eq!(*other.outputs(), outputs);
    other.advance(5e-3).unwrap();
    assert_eq!((one.state(), one.outputs()), (other.state(), other.outputs()));
    // A bearing without a cage is another one.
    let mut without = Simulation::new(&self::scene(FREE, &[("effects.cage", "\"none\"")])).unwrap();
    assert!(!without.restore(&snapshot));
}

/// An outer race that is moved takes the centre of the cage along: everything is as where it rests.
#[test]
fn invariant_a_bearing_that_moves_on_evenly_is_one_at_rest() {
    let place = |speed: f64| {
        let scene = scene(
            THRUST,
            &[("effects.cage", "\"ideal\""), ("outer.drive", "\"pose\""), ("inner.drive", "\"pose\"")],
        );
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut inputs = *simulation.inputs();
        for race in Race::BOTH {
            inputs[race].twist.velocity.y = speed;
        }
        simulation.set_inputs(inputs);
        simulation.initialise().unwrap();
        simulation.advance(2e-3).unwrap();
        simulation.outputs().clone()
    };
    let (rests, moves) = (place(0.0), place(1.0));
    println!(
        "{} {}, {} {}",
        rests.cage_speed, moves.cage_speed, rests.balls[1].outer.load, moves.balls[1].outer.load
    );
    assert!((rests.cage_speed / moves.cage_speed - 1.0).abs() < 1e-6);
    assert!((rests.balls[1].outer.load / moves.balls[1].outer.load - 1.0).abs() < 1e-6);
}

#[test]
fn a_word_that_is_no_cage_is_refused_with_what_could_be_written() {
    let refused = |word: &str| Scene::edited(FREE, [("effects.cage", word)]).unwrap_err().to_string();
    let why = refused("\"idael\"");
    assert!(why.contains("effects.cage") && why.contains("\"ideal\", \"none\", true or false"), "{why}");
    let why = refused("true");
    assert!(why.contains("effects.cage = \"ideal\""), "{why}");
    let section = (
        "cage",
        "{ mass = 0.01, inertia = [1e-6, 1e-6, 1e-6], pocket_clearance = 1e-4, guided_by = \"balls\" }",
    );
    let why = Scene::edited(FREE, [section]).unwrap_err().to_string();
    assert!(why.contains("cage") && why.contains("effects.cage = true"), "{why}");
}

#[test]
fn an_outer_race_that_forces_move_is_refused_beside_an_ideal_cage() {
    let held = [
        ("inner.drive", "\"pose\""),
        ("outer.drive", "\"wrench\""),
        ("load.y.force", ""),
        ("load.x.force", ""),
    ];
    let body = [("outer.mass", "0.3"), ("outer.inertia", "[1e-4, 1e-4, 1e-4]")];
    let supported = [
        ("outer.support.stiffness", "[1e8, 1e8, 1e8, 1e4, 1e4, 1e4]"),
        ("outer.support.mass", "0.3"),
        ("outer.support.inertia", "[1e-4, 1e-4, 1e-4]"),
        ("outer.drive", "\"pose\""),
    ];
    let hinged = [("outer.drive", "\"hinge\"")];
    for changes in [
        [held.as_slice(), body.as_slice()].concat(),
        supported.to_vec(),
        [hinged.as_slice(), body.as_slice()].concat(),
    ] {
        let why = Scene::edited(FREE, changes.iter().copied()).unwrap_err().to_string();
        assert!(why.contains("effects.cage") && why.contains("whose motion must be given"), "{why}");
        let other = changes.iter().copied().chain([("effects.cage", "\"none\"")]);
        let why = Scene::edited(FREE, other).err().map_or(String::new(), |why| why.to_string());
        assert!(!why.contains("effects.cage"), "{why}");
    }
    // On shafts: in a housing, and in a bore that is tilted, which a structure stands for; straight in the ground it is held.
    let housing = include_str!("../../scenes/shafts/housing.toml");
    let pinion = include_str!("../../scenes/shafts/pinion.toml");
    let folder = std::path::Path::new(roulement_tests::ROOT).join("scenes/shafts");
    let parsed = |text: &str| {
        let text = text.replace("[[bearing]]\n", "[[bearing]]\nset = { effects = { cage = \"ideal\" } }\n");
        SystemScene::parse(&text, None, &folder).err().map_or(String::new(), |why| why.to_string())
    };
    let tilted = pinion.replacen("direction = \"-x\"", "direction = \"-x\", misalignment = { ry = 1e-4 }", 1);
    for text in [housing, &tilted] {
        let why = parsed(text);
        assert!(why.contains("effects.cage") && why.contains("whose motion must be given"), "{why}");
    }
    assert_eq!(parsed(pinion), "");
}
