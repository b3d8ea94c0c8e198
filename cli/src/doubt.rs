//! Doubt about a catalogue bearing: what is not known of its inside, one input at a time, and how far that moves its life, torque and loads.

use std::fmt::Write;

use roulement::Scene;
use roulement::catalogue::Bearing;
use roulement::simulation::Simulation;
use thiserror::Error;

use crate::fits::{WITHIN, by_words};
use crate::sweep::all::on_threads;

/// [-] error in both load ratings beyond that of the best candidate up to which another one is likely, too: a ball more or less.
const LIKELY: f64 = 0.02;
/// [-] spread of the pitch diameter.
const PITCH: f64 = 0.02;
/// [-] conformities that makers choose from.
const CONFORMITIES: [f64; 2] = [0.505, 0.54];
/// \[rad] spread of a contact angle.
const ANGLE: f64 = 3.0 * std::f64::consts::PI / 180.0;

/// Why there is no spread.
#[derive(Debug, Error)]
pub enum DoubtError {
    /// The bearing itself.
    #[error(transparent)]
    Bearing(#[from] roulement::catalogue::CatalogueError),
    /// Its scene, or that with a key of the user's.
    #[error(transparent)]
    Scene(#[from] roulement::SceneError),
    /// No balance with the candidate that is looked at.
    #[error("candidate {0}: {1}")]
    Balance(usize, String),
}

/// A quantity: its name, unit, and value at the start of a run.
type Quantity = (&'static str, &'static str, fn(&Simulation) -> Option<f64>);

/// Quantities that are told.
const QUANTITIES: [Quantity; 6] = [
    ("life L10r", "h", |of| {
        let life = of.outputs().life?.reference;
        Some(life * 1e6 * std::f64::consts::TAU / of.outputs().relative_speed().abs() / 3600.0)
            .filter(|life| life.is_finite())
    }),
    ("static safety", "", |of| Some(of.outputs().life?.static_safety)),
    ("torque", "N mm", |of| {
        Some(1e3 * of.outputs().torque_of_losses()).filter(|_| of.outputs().relative_speed() != 0.0)
    }),
    ("losses", "W", |of| Some(of.outputs().losses.total())),
    ("largest ball load", "N", |of| largest(of, |ball| ball.inner.load)),
    ("peak pressure", "MPa", |of| {
        largest(of, |ball| 1e-6 * ball.inner.peak_pressure.max(ball.outer.peak_pressure))
    }),
];

fn largest(of: &Simulation, get: impl Fn(&roulement::effects::reports::BallOutput) -> f64) -> Option<f64> {
    of.outputs().balls.iter().map(get).reduce(f64::max)
}

/// One input with one of its values, or none of a candidate's own.
struct Case {
    input: &'static str,
    value: String,
    scene: Scene,
}

/// Values of all quantities, none where one has none; of a case without balance why.
type Found = Result<Vec<Option<f64>>, String>;

/// What moves a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    /// Its name.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// With the candidate that is looked at.
    pub value: f64,
    /// Least and largest over all cases.
    pub span: [f64; 2],
    /// Input that moves it most, with the value of the input and that of the quantity.
    pub most: Option<(&'static str, String, f64)>,
}

/// Spreads of all quantities, and inputs of which a case has no balance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Doubt {
    /// Quantities.
    pub moved: Vec<Moved>,
    /// Cases without balance, with the reason.
    pub failed: Vec<String>,
    /// [-] how many were looked at.
    pub cases: usize,
}

/// Looks at a candidate of a bearing, counted from 1, with keys of its scene as the user sets them; cases on some threads.
///
/// # Errors
/// If there is no such bearing, a key is refused, or the candidate itself finds no balance.
pub fn doubt(
    bearing: &Bearing,
    candidate: usize,
    set: &[(String, String)],
    threads: usize,
) -> Result<Doubt, DoubtError> {
    let base = Scene::edited(&bearing.scene(candidate)?, pairs(set))?;
    let cases = cases(bearing, candidate, set, &base)?;
    let found = on_threads(cases.len() + 1, threads, |index| match index.checked_sub(1) {
        None => look(&base),
        Some(index) => look(&cases[index].scene),
    });
    let (own, others) =
        found.split_first().map_or((Ok(vec![]), &[][..]), |(own, others)| (own.clone(), others));
    let own = own.map_err(|why| DoubtError::Balance(candidate, why))?;
    let mut doubt = Doubt { cases: cases.len() + 1, ..Doubt::default() };
    for (case, found) in cases.iter().zip(others) {
        if let Err(why) = found {
            doubt.failed.push(format!("{} = {}: {why}", case.input, case.value));
        }
    }
    for (place, (quantity, unit, _)) in QUANTITIES.into_iter().enumerate() {
        let Some(value) = own[place] else { continue };
        let values =
            cases.iter().zip(others).filter_map(|(case, found)| Some((case, found.as_ref().ok()?[place]?)));
        let values: Vec<(&Case, f64)> = values.collect();
        let span =
            values.iter().fold([value; 2], |[least, most], (_, other)| [least.min(*other), most.max(*other)]);
        let most = values.iter().max_by(|a, b| (a.1 - value).abs().total_cmp(&(b.1 - value).abs()));
        let most = most
            .filter(|(_, other)| *other != value)
            .map(|(case, other)| (case.input, case.value.clone(), *other));
        doubt.moved.push(Moved { quantity, unit, value, span, most });
    }
    Ok(doubt)
}

/// Keys with their values.
fn pairs(set: &[(String, String)]) -> impl Iterator<Item = (&str, &str)> {
    set.iter().map(|(key, value)| (key.as_str(), value.as_str()))
}

/// Values at the start of a run, where all is in balance.
fn look(scene: &Scene) -> Found {
    let simulation = Simulation::new(scene).map_err(|why| why.to_string())?;
    Ok(QUANTITIES.iter().map(|(.., get)| get(&simulation)).collect())
}

/// All inputs that are not known, each by itself.
fn cases(
    bearing: &Bearing,
    candidate: usize,
    set: &[(String, String)],
    base: &Scene,
) -> Result<Vec<Case>, DoubtError> {
    let mut cases = vec![];
    let candidates = bearing.candidates()?;
    let best = candidates.first().map_or(0.0, roulement::catalogue::Candidate::error);
    for (index, other) in candidates.iter().enumerate() {
        if index + 1 != candidate && other.error() <= best + LIKELY {
            let scene = Scene::edited(&bearing.scene(index + 1)?, pairs(set))?;
            cases.push(Case { input: "balls", value: other.to_string(), scene });
        }
    }
    if let Some(growth) = base.effects.growth.section.as_ref().filter(|growth| by_words(growth)) {
        for (name, _) in WITHIN.into_iter().filter(|(_, within)| *within != growth.fits) {
            let scene = Scene::edited(&base.source, [("growth.fits", format!("\"{name}\"").as_str())])?;
            cases.push(Case { input: "growth.fits", value: name.to_owned(), scene });
        }
    }
    let mut push = |input: &'static str, values: [f64; 2], own: f64, shown: &dyn Fn(f64) -> String| {
        // What the user sets is known.
        if set.iter().any(|(key, _)| key == input) {
            return Ok(());
        }
        for value in values.into_iter().filter(|value| *value != own) {
            let scene = Scene::edited(&base.source, [(input, value.to_string().as_str())])?;
            cases.push(Case { input, value: shown(value), scene });
        }
        Ok::<(), DoubtError>(())
    };
    let of = &base.bearing;
    if bearing.inside.is_none() {
        let pitch = of.pitch_diameter.0;
        let millimetres = |value: f64| format!("{:.3} mm", 1e3 * value);
        push("bearing.pitch_diameter", [pitch * (1.0 - PITCH), pitch * (1.0 + PITCH)], pitch, &millimetres)?;
        let plain = |value: f64| value.to_string();
        push("bearing.inner_conformity", CONFORMITIES, of.inner_conformity, &plain)?;
        push("bearing.outer_conformity", CONFORMITIES, of.outer_conformity, &plain)?;
    }
    if let (Some(clearance), None) = (of.diametral_clearance, bearing.own_clearance) {
        let micrometres = |value: f64| format!("{:.1} um", 1e6 * value);
        push(
            "bearing.diametral_clearance",
            bearing.clearance.limits(bearing.bore)?,
            clearance.0,
            &micrometres,
        )?;
    }
    if let Some(angle) = of.contact_angle.filter(|_| !bearing.is_thrust()) {
        let degrees = |value: f64| format!("{:.1} deg", value.to_degrees());
        push("bearing.contact_angle", [angle.0 - ANGLE, angle.0 + ANGLE], angle.0, &degrees)?;
    }
    Ok(cases)
}

/// A number in three digits.
fn three(value: f64) -> String {
    let digits = if value == 0.0 { 0 } else { (2.0 - value.abs().log10().floor()).max(0.0) as usize };
    format!("{value:.digits$}")
}

impl Doubt {
    /// A line for each quantity: its value, its span, and what moves it most.
    pub fn to_text(&self) -> String {
        let mut text = format!(
            "spread of {} equilibria, one input at a time; what moves it most is behind\n",
            self.cases
        );
        for Moved { quantity, unit, value, span: [least, most], most: by } in &self.moved {
            let by = by
                .as_ref()
                .map_or(String::new(), |(input, to, other)| format!("  {input} = {to}: {}", three(*other)));
            let span = format!("{} to {} {unit}", three(*least), three(*most));
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {quantity:<18} {:>9} {unit:<5} {span:<24}{by}", three(*value));
        }
        for failed in &self.failed {
            let _ = writeln!(text, "  no balance with {failed}");
        }
        text
    }
}
