//! The cage: struck by its balls, whirling, with hardly any and with huge clearance, started from rest, standing.

use nalgebra::Vector3;
use roulement::outputs::{CageOutput, Outputs, PocketOutput};

use crate::gates::{Case, Run, limits};
use crate::scenes::{CAGE, load, ramp, scene};

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

fn friction(ball_cage: f64, cage_race: f64) -> String {
    format!("[friction]\nball_race = 0.08\nball_cage = {ball_cage}\ncage_race = {cage_race}\n")
}

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

#[test]
fn balls_strike_their_pockets() {
    // Balls a fifth slower than the cage, and no friction: the cage runs into all of them at once.
    let rows = "x = { force = 1500.0 }\noutput_interval = \"20 us\"\n";
    let start = "[start]\norbital_speed = 200.0\n";
    let run = |name: &str, damping: f64, limit| {
        let changes = load(10.0, 6000.0, rows) + SLIPPERY + start + &on_lands(0.2, 0.2, damping);
        Case::new(name, scene(CAGE, &changes), limit).pass()
    };
    for (name, damping, limit) in [
        ("balls strike the cage at 1.4 m/s", 0.5, limits(9000, 60, 60, 3.0)),
        ("the same without damping in the pockets", 0.0, limits(9000, 60, 60, 3.0)),
    ] {
        let run = run(name, damping, limit);
        // Nothing acts about the axis from outside: angular momentum stays what it was.
        let model = run.simulation.model();
        let (mass, inertia) = (model.bearing.ball.mass, model.cage.as_ref().unwrap().body.inertia.x);
        let momentum = |o: &Outputs| {
            let orbit =
                |b: &roulement::outputs::BallOutput| mass * b.orbital_speed * b.position.yz().norm_squared();
            o.balls.iter().map(orbit).sum::<f64>() + inertia * o.cage_speed
        };
        let first = momentum(&run.history[0]);
        for o in &run.history {
            assert!((momentum(o) / first - 1.0).abs() < 1e-4, "{name}: {} at {} s", momentum(o), o.time);
        }
        // One ball takes at most the energy that all of them bring.
        let pocket = &model.cage.as_ref().unwrap().pocket;
        let relative = (run.history[0].cage_speed - 200.0) * 23e-3;
        let energy = pocket.elastic_energy(deepest_pocket(&run));
        assert!(energy > 0.0 && energy < 0.5 * 0.02 * relative * relative, "{name}: {energy} J");
        assert!(changes(&run) >= 20, "{name}: {} changes of contact", changes(&run));
        let spread = |o: &Outputs| {
            o.balls.iter().map(|b| (b.orbital_speed / o.cage_speed - 1.0).abs()).fold(0.0, f64::max)
        };
        if damping > 0.0 {
            // The blows die out, and balls and cage go on together.
            assert!(spread(run.last()) < 0.1 * spread(&run.history[0]), "{name}: {}", spread(run.last()));
        }
    }
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

#[test]
fn whirl() {
    let inner = "guided_by = \"inner\"\nguidance_clearance = \"0.2 mm\"\n\
                 land_diameter = \"40 mm\"\nland_width = \"2 mm\"";
    for (name, section) in [
        ("cage whirls on the outer lands, friction 0.3", on_lands(0.2, 0.2, 0.5)),
        ("cage whirls on the inner lands, friction 0.3", section(0.2, 0.5, inner)),
    ] {
        let scene = scene(CAGE, &(load(60.0, 12_000.0, COMBINED) + &friction(0.05, 0.3) + &section));
        let run = Case::new(name, scene, limits(9000, 60, 60, 4.0)).pass();
        let mut angle = 0.0;
        let at = |o: &Outputs| cage(o).eccentricity.z.atan2(cage(o).eccentricity.y);
        for pair in run.history.windows(2) {
            let step = at(&pair[1]) - at(&pair[0]);
            angle += step - std::f64::consts::TAU * (step / std::f64::consts::TAU).round();
        }
        let last: Vec<f64> = run.history[300..].iter().map(|o| cage(o).eccentricity.yz().norm()).collect();
        println!(
            "{name}: {} turns, ecc {:?}, land {} pocket {}",
            angle / 6.283,
            last.iter().step_by(30).collect::<Vec<_>>(),
            deepest_land(&run),
            deepest_pocket(&run)
        );
    }
}

#[test]
fn clearances() {
    for (name, pocket, land, friction_of_cage, limit) in [
        ("cage with clearances of 48 um and 10 um", 0.048, 0.01, 0.05, limits(9000, 60, 60, 4.0)),
        ("cage with clearances of 4.5 mm and 2 mm", 4.5, 2.0, 0.05, limits(9000, 60, 60, 4.0)),
    ] {
        let changes = load(40.0, 6000.0, COMBINED)
            + &friction(friction_of_cage, friction_of_cage)
            + &on_lands(pocket, land, 0.5);
        let run = Case::new(name, scene(CAGE, &changes), limit).pass();
        println!(
            "{name}: land {} pocket {} slip {} changes {}",
            deepest_land(&run),
            deepest_pocket(&run),
            run.last().cage_slip,
            changes_of(&run)
        );
    }
}
fn changes_of(run: &Run) -> usize {
    changes(run)
}

#[test]
fn from_rest() {
    let speed = "[[0.0, 0.0], [0.02, \"6000 rpm\"]]";
    for (name, section) in [
        ("cage on outer lands from rest in 20 ms", on_lands(0.2, 0.2, 0.5)),
        ("cage on the balls from rest in 20 ms", section(0.2, 0.5, "guided_by = \"balls\"")),
    ] {
        let friction =
            if name.contains("balls") { "[friction]\nball_race = 0.08\nball_cage = 0.05\n" } else { "" };
        let scene = scene(CAGE, &(ramp(30.0, speed, COMBINED) + &section + friction));
        let run = Case::new(name, scene, limits(4000, 40, 40, 4.0)).pass();
        assert_eq!(run.history[0].cage_speed, 0.0);
        assert!(run.last().cage_slip.abs() < 0.02, "{}", run.last().cage_slip);
        assert!(run.history.windows(2).all(|pair| pair[1].dissipated >= pair[0].dissipated));
        println!(
            "{name}: land {} pocket {} slip {} changes {}",
            deepest_land(&run),
            deepest_pocket(&run),
            run.last().cage_slip,
            changes(&run)
        );
    }
}

#[test]
fn standstill() {
    // The cage falls by its play and comes to rest.
    let scene = scene(CAGE, &load(60.0, 0.0, COMBINED));
    let run = Case::new("cage dropped at standstill", scene, limits(9000, 60, 60, 4.0)).pass();
    let weight = 0.02 * 9.81;
    let last = cage(run.last());
    let carried: Vector3<f64> = last.pocket_force + last.land_force;
    println!("cage at rest: {last:?} {carried:?} {weight}");
}
