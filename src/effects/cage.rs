//! The cage: a rigid body with pockets, and lands of a race that guide it ([`crate::model::cage`]); or an ideal one ([`crate::model::spacing`]).

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::estimate::{Estimate, Standing, Verdict, digits, percent};
use super::keys::keys;
use super::losses::Part;
use super::per_ball::ball_row;
use super::reports::{BallOutput, CageOutput, PocketOutput};
use crate::schema::numbers::{DISSIPATION, Number, POISSON_RATIO, Place, Range, YOUNGS_MODULUS};
use crate::schema::units::{DissipationFactor, Inertia, Length, Mass, Pressure, Unbalance};
use crate::schema::variable_units::{
    METRE, METRE_PER_SECOND, NEWTON, ONE, RADIAN, RADIAN_PER_SECOND, Unit, WATT,
};
use crate::schema::{BearingSection, SceneError};

/// Means that keep the balls apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CageKind {
    /// Nothing: they touch where they meet.
    #[default]
    None,
    /// A cage without mass, play and friction: they are at even spacing ([`crate::model::spacing`]).
    Ideal,
    /// The cage of a section `[cage]`.
    Body,
}

impl<'de> Deserialize<'de> for CageKind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Word;
        impl Visitor<'_> for Word {
            type Value = CageKind;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("\"ideal\", \"none\", true or false")
            }

            fn visit_bool<E: Error>(self, is: bool) -> Result<CageKind, E> {
                Ok(if is { CageKind::Body } else { CageKind::None })
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<CageKind, E> {
                match word {
                    "ideal" => Ok(CageKind::Ideal),
                    "none" => Ok(CageKind::None),
                    _ => Err(E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                }
            }
        }
        deserializer.deserialize_any(Word)
    }
}

/// Radial guidance of the cage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Guidance {
    /// Lands of the inner race, inside the cage.
    Inner,
    /// Lands of the outer race, around the cage.
    Outer,
    /// The balls, by their pockets.
    Balls,
}

/// The cage: only with `effects.cage`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CageSection {
    /// \[kg] mass.
    pub mass: Mass,
    /// [kg m2] moments of inertia about the cage's x (bearing axis), y and z axes.
    pub inertia: [Inertia; 3],
    /// [kg m] unbalance: mass times the distance of the centre of mass from the cage's axis, towards its y axis; 0 if not given.
    pub unbalance: Option<Unbalance>,
    /// \[m] diametral clearance of a ball in its pocket.
    pub pocket_clearance: Length,
    /// Guide of the cage: a race or the balls.
    pub guided_by: Guidance,
    /// \[m] diametral clearance of the cage on the lands of the race that guides it.
    pub guidance_clearance: Option<Length>,
    /// \[m] diameter of those lands.
    pub land_diameter: Option<Length>,
    /// \[m] width of each of the two lands, which begin beside the pockets.
    pub land_width: Option<Length>,
    /// \[Pa] Young's modulus in the pockets; that of the races if not given.
    pub youngs_modulus: Option<Pressure>,
    /// [-] Poisson's ratio in the pockets; that of the races if not given.
    pub poisson_ratio: Option<f64>,
    /// [s/m] Hunt-Crossley dissipation factor of the cage's contacts; that of `effects.damping` if not given.
    pub damping: Option<DissipationFactor>,
}

keys! {
    /// Means by which balls are kept apart: `true` is the cage of `[cage]`, `"ideal"` one without mass, play and friction, `false` or `"none"` nothing.
    "cage" => kind: CageKind = CageKind::None,
    ;
    /// The section `[cage]`: there with the effect only.
    section: Option<CageSection> = None,
}

impl Settings {
    /// Is there a cage that is a body?
    pub fn is_body(&self) -> bool {
        self.kind == CageKind::Body
    }

    /// Refuses an unbalance in a frame that moves.
    ///
    /// # Errors
    /// Names the key.
    pub fn check_frame(&self, moves: bool) -> Result<(), SceneError> {
        let unbalance = self.section.and_then(|cage| cage.unbalance).map_or(0.0, |product| product.0);
        if unbalance > 0.0 && moves {
            let why = "a cage with an unbalance is not simulated in a frame that moves: leave out the unbalance or the frame";
            return Err(SceneError::conflict("cage.unbalance", why));
        }
        Ok(())
    }

    /// Does an ideal cage keep the balls apart?
    pub fn is_ideal(&self) -> bool {
        self.kind == CageKind::Ideal
    }
}

