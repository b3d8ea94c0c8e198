//! The ball-race contact kernel and the creep laws, through the public interface.
#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;
use roulement::contact::creep::{Creepage, Law, LinearTheory};
use roulement::contact::{BallMotion, BallRaceContact, RaceMotion};
use roulement::equilibrium::{self, EquilibriumInput, Gyroscopic};
use roulement::model::{INNER, Model, OUTER};
use roulement::scalar::{Dual, Scalar};
use roulement::scene::Scene;

const LAWS: [Law<'static>; 4] = [Law::Frictionless, Law::Linear, Law::Regularised, Law::Saturated];

fn model() -> Model {
    Model::new(&Scene::parse(include_str!("../scenes/thrust.toml")).unwrap()).unwrap()
}

/// Ball 2 of the thrust case near its equilibrium, with slip, spin and tilt: 18 independent numbers.
fn motion(race: usize) -> [f64; 18] {
    let scene = Scene::parse(include_str!("../scenes/thrust.toml")).unwrap();
    let input = EquilibriumInput::from_scene(&scene, Gyroscopic::None);
    let solution = equilibrium::solve(&model(), &input).unwrap();
    let ball = &solution.balls[1];
    let (displacement, speed) = if race == INNER { (solution.displacement[0], 628.0) } else { (0.0, 0.3) };
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

fn evaluate<S: Scalar>(model: &Model, law: Law<'_>, race: usize, x: &[S; 18]) -> BallRaceContact<S> {
    let mut contact = model.contact(race, 0.08);
    contact.law = law;
    let vector = |i: usize| Vector3::new(x[i], x[i + 1], x[i + 2]);
    let ball = BallMotion { position: vector(0), velocity: vector(3), angular_velocity: vector(6) };
    let tilt = Vector3::new(S::one(), x[13], -x[12]);
    let length = tilt.dot(&tilt).sqrt();
    let race = RaceMotion {
        position: vector(9),
        axis: tilt.map(|c| c / length),
        velocity: Vector3::new(x[14], x[14], x[14]),
        angular_velocity: vector(15),
    };
    contact.evaluate(&ball, &race)
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
    for law in LAWS {
        for race in [INNER, OUTER] {
            let x = motion(race);
            let dual: [Dual<18>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i, 1.0));
            let exact = rows(&evaluate(&model, law, race, &dual));
            assert!(exact[0].value > 50.0, "the contact must be loaded: {} N", exact[0].value);
            for i in 0..18 {
                let at = |sign: f64| {
                    let mut moved = x;
                    moved[i] += sign * step(i);
                    rows(&evaluate(&model, law, race, &moved))
                };
                let (p1, m1, p2, m2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
                // Fourth-order central differences.
                for (k, row) in exact.iter().enumerate() {
                    let difference = (8.0 * (p1[k] - m1[k]) - (p2[k] - m2[k])) / (12.0 * step(i));
                    // Rounding of the row's value sets a floor: eps |value| over the step.
                    let floor = 30.0 * f64::EPSILON * row.value.abs().max(exact[0].value * 1e-3) / step(i);
                    let tolerance = 1e-6 * row.derivatives[i].abs() + floor;
                    let error = (difference - row.derivatives[i]).abs();
                    assert!(
                        error < tolerance,
                        "{law:?} race {race} row {k} by {i}: {difference} {}",
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
    for law in LAWS {
        let contact = evaluate(&model, law, INNER, &motion(INNER));
        // Force and moments of ball and race balance about the race origin.
        let x = motion(INNER);
        let offset = Vector3::new(x[0] - x[9], x[1] - x[10], x[2] - x[11]);
        let balance = contact.ball_moment + offset.cross(&contact.force) + contact.race_moment;
        assert!(balance.norm() < 1e-12 * contact.race_moment.norm().max(1.0));
        assert!(contact.friction_power >= 0.0);
    }
}

/// Linear theory of a contact of 300 N, axis ratio about 0.1.
fn theory() -> LinearTheory<f64> {
    let (area, shear) = (4.0e-8, 7.9e10);
    LinearTheory {
        longitudinal: shear * area * 3.5,
        lateral: shear * area * 2.5,
        coupling: shear * area.powf(1.5) * 0.51,
        spin: shear * area.powi(2) * 8.8,
        friction_limit: 24.0,
        moment_limit: 24.0 * 2.0e-4 * 1.2,
        mean_semi_axis: 2.0e-4,
    }
}

/// Creepages over many magnitudes and all signs, rest and extremes included.
fn creepages() -> Vec<Creepage<f64>> {
    let sizes = [0.0, 1e-300, 1e-12, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 1.0, 1e6];
    let mut list = vec![];
    for &x in &sizes {
        for &y in &sizes {
            for &z in &sizes {
                for signs in 0..8u8 {
                    let sign = |bit: u8| if signs & (1 << bit) == 0 { 1.0 } else { -1.0 };
                    list.push(Creepage {
                        longitudinal: sign(0) * x,
                        lateral: sign(1) * y,
                        spin: sign(2) * z * 5e3,
                    });
                }
            }
        }
    }
    list
}

/// The suite that every bounded creep law passes.
fn bounded_law_suite(law: Law<'_>) {
    let theory = theory();
    for c in creepages() {
        let f = theory.forces(law, &c);
        let size = f.longitudinal.hypot(f.lateral);
        // finite, bounded
        assert!(size.is_finite() && f.spin_moment.is_finite(), "{law:?} {c:?}");
        assert!(size <= theory.friction_limit * (1.0 + 1e-12), "{law:?} {c:?}: {size} N");
        assert!(f.spin_moment.abs() <= theory.moment_limit * (1.0 + 1e-12), "{law:?} {c:?}");
        // dissipative
        let power = f.longitudinal * c.longitudinal + f.lateral * c.lateral + f.spin_moment * c.spin;
        assert!(power >= 0.0, "{law:?} {c:?}: {power} W");
        // odd, and mirror symmetric about the rolling direction
        let opposite = Creepage { longitudinal: -c.longitudinal, lateral: -c.lateral, spin: -c.spin };
        let g = theory.forces(law, &opposite);
        assert_eq!([g.longitudinal, g.lateral, g.spin_moment], [-f.longitudinal, -f.lateral, -f.spin_moment]);
        let mirrored = Creepage { longitudinal: c.longitudinal, lateral: -c.lateral, spin: -c.spin };
        let g = theory.forces(law, &mirrored);
        assert_eq!([g.longitudinal, g.lateral, g.spin_moment], [f.longitudinal, -f.lateral, -f.spin_moment]);
    }
}

#[test]
fn invariant_suite_saturated() {
    bounded_law_suite(Law::Saturated);
}

#[test]
fn invariant_suite_regularised() {
    bounded_law_suite(Law::Regularised);
}

#[test]
fn closed_form_saturated_is_tangent_to_linear_theory_with_and_without_spin() {
    let theory = theory();
    let c = Creepage { longitudinal: 2e-8, lateral: -1e-8, spin: 3e-5 };
    let (linear, ours) = (theory.forces(Law::Linear, &c), theory.forces(Law::Saturated, &c));
    // The cubic leaves linear theory by q/3, here q is a few 1e-5.
    assert!((ours.longitudinal / linear.longitudinal - 1.0).abs() < 1e-4);
    assert!((ours.lateral / linear.lateral - 1.0).abs() < 1e-4);
    assert!((ours.spin_moment / linear.spin_moment - 1.0).abs() < 1e-4);
    assert!((linear.lateral - (theory.lateral * c.lateral + theory.coupling * c.spin)).abs() < 1e-12);
}

#[test]
fn closed_form_saturated_pure_creep_is_the_cubic_of_vermeulen_and_johnson() {
    let theory = theory();
    for share in [0.3, 1.0, 2.0, 2.9] {
        let c = Creepage {
            longitudinal: share * theory.friction_limit / theory.longitudinal,
            lateral: 0.0,
            spin: 0.0,
        };
        let expected = theory.friction_limit * (1.0 - (1.0 - share / 3.0).powi(3));
        let ours = theory.forces(Law::Saturated, &c).longitudinal;
        assert!((ours / expected - 1.0).abs() < 1e-8, "{share}: {ours} {expected}");
    }
}

#[test]
fn closed_form_regularised_pure_creep_is_equation_15() {
    let theory = theory();
    // eps = 2 mu Q/(C11 G c^2) (eq. A.3)
    let eps = 2.0 * theory.friction_limit / theory.longitudinal;
    for share in [0.1, 0.5, 0.99, 1.5] {
        let c = Creepage { longitudinal: share * eps, lateral: 0.0, spin: 0.0 };
        let phi = if share <= 1.0 { (2.0 - share) * share } else { 1.0 };
        let ours = theory.forces(Law::Regularised, &c).longitudinal;
        assert!((ours / (theory.friction_limit * phi) - 1.0).abs() < 1e-8);
    }
}

#[test]
fn an_open_contact_has_neither_force_nor_slope() {
    let model = model();
    let mut x = motion(OUTER);
    x[1] *= 0.999;
    x[2] *= 0.999;
    for law in LAWS {
        let dual: [Dual<18>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i, 1.0));
        let contact = evaluate(&model, law, OUTER, &dual);
        assert!(contact.geometry.approach.value < 0.0);
        for row in rows(&contact) {
            assert_eq!(row.value, 0.0);
            assert!(row.derivatives.iter().all(|d| *d == 0.0), "{law:?} {row:?}");
        }
    }
}
