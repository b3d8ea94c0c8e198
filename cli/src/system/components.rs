//! Packages of all components.

use std::fs;
use std::path::{Path, PathBuf};

use roulement::analysis::auto;
use roulement::interface::model_description::Version;
use roulement::scene::Scene;
use roulement::schema::regular::{self, LARGEST_BINARY};

use super::description::{Named, Source};
use super::interface::Interface;
use super::{SystemError, file_error};
use crate::package::{library_beside_executable, write_fmu};

/// A component with its package, which is in the folder for libcosim.
pub struct Component {
    /// Name.
    pub name: String,
    /// File of the package; components of one source share it.
    pub file: String,
    /// Variables and units.
    pub interface: Interface,
    /// Does its x axis point the other way?
    turned: bool,
}

/// Numbers about the axis of a bearing, beside those whose names end in `speed`.
const ABOUT_AXIS: [&str; 2] = ["turned", "drive_torque"];

impl Component {
    /// Another component with the same package.
    fn shared_by(&self, name: &str, turned: bool) -> Self {
        let Self { file, interface, .. } = self;
        Self { name: name.into(), file: file.clone(), interface: interface.clone(), turned }
    }

    /// Sign of a variable in the axes of the system. A component with its x axis the other way is seen after half a turn about z: x and
    /// y components have the other sign, and what turns about x.
    pub fn sign(&self, variable: &str) -> f64 {
        let last = variable.rsplit('.').next().unwrap_or(variable);
        let changes = ["x", "y"].contains(&last) || ABOUT_AXIS.contains(&last) || last.ends_with("speed");
        if self.turned && changes { -1.0 } else { 1.0 }
    }
}

/// Packs scenes into a folder and copies packages there; with what the reader should know. Files are searched beside the description. Without
/// a library, scenes get the one beside this program.
///
/// # Errors
/// If a package cannot be read, made or used.
pub fn prepare(
    named: &[Named],
    beside: &Path,
    folder: &Path,
    libraries: &[PathBuf],
) -> Result<(Vec<Component>, Vec<String>), SystemError> {
    let mut made: Vec<Component> = vec![];
    let mut notes = vec![];
    // Scenes that were packed, by the component that did it first: another file, or other changes, may say the same.
    let mut packed: Vec<(String, usize)> = vec![];
    for (index, Named { name, source, turned }) in named.iter().enumerate() {
        let failed = |why: String| SystemError::Component { component: name.clone(), why };
        if let Some(same) = named[..index].iter().position(|before| before.source == *source) {
            let shared = made[same].shared_by(name, *turned);
            made.push(shared);
            continue;
        }
        let file = format!("{name}.fmu");
        let package = folder.join(&file);
        let bytes = match source {
            Source::Fmu(path) => {
                let path = beside.join(path);
                let bytes = regular::bytes(&path, LARGEST_BINARY)
                    .map_err(|why| failed(format!("cannot read {}: {why}", path.display())))?;
                fs::write(&package, &bytes).map_err(file_error("write", &package))?;
                bytes
            }
            Source::Scene(path, changes) => {
                let (scene, said) = scene(&beside.join(path), changes).map_err(failed)?;
                notes.extend(said.into_iter().map(|note| format!("{name}: {note}")));
                if let Some((_, same)) = packed.iter().find(|(source, _)| *source == scene.source) {
                    let shared = made[*same].shared_by(name, *turned);
                    made.push(shared);
                    continue;
                }
                packed.push((scene.source.clone(), index));
                let mut libraries = libraries.to_vec();
                if libraries.is_empty() {
                    libraries.push(library_beside_executable().map_err(|why| failed(why.to_string()))?);
                }
                // Masters of both structures read FMI 2.0; of FMI 3.0 libcosim reads nothing.
                write_fmu(&scene.into(), &Version::V2.into(), name, &[], &libraries, &package)
                    .map_err(|why| failed(why.to_string()))?;
                regular::bytes(&package, LARGEST_BINARY).map_err(file_error("read", &package))?
            }
        };
        let interface = Interface::of_package(&bytes).map_err(failed)?;
        made.push(Component { name: name.clone(), file, interface, turned: *turned });
    }
    Ok((made, notes))
}

/// A scene with its keys changed and its effects found out; with what is said of it.
fn scene(path: &Path, changes: &[(String, String)]) -> Result<(Scene, Vec<String>), String> {
    let mut scene = Scene::load(path).map_err(|why| why.to_string())?;
    if !changes.is_empty() {
        let changes = changes.iter().map(|(key, value)| (key.as_str(), value.as_str()));
        scene = Scene::edited(&scene.source, changes).map_err(|why| format!("changes: {why}"))?;
    }
    let mut said: Vec<String> = scene.notes().into_iter().collect();
    let (scene, found_out) = auto::resolve_for_importer(scene).map_err(|why| why.to_string())?;
    said.extend(found_out);
    Ok((scene, said))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_half_a_turn_about_z_changes_x_and_y() {
        let [seen, turned] = [false, true].map(|turned| Component {
            name: String::new(),
            file: String::new(),
            interface: Interface::default(),
            turned,
        });
        for name in ["inner.force.x", "inner.rotation.y", "inner.speed", "inner.turned", "cage.speed"] {
            assert_eq!((seen.sign(name), turned.sign(name)), (1.0, -1.0), "{name}");
        }
        for name in ["inner.force.z", "inner.orientation.w", "friction", "friction_power", "balls.loaded"] {
            assert_eq!((seen.sign(name), turned.sign(name)), (1.0, 1.0), "{name}");
        }
    }
}
