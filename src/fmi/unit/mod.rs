//! Unit of an instance: a machine as values by reference. Some go in, steps are made, others come out. Lists of values have one of
//! every row, by value reference; those of outputs are ignored where values go in.
//!
//! Its scripts are, in this order: those of every bearing, group by group; where there are shafts, one of each named load, one of each gear,
//! that of the drive of each shaft, one of each motion that is given, that of the frame.

mod derivatives;
mod tuning;

use std::sync::Arc;

use strum::VariantArray;

use super::log::Log;
use super::outcome::{Outcome, Status};
use crate::analysis::estimate;
use crate::effects::estimate::missed;
use crate::effects::frame::FrameSection;
use crate::interface::contradiction::Contradiction;
use crate::interface::references::References;
use crate::interface::variables::{Causality, MachineGroup, MachineVariables, Variable};
use crate::model::bodies::Race;
use crate::scene::machine::MachineScene;
use crate::scene::system::NamedLoad;
use crate::scene::{Giver, Group, Groups, Level, Scene, SceneError, Solver};
use crate::schema::GivenMotion;
use crate::simulation::alarms::Alarms;
use crate::simulation::driven::{MachineInputs, MachineSnapshot};
use crate::simulation::machine::{Machine, MachineError, follows_time};
use crate::simulation::scripted_groups;
use crate::simulation::system::{Played, drive_is_scripted};

/// Scripts of a bearing.
const GROUPS: usize = Group::VARIANTS.len();

/// Message about a unit without motion in time.
const OF_EQUILIBRIA: &str =
    "solver.level = \"equilibrium\": outputs are those of the equilibrium under the inputs of each step";

/// A machine with its variables.
#[derive(Clone)]
pub struct Unit {
    variables: Arc<MachineVariables>,
    scene: Arc<MachineScene>,
    machine: Machine,
    /// Inputs of the next step.
    next: MachineInputs,
    /// Groups of its inputs, one of each script.
    groups: Arc<Vec<MachineGroup>>,
    /// [`Unit::scripts`].
    scripts: Vec<Option<Giver>>,
}

/// A refusal for a reason.
fn refused(why: &impl ToString) -> (Status, String) {
    (Status::Error, why.to_string())
}

/// Those of some groups that are marked.
fn marked(marks: &[bool]) -> Groups {
    Group::VARIANTS.iter().fold(Groups::default(), |groups, &group| {
        groups.with(group, marks.get(group as usize).is_some_and(|marked| *marked))
    })
}

/// Who gives each group of inputs that a scene has a script for.
fn givers(scene: &Scene) -> impl Iterator<Item = Option<Giver>> {
    let scripted = scripted_groups(scene);
    Group::VARIANTS
        .iter()
        .map(move |&group| scripted.contains(group).then(|| scene.interface.inputs.of(group)))
}

/// Scripts of a machine of a scene: who gives what there is one for.
fn scripts(machine: &Machine, scene: &MachineScene) -> Vec<Option<Giver>> {
    let mut all: Vec<_> = machine.bearings().flat_map(|(_, bearing)| givers(bearing.scene())).collect();
    if let Some(scene) = scene.shaft() {
        // The frame of every bearing is that of the machine, which has a script of its own.
        all.iter_mut().skip(Group::Frame as usize).step_by(GROUPS).for_each(|script| *script = None);
        let loads = scene.loads().map(|load| load.is_scripted());
        let gears = scene.gears().map(|gear| gear.torque.is_scripted());
        let drives = scene.shafts.iter().map(drive_is_scripted);
        let motions = scene.motions().map(|(_, (.., schedule))| schedule.is_scripted());
        let frame = scene.frame.iter().map(FrameSection::is_scripted);
        let of_shaft = loads.chain(gears).chain(drives).chain(motions).chain(frame);
        all.extend(of_shaft.map(|scripted| scripted.then_some(Giver::Scene)));
    }
    all
}

/// Groups of the inputs of a machine, one of each of [`scripts`].
fn groups(machine: &Machine, scene: &MachineScene) -> Vec<MachineGroup> {
    let bearings = 0..machine.bearings().count();
    let of_bearing = |index| Group::VARIANTS.iter().map(move |&group| MachineGroup::Bearing(index, group));
    let mut all: Vec<_> = bearings.flat_map(of_bearing).collect();
    if let Some(scene) = scene.shaft() {
        all.extend((0..scene.loads().count()).map(MachineGroup::Load));
        all.extend((0..scene.gears().count()).map(MachineGroup::Gear));
        all.extend((0..scene.shafts.len()).map(MachineGroup::Drive));
        all.extend((0..scene.motions().count()).map(MachineGroup::Motion));
        all.extend(scene.frame.iter().map(|_| MachineGroup::Frame));
    }
    all
}

