//! Advice for a scene: the cheapest creep law and step together that keep an error, run once to be sure.

use super::levers::{CreepModel, Lever, ReferenceKind, Setting};
use super::norms::{Errors, Norm};
use super::{Measured, Point};

/// [-] error that is asked for.
pub const TARGET: f64 = 0.01;
/// Quantities that it is asked for, a sentence each.
pub const ASKED: [Norm; 2] = [Norm::Power, Norm::Wrench];
/// [-] combinations that are run before the search is given up.
const MOST_TRIALS: usize = 5;

/// A law and a numerical setting together, with what their runs one by one make expect.
struct Combination<'a> {
    creep: CreepModel,
    /// The numerical setting; none is the scene's own.
    point: Option<&'a Point>,
    cpu: f64,
    error: f64,
}

/// All combinations, the cheapest first: errors of law and step add up at worst, times multiply.
fn combinations<'a>(points: &'a [Point], own: CreepModel, norm: Norm) -> Vec<Combination<'a>> {
    let ok = |point: &'a Point| Some((point, point.result.as_ref().ok()?));
    let laws: Vec<(&Point, &Measured)> =
        points.iter().filter(|point| point.lever == Lever::CreepLaw).filter_map(ok).collect();
    let numerical =
        [Lever::Default, Lever::Goal, Lever::FixedStep, Lever::Tolerance, Lever::Method, Lever::StepCap];
    let steps: Vec<(&Point, &Measured)> =
        points.iter().filter(|point| numerical.contains(&point.lever)).filter_map(ok).collect();
    let error = |measured: &Measured| measured.errors.get(norm).unwrap_or(f64::INFINITY);
    let own_cpu = laws.iter().find(|(point, _)| point.creep == own).map(|(_, measured)| measured.cpu);
    let mut all: Vec<Combination<'a>> = match (&laws[..], &steps[..]) {
        ([], steps) => steps
            .iter()
            .map(|&(point, m)| Combination { creep: own, point: Some(point), cpu: m.cpu, error: error(m) })
            .collect(),
        (laws, []) => laws
            .iter()
            .map(|(law, m)| Combination { creep: law.creep, point: None, cpu: m.cpu, error: error(m) })
            .collect(),
        (laws, steps) => laws
            .iter()
            .flat_map(|(law, of_law)| {
                steps.iter().map(move |&(point, of_step)| Combination {
                    creep: law.creep,
                    point: Some(point),
                    cpu: of_step.cpu * own_cpu.map_or(1.0, |own| of_law.cpu / own),
                    error: error(of_law) + error(of_step),
                })
            })
            .collect(),
    };
    all.sort_by(|a, b| a.cpu.total_cmp(&b.cpu));
    all
}

/// A sentence for each quantity asked for. `settings` are those of the points with the same lever and label, `run` gives the
/// error of a setting against the reference of a kind, and its time.
pub fn advise(
    points: &[Point],
    settings: &[Setting],
    scene: &roulement::scene::machine::MachineScene,
    run: impl Fn(&Setting, ReferenceKind) -> Option<(Errors, f64)>,
) -> Vec<String> {
    let own = CreepModel::of(scene);
    let kind = match points.iter().any(|point| point.lever == Lever::CreepLaw) {
        true => ReferenceKind::Model,
        false => ReferenceKind::Numerical,
    };
    let of = |combination: &Combination<'_>| {
        let base = combination.point.and_then(|point| {
            settings.iter().find(|setting| (setting.lever, &setting.label) == (point.lever, &point.label))
        });
        let scene = base.map_or(scene, |setting| &setting.scene);
        Setting::creep(scene, combination.creep)
    };
    let sentence = |norm: Norm| {
        let all = combinations(points, own, norm);
        let hopeful = all.iter().filter(|combination| combination.error <= TARGET).take(MOST_TRIALS);
        for combination in hopeful {
            let Some((errors, cpu)) = run(&of(combination), kind) else { continue };
            if let Some(error) = errors.get(norm).filter(|error| *error <= TARGET) {
                return format!(
                    "For {:.0} % of the {} take {}{}: {cpu:.2} s/s, error {:.1e}.",
                    TARGET * 100.0,
                    norm.name(),
                    combination.creep.name(),
                    step_of(combination.point),
                    error
                );
            }
        }
        match all
            .iter()
            .filter(|combination| combination.error.is_finite())
            .min_by(|a, b| a.error.total_cmp(&b.error))
        {
            Some(best) => format!(
                "No setting was found that keeps {:.0} % of the {}; the closest is {}{}: about {:.2} s/s, error {:.1e}.",
                TARGET * 100.0,
                norm.name(),
                best.creep.name(),
                step_of(best.point),
                best.cpu,
                best.error
            ),
            None => format!("Nothing was run that tells the error of the {}.", norm.name()),
        }
    };
    ASKED.into_iter().map(sentence).collect()
}

/// A numerical setting in words.
fn step_of(point: Option<&Point>) -> String {
    let Some(point) = point else { return " with the scene's own steps".into() };
    match point.lever {
        Lever::Default => format!(" with {}", point.label),
        Lever::Goal => format!(" with accuracy = \"{}\"", point.label),
        Lever::FixedStep => format!(" with fixed steps of {}", point.label),
        Lever::Tolerance => format!(" with tolerance = {} and no other limit of the step", point.label),
        Lever::Method => {
            let (method, tolerance) = point.label.split_once(' ').unwrap_or((&point.label, ""));
            format!(" with method = \"{method}\", tolerance = {tolerance} and no other limit of the step")
        }
        Lever::StepCap => format!(" with max_step = \"{}\"", point.label),
        lever => format!(" with {} {}", lever.name(), point.label),
    }
}
