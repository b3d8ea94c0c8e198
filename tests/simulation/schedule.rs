//! Scripted quantities: tables, and smooth motions through their points.

use std::f64::consts::TAU;

use roulement::scene::{Schedule, Sine};

/// Unequal intervals: rising by secants 2, 6, 1, then flat, then falling by 3.
const POINTS: [(f64, f64); 6] = [(1.0, 0.5), (2.0, 2.5), (2.5, 5.5), (4.5, 7.5), (5.0, 7.5), (6.0, 4.5)];

fn close(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-12, "{value}, expected {expected}");
}

#[test]
fn closed_form_smooth_motion_through_a_table() {
    let schedule = Schedule::Table(POINTS.to_vec());
    // Harmonic means 2 s1 s2/(s1 + s2) of the neighbouring secants, 0 at ends and where they do not agree in sign.
    let slopes = [0.0, 3.0, 12.0 / 7.0, 0.0, 0.0, 0.0];
    for ((time, value), slope) in POINTS.into_iter().zip(slopes) {
        for moment in [time - 1e-13, time, time + 1e-13] {
            let (at, rate) = schedule.smooth_at(moment);
            assert!((at - value).abs() < 1e-11 && (rate - slope).abs() < 1e-11, "{moment}: {at} {rate}");
        }
    }
    // Between, the cubic by Hermite's basis, and its rate by differences.
    for i in 0..5 {
        let ((t0, v0), (t1, v1)) = (POINTS[i], POINTS[i + 1]);
        for k in 1..10 {
            let (s, h) = (f64::from(k) / 10.0, t1 - t0);
            let basis = [
                (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s),
                s * (1.0 - s) * (1.0 - s) * h,
                s * s * (3.0 - 2.0 * s),
                s * s * (s - 1.0) * h,
            ];
            let expected = basis[0] * v0 + basis[1] * slopes[i] + basis[2] * v1 + basis[3] * slopes[i + 1];
            let time = t0 + s * h;
            let (value, rate) = schedule.smooth_at(time);
            close(value, expected);
            assert!(value >= v0.min(v1) - 1e-12 && value <= v0.max(v1) + 1e-12, "it overshoots");
            let (after, before) = (schedule.smooth_at(time + 1e-5).0, schedule.smooth_at(time - 1e-5).0);
            assert!((rate - (after - before) / 2e-5).abs() < 1e-8, "{rate}");
        }
    }
    for (time, value) in [(0.0, 0.5), (7.0, 4.5)] {
        assert_eq!(schedule.smooth_at(time), (value, 0.0));
        assert_eq!(schedule.at(time), value);
    }
    assert_eq!(Schedule::Constant(3.0).smooth_at(1.0), (3.0, 0.0));
    assert_eq!(Schedule::Table(vec![(1.0, 2.0)]).smooth_at(1.0), (2.0, 0.0));
}

#[test]
fn closed_form_table_between_its_points() {
    let schedule = Schedule::Table(POINTS.to_vec());
    for (time, value) in
        [(1.0, 0.5), (1.25, 1.0), (2.0, 2.5), (2.4, 4.9), (3.5, 6.5), (4.75, 7.5), (5.5, 6.0)]
    {
        close(schedule.at(time), value);
    }
}

#[test]
fn closed_form_integral_and_knots_of_a_table() {
    let schedule = Schedule::Table(POINTS.to_vec());
    // Trapezoids 1.5, 2, 13, 3.75 and 6 between the points; held before and after.
    let areas = [0.0, 1.5, 3.5, 16.5, 20.25, 26.25];
    for ((time, _), area) in POINTS.into_iter().zip(areas) {
        close(schedule.integral(1.0, time), area);
        close(schedule.integral(time, 1.0), -area);
        close(schedule.integral(-1.0, time), area + 1.0);
    }
    close(schedule.integral(6.0, 8.0), 9.0);
    close(schedule.integral(2.1, 2.3), 0.2 * 3.7);
    // Simpson's rule within one piece is exact, too.
    let simpson = (schedule.at(3.0) + 4.0 * schedule.at(3.4) + schedule.at(3.8)) * 0.8 / 6.0;
    close(schedule.integral(3.0, 3.8), simpson);
    assert_eq!(Schedule::Constant(3.0).integral(1.0, 3.0), 6.0);
    let knots = |from, to| schedule.knots(from, to).collect::<Vec<_>>();
    assert_eq!(knots(0.0, 9.0), POINTS.map(|(time, _)| time));
    assert_eq!((knots(2.0, 4.5), knots(5.0, 5.5)), (vec![2.5], vec![]));
    assert_eq!(Schedule::Constant(3.0).knots(0.0, 9.0).count(), 0);
}

const SINE: Sine = Sine { mean: 2.0, amplitude: 3.0, frequency: 5.0, phase: 0.4, begin: None };

