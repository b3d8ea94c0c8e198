//! Cylindrical and tapered roller bearings of a machine.

use std::path::Path;

use nalgebra::Vector3;
use roulement::interface::variables::MachineVariables;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::MachineEquilibrium;

use crate::common::{held, imbalance, run, scene, stored, system};

/// A rigid shaft on a 6205 and on an NU 206, with a load between them and one beyond.
const NON_LOCATING: &str = r#"
[shaft]
speed = "1500 rpm"
mass = "2 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "3e-3 kg m^2"

[[shaft.load]]
name = "pull"
position = "60 mm"
force = ["150 N", "4 kN", "-3 kN"]

[[bearing]]
name = "ball"
catalogue = "6205"
mounting = { position = 0 }

[[bearing]]
name = "roller"
catalogue = "NU 206"
level = "equilibrium"
mounting = { position = "100 mm" }

[load]
duration = "1 ms"
output_interval = "100 us"
"#;

#[test]
fn closed_form_a_roller_bearing_carries_its_share_and_no_axial_force() {
    let system = system(NON_LOCATING);
    let link = &system.outputs().links[0];
    let force = link.state.force;
    let [on_ball, moment] = held(&system)[0];
    // Moments about the middle of the ball bearing: 0.06 F + 0.1 R + M + M_R = 0.
    let y = -(0.06 * 4000.0 + moment.z + force[5]) / 0.1;
    let z = -(0.06 * -3000.0 - moment.y - force[4]) / 0.1;
    assert!((force[1] - y).abs() < 1e-6 * 2400.0 && (force[2] - z).abs() < 1e-6 * 2400.0, "{force} {y} {z}");
    assert_eq!(force[0], 0.0);
    assert!((on_ball.x + 150.0).abs() < 1e-3, "{on_ball}");
    // Sjoevall's factor is between that of half a loaded circle and that of a few rollers.
    let rollers = *link.rollers().unwrap();
    let factor = 13.0 * rollers.largest_load / force[1].hypot(force[2]);
    assert!((4.08..6.0).contains(&factor), "{factor}");
    assert!((3..=7).contains(&rollers.loaded), "{}", rollers.loaded);
}

#[test]
fn invariant_a_package_has_the_rollers_of_the_catalogue_and_bits_are_the_same_again() {
    let whole = scene(NON_LOCATING);
    assert!(!whole.source.contains("NU 206") && whole.source.contains("rollers"));
    let again = SystemScene::of_package(&whole.source).unwrap();
    assert_eq!(again.source, whole.source);
    let mut systems =
        [&whole, &again].map(|scene| roulement::simulation::system::System::new(scene).unwrap());
    for (system, ends) in systems.iter_mut().zip([&[0.3e-3, 1e-3][..], &[1e-3]]) {
        for end in ends {
            system.advance(*end).unwrap();
        }
    }
    let [one, other] = &systems;
    let close = (one.outputs().links[0].state.force - other.outputs().links[0].state.force).norm();
    assert!(close < 1.0, "{close}");
    // Saved and restored, it goes on in the same bits.
    let mut first = system(NON_LOCATING);
    first.advance(0.4e-3).unwrap();
    let saved = first.snapshot();
    first.advance(1e-3).unwrap();
    let mut second = system(NON_LOCATING);
    assert!(second.restore(&saved));
    second.advance(1e-3).unwrap();
    assert_eq!(first.outputs(), second.outputs());
    assert_eq!(first.snapshot(), second.snapshot());
    // Its outputs in a package.
    let rows = MachineVariables::new(&first);
    for name in [
        "roller.force.y",
        "roller.largest_load",
        "roller.peak_pressure",
        "roller.loaded_rollers",
        "roller.life.L10r",
    ] {
        assert!(rows.rows().iter().any(|row| row.name == name), "{name}");
    }
}

