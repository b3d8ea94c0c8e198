//! The immutable model of a run: bearing, contact tables, effects, and which races are bodies.

use nalgebra::Vector3;

use crate::arrowhead::{BLOCK, BODIES};
use crate::bearing::{Bearing, Raceway};
use crate::cage::CageModel;
use crate::contact::ContactModel;
use crate::contact::creep::Law;
use crate::contact::identification::identify_by_table;
use crate::contact::regularised::Parameters;
use crate::contact::shape::ContactShape;
use crate::kalker::nonlinear::KalkerError;
use crate::kalker::scaled_law::ScaledKalker;
use crate::kalker::table::CreepTable;
use crate::scalar::Scalar;
use crate::scene::{Condition, CreepLaw, Drive, RaceSection, Scene, Schedule, Solver};

/// Index of the inner race wherever races come in pairs.
pub const INNER: usize = 0;
/// Index of the outer race wherever races come in pairs.
pub const OUTER: usize = 1;
/// Index of the cage wherever it comes after the races.
pub const CAGE: usize = 2;

/// A constraint on a race that is a body (paper eq. 1, 2, 24).
#[derive(Clone, Debug, PartialEq)]
pub enum Constraint {
    /// Holonomic: position along a world axis (0, 1, 2) follows a schedule [m].
    Position(usize, Schedule),
    /// Holonomic: tilt about world y (1) or z (2) follows a schedule [rad].
    Tilt(usize, Schedule),
    /// Non-holonomic: spin about the race's own axis has the prescribed speed (eq. 24).
    Spin,
}

/// A race that is a rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct RaceBody {
    /// [kg] mass.
    pub mass: f64,
    /// [kg m2] moments of inertia about the race's own axes.
    pub inertia: Vector3<f64>,
    /// Constraints, in the order of their multipliers.
    pub constraints: Vec<Constraint>,
}

impl RaceBody {
    /// [-] components along world z and y of the race axis held at a time [s], with the sign of their tilts about y and
    /// z: the axis of the rotation vector [0, ry, rz] of all scripted tilts.
    pub fn tilt_target(&self, axis: usize, time: f64) -> f64 {
        let mut tilt = [0.0; 2];
        for constraint in &self.constraints {
            if let Constraint::Tilt(axis, schedule) = constraint {
                tilt[axis - 1] = schedule.smooth_at(time).0;
            }
        }
        let angle = f64::hypot(tilt[0], tilt[1]);
        if angle == 0.0 { 0.0 } else { tilt[axis - 1] * (angle.sin() / angle) }
    }
}

/// World direction of the moment that holds the tilt of a race's axis about world y (1) or z (2): tilting about y moves
/// the axis towards -z, about z towards +y.
pub fn tilt_direction<S: Scalar>(about: usize, axis: &Vector3<S>) -> Vector3<S> {
    let (other, sign) = tilt_component(about);
    let toward = Vector3::from_fn(|i, _| S::constant(if i == other { sign } else { 0.0 }));
    axis.cross(&toward)
}

/// Component of a race's axis that shows its tilt about world y (1) or z (2), and its sign.
pub fn tilt_component(about: usize) -> (usize, f64) {
    if about == 1 { (2, -1.0) } else { (1, 1.0) }
}

/// Creep law of a raceway with what it needs.
#[derive(Clone, Debug)]
enum RacewayLaw {
    Frictionless,
    Linear,
    Regularised(Parameters),
    Saturated,
    Table(CreepTable),
    Kalker(CreepTable, Box<ScaledKalker>),
}

impl RacewayLaw {
    fn new(scene: &Scene, shape: &ContactShape, bearing: &Bearing, race: usize) -> Result<Self, KalkerError> {
        let patch = shape.typical_patch(bearing.poisson_ratio);
        let given = [scene.regularised.inner, scene.regularised.outer][race];
        Ok(match scene.effects.creep {
            CreepLaw::Frictionless => Self::Frictionless,
            CreepLaw::Linear => Self::Linear,
            CreepLaw::Regularised => Self::Regularised(match given {
                Some(parameters) => parameters,
                None => identify_by_table(&patch)?.parameters,
            }),
            CreepLaw::Saturated => Self::Saturated,
            CreepLaw::KalkerTable => Self::Table(CreepTable::new(&patch)?),
            CreepLaw::Kalker => {
                let kalker = ScaledKalker::new(&patch, scene.effects.kalker_degree)?;
                Self::Kalker(CreepTable::new(&patch)?, Box::new(kalker))
            }
        })
    }

    fn law(&self) -> Law<'_> {
        match self {
            Self::Frictionless => Law::Frictionless,
            Self::Linear => Law::Linear,
            Self::Regularised(parameters) => Law::Regularised(parameters),
            Self::Saturated => Law::Saturated,
            Self::Table(table) | Self::Kalker(table, _) => Law::Table(table),
        }
    }
}

/// Everything that stays the same during a run.
#[derive(Clone, Debug)]
pub struct Model {
    /// Geometry and materials.
    pub bearing: Bearing,
    /// Contact tables of inner and outer raceway.
    shapes: [ContactShape; 2],
    /// Creep law on inner and outer raceway.
    laws: [RacewayLaw; 2],
    /// [1/m] mean transverse curvature of ball and groove over 2, where its slip is simulated.
    groove_bends: [Option<f64>; 2],
    /// [-] change of creepages over sliding ones after which Kalker's polynomials are solved anew.
    pub epsilon_switch: f64,
    /// [s/m] Hunt-Crossley dissipation factor.
    pub damping: f64,
    /// [m/s2] gravity.
    pub gravity: Vector3<f64>,
    /// Inner and outer race where they are bodies; the others have prescribed motion.
    pub bodies: [Option<RaceBody>; 2],
    /// The cage, where it is simulated.
    pub cage: Option<CageModel>,
    /// Are condensed stiffness and damping reported?
    pub stiffness_outputs: bool,
    /// Time integration.
    pub solver: Solver,
}

