//! Accelerations as a sensor would tell them: by how much a velocity has changed since the row before, over the time between. Those of the integrator are
//! unknowns of its steps: they follow from its stages, and change their sign from step to step where a motion is stiff.

/// Place and component of a velocity; none of other columns.
pub fn of_velocity(name: &str) -> Option<(&str, &str)> {
    let (place, component) = name.rsplit_once(".velocity.")?;
    matches!(component, "x" | "y" | "z").then_some((place, component))
}

/// Name of an acceleration.
pub fn name(place: &str, component: &str) -> String {
    format!("{place}.acceleration.{component}")
}

/// Unit of an acceleration.
pub const UNIT: &str = "m/s2";

/// Accelerations of a list of velocities, row by row.
#[derive(Clone, Debug, Default)]
pub struct Accelerations {
    /// \[s] time of the last row, and its velocities [m/s].
    last: Option<(f64, Vec<f64>)>,
    now: Vec<f64>,
}

impl Accelerations {
    /// Takes the velocities [m/s] of a row at a time \[s]; of all rows, those of which nothing is written, too.
    pub fn push(&mut self, time: f64, velocities: impl Iterator<Item = f64>) {
        let velocities: Vec<f64> = velocities.collect();
        // None before the first row. A row that is written twice, as at the end of a run, has its own.
        match &self.last {
            Some((before, old)) if time > *before => {
                let changes = velocities.iter().zip(old).map(|(new, old)| (new - old) / (time - before));
                self.now = changes.collect();
            }
            Some(_) => return,
            None => self.now = vec![0.0; velocities.len()],
        }
        self.last = Some((time, velocities));
    }

    /// [m/s2] mean accelerations between the last two rows; 0 at the first one.
    pub fn values(&self) -> &[f64] {
        &self.now
    }
}