#[test]
fn invariant_energy_is_kept_as_rollers_pass_and_their_cage_turns() {
    let before = stored(&system(NON_LOCATING));
    let system = run(NON_LOCATING, 4e-3);
    let link = &system.outputs().links[0];
    let turned = link.state.taken.abs().max(link.state.stored);
    assert!(link.state.unaccounted().abs() < 1e-4 * turned, "{:e} of {turned:e}", link.state.unaccounted());
    let [of_shaft, of_bearings] = imbalance(&system, &before);
    assert!(of_shaft < 1e-3 && of_bearings < 1e-3, "{of_shaft:e} {of_bearings:e}");
}

#[test]
fn closed_form_ribs_carry_a_thrust_one_way_or_both() {
    // A 6205 that slides, and rollers that locate: all of the thrust is theirs.
    let located = |name: &str, thrust: &str, direction: &str| {
        NON_LOCATING
            .replace("\"150 N\"", thrust)
            .replace("NU 206", name)
            .replace("{ position = 0 }", "{ position = 0, axial = \"free\" }")
            .replace(
                "{ position = \"100 mm\" }",
                &format!("{{ position = \"100 mm\", direction = \"{direction}\" }}"),
            )
    };
    let cases = [
        ("NUP 206", 300.0, "+x"),
        ("NUP 206", -300.0, "+x"),
        ("NJ 206", 300.0, "+x"),
        ("NJ 206", -300.0, "-x"),
    ];
    for (name, thrust, direction) in cases {
        let system = system(&located(name, &format!("\"{thrust} N\""), direction));
        let link = &system.outputs().links[0];
        assert!((link.state.force[0] + thrust).abs() < 1e-3 * 300.0, "{name} {thrust}: {}", link.state.force);
        assert!(link.rollers().unwrap().largest_rib_load > 300.0 / 13.0);
    }
    // Against its rib nothing holds the shaft.
    let away = scene(&located("NJ 206", "\"-300 N\"", "+x"));
    assert!(roulement::simulation::system::System::new(&away).is_err());
    // Without any that is known from the keys.
    let text = located("NU 206", "0", "+x");
    let why = SystemScene::parse(&text, None, Path::new("")).unwrap_err().to_string();
    assert!(why.contains("nothing would hold the shaft along its axis"), "{why}");
}

/// A shaft on two tapered bearings back to back, with a 6205 that slides and hardly carries at its end.
fn tapered_pair(clearance: &str, force: &str) -> String {
    let one = |name: &str, position: &str, direction: &str| {
        format!(
            "[[bearing]]\nname = \"{name}\"\nrollers = {{ count = 17, diameter = \"7.2 mm\", length = \"10 mm\", pitch_diameter = \"46 mm\", \
             contact_angle = \"14 deg\", roller_angle = \"4 deg\", axial_clearance = \"{clearance}\" }}\n\
             mounting = {{ position = \"{position}\", direction = \"{direction}\" }}\n"
        )
    };
    let (before, load) = NON_LOCATING.split_once("[[bearing]]\nname = \"roller\"").unwrap();
    let before = before.replace("{ position = 0 }", "{ position = \"200 mm\", axial = \"free\" }");
    let (_, load) = load.split_once("[load]").unwrap();
    let whole = before + &one("left", "0 mm", "-x") + &one("right", "100 mm", "+x") + "[load]" + load;
    whole.replace("[\"150 N\", \"4 kN\", \"-3 kN\"]", force)
}

