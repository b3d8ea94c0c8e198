//! Structures of which the motion of some places is given.
//!
//! With `A q = u(t)` for the given components, coordinates become `q = N f + H u`: `A N = 0`, and `H = M^-1 A^T (A M^-1 A^T)^-1`, so that
//! `A H = 1` and inertia couples neither with the other. The given components are coordinates then, at the places of some of the old ones.

use nalgebra::DMatrix;

use super::{Carrier, Lump, Map, Structure};

/// [-] of its own size: what is left of a component that others give already.
const DEPENDENT: f64 = 1e-9;

impl Carrier {
    /// With the motion of these components (0 to 5) at these stations as coordinates that are given, in that order.
    ///
    /// # Errors
    /// The index of a component that follows from those before it.
    pub fn holding(self, given: &[(usize, usize)]) -> Result<Self, usize> {
        if given.is_empty() {
            return Ok(self);
        }
        let Self { structure, stations, sliding, modes } = self;
        let n = structure.size();
        let rows = DMatrix::from_fn(given.len(), n, |i, k| stations[given[i].0][(given[i].1, k)]);
        let pivots = pivots(&rows, &structure.mass)?;
        let by = change(&rows, &pivots, &structure.mass).ok_or(given.len() - 1)?;
        let map = |map: &Map| map * &by;
        let matrix = |of: &DMatrix<f64>| by.tr_mul(&(of * &by));
        let mut mass = matrix(&structure.mass);
        // What is zero but for rounding.
        for (i, k) in
            pivots.iter().flat_map(|i| (0..n).map(move |k| (*i, k))).filter(|(_, k)| !pivots.contains(k))
        {
            (mass[(i, k)], mass[(k, i)]) = (0.0, 0.0);
        }
        let structure = Structure {
            mass: mass.into(),
            damping: matrix(&structure.damping).into(),
            stiffness: matrix(&structure.stiffness).into(),
            gyroscopic: matrix(&structure.gyroscopic).into(),
            by_spin: by.tr_mul(&structure.by_spin),
            weights: by.tr_mul(&structure.weights),
            lumps: structure.lumps.into_iter().map(|lump| Lump { map: map(&lump.map), ..lump }).collect(),
            held: pivots,
            ..structure
        };
        let sliding = sliding.into_iter().map(|(station, ring)| (station, map(&ring))).collect();
        Ok(Self { structure, stations: stations.iter().map(map).collect(), sliding, modes })
    }
}

/// A coordinate for each row, in which it is large while those of the other rows are eliminated; in units in which coordinates have equal mass.
fn pivots(rows: &DMatrix<f64>, mass: &DMatrix<f64>) -> Result<Vec<usize>, usize> {
    let scale = |k: usize| mass[(k, k)].sqrt().max(f64::MIN_POSITIVE);
    let scaled = DMatrix::from_fn(rows.nrows(), rows.ncols(), |i, k| rows[(i, k)] / scale(k));
    let mut left = scaled.clone();
    let mut pivots: Vec<usize> = vec![];
    for i in 0..left.nrows() {
        let free = (0..left.ncols()).filter(|k| !pivots.contains(k));
        let pivot = free.max_by(|a, b| left[(i, *a)].abs().total_cmp(&left[(i, *b)].abs())).ok_or(i)?;
        let largest = left[(i, pivot)];
        if largest.abs() <= DEPENDENT * scaled.row(i).amax() {
            return Err(i);
        }
        let own = left.row(i) / largest;
        for other in i + 1..left.nrows() {
            let factor = left[(other, pivot)];
            let mut row = left.row_mut(other);
            row -= &own * factor;
        }
        pivots.push(pivot);
    }
    Ok(pivots)
}

/// Old coordinates by the new ones.
fn change(rows: &DMatrix<f64>, pivots: &[usize], mass: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = rows.ncols();
    let of_pivots = rows.select_columns(pivots).lu();
    let mut by = DMatrix::identity(n, n);
    for k in (0..n).filter(|k| !pivots.contains(k)) {
        let follow = of_pivots.solve(&rows.column(k).into_owned())?;
        pivots.iter().zip(follow.iter()).for_each(|(pivot, value)| by[(*pivot, k)] = -value);
    }
    let driven = mass.clone().cholesky()?.solve(&rows.transpose());
    let moved = driven.clone() * (rows * &driven).lu().try_inverse()?;
    pivots.iter().zip(moved.column_iter()).for_each(|(pivot, column)| by.set_column(*pivot, &column));
    Some(by)
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;
    use crate::schema::ShaftSection;
    use crate::schema::units::{Inertia, Length, Mass};

    fn rigid() -> Carrier {
        let section = ShaftSection {
            mass: Some(Mass(2.0)),
            polar_inertia: Some(Inertia(1e-3)),
            transverse_inertia: Some(Inertia(5e-3)),
            centre: Some(Length(0.01)),
            ..ShaftSection::default()
        };
        Carrier::of_shaft(&section, &[-0.05, 0.05, 0.02], false).unwrap()
    }

    #[test]
    fn closed_form_a_point_that_is_driven_moves_as_given_and_the_rest_by_its_inertia() {
        let held = rigid().holding(&[(2, 1), (2, 0)]).unwrap();
        let Structure { mass, held: places, .. } = &held.structure;
        // The mass that a force across the axis at an arm of 10 mm meets: 1/(1/m + a^2/I).
        assert!((mass[(places[0], places[0])] - 1.0 / (1.0 / 2.0 + 1e-4 / 5e-3)).abs() < 1e-12);
        assert!((mass[(places[1], places[1])] - 2.0).abs() < 1e-12);
        let mut q = DVector::from_fn(held.structure.size(), |i, _| 1e-3 * (i as f64 - 1.7));
        (q[places[0]], q[places[1]]) = (0.25, -0.5);
        let at = &held.stations[2] * &q;
        assert!((at[1] - 0.25).abs() < 1e-15 && (at[0] + 0.5).abs() < 1e-15, "{at}");
    }

    #[test]
    fn refusal_a_component_that_follows_from_others_is_named() {
        assert_eq!(rigid().holding(&[(0, 1), (1, 1), (2, 1)]).err(), Some(2));
        assert_eq!(rigid().holding(&[(0, 0), (1, 0)]).err(), Some(1));
        assert!(rigid().holding(&[(0, 1), (1, 1), (2, 2), (2, 4)]).is_ok());
    }
}
