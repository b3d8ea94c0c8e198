//! A shaft at rest on its bearings.

use crate::common::{GEARBOX, ROTOR, forces, held, run, system};

/// Forces by hand: each bearing's radial force acts where the cone of its contacts meets the axis.
#[test]
fn closed_form_bearing_forces_of_a_gear_shaft_are_those_of_statics() {
    // Creep forces of balls that start at one common speed have faded.
    let system = run(GEARBOX, 1e-3);
    let [left, right] = [0, 1].map(|k| forces(&system)[k]);
    let load = nalgebra::Vector3::new(337.8, -475.0, 1260.5 - 9.81 * 1.8);
    assert!((left + right + load).norm() < 2e-3 * load.norm(), "{left} {right}");
    let cone = 0.023 * 40f64.to_radians().tan();
    let (a, b) = (-0.05 - cone, 0.05 + cone);
    // Moments of the load about the middle of the shaft: the mesh acts at -10 mm.
    let (about_y, about_z) = (0.01 * 1260.5, -8.04 + 0.01 * 475.0);
    let on_right = [(about_z - a * load.y) / (b - a), (-about_y - a * load.z) / (b - a)];
    let on_left = [load.y - on_right[0], load.z - on_right[1]];
    for (found, by_hand) in [(left, on_left), (right, on_right)] {
        let hand = by_hand[0].hypot(by_hand[1]);
        let size = found.y.hypot(found.z);
        assert!((size / hand - 1.0).abs() < 0.01, "{size} {hand}");
    }
}

#[test]
fn invariant_a_preloaded_pair_without_load_has_equal_and_opposite_axial_forces() {
    let text = GEARBOX
        .replace("force = [337.8, -475.0, 1260.5]", "force = [0, 0, 0]")
        .replace("moment = [30.0, 0, -8.04]", "moment = [0, 0, 0]")
        .replace("gravity = [0, 0, -9.81]", "gravity = [0, 0, 0]")
        .replace("6000 rpm", "1 rpm")
        .replace("[load]\n", "[bearing.set]\nfriction.ball_race = 0.0\n[load]\n")
        .replace(
            "[[bearing]]\nname = \"right\"",
            "[bearing.set]\nfriction.ball_race = 0.0\n[[bearing]]\nname = \"right\"",
        );
    let system = system(&text);
    let [left, right] = [0, 1].map(|k| forces(&system)[k]);
    for force in [left.x, -right.x] {
        assert!((force / -1500.0 - 1.0).abs() < 1e-3, "{left} {right}");
    }
    assert!(system.outputs().seats.iter().all(|seat| seat.displacement.norm() < 1e-9));
}

/// The middle of a beam under a force and two end moments, by Timoshenko's theory, from the moments that the bearings are found to carry.
#[test]
fn closed_form_a_shaft_bends_between_its_bearings_as_a_beam_does() {
    let system = system(ROTOR);
    let outputs = system.outputs();
    let (length, diameter, force) = (0.4f64, 0.025f64, 100.0);
    let second = std::f64::consts::PI / 64.0 * diameter.powi(4);
    let area = 0.25 * std::f64::consts::PI * diameter.powi(2);
    let (bending, shear) = (206e9 * second, 206e9 / 2.6 * area * (6.0 * 1.3 / (7.0 + 6.0 * 0.3)));
    // Moments of the bearings about z on the shaft's ends; that of the left bearing bends the middle towards +y where it is negative.
    let signs = system.scene().bearings.iter().map(|mounted| mounted.mounting.direction.sign());
    let moments: Vec<f64> =
        system.bearings().map(|(_, bearing)| bearing.outputs().inner.wrench.moment.z).collect();
    assert!(signs.eq([1.0, -1.0]));
    let alone = force * length.powi(3) / (48.0 * bending) + force * length / (4.0 * shear);
    let by_moments = (moments[0] - moments[1]) * length * length / (16.0 * bending);
    let chord = 0.5 * (outputs.seats[0].displacement.y + outputs.seats[1].displacement.y);
    let found = outputs.loads[0].displacement.y - chord;
    assert!(by_moments.abs() > 1e-3 * alone, "the bearings hold the ends: {by_moments}");
    // Creep forces of the running balls and the place of contacts are what is left.
    assert!((found / (alone + by_moments) - 1.0).abs() < 1e-3, "{found} {alone} {by_moments}");
}

