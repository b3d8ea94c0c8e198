//! Quantities that a user asks of a bearing, at a settled state: equilibrium with balls that roll, each with its friction in balance.

use nalgebra::Vector3;

use crate::effects::estimate::Changes;
use crate::model::bodies::Race;
use crate::simulation::Simulation;

/// Quantities of a bearing that was just started.
#[derive(Clone, Copy, Debug)]
pub struct Settled {
    /// \[W] all losses; over the speed they are the torque.
    pub power: f64,
    /// \[N] largest load of a ball on the inner race.
    largest_load: f64,
    /// [-] reference life, million revolutions.
    life: Option<f64>,
    /// \[m] place of the loaded race, or of its flange's, from the other's.
    displacement: Vector3<f64>,
    /// [-] film over roughness at the most loaded ball on the inner race, where there is oil.
    pub film_ratio: Option<f64>,
}

impl Settled {
    /// Those of a bearing that was just started.
    pub fn of(simulation: &Simulation) -> Self {
        let outputs = simulation.outputs();
        let most = outputs.balls.iter().max_by(|a, b| a.inner.load.total_cmp(&b.inner.load));
        let (moved, other) = match Race::loaded(simulation.scene()) {
            Race::Inner => (Race::Inner, Race::Outer),
            Race::Outer => (Race::Outer, Race::Inner),
        };
        Self {
            power: outputs.losses.total(),
            largest_load: most.map_or(0.0, |ball| ball.inner.load),
            life: outputs.life.map(|life| life.reference),
            film_ratio: most.map(|ball| ball.inner.film.ratio).filter(|ratio| *ratio > 0.0),
            displacement: outputs[moved].pose.position - simulation.inputs()[other].pose.position,
        }
    }

    /// Changes of another state, over the quantities here.
    pub fn changes_to(&self, with: &Self) -> Changes {
        let change = |before: f64, after: f64| {
            let size = if before > 0.0 { before } else { after };
            Some((after - before) / size).filter(|change| change.is_finite())
        };
        let life = self.life.zip(with.life).and_then(|(before, after)| change(before, after));
        let moved = (with.displacement - self.displacement).norm() / self.displacement.norm();
        Changes {
            torque: change(self.power, with.power),
            largest_load: change(self.largest_load, with.largest_load),
            life,
            displacement: Some(moved).filter(|moved| moved.is_finite()),
        }
    }
}
