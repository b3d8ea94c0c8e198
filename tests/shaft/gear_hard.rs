//! Hard cases of gears: rattle, a run-up through a resonance of the teeth, a start from rest, loss of oil, a preload that is lost, many bearings. Each runs twice, to the same bits.

use std::f64::consts::TAU;

use roulement::simulation::Simulation;
use roulement::simulation::system::System;

use crate::common::{LIGHT, MODULE, gear_pair, imbalance, stored, system, train};

/// Nothing but their turns moves; so large that the balls, which go round with the shaft, add nothing to it.
const HEAVY: &str = "mass = 1e6\npolar_inertia = 1e-2\ntransverse_inertia = 1e6";
/// Teeth of the pair.
const TEETH: [f64; 2] = [20.0, 40.0];

/// \[m] base radii of the spur pair.
fn bases() -> [f64; 2] {
    TEETH.map(|teeth| 0.5 * MODULE * teeth * 20f64.to_radians().cos())
}

/// Two outside gears: keys of the first shaft, of the second, of the mesh; helix angle \[deg], and keys of both shafts.
fn pair(keys: [&str; 3], helix: f64, masses: &str) -> String {
    gear_pair(keys, masses, false, helix, [1.0, 0.0])
}

/// What a machine shows in rows to its end \[s]: it comes there, to the same bits when it runs once more, and no energy is made or lost beyond 1 % of what
/// went through a shaft.
fn gates<T>(text: &str, end: f64, rows: u32, show: impl Fn(&System) -> T) -> Vec<T> {
    let run = || {
        let mut machine = system(text);
        let before = stored(&machine);
        let mut seen = vec![];
        for row in 1..=rows {
            machine
                .advance(end * f64::from(row) / f64::from(rows))
                .unwrap_or_else(|why| panic!("{row}: {why}"));
            seen.push(show(&machine));
        }
        (machine, before, seen)
    };
    let (machine, before, seen) = run();
    let (again, ..) = run();
    assert_eq!(machine.outputs(), again.outputs());
    let bits = |machine: &System| serde_json::to_vec(&machine.snapshot()).unwrap();
    assert!(bits(&machine) == bits(&again), "another run has other bits");

    let outputs = machine.outputs();
    let through = outputs.shafts.iter().map(|shaft| shaft.energies.turned_over()).fold(0.0, f64::max);
    let of_shafts = outputs.shafts.iter().map(|shaft| shaft.energies.unaccounted());
    let of_links = outputs.links.iter().map(|link| link.state.unaccounted());
    for open in of_shafts.chain(of_links) {
        assert!(open.abs() < 1e-2 * through, "{open:e} of {through:e}");
    }
    assert!(outputs.links.iter().all(|link| link.state.damped >= 0.0));
    let [_, of_bearings] = imbalance(&machine, &before);
    assert!(of_bearings < 1e-2, "{of_bearings:e}");
    seen
}

/// \[N] normal force of the first mesh.
fn normal(machine: &System) -> f64 {
    machine.outputs().links[0].teeth.normal_force
}

/// A drive that swings holds its gear against a drag torque on the other as long as this gives the other gear's inertia more than it asks for.
#[test]
fn hard_case_closed_form_a_gear_rattles_where_its_inertia_asks_for_more_than_its_drag() {
    let (drag, frequency) = (1.0, 200.0);
    // Acceleration of the first gear at which that of the second one, half as fast, takes the drag torque.
    let threshold = 2.0 * drag / 1e-2;
    let run = |part: f64, drag: f64| {
        let amplitude = part * threshold / (TAU * frequency);
        let speed =
            format!("speed = {{ mean = 100, amplitude = {amplitude}, frequency = \"{frequency} Hz\" }}");
        let keys = [&speed, &format!("torque = {drag}"), "backlash = \"40 um\"\ndamping_ratio = 0.3"];
        gates(&pair([keys[0], keys[1], keys[2]], 0.0, HEAVY), 15e-3, 600, normal)
    };
    let held = run(0.5, drag);
    let mean = drag / bases()[1];
    let swing = held.iter().skip(200).map(|force| (force / mean - 1.0).abs()).fold(0.0, f64::max);
    assert!(held.iter().all(|force| *force > 0.0) && (swing / 0.5 - 1.0).abs() < 0.05, "{swing}");

    let free = run(1.5, drag).iter().filter(|force| **force == 0.0).count();
    assert!(free > 100, "{free}");

    // Without load: from flank to flank, as the drive swings by 36 um at the teeth, half as much as their play allows.
    let idle = run(15.0, 0.0);
    let on = |sign: f64| idle.iter().filter(|force| **force * sign > 0.0).count();
    let [one, other, none] = [on(1.0), on(-1.0), 600 - on(1.0) - on(-1.0)];
    println!("{one} rows on one flank, {other} on the other, {none} on none");
    assert!(one > 3 && other > 3 && none > 100, "{one} {none} {other}");
}

