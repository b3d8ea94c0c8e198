//! Sums over a bearing, and runs: races, reactions, work and losses, speeds, counters.

use super::*;

#[test]
fn closed_form_sums() {
    for case in cases() {
        let (outputs, races) = (&case.outputs, case.races());
        let contacts = || case.balls.iter().flatten();
        let pockets = || case.pockets.iter().filter_map(|(_, contact)| contact.as_ref());
        let lands = || case.lands.iter().flatten();
        let friction = contacts().chain(pockets()).map(|c| c.friction.power).sum::<f64>()
            + lands().map(|land| land.friction_power).sum::<f64>();
        close("friction power", outputs.friction_power, friction, 4e-3, 0.0);
        let damping = contacts().chain(pockets()).map(|c| c.damping_power).sum::<f64>()
            + lands().map(|land| land.damping_power).sum::<f64>();
        close("damping power", outputs.damping_power, damping, 1e-5, 0.0);
        // Kinetic energy by velocity and spin, elastic energy by springs.
        let mass = DENSITY * 4.0 / 3.0 * PI * RADIUS.powi(3);
        let kinetic = |mass: f64, inertia: V, body: &Body| {
            let rate = body.orientation.inverse() * body.omega;
            0.5 * mass * body.velocity.norm_squared() + 0.5 * inertia.dot(&rate.component_mul(&rate))
        };
        let mut energy = contacts().chain(pockets()).map(|c| c.elastic_energy).sum::<f64>()
            + lands().map(|land| land.elastic_energy).sum::<f64>();
        for ball in &case.state.balls {
            energy += kinetic(mass, V::repeat(0.4 * mass * RADIUS * RADIUS), &body_of_ball(ball));
        }
        for (i, body) in [races[0], races[1], case.cage()].iter().enumerate() {
            energy += kinetic(MASSES[i], V::from(INERTIAS[i]), body);
        }
        close("energy", outputs.stored_energy, energy, 1e-9, 0.0);
        // Cage speed about its own axis; slip against the orbit in which each ball would roll on both races about the axis that
        // it has: two equations of surface speeds, for that orbit and the ball's own spin.
        let cage = case.cage();
        let speed = cage.omega.dot(&cage.axis());
        close("cage speed", outputs.cage_speed, speed, 1e-12, 0.0);
        let (mut rolling, mut orbit, mut weight) = (0.0, 0.0, 0.0);
        for (ball, of_ball) in case.state.balls.iter().zip(&case.balls) {
            let load = of_ball[0].load.min(of_ball[1].load);
            let out = ball.position - races[1].position;
            let about = races[1].axis();
            let across = out - about * about.dot(&out);
            let relative = ball.velocity - races[1].velocity;
            let own = about.cross(&across).dot(&relative) / across.norm_squared();
            let spin = ball.angular_velocity - about * own;
            let equation = |race: usize| {
                let axis = races[race].axis();
                let offset = ball.position - races[race].position;
                let radial = (offset - axis * axis.dot(&offset)).normalize();
                let along = axis.cross(&radial);
                let arm = of_ball[race].normal * RADIUS;
                let reach = (offset + arm).dot(&radial);
                (reach, spin.cross(&arm).dot(&along), reach * races[race].omega.dot(&axis))
            };
            let [(a, b, e), (c, d, f)] = [equation(0), equation(1)];
            rolling += load * (e * d - b * f) / (a * d - b * c);
            orbit += load * own;
            weight += load;
        }
        close("cage slip", outputs.cage_slip, 1.0 - speed * weight / rolling, 1e-9, 1.0);
        close("ball slip", outputs.ball_slip, 1.0 - orbit / rolling, 1e-9, 1.0);
        assert_eq!(outputs.time, 1e-3);
        assert!(case.model.stiffness_outputs == outputs.condensed.is_some());
    }
}

