//! Growth of rings and balls by temperature, fits and rotation, against independent data (tests/data/growth/README.md) and closed
//! forms.

use roulement::Model;
use roulement::contact::BallMotion;
use roulement::contact::many::ContactGroup;
use roulement::effects::growth::rings::{Cylinder, Fit};
use roulement::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic};
use roulement::interface::variables::{Causality, Variables};
use roulement::model::bodies::Race;
use roulement::numerics::lanes::WIDTH;
use roulement::scene::{Groups, Scene};
use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;

const RINGS: &str = include_str!("../data/growth/rings.csv");
const FITS: &str = include_str!("../data/growth/fits.csv");
const CASES: &str = include_str!("../data/growth/thermal_fits.csv");
const SOLUTIONS: &str = include_str!("../data/growth/thermal_fits_solutions.json");

/// [rad/s] per revolution per minute.
const RPM: f64 = std::f64::consts::PI / 30.0;

/// Cells of a table after its header, the first one without its quotes.
fn rows(text: &str) -> impl Iterator<Item = Vec<String>> {
    text.lines().skip(1).map(|line| match line.strip_prefix('"') {
        Some(quoted) => {
            let (name, rest) = quoted.split_once("\",").unwrap();
            std::iter::once(name).chain(rest.split(',')).map(String::from).collect()
        }
        None => line.split(',').map(String::from).collect(),
    })
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("{cell} is no number"))
}

fn close(ours: f64, theirs: f64, tolerance: f64, what: &str) {
    // Data are printed to twelve digits.
    assert!(
        (ours - theirs).abs() <= tolerance * theirs.abs().max(f64::MIN_POSITIVE),
        "{what}: {ours} {theirs}"
    );
}

#[test]
fn independent_data_rings_under_pressure_and_rotation() {
    let mut seen = 0;
    for row in rows(RINGS) {
        let [inside, outside, pressed_inside, pressed_outside, rpm, youngs_modulus, poisson_ratio, density] =
            std::array::from_fn(|i| number(&row[i + 1]));
        let ring = Cylinder { inside, outside, youngs_modulus, poisson_ratio, density };
        let radius = if row[9] == "inner surface" { inside } else { outside };
        let speed = rpm * RPM;
        let ours =
            ring.pressed(radius, [pressed_inside, pressed_outside]) + ring.spun(radius) * speed * speed;
        close(ours, number(&row[10]), 1e-10, &row[0]);
        close(ours, number(&row[11]), 1e-10, &row[0]);
        seen += 1;
    }
    assert_eq!(seen, 16);
}

#[test]
fn independent_data_fits() {
    let mut seen = 0;
    for row in rows(FITS) {
        let n: Vec<f64> = row[1..].iter().map(|cell| number(cell)).collect();
        let cylinder = |inside, outside, material: &[f64]| Cylinder {
            inside,
            outside,
            youngs_modulus: material[0],
            poisson_ratio: material[1],
            density: material[2],
        };
        let fit = Fit { inner: cylinder(n[2], n[3], &n[5..8]), outer: cylinder(n[3], n[4], &n[8..11]) };
        let square = (n[1] * RPM).powi(2);
        let seated = fit.seated(n[0], square);
        close(seated.interference, n[11], 1e-10, &row[0]);
        close(seated.pressure, n[12], 1e-10, &row[0]);
        // The raceway is on the ring's side without the seat.
        let raceway = match row[0].contains("housing") {
            false => fit.outer.pressed(n[4], [seated.pressure, 0.0]) + fit.outer.spun(n[4]) * square,
            true => fit.inner.pressed(n[2], [0.0, seated.pressure]) + fit.inner.spun(n[2]) * square,
        };
        close(raceway, n[13], 1e-10, &row[0]);
        seen += 1;
    }
    assert_eq!(seen, 9);
}

/// Keys of a bearing of the data: section, bores and outside diameters of its rings [m].
fn bearing(name: &str) -> (&'static str, f64, f64) {
    match name {
        "6206" => (
            "balls = 9\nball_diameter = 9.525e-3\npitch_diameter = 46e-3\ndiametral_clearance = 10e-6\n\
             inner_conformity = 0.52\nouter_conformity = 0.53\n",
            30e-3,
            62e-3,
        ),
        "7206" => (
            "balls = 13\nball_diameter = 9.525e-3\npitch_diameter = 46e-3\ncontact_angle = \"25 deg\"\n\
             inner_conformity = 0.52\nouter_conformity = 0.53\n",
            30e-3,
            62e-3,
        ),
        _ => (
            "balls = 16\nball_diameter = 22.23e-3\npitch_diameter = 125.26e-3\ncontact_angle = \"40 deg\"\n\
             inner_conformity = 0.5232\nouter_conformity = 0.5232\n",
            90e-3,
            160e-3,
        ),
    }
}

