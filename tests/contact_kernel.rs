//! The ball-race contact kernel and the creep laws, through the public interface.
#![allow(clippy::unwrap_used)]

#[path = "common/laws.rs"]
mod laws;

use laws::Laws;
use nalgebra::Vector3;
use roulement::contact::creep::{Creepage, Law, LinearTheory};
use roulement::contact::many::ContactGroup;
use roulement::contact::materials::Pair;
use roulement::contact::{BallMotion, BallRaceContact, ContactModel, RaceMotion};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::model::bodies::Race;
use roulement::model::{Conditions, Model};
use roulement::numerics::lanes::{Lanes, WIDTH};
use roulement::numerics::scalar::{Dual, Scalar};
use roulement::scene::Scene;

fn model() -> Model {
    Model::new(&Scene::parse(include_str!("../scenes/thrust.toml")).unwrap()).unwrap()
}

/// Ball 2 of the thrust case near its equilibrium, with slip, spin and tilt: 18 independent numbers.
fn motion(race: Race) -> [f64; 18] {
    let scene = Scene::parse(include_str!("../scenes/thrust.toml")).unwrap();
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

fn evaluate<S: Scalar>(
    model: &Model,
    (law, bend): (Law<'_>, Option<f64>),
    race: Race,
    x: &[S; 18],
) -> BallRaceContact<S> {
    let mut contact = model.contact(race, &Conditions::of_friction(0.08));
    (contact.law, contact.groove_bend) = (law, bend);
    evaluate_contact(&contact, x)
}

fn evaluate_contact<S: Scalar>(contact: &ContactModel<'_>, x: &[S; 18]) -> BallRaceContact<S> {
    let (ball, race) = motions_of(x);
    contact.evaluate(&ball, &race)
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

fn rows<S: Scalar>(contact: &BallRaceContact<S>) -> Vec<S> {
    let mut rows = vec![contact.load, contact.friction_power, contact.damping_power];
    for vector in [&contact.force, &contact.ball_moment, &contact.race_moment] {
        rows.extend(vector.iter().copied());
    }
    rows
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
            let dual: [Dual<18>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i, 1.0));
            let exact = rows(&evaluate(&model, (law, bend), race, &dual));
            assert!(exact[0].value > 50.0, "the contact must be loaded: {} N", exact[0].value);
            // `kalker` is itself the end of an iteration, known to some 1e-11: larger steps, larger rounding.
            let (wider, rounding, relative) =
                if name == "kalker" { (5.0, 1e-11, 3e-5) } else { (1.0, f64::EPSILON, 1e-6) };
            for i in 0..18 {
                let step = |i: usize| wider * step(i);
                let at = |sign: f64| {
                    let mut moved = x;
                    moved[i] += sign * step(i);
                    rows(&evaluate(&model, (law, bend), race, &moved))
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

/// The thrust bearing in oil.
fn oiled() -> Model {
    let changes = [("film.iso_vg", "68.0"), ("film.temperature", "70.0")];
    Model::new(&Scene::edited(include_str!("../scenes/thrust.toml"), changes).unwrap()).unwrap()
}

/// Contacts in oil, full and mixed, with the usual slip, hardly any, and at rest.
fn in_oil(mut check: impl FnMut(&str, &ContactModel<'_>, &[f64; 18])) {
    let model = oiled();
    let laws = Laws::new();
    for (name, law, bend) in
        laws.bounded().into_iter().flat_map(|(name, law)| [(name, law, None), (name, law, Some(100.0))])
    {
        for (race, lubrication) in [(Race::Inner, 1.0), (Race::Outer, 0.1), (Race::Inner, 1e-6)] {
            let conditions = Conditions { lubrication, ..Conditions::of_friction(0.08) };
            let mut contact = model.contact(race, &conditions);
            (contact.law, contact.groove_bend) = (law, bend);
            for speed in [1.0, 1e-3] {
                let mut x = motion(race);
                // Rolling and slip fall alike; positions stay.
                for rate in [3, 4, 5, 6, 7, 8, 14, 15, 16, 17] {
                    x[rate] *= speed;
                }
                check(&format!("{name} {bend:?} {race:?} {lubrication} {speed}"), &contact, &x);
            }
        }
    }
}

#[test]
fn invariant_films_have_exact_tangents() {
    in_oil(|name, contact, x| {
        let dual: [Dual<18>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i, 1.0));
        let exact = rows(&evaluate_contact(contact, &dual));
        assert!(exact[0].value > 50.0);
        for i in [0, 1, 3, 4, 5, 6, 7, 8, 15] {
            // Slow contacts change within smaller differences of their speeds.
            let slow = if x[15].abs() < 1.0 { 1e-3 } else { 1.0 };
            let step = match i {
                0..=2 => 2e-10,
                3..=5 => 1e-5 * slow,
                _ => 1e-3 * slow,
            };
            let at = |sign: f64| {
                let mut moved = *x;
                moved[i] += sign * step;
                rows(&evaluate_contact(contact, &moved))
            };
            let (p1, m1, p2, m2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
            let (relative, rounding) =
                if name.starts_with("kalker ") { (1e-4, 1e-11) } else { (1e-6, f64::EPSILON) };
            for (k, row) in exact.iter().enumerate() {
                let difference = (8.0 * (p1[k] - m1[k]) - (p2[k] - m2[k])) / (12.0 * step);
                let largest = [0, 3, 6]
                    .map(|first| (first..first + 3).map(|k| row.derivatives[k].abs()).fold(0.0, f64::max))
                    [(i / 3).min(2)];
                let floor = 30.0 * rounding * row.value.abs().max(exact[0].value * 1e-3) / step;
                let error = (difference - row.derivatives[i]).abs();
                assert!(
                    error < relative * largest + floor,
                    "{name} row {k} by {i}: {difference} {}",
                    row.derivatives[i]
                );
            }
        }
    });
}

#[test]
fn invariant_films_act_and_react_and_lose_power() {
    in_oil(|name, contact, x| {
        let forces = evaluate_contact(contact, x);
        let offset = Vector3::new(x[0] - x[9], x[1] - x[10], x[2] - x[11]);
        let balance = forces.ball_moment + offset.cross(&forces.force) + forces.race_moment;
        assert!(balance.norm() < 1e-12 * forces.race_moment.norm().max(1.0), "{name}");
        assert!(forces.friction_power > 0.0, "{name}");
        // What both bodies do is what is lost: power does not depend on the point that moments are taken about.
        let (ball, race) = motions_of(x);
        let done = forces.force.dot(&ball.velocity) + forces.ball_moment.dot(&ball.angular_velocity)
            - forces.force.dot(&race.velocity)
            + forces.race_moment.dot(&race.angular_velocity);
        let elastic = forces.load * {
            let arm = forces.geometry.normal * contact.surface.ball_radius;
            let slip = ball.velocity + ball.angular_velocity.cross(&arm)
                - race.velocity
                - race.angular_velocity.cross(&(offset + arm));
            slip.dot(&forces.geometry.normal)
        };
        let lost = -done - elastic;
        assert!(
            (lost - forces.friction_power).abs() < 1e-9 * (forces.friction_power + elastic.abs() + 1e-3),
            "{name}: {lost} {}",
            forces.friction_power
        );
        // Four at a time have the same bits, beside one that touches nothing.
        let away = BallMotion { position: ball.position - forces.geometry.normal * 1e-4, ..ball };
        let open = contact.evaluate(&away, &race);
        assert!(open.load == 0.0 && open.force == Vector3::zeros(), "{name}: {open:?}");
        let mut together = ContactGroup::filled(&forces);
        together.evaluate(contact, &race, &BallMotion::of_balls(&[ball, away, ball]));
        assert_eq!([together.contact(1), together.contact(2)], [open, forces], "{name}");
    });
}

#[test]
fn invariant_action_is_reaction_and_power_is_lost() {
    let model = model();
    let laws = Laws::new();
    for (_, law, bend) in all(&laws) {
        let contact = evaluate(&model, (law, bend), Race::Inner, &motion(Race::Inner));
        // Force and moments of ball and race balance about the race origin.
        let x = motion(Race::Inner);
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
        let dual: [Dual<18>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i, 1.0));
        let contact = evaluate(&model, (law, bend), Race::Outer, &dual);
        assert!(contact.geometry.approach.value < 0.0);
        for row in rows(&contact) {
            assert_eq!(row.value, 0.0);
            assert!(row.derivatives.iter().all(|d| *d == 0.0), "{name} {row:?}");
        }
    }
    // In oil, and with hysteresis against rolling.
    in_oil(|name, contact, x| {
        let touching = evaluate_contact(contact, x);
        let mut x = *x;
        for i in 0..3 {
            x[i] -= 1e-4 * touching.geometry.normal[i];
        }
        let (ball, race) = motions_of(&x);
        assert!(contact.is_open(&ball, &race), "{name}");
        let dual: [Dual<18>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i, 1.0));
        for row in rows(&evaluate_contact(&ContactModel { hysteresis: 1e-3, ..*contact }, &dual)) {
            assert!(row.value == 0.0 && row.derivatives.iter().all(|d| *d == 0.0), "{name} {row:?}");
        }
    });
}

#[test]
fn invariant_four_contacts_at_a_time_have_the_bits_of_one() {
    let model = model();
    let laws = Laws::new();
    for (name, law, bend) in all(&laws) {
        for race in Race::BOTH {
            let mut contact = model.contact(race, &Conditions::of_friction(0.08));
            (contact.law, contact.groove_bend) = (law, bend);
            // One ball as it is, one that slides, one that spins, one that touches nothing.
            let changes = [(0.0, 0.0, 0.0), (0.0, 0.4, 0.0), (1e-6, 0.0, 300.0), (-3e-5, 0.1, -5.0)];
            let vector = |x: &[f64; 18], i: usize| Vector3::new(x[i], x[i + 1], x[i + 2]);
            let x = motion(race);
            let motions = changes.map(|(inwards, slip, spin)| {
                let mut x = x;
                x[0] += if race == Race::Inner { -inwards } else { inwards };
                x[5] += slip;
                x[6] += spin;
                BallMotion {
                    position: vector(&x, 0),
                    velocity: vector(&x, 3),
                    angular_velocity: vector(&x, 6),
                }
            });
            let away = [0.0, 300.0, -2.0, 5e-3].map(|spin| {
                let BallMotion { angular_velocity, .. } = motions[0];
                BallMotion {
                    angular_velocity: angular_velocity + Vector3::new(spin, 0.1 * spin, 0.0),
                    ..motions[3]
                }
            });
            let axis = Vector3::new(1.0, x[13], -x[12]).normalize();
            let (position, velocity) = (vector(&x, 9), Vector3::repeat(x[14]));
            let race_motion = RaceMotion {
                position,
                axis,
                across: Vector3::y(),
                velocity,
                angular_velocity: vector(&x, 15),
            };
            let alone = motions.each_ref().map(|m| contact.evaluate(m, &race_motion));
            assert!(alone[0].load > 50.0 && alone[3].load == 0.0);

            // With the vectors that this processor has.
            for count in 1..=WIDTH {
                let mut together = ContactGroup::filled(&alone[3]);
                together.evaluate(&contact, &race_motion, &BallMotion::of_balls(&motions[..count]));
                for (lane, alone) in alone[..count].iter().enumerate() {
                    assert_eq!(together.contact(lane), *alone, "{name}");
                }
            }
            // Where none of them touches, costly laws are not asked: with the signs of beside one that does.
            for touching in [None, Some(motions[0])] {
                let mut balls = away;
                balls[0] = touching.unwrap_or(away[0]);
                let mut together = ContactGroup::filled(&alone[0]);
                together.evaluate(&contact, &race_motion, &BallMotion::of_balls(&balls));
                let bits = |contact: &_| rows::<f64>(contact).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                for (lane, ball) in balls.iter().enumerate() {
                    let alone = contact.evaluate(ball, &race_motion);
                    assert_eq!(bits(&together.contact(lane)), bits(&alone), "{name}, {lane}");
                    assert_eq!(contact.is_open(ball, &race_motion), alone.load == 0.0, "{name}, {lane}");
                }
            }
            // One by one.
            let mut together = ContactGroup::filled(&alone[3]);
            (0..WIDTH).for_each(|lane| together.set(lane, &alone[lane]));
            assert!((0..WIDTH).all(|lane| together.contact(lane) == alone[lane]), "{name}");
            // With those that every processor has.
            let ball = BallMotion {
                position: Lanes::vector(|lane| motions[lane].position),
                velocity: Lanes::vector(|lane| motions[lane].velocity),
                angular_velocity: Lanes::vector(|lane| motions[lane].angular_velocity),
            };
            let race = race_motion.constant::<Lanes>();
            let contacts = contact.evaluate(&ball, &race);
            assert_eq!(contacts.load, Lanes::from_fn(|lane| alone[lane].load), "{name}");
            assert_eq!(contacts.force, Lanes::vector(|lane| alone[lane].force), "{name}");
            assert_eq!(contacts.ball_moment, Lanes::vector(|lane| alone[lane].ball_moment), "{name}");
        }
    }
}

#[test]
fn invariant_laws_of_four_contacts_have_the_bits_of_one_and_of_derivatives() {
    let laws = Laws::new();
    let alone = laws::theory();
    // From rest to far beyond complete sliding, along and across the axes of the table and between its pieces.
    let slips = [0.0, 1e-16, -3e-7, 2e-4, -1.7e-3, 0.011, -0.4, 1e60];
    let spins = [0.0, -1e-13, 0.07, -2.3, 41.0, -900.0, 1e62];
    let mut creepages = vec![];
    for (longitudinal, lateral) in slips.into_iter().flat_map(|x| slips.map(|y| (x, y))) {
        for (place, spin) in spins.into_iter().enumerate() {
            // Rolling either way, and hardly.
            for cosine in [1.0, -1.0, 0.3, -1e-3] {
                let curvature = [0.0, 3e3, 1.5e5][place % 3];
                creepages.push((
                    Creepage { longitudinal, lateral, spin, curvature: None },
                    curvature,
                    cosine,
                ));
            }
        }
    }
    let at = |number: usize| creepages[number % creepages.len()];
    for law in [Law::Saturated, Law::Table(&laws.table), Law::Frozen(&laws.table, &[0.01, -0.02, 0.005, 0.0])]
    {
        for bent in [false, true] {
            let one = |number: usize| {
                let (creepage, curvature, cosine) = at(number);
                let theory = LinearTheory { coupling: cosine * alone.coupling, ..alone };
                (theory, Creepage { curvature: bent.then_some(curvature), ..creepage })
            };
            for first in 0..creepages.len() {
                let four: [_; WIDTH] = std::array::from_fn(|lane| one(first + 17 * lane));
                let of_theory =
                    |part: fn(&LinearTheory<f64>) -> f64| Lanes::from_fn(|lane| part(&four[lane].0));
                let of_creepage =
                    |part: fn(&Creepage<f64>) -> f64| Lanes::from_fn(|lane| part(&four[lane].1));
                let theory = LinearTheory {
                    longitudinal: of_theory(|x| x.longitudinal),
                    lateral: of_theory(|x| x.lateral),
                    coupling: of_theory(|x| x.coupling),
                    spin: of_theory(|x| x.spin),
                    friction_limit: of_theory(|x| x.friction_limit),
                    moment_limit: of_theory(|x| x.moment_limit),
                    mean_semi_axis: of_theory(|x| x.mean_semi_axis),
                    half_width: of_theory(|x| x.half_width),
                };
                let creepage = Creepage {
                    longitudinal: of_creepage(|x| x.longitudinal),
                    lateral: of_creepage(|x| x.lateral),
                    spin: of_creepage(|x| x.spin),
                    curvature: bent.then(|| of_creepage(|x| x.curvature.unwrap())),
                };
                let together = theory.forces(law, &creepage);
                for (lane, (theory, creepage)) in four.iter().enumerate() {
                    let expected = theory.forces(law, creepage);
                    let ours = together.zip_with(&together, |lanes, _| lanes.0[lane]);
                    assert_eq!(ours, expected, "{law:?} {theory:?} {creepage:?}");
                }
                let (theory, creepage) = &four[0];
                let dual = |x: f64| Dual::<1>::variable(x, 0, x);
                let theory = LinearTheory {
                    longitudinal: dual(theory.longitudinal),
                    lateral: dual(theory.lateral),
                    coupling: dual(theory.coupling),
                    spin: dual(theory.spin),
                    friction_limit: dual(theory.friction_limit),
                    moment_limit: dual(theory.moment_limit),
                    mean_semi_axis: dual(theory.mean_semi_axis),
                    half_width: dual(theory.half_width),
                };
                let forces = theory.forces(law, &creepage.zip_with(creepage, |x, _| dual(x)));
                let values = forces.zip_with(&forces, |force, _| force.value);
                assert_eq!(values, together.zip_with(&together, |lanes, _| lanes.0[0]), "{creepage:?}");
            }
        }
    }
}

/// Laws of a scene that have friction.
const FRICTION: [&str; 5] = ["linear", "regularised", "saturated", "kalker", "kalker_table"];

fn model_of(law: &str) -> Model {
    let creep = format!("\"{law}\"");
    let changes = [("effects.creep", &*creep), ("friction.ball_race", "2.0")];
    Model::new(&Scene::edited(include_str!("../scenes/thrust.toml"), changes).unwrap()).unwrap()
}

/// Numbers of [`motion`] with the ball turning about the circumference as well: it rolls obliquely, and slides.
fn oblique_motion(race: Race, turning: f64) -> [f64; 18] {
    let mut x = motion(race);
    let radius = x[1].hypot(x[2]);
    let around = [-x[2] / radius, x[1] / radius];
    x[7] += turning * around[0];
    x[8] += turning * around[1];
    x
}

/// A contact of a model as it is, at the 18 numbers of [`motion`].
fn as_simulated<S: Scalar>(model: &Model, race: Race, x: &[S; 18]) -> BallRaceContact<S> {
    let contact = model.contact(race, &Conditions::of_friction(0.08));
    evaluate_contact(&contact, x)
}

#[test]
fn invariant_oblique_rolling_has_exact_tangents() {
    // From hardly oblique to nearly across, both ways; through where the share of rolling across begins and is full.
    let mut seen = vec![];
    for law in FRICTION {
        let model = model_of(law);
        for race in Race::BOTH {
            for turning in [-3e3, -900.0, -250.0, 150.0, 400.0, 1500.0, 2e4] {
                let x = oblique_motion(race, turning);
                let dual: [Dual<18>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i, 1.0));
                let exact = rows(&as_simulated(&model, race, &dual));
                seen.push(as_simulated(&model, race, &x).rolling_cosine.abs());
                for i in 3..9 {
                    let step = if i < 6 { 1e-5 } else { 1e-3 };
                    let at = |sign: f64| {
                        let mut moved = x;
                        moved[i] += sign * step;
                        rows(&as_simulated(&model, race, &moved))
                    };
                    let (plus, minus) = (at(1.0), at(-1.0));
                    for (k, row) in exact.iter().enumerate() {
                        let difference = (plus[k] - minus[k]) / (2.0 * step);
                        let largest = (3..9).fold(0.0f64, |most, i| most.max(row.derivatives[i].abs()));
                        let floor = 1e2 * f64::EPSILON * row.value.abs().max(exact[0].value) / step;
                        let error = (difference - row.derivatives[i]).abs();
                        assert!(
                            error < 1e-4 * largest + floor,
                            "{law} {race:?} {turning} row {k} by {i}: {difference} {}",
                            row.derivatives[i]
                        );
                    }
                }
            }
        }
    }
    seen.sort_by(f64::total_cmp);
    assert!(seen[0] < 0.3 && seen[seen.len() - 1] > 0.99, "{seen:?}");
}

#[test]
fn invariant_oblique_contacts_beside_straight_ones_have_the_bits_of_one() {
    for law in FRICTION {
        let model = model_of(law);
        for race in Race::BOTH {
            let contact = model.contact(race, &Conditions::of_friction(0.08));
            let cosine =
                |turning: f64| as_simulated(&model, race, &oblique_motion(race, turning)).rolling_cosine;
            let straight = if cosine(-150.0).abs() > cosine(150.0).abs() { -150.0 } else { 150.0 };
            let x = [straight, 300.0, -5e3, 0.9 * straight].map(|turning| oblique_motion(race, turning));
            let motions = x.each_ref().map(|x| motions_of(x).0);
            let (_, race_motion) = motions_of(&x[0]);
            let alone = motions.each_ref().map(|ball| contact.evaluate(ball, &race_motion));
            assert!(alone[2].rolling_cosine.abs() < 0.9 && alone[0].rolling_cosine.abs() > 0.995);
            let mut together = ContactGroup::filled(&alone[0]);
            together.evaluate(&contact, &race_motion, &BallMotion::of_balls(&motions));
            for (lane, alone) in alone.iter().enumerate() {
                assert_eq!(together.contact(lane), *alone, "{law} {race:?} {lane}");
            }
            // Rolling along the circumference knows nothing of rolling across it.
            let mut straight = contact;
            straight.across = None;
            assert_eq!(straight.evaluate(&motions[0], &race_motion), alone[0], "{law}");
            assert_ne!(straight.evaluate(&motions[2], &race_motion).creep, alone[2].creep, "{law}");
        }
    }
}

#[test]
fn invariant_oblique_rolling_stays_within_the_limits_and_loses_power() {
    for law in FRICTION.into_iter().filter(|law| *law != "linear") {
        let model = model_of(law);
        for race in Race::BOTH {
            for turning in [-1e5, -3e3, -500.0, 100.0, 250.0, 1e3, 1e4] {
                let contact = as_simulated(&model, race, &oblique_motion(race, turning));
                let force = contact.creep.longitudinal.hypot(contact.creep.lateral);
                assert!(force <= 0.08 * contact.load * (1.0 + 1e-12), "{law} {race:?} {turning}");
                assert!(contact.friction_power > 0.0, "{law} {race:?} {turning}");
            }
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
            let all = contact.evaluate(&ball, &seen);
            contact.law = Law::Frictionless;
            let pressed = contact.evaluate(&ball, &seen);
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
