//! A cylindrical or tapered roller bearing without states, against closed forms, differences, and a solver of its own.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix6, Vector3, Vector6};
use roulement::model::link::roller::{Line, Profile, Rib, Roller};
use roulement::model::link::rollers::{Geometry, Rollers, Taper};

use crate::random::Random;

/// A bearing of the size of an NU 206.
const USUAL: Geometry = Geometry {
    count: 13,
    diameter: 9e-3,
    length: 8.8e-3,
    pitch_diameter: 46.5e-3,
    diametral_clearance: 0.0,
    profile: Profile::Straight,
    ribs: [false; 2],
    axial_clearance: 0.0,
    rib_stiffness: None,
    first_azimuth: 0.0,
    taper: None,
};
const STILL: Vector6<f64> = Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);

/// Displacement of a shaft x, y, z \[um], and its tilt about y and z \[mrad].
fn displaced([x, y, z, tilt_y, tilt_z]: [f64; 5]) -> Vector6<f64> {
    Vector6::new(1e-6 * x, 1e-6 * y, 1e-6 * z, 0.0, 1e-3 * tilt_y, 1e-3 * tilt_z)
}

/// A shaft that turns at this speed [rad/s].
fn turning(speed: f64) -> Vector6<f64> {
    Vector6::ith(3, speed)
}

#[test]
fn published_radial_integrals_of_sjoevall_for_line_contact() {
    // Integrals J_r over the loaded part of the diameter, for Q ~ d^1.11 (Harris, Rolling Bearing Analysis, 4th ed., table 7.2).
    let published =
        [(0.2, 0.1737), (0.3, 0.2055), (0.4, 0.2286), (0.5, 0.2453), (0.7, 0.2636), (0.9, 0.2628)];
    for (part, integral) in published {
        // `part = (1 - clearance/2 over the displacement)/2`
        let way = 20e-6;
        let clearance = 2.0 * way * (1.0 - 2.0 * part);
        let geometry = Geometry { count: 200, diametral_clearance: clearance, ..USUAL };
        let bearing = Rollers::new(geometry, None);
        let d = Vector6::ith(1, way);
        let force = -bearing.force(&d, &STILL).force[1];
        let largest = bearing.outputs(&d, &STILL, &[], None).largest_load;
        let own = force / (200.0 * largest);
        assert!((own / integral - 1.0).abs() < 5e-3, "{part}: {own} {integral}");
    }
    // The largest load without clearance is 4.08 F/Z.
    let bearing = Rollers::new(Geometry { count: 200, ..USUAL }, None);
    let d = Vector6::ith(2, 10e-6);
    let factor =
        200.0 * bearing.outputs(&d, &STILL, &[], None).largest_load / -bearing.force(&d, &STILL).force[2];
    assert!((factor / 4.08 - 1.0).abs() < 2e-3, "{factor}");
}

#[test]
fn closed_form_load_and_moment_of_a_tilted_roller_that_is_straight_or_crowned() {
    let one = |profile| Rollers::with_stations(Geometry { count: 1, profile, ..USUAL }, None, Some(64));
    let length = USUAL.length;
    // Both races in series are ISO's roller: 35948 N/mm^(10/9) mm^(8/9).
    let stiffness = 35948.0 * (1e3 * length).powf(8.0 / 9.0) * 1e3f64.powf(10.0 / 9.0);
    let n = 10.0 / 9.0;
    for (way, tilt) in [(10e-6, 0.3e-3), (10e-6, 2e-3), (2e-6, 8e-3), (-4e-6, 5e-3)] {
        let d = Vector6::new(0.0, way, 0.0, 0.0, 0.0, tilt);
        let force = one(Profile::Straight).force(&d, &STILL).force;
        // `int (w + x t)^n dx` and `int x (w + x t)^n dx` by the approach.
        let ends = [way - 0.5 * length * tilt, way + 0.5 * length * tilt].map(|end| end.max(0.0));
        let integral = |power: f64| (ends[1].powf(power) - ends[0].powf(power)) / power;
        let load = stiffness / length * integral(n + 1.0) / tilt;
        let moment = stiffness / length * (integral(n + 2.0) - way * integral(n + 1.0)) / (tilt * tilt);
        assert!((force[1] / -load - 1.0).abs() < 1e-3, "{} {load}", force[1]);
        assert!((force[5] / -moment - 1.0).abs() < 2e-3, "{} {moment}", force[5]);
    }
    // A crown that carries within the roller is shifted by a tilt: `M = Q R t/2`, as each race has a half of the tilt.
    let radius = 0.4;
    let d = Vector6::new(0.0, 4e-6, 0.0, 0.0, 0.0, 4e-3);
    let force = one(Profile::Crowned(radius)).force(&d, &STILL).force;
    let lever = 0.5 * radius * d[5];
    assert!((force[5] / force[1] / lever - 1.0).abs() < 2e-3, "{} {lever}", force[5] / force[1]);
}

