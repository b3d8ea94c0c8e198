//! Random scenes of all effects, and of shafts: those of random_scenes.rs with oil, waves, spalls, warmth, supports, frames and more.

use std::fmt::Write;

use roulement::scene::Scene;
use roulement::scene::machine::MachineScene;

use crate::random::Random;
use crate::random_scenes;

/// A scene of a bearing, or one in four of a shaft; none where what was drawn does not go together.
pub fn machine(random: &mut Random) -> Option<MachineScene> {
    if random.below(4) == 0 { MachineScene::parse(&shaft(random)).ok() } else { bearing(random) }
}

/// A bearing with every effect as often as not, or less.
fn bearing(random: &mut Random) -> Option<MachineScene> {
    let plain = random_scenes::scene(random);
    let scene = Scene::parse(&plain).ok()?;
    let size = scene.bearing.ball_diameter.0;
    let caged = plain.contains("cage = true");
    let mut edits: Vec<(&str, String)> = vec![("solver", "{}".into())];
    let mut drawn = |share: f64, edit: &dyn Fn(&mut Random) -> (&'static str, String)| {
        if random.unit() < share {
            edits.push(edit(random));
        }
    };
    drawn(0.4, &|random| {
        let (grade, warm) = (random.logarithmic(10.0, 500.0), random.between(20.0, 90.0));
        let supply = random.pick(&["flooded", "bath", "oil_air"]);
        let cage = caged && random.unit() < 0.5;
        (
            "film",
            format!(
                "{{ iso_vg = {grade}, temperature = \"{warm} degC\", supply = \"{supply}\", cage = {cage} }}"
            ),
        )
    });
    drawn(0.2, &|random| {
        let density = random.logarithmic(1.0, 100.0);
        ("effects.ambient", format!("{{ density = {density}, viscosity = 5e-4 }}"))
    });
    drawn(0.3, &|_| ("effects.hysteresis", "true".into()));
    drawn(0.15, &|random| {
        let restitution = random.between(0.4, 0.95);
        ("effects.damping", format!("{{ restitution = {restitution}, at = 0.05 }}"))
    });
    drawn(0.15, &|random| {
        ("effects.damping", format!("{{ retardation_time = {} }}", random.logarithmic(1e-7, 1e-5)))
    });
    drawn(0.3, &|random| {
        let wave = |random: &mut Random| {
            let amplitude = size * random.logarithmic(3e-6, 3e-4);
            let (order, way) = (1 + random.below(30), random.pick(&["radial", "axial"]));
            format!("{{ order = {order}, amplitude = {amplitude}, direction = \"{way}\" }}")
        };
        ("form", format!("{{ inner = [{}], outer = [{}] }}", wave(random), wave(random)))
    });
    drawn(0.25, &|random| {
        let part = size * random.logarithmic(0.03, 0.3);
        let (on, azimuth) = (random.pick(&["inner", "outer"]), random.between(-3.0, 3.0));
        let depth = part * random.logarithmic(0.003, 0.1);
        let width = 0.3 * size;
        let text = format!(
            "[{{ on = \"{on}\", azimuth = {azimuth}, length = {part}, width = {width}, depth = {depth} }}]"
        );
        ("defect", text)
    });
    drawn(0.3, &|random| {
        let warm = random.between(-20.0, 40.0);
        ("growth", format!("{{ inner = [[0, 0], [0.002, 0], [0.005, {warm}]], balls = {} }}", 0.5 * warm))
    });
    drawn(0.15, &|_| ("growth", "{ rotation = true }".into()));
    drawn(0.3, &|_| ("rating", "{}".into()));
    drawn(0.15, &|random| {
        let [x, y] = [(); 2].map(|()| 100.0 * random.symmetric());
        ("effects.frame", format!("{{ angular_velocity = [{x}, {y}, 0], arm = [0, {}, 0] }}", 5.0 * size))
    });
    drawn(0.2, &|random| {
        let (stiffness, mass) = (random.logarithmic(1e9, 2e10) * size, 2e4 * size.powi(3));
        let (about, inertia) = (stiffness * size * size * 10.0, mass * size * size * 5.0);
        let [along, around] = [(stiffness, mass), (about, inertia)].map(|(k, m)| (k, 0.2 * (k * m).sqrt()));
        let six = |a: f64, b: f64| format!("[{a}, {a}, {a}, {b}, {b}, {b}]");
        (
            "outer.support",
            format!(
                "{{ stiffness = {}, damping = {}, mass = {mass}, inertia = [{inertia}, {inertia}, {inertia}] }}",
                six(along.0, around.0),
                six(along.1, around.1)
            ),
        )
    });
    drawn(0.2, &|random| {
        ("load.rotating", format!("[{{ unbalance = {} }}]", random.logarithmic(0.1, 30.0) * size.powi(4)))
    });
    drawn(0.2, &|random| ("load.outer_speed", format!("{}", random.symmetric() * 2.0 / size)));
    // Heat warms from where constants of the growth have it.
    if random.unit() < 0.15 {
        edits.retain(|(key, _)| *key != "growth");
        edits.push(("growth", format!("{{ inner = {}, balls = 5 }}", random.between(-10.0, 20.0))));
        edits.push(("effects.heat_balance", format!("{{ faster = {} }}", random.logarithmic(1.0, 1e3))));
    }
    let scene = Scene::edited(&plain, edits.iter().map(|(key, value)| (*key, value.as_str()))).ok()?;
    Some(scene.into())
}

