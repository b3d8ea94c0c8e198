//! Groups of inputs of a package, and who gives them: the scene's script or the master.

use serde::{Deserialize, Serialize};
use strum::{Display, VariantArray};

/// Inputs of a package that are given together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display, VariantArray)]
#[strum(serialize_all = "snake_case")]
pub enum Group {
    /// Wrench applied to a race, as `inner.applied_force`, `inner.applied_moment`.
    Loads,
    /// Spin of a race that a wrench moves, as `inner.speed`.
    Speeds,
    /// Pose and twist of races in pose drive: displacements, tilts and spin, which make one motion.
    Tilts,
    /// `friction`.
    Friction,
    /// `temperature_rise`, of all parts.
    Temperatures,
    /// Motion of the bearing's frame and gravity in it, as `frame.angular_velocity`.
    Frame,
    /// `lubrication`.
    Lubrication,
}

/// A set of groups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Groups([bool; Group::VARIANTS.len()]);

impl Groups {
    /// All of them.
    pub const ALL: Self = Self([true; Group::VARIANTS.len()]);

    /// Is a group in the set?
    pub fn contains(self, group: Group) -> bool {
        self.0[group as usize]
    }

    /// The set with a group in it or not.
    #[must_use]
    pub fn with(mut self, group: Group, contained: bool) -> Self {
        self.0[group as usize] = contained;
        self
    }
}

/// Who gives a group of inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Giver {
    /// The scene, where it has a script, until the master sets one of these inputs.
    #[default]
    Scene,
    /// The master; the scene's script is not played.
    Master,
}

/// Who gives each group of inputs of an FMU: the scene's script, or the master, which is the program that runs the FMU.
/// `roulement run` plays all scripts.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InputGivers {
    /// Applied wrench.
    pub loads: Giver,
    /// Spin of a race that a wrench moves.
    pub speeds: Giver,
    /// Pose and twist of races in pose drive.
    pub tilts: Giver,
    /// Friction coefficient.
    pub friction: Giver,
    /// Temperatures of all parts.
    pub temperatures: Giver,
    /// Motion of the frame.
    pub frame: Giver,
    /// Degree of lubrication.
    pub lubrication: Giver,
}

impl InputGivers {
    /// Who gives a group.
    pub fn of(&self, group: Group) -> Giver {
        match group {
            Group::Loads => self.loads,
            Group::Speeds => self.speeds,
            Group::Tilts => self.tilts,
            Group::Friction => self.friction,
            Group::Temperatures => self.temperatures,
            Group::Frame => self.frame,
            Group::Lubrication => self.lubrication,
        }
    }
}
