//! The cage: struck by its balls, whirling, with hardly any and with huge clearance, started from rest, standing.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use roulement::model::bodies::Body;
use roulement::simulation::Simulation;
use roulement::simulation::inputs::Inputs;
use roulement::simulation::outputs::{BallOutput, CageOutput, Outputs, PocketOutput};

use crate::gates::{Case, Run, limits};
use crate::scenes::{CAGE, ROLLING_START, load, ramp, scene};

/// Thrust and radial load.
const COMBINED: &str = "x = { force = 1500.0 }\nz = { force = -300.0 }\n";
/// Nothing rubs: only normal forces between balls and cage change a motion about the bearing axis.
const SLIPPERY: &str = "[friction]\nball_race = 0.0\nball_cage = 0.0\ncage_race = 0.0\n";

/// Section `[cage]` on lands of the outer race, with diametral clearances [mm] of pockets and lands and their damping
/// [s/m].
fn on_lands(pocket: f64, land: f64, damping: f64) -> String {
    section(pocket, damping, &format!("guided_by = \"outer\"\nguidance_clearance = \"{land} mm\"\n{LANDS}"))
}

const LANDS: &str = "land_diameter = \"52 mm\"\nland_width = \"2 mm\"";

fn section(pocket: f64, damping: f64, guide: &str) -> String {
    format!(
        "[cage]\nmass = \"20 g\"\ninertia = [1.1e-5, 6e-6, 6e-6]\npocket_clearance = \"{pocket} mm\"\n{guide}\n\
         youngs_modulus = \"105 GPa\"\npoisson_ratio = 0.35\ndamping = {damping}\n"
    )
}

/// A hundredth of the tolerance that other scenes with steps of their own have, for blows that all the rest follows from.
const SHARP: &str = "[solver]\ninitial_step = \"1 us\"\nmax_step = \"10 us\"\ntolerance = 1e-8\n";

const WEIGHTLESS: &str = "[effects]\ncreep = \"saturated\"\ndamping = \"0.02 s/m\"\ncage = true\n";

fn cage(outputs: &Outputs) -> &CageOutput {
    outputs.cage.as_ref().unwrap()
}

fn pockets(outputs: &Outputs) -> impl Iterator<Item = PocketOutput> + '_ {
    outputs.balls.iter().map(|ball| ball.pocket.unwrap())
}

/// [m] deepest approach of any ball in its pocket.
fn deepest_pocket(run: &Run) -> f64 {
    run.history.iter().flat_map(pockets).map(|pocket| pocket.approach).fold(f64::NEG_INFINITY, f64::max)
}

/// [m] deepest approach of the lands.
fn deepest_land(run: &Run) -> f64 {
    run.history.iter().map(|o| cage(o).land_approach).fold(f64::NEG_INFINITY, f64::max)
}

/// Times that a ball begins or ceases to touch its pocket, as far as communication points show.
fn changes(run: &Run) -> usize {
    let touched = |o: &Outputs, j: usize| o.balls[j].pocket.unwrap().load > 0.0;
    (0..run.history[0].balls.len())
        .map(|j| run.history.windows(2).filter(|w| touched(&w[0], j) != touched(&w[1], j)).count())
        .sum()
}

/// Angular momentum of balls and cage about the axis [kg m2/s].
fn momentum(run: &Run, o: &Outputs) -> f64 {
    let model = run.simulation.model();
    let (mass, inertia) =
        (model.bearing.ball.mass, model.bodies.get(Body::Cage).unwrap().as_ref().unwrap().inertia.x);
    let orbit = |ball: &BallOutput| mass * ball.orbital_speed * ball.position.yz().norm_squared();
    o.balls.iter().map(orbit).sum::<f64>() + inertia * o.cage_speed
}

