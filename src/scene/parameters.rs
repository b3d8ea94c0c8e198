//! The numbers of a scene that can take another value without changing what the model is made of: their ranges, and
//! what a package offers as FMI parameters.

use super::{Drive, Scene, SceneError};

/// Bounds of a value; an open bound is not itself allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub low: f64,
    /// Is the lower bound not allowed itself?
    pub low_open: bool,
    /// Upper bound, allowed.
    pub high: f64,
    /// SI unit.
    pub unit: &'static str,
}

impl Range {
    /// Both bounds are allowed.
    pub const fn closed(low: f64, high: f64, unit: &'static str) -> Self {
        Self { low, low_open: false, high, unit }
    }

    /// The lower bound is not allowed.
    pub const fn above(low: f64, high: f64, unit: &'static str) -> Self {
        Self { low, low_open: true, high, unit }
    }

    /// Checks a value.
    ///
    /// # Errors
    /// Names the key, the value and the range.
    pub fn check(&self, key: &str, value: f64) -> Result<(), SceneError> {
        let inside = value <= self.high && if self.low_open { value > self.low } else { value >= self.low };
        if inside {
            return Ok(());
        }
        let bracket = if self.low_open { "(" } else { "[" };
        let range = format!("{bracket}{}, {}] {}", self.low, self.high, self.unit);
        Err(SceneError::Range { key: key.to_string(), value, unit: self.unit, range })
    }
}

/// When a parameter of a package may be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Before the start only: the model is built from it.
    Fixed,
    /// Between communication steps too.
    Tunable,
}

/// A number of a scene.
#[derive(Debug)]
pub struct Parameter {
    /// Section and key, as in the scene file.
    pub key: &'static str,
    /// Allowed values; others may be narrower because of other keys.
    pub range: Range,
    /// When a package's importer may set it.
    pub variability: Variability,
    /// One sentence.
    pub description: &'static str,
    place: fn(&mut Scene) -> Option<&mut f64>,
}

impl Parameter {
    /// Its place in a scene, to be read or changed; [`Scene::check`] tells whether a value is allowed. None if the scene
    /// makes no use of it.
    pub fn place<'a>(&self, scene: &'a mut Scene) -> Option<&'a mut f64> {
        (self.place)(scene)
    }
}

/// A parameter that the model is built from.
const fn fixed(
    key: &'static str,
    range: Range,
    description: &'static str,
    place: fn(&mut Scene) -> Option<&mut f64>,
) -> Parameter {
    Parameter { key, range, variability: Variability::Fixed, description, place }
}

/// A parameter that each step reads.
const fn tunable(
    key: &'static str,
    range: Range,
    description: &'static str,
    place: fn(&mut Scene) -> Option<&mut f64>,
) -> Parameter {
    Parameter { key, range, variability: Variability::Tunable, description, place }
}

const YOUNGS_MODULUS: Range = Range::closed(1e6, 1e13, "Pa");
const POISSON_RATIO: Range = Range::closed(0.0, 0.5, "");
const DENSITY: Range = Range::closed(1.0, 1e5, "kg/m3");
const CONFORMITY: Range = Range::above(0.5, 1.0, "");
const INERTIA: Range = Range::above(0.0, 1e5, "kg m2");
const GRAVITY: Range = Range::closed(-1e6, 1e6, "m/s2");
const TILT: Range = Range::closed(-0.2, 0.2, "rad");
const STEP: Range = Range::closed(1e-15, 1e-2, "s");

