//! Contacts, balls, pockets and cage of states in general motion.

use super::*;

#[test]
fn closed_form_ball_race_contacts() {
    let (mut stick, mut slide) = (0, 0);
    for case in cases() {
        for (j, ball) in case.outputs.balls.iter().enumerate() {
            for (race, output) in [(0, &ball.inner), (1, &ball.outer)] {
                let (body, contact) = (case.races()[race], case.balls[j][race]);
                let ContactOutput { load, contact_angle, .. } = *output;
                close("load", load, contact.load, 1e-7, 0.0);
                // Of the force on the ball for the inner race, of the opposite for the outer one; relative to the race.
                let outwards = contact.normal * if race == 0 { -1.0 } else { 1.0 };
                let axial = outwards.dot(&body.axis());
                close("contact angle", contact_angle, axial.asin(), 1e-9, 1.0);
                assert!(contact_angle > 0.1);
                close("semi-axis along", output.semi_axis_rolling, contact.semi[0], 1e-7, 0.0);
                close("semi-axis across", output.semi_axis_transverse, contact.semi[1], 1e-7, 0.0);
                let pressure = 3.0 * contact.load / (2.0 * PI * contact.semi[0] * contact.semi[1]);
                close("pressure", output.peak_pressure, pressure, 1e-7, 0.0);
                let friction = &contact.friction;
                let c = (contact.semi[0] * contact.semi[1]).sqrt();
                let seen = [output.creepage_longitudinal, output.creepage_lateral, output.creepage_spin * c];
                let [xi, eta, phi] = friction.creepages;
                for (seen, expected) in seen.into_iter().zip([xi, eta, phi * c]) {
                    close("creepage", seen, expected, 1e-6, 1e-3);
                }
                // Between the independent coefficients, which are good to 1e-3 and interpolated.
                let limit = 0.07 * contact.load;
                close("force along", output.force_longitudinal, friction.forces[0], 4e-3, limit);
                close("force across", output.force_lateral, friction.forces[1], 4e-3, limit);
                close("moment", output.spin_moment, friction.forces[2], 4e-3, limit * contact.semi[1]);
                // Rolling across has coefficients in the ratio of a typical contact of the raceway, not of the one in hand.
                close("power", output.power, friction.power, 6e-3, 1e-3);
                let used = f64::hypot(friction.forces[0], friction.forces[1]) / limit;
                stick += u32::from(used < 0.5);
                slide += u32::from(used > 0.95);
            }
        }
    }
    assert!(stick > 10 && slide > 10, "{stick} {slide}");
}

