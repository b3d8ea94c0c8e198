//! Several bearings on a shaft, in motion together: one implicit step for all.

mod advance;
mod course;
mod critical_speeds;
mod equilibrium;
mod inputs;
mod linear;
mod loads;
mod motions;
mod outputs;
mod quasi_static;
mod snapshot;
mod start;
mod statics;

use std::sync::Arc;

use nalgebra::DVector;
use thiserror::Error;

use super::inputs::Inputs;
use super::{Simulation, SimulationError, follows_time};
use crate::dynamics::system::{Joint, SystemWorkspace};
use crate::model::structure::{Carrier, StructureState};
use crate::numerics::step_control::StepControl;
use crate::scene::Scene;
use crate::scene::system::SystemScene;
use crate::schema::numbers::four;
pub use critical_speeds::{Campbell, CampbellRow, CriticalSpeed, at_speed, campbell, largest_speed};
pub use equilibrium::{BearingEquilibrium, MachineEquilibrium};
use inputs::ShaftPaths;
pub use inputs::{Played, ShaftInputs, drive_is_scripted};
pub use linear::{Linear, ShaftMode, Whirl};
pub use loads::script_changes_within;
pub use outputs::{HousingOutputs, PointOutput, SystemOutputs};
pub use snapshot::SystemSnapshot;

/// Why a system could not start or go on.
#[derive(Debug, Error)]
pub enum SystemError {
    /// One of its bearings could not.
    #[error("bearing \"{name}\": {source}")]
    Bearing {
        /// The bearing.
        name: String,
        /// Why not.
        source: SimulationError,
    },
    /// The shaft or a housing cannot be built.
    #[error("{name}: {why}")]
    Structure {
        /// What it is.
        name: String,
        /// Why not.
        why: String,
    },
    /// The shaft finds no balance on its bearings.
    #[error(
        "the shaft finds no equilibrium on its bearings: after {iterations} iterations {residual:.3e} N are out of balance \
         (is it held in every direction, axially too?)"
    )]
    NoEquilibrium {
        /// Iterations spent.
        iterations: u32,
        /// \[N] largest unbalanced force.
        residual: f64,
    },
    /// A housing is too soft.
    #[error(
        "no equilibrium is found: housing \"{housing}\" gives way, and the seat of bearing \"{bearing}\" is tilted by {tilt:.3} rad; what \
         holds the housing is too soft for the loads"
    )]
    GivesWay {
        /// The housing.
        housing: String,
        /// The bearing.
        bearing: String,
        /// \[rad] tilt of its seat where the search ended.
        tilt: f64,
    },
    /// A preload that nothing holds.
    #[error(
        "bearing \"{name}\": mounting.preload asks for {} N, and {} N are left on a shaft without loads: nothing holds it; a preload needs \
         a bearing that pushes against it, as two of opposite mounting.direction do",
        four(.asked), four(.left)
    )]
    Preload {
        /// The bearing.
        name: String,
        /// \[N] asked for.
        asked: f64,
        /// \[N] left.
        left: f64,
    },
    /// A step end that is not a time after the present one.
    #[error("cannot advance from {from} s to {to} s")]
    Backwards {
        /// \[s] present time.
        from: f64,
        /// \[s] asked for.
        to: f64,
    },
    /// A bearing is tilted further than linear structures are valid for.
    #[error(
        "at {} s the {race} race of bearing \"{name}\" is tilted by {tilt:.3} rad: more than {limit} rad, the most that the linear \
         equations of a shaft or a housing hold for",
        four(.time)
    )]
    Tilted {
        /// \[s] time.
        time: f64,
        /// The bearing.
        name: String,
        /// Its race.
        race: &'static str,
        /// \[rad] tilt.
        tilt: f64,
        /// \[rad] largest tilt.
        limit: f64,
    },
    /// The step has no derivatives.
    #[error("at {} s the step has no derivatives: its Newton matrix is singular", four(.0))]
    Singular(f64),
    /// Inputs of another system.
    #[error("there are too many or too few inputs for this system")]
    OtherInputs,
    /// So late that a step no longer changes the time.
    #[error("at {} s a step of {} s is lost in rounding: begin nearer to time 0", four(.time), four(.step))]
    LostInRounding {
        /// \[s] time reached.
        time: f64,
        /// \[s] step.
        step: f64,
    },
}

/// A shaft on its bearings in motion. Cloning it saves everything; the clone goes on to the same bits.
#[derive(Clone, Debug)]
pub struct System {
    scene: Arc<SystemScene>,
    /// The shaft, then the housings in the order of the scene.
    carriers: Arc<Vec<Carrier>>,
    /// [`crate::model::structure::Structure::scales`] of each.
    scales: Vec<DVector<f64>>,
    /// The bearings, in the order of the scene.
    bearings: Vec<Simulation>,
    joints: Arc<Vec<Joint>>,
    inputs: ShaftInputs,
    paths: ShaftPaths,
    /// State of each structure.
    states: Vec<StructureState>,
    control: StepControl,
    time: f64,
    outputs: SystemOutputs,
    workspace: SystemWorkspace,
}

