//! The list of effects: what is told about each, what it adds to the variables, and how its keys are refused.

use std::collections::BTreeSet;

use roulement::interface::documentation::page;
use roulement::interface::model_description::all;
use roulement::interface::variables::Variables;
use roulement::scene::Scene;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
/// Variables of the thrust case, whose effects have none of their own.
const DESCRIPTION: &str = include_str!("../../modelDescription/modelDescription.xml");

/// The thrust case with another section of effects, and what follows it.
fn with(effects: &str) -> String {
    let from = THRUST.find("[effects]").unwrap();
    let to = THRUST.find("[inner]").unwrap();
    format!("{}{}{effects}", &THRUST[..from], &THRUST[to..])
}

const OFF: &str = "[effects]\ncreep = \"frictionless\"\n";

/// An effect's example without the slip of grooves, which comes with the default creep law.
fn alone(example: &str) -> String {
    match example.contains("creep = ") || example.contains("heathcote_slip = ") {
        true => example.to_string(),
        false if example.contains("[effects]\n") => {
            example.replacen("[effects]\n", "[effects]\ncreep = \"saturated\"\n", 1)
        }
        // A section of its own.
        false => format!("[effects]\ncreep = \"saturated\"\n{example}"),
    }
}

fn parse(effects: &str) -> Scene {
    Scene::parse(&with(effects)).unwrap()
}

/// Names of variables but margins, of which the creep law decides whether they can be told.
fn names(scene: &Scene) -> Vec<String> {
    let names = Variables::new(scene).rows().iter().map(|row| row.name.clone()).collect::<Vec<_>>();
    names.into_iter().filter(|name| !name.starts_with("margin.")).collect()
}

fn committed_names() -> Vec<String> {
    let rows = DESCRIPTION.split("<ScalarVariable name=\"").skip(1);
    rows.map(|row| row.split('"').next().unwrap().to_string()).collect()
}

#[test]
fn an_effect_that_is_off_adds_no_variable() {
    let off = parse(OFF);
    assert!(off.effects.each().iter().all(|effect| effect.setting().is_none()));
    assert!(off.effects.rows(off.bearing.balls, false).is_empty());
    // The thrust case has damping of contacts on, which is a loss.
    let committed =
        committed_names().into_iter().filter(|name| name != "loss.damping" && !name.starts_with("margin."));
    let committed = committed.collect::<Vec<_>>();
    assert_eq!(names(&off), committed);
}

#[test]
fn an_effect_that_is_on_adds_its_own_variables_before_the_parameters() {
    let base = names(&parse(OFF));
    let first_parameter = base.iter().position(|name| name == "bearing.ball_diameter").unwrap();
    // Effect, how many variables it adds, and how their names begin: 36 coefficients twice; of a cage without lands 22;
    // of 10 balls 29 each, and what they meet where they enter the load zone; of neighbouring balls 4.
    let adding = [
        ("effects.stiffness_outputs", 72, &["stiffness.", "damping."][..]),
        ("effects.cage", 22, &["cage."]),
        ("effects.heathcote_slip", 1, &["power.groove"]),
        ("effects.per_ball_outputs", 291, &["ball[", "balls.entering_slip_load"]),
        ("effects.full_complement", 4, &["neighbours."]),
        ("effects.shoulder_outputs", 4, &["shoulder."]),
        ("effects.heat_outputs", 4, &["heat."]),
        ("effects.mean_outputs", 17, &["mean."]),
        ("rating", 5, &["life."]),
        (
            "growth",
            11,
            &["clearance", "contact_angle.free", "interference.", "seat_pressure.", "temperature_rise."],
        ),
        ("defect", 4, &["frequency."]),
        ("effects.frame", 9, &["frame."]),
        ("effects.ambient", 1, &["ambient."]),
        ("support", 6, &["outer.support."]),
        ("film", 6, &["lubrication", "film.", "rolling_power."]),
        ("effects.hysteresis", 1, &["power.hysteresis"]),
        // With growth, whose temperatures are its outputs then.
        (
            "effects.heat_balance",
            12,
            &["clearance", "contact_angle.", "interference.", "seat_pressure.", "temperature_rise.", "heat."],
        ),
    ];
    // What can be lost to the effect is a loss of its own, beside all losses and sliding.
    let losing = [
        ("effects.damping", "loss.damping"),
        ("effects.cage", "loss.cage"),
        ("effects.hysteresis", "loss.hysteresis"),
        ("effects.ambient", "loss.drag"),
        ("support", "loss.support"),
        ("film", "loss.rolling"),
    ];
    let (losses, base): (Vec<_>, Vec<_>) = base.into_iter().partition(|name| name.starts_with("loss."));
    assert_eq!(losses, ["loss.total", "loss.sliding"]);
    let first_parameter = first_parameter - losses.len();
    for effect in parse(OFF).effects.each() {
        let info = effect.info();
        let on = names(&parse(&alone(info.example)));
        let (lost, on): (Vec<_>, Vec<_>) = on.into_iter().partition(|name| name.starts_with("loss."));
        let part = losing.iter().find(|(key, _)| *key == info.key).map(|(_, name)| name.to_string());
        assert_eq!(lost, [losses.clone(), part.into_iter().collect()].concat(), "{}", info.key);
        let (count, starts) = adding
            .iter()
            .find(|(key, ..)| *key == info.key)
            .map_or((0, &[][..]), |(_, count, starts)| (*count, *starts));
        let added = &on[first_parameter..first_parameter + count];
        assert!(added.iter().all(|name| starts.iter().any(|start| name.starts_with(start))), "{added:?}");
        // Behind it are parameters, its own among them.
        let rest = on[..first_parameter].iter().chain(&on[first_parameter + count..]);
        let own = [
            "cage.",
            "growth.",
            "rating.",
            "ball.thermal_expansion",
            "race.density",
            "race.thermal_expansion",
            "effects.frame.",
            "effects.ambient.",
            "outer.support.",
            "film.",
            "effects.heat_balance.",
        ];
        let is_own = |name: &&String| own.iter().any(|start| name.starts_with(start)) && !base.contains(name);
        let others: Vec<_> = rest.filter(|name| !is_own(name)).collect();
        // Gravity is an input of a frame that moves, and no parameter.
        let moves = info.key == "effects.frame";
        let usual = base.iter().filter(|name| !(moves && name.starts_with("effects.gravity")));
        assert_eq!(others, usual.collect::<Vec<_>>(), "{}", info.key);
    }
    // A cage adds its pockets to every ball.
    let both = parse(
        "[effects]\ncreep = \"saturated\"\ncage = true\nper_ball_outputs = true\n[cage]\nmass = 0.02\n\
                      inertia = [1e-5, 6e-6, 6e-6]\npocket_clearance = 2e-4\nguided_by = \"balls\"\n",
    );
    let on = names(&both);
    assert_eq!(on.len(), base.len() + losses.len() + 22 + 10 * (29 + 6) + 1 + 5 + 1);
    assert_eq!(on.iter().filter(|name| name.contains("].pocket.")).count(), 60);
    assert_eq!(on.iter().collect::<BTreeSet<_>>().len(), on.len(), "names are unique");
}