/// A race and what the mechanics say that contacts exert on it, about its origin.
fn wrench_on_race(case: &Case, race: usize) -> (V, V) {
    let mut sum = (V::zeros(), V::zeros());
    for of_ball in &case.balls {
        sum = (sum.0 - of_ball[race].force, sum.1 + of_ball[race].other_moment);
    }
    if usize::from(case.guide != Guide::Inner) == race {
        for land in case.lands.iter().flatten() {
            sum = (sum.0 - land.force, sum.1 + land.other_moment);
        }
    }
    sum
}

#[test]
fn closed_form_races_of_a_run() {
    for guide in [Guide::Outer, Guide::Inner, Guide::Balls] {
        let mut simulation = simulation(&scene(guide));
        let mut turned = [0.0; 2];
        // The cage is thrown against pockets and lands on the way.
        for point in 0..=6 {
            if point > 0 {
                simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
                let end = f64::from(point) * 0.5e-3;
                turned = [0, 1].map(|i: usize| turned[i] + SPEEDS[i] * (end - simulation.time()));
                simulation.advance(end).unwrap();
            }
            let (outputs, races) =
                (simulation.outputs(), [&simulation.outputs().inner, &simulation.outputs().outer]);
            let case = Case::of(simulation.model(), simulation.state(), guide);
            for (i, race) in races.into_iter().enumerate() {
                let body = case.races()[i];
                assert_eq!((race.pose.position, race.pose.orientation), (body.position, body.orientation));
                assert_eq!(race.twist.velocity, body.velocity);
                close_vector("angular velocity", &race.twist.angular_velocity, &body.omega, 1e-14, 0.0);
                close("spin", body.omega.dot(&body.axis()), SPEEDS[i], 1e-9, 0.0);
                close("turned", race.turned, turned[i], 1e-9, 1e-3);
                let (force, moment) = wrench_on_race(&case, i);
                let loads: f64 = case.balls.iter().map(|contacts| contacts[i].load).sum();
                close_vector("force", &race.wrench.force, &force, 1e-4, loads);
                close_vector("moment", &race.wrench.moment, &moment, 1e-4, loads * 0.5 * PITCH);
                // Only friction turns a race about its axis: creep coefficients are good to a few per mille.
                let axial = moment.dot(&body.axis());
                let friction = 0.07 * loads * 0.5 * PITCH;
                close("axial moment", race.wrench.moment.dot(&body.axis()), axial, 4e-3, 0.02 * friction);
                if i == 0 {
                    close("friction torque", outputs.friction_torque, -axial, 4e-3, 0.02 * friction);
                }
            }
        }
    }
}

#[test]
fn closed_form_friction_torque_turns_with_the_speed() {
    // Against the inner race's rotation as seen from the outer one: positive either way round, whichever turns.
    for [inner, outer] in
        [[600.0, 0.0], [-600.0, 0.0], [0.0, 600.0], [0.0, -600.0], [300.0, 800.0], [-200.0, -700.0]]
    {
        let speed = inner - outer;
        let [inner, outer] = [inner, outer].map(|speed: f64| format!("{speed:?}"));
        let speeds = [("load.inner_speed", &*inner), ("load.outer_speed", &*outer)];
        let scene = scenes::scene(&scene(Guide::Outer), &speeds);
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.advance(3e-3).unwrap();
        let outputs = simulation.outputs();
        let torque = outputs.inner.wrench.moment.dot(&(outputs.inner.pose.orientation * V::x()));
        assert!(outputs.friction_torque > 1e-3 && torque * speed < 0.0);
        close("torque", outputs.friction_torque, torque.abs(), 1e-12, 0.0);
    }
}

