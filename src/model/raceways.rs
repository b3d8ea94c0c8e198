//! Balls against a raceway: contact tables and creep law of one race.

use super::bearing::Bearing;
use super::bodies::Race;
use crate::contact::creep::Law;
use crate::contact::identification::identify_by_table;
use crate::contact::oblique::{Across, Exchanged, exchanged};
use crate::contact::regularised::Parameters;
use crate::contact::shape::ContactShape;
use crate::kalker::Patch;
use crate::kalker::nonlinear::KalkerError;
use crate::kalker::scaled_law::ScaledKalker;
use crate::kalker::table::CreepTable;
use crate::scene::{CreepLaw, Scene};

/// Creep law of a raceway with its tables or parameters.
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
    /// Law of a patch that rolls along its x axis.
    fn new(
        law: CreepLaw,
        patch: &Patch,
        degree: usize,
        given: Option<Parameters>,
    ) -> Result<Self, KalkerError> {
        Ok(match law {
            CreepLaw::Frictionless => Self::Frictionless,
            CreepLaw::Linear => Self::Linear,
            CreepLaw::Regularised | CreepLaw::Uncoupled => {
                let parameters = match given {
                    Some(parameters) => parameters,
                    None => identify_by_table(patch)?.parameters,
                };
                let coupled = law == CreepLaw::Regularised;
                Self::Regularised(if coupled { parameters } else { parameters.uncoupled() })
            }
            CreepLaw::Saturated => Self::Saturated,
            CreepLaw::KalkerTable => Self::Table(CreepTable::new(patch)?),
            CreepLaw::Kalker => {
                let kalker = ScaledKalker::new(patch, degree)?;
                Self::Kalker(CreepTable::new(patch)?, Box::new(kalker))
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

/// Constants of the contacts of all balls with one raceway.
#[derive(Clone, Debug)]
pub struct RacewayContacts {
    /// Contact tables.
    pub shape: ContactShape,
    law: RacewayLaw,
    /// Rolling across the circumference, and its law; none without friction.
    across: Option<(Exchanged, RacewayLaw)>,
    /// [1/m] mean transverse curvature of ball and groove over 2, where its slip is simulated.
    pub groove_bend: Option<f64>,
}

impl RacewayContacts {
    /// Contacts with a race of a scene.
    ///
    /// # Errors
    /// If creep coefficients cannot be computed.
    pub fn new(scene: &Scene, bearing: &Bearing, race: Race) -> Result<Self, KalkerError> {
        let raceway = bearing.raceway(race);
        let (radius, pitch, materials) = (bearing.ball.radius, bearing.pitch_diameter, &bearing.materials);
        let shape = match scene.effects.creep.law {
            CreepLaw::Frictionless => ContactShape::without_creep(radius, pitch, materials, raceway),
            _ => ContactShape::new(radius, pitch, materials, raceway)?,
        };
        let settings = &scene.effects.creep;
        let given = match race {
            Race::Inner => settings.regularised.inner,
            Race::Outer => settings.regularised.outer,
        };
        let patch = shape.typical_patch(materials.poisson_ratio);
        let law = RacewayLaw::new(settings.law, &patch, settings.kalker_degree, given)?;
        let across = match settings.law {
            CreepLaw::Frictionless => None,
            // Polynomials are a difference from the table of rolling along the circumference.
            CreepLaw::Kalker => Some(CreepLaw::KalkerTable),
            law => Some(law),
        };
        let across = across
            .map(|law| -> Result<_, KalkerError> {
                let law = RacewayLaw::new(law, &exchanged(&patch), settings.kalker_degree, None)?;
                Ok((Exchanged::new(&patch)?, law))
            })
            .transpose()?;
        let groove_bend = scene.effects.groove_slip.bend(bearing.ball.radius, raceway.groove_radius);
        Ok(Self { shape, law, across, groove_bend })
    }

    /// Creep law; Kalker's polynomials give their table.
    pub fn law(&self) -> Law<'_> {
        self.law.law()
    }

    /// Rolling across the circumference.
    pub fn across(&self) -> Option<Across<'_>> {
        self.across.as_ref().map(|(exchanged, law)| Across { exchanged, law: law.law() })
    }

    /// Kalker's polynomials, where they are simulated.
    pub fn polynomials(&self) -> Option<&ScaledKalker> {
        match &self.law {
            RacewayLaw::Kalker(_, kalker) => Some(kalker),
            _ => None,
        }
    }
}
