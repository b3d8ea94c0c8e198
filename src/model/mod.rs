//! The immutable model of a run: bearing, bodies, and the constants of their contacts.

pub mod balance;
mod ball_state;
pub mod bearing;
pub mod bodies;
pub mod cage;
pub mod damage;
pub mod energies;
pub mod link;
pub mod raceways;
pub mod spacing;
pub mod state;
pub mod structure;

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::contact::ball_ball::BallBallModel;
use crate::contact::ball_spall::Damage;
use crate::contact::creep::Law;
use crate::contact::form::Form;
use crate::contact::normal::Damping;
use crate::contact::spall::Spalls;
use crate::contact::surface::{BallSize, Surface};
use crate::contact::{ContactModel, Resistance};
use crate::effects::ambient::{Ambient, AmbientSection, Medium};
use crate::effects::defects::On;
use crate::effects::film::Films;
use crate::effects::form::Shape;
use crate::effects::frame::FrameSection;
use crate::effects::growth::{Growth, Warmth};
use crate::effects::heat_balance::HeatBalance;
use crate::effects::moving_frame::{FrameMotion, MovingFrame};
use crate::effects::rating::Rating;
use crate::effects::support::Support;
use crate::kalker::nonlinear::KalkerError;
use crate::kalker::scaled_law::ScaledKalker;
use crate::numerics::arrowhead::Offsets;
use crate::scene::{Level, Scene, Solver};
use bearing::{Ball, Bearing};
use bodies::{Bodies, PerRace, Race, RigidBody};
use cage::CageModel;
use damage::DamagedBalls;
use raceways::RacewayContacts;
use spacing::Spacing;

/// Conditions that may change from step to step and are the same in every contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// [-] friction coefficient of the ball-race contacts.
    pub friction: f64,
    /// Temperatures and speeds that rings and balls have grown by; not used where growth is not simulated.
    pub warmth: Warmth,
    /// [-] degree of lubrication: 0 dry.
    pub lubrication: f64,
}

impl Conditions {
    /// Those of a friction coefficient, dry, where nothing has grown.
    pub fn of_friction(friction: f64) -> Self {
        Self { friction, ..Self::default() }
    }
}