/// All of them, in the order of the scene file.
#[rustfmt::skip]
pub static PARAMETERS: [Parameter; 27] = [
    fixed("bearing.ball_diameter", Range::closed(1e-4, 1.0, "m"), "ball diameter",
        |s| Some(&mut s.bearing.ball_diameter.0)),
    fixed("bearing.pitch_diameter", Range::closed(1.2e-4, 1e3, "m"), "diameter of the circle through the ball centres",
        |s| Some(&mut s.bearing.pitch_diameter.0)),
    fixed("bearing.contact_angle", Range::closed(0.0, 1.5, "rad"), "free contact angle",
        |s| s.bearing.contact_angle.as_mut().map(|angle| &mut angle.0)),
    fixed("bearing.diametral_clearance", Range::closed(-0.1, 2.0, "m"), "diametral clearance; negative is interference",
        |s| s.bearing.diametral_clearance.as_mut().map(|clearance| &mut clearance.0)),
    fixed("bearing.inner_conformity", CONFORMITY, "inner groove radius over ball diameter",
        |s| Some(&mut s.bearing.inner_conformity)),
    fixed("bearing.outer_conformity", CONFORMITY, "outer groove radius over ball diameter",
        |s| Some(&mut s.bearing.outer_conformity)),
    fixed("bearing.first_ball_azimuth", Range::closed(-7.0, 7.0, "rad"), "azimuth of ball 1, from +y towards +z",
        |s| Some(&mut s.bearing.first_ball_azimuth.0)),
    fixed("ball.youngs_modulus", YOUNGS_MODULUS, "Young's modulus of the balls", |s| Some(&mut s.ball.youngs_modulus.0)),
    fixed("ball.poisson_ratio", POISSON_RATIO, "Poisson's ratio of the balls", |s| Some(&mut s.ball.poisson_ratio)),
    fixed("ball.density", DENSITY, "density of the balls", |s| Some(&mut s.ball.density.0)),
    fixed("race.youngs_modulus", YOUNGS_MODULUS, "Young's modulus of the races", |s| Some(&mut s.race.youngs_modulus.0)),
    fixed("race.poisson_ratio", POISSON_RATIO, "Poisson's ratio of the races", |s| Some(&mut s.race.poisson_ratio)),
    tunable("effects.damping", Range::closed(0.0, 10.0, "s/m"), "dissipation factor of the contacts (Hunt-Crossley)",
        |s| Some(&mut s.effects.damping.0)),
    tunable("effects.gravity.x", GRAVITY, "acceleration of gravity along x", |s| Some(&mut s.effects.gravity[0].0)),
    tunable("effects.gravity.y", GRAVITY, "acceleration of gravity along y", |s| Some(&mut s.effects.gravity[1].0)),
    tunable("effects.gravity.z", GRAVITY, "acceleration of gravity along z", |s| Some(&mut s.effects.gravity[2].0)),
    fixed("inner.mass", Range::above(0.0, 1e5, "kg"), "mass of the inner race and what is fixed to it",
        |s| body(s).then_some(s.inner.mass.as_mut()).flatten().map(|mass| &mut mass.0)),
    fixed("inner.inertia.x", INERTIA, "moment of inertia of the inner race about its own axis", |s| inertia(s, 0)),
    fixed("inner.inertia.y", INERTIA, "moment of inertia of the inner race about its y axis", |s| inertia(s, 1)),
    fixed("inner.inertia.z", INERTIA, "moment of inertia of the inner race about its z axis", |s| inertia(s, 2)),
    fixed("outer.misalignment.ry", TILT, "misalignment of the outer race about y",
        |s| (s.outer.drive != Drive::Pose).then_some(&mut s.outer.misalignment.ry)?.constant_mut()),
    fixed("outer.misalignment.rz", TILT, "misalignment of the outer race about z",
        |s| (s.outer.drive != Drive::Pose).then_some(&mut s.outer.misalignment.rz)?.constant_mut()),
    fixed("solver.alpha_f", Range::above(0.0, 1.0 / 3.0, ""), "numerical damping of the HHT scheme",
        |s| Some(&mut s.solver.alpha_f)),
    tunable("solver.tolerance", Range::closed(1e-14, 1e-2, ""), "local error of an internal step over the ball diameter",
        |s| Some(&mut s.solver.tolerance)),
    fixed("solver.initial_step", STEP, "first internal step", |s| Some(&mut s.solver.initial_step.0)),
    fixed("solver.max_step", Range::closed(1e-14, 1e-2, "s"), "largest internal step", |s| Some(&mut s.solver.max_step.0)),
    fixed("solver.min_step", STEP, "smallest internal step; a step that needs a smaller one is not finished",
        |s| Some(&mut s.solver.min_step.0)),
];

fn body(scene: &Scene) -> bool {
    scene.inner.drive == Drive::Wrench
}

fn inertia(scene: &mut Scene, axis: usize) -> Option<&mut f64> {
    body(scene).then_some(scene.inner.inertia.as_mut()).flatten().map(|moments| &mut moments[axis].0)
}