/// Requirement of an ideal cage: the force that it holds its centre by is on the outer race, and none of its equations of motion.
pub const IDEAL_CAGE_NEEDS: &str = "\"ideal\" keeps balls apart about the outer race, whose motion must be given (outer.drive = \"fixed\" or \"pose\", on a \
     shaft in the ground, straight): take \"none\", or a cage of [cage], where forces move that race: under a wrench, on a hinge or a \
     support, in a housing, on a hub, where it slides, or in a bore that lies off or is tilted";

const INERTIA: Range = Range::above(0.0, 1e4, "kg m2");
/// Lengths; those of the bearing narrow it.
const LENGTH: Range = Range::above(0.0, 1e3, "m");

fn length(settings: &mut Settings, of: fn(&mut CageSection) -> &mut Option<Length>) -> Place<'_> {
    Place::Value(settings.section.as_mut().and_then(|cage| of(cage).as_mut()).map(|length| &mut length.0))
}

/// [-] diametral clearance of the pockets of a usual cage over the ball diameter.
pub const USUAL_CLEARANCE: f64 = 0.02;

/// [-] lead of balls over the clearance of their pockets below which they are said to keep their places.
const STILL: f64 = 1e-3;
/// [-] gyroscopic moment over what friction can hold below which balls are said to keep their axes.
const STEADY: f64 = 0.1;

/// [-] smallest diametral clearance of a pocket over the ball diameter.
const SMALLEST_POCKET_CLEARANCE: f64 = 0.005;

