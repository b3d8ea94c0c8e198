//! Estimates of effects: against independent numbers, and against what switching the effect on really does.

use std::collections::BTreeMap;

use roulement::Simulation;
use roulement::analysis::estimate;
use roulement::contact::film::FREE_ROLLING;
use roulement::effects::estimate::{ContactEstimate, Estimate, Outline, Standing, Verdict};
use roulement::effects::inherent::ring_bending;
use roulement::equilibrium::{self, Equilibrium, EquilibriumInput, Gyroscopic, Prescribed};
use roulement::model::Model;
use roulement::scene::Scene;

use crate::scenes::scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
const RADIAL: &str = include_str!("../../scenes/radial.toml");
const OIL_MIST: &str = include_str!("../../scenes/effects/oil_mist.toml");
const LOAD_ZONE: &str = include_str!("../../scenes/cost/load_zone.toml");
const UNBALANCE: &str = include_str!("../../scenes/error/unbalance.toml");
const SPINDLE: &str = include_str!("../../scenes/error/spindle.toml");
const MINIATURE: &str = include_str!("../../scenes/error/miniature.toml");
const HIGH_SPEED: &str = include_str!("../../scenes/error/high_speed.toml");

/// Changes of a scene.
type Changes<'a> = &'a [(&'a str, &'a str)];

/// The 218 at 22.25 kN and 10,000 rpm from the thrust case.
const LARGE: Changes<'static> = &[
    ("bearing.balls", "16"),
    ("bearing.ball_diameter", "\"22.23 mm\""),
    ("bearing.pitch_diameter", "\"125.26 mm\""),
    ("bearing.contact_angle", "\"40 deg\""),
    ("bearing.inner_conformity", "0.5232"),
    ("bearing.outer_conformity", "0.5232"),
    ("inner.mass", "2.06236783"),
    ("load.inner_speed", "\"10000 rpm\""),
    ("load.x.force", "\"22.25 kN\""),
];

/// A 6206 at 50 N and 300 rpm from the radial case.
const LIGHT: Changes<'static> = &[
    ("bearing.outer_conformity", "0.53"),
    ("inner.mass", "0.12"),
    ("load.inner_speed", "\"300 rpm\""),
    ("load.y.force", "50"),
];

/// A 7206 at 200 N and 30,000 rpm from the thrust case.
const FAST: Changes<'static> = &[
    ("bearing.balls", "13"),
    ("bearing.outer_conformity", "0.53"),
    ("inner.mass", "0.12"),
    ("load.inner_speed", "\"30000 rpm\""),
    ("load.x.force", "200"),
];

/// Thrust and radial load of the cage case on its bearing without the cage, a ball where the load points.
const COMBINED: Changes<'static> = &[
    ("inner.mass", "0.12"),
    ("load.y.force", "300"),
    ("load.ry", "{ rotation = 0.0 }"),
    ("load.rz", "{ rotation = 0.0 }"),
];

/// A shoulder of 0.2 ball diameters on either side of both races.
fn low_shoulders(ball: f64) -> [(&'static str, String); 2] {
    let heights = format!("[{0}, {0}]", 0.2 * ball);
    [("inner.shoulder_height", heights.clone()), ("outer.shoulder_height", heights)]
}

fn find<'a>(verdicts: &'a [Verdict], subject: &str) -> &'a Verdict {
    verdicts.iter().find(|verdict| verdict.subject == subject).unwrap_or_else(|| panic!("{subject}"))
}

fn value(verdicts: &[Verdict], subject: &str) -> f64 {
    find(verdicts, subject).value
}

