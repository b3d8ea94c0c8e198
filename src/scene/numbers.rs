//! The one table of the numbers of a scene, but for those of its effects, which stand with them.

use super::{Drive, RaceLoad, Scene, SceneError, Schedule};
use crate::effects::growth::EXPANSION;
use crate::schema::SMALLEST_TOLERANCE;
use crate::schema::numbers::{FRICTION, Number, POISSON_RATIO, Parameter, Place, Range, YOUNGS_MODULUS};

const DENSITY: Range = Range::closed(1.0, 1e5, "kg/m3");
const CONFORMITY: Range = Range::above(0.5, 1.0, "");
/// A groove, or a sphere about the axis, of the largest pitch diameter that balls have ([`super::validate`]).
const OUTER_CONFORMITY: Range = Range::above(0.5, 1e3, "");
const MASS: Range = Range::above(0.0, 1e5, "kg");
const INERTIA: Range = Range::above(0.0, 1e5, "kg m2");
const TILT: Range = Range::closed(-0.2, 0.2, "rad");
const SPEED: Range = Range::closed(-1e5, 1e5, "rad/s");
const FORCE: Range = Range::closed(-1e9, 1e9, "N");
const MOMENT: Range = Range::closed(-1e8, 1e8, "N m");
const DISPLACEMENT: Range = Range::closed(-0.1, 0.1, "m");
/// Heights of shoulders; the groove radius is their limit.
const LENGTH: Range = Range::closed(0.0, 1.0, "m");
/// A groove ends before the ball stands on the race's side, but for rounding.
const RIGHT_ANGLE: Range = Range::closed(0.0, std::f64::consts::FRAC_PI_2 * (1.0 + 1e-12), "rad");
/// Steps; the smallest, first and largest must agree, too.
pub(super) const STEP: Range = Range::closed(1e-15, 1e-2, "s");
pub(super) const MAX_STEP: Range = Range::closed(1e-14, 1e-2, "s");
pub(super) const ERROR_GOAL: Range = Range::closed(1e-7, 0.5, "");
pub(super) const DAMPING: Range = Range::above(0.0, 1.0 / 3.0, "");
pub(super) const TOLERANCE: Range = Range::closed(SMALLEST_TOLERANCE, 1e-2, "");
pub(super) const SHARE: Range = Range::closed(0.0, 1.0, "");

/// Bearing and materials: those before the effects.
#[rustfmt::skip]
static BEARING: [Number<Scene>; 17] = [
    Number::checked("bearing.balls", Range::closed(1.0, 200.0, ""), |s| Place::Read(vec![s.bearing.balls as f64])),
    Number::fixed("bearing.ball_diameter", Range::closed(1e-4, 1.0, "m"), "ball diameter",
        |s| Place::Value(Some(&mut s.bearing.ball_diameter.0))),
    Number::fixed("bearing.pitch_diameter", Range::closed(1.2e-4, 1e3, "m"), "diameter of the circle through the ball centres",
        |s| Place::Value(Some(&mut s.bearing.pitch_diameter.0))),
    Number::fixed("bearing.contact_angle", Range::closed(0.0, std::f64::consts::FRAC_PI_2, "rad"), "free contact angle",
        |s| Place::Value(s.bearing.contact_angle.as_mut().map(|angle| &mut angle.0))),
    Number::fixed("bearing.diametral_clearance", Range::closed(-0.1, 2.0, "m"), "diametral clearance; negative is interference",
        |s| Place::Value(s.bearing.diametral_clearance.as_mut().map(|clearance| &mut clearance.0))),
    Number::fixed("bearing.inner_conformity", CONFORMITY, "inner groove radius over ball diameter",
        |s| Place::Value(Some(&mut s.bearing.inner_conformity))),
    Number::fixed("bearing.outer_conformity", OUTER_CONFORMITY, "outer groove radius over ball diameter",
        |s| Place::Value(Some(&mut s.bearing.outer_conformity))),
    Number::fixed("bearing.first_ball_azimuth", Range::closed(-7.0, 7.0, "rad"), "azimuth of ball 1, from +y towards +z",
        |s| Place::Value(Some(&mut s.bearing.first_ball_azimuth.0))),
    Number::fixed("ball.youngs_modulus", YOUNGS_MODULUS, "Young's modulus of the balls",
        |s| Place::Value(Some(&mut s.ball.youngs_modulus.0))),
    Number::fixed("ball.poisson_ratio", POISSON_RATIO, "Poisson's ratio of the balls",
        |s| Place::Value(Some(&mut s.ball.poisson_ratio))),
    Number::fixed("ball.density", DENSITY, "density of the balls", |s| Place::Value(Some(&mut s.ball.density.0))),
    Number::fixed_if("ball.thermal_expansion", EXPANSION, "coefficient of thermal expansion of the balls", grows,
        |s| Place::Value(Some(&mut s.ball.thermal_expansion.0))),
    Number::fixed("race.youngs_modulus", YOUNGS_MODULUS, "Young's modulus of the races",
        |s| Place::Value(Some(&mut s.race.youngs_modulus.0))),
    Number::fixed("race.poisson_ratio", POISSON_RATIO, "Poisson's ratio of the races",
        |s| Place::Value(Some(&mut s.race.poisson_ratio))),
    Number::fixed_if("race.density", DENSITY, "density of the races", grows, |s| Place::Value(Some(&mut s.race.density.0))),
    Number::fixed_if("race.thermal_expansion", EXPANSION, "coefficient of thermal expansion of the races", grows,
        |s| Place::Value(Some(&mut s.race.thermal_expansion.0))),
    // A package has it as an input.
    Number::checked("friction.ball_race", FRICTION, |s| Place::Schedule(&mut s.friction.ball_race)),
];