/// Its part of the losses.
pub const LOSS: Part = Part {
    name: "loss.cage",
    description: "power lost to friction of the cage, in its pockets and on its lands",
    words: "friction of the cage",
    is_of: |effects| effects.cage.is_body(),
    get: |losses| losses.cage,
};

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.cage",
        adds: "a rigid cage that the balls touch in its pockets, guided by lands of a race or by the balls; or an ideal one: balls at even spacing",
        states: "pose, velocity and angular velocity of the cage; of an ideal one its turn",
        source: "Bovet et al. 2013, section 4.2; lands after Gupta 1984 and Lundberg",
        price: "167 % of a step of 10 balls (thrust case against scenes/cage.toml)",
        example: "[effects]\ncage = true\n[cage]\nmass = \"20 g\"\ninertia = [1.1e-5, 6e-6, 6e-6]\n\
                  pocket_clearance = \"0.2 mm\"\nguided_by = \"balls\"\n",
    };

    const ESTIMATE: &'static str = "load of the blows of balls that nothing keeps apart, or the power of balls that a cage holds back; what rattles is not estimated, and taken to matter";

    fn matters(&self, estimate: &Estimate) -> Vec<Verdict> {
        let Estimate { spacing, loads: [largest, _], .. } = *estimate;
        let usual = USUAL_CLEARANCE * 2.0 * estimate.ball_radius;
        let clearance = self.section.as_ref().map_or(usual, |cage| cage.pocket_clearance.0);
        let lead = format!(
            "by themselves balls would lead or lag by {} mm in a revolution",
            digits(spacing.lead * 1e3)
        );
        // Of balls that start from rest those without load stay behind at first.
        let (speed, why) = if spacing.from_rest {
            (estimate.orbital_velocity, "from rest, balls without load stay behind those with it".to_string())
        } else if spacing.falling > spacing.difference {
            (spacing.falling, "balls that no load holds fall on the next ones".into())
        } else if spacing.lead > spacing.gap {
            (spacing.difference, lead.clone())
        } else {
            (0.0, lead.clone())
        };
        let blow = spacing.blow * speed.powf(1.2);
        let struck = blow / largest;
        // A cage holds them back to the common speed.
        let held = estimate.held_back(clearance);
        // Elsewhere runs with a cage differ from those without one where no settled state tells of it.
        let quiet = !spacing.loose && spacing.lead < STILL * clearance && estimate.gyroscopic() < STEADY;
        let loose = !quiet && !spacing.from_rest;
        let sentence = match (struck >= held, speed > 0.0) {
            (true, true) => format!(
                "{why}; without a cage they strike each other at up to {} m/s: with {} N, {} of the largest load of a ball",
                digits(speed),
                digits(blow),
                percent(struck)
            ),
            (false, _) => format!(
                "{lead}, and a cage with {} mm in its pockets holds them: up to {} W of sliding, {} of all losses without it",
                digits(clearance * 1e3),
                digits(spacing.slipping),
                percent(held)
            ),
            _ if loose => format!("{lead}; what rattles in a cage is not estimated: --measure runs it"),
            _ => format!("{lead}: less than the {} mm that they have in pockets", digits(clearance * 1e3)),
        };
        let quantity = if struck >= held { "largest load" } else { "torque" };
        let standing = if self.kind != CageKind::None { Standing::On } else { Standing::Off };
        let write = "[effects] cage = \"ideal\", or cage = true with [cage] mass, inertia, pocket_clearance, guided_by";
        let value = (struck.max(held), estimate.threshold);
        let verdict = Verdict::new(("cage", quantity), standing, value, sentence, write);
        vec![Verdict { key: Some("effects.cage"), matters: verdict.matters || loose, ..verdict }]
    }

    const NUMBERS: &'static [Number<Self>] = &[
        Number::fixed("cage.mass", Range::above(0.0, 1e4, "kg"), "mass of the cage", |s| {
            Place::Value(s.section.as_mut().map(|cage| &mut cage.mass.0))
        }),
        Number::fixed("cage.inertia.x", INERTIA, "moment of inertia of the cage about its own axis", |s| {
            Place::Value(s.section.as_mut().map(|cage| &mut cage.inertia[0].0))
        }),
        Number::fixed("cage.inertia.y", INERTIA, "moment of inertia of the cage about its y axis", |s| {
            Place::Value(s.section.as_mut().map(|cage| &mut cage.inertia[1].0))
        }),
        Number::fixed("cage.inertia.z", INERTIA, "moment of inertia of the cage about its z axis", |s| {
            Place::Value(s.section.as_mut().map(|cage| &mut cage.inertia[2].0))
        }),
        Number::fixed("cage.unbalance", Range::closed(0.0, 1e3, "kg m"), "unbalance of the cage", |s| {
            Place::Value(
                s.section.as_mut().and_then(|cage| cage.unbalance.as_mut()).map(|product| &mut product.0),
            )
        }),
        Number::fixed("cage.pocket_clearance", LENGTH, "diametral clearance of a ball in its pocket", |s| {
            Place::Value(s.section.as_mut().map(|cage| &mut cage.pocket_clearance.0))
        }),
        Number::fixed(
            "cage.guidance_clearance",
            LENGTH,
            "diametral clearance of the cage on the lands",
            |s| length(s, |cage| &mut cage.guidance_clearance),
        ),
        Number::fixed("cage.land_diameter", LENGTH, "diameter of the lands that guide the cage", |s| {
            length(s, |cage| &mut cage.land_diameter)
        }),
        Number::fixed("cage.land_width", LENGTH, "width of each of the two lands", |s| {
            length(s, |cage| &mut cage.land_width)
        }),
        Number::fixed("cage.youngs_modulus", YOUNGS_MODULUS, "Young's modulus in the pockets", |s| {
            Place::Value(s.section.as_mut().and_then(|cage| cage.youngs_modulus.as_mut()).map(|e| &mut e.0))
        }),
        Number::fixed("cage.poisson_ratio", POISSON_RATIO, "Poisson's ratio in the pockets", |s| {
            Place::Value(s.section.as_mut().and_then(|cage| cage.poisson_ratio.as_mut()))
        }),
        Number::fixed("cage.damping", DISSIPATION, "dissipation factor of the cage's contacts", |s| {
            Place::Value(
                s.section.as_mut().and_then(|cage| cage.damping.as_mut()).map(|factor| &mut factor.0),
            )
        }),
    ];

    fn setting(&self) -> Option<String> {
        let guided = |section: CageSection| match section.guided_by {
            Guidance::Inner => "guided by the inner race".into(),
            Guidance::Outer => "guided by the outer race".into(),
            Guidance::Balls => "guided by the balls".into(),
        };
        if self.is_ideal() { Some("ideal: balls at even spacing".into()) } else { self.section.map(guided) }
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        let friction = [("ball_cage", setup.friction.ball_cage), ("cage_race", setup.friction.cage_race)];
        match (self.is_body(), &self.section) {
            (true, Some(cage)) => {
                unbalance(cage)?;
                pockets(cage, setup.bearing)?;
                lands(cage, setup.friction.cage_race.is_some(), setup.bearing)
            }
            (true, None) => {
                let why = "give the cage's mass, inertia and clearances in [cage], or write effects.cage = \"ideal\"";
                Err(SceneError::conflict("effects.cage", why))
            }
            (false, Some(_)) => Err(SceneError::conflict("cage", "allowed with effects.cage = true only")),
            (false, None) => match friction.into_iter().find(|(_, given)| given.is_some()) {
                Some((key, _)) => {
                    let why = "allowed with effects.cage = true only";
                    Err(SceneError::conflict(format!("friction.{key}"), why))
                }
                None => Ok(()),
            },
        }
    }

    fn rows(&self) -> Vec<Row> {
        self.section.map(|section| cage_rows(section.guided_by)).unwrap_or_default()
    }

    fn ball_rows(&self, ball: usize) -> Vec<Row> {
        match self.kind {
            CageKind::None => vec![],
            CageKind::Ideal => pocket_rows(ball).drain(..4).collect(),
            CageKind::Body => pocket_rows(ball),
        }
    }
}

