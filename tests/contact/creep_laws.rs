//! One suite for all creep laws, as the simulation calls them, flat and with bent grooves.

use std::f64::consts::PI;

use roulement::contact::creep::{CreepForces, Creepage, Law, LinearTheory};
use roulement::contact::identification::identify_by_table;
use roulement::contact::oblique::{Across, Exchanged, exchanged};
use roulement::contact::regularised::{lateral_by_spin, moment_by_lateral, moment_by_spin};
use roulement::kalker::table::CreepTable;
use roulement::numerics::scalar::{Dual, Scalar};

use crate::laws::{self, Laws, theory};

/// Creepages over many magnitudes and all signs, rest and extremes included; fewer of them for slow laws.
fn creepages(curved: bool, few: bool) -> Vec<Creepage<f64>> {
    let all = [0.0, 1e-300, 1e-12, 1e-7, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 1.0, 1e6];
    let sizes = if few { vec![0.0, 1e-4, 2e-3, 1.0] } else { all.to_vec() };
    let curvatures = if curved { vec![-3e4, 2e2, 3e4] } else { vec![f64::NAN] };
    let mut list = vec![];
    for &x in &sizes {
        for &y in &sizes {
            for &z in &sizes {
                for &curvature in &curvatures {
                    for signs in 0..8u8 {
                        let sign = |bit: u8| if signs & (1 << bit) == 0 { 1.0 } else { -1.0 };
                        list.push(Creepage {
                            longitudinal: sign(0) * x,
                            lateral: sign(1) * y,
                            spin: sign(2) * z * 5e3,
                            curvature: curved.then_some(curvature),
                        });
                    }
                }
            }
        }
    }
    list
}

fn power(c: &Creepage<f64>, f: &CreepForces<f64>) -> f64 {
    f.longitudinal * c.longitudinal + f.lateral * c.lateral + f.spin_moment * c.spin
        - f.second_moment * c.curvature.unwrap_or(0.0)
}

/// Alike to rounding; the law `kalker` to the end of its iteration, where points change between sticking and sliding.
fn close(name: &str, a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= if name == "kalker" { 1e-5 } else { 1e-9 } * scale
}

#[test]
fn invariant_bounded_symmetric_and_dissipative() {
    let laws = Laws::new();
    let theory = theory();
    for curved in [false, true] {
        for (name, law) in laws.bounded() {
            let mut worst = 0.0f64;
            for c in creepages(curved, name == "kalker") {
                let f = theory.forces(law, &c);
                let size = f.longitudinal.hypot(f.lateral);
                assert!(size.is_finite() && f.spin_moment.is_finite(), "{name} {c:?}");
                assert!(size <= theory.friction_limit * (1.0 + 1e-12), "{name} {c:?}: {size} N");
                let sliding = theory.friction_limit * 1e-300;
                let slip = c.longitudinal.abs() + c.lateral.abs() + c.spin.abs() * theory.half_width;
                worst = worst.max(-power(&c, &f) / (theory.friction_limit * slip + sliding));
                // odd in everything
                let opposite = Creepage {
                    longitudinal: -c.longitudinal,
                    lateral: -c.lateral,
                    spin: -c.spin,
                    curvature: c.curvature.map(|k| -k),
                };
                let g = theory.forces(law, &opposite);
                let limits = [theory.friction_limit, theory.friction_limit, theory.moment_limit];
                let (mine, other) = (
                    [f.longitudinal, f.lateral, f.spin_moment],
                    [-g.longitudinal, -g.lateral, -g.spin_moment],
                );
                assert!(
                    (0..3).all(|k| close(name, mine[k], other[k], limits[k])),
                    "{name} {c:?}: {f:?} {g:?}"
                );
                // mirrored about the rolling direction
                let mirrored = Creepage { lateral: -c.lateral, spin: -c.spin, ..c };
                let g = theory.forces(law, &mirrored);
                let other = [g.longitudinal, -g.lateral, -g.spin_moment];
                assert!(
                    (0..3).all(|k| close(name, mine[k], other[k], limits[k])),
                    "{name} {c:?}: {f:?} {g:?}"
                );
            }
            println!("{name:13} bent groove {curved}: least power {:.1e} of mu Q times slip", -worst);
            assert!(worst <= 0.0, "{name}, bent groove {curved}: power {worst:e}");
        }
    }
}