#[test]
fn independent_data_lines_of_six_bearings() {
    let mut table = csv::Reader::from_path("tests/data/effects/auto_estimates.csv").unwrap();
    let mut largest = (0.0, String::new());
    let mut rows = 0;
    for row in table.deserialize() {
        let mut row: BTreeMap<String, String> = row.unwrap();
        let name = row.remove("scene").unwrap();
        let dry: Changes = &[("inner.mass", "0.12")];
        let (text, changes, ball, outline) = match name.split([',', ' ']).next().unwrap() {
            "thrust" => (THRUST, dry, 9.525e-3, [30.0, 62.0, 16.0]),
            "radial" => (RADIAL, dry, 9.525e-3, [30.0, 62.0, 16.0]),
            "cage" => (THRUST, COMBINED, 9.525e-3, [30.0, 62.0, 16.0]),
            "218" => (THRUST, LARGE, 22.23e-3, [90.0, 160.0, 30.0]),
            "6206" => (RADIAL, LIGHT, 9.525e-3, [30.0, 62.0, 16.0]),
            "hinge-like" => (THRUST, FAST, 9.525e-3, [30.0, 62.0, 16.0]),
            other => panic!("{other}"),
        };
        let shoulders = low_shoulders(ball);
        let shoulders = shoulders.iter().map(|(key, value)| (*key, value.as_str()));
        let changes: Vec<_> = changes.iter().copied().chain(shoulders).collect();
        let scene = scene(text, &changes);
        let mut estimate = estimate::of(&scene, &Model::new(&scene).unwrap()).unwrap();
        let [bore, outside, width] = outline.map(|length| 1e-3 * length);
        estimate.outline = Outline { bore, outside, width };
        let verdicts = scene.effects.verdicts(&estimate);
        let of = |subject: &str| {
            let verdict = find(&verdicts, subject);
            verdict.closed_form.unwrap_or(verdict.value)
        };
        let centrifugal = of("centrifugal force");
        let ours: [(&str, f64); 18] = [
            ("deepest_approach_m", estimate.deepest),
            ("Q_max_N", estimate.loads[0]),
            ("centrifugal", centrifugal),
            ("gravity", of("gravity")),
            ("thermal_growth_per_10K", of("growth by temperature")),
            ("heating_K", estimate.heating()),
            ("centrifugal_growth", of("growth by rotation")),
            ("waviness_per_um", of("waviness")),
            ("heathcote", estimate.groove_share()),
            ("rolling_resistance", of("rolling resistance")),
            ("film_ratio", of("film")),
            ("drag", of("drag")),
            ("support", of("support")),
            ("ring_bending", ring_bending(&estimate)),
            ("truncation_margin_deg", of("shoulders").to_degrees()),
            ("skid", 1.0 / centrifugal),
            ("gyroscopic", of("gyroscopic moment")),
            ("friction_power_W", estimate.friction_power()),
        ];
        assert_eq!(row.len(), ours.len());
        for (column, ours) in ours {
            let expected: f64 = row[column].parse().unwrap();
            let error = (ours - expected).abs() / expected.abs().max(1e-12);
            let zero = expected == 0.0 && ours.abs() < 1e-9;
            println!("{name} {column}: {ours:.6e} {expected:.6e} {:.2} %", 100.0 * error);
            assert!(zero || error < 0.05, "{name} {column}: {ours} for {expected}");
            if !zero && error > largest.0 {
                largest = (error, format!("{name} {column}"));
            }
        }
        rows += 1;
    }
    println!("largest: {largest:?}");
    assert_eq!(rows, 6);
}

/// A scene that estimates are tried on.
struct Case {
    name: &'static str,
    text: &'static str,
    changes: Changes<'static>,
}

const CASES: [Case; 12] = [
    Case { name: "thrust", text: THRUST, changes: &[] },
    Case { name: "radial", text: RADIAL, changes: &[] },
    Case { name: "combined", text: THRUST, changes: COMBINED },
    Case { name: "218", text: THRUST, changes: LARGE },
    Case { name: "6206 light", text: RADIAL, changes: LIGHT },
    Case { name: "7206 fast", text: THRUST, changes: FAST },
    Case { name: "load zone", text: LOAD_ZONE, changes: &[] },
    Case { name: "unbalance", text: UNBALANCE, changes: &[] },
    Case { name: "oil mist", text: OIL_MIST, changes: &[("effects.ambient", "")] },
    Case { name: "spindle", text: SPINDLE, changes: &[] },
    Case { name: "miniature", text: MINIATURE, changes: &[] },
    Case { name: "high speed", text: HIGH_SPEED, changes: &[] },
];