impl Model {
    /// Builds the model of a scene.
    ///
    /// # Errors
    /// If creep coefficients cannot be computed for the bearing's contacts.
    pub fn new(scene: &Scene) -> Result<Self, KalkerError> {
        let bearing = Bearing::new(scene);
        let shape = |raceway| match scene.effects.creep {
            CreepLaw::Frictionless => Ok(ContactShape::without_creep(&bearing, raceway)),
            _ => ContactShape::new(&bearing, raceway),
        };
        let shapes = [shape(&bearing.inner)?, shape(&bearing.outer)?];
        let law = |race: usize| RacewayLaw::new(scene, &shapes[race], &bearing, race);
        let laws = [law(INNER)?, law(OUTER)?];
        let bend = |raceway: &Raceway| 0.25 * (1.0 / bearing.ball.radius + 1.0 / raceway.groove_radius);
        let groove_bends = [&bearing.inner, &bearing.outer]
            .map(|raceway| scene.effects.heathcote_slip.then(|| bend(raceway)));
        Ok(Self {
            cage: scene.cage.as_ref().map(|section| CageModel::new(section, scene, &bearing)).transpose()?,
            bearing,
            laws,
            groove_bends,
            shapes,
            epsilon_switch: scene.effects.epsilon_switch,
            damping: scene.effects.damping.0,
            gravity: Vector3::from(scene.effects.gravity.map(|component| component.0)),
            bodies: [wrench_body(&scene.inner, scene), hinged_body(&scene.outer)],
            stiffness_outputs: scene.effects.stiffness_outputs,
            solver: scene.solver,
        })
    }

    /// Takes over the numbers of a scene that each step reads.
    pub fn tune(&mut self, scene: &Scene) {
        self.damping = scene.effects.damping.0;
        self.gravity = Vector3::from(scene.effects.gravity.map(|component| component.0));
        self.solver = scene.solver;
    }

    /// Raceway of a race.
    pub fn raceway(&self, race: usize) -> &Raceway {
        if race == INNER { &self.bearing.inner } else { &self.bearing.outer }
    }

    /// Contact model of the balls with a race at a friction coefficient; Kalker's polynomials give its table, to which
    /// each ball's difference is added ([`ContactModel::of_ball`]).
    pub fn contact(&self, race: usize, friction: f64) -> ContactModel<'_> {
        ContactModel {
            raceway: self.raceway(race),
            shape: &self.shapes[race],
            ball_radius: self.bearing.ball.radius,
            law: self.laws[race].law(),
            groove_bend: self.groove_bends[race],
            friction,
            damping: self.damping,
        }
    }

    /// Kalker's polynomials on a race, where they are simulated.
    pub fn polynomials(&self, race: usize) -> Option<&ScaledKalker> {
        match &self.laws[race] {
            RacewayLaw::Kalker(_, kalker) => Some(kalker),
            _ => None,
        }
    }

    /// Border rows of a race body: 6 of motion and one per constraint.
    pub fn border_rows(&self, race: usize) -> usize {
        self.bodies[race].as_ref().map_or(0, |body| 6 + body.constraints.len())
    }

    /// First border row of inner race, outer race and cage, where they are bodies.
    pub fn border_offsets(&self) -> [Option<usize>; BODIES] {
        let (inner, outer) = (self.border_rows(INNER), self.border_rows(OUTER));
        [(inner > 0).then_some(0), (outer > 0).then_some(inner), self.cage.as_ref().map(|_| inner + outer)]
    }

    /// Border rows of all bodies.
    pub fn border_size(&self) -> usize {
        self.border_rows(INNER) + self.border_rows(OUTER) + self.cage.as_ref().map_or(0, |_| BLOCK)
    }

    /// [m] length that turns moments of a race into forces of the size of the others.
    pub fn race_length(&self) -> f64 {
        0.5 * self.bearing.pitch_diameter
    }
}

/// The inner race under a wrench, held where the scene's load gives motions.
fn wrench_body(section: &RaceSection, scene: &Scene) -> Option<RaceBody> {
    let locks =
        scene.load.conditions().into_iter().enumerate().filter_map(
            |(direction, condition)| match condition {
                Condition::Load(_) => None,
                Condition::Motion(schedule) if direction < 3 => {
                    Some(Constraint::Position(direction, schedule))
                }
                Condition::Motion(schedule) => Some(Constraint::Tilt(direction - 2, schedule)),
            },
        );
    body(section, Drive::Wrench, locks.chain([Constraint::Spin]).collect())
}

/// A race on a hinge to its frame (paper section 2: the outer race).
fn hinged_body(section: &RaceSection) -> Option<RaceBody> {
    let place = (0..3).map(|axis| Constraint::Position(axis, Schedule::default()));
    let tilt = [&section.misalignment.ry, &section.misalignment.rz];
    let tilts = tilt.into_iter().enumerate().map(|(i, angle)| Constraint::Tilt(i + 1, angle.clone()));
    body(section, Drive::Hinge, place.chain(tilts).chain([Constraint::Spin]).collect())
}

/// The body of a race, if that is how it is driven.
fn body(section: &RaceSection, drive: Drive, constraints: Vec<Constraint>) -> Option<RaceBody> {
    let (true, Some(mass), Some(inertia)) = (section.drive == drive, section.mass, section.inertia) else {
        return None;
    };
    Some(RaceBody { mass: mass.0, inertia: Vector3::from(inertia.map(|moment| moment.0)), constraints })
}
