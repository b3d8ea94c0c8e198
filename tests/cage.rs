//! The cage: contacts of pockets and lands, motion, energy, cost, and scenes that are refused.
#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use roulement::contact::body::BodyMotion;
use roulement::contact::land::{LandModel, Lands};
use roulement::contact::materials::Pair;
use roulement::contact::pair::PairForces;
use roulement::contact::pocket::PocketModel;
use roulement::contact::{BallMotion, RaceMotion};
use roulement::interface::variables::Variables;
use roulement::numerics::scalar::{Dual, Scalar, constant_vector};
use roulement::scene::{Guidance, Scene};
use roulement::simulation::Simulation;
use roulement::simulation::outputs::{CageOutput, Outputs, PocketOutput};

#[path = "common/mechanics.rs"]
mod mechanics;
#[path = "common/random.rs"]
mod random;
#[path = "common/scenes.rs"]
mod scenes;

use mechanics::{Body, CageDimensions};
use random::{number, vector};
use scenes::scene;

const THRUST: &str = include_str!("../scenes/thrust.toml");
const CAGE: &str = include_str!("../scenes/cage.toml");
/// Half the diametral clearance of pockets and lands of the scene [m].
const HALF_CLEARANCE: f64 = 0.1e-3;

/// Goes on by the scene's own script for some communication steps; outputs at every one, the present first.
fn go_on(simulation: &mut Simulation, points: u32) -> Vec<Outputs> {
    let interval = simulation.scene().load.output_interval.0;
    let mut history = vec![simulation.outputs().clone()];
    let begin = simulation.time();
    for point in 1..=points {
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(begin + f64::from(point) * interval).unwrap();
        history.push(simulation.outputs().clone());
    }
    history
}

fn run(scene: &Scene, points: u32) -> (Simulation, Vec<Outputs>) {
    let mut simulation = Simulation::new(scene).unwrap();
    let history = go_on(&mut simulation, points);
    (simulation, history)
}

/// Changes of keys.
type Changes = [(&'static str, &'static str)];

/// The cage carried by the balls instead of the outer race.
const BALL_GUIDED: &Changes = &[
    ("cage.guided_by", "\"balls\""),
    ("cage.guidance_clearance", ""),
    ("cage.land_diameter", ""),
    ("cage.land_width", ""),
    ("friction.cage_race", ""),
];

/// The cage on lands of the inner race, which is a body.
const INNER_GUIDED: &Changes = &[("cage.guided_by", "\"inner\""), ("cage.land_diameter", "\"40 mm\"")];

/// Without the radial load.
const PURE_THRUST: &Changes = &[("load.z", "")];

/// The inner race braked from 6000 to 3000 rpm between two times [s], so that the cage runs into slower balls.
fn braked(changes: &Changes, from: f64, to: f64) -> Scene {
    let ramp = format!("[[0.0, \"6000 rpm\"], [{from}, \"6000 rpm\"], [{to}, \"3000 rpm\"]]");
    scene(CAGE, &[changes, &[("load.inner_speed", &ramp)]].concat())
}

fn cage(outputs: &Outputs) -> CageOutput {
    outputs.cage.unwrap()
}

fn pockets(outputs: &Outputs) -> impl Iterator<Item = PocketOutput> + '_ {
    outputs.balls.iter().map(|ball| ball.pocket.unwrap())
}

fn deepest_pocket(history: &[Outputs]) -> f64 {
    history.iter().flat_map(pockets).map(|pocket| pocket.approach).fold(f64::NEG_INFINITY, f64::max)
}

/// Energy put in that is neither stored nor lost, over all that was put in or lost.
fn imbalance(history: &[Outputs]) -> f64 {
    let (first, last) = (&history[0], &history[history.len() - 1]);
    let balance = last.work - last.dissipated - (last.stored_energy - first.stored_energy);
    balance.abs() / (last.work.abs() + last.dissipated)
}

// contact kernels

