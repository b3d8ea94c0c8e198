//! The ball-race contact kernel and the creep laws, through the public interface.

mod lanes;
mod oblique;
mod oil;

use nalgebra::Vector3;
use roulement::contact::creep::{Creepage, Law, LinearTheory};
use roulement::contact::many::ContactGroup;
use roulement::contact::materials::Pair;
use roulement::contact::pair::PairForces;
use roulement::contact::{BallMotion, BallRaceContact, ContactModel, Path, RaceMotion};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::kalker::scaled_law::Difference;
use roulement::model::bodies::Race;
use roulement::model::{Conditions, Model};
use roulement::numerics::lanes::{Lanes, WIDTH};
use roulement::numerics::scalar::{Dual, Scalar};
use roulement::scene::Scene;

use crate::laws::{self, Laws};

fn model() -> Model {
    Model::new(&Scene::parse(include_str!("../../../scenes/thrust.toml")).unwrap()).unwrap()
}

/// Ball 2 of the thrust case near its equilibrium, with slip, spin and tilt: 18 independent numbers.
fn motion(race: Race) -> [f64; 18] {
    let scene = Scene::parse(include_str!("../../../scenes/thrust.toml")).unwrap();
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::None);
    let solution = equilibrium::solve(&model(), &input).unwrap();
    let ball = &solution.balls[1];
    let (displacement, speed) =
        if race == Race::Inner { (solution.displacement[0], 628.0) } else { (0.0, 0.3) };
    let (p, v, w) = (ball.position, ball.velocity, ball.angular_velocity);
    [
        // ball: position, velocity, angular velocity
        p.x,
        p.y,
        p.z,
        v.x + 0.002,
        v.y,
        v.z + 0.003,
        w.x + 0.5,
        w.y - 1.0,
        w.z + 0.7,
        // race: position, tilt (about y, z), velocity (all three alike), angular velocity
        displacement,
        1.0e-7,
        -2.0e-7,
        1e-5,
        -5e-6,
        1e-3,
        speed,
        1.5,
        -0.7,
    ]
}

/// Every law, on flat and on bent grooves.
fn all(laws: &Laws) -> Vec<(&'static str, Law<'_>, Option<f64>)> {
    let unbounded = [("frictionless", Law::Frictionless, None), ("linear", Law::Linear, None)];
    let bounded = laws.bounded().into_iter();
    unbounded
        .into_iter()
        .chain(bounded.flat_map(|(name, law)| [(name, law, None), (name, law, Some(100.0))]))
        .collect()
}

