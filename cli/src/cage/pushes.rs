//! Push of a cage.

use roulement::scene::machine::MachineScene;
use roulement::scene::{Scene, Schedule};

/// [m/s2] standard gravity.
const GRAVITY: f64 = 9.80665;

/// A push.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Push {
    /// None but those that the scene has.
    AsItIs,
    /// Weight of cage, balls and moved rings, across the axis.
    Weight,
    /// It starts half of its play off the centre.
    Offset,
    /// It starts with a velocity across the axis that takes it through its play while it turns by 1 rad.
    Kick,
}

impl Push {
    /// Those that a scene does not have already.
    pub fn of(scene: &MachineScene) -> Vec<Self> {
        let weighs = |scene: &Scene| {
            let [_, y, z] = &scene.effects.gravity.acceleration.0;
            *y != Schedule::default() || *z != Schedule::default()
        };
        // Gravity of a frame that moves is an input.
        let framed = |scene: &Scene| scene.effects.frame.section.is_some();
        let has = scene.bearings().iter().any(|(_, own)| weighs(own) || framed(own));
        let weight = if has { None } else { Some(Self::Weight) };
        [Some(Self::AsItIs), weight, Some(Self::Offset), Some(Self::Kick)].into_iter().flatten().collect()
    }

    /// The scene that is run with it.
    pub fn scene(self, scene: &MachineScene) -> MachineScene {
        match self {
            Self::Weight => {
                scene.with(|own| own.effects.gravity.acceleration.0[2] = Schedule::Constant(-GRAVITY))
            }
            _ => scene.clone(),
        }
    }

    /// In a word or two.
    pub fn name(self) -> &'static str {
        match self {
            Self::AsItIs => "as it is",
            Self::Weight => "weight",
            Self::Offset => "offset",
            Self::Kick => "kick",
        }
    }
}
