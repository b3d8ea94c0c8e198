//! Runs in oil: dry at no lubrication, energy, the loss of oil, what is refused, and when balls skid.

use roulement::effects::Effect;
use roulement::interface::variables::Variables;
use roulement::scene::Scene;
use roulement::scene::system::SystemScene;
use roulement::simulation::Simulation;
use roulement::simulation::outputs::Outputs;
use roulement::simulation::system::System;

use crate::tables::{compare, count, row};

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const CAGE: &str = include_str!("../../scenes/cage.toml");
const LOSS: &str = include_str!("../../scenes/effects/loss_of_lubrication.toml");

fn scene(text: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::edited(text, changes.iter().copied()).unwrap_or_else(|why| panic!("{why}"))
}

fn run(scene: &Scene, end: f64) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.advance_scripted(end).unwrap_or_else(|why| panic!("{why}"));
    simulation
}

const OIL: [(&str, &str); 2] = [("film.iso_vg", "68.0"), ("film.temperature", "70.0")];

#[test]
fn identity_no_lubrication_is_the_dry_bearing_to_the_bit() {
    for text in [THRUST, CAGE] {
        let mut oiled = OIL.to_vec();
        oiled.push(("film.lubrication", "0.0"));
        if text == CAGE {
            oiled.push(("film.cage", "true"));
        }
        let (dry, none) = (run(&scene(text, &[]), 5e-3), run(&scene(text, &oiled), 5e-3));
        let (dry, none) = (dry.state(), none.state());
        assert_eq!(
            (&dry.balls, &dry.energies, &dry.statistics),
            (&none.balls, &none.energies, &none.statistics)
        );
        assert_eq!(dry.bodies, none.bodies);
    }
}

#[test]
fn identity_an_importer_that_sets_lubrication_does_what_the_script_does() {
    let table = "[[0, 1], [0.002, 1], [0.0021, 0.2]]";
    let mut changes = OIL.to_vec();
    changes.push(("film.lubrication", table));
    let scripted = run(&scene(THRUST, &changes), 4e-3);
    changes.pop();
    let mut set = Simulation::new(&scene(THRUST, &changes)).unwrap();
    let degree = |time: f64| (1.0 - 0.8 * (time - 0.002) / 1e-4).clamp(0.2, 1.0);
    for point in 0..2000 {
        let (begin, end) = (2e-6 * f64::from(point), 2e-6 * f64::from(point + 1));
        let mut inputs = set.scripted_inputs(begin);
        inputs.effects.lubrication = degree(end);
        set.set_inputs(inputs);
        set.advance(end).unwrap();
    }
    let (a, b) = (scripted.outputs(), set.outputs());
    assert!(
        (a.friction_power / b.friction_power - 1.0).abs() < 1e-3,
        "{} {}",
        a.friction_power,
        b.friction_power
    );
    // Out of range it is refused with its name.
    let variables = Variables::new(set.scene());
    let inputs = set.scripted_inputs(0.0);
    let mut values = variables.values(&inputs, set.outputs());
    let place = variables.rows().iter().position(|row| row.name == "lubrication").unwrap();
    values[place] = 1.5;
    let why = variables.inputs(&values, &vec![0.0; values.len()], &inputs).unwrap_err().to_string();
    assert!(why.contains("lubrication = 1.5") && why.contains("[0, 1]"), "{why}");
}

#[test]
fn invariant_energy_closes_in_oil_and_while_it_is_lost() {
    let mut changes = OIL.to_vec();
    changes.push(("film.lubrication", "[[0, 1], [0.003, 1], [0.006, 0]]"));
    let runs = [
        (THRUST, "false", "olver_spikes", "mean"),
        (CAGE, "true", "olver_spikes", "mean"),
        (THRUST, "false", "erf", "hertz"),
        (CAGE, "true", "skf", "hertz"),
    ];
    for (text, cage, mixed, pressure) in runs {
        let [mixed, pressure] = [mixed, pressure].map(|law| format!("\"{law}\""));
        let mut changes = changes.clone();
        changes.extend([("film.mixed_friction", mixed.as_str()), ("film.shear_pressure", pressure.as_str())]);
        if text == CAGE {
            changes.push(("film.cage", cage));
        }
        let scene = scene(text, &changes);
        let start = Simulation::new(&scene).unwrap().outputs().stored_energy;
        let end = run(&scene, 0.01);
        let Outputs { work, stiffened, dissipated, stored_energy, .. } = end.outputs();
        let open = work + stiffened - dissipated - (stored_energy - start);
        assert!(open.abs() < 2e-3 * dissipated, "{open} of {dissipated}");
    }
}

