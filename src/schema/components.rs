//! A vector over time: three components, each constant or a table.

use std::marker::PhantomData;

use nalgebra::Vector3;
use serde::de::{Deserialize, Deserializer, Error};

use super::schedule::{self, Schedule};
use super::units::Quantity;

/// Components along x, y, z of a quantity of dimension `Q`, in SI, each constant or a table; 0 by default.
#[derive(Clone, Debug, PartialEq)]
pub struct Components<Q>(pub [Schedule; 3], PhantomData<Q>);

impl<Q> Components<Q> {
    /// The vector at a time \[s].
    pub fn at(&self, time: f64) -> Vector3<f64> {
        Vector3::from_fn(|i, _| self.0[i].at(time))
    }

    /// \[1/s] its rate of change up to a time \[s].
    pub fn slope(&self, time: f64) -> Vector3<f64> {
        Vector3::from_fn(|i, _| self.0[i].slope(time))
    }

    /// Does a table give one of the components?
    pub fn is_scripted(&self) -> bool {
        self.0.iter().any(Schedule::is_scripted)
    }

    /// The vector in axes that are turned by half a turn about z.
    #[must_use]
    pub fn half_turned(&self) -> Self {
        let [x, y, z] = &self.0;
        Self([x.negated(), y.negated(), z.clone()], PhantomData)
    }

    /// Bound of the vector's length at all times.
    pub fn largest(&self) -> f64 {
        let largest =
            |schedule: &Schedule| schedule.values().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let [x, y, z] = self.0.each_ref().map(largest);
        x.hypot(y).hypot(z)
    }
}

impl<Q> Default for Components<Q> {
    fn default() -> Self {
        [0.0; 3].into()
    }
}

impl<Q> From<[f64; 3]> for Components<Q> {
    fn from(constant: [f64; 3]) -> Self {
        Self(constant.map(Schedule::Constant), PhantomData)
    }
}

impl<'de, Q: Quantity> Deserialize<'de> for Components<Q> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        const THREE: &str = "a vector is a list of three components, such as [0, 0, 1]";
        let toml::Value::Array(values) = toml::Value::deserialize(deserializer)? else {
            return Err(Error::custom(THREE));
        };
        let [x, y, z]: [toml::Value; 3] = values.try_into().map_err(|_| Error::custom(THREE))?;
        let read = |value: toml::Value| schedule::of_value(&value, &Q::DIMENSION).map_err(Error::custom);
        Ok(Self([read(x)?, read(y)?, read(z)?], PhantomData))
    }
}