/// A cylinder, and a sphere about the ball that is pressed into it.
fn pocket_models() -> [PocketModel; 2] {
    let pair = Pair::new([(206e9, 0.3), (105e9, 0.35)]);
    [None, Some(23e-3)].map(|sphere| PocketModel::new(4.7625e-3, 0.2e-3, sphere, &pair, 0.05, 0.5).unwrap())
}

fn lands(inside: bool) -> LandModel {
    let lands = Lands { inside, clearance: 0.2e-3, diameter: 52e-3, width: 2e-3, edge: 4.9e-3 };
    LandModel::new(&lands, 0.05, 0.5)
}

/// A rigid body somewhere in general motion.
fn body(k: usize) -> BodyMotion<f64> {
    let orientation = UnitQuaternion::new(vector(k) * 2e-3 + Vector3::x() * 0.7);
    BodyMotion {
        position: vector(k + 1) * 5e-6,
        axes: [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| orientation * axis),
        velocity: vector(k + 2) * 0.05,
        angular_velocity: Vector3::x() * 250.0 + vector(k + 3) * 5.0,
    }
}

const DIRECTION: [f64; 2] = [0.6, 0.8];

/// A ball pressed into the pocket of `body(k)`.
fn pressed_ball(k: usize) -> BallMotion<f64> {
    let cage = body(k);
    let axis = cage.axes[1] * DIRECTION[0] + cage.axes[2] * DIRECTION[1];
    let sideways = (vector(k + 4) - axis * axis.dot(&vector(k + 4))).normalize();
    let position = cage.position + axis * 23e-3 + sideways * (HALF_CLEARANCE + 0.4e-6);
    BallMotion {
        position,
        velocity: cage.velocity
            + cage.angular_velocity.cross(&(position - cage.position))
            + vector(k + 5) * 0.1,
        angular_velocity: Vector3::new(-1200.0, 100.0, 300.0) + vector(k + 6) * 50.0,
    }
}

/// A race pressed against the lands of `body(k)`.
fn pressed_race(k: usize) -> RaceMotion<f64> {
    let cage = body(k);
    let across = Vector3::new(0.0, number(k), number(k + 9)).normalize();
    RaceMotion {
        position: cage.position - across * (HALF_CLEARANCE + 20e-6),
        axis: (Vector3::x() + vector(k + 7) * 1e-3).normalize(),
        velocity: vector(k + 8) * 0.1,
        angular_velocity: Vector3::x() * 600.0 + vector(k + 9),
    }
}

#[test]
fn invariant_forces_take_the_power_that_is_lost_or_stored() {
    // Power of the forces on both bodies is minus friction, damping and the growth of elastic energy.
    let h = 1e-9;
    let check = |contact: PairForces<f64>, power: f64, growth: f64| {
        let lost = contact.friction_power + contact.damping_power;
        assert!(contact.load > 0.0 && contact.friction_power > 0.0);
        assert!((power + lost + growth).abs() < 1e-5 * (power.abs() + lost.abs()), "{power} {lost} {growth}");
    };
    for (k, model) in (0..8).flat_map(|k| pocket_models().map(|model| (k, model))) {
        let (cage, ball) = (body(k), pressed_ball(k));
        let contact = model.evaluate(&ball, &cage, DIRECTION).unwrap();
        let power = contact.force.dot(&(ball.velocity - cage.velocity))
            + contact.moment.dot(&ball.angular_velocity)
            + contact.other_moment.dot(&cage.angular_velocity);
        let moved = |h: f64| {
            let turn = UnitQuaternion::new(cage.angular_velocity * h);
            let later = BodyMotion {
                position: cage.position + cage.velocity * h,
                axes: cage.axes.map(|axis| turn * axis),
                ..cage
            };
            let ball = BallMotion { position: ball.position + ball.velocity * h, ..ball };
            model.elastic_energy(model.approach(&ball, &later, DIRECTION))
        };
        check(contact, power, (moved(h) - moved(-h)) / (2.0 * h));

        for inside in [true, false] {
            let (race, model) = (pressed_race(k), lands(inside));
            let contact = model.evaluate(&cage, &race, model.positions[0]).unwrap();
            let power = contact.force.dot(&(cage.velocity - race.velocity))
                + contact.moment.dot(&cage.angular_velocity)
                + contact.other_moment.dot(&race.angular_velocity);
            let moved = |h: f64| {
                let turn = |w: &Vector3<f64>| UnitQuaternion::new(w * h);
                let later = BodyMotion {
                    position: cage.position + cage.velocity * h,
                    axes: cage.axes.map(|axis| turn(&cage.angular_velocity) * axis),
                    ..cage
                };
                let race = RaceMotion {
                    position: race.position + race.velocity * h,
                    axis: turn(&race.angular_velocity) * race.axis,
                    ..race
                };
                model.elastic_energy(model.approach(&later, &race, model.positions[0]))
            };
            check(contact, power, (moved(h) - moved(-h)) / (2.0 * h));
        }
    }
}