#[test]
fn balls_strike_their_pockets() {
    // Balls slower than the cage, and no friction: the cage runs into all of them at once.
    let rows = "x = { force = 1500.0 }\noutput_interval = \"5 us\"\n";
    let case = |damping: f64| {
        let start = "[start]\norbital_speed = 200.0\n";
        let changes = load(1.0, 6000.0, rows) + SLIPPERY + start + SHARP + &on_lands(0.2, 0.2, damping);
        let name = "balls strike the cage at 1.3 m/s";
        let mut case = Case::new(name, scene(CAGE, &changes), limits(1500, 40, 10, 4.0));
        case.window = [0.0, 1.0];
        case
    };
    let damped = case(0.5).pass();
    let undamped = {
        let case = case(0.0);
        case.run(&case.scene, |_, _| {})
    };
    for run in [&damped, &undamped] {
        // Nothing acts about the axis from outside: angular momentum stays what it was.
        let first = momentum(run, &run.history[0]);
        for o in &run.history {
            assert!((momentum(run, o) / first - 1.0).abs() < 1e-5, "{} at {} s", momentum(run, o), o.time);
        }
        // One ball takes at most the energy that all of them bring.
        let model = run.simulation.model();
        let pocket = &model.cage.as_ref().unwrap().pocket;
        let speed = (run.history[0].cage_speed - 200.0) * 23e-3;
        let energy = pocket.elastic_energy(deepest_pocket(run));
        assert!(energy > 0.0 && energy < 0.5 * 0.02 * speed * speed, "{energy} J");
        assert!(changes(run) >= 20, "{} changes of contact", changes(run));
    }
    // Without damping the blows neither gain energy nor lose much; with it they die out.
    let energy = |o: &Outputs| o.stored_energy - o.work;
    let begin = energy(&undamped.history[0]);
    assert!(undamped.history.iter().all(|o| energy(o) <= begin * (1.0 + 1e-9)));
    let spread = |run: &Run| {
        let o = run.last();
        o.balls.iter().map(|b| (b.orbital_speed - o.cage_speed).abs()).fold(0.0, f64::max)
    };
    assert!(spread(&damped) < 0.2 * spread(&undamped), "{} {}", spread(&damped), spread(&undamped));
}

#[test]
fn balls_braked_below_the_cage() {
    let speed = "[[0.0, \"6000 rpm\"], [0.001, \"6000 rpm\"], [0.003, \"3000 rpm\"]]";
    let scene = scene(CAGE, &ramp(15.0, speed, COMBINED));
    let run = Case::new("balls braked below the cage in 2 ms", scene, limits(4000, 40, 40, 4.0)).pass();
    assert!(changes(&run) >= 20, "{} changes of contact", changes(&run));
    assert!(deepest_pocket(&run) > 0.0 && deepest_pocket(&run) < 10e-6, "{}", deepest_pocket(&run));
    assert!(run.last().cage_slip.abs() < 0.03, "{}", run.last().cage_slip);
}

/// [rad/s] mean whirl speed of the cage's centre, over the second half.
fn whirl_speed(run: &Run) -> f64 {
    let late = &run.history[run.history.len() / 2..];
    let angle = |o: &Outputs| cage(o).eccentricity.z.atan2(cage(o).eccentricity.y);
    let turned: f64 = late
        .windows(2)
        .map(|pair| {
            let step = angle(&pair[1]) - angle(&pair[0]);
            step - TAU * (step / TAU).round()
        })
        .sum();
    turned / (late[late.len() - 1].time - late[0].time)
}

#[test]
fn whirl() {
    // A rotating load takes along the pattern of fast and slow balls, and with it the cage.
    let inner = "guided_by = \"inner\"\nguidance_clearance = \"0.2 mm\"\n\
                 land_diameter = \"40 mm\"\nland_width = \"2 mm\"";
    for (name, section, speed) in [
        ("cage whirls on outer lands at 300 rad/s", on_lands(0.2, 0.2, 0.5), 300.0),
        ("cage whirls on inner lands at 128 rad/s", section(0.2, 0.5, inner), 128.0),
    ] {
        let importer = |simulation: &Simulation, point: u32| -> (Inputs, f64) {
            let time = simulation.time();
            let mut inputs = simulation.scripted_inputs(time);
            let (sin, cos) = (speed * time).sin_cos();
            inputs.inner.applied.force = Vector3::new(1500.0, 300.0 * cos, 300.0 * sin);
            (inputs, f64::from(point + 1) * 1e-4)
        };
        let rows = "x = { force = 1500.0 }\ny = { force = 300.0 }\n";
        let changes = load(20.0, 6000.0, rows) + WEIGHTLESS + &section + ROLLING_START;
        let mut case = Case::new(name, scene(CAGE, &changes), limits(2300, 20, 10, 4.0));
        case.importer = Some(&importer);
        let run = case.pass();
        // The cage whirls with the load, as far out as the lands let it.
        let whirl = whirl_speed(&run);
        assert!((whirl / speed - 1.0).abs() < 0.05, "{name}: {whirl} rad/s");
        for o in &run.history[run.history.len() / 2..] {
            let radius = cage(o).eccentricity.yz().norm();
            assert!((radius / 0.1e-3 - 1.0).abs() < 0.05, "{name}: {radius} m");
        }
        let rubbing = run.history.iter().filter(|o| cage(o).land_power > 0.0).count();
        assert!(rubbing > 20, "{name}: the lands rub at {rubbing} points");
    }
}

