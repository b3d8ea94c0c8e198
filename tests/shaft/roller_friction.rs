//! Friction of roller bearings: laws of single contacts, the moment on rings with its derivatives, energy, and SKF's model. Writes and checks the table of
//! docs/oil.md.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Vector2, Vector6};
use roulement::effects::film::Section;
use roulement::model::link::roller_friction::Lubricant;
use roulement::model::link::rollers::Rollers;
use roulement::scene::system::SystemScene;
use roulement::simulation::system::MachineEquilibrium;

use crate::common::{run, scene, system};
use crate::tables::{compare, count, row};

/// \[Pa] E' of steel on steel.
const MODULUS: f64 = 206e9 / 0.91;
const OIL: &str = "film = { iso_vg = 68, temperature = \"70 degC\" }";

/// A rigid shaft on a 6205 and a roller bearing, with further keys of its rollers.
fn text(name: &str, keys: &str, force: &str) -> String {
    format!(
        "[shaft]\nspeed = \"1500 rpm\"\nmass = \"2 kg\"\npolar_inertia = \"1e-3 kg m^2\"\ntransverse_inertia = \"3e-3 kg m^2\"\n\
         [[shaft.load]]\nname = \"pull\"\nposition = \"60 mm\"\nforce = {force}\n\
         [[bearing]]\nname = \"ball\"\ncatalogue = \"6205\"\nmounting = {{ position = 0, axial = \"{}\" }}\n\
         [[bearing]]\nname = \"roller\"\ncatalogue = \"{name}\"\nmounting = {{ position = \"100 mm\" }}\nset = {{ rollers = {{ {keys} }} }}\n\
         [load]\nduration = \"1 ms\"\noutput_interval = \"100 us\"\n",
        if name.starts_with("NU ") { "held" } else { "free" }
    )
}

/// Rollers of the catalogue with further keys.
fn rollers(name: &str, keys: &str) -> Rollers {
    scene(&text(name, keys, "[\"3 kN\", \"4 kN\", 0]")).springs[0].rollers.clone().unwrap()
}

fn turning(rpm: f64) -> Vector6<f64> {
    Vector6::ith(3, rpm * TAU / 60.0)
}

/// Displacement under a force along x and y \[N] on the shaft.
fn rest(rollers: &Rollers, [axial, radial]: [f64; 2], rate: &Vector6<f64>) -> Vector6<f64> {
    let mut d = Vector6::new(if axial > 0.0 { 5e-6 } else { 0.0 }, 2e-5, 0.0, 0.0, 0.0, 0.0);
    for _ in 0..500 {
        let on = rollers.force(&d, rate);
        let left = Vector2::new(axial + on.force[0], radial + on.force[1]);
        if left.norm() < 1e-7 * (axial + radial) {
            return d;
        }
        let mut k: Matrix2<f64> = -on.by_displacement.fixed_view::<2, 2>(0, 0).into_owned();
        let soft = 1e-6 * k.amax() + 1.0;
        k += Matrix2::identity() * soft;
        let step = k.lu().solve(&left).unwrap();
        let step = step * (5e-6 / step.amax().max(5e-6));
        d[0] += if axial > 0.0 { step.x } else { 0.0 };
        d[1] += step.y;
    }
    panic!("no balance: {d}");
}

