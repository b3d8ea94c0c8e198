//! Push of a cage.

use roulement::scene::machine::MachineScene;
use roulement::scene::units::Unbalance;
use roulement::scene::{CageSection, Scene, Schedule};

/// [m/s2] standard gravity.
const GRAVITY: f64 = 9.80665;

/// A push.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Push {
    /// None but those that the scene has.
    AsItIs,
    /// Weight of cage, balls and moved rings, across the axis.
    Weight,
    /// Its centre of mass is half of its play off its axis.
    Unbalance,
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
        let cages = scene.bearings().into_iter().filter_map(|(_, own)| own.effects.cage.section);
        let has = cages.filter_map(|cage| cage.unbalance).any(|product| product.0 > 0.0);
        // A frame that moves allows none.
        let can = !has && !scene.bearings().iter().any(|(_, own)| framed(own));
        let unbalance = can.then_some(Self::Unbalance);
        [Some(Self::AsItIs), weight, unbalance, Some(Self::Offset), Some(Self::Kick)]
            .into_iter()
            .flatten()
            .collect()
    }

    /// The scene that is run with it.
    pub fn scene(self, scene: &MachineScene) -> MachineScene {
        match self {
            Self::Weight => {
                scene.with(|own| own.effects.gravity.acceleration.0[2] = Schedule::Constant(-GRAVITY))
            }
            Self::Unbalance => scene.with(|own| {
                if let Some(cage) = &mut own.effects.cage.section {
                    cage.unbalance = Some(Unbalance(usual_unbalance(cage)));
                }
            }),
            Self::AsItIs | Self::Offset | Self::Kick => scene.clone(),
        }
    }

    /// In a word or two.
    pub fn name(self) -> &'static str {
        match self {
            Self::AsItIs => "as it is",
            Self::Weight => "weight",
            Self::Unbalance => "unbalance",
            Self::Offset => "offset",
            Self::Kick => "kick",
        }
    }
}

/// [kg m] unbalance of a cage whose centre of mass lies half of its play off its axis, or as far as its inertia allows.
fn usual_unbalance(cage: &CageSection) -> f64 {
    let play = 0.5 * cage.guidance_clearance.unwrap_or(cage.pocket_clearance).0;
    (0.5 * play * cage.mass.0).min(cage.largest_unbalance())
}