impl System {
    /// The scene.
    pub fn scene(&self) -> &SystemScene {
        &self.scene
    }

    /// The shaft.
    pub fn shaft(&self) -> &Carrier {
        &self.carriers[0]
    }

    /// \[s] time.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// State of the shaft.
    pub fn state(&self) -> &StructureState {
        &self.states[0]
    }

    /// The bearings with their names, each in axes of its own; their inner races are where the shaft carries them.
    pub fn bearings(&self) -> impl Iterator<Item = (&str, &Simulation)> {
        self.scene.bearings.iter().map(|mounted| mounted.name.as_str()).zip(&self.bearings)
    }

    /// Inputs of the shaft as set last; those of bearings are [`Simulation::inputs`].
    pub fn inputs(&self) -> &ShaftInputs {
        &self.inputs
    }

    /// Sets the inputs of the next step: loads and drive, and those of every bearing in the order of the scene, where what is said of
    /// races on the shaft or in a housing counts for nothing. False, with nothing changed, if there are too many or too few.
    #[must_use]
    pub fn set_inputs(&mut self, shaft: ShaftInputs, bearings: Vec<Inputs>) -> bool {
        let fit = shaft.fits(&self.inputs) && bearings.len() == self.bearings.len();
        if fit {
            self.inputs = shaft;
            self.bearings.iter_mut().zip(bearings).for_each(|(bearing, inputs)| bearing.set_inputs(inputs));
        }
        fit
    }

    /// Goes on with scenes of its bearings, in their order, that differ in tunable parameters alone.
    pub fn tune(&mut self, scenes: &[Scene]) {
        let own = Arc::make_mut(&mut self.scene).bearings.iter_mut();
        for ((bearing, mounted), scene) in self.bearings.iter_mut().zip(own).zip(scenes) {
            bearing.tune(scene);
            mounted.scene = scene.clone();
        }
    }

    /// What the shaft does.
    pub fn outputs(&self) -> &SystemOutputs {
        &self.outputs
    }

    /// An error of one of the bearings.
    fn of_bearing(&self, index: usize, source: SimulationError) -> SystemError {
        SystemError::Bearing { name: self.scene.bearings[index].name.clone(), source }
    }
}

/// Does anything change by itself with time?
pub fn shaft_follows_time(scene: &SystemScene) -> bool {
    drive_is_scripted(scene)
        || scene.loads().any(|load| load.is_scripted())
        || scene.shaft.gear.iter().any(|gear| gear.torque.is_scripted())
        || scene.bearings.iter().any(|bearing| follows_time(&bearing.scene))
}

/// Positions of all stations of a shaft \[m]: bearings, then loads, points, discs and gears.
fn stations(scene: &SystemScene) -> Vec<f64> {
    let shaft = &scene.shaft;
    let bearings = scene.bearings.iter().map(|bearing| bearing.mounting.position.0);
    let loads = shaft.load.iter().map(|load| load.position.0);
    let points = shaft.point.iter().map(|point| point.position.0);
    let discs = shaft.disc.iter().map(|disc| disc.position.0);
    let gears = shaft.gear.iter().map(|gear| gear.offset.0);
    bearings.chain(loads).chain(points).chain(discs).chain(gears).collect()
}

/// First station of loads, of points, of discs and of gears.
fn first_stations(scene: &SystemScene) -> [usize; 4] {
    let loads = scene.bearings.len();
    let points = loads + scene.shaft.load.len();
    let discs = points + scene.shaft.point.len();
    [loads, points, discs, discs + scene.shaft.disc.len()]
}

/// Places of all stations of a housing \[m]: its bearings, then its loads and points.
fn places_of_housing(scene: &SystemScene, index: usize) -> Vec<[f64; 3]> {
    let housing = &scene.housings[index];
    let seats =
        scene.bearings_in(index).map(|bearing| [scene.bearings[bearing].mounting.position.0, 0.0, 0.0]);
    let loads = housing.load.iter().map(|load| load.position.map(|length| length.0));
    let points = housing.point.iter().map(|point| point.position.map(|length| length.0));
    seats.chain(loads).chain(points).collect()
}

/// First station of a housing's loads and of its points.
fn housing_stations(scene: &SystemScene, index: usize) -> [usize; 2] {
    let loads = scene.bearings_in(index).count();
    [loads, loads + scene.housings[index].load.len()]
}