#[test]
fn identity_derivatives_of_both_contacts_agree_with_differences() {
    // along a general change of ball position, velocity and spin; of cage position, velocity and spin
    fn lift<S: Scalar>(motion: &BodyMotion<f64>, t: S, [a, b, c]: [Vector3<f64>; 3]) -> BodyMotion<S> {
        let line = |x: &Vector3<f64>, d: &Vector3<f64>| constant_vector::<S>(x) + d.map(|d| t.scale(d));
        BodyMotion {
            position: line(&motion.position, &a),
            axes: motion.axes.each_ref().map(constant_vector),
            velocity: line(&motion.velocity, &b),
            angular_velocity: line(&motion.angular_velocity, &c),
        }
    }
    let change = |k: usize| [vector(k) * 1e-3, vector(k + 1) * 10.0, vector(k + 2) * 100.0];
    let compare = |exact: PairForces<Dual<1>>, [after, before]: [PairForces<f64>; 2], h: f64| {
        for (exact, after, before) in [
            (exact.force, after.force, before.force),
            (exact.moment, after.moment, before.moment),
            (exact.other_moment, after.other_moment, before.other_moment),
        ] {
            let (slope, difference) = (exact.map(|x| x.derivatives[0]), (after - before) / (2.0 * h));
            assert!((slope - difference).norm() < 2e-5 * slope.norm(), "{slope} {difference}");
        }
    };
    let h = 1e-7;
    for (k, pocket) in (0..8).flat_map(|k| pocket_models().map(|model| (k, model))) {
        let (cage, ball) = (body(k), pressed_ball(k));
        let still = [Vector3::zeros(); 3];
        let as_body = BodyMotion {
            position: ball.position,
            axes: cage.axes,
            velocity: ball.velocity,
            angular_velocity: ball.angular_velocity,
        };
        fn ball_of<S: Scalar>(body: &BodyMotion<S>) -> BallMotion<S> {
            BallMotion {
                position: body.position,
                velocity: body.velocity,
                angular_velocity: body.angular_velocity,
            }
        }
        let at = |t: f64| {
            let ball = ball_of(&lift(&as_body, t, change(k + 10)));
            pocket.evaluate(&ball, &lift(&cage, t, change(k + 20)), DIRECTION).unwrap()
        };
        let t = Dual::<1>::variable(0.0, 0, 1.0);
        let seeded = ball_of(&lift(&as_body, t, change(k + 10)));
        let exact = pocket.evaluate(&seeded, &lift(&cage, t, change(k + 20)), DIRECTION).unwrap();
        compare(exact, [at(h), at(-h)], h);

        let (land, race) = (lands(false), pressed_race(k));
        let fixed = |race: &RaceMotion<f64>| RaceMotion {
            position: constant_vector::<Dual<1>>(&race.position),
            axis: constant_vector(&race.axis),
            velocity: constant_vector(&race.velocity),
            angular_velocity: constant_vector(&race.angular_velocity),
        };
        let at = |t: f64| land.evaluate(&lift(&cage, t, change(k + 20)), &race, land.positions[1]).unwrap();
        let exact = land.evaluate(&lift(&cage, t, change(k + 20)), &fixed(&race), land.positions[1]).unwrap();
        compare(exact, [at(h), at(-h)], h);
        assert!(pocket.evaluate(&ball, &lift(&cage, 0.0, still), DIRECTION).is_some());
    }
}

