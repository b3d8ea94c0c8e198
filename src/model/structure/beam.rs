//! Beams of circular cross-section (Timoshenko), and their reduction to stations (Craig and Bampton 1968).
//!
//! Nodes have five coordinates: displacement along x, y, z and tilt about y and z; twist is apart ([`super::torsion`]). Consistent
//! mass with rotary inertia, and gyroscopic matrix, after Friswell, Penny, Garvey and Lees, Dynamics of Rotating Machines (2010).

use nalgebra::{DMatrix, Dyn, Matrix4, OMatrix, SMatrix, U3, Vector3};

use super::reduction::{modes, symmetric};
use super::torsion::{ReducedTorsion, Torsion};
use super::{Lump, Map};
use crate::schema::{BeamSection, Material};

/// Coordinates of a node.
const NODE: usize = 5;
/// [-] longest element over its diameter.
const LONGEST: f64 = 0.5;
/// \[m] positions closer than this are one node.
const SAME: f64 = 1e-9;

/// A shaft of beams with discs, by the coordinates of its nodes.
pub struct Beams {
    mass: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    gyroscopic: DMatrix<f64>,
    /// [kg m2].
    polar_inertia: f64,
    /// \[m] position of each node.
    nodes: Vec<f64>,
    /// Mass at each node \[kg], and its polar and transverse moment of inertia [kg m2]: together the mass, its centre and the moments of
    /// inertia of beams and discs.
    at_nodes: Vec<[f64; 3]>,
    /// Node of each station.
    stations: Vec<usize>,
    /// How it twists, and the node that its turn is taken at, where it does.
    torsion: Option<(Torsion, usize)>,
}

/// Beams by the coordinates of their stations and the amplitudes of modes between them.
pub struct Reduced {
    /// Mass matrix.
    pub mass: DMatrix<f64>,
    /// Stiffness matrix.
    pub stiffness: DMatrix<f64>,
    /// Gyroscopic matrix of a spin of 1 rad/s.
    pub gyroscopic: DMatrix<f64>,
    /// Generalised forces of unit accelerations along x, y, z.
    pub weights: OMatrix<f64, Dyn, U3>,
    /// [kg m2] moment of inertia about the axis.
    pub polar_inertia: f64,
    /// Displacement and rotation at each station.
    pub stations: Vec<Map>,
    /// Masses of the nodes, places along the x axis.
    pub lumps: Vec<Lump>,
    /// [rad/s] angular frequencies of the modes that are kept.
    pub frequencies: Vec<f64>,
}

