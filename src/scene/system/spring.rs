//! Links of a system: bearings by their stiffness or by rollers, and couplings between two shafts.

use nalgebra::Vector3;

use super::ranges::POSITION;
use crate::model::link::force_table::ForceTable;
use crate::model::link::rollers::Rollers;
use crate::model::link::spring_bearing::Spring;
use crate::schema::numbers::Range;
use crate::schema::units::Quantity;
use crate::schema::{AxialTaken, CouplingSection, SceneError, ShaftSection, Stiffness, StiffnessSection};

const STIFFNESS: Range = Range::above(0.0, 1e15, "N/m");
const NO_LESS: Range = Range::closed(0.0, 1e15, "N/m, N m/rad, N s/m or N m s/rad");
const PLAY: Range = Range::closed(0.0, 0.1, "m");
const WAY: Range = Range::closed(-1.0, 1.0, "m or rad");
const FORCE: Range = Range::closed(-1e9, 1e9, "N or N m");

/// A bearing by its stiffness or by rollers, or a coupling.
#[derive(Clone, Debug)]
pub struct SceneSpring {
    /// Its name.
    pub name: String,
    /// Index of its shaft; of a coupling the first.
    pub shaft: usize,
    /// \[m] position along that.
    pub position: f64,
    /// Index of the housing that it sits in; none in the ground.
    pub housing: Option<usize>,
    /// Index of the second shaft of a coupling, or of the shaft that the outer ring of rollers is a part of.
    pub second: Option<usize>,
    /// \[m, rad] how far its bore lies beside the axis of the shaft, and the tilt of that.
    pub bore: (Vector3<f64>, Vector3<f64>),
    /// Its keys; none of a bearing by rollers.
    pub stiffness: StiffnessSection,
    /// Its rollers.
    pub rollers: Option<Rollers>,
}

impl SceneSpring {
    /// \[m] position along a shaft, if it is on that.
    pub fn position_on(&self, shaft: usize, shafts: &[ShaftSection]) -> Option<f64> {
        match shaft {
            own if own == self.shaft => Some(self.position),
            own if Some(own) == self.second => {
                Some(shafts[self.shaft].place(self.position)[0] - shafts[own].place(0.0)[0])
            }
            _ => None,
        }
    }

    /// Is it a coupling?
    pub fn is_coupling(&self) -> bool {
        self.second.is_some() && self.rollers.is_none()
    }

    /// Does it hold the shaft along the axis?
    pub fn holds_axially(&self) -> bool {
        let by_stiffness = self.stiffness.axial.as_ref().is_some_and(|axial| axial.number() != Some(0.0));
        by_stiffness || self.rollers.as_ref().is_some_and(Rollers::has_ribs)
    }

    /// Is it a bearing by rollers with friction?
    pub fn rubs(&self) -> bool {
        self.rollers.as_ref().is_some_and(|rollers| rollers.friction.is_some())
    }

    /// Does it hold the turns of two shafts against each other?
    pub fn couples(&self) -> Option<[usize; 2]> {
        self.stiffness.torsion.as_ref().and(self.second).map(|second| [self.shaft, second])
    }
}

/// A stiffness as the model has it; none, where nothing is given, is 0.
pub fn spring<K: Quantity, X: Quantity, F: Quantity>(given: Option<&Stiffness<K, X, F>>) -> Spring {
    let table = given.and_then(Stiffness::points).and_then(|points| ForceTable::through(&points));
    table.map_or_else(|| Spring::Linear(given.and_then(Stiffness::number).unwrap_or(0.0)), Spring::Table)
}

/// Reads a coupling.
///
/// # Errors
/// Names it, the key, the value and the range.
pub fn coupling(section: &CouplingSection, shafts: &[ShaftSection]) -> Result<SceneSpring, SceneError> {
    let inside =
        |source| SceneError::At { place: format!("coupling \"{}\"", section.name), source: Box::new(source) };
    checked(section, shafts).map_err(inside)
}

fn checked(section: &CouplingSection, shafts: &[ShaftSection]) -> Result<SceneSpring, SceneError> {
    POSITION.check("coupling.position", section.position.0)?;
    let mut of = [0; 2];
    for (place, wanted) in of.iter_mut().zip(&section.shafts) {
        *place = shafts.iter().position(|shaft| shaft.name == *wanted).ok_or_else(|| {
            let names: Vec<&str> = shafts.iter().map(|shaft| shaft.name.as_str()).collect();
            let why = format!("there is no such [[shaft]]; there are: {}", names.join(", "));
            SceneError::conflict(format!("coupling.shafts = \"{wanted}\""), why)
        })?;
    }
    let refuse = |why: &str| Err(SceneError::conflict("coupling.shafts", why));
    if of[0] == of[1] {
        return refuse("both are one shaft: a coupling joins two");
    }
    if !shafts[of[0]].is_coaxial_with(&shafts[of[1]]) {
        return refuse("both must be on one axis: give them the same y and z of shaft.origin");
    }
    let stiffness = &section.stiffness;
    if stiffness.gap.is_some() || stiffness.axial_way != AxialTaken::Both {
        let why = "is for a bearing: play of a coupling is a table whose force begins beyond it";
        return Err(SceneError::conflict("coupling.stiffness", why));
    }
    check(stiffness, "coupling.stiffness")?;
    Ok(SceneSpring {
        name: section.name.clone(),
        shaft: of[0],
        position: section.position.0,
        housing: None,
        second: Some(of[1]),
        bore: (Vector3::zeros(), Vector3::zeros()),
        stiffness: stiffness.clone(),
        rollers: None,
    })
}