#[test]
fn closed_form_pocket_forces_from_rolling_to_sliding() {
    // A ball that rolls in its pocket with little slip and spin, and one that slides, against own formulas.
    // In brass, and in a polymer on which friction is high: there creepages are large before all slides.
    let (mut rolling, mut coupled) = (0, 0);
    for (k, sphere) in (0..48).map(|k| (k, if k % 2 == 0 { None } else { Some(23e-3) })) {
        let (cage_material, friction) = if k < 24 { ((105e9, 0.3), 0.05) } else { ((2e9, 0.3), 0.8) };
        let materials = [(310e9, 0.26), cage_material];
        let clearance = 2.0 * HALF_CLEARANCE;
        let model =
            PocketModel::new(4.7625e-3, clearance, sphere, &Pair::new(materials), friction, 0.5).unwrap();
        let dimensions = CageDimensions {
            ball_radius: 4.7625e-3,
            materials,
            pocket_clearance: clearance,
            ball_friction: friction,
            land_friction: 0.05,
            damping: 0.5,
            sphere,
            lands: None,
        };
        let cage = body(k);
        let mut ball = pressed_ball(k);
        // Rolling: the ball turns with the cage, and on the pocket at some speed, with some slip and spin.
        let axis = cage.axes[1] * DIRECTION[0] + cage.axes[2] * DIRECTION[1];
        let offset = ball.position - cage.position;
        let normal = (offset - axis * sphere.unwrap_or(offset.dot(&axis))).normalize();
        let along = vector(k + 30).cross(&normal).normalize();
        let speed = 0.5 + number(k + 40).abs();
        let size = [1e-3, 1e-2, 0.1][k % 3];
        ball.angular_velocity = cage.angular_velocity - normal.cross(&along) * (speed / 4.7625e-3)
            + vector(k + 31) * (20.0 * size)
            + normal * (number(k + 33) * 3e3 * size);
        ball.velocity = cage.velocity
            + cage.angular_velocity.cross(&offset)
            + along * speed
            + vector(k + 32) * (0.1 * size);
        let pose = |position, orientation, velocity, omega| Body { position, orientation, velocity, omega };
        let orientation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_basis_unchecked(&cage.axes));
        let bodies = [
            pose(ball.position, UnitQuaternion::identity(), ball.velocity, ball.angular_velocity),
            pose(cage.position, orientation, cage.velocity, cage.angular_velocity),
        ];
        let expected = dimensions.pocket(DIRECTION[1].atan2(DIRECTION[0]), &bodies[0], &bodies[1]).unwrap();
        let contact = model.evaluate(&ball, &cage, DIRECTION).unwrap();
        let limit = friction * expected.load;
        assert!((contact.load / expected.load - 1.0).abs() < 1e-6, "{} {}", contact.load, expected.load);
        assert!((contact.force - expected.force).norm() < 5e-3 * limit, "{contact:?} {expected:?}");
        assert!((contact.moment - expected.moment).norm() < 5e-3 * limit * 4.7625e-3);
        let arm = 23e-3 * limit + 1e-6 * 23e-3 * expected.load;
        assert!((contact.other_moment - expected.other_moment).norm() < 5e-3 * arm);
        let [x, y, _] = expected.friction.forces;
        rolling += u32::from(f64::hypot(x, y) < 0.7 * limit);
        let [_, eta, phi] = expected.friction.creepages;
        let c = (expected.semi[0] * expected.semi[1]).sqrt();
        coupled +=
            u32::from(sphere.is_none() && (phi * c).abs() > 0.3 * eta.abs() && f64::hypot(x, y) < limit);
    }
    assert!(rolling > 5 && coupled > 2, "{rolling} {coupled}");
}

