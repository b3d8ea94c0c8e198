//! Checks of the keys of a housing.

use super::NamedLoad;
use super::check_motion::given_motion;
use super::ranges::{INERTIA, MASS, POSITION};
use crate::schema::numbers::Range;
use crate::schema::units::{Length, Quantity};
use crate::schema::{HousingSection, SceneError};

const STIFFNESS: Range = Range::closed(0.0, 1e15, "N/m or N m/rad");
const DAMPING: Range = Range::closed(0.0, 1e12, "N s/m or N m s/rad");
/// [-] asymmetry of a matrix over its entries that is rounding.
const ROUNDING: f64 = 1e-9;

/// Checks a housing; errors name it.
pub fn housing(housing: &HousingSection) -> Result<(), SceneError> {
    let inside =
        |source| SceneError::At { place: format!("housing \"{}\"", housing.name), source: Box::new(source) };
    keys(housing).map_err(inside)
}

fn keys(housing: &HousingSection) -> Result<(), SceneError> {
    let HousingSection { mass, inertia, centre, stiffness, damping, foot, matrices, load, point, .. } =
        housing;
    let held = !foot.is_empty() || stiffness.0.amax() > 0.0;
    if matrices.is_some() {
        let given = [
            ("housing.mass", mass.is_some()),
            ("housing.inertia", inertia.is_some()),
            ("housing.centre", centre.is_some()),
            ("housing.stiffness", held),
            ("housing.damping", damping.0.amax() > 0.0),
        ];
        if let Some((key, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(SceneError::conflict(key, "is in the file of housing.matrices"));
        }
    } else {
        let (Some(mass), Some(inertia)) = (mass, inertia) else {
            let why = "a rigid housing needs mass and inertia; a flexible one matrices";
            return Err(SceneError::conflict("housing.mass", why));
        };
        MASS.check("housing.mass", mass.0)?;
        inertia.iter().try_for_each(|moment| INERTIA.check("housing.inertia", moment.0))?;
        if !held {
            let why = "nothing holds it: give stiffness, or [[housing.foot]]";
            return Err(SceneError::conflict("housing.stiffness", why));
        }
    }
    centre.iter().try_for_each(|centre| place("housing.centre", centre))?;
    for (key, matrix, range) in
        [("housing.stiffness", &stiffness.0, STIFFNESS), ("housing.damping", &damping.0, DAMPING)]
    {
        matrix.diagonal().iter().try_for_each(|value| range.check(key, *value))?;
        let apart = (matrix - matrix.transpose()).amax();
        if apart.is_nan() || apart > ROUNDING * matrix.amax() {
            let why = format!("is not symmetric: entries differ by up to {apart}");
            return Err(SceneError::conflict(key, why));
        }
    }
    for foot in foot {
        place("housing.foot.position", &foot.position)?;
        of_foot("housing.foot.stiffness", STIFFNESS, &foot.stiffness)?;
        foot.damping.iter().try_for_each(|damping| of_foot("housing.foot.damping", DAMPING, damping))?;
    }
    for load in load {
        place("housing.load.position", &load.position)?;
        given_motion(&NamedLoad::of_housing(load))?;
    }
    point.iter().try_for_each(|point| place("housing.point.position", &point.position))
}

fn of_foot<Q: Quantity>(key: &str, range: Range, values: &[Q; 3]) -> Result<(), SceneError> {
    values.iter().try_for_each(|value| range.check(key, value.si()))
}

fn place(key: &str, place: &[Length; 3]) -> Result<(), SceneError> {
    place.iter().try_for_each(|length| POSITION.check(key, length.0))
}