/// Cage friction, races, start, time integration and load: those after the effects.
#[rustfmt::skip]
static MOTION: [Number<Scene>; 59] = [
    Number::fixed("friction.ball_cage", FRICTION, "friction coefficient of the balls in their pockets", |s| Place::Value(s.friction.ball_cage.as_mut())),
    Number::fixed("friction.cage_race", FRICTION, "friction coefficient of the cage on the lands", |s| Place::Value(s.friction.cage_race.as_mut())),
    Number::fixed("friction.ball_ball", FRICTION, "friction coefficient of neighbouring balls", |s| Place::Value(s.friction.ball_ball.as_mut())),
    Number::fixed_if("inner.mass", MASS, "mass of the inner race and what is fixed to it", inner_moves,
        |s| Place::Value(s.inner.mass.as_mut().map(|mass| &mut mass.0))),
    Number::fixed_if("inner.inertia.x", INERTIA, "moment of inertia of the inner race about its own axis", inner_moves,
        |s| Place::Value(s.inner.inertia.as_mut().map(|moments| &mut moments[0].0))),
    Number::fixed_if("inner.inertia.y", INERTIA, "moment of inertia of the inner race about its y axis", inner_moves,
        |s| Place::Value(s.inner.inertia.as_mut().map(|moments| &mut moments[1].0))),
    Number::fixed_if("inner.inertia.z", INERTIA, "moment of inertia of the inner race about its z axis", inner_moves,
        |s| Place::Value(s.inner.inertia.as_mut().map(|moments| &mut moments[2].0))),
    Number::checked("inner.misalignment.ry", TILT, |s| Place::Schedule(&mut s.inner.misalignment.ry)),
    Number::checked("inner.misalignment.rz", TILT, |s| Place::Schedule(&mut s.inner.misalignment.rz)),
    Number::fixed("inner.turn", Range::closed(-7.0, 7.0, "rad"), "turn of the inner race about its own axis at the start",
        |s| Place::Value(s.inner.turn.as_mut().map(|turn| &mut turn.0))),
    Number::fixed("inner.shoulder_height.minus_x", LENGTH, "height over the groove's bottom of the shoulder at the -x side of the inner race",
        |s| Place::Value(s.inner.shoulder_height.as_mut().map(|heights| &mut heights[0].0))),
    Number::fixed("inner.shoulder_height.plus_x", LENGTH, "height over the groove's bottom of the shoulder at the +x side of the inner race",
        |s| Place::Value(s.inner.shoulder_height.as_mut().map(|heights| &mut heights[1].0))),
    Number::fixed("inner.shoulder_angle.minus_x", RIGHT_ANGLE, "contact angle at which the groove ends at the -x side of the inner race",
        |s| Place::Value(s.inner.shoulder_angle.as_mut().map(|angles| &mut angles[0].0))),
    Number::fixed("inner.shoulder_angle.plus_x", RIGHT_ANGLE, "contact angle at which the groove ends at the +x side of the inner race",
        |s| Place::Value(s.inner.shoulder_angle.as_mut().map(|angles| &mut angles[1].0))),
    Number::fixed_if("outer.mass", MASS, "mass of the outer race and what is fixed to it", outer_moves,
        |s| Place::Value(s.outer.mass.as_mut().map(|mass| &mut mass.0))),
    Number::fixed_if("outer.inertia.x", INERTIA, "moment of inertia of the outer race about its own axis", outer_moves,
        |s| Place::Value(s.outer.inertia.as_mut().map(|moments| &mut moments[0].0))),
    Number::fixed_if("outer.inertia.y", INERTIA, "moment of inertia of the outer race about its y axis", outer_moves,
        |s| Place::Value(s.outer.inertia.as_mut().map(|moments| &mut moments[1].0))),
    Number::fixed_if("outer.inertia.z", INERTIA, "moment of inertia of the outer race about its z axis", outer_moves,
        |s| Place::Value(s.outer.inertia.as_mut().map(|moments| &mut moments[2].0))),
    Number::fixed_if("outer.misalignment.ry", TILT, "misalignment of the outer race about y", outer_has_frame,
        |s| Place::Schedule(&mut s.outer.misalignment.ry)),
    Number::fixed_if("outer.misalignment.rz", TILT, "misalignment of the outer race about z", outer_has_frame,
        |s| Place::Schedule(&mut s.outer.misalignment.rz)),
    Number::fixed("outer.turn", Range::closed(-7.0, 7.0, "rad"), "turn of the outer race about its own axis at the start",
        |s| Place::Value(s.outer.turn.as_mut().map(|turn| &mut turn.0))),
    Number::fixed("outer.shoulder_height.minus_x", LENGTH, "height over the groove's bottom of the shoulder at the -x side of the outer race",
        |s| Place::Value(s.outer.shoulder_height.as_mut().map(|heights| &mut heights[0].0))),
    Number::fixed("outer.shoulder_height.plus_x", LENGTH, "height over the groove's bottom of the shoulder at the +x side of the outer race",
        |s| Place::Value(s.outer.shoulder_height.as_mut().map(|heights| &mut heights[1].0))),
    Number::fixed("outer.shoulder_angle.minus_x", RIGHT_ANGLE, "contact angle at which the groove ends at the -x side of the outer race",
        |s| Place::Value(s.outer.shoulder_angle.as_mut().map(|angles| &mut angles[0].0))),
    Number::fixed("outer.shoulder_angle.plus_x", RIGHT_ANGLE, "contact angle at which the groove ends at the +x side of the outer race",
        |s| Place::Value(s.outer.shoulder_angle.as_mut().map(|angles| &mut angles[1].0))),
    Number::checked("start.orbital_speed", SPEED,
        |s| Place::Value(s.start.orbital_speed.as_mut().map(|speed| &mut speed.0))),
    Number::checked("start.ball_angular_velocity", Range::closed(-1e6, 1e6, "rad/s"),
        |s| Place::Read(s.start.ball_angular_velocity.iter().flatten().map(|component| component.0).collect())),
    Number::checked("start.inner_velocity", Range::closed(-1e4, 1e4, "m/s"),
        |s| Place::Read(s.start.inner_velocity.iter().flatten().map(|component| component.0).collect())),
    // Before the settings that follow from it.
    Number::checked("solver.accuracy.error", ERROR_GOAL,
        |s| Place::Read(s.solver.goal.iter().map(|goal| goal.error).collect())),
    Number::fixed("solver.alpha_f", DAMPING, "numerical damping of the HHT scheme",
        |s| Place::Value(Some(&mut s.solver.alpha_f))),
    Number::tunable("solver.tolerance", TOLERANCE, "local error of an internal step over the ball diameter",
        |s| Place::Value(Some(&mut s.solver.tolerance))),
    Number::fixed("solver.initial_step", STEP, "first internal step",
        |s| Place::Value(Some(&mut s.solver.initial_step.0))),
    Number::fixed("solver.max_step", MAX_STEP, "largest internal step",
        |s| Place::Value(Some(&mut s.solver.max_step.0))),
    Number::fixed("solver.min_step", STEP, "smallest internal step; a step that needs a smaller one is not finished",
        |s| Place::Value(Some(&mut s.solver.min_step.0))),
    Number::checked("solver.matrix_reuse", SHARE, |s| Place::Value(Some(&mut s.solver.matrix_reuse))),
    Number::checked("solver.energy_error", SHARE, |s| Place::Value(Some(&mut s.solver.energy_error))),
    Number::checked("load.duration", Range::above(0.0, 1e6, "s"), |s| Place::Value(Some(&mut s.load.duration.0))),
    Number::checked("load.inner_speed", SPEED, |s| Place::Schedule(&mut s.load.inner_speed)),
    Number::checked("load.outer_speed", SPEED, |s| Place::Schedule(&mut s.load.outer_speed)),
    Number::checked("load.x.force", FORCE, |s| values(&s.load.x.force)),
    Number::checked("load.x.displacement", DISPLACEMENT, |s| values(&s.load.x.displacement)),
    Number::checked("load.y.force", FORCE, |s| values(&s.load.y.force)),
    Number::checked("load.y.displacement", DISPLACEMENT, |s| values(&s.load.y.displacement)),
    Number::checked("load.z.force", FORCE, |s| values(&s.load.z.force)),
    Number::checked("load.z.displacement", DISPLACEMENT, |s| values(&s.load.z.displacement)),
    Number::checked("load.ry.moment", MOMENT, |s| values(&s.load.ry.moment)),
    Number::checked("load.ry.rotation", TILT, |s| values(&s.load.ry.rotation)),
    Number::checked("load.rz.moment", MOMENT, |s| values(&s.load.rz.moment)),
    Number::checked("load.rz.rotation", TILT, |s| values(&s.load.rz.rotation)),
    Number::checked("load.outer.x.force", FORCE, |s| outer(s, |load| &load.x.force)),
    Number::checked("load.outer.x.displacement", DISPLACEMENT, |s| outer(s, |load| &load.x.displacement)),
    Number::checked("load.outer.y.force", FORCE, |s| outer(s, |load| &load.y.force)),
    Number::checked("load.outer.y.displacement", DISPLACEMENT, |s| outer(s, |load| &load.y.displacement)),
    Number::checked("load.outer.z.force", FORCE, |s| outer(s, |load| &load.z.force)),
    Number::checked("load.outer.z.displacement", DISPLACEMENT, |s| outer(s, |load| &load.z.displacement)),
    Number::checked("load.outer.ry.moment", MOMENT, |s| outer(s, |load| &load.ry.moment)),
    Number::checked("load.outer.ry.rotation", TILT, |s| outer(s, |load| &load.ry.rotation)),
    Number::checked("load.outer.rz.moment", MOMENT, |s| outer(s, |load| &load.rz.moment)),
    Number::checked("load.outer.rz.rotation", TILT, |s| outer(s, |load| &load.rz.rotation)),
];