impl Case {
    fn with(&self, more: &[(&str, &str)]) -> Scene {
        let changes: Vec<_> = self.changes.iter().copied().chain(more.iter().copied()).collect();
        scene(self.text, &changes)
    }
}

/// Equilibrium under the scene's load at the largest speeds, and the same with the race held there in a changed scene.
fn held(case: &Case, changes: &[(&str, &str)], rises: [f64; 5]) -> [Equilibrium; 2] {
    let fastest =
        |values: Vec<f64>| values.into_iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let plain = case.with(&[]);
    let speeds = [&plain.load.inner_speed, &plain.load.outer_speed].map(|speed| fastest(speed.values()));
    let [inner_speed, outer_speed] = speeds;
    let input = EquilibriumInput::from_scene(&plain, Gyroscopic::Friction);
    let input = EquilibriumInput { inner_speed, outer_speed, ..input };
    let before = equilibrium::solve(&Model::new(&plain).unwrap(), &input).unwrap();
    let conditions = before.displacement.map(Prescribed::Motion);
    let changed = Model::new(&case.with(changes)).unwrap();
    let after = equilibrium::solve(&changed, &EquilibriumInput { conditions, rises, ..input }).unwrap();
    [before, after]
}

fn deepest(solution: &Equilibrium) -> f64 {
    let reports = solution.balls.iter().map(|ball| &ball.report);
    reports.map(|r| r.inner_approach.max(0.0) + r.outer_approach.max(0.0)).fold(0.0, f64::max)
}

fn largest_load(solution: &Equilibrium) -> f64 {
    solution.balls.iter().map(|ball| ball.report.inner_load).fold(0.0, f64::max)
}

fn estimate_of(scene: &Scene) -> (Estimate, Vec<Verdict>) {
    let estimate = estimate::of(scene, &Model::new(scene).unwrap()).unwrap();
    let verdicts = scene.effects.verdicts(&estimate);
    (estimate, verdicts)
}

/// Estimate and truth are within a factor of 2.
#[track_caller]
fn agree(case: &Case, subject: &str, estimate: f64, truth: f64) {
    println!("{:<12} {subject:<22} {estimate:.4} {truth:.4}  {:.2}", case.name, estimate / truth);
    assert!(
        estimate < 2.0 * truth && truth < 2.0 * estimate,
        "{}, {subject}: {estimate} for {truth}",
        case.name
    );
}

#[test]
fn invariant_growth_by_temperature_is_within_a_factor_of_two() {
    for case in &CASES {
        let (_, verdicts) = estimate_of(&case.with(&[]));
        let [cold, warm] = held(case, &[("growth.inner", "10")], [10.0, 0.0, 0.0, 0.0, 0.0]);
        let truth = (deepest(&warm) - deepest(&cold)) / deepest(&cold);
        agree(case, "growth by temperature", value(&verdicts, "growth by temperature"), truth);
    }
}

#[test]
fn invariant_growth_by_rotation_is_within_a_factor_of_two() {
    for case in &CASES {
        let (estimate, verdicts) = estimate_of(&case.with(&[]));
        let [bore, outside] =
            [estimate.outline.bore, estimate.outline.outside].map(|length| format!("{length:e}"));
        let mut changes = vec![("growth.rotation", "true"), ("growth.shaft.diameter", bore.as_str())];
        if estimate.rings[1].speed != 0.0 {
            changes.push(("growth.housing.diameter", outside.as_str()));
        }
        let [slow, grown] = held(case, &changes, [0.0; 5]);
        let truth = (deepest(&grown) - deepest(&slow)) / deepest(&slow);
        agree(case, "growth by rotation", value(&verdicts, "growth by rotation"), truth);
    }
}

