//! Damping by measurable quantities against independent data (tests/data/effects/README.md) and closed forms: a ball struck against a race.

use nalgebra::Vector3;
use roulement::contact::normal::Damping;
use roulement::contact::{BallMotion, ContactModel};
use roulement::effects::damping::RestitutionLaw;
use roulement::model::bodies::Race;
use roulement::model::{Conditions, Model};
use roulement::scene::Scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");

fn table(text: &str) -> Vec<Vec<&str>> {
    text.lines().skip(1).map(|line| line.split(',').collect()).collect()
}

/// The thrust case without friction under some damping.
fn scene(damping: &str) -> Result<Scene, roulement::scene::SceneError> {
    Scene::edited(THRUST, [("effects.creep", "\"frictionless\""), ("effects.damping", damping)])
}

/// [-] restitution of a ball of a mass [kg] that meets the outer race at a speed [m/s]: the contact's own force, integrated by
/// Runge and Kutta's rule in steps of a thousandth of the impact.
fn drop(model: &Model, contact: &ContactModel<'_>, speed: f64, mass: f64) -> f64 {
    let race = roulement::contact::RaceMotion::resting(Vector3::zeros(), Vector3::x(), Vector3::y());
    let raceway = &model.bearing.outer;
    // Where a ball just touches, at the bottom of the groove.
    let touching = raceway.groove_circle_radius + raceway.groove_radius - model.bearing.ball.radius;
    let force = |depth: f64, rate: f64| {
        let ball = BallMotion {
            position: Vector3::new(raceway.groove_offset, touching + depth, 0.0),
            velocity: Vector3::new(0.0, rate, 0.0),
            angular_velocity: Vector3::zeros(),
        };
        contact.evaluated(&ball, &race).force.y / mass
    };
    let stiffness = contact.evaluated(
        &BallMotion {
            position: Vector3::new(raceway.groove_offset, touching + 1e-6, 0.0),
            ..BallMotion::at_rest()
        },
        &race,
    );
    let duration = 2.94 * (mass / stiffness.stiffness).powf(0.4) * (1.25f64).powf(0.4) / speed.powf(0.2);
    let h = duration / 2000.0;
    let (mut x, mut v) = (0.0, speed);
    for _ in 0..20_000 {
        let at = |x: f64, v: f64| (v, force(x, v));
        let a = at(x, v);
        let b = at(x + 0.5 * h * a.0, v + 0.5 * h * a.1);
        let c = at(x + 0.5 * h * b.0, v + 0.5 * h * b.1);
        let d = at(x + h * c.0, v + h * c.1);
        x += h / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + d.0);
        v += h / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + d.1);
        if x <= 0.0 {
            return -v / speed;
        }
    }
    panic!("the ball stays");
}

#[test]
fn independent_data_published_laws_give_the_factors_of_the_review() {
    let law = |name: &str| match name {
        "hunt_crossley" => RestitutionLaw::HuntCrossley,
        "herbert_mcwhannell" => RestitutionLaw::HerbertMcwhannell,
        "lee_wang" => RestitutionLaw::LeeWang,
        "lankarani_nikravesh" => RestitutionLaw::LankaraniNikravesh,
        "gonthier" => RestitutionLaw::Gonthier,
        "flores" => RestitutionLaw::Flores,
        "hu_guo" => RestitutionLaw::HuGuo,
        other => panic!("{other}"),
    };
    let rows = table(include_str!("../data/effects/damping_laws.csv"));
    assert!(rows.len() > 30);
    for row in rows {
        let [wanted, factor, restitution] = [1, 2, 3].map(|i| row[i].parse::<f64>().unwrap());
        assert!((law(row[0]).factor(wanted) / factor - 1.0).abs() < 1e-10, "{row:?}");
        // The exact law asked for what that law really gives finds that law's factor.
        assert!((RestitutionLaw::Exact.factor(restitution) / factor - 1.0).abs() < 1e-7, "{row:?}");
    }
}

#[test]
fn closed_form_the_exact_factor_solves_its_equation_and_nothing_lost_needs_none() {
    for e in [0.1f64, 0.5, 0.9, 0.998_9, 0.999_1] {
        let x = RestitutionLaw::Exact.factor(e);
        let excess = x - x.ln_1p() + e * x + (-e * x).ln_1p();
        assert!(x > 0.0 && x < 1.0 / e && excess.abs() < 1e-12 * x.max(1.0), "{e}: {x} {excess:e}");
    }
    // What is asked for at the end of the range is beyond any factor that a number can tell from 1/e.
    assert!((RestitutionLaw::Exact.factor(0.01) - 100.0).abs() < 1e-9);
    // To first order e = 1 - 2/3 x.
    for lost in [1e-4, 1e-8, 1e-12] {
        let x = RestitutionLaw::Exact.factor(1.0 - lost);
        assert!((x / (1.5 * lost) - 1.0).abs() < 2.0 * lost + 1e-3 * 1e-12 / lost, "{lost}: {x:e}");
    }
    assert_eq!(RestitutionLaw::Exact.factor(1.0), 0.0);
}