#[test]
fn closed_form_a_pair_of_tapered_bearings_has_the_preload_of_its_clearance_and_shares_a_thrust() {
    let axial = |clearance: &str, force: &str| {
        let system = system(&tapered_pair(clearance, force));
        let links = &system.outputs().links;
        (links[0].state.force[0], links[1].state.force[0], *links[0].rollers().unwrap())
    };
    // Each bearing alone, pressed together by 8 um.
    let geometry = roulement::model::link::rollers::Geometry {
        count: 17,
        diameter: 7.2e-3,
        length: 10e-3,
        pitch_diameter: 46e-3,
        diametral_clearance: 0.0,
        profile: roulement::model::link::roller::Profile::Logarithmic,
        ribs: [false; 2],
        axial_clearance: 0.0,
        rib_stiffness: None,
        first_azimuth: 0.0,
        taper: Some(roulement::model::link::rollers::Taper {
            contact_angle: 14f64.to_radians(),
            roller_angle: 4f64.to_radians(),
            direction: 1.0,
        }),
    };
    let alone = roulement::model::link::rollers::Rollers::new(geometry, None);
    let turning = nalgebra::Vector6::ith(3, 1500.0 * std::f64::consts::TAU / 60.0);
    let preload = -alone.force(&nalgebra::Vector6::ith(0, 8e-6), &turning).force[0];
    let (left, right, _) = axial("-8 um", "[0, 0, 0]");
    assert!(
        (left / preload - 1.0).abs() < 1e-3 && (right / -preload - 1.0).abs() < 1e-3,
        "{left} {right} {preload}"
    );
    // A thrust goes to the right one where there is play. Centrifugal forces press the rollers of the other one along its outer race against the rib:
    // `F_c tan(a)/(1 + tan(a) tan(b))` each, with the angles of the outer line and of the axes.
    let (left, right, rollers) = axial("5 um", "[\"600 N\", 0, 0]");
    let [a, b] = [14f64, 12.0].map(|angle| angle.to_radians().tan());
    let cage = alone.ratio() * turning[3];
    let mass = 7800.0 * std::f64::consts::PI / 4.0 * 7.2e-3f64.powi(2) * 10e-3;
    let thrown = 17.0 * mass * 23e-3 * cage * cage * a / (1.0 + a * b);
    assert!((left / thrown - 1.0).abs() < 1e-4 && rollers.loaded == 0, "{left} {thrown}");
    assert!((left + right + 600.0).abs() < 1e-3, "{left} {right}");
    let (left, right, _) = axial("-8 um", "[\"600 N\", 0, 0]");
    assert!(
        (left + right + 600.0).abs() < 1e-3 && left > 0.3 * preload && left < preload,
        "{left} {right} {preload}"
    );
    // A radial load pushes both apart, along the axis.
    let (left, right, rollers) = axial("0 um", "[0, \"4 kN\", 0]");
    assert!((left + right).abs() < 1e-3 && left > 100.0 && rollers.largest_rib_load > 1.0, "{left} {right}");
}

/// The tapered pair with a preload of both, in place of a clearance.
fn preloaded(preload: &str) -> String {
    ["-x", "+x"].iter().fold(
        tapered_pair("1 um", "[0, 0, 0]").replace(", axial_clearance = \"1 um\"", ""),
        |text, direction| {
            let own = format!("direction = \"{direction}\"");
            text.replace(&format!("{own} }}"), &format!("{own}, preload = {preload} }}"))
        },
    )
}

#[test]
fn closed_form_tapered_bearings_have_the_preload_that_they_are_given() {
    let axial = |text: &str| {
        let system = system(text);
        let links = &system.outputs().links;
        [links[0].state.force[0], links[1].state.force[0]]
    };
    for wanted in [40.0, 900.0, 20e3] {
        for own in axial(&preloaded(&format!("{{ force = {wanted} }}"))) {
            // Its weight presses the shaft across the axis, too.
            assert!((own.abs() / wanted - 1.0).abs() < 10.0 / wanted, "{own} {wanted}");
        }
    }
    let way = axial(&preloaded("{ displacement = \"8 um\" }"));
    assert_eq!(way, axial(&tapered_pair("-8 um", "[0, 0, 0]")));
}