#[test]
fn invariant_waviness_is_within_a_factor_of_two() {
    for case in &CASES {
        let plain = case.with(&[]);
        let (_, verdicts) = estimate_of(&plain);
        // As many waves as balls, each on a crest.
        let wave = format!(
            "[{{ order = {0}, amplitude = 1e-6, phase = {1} }}]",
            plain.bearing.balls,
            (plain.bearing.balls as f64 * plain.bearing.first_ball_azimuth.0) % std::f64::consts::TAU
        );
        let [smooth, wavy] = held(case, &[("form.inner", &wave)], [0.0; 5]);
        let truth = largest_load(&wavy) / largest_load(&smooth) - 1.0;
        agree(case, "waviness", value(&verdicts, "waviness"), truth);
    }
}

/// Force \[N] of all balls on the outer race along a direction, from contact angles and azimuths.
fn on_outer(solution: &Equilibrium, axis: usize) -> f64 {
    let of = |ball: &equilibrium::BallEquilibrium| {
        let (load, angle) = (ball.report.outer_load, ball.report.outer_contact_angle);
        let radial = [0.0, ball.azimuth.cos(), ball.azimuth.sin()][axis];
        load * if axis == 0 { angle.sin() } else { angle.cos() * radial }
    };
    solution.balls.iter().map(of).sum()
}

#[test]
fn invariant_gravity_is_within_a_factor_of_two() {
    for case in CASES.iter().filter(|case| case.name != "load zone") {
        let plain = case.with(&[]);
        let (_, verdicts) = estimate_of(&plain);
        let input = EquilibriumInput::from_scene(&plain, Gyroscopic::Friction);
        // Along the largest load.
        let load = |axis: usize| match input.conditions[axis] {
            Prescribed::Load(load) => load,
            Prescribed::Motion(_) => 0.0,
        };
        let axis = if load(0).abs() > load(1).abs() { 0 } else { 1 };
        let gravity = if axis == 0 { "[9.80665, 0, 0]" } else { "[0, 9.80665, 0]" };
        let heavy = case.with(&[("effects.gravity", gravity)]);
        let [without, with] = [&plain, &heavy].map(|scene| {
            let input = EquilibriumInput::from_scene(scene, Gyroscopic::Friction);
            equilibrium::solve(&Model::new(scene).unwrap(), &input).unwrap()
        });
        let truth = on_outer(&with, axis) / on_outer(&without, axis) - 1.0;
        agree(case, "gravity", value(&verdicts, "gravity"), truth);
    }
}

#[test]
fn invariant_drag_is_within_a_factor_of_two() {
    for case in &CASES {
        let plain = case.with(&[]);
        let (estimate, verdicts) = estimate_of(&plain);
        let misty = case.with(&[("effects.ambient", "{ density = 50, viscosity = 18e-6 }")]);
        let outputs = Simulation::new(&misty).unwrap().outputs().clone();
        let velocities =
            outputs.balls.iter().map(|ball| 0.5 * plain.bearing.pitch_diameter.0 * ball.orbital_speed.abs());
        let drag = outputs.drag_power / velocities.sum::<f64>();
        let truth = drag / (estimate.friction * estimate.loads[1]);
        agree(case, "drag", value(&verdicts, "drag"), truth);
    }
}