/// Checks the keys of a bearing by its stiffness.
///
/// # Errors
/// Names the key, the value and the range.
pub fn check_bearing(of: &StiffnessSection) -> Result<(), SceneError> {
    let Some(radial) = &of.radial else {
        return Err(SceneError::conflict(
            "bearing.stiffness.radial",
            "is needed: how stiff the bearing is across its axis",
        ));
    };
    radial.number().map_or(Ok(()), |k| STIFFNESS.check("bearing.stiffness.radial", k))?;
    if of.torsion.is_some() || of.torsion_damping.is_some() {
        let why = "is for a [[coupling]]: a bearing does not hold the turn of its shaft";
        return Err(SceneError::conflict("bearing.stiffness.torsion", why));
    }
    if radial.points().is_some() && of.gap.is_some() {
        let why = "is beside a table: its first points have the play, [[0, 0], [gap, 0], ...]";
        return Err(SceneError::conflict("bearing.stiffness.gap", why));
    }
    if of.axial_way != AxialTaken::Both && of.axial.as_ref().is_some_and(|axial| axial.points().is_some()) {
        let why =
            "is beside a table: give it points on both sides, [[-0.001, 0], [0, 0], ...], which hold one way";
        return Err(SceneError::conflict("bearing.stiffness.axial_way", why));
    }
    PLAY.check("bearing.stiffness.gap", of.gap.map_or(0.0, |gap| gap.0))?;
    check(of, "bearing.stiffness")
}

fn check(of: &StiffnessSection, section: &str) -> Result<(), SceneError> {
    let key = |name: &str| format!("{section}.{name}");
    stiffness(&key("radial"), of.radial.as_ref(), true)?;
    stiffness(&key("axial"), of.axial.as_ref(), false)?;
    stiffness(&key("tilt"), of.tilt.as_ref(), true)?;
    stiffness(&key("torsion"), of.torsion.as_ref(), false)?;
    let dampings = [
        ("radial_damping", of.radial_damping.map(|c| c.0)),
        ("axial_damping", of.axial_damping.map(|c| c.0)),
        ("tilt_damping", of.tilt_damping.map(|c| c.0)),
        ("torsion_damping", of.torsion_damping.map(|c| c.0)),
    ];
    dampings.into_iter().try_for_each(|(name, value)| NO_LESS.check(&key(name), value.unwrap_or(0.0)))
}

/// A number that is no less than 0, or a table that is one: alike in all directions, or along one axis.
fn stiffness<K: Quantity, X: Quantity, F: Quantity>(
    key: &str,
    given: Option<&Stiffness<K, X, F>>,
    alike: bool,
) -> Result<(), SceneError> {
    let Some(given) = given else { return Ok(()) };
    let Some(points) = given.points() else { return NO_LESS.check(key, given.number().unwrap_or(0.0)) };
    let refuse = |why: String| Err(SceneError::conflict(key, why));
    for [way, force] in &points {
        WAY.check(&format!("{key}: displacement"), *way)?;
        FORCE.check(&format!("{key}: force"), *force)?;
    }
    if points.len() < 2 {
        return refuse(format!(
            "{} points: a table has two or more, [[displacement, force], ...]",
            points.len()
        ));
    }
    let from_rest = points[0] == [0.0, 0.0];
    if alike && !from_rest {
        return refuse(format!(
            "begins at [{}, {}]: a table that holds alike in all directions begins at [0, 0]",
            points[0][0], points[0][1]
        ));
    }
    if !from_rest && points[0][0] >= 0.0 {
        return refuse(format!(
            "begins at [{}, {}]: from [0, 0] a table holds both ways alike; one of both ways begins below 0",
            points[0][0], points[0][1]
        ));
    }
    if let Some(pair) = points.windows(2).find(|pair| pair[1][0] <= pair[0][0] || pair[1][1] < pair[0][1]) {
        return refuse(format!(
            "after [{}, {}] comes [{}, {}]: displacements grow, and forces do not fall",
            pair[0][0], pair[0][1], pair[1][0], pair[1][1]
        ));
    }
    Ok(())
}
