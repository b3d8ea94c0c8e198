//! Links of a system from its scene: meshes, then bearings by their stiffness or by rollers, then couplings.

use nalgebra::Vector3;

use crate::model::link::spring_bearing::{AxialSupport, SpringBearing};
use crate::model::link::tooth_mesh::ToothMesh;
use crate::model::link::{Law, Link, LinkEnd};
use crate::model::state::stack;
use crate::model::structure::Carrier;
use crate::scene::system::SystemScene;
use crate::scene::system::spring::spring as stiffness;
use crate::schema::AxialTaken;

/// [-] damping of a mesh over critical damping, where the scene does not say so.
const DAMPING_RATIO: f64 = 0.05;

/// Positions \[m] of a shaft's stations for its meshes, then for its bearings by their stiffness and its couplings.
pub fn positions(scene: &SystemScene, shaft: usize) -> impl Iterator<Item = f64> {
    let meshes = scene.meshes.iter().flat_map(move |mesh| {
        let x = mesh.place(scene).x;
        let own = (0..2).filter(move |gear| mesh.shafts[*gear] == shaft);
        own.map(move |_| x - scene.shafts[shaft].place(0.0)[0])
    });
    let springs = scene.springs.iter().filter_map(move |spring| spring.position_on(shaft, &scene.shafts));
    meshes.chain(springs)
}

/// Names of what is at these stations.
pub fn names(scene: &SystemScene, shaft: usize) -> impl Iterator<Item = String> {
    let meshes = scene.meshes.iter().filter(move |mesh| mesh.shafts.contains(&shaft));
    let springs =
        scene.springs.iter().filter(move |spring| [Some(spring.shaft), spring.second].contains(&Some(shaft)));
    meshes.map(|mesh| mesh.section.name.clone()).chain(springs.map(|spring| spring.name.clone()))
}

/// The links of a scene between these structures, whose last stations are [`positions`].
pub fn of(scene: &SystemScene, carriers: &[Carrier]) -> Vec<Link> {
    let count = |shaft: usize| positions(scene, shaft).count();
    let first = |shaft: usize| carriers[shaft].stations.len() - count(shaft);
    let mut next: Vec<usize> = (0..scene.shafts.len()).map(first).collect();
    let mut end = |shaft: usize, arm: &Vector3<f64>| {
        let carrier = &carriers[shaft];
        next[shaft] += 1;
        LinkEnd::new(shaft, &carrier.structure, &carrier.stations[next[shaft] - 1], arm)
    };
    let mut links = vec![];
    for mesh in &scene.meshes {
        let pair = mesh.pair(scene);
        let towards = mesh.towards(scene);
        let [one, other] = pair.pitch_radii();
        let arms = [towards * one, towards * -other];
        let ends = vec![end(mesh.shafts[0], &arms[0]), end(mesh.shafts[1], &arms[1])];
        let stiffness = mesh.section.stiffness.map_or_else(|| pair.mean_stiffness(), |given| given.0);
        let inertia = mesh.shafts.map(|shaft| carriers[shaft].structure.polar_inertia);
        let along = pair.base_helix_angle().cos();
        let mobility: f64 =
            pair.base_radii().iter().zip(inertia).map(|(radius, own)| (radius * along).powi(2) / own).sum();
        let ratio = mesh.section.damping_ratio.unwrap_or(DAMPING_RATIO);
        let law = ToothMesh {
            normals: pair.normals(&towards),
            arms,
            stiffness,
            damping: 2.0 * ratio * (stiffness / mobility).sqrt(),
            backlash: mesh.section.backlash.map_or_else(|| pair.backlash().max(0.0), |given| given.0),
            turn: pair.turn(),
            varying: mesh.varying(),
            friction: mesh.friction(scene),
        };
        links.push(Link { ends, law: Law::Mesh(law) });
    }
    for (index, spring) in scene.springs.iter().enumerate() {
        let mut ends = vec![end(spring.shaft, &Vector3::zeros())];
        if let Some(housing) = spring.housing {
            let carrier = &carriers[scene.shafts.len() + housing];
            let own = scene.springs.iter().enumerate().filter(|(_, other)| other.housing == Some(housing));
            let after = own.filter(|(other, _)| *other >= index).count();
            let station = &carrier.stations[carrier.stations.len() - after];
            ends.push(LinkEnd::new(
                scene.shafts.len() + housing,
                &carrier.structure,
                station,
                &Vector3::zeros(),
            ));
        }
        let second = spring.second.map(|second| end(second, &Vector3::zeros()));
        ends.extend(second.map(|end| match &spring.rollers {
            Some(rollers) => end.around(rollers),
            None => end,
        }));
        if let Some(rollers) = &spring.rollers {
            links.push(Link { ends, law: Law::Rollers(rollers.clone()) });
            continue;
        }
        let of = &spring.stiffness;
        let law = SpringBearing {
            stiffness: [
                stiffness(of.radial.as_ref()),
                stiffness(of.axial.as_ref()),
                stiffness(of.tilt.as_ref()),
            ],
            torsion: of
                .torsion
                .as_ref()
                .map(|torsion| (stiffness(Some(torsion)), of.torsion_damping.map_or(0.0, |c| c.0))),
            damping: [
                of.radial_damping.map_or(0.0, |c| c.0),
                of.axial_damping.map_or(0.0, |c| c.0),
                of.tilt_damping.map_or(0.0, |c| c.0),
            ],
            gap: of.gap.map_or(0.0, |gap| gap.0),
            axial: match of.axial_way {
                AxialTaken::Both => AxialSupport::Both,
                AxialTaken::Along => AxialSupport::Along,
                AxialTaken::Against => AxialSupport::Against,
            },
            rest: stack(&spring.bore.0, &spring.bore.1),
        };
        links.push(Link { ends, law: Law::Spring(law) });
    }
    links
}