#[test]
fn invariant_shoulders_end_where_runs_report_it() {
    let mut cut = 0;
    for case in &CASES {
        let ball = case.with(&[]).bearing.ball_diameter.0;
        let heights = low_shoulders(ball);
        let changes: Vec<_> = heights.iter().map(|(key, value)| (*key, value.as_str())).collect();
        let scene = case.with(&changes);
        let (estimate, verdicts) = estimate_of(&scene);
        let outputs = Simulation::new(&scene).unwrap().outputs().clone();
        let contacts = || outputs.balls.iter().flat_map(|ball| [&ball.inner, &ball.outer]);
        let largest = contacts().map(|contact| contact.load).fold(0.0, f64::max);
        let loaded = || contacts().filter(|contact| contact.load > 0.05 * largest);
        let margin = loaded().map(|contact| contact.shoulder_margin).fold(f64::INFINITY, f64::min);
        let share = loaded().map(|contact| contact.shoulder_share).fold(0.0, f64::max);
        assert_eq!(value(&verdicts, "shoulders") < 0.0, margin < 0.0, "{}", case.name);
        agree(case, "shoulders", value(&verdicts, "shoulders").abs(), margin.abs());
        if margin < 0.0 {
            cut += 1;
            agree(case, "share over shoulders", estimate.shoulder_share, share);
        }
    }
    assert!(cut > 0);
}

#[test]
fn invariant_yielding_of_a_support_is_within_a_factor_of_two() {
    const STIFF: &str =
        "{ stiffness = [1e9, 1e9, 1e9, 1e7, 1e7, 1e7], mass = 1.0, inertia = [1e-3, 1e-3, 1e-3] }";
    // Tilts are held: the estimate is of the stiffness against a translation alone.
    let upright: Changes = &[("load.ry", "{ rotation = 0.0 }"), ("load.rz", "{ rotation = 0.0 }")];
    for (name, key, load) in [
        ("thrust", "load.y.force", 0.0),
        ("radial", "load.y.force", 1500.0),
        ("combined", "load.y.force", 300.0),
        ("218", "load.x.force", 22250.0),
        ("6206 light", "load.y.force", 50.0),
        ("7206 fast", "load.x.force", 200.0),
        ("high speed", "load.x.force", 1500.0),
    ] {
        let case = CASES.iter().find(|case| case.name == name).unwrap();
        let (estimate, verdicts) = estimate_of(&case.with(upright));
        let axis = usize::from(key == "load.y.force");
        let place = |load: f64, support: bool| {
            let load = format!("{load:e}");
            let mut changes = upright.to_vec();
            changes.push((key, &load));
            if support {
                changes.push(("outer.support", STIFF));
            }
            Simulation::new(&case.with(&changes)).unwrap().inputs().inner.pose.position[axis]
        };
        let more = load + 0.01 * estimate.load;
        let [stiff, soft] = [false, true].map(|support| place(more, support) - place(load, support));
        agree(case, "support", value(&verdicts, "support"), soft / stiff - 1.0);
    }
}

/// \[W] least power of complete sliding over the friction coefficient: spin of every ball in eighths on either race, creepages by
/// golden sections, over an 8 by 8 quadrature; the slip of grooves times a factor.
fn sliding_by_search(estimate: &Estimate, groove: f64) -> f64 {
    let of_contact = |contact: &ContactEstimate, spin: f64| {
        let bent = groove * contact.bend * contact.rolling.abs() * contact.semi_axes[1].powi(2);
        if spin == 0.0 {
            return FREE_ROLLING * contact.load * bent;
        }
        let power = |creep: f64| {
            let mut sum = 0.0;
            for (ring, ray) in (0..8).flat_map(|ring| (0..8).map(move |ray| (ring, ray))) {
                let radius = (1.0 - ((f64::from(ring) + 0.5) / 8.0).powf(2.0 / 3.0)).sqrt();
                let angle = std::f64::consts::PI * ((f64::from(ray) + 0.5) / 8.0 - 0.5);
                let (x, y) = (radius * angle.cos(), radius * angle.sin());
                let [along, across] = contact.semi_axes.map(|axis| axis * spin);
                sum += (bent * y * y - creep - across * y).hypot(along * x);
            }
            contact.load * sum / 64.0
        };
        let (mut low, mut high) = (-bent, bent);
        for _ in 0..30 {
            let width = 0.618_033_988_749_895 * (high - low);
            if power(high - width) < power(low + width) { high = low + width } else { low = high - width }
        }
        power(0.5 * (low + high))
    };
    let balls = estimate.contacts.iter().map(|contact| contact.ball + 1).max().unwrap();
    let of_ball = |ball: usize| {
        let of: Vec<_> = estimate.contacts.iter().filter(|contact| contact.ball == ball).collect();
        let spin = of.iter().map(|contact| contact.spin.abs()).fold(0.0, f64::max);
        let shares = (0..=8).map(|k| f64::from(k) / 8.0);
        let shared = |outer: f64| -> f64 {
            of.iter().map(|c| of_contact(c, if c.race == 0 { 1.0 - outer } else { outer } * spin)).sum()
        };
        if of.len() < 2 { of_contact(of[0], 0.0) } else { shares.map(shared).fold(f64::INFINITY, f64::min) }
    };
    let loaded = (0..balls).filter(|ball| estimate.contacts.iter().any(|contact| contact.ball == *ball));
    loaded.map(of_ball).sum()
}