fn material(name: &str) -> &'static str {
    match name {
        "steel" => {
            "youngs_modulus = 206e9\npoisson_ratio = 0.3\ndensity = 7800.0\nthermal_expansion = 12e-6\n"
        }
        "aluminium" => {
            "youngs_modulus = 70e9\npoisson_ratio = 0.33\ndensity = 2700.0\nthermal_expansion = 23e-6\n"
        }
        "silicon_nitride" => {
            "youngs_modulus = 310e9\npoisson_ratio = 0.27\ndensity = 3200.0\nthermal_expansion = 3.2e-6\n"
        }
        other => panic!("{other}"),
    }
}

/// A case of the data by the names of its columns.
struct Case(Vec<(String, String)>);

impl Case {
    fn all() -> Vec<Self> {
        let names: Vec<&str> = CASES.lines().next().unwrap().split(',').collect();
        let case = |cells: Vec<String>| Self(names.iter().map(ToString::to_string).zip(cells).collect());
        rows(CASES).map(case).collect()
    }

    fn text(&self, name: &str) -> &str {
        &self.0.iter().find(|(column, _)| column == name).unwrap_or_else(|| panic!("{name}")).1
    }

    fn given(&self, name: &str) -> Option<f64> {
        Some(self.text(name)).filter(|cell| !cell.is_empty()).map(number)
    }

    fn get(&self, name: &str) -> f64 {
        number(self.text(name))
    }

    fn radial(&self) -> bool {
        self.text("kind") == "radial"
    }

    /// The scene, as a user would write it; `held` has the displacement along the load in place of the load.
    fn scene(&self, held: bool) -> Scene {
        let (section, bore, outside) = bearing(self.text("bearing"));
        let mut growth = format!(
            "[growth]\ninner = {}.0\nouter = {}.0\nballs = {}.0\nrotation = {}\n",
            self.get("dT_inner"),
            self.get("dT_outer"),
            self.get("dT_ball"),
            self.get("speed_rpm") > 0.0
        );
        for (key, ring, seat, other) in
            [("shaft", "inner", bore, "bore"), ("housing", "outer", outside, "outside")]
        {
            let fit = self.given(&format!("{ring}_fit_m"));
            if fit.is_none() && key == "housing" {
                continue;
            }
            growth += &format!("[growth.{key}]\ndiameter = {seat}\n");
            if let Some(interference) = fit {
                growth += &format!("interference = {interference:e}\n");
                growth += material(self.text(&format!("{ring}_fit_partner")));
                growth += &format!("rise = {}.0\n", self.get(&format!("{ring}_fit_partner_dT")));
                growth += &format!("{other} = {:?}\n", self.get(&format!("{ring}_fit_partner_diameter_m")));
            }
        }
        let load = match (held, self.given("held_displacement_m")) {
            (true, Some(place)) => format!("{{ displacement = {place:e} }}"),
            _ => format!("{{ force = {}.0 }}", self.get("load_N")),
        };
        let still = "{ displacement = 0.0 }".to_string();
        let [x, y] = if self.radial() { [still.clone(), load] } else { [load, still.clone()] };
        let text = format!(
            "[bearing]\n{section}[ball]\n{}[race]\n{}{growth}[load]\ninner_speed = \"{} rpm\"\nx = {x}\ny = {y}\nz = {still}\n\
             ry = {{ rotation = 0.0 }}\nrz = {{ rotation = 0.0 }}\n",
            material(self.text("ball")),
            material("steel"),
            self.get("speed_rpm"),
        );
        Scene::parse(&text).unwrap_or_else(|why| panic!("{}: {why}\n{text}", self.text("id")))
    }

    fn solve(&self, held: bool) -> Equilibrium {
        let scene = self.scene(held);
        let input = EquilibriumInput::from_scene(&scene, Gyroscopic::OuterRaceControl);
        equilibrium::solve(&Model::new(&scene).unwrap(), &input)
            .unwrap_or_else(|why| panic!("{}: {why}", self.text("id")))
    }
}