#[test]
fn independent_data_a_ball_dropped_on_a_race_leaves_it_as_asked() {
    // By factor: chi and speed of the data.
    let rows = table(include_str!("../data/effects/damping_hunt_crossley.csv"));
    for row in rows.iter().step_by(3) {
        let [factor, speed, restitution] = [0, 1, 2].map(|i| row[i].parse::<f64>().unwrap());
        let model = Model::new(&scene(&factor.to_string()).unwrap()).unwrap();
        let contact = model.contact(Race::Outer, &Conditions::of_friction(0.0));
        let ours = drop(&model, &contact, speed, model.bearing.ball.mass);
        assert!((ours - restitution).abs() < 1e-5, "{row:?}: {ours}");
    }
    // By restitution at a speed, exactly and by two laws with what these really give.
    for (law, wanted, given) in
        [("exact", 0.6, 0.6), ("exact", 0.95, 0.95), ("lee_wang", 0.6, 0.833), ("flores", 0.6, 0.577)]
    {
        let damping = format!("{{ restitution = {wanted}, at = \"0.2 m/s\", law = \"{law}\" }}");
        let model = Model::new(&scene(&damping).unwrap()).unwrap();
        let contact = model.contact(Race::Outer, &Conditions::of_friction(0.0));
        let ours = drop(&model, &contact, 0.2, model.bearing.ball.mass);
        let tolerance = if law == "exact" { 1e-4 } else { 1e-3 };
        assert!((ours - given).abs() < tolerance, "{law}: {ours}");
    }
}

#[test]
fn independent_data_viscoelastic_restitution() {
    let rows = table(include_str!("../data/effects/damping_viscoelastic.csv"));
    for row in &rows {
        let [time, speed, mass, stiffness, restitution] =
            [0, 1, 2, 3, 4].map(|i| row[i].parse::<f64>().unwrap());
        let model = Model::new(&scene(&format!("{{ retardation_time = {time:e} }}")).unwrap()).unwrap();
        let contact = model.contact(Race::Outer, &Conditions::of_friction(0.0));
        assert_eq!(contact.damping, Damping::Viscoelastic(time));
        // The data have another stiffness: the impact depends on mass over stiffness alone.
        let ball = BallMotion {
            position: Vector3::new(
                model.bearing.outer.groove_offset,
                model.bearing.outer.groove_circle_radius + model.bearing.outer.groove_radius
                    - model.bearing.ball.radius,
                0.0,
            ),
            ..BallMotion::at_rest()
        };
        let race = roulement::contact::RaceMotion::resting(Vector3::zeros(), Vector3::x(), Vector3::y());
        let own = contact.evaluated(&ball, &race).stiffness;
        let ours = drop(&model, &contact, speed, mass * own / stiffness);
        assert!((ours - restitution).abs() < 1e-4, "{row:?}: {ours}");
    }
    assert!(rows.len() > 5);
}

#[test]
fn wrong_dampings_are_refused_by_key_value_and_range() {
    for (damping, parts) in [
        ("-1", &["effects.damping = -1", "[0, 10] s/m"][..]),
        ("{ restitution = 1.1, at = 1 }", &["effects.damping.restitution = 1.1", "[0.01, 1]"]),
        ("{ restitution = 0.9, at = 0 }", &["effects.damping.at = 0", "(0, 100] m/s"]),
        ("{ restitution = 0.9 }", &["at"]),
        ("{ restitution = 0.9, at = 1, law = \"mine\" }", &["mine", "hu_guo"]),
        ("{ retardation_time = 1 }", &["effects.damping.retardation_time = 1", "[0, 0.001] s"]),
        ("{ retardation_time = 1e-6, at = 1 }", &["at"]),
        ("\"3 kg\"", &["effects.damping", "kg measures something else"]),
    ] {
        let message = scene(damping).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
    let offered = |damping: &str| -> Vec<&str> {
        let scene = scene(damping).unwrap();
        let keys = scene.parameters().into_iter().map(|parameter| parameter.key);
        keys.filter(|key| key.starts_with("effects.damping")).collect()
    };
    assert_eq!(offered("0.02"), ["effects.damping"]);
    assert_eq!(offered("{ retardation_time = 1e-7 }"), ["effects.damping.retardation_time"]);
    assert_eq!(
        offered("{ restitution = 0.9, at = 1 }"),
        ["effects.damping.restitution", "effects.damping.at"]
    );
}