#[test]
fn a_preload_of_rollers_that_cannot_be_is_refused() {
    let too_much = preloaded("{ force = \"1 MN\" }");
    let twice = tapered_pair("-8 um", "[0, 0, 0]")
        .replace("direction = \"-x\" }", "direction = \"-x\", preload = { force = 10 } }");
    let pulled = preloaded("{ force = -10 }");
    let far = preloaded("{ displacement = \"2 mm\" }");
    let across = NON_LOCATING
        .replace("{ position = \"100 mm\" }", "{ position = \"100 mm\", preload = { force = 10 } }");
    assert!(across != NON_LOCATING);
    for (text, parts) in [
        (too_much, ["bearing.mounting.preload.force", "1000000", "allowed is [0,"]),
        (twice, ["bearing.mounting.preload", "axial_clearance", "one of both"]),
        (far, ["bearing.mounting.preload.displacement = 0.002", "m", "allowed is [-0.01, 0.001]"]),
        (pulled, ["bearing.mounting.preload.force", "-10", "allowed is [0,"]),
        (across, ["bearing.mounting", "preload", "tapered"]),
    ] {
        let why = SystemScene::parse(&text, None, Path::new(".")).unwrap_err().to_string();
        for part in parts {
            assert!(why.contains(part), "{why}\nshould have {part}");
        }
    }
}

#[test]
fn invariant_a_tapered_bearing_by_its_designation_is_that_of_its_keys() {
    let by_keys = tapered_pair("-8 um", "[\"600 N\", \"2 kN\", 0]");
    let written = by_keys.split("rollers = {").nth(1).unwrap().split('}').next().unwrap();
    let keys: toml::Table = roulement::catalogue::rollers_of("30206").unwrap().unwrap().parse().unwrap();
    let inline: Vec<String> = keys.iter().map(|(key, value)| format!("{key} = {value}")).collect();
    let own = by_keys.replace(written, &format!(" {}, axial_clearance = \"-8 um\" ", inline.join(", ")));
    let named = by_keys.replace(
        &format!("rollers = {{{written}}}"),
        "catalogue = \"SKF 30206 J2/Q\"\nset = { rollers = { axial_clearance = \"-8 um\" } }",
    );
    let [own, named] = [own, named]
        .map(|text| system(&text).outputs().links.iter().map(|link| link.state.force).collect::<Vec<_>>());
    assert!(own == named && own[0][1].hypot(own[1][1]) > 1000.0, "{own:?} {named:?}");
}

#[test]
fn invariant_the_equilibrium_reports_rollers_with_their_life() {
    let found = MachineEquilibrium::of(&scene(NON_LOCATING), 0.0, 100.0).unwrap();
    let value = found.to_json();
    let of = &value["bearings_by_stiffness"]["roller"];
    let rollers = found.outputs.links[0].rollers().unwrap();
    assert_eq!(of["largest_load"].as_f64(), Some(rollers.largest_load));
    let hours = rollers.life * 1e6 / (1500.0 * 60.0);
    assert!((of["L10r_hours"].as_f64().unwrap() / hours - 1.0).abs() < 1e-9);
    // The stiffness is the force's change by a change of the load, with the other bearing's.
    assert_eq!(rollers.stiffness.row(0).norm(), 0.0);
    assert!(rollers.stiffness[(1, 1)] > 5e7 && rollers.stiffness[(1, 1)] < 1e9, "{}", rollers.stiffness);
    let text = found.to_string();
    for part in ["rollers without friction", "rollers loaded, up to", "static safety", "axes of the shaft"] {
        assert!(text.contains(part), "{text}\nshould have {part}");
    }
    // Both bearings' lives are one, where both are known.
    assert!(found.hours()[0].is_some_and(|all| all < hours) && found.hours()[1].is_none());
}