/// Places of hard and usual cases.
const PLACES: [[f64; 5]; 8] = [
    [0.0, 12.0, 5.0, 0.0, 0.0],
    [0.0, 20.0, -3.0, 0.4, -0.9],
    [8.0, 14.0, 9.0, 0.1, 0.2],
    [-11.0, 14.0, 9.0, 0.1, 0.2],
    [12.0, 0.0, 0.0, 0.0, 0.0],
    [3.0, 4.0, 2.0, 0.0, 0.0],
    [0.0, 5.0, 30.0, 10.0, 0.0],
    [15.0, -18.0, 2.0, -3.0, 2.0],
];

/// A locating bearing with everything.
fn locating() -> Geometry {
    Geometry {
        diametral_clearance: 8e-6,
        profile: Profile::Logarithmic,
        ribs: [true; 2],
        axial_clearance: 4e-6,
        ..USUAL
    }
}

#[test]
fn invariant_stiffness_is_the_derivative_of_the_force_and_the_force_that_of_the_potential() {
    for (geometry, speed) in
        [(locating(), 0.0), (locating(), 1500.0), (tapered(1.0), 0.0), (tapered(-1.0), 1500.0)]
    {
        for place in PLACES {
            let bearing = Rollers::new(geometry, None);
            let (d, rate) = (displaced(place) + Vector6::ith(3, 0.7), turning(speed));
            let of = bearing.force(&d, &rate);
            let (mut differences, mut slope) = (Matrix6::zeros(), Vector6::zeros());
            let (mut by_rate, change_of_rate) = (Vector6::zeros(), 0.1);
            for k in 0..6 {
                let h = if k < 3 { 1e-10 } else { 1e-8 } * if k == 3 { 100.0 } else { 1.0 };
                let [plus, minus] = [h, -h].map(|h| bearing.force(&(d + Vector6::ith(k, h)), &rate));
                differences.set_column(k, &((plus.force - minus.force) / (2.0 * h)));
                slope[k] = -(plus.stored - minus.stored) / (2.0 * h);
            }
            if speed > 0.0 {
                let [plus, minus] = [1.0, -1.0]
                    .map(|sign| bearing.force(&d, &(rate + Vector6::ith(3, sign * change_of_rate))));
                by_rate = (plus.force - minus.force) / (2.0 * change_of_rate);
            }
            // Rotations by the radius of the roller set.
            let scale = Vector6::new(1.0, 1.0, 1.0, 40.0, 40.0, 40.0);
            let scaled = |m: &Matrix6<f64>| Matrix6::from_fn(|i, k| m[(i, k)] * scale[i] * scale[k]);
            let [exact, other] = [&of.by_displacement, &differences].map(scaled);
            // Forces below 1e-9 N are nothing to a roller.
            let size = exact.amax().max(1e8);
            assert!((exact - other).amax() < 2e-6 * size, "{place:?} {speed}: {exact} {other}");
            assert!(
                (exact - exact.transpose()).amax() < 1e-7 * size,
                "{place:?}: {:e}",
                (exact - exact.transpose()).amax() / size
            );
            let [exact, other] = [of.force, slope].map(|f| f.component_mul(&scale));
            assert!((exact - other).amax() < 1e-5 * exact.amax().max(1.0), "{place:?}: {exact} {other}");
            let exact = of.by_rate.column(3);
            assert!((exact - by_rate).amax() < 1e-5 * exact.amax().max(1e-3), "{place:?}: {exact} {by_rate}");
        }
    }
}