impl Beams {
    /// Beams that follow each other, nodes at stations \[m] among them, and discs (position \[m]; mass \[kg], polar and transverse
    /// moment of inertia [kg m2]). They twist where a place \[m] is given at which the turn is taken.
    ///
    /// # Errors
    /// A sentence, where a station or disc lies beyond the ends.
    pub fn new(
        sections: &[BeamSection],
        material: Material,
        stations: &[f64],
        discs: &[(f64, [f64; 3])],
        turned_at: Option<f64>,
    ) -> Result<Self, String> {
        let ends = sections.iter().flat_map(|section| [section.from.0, section.to.0]);
        let (low, high) =
            ends.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let wanted = stations.iter().chain(discs.iter().map(|(position, _)| position)).chain(&turned_at);
        for position in wanted.clone() {
            if *position < low - SAME || *position > high + SAME {
                return Err(format!(
                    "{position} m lies beyond the shaft, which goes from {low} m to {high} m"
                ));
            }
        }
        let mut nodes: Vec<f64> = ends.chain(wanted.copied()).collect();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup_by(|a, b| (*a - *b).abs() < SAME);
        let mut all = vec![nodes[0]];
        for pair in nodes.windows(2) {
            let section = section_at(sections, 0.5 * (pair[0] + pair[1]));
            let count = ((pair[1] - pair[0]) / (LONGEST * section.outer_diameter.0)).ceil().max(1.0);
            all.extend((1..=count as usize).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / count));
        }
        let size = NODE * all.len();
        let zero = || DMatrix::zeros(size, size);
        let mut beams = Self {
            mass: zero(),
            stiffness: zero(),
            gyroscopic: zero(),
            polar_inertia: 0.0,
            at_nodes: vec![[0.0; 3]; all.len()],
            stations: stations.iter().map(|position| node_at(&all, *position)).collect(),
            torsion: turned_at.map(|place| (Torsion::new(all.len()), node_at(&all, place))),
            nodes: all.clone(),
        };
        for (index, pair) in all.windows(2).enumerate() {
            let section = section_at(sections, 0.5 * (pair[0] + pair[1]));
            beams.add_element(NODE * index, pair[1] - pair[0], section, material);
        }
        for (position, [mass, polar, transverse]) in discs {
            beams.add_disc(NODE * node_at(&all, *position), *mass, *polar, *transverse);
        }
        Ok(beams)
    }

    fn add_disc(&mut self, at: usize, mass: f64, polar: f64, transverse: f64) {
        for i in 0..3 {
            self.mass[(at + i, at + i)] += mass;
        }
        for i in 3..5 {
            self.mass[(at + i, at + i)] += transverse;
        }
        self.gyroscopic[(at + 3, at + 4)] += polar;
        self.gyroscopic[(at + 4, at + 3)] -= polar;
        self.polar_inertia += polar;
        self.add_at_node(at / NODE, [mass, polar, transverse]);
        if let Some((torsion, _)) = &mut self.torsion {
            torsion.add_disc(at / NODE, polar);
        }
    }

    fn add_at_node(&mut self, node: usize, own: [f64; 3]) {
        self.at_nodes[node].iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    }

    fn add_element(&mut self, at: usize, length: f64, section: &BeamSection, material: Material) {
        let [outer, inner] = [section.outer_diameter.0, section.inner_diameter.map_or(0.0, |d| d.0)];
        let area = 0.25 * std::f64::consts::PI * (outer * outer - inner * inner);
        let second_moment = std::f64::consts::PI / 64.0 * (outer.powi(4) - inner.powi(4));
        let (young, poisson, density) =
            (material.youngs_modulus.0, material.poisson_ratio, material.density.0);
        // Cowper (1966), hollow circle.
        let ratio = (inner / outer).powi(2);
        let square = (1.0 + ratio).powi(2);
        let shear_factor = 6.0 * (1.0 + poisson) * square
            / ((7.0 + 6.0 * poisson) * square + (20.0 + 12.0 * poisson) * ratio);
        let shear_modulus = young / (2.0 * (1.0 + poisson));
        let phi = 12.0 * young * second_moment / (shear_factor * shear_modulus * area * length * length);
        let stiffness =
            bending_stiffness(length, phi) * (young * second_moment / (length.powi(3) * (1.0 + phi)));
        let whole = (1.0 + phi).powi(2);
        let translational = translational_mass(length, phi) * (density * area * length / (840.0 * whole));
        let rotary = rotary_mass(length, phi) * (density * second_moment / (30.0 * whole * length));
        // The planes xy and xz: displacement and slope at both ends, by the coordinates of both nodes.
        let mut in_xy = SMatrix::<f64, 4, 10>::zeros();
        let mut in_xz = in_xy;
        for node in 0..2 {
            in_xy[(2 * node, NODE * node + 1)] = 1.0;
            in_xy[(2 * node + 1, NODE * node + 4)] = 1.0;
            in_xz[(2 * node, NODE * node + 2)] = 1.0;
            in_xz[(2 * node + 1, NODE * node + 3)] = -1.0;
        }
        let both =
            |matrix: Matrix4<f64>| in_xy.transpose() * matrix * in_xy + in_xz.transpose() * matrix * in_xz;
        let across = in_xz.transpose() * (rotary * -2.0) * in_xy;
        let (mut mass, mut stiff) = (both(translational + rotary), both(stiffness));
        let (line, rod) = (density * area * length / 6.0, young * area / length);
        for (i, k) in [(0, 0), (0, NODE), (NODE, 0), (NODE, NODE)] {
            mass[(i, k)] += if i == k { 2.0 * line } else { line };
            stiff[(i, k)] += if i == k { rod } else { -rod };
        }
        let size = (2 * NODE, 2 * NODE);
        let mut view = self.mass.view_mut((at, at), size);
        view += mass;
        let mut view = self.stiffness.view_mut((at, at), size);
        view += stiff;
        let mut view = self.gyroscopic.view_mut((at, at), size);
        view += across - across.transpose();
        self.polar_inertia += 2.0 * density * second_moment * length;
        // Half of its mass at either end has a sixth of mass times length squared too much across the axis.
        let half = 0.5 * density * length;
        let across = half * (second_moment - area * length * length / 6.0);
        for node in [at / NODE, at / NODE + 1] {
            self.add_at_node(node, [half * area, half * 2.0 * second_moment, across]);
        }
        if let Some((torsion, _)) = &mut self.torsion {
            // The polar moment of a circle is twice that about a diameter.
            let polar = 2.0 * second_moment;
            torsion.add_rod(at / NODE, density * polar * length, shear_modulus * polar / length);
        }
    }

    /// How it twists, by its stations and modes between them up to an angular frequency [rad/s], where it does.
    pub fn twisting(&self, highest: f64) -> Option<ReducedTorsion> {
        self.torsion.as_ref().map(|(torsion, at)| torsion.reduced(&self.stations, *at, highest))
    }

    /// Reduces the shaft to its stations, with the modes between them while they are held, up to an angular frequency [rad/s].
    pub fn reduced(&self, highest: f64) -> Reduced {
        let mut of_stations: Vec<usize> = self.stations.clone();
        of_stations.sort_unstable();
        of_stations.dedup();
        let outer: Vec<usize> =
            of_stations.iter().flat_map(|node| (0..NODE).map(move |i| NODE * node + i)).collect();
        let size = self.mass.nrows();
        let inner: Vec<usize> = (0..size).filter(|i| !outer.contains(i)).collect();
        let part = |matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, k| matrix[(rows[i], columns[k])])
        };
        let (stiff, mass) = (part(&self.stiffness, &inner, &inner), part(&self.mass, &inner, &inner));
        // Static shapes; the inner part is held by its stations, so this is regular.
        let static_shapes = -stiff
            .clone()
            .lu()
            .solve(&part(&self.stiffness, &inner, &outer))
            .unwrap_or_else(|| DMatrix::zeros(inner.len(), outer.len()));
        let (modes, frequencies) = modes(&stiff, &mass, highest);
        let n = outer.len() + frequencies.len();
        let mut shapes = DMatrix::zeros(size, n);
        for (k, row) in outer.iter().enumerate() {
            shapes[(*row, k)] = 1.0;
        }
        for (k, row) in inner.iter().enumerate() {
            for column in 0..outer.len() {
                shapes[(*row, column)] = static_shapes[(k, column)];
            }
            for (column, _) in frequencies.iter().enumerate() {
                shapes[(*row, outer.len() + column)] = modes[(k, column)];
            }
        }
        let reduce = |matrix: &DMatrix<f64>| shapes.tr_mul(&(matrix * &shapes));
        let mut unit = DMatrix::zeros(size, 3);
        for row in 0..size {
            if row % NODE < 3 {
                unit[(row, row % NODE)] = 1.0;
            }
        }
        let weights = shapes.tr_mul(&(&self.mass * unit));
        let station = |node: &usize| {
            let at = of_stations.iter().position(|other| other == node).unwrap_or(0) * NODE;
            let mut map = Map::zeros(n);
            for i in 0..3 {
                map[(i, at + i)] = 1.0;
            }
            (map[(4, at + 3)], map[(5, at + 4)]) = (1.0, 1.0);
            map
        };
        Reduced {
            mass: symmetric(&reduce(&self.mass)),
            stiffness: symmetric(&reduce(&self.stiffness)),
            gyroscopic: reduce(&self.gyroscopic),
            weights: OMatrix::from_fn_generic(Dyn(n), U3, |i, k| weights[(i, k)]),
            polar_inertia: self.polar_inertia,
            lumps: self.lumps(&shapes),
            stations: self.stations.iter().map(station).collect(),
            frequencies,
        }
    }
}