#[test]
fn invariant_groove_slip_is_the_least_power_that_a_search_finds() {
    let mut largest = 0.0f64;
    for case in &CASES {
        let (estimate, verdicts) = estimate_of(&case.with(&[]));
        let [without, with] = [0.0, 1.0].map(|groove| sliding_by_search(&estimate, groove));
        let (ours, searched) = (value(&verdicts, "groove slip"), ((with - without) / with).max(0.0));
        println!("{}: {ours:.6e} {searched:.6e}", case.name);
        // The search knows the creepage to 1e-6 of its range, powers to the square of that where they have no kink.
        assert!((ours - searched).abs() < 1e-6, "{}: {ours} {searched}", case.name);
        largest = largest.max(ours);
    }
    assert!(largest > 0.05);
}

/// \[W] mean friction power of a run between two times \[s].
fn friction_power(scene: &Scene, [from, to]: [f64; 2]) -> f64 {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.advance_scripted(from).unwrap();
    let rows = 20;
    let row = |simulation: &mut Simulation, k: usize| {
        simulation.advance_scripted(from + (to - from) * k as f64 / rows as f64).unwrap();
        simulation.outputs().contact_power(|ball| ball.inner.power + ball.outer.power)
    };
    (1..=rows).map(|k| row(&mut simulation, k)).sum::<f64>() / rows as f64
}

/// The slip of grooves in runs over that time, in scenes by name.
fn groove_slip_in_runs(names: &[&str], law: &str, window: [f64; 2]) {
    for name in names {
        let case = CASES.iter().find(|case| case.name == *name).unwrap();
        let [without, with] = ["false", "true"].map(|slip| {
            let scene = case.with(&[("effects.creep", law), ("effects.heathcote_slip", slip)]);
            friction_power(&scene, window)
        });
        let (_, verdicts) = estimate_of(&case.with(&[]));
        let verdict = find(&verdicts, "groove slip");
        let (ours, truth) = (verdict.value, (with - without) / with);
        println!("{name}: {without} {with} W");
        // Shares below the threshold are those of spin that takes another part of the power; only that they are small is promised.
        if verdict.sentence.contains("makes up to") {
            // Friction does not hold these balls.
            println!("{name:<12} groove slip up to {ours:.4} {truth:.4}");
            assert!(truth < 2.0 * ours, "{name}: {ours} for {truth}");
        } else if ours < 0.05 {
            assert!(truth < 0.05, "{name}: {ours} for {truth}");
            println!("{name:<12} groove slip {ours:.4} {truth:.4}");
        } else {
            agree(case, "groove slip", ours, truth);
        }
    }
}

#[test]
fn invariant_groove_slip_is_within_a_factor_of_two_in_short_runs() {
    groove_slip_in_runs(&["radial", "7206 fast", "load zone", "6206 light"], "\"saturated\"", [2e-3, 4e-3]);
}

