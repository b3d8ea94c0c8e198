//! Oblique rolling.

use super::*;

/// Laws of a scene that have friction.
const FRICTION: [&str; 5] = ["linear", "regularised", "saturated", "kalker", "kalker_table"];

fn model_of(law: &str) -> Model {
    let creep = format!("\"{law}\"");
    let changes = [("effects.creep", &*creep), ("friction.ball_race", "2.0")];
    Model::new(&Scene::edited(include_str!("../../../scenes/thrust.toml"), changes).unwrap()).unwrap()
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
fn as_simulated(model: &Model, race: Race, x: &[f64; 18]) -> BallRaceContact<f64> {
    evaluated(&model.contact(race, &Conditions::of_friction(0.08)), x)
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
                let contact = model.contact(race, &Conditions::of_friction(0.08));
                let (_, exact) = differentiated(&contact, &x);
                seen.push(as_simulated(&model, race, &x).rolling_cosine.abs());
                for i in 3..9 {
                    let step = if i < 6 { 1e-5 } else { 1e-3 };
                    let at = |sign: f64| {
                        let mut moved = x;
                        moved[i] += sign * step;
                        values(&contact, &moved)
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
            let alone = motions.each_ref().map(|ball| contact.evaluated(ball, &race_motion));
            assert!(alone[2].rolling_cosine.abs() < 0.9 && alone[0].rolling_cosine.abs() > 0.995);
            let mut together = ContactGroup::filled(&alone[0]);
            together.evaluate(&contact, &race_motion, &BallMotion::of_balls(&motions));
            for (lane, alone) in alone.iter().enumerate() {
                assert_eq!(together.contact(lane), *alone, "{law} {race:?} {lane}");
            }
            // Rolling along the circumference knows nothing of rolling across it.
            let mut straight = contact;
            straight.across = None;
            assert_eq!(straight.evaluated(&motions[0], &race_motion), alone[0], "{law}");
            assert_ne!(straight.evaluated(&motions[2], &race_motion).creep, alone[2].creep, "{law}");
        }
    }
}

#[test]
fn invariant_what_a_contact_did_before_does_not_change_its_bits() {
    for (law, bend) in FRICTION.into_iter().flat_map(|law| [(law, None), (law, Some(100.0))]) {
        let model = model_of(law);
        for race in Race::BOTH {
            let mut contact = model.contact(race, &Conditions::of_friction(0.08));
            contact.groove_bend = bend;
            assert_eq!((contact.path(false), contact.path(true)), (Path::Plain, Path::General));
            let cosine =
                |turning: f64| as_simulated(&model, race, &oblique_motion(race, turning)).rolling_cosine;
            let straight = if cosine(-150.0).abs() > cosine(150.0).abs() { -150.0 } else { 150.0 };
            // All along the circumference; one of four obliquely; all of them, from where it begins; one that is open.
            let turnings = [
                [straight; WIDTH],
                [straight, 0.9 * straight, -3e3, straight],
                [-2.0 * straight, -2e4, 400.0, 1e3],
                [straight, -900.0, straight, 1.1 * straight],
            ];
            let (_, race_motion) = motions_of(&motion(race));
            let mut groups =
                turnings.map(|turnings| turnings.map(|turning| motions_of(&oblique_motion(race, turning)).0));
            groups[3][1].position.x += if race == Race::Inner { 3e-5 } else { -3e-5 };
            assert_eq!(contact.evaluated(&groups[3][1], &race_motion).load, 0.0);
            let mut seen = vec![];
            for (before, now) in groups.iter().flat_map(|before| groups.each_ref().map(|now| (before, now))) {
                let mut together = ContactGroup::filled(&contact.evaluated(&before[0], &race_motion));
                for balls in [before, now, now] {
                    together.evaluate(&contact, &race_motion, &BallMotion::of_balls(balls));
                }
                seen.push(together.rolled_obliquely());
                for (lane, ball) in now.iter().enumerate() {
                    let alone = contact.evaluated(ball, &race_motion);
                    assert_eq!(together.contact(lane), alone, "{law} {race:?} {lane}");
                    assert_eq!(bits(&together.contact(lane)), bits(&alone), "{law} {race:?} {lane}");
                }
            }
            assert!(seen.contains(&true) && seen.contains(&false), "{law} {race:?}");
            // Nor those of its derivatives.
            for turning in turnings.as_flattened() {
                let x = oblique_motion(race, *turning);
                let x: [Dual<9>; 18] = std::array::from_fn(|i| Dual::variable(x[i], i % 9, 1.0 + i as f64));
                let (ball, race_motion) = motions_of(&x);
                let [plain, general] = [Path::Plain, Path::General]
                    .map(|path| contact.differentiated(path, &ball, &race_motion));
                assert_eq!(plain, general, "{law}");
            }
        }
    }
}

/// A ball that rolls along the circumference with no lateral creep at all, whatever the sign of these zeros; and one that rolls obliquely
/// from the same place.
fn without_lateral_creep(race: Race, zero: f64) -> [BallMotion<f64>; 2] {
    let x = motion(race);
    let straight = BallMotion {
        position: Vector3::new(x[0], x[1].hypot(x[2]), zero),
        velocity: Vector3::new(zero, zero, x[4].hypot(x[5])),
        angular_velocity: Vector3::new(x[6], x[7].hypot(x[8]), zero),
    };
    let turning = straight.angular_velocity + Vector3::new(0.0, 0.0, 3e3);
    [straight, BallMotion { angular_velocity: turning, ..straight }]
}

#[test]
fn invariant_a_contact_without_lateral_creep_has_its_bits_after_oblique_rolling_too() {
    // Numbers as they are written, and signs of zeros with them.
    let written = |of: &dyn std::fmt::Debug| format!("{of:?}");
    let mut models: Vec<_> = FRICTION.iter().map(|law| (*law, model_of(law))).collect();
    // Not plain, with and without friction.
    let resisting = [("effects.hysteresis", "true")];
    for (law, changes) in [("frictionless", &[][..]), ("saturated", &resisting)] {
        let creep = format!("\"{law}\"");
        let changes = [&[("effects.creep", &*creep)], changes].concat();
        let scene = Scene::edited(include_str!("../../../scenes/thrust.toml"), changes).unwrap();
        models.push((law, Model::new(&scene).unwrap()));
    }
    for ((law, model), zero) in models.iter().flat_map(|model| [0.0, -0.0].map(|zero| (model, zero))) {
        for race in Race::BOTH {
            let contact = model.contact(race, &Conditions::of_friction(0.08));
            let [straight, oblique] = without_lateral_creep(race, zero);
            let race_motion = RaceMotion {
                position: Vector3::new(motion(race)[9], zero, zero),
                axis: Vector3::new(1.0, zero, zero),
                across: Vector3::y(),
                velocity: Vector3::repeat(zero),
                angular_velocity: Vector3::new(motion(race)[15], zero, zero),
            };
            let alone = contact.evaluated(&straight, &race_motion);
            assert!(alone.load > 50.0 && alone.creepage.lateral == 0.0, "{law} {race:?} {alone:?}");
            let general = ContactModel { across: None, ..contact };
            if contact.path(false) == Path::Plain && *law != "frictionless" {
                assert_eq!(
                    written(&general.evaluated(&straight, &race_motion)),
                    written(&alone),
                    "{law} {race:?}"
                );
                assert!(
                    contact.evaluated(&oblique, &race_motion).rolling_cosine.abs() < 0.9,
                    "{law} {race:?}"
                );
            }
            // By four: as the first that a group does, after oblique ones, after its own, beside an oblique one.
            let evaluations = [
                vec![[straight; WIDTH]],
                vec![[oblique; WIDTH], [straight; WIDTH]],
                vec![[oblique; WIDTH], [straight; WIDTH], [straight; WIDTH]],
                vec![[oblique; WIDTH], [straight, straight, straight, oblique]],
                vec![[straight; WIDTH], [straight, straight, straight, oblique]],
            ];
            for before in evaluations {
                let mut together = ContactGroup::filled(&contact.evaluated(&oblique, &race_motion));
                for balls in &before {
                    together.evaluate(&contact, &race_motion, &BallMotion::of_balls(balls));
                }
                for lane in 0..3 {
                    assert_eq!(
                        written(&together.contact(lane)),
                        written(&alone),
                        "{law} {race:?} {zero:?} {lane}"
                    );
                }
            }
            // With derivatives: the path that it went before does not change one of them.
            let variable = |v: &Vector3<f64>, first: usize| {
                Vector3::from_fn(|i, _| Dual::<9>::variable(v[i], first + i, 1.0 + i as f64))
            };
            let ball = BallMotion {
                position: variable(&straight.position, 0),
                velocity: variable(&straight.velocity, 3),
                angular_velocity: variable(&straight.angular_velocity, 6),
            };
            let seen = [false, true].map(|obliquely| {
                contact.differentiated(contact.path(obliquely), &ball, &race_motion.constant())
            });
            assert_eq!(written(&seen[0]), written(&seen[1]), "{law} {race:?} {zero:?}");
            assert_eq!(seen[0].load.value.to_bits(), alone.load.to_bits(), "{law} {race:?}");
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
