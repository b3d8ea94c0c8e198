//! The section of a flexible support of a race, and 6 x 6 matrices of stiffness and damping.

use std::marker::PhantomData;

use nalgebra::{Matrix6, Vector6};
use serde::Deserialize;
use serde::de::{Deserializer, Error};

use super::reader;
use super::units::{
    Inertia, Mass, Quantity, RotationalDamping, RotationalStiffness, TranslationalDamping,
    TranslationalStiffness,
};

/// A flexible support between a race and its flange, `[inner.support]` or `[outer.support]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SupportSection {
    /// [N/m, N m/rad] stiffness along and about the flange's axes x, y, z: six numbers, or six rows of six.
    pub stiffness: DirectionMatrix<TranslationalStiffness, RotationalStiffness>,
    /// [N s/m, N m s/rad] damping, likewise; none if not given.
    #[serde(default)]
    pub damping: DirectionMatrix<TranslationalDamping, RotationalDamping>,
    /// \[kg] mass of the race and what moves with it.
    pub mass: Mass,
    /// [kg m2] its moments of inertia about the race's x, y and z axes.
    pub inertia: [Inertia; 3],
}

/// A matrix of forces and moments by translations and rotations along and about x, y, z; 0 by default. `T` measures its entries of
/// forces by translations, `R` those of moments by rotations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionMatrix<T, R>(pub Matrix6<f64>, PhantomData<(T, R)>);

impl<T, R> DirectionMatrix<T, R> {
    /// Entries on the diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        self.0.diagonal().iter().copied().collect()
    }
}

impl<T, R> Default for DirectionMatrix<T, R> {
    fn default() -> Self {
        Self(Matrix6::zeros(), PhantomData)
    }
}

/// An entry in SI: of a force by a translation, of a moment by a rotation, or of a coupling of both.
fn entry<T, R, E: Error>(value: &toml::Value, row: usize, column: usize) -> Result<f64, E>
where
    T: Quantity,
    R: Quantity,
{
    let read = match (row < 3, column < 3) {
        (true, true) => T::DIMENSION.read(value),
        (false, false) => R::DIMENSION.read(value),
        _ => reader::read(value).map_err(|why| why.message().to_string()),
    };
    read.map_err(E::custom)
}

impl<'de, T, R> Deserialize<'de> for DirectionMatrix<T, R>
where
    T: Quantity,
    R: Quantity,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        const SIX: &str = "six numbers along and about x, y, z, or six rows of six";
        let six = |value: toml::Value| -> Result<[toml::Value; 6], D::Error> {
            let toml::Value::Array(values) = value else {
                return Err(Error::custom(SIX));
            };
            values.try_into().map_err(|_| Error::custom(SIX))
        };
        let rows = six(toml::Value::deserialize(deserializer)?)?;
        let mut matrix = Matrix6::zeros();
        if rows.iter().any(toml::Value::is_array) {
            for (i, row) in rows.into_iter().enumerate() {
                for (k, value) in six(row)?.into_iter().enumerate() {
                    matrix[(i, k)] = entry::<T, R, D::Error>(&value, i, k)?;
                }
            }
        } else {
            let mut diagonal = Vector6::zeros();
            for (i, value) in rows.into_iter().enumerate() {
                diagonal[i] = entry::<T, R, D::Error>(&value, i, i)?;
            }
            matrix = Matrix6::from_diagonal(&diagonal);
        }
        Ok(Self(matrix, PhantomData))
    }
}