impl Unit {
    /// A machine of a scene whose effects are found out, started.
    ///
    /// # Errors
    /// If it does not start.
    pub fn new(scene: MachineScene) -> Outcome<Self> {
        let machine = Machine::new(&scene).map_err(|why| refused(&why))?;
        let variables = Arc::new(MachineVariables::new(&machine));
        let (groups, scripts) = (Arc::new(groups(&machine, &scene)), scripts(&machine, &scene));
        Ok(Self { variables, scene: Arc::new(scene), next: machine.inputs(), machine, groups, scripts })
    }

    /// The variables; the index of a row is its value reference.
    pub fn rows(&self) -> &[Variable] {
        self.variables.rows()
    }

    /// Are its variables arrays, where FMI has them?
    pub fn has_arrays(&self) -> bool {
        self.scene.has_arrays()
    }

    /// Value references of the inputs.
    pub fn inputs(&self) -> &[usize] {
        self.variables.input_references()
    }

    /// \[s] time.
    pub fn time(&self) -> f64 {
        self.machine.time()
    }

    /// Value of a row: an input as set, an output of the last communication point.
    pub fn value(&self, reference: usize) -> f64 {
        self.variables.value(reference, &self.machine)
    }

    /// Values of all rows.
    pub fn values(&self) -> Vec<f64> {
        self.variables.values(&self.machine)
    }

    /// Are all numbers finite that values are computed from?
    pub fn is_finite(&self) -> bool {
        self.variables.shaft_values(&self.machine).all(f64::is_finite) && self.machine.is_finite()
    }

    /// Does anything change by itself with time?
    pub fn follows_time(&self) -> bool {
        follows_time(&self.scene)
    }

    /// \[s] time that the scene's scripts are written for, from 0.
    pub fn duration(&self) -> f64 {
        self.scene.duration()
    }

    /// The scene with the parameters among these values.
    fn scene_with(&self, values: &[f64]) -> Outcome<MachineScene> {
        let mut scene = MachineScene::clone(&self.scene);
        self.variables.set_parameters(&mut scene, values);
        for (name, bearing) in scene.bearings() {
            let before = if name.is_empty() { String::new() } else { format!("bearing {name}: ") };
            bearing.check().map_err(|why: SceneError| (Status::Error, format!("{before}{why}")))?;
        }
        Ok(scene)
    }

    /// Starts again with the parameters among these values at a time \[s], under what the scripts say then.
    ///
    /// # Errors
    /// If that is not possible.
    pub fn start_at(&mut self, time: f64, values: &[f64]) -> Outcome {
        let scene = self.scene_with(values)?;
        self.machine = Machine::starting_at(&scene, time).map_err(|why| refused(&why))?;
        self.scripts = scripts(&self.machine, &scene);
        self.scene = Arc::new(scene);
        Ok(())
    }

    /// Sets the time \[s] of a unit that has not moved yet and does not follow time.
    ///
    /// # Errors
    /// If it does not start there.
    pub fn set_start_time(&mut self, time: f64) -> Outcome {
        self.machine.set_start_time(time).map_err(|why| refused(&why))
    }

    /// Takes the inputs among these values, and their rates, for the next step or start.
    ///
    /// # Errors
    /// If one is not allowed.
    pub fn prepare(&mut self, values: &[f64], rates: &[f64]) -> Outcome {
        self.next = self.variables.inputs(values, rates, &self.machine).map_err(|why| refused(&why))?;
        Ok(())
    }

    fn take_prepared(&mut self) {
        let taken = self.machine.set_inputs(self.next.clone());
        debug_assert!(taken, "they were made for this very machine");
    }

    /// Starts again at the present time under the inputs that were prepared.
    ///
    /// # Errors
    /// If there is no equilibrium.
    pub fn initialise(&mut self) -> Outcome {
        self.take_prepared();
        self.machine.initialise().map_err(|why| refused(&why))
    }

    /// Runs to a time \[s] under the inputs that were prepared, some of them given by the scripts that are played.
    ///
    /// # Errors
    /// A discarded step if it cannot be finished.
    pub fn advance(&mut self, end: f64, played: &[bool]) -> Outcome {
        self.take_prepared();
        let played = self.played(played);
        self.machine
            .advance_with(end, &played)
            .map_err(|why: MachineError| (Status::Discard, why.to_string()))
    }