#[test]
fn independent_data_dimensions_of_the_grown_bearing() {
    let cases = Case::all();
    assert_eq!(cases.len(), 14);
    for case in cases {
        let id = case.text("id");
        let model = Model::new(&case.scene(false)).unwrap();
        let input = EquilibriumInput::from_scene(&case.scene(false), Gyroscopic::OuterRaceControl);
        let contacts = model.contacts(&input.surroundings());
        let absolute = |ours: f64, name: &str| {
            let theirs = case.get(name);
            // Printed to twelve digits: of the pitch radius 63 mm that is 1e-13 m.
            assert!((ours - theirs).abs() < 2e-13, "{id} {name}: {ours} {theirs}");
        };
        absolute(contacts.inner.surface.raceway.groove_circle_radius, "inner_groove_circle_m");
        absolute(contacts.outer.surface.raceway.groove_circle_radius, "outer_groove_circle_m");
        absolute(contacts.inner.surface.raceway.groove_radius, "inner_groove_radius_m");
        absolute(contacts.outer.surface.raceway.groove_radius, "outer_groove_radius_m");
        absolute(2.0 * contacts.inner.surface.ball_radius, "ball_diameter_m");
        let grown = model.growth.unwrap().output(&input.surroundings().warmth);
        assert!((grown.clearance - case.get("clearance_m")).abs() < 1e-12, "{id} {}", grown.clearance);
        assert!((grown.contact_angle - case.get("free_contact_angle_rad")).abs() < 1e-9, "{id} {grown:?}");
        for (index, ring) in ["inner", "outer"].into_iter().enumerate() {
            if let Some(interference) = case.given(&format!("{ring}_interference_m")) {
                assert!((grown.interference[index] - interference).abs() < 1e-15, "{id} {grown:?}");
                let pressure = case.get(&format!("{ring}_fit_pressure_Pa"));
                assert!((grown.seat_pressure[index] - pressure).abs() <= 1e-9 * pressure, "{id} {grown:?}");
            } else {
                assert_eq!((grown.interference[index], grown.seat_pressure[index]), (0.0, 0.0), "{id}");
            }
        }
    }
}

#[test]
fn independent_data_equilibria_of_the_grown_bearing() {
    for case in Case::all() {
        let id = case.text("id");
        let solution = case.solve(false);
        let along = if case.radial() { 1 } else { 0 };
        let moved = solution.displacement[along] - case.get("displacement_m");
        assert!(moved.abs() < 2e-9, "{id}: off by {moved} m");
        let largest = |of: fn(&equilibrium::BallReport) -> f64| {
            solution.balls.iter().map(|ball| of(&ball.report)).fold(0.0, f64::max)
        };
        close(largest(|b| b.inner_load), case.get("max_inner_load_N"), 1e-5, id);
        close(largest(|b| b.outer_load), case.get("max_outer_load_N"), 1e-5, id);
        if let Some(load) = case.given("held_load_N") {
            close(case.solve(true).load[along], load, 1e-5, id);
        }
    }
}

#[test]
fn independent_data_loads_of_every_ball() {
    let solutions: serde_json::Value = serde_json::from_str(SOLUTIONS).unwrap();
    for theirs in solutions.as_array().unwrap() {
        let id = theirs["id"].as_str().unwrap();
        let Some(case) = Case::all().into_iter().find(|case| case.text("id") == id) else {
            continue;
        };
        let solution = case.solve(false);
        for (key, of) in
            [("Qi", (|b| b.inner_load) as fn(&equilibrium::BallReport) -> f64), ("Qo", |b| b.outer_load)]
        {
            let loads = theirs[key].as_array().unwrap();
            assert_eq!(loads.len(), solution.balls.len());
            let largest = case.get("max_outer_load_N");
            for (ball, load) in solution.balls.iter().zip(loads) {
                let off = of(&ball.report) - load.as_f64().unwrap();
                assert!(off.abs() < 1e-5 * largest, "{id} {key}: off by {off} N");
            }
        }
    }
}

/// Keys of a scene and their values.
type Changes<'a> = &'a [(&'a str, &'a str)];

