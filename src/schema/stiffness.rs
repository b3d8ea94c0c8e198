//! A stiffness: a number, or a table of force over displacement.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, IntoDeserializer, SeqAccess, Visitor};

use super::units::Quantity;

/// A stiffness `K`, or points of displacement `X` and force `F`.
#[derive(Clone, Debug, PartialEq)]
pub enum Stiffness<K, X, F> {
    /// One at all displacements.
    Linear(K),
    /// Points `[displacement, force]`.
    Table(Vec<(X, F)>),
}

impl<K: Quantity, X: Quantity, F: Quantity> Stiffness<K, X, F> {
    /// [N/m or N m/rad] the number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Linear(stiffness) => Some(stiffness.si()),
            Self::Table(_) => None,
        }
    }

    /// Points of the table, SI, if it is one.
    pub fn points(&self) -> Option<Vec<[f64; 2]>> {
        match self {
            Self::Linear(_) => None,
            Self::Table(points) => Some(points.iter().map(|(way, force)| [way.si(), force.si()]).collect()),
        }
    }
}

impl<'de, K, X, F> Deserialize<'de> for Stiffness<K, X, F>
where
    K: Deserialize<'de>,
    X: Deserialize<'de>,
    F: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either<K, X, F>(PhantomData<(K, X, F)>);
        impl<'de, K, X, F> Visitor<'de> for Either<K, X, F>
        where
            K: Deserialize<'de>,
            X: Deserialize<'de>,
            F: Deserialize<'de>,
        {
            type Value = Stiffness<K, X, F>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a stiffness, or a table [[displacement, force], ...]")
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<Self::Value, E> {
                K::deserialize(number.into_deserializer()).map(Stiffness::Linear)
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
                K::deserialize(number.into_deserializer()).map(Stiffness::Linear)
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                K::deserialize(text.into_deserializer()).map(Stiffness::Linear)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Stiffness::Table)
            }
        }
        deserializer.deserialize_any(Either(PhantomData))
    }
}
