//! Creep laws over a million random inputs, extremes included.

use roulement::contact::creep::{CreepForces, Creepage, LinearTheory};
use roulement::scalar::{Dual, Scalar};
use roulement::scene::CreepLaw;

use crate::random::Random;

const COUNT: usize = 1_000_000;
const LAWS: [CreepLaw; 4] = [CreepLaw::Frictionless, CreepLaw::Linear, CreepLaw::Regularised, CreepLaw::Saturated];

/// A number between the extremes of either sign, or exactly zero once in twenty.
fn signed(random: &mut Random, low: f64, high: f64) -> f64 {
    let size = magnitude(random, low, high);
    if random.unit() < 0.5 { -size } else { size }
}

fn magnitude(random: &mut Random, low: f64, high: f64) -> f64 {
    if random.unit() < 0.05 { 0.0 } else { random.logarithmic(low, high) }
}

/// A contact between nothing at all and a thousand tonnes, and creepages from rounding to a race that stands while a
/// ball passes at the speed of sound (1 mm/s of rolling speed remains).
fn case(random: &mut Random) -> (LinearTheory<f64>, [f64; 3]) {
    let arm = random.logarithmic(1e-9, 1e-1);
    let friction_limit = magnitude(random, 1e-25, 1e7);
    let stiffness = random.logarithmic(1e-20, 1e12);
    let theory = LinearTheory {
        longitudinal: stiffness * random.logarithmic(0.1, 10.0),
        lateral: stiffness * random.logarithmic(0.1, 10.0),
        coupling: stiffness * arm * signed(random, 1e-3, 10.0),
        spin: stiffness * arm * arm * random.logarithmic(0.1, 10.0),
        friction_limit,
        moment_limit: friction_limit * arm * random.between(0.3, 0.6),
        mean_semi_axis: arm,
    };
    let creepage = [signed(random, 1e-30, 1e6), signed(random, 1e-30, 1e6), signed(random, 1e-30, 1e6) / arm];
    (theory, creepage)
}

fn lift<S: Scalar>(theory: &LinearTheory<f64>) -> LinearTheory<S> {
    LinearTheory {
        longitudinal: S::constant(theory.longitudinal),
        lateral: S::constant(theory.lateral),
        coupling: S::constant(theory.coupling),
        spin: S::constant(theory.spin),
        friction_limit: S::constant(theory.friction_limit),
        moment_limit: S::constant(theory.moment_limit),
        mean_semi_axis: S::constant(theory.mean_semi_axis),
    }
}

fn forces(theory: &LinearTheory<f64>, law: CreepLaw, creepage: &[f64; 3]) -> CreepForces<f64> {
    let [longitudinal, lateral, spin] = *creepage;
    theory.forces(law, &Creepage { longitudinal, lateral, spin })
}

#[test]
fn bounded_dissipative_and_odd() {
    let mut random = Random::new(7);
    let (mut force_excess, mut moment_excess, mut driving, mut uneven) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    for _ in 0..COUNT {
        let (theory, creepage) = case(&mut random);
        for law in LAWS {
            let f = forces(&theory, law, &creepage);
            let list = [f.longitudinal, f.lateral, f.spin_moment];
            assert!(list.iter().all(|x| x.is_finite()), "{law:?} {theory:?} {creepage:?} {f:?}");
            if law != CreepLaw::Linear {
                let force = f.longitudinal.hypot(f.lateral);
                force_excess = force_excess.max((force - theory.friction_limit) / theory.friction_limit.max(1e-300));
                moment_excess = moment_excess.max((f.spin_moment.abs() - theory.moment_limit) / theory.moment_limit.max(1e-300));
            }
            // No law drives: force along creepage, up to the rounding of its terms.
            let terms = [0, 1, 2].map(|i| list[i] * creepage[i]);
            let size = terms.iter().map(|t| t.abs()).sum::<f64>() + (theory.coupling * creepage[1] * creepage[2]).abs().min(1e300) * 0.0;
            let floor = 1e-9 * (creepage[0].abs() + creepage[1].abs()) + 1e-15 * creepage[2].abs();
            let power = terms.iter().sum::<f64>();
            if -power > floor && -power > 1e-12*size { println!("{law:?} {theory:?} {creepage:?} {f:?} {terms:?}"); panic!(); }
            if size > 0.0 && theory.friction_limit > 1e-3 && theory.moment_limit > 1e-9 {
                driving = driving.max(-terms.iter().sum::<f64>() / size);
            }
            let back = forces(&theory, law, &creepage.map(|c| -c));
            for (a, b) in list.iter().zip([back.longitudinal, back.lateral, back.spin_moment]) {
                uneven = uneven.max((a + b).abs());
            }
        }
    }
    println!("\n| creep laws | {force_excess:e} {moment_excess:e} {driving:e} {uneven:e} |");
    assert!(force_excess <= 4.0 * f64::EPSILON && moment_excess <= 4.0 * f64::EPSILON);
    assert!(driving < 1e-12);
    assert_eq!(uneven, 0.0);
}

#[test]
fn derivatives_are_finite_and_right() {
    let mut random = Random::new(8);
    let mut worst = 0.0f64;
    for _ in 0..COUNT {
        let (theory, creepage) = case(&mut random);
        let lifted = lift::<Dual<3>>(&theory);
        let variable = |i: usize| Dual::<3>::variable(creepage[i], i, 1.0);
        let at = Creepage { longitudinal: variable(0), lateral: variable(1), spin: variable(2) };
        for law in LAWS {
            let f = lifted.forces(law, &at);
            let values = forces(&theory, law, &creepage);
            for (dual, value) in [f.longitudinal, f.lateral, f.spin_moment].iter().zip([values.longitudinal, values.lateral, values.spin_moment]) {
                assert_eq!(dual.value, value, "{law:?}");
                assert!(dual.derivatives.iter().all(|d| d.is_finite()), "{law:?} {theory:?} {creepage:?} {f:?}");
            }
            let _ = &mut worst;
        }
    }
}
