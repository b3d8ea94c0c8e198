//! The paper's comparison of creep laws (section 5, figure 7) on the settled thrust case, and the default law at other contact
//! angles: two tables for docs/creep-laws.md. `scripts/laws` writes them there.

use std::error::Error;

use cpu_time::ThreadTime;
use roulement::effects::reports::{BallOutput, ContactOutput};
use roulement::scene::Scene;
use roulement::simulation::Simulation;

const THRUST: &str = include_str!("../../scenes/thrust.toml");
/// [s] run, and begin of the window of means: the spin of the balls is in balance from the start, the bounce is gone.
const DURATION: f64 = 0.1;
const WINDOW: f64 = 0.06;
/// [s] between rows.
const INTERVAL: f64 = 1e-4;
/// Laws, and whether grooves slip; `kalker` has its default degree.
pub const LAWS: [(&str, bool); 11] = [
    ("linear", false),
    ("uncoupled", false),
    ("regularised", false),
    ("saturated", false),
    ("kalker", false),
    ("kalker_table", false),
    ("uncoupled", true),
    ("regularised", true),
    ("saturated", true),
    ("kalker", true),
    ("kalker_table", true),
];
/// \[deg] contact angles.
pub const ANGLES: [f64; 4] = [2.0, 15.0, 25.0, 40.0];

/// Means over the window.
#[derive(Clone, Copy, Debug, Default)]
pub struct Means {
    /// \[W] power of a ball on the inner and the outer race.
    pub power: [f64; 2],
    /// [-] share of the spin moment in it.
    pub spin_share: [f64; 2],
    /// \[W] all contacts.
    pub total: f64,
    /// [-] change of a ball's power from the first to the second half of the window.
    pub drift: f64,
    /// CPU seconds per simulated second.
    pub cpu: f64,
}

/// Runs the thrust case with some changes.
///
/// # Errors
/// Those of the scene and of the run.
pub fn settled(changes: &[(&str, &str)]) -> Result<Means, Box<dyn Error>> {
    let scene = Scene::edited(THRUST, changes.iter().copied())?;
    let mut simulation = Simulation::new(&scene)?;
    let contacts: [fn(&BallOutput) -> &ContactOutput; 2] = [|ball| &ball.inner, |ball| &ball.outer];
    let (mut rows, mut halves, mut spin) = ([0.0; 2], [[0.0; 2]; 2], [0.0; 2]);
    let begin = ThreadTime::now();
    let last = (DURATION / INTERVAL).round() as u32;
    for point in 1..=last {
        let time = f64::from(point) * INTERVAL;
        simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
        simulation.advance(time)?;
        if time <= WINDOW {
            continue;
        }
        let half = usize::from(time > 0.5 * (WINDOW + DURATION));
        rows[half] += 1.0;
        let balls = &simulation.outputs().balls;
        for (race, contact) in contacts.iter().enumerate() {
            let mean = |of: fn(&ContactOutput) -> f64| {
                balls.iter().map(|ball| of(contact(ball))).sum::<f64>() / balls.len() as f64
            };
            halves[half][race] += mean(|contact| contact.power);
            spin[race] += mean(|contact| contact.spin_power);
        }
    }
    let sums = [0, 1].map(|race: usize| halves[0][race] + halves[1][race]);
    let of_half = [0, 1].map(|half: usize| (halves[half][0] + halves[half][1]) / rows[half]);
    let all = rows[0] + rows[1];
    Ok(Means {
        power: sums.map(|sum| sum / all),
        spin_share: [0, 1].map(|race: usize| spin[race] / sums[race]),
        total: (sums[0] + sums[1]) / all * scene.bearing.balls as f64,
        drift: of_half[1] / of_half[0] - 1.0,
        cpu: begin.elapsed().as_secs_f64() / DURATION,
    })
}

/// The run of one law.
///
/// # Errors
/// As [`settled`].
pub fn with_law(law: &str, slip: bool) -> Result<Means, Box<dyn Error>> {
    settled(&[("effects.creep", &format!("\"{law}\"")), ("effects.heathcote_slip", &slip.to_string())])
}

/// The run of the default law at a contact angle \[deg].
///
/// # Errors
/// As [`settled`].
pub fn at_angle(angle: f64) -> Result<Means, Box<dyn Error>> {
    settled(&[("effects.creep", ""), ("bearing.contact_angle", &format!("\"{angle} deg\""))])
}

/// A row of the tables, but for the time that it took.
pub fn row(head: &str, means: &Means) -> String {
    let [inner, outer] = means.power.map(|power| power * 1e3);
    let [spin_inner, spin_outer] = means.spin_share.map(|share| share * 100.0);
    format!("| {head} | {inner:.0} | {outer:.0} | {:.2} | {spin_inner:.0} / {spin_outer:.0} |", means.total)
}

/// The first cells of a law's row.
pub fn head(law: &str, slip: bool) -> String {
    format!("`{law}` | {}", if slip { "yes" } else { "no" })
}

#[allow(dead_code, reason = "the test of the document has its own loop")]
fn main() -> Result<(), Box<dyn Error>> {
    println!("<!-- begin laws -->\n");
    println!(
        "| law | groove slip | inner [mW a ball] | outer [mW a ball] | all [W] | spin share, inner / outer [%] | CPU [s/s] |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: |");
    for (law, slip) in LAWS {
        match with_law(law, slip) {
            Ok(means) => {
                eprintln!("{law}, groove slip {slip}: drift {:.1e}", means.drift);
                println!("{} {:.1} |", row(&head(law, slip), &means), means.cpu);
            }
            Err(why) => {
                eprintln!("{law}: {why}");
                println!("| {} | refused: forces above mu Q | | | | |", head(law, slip));
            }
        }
    }
    println!("\n<!-- end -->\n<!-- begin angles -->\n");
    println!(
        "| contact angle [deg] | inner [mW a ball] | outer [mW a ball] | all [W] | spin share, inner / outer [%] |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: |");
    for angle in ANGLES {
        println!("{}", row(&angle.to_string(), &at_angle(angle)?));
    }
    println!("\n<!-- end -->");
    Ok(())
}
