//! Parts of scenes: quantities with units, schedules, sections, ranges of numbers, and why a scene is refused.

mod accuracy;
mod components;
mod error;
pub mod explain;
mod follow;
mod housing;
mod inputs;
mod machine;
mod matrices;
mod mesh;
pub mod numbers;
mod phase;
mod race;
pub mod reader;
pub mod regular;
pub mod schedule;
mod sections;
mod shaft;
mod support;
pub mod units;
pub mod variable_units;

pub use accuracy::{Accuracy, ErrorGoal, ErrorOf, Level, Method, Solver};
pub use components::Components;
pub use error::SceneError;
pub use follow::{Follows, SMALLEST_TOLERANCE};
pub use housing::*;
pub use inputs::{Giver, Group, Groups, InputGivers};
pub use machine::{GearSection, Machine, RotatingSection};
pub use matrices::{Matrices, StructureMatrices};
pub use mesh::*;
pub use phase::{PhaseSection, check_phases};
pub use race::Race;
pub use schedule::{Schedule, Sine};
pub use sections::*;
pub use shaft::*;
pub use support::{DirectionMatrix, SupportSection};