/// \[N/m] rolling force and \[m] central film of an elastic line by the inlet of Ertel and Grubin, integrated: rigid sides of Hertz's shape, reduced pressure `1/alpha` at the
/// edge of the flat.
fn grubin(viscosity: f64, u: f64, radius: f64, alpha: f64, load: f64) -> [f64; 2] {
    let b = (8.0 * load * radius / (PI * MODULUS)).sqrt();
    let grid: Vec<[f64; 2]> = (0..=4000)
        .map(|k| {
            let t = 10f64.powf(-7.0 + (300f64.log10() + 7.0) * f64::from(k) / 4000.0);
            let root = ((1.0 + t) * (1.0 + t) - 1.0).sqrt();
            [t * b, b * b / (2.0 * radius) * ((1.0 + t) * root - (t + root).ln_1p())]
        })
        .collect();
    let slope = |h0: f64, gap: f64| 12.0 * viscosity * u * gap / (h0 + gap).powi(3);
    let end = |h0: f64| -> f64 {
        grid.windows(2).map(|w| 0.5 * (slope(h0, w[0][1]) + slope(h0, w[1][1])) * (w[1][0] - w[0][0])).sum()
    };
    let (mut low, mut high) = (1e-10f64, 1e-3f64);
    for _ in 0..80 {
        let middle = (low * high).sqrt();
        if end(middle) > 1.0 / alpha {
            low = middle;
        } else {
            high = middle;
        }
    }
    // What is left of the reduced pressure near the edge, where the gap grows with the power 3/2.
    let mut rest = 0.4 * slope(low, grid[0][1]) * grid[0][0];
    let mut force = 0.0;
    let mut before = 0.5 * grid[0][1] * slope(low, grid[0][1]) / (alpha * rest);
    for w in grid.windows(2) {
        let way = w[1][0] - w[0][0];
        rest += 0.5 * (slope(low, w[0][1]) + slope(low, w[1][1])) * way;
        let now = 0.5 * w[1][1] * slope(low, w[1][1]) / (alpha * rest);
        force += 0.5 * (before + now) * way;
        before = now;
    }
    [force, low]
}

fn lubricant(viscosity: f64) -> Lubricant {
    // Next to no heating, of the oil of `[film]`: 2.2e-8 1/Pa.
    let oil = roulement::contact::film::Lubricant {
        temperature_viscosity: 1e-12,
        ..Section::default().lubricant()
    };
    Lubricant { oil, viscosity, starvation: 0.0 }
}

#[test]
fn independent_the_inlet_of_an_elastic_line_integrated_has_the_rolling_force_and_the_film() {
    for viscosity in [0.01, 0.05] {
        for u in [0.5, 2.0, 8.0] {
            for load in [3e3, 2e4, 1e5, 3e5] {
                let radius = 3.3e-3;
                let [force, film] = grubin(viscosity, u, radius, 2.2e-8, load);
                let oil = lubricant(viscosity);
                let [elastic, _] = oil.rolling([radius, 1.0], u);
                let ours = elastic * (load / (MODULUS * radius)).powf(0.0126);
                let [central, least] = oil.films([radius, 1.0], load, u);
                assert!((0.90..1.16).contains(&(ours / force)), "{viscosity} {u} {load}: {}", ours / force);
                assert!(
                    (0.88..1.20).contains(&(central / film)),
                    "{viscosity} {u} {load}: {}",
                    central / film
                );
                assert!(
                    (0.7..1.0).contains(&(least / central)),
                    "{viscosity} {u} {load}: {}",
                    least / central
                );
            }
        }
    }
}

#[test]
fn closed_form_a_rigid_cylinder_rolls_with_the_force_of_reynolds_equation() {
    // h = h0 / cos^2 t. Pressure and its slope are 0 where it ends, at t_e: the integral of cos^2 - cos^4 / cos^2(t_e) from -pi/2 is 0.
    let integral = |from: f64, to: f64, of: &dyn Fn(f64) -> f64| {
        let n = 20_000;
        let way = (to - from) / f64::from(n);
        (0..n).map(|k| of(from + (f64::from(k) + 0.5) * way) * way).sum::<f64>()
    };
    let pressure = |end: f64, t: f64| t.cos().powi(2) - t.cos().powi(4) / end.cos().powi(2);
    let (mut low, mut high) = (0.1, 1.0);
    for _ in 0..60 {
        let end: f64 = 0.5 * (low + high);
        if integral(-PI / 2.0, end, &|t| pressure(end, t)) > 0.0 {
            low = end;
        } else {
            high = end;
        }
    }
    let end = low;
    // Load over eta u R/h0, by parts, and force on each surface over eta u (R/h0)^(1/2).
    let carried = 24.0 * integral(-PI / 2.0, end, &|t| -(t.tan() - end.tan()) * pressure(end, t));
    let force = 6.0 * 2f64.sqrt() * integral(-PI / 2.0, end, &|t| 1.0 - (t.cos() / end.cos()).powi(2));
    assert!((carried / 4.896 - 1.0).abs() < 2e-3, "Martin's load: {carried}");
    let [_, rigid] = lubricant(0.02).rolling([4e-3, 9e-3], 3.0);
    let ours = rigid / (0.02_f64 * 3.0 * 9e-3).sqrt();
    assert!((force / carried.sqrt() / ours - 1.0).abs() < 2e-3, "{} {ours}", force / carried.sqrt());
}

