//! Outputs of shafts on their bearings and of their housings: motion at points, drive, energies.

use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use nalgebra::{DVector, Vector3};

use super::{LevelJump, first_stations, housing_stations};
use crate::model::link::rollers::RollerOutputs;
use crate::model::link::{Law, Link, LinkState};
use crate::model::structure::{Carrier, Map, Spin, StructureEnergies, StructurePowers, StructureState};
use crate::scene::system::SystemScene;

/// Motion of a point of a structure, in the shaft's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointOutput {
    /// \[m] displacement.
    pub displacement: Vector3<f64>,
    /// [m/s] velocity.
    pub velocity: Vector3<f64>,
    /// \[rad] rotation; x is 0 of a shaft: its turn is no tilt.
    pub tilt: Vector3<f64>,
}

/// Outputs of a housing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HousingOutputs {
    /// Motion at the bearings that sit in it, in the order of the scene.
    pub seats: Vec<PointOutput>,
    /// Motion at its named loads.
    pub loads: Vec<PointOutput>,
    /// Motion at its named points.
    pub points: Vec<PointOutput>,
    /// Powers.
    pub powers: StructurePowers,
    /// Energies since the start.
    pub energies: StructureEnergies,
}

/// Outputs of a shaft as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaftOutputs {
    /// Its turn.
    pub spin: Spin,
    /// [N m] torque that drives it.
    pub torque: f64,
    /// Powers.
    pub powers: StructurePowers,
    /// Energies since the start.
    pub energies: StructureEnergies,
}

/// Outputs of a link: a mesh, a bearing by its stiffness or by its rollers, or a coupling.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkOutputs {
    /// Forces and energies; forces are those on the first gear, or on the shaft.
    pub state: LinkState,
    /// Outputs of teeth alone.
    pub teeth: TeethOutputs,
    rollers: Option<Unseen>,
}

/// Rollers of a link, whose outputs are found when they are first asked for: steps do without.
#[derive(Clone, Debug)]
struct Unseen {
    links: Arc<Vec<Link>>,
    index: usize,
    found: OnceLock<RollerOutputs>,
}

impl PartialEq for Unseen {
    /// What there is to find follows from the state of the link.
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

/// Outputs of teeth in mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TeethOutputs {
    /// \[N] normal force: positive on the flank that presses where the first gear drives while it turns about +x, negative on the other.
    pub normal_force: f64,
    /// \[rad] misalignment in the plane of action of the flank that presses.
    pub misalignment: f64,
    /// [N m] moments of the axial force on both gears, each about its axis.
    pub tilting_moments: [Vector3<f64>; 2],
    /// \[W] power that friction takes.
    pub friction_power: f64,
}

impl LinkOutputs {
    /// Outputs of one of the links in a state.
    pub fn of(links: &Arc<Vec<Link>>, index: usize, state: &LinkState) -> Self {
        let teeth = match &links[index].law {
            Law::Mesh(mesh) => {
                let [one, other] = mesh.flank_forces(&state.displacement, &state.rate);
                TeethOutputs {
                    normal_force: one - other,
                    misalignment: mesh.misalignment(&state.displacement),
                    tilting_moments: mesh.tilting_moments(&state.force),
                    friction_power: mesh.friction_power(&state.displacement, &state.rate),
                }
            }
            Law::Spring(_) | Law::Rollers(_) => TeethOutputs::default(),
        };
        let rollers = matches!(links[index].law, Law::Rollers(_)).then(|| Unseen {
            links: links.clone(),
            index,
            found: OnceLock::new(),
        });
        Self { state: state.clone(), teeth, rollers }
    }

    /// Outputs of rollers; none of other links.
    pub fn rollers(&self) -> Option<&RollerOutputs> {
        let Unseen { links, index, found } = self.rollers.as_ref()?;
        let Law::Rollers(bearing) = &links[*index].law else { return None };
        let LinkState { displacement, rate, rollers, outer_speed, .. } = &self.state;
        Some(found.get_or_init(|| bearing.outputs(displacement, rate, rollers, *outer_speed)))
    }

    /// [rad/s] speed of the rings of rollers against each other; none of other links.
    pub fn speed(&self) -> Option<f64> {
        let Unseen { links, index, .. } = self.rollers.as_ref()?;
        let Law::Rollers(bearing) = &links[*index].law else { return None };
        Some(bearing.relative_speed(&self.state.rate, self.state.outer_speed).abs())
    }

