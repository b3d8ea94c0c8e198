//! `roulement identify`: parameters of the regularised creep law.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use roulement::contact::identification::{identify, identify_by_table};
use roulement::contact::shape::ContactShape;
use roulement::kalker::Patch;
use roulement::kalker::nonlinear::Kalker;
use roulement::model::bearing::Bearing;
use roulement::scene::machine::MachineScene;
use roulement::schema::regular;

use super::say;

/// Options of `roulement identify`.
#[derive(Args)]
pub struct Options {
    /// Scene whose raceways are meant; without one, give --axis-ratio.
    scene: Option<PathBuf>,
    /// Semi-axis along rolling over the one across it, 0.018 to 55.
    #[arg(long, conflicts_with = "scene", default_value_t = 1.0)]
    axis_ratio: f64,
    /// Poisson's ratio, 0 to 0.5.
    #[arg(long, conflicts_with = "scene", default_value_t = 0.3)]
    poisson_ratio: f64,
    /// Friction coefficient. The parameters do not depend on it: it drops out of Kalker's scaled creepages.
    #[arg(long)]
    friction: Option<f64>,
    /// Fit to the polynomials of this degree, 1 to 7, instead of the table of the nonlinear theory.
    #[arg(long)]
    degree: Option<usize>,
    /// Scene file to write: the scene with the parameters in it; without a scene, the section alone.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// Identifies and prints the parameters as a section of a scene.
///
/// # Errors
/// If input is out of range or the file cannot be written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    if let Some(friction) = options.friction
        && !(friction > 0.0 && friction <= 2.0)
    {
        return Err(format!("--friction = {friction} is out of range: allowed is (0, 2]").into());
    }
    let mut section = String::new();
    match &options.scene {
        Some(path) => {
            let MachineScene::Bearing(scene) = super::load(path)? else {
                let path = path.display();
                return Err(format!("{path} is of a shaft: name the scene of one of its bearings").into());
            };
            let bearing = Bearing::new(&scene);
            for (race, raceway) in [("inner", &bearing.inner), ("outer", &bearing.outer)] {
                let materials = &bearing.materials;
                let shape =
                    ContactShape::new(bearing.ball.radius, bearing.pitch_diameter, materials, raceway)?;
                let patch = shape.typical_patch(materials.poisson_ratio);
                write_parameters(&mut section, race, &patch, options.degree)?;
            }
        }
        None => {
            let patch = Patch {
                axis_ratio: options.axis_ratio,
                poisson_ratio: options.poisson_ratio,
                rolling_angle: 0.0,
            };
            for race in ["inner", "outer"] {
                write_parameters(&mut section, race, &patch, options.degree)?;
            }
        }
    }
    say(&section)?;
    if let Some(output) = &options.output {
        write_scene(options.scene.as_deref(), output, &section)?;
        super::tell([format!("written to {}", output.display())]);
    }
    Ok(())
}

fn write_parameters(
    section: &mut String,
    race: &str,
    patch: &Patch,
    degree: Option<usize>,
) -> Result<(), Box<dyn Error>> {
    let (found, theory) = match degree {
        None => (identify_by_table(patch)?, "the table of Kalker's nonlinear theory".to_string()),
        Some(degree) => {
            let kalker = Kalker::new(*patch, degree)?;
            let found = identify(patch, |h| kalker.solve(h, None).map(|solution| solution.forces))?;
            (found, format!("Kalker's nonlinear theory in polynomials of degree {degree}"))
        }
    };
    let [eta, beta, alpha] = found.residuals();
    let list = |values: &[f64]| values.iter().map(|v| format!("{v:.5}")).collect::<Vec<_>>().join(", ");
    let parameters = &found.parameters;
    writeln!(section, "[regularised.{race}]")?;
    writeln!(
        section,
        "# axis ratio {:.4}, Poisson's ratio {:.3}; fitted to\n\
         # {theory}, 50 spins and 50 lateral creepages; residuals over mu Q (eta) and M_max (beta, alpha)",
        patch.axis_ratio, patch.poisson_ratio
    )?;
    for (name, values, [rms, largest]) in [
        ("eta", &parameters.eta[..], eta),
        ("beta", &parameters.beta, beta),
        ("alpha", &parameters.alpha, alpha),
    ] {
        writeln!(section, "{name} = [{}]  # rms {rms:.4}, largest {largest:.4}", list(values))?;
    }
    Ok(())
}

/// Writes a scene with the section in it.
fn write_scene(scene: Option<&Path>, output: &Path, section: &str) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    if let Some(path) = scene {
        text = regular::text(path)?;
        if text.lines().any(|line| line.trim_start().starts_with("[regularised")) {
            return Err(
                format!("{} has a [regularised] section already: remove it first", path.display()).into()
            );
        }
        text.push('\n');
    }
    text.push_str(section);
    fs::write(output, text).map_err(|why| format!("cannot write {}: {why}", output.display()))?;
    Ok(())
}
