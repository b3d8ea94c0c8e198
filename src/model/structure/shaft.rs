//! The shaft of a system as a structure: rigid, or of beams that are reduced to its stations.

use nalgebra::{DMatrix, DVector, OMatrix, Vector3};

use super::beam::Beams;
use super::torsion::ReducedTorsion;
use super::{Carrier, Lump, Map, Structure, Turning};
use crate::schema::ShaftSection;

/// \[Hz] modes between stations that are kept, where the file does not say so.
const MODES_UP_TO: f64 = 20e3;

/// Mass, centre and moments of inertia of rigid parts on one axis.
#[derive(Clone, Copy, Debug, Default)]
struct RigidSum {
    mass: f64,
    centre: f64,
    polar: f64,
    transverse: f64,
}

impl RigidSum {
    /// With another part.
    fn plus(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let centre = (self.mass * self.centre + other.mass * other.centre) / mass;
        let moved = |part: &Self| part.transverse + part.mass * (part.centre - centre).powi(2);
        Self { mass, centre, polar: self.polar + other.polar, transverse: moved(&self) + moved(&other) }
    }
}

impl Carrier {
    /// The shaft of a file, with stations at these positions \[m] along it; its beams twist where that is asked for.
    ///
    /// # Errors
    /// A sentence, where a station lies beyond the ends of a flexible shaft, or is none of its matrices.
    pub fn of_shaft(section: &ShaftSection, stations: &[f64], twists: bool) -> Result<Self, String> {
        let turning = if section.speed.is_some() { Turning::Given } else { Turning::Free };
        if let Some(read) = &section.read {
            let map = |x: &f64| read.station([*x, 0.0, 0.0]);
            let maps = stations.iter().map(map).collect::<Result<_, _>>()?;
            let parts = Parts {
                mass: read.mass.clone(),
                damping: read.damping.clone(),
                stiffness: read.stiffness.clone(),
                gyroscopic: read.gyroscopic.clone(),
                weights: read.weights.clone(),
                polar_inertia: read.polar_inertia,
                lumps: vec![],
                by_turn: None,
            };
            return Ok(parts.turning(turning, maps, vec![]));
        }
        if section.section.is_empty() {
            return Ok(rigid(section, stations, turning));
        }
        let discs: Vec<_> = section
            .disc
            .iter()
            .map(|disc| (disc.position.0, [disc.mass.0, disc.polar_inertia.0, disc.transverse_inertia.0]))
            .collect();
        let left = section.section.iter().map(|beam| beam.from.0).fold(f64::INFINITY, f64::min);
        let turned_at = twists.then(|| section.drive_position.map_or(left, |position| position.0));
        let beams = Beams::new(&section.section, section.material, stations, &discs, turned_at)?;
        let highest = section.modes_up_to.map_or(MODES_UP_TO, |frequency| frequency.0);
        let retardation = section.retardation_time.map_or(0.0, |time| time.0);
        let reduced = beams.reduced(std::f64::consts::TAU * highest);
        let maps = reduced.stations;
        let modes = reduced.frequencies.iter().map(|frequency| frequency / std::f64::consts::TAU).collect();
        let parts = Parts {
            mass: reduced.mass,
            damping: &reduced.stiffness * retardation,
            stiffness: reduced.stiffness,
            gyroscopic: reduced.gyroscopic,
            weights: reduced.weights,
            polar_inertia: reduced.polar_inertia,
            lumps: reduced
                .lumps
                .into_iter()
                .map(|lump| Lump { place: lump.place + origin(section), ..lump })
                .collect(),
            by_turn: None,
        };
        Ok(match beams.twisting(std::f64::consts::TAU * highest) {
            Some(torsion) => parts.twisting(maps, &torsion, retardation, turning, modes),
            None => parts.turning(turning, maps, modes),
        })
    }
}

/// \[m] where positions along a shaft count from, in the axes of the machine.
fn origin(section: &ShaftSection) -> Vector3<f64> {
    Vector3::from(section.place(0.0))
}

fn rigid(section: &ShaftSection, stations: &[f64], turning: Turning) -> Carrier {
    let body = RigidSum {
        mass: section.mass.map_or(0.0, |mass| mass.0),
        centre: section.centre.map_or(0.0, |centre| centre.0),
        polar: section.polar_inertia.map_or(0.0, |inertia| inertia.0),
        transverse: section.transverse_inertia.map_or(0.0, |inertia| inertia.0),
    };
    let whole = section.disc.iter().fold(body, |sum, disc| {
        sum.plus(RigidSum {
            mass: disc.mass.0,
            centre: disc.position.0,
            polar: disc.polar_inertia.0,
            transverse: disc.transverse_inertia.0,
        })
    });
    let RigidSum { mass, centre, polar, transverse } = whole;
    let diagonal = [mass, mass, mass, transverse, transverse];
    let mut gyroscopic = DMatrix::zeros(5, 5);
    (gyroscopic[(3, 4)], gyroscopic[(4, 3)]) = (polar, -polar);
    let map = |position: &f64| {
        let arm = position - centre;
        let mut map = Map::zeros(5);
        for i in 0..3 {
            map[(i, i)] = 1.0;
        }
        (map[(1, 4)], map[(2, 3)]) = (arm, -arm);
        (map[(4, 3)], map[(5, 4)]) = (1.0, 1.0);
        map
    };
    let weights =
        OMatrix::from_fn_generic(
            nalgebra::Dyn(5),
            nalgebra::Const::<3>,
            |i, k| {
                if i == k { mass } else { 0.0 }
            },
        );
    let parts = Parts {
        mass: DMatrix::from_diagonal(&DVector::from_row_slice(&diagonal)),
        damping: DMatrix::zeros(5, 5),
        stiffness: DMatrix::zeros(5, 5),
        gyroscopic,
        weights,
        polar_inertia: polar,
        lumps: vec![Lump {
            place: Vector3::from(section.place(centre)),
            mass,
            inertia: Vector3::new(polar, transverse, transverse),
            map: map(&centre),
        }],
        by_turn: None,
    };
    parts.turning(turning, stations.iter().map(map).collect(), vec![])
}

