//! Contacts of pockets and lands by themselves.

use super::*;

/// A cylinder, and a sphere about the ball that is pressed into it.
fn pocket_models() -> [PocketModel; 2] {
    let pair = Pair::new([(206e9, 0.3), (105e9, 0.35)]);
    [None, Some(23e-3)].map(|sphere| PocketModel::new(4.7625e-3, 0.2e-3, sphere, &pair, 0.05, 0.5).unwrap())
}

/// Both pockets, dry and in oil [Pa s].
fn each_in_oil(k: usize) -> impl Iterator<Item = (usize, PocketModel, f64)> {
    [0.0, 0.03].into_iter().flat_map(move |oil| pocket_models().map(|model| (k, model, oil)))
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
        across: Vector3::y(),
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
    for (k, model, oil) in (0..8).flat_map(each_in_oil) {
        let (cage, ball) = (body(k), pressed_ball(k));
        let contact = model.evaluate(&ball, &cage, DIRECTION, oil).unwrap();
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
            let contact = model.evaluate(&cage, &race, model.positions[0], oil).unwrap();
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
    for (k, pocket, oil) in (0..8).flat_map(each_in_oil) {
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
            pocket.evaluate(&ball, &lift(&cage, t, change(k + 20)), DIRECTION, oil).unwrap()
        };
        let t = Dual::<1>::variable(0.0, 0, 1.0);
        let seeded = ball_of(&lift(&as_body, t, change(k + 10)));
        let exact = pocket.evaluate(&seeded, &lift(&cage, t, change(k + 20)), DIRECTION, oil).unwrap();
        compare(exact, [at(h), at(-h)], h);

        let (land, race) = (lands(false), pressed_race(k));
        let fixed = |race: &RaceMotion<f64>| RaceMotion {
            position: constant_vector::<Dual<1>>(&race.position),
            axis: constant_vector(&race.axis),
            across: race.across,
            velocity: constant_vector(&race.velocity),
            angular_velocity: constant_vector(&race.angular_velocity),
        };
        let at =
            |t: f64| land.evaluate(&lift(&cage, t, change(k + 20)), &race, land.positions[1], oil).unwrap();
        let exact =
            land.evaluate(&lift(&cage, t, change(k + 20)), &fixed(&race), land.positions[1], oil).unwrap();
        compare(exact, [at(h), at(-h)], h);
        assert!(pocket.evaluate(&ball, &lift(&cage, 0.0, still), DIRECTION, 0.0).is_some());
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
        let contact = model.evaluate(&ball, &cage, DIRECTION, 0.0).unwrap();
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
        let contact = pocket.evaluate(&ball, &cage, DIRECTION, 0.0).unwrap();
        let tangential = (contact.force.norm_squared() - contact.load.powi(2)).sqrt();
        assert!(tangential <= 0.05 * contact.load * (1.0 + 1e-9), "{tangential} {}", contact.load);
        // A ball that spins at 1200 rad/s in its pocket slides: nearly all of mu Q acts.
        assert!(tangential > 0.9 * 0.05 * contact.load);
        let axis = cage.axes[1] * DIRECTION[0] + cage.axes[2] * DIRECTION[1];
        let centred = BallMotion { position: cage.position + axis * 23e-3, ..ball };
        assert!(pocket.evaluate(&centred, &cage, DIRECTION, 0.0).is_none());
        let race = RaceMotion { position: cage.position, ..pressed_race(k) };
        assert!(lands(false).evaluate(&cage, &race, 0.0, 0.0).is_none());
    }
}