#[test]
fn loss_of_lubrication_takes_the_clearance() {
    // A coarser look at the scene: shorter by a factor of three, warming faster by as much.
    let changes = [
        ("load.duration", "0.05"),
        ("film.lubrication", "[[0.0, 1.0], [0.005, 1.0], [0.02, 0.0]]"),
        ("effects.heat_balance.faster", "1200.0"),
    ];
    let scene = scene(LOSS, &changes);
    let mut simulation = Simulation::new(&scene).unwrap();
    let mut at = |time: f64| {
        simulation.advance_scripted(time).unwrap();
        simulation.outputs().clone()
    };
    let [oiled, dry, end] = [0.004, 0.022, 0.05].map(&mut at);
    let clearance = |o: &Outputs| o.growth.unwrap().clearance;
    let rolling =
        |o: &Outputs| o.contact_power(|ball| ball.inner.film.rolling_power + ball.outer.film.rolling_power);
    assert!(clearance(&oiled) > 5e-6 && clearance(&end) < 0.0, "{} {}", clearance(&oiled), clearance(&end));
    assert!(rolling(&oiled) > 20.0 && rolling(&dry) == 0.0, "{}", rolling(&oiled));
    // Groove slip and spin take over what the oil carried.
    let groove = |o: &Outputs| o.contact_power(|ball| ball.inner.groove_power + ball.outer.groove_power);
    assert!(groove(&dry) > 2.0 * groove(&oiled), "{} {}", groove(&dry), groove(&oiled));
    let rises = end.warm.unwrap().rises;
    assert!(rises[0] > rises[1] + 5.0 && rises[2] > rises[1], "{rises:?}");
}

#[test]
fn what_does_not_go_together_is_refused() {
    let why =
        |changes: &[(&str, &str)]| Scene::edited(THRUST, changes.iter().copied()).unwrap_err().to_string();
    for (changes, part) in [
        (vec![("film", "{}")], "iso_vg"),
        (vec![("film.iso_vg", "68.0")], "temperature"),
        (vec![("film.iso_vg", "68.0"), ("film.viscosity", "0.02")], "not both"),
        (vec![("film.viscosity", "0.02"), ("film.temperature", "70.0")], "without a temperature"),
        (vec![("film.iso_vg", "68.0"), ("film.cold_temperature", "70.0")], "[growth]"),
        (vec![("film.viscosity", "0.02"), ("effects.creep", "\"linear\"")], "effects.creep"),
        (vec![("film.viscosity", "0.02"), ("effects.creep", "\"frictionless\"")], "effects.creep"),
        (vec![("film.viscosity", "0.02"), ("film.cage", "true")], "cage"),
        (vec![("film.viscosity", "0.02"), ("film.lubrication", "1.1")], "film.lubrication"),
        (vec![("film.viscosity", "0.02"), ("film.bore", "0.05"), ("film.outside", "0.04")], "film.outside"),
        (vec![("film.viscosity", "0.02"), ("film.roughness", "0.0")], "[0.000000001, 0.0001] m"),
        (vec![("film.viscosity", "\"20 mm\"")], "mm measures something else"),
        (vec![("film.viscosity", "0.02"), ("film.supply", "\"jet\"")], "flooded, bath, oil_air"),
        (vec![("film.viscosity", "0.02"), ("film.mixed_friction", "\"stribeck\"")], "olver_spikes, erf, skf"),
        (vec![("film.viscosity", "0.02"), ("film.shear_pressure", "\"peak\"")], "mean, hertz"),
        (vec![("interface.inputs.lubrication", "\"master\"")], "[film]"),
    ] {
        let why = why(&changes);
        assert!(why.contains(part), "{changes:?}: {why}");
    }
}

