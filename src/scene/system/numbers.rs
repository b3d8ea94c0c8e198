//! The numbers of a shaft, its housings and mountings that a package offers as parameters. Those of the bearings are in their own scenes.

use super::SystemScene;
use super::ranges::{BORE_OFFSET, BORE_TILT, INERTIA, MASS, POSITION};
use crate::schema::numbers::{Range, Variability};
use crate::schema::{AxialSeat, Disc, Mounting, ShaftSection};

const SPEED: Range = Range::closed(-1e5, 1e5, "rad/s");
const UNBALANCE: Range = Range::closed(0.0, 1e3, "kg m");
const ANGLE: Range = Range::closed(-7.0, 7.0, "rad");
const RETARDATION: Range = Range::closed(0.0, 1.0, "s");
const FORCE: Range = Range::closed(-1e9, 1e9, "N");
const WAY: Range = Range::closed(-0.1, 0.1, "m");
const TOLERANCE: Range = Range::closed(1e-14, 1e-2, "");
const LEVEL: Range = Range::whole(0.0, 1.0);
const STEP: Range = Range::closed(1e-15, 1e-2, "s");

/// Which of several parts a number is of: names stand before its key, or in it.
type Names = fn(&SystemScene) -> Vec<String>;

/// A number of one or several parts.
#[derive(Debug)]
pub struct ShaftNumber {
    /// Key behind the name of the part.
    pub key: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Allowed values.
    pub range: Range,
    /// Can it be set before the start alone?
    pub variability: Variability,
    names: Names,
    place: fn(&mut SystemScene, usize) -> Option<&mut f64>,
    /// Is it one of all bearings together?
    shared: bool,
}

const fn number(
    key: &'static str,
    description: &'static str,
    range: Range,
    names: Names,
    place: fn(&mut SystemScene, usize) -> Option<&mut f64>,
) -> ShaftNumber {
    ShaftNumber { key, description, range, variability: Variability::Fixed, names, place, shared: false }
}

fn of_shafts(scene: &SystemScene) -> Vec<String> {
    scene.shafts.iter().map(|shaft| shaft.name.clone()).collect()
}

fn of_solver(_: &SystemScene) -> Vec<String> {
    vec!["solver".into()]
}

fn of_discs(scene: &SystemScene) -> Vec<String> {
    let of = |shaft: &ShaftSection| {
        let name = shaft.name.clone();
        (1..=shaft.disc.len()).map(move |disc| format!("{name}.disc[{disc}]"))
    };
    scene.shafts.iter().flat_map(of).collect()
}

fn of_bearings(scene: &SystemScene) -> Vec<String> {
    scene.bearings.iter().map(|bearing| bearing.name.clone()).collect()
}

fn of_housings(scene: &SystemScene) -> Vec<String> {
    scene.housings.iter().map(|housing| housing.name.clone()).collect()
}

fn disc(scene: &mut SystemScene, index: usize) -> Option<&mut Disc> {
    scene.shafts.iter_mut().flat_map(|shaft| &mut shaft.disc).nth(index)
}

fn mounting(scene: &mut SystemScene, index: usize) -> Option<&mut Mounting> {
    scene.bearings.get_mut(index).map(|bearing| &mut bearing.mounting)
}

/// One of all bearings, as they are integrated together.
const fn solver(
    key: &'static str,
    description: &'static str,
    (range, variability): (Range, Variability),
    place: fn(&mut SystemScene, usize) -> Option<&mut f64>,
) -> ShaftNumber {
    ShaftNumber { key, description, range, variability, names: of_solver, place, shared: true }
}