#[test]
fn closed_form_dry_ribs_hold_a_thrust_back_by_its_lever() {
    // Both ribs together: slip of d_m/10 over the speed, whatever the cage's.
    let nup = rollers("NUP 206", "rib_friction = 0.1");
    let rate = turning(1500.0);
    let d = rest(&nup, [500.0, 2000.0], &rate);
    let [smooth, lever] = [rate[3].hypot(0.1), 0.1 * nup.geometry().pitch_diameter];
    let on = nup.force(&d, &rate);
    let without = rollers("NUP 206", "").force(&d, &rate);
    let moment = on.force[3] - without.force[3];
    assert!((moment / (-0.1 * 500.0 * lever * rate[3] / smooth) - 1.0).abs() < 1e-3, "{moment}");
    assert!((on.damped - without.damped + moment * rate[3]).abs() < 1e-12);
    // None at rest, the opposite the other way round, and nothing else is changed.
    let still =
        nup.force(&d, &turning(0.0)).force[3] - rollers("NUP 206", "").force(&d, &turning(0.0)).force[3];
    let back = nup.force(&d, &-rate).force[3] - rollers("NUP 206", "").force(&d, &-rate).force[3];
    assert!(still == 0.0 && (back + moment).abs() < 1e-12, "{still} {back}");
    for row in [0, 1, 2, 4, 5] {
        assert_eq!(on.force[row], without.force[row]);
    }
}

#[test]
fn invariant_derivatives_of_the_moment_are_those_of_differences() {
    let all =
        "film = { iso_vg = 68, temperature = \"70 degC\" }, ambient = { density = 30, viscosity = 18e-6 }";
    let cases = [
        ("NU 206", all.to_owned()),
        ("NUP 206", all.to_owned()),
        ("NUP 206", "rib_friction = 0.1".to_owned()),
        ("30206", format!("{all}, rib_friction = 0.12")),
        // Films that touch, and one that shears to its limit.
        ("30206", "film = { viscosity = \"3 mPa s\" }, rib_radius = \"20 mm\"".to_owned()),
        ("NUP 206", "film = { viscosity = \"5 Pa s\" }, rib_radius = \"5 mm\"".to_owned()),
    ];
    for (name, keys) in cases {
        let [with, without] = [&keys[..], ""].map(|keys| rollers(name, keys));
        for rpm in [0.0, 0.5, 30.0, 3000.0, -12_000.0] {
            let rate = turning(rpm);
            let forces = if name.starts_with("NU ") { [0.0, 4000.0] } else { [1500.0, 3000.0] };
            let mut d = rest(&without, forces, &rate);
            d += Vector6::new(0.0, 0.0, 3e-6, 0.1, 2e-4, -1e-4);
            let at = |d: &Vector6<f64>, rate: &Vector6<f64>| {
                let [one, other] = [&with, &without].map(|rollers| rollers.force(d, rate));
                (
                    one.force[3] - other.force[3],
                    one.by_displacement - other.by_displacement,
                    one.by_rate - other.by_rate,
                )
            };
            let (moment, by_displacement, by_rate) = at(&d, &rate);
            assert!(moment * rate[3] <= 0.0 && (rate[3] == 0.0 || moment != 0.0), "{name} {rpm}: {moment}");
            for column in 0..6 {
                let h = [1e-9, 1e-9, 1e-9, 1e-6, 1e-7, 1e-7][column];
                let way = Vector6::ith(column, h);
                let slope = (at(&(d + way), &rate).0 - at(&(d - way), &rate).0) / (2.0 * h);
                let own = by_displacement[(3, column)];
                // Over a moment that changes in a hundredth of a micrometre, or of a millirad.
                let size = moment.abs() / [1e-5, 1e-5, 1e-5, 1e-1, 1e-3, 1e-3][column];
                assert!(
                    (slope - own).abs() <= 2e-3 * own.abs() + 1e-4 * size,
                    "{name} {keys} {rpm} {column}: {slope} {own}"
                );
            }
            let h = 1e-4 * rate[3].abs() + 1e-5;
            let way = Vector6::ith(3, h);
            let slope = (at(&d, &(rate + way)).0 - at(&d, &(rate - way)).0) / (2.0 * h);
            let own = by_rate[(3, 3)];
            assert!(
                own.is_finite() && (slope - own).abs() <= 1e-4 * own.abs() + 1e-9,
                "{name} {keys} {rpm}: {slope} {own}"
            );
        }
    }
}

