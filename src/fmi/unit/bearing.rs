//! A bearing.

use std::sync::Arc;

use strum::VariantArray;

use super::{Simulated, UnitSnapshot, derivatives};
use crate::analysis::estimate;
use crate::effects;
use crate::fmi::log::Log;
use crate::fmi::outcome::{Outcome, Status};
use crate::interface::contradiction::Contradiction;
use crate::interface::variables::{Variable, Variables};
use crate::model::bodies::Race;
use crate::scene::{Giver, Group, Groups, Level, Scene, Solver};
use crate::simulation::inputs::Inputs;
use crate::simulation::{Simulation, follows_time, scripted_groups};

/// A bearing with its variables.
#[derive(Clone)]
pub struct BearingUnit {
    pub(super) variables: Arc<Variables>,
    pub(super) simulation: Simulation,
    /// Inputs of the next step.
    next: Inputs,
}

/// A refusal for a reason.
fn refused(why: &impl ToString) -> (Status, String) {
    (Status::Error, why.to_string())
}

/// What is told of a unit without motion in time.
pub const OF_EQUILIBRIA: &str =
    "solver.level = \"equilibrium\": outputs are those of the equilibrium under the inputs of each step";

/// Those of some groups that are marked.
pub fn marked(marks: &[bool]) -> Groups {
    Group::VARIANTS.iter().fold(Groups::default(), |groups, &group| {
        groups.with(group, marks.get(group as usize).is_some_and(|marked| *marked))
    })
}

/// Who gives each group of inputs that a scene has a script for.
pub fn givers(scene: &Scene) -> impl Iterator<Item = Option<Giver>> {
    let scripted = scripted_groups(scene);
    Group::VARIANTS
        .iter()
        .map(move |&group| scripted.contains(group).then(|| scene.interface.inputs.of(group)))
}

impl BearingUnit {
    /// A bearing of a scene whose effects are found out, started.
    ///
    /// # Errors
    /// If it does not start.
    pub fn new(scene: &Scene) -> Outcome<Self> {
        let simulation = Simulation::new(scene).map_err(|why| refused(&why))?;
        Ok(Self { variables: Arc::new(Variables::new(scene)), next: *simulation.inputs(), simulation })
    }

    /// The scene with the parameters among these values.
    fn scene_with(&self, values: &[f64]) -> Outcome<Scene> {
        let mut scene = self.simulation.scene().clone();
        self.variables.set_parameters(&mut scene, values);
        scene.check().map_err(|why| refused(&why))?;
        Ok(scene)
    }

    /// Tells which effects are on, and which that are off would matter.
    fn announce_effects(&self, log: &Log) {
        // Estimates ask for an equilibrium, which nobody waits for who does not read them.
        if !log.tells(Status::Ok) {
            return;
        }
        let scene = self.simulation.scene();
        let lines = match estimate::verdicts(scene, self.simulation.model()) {
            Ok(verdicts) => effects::estimate::missed(&verdicts),
            Err(why) => vec![why.to_string()],
        };
        [scene.effects.simulated()].iter().chain(&lines).for_each(|line| log.write(Status::Ok, line));
    }

    /// Tells what an error goal means here: a single run cannot measure its own error.
    fn announce_goal(&self, log: &Log) {
        if let Some(goal) = self.simulation.scene().solver.goal {
            let Solver { max_step, tolerance, .. } = self.simulation.scene().solver;
            log.write(
                Status::Ok,
                &format!(
                    "solver.accuracy.error = {:e}: this package runs once, with the settings that runs of the scene begin with \
                     (max_step {:e} s, tolerance {tolerance:e}), and does not measure its error; \"roulement run\" does",
                    goal.error, max_step.0
                ),
            );
        }
    }
}

impl Simulated for BearingUnit {
    fn rows(&self) -> &[Variable] {
        self.variables.rows()
    }

    fn inputs(&self) -> &[usize] {
        self.variables.input_references()
    }

