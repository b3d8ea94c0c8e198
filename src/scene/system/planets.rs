//! Planets: shafts around a common axis whose teeth stand between those of two gears on it, a sun and a ring.
//!
//! ```text
//! z_s (t_s - p) + z (t - p) = a           sun and planet in mesh at the angle p, t turns of gears; a the same for all planets
//! z_r (t_r - p) - z (t - p) = b           planet and ring
//! (z_s + z_r) p = a + b + 2 pi n          both: where a planet can stand, by a whole number n
//! ```
//! Of two planets at `p` and `p + d` the teeth fit where `(z_s + z_r) d` is a whole number of turns. Their teeth do not pass the pitch points at one time: those of the second
//! are behind by `z_s d` at the sun and by `z_r d` at the ring.

use std::f64::consts::{PI, TAU};

use super::SceneError;
use super::mesh::SceneMesh;
use crate::schema::ShaftSection;

/// [-] of a tooth: how far a planet may stand beside a place where it fits, by the digits of a file.
const FITS: f64 = 0.02;

/// A planet: its shaft, and its two meshes by growing index.
#[derive(Clone, Copy)]
struct Planet {
    shaft: usize,
    meshes: [usize; 2],
}

/// A gear beside that of a planet: its shaft, and its teeth, negative where they are inside.
type Partner = (usize, i64);

/// Teeth of a gear, negative where they are inside.
fn teeth(mesh: &SceneMesh, gear: usize) -> i64 {
    let of = &mesh.section.gears[gear];
    i64::from(of.teeth) * if of.inside { -1 } else { 1 }
}

/// Which gear of a mesh is on a shaft.
fn gear_on(mesh: &SceneMesh, shaft: usize) -> Option<usize> {
    mesh.shafts.iter().position(|own| *own == shaft)
}

/// What a planet meshes with.
fn partners(planet: &Planet, meshes: &[SceneMesh]) -> Option<[Partner; 2]> {
    let of = |mesh: usize| {
        let mesh = &meshes[mesh];
        let other = 1 - gear_on(mesh, planet.shaft)?;
        Some((mesh.shafts[other], teeth(mesh, other)))
    };
    let [one, other] = planet.meshes.map(of);
    Some([one?, other?])
}

/// The planets of a machine: shafts of which one gear meshes with two that are on another axis.
fn planets(shafts: &[ShaftSection], meshes: &[SceneMesh]) -> Vec<Planet> {
    let coaxial = |one: usize, other: usize| shafts[one].is_coaxial_with(&shafts[other]);
    let mut found = vec![];
    for shaft in 0..shafts.len() {
        let own: Vec<(usize, i64)> = meshes
            .iter()
            .enumerate()
            .filter_map(|(index, mesh)| gear_on(mesh, shaft).map(|gear| (index, teeth(mesh, gear))))
            .collect();
        for (place, (first, z)) in own.iter().enumerate() {
            for (second, other) in &own[place + 1..] {
                let planet = Planet { shaft, meshes: [*first, *second] };
                let Some([a, b]) = partners(&planet, meshes) else { continue };
                // Of a stepped planet each gear has teeth of its own, and so a place for every way in which these stand to each other.
                if z == other && a.0 != b.0 && coaxial(a.0, b.0) && !coaxial(a.0, shaft) {
                    found.push(planet);
                }
            }
        }
    }
    found
}

/// \[rad] angle of a shaft about the axis of another, from y towards z.
fn angle(shafts: &[ShaftSection], planet: usize, about: usize) -> f64 {
    let [from, to] = [about, planet].map(|shaft| shafts[shaft].place(0.0));
    (to[2] - from[2]).atan2(to[1] - from[1])
}

/// Checks that all planets fit between the teeth of their sun and ring, and turns the gears of their meshes to where they stand at the start: the first planet of
/// a set stands as any gears do.
///
/// # Errors
/// Names the planet, where it stands, and where it would fit.
pub fn place(shafts: &[ShaftSection], meshes: &mut [SceneMesh]) -> Result<(), SceneError> {
    let all = planets(shafts, meshes);
    for (index, planet) in all.iter().enumerate() {
        let own = partners(planet, meshes);
        let Some(first) = all[..index].iter().find(|first| partners(first, meshes) == own) else { continue };
        let Some([a, b]) = own else { continue };
        let from = angle(shafts, first.shaft, a.0);
        let apart = (angle(shafts, planet.shaft, a.0) - from + PI).rem_euclid(TAU) - PI;
        let teeth = (a.1 - b.1) as f64;
        let passed = teeth * apart / TAU;
        if (passed - passed.round()).abs() > FITS {
            let name = |shaft: usize| &shafts[shaft].name;
            let pitch = 360.0 / teeth.abs();
            let below = (apart.to_degrees() / pitch).floor() * pitch;
            let why = format!(
                "it stands {:.4} deg from \"{}\" about the axis of \"{}\" and \"{}\", where its teeth do not fit between both: planets fit every {pitch:.4} deg \
                 (360 deg over {} + {} teeth), next at {below:.4} and {:.4} deg; planets at equal angles need a sum of these teeth that is a multiple of their number",
                apart.to_degrees(),
                name(first.shaft),
                name(a.0),
                name(b.0),
                a.1.abs(),
                b.1.abs(),
                below + pitch
            );
            return Err(SceneError::conflict(format!("shaft \"{}\": shaft.origin", name(planet.shaft)), why));
        }
        for index in planet.meshes {
            let mesh = &mut meshes[index];
            // The sun or the ring stands behind by the angle between both planets.
            mesh.turned = match gear_on(mesh, planet.shaft) {
                Some(0) => -apart / mesh.ratio(),
                _ => -apart,
            };
        }
    }
    Ok(())
}