#[test]
fn hard_a_misaligned_bore_of_10_mrad_and_a_load_through_the_gap() {
    let tilted = NON_LOCATING.replace(
        "{ position = \"100 mm\" }",
        "{ position = \"100 mm\", misalignment = { ry = \"10 mrad\", rz = \"-4 mrad\" } }",
    );
    let system = system(&tilted);
    let link = &system.outputs().links[0];
    let even = crate::common::system(NON_LOCATING);
    let [tilt, none] = [link, &even.outputs().links[0]].map(|link| *link.rollers().unwrap());
    assert!(tilt.peak_pressure > 1.2 * none.peak_pressure && tilt.life < none.life, "{tilt:?} {none:?}");
    // A load that turns over: the shaft goes through the gap, and is caught.
    let reversed = NON_LOCATING.replace(
        "force = [\"150 N\", \"4 kN\", \"-3 kN\"]",
        "force = [\"150 N\", [[0, 4000], [0.5e-3, -4000], [1, -4000]], 0]",
    );
    let system = run(&reversed, 2e-3);
    let force: Vector3<f64> = system.outputs().links[0].state.force.fixed_rows::<3>(0).into_owned();
    assert!(force.iter().all(|value| value.is_finite()), "{force}");
}

#[test]
fn refusals_of_rollers_name_key_value_and_range() {
    let refuse = |text: &str| SystemScene::parse(text, None, Path::new("")).unwrap_err().to_string();
    let keys =
        "rollers = { count = 13, diameter = \"9 mm\", length = \"8.8 mm\", pitch_diameter = \"46.5 mm\" }";
    let own = NON_LOCATING.replace("catalogue = \"NU 206\"", keys);
    scene(&own);
    for (text, parts) in [
        (
            NON_LOCATING.replace("\"equilibrium\"", "\"dynamic\""),
            &["roller", "bearing.level", "rollers are simulated at level = \"equilibrium\""][..],
        ),
        (NON_LOCATING.replace("NU 206", "NU 299"), &["roller", "NU 299 is a cylindrical roller bearing"]),
        (own.replace("count = 13", "count = 17"), &["bearing.rollers.diameter = 0.009", "0.0085"]),
        (own.replace("\"8.8 mm\"", "\"8.8 kg\""), &["length", "8.8 kg", "kg measures something else"]),
        (own.replace("count = 13", "count = 13, axial_clearance = 1e-5"), &["bearing.rollers.axial_way"]),
        (own.replace("count = 13", "count = 13, axial_way = \"x\""), &["axial_way", "both"]),
        (
            own.replace("count = 13", "count = 13, contact_angle = \"14 deg\""),
            &["bearing.rollers", "give both"],
        ),
        (
            own.replace(
                "count = 13",
                "count = 13, contact_angle = \"14 deg\", roller_angle = \"4 deg\", diametral_clearance = 0",
            ),
            &["bearing.rollers.diametral_clearance", "axial_clearance"],
        ),
        (
            own.replace("count = 13", "count = 13, contact_angle = \"14 deg\", roller_angle = \"20 deg\""),
            &["bearing.rollers.roller_angle = 0.349", "[0.01, 0.244"],
        ),
        (own.replace("\"100 mm\" }", "\"100 mm\", axial = \"free\" }"), &["bearing.mounting", "by rollers"]),
        (
            own.replace("name = \"ball\"\ncatalogue = \"6205\"", &format!("name = \"ball\"\n{keys}")),
            &["bearing", "nothing would hold the shaft along its axis", "rollers.axial_way"],
        ),
        (
            own.replace("rollers = {", "stiffness = { radial = 1e8 }\nrollers = {"),
            &["at most one of stiffness and rollers"],
        ),
    ] {
        let why = refuse(&text);
        for part in parts {
            assert!(why.contains(part), "{why}\nshould name {part}");
        }
    }
    // Changes of the catalogue's rollers.
    let changed = NON_LOCATING.replace(
        "level = \"equilibrium\"",
        "level = \"equilibrium\"\nset = { rollers = { diametral_clearance = \"-5 um\" } }",
    );
    let loaded = |text: &str| system(text).outputs().links[0].rollers().unwrap().loaded;
    assert!(loaded(&changed) > loaded(NON_LOCATING));
}
