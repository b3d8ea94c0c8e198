//! Contacts in oil: exact tangents, action and reaction, power, and none of these where a contact is open.

use super::*;

/// The thrust bearing in oil.
fn oiled() -> Model {
    let changes = [("film.iso_vg", "68.0"), ("film.temperature", "70.0")];
    Model::new(&Scene::edited(include_str!("../../../scenes/thrust.toml"), changes).unwrap()).unwrap()
}

/// Contacts in oil, full and mixed, with the usual slip, hardly any, and at rest.
fn in_oil(mut check: impl FnMut(&str, &ContactModel<'_>, &[f64; 18])) {
    let model = oiled();
    let laws = Laws::new();
    for (name, law, bend) in
        laws.bounded().into_iter().flat_map(|(name, law)| [(name, law, None), (name, law, Some(100.0))])
    {
        for (race, lubrication) in [(Race::Inner, 1.0), (Race::Outer, 0.1), (Race::Inner, 1e-6)] {
            let conditions = Conditions { lubrication, ..Conditions::of_friction(0.08) };
            let mut contact = model.contact(race, &conditions);
            (contact.law, contact.groove_bend) = (law, bend);
            for speed in [1.0, 1e-3] {
                let mut x = motion(race);
                // Rolling and slip fall alike; positions stay.
                for rate in [3, 4, 5, 6, 7, 8, 14, 15, 16, 17] {
                    x[rate] *= speed;
                }
                check(&format!("{name} {bend:?} {race:?} {lubrication} {speed}"), &contact, &x);
            }
        }
    }
}

#[test]
fn invariant_films_have_exact_tangents() {
    in_oil(|name, contact, x| {
        let (_, exact) = differentiated(contact, x);
        assert!(exact[0].value > 50.0);
        for i in [0, 1, 3, 4, 5, 6, 7, 8, 15] {
            // Slow contacts change within smaller differences of their speeds.
            let slow = if x[15].abs() < 1.0 { 1e-3 } else { 1.0 };
            let step = match i {
                0..=2 => 2e-10,
                3..=5 => 1e-5 * slow,
                _ => 1e-3 * slow,
            };
            let at = |sign: f64| {
                let mut moved = *x;
                moved[i] += sign * step;
                values(contact, &moved)
            };
            let (p1, m1, p2, m2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
            let (relative, rounding) =
                if name.starts_with("kalker ") { (1e-4, 1e-11) } else { (1e-6, f64::EPSILON) };
            for (k, row) in exact.iter().enumerate() {
                let difference = (8.0 * (p1[k] - m1[k]) - (p2[k] - m2[k])) / (12.0 * step);
                let largest = [0, 3, 6]
                    .map(|first| (first..first + 3).map(|k| row.derivatives[k].abs()).fold(0.0, f64::max))
                    [(i / 3).min(2)];
                let floor = 30.0 * rounding * row.value.abs().max(exact[0].value * 1e-3) / step;
                let error = (difference - row.derivatives[i]).abs();
                assert!(
                    error < relative * largest + floor,
                    "{name} row {k} by {i}: {difference} {}",
                    row.derivatives[i]
                );
            }
        }
    });
}

#[test]
fn invariant_films_act_and_react_and_lose_power() {
    in_oil(|name, contact, x| {
        let forces = evaluated(contact, x);
        let offset = Vector3::new(x[0] - x[9], x[1] - x[10], x[2] - x[11]);
        let balance = forces.ball_moment + offset.cross(&forces.force) + forces.race_moment;
        assert!(balance.norm() < 1e-12 * forces.race_moment.norm().max(1.0), "{name}");
        assert!(forces.friction_power > 0.0, "{name}");
        // What both bodies do is what is lost: power does not depend on the point that moments are taken about.
        let (ball, race) = motions_of(x);
        let done = forces.force.dot(&ball.velocity) + forces.ball_moment.dot(&ball.angular_velocity)
            - forces.force.dot(&race.velocity)
            + forces.race_moment.dot(&race.angular_velocity);
        let elastic = forces.load * {
            let arm = forces.geometry.normal * contact.surface.ball_radius;
            let slip = ball.velocity + ball.angular_velocity.cross(&arm)
                - race.velocity
                - race.angular_velocity.cross(&(offset + arm));
            slip.dot(&forces.geometry.normal)
        };
        let lost = -done - elastic;
        assert!(
            (lost - forces.friction_power).abs() < 1e-9 * (forces.friction_power + elastic.abs() + 1e-3),
            "{name}: {lost} {}",
            forces.friction_power
        );
        // Four at a time have the same bits, beside one that touches nothing.
        let away = BallMotion { position: ball.position - forces.geometry.normal * 1e-4, ..ball };
        let open = contact.evaluated(&away, &race);
        assert!(open.load == 0.0 && open.force == Vector3::zeros(), "{name}: {open:?}");
        let mut together = ContactGroup::filled(&forces);
        together.evaluate(contact, &race, &BallMotion::of_balls(&[ball, away, ball]));
        assert_eq!([together.contact(1), together.contact(2)], [open, forces], "{name}");
    });
}

#[test]
fn an_open_contact_in_oil_has_neither_force_nor_slope() {
    in_oil(|name, contact, x| {
        let touching = evaluated(contact, x);
        let mut x = *x;
        for i in 0..3 {
            x[i] -= 1e-4 * touching.geometry.normal[i];
        }
        let (ball, race) = motions_of(&x);
        assert!(contact.is_open(&ball, &race), "{name}");
        // With hysteresis against rolling as well.
        for row in differentiated(
            &ContactModel {
                resistance: roulement::contact::Resistance { factor: 1e-3, exponent: 1.33 },
                ..*contact
            },
            &x,
        )
        .1
        {
            assert!(row.value == 0.0 && row.derivatives.iter().all(|d| *d == 0.0), "{name} {row:?}");
        }
    });
}
