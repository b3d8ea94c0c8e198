//! A shaft with its bearings.
//!
//! Its scripts are, in this order: those of every bearing, group by group; one of each named load; one of each gear; that of the drive.

use std::sync::Arc;

use strum::VariantArray;

use super::bearing::{OF_EQUILIBRIA, givers, marked};
use super::{Simulated, UnitSnapshot, derivatives};
use crate::fmi::log::Log;
use crate::fmi::outcome::{Outcome, Status};
use crate::interface::contradiction::Contradiction;
use crate::interface::variables::{SystemGroup, SystemVariables, Variable};
use crate::model::bodies::Race;
use crate::scene::system::{MountedScene, SystemScene};
use crate::scene::{Giver, Group, Level, SceneError};
use crate::simulation::inputs::Inputs;
use crate::simulation::system::{
    Played, ShaftInputs, System, SystemError, drive_is_scripted, shaft_follows_time,
};

/// Scripts of a bearing.
const GROUPS: usize = Group::VARIANTS.len();

/// A system with its variables.
#[derive(Clone)]
pub struct SystemUnit {
    pub(super) variables: Arc<SystemVariables>,
    pub(super) system: System,
    /// Inputs of the next step: of the shaft, and of every bearing.
    next: (ShaftInputs, Vec<Inputs>),
}

fn refused(why: &SystemError) -> (Status, String) {
    (Status::Error, why.to_string())
}

impl SystemUnit {
    /// A system of a scene, started.
    ///
    /// # Errors
    /// If it does not start.
    pub fn new(scene: &SystemScene) -> Outcome<Self> {
        let system = System::new(scene).map_err(|why| refused(&why))?;
        let variables = Arc::new(SystemVariables::new(&system));
        let bearings = system.bearings().map(|(_, bearing)| *bearing.inputs()).collect();
        Ok(Self { variables, next: (system.inputs().clone(), bearings), system })
    }

    fn bearing_count(&self) -> usize {
        self.system.scene().bearings.len()
    }

    fn gears(&self) -> usize {
        self.system.scene().shaft.gear.len()
    }

    /// The scene with the parameters among these values.
    fn scene_with(&self, values: &[f64]) -> Outcome<SystemScene> {
        let mut scene = self.system.scene().clone();
        self.variables.set_parameters(&mut scene, values);
        let check = |mounted: &MountedScene| {
            let refused = |why: SceneError| (Status::Error, format!("bearing {}: {why}", mounted.name));
            mounted.scene.check().map_err(refused)
        };
        scene.bearings.iter().try_for_each(check)?;
        Ok(scene)
    }

    /// What a script gives.
    fn group(&self, script: usize) -> SystemGroup {
        let (bearings, loads) = (GROUPS * self.bearing_count(), self.system.scene().loads().count());
        match script.checked_sub(bearings) {
            None => SystemGroup::Bearing(script / GROUPS, Group::VARIANTS[script % GROUPS]),
            Some(load) if load < loads => SystemGroup::Load(load),
            Some(gear) if gear < loads + self.gears() => SystemGroup::Gear(gear - loads),
            Some(_) => SystemGroup::Drive,
        }
    }

    /// Its scripts that are marked.
    fn played(&self, marks: &[bool]) -> Played {
        let (bearings, rest) = marks.split_at(GROUPS * self.bearing_count());
        let (loads, rest) = rest.split_at(self.system.scene().loads().count());
        let (gears, drive) = rest.split_at(self.gears());
        Played {
            loads: loads.to_vec(),
            gears: gears.to_vec(),
            drive: drive.contains(&true),
            bearings: bearings.chunks(GROUPS).map(marked).collect(),
        }
    }

    fn take_prepared(&mut self) {
        let (shaft, bearings) = self.next.clone();
        let taken = self.system.set_inputs(shaft, bearings);
        debug_assert!(taken, "they were made for this very system");
    }
}

impl Simulated for SystemUnit {
    fn rows(&self) -> &[Variable] {
        self.variables.rows()
    }

    fn inputs(&self) -> &[usize] {
        self.variables.input_references()
    }

    fn time(&self) -> f64 {
        self.system.time()
    }

    fn value(&self, reference: usize) -> f64 {
        self.variables.value(reference, &self.system)
    }

    fn values(&self) -> Vec<f64> {
        self.variables.values(&self.system)
    }

    fn is_finite(&self) -> bool {
        self.variables.shaft_values(&self.system).all(f64::is_finite)
            && self.system.bearings().all(|(_, bearing)| bearing.is_finite())
    }

    fn follows_time(&self) -> bool {
        shaft_follows_time(self.system.scene())
    }

    fn duration(&self) -> f64 {
        self.system.scene().load.duration.0
    }

