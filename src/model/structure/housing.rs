//! A housing of a system as a structure: rigid on springs, or of matrices.

use nalgebra::{DMatrix, DVector, Dyn, Matrix6, OMatrix, U3, Vector3};

use super::{Carrier, Lump, Map, Structure, Turning};
use crate::schema::{Foot, HousingSection};

/// Displacement and rotation at a place of a rigid body by those of its centre, from there \[m].
fn moved_with(arm: &Vector3<f64>) -> Matrix6<f64> {
    let mut map = Matrix6::identity();
    // `u + r x arm`
    map.fixed_view_mut::<3, 3>(0, 3).copy_from(&-arm.cross_matrix());
    map
}

/// Matrix at the centre of springs (or dampers) along x, y, z at feet.
fn of_feet(feet: &[Foot], centre: &Vector3<f64>, along: fn(&Foot) -> [f64; 3]) -> Matrix6<f64> {
    feet.iter().fold(Matrix6::zeros(), |sum, foot| {
        let place = Vector3::from(foot.position.map(|length| length.0));
        let to_foot = moved_with(&(place - centre)).fixed_rows::<3>(0).into_owned();
        sum + to_foot.transpose() * nalgebra::Matrix3::from_diagonal(&along(foot).into()) * to_foot
    })
}

impl Carrier {
    /// A housing, with stations at these places \[m].
    ///
    /// # Errors
    /// A sentence, where nothing holds it in some direction, or it has no station at a place.
    pub fn of_housing(section: &HousingSection, stations: &[[f64; 3]]) -> Result<Self, String> {
        let carrier = match &section.read {
            Some(read) => {
                let maps = stations.iter().map(|place| read.station(*place)).collect::<Result<_, _>>()?;
                let [mass, damping, stiffness] =
                    [&read.mass, &read.damping, &read.stiffness].map(Clone::clone);
                still([mass, damping, stiffness], read.weights.clone(), vec![], maps)
            }
            None => rigid(section, stations),
        };
        if (*carrier.structure.stiffness).clone().cholesky().is_none() {
            return Err(
                "it can move without a force: give it stiffness in every direction, or three feet".into()
            );
        }
        Ok(carrier)
    }
}

fn rigid(section: &HousingSection, stations: &[[f64; 3]]) -> Carrier {
    let centre = Vector3::from(section.centre.map_or([0.0; 3], |centre| centre.map(|length| length.0)));
    let mass = section.mass.map_or(0.0, |mass| mass.0);
    let inertia = section.inertia.map_or([0.0; 3], |inertia| inertia.map(|moment| moment.0));
    let stiffness =
        section.stiffness.0 + of_feet(&section.foot, &centre, |foot| foot.stiffness.map(|value| value.0));
    let damping = section.damping.0
        + of_feet(&section.foot, &centre, |foot| {
            foot.damping.map_or([0.0; 3], |damping| damping.map(|value| value.0))
        });
    let dynamic = |matrix: Matrix6<f64>| DMatrix::from_fn(6, 6, |i, k| matrix[(i, k)]);
    let diagonal = DVector::from_fn(6, |i, _| if i < 3 { mass } else { inertia[i - 3] });
    let weights = OMatrix::from_fn_generic(Dyn(6), U3, |i, k| if i == k { mass } else { 0.0 });
    let map = |place: &[f64; 3]| {
        let map = moved_with(&(Vector3::from(*place) - centre));
        Map::from_fn(6, |i, k| map[(i, k)])
    };
    let matrices = [DMatrix::from_diagonal(&diagonal), dynamic(damping), dynamic(stiffness)];
    let whole = Lump { place: centre, mass, inertia: Vector3::from(inertia), map: Map::identity(6) };
    still(matrices, weights, vec![whole], stations.iter().map(map).collect())
}

/// A structure that does not turn: mass, damping and stiffness.
fn still(
    [mass, damping, stiffness]: [DMatrix<f64>; 3],
    weights: OMatrix<f64, Dyn, U3>,
    lumps: Vec<Lump>,
    stations: Vec<Map>,
) -> Carrier {
    let size = mass.nrows();
    let structure = Structure {
        mass: mass.into(),
        damping: damping.into(),
        stiffness: stiffness.into(),
        gyroscopic: DMatrix::zeros(size, size).into(),
        polar_inertia: 0.0,
        by_spin: DVector::zeros(size),
        weights,
        lumps,
        turning: Turning::Still,
        rings: 0,
        held: vec![],
    };
    Carrier { structure, stations, sliding: vec![], modes: vec![] }
}
