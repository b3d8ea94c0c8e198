//! A shelf of one's own: bearings of a file `catalogue.toml`, with load ratings, and with inner geometry where a maker tells it.

use std::path::Path;

use serde::Deserialize;

use super::estimate::{Candidate, STEEL_OF_ISO_76};
use super::{Bearing, Cage, CatalogueError, Request};
use crate::effects::rating::standard::Geometry;
use crate::schema::numbers::Range;
use crate::schema::units::{Angle, Force, Length};
use crate::schema::{SceneError, explain, regular};

/// Name of the file, beside the scene.
pub const FILE: &str = "catalogue.toml";
/// Range of conformities.
const CONFORMITY: Range = Range::closed(0.501, 1.0, "");

/// Bearings of a file.
#[derive(Clone, Debug, Default)]
pub struct Shelf {
    bearings: Vec<Bearing>,
}

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    /// Its bearings.
    bearing: Vec<Own>,
}

/// A bearing of the file: an entry `[[bearing]]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Own {
    /// Its name; capitals and spaces make no difference.
    designation: String,
    /// \[m] bore.
    bore: Length,
    /// \[m] outside diameter.
    outside: Length,
    /// \[m] width.
    width: Length,
    /// \[N] basic dynamic load rating C.
    dynamic_load_rating: Force,
    /// \[N] basic static load rating C0.
    static_load_rating: Force,
    /// \[rad] contact angle; 0, a deep-groove bearing, if not given.
    contact_angle: Option<Angle>,
    /// Class of the radial clearance of a deep-groove bearing: C2 to C5.
    clearance: Option<String>,
    /// Means by which balls are kept apart.
    #[serde(default)]
    cage: Cage,
    /// [-] number of balls; with `ball_diameter`, or both are estimated.
    balls: Option<usize>,
    /// \[m] ball diameter.
    ball_diameter: Option<Length>,
    /// \[m] pitch diameter; midway between bore and outside if not given.
    pitch_diameter: Option<Length>,
    /// [-] inner conformity; the usual one if not given.
    inner_conformity: Option<f64>,
    /// [-] outer conformity.
    outer_conformity: Option<f64>,
    /// \[m] diametral clearance of a deep-groove bearing, in place of the middle of its class.
    diametral_clearance: Option<Length>,
}

impl Shelf {
    /// The shelf beside a scene in a folder; empty where there is no such file.
    ///
    /// # Errors
    /// If the file cannot be read or something in it is refused; with its name, the bearing and the key.
    pub fn beside(folder: &Path) -> Result<Self, SceneError> {
        let path = folder.join(FILE);
        if path.is_file() { Self::load(&path) } else { Ok(Self::default()) }
    }

    /// The shelf of a file.
    ///
    /// # Errors
    /// As [`Shelf::beside`], and if there is no such file.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text = regular::scene(path)?;
        Self::parse(&text, &path.display().to_string())
    }

    /// The shelf of a text from a file of that name.
    ///
    /// # Errors
    /// With the name of the file, the bearing and the key.
    pub fn parse(text: &str, file: &str) -> Result<Self, SceneError> {
        let written: Written =
            explain::read(text).map_err(|(why, spot)| explain::with_place(why, text, spot, Some(file)))?;
        let mut shelf = Self::default();
        for own in written.bearing {
            let name = own.designation.clone();
            let placed = |why: String| SceneError::Format(format!("{file}: bearing \"{name}\": {why}"));
            let bearing = own.bearing(file).map_err(|why| placed(why.to_string()))?;
            if name.trim().is_empty() || shelf.find(&name).is_some() {
                return Err(placed(
                    "its designation is empty, or that of another one: each needs one of its own".into(),
                ));
            }
            shelf.bearings.push(bearing);
        }
        Ok(shelf)
    }

    /// Designations of all of them.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.bearings.iter().map(|own| own.designation.as_str())
    }

    /// The bearing of a designation.
    pub fn find(&self, designation: &str) -> Option<&Bearing> {
        let plain = |name: &str| name.split_whitespace().collect::<String>().to_uppercase();
        self.bearings.iter().find(|own| plain(&own.designation) == plain(designation))
    }
}