#[test]
fn closed_form_saturated_is_tangent_to_linear_theory_with_and_without_spin() {
    let theory = theory();
    let c = Creepage { longitudinal: 2e-8, lateral: -1e-8, spin: 3e-5, curvature: None };
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
    for ratio in [0.3, 1.0, 2.0, 2.9] {
        let c = Creepage {
            longitudinal: ratio * theory.friction_limit / theory.longitudinal,
            lateral: 0.0,
            spin: 0.0,
            curvature: None,
        };
        let expected = theory.friction_limit * (1.0 - (1.0 - ratio / 3.0).powi(3));
        let ours = theory.forces(Law::Saturated, &c).longitudinal;
        assert!((ours / expected - 1.0).abs() < 1e-8, "{ratio}: {ours} {expected}");
    }
}

#[test]
fn closed_form_regularised_pure_creep_is_equation_15() {
    let theory = theory();
    let laws = Laws::new();
    // eps = 2 mu Q/(C11 G c^2) (eq. A.3)
    let eps = 2.0 * theory.friction_limit / theory.longitudinal;
    for ratio in [0.1, 0.5, 0.99, 1.5] {
        let c = Creepage { longitudinal: ratio * eps, lateral: 0.0, spin: 0.0, curvature: None };
        let phi = if ratio <= 1.0 { (2.0 - ratio) * ratio } else { 1.0 };
        let ours = theory.forces(Law::Regularised(&laws.parameters), &c).longitudinal;
        assert!((ours / (theory.friction_limit * phi) - 1.0).abs() < 1e-8);
    }
}

#[test]
fn closed_form_regularised_couplings_are_equations_a4_to_a6() {
    // Lateral creepage alone gives the moment of A.6, spin alone the force of A.4 and a moment of its own, each at the
    // ratio of linear theory's force or moment to its limit; signs as in linear theory (eq. 14).
    let theory = theory();
    let Laws { parameters, .. } = Laws::new();
    let forces = |lateral: f64, spin: f64| {
        let creepage = Creepage { longitudinal: 0.0, lateral, spin, curvature: None };
        theory.forces(Law::Regularised(&parameters), &creepage)
    };
    let (force, moment, coupling) = (theory.friction_limit, theory.moment_limit, theory.coupling);
    for size in [-3.0f64, -0.5, 0.1, 1.0] {
        let by_lateral = forces(size * moment / coupling.abs(), 0.0).spin_moment;
        let expected = -(coupling * size).signum() * moment * moment_by_lateral(parameters.alpha, size.abs());
        assert!((by_lateral / expected - 1.0).abs() < 1e-6, "{size}: {by_lateral} for {expected}");

        let spun = forces(0.0, size * 2.0 * force / coupling.abs());
        let expected = (coupling * size).signum() * force * lateral_by_spin(parameters.eta, size.abs());
        assert!((spun.lateral / expected - 1.0).abs() < 1e-6, "{size}: {} for {expected}", spun.lateral);

        let own = forces(0.0, size * moment / theory.spin).spin_moment;
        let expected = size.signum() * moment * moment_by_spin(parameters.beta, size.abs());
        assert!((own / expected - 1.0).abs() < 1e-6, "{size}: {own} for {expected}");
    }
}