/// A contact of a model by this law.
fn by_law<'a>(model: &'a Model, (law, bend): (Law<'a>, Option<f64>), race: Race) -> ContactModel<'a> {
    let mut contact = model.contact(race, &Conditions::of_friction(0.08));
    (contact.law, contact.groove_bend) = (law, bend);
    contact
}

fn evaluated(contact: &ContactModel<'_>, x: &[f64; 18]) -> BallRaceContact<f64> {
    let (ball, race) = motions_of(x);
    contact.evaluated(&ball, &race)
}

/// Approach and rows of a contact with their derivatives by all numbers: nine directions at a time, as steps take them.
fn differentiated(contact: &ContactModel<'_>, x: &[f64; 18]) -> (Dual<18>, Vec<Dual<18>>) {
    const HALF: usize = 9;
    let [first, second] = [0, HALF].map(|begin| {
        let x: [Dual<HALF>; 18] = std::array::from_fn(|i| match i.checked_sub(begin) {
            Some(direction) if direction < HALF => Dual::variable(x[i], direction, 1.0),
            _ => Dual::constant(x[i]),
        });
        let (ball, race) = motions_of(&x);
        let forces = contact.differentiated(contact.path(false), &ball, &race);
        [vec![forces.approach], rows(&forces)].concat()
    });
    let mut all = first.iter().zip(&second).map(|(first, second)| Dual {
        value: first.value,
        derivatives: std::array::from_fn(|i| [first, second][i / HALF].derivatives[i % HALF]),
    });
    (all.next().unwrap(), all.collect())
}

/// Motions of ball and race of the 18 numbers.
fn motions_of<S: Scalar>(x: &[S; 18]) -> (BallMotion<S>, RaceMotion<S>) {
    let vector = |i: usize| Vector3::new(x[i], x[i + 1], x[i + 2]);
    let ball = BallMotion { position: vector(0), velocity: vector(3), angular_velocity: vector(6) };
    let tilt = Vector3::new(S::one(), x[13], -x[12]);
    let length = tilt.dot(&tilt).sqrt();
    let race = RaceMotion {
        position: vector(9),
        axis: tilt.map(|c| c / length),
        across: Vector3::y(),
        velocity: Vector3::new(x[14], x[14], x[14]),
        angular_velocity: vector(15),
    };
    (ball, race)
}

fn rows<S: Scalar>(forces: &PairForces<S>) -> Vec<S> {
    let mut rows = vec![forces.load, forces.friction_power, forces.damping_power];
    for vector in [&forces.force, &forces.moment, &forces.other_moment] {
        rows.extend(vector.iter().copied());
    }
    rows
}

/// [`rows`] at given numbers.
fn values(contact: &ContactModel<'_>, x: &[f64; 18]) -> Vec<f64> {
    rows(&PairForces::from(&evaluated(contact, x)))
}

/// Bits of the rows: two zeros of unlike sign differ.
fn bits(contact: &BallRaceContact<f64>) -> Vec<u64> {
    rows(&PairForces::from(contact)).into_iter().map(f64::to_bits).collect()
}

#[test]
fn invariant_exact_tangents_agree_with_differences_to_1e_6() {
    let model = model();
    // Steps that keep both truncation and rounding of central differences below 1e-7 of a row's largest derivative.
    let step = |i: usize| match i {
        0..=2 | 9..=11 => 2e-10,
        3..=5 | 14 => 1e-5,
        12 | 13 => 1e-8,
        _ => 1e-3,
    };
    let laws = Laws::new();
    for (name, law, bend) in all(&laws) {
        for race in Race::BOTH {
            let x = motion(race);
            let contact = by_law(&model, (law, bend), race);
            let (_, exact) = differentiated(&contact, &x);
            assert!(exact[0].value > 50.0, "the contact must be loaded: {} N", exact[0].value);
            // `kalker` is itself the end of an iteration, known to some 1e-11: larger steps, larger rounding.
            let (wider, rounding, relative) =
                if name == "kalker" { (5.0, 1e-11, 3e-5) } else { (1.0, f64::EPSILON, 1e-6) };
            for i in 0..18 {
                let step = |i: usize| wider * step(i);
                let at = |sign: f64| {
                    let mut moved = x;
                    moved[i] += sign * step(i);
                    values(&contact, &moved)
                };
                let (p1, m1, p2, m2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
                // Fourth-order central differences.
                for (k, row) in exact.iter().enumerate() {
                    let difference = (8.0 * (p1[k] - m1[k]) - (p2[k] - m2[k])) / (12.0 * step(i));
                    // Rounding of the row's value sets a floor: eps |value| over the step.
                    let floor = 30.0 * rounding * row.value.abs().max(exact[0].value * 1e-3) / step(i);
                    let tolerance = relative * row.derivatives[i].abs() + floor;
                    let error = (difference - row.derivatives[i]).abs();
                    assert!(
                        error < tolerance,
                        "{name} race {race:?} row {k} by {i}, {bend:?}: {difference} {}",
                        row.derivatives[i]
                    );
                }
            }
        }
    }
}

#[test]
fn invariant_action_is_reaction_and_power_is_lost() {
    let model = model();
    let laws = Laws::new();
    for (_, law, bend) in all(&laws) {
        let x = motion(Race::Inner);
        let contact = evaluated(&by_law(&model, (law, bend), Race::Inner), &x);
        // Force and moments of ball and race balance about the race origin.
        let offset = Vector3::new(x[0] - x[9], x[1] - x[10], x[2] - x[11]);
        let balance = contact.ball_moment + offset.cross(&contact.force) + contact.race_moment;
        assert!(balance.norm() < 1e-12 * contact.race_moment.norm().max(1.0));
        assert!(contact.friction_power >= 0.0);
    }
}

#[test]
fn an_open_contact_has_neither_force_nor_slope() {
    let model = model();
    let mut x = motion(Race::Outer);
    x[1] *= 0.999;
    x[2] *= 0.999;
    let laws = Laws::new();
    for (name, law, bend) in all(&laws) {
        let (approach, rows) = differentiated(&by_law(&model, (law, bend), Race::Outer), &x);
        assert!(approach.value < 0.0);
        for row in rows {
            assert_eq!(row.value, 0.0);
            assert!(row.derivatives.iter().all(|d| *d == 0.0), "{name} {row:?}");
        }
    }
}

#[test]
fn published_number_unlike_materials_after_kalker() {
    // 1/G = (1/G1 + 1/G2)/2 and nu/G = (nu1/G1 + nu2/G2)/2 (Kalker 1967), written out: G1 = 125 GPa, nu1 = 0.2 and
    // G2 = 50 GPa, nu2 = 0.35 give 1/G = 0.014/GPa, nu/G = 0.0043/GPa. Hertz: 0.96/300 + 0.8775/135 per GPa.
    let pair = Pair::new([(300e9, 0.2), (135e9, 0.35)]);
    assert!((pair.shear_modulus / (1e9 / 0.014) - 1.0).abs() < 1e-12, "{pair:?}");
    assert!((pair.poisson_ratio / (0.0043 / 0.014) - 1.0).abs() < 1e-12, "{pair:?}");
    assert!((pair.compliance / 9.7e-12 - 1.0).abs() < 1e-12, "{pair:?}");
}

#[test]
fn invariant_friction_that_is_off_is_not_computed_and_forces_are_the_same() {
    let model = model();
    for race in Race::BOTH {
        for damping in [0.0, 0.02] {
            let x = motion(race);
            let vector = |i: usize| Vector3::new(x[i], x[i + 1], x[i + 2]);
            let ball = BallMotion { position: vector(0), velocity: vector(3), angular_velocity: vector(6) };
            let seen = RaceMotion {
                position: vector(9),
                axis: Vector3::x(),
                across: Vector3::y(),
                velocity: vector(12),
                angular_velocity: vector(15),
            };
            let mut contact = model.contact(race, &Conditions::of_friction(0.0));
            contact.damping = damping.into();
            // Linear theory without stiffness computes everything, and has no force either.
            contact.law = Law::Saturated;
            let all = contact.evaluated(&ball, &seen);
            contact.law = Law::Frictionless;
            let pressed = contact.evaluated(&ball, &seen);
            assert!(all.load > 0.0);
            assert_eq!(
                (all.load, all.force, all.damping_power),
                (pressed.load, pressed.force, pressed.damping_power)
            );
            assert_eq!((all.stiffness, all.geometry), (pressed.stiffness, pressed.geometry));
            assert!((all.race_moment - pressed.race_moment).norm() < 1e-15 * all.race_moment.norm());
            assert_eq!(pressed.ball_moment, Vector3::zeros());
            // What no force depends on waits until it is reported.
            assert_eq!(
                (pressed.semi_axes, pressed.creepage.spin, pressed.rolling_speed),
                ([0.0; 2], 0.0, 0.0)
            );
            let completed = contact.completed(&pressed, &ball, &seen);
            assert_eq!((completed.force, completed.load), (pressed.force, pressed.load));
            assert_eq!((completed.creepage, completed.semi_axes), (all.creepage, all.semi_axes));
            assert_eq!(
                (completed.rolling_speed, completed.rolling_cosine),
                (all.rolling_speed, all.rolling_cosine)
            );
        }
    }
}