impl Own {
    fn bearing(self, file: &str) -> Result<Bearing, CatalogueError> {
        let request = Request {
            bore: Some(self.bore),
            outside: Some(self.outside),
            width: Some(self.width),
            dynamic_load_rating: Some(self.dynamic_load_rating),
            static_load_rating: Some(self.static_load_rating),
            contact_angle: self.contact_angle,
            clearance: self.clearance.clone(),
            cage: self.cage,
            ..Request::default()
        };
        let mut bearing =
            Bearing { designation: self.designation.clone(), source: file.into(), ..request.bearing()? };
        bearing.own_clearance = self.own_clearance(&bearing)?;
        bearing.inside = self.inside(&bearing)?;
        Ok(bearing)
    }

    fn own_clearance(&self, bearing: &Bearing) -> Result<Option<f64>, CatalogueError> {
        let Some(clearance) = self.diametral_clearance else { return Ok(None) };
        if !bearing.is_deep_groove() || self.clearance.is_some() {
            return Err(CatalogueError::Conflict(
                "diametral_clearance: it is of a deep-groove bearing, in place of a class in clearance"
                    .into(),
            ));
        }
        Range::closed(-1e-3, 1e-3, "m")
            .check("diametral_clearance", clearance.0)
            .map_err(|why| CatalogueError::Conflict(why.to_string()))?;
        Ok(Some(clearance.0))
    }

    /// The balls and grooves that are given.
    fn inside(&self, bearing: &Bearing) -> Result<Option<Candidate>, CatalogueError> {
        let (balls, ball_diameter) = match (self.balls, self.ball_diameter) {
            (Some(balls), Some(ball)) => (balls, ball.0),
            (None, None) => {
                let rest = [
                    ("pitch_diameter", self.pitch_diameter.is_some()),
                    ("inner_conformity", self.inner_conformity.is_some()),
                    ("outer_conformity", self.outer_conformity.is_some()),
                ];
                return match rest.iter().find(|(_, given)| *given) {
                    Some((key, _)) => Err(CatalogueError::Conflict(format!(
                        "{key}: inner geometry begins with balls and ball_diameter, which are not given"
                    ))),
                    None => Ok(None),
                };
            }
            (balls, _) => {
                let key = if balls.is_some() { "ball_diameter" } else { "balls" };
                return Err(CatalogueError::Conflict(format!(
                    "{key} is missing: balls and ball_diameter go together"
                )));
            }
        };
        let within = |key: &str, value: f64, range: Range| {
            range.check(key, value).map_err(|why| CatalogueError::Conflict(why.to_string()))
        };
        let room = if bearing.is_thrust() { bearing.width } else { bearing.section_height() };
        // To the nanometre, so that an error has no digits of rounding.
        let part = |share: f64| (share * room * 1e9).round() / 1e9;
        within("ball_diameter", ball_diameter, Range::closed(part(0.2), part(0.95), "m"))?;
        let pitch_diameter = self.pitch_diameter.map_or(bearing.pitch_diameter(), |pitch| pitch.0);
        within("pitch_diameter", pitch_diameter, Range::closed(bearing.bore, bearing.outside, "m"))?;
        let most = std::f64::consts::PI / (ball_diameter / pitch_diameter).asin();
        within("balls", balls as f64, Range::closed(3.0, most.floor(), ""))?;
        let usual = bearing.usual_conformities();
        let conformities = [
            ("inner_conformity", self.inner_conformity, usual[0]),
            ("outer_conformity", self.outer_conformity, usual[1]),
        ];
        for (key, given, _) in conformities {
            given.map_or(Ok(()), |given| within(key, given, CONFORMITY))?;
        }
        let geometry = Geometry {
            balls,
            ball_diameter,
            pitch_diameter,
            contact_angle: bearing.contact_angle,
            conformities: conformities.map(|(_, given, usual)| given.unwrap_or(usual)),
        };
        Ok(Some(bearing.rated(geometry, geometry.static_ball_loads(STEEL_OF_ISO_76))))
    }
}
