//! Runs of a scene with smaller and smaller steps, until its error goal is kept or known not to be.

use roulement::Scene;
use roulement::scene::units::Time;

use super::{Judgement, Rounds, Run, TWIN};

/// [-] runs of a scene that has an error goal, at most; as of `roulement run`.
pub const MOST_ROUNDS: u32 = 6;

/// A run that can be compared with others.
pub trait Compared {
    /// What is kept of it for that.
    fn comparable(&mut self) -> Run;
}

/// The finest run of a scene.
pub struct Refined<P> {
    /// The run.
    pub run: P,
    /// All rounds and whether the goal is met; none without a goal.
    pub rounds: Option<(Rounds, &'static str)>,
}

/// Plays a scene; with an error goal, as often as that asks for. `play` is told whether its run may be the result.
///
/// # Errors
/// Those of `play`.
pub fn refine<P: Compared, E>(
    scene: &Scene,
    mut play: impl FnMut(&Scene, bool) -> Result<P, E>,
) -> Result<Refined<P>, E> {
    let mut run = play(scene, true)?;
    let Some(goal) = scene.solver.goal else {
        return Ok(Refined { run, rounds: None });
    };
    let with = |solver| {
        let mut scene = scene.clone();
        scene.solver = solver;
        scene
    };
    let mut rounds = Rounds::new(Some(goal), MOST_ROUNDS);
    rounds.push(run.comparable());
    let said = loop {
        match rounds.judge() {
            Judgement::Refine => {
                run = play(&with(scene.solver.refined(rounds.refinements())), true)?;
                rounds.push(run.comparable());
            }
            Judgement::Twin => {
                let Some(coarser) = rounds.coarser() else { break "met" };
                let mut solver = coarser.solver;
                solver.max_step = Time(solver.max_step.0 * (1.0 + TWIN));
                solver.initial_step = Time(solver.initial_step.0 * (1.0 + TWIN));
                let twin = play(&with(solver), false)?.comparable();
                rounds.push_twin(&twin);
            }
            Judgement::Done => break "met",
            Judgement::TooShort => break "not met: the run is too short",
            Judgement::TooMany => break "not met: more rounds are needed",
        }
    };
    Ok(Refined { run, rounds: Some((rounds, said)) })
}