#[test]
fn closed_form_a_sine_is_exact_everywhere() {
    let late = Sine { begin: Some(0.1), ..SINE };
    let omega = TAU * SINE.frequency;
    for (sine, begin) in [(SINE, 0.0), (late, 0.1)] {
        let schedule = Schedule::Sine(sine);
        for time in [0.1, 0.1234, 0.35, 1.7, 12.0] {
            let angle = omega * (time - begin) + 0.4;
            close(schedule.at(time), 2.0 + 3.0 * angle.sin());
            let (value, rate) = schedule.smooth_at(time);
            close(value, 2.0 + 3.0 * angle.sin());
            assert!((rate - 3.0 * omega * angle.cos()).abs() < 1e-10, "{rate}");
            if time > begin {
                assert!((schedule.slope(time) - rate).abs() < 1e-12);
            }
            // Its antiderivative, from a time to another one on either side.
            let whole = |time: f64| 2.0 * time - 3.0 / omega * (omega * (time - begin) + 0.4).cos();
            close(schedule.integral(0.15, time), whole(time) - whole(0.15));
        }
        // Over a whole period, the mean; over a short time, no digits lost.
        close(schedule.integral(0.3, 0.5), 0.4);
        let (short, value) = (1e-9, schedule.at(0.3 + 0.5e-9));
        assert!((schedule.integral(0.3, 0.3 + short) / (0.3 + short - 0.3) / value - 1.0).abs() < 1e-12);
    }
    // Before it begins it is held, at rest.
    let late = Schedule::Sine(late);
    let held = 2.0 + 3.0 * 0.4f64.sin();
    assert_eq!((late.at(0.05), late.smooth_at(0.05), late.slope(0.1)), (held, (held, 0.0), 0.0));
    close(late.integral(-0.2, 0.1), 0.3 * held);
    close(late.integral(0.3, 0.0), -0.1 * held - late.integral(0.1, 0.3));
    assert_eq!(late.knots(0.0, 1.0).collect::<Vec<_>>(), [0.1]);
    assert_eq!((late.shortest_period(0.05), late.shortest_period(0.1)), (None, Some(0.2)));
    assert_eq!(Schedule::Sine(SINE).knots(-1e9, 1e9).count(), 0);
    assert_eq!(late.values(), [-1.0, 5.0]);
}

#[test]
fn closed_form_a_sum_is_the_sum_of_its_parts() {
    let parts = [
        Schedule::Constant(-1.5),
        Schedule::Table(POINTS.to_vec()),
        Schedule::Sine(SINE),
        Schedule::Sine(Sine { begin: Some(2.2), frequency: 20.0, ..SINE }),
    ];
    let sum = Schedule::Sum(parts.to_vec());
    let of = |get: &dyn Fn(&Schedule) -> f64| parts.iter().map(get).sum::<f64>();
    for time in [0.0, 1.3, 2.2, 2.6, 5.5, 7.0] {
        close(sum.at(time), of(&|part| part.at(time)));
        assert!((sum.smooth_at(time).1 - of(&|part| part.smooth_at(time).1)).abs() < 1e-11);
        assert!((sum.slope(time) - of(&|part| part.slope(time))).abs() < 1e-11);
        close(sum.integral(0.5, time), of(&|part| part.integral(0.5, time)));
        let mut knots: Vec<f64> = sum.knots(time, 9.0).collect();
        knots.sort_by(f64::total_cmp);
        let mut expected: Vec<f64> =
            POINTS.iter().map(|point| point.0).chain([2.2]).filter(|knot| *knot > time).collect();
        expected.sort_by(f64::total_cmp);
        assert_eq!(knots, expected);
    }
    assert_eq!((sum.shortest_period(2.0), sum.shortest_period(3.0)), (Some(0.2), Some(0.05)));
}

#[test]
fn invariant_values_of_a_sum_bound_it_and_are_reached() {
    let sum = Schedule::Sum(vec![
        Schedule::Table(POINTS.to_vec()),
        Schedule::Sine(Sine { frequency: 40.0, amplitude: -3.0, begin: Some(2.2), ..SINE }),
        Schedule::Constant(1.0),
    ]);
    let ends = |values: &[f64]| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        (least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    };
    let bounds = ends(&sum.values());
    let seen: Vec<f64> = (0..100_000).map(|k| sum.at(f64::from(k) * 8e-5)).collect();
    let reached = ends(&seen);
    assert!(bounds.0 <= reached.0 && bounds.1 >= reached.1, "{bounds:?} {reached:?}");
    // 7.5 + 1 + 2 + 3 where the table is flat; least before the sine: 0.5 + 1 + 2 - 3 sin 0.4.
    close(bounds.1, 13.5);
    close(bounds.0, 3.5 - 3.0 * 0.4f64.sin());
    assert!(bounds.1 - reached.1 < 1e-3 && reached.0 - bounds.0 < 1e-12, "{reached:?}");
    // Not a number is no bound that a range would let pass.
    let broken = Schedule::Sum(vec![Schedule::Sine(Sine { mean: f64::NAN, ..SINE })]);
    assert!(broken.values().iter().all(|value| value.is_nan()));
    let difference = Schedule::Constant(10.0).values_of_difference(&Schedule::Sine(SINE));
    assert_eq!(ends(&difference), (5.0, 11.0));
}