#[test]
fn closed_form_drive_torque_and_reactions_balance_a_race() {
    // Consistent at the start and after settling: Newton's and Euler's laws about each race's own origin.
    for ramp in [false, true] {
        let speed = if ramp { "[[0.0, 600.0], [0.1, 1600.0]]" } else { "600.0" };
        let scene = scenes::scene(&scene(Guide::Outer), &[("load.inner_speed", speed)]);
        let mut simulation = Simulation::new(&scene).unwrap();
        for point in 1..=60 {
            simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
            simulation.advance(f64::from(point) * 1e-4).unwrap();
        }
        if ramp {
            // Driven up by 1e4 rad/s2.
            let inner = &simulation.outputs().inner;
            let axis = inner.pose.orientation * V::x();
            let moment = inner.wrench.moment + simulation.inputs().inner.applied.moment;
            let expected = 1e4 * INERTIAS[0][0] - moment.dot(&axis);
            close("drive torque", inner.drive_torque, expected, 2e-3, 0.01);
            continue;
        }
        // The scheme weighs forces of both ends of a step: short ones, between which forces hardly change.
        let mut held_about_z = Vector2::zeros();
        for point in 1..=10 {
            simulation.advance(6e-3 + f64::from(point) * 2e-7).unwrap();
            let inner = &simulation.outputs().inner;
            let about_z = inner.wrench.moment.z;
            held_about_z += 0.1 * Vector2::new(inner.reaction.moment.z, about_z);
        }
        let (outputs, inputs) = (simulation.outputs(), simulation.inputs());
        let weight = |i: usize| V::from(GRAVITY) * MASSES[i];
        // The hinge holds place and axis; the spin is steady: nothing is left over.
        let outer = &outputs.outer;
        let scale = outer.wrench.force.norm();
        close_vector("hinge force", &outer.reaction.force, &-(outer.wrench.force + weight(1)), 1e-5, scale);
        close_vector(
            "hinge moment",
            &outer.reaction.moment,
            &-outer.wrench.moment,
            1e-5,
            scale * 0.5 * PITCH,
        );
        let axis = outer.pose.orientation * V::x();
        close("axis", axis.z, -(TILT[0].hypot(TILT[1]).sin() / TILT[0].hypot(TILT[1])) * TILT[0], 1e-9, 1.0);
        close("drive torque", outer.drive_torque, -outer.wrench.moment.dot(&axis), 1e-3, 1e-4);
        close("drive torque", outer.drive_torque, outer.reaction.moment.dot(&axis), 1e-12, 1e-3);

        // The inner race is held along z and about world z, and driven; it may move in the other directions.
        let inner = &outputs.inner;
        let axis = inner.pose.orientation * V::x();
        let held = inner.wrench.force.z + inputs.inner.applied.force.z + weight(0).z;
        close("force along z", inner.reaction.force.z, -held, 1e-5, scale);
        assert_eq!((inner.reaction.force.x, inner.reaction.force.y), (0.0, 0.0));
        assert!(held.abs() > 10.0);
        let drive = -(inner.wrench.moment + inputs.inner.applied.moment).dot(&axis);
        close("drive torque", inner.drive_torque, drive, 2e-3, 0.01);
        assert!(drive.abs() > 1e-3);
        // What holds the tilt about z does not act about the axis nor about y.
        let across = inner.reaction.moment - axis * inner.drive_torque;
        assert!(across.dot(&axis).abs() < 1e-9 * across.norm() && across.y.abs() < 2e-3 * across.norm());
        // Multipliers of places and tilts go to and fro from step to step; their mean holds.
        close("moment about z", held_about_z[0], -held_about_z[1], 5e-3, 0.1);
        assert!(held_about_z[1].abs() > 0.05);
    }
}