#[test]
fn closed_form_friction_is_bounded_and_nothing_acts_across_a_gap() {
    for (k, pocket) in (0..8).flat_map(|k| pocket_models().map(|model| (k, model))) {
        let (cage, ball) = (body(k), pressed_ball(k));
        let contact = pocket.evaluate(&ball, &cage, DIRECTION).unwrap();
        let tangential = (contact.force.norm_squared() - contact.load.powi(2)).sqrt();
        assert!(tangential <= 0.05 * contact.load * (1.0 + 1e-9), "{tangential} {}", contact.load);
        // A ball that spins at 1200 rad/s in its pocket slides: nearly all of mu Q acts.
        assert!(tangential > 0.9 * 0.05 * contact.load);
        let axis = cage.axes[1] * DIRECTION[0] + cage.axes[2] * DIRECTION[1];
        let centred = BallMotion { position: cage.position + axis * 23e-3, ..ball };
        assert!(pocket.evaluate(&centred, &cage, DIRECTION).is_none());
        let race = RaceMotion { position: cage.position, ..pressed_race(k) };
        assert!(lands(false).evaluate(&cage, &race, 0.0).is_none());
    }
}

// whole bearings

#[test]
fn invariant_pocket_and_land_forces_accelerate_the_cage() {
    for guidance in [&[][..], INNER_GUIDED, BALL_GUIDED] {
        let (mut simulation, _) = run(&braked(guidance, 1e-3, 8e-3), 50);
        let (mass, alpha_f) = (0.02, 0.05);
        let weight = Vector3::z() * (-9.81 * mass);
        let total = |o: &Outputs| cage(o).pocket_force + cage(o).land_force + weight;
        let (mut loaded, mut compared) = (0, 0);
        for _ in 0..400 {
            let (before, steps) = (simulation.outputs().clone(), simulation.state().statistics.steps);
            simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
            simulation.advance(simulation.time() + 1e-6).unwrap();
            // one step of the scheme: m a1 = (1 - alpha_f) g1 + alpha_f g0
            if simulation.state().statistics.steps == steps + 1 {
                let (force, last) = (total(simulation.outputs()), total(&before));
                let expected = force * (1.0 - alpha_f) + last * alpha_f;
                let inertial = simulation.state().cage().unwrap().acceleration * mass;
                let scale = 1e-5 + 1e-7 * pockets(simulation.outputs()).map(|p| p.load).sum::<f64>();
                assert!((inertial - expected).norm() < scale, "{inertial} {expected}");
                compared += 1;
                loaded += u32::from(pockets(simulation.outputs()).any(|pocket| pocket.load > 0.0));
            }
        }
        assert!(compared > 100 && loaded > 10, "{compared} steps compared, {loaded} with a loaded pocket");
    }
}

#[test]
fn closed_form_cage_runs_at_the_epicyclic_speed_under_thrust() {
    for guidance in [&[][..], INNER_GUIDED, BALL_GUIDED] {
        let (_, history) = run(&scene(CAGE, &[guidance, PURE_THRUST].concat()), 300);
        for outputs in &history[100..] {
            assert!(outputs.cage_slip.abs() < 1e-2, "{} at {} s", outputs.cage_slip, outputs.time);
        }
        // Balls stay in their pockets, so that on the mean the cage goes with them.
        let mean = |get: &dyn Fn(&Outputs) -> f64| history[100..].iter().map(get).sum::<f64>() / 201.0;
        let balls = mean(&|o| o.balls.iter().map(|b| b.orbital_speed).sum::<f64>() / o.balls.len() as f64);
        let turned = mean(&|o| o.cage_speed);
        assert!((turned / balls - 1.0).abs() < 5e-3, "{turned} {balls}");
        assert!(deepest_pocket(&history) < 2e-6, "{}", deepest_pocket(&history));
    }
}