    fn start_at(&mut self, time: f64, values: &[f64]) -> Outcome {
        let scene = self.scene_with(values)?;
        self.system = System::starting_at(&scene, time).map_err(|why| refused(&why))?;
        Ok(())
    }

    fn set_start_time(&mut self, time: f64) -> Outcome {
        if time == self.system.time() { Ok(()) } else { self.start_at(time, &[]) }
    }

    fn tune(&mut self, values: &[f64]) -> Outcome {
        let scene = self.scene_with(values)?;
        let scenes: Vec<_> = scene.bearings.into_iter().map(|mounted| mounted.scene).collect();
        self.system.tune(&scenes);
        Ok(())
    }

    fn prepare(&mut self, values: &[f64], rates: &[f64]) -> Outcome {
        let inputs = self.variables.inputs(values, rates, &self.system);
        self.next = inputs.map_err(|why| (Status::Error, why.to_string()))?;
        Ok(())
    }

    fn initialise(&mut self) -> Outcome {
        self.take_prepared();
        self.system.initialise().map_err(|why| refused(&why))
    }

    fn advance(&mut self, end: f64, played: &[bool]) -> Outcome {
        self.take_prepared();
        let played = self.played(played);
        self.system.advance_with(end, &played).map_err(|why| (Status::Discard, why.to_string()))
    }

    fn snapshot(&self) -> UnitSnapshot {
        UnitSnapshot::System(Box::new(self.system.snapshot()))
    }

    fn restore(&mut self, snapshot: &UnitSnapshot) -> bool {
        match snapshot {
            UnitSnapshot::System(snapshot) => self.system.restore(snapshot),
            UnitSnapshot::Bearing(_) => false,
        }
    }

    fn scripts(&self) -> Vec<Option<Giver>> {
        let scene = self.system.scene();
        let of_bearings = self.system.bearings().flat_map(|(_, bearing)| givers(bearing.scene()));
        let loads = scene.loads().map(|load| load.is_scripted());
        let gears = scene.shaft.gear.iter().map(|gear| gear.torque.is_scripted());
        let of_shaft = loads.chain(gears).chain([drive_is_scripted(scene)]);
        of_bearings.chain(of_shaft.map(|scripted| scripted.then_some(Giver::Scene))).collect()
    }

    fn script_name(&self, script: usize) -> (String, Group) {
        let scene = self.system.scene();
        match self.group(script) {
            SystemGroup::Load(load) => {
                (scene.loads().nth(load).map_or_else(String::new, |load| load.name.into()), Group::Loads)
            }
            SystemGroup::Gear(gear) => (format!("the torque of gear {}", gear + 1), Group::Loads),
            SystemGroup::Drive => ("the shaft's drive".into(), Group::Speeds),
            SystemGroup::Bearing(index, group) => {
                (format!("{group} of {}", scene.bearings[index].name), group)
            }
        }
    }

    fn script_of(&self, reference: usize) -> Option<usize> {
        let after_bearings = GROUPS * self.bearing_count();
        Some(match self.variables.group(reference, &self.system)? {
            SystemGroup::Bearing(index, group) => GROUPS * index + group as usize,
            SystemGroup::Load(load) => after_bearings + load,
            SystemGroup::Gear(gear) => after_bearings + self.system.scene().loads().count() + gear,
            SystemGroup::Drive => after_bearings + self.system.scene().loads().count() + self.gears(),
        })
    }

    fn zero_quaternion(&self, values: &[f64]) -> Option<String> {
        let mut bearings = self.variables.bearings().zip(self.system.bearings());
        bearings.find_map(|((first, variables), (name, _))| {
            let race = variables.zero_quaternion(&values[first..])?;
            Some(format!("{name}.{}", race.name()))
        })
    }

    fn contradiction(&self, step: f64, played: &[bool]) -> Option<(String, Contradiction)> {
        let tables = self.variables.bearings().zip(self.system.bearings());
        let mut bearings = tables.zip(&self.next.1).zip(played.chunks(GROUPS));
        bearings.find_map(|((((_, variables), (name, bearing)), next), played)| {
            let given = variables.pose_is_given(Race::Outer) && !marked(played).contains(Group::Tilts);
            let before = bearing.inputs();
            let found = given.then(|| Contradiction::between(&before.outer, &next.outer, step))??;
            Some((format!("the outer race of {name}"), found))
        })
    }

    fn announce(&self, log: &Log) {
        if self.system.scene().solver().level == Level::Equilibrium {
            log.write(Status::Ok, OF_EQUILIBRIA);
        }
        for (name, bearing) in self.system.bearings() {
            log.write(Status::Ok, &format!("{name}: {}", bearing.scene().effects.simulated()));
        }
    }

    fn derivatives(&self, before: Option<&UnitSnapshot>, played: &[bool]) -> Outcome<Vec<Vec<f64>>> {
        derivatives::columns_of_system(self, before, &self.played(played))
    }
}