#[test]
fn invariant_energy_is_kept_and_losses_are_the_torque_of_the_shaft() {
    for (name, keys) in [
        ("NUP 206", OIL.to_owned()),
        ("30206", format!("{OIL}, ambient = {{ density = 30, viscosity = 18e-6 }}")),
    ] {
        let own = text(name, &keys, "[\"3 kN\", \"4 kN\", \"-1 kN\"]");
        let dry = text(name, "", "[\"3 kN\", \"4 kN\", \"-1 kN\"]");
        let [with, without] = [&own, &dry].map(|text| run(text, 2e-3));
        let link = &with.outputs().links[0];
        let friction = link.rollers().unwrap().friction.unwrap();
        assert!(without.outputs().links[0].rollers().unwrap().friction.is_none());
        // Lost is the torque times the turn, within what it changes.
        let turned = friction.torque() * 1500.0 * TAU / 60.0 * 2e-3;
        assert!((link.state.damped / turned - 1.0).abs() < 0.05, "{} {turned}", link.state.damped);
        assert!(link.state.unaccounted().abs() < 1e-3 * turned, "{:e}", link.state.unaccounted());
        assert!((friction.loss / (friction.torque() * link.state.rate[3]) - 1.0).abs() < 1e-12);
        let parts: f64 = (0..3).map(|part| friction.loss_of(part)).sum();
        assert!((parts / friction.loss - 1.0).abs() < 1e-12);
        // The drive brings it, over what the other bearing takes.
        let [one, other] = [&with, &without].map(|system| system.outputs().shafts[0].torque);
        assert!(
            (one - other - friction.torque()).abs() < 0.1 * friction.torque(),
            "{one} {other} {}",
            friction.torque()
        );
    }
}

#[test]
fn hard_a_shaft_that_is_let_go_comes_to_rest_and_stays() {
    let free = text("NUP 206", "rib_friction = 0.3", "[\"3 kN\", \"1 kN\", 0]")
        .replace("speed = \"1500 rpm\"", "torque = 0.0\nstart_speed = \"20 rpm\"")
        .replace("1e-3 kg m^2", "1e-4 kg m^2");
    let mut system = system(&free);
    let mut least: f64 = 10.0;
    for point in 1..=20 {
        system.advance(1e-3 * f64::from(point)).unwrap();
        least = least.min(system.outputs().shafts[0].spin.speed);
    }
    let spin = system.outputs().shafts[0].spin.speed;
    assert!(spin.abs() < 0.02 && least > -0.5, "{spin} {least}");
    let link = &system.outputs().links[0];
    assert!(link.state.damped > 0.0 && link.state.unaccounted().abs() < 1e-3 * link.state.damped.max(1e-4));
}