#[test]
fn identity_laws_of_the_film_of_a_shafts_bearing_are_those_of_its_text() {
    // The left bearing has a law, the right one keeps the default; each bearing's film is the one that its own scene would have.
    let text = include_str!("../../scenes/shafts/pinion.toml");
    let mut powers = vec![];
    for law in ["", "mixed_friction = \"erf\"", "mixed_friction = \"skf\"", "shear_pressure = \"hertz\""] {
        let oil = |law: &str| {
            format!("[bearing.set.film]\niso_vg = 32\ntemperature = 90.0\nroughness = 5e-7\n{law}\n")
        };
        let text = text
            .replace("[[bearing]]\nname = \"right\"", &format!("{}[[bearing]]\nname = \"right\"", oil(law)))
            .replace("\n[load]\n", &format!("\n{}[load]\n", oil("")));
        let scene = SystemScene::parse(&text, None, "".as_ref()).unwrap_or_else(|why| panic!("{why}"));
        let system = System::new(&scene).unwrap();
        let told: Vec<String> =
            system.bearings().map(|(_, bearing)| bearing.scene().effects.film.setting().unwrap()).collect();
        assert!(told[1].ends_with("bath"), "{told:?}");
        assert_eq!(law.is_empty(), told[0] == told[1], "{told:?}");
        powers.push([0, 1].map(|place| system.bearings().nth(place).unwrap().1.outputs().friction_power));
    }
    // Films of a third of the roughness: most friction is dry, by each law another share.
    for (i, [left, right]) in powers.iter().enumerate() {
        assert!((right / powers[0][1] - 1.0).abs() < 1e-3, "{powers:?}");
        assert!(powers[..i].iter().all(|before| (before[0] / left - 1.0).abs() > 1e-4), "{powers:?}");
    }
    let why = SystemScene::parse(
        &text.replace(
            "\n[load]\n",
            "\n[bearing.set.film]\nviscosity = 0.02\nmixed_friction = \"wet\"\n[load]\n",
        ),
        None,
        "".as_ref(),
    );
    let why = why.unwrap_err().to_string();
    assert!(why.contains("olver_spikes, erf, skf"), "{why}");
}

/// \[N mm] friction torque of a 6206 under 1500 N at 6000 rpm, in an oil or dry, at a settled time.
fn torque(oil: &str) -> f64 {
    let text = format!(
        "[bearing]\nballs = 9\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\ninner_conformity = 0.52\n\
         outer_conformity = 0.53\ndiametral_clearance = \"10 um\"\n[friction]\nball_race = 0.1\n{oil}\
         [load]\ninner_speed = \"6000 rpm\"\ny = {{ force = 1500.0 }}\nx = {{ displacement = 0.0 }}\n\
         z = {{ displacement = 0.0 }}\nry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n"
    );
    let scene = Scene::parse(&text).unwrap_or_else(|why| panic!("{why}"));
    let mut simulation = run(&scene, 0.02);
    // Ball passages are 2.2 ms: over five of them.
    let (mut sum, steps) = (0.0, 220);
    for step in 1..=steps {
        simulation.advance_scripted(0.02 + 5e-5 * f64::from(step)).unwrap();
        sum += simulation.outputs().friction_power;
    }
    1e3 * sum / f64::from(steps) / (6000.0 * std::f64::consts::PI / 30.0)
}

#[test]
fn regression_torque_dry_and_in_oils() {
    let oils = ["", "46", "68", "100"];
    let rows: Vec<_> = oils
        .into_iter()
        .map(|grade| match grade {
            "" => row("dry", vec![count(torque(""), 1)], ""),
            _ => {
                let oil = format!("[film]\niso_vg = {grade}\ntemperature = \"70 degC\"\n");
                row(format!("ISO VG {grade}"), vec![count(torque(&oil), 1)], "")
            }
        })
        .collect();
    compare("docs/oil.md", "grades", "oil at 70 degC | torque \\[N mm]", &rows);
}