impl Beams {
    /// Masses of the nodes, which move by the coordinates as these shapes say.
    fn lumps(&self, shapes: &DMatrix<f64>) -> Vec<Lump> {
        let lump = |(node, (x, [mass, polar, transverse])): (usize, (&f64, &[f64; 3]))| {
            let rows = [0, 1, 2, 4, 5];
            let mut map = Map::zeros(shapes.ncols());
            for (i, row) in rows.into_iter().enumerate() {
                map.row_mut(row).copy_from(&shapes.row(NODE * node + i));
            }
            let inertia = Vector3::new(*polar, *transverse, *transverse);
            Lump { place: Vector3::new(*x, 0.0, 0.0), mass: *mass, inertia, map }
        };
        self.nodes.iter().zip(&self.at_nodes).enumerate().map(lump).collect()
    }
}

/// The beam at a position.
fn section_at(sections: &[BeamSection], position: f64) -> &BeamSection {
    let at = sections.iter().position(|section| section.from.0 <= position && position <= section.to.0);
    &sections[at.unwrap_or(0)]
}

/// The node at a position.
fn node_at(nodes: &[f64], position: f64) -> usize {
    let distance = |node: &usize| (nodes[*node] - position).abs();
    (0..nodes.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

fn bending_stiffness(l: f64, phi: f64) -> Matrix4<f64> {
    let (a, b) = ((4.0 + phi) * l * l, (2.0 - phi) * l * l);
    Matrix4::new(
        12.0,
        6.0 * l,
        -12.0,
        6.0 * l,
        6.0 * l,
        a,
        -6.0 * l,
        b,
        -12.0,
        -6.0 * l,
        12.0,
        -6.0 * l,
        6.0 * l,
        b,
        -6.0 * l,
        a,
    )
}

fn translational_mass(l: f64, phi: f64) -> Matrix4<f64> {
    let square = phi * phi;
    let m1 = 312.0 + 588.0 * phi + 280.0 * square;
    let m2 = (44.0 + 77.0 * phi + 35.0 * square) * l;
    let m3 = 108.0 + 252.0 * phi + 140.0 * square;
    let m4 = -(26.0 + 63.0 * phi + 35.0 * square) * l;
    let m5 = (8.0 + 14.0 * phi + 7.0 * square) * l * l;
    let m6 = -(6.0 + 14.0 * phi + 7.0 * square) * l * l;
    Matrix4::new(m1, m2, m3, m4, m2, m5, -m4, m6, m3, -m4, m1, -m2, m4, m6, -m2, m5)
}

fn rotary_mass(l: f64, phi: f64) -> Matrix4<f64> {
    let m8 = (3.0 - 15.0 * phi) * l;
    let m9 = (4.0 + 5.0 * phi + 10.0 * phi * phi) * l * l;
    let m10 = (-1.0 - 5.0 * phi + 5.0 * phi * phi) * l * l;
    Matrix4::new(36.0, m8, -36.0, m8, m8, m9, -m8, m10, -36.0, -m8, 36.0, -m8, m8, m10, -m8, m9)
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;
    use crate::schema::units::Length;

    /// A steel shaft of 30 mm and 600 mm with stations at both ends.
    fn shaft(stations: &[f64], inner: f64) -> Beams {
        let section = BeamSection {
            from: Length(0.0),
            to: Length(0.6),
            outer_diameter: Length(0.03),
            inner_diameter: Some(Length(inner)),
        };
        Beams::new(&[section], Material::default(), stations, &[], Some(0.0)).unwrap()
    }

    #[test]
    fn closed_form_a_cantilever_bends_as_timoshenko_says() {
        let beams = shaft(&[0.0, 0.6], 0.01);
        let reduced = beams.reduced(1.0);
        // Held at the left station, loaded at the right one.
        let free = reduced.stiffness.view((NODE, NODE), (NODE, NODE)).into_owned();
        let moved = free.lu().solve(&DVector::from_row_slice(&[1e4, 1e3, -500.0, 0.0, 0.0])).unwrap();
        let (area, second) = (
            0.25 * std::f64::consts::PI * (0.03f64.powi(2) - 0.01f64.powi(2)),
            std::f64::consts::PI / 64.0 * (0.03f64.powi(4) - 0.01f64.powi(4)),
        );
        let (young, shear) = (206e9, 206e9 / 2.6);
        let m = 1.0f64 / 9.0;
        let factor = 6.0 * 1.3 * (1.0 + m).powi(2) / (8.8 * (1.0 + m).powi(2) + 23.6 * m);
        let bend = 0.6f64.powi(3) / (3.0 * young * second) + 0.6 / (factor * shear * area);
        let slope = 0.6f64.powi(2) / (2.0 * young * second);
        let exact = [1e4 * 0.6 / (young * area), 1e3 * bend, -500.0 * bend, 500.0 * slope, 1e3 * slope];
        for (found, exact) in moved.iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 1e-8, "{found} {exact}");
        }
    }

    #[test]
    fn closed_form_a_rod_twists_as_saint_venant_says_and_swings_as_its_wave_runs() {
        let beams = shaft(&[0.0, 0.6], 0.01);
        let all = beams.twisting(1e6).unwrap();
        // Held at the left end, where the turn is taken.
        let twist = &all.stations[1];
        let moved = all.stiffness.clone().lu().solve(twist).unwrap();
        let polar = std::f64::consts::PI / 32.0 * (0.03f64.powi(4) - 0.01f64.powi(4));
        let shear = 206e9 / 2.6;
        assert!((twist.dot(&moved) / (0.6 / (shear * polar)) - 1.0).abs() < 1e-9);
        assert!(all.stations[0].amax() == 0.0);
        let whole = 7800.0 * polar * 0.6;
        // A rigid acceleration of the turn meets half of it at the free end and none at the other, but for modes between.
        assert!((beams.polar_inertia / whole - 1.0).abs() < 1e-9);
        // A quarter of a wave: consistent inertia is above by (pi h / (2 L))^2 / 24 of its elements.
        let (_, found) = modes(&all.stiffness, &all.mass, 1e6);
        let first = std::f64::consts::PI / 1.2 * (shear / 7800.0f64).sqrt();
        let elements = (0.6 / (LONGEST * 0.03)).ceil();
        let above = (std::f64::consts::PI / 2.0 / elements).powi(2) / 24.0;
        assert!((found[0] / first - 1.0 - above).abs() < 0.1 * above + 1e-9, "{} {first} {above}", found[0]);
    }

    #[test]
    fn closed_form_a_free_slender_shaft_swings_as_euler_says_and_a_disc_adds_up() {
        // The free modes of the whole: rigid ones, then bending at (4.73004/L)^2 sqrt(EI/(rho A)), less for shear and rotation.
        let beams = shaft(&[0.3], 0.0);
        let (_, all) = modes(&beams.stiffness, &beams.mass, 1e5);
        let first = all.iter().find(|frequency| **frequency > 100.0).copied().unwrap();
        let euler = (4.730_040_7f64 / 0.6).powi(2) * (206e9 * 0.03f64.powi(2) / 16.0 / 7800.0).sqrt();
        assert!((0.985..1.0).contains(&(first / euler)), "{first} {euler}");
        // Reduced to its middle, with all modes: the same.
        let reduced = beams.reduced(1e7);
        let (_, again) = modes(&reduced.stiffness, &reduced.mass, 1e5);
        let again = again.iter().find(|frequency| **frequency > 100.0).copied().unwrap();
        assert!((again / first - 1.0).abs() < 1e-6, "{again} {first}");
        let whole = reduced
            .weights
            .column(1)
            .dot(&reduced.mass.clone().lu().solve(&reduced.weights.column(1).into_owned()).unwrap());
        let mass = 7800.0 * 0.25 * std::f64::consts::PI * 0.03f64.powi(2) * 0.6;
        assert!((whole / mass - 1.0).abs() < 1e-9, "{whole} {mass}");
    }
}