#[test]
fn invariant_the_equilibrium_and_the_housing_see_the_friction_of_rollers() {
    let own = text("30206", &format!("{OIL}, rib_friction = 0.12"), "[\"3 kN\", \"4 kN\", 0]");
    let found = MachineEquilibrium::of(&scene(&own), 0.0, 100.0).unwrap();
    let friction = found.outputs.links[0].rollers().unwrap().friction.unwrap();
    let value = found.to_json();
    let of = &value["bearings_by_stiffness"]["roller"]["friction"];
    assert_eq!(of["torque"].as_f64(), Some(friction.torque()));
    assert!(of["film_ratio"].as_f64().unwrap() > 0.5 && of["of_ribs"].as_f64().unwrap() > 0.0);
    let text = found.to_string();
    for part in ["friction torque", "rolling", "ribs", "of the roughness"] {
        assert!(text.contains(part), "{text}\nshould have {part}");
    }
    // A housing that is soft against turning is in balance with the friction of its roller bearing at the start, and turns along with the shaft.
    let housed = |text: &str| {
        let housing = "[[housing]]\nname = \"case\"\nmass = \"5 kg\"\ninertia = [0.02, 0.02, 0.02]\ncentre = [0.1, 0, 0]\n\
                       stiffness = [1e9, 1e9, 1e9, 100.0, 1e7, 1e7]\n[[housing.point]]\nname = \"top\"\nposition = [0.1, 0, 0.05]\n";
        let text = text.replace("position = \"100 mm\" }", "position = \"100 mm\", housing = \"case\" }");
        let system = system(&text.replacen("[[bearing]]", &format!("{housing}[[bearing]]"), 1));
        system.outputs().housings[0].points[0].tilt.x
    };
    let dry = crate::roller_friction::text("30206", "", "[\"3 kN\", \"4 kN\", 0]");
    let turned = 100.0 * (housed(&own) - housed(&dry));
    assert!((turned / friction.torque() - 1.0).abs() < 1e-2, "{turned} {}", friction.torque());
}

#[test]
fn refusals_of_oil_and_ribs_name_key_value_and_range() {
    for (name, keys, parts) in [
        ("NU 206", "film = { iso_vg = 68 }", &["roller", "bearing.rollers.film", "give temperature"][..]),
        ("NU 206", "film = { }", &["bearing.rollers.film", "give the oil"]),
        ("NU 206", "film = { iso_vg = 68, viscosity = 0.02 }", &["not both"]),
        (
            "NU 206",
            "film = { viscosity = 0.02, temperature = 70 }",
            &["film.viscosity", "without a temperature"],
        ),
        (
            "NU 206",
            "film = { viscosity = nan }",
            &["bearing.rollers.film.viscosity = NaN Pa.s", "[0.0001, 100]"],
        ),
        (
            "NU 206",
            "film = { viscosity = 0.02, roughness = \"1 mm\" }",
            &["film.roughness = 0.001 m", "[0.000000001, 0.0001]"],
        ),
        (
            "NU 206",
            "film = { viscosity = 0.02, bore = 1.0 }",
            &["film.bore = 1 m", "smaller than film.outside"],
        ),
        ("NU 206", "film = { viscosity = 0.02, supply = \"jet\" }", &["supply", "jet", "oil_air"]),
        ("NU 206", "rib_friction = 0.1", &["bearing.rollers.rib_friction", "axial_way"]),
        ("NUP 206", "rib_friction = -0.1", &["bearing.rollers.rib_friction = -0.1", "[0, 2]"]),
        ("NUP 206", "rib_radius = 0.1", &["bearing.rollers.rib_radius", "give film"]),
        (
            "NUP 206",
            "ambient = { density = -1, viscosity = 1 }",
            &["ambient.density = -1 kg/m3", "[0, 20000]"],
        ),
        ("NUP 206", "ambient = { density = 1.2 }", &["ambient", "viscosity"]),
    ] {
        let why = SystemScene::parse(&text(name, keys, "[0, \"4 kN\", 0]"), None, std::path::Path::new(""));
        let why = why.unwrap_err().to_string();
        for part in parts {
            assert!(why.contains(part), "{why}\nshould name {part}");
        }
    }
}

/// A bearing in SKF's model: constants of its series (R1, S1, S2; of tapered ones R2 is 10.9) and its Y. Those of pages 105 to 109 of the catalogue of 2016; the formulas
/// were looked up, the constants are recalled.
struct Published {
    name: &'static str,
    kind: &'static str,
    /// \[mm] bore and outside diameter.
    size: [f64; 2],
    constants: [f64; 3],
    y: f64,
    /// [-] axial force over the radial one.
    thrust: f64,
}