    /// \[s] where the integrator's next step ends on the way to a time, if it succeeds; an equilibrium is one step.
    pub fn next_point(&self, end: f64) -> f64 {
        let time = self.time();
        let dynamic = self.scene.solver().level == Level::Dynamic;
        let control = self.machine.control();
        let step = if dynamic { control.step_within(end - time) } else { f64::INFINITY };
        if step >= (end - time) * (1.0 - 1e-9) { end } else { time + step }
    }

    /// Sets the pose and the twist of races that are given to where they are now.
    pub fn follow(&self, values: &mut [f64]) {
        self.variables.follow(values, &self.machine);
    }

    /// Warnings at its present time, a sentence each.
    pub fn alarms(&self, alarms: &mut Alarms) -> Vec<String> {
        alarms.step(&self.machine)
    }

    /// The point that it is at.
    pub fn snapshot(&self) -> MachineSnapshot {
        self.machine.snapshot()
    }

    /// That, in the memory of an earlier one.
    pub fn snapshot_into(&self, snapshot: &mut MachineSnapshot) {
        self.machine.snapshot_into(snapshot);
    }

    /// Goes to a point; false, with nothing changed, if that is of another unit.
    #[must_use]
    pub fn restore(&mut self, snapshot: &MachineSnapshot) -> bool {
        self.machine.restore(snapshot)
    }

    /// Scripts: who gives what there is one for; none where the scene has no script.
    pub fn scripts(&self) -> &[Option<Giver>] {
        &self.scripts
    }

    /// Name of what a script gives, in words, and its group.
    pub fn script_name(&self, script: usize) -> (String, Group) {
        let load = |index: usize| self.scene.shaft().and_then(|scene| scene.loads().nth(index));
        match self.groups[script] {
            MachineGroup::Load(index) => {
                (load(index).map_or_else(String::new, |load| load.name.into()), Group::Loads)
            }
            MachineGroup::Gear(gear) => (format!("the torque of gear {}", gear + 1), Group::Loads),
            MachineGroup::Drive(shaft) => {
                let name = self.scene.shaft().map_or("shaft", |scene| &scene.shafts[shaft].name);
                (
                    if name == "shaft" { "the shaft's drive".into() } else { format!("the drive of {name}") },
                    Group::Speeds,
                )
            }
            MachineGroup::Motion(index) => {
                let given = self.scene.shaft().and_then(|scene| scene.motions().nth(index));
                let name =
                    |(load, (key, ..)): (NamedLoad<'_>, GivenMotion<'_>)| format!("{}.{key}", load.name);
                (given.map_or_else(String::new, name), Group::Tilts)
            }
            MachineGroup::Frame => (Group::Frame.to_string(), Group::Frame),
            MachineGroup::Bearing(index, group) => match self.machine.bearings().nth(index) {
                Some((name, _)) if !name.is_empty() => (format!("{group} of {name}"), group),
                _ => (group.to_string(), group),
            },
        }
    }

    /// The script that may give an input.
    pub fn script_of(&self, reference: usize) -> Option<usize> {
        let wanted = self.variables.group(reference, &self.machine)?;
        self.groups.iter().position(|group| *group == wanted)
    }

    /// Scripts that are marked.
    fn played(&self, marks: &[bool]) -> Played {
        let mut played = Played {
            bearings: vec![Groups::default(); self.next.bearings.len()],
            ..Played::of_bearing(Groups::default())
        };
        for (group, mark) in self.groups.iter().zip(marks) {
            match *group {
                MachineGroup::Bearing(index, group) => {
                    played.bearings[index] = played.bearings[index].with(group, *mark);
                }
                MachineGroup::Load(_) => played.loads.push(*mark),
                MachineGroup::Gear(_) => played.gears.push(*mark),
                MachineGroup::Drive(_) => played.drives.push(*mark),
                MachineGroup::Motion(_) => played.motions.push(*mark),
                MachineGroup::Frame => {
                    // The frame of every bearing is that of the machine.
                    played.bearings.iter_mut().for_each(|own| *own = own.with(Group::Frame, *mark));
                    played.frame = *mark;
                }
            }
        }
        played
    }

    /// A quaternion of zeros among these values: an input that nothing is connected to.
    pub fn zero_quaternion(&self, values: &[f64]) -> Option<String> {
        let mut bearings = self.variables.bearings().zip(self.machine.bearings());
        bearings.find_map(|((first, variables), (name, _))| {
            let race = variables.zero_quaternion(&values[first..])?.name();
            Some(if name.is_empty() { race.to_string() } else { format!("{name}.{race}") })
        })
    }