#[test]
fn invariant_energy_balance_with_every_guidance() {
    for guidance in [&[][..], INNER_GUIDED, BALL_GUIDED] {
        let (simulation, history) = run(&braked(guidance, 10e-3, 20e-3), 300);
        let lands = simulation.scene().effects.cage.section.unwrap().guided_by != Guidance::Balls;
        // Asked for: 1 % of work plus friction.
        assert!(imbalance(&history) < 1e-3, "{}", imbalance(&history));
        for outputs in &history {
            let of_contacts: f64 = outputs.balls.iter().map(|b| b.inner.power + b.outer.power).sum();
            let parts = of_contacts + cage(outputs).pocket_power + cage(outputs).land_power;
            assert!((parts / outputs.friction_power - 1.0).abs() < 1e-9);
        }
        assert!(history.iter().any(|o| cage(o).pocket_power > 0.1), "the pockets never rubbed");
        assert_eq!(history.iter().any(|o| cage(o).land_power > 0.1), lands);
    }
}

#[test]
fn start_from_rest_takes_the_cage_along() {
    let speed = "[[0.0, 0.0], [0.02, \"6000 rpm\"]]";
    let (_, history) = run(&scene(CAGE, &[("load.inner_speed", speed)]), 300);
    assert_eq!(history[0].cage_speed, 0.0);
    let last = &history[300];
    assert!(last.cage_slip.abs() < 0.02, "{}", last.cage_slip);
    assert!(history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated));
    assert!(deepest_pocket(&history) < 5e-6 && cage(last).turned > 1.0);
    assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
}

#[test]
fn invariant_balls_that_jump_in_their_pockets_stay_in_them() {
    let (simulation, history) = run(&braked(&[], 1e-3, 3e-3), 150);
    let touched = |o: &Outputs, j: usize| o.balls[j].pocket.unwrap().load > 0.0;
    let changes: usize =
        (0..10).map(|j| history.windows(2).filter(|w| touched(&w[0], j) != touched(&w[1], j)).count()).sum();
    assert!(changes >= 20, "{changes} changes of contact");
    // No deeper than if all balls' change of speed met the whole cage at one pocket without damping.
    let speed = 0.5 * 0.5 * 628.0 * 23e-3;
    let model = simulation.model().cage.as_ref().unwrap();
    let energy = model.pocket.elastic_energy(deepest_pocket(&history));
    assert!(energy < 0.5 * 0.02 * speed * speed, "{energy} J at {} m", deepest_pocket(&history));
    assert!(deepest_pocket(&history) > 0.0 && deepest_pocket(&history) < 0.1 * HALF_CLEARANCE);
    assert!(history[150].cage_slip.abs() < 0.03, "{}", history[150].cage_slip);
    assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
}

#[test]
fn invariant_whirl_is_bounded_by_the_land_clearance() {
    // A cage under its weight and the friction of the land, in a bearing with radial load.
    for guidance in [&[][..], INNER_GUIDED] {
        let (_, history) = run(&scene(CAGE, guidance), 500);
        let mut touched = 0;
        for outputs in &history {
            let cage = cage(outputs);
            assert!(cage.land_approach < 3e-6, "{} at {}", cage.land_approach, outputs.time);
            assert!(cage.eccentricity.yz().norm() < HALF_CLEARANCE + 3e-6);
            touched += u32::from(cage.land_loads.iter().any(|load| *load > 0.0));
        }
        assert!(touched > 5, "the land was touched at {touched} points");
        assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
    }
}

#[test]
fn invariant_spherical_pockets_carry_a_cage_without_lands() {
    let (_, history) = run(&scene(CAGE, BALL_GUIDED), 500);
    // The balls themselves run up to 20 um off the pitch circle under this load.
    let largest = history.iter().map(|o| cage(o).eccentricity.yz().norm()).fold(0.0, f64::max);
    assert!(largest > 0.5 * HALF_CLEARANCE && largest < HALF_CLEARANCE + 20e-6, "{largest}");
    assert!(deepest_pocket(&history) < 0.05 * HALF_CLEARANCE);
    assert!(history.iter().all(|o| cage(o).land_loads == [0.0; 2]));
}