#[test]
fn closed_form_work_and_losses_by_quadrature() {
    // Every microsecond over half a millisecond: power of loads, drives and weights; and what friction and damping took.
    let mut simulation = simulation(&scene(Guide::Outer));
    simulation.advance(1e-3).unwrap();
    let powers = |simulation: &Simulation| {
        let (o, state) = (simulation.outputs(), simulation.state());
        let applied = &simulation.inputs().inner.applied;
        let mut input =
            applied.force.dot(&o.inner.twist.velocity) + applied.moment.dot(&o.inner.twist.angular_velocity);
        for race in [&o.inner, &o.outer] {
            // Held directions do not move: of the reactions only the drive works.
            input += race.drive_torque * race.twist.angular_velocity.dot(&(race.pose.orientation * V::x()));
        }
        let gravity = V::from(GRAVITY);
        let mass = DENSITY * 4.0 / 3.0 * PI * RADIUS.powi(3);
        input += state.balls.iter().map(|ball| mass * gravity.dot(&ball.velocity)).sum::<f64>();
        let bodies = [&o.inner.twist.velocity, &o.outer.twist.velocity, &o.cage.unwrap().twist.velocity];
        input += bodies.iter().zip(MASSES).map(|(v, mass)| mass * gravity.dot(v)).sum::<f64>();
        [input, o.friction_power + o.damping_power, o.cage_speed]
    };
    // What is put in at the start, and there the same by the state itself.
    let start = self::simulation(&scene(Guide::Outer));
    close("input at the start", start.state().powers.input, powers(&start)[0], 1e-10, 0.0);
    close("losses at the start", start.state().powers.friction, start.outputs().friction_power, 1e-12, 0.0);
    close("damping at the start", start.state().powers.damping, start.outputs().damping_power, 1e-9, 1e-6);
    let first = simulation.outputs().clone();
    let (mut before, mut sums) = (powers(&simulation), [0.0; 3]);
    for point in 1..=500 {
        simulation.advance(1e-3 + f64::from(point) * 1e-6).unwrap();
        let after = powers(&simulation);
        sums = [0, 1, 2].map(|i: usize| sums[i] + 0.5e-6 * (before[i] + after[i]));
        before = after;
    }
    let last = simulation.outputs();
    close("work", last.work - first.work, sums[0], 1e-3, 0.0);
    close("dissipated", last.dissipated - first.dissipated, sums[1], 1e-6, 0.0);
    let turned = |outputs: &Outputs| outputs.cage.unwrap().turned;
    close("cage turned", turned(last) - turned(&first), sums[2], 1e-9, 0.0);
    let stored = last.stored_energy - first.stored_energy;
    close("balance", last.work - first.work, last.dissipated - first.dissipated + stored, 1e-3, 0.0);
}

#[test]
fn closed_form_without_a_cage_the_mean_orbit_is_the_cage_speed() {
    let text = include_str!("../../../scenes/thrust.toml");
    let mut simulation = simulation(text);
    simulation.advance(1e-3).unwrap();
    let mut state = simulation.state().clone();
    for (j, ball) in state.balls.iter_mut().enumerate() {
        ball.velocity *= 1.0 + 0.01 * j as f64;
    }
    let outputs = Outputs::new(simulation.model(), &state, &Conditions::of_friction(0.08));
    let speeds = outputs.balls.iter().map(|ball| {
        let p = ball.position;
        let state = state.balls.iter().find(|state| state.position == p).unwrap();
        (p.y * state.velocity.z - p.z * state.velocity.y) / (p.y * p.y + p.z * p.z)
    });
    let mean = speeds.sum::<f64>() / 10.0;
    close("cage speed", outputs.cage_speed, mean, 1e-12, 0.0);
    assert!(outputs.cage.is_none() && outputs.balls.iter().all(|ball| ball.pocket.is_none()));
    // A race of given motion: the torque that would balance the bearing's, and no reaction.
    let outer = &outputs.outer;
    close("drive torque", outer.drive_torque, -outer.wrench.moment.x, 1e-12, 0.0);
    assert_eq!((outer.reaction.force, outer.reaction.moment), (V::zeros(), V::zeros()));
    // Balls alone and the inner race store energy: a fixed race does not.
    let still = simulation.outputs();
    assert!(still.stored_energy > 0.0 && still.time == 1e-3);
    // Races at rest have no speed to compare with.
    let rest = scenes::scene(text, &[("load.inner_speed", "0.0")]);
    assert_eq!(Simulation::new(&rest).unwrap().outputs().cage_slip, 0.0);
}

/// Orbital speed of rolling on both races at contact angles of their own, about an axis of a pitch angle: Harris, Rolling
/// Bearing Analysis, 4th edition, eq. 8.14, outer race at rest; `gamma` is ball over orbit diameter.
fn harris(inner_speed: f64, gamma: f64, [inner, outer]: [f64; 2], pitch: f64) -> f64 {
    let turned = |angle: f64| angle.cos() + pitch.tan() * angle.sin();
    let outer_part = (1.0 + gamma * outer.cos()) * turned(inner);
    let inner_part = (1.0 - gamma * inner.cos()) * turned(outer);
    inner_speed * inner_part / (outer_part + inner_part)
}