/// What skids: dry or in oil with a law of the shear's pressure, beside a cage, in a mist of a density [kg/m3].
#[derive(Clone, Copy)]
struct Skids {
    shear: Option<&'static str>,
    cage: bool,
    mist: f64,
}

/// A 7206 with 25 degrees under thrust \[N] at a speed [rpm], its oil ISO VG 32 at 70 degC: slip of its balls after 40 ms.
fn ball_slip(thrust: f64, speed: f64, Skids { shear, cage, mist }: Skids) -> f64 {
    let film = shear.map_or(String::new(), |law| {
        format!("[film]\niso_vg = 32\ntemperature = \"70 degC\"\nshear_pressure = \"{law}\"\ncage = {cage}\n")
    });
    let effects = if cage { "cage = true\n" } else { "" };
    let cage = if cage {
        "[cage]\nmass = \"20 g\"\ninertia = [1.1e-5, 6e-6, 6e-6]\npocket_clearance = \"0.2 mm\"\nguided_by = \"outer\"\n\
         guidance_clearance = \"0.2 mm\"\nland_diameter = \"52 mm\"\nland_width = \"2 mm\"\nyoungs_modulus = \"105 GPa\"\n\
         poisson_ratio = 0.35\ndamping = \"0.5 s/m\"\n"
    } else {
        ""
    };
    let text = format!(
        "[bearing]\nballs = 13\nball_diameter = \"9.525 mm\"\npitch_diameter = \"46 mm\"\ninner_conformity = 0.52\n\
         outer_conformity = 0.53\ncontact_angle = \"25 deg\"\n[friction]\nball_race = 0.12\n{film}\
         [effects]\n{effects}ambient = {{ density = {mist}, viscosity = \"18 uPa s\" }}\n{cage}\
         [inner]\ndrive = \"wrench\"\nmass = 1.0\ninertia = [6e-4, 5e-4, 5e-4]\n[load]\ninner_speed = \"{speed} rpm\"\n\
         x = {{ force = {thrust} }}\ny = {{ displacement = 0.0 }}\nz = {{ displacement = 0.0 }}\n\
         ry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n[solver]\naccuracy = \"balanced\"\n"
    );
    let scene = Scene::parse(&text).unwrap_or_else(|why| panic!("{why}"));
    run(&scene, 0.04).outputs().ball_slip
}

/// The map of some that skid, with their words, as a table of docs/oil.md.
fn map_of_skidding(name: &str, thrusts: &[f64], variants: &[(&str, Skids)]) -> Vec<Vec<[f64; 4]>> {
    let speeds = [5000.0, 10_000.0, 15_000.0, 20_000.0];
    let maps: Vec<Vec<[f64; 4]>> = thrusts
        .iter()
        .map(|thrust| {
            let slips = |(_, skids): &(&str, Skids)| speeds.map(|speed| ball_slip(*thrust, speed, *skids));
            variants.iter().map(slips).collect()
        })
        .collect();
    let lines = |(thrust, slips): (&f64, &Vec<[f64; 4]>)| -> Vec<_> {
        let line = |((words, _), slips): (&(&str, Skids), &[f64; 4])| {
            let slips = slips.map(|slip| count((1000.0 * slip).round() / 10.0 + 0.0, 1));
            row(format!("{thrust} | {words}"), slips.into(), " %")
        };
        variants.iter().zip(slips).map(line).collect()
    };
    let rows: Vec<_> = thrusts.iter().zip(&maps).flat_map(lines).collect();
    compare("docs/oil.md", name, "thrust \\[N] | film | slip at 5000 / 10,000 / 15,000 / 20,000 rpm", &rows);
    maps
}

/// What skids without a cage, in a thin mist, with a law of the shear's pressure or dry.
const fn uncaged(shear: Option<&'static str>) -> Skids {
    Skids { shear, cage: false, mist: 10.0 }
}