#[test]
fn invariant_refined_steps_give_the_same_statistics() {
    let statistics = ["\"10 us\"", "\"2.5 us\""].map(|max_step| {
        let (simulation, history) = run(&scene(CAGE, &[("solver.max_step", max_step)]), 400);
        // Exact tangents: few corrections a step, and no step given up.
        let s = &simulation.state().statistics;
        assert!(s.newton.iterations as f64 <= 3.0 * s.steps as f64 && s.rejected_newton == 0, "{s:?}");
        let mean = |get: fn(&Outputs) -> f64| history[200..].iter().map(get).sum::<f64>() / 201.0;
        [
            mean(|o| o.cage_speed),
            mean(|o| cage(o).pocket_power),
            mean(|o| cage(o).land_power),
            mean(|o| cage(o).eccentricity.yz().norm()),
        ]
    });
    for (coarse, fine) in statistics[0].into_iter().zip(statistics[1]) {
        assert!((coarse / fine - 1.0).abs() < 1e-2, "{statistics:?}");
    }
}

#[test]
fn invariant_hard_cases_run_through_within_the_clearances() {
    let cases: [&Changes; 6] = [
        &[("cage.damping", "0")],
        &[("friction.ball_cage", "0.3"), ("friction.cage_race", "0.3")],
        &[("load.z", ""), ("load.ry.rotation", "\"0.5 deg\"")],
        &[("cage.mass", "\"1 g\""), ("cage.inertia", "[5.5e-7, 3e-7, 3e-7]")],
        &[("load.x.force", "\"20 N\""), ("load.z.force", "\"-3000 N\"")],
        &[("load.inner_speed", "[[0, \"6000 rpm\"], [0.02, \"-6000 rpm\"]]")],
    ];
    // Balls climb both flanks under some of these loads.
    let whole = [("inner.shoulder_angle", "[1.5, 1.5]"), ("outer.shoulder_angle", "[1.5, 1.5]")];
    for case in cases {
        let (_, history) = run(&scene(CAGE, &[case, &whole].concat()), 300);
        let pocket = deepest_pocket(&history) / HALF_CLEARANCE;
        let land = history.iter().map(|o| cage(o).land_approach).fold(f64::NEG_INFINITY, f64::max);
        assert!(pocket < 0.1 && land < 0.1 * HALF_CLEARANCE, "{case:?}: {pocket} {land}");
        assert!(imbalance(&history) < 1e-2, "{case:?}: {}", imbalance(&history));
        assert!(history[300].cage_slip.abs() < 0.05, "{case:?}: {}", history[300].cage_slip);
    }
}

#[test]
fn invariant_misaligned_inner_race_keeps_excursions_within_the_pockets() {
    let (_, history) = run(&scene(CAGE, &[("load.ry.rotation", "\"0.1 deg\"")]), 400);
    // Balls run ahead and behind once per orbit: they use up the clearance and push the cage.
    let last = &history[200..];
    let largest = last.iter().flat_map(pockets).map(|pocket| pocket.load).fold(0.0, f64::max);
    assert!(largest > 0.0 && deepest_pocket(last) > 0.0);
    assert!(deepest_pocket(&history) < 0.05 * HALF_CLEARANCE, "{}", deepest_pocket(&history));
    let speeds: Vec<f64> = history[400].balls.iter().map(|ball| ball.orbital_speed).collect();
    let spread = speeds.iter().fold(0.0f64, |s, v| s.max((v - speeds[0]).abs()));
    assert!(spread > 0.1, "{speeds:?}");
    assert!(imbalance(&history) < 1e-2, "{}", imbalance(&history));
}

#[test]
fn invariant_without_the_effect_there_is_no_cage() {
    let scene = Scene::parse(THRUST).unwrap();
    let simulation = Simulation::new(&scene).unwrap();
    assert!(simulation.state().cage().is_none() && simulation.outputs().cage.is_none());
    assert!(simulation.model().cage.is_none() && simulation.model().border_size() == 7);
    let names = |scene: &Scene| -> Vec<String> {
        Variables::moving(scene, true).rows().iter().map(|row| row.name.clone()).collect()
    };
    let (without, with) = (names(&scene), names(&Scene::parse(CAGE).unwrap()));
    let of_cage = |name: &&String| name.starts_with("cage.") || name.contains(".pocket.");
    assert_eq!(without.iter().filter(of_cage).count(), 2);
    for name in ["cage.eccentricity.radius", "cage.land_force.y", "ball[10].pocket.load", "cage.position.z"] {
        assert!(with.iter().any(|given| given == name), "{name}");
    }
    assert_eq!(with.len() - without.len(), with.iter().filter(of_cage).count() - 2);
}

