//! Bearings on a shaft or on several, in motion together: one implicit step for all.

mod advance;
mod assembly;
mod change_level;
mod critical_speeds;
mod elements;
mod equilibrium;
mod inputs;
mod linear;
mod links;
mod loads;
mod motions;
mod outputs;
mod pace;
mod quasi_static;
mod snapshot;
mod start;
mod statics;
pub(super) mod steady_torque;
mod structures;

use std::sync::Arc;

use thiserror::Error;

use super::cage_push::CagePush;
use super::inputs::Inputs;
pub use super::path::Motion;
use super::{Simulation, SimulationError, follows_time};
use crate::effects::frame::FrameSection;
use crate::model::state::Statistics;
use crate::model::structure::{Carrier, StructureState};
use crate::numerics::step_control::StepControl;
use crate::scene::system::SystemScene;
use crate::schema::numbers::four;
pub use assembly::InBalance;
pub use change_level::LevelJump;
pub use critical_speeds::{Campbell, CampbellRow, CriticalSpeed, at_speed, campbell, largest_speed};
pub use equilibrium::{BearingEquilibrium, MachineEquilibrium};
pub use inputs::{Played, ShaftInputs, drive_is_scripted};
pub use linear::{Linear, ShaftMode, Whirl};
pub use loads::script_changes_within;
pub use outputs::{HousingOutputs, LinkOutputs, PointOutput, ShaftOutputs, SystemOutputs, TeethOutputs};
pub use snapshot::SystemSnapshot;
pub use structures::Structures;

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
        /// Name of the shaft or the housing.
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
    /// All of its bearings together could not.
    #[error(transparent)]
    Together(SimulationError),
    /// Inputs of another system.
    #[error("there are too many or too few inputs for this system")]
    OtherInputs,
}

/// Shafts on their bearings in motion. Cloning it saves everything; the clone goes on to the same bits.
#[derive(Clone, Debug)]
pub struct System {
    /// The bearings, in the order of the scene.
    bearings: Vec<Simulation>,
    /// Shafts and housings.
    structures: Structures,
}

impl System {
    /// The scene.
    pub fn scene(&self) -> &SystemScene {
        &self.structures.scene
    }

    /// The shafts.
    pub fn shafts(&self) -> &[Carrier] {
        &self.structures.carriers[..self.structures.scene.shafts.len()]
    }

    /// \[s] time.
    pub fn time(&self) -> f64 {
        self.structures.pace.time
    }

    /// States of the shafts.
    pub fn states(&self) -> &[StructureState] {
        &self.structures.states[..self.structures.scene.shafts.len()]
    }

    /// The bearings with their names, each in axes of its own; their inner races are where the shaft carries them.
    pub fn bearings(&self) -> impl Iterator<Item = (&str, &Simulation)> {
        self.structures.scene.bearings.iter().map(|mounted| mounted.name.as_str()).zip(&self.bearings)
    }

    /// Inputs of the shaft as set last; those of bearings are [`Simulation::inputs`].
    pub fn inputs(&self) -> &ShaftInputs {
        &self.structures.inputs
    }

    /// Sets the inputs of the next step: loads, drive and the motion of the frame, and those of every bearing in the order of the scene, where what is said of
    /// races on the shaft or in a housing counts for nothing. False, with nothing changed, if there are too many or too few.
    #[must_use]
    pub fn set_inputs(&mut self, shaft: ShaftInputs, bearings: Vec<Inputs>) -> bool {
        let fit = shaft.fits(&self.structures.inputs) && bearings.len() == self.bearings.len();
        if fit {
            self.structures.inputs = shaft;
            let mounted = &self.structures.scene.bearings;
            for ((bearing, mut inputs), mounted) in self.bearings.iter_mut().zip(bearings).zip(mounted) {
                // All bearings are in the frame of the machine.
                if let Some(frame) = &self.structures.inputs.frame {
                    inputs.effects.frame = frame.seen_along(mounted.mounting.direction.sign());
                }
                bearing.set_inputs(inputs);
            }
        }
        fit
    }