/// A tapered roller bearing of the size of a 30206.
fn tapered(direction: f64) -> Geometry {
    let taper = Taper { contact_angle: 14f64.to_radians(), roller_angle: 4f64.to_radians(), direction };
    Geometry {
        count: 17,
        diameter: 7.2e-3,
        length: 10e-3,
        pitch_diameter: 46e-3,
        profile: Profile::Logarithmic,
        taper: Some(taper),
        ..USUAL
    }
}

#[test]
fn closed_form_a_tapered_roller_presses_its_rib_and_a_radial_load_induces_an_axial_one() {
    for direction in [1.0, -1.0] {
        let geometry = Geometry { count: 200, profile: Profile::Straight, ..tapered(direction) };
        let Taper { contact_angle, roller_angle, .. } = geometry.taper.unwrap();
        let bearing = Rollers::new(geometry, None);
        // Balance of a roller: rib `2 Q_o sin(angle/2)`, the same on all under a thrust; what a roller takes of that is `Q_o sin(contact angle)`.
        let d = Vector6::ith(0, direction * 30e-6);
        let force = bearing.force(&d, &STILL).force;
        let outer = force[0].abs() / 200.0 / contact_angle.sin();
        let rib = bearing.outputs(&d, &STILL, &[], None).largest_rib_load;
        assert!(
            force[0] * direction < -1e4
                && (rib / (2.0 * outer * (0.5 * roller_angle).sin()) - 1.0).abs() < 1e-9,
            "{rib} {outer}"
        );
        // The other way nothing holds.
        assert_eq!(bearing.force(&-d, &STILL).force, Vector6::zeros());
        // A load of which half of the rollers carry some: mean powers of a cosine over the circle, 10/9 and 19/9. Rollers tilt by their ribs, and
        // differently loaded ones differently.
        let mean = |power: f64| {
            (0..20000).map(|k| (PI * (f64::from(k) - 9999.5) / 20000.0).cos().powf(power)).sum::<f64>()
                / 40000.0
        };
        let place = (-40..=40).map(|k| 1e-7 * f64::from(k)).min_by_key(|x| {
            let loaded = bearing
                .outputs(&Vector6::new(direction * x, 20e-6, 0.0, 0.0, 0.0, 0.0), &STILL, &[], None)
                .loaded;
            loaded.abs_diff(100)
        });
        let force =
            bearing.force(&Vector6::new(direction * place.unwrap(), 20e-6, 0.0, 0.0, 0.0, 0.0), &STILL).force;
        let induced = direction * force[0] / force[1] / contact_angle.tan();
        let expected = mean(10.0 / 9.0) / mean(19.0 / 9.0);
        assert!((induced / expected - 1.0).abs() < 0.02, "{induced} {expected}");
    }
}

