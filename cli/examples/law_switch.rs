//! The paper's own switch of creep laws inside Newton's method beside ours, which freezes what polynomials add to the table for a step:
//! steps, failures, corrections, power and time. A table for docs/creep-laws.md; `scripts/laws` writes it there.

use std::error::Error;

use cpu_time::ThreadTime;
use roulement::model::Model;
use roulement::model::state::Statistics;
use roulement::scene::Scene;
use roulement::simulation::{Simulation, SimulationError};

/// [s] between rows.
const INTERVAL: f64 = 1e-4;

/// A case: its name, its scene, and begin and end [s] of the window of its means.
pub struct Case {
    /// Name.
    pub name: &'static str,
    text: &'static str,
    window: [f64; 2],
}

/// Cases: settled, a load zone, and a hard one.
pub const CASES: [Case; 3] = [
    Case { name: "thrust", text: include_str!("../../scenes/thrust.toml"), window: [10e-3, 20e-3] },
    Case { name: "radial", text: include_str!("../../scenes/radial.toml"), window: [5e-3, 10e-3] },
    // From rest: rolling begins, and creepages are what the first correction makes of them.
    Case {
        name: "speed ramp from rest",
        text: include_str!("../../scenes/cost/speed_ramp.toml"),
        window: [0.0, 10e-3],
    },
];

/// How polynomials enter a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// As the law `kalker` does: frozen for a step as a difference from the table.
    Frozen,
    /// In every evaluation once the residual \[N] that the law `regularised` leaves is below this one.
    Switched(f64),
}

/// Ways; the paper's residuals (its section 3.1.3), and polynomials without the other law before them.
pub const WAYS: [Way; 4] =
    [Way::Frozen, Way::Switched(1e-3), Way::Switched(1e-1), Way::Switched(f64::INFINITY)];

impl Way {
    /// Name in the table.
    pub fn name(self) -> String {
        match self {
            Self::Frozen => "`kalker`, frozen in a step".into(),
            Self::Switched(f64::INFINITY) => "polynomials throughout".into(),
            Self::Switched(residual) => format!("switch at {residual:.0e} N"),
        }
    }
}

/// What came of a run.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// Work of the integrator.
    pub work: Statistics,
    /// \[W] mean friction power over the window.
    pub power: f64,
    /// CPU seconds per simulated second.
    pub cpu: f64,
    /// \[s] where it ended, before the time wanted if it could not go on.
    pub end: f64,
}

/// Runs a case, without groove slip.
///
/// # Errors
/// Those of the scene and of the start.
pub fn run(case: &Case, way: Way) -> Result<Outcome, Box<dyn Error>> {
    let scene = Scene::edited(case.text, [("effects.creep", "\"kalker\"")])?;
    let mut simulation = match way {
        Way::Frozen => Simulation::new(&scene)?,
        Way::Switched(residual) => Simulation::of_model(&scene, Model::switching(&scene, residual)?, 0.0)?,
    };
    let [begin, end] = case.window;
    let (mut sum, mut rows) = (0.0, 0u32);
    let clock = ThreadTime::now();
    for point in 1..=(end / INTERVAL).round() as u32 {
        let time = f64::from(point) * INTERVAL;
        match simulation.advance_scripted(time) {
            Ok(()) => {}
            Err(SimulationError::StepTooSmall { .. }) => break,
            Err(why) => return Err(why.into()),
        }
        if time > begin + 0.5 * INTERVAL {
            sum += simulation.outputs().friction_power;
            rows += 1;
        }
    }
    let end = simulation.time();
    let cpu = clock.elapsed().as_secs_f64() / end;
    Ok(Outcome { work: simulation.state().statistics, power: sum / f64::from(rows), cpu, end })
}

impl Outcome {
    /// Did it come to its end?
    pub fn is_whole(&self, case: &Case) -> bool {
        self.end >= case.window[1] * (1.0 - 1e-9)
    }
}

/// The first cells of a row.
pub fn head(case: &Case, way: Way) -> String {
    format!("{} | {}", case.name, way.name())
}

/// A row of the table, but for the time.
pub fn row(case: &Case, way: Way, outcome: &Outcome) -> String {
    let work = &outcome.work;
    let steps = work.steps as f64;
    let power = match outcome.is_whole(case) {
        true => format!("{:.4e}", outcome.power),
        false => format!("ended at {:.3} ms", outcome.end * 1e3),
    };
    format!(
        "| {} | {} | {} | {:.2} | {:.0} | {power} |",
        head(case, way),
        work.steps,
        work.rejected_newton,
        work.newton.iterations as f64 / steps,
        (work.contact_values + work.contact_tangents) as f64 / steps,
    )
}

#[allow(dead_code, reason = "the test of the document has its own loop")]
fn main() -> Result<(), Box<dyn Error>> {
    println!("<!-- begin switch -->\n");
    println!(
        "| case | polynomials | steps | failures of Newton | corrections a step | contacts a step | power [W] | CPU over `kalker`'s |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for case in &CASES {
        let mut own = f64::NAN;
        for way in WAYS {
            let outcome = run(case, way)?;
            if way == Way::Frozen {
                own = outcome.cpu;
            }
            eprintln!("{} {way:?}: {outcome:?}", case.name);
            let cpu =
                if outcome.is_whole(case) { format!("{:.1}", outcome.cpu / own) } else { String::new() };
            println!("{} {cpu} |", row(case, way, &outcome));
        }
    }
    println!("\n<!-- end -->");
    Ok(())
}