#[test]
fn closed_form_slip_by_the_contact_angles_of_both_races() {
    // Fast and lightly loaded: balls lie far out on the outer race and high up on the inner one.
    let text = include_str!("../../../scenes/thrust.toml");
    let fast = [
        ("load.inner_speed", "\"20000 rpm\""),
        ("load.x.force", "\"60 N\""),
        ("start.spin_balance", "false"),
    ];
    let mut simulation = Simulation::new(&scenes::scene(text, &fast)).unwrap();
    let first = simulation.outputs();
    let angles = [first.balls[0].inner.contact_angle, first.balls[0].outer.contact_angle];
    assert!(angles[0] > 2.0 * angles[1], "{angles:?}");
    // The start rolls on both races: a mean contact angle called that slip.
    close("ball slip at the start", first.ball_slip, 0.0, 1e-9, 1.0);
    close("cage slip at the start", first.cage_slip, 0.0, 1e-9, 1.0);
    let radius = 4.7625e-3;
    let speed = 20000.0 * std::f64::consts::PI / 30.0;
    let mean = 0.5 * speed * (1.0 - radius / 0.023 * (0.5 * (angles[0] + angles[1])).cos());
    assert!((1.0 - first.cage_speed / mean).abs() > 0.02, "{} {mean}", first.cage_speed);
    // Balls that roll about axes of any pitch angle between the contacts, then behind that orbit by a known part.
    for pitch in [0.1, 0.3, 0.6] {
        for behind in [0.0, 0.02] {
            let mut state = simulation.state().clone();
            for ball in &mut state.balls {
                let orbit = ball.position.yz().norm();
                let rolling = harris(speed, radius / orbit, angles, pitch);
                let own = rolling * (1.0 - behind);
                let along = V::x().cross(&ball.position) / orbit;
                let radial = along.cross(&V::x());
                // Seen from the orbit the ball turns about (-cos, sin) of its pitch angle, at any speed.
                let spin = V::x() * -pitch.cos() + radial * pitch.sin();
                ball.velocity = along * (own * orbit);
                ball.angular_velocity = V::x() * own + spin * (0.9 * speed);
            }
            let outputs = Outputs::new(simulation.model(), &state, &Conditions::of_friction(0.08));
            close("ball slip", outputs.ball_slip, behind, 1e-12, 1.0);
            close("cage slip", outputs.cage_slip, behind, 1e-12, 1.0);
        }
    }
    // And it stays small while friction takes the axes to where they belong.
    simulation.advance(1e-3).unwrap();
    assert!(simulation.outputs().cage_slip.abs() < 0.01, "{}", simulation.outputs().cage_slip);
}

#[test]
fn closed_form_counters_of_equal_steps() {
    let equal = [("solver.initial_step", "\"10 us\"")];
    let scene = scenes::scene(include_str!("../../../scenes/thrust.toml"), &equal);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance(2e-3).unwrap();
    let s = simulation.outputs().statistics;
    // The last step may leave a rounded rest.
    assert!((200..=201).contains(&s.steps) && s.rejected_error + s.rejected_newton == 0, "{s:?}");
    // A step evaluates 20 contacts once, and each correction once more.
    let evaluations = 20 * (s.steps + s.newton.iterations);
    assert!(s.newton.iterations >= 200, "{s:?}");
    assert_eq!(s.contact_values, evaluations, "{s:?}");
    // The first step needs all blocks; each factorisation has one new one at least, of two contacts.
    let blocks = 2 * s.newton.factorisations..=20 * s.newton.factorisations;
    assert!(s.contact_tangents >= 20 && blocks.contains(&s.contact_tangents), "{s:?}");
    assert_eq!((s.polynomials, s.polynomial_failures, s.second_guesses), (0, 0, 0));
}