/// A shaft without its turn.
struct Parts {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    gyroscopic: DMatrix<f64>,
    weights: OMatrix<f64, nalgebra::Dyn, nalgebra::U3>,
    polar_inertia: f64,
    lumps: Vec<Lump>,
    /// Inertia of the coordinates by an acceleration of the turn; none of a shaft that does not twist.
    by_turn: Option<DVector<f64>>,
}

impl Parts {
    /// The shaft with twist: coordinates of that behind those of bending.
    fn twisting(
        self,
        maps: Vec<Map>,
        torsion: &ReducedTorsion,
        retardation: f64,
        turning: Turning,
        modes: Vec<f64>,
    ) -> Carrier {
        let (n, own) = (self.mass.nrows(), torsion.mass.nrows());
        let both = |bending: DMatrix<f64>, twist: &DMatrix<f64>| {
            let mut whole = bending.resize(n + own, n + own, 0.0);
            whole.view_mut((n, n), (own, own)).copy_from(twist);
            whole
        };
        let with_twist = |(map, twist): (Map, &DVector<f64>)| {
            let mut map = map.resize_horizontally(n + own, 0.0);
            map.fixed_rows_mut::<1>(3).columns_mut(n, own).copy_from(&twist.transpose());
            map
        };
        let maps = maps.into_iter().zip(&torsion.stations).map(with_twist).collect();
        let lumps = self.lumps.into_iter().zip(&torsion.nodes);
        let lumps = lumps.map(|(lump, twist)| Lump { map: with_twist((lump.map, twist)), ..lump }).collect();
        let parts = Self {
            mass: both(self.mass, &torsion.mass),
            damping: both(self.damping, &(&torsion.stiffness * retardation)),
            stiffness: both(self.stiffness, &torsion.stiffness),
            gyroscopic: self.gyroscopic.resize(n + own, n + own, 0.0),
            weights: self.weights.resize_vertically(n + own, 0.0),
            polar_inertia: self.polar_inertia,
            lumps,
            by_turn: Some(DVector::from_fn(n + own, |i, _| if i < n { 0.0 } else { torsion.by_turn[i - n] })),
        };
        parts.turning(turning, maps, modes)
    }

    /// The shaft as it turns: under a torque its angle is one more coordinate.
    fn turning(self, turning: Turning, maps: Vec<Map>, modes: Vec<f64>) -> Carrier {
        let Self { mass, damping, stiffness, gyroscopic, weights, polar_inertia, lumps, by_turn } = self;
        let n = mass.nrows();
        let size = if turning == Turning::Free { n + 1 } else { n };
        let wider = |matrix: DMatrix<f64>| matrix.resize(size, size, 0.0);
        let mut mass = wider(mass);
        let mut stations: Vec<Map> = maps.into_iter().map(|map| map.resize_horizontally(size, 0.0)).collect();
        let mut lumps: Vec<Lump> = lumps.into_iter().map(|lump| lump.widened(size)).collect();
        let mut by_spin = DVector::zeros(size);
        if let Some(by_turn) = by_turn {
            match turning {
                Turning::Free => {
                    mass.view_mut((0, n), (n, 1)).copy_from(&by_turn);
                    mass.view_mut((n, 0), (1, n)).copy_from(&by_turn.transpose());
                }
                Turning::Given | Turning::Still => by_spin = by_turn,
            }
        }
        if turning == Turning::Free {
            mass[(n, n)] = polar_inertia;
            let of_lumps = lumps.iter_mut().map(|lump| &mut lump.map);
            stations.iter_mut().chain(of_lumps).for_each(|map| map[(3, n)] = 1.0);
        }
        let structure = Structure {
            mass: mass.into(),
            damping: wider(damping).into(),
            stiffness: wider(stiffness).into(),
            gyroscopic: wider(gyroscopic).into(),
            polar_inertia,
            by_spin,
            weights: weights.resize_vertically(size, 0.0),
            lumps,
            turning,
            rings: 0,
            held: vec![],
        };
        Carrier { structure, stations, sliding: vec![], modes }
    }
}