    /// \[h] reference life of rollers at the present speed; none of others, or at rest.
    pub fn hours(&self) -> Option<f64> {
        let speed = self.speed().filter(|speed| *speed > 0.0)?;
        Some(self.rollers()?.life * 1e6 * TAU / speed / 3600.0)
    }
}

/// Outputs of the shafts and the housings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SystemOutputs {
    /// \[s] time.
    pub time: f64,
    /// Every shaft, in the order of the scene.
    pub shafts: Vec<ShaftOutputs>,
    /// Motion of the shafts at every bearing, in the order of the scene.
    pub seats: Vec<PointOutput>,
    /// Motion at every named load of the first shaft, then of the next.
    pub loads: Vec<PointOutput>,
    /// Motion at every named point, likewise.
    pub points: Vec<PointOutput>,
    /// \[N, N m] what holds each motion that is given, in the order of [`SystemScene::motions`]: force and moment on the shaft or the housing.
    pub holding: Vec<f64>,
    /// What changes of level did, in the order of the scene's bearings.
    pub jumps: Vec<LevelJump>,
    /// Outputs of meshes, then of bearings by their stiffness, in the order of the scene.
    pub links: Vec<LinkOutputs>,
    /// Outputs of the housings, in the order of the scene.
    pub housings: Vec<HousingOutputs>,
    /// Energies since the start of rings that slide in bores of the ground; none where there are none.
    pub ground: Option<StructureEnergies>,
}

/// Motion of a station.
fn moved(map: &Map, state: &StructureState) -> PointOutput {
    let halves = |v: &DVector<f64>| -> [Vector3<f64>; 2] {
        let moved = map * v;
        [0, 3].map(|from| moved.fixed_rows::<3>(from).into_owned())
    };
    let ([displacement, tilt], [velocity, _]) = (halves(&state.coordinates), halves(&state.rates));
    PointOutput { displacement, velocity, tilt }
}

impl SystemOutputs {
    /// Those of states of the shafts and the housings at a time \[s], with the torque [N m] that drives each shaft.
    pub fn of(
        scene: &SystemScene,
        carriers: &[Carrier],
        states: &[StructureState],
        torques: &[f64],
        time: f64,
    ) -> Self {
        let count = scene.shafts.len();
        let on_shaft = |shaft: usize, station: usize| {
            let PointOutput { displacement, velocity, tilt } =
                moved(&carriers[shaft].stations[station], &states[shaft]);
            PointOutput { displacement, velocity, tilt: Vector3::new(0.0, tilt.y, tilt.z) }
        };
        let each = |range: fn([usize; 5]) -> std::ops::Range<usize>| {
            let of =
                move |shaft| range(first_stations(scene, shaft)).map(move |station| on_shaft(shaft, station));
            (0..count).flat_map(of).collect()
        };
        let seats = scene.bearings.iter().enumerate().map(|(index, bearing)| {
            let station = scene.bearings_on(bearing.shaft).position(|of| of == index);
            on_shaft(bearing.shaft, station.unwrap_or(0))
        });
        let shafts = states.iter().zip(torques).map(|(state, torque)| ShaftOutputs {
            spin: state.spin,
            torque: *torque,
            powers: state.powers,
            energies: state.energies,
        });
        let housings = scene.housings.iter().zip(carriers[count..].iter().zip(&states[count..])).enumerate();
        let housings = housings.map(|(index, (_, (carrier, state)))| {
            let mut all = carrier.stations.iter().map(|map| moved(map, state));
            let [loads, points] = housing_stations(scene, index);
            HousingOutputs {
                seats: all.by_ref().take(loads).collect(),
                loads: all.by_ref().take(points - loads).collect(),
                points: all.take(scene.housings[index].point.len()).collect(),
                powers: state.powers,
                energies: state.energies,
            }
        });
        Self {
            time,
            shafts: shafts.collect(),
            seats: seats.collect(),
            loads: each(|[loads, points, ..]| loads..points),
            points: each(|[_, points, discs, ..]| points..discs),
            holding: states.iter().flat_map(|state| state.holding.iter().copied()).collect(),
            jumps: vec![],
            links: vec![],
            housings: housings.collect(),
            ground: states
                .get(scene.housings.len() + count)
                .filter(|state| !state.coordinates.is_empty())
                .map(|state| state.energies),
        }
    }
}
