//! Losses of a bearing by part; each part is defined by the effect that it is of.

use super::reports::ContactOutput;
use crate::effects::Effects;

/// \[W] powers at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    /// Sliding and spin where balls touch races and one another.
    pub sliding: f64,
    /// Friction of the cage: in its pockets and on its lands.
    pub cage: f64,
    /// Moments against rolling in the material.
    pub resisting: f64,
    /// Rolling resistance of the oil.
    pub rolling: f64,
    /// Drag of the medium around the balls.
    pub drag: f64,
    /// Damping of all contacts.
    pub damping: f64,
    /// Dampers of supports.
    pub support: f64,
}

/// A part of the losses that is reported.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Name of its variable.
    pub name: &'static str,
    /// Description in one sentence.
    pub description: &'static str,
    /// The part in a few words.
    pub words: &'static str,
    /// Is there anything among the effects of a scene that it can be lost to?
    pub is_of: fn(&Effects) -> bool,
    /// \[W] its power.
    pub get: fn(&Losses) -> f64,
}

/// A part of the power that contacts with the races lose, defined by its effect.
#[derive(Clone, Copy, Debug)]
pub struct ContactPower {
    /// Its name, such as "groove".
    pub name: &'static str,
    /// \[W] its value.
    pub get: fn(&ContactOutput) -> f64,
}

/// The whole.
pub const TOTAL: Part = Part {
    name: "loss.total",
    description: "all power that the bearing loses: what its races have to bring at even speed",
    words: "all losses",
    is_of: |_| true,
    get: Losses::total,
};

/// Part that is lost whatever is simulated.
pub const SLIDING: Part = Part {
    name: "loss.sliding",
    description: "power lost to sliding and spin where balls touch races and one another",
    words: "sliding of balls",
    is_of: |_| true,
    get: |losses| losses.sliding,
};

impl Losses {
    /// \[W] all of it.
    pub fn total(&self) -> f64 {
        let Self { sliding, cage, resisting, rolling, drag, damping, support } = self;
        sliding + cage + resisting + rolling + drag + damping + support
    }
}