#[test]
fn what_cannot_be_held_is_refused_with_what_is_missing() {
    // One bearing, which can let go of the shaft in -x.
    let text = GEARBOX.replace("[337.8, -475.0, 1260.5]", "[-5000.0, 0, 0]");
    let second = text.find("[[bearing]]\nname = \"right\"").unwrap();
    let load = text.find("[load]").unwrap();
    let alone = format!("{}{}", &text[..second], &text[load..]);
    let refusal = roulement::simulation::system::System::new(&crate::common::scene(&alone)).unwrap_err();
    assert!(refusal.to_string().contains("equilibrium"), "{refusal}");
}

/// Balls opposite to the load are held by their centrifugal force alone, and the race goes away from them until it ends.
#[test]
fn an_unloaded_ball_that_leaves_its_groove_is_told_from_too_large_a_load() {
    let heavy = |preload: &str| {
        GEARBOX
            .replace("[337.8, -475.0, 1260.5]", "[0, 40e3, 0]")
            .replace("moment = [30.0, 0, -8.04]", "moment = [0, 0, 0]")
            .replace("position = \"-10 mm\"", "position = 0.0")
            .replace("6000 rpm", "600 rpm")
            .replace("preload = { force = \"1500 N\" }", &format!("preload = {{ force = \"{preload} N\" }}"))
    };
    let refusal =
        roulement::simulation::system::System::new(&crate::common::scene(&heavy("500"))).unwrap_err();
    let said = refusal.to_string();
    assert!(said.contains("carries next to nothing; more axial load or preload"), "{said}");
    let held = system(&heavy("2000"));
    let steepest = held.bearings().flat_map(|(_, bearing)| bearing.outputs().balls.clone());
    let steepest = steepest.map(|ball| ball.inner.contact_angle.abs()).fold(0.0, f64::max);
    println!("{steepest} rad");
    assert!((1.4..std::f64::consts::FRAC_PI_2).contains(&steepest), "{steepest} rad");
}

/// A heavy rotor on stiff bearings, which tilts by a tenth of a microradian: every load is balanced.
#[test]
fn regression_a_rotor_that_hardly_tilts_is_balanced_under_every_load() {
    let weight = 9.81 * 20.0;
    let loads =
        [[200.0, -100.0], [196.2, -18.0], [196.2, -19.5], [196.2, -20.0], [196.2, -22.0], [0.0, -50.0]];
    for [along, across] in loads {
        let bearing = |name: &str, position: f64, direction: &str| {
            format!(
                "[[bearing]]\nname = \"{name}\"\nscene = \"whirl/one.toml\"\n\
                 mounting = {{ position = {position}, direction = \"{direction}\", preload = {{ force = 200 }} }}\n"
            )
        };
        let text = [
            "gravity = [-9.81, 0, 0]\n[shaft]\nspeed = \"6000 rpm\"\nmass = 20\npolar_inertia = 0.1\ntransverse_inertia = 0.3\n",
            &format!("[[shaft.load]]\nname = \"side\"\nposition = 0.03\nforce = [{along}, 0, {across}]\n"),
            &bearing("left", -0.15, "+x"),
            &bearing("right", 0.15, "-x"),
            "[load]\nduration = 0.005\noutput_interval = 5e-5\n",
        ];
        let system = system(&text.concat());
        let held: Vec<_> = held(&system).into_iter().map(|[force, _]| force).collect();
        let sum = held[0] + held[1];
        let expected = nalgebra::Vector3::new(weight - along, 0.0, -across);
        // What weighs inside of the bearings is theirs.
        assert!(
            (sum - expected).yz().norm() < 1e-6 && (sum.x - expected.x).abs() < 1.0,
            "{along} {across}: {held:?}"
        );
    }
}