#[test]
fn closed_form_the_uncoupled_law_has_each_force_by_its_own_creepage() {
    let theory = theory();
    let coupled = Laws::new().parameters;
    let parameters = coupled.uncoupled();
    let forces = |parameters, longitudinal, lateral, spin| {
        let creepage = Creepage { longitudinal, lateral, spin, curvature: None };
        theory.forces(Law::Regularised(parameters), &creepage)
    };
    let (force, moment) = (theory.friction_limit, theory.moment_limit);
    for size in [-2.0f64, -0.5, 0.1, 0.9] {
        let (lateral, spin) = (size * 2.0 * force / theory.lateral, size * moment / theory.spin);
        // Lateral creepage alone has its force and no moment, spin alone its moment and no force.
        let across = forces(&parameters, 0.0, lateral, 0.0);
        let phi = if size.abs() < 1.0 { (2.0 - size.abs()) * size.abs() } else { 1.0 };
        assert!((across.lateral / (size.signum() * force * phi) - 1.0).abs() < 1e-6, "{}", across.lateral);
        assert_eq!(across.spin_moment, 0.0);
        let spun = forces(&parameters, 0.0, 0.0, spin);
        let own = size.signum() * moment * moment_by_spin(parameters.beta, size.abs());
        assert!((spun.spin_moment / own - 1.0).abs() < 1e-6, "{}", spun.spin_moment);
        assert_eq!((spun.lateral, spun.longitudinal), (0.0, 0.0));
        assert!(forces(&coupled, 0.0, 0.0, spin).lateral != 0.0);
    }
}

#[test]
fn invariant_frozen_differences_never_leave_coulombs_limits() {
    let (theory, laws) = (theory(), Laws::new());
    for sign in [-1.0, 1.0] {
        // Complete sliding by spin: the table's moment is at its limit already.
        let creepage = Creepage { longitudinal: 0.0, lateral: 0.0, spin: sign * 1e6, curvature: None };
        let difference = [0.3, 0.9, sign * 0.5, 0.0];
        let forces = theory.forces(Law::Frozen(&laws.table, &difference), &creepage);
        assert!((forces.spin_moment / theory.moment_limit - sign).abs() < 1e-9);
        assert!(forces.longitudinal.hypot(forces.lateral) <= theory.friction_limit * (1.0 + 1e-12));
    }
}

#[test]
fn invariant_tangents_where_a_contact_hardly_rolls_along_its_axis() {
    // The coupling carries the cosine of the rolling direction: from along the axis to against it, by central differences.
    fn turned<S: Scalar>(cosine: S, load: S) -> LinearTheory<S> {
        let theory = theory();
        LinearTheory {
            longitudinal: S::constant(theory.longitudinal),
            lateral: S::constant(theory.lateral),
            coupling: cosine.scale(theory.coupling),
            spin: S::constant(theory.spin),
            friction_limit: load.scale(theory.friction_limit),
            moment_limit: load.scale(theory.moment_limit),
            mean_semi_axis: S::constant(theory.mean_semi_axis),
            half_width: S::constant(theory.half_width),
        }
    }
    let laws = Laws::new();
    let difference = [0.1, -0.05, 0.02, 0.0];
    let (x, y, spin) = (4e-4, -2e-4, 1.5);
    for (name, law) in [("table", Law::Table(&laws.table)), ("frozen", Law::Frozen(&laws.table, &difference))]
    {
        for cosine in [1.0, 0.8, 0.45, 0.2, 0.0, -0.1, -0.4, -0.9] {
            let forces = |step: f64| {
                let creepage = Creepage { longitudinal: x, lateral: y, spin, curvature: None };
                let f = turned(cosine + step, 1.0 + 0.3 * step).forces(law, &creepage);
                [f.longitudinal, f.lateral, f.spin_moment]
            };
            let constant = Dual::<1>::constant;
            let creepage = Creepage {
                longitudinal: constant(x),
                lateral: constant(y),
                spin: constant(spin),
                curvature: None,
            };
            let variable = Dual::variable;
            let f = turned(variable(cosine, 0, 1.0), variable(1.0, 0, 0.3)).forces(law, &creepage);
            let h = 1e-6;
            let (after, before) = (forces(h), forces(-h));
            let scales = [theory().friction_limit, theory().friction_limit, theory().moment_limit];
            for (i, exact) in [f.longitudinal, f.lateral, f.spin_moment].into_iter().enumerate() {
                let slope = (after[i] - before[i]) / (2.0 * h);
                let error = (exact.derivatives[0] - slope).abs() / scales[i];
                assert!(error < 1e-6, "{name} {cosine} row {i}: {} {slope}", exact.derivatives[0]);
            }
        }
    }
}

