//! CPU time and work of fixed steps of 1e-5 s: `step_cost CASE LAW BALLS INTERVAL STEPS`, with a communication INTERVAL of so many
//! steps. CASE is the thrust scene with its inner race in drive `pose` or `wrench`, or another scene, `cage` or `radial`, or `fast`: the radial
//! one with that goal, for as long as these steps would take, or `fast:NAME`: the same of `scenes/cost/NAME.toml`, from the beginning. These have
//! BALLS of their own. LAW may end in `+heathcote`. See `scripts/measure step-cost`.

use std::error::Error;

use cpu_time::ThreadTime;
use roulement::scene::Scene;
use roulement::simulation::Simulation;

/// [s] step.
const STEP: f64 = 1e-5;
/// Steps before the clock starts: the balls' starting bounce has gone.
const SETTLING: u32 = 500;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [case, law, balls, interval, steps] = &arguments[..] else {
        return Err("usage: step_cost CASE LAW BALLS INTERVAL STEPS".into());
    };
    let (interval, steps): (u32, u32) = (interval.parse()?, steps.parse()?);
    // A large tolerance keeps the step at its cap; more balls need a larger pitch circle.
    let n_balls: f64 = balls.parse()?;
    let scene = case.strip_prefix("fast:");
    let settling = if scene.is_some() { 0 } else { SETTLING };
    let text = match case.as_str() {
        _ if let Some(name) = scene => {
            std::fs::read_to_string(format!("scenes/cost/{name}.toml"))?.replace("tolerance = 1e-6\n", "")
        }
        "cage" => include_str!("../../scenes/cage.toml").to_string(),
        "radial" | "fast" => include_str!("../../scenes/radial.toml").replace("tolerance = 1e-6\n", ""),
        drive => include_str!("../../scenes/thrust.toml")
            .replace("drive = \"wrench\"", &format!("drive = \"{drive}\""))
            .replace("balls = 10 ", &format!("balls = {balls} "))
            .replace("\"46 mm\"", &format!("\"{} mm\"", 46f64.max(4.6 * n_balls))),
    };
    let law = match law.strip_suffix("+heathcote") {
        Some(law) => format!("\"{law}\"\nheathcote_slip = true"),
        None => format!("\"{law}\""),
    };
    let steps_of_case = match case.as_str() {
        case if case.starts_with("fast") => "accuracy = \"fast\"",
        _ => "max_step = \"10 us\"\ntolerance = 1e-2",
    };
    let text = text.replace("\"saturated\"", &law).replace("max_step = \"10 us\"", steps_of_case);
    let mut simulation = Simulation::new(&Scene::parse(&text)?)?;
    let run = |simulation: &mut Simulation, from: u32, to: u32| -> Result<(), Box<dyn Error>> {
        for point in (from + interval..=to).step_by(interval as usize) {
            simulation.set_inputs(simulation.scripted_inputs(simulation.time()));
            simulation.advance(f64::from(point) * STEP)?;
        }
        Ok(())
    };
    match scene {
        // Whole scenes are short: what the first run of a program has to wait for is not part of them.
        Some(_) => run(&mut simulation.clone(), 0, steps)?,
        None => run(&mut simulation, 0, settling)?,
    }
    let before = simulation.state().statistics;
    let begin = ThreadTime::now();
    run(&mut simulation, settling, settling + steps)?;
    let seconds = begin.elapsed().as_secs_f64();
    let after = simulation.state().statistics;
    let taken = (after.steps - before.steps) as f64;
    let per_step = |after: u64, before: u64| (after - before) as f64 / taken;
    println!(
        "{:.3} s/s, {taken} steps; per step: {:.2} corrections, {:.2} matrices, {:.2} contact values, {:.2} contact tangents",
        seconds / (f64::from(steps) * STEP),
        per_step(after.newton.iterations, before.newton.iterations),
        per_step(after.newton.factorisations, before.newton.factorisations),
        per_step(after.contact_values, before.contact_values),
        per_step(after.contact_tangents, before.contact_tangents),
    );
    println!("time {:e}, energy lost {:e} J", simulation.time(), simulation.state().energies.friction);
    println!("{:?}", simulation.state().balls[3].position.as_slice());
    Ok(())
}