const fn nu(name: &'static str, kind: &'static str, size: [f64; 2], r1: f64, thrust: f64) -> Published {
    Published { name, kind, size, constants: [r1, 0.16, 0.0015], y: 0.0, thrust }
}

const fn tapered(name: &'static str, size: [f64; 2], y: f64) -> Published {
    Published { name, kind: "302", size, constants: [1.76e-6, 0.017, 2.0], y, thrust: 0.6 }
}

const BEARINGS: [Published; 11] = [
    nu("NU 206", "NU 2", [30.0, 62.0], 1.09e-6, 0.0),
    nu("NU 210", "NU 2", [50.0, 90.0], 1.09e-6, 0.0),
    nu("NU 306", "NU 3", [30.0, 72.0], 1.09e-6, 0.0),
    nu("NU 310", "NU 3", [50.0, 110.0], 1.09e-6, 0.0),
    nu("NU 1010", "NU 10", [50.0, 80.0], 1.12e-6, 0.0),
    nu("NU 1016", "NU 10", [80.0, 125.0], 1.12e-6, 0.0),
    nu("NUP 206", "NUP 2, thrust 0.1 of the load", [30.0, 62.0], 1.09e-6, 0.1),
    nu("NUP 210", "NUP 2, thrust 0.1 of the load", [50.0, 90.0], 1.09e-6, 0.1),
    tapered("30204", [20.0, 47.0], 1.7),
    tapered("30206", [30.0, 62.0], 1.6),
    tapered("30210", [50.0, 90.0], 1.4),
];

/// [N mm] SKF's rolling and sliding moment under a radial load \[N], at a speed [rpm] and a viscosity [mm2/s], in an oil bath, with a boundary friction of 0.12.
fn published(of: &Published, radial: f64, speed: f64, viscosity: f64) -> [f64; 2] {
    let [bore, outside] = of.size;
    let mean = 0.5 * (bore + outside);
    let axial = of.thrust * radial;
    let [r1, s1, s2] = of.constants;
    let is_tapered = of.y > 0.0;
    let (rolling, sliding, shape, of_film) = match is_tapered {
        true => (
            r1 * mean.powf(2.38) * (radial + 10.9 * of.y * axial).powf(0.31),
            s1 * mean.powf(0.82) * (radial + s2 * of.y * axial),
            6.0,
            0.002,
        ),
        false => (
            r1 * mean.powf(2.41) * radial.powf(0.31),
            s1 * mean.powf(0.9) * axial + s2 * mean * radial,
            5.1,
            0.02,
        ),
    };
    let heating = 1.0 / (1.0 + 1.84e-9 * (speed * mean).powf(1.28) * viscosity.powf(0.64));
    let starving = 3e-8 * viscosity * speed * (bore + outside) * f64::sqrt(shape / (2.0 * (outside - bore)));
    let boundary = (-2.6e-8 * (speed * viscosity).powf(1.4) * mean).exp();
    let friction = boundary * 0.12 + (1.0 - boundary) * of_film;
    [heating * (-starving).exp() * rolling * (viscosity * speed).powf(0.6), friction * sliding]
}

/// [N mm] ours, of rolling and of ribs.
fn ours(of: &Published, radial: f64, speed: f64, viscosity: f64) -> [f64; 2] {
    let [bore, outside] = of.size;
    let ribs = if of.thrust > 0.0 { ", rib_friction = 0.12" } else { "" };
    let keys = format!(
        "film = {{ viscosity = {}, temperature_viscosity = 0.045, bore = \"{bore} mm\", outside = \"{outside} mm\" }}{ribs}",
        viscosity * 880e-6
    );
    let rollers = rollers(of.name, &keys);
    let rate = turning(speed);
    let d = rest(&rollers, [of.thrust * radial, radial], &rate);
    let friction = rollers.outputs(&d, &rate, &[], None).friction.unwrap();
    [friction.parts[0] * 1e3, friction.parts[1] * 1e3]
}