/// [-] largest distance of a cage's centre of mass from its axis over its least radius of gyration about its centre.
const LARGEST_OFFSET: f64 = 0.3;

impl CageSection {
    /// [kg m] largest unbalance that the inertia of a cage allows.
    pub fn largest_unbalance(&self) -> f64 {
        let least = self.inertia.iter().map(|moment| moment.0).fold(f64::INFINITY, f64::min);
        LARGEST_OFFSET * (self.mass.0 * least).sqrt()
    }
}

/// A centre of mass within the cage.
fn unbalance(cage: &CageSection) -> Result<(), SceneError> {
    let largest = Range::closed(0.0, cage.largest_unbalance(), "kg m");
    cage.unbalance.map_or(Ok(()), |product| largest.check("cage.unbalance", product.0))
}

/// Pockets that hold their balls, and do not overlap.
fn pockets(cage: &CageSection, bearing: &BearingSection) -> Result<(), SceneError> {
    let (ball, pitch) = (bearing.ball_diameter.0, bearing.pitch_diameter.0);
    // Below, ball and pocket fit so closely that they are no half-spaces any more, which Hertz takes them for.
    Range::closed(SMALLEST_POCKET_CLEARANCE * ball, 0.5 * ball, "m")
        .check("cage.pocket_clearance", cage.pocket_clearance.0)?;
    let spacing = pitch * (std::f64::consts::PI / bearing.balls as f64).sin();
    if bearing.balls > 1 && spacing <= ball + cage.pocket_clearance.0 {
        let why = format!("pockets overlap: balls are {spacing} m apart and pockets wider");
        return Err(SceneError::conflict("cage.pocket_clearance", why));
    }
    Ok(())
}

/// Lands that guide have all their dimensions; without lands there are none.
fn lands(cage: &CageSection, friction: bool, bearing: &BearingSection) -> Result<(), SceneError> {
    let (ball, pitch) = (bearing.ball_diameter.0, bearing.pitch_diameter.0);
    let given = [
        ("cage.guidance_clearance", cage.guidance_clearance.map(|length| length.0)),
        ("cage.land_diameter", cage.land_diameter.map(|length| length.0)),
        ("cage.land_width", cage.land_width.map(|length| length.0)),
    ];
    let diameters = match cage.guided_by {
        Guidance::Inner => Range::closed((pitch - 2.0 * ball).max(0.0), pitch, "m"),
        Guidance::Outer => Range::closed(pitch, pitch + 2.0 * ball, "m"),
        Guidance::Balls => {
            let keys = given.iter().filter(|(_, value)| value.is_some()).map(|(key, _)| *key);
            let keys = keys.chain(friction.then_some("friction.cage_race"));
            return keys.into_iter().next().map_or(Ok(()), |key| {
                let why = "allowed with cage.guided_by = \"inner\" or \"outer\" only";
                Err(SceneError::conflict(key, why))
            });
        }
    };
    for ((key, value), range) in
        given.into_iter().zip([Range::above(0.0, ball, "m"), diameters, Range::above(0.0, 2.0 * ball, "m")])
    {
        let Some(value) = value else {
            let why = "needed where lands guide the cage: guided_by = \"inner\" or \"outer\"";
            return Err(SceneError::conflict(key, why));
        };
        range.check(key, value)?;
    }
    Ok(())
}

type FromCage = fn(&CageOutput) -> f64;
type FromPocket = fn(&PocketOutput) -> f64;

/// A row of the cage.
fn row(name: &str, unit: Unit, nominal: f64, description: String, get: FromCage) -> Row {
    let name = format!("cage.{name}");
    Row { name, unit, nominal, description, get: Getter::new(move |reports| reports.cage.map_or(0.0, get)) }
}

