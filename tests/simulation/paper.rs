//! The run of section 5 of the paper (Bovet and others 2013): its start, its two laws, its oscillation; and which bearing would lose what
//! it says. Its figures 6 (dimensions) and 7 (history) are not available as numbers. Writes a table of docs/creep-laws.md.

use roulement::effects::reports::ContactOutput;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

use crate::tables::{compare, count, row};

const PAPER: &str = include_str!("../../scenes/paper.toml");
/// \[W] power of a ball's contact with the inner and the outer race in the paper.
const POWERS: [f64; 2] = [0.074, 0.003];

fn scene(changes: &[(&str, &str)]) -> Scene {
    Scene::edited(PAPER, changes.iter().copied()).unwrap_or_else(|why| panic!("{why}"))
}

/// Axial places of the inner race \[m] at every microsecond between two times \[us].
fn places(simulation: &mut Simulation, from: u32, to: u32) -> Vec<f64> {
    (from..to)
        .map(|time| {
            simulation.advance_scripted(1e-6 * f64::from(time)).unwrap();
            simulation.outputs().inner.pose.position.x
        })
        .collect()
}

/// \[s] mean time between rises through the mean, and half the swing \[m].
fn swing(places: &[f64]) -> (f64, f64) {
    let mean = places.iter().sum::<f64>() / places.len() as f64;
    let rises: Vec<f64> = places
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < mean && pair[1] >= mean)
        .map(|(i, pair)| i as f64 + (mean - pair[0]) / (pair[1] - pair[0]))
        .collect();
    let [low, high] = [f64::min, f64::max].map(|of| places.iter().copied().fold(mean, of));
    (1e-6 * (rises[rises.len() - 1] - rises[0]) / (rises.len() - 1) as f64, 0.5 * (high - low))
}

#[test]
fn closed_form_the_paper_s_run_swings_on_the_springs_of_its_contacts() {
    let scene = scene(&[]);
    let mut simulation = Simulation::new(&scene).unwrap();
    let begin = places(&mut simulation, 1, 2000);
    let end = places(&mut simulation, 2000, 4000);
    // One mass on the slope of the force: the race, and balls that go along by half and roll as they do, on their flank at the angle of contact.
    let at = |force: f64| {
        let scene = self::scene(&[("load.x.force", &force.to_string())]);
        Simulation::new(&scene).unwrap().outputs().inner.pose.position.x
    };
    let stiffness = 20.0 / (at(1510.0) - at(1490.0));
    let ball = 7800.0 * std::f64::consts::PI / 6.0 * 9.525e-3f64.powi(3);
    let angle = simulation.outputs().balls[0].inner.contact_angle;
    let mass = 0.2 + 10.0 * ball / 4.0 * (1.0 + 0.4 * angle.cos().powi(2));
    let expected = std::f64::consts::TAU * (mass / stiffness).sqrt();
    let [(first, wide), (second, narrow)] = [swing(&begin), swing(&end)];
    println!("periods {first:.3e}, {second:.3e} s for {expected:.3e}; swings {wide:.2e}, {narrow:.2e} m");
    for period in [first, second] {
        assert!((period / expected - 1.0).abs() < 0.01, "{period} for {expected}");
    }
    // As the paper says: the amplitude slightly decreases, every ball behaves alike, and the inner contact loses more.
    assert!(narrow < 0.95 * wide && narrow > 0.5 * wide, "{wide} {narrow}");
    let balls = &simulation.outputs().balls;
    for ball in balls.iter() {
        assert!((ball.inner.load / balls[0].inner.load - 1.0).abs() < 1e-8);
    }
    assert!(balls[0].inner.power > balls[0].outer.power);
    // With its steps no residual is left over its limit.
    assert_eq!(simulation.state().statistics.rejected_newton, 0);
}

#[test]
fn invariant_the_paper_s_change_of_laws_brings_lateral_creepage() {
    let mut first = Simulation::new(&scene(&[])).unwrap();
    first.advance_scripted(2e-3).unwrap();
    let mut then = Simulation::new(&scene(&[("effects.creep", "\"kalker_table\"")])).unwrap();
    assert!(then.restore(&first.snapshot()));
    let contact = |simulation: &Simulation| -> ContactOutput { simulation.outputs().balls[0].inner };
    let (simple, kalker) = (contact(&first), contact(&then));
    // The same motion, another law, in which spin makes a lateral force.
    assert_eq!(simple.creepage_spin, kalker.creepage_spin);
    assert!(kalker.force_lateral.abs() > 5.0 * simple.force_lateral.abs(), "{simple:?} {kalker:?}");
    // Lateral creepage follows within a period, where without the change it stays as it was; a force of spin alone is left.
    let before = simple.creepage_lateral;
    first.advance_scripted(2.3e-3).unwrap();
    then.advance_scripted(2.3e-3).unwrap();
    let [simple, kalker] = [&first, &then].map(contact);
    let change = |of: &ContactOutput| (of.creepage_lateral - before).abs();
    assert!(change(&kalker) > 5.0 * change(&simple), "{before}: {simple:?} {kalker:?}");
}

