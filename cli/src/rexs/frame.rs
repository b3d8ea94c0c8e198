//! Axes of a gearbox: where its parts are, and the axes that a machine's file has: x along all shafts.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::model::{Component, Model};

/// [rad] how far shafts may be from parallel, by the digits of a file.
const PARALLEL: f64 = 1e-6;
/// Components that are placed by others, one after another, at most.
const DEEPEST: usize = 32;

/// Place and axes of a component in those of the gear unit: its origin \[m], and u, v, w as columns.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// \[m] origin.
    pub origin: Vector3<f64>,
    /// Its axes u, v, w as columns.
    pub axes: Matrix3<f64>,
}

impl Default for Frame {
    fn default() -> Self {
        Self { origin: Vector3::zeros(), axes: Matrix3::identity() }
    }
}

impl Frame {
    /// Frame of a component, if the file says where it is.
    ///
    /// # Errors
    /// Names the component, if its axes are none or it is placed by itself.
    pub fn of(component: &Component, model: &Model) -> Result<Option<Self>, String> {
        Self::found(component, model, 0)
    }

    fn found(component: &Component, model: &Model, depth: usize) -> Result<Option<Self>, String> {
        let Some(origin) = component.vector("support_vector")? else { return Ok(None) };
        let [u, w] = [("u_axis_vector", [1.0, 0.0, 0.0]), ("w_axis_vector", [0.0, 0.0, 1.0])]
            .map(|(name, usual)| component.vector(name).map(|found| Vector3::from(found.unwrap_or(usual))));
        let (u, w) = (u?, w?);
        let none = || {
            format!(
                "{component}: u_axis_vector {:?} and w_axis_vector {:?} are no axes",
                u.as_slice(),
                w.as_slice()
            )
        };
        let u = u.try_normalize(0.0).ok_or_else(none)?;
        let w = (w - u * u.dot(&w)).try_normalize(1e-9).ok_or_else(none)?;
        let own = Self { origin: Vector3::from(origin), axes: Matrix3::from_columns(&[u, w.cross(&u), w]) };
        let by = component.text("reference_component_for_position").and_then(|text| text.parse().ok());
        let Some(by) = by.filter(|by| *by != component.id).and_then(|by: u64| model.components.get(&by))
        else {
            return Ok(Some(own));
        };
        if depth == DEEPEST {
            return Err(format!("{component}: reference_component_for_position goes round in a circle"));
        }
        let under = Self::found(by, model, depth + 1)?.unwrap_or_default();
        Ok(Some(Self { origin: under.origin + under.axes * own.origin, axes: under.axes * own.axes }))
    }
}

/// The axes of a machine: x along all shafts, z as near to the gear unit's w axis as may be.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    turn: Rotation3<f64>,
}

impl Axes {
    /// Axes whose x is along a shaft.
    pub fn along(u: &Vector3<f64>) -> Self {
        let up = if u.z.abs() < 0.9 { Vector3::z() } else { Vector3::y() };
        let z = (up - u * u.dot(&up)).normalize();
        Self {
            turn: Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[*u, z.cross(u), z]).transpose()),
        }
    }

    /// A vector in them.
    pub fn turned(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.turn * vector
    }

    /// Does a shaft point along x (1) or against it (-1)?
    ///
    /// # Errors
    /// Names the shaft, if it is not parallel to the others.
    pub fn way(&self, shaft: &Component, frame: &Frame) -> Result<f64, String> {
        let u = self.turned(&frame.axes.column(0).into_owned());
        let across = u.yz().norm();
        if across > PARALLEL {
            return Err(format!(
                "{shaft}: its axis is {:.4} deg from that of the first shaft: a machine has parallel shafts",
                u.x.acos().to_degrees()
            ));
        }
        Ok(u.x.signum())
    }
}
