//! Types that most programs need: `use roulement::prelude::*;`.

pub use crate::equilibrium::{self, EquilibriumInput, Gyroscopic};
pub use crate::model::bodies::Race;
pub use crate::scene::CreepLaw;
pub use crate::simulation::inputs::AxisInput;
pub use crate::{Inputs, Model, Outputs, Scene, SceneError, Simulation, SimulationError};