/// The swing of the second gear against the first, whose speed grows, by fine steps of Runge and Kutta: normal forces at the times of the rows.
fn finely(of: &Passage, rows: u32) -> Vec<f64> {
    let [base_1, base_2] = bases();
    let mobility = (base_1 * base_1 + base_2 * base_2) / 1e-2;
    let damping = 2.0 * of.damping_ratio * (of.stiffness / mobility).sqrt();
    let force = |time: f64, [x, v]: [f64; 2]| {
        let angle = of.from * time + 0.5 * of.gain * time * time;
        of.stiffness * (1.0 + of.varies * (TEETH[0] * angle).sin()) * x + damping * v
    };
    let slope = |time: f64, at: [f64; 2]| {
        let torque = of.torque - base_2 * force(time, at);
        [at[1], base_2 * (torque / 1e-2 + 0.5 * of.gain)]
    };
    let step = 2e-7;
    let mut at = [of.torque / base_2 / of.stiffness, 0.0];
    let count = (of.end / step).round() as u32;
    let mut seen = vec![];
    for n in 0..count {
        let time = f64::from(n) * step;
        let along = |k: [f64; 2], h: f64| [at[0] + h * k[0], at[1] + h * k[1]];
        let a = slope(time, at);
        let b = slope(time + 0.5 * step, along(a, 0.5 * step));
        let c = slope(time + 0.5 * step, along(b, 0.5 * step));
        let d = slope(time + step, along(c, step));
        at = [0, 1].map(|i| at[i] + step / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
        if (n + 1) % (count / rows) == 0 {
            seen.push(force(time + step, at));
        }
    }
    seen
}

/// A run-up of the pair.
struct Passage {
    /// [rad/s] speed of the first gear at the start, and [rad/s2] its growth.
    from: f64,
    gain: f64,
    /// \[s] its end.
    end: f64,
    torque: f64,
    stiffness: f64,
    varies: f64,
    damping_ratio: f64,
}

#[test]
fn hard_case_independent_a_run_up_through_a_resonance_of_the_teeth_is_that_of_a_fine_integration() {
    let of = Passage {
        from: 220.0,
        gain: 2500.0,
        end: 40e-3,
        torque: 30.0,
        stiffness: 2e8,
        varies: 0.05,
        damping_ratio: 0.03,
    };
    // Twenty teeth pass the own frequency of the second gear on the way.
    let natural = bases()[1] * (of.stiffness / 1e-2).sqrt() / TEETH[0];
    assert!(of.from < 0.9 * natural && of.from + of.gain * of.end > 1.1 * natural, "{natural}");
    let speed = format!("speed = [[0, {}], [{}, {}]]", of.from, of.end, of.from + of.gain * of.end);
    let mesh = format!(
        "stiffness = {:e}\ndamping_ratio = {}\nbacklash = \"50 um\"\n\
         stiffness_variation = [{{ amplitude = {}, phase = \"90 deg\" }}]",
        of.stiffness, of.damping_ratio, of.varies
    );
    let keys = [&speed, &format!("torque = {}", of.torque), mesh.as_str()];
    let found = gates(&pair([keys[0], keys[1], keys[2]], 0.0, HEAVY), of.end, 1000, normal);
    let exact = finely(&of, 1000);
    assert_eq!(found.len(), exact.len());
    // What brakes the second gear, and what its inertia takes.
    let mean = (of.torque + 0.5 * of.gain * 1e-2) / bases()[1];
    let swing = |forces: &[f64]| forces.iter().map(|force| force - mean).fold(0.0, f64::max);
    let [own, fine] = [&found, &exact].map(|forces| swing(forces));
    // It is passed: the largest swing is far above that of the start, and gone at the end.
    let [early, late] = [&exact[..100], &exact[900..]].map(swing);
    let apart = found.iter().zip(&exact).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    println!(
        "swing {own:.2} N, finely {fine:.2} N, early {early:.2} N, late {late:.2} N, apart {apart:.2} N"
    );
    assert!(fine > 1.5 * early && fine > 1.5 * late, "{early} {fine} {late}");
    assert!((own / fine - 1.0).abs() < 0.02, "{own} {fine}");
    assert!(apart < 0.02 * (mean + fine), "{apart} {fine}");
}

#[test]
fn hard_case_closed_form_a_train_that_starts_from_rest_gains_speed_by_its_inertias() {
    let keys = ["torque = 20\nstart_speed = 0", "", "damping_ratio = 0.2"];
    let rows = gates(&pair(keys, 20.0, LIGHT), 5e-3, 200, |machine| {
        let speeds = [0, 1].map(|shaft| machine.outputs().shafts[shaft].spin.speed);
        (speeds, normal(machine))
    });
    // Balls and their friction take less than 2 %.
    let inertia = 1e-3 * (1.0 + 0.25);
    let expected = 20.0 / inertia * 5e-3;
    let ([one, other], _) = rows[199];
    assert!((one / expected - 1.0).abs() < 0.02, "{one} {expected}");
    assert!((other / one + 0.5).abs() < 2e-3, "{other} {one}");
    // The teeth pass on what the second gear's inertia takes.
    let helix = 20f64.to_radians();
    let transverse = (20f64.to_radians().tan() / helix.cos()).atan();
    let base_helix = (helix.sin() * 20f64.to_radians().cos()).asin();
    let base = 0.5 * MODULE * TEETH[1] / helix.cos() * transverse.cos() * base_helix.cos();
    let force = 1e-3 * 0.5 * 20.0 / inertia / base;
    let mean = rows[100..].iter().map(|(_, normal)| normal).sum::<f64>() / 100.0;
    assert!((mean / force - 1.0).abs() < 0.03, "{mean} {force}");
}

#[test]
fn hard_case_a_gear_pair_that_loses_its_oil_goes_on_under_the_same_forces() {
    let oil = "film = { iso_vg = 68, temperature = 70.0, lubrication = [[0.0, 1.0], [0.001, 1.0], [0.0015, 0.0]] }\n\
               friction = { ball_race = 0.2 }";
    let text = pair(["speed = \"3000 rpm\"", "torque = 30", "damping_ratio = 0.2"], 20.0, LIGHT);
    let text = text.replace("heathcote_slip = false }\n", &format!("heathcote_slip = false }}\n{oil}\n"));
    let rows = gates(&text, 4e-3, 160, |machine| {
        let lubricated = machine.bearings().map(|(_, bearing)| {
            bearing.outputs().balls.iter().map(|ball| ball.inner.film.ratio).fold(0.0, f64::max)
        });
        (lubricated.collect::<Vec<_>>(), normal(machine), machine.outputs().shafts[0].torque)
    });
    assert!(rows[30].0.iter().all(|ratio| *ratio > 0.5), "{:?}", rows[30].0);
    assert!(rows[159].0.iter().all(|ratio| *ratio == 0.0), "{:?}", rows[159].0);
    let mean = |rows: &[(Vec<f64>, f64, f64)], get: fn(&(Vec<f64>, f64, f64)) -> f64| {
        rows.iter().map(get).sum::<f64>() / rows.len() as f64
    };
    let [oiled, dry] = [&rows[20..40], &rows[120..160]];
    let [before, after] = [oiled, dry].map(|rows| mean(rows, |row| row.1));
    assert!((after / before - 1.0).abs() < 0.01, "{before} {after}");
    // What drives it is the torque that is passed on, and friction.
    let [before, after] = [oiled, dry].map(|rows| mean(rows, |row| row.2));
    assert!(before > 15.0 && after > 15.0 && after != before, "{before} {after}");
}

#[test]
fn hard_case_a_thrust_takes_the_preload_off_one_bearing_and_gives_it_back() {
    let thrust = "[[shaft.load]]\nname = \"thrust\"\nposition = 0\n\
                  force = [[[0, 0], [\"0.5 ms\", 0], [\"3 ms\", 1500], [\"4 ms\", 1500], [\"6.5 ms\", 0]], 0, 0]\n[[mesh]]";
    let text = pair(["speed = \"300 rpm\"", "torque = 1", "damping_ratio = 0.2"], 20.0, LIGHT);
    let rows = gates(&text.replace("[[mesh]]", thrust), 8e-3, 160, |machine| {
        let loads =
            |bearing: &Simulation| bearing.outputs().balls.iter().map(|ball| ball.inner.load).sum::<f64>();
        machine.bearings().map(|(_, bearing)| loads(bearing)).collect::<Vec<f64>>()
    });
    // Loads of the balls of both bearings on the second shaft, while the thrust acts, and after that, over those before.
    let mean =
        |index: usize, rows: &[Vec<f64>]| rows.iter().map(|row| row[index]).sum::<f64>() / rows.len() as f64;
    let [lost, back] = [&rows[60..80], &rows[130..]]
        .map(|later| [2, 3].map(|index| mean(index, later) / mean(index, &rows[..10])));
    println!("{lost:?} {back:?}");
    assert!(lost[0].min(lost[1]) < 0.05 && lost[0].max(lost[1]) > 2.0, "{lost:?}");
    assert!(back.iter().all(|part| (part - 1.0).abs() < 0.15), "{back:?}");
}

#[test]
fn hard_case_twenty_bearings_and_nine_meshes_pass_on_their_torque() {
    let forces = |machine: &System| {
        machine.outputs().links.iter().map(|link| link.teeth.normal_force.abs()).collect::<Vec<_>>()
    };
    let rows = gates(&train(10), 1e-3, 50, forces);
    let expected = 20.0 / (0.03 * 20f64.to_radians().cos());
    for mesh in 0..9 {
        let mean = rows[25..].iter().map(|row| row[mesh]).sum::<f64>() / 25.0;
        assert!((mean / expected - 1.0).abs() < 0.02, "{mesh}: {mean} {expected}");
    }
}
