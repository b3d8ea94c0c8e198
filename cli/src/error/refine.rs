//! Runs of a scene with smaller and smaller steps, until its error goal is kept or known not to be.

use roulement::scene::machine::MachineScene;

use super::{Judgement, Rounds, Run, TWIN};

/// [-] runs of a scene that has an error goal, at most; as of `roulement run`.
pub const MOST_ROUNDS: u32 = 6;

/// A run that can be compared with others.
pub trait Compared {
    /// Sample that is kept of it for that.
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
    scene: &MachineScene,
    mut play: impl FnMut(&MachineScene, bool) -> Result<P, E>,
) -> Result<Refined<P>, E> {
    let mut run = play(scene, true)?;
    let Some(goal) = scene.solver().goal else {
        return Ok(Refined { run, rounds: None });
    };
    let mut rounds = Rounds::new(Some(goal), MOST_ROUNDS);
    rounds.push(run.comparable());
    let said = loop {
        match rounds.judge() {
            Judgement::Refine => {
                run = play(&finer(scene, rounds.refinements()), true)?;
                rounds.push(run.comparable());
            }
            Judgement::Twin => {
                let twin = play(&twin_of_coarser(scene, rounds.refinements()), false)?.comparable();
                rounds.push_twin(&twin);
            }
            Judgement::Done => break "met",
            Judgement::TooShort => break "not met: the run is too short",
            Judgement::TooMany => break "not met: more rounds are needed",
        }
    };
    Ok(Refined { run, rounds: Some((rounds, said)) })
}

/// A scene with steps halved so often.
pub fn finer(scene: &MachineScene, halvings: u32) -> MachineScene {
    scene.with_solver(|solver| *solver = solver.refined(halvings))
}

/// The scene of the coarser one of the last two of so many runs, with steps that differ from its own by next to nothing.
pub fn twin_of_coarser(scene: &MachineScene, runs: u32) -> MachineScene {
    let coarser = if runs < 2 { scene.clone() } else { finer(scene, runs - 2) };
    coarser.with_solver(|solver| {
        solver.max_step.0 *= 1.0 + TWIN;
        solver.initial_step.0 *= 1.0 + TWIN;
    })
}