/// Motion of the cage, and what pockets and lands do to it.
fn cage_rows(guided_by: Guidance) -> Vec<Row> {
    let guide = match guided_by {
        Guidance::Inner => "inner",
        Guidance::Outer | Guidance::Balls => "outer",
    };
    let centre = format!("cage centre relative to the {guide} race");
    let mut rows: Vec<(&str, Unit, f64, String, FromCage)> = vec![
        ("orientation.w", ONE, 1.0, "orientation of the cage, quaternion component w".into(), |c| {
            c.pose.orientation.w
        }),
        ("turned", RADIAN, 100.0, "turns of the cage about its axis since the start".into(), |c| c.turned),
        ("eccentricity.axial", METRE, 1e-4, format!("{centre}, along its axis"), |c| c.eccentricity.x),
        ("eccentricity.radius", METRE, 1e-4, format!("{centre}, distance from its axis"), |c| {
            c.eccentricity.yz().norm()
        }),
        ("eccentricity.angle", RADIAN, 1.0, format!("{centre}, angle from +y towards +z"), |c| {
            c.eccentricity.z.atan2(c.eccentricity.y)
        }),
        ("pocket_power", WATT, 1.0, "power lost to friction in all pockets".into(), |c| c.pocket_power),
    ];
    let power = "power lost to friction in all contacts of the cage".to_string();
    rows.push(("power", WATT, 1.0, power, |c| c.pocket_power + c.land_power));
    let vectors: [(&str, Unit, f64, &str, [FromCage; 3]); 6] = [
        (
            "position",
            METRE,
            1e-4,
            "position of the cage's centre",
            [|c| c.pose.position.x, |c| c.pose.position.y, |c| c.pose.position.z],
        ),
        (
            "orientation",
            ONE,
            1.0,
            "orientation of the cage, imaginary part of the quaternion",
            [|c| c.pose.orientation.i, |c| c.pose.orientation.j, |c| c.pose.orientation.k],
        ),
        (
            "velocity",
            METRE_PER_SECOND,
            1e-2,
            "velocity of the cage's centre",
            [|c| c.twist.velocity.x, |c| c.twist.velocity.y, |c| c.twist.velocity.z],
        ),
        (
            "angular_velocity",
            RADIAN_PER_SECOND,
            100.0,
            "angular velocity of the cage",
            [|c| c.twist.angular_velocity.x, |c| c.twist.angular_velocity.y, |c| c.twist.angular_velocity.z],
        ),
        (
            "pocket_force",
            NEWTON,
            10.0,
            "force of all pockets on the cage",
            [|c| c.pocket_force.x, |c| c.pocket_force.y, |c| c.pocket_force.z],
        ),
        (
            "land_force",
            NEWTON,
            10.0,
            "force of the lands on the cage",
            [|c| c.land_force.x, |c| c.land_force.y, |c| c.land_force.z],
        ),
    ];
    if guided_by != Guidance::Balls {
        let (left, right) = ("normal load on the land at the cage's -x side", "at the cage's +x side");
        rows.push(("land_load.left", NEWTON, 10.0, left.into(), |c| c.land_loads[0]));
        let right = format!("normal load on the land {right}");
        rows.push(("land_load.right", NEWTON, 10.0, right, |c| c.land_loads[1]));
        let power = "power lost to friction on the lands".to_string();
        rows.push(("land_power", WATT, 1.0, power, |c| c.land_power));
    }
    let mut table: Vec<Row> = rows
        .into_iter()
        .map(|(name, unit, nominal, description, get)| row(name, unit, nominal, description, get))
        .collect();
    for (name, unit, nominal, what, components) in vectors {
        if name == "land_force" && guided_by == Guidance::Balls {
            continue;
        }
        for (axis, get) in ["x", "y", "z"].into_iter().zip(components) {
            let description = format!("{what}, {axis} component");
            table.push(row(&format!("{name}.{axis}"), unit, nominal, description, get));
        }
    }
    table
}

/// Contact of a ball with its pocket.
fn pocket_rows(ball: usize) -> Vec<Row> {
    let pocket: [(&str, Unit, f64, &str, FromPocket); 6] = [
        ("load", NEWTON, 10.0, "normal load", |p| p.load),
        ("force.x", NEWTON, 10.0, "force on the ball, x component, world axes,", |p| p.force.x),
        ("force.y", NEWTON, 10.0, "force on the ball, y component, world axes,", |p| p.force.y),
        ("force.z", NEWTON, 10.0, "force on the ball, z component, world axes,", |p| p.force.z),
        ("approach", METRE, 1e-4, "approach (negative is a gap)", |p| p.approach),
        ("power", WATT, 0.1, "power lost to friction", |p| p.power),
    ];
    let row = |(quantity, unit, nominal, what, get): (&str, Unit, f64, &str, FromPocket)| {
        let description = format!("{what} of ball {} and its cage pocket", ball + 1);
        let of_ball = move |b: &BallOutput| b.pocket.as_ref().map_or(0.0, get);
        ball_row(ball, &format!("pocket.{quantity}"), unit, nominal, description, of_ball)
    };
    pocket.into_iter().map(row).collect()
}