/// All of them.
#[rustfmt::skip]
static NUMBERS: [ShaftNumber; 25] = [
    number("mass", "mass of the shaft", MASS, of_shafts, |s, k| s.shafts.get_mut(k)?.mass.as_mut().map(|mass| &mut mass.0)),
    number("polar_inertia", "moment of inertia of the shaft about its axis", INERTIA, of_shafts,
        |s, k| s.shafts.get_mut(k)?.polar_inertia.as_mut().map(|inertia| &mut inertia.0)),
    number("transverse_inertia", "moment of inertia of the shaft across its axis, about its centre of mass", INERTIA, of_shafts,
        |s, k| s.shafts.get_mut(k)?.transverse_inertia.as_mut().map(|inertia| &mut inertia.0)),
    number("centre", "position of the centre of mass along the shaft", POSITION, of_shafts,
        |s, k| s.shafts.get_mut(k)?.centre.as_mut().map(|position| &mut position.0)),
    number("start_speed", "speed of the shaft at the start", SPEED, of_shafts,
        |s, k| s.shafts.get_mut(k)?.start_speed.as_mut().map(|speed| &mut speed.0)),
    number("retardation_time", "retardation time of the beams of the shaft", RETARDATION, of_shafts,
        |s, k| s.shafts.get_mut(k)?.retardation_time.as_mut().map(|time| &mut time.0)),
    number("mass", "mass of the disc", MASS, of_discs, |s, k| disc(s, k).map(|disc| &mut disc.mass.0)),
    number("polar_inertia", "moment of inertia of the disc about the axis", INERTIA, of_discs,
        |s, k| disc(s, k).map(|disc| &mut disc.polar_inertia.0)),
    number("transverse_inertia", "moment of inertia of the disc about a diameter", INERTIA, of_discs,
        |s, k| disc(s, k).map(|disc| &mut disc.transverse_inertia.0)),
    number("unbalance", "unbalance of the disc", UNBALANCE, of_discs,
        |s, k| disc(s, k)?.unbalance.as_mut().map(|product| &mut product.0)),
    number("unbalance_azimuth", "azimuth of the unbalance of the disc at the start, from +y towards +z", ANGLE, of_discs,
        |s, k| disc(s, k)?.unbalance_azimuth.as_mut().map(|angle| &mut angle.0)),
    number("mounting.position", "position of the bearing along the shaft", POSITION, of_bearings,
        |s, k| s.bearings.get_mut(k).map(|bearing| &mut bearing.mounting.position.0)),
    number("mounting.preload.force", "axial force that the preload of the bearing makes at rest", FORCE, of_bearings,
        |s, k| s.bearings.get_mut(k)?.mounting.preload.force.as_mut().map(|force| &mut force.0)),
    number("mounting.preload.displacement", "way of the inner race by the preload of the bearing", WAY, of_bearings,
        |s, k| s.bearings.get_mut(k)?.mounting.preload.displacement.as_mut().map(|way| &mut way.0)),
    number("mounting.misalignment.ry", "tilt about y of the bore of the bearing, axes of the shaft", BORE_TILT, of_bearings,
        |s, k| mounting(s, k)?.misalignment.ry.as_mut().map(|angle| &mut angle.0)),
    number("mounting.misalignment.rz", "tilt about z of the bore of the bearing, axes of the shaft", BORE_TILT, of_bearings,
        |s, k| mounting(s, k)?.misalignment.rz.as_mut().map(|angle| &mut angle.0)),
    number("mounting.offset.y", "y coordinate of the bore of the bearing, axes of the shaft", BORE_OFFSET, of_bearings,
        |s, k| mounting(s, k)?.offset.y.as_mut().map(|length| &mut length.0)),
    number("mounting.offset.z", "z coordinate of the bore of the bearing, axes of the shaft", BORE_OFFSET, of_bearings,
        |s, k| mounting(s, k)?.offset.z.as_mut().map(|length| &mut length.0)),
    number("outer.mass", "mass of the outer ring that slides in its bore", MASS, of_bearings, |s, k| {
        let bearing = s.bearings.get_mut(k).filter(|bearing| bearing.mounting.axial == AxialSeat::Free)?;
        bearing.scene.outer.mass.as_mut().map(|mass| &mut mass.0)
    }),
    ShaftNumber {
        variability: Variability::Tunable,
        ..number("dynamic", "level of the bearing: 1 with states (\"dynamic\"), 0 without (\"equilibrium\")", LEVEL, of_bearings,
            |s, k| s.bearings.get_mut(k)?.dynamic.as_mut())
    },
    number("mass", "mass of the housing", MASS, of_housings, |s, k| s.housings.get_mut(k)?.mass.as_mut().map(|mass| &mut mass.0)),
    solver("tolerance", "local error of an internal step over the ball diameter", (TOLERANCE, Variability::Tunable),
        |s, k| s.solver_of(k).map(|solver| &mut solver.tolerance)),
    solver("initial_step", "first internal step", (STEP, Variability::Fixed),
        |s, k| s.solver_of(k).map(|solver| &mut solver.initial_step.0)),
    solver("max_step", "largest internal step", (STEP, Variability::Fixed),
        |s, k| s.solver_of(k).map(|solver| &mut solver.max_step.0)),
    solver("min_step", "smallest internal step; a step that needs a smaller one is not finished", (STEP, Variability::Fixed),
        |s, k| s.solver_of(k).map(|solver| &mut solver.min_step.0)),
];

/// A number of a part.
#[derive(Clone, Copy, Debug)]
pub struct ShaftParameter {
    /// Row of its kind: name, unit, range.
    pub number: &'static ShaftNumber,
    part: usize,
    /// Its value in the scene.
    pub start: f64,
}

impl ShaftParameter {
    /// Gives it another value in a scene.
    pub fn set(&self, scene: &mut SystemScene, value: f64) {
        let parts = if self.number.shared { 0..scene.bearings.len() } else { self.part..self.part + 1 };
        for part in parts {
            if let Some(place) = (self.number.place)(scene, part) {
                *place = value;
            }
        }
    }
}

impl SystemScene {
    /// The numbers that a package offers beside those of its bearings, by their names.
    pub fn parameters(&self) -> Vec<(String, ShaftParameter)> {
        let mut copy = self.clone();
        let mut all = vec![];
        for number in &NUMBERS {
            for (part, name) in (number.names)(self).into_iter().enumerate() {
                if let Some(start) = (number.place)(&mut copy, part).copied() {
                    let parameter = ShaftParameter { number, part, start };
                    all.push((format!("{name}.{}", number.key), parameter));
                }
            }
        }
        all
    }
}