#[test]
fn invariant_a_snapshot_in_mid_contact_goes_on_to_the_same_bits() {
    let scene = braked(&[], 1e-3, 12e-3);
    let (mut simulation, _) = run(&scene, 60);
    let snapshot = simulation.snapshot();
    let first = go_on(&mut simulation, 40);
    let mut other = Simulation::new(&scene).unwrap();
    assert!(other.restore(&snapshot));
    let second = go_on(&mut other, 40);
    assert!(first == second && simulation.snapshot() == other.snapshot());
    assert!(first.iter().flat_map(pockets).any(|pocket| pocket.load > 0.0));
    // A state without a cage is of another bearing.
    assert!(!Simulation::new(&Scene::parse(THRUST).unwrap()).unwrap().restore(&snapshot));
}

#[test]
fn invariant_work_of_a_step_is_linear_in_the_number_of_balls() {
    // A ring of balls on a pitch circle that grows with their number: evaluations of contacts and corrections a step, counted.
    // Instructions are counted by scripts/ball-cost.
    let work = |balls: u32| {
        let changes = [
            ("bearing.balls", &*balls.to_string()),
            ("bearing.pitch_diameter", &format!("\"{} mm\"", 5 * balls)),
            ("cage.land_diameter", &format!("\"{} mm\"", 5 * balls + 6)),
            ("load.x.force", &format!("\"{} N\"", 150 * balls)),
        ];
        let (simulation, _) = run(&scene(CAGE, &changes), 10);
        let s = simulation.state().statistics;
        let contacts = (s.contact_values + s.contact_tangents) as f64 / f64::from(balls);
        [contacts / s.steps as f64, s.newton.iterations as f64 / s.steps as f64, s.steps as f64]
    };
    let [few, many] = [8, 64].map(work);
    println!("contacts per ball and step, corrections per step, steps; 8 balls: {few:?}, 64 balls: {many:?}");
    for (few, many) in few.into_iter().zip(many) {
        assert!(many < 1.6 * few, "{few} {many}");
    }
}

#[test]
fn wrong_sections_are_refused_by_name() {
    let cases = [
        ("effects.cage", "", &["cage", "effects.cage = true"][..]),
        ("cage.mass", "", &["cage.mass is missing", "20 g"]),
        ("cage.mass", "0", &["cage.mass = 0", "(0, 10000]"]),
        ("cage.mass", "\"20 mm\"", &["cage.mass", "20 mm", "mm measures something else"]),
        ("cage.inertia", "[-1.0, 6e-6, 6e-6]", &["cage.inertia.x = -1"]),
        ("cage.pocket_clearance", "0", &["cage.pocket_clearance = 0"]),
        ("cage.pocket_clearance", "\"4.75 mm\"", &["pockets overlap"]),
        ("cage.guided_by", "\"left\"", &["left", "inner"]),
        ("cage.guided_by", "\"balls\"", &["cage.guidance_clearance", "guided_by"]),
        ("cage.guidance_clearance", "", &["cage.guidance_clearance", "needed"]),
        ("cage.land_width", "", &["cage.land_width", "needed"]),
        ("cage.land_diameter", "\"20 mm\"", &["cage.land_diameter = 0.02"]),
        ("friction.ball_cage", "-1", &["friction.ball_cage = -1", "[0, 2]"]),
        ("cage.colour", "1", &["cage.colour is no known key", "guided_by"]),
    ];
    let refusal = |text, key, value| Scene::edited(text, [(key, value)]).unwrap_err().to_string();
    for (key, value, parts) in cases {
        let message = refusal(CAGE, key, value);
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
    assert!(refusal(THRUST, "effects.cage", "true").contains("effects.cage"));
    assert!(refusal(THRUST, "friction.ball_cage", "0.1").contains("friction.ball_cage"));
}