/// Until spin has settled.
#[test]
#[ignore = "minutes; scripts/soak runs it"]
fn invariant_groove_slip_is_within_a_factor_of_two_in_long_runs() {
    let names = [
        "thrust",
        "radial",
        "combined",
        "218",
        "load zone",
        "unbalance",
        "oil mist",
        "miniature",
        "spindle",
        "high speed",
        "6206 light",
        "7206 fast",
    ];
    groove_slip_in_runs(&names, "\"kalker_table\"", [20e-3, 30e-3]);
}

#[test]
fn what_is_on_is_judged_as_it_is_set() {
    fn judged(text: &str, changes: &[(&str, &str)]) -> Vec<Verdict> {
        estimate_of(&scene(text, changes)).1
    }
    let of = |verdicts: &[Verdict], subject: &str| {
        let verdict = verdicts.iter().find(|verdict| verdict.subject == subject).unwrap().clone();
        (verdict.standing, verdict.value)
    };
    // A tenth of the gravity is a tenth of the share.
    let full = of(&judged(THRUST, &[("effects.gravity", "[0, -9.80665, 0]")]), "gravity");
    let tenth = of(&judged(THRUST, &[("effects.gravity", "[0, 0.980665, 0]")]), "gravity");
    assert_eq!((full.0, tenth.0), (Standing::On, Standing::On));
    assert!((full.1 / tenth.1 - 10.0).abs() < 1e-3, "{full:?} {tenth:?}");
    // 20 K of the inner ring change the clearance by twice what 10 K do.
    let ten = of(&judged(RADIAL, &[("growth.inner", "10")]), "growth by temperature");
    let twenty = of(&judged(RADIAL, &[("growth.inner", "[[0, 0], [1, 20]]")]), "growth by temperature");
    let off = of(&judged(RADIAL, &[]), "growth by temperature");
    assert_eq!((ten.0, off.0), (Standing::On, Standing::Off));
    assert!(
        (ten.1 / off.1 - 1.0).abs() < 0.3 && (twenty.1 / ten.1 - 2.0).abs() < 0.3,
        "{ten:?} {twenty:?} {off:?}"
    );
    // Waves, drag and supports by their own sizes.
    let waves = "[{ order = 9, amplitude = \"0.1 um\" }]";
    let small = of(&judged(RADIAL, &[("form.outer", waves)]), "waviness");
    let micrometre = of(&judged(RADIAL, &[]), "waviness");
    assert!((micrometre.1 / small.1 - 10.0).abs() < 0.2, "{small:?} {micrometre:?}");
    let thin = of(&judged(RADIAL, &[("effects.ambient", "{ density = 5, viscosity = 18e-6 }")]), "drag");
    let mist = of(&judged(RADIAL, &[]), "drag");
    assert!(thin.0 == Standing::On && (mist.1 / thin.1 - 10.0).abs() < 1.0, "{thin:?} {mist:?}");
    let support = "{ stiffness = [2e9, 5e8, 2e9, 1e7, 1e7, 1e7], mass = 1.0, inertia = [1e-3, 1e-3, 1e-3] }";
    let soft = of(&judged(RADIAL, &[("outer.support", support)]), "support");
    let usual = of(&judged(RADIAL, &[]), "support");
    assert!(soft.0 == Standing::On && (soft.1 / usual.1 - 2.0).abs() < 1e-6, "{soft:?} {usual:?}");
}

#[test]
fn a_load_that_grows_from_nothing_is_looked_at_where_it_has_grown() {
    let table = "[[0, 0], [\"1 ms\", 0], [\"2 ms\", 1500], [\"3 ms\", 3000]]";
    let (growing, _) = estimate_of(&scene(RADIAL, &[("load.y.force", table)]));
    let (constant, _) = estimate_of(&scene(RADIAL, &[]));
    assert_eq!(growing, constant);
    let unloaded = scene(RADIAL, &[("load.y.force", "0")]);
    let why = estimate::of(&unloaded, &Model::new(&unloaded).unwrap()).unwrap_err().to_string();
    assert!(why.contains("no ball is loaded"), "{why}");
}