#[test]
fn independent_a_tapered_roller_is_in_balance_by_bisection() {
    // One roller: place along, tilt and place across by bisection, each inside the one before, as all is convex.
    let geometry = Geometry { count: 1, profile: Profile::Crowned(3.0), ..tapered(1.0) };
    let Geometry { diameter, length, .. } = geometry;
    let Taper { contact_angle, roller_angle, .. } = geometry.taper.unwrap();
    const COUNT: usize = 40;
    let line = 35948.0 * 2f64.powf(10.0 / 9.0) * (1e3 * length).powf(8.0 / 9.0) * 1e3f64.powf(10.0 / 9.0);
    let rib = 206e9 / (1.0 - 0.09) * 0.05 * diameter;
    for p in [
        Vector3::new(30e-6, 5e-6, 0.0),
        Vector3::new(10e-6, 15e-6, 0.4e-3),
        Vector3::new(60e-6, -3e-6, -0.6e-3),
    ] {
        // Unbalanced force along, across and moment on the roller; force on the inner ring.
        let of = |q: &Vector3<f64>| {
            let (mut on_roller, mut on_ring) = (Vector3::zeros(), Vector3::zeros());
            for k in 0..COUNT {
                let s = length * ((k as f64 + 0.5) / COUNT as f64 - 0.5);
                let drop = s * s / 6.0;
                for (angle, inner) in [(contact_angle - roller_angle, true), (contact_angle, false)] {
                    let out = if inner { -1.0 } else { 1.0 };
                    let w = Vector3::new(angle.sin(), angle.cos(), s) * out;
                    let moved = if inner { q - p } else { *q };
                    let load = line / COUNT as f64 * (w.dot(&moved) - drop).max(0.0).powf(10.0 / 9.0);
                    on_roller -= w * load;
                    if inner {
                        on_ring += w * load;
                    }
                }
            }
            let axis = contact_angle - 0.5 * roller_angle;
            let w = Vector3::new(-axis.cos(), axis.sin(), -0.45 * diameter);
            let load = rib * (w.dot(&(q - p)) - 0.5e-7).max(0.0);
            (on_roller - w * load, on_ring + w * load)
        };
        let bisect = |size: f64, falls: &dyn Fn(f64) -> f64| {
            let (mut low, mut high) = (-size, size);
            for _ in 0..36 {
                let middle = 0.5 * (low + high);
                if falls(middle) > 0.0 { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        };
        let across = |a: f64, tilt: f64| bisect(2e-4, &|v| of(&Vector3::new(a, v, tilt)).0.y);
        let tilt = |a: f64| bisect(0.02, &|tilt| of(&Vector3::new(a, across(a, tilt), tilt)).0.z);
        let a = bisect(2e-4, &|a| {
            let tilt = tilt(a);
            of(&Vector3::new(a, across(a, tilt), tilt)).0.x
        });
        let tilt = tilt(a);
        let expected = of(&Vector3::new(a, across(a, tilt), tilt)).1;
        // The roller at azimuth 0 sees this motion of a shaft.
        let radius = 0.5 * geometry.pitch_diameter;
        let d = Vector6::new(p.x + radius * p.z, p.y, 0.0, 0.0, 0.0, p.z);
        let own = Rollers::new(geometry, None).force(&d, &STILL).force;
        let force = Vector3::new(own[0], own[1], own[5] + radius * own[0]);
        println!("{force:?} {expected:?}");
        let error = force - expected;
        assert!(error.xy().norm() < 0.01 * expected.xy().norm(), "{force} {expected}");
        assert!(error.z.abs() < 0.01 * expected.xy().norm() * length, "{force} {expected}");
    }
}

/// Forces of a roller on the inner race in its plane, by a solver of its own: uniform laminae, and its balance by bisection, of the tilt outside, of the
/// place across the axis inside. Ribs are springs in series.
fn by_bisection(geometry: &Geometry, p: &Vector3<f64>, centrifugal: f64) -> Vector3<f64> {
    const COUNT: usize = 400;
    let Geometry { diameter, length, diametral_clearance, ribs, axial_clearance, .. } = *geometry;
    // One contact of two in series, in SI units.
    let line = 35948.0 * 2f64.powf(10.0 / 9.0) * (1e3 * length).powf(8.0 / 9.0) * 1e3f64.powf(10.0 / 9.0);
    let laminae: Vec<[f64; 2]> = (0..COUNT)
        .map(|k| {
            let x = length * ((k as f64 + 0.5) / COUNT as f64 - 0.5);
            let part = 2.0 * x / length;
            let drop = 0.00035 * diameter * (1.0 / (1.0 - part * part)).ln();
            [x, drop + 0.25 * diametral_clearance]
        })
        .collect();
    let lever = 0.45 * diameter;
    let rib = 0.5 * 206e9 / (1.0 - 0.09) * 0.05 * diameter;
    let of = |v: f64, tilt: f64| {
        let (mut radial, mut moment, mut on_ring) = (centrifugal, 0.0, Vector3::zeros());
        for [x, drop] in &laminae {
            let of = |approach: f64| line / COUNT as f64 * approach.max(0.0).powf(10.0 / 9.0);
            let inner = of(p.y - v + x * (p.z - tilt) - drop);
            let outer = of(v + x * tilt - drop);
            radial += inner - outer;
            moment += x * (inner - outer);
            on_ring -= Vector3::new(0.0, inner, x * inner);
        }
        for sign in ribs.into_iter().zip([1.0, -1.0]).filter(|(taken, _)| *taken).map(|(_, sign)| sign) {
            // Each of both contacts comes in over 0.1 um, a half of which it is behind from then on.
            let way = sign * (p.x + lever * p.z - 2.0 * lever * tilt) - 0.5 * axial_clearance - 0.1e-6;
            let force = sign * rib * way.max(0.0);
            moment += 2.0 * lever * force;
            on_ring -= Vector3::new(force, 0.0, lever * force);
        }
        (radial, moment, on_ring)
    };
    let bisect = |mut low: f64, mut high: f64, falls: &dyn Fn(f64) -> f64| {
        // To 2e-15 m and 1e-13 rad.
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if falls(middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let across = |tilt: f64| bisect(-1e-3, 1e-3, &|v| of(v, tilt).0);
    let tilt = bisect(-0.05, 0.05, &|tilt| of(across(tilt), tilt).1);
    of(across(tilt), tilt).2
}

#[test]
fn independent_forces_are_those_of_laminae_in_balance_by_bisection() {
    let mut worst = [0.0f64; 2];
    for speed in [0.0, 2000.0] {
        for place in PLACES {
            let geometry = locating();
            let (d, rate) = (displaced(place), turning(speed));
            let ratio = 0.5 * (1.0 - geometry.diameter / geometry.pitch_diameter);
            let mass = 7800.0 * PI / 4.0 * geometry.diameter.powi(2) * geometry.length;
            let radius = 0.5 * geometry.pitch_diameter;
            let centrifugal = mass * radius * (ratio * speed).powi(2);
            let mut sum = Vector6::zeros();
            for k in 0..geometry.count {
                let (s, c) = (TAU * k as f64 / geometry.count as f64).sin_cos();
                let tilt = d[5] * c - d[4] * s;
                let p = Vector3::new(d[0] - radius * tilt, d[1] * c + d[2] * s, tilt);
                let f = by_bisection(&geometry, &p, centrifugal);
                let about = f.z - radius * f.x;
                sum += Vector6::new(f.x, f.y * c, f.y * s, 0.0, -s * about, c * about);
            }
            let own = Rollers::new(geometry, None).force(&d, &rate).force;
            let force = (own - sum).fixed_rows::<3>(0).norm() / sum.fixed_rows::<3>(0).norm().max(250.0);
            let moment = (own - sum).fixed_rows::<2>(4).norm() / sum.fixed_rows::<2>(4).norm().max(1.0);
            worst = [worst[0].max(force), worst[1].max(moment)];
            assert!(force < 0.01 && moment < 0.01, "{place:?} {speed}: {own} {sum}");
        }
    }
    println!("largest difference of force {:.1e}, of moment {:.1e}", worst[0], worst[1]);
}

#[test]
fn order_stations_converge() {
    let error = |place: [f64; 5], stations: usize| {
        let of = |stations| {
            Rollers::with_stations(locating(), None, Some(stations)).force(&displaced(place), &STILL).force
        };
        let (own, fine) = (of(stations), of(400));
        [
            (own - fine).fixed_rows::<3>(0).norm() / fine.fixed_rows::<3>(0).norm(),
            (own - fine).fixed_rows::<2>(4).norm() / fine.fixed_rows::<2>(4).norm(),
        ]
    };
    for place in PLACES.into_iter().filter(|place| place[1].abs() > 10.0 || place[2].abs() > 10.0) {
        let errors = [4, 8, 16, 32].map(|stations| error(place, stations));
        println!("{place:?}: {errors:?}");
        assert!(errors[2][0] < 4e-3, "{place:?}: {errors:?}");
        assert!(errors[3][0] < 0.7 * errors[1][0] + 1e-6, "{place:?}: {errors:?}");
    }
}

#[test]
fn hard_loads_through_the_gap_reversed_ribs_and_large_tilts_stay_in_balance() {
    let bearing = Rollers::new(Geometry { diametral_clearance: 40e-6, ..locating() }, None);
    let none = bearing.force(&STILL, &STILL);
    assert_eq!((none.force, none.stored), (Vector6::zeros(), 0.0));
    let mut before = None;
    for speed in [0.0, 1.0, 3000.0] {
        for step in -200..=200 {
            // Through the gap, from one rib to the other, from one tilt to the other.
            let part = f64::from(step) / 200.0;
            let d = displaced([30.0 * part, 60.0 * part, 20.0 * part * part, 10.0 * part, -10.0 * part]);
            let of = bearing.force(&d, &turning(speed));
            assert!(of.force.iter().chain(of.by_displacement.iter()).all(|value| value.is_finite()));
            // A hundredth of what may be left: searches end at 1e-9 N or 1e-12 of the loads, what may be left is 1e-6 of both.
            assert!(of.unbalanced < 1e-2, "{speed} {part}: {}", of.unbalanced);
            // No jump: thirteen rollers are no stiffer than this.
            if let Some((d_before, force)) = before.filter(|_| step > -200) {
                let (moved, jump): (Vector6<f64>, Vector6<f64>) = (d - d_before, of.force - force);
                let way = moved.fixed_rows::<3>(0).norm() + 0.03 * moved.fixed_rows::<2>(4).norm();
                assert!(jump.fixed_rows::<3>(0).norm() < 2e9 * way, "{speed} {part}");
            }
            before = Some((d, of.force));
        }
    }
    // Ribs push back, each its way, and a bearing without them lets the shaft go.
    for (ribs, x, way) in [
        ([true; 2], 20.0, -1.0),
        ([true; 2], -20.0, 1.0),
        ([true, false], 20.0, -1.0),
        ([true, false], -20.0, 0.0),
        ([false; 2], 20.0, 0.0),
    ] {
        let force = Rollers::new(Geometry { ribs, ..locating() }, None)
            .force(&displaced([x, 15.0, 0.0, 0.0, 0.0]), &STILL)
            .force;
        if way == 0.0 {
            assert_eq!(force[0], 0.0);
        } else {
            assert!(force[0] * way > 100.0, "{force}");
        }
    }
}

#[test]
fn hard_wherever_rings_are_and_however_slow_rollers_go_all_searches_end() {
    let mut random = Random::new(1);
    for bearing in [locating(), tapered(1.0)].map(|of| Rollers::new(of, None)) {
        // From rollers that weigh a hundredth of their weight outwards to those that are pressed by 300 N.
        for speed in [0.0, 1.0, 10.0, 100.0, 3000.0] {
            for _ in 0..100 {
                let d = displaced(
                    [
                        random.unit() - 0.3,
                        random.unit() - 0.5,
                        random.unit() - 0.5,
                        0.1 * random.unit(),
                        0.1 * random.unit(),
                    ]
                    .map(|of| 100.0 * of),
                );
                let of = bearing.force(&d, &turning(speed));
                // A hundredth of what may be left, as above.
                assert!(of.unbalanced < 1e-2, "{speed} {d}: {}", of.unbalanced);
            }
        }
    }
}

#[test]
fn invariant_rollers_sought_from_where_they_were_are_where_a_search_from_nothing_finds_them() {
    let mut random = Random::new(3);
    for bearing in [Geometry { ribs: [false; 2], ..locating() }, locating(), tapered(1.0)]
        .map(|of| Rollers::new(of, None))
    {
        for speed in [0.0, 100.0, 3000.0] {
            let mut at = [30.0, 20.0, 10.0, 0.5, 0.0];
            let mut left = vec![];
            for step in 0..60 {
                // Small steps, then some from one side of the clearance to the other.
                let size = if step % 10 == 9 { 30.0 } else { 0.3 };
                at = [0, 1, 2, 3, 4].map(|k: usize| {
                    let moved = at[k] + size * (random.unit() - 0.5) * if k < 3 { 1.0 } else { 0.02 };
                    moved.clamp(-40.0, 40.0)
                });
                let d = displaced(at) + Vector6::ith(3, 0.02 * f64::from(step));
                let rate = turning(speed);
                let fresh = bearing.force(&d, &rate);
                let (near, now) = bearing.leave(&d, &rate, &left);
                let size = 1.0 + fresh.force.norm();
                assert!(
                    (near.force - fresh.force).norm() < 1e-9 * size,
                    "{speed} {step}: {:e}",
                    (near.force - fresh.force).norm()
                );
                let stiffness = near.by_displacement - fresh.by_displacement;
                assert!(stiffness.norm() < 1e-6 * (1.0 + fresh.by_displacement.norm()), "{speed} {step}");
                assert!(near.is_balanced(), "{speed} {step}: {}", near.unbalanced);
                assert_eq!(bearing.force_near(&d, &rate, &left).force, near.force);
                left = now;
            }
        }
    }
}

#[test]
fn regression_a_tapered_roller_that_its_rib_pushes_up_its_race_comes_to_balance() {
    // Motions of the inner race [m, m, rad] and centrifugal forces \[N], 5 of 2000: steps that ran into the outer line or the rib were halved until there were
    // no trials left, up to a thousand times what may be left away from balance.
    let (diameter, length, angle, taper) = (7.5e-3, 11e-3, 0.23f64, 0.06);
    let line = |side: f64, angle: f64| Line {
        normal: Vector3::new(angle.sin(), angle.cos(), 0.0) * side,
        side,
        gap: 0.0,
        stiffness: Roller::line_stiffness(length),
    };
    let (sine, cosine) = (angle - 0.5 * taper).sin_cos();
    let rib =
        Rib { race: 0, normal: Vector3::new(-cosine, sine, -0.45 * diameter), gap: 0.0, stiffness: 8.5e7 };
    let lines = [line(-1.0, angle - taper), line(1.0, angle)];
    let roller = Roller::new(lines, vec![rib], [diameter, length], Profile::Logarithmic, None);
    for (place, centrifugal) in [
        ([2.7460554959407328e-5, -3.786483699191563e-5, 1.5207920784276812e-4], 1e-4),
        ([2.9968374580029434e-5, -3.638929813894682e-5, -1.484646165904764e-4], 1e-4),
        ([2.6318603427140586e-5, -3.893488481258445e-5, 2.0408117737013608e-4], 1e-4),
        ([2.8797668578042296e-5, -3.364132867394474e-5, -4.05136742349804e-5], 1e-4),
        ([3.1098672900874554e-5, -3.4205565930631536e-5, -3.016866572778562e-4], 1e-2),
    ] {
        let of = roller.settle(&place.into(), centrifugal, None);
        // Searches end at 1e-9 N or 1e-12 of the loads.
        assert!(of.unbalanced < 1e-8, "{place:?}: {:e}", of.unbalanced);
    }
}

#[test]
fn hard_a_search_that_does_not_end_is_no_balance() {
    let bearing = Rollers::new(locating(), None);
    assert!(bearing.force(&displaced([10.0, 40.0, 0.0, 1.0, 0.0]), &turning(300.0)).is_balanced());
    // Rings a third of a roller apart and on edge: farther than a search of a hundred steps of 10 um goes.
    let far = bearing.force(&displaced([3000.0, 3000.0, 0.0, 200.0, 0.0]), &turning(3000.0));
    assert!(!far.is_balanced(), "{}", far.unbalanced);
    for of in [locating(), Geometry { ribs: [false; 2], ..locating() }] {
        let no_number = Rollers::new(of, None).force(&(STILL * f64::NAN), &STILL);
        assert!(!no_number.is_balanced(), "{}", no_number.unbalanced);
    }
}

#[test]
fn closed_form_a_rib_load_tilts_a_roller_by_the_couple_of_both_ribs() {
    // Rollers that are pressed evenly all around, with an axial force on top: each carries its part, and its couple as a shift of its lines.
    let geometry = Geometry { diametral_clearance: -30e-6, axial_clearance: 0.0, ribs: [true; 2], ..USUAL };
    let bearing = Rollers::new(geometry, None);
    let d = displaced([10.0, 0.0, 0.0, 0.0, 0.0]);
    let force = bearing.force(&d, &STILL).force[0];
    // `k = 1/(1/k_rib + lever^2/k_tilt)`: a roller's tilt between two straight lines; each has `k_tilt = 10/9 Q/d l^2/12`.
    let approach: f64 = 7.5e-6;
    let line = Roller::line_stiffness(geometry.length);
    let of_tilt = 2.0 * 10.0 / 9.0 * line * approach.powf(1.0 / 9.0) * geometry.length.powi(2) / 12.0;
    let rib = 0.5 * 206e9 / (1.0 - 0.09) * 0.05 * geometry.diameter;
    let lever = 2.0 * 0.45 * geometry.diameter;
    let each = 1.0 / (1.0 / rib + lever * lever / of_tilt);
    let hand = geometry.count as f64 * each * d[0];
    // The tilt is so small that the lines stay loaded; the rib comes in over 0.1 um.
    assert!((force / -hand - 1.0).abs() < 0.02, "{force} {hand}");
}