/// T13 of the data: the preloaded bearing, held where the cold one carries 1500 N.
fn preloaded(changes: Changes<'_>) -> Scene {
    let case = Case::all().into_iter().find(|case| case.text("id") == "T13").unwrap();
    Scene::edited(&case.scene(true).source, changes.iter().copied()).unwrap()
}

/// [N] thrust that holds the inner race.
fn thrust(simulation: &Simulation) -> f64 {
    -simulation.outputs().inner.wrench.force.x
}

/// Balls that turn, so that they are held in place, without friction that would take part in the thrust.
const TURNING: [(&str, &str); 2] =
    [("effects", "{ creep = \"frictionless\" }"), ("load.inner_speed", "\"600 rpm\"")];

#[test]
fn independent_data_a_run_of_the_warm_bearing_starts_and_stays_in_balance() {
    let mut simulation = Simulation::new(&preloaded(&TURNING)).unwrap();
    let start = thrust(&simulation);
    assert!((start / 2863.77836 - 1.0).abs() < 1e-3, "{start}");
    simulation.advance(2e-3).unwrap();
    assert!((thrust(&simulation) / start - 1.0).abs() < 1e-6, "{start} {}", thrust(&simulation));
    let grown = simulation.outputs().growth.unwrap();
    assert!((grown.clearance - 7.82425271234e-05).abs() < 1e-12, "{grown:?}");
}

/// Temperatures of T13 as tables: from the cold bearing within a second.
const RAMP: [(&str, &str); 3] = [
    ("growth.inner", "[[0, 0], [1, 50]]"),
    ("growth.outer", "[[0, 0], [1, 30]]"),
    ("growth.balls", "[[0, 0], [1, 40]]"),
];

#[test]
fn independent_data_thrust_of_a_bearing_that_warms_up_by_its_script() {
    let scene = preloaded(&[&TURNING[..], &RAMP].concat());
    let mut simulation = Simulation::new(&scene).unwrap();
    let (first, mut last) = (simulation.outputs().clone(), thrust(&simulation));
    assert!((last / 1500.0 - 1.0).abs() < 1e-3, "{last}");
    for row in 1..=100 {
        simulation.advance_scripted(0.01 * f64::from(row)).unwrap();
        let now = thrust(&simulation);
        // 1364 N in a hundred rows, without a step.
        assert!(now > last + 8.0 && now < last + 19.0, "{row}: {last} {now}");
        last = now;
    }
    assert!((last / 2863.77836 - 1.0).abs() < 5e-3, "{last}");
    assert_eq!(simulation.inputs().rises, Some([50.0, 30.0, 40.0, 0.0, 0.0]));
    // Growth presses the contacts together: that work is what they store.
    let now = simulation.outputs();
    let stored = now.stored_energy - first.stored_energy;
    assert!(now.work > 1e-3, "{}", now.work);
    let open = now.work + now.stiffened - now.dissipated - stored;
    assert!(open.abs() < 1e-5 * now.work, "{open} of {}", now.work);
}

#[test]
fn invariant_temperatures_as_inputs_do_what_the_script_does() {
    let mut by_inputs = Simulation::new(&preloaded(
        &[&TURNING[..], &[("growth.inner", "0.0"), ("growth.outer", "0.0"), ("growth.balls", "0.0")]]
            .concat(),
    ))
    .unwrap();
    let mut by_script = Simulation::new(&preloaded(&[&TURNING[..], &RAMP].concat())).unwrap();
    for row in 1..=3 {
        let end = 0.01 * f64::from(row);
        // Reached at the end of the step, linearly.
        let rises = Some([50.0 * end, 30.0 * end, 40.0 * end, 0.0, 0.0]);
        by_inputs.set_inputs(Inputs { rises, ..*by_inputs.inputs() });
        by_inputs.advance(end).unwrap();
        by_script.advance_scripted(end).unwrap();
        let [one, other] = [thrust(&by_inputs), thrust(&by_script)];
        assert!((one / other - 1.0).abs() < 1e-9, "{row}: {one} {other}");
    }
    let names = Variables::new(by_inputs.scene());
    let inputs = names.rows().iter().filter(|row| row.name.starts_with("temperature_rise."));
    assert_eq!(inputs.clone().count(), 5);
    assert!(inputs.clone().all(|row| row.causality == Causality::Input && row.unit.name == "K"));
    let values: Vec<f64> =
        inputs.map(|row| names.value(row, by_inputs.inputs(), by_inputs.outputs())).collect();
    let expected = [1.5, 0.9, 1.2, 0.0, 0.0];
    assert!(
        values.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-12),
        "{values:?}"
    );
}