    /// A race whose prepared pose contradicts its twist, or a load whose given motion does, over a step \[s] before now.
    pub fn contradiction(&self, step: f64, played: &[bool]) -> Option<(String, Contradiction)> {
        let tables = self.variables.bearings().zip(self.machine.bearings());
        let mut bearings = tables.zip(&self.next.bearings).zip(played.chunks(GROUPS));
        let of_race = bearings.find_map(|((((_, variables), (name, bearing)), next), played)| {
            // A script moves on within a step, and its pose and twist agree.
            let scripted = marked(played).contains(Group::Tilts);
            let given = |race: &Race| !scripted && variables.pose_is_given(*race);
            let before = bearing.inputs();
            Race::BOTH.into_iter().filter(given).find_map(|race| {
                let found = Contradiction::between(&before[race], &next[race], step)?;
                let of = if name.is_empty() { String::new() } else { format!(" of {name}") };
                Some((format!("the {} race{of}", race.name()), found))
            })
        });
        of_race.or_else(|| self.contradicting_motion(step, played))
    }

    fn contradicting_motion(&self, step: f64, played: &[bool]) -> Option<(String, Contradiction)> {
        let (before, next) = (self.machine.shaft()?.inputs(), self.next.shaft.as_ref()?);
        let pairs = before.motions.iter().zip(&next.motions);
        let mut motions = self.scene.shaft()?.motions().zip(pairs).enumerate();
        motions.find_map(|(index, ((load, (_, component, _)), (before, next)))| {
            let script = self.groups.iter().position(|group| *group == MachineGroup::Motion(index))?;
            let found = Contradiction::of_motion(component > 2, before, next, step)?;
            (!played[script]).then(|| (format!("load {}", load.name), found))
        })
    }

    /// Is a parameter among these values different?
    pub fn parameters_differ(&self, one: &[f64], other: &[f64]) -> bool {
        let pairs = one.iter().zip(other);
        let mut rows = self.rows().iter().zip(pairs);
        rows.any(|(row, (one, other))| row.causality == Causality::Parameter && one != other)
    }

    /// Derivatives of all variables by some inputs, one column per input, of the step since a point, or of the start.
    ///
    /// # Errors
    /// If there are none.
    pub fn derivatives(
        &self,
        before: Option<&MachineSnapshot>,
        played: &[bool],
        inputs: &[usize],
    ) -> Outcome<Vec<Vec<f64>>> {
        derivatives::columns(self, before, &self.played(played), inputs)
    }

    /// The same by the rate of every input that takes one, in columns by their references; those of others are empty. A start knows no rates.
    ///
    /// # Errors
    /// As of [`Unit::derivatives`].
    pub fn derivatives_by_rates(
        &self,
        before: Option<&MachineSnapshot>,
        played: &[bool],
    ) -> Outcome<Vec<Vec<f64>>> {
        let rated: Vec<usize> = References::new(self.rows()).rates().map(|(_, row)| row).collect();
        let found = derivatives::columns_of_rates(self, before, &self.played(played), &rated)?;
        let mut columns = vec![vec![]; self.rows().len()];
        rated.into_iter().zip(found).for_each(|(row, column)| columns[row] = column);
        Ok(columns)
    }

    /// Tells what is simulated.
    pub fn announce(&self, log: &Log) {
        let Solver { goal, level, max_step, tolerance, .. } = self.scene.solver();
        if let Some(goal) = goal {
            // A single run cannot measure its own error.
            log.write(
                Status::Ok,
                &format!(
                    "solver.accuracy.error = {:e}: this package runs once, with the settings that runs of the scene begin with \
                     (max_step {:e} s, tolerance {tolerance:e}), and does not measure its error; \"roulement run\" does",
                    goal.error, max_step.0
                ),
            );
        }
        if level == Level::Equilibrium {
            log.write(Status::Ok, OF_EQUILIBRIA);
        }
        // Estimates ask for equilibria, which nobody waits for who does not read them.
        if log.tells(Status::Ok) {
            let verdicts = estimate::verdicts_of(&self.machine);
            for ((name, bearing), verdicts) in self.machine.bearings().zip(verdicts) {
                let before = if name.is_empty() { String::new() } else { format!("{name}: ") };
                // Which are on, and which that are off would matter.
                let lines = verdicts.map_or_else(|why| vec![why.to_string()], |verdicts| missed(&verdicts));
                for line in [bearing.scene().effects.simulated()].iter().chain(&lines) {
                    log.write(Status::Ok, &format!("{before}{line}"));
                }
            }
        }
    }
}