/// A shaft on two bearings, back to back, with a load that may step; on feet, or in a fixed housing.
fn shaft(random: &mut Random) -> String {
    let mut text = String::from("gravity = [0, 0, -9.81]\n[shaft]\n");
    let speed = random.logarithmic(100.0, 15_000.0);
    let _ = match random.below(3) {
        0 => writeln!(
            text,
            "speed = {{ ramp = [\"{speed} rpm\", \"{} rpm\"], from = 0, to = \"4 ms\" }}",
            1.1 * speed
        ),
        _ => writeln!(text, "speed = \"{speed} rpm\""),
    };
    let bearing = random.pick(&["7206 B", "6206", "7208 B", "6308"]);
    let flexible = random.unit() < 0.3;
    if flexible {
        let thick = random.between(25.0, 30.0);
        let _ = write!(
            text,
            "modes_up_to = \"8 kHz\"\n[[shaft.section]]\nfrom = \"-70 mm\"\nto = \"70 mm\"\nouter_diameter = \"{thick} mm\"\n"
        );
        let _ = write!(
            text,
            "[[shaft.disc]]\nposition = \"10 mm\"\nmass = \"{} kg\"\npolar_inertia = \"1e-3 kg m^2\"\n\
             transverse_inertia = \"6e-4 kg m^2\"\nunbalance = \"{} g mm\"\n",
            random.between(0.2, 2.0),
            random.logarithmic(1.0, 50.0)
        );
    } else {
        let mass = random.logarithmic(0.8, 8.0);
        let _ = writeln!(
            text,
            "mass = {mass}\npolar_inertia = {}\ntransverse_inertia = {}",
            3.3e-4 * mass,
            2.2e-3 * mass
        );
    }
    let force = random.logarithmic(50.0, 2000.0);
    let across = match random.below(3) {
        0 => format!("[[0, {force}], [\"2 ms\", {force}], [\"2.2 ms\", {}]]", 0.3 * force),
        _ => format!("{force}"),
    };
    let _ = write!(
        text,
        "[[shaft.load]]\nname = \"mesh\"\nposition = \"{} mm\"\nforce = [{}, 0, {across}]\n",
        random.between(-30.0, 30.0),
        0.2 * force * random.symmetric()
    );
    let housing = random.unit() < 0.4;
    if housing {
        text.push_str(
            "[[housing]]\nname = \"case\"\nmass = 12\ninertia = [0.06, 0.08, 0.08]\ncentre = [0, 0, \"-20 mm\"]\n",
        );
        let stiff = random.logarithmic(2e7, 2e8);
        for [x, y] in [[-80, -90], [-80, 90], [80, -90], [80, 90]] {
            let _ = write!(
                text,
                "[[housing.foot]]\nposition = [\"{x} mm\", \"{y} mm\", \"-100 mm\"]\nstiffness = [{stiff}, {stiff}, {}]\n\
                 damping = [2000, 2000, 4000]\n",
                2.0 * stiff
            );
        }
    }
    let preload = random.logarithmic(200.0, 2000.0);
    let oil = random.unit() < 0.5;
    for (name, position, direction) in [("left", "-50 mm", "+x"), ("right", "50 mm", "-x")] {
        let inside = if housing { "housing = \"case\", " } else { "" };
        let _ = write!(
            text,
            "[[bearing]]\nname = \"{name}\"\ncatalogue = \"{bearing}\"\nmounting = {{ position = \"{position}\", \
             direction = \"{direction}\", {inside}preload = {{ force = {preload} }} }}\n"
        );
        if oil {
            text.push_str("[bearing.set]\nfilm = { iso_vg = 68, temperature = \"60 degC\" }\n");
        }
    }
    text.push_str("[load]\nduration = \"5 ms\"\noutput_interval = \"100 us\"\n");
    text
}