#[test]
fn invariant_sensitivities_of_a_step_by_temperatures_are_those_of_repeated_steps() {
    let mut simulation = Simulation::new(&preloaded(&TURNING)).unwrap();
    simulation.advance(1e-3).unwrap();
    let base = *simulation.inputs();
    let warmer = |by: f64| Inputs {
        rises: base.rises.map(|[inner, rest @ ..]| {
            let [a, b, c, d] = rest;
            [inner + by, a, b, c, d]
        }),
        ..base
    };
    let mut central = simulation.clone();
    central.set_inputs(base);
    let outputs =
        central.advance_perturbed(1.1e-3, &[warmer(1e-3), warmer(-1e-3)], Groups::default()).unwrap();
    let linear =
        (outputs[1].outputs().inner.wrench.force.x - outputs[0].outputs().inner.wrench.force.x) / 2e-3;
    let repeated = |by: f64| {
        let mut again = simulation.clone();
        again.set_inputs(warmer(by));
        again.advance(1.1e-3).unwrap();
        thrust(&again)
    };
    let difference = (repeated(1e-3) - repeated(-1e-3)) / 2e-3;
    assert!(difference > 10.0, "{difference} N/K");
    assert!((linear / difference - 1.0).abs() < 1e-4, "{linear} {difference}");
}

#[test]
fn invariant_a_snapshot_in_the_middle_of_a_warming_goes_on_to_the_same_bits() {
    let scene = preloaded(&[&TURNING[..], &RAMP, &[("growth.rotation", "true")]].concat());
    let mut simulation = Simulation::new(&scene).unwrap();
    let mut other = Simulation::new(&scene).unwrap();
    simulation.advance_scripted(0.01).unwrap();
    assert!(other.restore(&simulation.snapshot()));
    assert_eq!(other.outputs(), simulation.outputs());
    for one in [&mut simulation, &mut other] {
        one.advance_scripted(0.02).unwrap();
    }
    assert_eq!(other.outputs(), simulation.outputs());
    assert_eq!(other.state(), simulation.state());
    // Rotation widens the inner ring a little: its raceway takes clearance.
    let cold = Scene::edited(&scene.source, [("growth.rotation", "false")]).unwrap();
    let [still, spun] = [&cold, &scene].map(|scene| {
        let mut simulation = Simulation::new(scene).unwrap();
        simulation.advance_scripted(1e-3).unwrap();
        simulation.outputs().growth.unwrap().clearance
    });
    let ring = Cylinder {
        inside: 15e-3,
        outside: 18.21965e-3,
        youngs_modulus: 206e9,
        poisson_ratio: 0.3,
        density: 7800.0,
    };
    let expected = 2.0 * ring.spun(ring.outside) * (600.0 * RPM).powi(2);
    assert!(((still - spun) / expected - 1.0).abs() < 1e-4, "{} {expected}", still - spun);
}

