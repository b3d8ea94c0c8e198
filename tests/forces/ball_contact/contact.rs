//! The contact of two balls by itself.

use super::*;

/// Two balls pressed together by some approach [m], in general motion.
fn pressed(k: usize, approach: f64) -> [BallMotion<f64>; 2] {
    let normal = vector(k).normalize();
    let centre = vector(k + 1) * 20e-3;
    [-1.0, 1.0].map(|side| BallMotion {
        position: centre + normal * (side * (RADIUS - 0.5 * approach)),
        velocity: vector(k + 2) * 3.0 + vector(k + 4) * (0.1 * side),
        angular_velocity: vector(k + 7) * 900.0 + vector(k + 6) * (50.0 * side),
    })
}

#[test]
fn closed_form_load_and_friction_of_two_spheres() {
    let (mu, chi) = (0.08, 0.02);
    let model = BallBallModel::new(RADIUS, STEEL, mu);
    // Hertz 1882: Q = 4/3 E* sqrt(R*) delta^1.5 with 1/E* = 2 (1 - nu^2)/E and R* = R/2.
    let modulus = STEEL.0 / (2.0 * (1.0 - STEEL.1 * STEEL.1));
    let mut sliding = 0;
    for (k, approach) in [1e-8, 1e-6, 5e-6, 40e-6].into_iter().cycle().take(24).enumerate() {
        let [first, second] = pressed(k, approach);
        let pair = model.evaluate(&first, &second, chi).unwrap();
        let offset = second.position - first.position;
        let (normal, depth) = (offset.normalize(), 2.0 * RADIUS - offset.norm());
        let rate = normal.dot(&(first.velocity - second.velocity));
        let elastic = 4.0 / 3.0 * modulus * (0.5 * RADIUS).sqrt() * depth.powf(1.5);
        let load = (elastic * (1.0 + chi * rate)).max(0.0);
        assert!((pair.load - load).abs() < 1e-9 * load, "{} {load}", pair.load);
        assert!((model.elastic_energy(depth) / (0.4 * elastic * depth) - 1.0).abs() < 1e-9);
        // Coulomb's friction against the slip of the first surface on the second, smooth below 1 cm/s.
        let arm = offset * 0.5;
        let surface =
            |ball: &BallMotion<f64>, arm: Vector3<f64>| ball.velocity + ball.angular_velocity.cross(&arm);
        let slip = surface(&first, arm) - surface(&second, -arm);
        let slip = slip - normal * normal.dot(&slip);
        let expected = slip * (-mu * load / slip.norm().hypot(0.01));
        let friction = pair.force + normal * load;
        assert!((friction - expected).norm() < 1e-9 * mu * load, "{friction} {expected}");
        sliding += usize::from(slip.norm() > 1.0);
        assert!(friction.norm() <= mu * load * (1.0 + 1e-12));
        assert!((pair.moment - arm.cross(&pair.force)).norm() < 1e-12 * RADIUS * load);
        // Nothing acts across a gap.
        let [first, second] = pressed(k, -approach);
        assert!(model.evaluate(&first, &second, chi).is_none());
    }
    assert!(sliding > 8, "{sliding}");
    // Balls that roll on each other like gears have none.
    let [mut first, mut second] = pressed(0, 1e-6);
    (first.velocity, second.velocity) = (Vector3::x(), Vector3::x());
    let axis = vector(3).cross(&(second.position - first.position));
    (first.angular_velocity, second.angular_velocity) = (axis * 1e5, -axis * 1e5);
    let pair = model.evaluate(&first, &second, chi).unwrap();
    assert!(pair.moment.norm() < 1e-9 * RADIUS * pair.load && pair.friction_power < 1e-9);
}

#[test]
fn invariant_momentum_and_power_of_a_pair() {
    let model = BallBallModel::new(RADIUS, STEEL, 0.1);
    for k in 0..12 {
        let [first, second] = pressed(k, 3e-6);
        let pair = model.evaluate(&first, &second, 0.5).unwrap();
        // The forces are opposite by their form; they make no moment about any point.
        let about = vector(k + 9) * 0.1;
        let total = (first.position - about).cross(&pair.force) + pair.moment
            - (second.position - about).cross(&pair.force)
            + pair.other_moment;
        assert!(total.norm() < 1e-13 * 0.1 * pair.load, "{total}");
        // What they take is lost, or stored.
        let power = pair.force.dot(&(first.velocity - second.velocity))
            + pair.moment.dot(&first.angular_velocity)
            + pair.other_moment.dot(&second.angular_velocity);
        let at = |h: f64| {
            let moved =
                |ball: &BallMotion<f64>| BallMotion { position: ball.position + ball.velocity * h, ..*ball };
            model.elastic_energy(model.approach(&moved(&first), &moved(&second)))
        };
        let growth = (at(1e-9) - at(-1e-9)) / 2e-9;
        let lost = pair.friction_power + pair.damping_power;
        assert!(pair.friction_power > 0.0 && pair.damping_power >= 0.0);
        assert!((power + lost + growth).abs() < 1e-5 * (power.abs() + lost), "{power} {lost} {growth}");
    }
}

#[test]
fn identity_derivatives_agree_with_differences() {
    fn along<S: Scalar>(ball: &BallMotion<f64>, t: S, k: usize) -> BallMotion<S> {
        let line = |x: &Vector3<f64>, d: Vector3<f64>| constant_vector::<S>(x) + d.map(|d| t.scale(d));
        BallMotion {
            position: line(&ball.position, vector(k) * 1e-3),
            velocity: line(&ball.velocity, vector(k + 1) * 10.0),
            angular_velocity: line(&ball.angular_velocity, vector(k + 2) * 100.0),
        }
    }
    let model = BallBallModel::new(RADIUS, STEEL, 0.1);
    let h = 1e-7;
    for k in 0..12 {
        let [first, second] = pressed(k, 3e-6);
        let at = |t: f64| model.evaluate(&along(&first, t, k + 20), &along(&second, t, k + 30), 0.5).unwrap();
        let t = Dual::<1>::variable(0.0, 0, 1.0);
        let exact = model.evaluate(&along(&first, t, k + 20), &along(&second, t, k + 30), 0.5).unwrap();
        let (after, before) = (at(h), at(-h));
        for (exact, after, before) in
            [(exact.force, after.force, before.force), (exact.moment, after.moment, before.moment)]
        {
            let (slope, difference) = (exact.map(|x| x.derivatives[0]), (after - before) / (2.0 * h));
            assert!((slope - difference).norm() < 2e-5 * slope.norm(), "{slope} {difference}");
        }
    }
}