    /// Goes on with a scene that differs in tunable parameters of its bearings and steps alone.
    ///
    /// # Errors
    /// If a bearing has no equilibrium to begin its new level at; nothing is then changed.
    pub fn tune(&mut self, scene: &SystemScene) -> Result<(), SystemError> {
        self.change_levels(scene)?;
        let own = Arc::make_mut(&mut self.structures.scene);
        own.of_links = scene.of_links;
        for ((bearing, mounted), tuned) in
            self.bearings.iter_mut().zip(&mut own.bearings).zip(&scene.bearings)
        {
            bearing.tune(&tuned.scene);
            mounted.scene = tuned.scene.clone();
        }
        self.structures.solver = scene.solver();
        Ok(())
    }

    /// Work of its steps since the start, without that of contacts.
    pub fn statistics(&self) -> &Statistics {
        &self.structures.pace.statistics
    }

    /// Control of its steps.
    pub fn control(&self) -> &StepControl {
        &self.structures.pace.control
    }

    /// Pushes the cage of every bearing that has one ([`Simulation::push_cage`]).
    pub fn push_cages(&mut self, push: impl Fn(&Simulation) -> CagePush) {
        self.bearings.iter_mut().for_each(|bearing| bearing.push_cage(&push(bearing)));
    }

    /// Outputs of the shaft.
    pub fn outputs(&self) -> &SystemOutputs {
        &self.structures.outputs
    }
}

/// Does anything change by itself with time?
pub fn shaft_follows_time(scene: &SystemScene) -> bool {
    scene.shafts.iter().any(drive_is_scripted)
        || scene.loads().any(|load| load.is_scripted())
        || scene.gears().any(|gear| gear.torque.is_scripted())
        || scene.rotating().any(|part| part.force.is_some() || part.speed.is_some())
        || scene.gravity.is_scripted()
        || scene.motions().any(|(_, (.., schedule))| schedule.is_scripted())
        || scene.frame.as_ref().is_some_and(FrameSection::is_scripted)
        || scene.bearings.iter().any(|bearing| follows_time(&bearing.scene))
}

/// Positions of all stations of a shaft along it \[m]: its bearings, then loads, points, discs, gears and forces that turn.
fn stations(scene: &SystemScene, shaft: usize) -> Vec<f64> {
    let bearings = scene.bearings_on(shaft).map(|bearing| match &scene.bearings[bearing] {
        mounted if mounted.shaft == shaft => mounted.mounting.position.0,
        mounted => mounted.place(&scene.shafts)[0] - scene.shafts[shaft].place(0.0)[0],
    });
    bearings.chain(scene.shafts[shaft].positions()).chain(links::positions(scene, shaft)).collect()
}

/// First station of loads, of points, of discs, of gears and of forces that turn of a shaft.
fn first_stations(scene: &SystemScene, shaft: usize) -> [usize; 5] {
    let section = &scene.shafts[shaft];
    let loads = scene.bearings_on(shaft).count();
    let points = loads + section.load.len();
    let discs = points + section.point.len();
    let gears = discs + section.disc.len();
    [loads, points, discs, gears, gears + section.gear.len()]
}

/// Places of all stations of a housing \[m]: its bearings, then its loads and points, then its bearings by their stiffness.
fn places_of_housing(scene: &SystemScene, index: usize) -> Vec<[f64; 3]> {
    let housing = &scene.housings[index];
    let seats = scene.bearings_in(index).map(|bearing| scene.bearings[bearing].place(&scene.shafts));
    let loads = housing.load.iter().map(|load| load.position.map(|length| length.0));
    let points = housing.point.iter().map(|point| point.position.map(|length| length.0));
    let springs = scene.springs.iter().filter(|spring| spring.housing == Some(index));
    let springs = springs.map(|spring| scene.shafts[spring.shaft].place(spring.position));
    seats.chain(loads).chain(points).chain(springs).collect()
}

/// First station of a housing's loads and of its points.
fn housing_stations(scene: &SystemScene, index: usize) -> [usize; 2] {
    let loads = scene.bearings_in(index).count();
    [loads, loads + scene.housings[index].load.len()]
}