#[test]
fn clearances() {
    for (name, pocket, land, damping, limit) in [
        ("cage with clearances of 48 um and 10 um", 0.048, 0.01, 0.5, limits(2300, 10, 10, 3.0)),
        ("cage with clearances of 4.5 mm and 2 mm", 4.5, 2.0, 10.0, limits(2300, 10, 10, 3.0)),
    ] {
        let sections = load(20.0, 6000.0, COMBINED) + &on_lands(pocket, land, damping);
        let mut case = Case::new(name, scene(CAGE, &sections), limit);
        case.window = [0.0, 1.0];
        let run = case.pass();
        // It stays within its play.
        let (in_pocket, on_land) = (deepest_pocket(&run), deepest_land(&run));
        assert!(in_pocket < 3e-6 && on_land < 3e-6, "{name}: {in_pocket} m, {on_land} m");
        if pocket < 0.1 {
            // Without play the cage turns as fast as the balls on the mean.
            assert!(run.last().cage_slip.abs() < 0.01, "{name}: {}", run.last().cage_slip);
            assert!(changes(&run) > 20, "{name}: {} changes of contact", changes(&run));
        } else {
            // It falls freely until it lands.
            for o in run.history.iter().filter(|o| o.time < 0.014) {
                let fallen = cage(o).eccentricity.z + 0.5 * 9.81 * o.time * o.time;
                assert!(fallen.abs() < 1e-9, "{name}: {fallen} m at {} s", o.time);
            }
            assert!(on_land > 0.0);
        }
    }
}

#[test]
fn from_rest() {
    let speed = "[[0.0, 0.0], [0.012, \"6000 rpm\"]]";
    for (name, section) in [
        ("cage on outer lands from rest in 12 ms", on_lands(0.2, 0.2, 0.5)),
        ("cage on the balls from rest in 12 ms", section(0.2, 0.5, "guided_by = \"balls\"")),
    ] {
        // Without lands there is no friction on them.
        let friction = if section.contains("land") { "" } else { "[friction]\nball_cage = 0.05\n" };
        let scene = scene(CAGE, &(ramp(18.0, speed, COMBINED) + &section + friction));
        let run = Case::new(name, scene, limits(2400, 40, 40, 4.0)).pass();
        assert_eq!(run.history[0].cage_speed, 0.0);
        assert!(run.last().cage_slip.abs() < 0.02, "{}", run.last().cage_slip);
        assert!(run.history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated));
        // The balls take it along, one pushing after the other.
        assert!(cage(run.last()).turned > 1.0 && changes(&run) > 20, "{name}");
        assert!(deepest_pocket(&run) < 3e-6, "{name}: {} m", deepest_pocket(&run));
    }
}

#[test]
fn standstill() {
    // The cage falls by its play into pockets and lands.
    // The power of this rattle is that of a few blows: two percent of it want still smaller errors than SHARP.
    let sharper = SHARP.replace("1e-8", "3e-10");
    let scene = scene(CAGE, &(load(40.0, 0.0, COMBINED) + &sharper + &on_lands(0.2, 0.2, 10.0)));
    let mut case = Case::new("cage dropped at standstill", scene, limits(6600, 40, 60, 4.0));
    case.window = [0.0, 1.0];
    let run = case.pass();
    for o in &run.history {
        // What it falls is all that drives it.
        let energy = 0.5 * cage(o).twist.velocity.norm_squared() + 9.81 * cage(o).eccentricity.z;
        assert!(energy < 1e-7, "{energy} J/kg at {} s", o.time);
    }
    assert!(
        cage(run.last()).eccentricity.z < 0.0 && deepest_land(&run) < 3e-6 && deepest_pocket(&run) < 3e-6
    );
}
