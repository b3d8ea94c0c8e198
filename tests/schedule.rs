//! Scripted quantities: tables, and smooth motions through their points.

use roulement::scene::Schedule;

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