#[test]
fn invariant_friction_opposes_each_slip() {
    // Whatever the law: where one slip rules, its force is against it.
    let mut seen = [0; 3];
    for case in cases() {
        for (j, ball) in case.outputs.balls.iter().enumerate() {
            for (race, output) in [(0, &ball.inner), (1, &ball.outer)] {
                let c = (output.semi_axis_rolling * output.semi_axis_transverse).sqrt();
                let slips = case.balls[j][race].friction.creepages;
                let sizes = [slips[0], slips[1], slips[2] * c].map(f64::abs);
                let forces = [output.force_longitudinal, output.force_lateral, output.spin_moment];
                for i in 0..3 {
                    if sizes[i] > 0.75 * sizes.iter().sum::<f64>() {
                        assert!(forces[i] * slips[i] < 0.0, "{i}: {forces:?} {slips:?}");
                        seen[i] += 1;
                    }
                }
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 3), "{seen:?}");
}

#[test]
fn closed_form_balls() {
    for case in cases() {
        let outer = case.races()[1];
        let tilt = case.state.race(Race::Outer).pose.orientation * V::x();
        for (ball, state) in case.outputs.balls.iter().zip(&case.state.balls) {
            assert_eq!((ball.position, ball.angular_velocity), (state.position, state.angular_velocity));
            // In a frame that tilts with the outer race but does not spin, azimuth from its y towards its z.
            let angle = V::x().cross(&tilt);
            let frame = UnitQuaternion::new(angle * (angle.norm().asin() / angle.norm()));
            let offset = |t: f64| state.position + state.velocity * t - outer.after(t).position;
            let seen = frame.inverse() * offset(0.0);
            close("azimuth", ball.azimuth, seen.z.atan2(seen.y), 1e-10, 1.0);
            // Swept angle about the axis as it stands.
            let around = |t: f64| frame.inverse() * offset(t);
            let (after, before) = (around(1e-7), around(-1e-7));
            let swept = (before.y * after.z - before.z * after.y) / (before.yz().norm() * after.yz().norm());
            close("orbital speed", ball.orbital_speed, swept.asin() / 2e-7, 1e-6, 1.0);
        }
    }
}

#[test]
fn closed_form_pockets() {
    let mut touching = 0;
    for case in cases() {
        for (ball, (approach, contact)) in case.outputs.balls.iter().zip(&case.pockets) {
            let pocket = ball.pocket.unwrap();
            close("approach", pocket.approach, *approach, 1e-9, CLEARANCE);
            let Some(contact) = contact else {
                assert_eq!((pocket.load, pocket.force, pocket.power), (0.0, V::zeros(), 0.0));
                continue;
            };
            touching += 1;
            close("load", pocket.load, contact.load, 1e-6, 0.0);
            close_vector("force", &pocket.force, &contact.force, 2e-4, contact.load);
            close("power", pocket.power, contact.friction.power, 4e-3, 0.0);
            // Pushed back, towards the pocket's middle.
            assert!(contact.load == 0.0 || pocket.force.dot(&contact.normal) < 0.0);
        }
    }
    assert!(touching > 15, "{touching}");
}

#[test]
fn closed_form_cage() {
    let mut lands_touched = [0; 2];
    for case in cases() {
        let (cage, body) = (case.outputs.cage.unwrap(), case.cage());
        assert_eq!((cage.pose.position, cage.pose.orientation), (body.position, body.orientation));
        assert_eq!(cage.twist.velocity, body.velocity);
        close_vector("angular velocity", &cage.twist.angular_velocity, &body.omega, 1e-14, 0.0);
        assert_eq!(cage.turned, 7.0);
        // The centre seen from the race that guides, in axes that tilt with it: along its axis, and across.
        let guide = case.races()[usize::from(case.guide != Guide::Inner)];
        let offset = body.position - guide.position;
        let n = guide.axis();
        close("axial eccentricity", cage.eccentricity.x, offset.dot(&n), 1e-10, CLEARANCE);
        // World y and z turned by the smallest rotation that takes x to the axis (Rodrigues).
        let tilted = |e: V| {
            let w = V::x().cross(&n);
            e + w.cross(&e) + w.cross(&w.cross(&e)) / (1.0 + n.x)
        };
        close("eccentricity y", cage.eccentricity.y, offset.dot(&tilted(V::y())), 1e-10, CLEARANCE);
        close("eccentricity z", cage.eccentricity.z, offset.dot(&tilted(V::z())), 1e-10, CLEARANCE);

        let on_cage = |sum: V, contact: &Contact| sum - contact.force;
        let forces = case.pockets.iter().filter_map(|(_, contact)| contact.as_ref());
        let loads: f64 = forces.clone().map(|contact| contact.load).sum();
        close_vector("pockets", &cage.pocket_force, &forces.clone().fold(V::zeros(), on_cage), 2e-4, loads);
        let power: f64 = forces.map(|contact| contact.friction.power).sum();
        close("pocket power", cage.pocket_power, power, 4e-3, 0.0);
        match &case.lands {
            None => {
                assert_eq!((cage.land_force, cage.land_loads, cage.land_power), (V::zeros(), [0.0; 2], 0.0));
                assert_eq!(cage.land_approach, f64::NEG_INFINITY);
            }
            Some(lands) => {
                let force = lands.iter().fold(V::zeros(), |sum, land| sum + land.force);
                close_vector("land force", &cage.land_force, &force, 1e-8, 1.0);
                for (side, land) in lands.iter().enumerate() {
                    close("land load", cage.land_loads[side], land.load, 1e-8, 1.0);
                    lands_touched[side] += u32::from(land.load > 0.0);
                }
                let deepest = lands[0].approach.max(lands[1].approach);
                close("land approach", cage.land_approach, deepest, 1e-10, CLEARANCE);
                let power = lands[0].friction_power + lands[1].friction_power;
                close("land power", cage.land_power, power, 1e-8, 0.0);
            }
        }
    }
    assert!(lands_touched.iter().all(|n| *n > 2), "{lands_touched:?}");
}
