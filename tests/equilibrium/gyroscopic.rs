//! How the gyroscopic moment is carried: the control of either race, and the one that costs less heat.

use roulement::equilibrium::{Equilibrium, Gyroscopic};

use crate::equilibria::solve;

/// A 218 angular contact bearing under thrust at a speed \[rpm].
fn angular(force: f64, rpm: f64, gyroscopic: Gyroscopic) -> Equilibrium {
    let held = |name: &str, key: &str| format!("{name} = {{ {key} = 0.0 }}\n");
    let text = format!(
        "[bearing]\nballs = 16\nball_diameter = \"22.23 mm\"\npitch_diameter = \"125.26 mm\"\ncontact_angle = \"40 deg\"\n\
         inner_conformity = 0.5232\nouter_conformity = 0.5232\n[ball]\ndensity = 7870\n[load]\ninner_speed = \"{rpm} rpm\"\n\
         x = {{ force = {force} }}\n{}{}{}{}",
        held("y", "displacement"),
        held("z", "displacement"),
        held("ry", "rotation"),
        held("rz", "rotation"),
    );
    solve(&text, gyroscopic)
}

#[test]
fn closed_form_cage_speed_and_force_of_the_race_that_balls_do_not_spin_on() {
    const RADIUS: f64 = 0.5 * 22.23e-3;
    let inertia = 7870.0 * std::f64::consts::PI * 22.23e-3f64.powi(3) / 6.0 * 0.4 * RADIUS * RADIUS;
    for (force, rpm) in [(17800.0, 3000.0), (22250.0, 6000.0), (44500.0, 10000.0)] {
        let speed = rpm * std::f64::consts::PI / 30.0;
        for gyroscopic in [Gyroscopic::InnerRaceControl, Gyroscopic::OuterRaceControl] {
            let found = angular(force, rpm, gyroscopic);
            let ball = &found.balls[0];
            let (inner, outer) = (ball.report.inner_contact_angle, ball.report.outer_contact_angle);
            let orbit = ball.position.yz().norm();
            // Harris, Rolling bearing analysis (4th ed.), ball speed ratios for control of each race, outer ring at rest.
            let (g, apart) = (RADIUS / orbit, (inner - outer).cos());
            let by_inner = gyroscopic == Gyroscopic::InnerRaceControl;
            let ratio =
                if by_inner { apart - g * outer.cos() } else { 1.0 - g * inner.cos() } / (1.0 + apart);
            assert!((found.cage_speed / (ratio * speed) - 1.0).abs() < 1e-9, "{rpm} {gyroscopic:?}");
            // The ball turns about the tangent of the race that it does not spin on: its spin towards the axis makes the moment.
            let radial = if by_inner {
                (speed - found.cage_speed) / g * inner.sin()
            } else {
                found.cage_speed / g * outer.sin()
            };
            let moment = -inertia * found.cage_speed * radial;
            assert!((ball.report.gyroscopic_moment / moment - 1.0).abs() < 1e-6, "{rpm} {gyroscopic:?}");
            // Its force at that race alone: balance along the axis and outwards.
            let friction = moment / RADIUS;
            let [at_inner, at_outer] = if by_inner { [friction, 0.0] } else { [0.0, friction] };
            let (si, ci, so, co) = (inner.sin(), inner.cos(), outer.sin(), outer.cos());
            let (qi, qo) = (ball.report.inner_load, ball.report.outer_load);
            // n x e_t of the inner contact (from the ball to the race) is (-cos, sin), of the outer one (cos, -sin).
            let axial = qi * si - qo * so + (at_inner * -ci + at_outer * co);
            let outwards =
                qi * ci - qo * co + (at_inner * si - at_outer * so) + ball.report.centrifugal_force;
            assert!(
                axial.abs() < 1e-6 * qo && outwards.abs() < 1e-6 * qo,
                "{gyroscopic:?} {axial} {outwards}"
            );
        }
    }
}

#[test]
fn invariant_least_heat_is_the_control_with_less_heat_of_spin() {
    // At low speed both races have one load, and the longer ellipse of the inner one holds the balls; with speed the outer load grows.
    let same = |one: &Equilibrium, other: &Equilibrium| {
        (one.displacement[0] - other.displacement[0]).abs() < 1e-12
            && (one.cage_speed - other.cage_speed).abs() < 1e-9 * other.cage_speed
    };
    let of = |rpm| {
        [Gyroscopic::LeastHeat, Gyroscopic::InnerRaceControl, Gyroscopic::OuterRaceControl]
            .map(|gyroscopic| angular(17800.0, rpm, gyroscopic))
    };
    let [least, inner, outer] = of(500.0);
    assert!(same(&least, &inner) && !same(&least, &outer));
    let [least, inner, outer] = of(12000.0);
    assert!(same(&least, &outer) && !same(&least, &inner));
}
