//! Which bearing is asked for: by a name of the table, by numbers, or by a name with some numbers of another maker.

use serde::Deserialize;

use super::designation::find;
use super::digits::short;
use super::{Bearing, CatalogueError, Clearance, Entry, SOURCE, Shelf};
use crate::schema::units::{Angle, Force, Length};

/// A bearing by name, by numbers, or both: numbers that are given stand in place of those of the table.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Request {
    /// Name as on the box: "6205", "7206 BECBP", "SKF 6305-2RS1/C3", "6805" (which is 61805).
    pub designation: Option<String>,
    /// \[m] bore.
    pub bore: Option<Length>,
    /// \[m] outside diameter.
    pub outside: Option<Length>,
    /// \[m] width.
    pub width: Option<Length>,
    /// \[N] basic dynamic load rating C.
    pub dynamic_load_rating: Option<Force>,
    /// \[N] basic static load rating C0.
    pub static_load_rating: Option<Force>,
    /// \[rad] contact angle; 0 is a deep-groove bearing, 90 degrees a thrust bearing.
    pub contact_angle: Option<Angle>,
    /// Class of the radial clearance of a deep-groove bearing: C2, CN, C3, C4, C5.
    pub clearance: Option<String>,
    /// Means by which balls are kept apart: "ideal" (if not given), "estimated" or "none".
    pub cage: Cage,
}

/// Means by which the scene of a bearing keeps its balls apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cage {
    /// Even spacing, without mass, play and friction.
    #[default]
    Ideal,
    /// A cage of pressed steel, estimated from the balls.
    Estimated,
    /// Nothing: balls touch where they meet.
    None,
}

impl Request {
    /// Reads a request from TOML: `designation = "6205"`, `bore = "25 mm"` and so on.
    ///
    /// # Errors
    /// Names the key.
    pub fn parse(text: &str) -> Result<Self, CatalogueError> {
        toml::from_str(text).map_err(|why: toml::de::Error| {
            let line = why.span().and_then(|span| text.get(..span.start)?.lines().last().map(str::to_string));
            let key =
                line.filter(|line| !line.is_empty()).map_or(String::new(), |line| format!("{line} ..: "));
            CatalogueError::Format(format!("{key}{}", why.message()))
        })
    }

    /// The bearing that is asked for, by its name on a shelf or else in the table.
    ///
    /// # Errors
    /// As [`Request::bearing`], and if numbers or a clearance are given beside a name of the shelf, which has its own.
    pub fn of_shelf(&self, shelf: &Shelf) -> Result<Bearing, CatalogueError> {
        let Some(own) = self.designation.as_deref().and_then(|name| shelf.find(name)) else {
            return self.bearing();
        };
        let by_name = Self { designation: self.designation.clone(), cage: self.cage, ..Self::default() };
        if *self != by_name {
            let why = format!("{} has its numbers in {}: change them there", own.designation, own.source);
            return Err(CatalogueError::Conflict(why));
        }
        let cage = if self.cage == Cage::default() { own.cage } else { self.cage };
        Ok(Bearing { cage, ..own.clone() })
    }

    /// The bearing that is asked for.
    ///
    /// # Errors
    /// If its name is not in the table, something is missing, or out of range.
    pub fn bearing(&self) -> Result<Bearing, CatalogueError> {
        let named = self.designation.as_deref().map(find).transpose()?;
        let row = named.as_ref().map(|named| named.row);
        let given = |value: Option<f64>, of: fn(&Entry) -> f64, key: &'static str| {
            value.or(row.as_ref().map(of)).ok_or(CatalogueError::Missing(key))
        };
        let contact_angle =
            self.contact_angle.map_or(row.map_or(0.0, |row| row.contact_angle.to_radians()), |angle| angle.0);
        let class = match &self.clearance {
            Some(name) => Some(Clearance::parse(name)?),
            None => named.as_ref().and_then(|named| named.clearance),
        };
        if contact_angle != 0.0 && class.is_some() {
            return Err(CatalogueError::Conflict(
                "clearance: classes are of deep-groove bearings; an angular-contact or thrust bearing has its contact angle instead".into(),
            ));
        }
        let by_name = Self {
            designation: self.designation.clone(),
            clearance: self.clearance.clone(),
            cage: self.cage,
            ..Self::default()
        };
        // Numbers beside a name are the user's own.
        let whole = row.is_some() && *self == by_name;
        let bearing = Bearing {
            designation: row.map_or(String::new(), |row| row.designation.into()),
            source: if whole { SOURCE.into() } else { "as given".into() },
            bore: given(self.bore.map(|of| of.0), |row| row.bore / 1e3, "bore")?,
            outside: given(self.outside.map(|of| of.0), |row| row.outside / 1e3, "outside")?,
            width: given(self.width.map(|of| of.0), |row| row.width / 1e3, "width")?,
            dynamic_load_rating: given(
                self.dynamic_load_rating.map(|of| of.0),
                |row| row.dynamic * 1e3,
                "dynamic_load_rating",
            )?,
            static_load_rating: given(
                self.static_load_rating.map(|of| of.0),
                |row| row.static_ * 1e3,
                "static_load_rating",
            )?,
            contact_angle,
            clearance: class.unwrap_or_default(),
            hybrid: named.as_ref().is_some_and(|named| named.hybrid),
            cage: self.cage,
            ignored: named.map(|named| named.ignored).unwrap_or_default(),
            inside: None,
            own_clearance: None,
        };
        bearing.check()?;
        Ok(bearing)
    }
}

impl Bearing {
    fn check(&self) -> Result<(), CatalogueError> {
        let within = |key, value: f64, low: f64, high: f64, scale: f64, unit: &str| {
            if value >= low * (1.0 - 1e-12) && value <= high * (1.0 + 1e-12) {
                return Ok(());
            }
            let [value, low, high] = [value, low, high].map(|of| short(of * scale, 9));
            Err(CatalogueError::Range {
                key,
                value: format!("{value} {unit}"),
                range: format!("[{low}, {high}] {unit}"),
            })
        };
        within("bore", self.bore, 1e-3, 1.0, 1e3, "mm")?;
        within("outside", self.outside, 1.15 * self.bore, 5.0 * self.bore, 1e3, "mm")?;
        // Wider sections than high ones are of several rows.
        within("width", self.width, 0.4 * self.section_height(), 2.5 * self.section_height(), 1e3, "mm")?;
        within("dynamic_load_rating", self.dynamic_load_rating, 1.0, 1e8, 1e-3, "kN")?;
        within("static_load_rating", self.static_load_rating, 1.0, 1e8, 1e-3, "kN")?;
        let angle = self.contact_angle.to_degrees();
        if !self.is_thrust() && !(0.0..=45.0 * (1.0 + 1e-12)).contains(&angle) {
            return Err(CatalogueError::Range {
                key: "contact_angle",
                value: format!("{} deg", short(angle, 9)),
                range: "[0, 45] deg, or 90 deg of a thrust bearing".into(),
            });
        }
        if self.is_deep_groove() {
            self.clearance.limits(self.bore)?;
        }
        Ok(())
    }
}