#[test]
fn wrong_keys_are_refused_by_name_value_and_range() {
    let cold = Scene::edited(&preloaded(&[]).source, [("growth", "")]).unwrap().source;
    let message =
        Scene::edited(&cold, [("interface.inputs.temperatures", "\"master\"")]).unwrap_err().to_string();
    assert!(message.contains("interface.inputs.temperatures") && message.contains("[growth]"), "{message}");
    let cases: [(Changes<'_>, &[&str]); 20] = [
        (&[("growth.inner", "\"50 degC\"")], &["growth.inner", "50 degC"]),
        (&[("growth.inner", "2000.0")], &["growth.inner = 2000", "[-300, 1000] K"]),
        (&[("growth.iner", "1.0")], &["growth.iner", "did you mean inner?"]),
        (&[("growth.shaft", "{ interference = 1e-5 }")], &["diameter"]),
        (&[("growth.shaft", "{ diameter = 0.05 }")], &["growth.shaft.diameter = 0.05", "m"]),
        (&[("growth.shaft", "{ diameter = 0.03, bore = 0.03 }")], &["growth.shaft.bore = 0.03", "[0, "]),
        (
            &[("growth.shaft", "{ diameter = 0.03, outside = 0.04 }")],
            &["growth.shaft.outside", "no shaft has it"],
        ),
        (
            &[("growth.housing", "{ diameter = 0.062, interference = 1e-5 }")],
            &["growth.housing.outside", "needed"],
        ),
        (&[("growth.housing", "{ diameter = 0.05 }")], &["growth.housing.diameter = 0.05"]),
        (
            &[("growth.shaft", "{ diameter = 0.03, roughness = 1e-6 }")],
            &["growth.shaft.interference", "roughness"],
        ),
        (
            &[("growth.shaft", "{ diameter = 0.03, interference = 1e-5, radial_load = 100.0 }")],
            &["growth.shaft.width", "needed"],
        ),
        (
            &[("growth.shaft", "{ diameter = 0.03, interference = 1e-5, roughness = 0.01 }")],
            &["growth.shaft.roughness = 0.01", "[0, 0.001] m"],
        ),
        (
            &[(
                "growth.housing",
                "{ diameter = 0.062, interference = 1e-5, outside = 0.1, radial_load = 100.0, width = 0.016 }",
            )],
            &["growth.housing.radial_load", "loosens inner rings"],
        ),
        (&[("growth.shaft", "{ diameter = 0.03, fit = \"K6\" }")], &["growth.shaft.fit", "small letters"]),
        (&[("growth.shaft", "{ diameter = 0.03, fit = \"x6\" }")], &["growth.shaft.fit", "\"x6\"", "js"]),
        (&[("growth.shaft", "{ diameter = 0.03, fit = \"k9\" }")], &["growth.shaft.fit", "4 to 8"]),
        (
            &[("growth.shaft", "{ diameter = 0.03, fit = \"k6\", interference = 1e-5 }")],
            &["growth.shaft.fit", "this or interference"],
        ),
        (&[("growth.housing", "{ diameter = 0.062, fit = \"N7\" }")], &["growth.housing.outside", "needed"]),
        (
            &[("growth", "{ rotation = true }"), ("load.inner_speed", "100.0")],
            &["growth.shaft", "inner race turns", "growth.shaft.diameter"],
        ),
        (
            &[("growth.balls", "1000.0"), ("bearing.inner_conformity", "0.505"), ("growth.inner", "-300.0")],
            &["growth.balls", "bearing.inner_conformity"],
        ),
    ];
    let plain = preloaded(&[]).source;
    for (changes, parts) in cases {
        let message = Scene::edited(&plain, changes.iter().copied()).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
}

/// Surfaces that are pressed flat (DIN 7190-1) and a load (NSK) take from a fit what a smaller one has not; none of them opens a gap.
#[test]
fn closed_form_interference_that_surfaces_and_load_take() {
    let fitted = |shaft: &str| {
        let scene = preloaded(&[("growth.shaft", shaft), ("load.inner_speed", "0.0")]);
        Simulation::new(&scene).unwrap().outputs().growth.unwrap().interference[0]
    };
    let plain =
        |interference: f64| fitted(&format!("{{ diameter = 0.03, interference = {interference:e} }}"));
    let lost = fitted(
        "{ diameter = 0.03, interference = 20e-6, roughness = 6e-6, radial_load = 4000.0, width = 0.016 }",
    );
    // 0.8 x 6 um, and 0.08 um (30/16 4000)^0.5 = 6.928 um.
    let left = 20e-6 - 4.8e-6 - 0.08e-6 * (30.0f64 / 16.0 * 4000.0).sqrt();
    close(lost, plain(left), 1e-9, "what is left");
    assert!(plain(20e-6) > lost + 10e-6);
    let gone = fitted("{ diameter = 0.03, interference = 2e-6, roughness = 6e-6 }");
    close(gone, plain(0.0), 1e-9, "nothing is left");
    assert_eq!(fitted("{ diameter = 0.03, interference = -5e-6, roughness = 6e-6 }"), plain(-5e-6));
}

/// Tables of fits that makers print for a bore of 30 mm and an outside diameter of 62 mm, shaft tolerance and housing tolerance against normal ones of
/// the bearing: the clearance is that of the interference itself, to rounding.
#[test]
fn published_fits_by_words_are_their_interferences() {
    let fitted = |ring: &str, seat: &str, changes: Changes<'_>| {
        let changes = [&[(ring, seat)][..], changes].concat();
        Simulation::new(&preloaded(&changes)).unwrap().outputs().growth.unwrap()
    };
    for (word, [least, greatest]) in [
        ("g6", [-20.0, 3.0]),
        ("h5", [-9.0, 10.0]),
        ("j5", [-4.0, 15.0]),
        ("js6", [-6.5, 16.5]),
        ("k5", [2.0, 21.0]),
        ("k6", [2.0, 25.0]),
        ("m6", [8.0, 31.0]),
        ("n6", [15.0, 38.0]),
        ("p6", [22.0, 45.0]),
    ] {
        let of = |fits: &str, um: f64| {
            let given = fitted(
                "growth.shaft",
                &format!("{{ diameter = 0.03, interference = {:e} }}", 1e-6 * um),
                &[],
            );
            let by_word = fitted(
                "growth.shaft",
                &format!("{{ diameter = 0.03, fit = \"{word}\" }}"),
                &[("growth.fits", fits)],
            );
            close(by_word.clearance, given.clearance, 1e-9, word);
        };
        of("\"least\"", least);
        of("\"mean\"", 0.5 * (least + greatest));
        of("\"greatest\"", greatest);
    }
    for (word, [least, greatest]) in [
        ("G7", [-53.0, -10.0]),
        ("H7", [-43.0, 0.0]),
        ("H8", [-59.0, 0.0]),
        ("J7", [-31.0, 12.0]),
        ("JS7", [-28.0, 15.0]),
        ("K6", [-17.0, 15.0]),
        ("K7", [-22.0, 21.0]),
        ("M7", [-13.0, 30.0]),
        ("N7", [-4.0, 39.0]),
        ("P6", [13.0, 45.0]),
        ("P7", [8.0, 51.0]),
    ] {
        let seat = |fit: &str| format!("{{ diameter = 0.062, outside = 0.1, {fit} }}");
        for (fits, um) in [("\"least\"", least), ("\"greatest\"", greatest)] {
            let given = fitted("growth.housing", &seat(&format!("interference = {:e}", 1e-6 * um)), &[]);
            let by_word =
                fitted("growth.housing", &seat(&format!("fit = \"{word}\"")), &[("growth.fits", fits)]);
            close(by_word.clearance, given.clearance, 1e-9, word);
        }
    }
    // Rings of class 5 are within 6 um at 30 mm.
    let p5 = [("growth.fits", "\"greatest\""), ("growth.ring_class", "\"p5\"")];
    let by_word = fitted("growth.shaft", "{ diameter = 0.03, fit = \"k5\" }", &p5);
    let given = fitted("growth.shaft", "{ diameter = 0.03, interference = 17e-6 }", &[]);
    close(by_word.clearance, given.clearance, 1e-9, "P5");
}

#[test]
fn regression_warm_contacts_of_four_balls_at_a_time_are_those_of_one_to_the_bit() {
    let mut simulation = Simulation::new(&preloaded(&[("load.inner_speed", "\"6000 rpm\"")])).unwrap();
    simulation.advance(2e-4).unwrap();
    let contacts = simulation.model().contacts(&simulation.conditions());
    for race in Race::BOTH {
        assert!(contacts[race].stiffening != 1.0);
        let motion = simulation.state().race(race).motion();
        let balls: [_; WIDTH] = std::array::from_fn(|lane| simulation.state().balls[3 * lane].motion());
        let mut group = ContactGroup::filled(&contacts[race].evaluated(&balls[0], &motion));
        group.evaluate(&contacts[race], &motion, &BallMotion::of_balls(&balls));
        for (lane, ball) in balls.iter().enumerate() {
            assert_eq!(group.contact(lane), contacts[race].evaluated(ball, &motion));
        }
    }
}

#[test]
fn regression_no_rise_is_the_cold_bearing_to_the_bit() {
    let cold = include_str!("../../scenes/thrust.toml");
    let mut plain = Simulation::new(&Scene::parse(cold).unwrap()).unwrap();
    let warm = Scene::edited(cold, [("growth", "{ inner = 0.0 }")]).unwrap();
    let mut grown = Simulation::new(&warm).unwrap();
    for end in [1e-3, 2e-3] {
        plain.advance(end).unwrap();
        grown.advance(end).unwrap();
        assert_eq!(plain.state().balls, grown.state().balls);
    }
    assert_eq!(plain.state().energies, grown.state().energies);
    assert!(Race::BOTH.into_iter().all(|race| plain.state().race(race) == grown.state().race(race)));
}