#[test]
fn limit_the_lightest_and_fastest_balls_roll_dry_and_skid_in_a_film() {
    let slip = |shear| ball_slip(20.0, 20_000.0, uncaged(shear));
    let (dry, mean, hertz) = (slip(None), slip(Some("mean")), slip(Some("hertz")));
    assert!(dry.abs() < 0.02 && mean > 5.0 * dry.abs(), "{dry} {mean}");
    // A film that is stiffer at small slips drives balls better.
    assert!(hertz < mean + 1e-3, "{hertz} {mean}");
}

#[test]
#[ignore = "half a minute (scripts/soak)"]
fn regression_map_of_skidding() {
    let variants = [("`mean`", uncaged(Some("mean"))), ("`hertz`", uncaged(Some("hertz")))];
    let maps = map_of_skidding("skid", &[20.0, 50.0, 100.0, 200.0, 500.0], &variants);
    let better =
        |pair: &Vec<[f64; 4]>| pair[0].iter().zip(&pair[1]).all(|(mean, hertz)| hertz < &(mean + 1e-3));
    assert!(maps.iter().all(better), "{maps:?}");
}

#[test]
#[ignore = "a minute: caged bearings that skid (scripts/soak)"]
fn regression_map_of_skidding_with_a_cage() {
    let skids = |law, mist| Skids { shear: Some(law), cage: true, mist };
    let variants = [
        ("`hertz`, cage", skids("hertz", 10.0)),
        ("`mean`, cage", skids("mean", 10.0)),
        ("`mean`, cage, mist of 50 kg/m3", skids("mean", 50.0)),
    ];
    map_of_skidding("skid-cage", &[20.0, 50.0, 100.0, 200.0, 500.0], &variants);
}

/// The bearing of 120 mm bore that ran at 3e6 DN (Bamberger, Zaretsky and Signer 1976; geometry of cli/tests/command_line/means.rs).
const LARGE: &str = "[bearing]\nballs = 15\nball_diameter = \"20.6375 mm\"\npitch_diameter = \"155 mm\"\ncontact_angle = \"24 deg\"\n\
    inner_conformity = 0.54\nouter_conformity = 0.52\n[film]\nviscosity = 0.0035\npressure_viscosity = 1.2e-8\n[effects]\nhysteresis = true\n\
    [inner]\ndrive = \"wrench\"\nmass = \"2 kg\"\ninertia = [8e-3, 5e-3, 5e-3]\n[load]\ny = { displacement = 0.0 }\nz = { displacement = 0.0 }\n\
    ry = { rotation = 0.0 }\nrz = { rotation = 0.0 }\n[solver]\naccuracy = \"balanced\"\n";

#[test]
#[ignore = "half a minute (scripts/soak)"]
fn regression_slip_of_a_fast_large_bearing() {
    let rows: Vec<_> = [(6672.0, 25_000.0), (22_240.0, 25_000.0), (6672.0, 12_000.0)]
        .into_iter()
        .flat_map(|(thrust, speed)| {
            ["mean", "hertz"].map(|law| {
                let slips = [1.2, 19.0, 50.0].map(|mist| {
                    let changes = [
                        ("load.inner_speed", format!("\"{speed} rpm\"")),
                        ("load.x.force", format!("{thrust}")),
                        ("film.shear_pressure", format!("\"{law}\"")),
                        ("effects.ambient.density", format!("{mist}")),
                        ("effects.ambient.viscosity", "18e-6".into()),
                    ];
                    let changes: Vec<_> = changes.iter().map(|(key, value)| (*key, value.as_str())).collect();
                    let slip = run(&scene(LARGE, &changes), 0.06).outputs().ball_slip;
                    count((1000.0 * slip).round() / 10.0 + 0.0, 1)
                });
                row(format!("{thrust} | {speed} | `{law}`"), slips.into(), " %")
            })
        })
        .collect();
    compare(
        "docs/oil.md",
        "large",
        "thrust \\[N] | \\[rpm] | `shear_pressure` | slip in 1.2 / 19 / 50 kg/m3",
        &rows,
    );
}