/// A bearing: ball and pitch diameter [mm], contact angle \[deg], conformities of the inner and the outer race.
#[derive(Clone, Copy, Debug)]
struct Tried {
    ball: f64,
    pitch: f64,
    angle: f64,
    conformities: [f64; 2],
}

impl Tried {
    /// As many balls as fill nine tenths of the pitch circle.
    fn balls(&self) -> usize {
        (0.9 * std::f64::consts::PI / (self.ball / self.pitch).asin()) as usize
    }

    /// \[W] power of a ball at both races with Kalker's theory: as soon as it rolls with all spin on the inner race, or settled, with the
    /// moments of friction in balance. Nothing of bearings that are no bearing under this load.
    fn powers(&self, settled: bool) -> Option<[f64; 2]> {
        let changes = [
            ("bearing.balls", self.balls().to_string()),
            ("bearing.ball_diameter", format!("\"{} mm\"", self.ball)),
            ("bearing.pitch_diameter", format!("\"{} mm\"", self.pitch)),
            ("bearing.contact_angle", format!("\"{} deg\"", self.angle)),
            ("bearing.inner_conformity", self.conformities[0].to_string()),
            ("bearing.outer_conformity", self.conformities[1].to_string()),
            ("effects.creep", "\"kalker_table\"".into()),
            ("start.spin_balance", settled.to_string()),
        ];
        let scene = Scene::edited(PAPER, changes).ok()?;
        let simulation = Simulation::new(&scene).ok()?;
        let ball = &simulation.outputs().balls[0];
        let contacts = [&ball.inner, &ball.outer];
        let bears =
            contacts.iter().all(|contact| contact.peak_pressure < 4.2e9 && contact.shoulder_margin > 0.0);
        bears.then(|| contacts.map(|contact| contact.power))
    }
}

/// Bearings of all sizes, angles and grooves of a grid.
fn grid() -> Vec<Tried> {
    let mut tried = vec![];
    for ball in [2.3812, 3.175, 4.7625, 6.35, 7.9375, 9.525, 12.7, 19.05] {
        for pitch in [30.0, 46.0, 70.0, 100.0, 150.0] {
            for angle in [15.0, 25.0, 40.0, 60.0] {
                for inner in [0.505, 0.515, 0.53, 0.55, 0.6] {
                    for outer in [0.505, 0.515, 0.53, 0.55, 0.6] {
                        if pitch > 3.0 * ball {
                            tried.push(Tried { ball, pitch, angle, conformities: [inner, outer] });
                        }
                    }
                }
            }
        }
    }
    tried
}

#[test]
#[ignore = "a minute: 6000 starts of bearings (scripts/soak)"]
fn regression_which_bearings_would_lose_what_the_paper_says() {
    let grid = grid();
    // As soon as balls roll, the outer race loses nothing yet.
    let away = |powers: &[f64; 2], races: usize| -> f64 {
        let far = powers.iter().zip(POWERS).map(|(ours, theirs)| (ours / theirs).ln().powi(2));
        far.take(races).sum::<f64>().sqrt()
    };
    let rows: Vec<_> = [(false, "rolling"), (true, "settled")]
        .into_iter()
        .flat_map(|(settled, words)| {
            let half = grid.len().div_ceil(2);
            let mut found: Vec<(Tried, [f64; 2])> = std::thread::scope(|scope| {
                let jobs: Vec<_> = grid
                    .chunks(half)
                    .map(|part| {
                        scope.spawn(move || -> Vec<_> {
                            part.iter().filter_map(|tried| Some((*tried, tried.powers(settled)?))).collect()
                        })
                    })
                    .collect();
                jobs.into_iter().flat_map(|job| job.join().unwrap()).collect()
            });
            println!("{words}: {} of {} bear the load", found.len(), grid.len());
            let races = if settled { 2 } else { 1 };
            found.sort_by(|a, b| away(&a.1, races).total_cmp(&away(&b.1, races)));
            let least = found.iter().copied().min_by(|a, b| (a.1[0] + a.1[1]).total_cmp(&(b.1[0] + b.1[1])));
            let usual = found.iter().copied().find(|(tried, _)| {
                tried.balls() <= 20 && tried.conformities.iter().all(|conformity| *conformity < 0.54)
            });
            // Its grooves do not matter to a race that loses nothing.
            let nearest = found.iter().take(if settled { 3 } else { 1 }).copied().map(|of| ("nearest", of));
            let others = [("nearest of up to 20 balls, grooves up to 0.53", usual), ("least of all", least)];
            let others = others.into_iter().filter_map(|(what, of)| Some((what, of?)));
            let line = |(what, (tried, powers)): (&str, (Tried, [f64; 2]))| {
                let words = format!(
                    "{words} | {what} | {} | {} x {} | {} | {} / {}",
                    tried.pitch,
                    tried.balls(),
                    tried.ball,
                    tried.angle,
                    tried.conformities[0],
                    tried.conformities[1]
                );
                row(words, powers.map(|power| count(1e3 * power, 1)).into(), "")
            };
            nearest.chain(others).map(line).collect::<Vec<_>>()
        })
        .collect();
    let header =
        "balls | which | pitch [mm] | balls [mm] | angle [deg] | conformities | inner / outer [mW a ball]";
    compare("docs/creep-laws.md", "search", header, &rows);
}