/// Do temperatures and fits change the dimensions?
fn grows(scene: &Scene) -> bool {
    scene.effects.growth.section.is_some()
}

fn inner_moves(scene: &Scene) -> bool {
    scene.inner.drive == Drive::Wrench
}

fn outer_moves(scene: &Scene) -> bool {
    matches!(scene.outer.drive, Drive::Hinge | Drive::Wrench)
}

/// A race whose pose is given has no frame of its own, nor has one that a wrench moves.
fn outer_has_frame(scene: &Scene) -> bool {
    matches!(scene.outer.drive, Drive::Fixed | Drive::Hinge)
}

/// All values of a schedule, if it was given.
fn values(schedule: &Option<Schedule>) -> Place<'static> {
    Place::Read(schedule.as_ref().map(Schedule::values).unwrap_or_default())
}

/// All values of a schedule of the load on the outer race, if it was given.
fn outer(scene: &Scene, of: impl Fn(&RaceLoad) -> &Option<Schedule>) -> Place<'static> {
    scene.load.outer.as_ref().map_or(Place::Read(vec![]), |load| values(of(load)))
}

impl Scene {
    /// Checks every number against its range.
    pub(super) fn check_numbers(&self) -> Result<(), SceneError> {
        let mut copy = self.clone();
        BEARING.iter().chain(&MOTION).try_for_each(|number| number.check(&mut copy))?;
        self.effects.check_numbers()
    }

    /// The numbers that a package offers, in the order of the scene file.
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut copy = self.clone();
        let mut parameters: Vec<_> =
            BEARING.iter().filter_map(|number| number.parameter(&mut copy)).collect();
        parameters.extend(self.effects.parameters());
        parameters.extend(MOTION.iter().filter_map(|number| number.parameter(&mut copy)));
        parameters
    }

    /// Gives the number of a key another value; [`Scene::check`] tells whether it is allowed. A key that the scene has no
    /// number of changes nothing.
    pub fn set_number(&mut self, key: &str, value: f64) {
        let place = match BEARING.iter().chain(&MOTION).find(|number| number.key == key) {
            Some(number) => number.value(self),
            None => self.effects.number(key),
        };
        if let Some(place) = place {
            *place = value;
        }
    }
}