    fn time(&self) -> f64 {
        self.simulation.time()
    }

    fn value(&self, reference: usize) -> f64 {
        self.variables.value_of(&self.variables.rows()[reference], &self.simulation)
    }

    fn is_finite(&self) -> bool {
        self.simulation.is_finite()
    }

    fn values(&self) -> Vec<f64> {
        self.variables.values(self.simulation.inputs(), self.simulation.outputs())
    }

    fn follows_time(&self) -> bool {
        follows_time(self.simulation.scene())
    }

    fn duration(&self) -> f64 {
        self.simulation.scene().load.duration.0
    }

    fn start_at(&mut self, time: f64, values: &[f64]) -> Outcome {
        let scene = self.scene_with(values)?;
        self.simulation = Simulation::starting_at(&scene, time).map_err(|why| refused(&why))?;
        Ok(())
    }

    fn set_start_time(&mut self, time: f64) -> Outcome {
        self.simulation.set_start_time(time);
        Ok(())
    }

    fn tune(&mut self, values: &[f64]) -> Outcome {
        let scene = self.scene_with(values)?;
        self.simulation.tune(&scene);
        Ok(())
    }

    fn prepare(&mut self, values: &[f64], rates: &[f64]) -> Outcome {
        self.next =
            self.variables.inputs(values, rates, self.simulation.inputs()).map_err(|why| refused(&why))?;
        Ok(())
    }

    fn initialise(&mut self) -> Outcome {
        self.simulation.set_inputs(self.next);
        self.simulation.initialise().map_err(|why| refused(&why))
    }

    fn advance(&mut self, end: f64, played: &[bool]) -> Outcome {
        self.simulation.set_inputs(self.next);
        let advanced = self.simulation.advance_with(end, marked(played));
        advanced.map_err(|why| (Status::Discard, why.to_string()))
    }

    fn snapshot(&self) -> UnitSnapshot {
        UnitSnapshot::Bearing(Box::new(self.simulation.snapshot()))
    }

    fn restore(&mut self, snapshot: &UnitSnapshot) -> bool {
        match snapshot {
            UnitSnapshot::Bearing(snapshot) => self.simulation.restore(snapshot),
            UnitSnapshot::System(_) => false,
        }
    }

    fn scripts(&self) -> Vec<Option<Giver>> {
        givers(self.simulation.scene()).collect()
    }

    fn script_name(&self, script: usize) -> (String, Group) {
        (Group::VARIANTS[script].to_string(), Group::VARIANTS[script])
    }

    fn script_of(&self, reference: usize) -> Option<usize> {
        let group = self.variables.rows()[reference].group(self.simulation.scene())?;
        Some(group as usize)
    }

    fn zero_quaternion(&self, values: &[f64]) -> Option<String> {
        self.variables.zero_quaternion(values).map(|race| race.name().to_string())
    }

    fn contradiction(&self, step: f64, played: &[bool]) -> Option<(String, Contradiction)> {
        // A script moves on within a step, and its pose and twist agree.
        let scripted = marked(played).contains(Group::Tilts);
        let given = |race: &Race| !scripted && self.variables.pose_is_given(*race);
        let (before, next) = (self.simulation.inputs(), &self.next);
        Race::BOTH.into_iter().filter(given).find_map(|race| {
            let found = Contradiction::between(&before[race], &next[race], step)?;
            Some((format!("the {} race", race.name()), found))
        })
    }

    fn announce(&self, log: &Log) {
        self.announce_goal(log);
        if self.simulation.scene().solver.level == Level::Equilibrium {
            log.write(Status::Ok, OF_EQUILIBRIA);
        }
        self.announce_effects(log);
    }

    fn derivatives(&self, before: Option<&UnitSnapshot>, played: &[bool]) -> Outcome<Vec<Vec<f64>>> {
        derivatives::columns(self, before, marked(played))
    }
}
