//! Contacts and laws of four at a time have the bits of one.

use super::*;

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
            let alone = motions.each_ref().map(|m| contact.evaluated(m, &race_motion));
            assert!(alone[0].load > 50.0 && alone[3].load == 0.0);

            // With the vectors that this processor has.
            for count in 1..=WIDTH {
                let mut together = ContactGroup::filled(&alone[3]);
                let balls = BallMotion::of_balls(&motions[..count]);
                together.evaluate(&contact, &race_motion, &balls);
                // And where it has none.
                let mut one_by_one = ContactGroup::filled(&alone[3]);
                one_by_one.evaluate_one_by_one(&contact, &race_motion, &balls);
                for (lane, alone) in alone[..count].iter().enumerate() {
                    assert_eq!(together.contact(lane), *alone, "{name}");
                    assert_eq!(one_by_one.contact(lane), *alone, "{name}");
                }
            }
            // Where none of them touches, costly laws are not asked: with the signs of beside one that does.
            for touching in [None, Some(motions[0])] {
                let mut balls = away;
                balls[0] = touching.unwrap_or(away[0]);
                let mut together = ContactGroup::filled(&alone[0]);
                together.evaluate(&contact, &race_motion, &BallMotion::of_balls(&balls));
                for (lane, ball) in balls.iter().enumerate() {
                    let alone = contact.evaluated(ball, &race_motion);
                    assert_eq!(bits(&together.contact(lane)), bits(&alone), "{name}, {lane}");
                    assert_eq!(contact.is_open(ball, &race_motion), alone.load == 0.0, "{name}, {lane}");
                }
            }
            // One by one.
            let mut together = ContactGroup::filled(&alone[3]);
            (0..WIDTH).for_each(|lane| together.set(lane, &alone[lane]));
            assert!((0..WIDTH).all(|lane| together.contact(lane) == alone[lane]), "{name}");
            // All balls of a bearing, as many as fill no group: each with a difference of its own, or none.
            let balls = [&motions[..], &away].concat().into_iter().chain([motions[2]]).collect::<Vec<_>>();
            let of_balls: Vec<_> = (0..balls.len())
                .map(|ball| Difference { value: [1e-3 * ball as f64; 4], ..Difference::default() })
                .collect();
            for simulated in [false, true] {
                let difference = |ball: usize| simulated.then(|| &of_balls[ball]);
                let all = contact.evaluate_balls(&balls, &race_motion, difference);
                let alone =
                    |(ball, motion)| contact.of_ball(ball, difference(ball)).evaluated(motion, &race_motion);
                assert_eq!(all, balls.iter().enumerate().map(alone).collect::<Vec<_>>(), "{name}");
            }
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