#[test]
fn what_is_told_about_an_effect_is_complete_and_its_example_switches_it_on() {
    let scene = parse(OFF);
    let effects = scene.effects.each();
    let keys: BTreeSet<_> = effects.iter().map(|effect| effect.info().key).collect();
    assert_eq!(keys.len(), effects.len());
    for (index, effect) in effects.iter().enumerate() {
        let info = effect.info();
        for text in [info.key, info.adds, info.states, info.source, info.price, info.example] {
            assert!(!text.trim().is_empty() && text.is_ascii(), "{info:?}");
        }
        let on = parse(&alone(info.example));
        assert!(
            on.effects.each()[index].setting().is_some_and(|setting| !setting.is_empty()),
            "{}",
            info.key
        );
        // All others stay off, but for the creep law, which has a default.
        for (other, effect) in on.effects.each().iter().enumerate().skip(1) {
            // Growth follows the temperatures of the heat balance, which needs it.
            let needed = (info.key, effect.info().key) == ("effects.heat_balance", "growth");
            assert_eq!(
                effect.setting().is_some(),
                other == index || needed,
                "{} by {}",
                effect.info().key,
                info.key
            );
        }
        // The key is one of the scene file: no other would be read. A support is a section of a race.
        let (section, key, written) = match info.key.strip_prefix("effects.") {
            Some(key) => ("effects.", key, format!("{key} = ")),
            None if info.key == "support" => {
                assert!(info.example.contains(&format!(".{}]", info.key)), "{}", info.example);
                continue;
            }
            None => ("", info.key, format!("[{}]", info.key)),
        };
        assert!(info.example.contains(&written), "{}", info.example);
        let misspelt = info.example.replacen(&written, &written.replacen(key, &format!("{key}s"), 1), 1);
        let message = Scene::parse(&with(&misspelt)).unwrap_err().to_string();
        for part in [&format!("{section}{key}s is no known key: did you mean"), key, "line"] {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
}

#[test]
fn settings_say_how_an_effect_is_set() {
    let text = with(
        "[effects]\ncreep = \"kalker\"\nkalker_degree = 5\ndamping = \"20 ms/m\"\ngravity = [0, -9.81, 0]\n",
    );
    let scene = Scene::parse(&text).unwrap();
    let settings: Vec<_> = scene.effects.each().iter().filter_map(|effect| effect.setting()).collect();
    assert_eq!(settings, ["kalker, degree 5", "0.02 s/m", "[0.0, -9.81, 0.0] m/s2"]);
    let cage = Scene::parse(include_str!("../../scenes/cage.toml")).unwrap();
    assert_eq!(cage.effects.cage.section.unwrap().mass.0, 0.02);
    let settings: Vec<_> = cage.effects.each().iter().filter_map(|effect| effect.setting()).collect();
    assert_eq!(settings, ["saturated", "0.02 s/m", "[0.0, 0.0, -9.81] m/s2", "guided by the outer race"]);
}

#[test]
fn the_page_of_a_package_names_every_effect_on_or_off() {
    let on = page(&Scene::parse(include_str!("../../scenes/cage.toml")).unwrap(), &all);
    let off = page(&parse(OFF), &all);
    let escaped = |text: &str| text.replace('\'', "&apos;");
    for effect in parse(OFF).effects.each() {
        let info = effect.info();
        for page in [&on, &off] {
            let row =
                page.lines().find(|line| line.contains(&format!("<tr><td><code>{}</code></td>", info.key)));
            let row = row.unwrap_or_else(|| panic!("no row of {}", info.key));
            for text in [info.adds, info.states, info.source, info.price] {
                assert!(row.contains(&escaped(text)), "{row}\nshould say {text}");
            }
        }
        assert!(off.contains(&format!("<code>{}</code></td><td>off</td>", info.key)), "{}", info.key);
    }
    assert!(on.contains("<code>effects.cage</code></td><td>guided by the outer race</td>"));
    assert!(on.contains("<code>effects.heathcote_slip</code></td><td>off</td>"));
}

#[test]
fn wrong_keys_of_effects_are_refused_by_name_value_and_range() {
    let cage = <roulement::effects::cage::Settings as roulement::effects::Effect>::INFO.example;
    let cases: [(String, &[&str]); 14] = [
        ("[effects]\ndamping = -1".into(), &["effects.damping = -1", "[0, 10] s/m"]),
        (
            "[effects]\ngravity = [0, 1e7, 0]".into(),
            &["effects.gravity.y = 10000000", "[-1000000, 1000000] m/s2"],
        ),
        (
            "[effects]\ngravity = [0, \"9.81 m\", 0]".into(),
            &["effects.gravity", "9.81 m", "m measures something else", "line"],
        ),
        ("[effects]\nkalker_degree = 8".into(), &["effects.kalker_degree = 8", "[1, 7]"]),
        ("[effects]\nepsilon_switch = nan".into(), &["effects.epsilon_switch = NaN", "[0, 1]"]),
        ("[effects]\ncreep = \"slippery\"".into(), &["slippery", "kalker_table", "line"]),
        (
            "[effects]\nheathcote_slip = 1".into(),
            &["effects.heathcote_slip wants true or false, not 1", "line"],
        ),
        (
            "[effects]\ncreep = \"linear\"\nheathcote_slip = true".into(),
            &["effects.heathcote_slip", "saturates"],
        ),
        (
            "[regularised]\ninner = { eta = [1e7, 1, 1], beta = [1, 1], alpha = [1, 1, 1] }".into(),
            &["regularised.inner.eta = 10000000", "[-1000000, 1000000]"],
        ),
        (
            "[regularised]\nouter = { eta = [1, -3, 1], beta = [1, 1], alpha = [1, 1, 1] }".into(),
            &["regularised.outer", "a denominator vanishes"],
        ),
        (cage.replace("mass = \"20 g\"", "mass = \"20 t\""), &["cage.mass = 20000", "(0, 10000] kg"]),
        (format!("{cage}damping = 11\n"), &["cage.damping = 11", "[0, 10] s/m"]),
        (format!("{cage}poisson_ratio = 0.6\n"), &["cage.poisson_ratio = 0.6", "[0, 0.5]"]),
        (cage.replace("cage = true", "cage = false"), &["cage", "effects.cage = true"]),
    ];
    for (effects, parts) in cases {
        let message = Scene::parse(&with(&effects)).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{message}\nshould name {part}");
        }
    }
}

#[test]
fn a_parameter_has_the_range_that_its_key_has_in_a_scene() {
    for text in
        [THRUST, include_str!("../../scenes/cage.toml"), include_str!("../../scenes/misalignment.toml")]
    {
        let scene = Scene::parse(text).unwrap();
        let parameters = scene.parameters();
        assert!(parameters.len() > 20, "{}", parameters.len());
        for parameter in parameters {
            let range = parameter.range;
            for value in [range.low - 1e-3 * range.high.abs(), 1.001 * range.high, f64::NAN] {
                let mut changed = scene.clone();
                changed.set_number(parameter.key, value);
                let message = changed.check().unwrap_err().to_string();
                let space = if range.unit.is_empty() { "" } else { " " };
                let expected = format!(
                    "{} = {value}{space}{} is out of range: allowed is {range}",
                    parameter.key, range.unit
                );
                assert_eq!(message, expected);
            }
            let mut same = scene.clone();
            same.set_number(parameter.key, parameter.start);
            same.check().unwrap();
        }
    }
}