/// A point: place of its speed, SKF's moments and ours [N mm].
type Compared = (usize, [f64; 2], [f64; 2]);

/// Geometric mean of ratios, and the factor that they are off in root mean square.
fn of_ratios(ratios: &[f64]) -> [f64; 2] {
    let n = ratios.len() as f64;
    let mean = ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / n;
    let square = ratios.iter().map(|ratio| ratio.ln().powi(2)).sum::<f64>() / n;
    [mean.exp(), square.sqrt().exp()]
}

#[test]
fn published_model_of_friction_torque_of_roller_bearings_in_oil() {
    // Load over C0, speed times mean diameter [mm/min], and viscosity.
    let mut kinds: Vec<(&str, Vec<Compared>)> = vec![];
    for of in &BEARINGS {
        let rating = rollers(of.name, "").ratings().static_load_rating;
        for share in [0.03, 0.1, 0.25] {
            for (place, speed) in [1e4, 1e5, 3e5].into_iter().enumerate() {
                for viscosity in [10.0, 20.0, 68.0] {
                    let (radial, speed) = (share * rating, speed / (0.5 * (of.size[0] + of.size[1])));
                    let [theirs, own] =
                        [published(of, radial, speed, viscosity), ours(of, radial, speed, viscosity)];
                    println!(
                        "{} {radial:.0} N {speed:.0} rpm {viscosity} mm2/s: SKF {:.1} + {:.1}, ours {:.1} + {:.1}",
                        of.name, theirs[0], theirs[1], own[0], own[1]
                    );
                    if kinds.last().is_none_or(|(kind, _)| *kind != of.kind) {
                        kinds.push((of.kind, vec![]));
                    }
                    kinds.last_mut().unwrap().1.push((place, theirs, own));
                }
            }
        }
    }
    let mut rows = vec![];
    for (kind, points) in &kinds {
        let [rolling, all] = [0, 1].map(|which| {
            {
                points.iter().map(|(_, theirs, own)| match which {
                    0 => own[0] / theirs[0],
                    _ => (own[0] + own[1]) / (theirs[0] + theirs[1]),
                })
            }
            .collect::<Vec<_>>()
        });
        let at = |speed: usize| {
            let own: Vec<f64> = points
                .iter()
                .zip(&all)
                .filter(|((place, ..), _)| *place == speed)
                .map(|(_, ratio)| *ratio)
                .collect();
            of_ratios(&own)[0]
        };
        let ([mean_rolling, off_rolling], [mean, off]) = (of_ratios(&rolling), of_ratios(&all));
        assert!(
            (0.5..1.6).contains(&mean_rolling) && off_rolling < 2.0,
            "{kind}: {mean_rolling} {off_rolling}"
        );
        // What the document says beside the table: rolling by load, and ribs over SKF's sliding moment by speed.
        let part = |wanted: &dyn Fn(usize) -> bool, ratio: &dyn Fn(&Compared) -> f64| {
            let own: Vec<f64> = points
                .iter()
                .enumerate()
                .filter(|(place, _)| wanted(*place))
                .map(|(_, of)| ratio(of))
                .collect();
            of_ratios(&own)[0]
        };
        let by_load = [0, 1, 2].map(|load| part(&|place| place / 9 % 3 == load, &|of| of.2[0] / of.1[0]));
        let by_speed =
            [0, 1, 2].map(|speed| part(&|place| points[place].0 == speed, &|of| of.2[1] / of.1[1]));
        println!(
            "{kind}: rolling at 0.03, 0.1, 0.25 of C0 {by_load:.2?}, ribs slow, medium, fast {by_speed:.2?}"
        );
        let numbers =
            [mean_rolling, off_rolling, mean, off, at(0), at(1), at(2)].map(|value| count(value, 2));
        rows.push(row(format!("{kind} | {}", points.len()), numbers.into(), ""));
    }
    let header = "bearings | points | rolling: mean ratio / factor off / all: mean ratio / factor off / slow / medium / fast";
    compare("docs/oil.md", "rollers", header, &rows);
}