#[test]
fn closed_form_short_journal_bearing() {
    // Ocvirk (1952): a journal that turns in a bearing at rest, its centre at rest.
    let (viscosity, width, radius, clearance, speed) = (0.02, 2e-3, 26e-3, 1e-4, 300.0);
    let axis = Vector3::x();
    for ratio in [0.1, 0.4, 0.7, 0.85] {
        let eccentricity = Vector3::y() * (ratio * clearance);
        // Half way between both centres.
        let velocity = axis.cross(&(-0.5 * eccentricity)) * speed;
        let gap = Gap { axis, eccentricity, velocity, clearance };
        let (force, friction) = cage_film::land(&gap, viscosity, [width, radius], speed);
        let size = viscosity * speed * radius * width.powi(3) / (clearance * clearance);
        let room: f64 = 1.0 - ratio * ratio;
        let inwards = size * ratio * ratio / room.powi(2);
        let across = size * 0.25 * PI * ratio / room.powf(1.5);
        // A hundredth of the clearance is added to gaps as if at a right angle.
        let (tolerance, total) = (if ratio > 0.8 { 0.02 } else { 5e-3 }, inwards.hypot(across));
        assert!((force.y + inwards).abs() < tolerance * total, "{ratio}: {force} {inwards} {across}");
        assert!((force.z.abs() - across).abs() < tolerance * total, "{ratio}: {force} {inwards} {across}");
        // The film takes its journal along against the direction of rotation of the load line.
        assert!(force.z * velocity.z < 0.0);
        let petroff = 2.0 * PI * viscosity * width * radius.powi(3) * speed / (clearance * room.sqrt());
        assert!((friction / petroff + 1.0).abs() < 5e-3, "{friction} {petroff}");
    }
    // A film that only closes presses against it, and nothing presses where nothing closes.
    let still = Gap { axis, eccentricity: Vector3::zeros(), velocity: Vector3::zeros(), clearance };
    assert_eq!(cage_film::land(&still, viscosity, [width, radius], 0.0), (Vector3::zeros(), 0.0));
    let closing = Gap { velocity: Vector3::z() * 0.01, ..still };
    let (force, _) = cage_film::land(&closing, viscosity, [width, radius], 0.0);
    let squeeze = 0.5 * PI * viscosity * width.powi(3) * radius * 0.01 / clearance.powi(3);
    assert!((force.z / squeeze + 1.0).abs() < 1e-3 && force.y.abs() < 1e-9 * squeeze, "{force} {squeeze}");
}

#[test]
fn closed_form_film_of_a_pocket() {
    // Against Reynolds' equation along the pocket at each direction, integrated by a fine sum.
    let (viscosity, radius, clearance): (f64, f64, f64) = (0.03, 4.7625e-3, 1e-4);
    let axis = Vector3::x();
    let velocity = Vector3::new(0.0, 0.05, -0.02);
    let eccentricity = Vector3::new(0.0, 4e-5, 2e-5);
    let gap = Gap { axis, eccentricity, velocity, clearance };
    let spin = Vector3::new(40.0, -300.0, 200.0);
    let (force, moment) = cage_film::pocket(&gap, viscosity, radius, &spin);
    let (mut expected, turns, places) = (Vector3::zeros(), 720, 4000);
    for turn in 0..turns {
        let (sine, cosine) = (std::f64::consts::TAU * (f64::from(turn) + 0.5) / f64::from(turns)).sin_cos();
        let direction = Vector3::new(0.0, cosine, sine);
        let closing = direction.dot(&velocity);
        if closing <= 0.0 {
            continue;
        }
        let least = clearance - eccentricity.dot(&direction);
        // p(z) = 6 eta r V/h^2 with h = least + z^2/2r, summed far beyond where it has fallen.
        let reach = 60.0 * (2.0 * radius * least).sqrt();
        let step = 2.0 * reach / f64::from(places);
        let pressure: f64 = (0..places)
            .map(|place| {
                let z = -reach + (f64::from(place) + 0.5) * step;
                6.0 * viscosity * radius * closing / (least + z * z / (2.0 * radius)).powi(2) * step
            })
            .sum();
        expected -= direction * (pressure * radius * std::f64::consts::TAU / f64::from(turns));
    }
    assert!((force - expected).norm() < 5e-3 * expected.norm(), "{force} {expected}");
    // Shear of the ball in the middle: a band of pi root(2 r/c), all of it about the axis, half across.
    let size = viscosity * PI * radius.powi(3) * (2.0 * radius / clearance).sqrt();
    let petroff = Vector3::new(2.0 * PI * spin.x, PI * spin.y, PI * spin.z) * -size;
    assert!((moment - petroff).norm() < 1e-12 * petroff.norm(), "{moment} {petroff}");
}
