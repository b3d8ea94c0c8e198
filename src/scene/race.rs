//! Sections, loads and speeds of a race in a scene.

use super::{Direction, Drive, Machine, RaceSection, Scene, Schedule};
use crate::numerics::motion::Wrench;
use crate::schema::Race;

impl Race {
    /// Its section of a scene.
    pub fn section(self, scene: &Scene) -> &RaceSection {
        match self {
            Self::Inner => &scene.inner,
            Self::Outer => &scene.outer,
        }
    }

    /// Loads or motions of a scene for its directions x, y, z, ry, rz.
    pub fn directions(self, scene: &Scene) -> [Direction<'_>; 5] {
        match self {
            Self::Inner => scene.load.of_inner(),
            Self::Outer => scene.load.of_outer(),
        }
    }

    /// Its scripted speed [rad/s] in a scene.
    pub fn scripted_speed(self, scene: &Scene) -> &Schedule {
        match self {
            Self::Inner => &scene.load.inner_speed,
            Self::Outer => &scene.load.outer_speed,
        }
    }

    /// Parts of the machine on it, if a scene has some.
    pub fn machine(self, scene: &Scene) -> Option<Machine<'_>> {
        let machine = scene.load.machine(self.scripted_speed(scene));
        (self == Self::loaded(scene) && !machine.is_empty()).then_some(machine)
    }

    /// \[N, N m] its load at a time \[s] in the directions x, y, z, ry, rz, by parts of the machine too; 0 in a direction that the
    /// scene holds: there they press on what holds it.
    pub fn load_at(self, scene: &Scene, time: f64) -> [f64; 5] {
        let machine = self.machine(scene).map(|machine| machine.at(time)).unwrap_or_default();
        let Wrench { force, moment } = machine;
        let added = [force.x, force.y, force.z, moment.y, moment.z];
        let directions = self.directions(scene);
        std::array::from_fn(|i| match directions[i].motion {
            Some(_) => 0.0,
            None => directions[i].load.map_or(0.0, |load| load.at(time)) + added[i],
        })
    }

    /// The race that the loads of a scene are put on: the outer one under a wrench, else the inner one. The other race
    /// holds the bearing.
    pub fn loaded(scene: &Scene) -> Self {
        if scene.outer.drive == Drive::Wrench { Self::Outer } else { Self::Inner }
    }
}