/// Everything that stays the same during a run.
#[derive(Clone, Debug)]
pub struct Model {
    /// Geometry and materials.
    pub bearing: Bearing,
    /// Bodies: mass, inertia and constraints of those that forces move; `None` where the motion is prescribed.
    pub bodies: Bodies<Option<RigidBody>>,
    /// Balls against raceways.
    raceways: PerRace<RacewayContacts>,
    /// Balls against the cage's pockets and the cage against a race's lands, where a cage is simulated.
    pub cage: Option<CageModel>,
    /// Even spacing of the balls, where an ideal cage keeps them apart.
    pub spacing: Option<Spacing>,
    /// Neighbouring balls against each other, where no cage keeps them apart.
    pub ball_contact: Option<BallBallModel>,
    /// Growth of rings and balls, where it is simulated.
    pub growth: Option<Growth>,
    /// Temperatures from the heat of friction, where they are simulated.
    pub heat_balance: Option<HeatBalance>,
    /// Films between balls and races, where there is oil.
    pub films: Option<Films>,
    /// Ratings of life, where it is asked for.
    pub rating: Option<Rating>,
    /// Is heat reported by part?
    pub heat_outputs: bool,
    /// Are means since the last communication point reported?
    pub mean_outputs: bool,
    /// [-] change of creepages over sliding ones after which Kalker's polynomials are solved anew.
    pub epsilon_switch: f64,
    /// Moments against rolling in the material of balls and races.
    resistance: PerRace<Resistance>,
    /// How contacts of the balls with races and with each other lose energy.
    pub damping: Damping,
    /// Form of the races, where they depart from a torus.
    pub form: PerRace<Option<Form>>,
    /// Spalls of the races, where they have some.
    pub spalls: PerRace<Option<Spalls>>,
    /// Balls with spalls, where there are some.
    pub damaged: Option<DamagedBalls>,
    /// Sizes of the balls on each race, where they are not alike.
    sizes: Option<PerRace<Vec<BallSize>>>,
    /// \[m] arm of the bearing's frame, where that may move.
    frame_arm: Option<Vector3<f64>>,
    /// The medium around the balls, where its drag is simulated.
    medium: Option<Medium>,
    /// Flexible supports of the races on their flanges.
    pub supports: PerRace<Option<Support>>,
    /// Is it without states in the steps of a machine: its elements in balance wherever the rings are?
    pub without_states: bool,
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
        let section = scene.effects.cage.section.as_ref();
        let cage = section.map(|section| CageModel::new(section, scene, &bearing)).transpose()?;
        let supports = &scene.effects.support.sections;
        let [inner_support, outer_support] = supports.each_ref().map(Option::as_ref);
        let races = PerRace {
            inner: RigidBody::under_wrench(Race::Inner, scene)
                .or_else(|| inner_support.map(RigidBody::on_support)),
            outer: RigidBody::under_wrench(Race::Outer, scene)
                .or_else(|| RigidBody::on_hinge(&scene.outer))
                .or_else(|| outer_support.map(RigidBody::on_support)),
        };
        let raceways = PerRace::try_new(|race| RacewayContacts::new(scene, &bearing, race))?;
        let larger = scene.effects.form.larger_radii();
        let size = |race: Race, larger: f64| BallSize {
            larger,
            stiffness: raceways[race]
                .shape
                .stiffness_of_larger(larger, bearing.circumferential_curvature(race)),
        };
        let sizes = |race: Race| larger.iter().map(|larger| size(race, *larger)).collect();
        let sizes = (!larger.is_empty()).then(|| PerRace::new(sizes));
        let whole = PerRace::new(|race| bearing.whole_contact(race, &raceways[race].shape));
        // What a race carries along its circumference is placed against balls and load by the turn that it starts with.
        let turn = |race: Race| race.section(scene).turn.map_or(0.0, |turn| turn.0);
        let spalls = PerRace::new(|race| {
            let mut on = match race {
                Race::Inner => scene.effects.defects.on(On::Inner, bearing.free_contact_angle),
                Race::Outer => scene.effects.defects.on(On::Outer, bearing.free_contact_angle),
            };
            on.iter_mut().for_each(|spall| spall.azimuth += turn(race));
            Spalls::new(on, whole[race])
        });
        let resistance = PerRace::new(|race| {
            scene.effects.hysteresis.resistance(bearing.ball.radius, whole[race].curvatures)
        });
        let passing = Race::BOTH.map(|race| bearing.passing(race, &raceways[race].shape));
        let heat_balance =
            scene.effects.heat_balance.balance(&scene.bearing, &scene.ball, &scene.race, passing);
        let films = scene.effects.film.section.as_ref().and_then(|section| {
            let races =
                Race::BOTH.map(|race| bearing.raceway_film(race, &raceways[race].shape, section.lubricant()));
            let sizes = [bearing.pitch_diameter, 2.0 * bearing.ball.radius];
            scene.effects.film.films(races, sizes, scene.bearing.contact_angle.is_some())
        });
        let spacing = scene.effects.cage.is_ideal().then(|| Spacing::new(&bearing));
        let damaged = DamagedBalls::new(&scene.effects.defects.on_balls(), &bearing, &whole);
        Ok(Self {
            bodies: Bodies::new(races, section.map(|section| Some(RigidBody::cage(section)))),
            raceways,
            ball_contact: (cage.is_none() && spacing.is_none()).then(|| {
                let material = (scene.ball.youngs_modulus.0, scene.ball.poisson_ratio);
                let friction = scene.friction.ball_ball.unwrap_or(scene.friction.ball_race.at(0.0));
                BallBallModel::new(bearing.ball.radius, material, friction)
            }),
            cage,
            spacing,
            rating: scene.effects.rating.rating(
                &scene.bearing,
                &bearing.materials,
                scene.effects.film.kinematic_viscosity(),
            ),
            heat_outputs: scene.effects.heat.on,
            mean_outputs: scene.effects.means.on,
            growth: scene.effects.growth.growth(&scene.bearing, &scene.ball, &scene.race),
            films,
            heat_balance,
            bearing,
            epsilon_switch: scene.effects.creep.epsilon_switch,
            resistance,
            damping: contact_damping(scene),
            form: PerRace::new(|race| {
                let form = scene.effects.form.of(race == Race::Inner).and_then(Shape::form);
                form.map(|form| form.turned(turn(race)))
            }),
            spalls,
            damaged,
            sizes,
            frame_arm: scene.effects.frame.section.as_ref().map(FrameSection::arm),
            supports: PerRace {
                inner: inner_support.map(Support::from),
                outer: outer_support.map(Support::from),
            },
            medium: scene.effects.ambient.section.as_ref().map(AmbientSection::medium),
            without_states: false,
            stiffness_outputs: scene.effects.stiffness.on,
            solver: scene.solver,
        })
    }

    /// Leaves the motion of a race to a structure that carries it, such as a shaft.
    pub fn carry(&mut self, race: Race) {
        self.bodies[race] = Some(RigidBody::carried());
    }

    /// Is a race carried by a structure?
    pub fn is_carried(&self, race: Race) -> bool {
        self.bodies[race].as_ref().is_some_and(|body| body.carried)
    }

    /// Takes over the tunable numbers of a scene, those that each step reads.
    pub fn tune(&mut self, scene: &Scene) {
        self.damping = contact_damping(scene);
        self.solver = scene.solver;
    }

    /// Contact model of the balls with a race; Kalker's polynomials give its table, to which each ball's difference is
    /// added ([`ContactModel::of_ball`]). Damaged balls face as at the start ([`ContactModel::oriented`]).
    pub fn contact(&self, race: Race, conditions: &Conditions) -> ContactModel<'_> {
        self.contact_of(&self.raceways[race], race, conditions, None)
    }

    fn contact_of<'a>(
        &'a self,
        raceway: &'a RacewayContacts,
        race: Race,
        conditions: &Conditions,
        orientations: Option<&'a Vec<UnitQuaternion<f64>>>,
    ) -> ContactModel<'a> {
        let (raceway_now, ball_radius, stiffening) = match &self.growth {
            None => (*self.bearing.raceway(race), self.bearing.ball.radius, 1.0),
            Some(growth) => {
                let (index, warmth) = (race as usize, &conditions.warmth);
                (growth.raceway(index, warmth), growth.ball_radius(warmth), growth.stiffening(index, warmth))
            }
        };
        ContactModel {
            surface: Surface {
                raceway: raceway_now,
                ball_radius,
                form: self.form[race].as_ref(),
                spalls: self.spalls[race].as_ref(),
                damage: self.damaged.as_ref().map(|damaged| Damage {
                    spalls: &damaged.spalls[race],
                    orientations: orientations.unwrap_or(&damaged.at_start),
                }),
                sizes: self.sizes.as_ref().map(|sizes| &*sizes[race]),
                ball: 0,
            },
            shape: &raceway.shape,
            stiffening,
            law: raceway.law(),
            across: raceway.across(),
            groove_bend: raceway.groove_bend,
            friction: conditions.friction,
            resistance: self.resistance[race],
            film: self.films.as_ref().and_then(|films| {
                films.film(race as usize, conditions.lubrication, &conditions.warmth, conditions.friction)
            }),
            damping: self.damping,
        }
    }

    /// [Pa s] viscosity of the oil around the cage; 0 where it is dry.
    pub fn oil_around_cage(&self, conditions: &Conditions) -> f64 {
        let guide = self.cage_guide().unwrap_or(Race::Outer) as usize;
        let Conditions { lubrication, warmth, .. } = conditions;
        self.films.as_ref().map_or(0.0, |films| films.around_cage(guide, *lubrication, warmth))
    }

    /// Contact models of both races.
    pub fn contacts(&self, conditions: &Conditions) -> PerRace<ContactModel<'_>> {
        PerRace::new(|race| self.contact(race, conditions))
    }

    /// Contact models of both races for damaged balls of these orientations.
    pub fn contacts_oriented<'a>(
        &'a self,
        conditions: &Conditions,
        orientations: Option<&'a Vec<UnitQuaternion<f64>>>,
    ) -> PerRace<ContactModel<'a>> {
        PerRace::new(|race| self.contact_of(&self.raceways[race], race, conditions, orientations))
    }

    /// Loads on balls and bodies from outside, in a frame of this motion.
    pub fn ambient(&self, frame: &FrameMotion) -> Ambient {
        let Ball { mass, inertia, radius } = self.bearing.ball;
        let moving = self.frame_arm.map(|arm| MovingFrame::new(frame, arm));
        Ambient { gravity: frame.gravity, frame: moving, medium: self.medium, mass, inertia, radius }
    }

    /// Is the medium around the balls felt?
    pub fn has_medium(&self) -> bool {
        self.medium.is_some()
    }

    /// The race whose lands guide the cage; none where the balls do, or without a cage.
    pub fn cage_guide(&self) -> Option<Race> {
        self.cage.as_ref().and_then(CageModel::guide)
    }

    /// Creep law of the balls on a race; Kalker's polynomials give their table.
    pub fn law(&self, race: Race) -> Law<'_> {
        self.raceways[race].law()
    }

    /// Kalker's polynomials on a race, where they are simulated.
    pub fn polynomials(&self, race: Race) -> Option<&ScaledKalker> {
        self.raceways[race].polynomials()
    }

    /// Rows of every body in the border of the Newton matrix: the first, where the body has unknowns.
    pub fn border_offsets(&self) -> Offsets {
        let mut offsets = Offsets::default();
        let mut rows = 0;
        for (body, moved) in self.bodies.iter() {
            if let Some(moved) = moved {
                offsets[body.index()] = Some(rows);
                rows += moved.rows();
            }
        }
        offsets
    }

    /// [-] number of bodies that forces move.
    pub fn moved_bodies(&self) -> usize {
        self.bodies.iter().filter(|(_, body)| body.is_some()).count()
    }

    /// [-] border rows of all bodies, and that of an ideal cage's turn.
    pub fn border_size(&self) -> usize {
        self.rows_of_bodies() + usize::from(self.spacing.is_some())
    }

    /// Border row of an ideal cage's turn, where there is one: the last.
    pub fn spacing_row(&self) -> Option<usize> {
        self.spacing.as_ref().map(|_| self.rows_of_bodies())
    }

    fn rows_of_bodies(&self) -> usize {
        self.bodies.iter().filter_map(|(_, body)| body.as_ref()).map(RigidBody::rows).sum()
    }

    /// \[m] length that turns moments of a body into forces of the size of the others.
    pub fn race_length(&self) -> f64 {
        0.5 * self.bearing.pitch_diameter
    }
}

/// How contacts lose energy; an equilibrium has no approach that damping could act on.
fn contact_damping(scene: &Scene) -> Damping {
    match scene.solver.level {
        Level::Dynamic => scene.effects.damping.law(),
        Level::Equilibrium => Damping::HuntCrossley(0.0),
    }
}