/// Forces over their limits of a contact that rolls at velocities along and across the circumference \[m/s], as simulations mix
/// them: slip 0.3 mm/s and spin 2 rad/s.
fn rolling_at(pair: [Law<'_>; 2], exchanged: &Exchanged, [along, across]: [f64; 2]) -> [f64; 3] {
    let speed = (along * along + across * across + 1e-6f64).sqrt();
    let theory = theory();
    let theory = LinearTheory { coupling: theory.coupling * along / speed, ..theory };
    let creepage =
        Creepage { longitudinal: 2e-4 / speed, lateral: -2.2e-4 / speed, spin: 2.0 / speed, curvature: None };
    let forces = theory.forces(pair[0], &creepage);
    let direction = [along, across].map(|component| component / speed);
    let forces = Across { exchanged, law: pair[1] }.forces(&forces, &theory, direction, &creepage);
    [
        forces.longitudinal / theory.friction_limit,
        forces.lateral / theory.friction_limit,
        forces.spin_moment / theory.moment_limit,
    ]
}

#[test]
fn invariant_the_direction_of_rolling_acts_smoothly_through_standstill() {
    let (laws, patch) = (Laws::new(), laws::patch());
    let (there, exchange) = (exchanged(&patch), Exchanged::new(&patch).unwrap());
    let table = CreepTable::new(&there).unwrap();
    let parameters = identify_by_table(&there).unwrap().parameters;
    let pairs = [
        ("linear", [Law::Linear; 2]),
        ("saturated", [Law::Saturated; 2]),
        ("regularised", [Law::Regularised(&laws.parameters), Law::Regularised(&parameters)]),
        ("kalker_table", [Law::Table(&laws.table), Law::Table(&table)]),
    ];
    for (name, pair) in pairs {
        // Through standstill across, along, and past it at 0.2 mm/s; and a full turn of the direction. (The regularised law's own
        // coupling is too steep in the size of the cosine to be seen to be smooth.)
        for path in (0..4).filter(|_| name != "regularised") {
            let at = |s: f64| match path {
                0 => [0.0, 0.02 * s],
                1 => [0.02 * s, 0.0],
                2 => [2e-4, 0.02 * s],
                _ => [0.5 * (PI * s).cos(), 0.5 * (PI * s).sin()],
            };
            let largest = |count: i32| {
                let forces: Vec<[f64; 3]> = (-count..=count)
                    .map(|k| rolling_at(pair, &exchange, at(f64::from(k) / f64::from(count))))
                    .collect();
                let change =
                    |pair: &[[f64; 3]]| (0..3).map(|m| (pair[1][m] - pair[0][m]).abs()).fold(0.0, f64::max);
                forces.windows(2).map(change).fold(0.0, f64::max)
            };
            let (coarse, fine) = (largest(500), largest(1000));
            assert!(fine < 0.55 * coarse, "{name}, path {path}: {coarse} {fine}");
        }
        // Straight ahead it is the law itself, straight across that of the exchanged ellipse.
        let ahead = rolling_at(pair, &exchange, [3.0, 0.0]);
        let theory = theory();
        let creepage =
            Creepage { longitudinal: 2e-4 / 3.0, lateral: -2.2e-4 / 3.0, spin: 2.0 / 3.0, curvature: None };
        let itself = theory.forces(pair[0], &creepage);
        assert!((ahead[1] * theory.friction_limit / itself.lateral - 1.0).abs() < 1e-6, "{name}");
        let limits = (300.0, 1.6e9, 79e9, 0.08);
        let turned = laws::theory_of(there.axis_ratio, limits.0, limits.1, limits.2, limits.3);
        let seen = Creepage { longitudinal: creepage.lateral, lateral: -creepage.longitudinal, ..creepage };
        let expected = turned.forces(pair[1], &seen);
        let across = rolling_at(pair, &exchange, [0.0, 3.0]);
        for (ours, theirs) in across.into_iter().zip([
            -expected.lateral / turned.friction_limit,
            expected.longitudinal / turned.friction_limit,
            expected.spin_moment / turned.moment_limit,
        ]) {
            assert!((ours - theirs).abs() < 1e-5 * (1.0 + theirs.abs()), "{name}: {ours} {theirs}");
        }
    }
}
