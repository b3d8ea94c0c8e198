//! The report of a study: tables, plots and what follows from them, as Markdown and HTML.

use std::fs;
use std::path::{Path, PathBuf};

use strum::VariantArray;
use thiserror::Error;

use super::document::{Block, html, markdown};
use super::levers::{DYNAMIC, Lever, ReferenceKind, seconds};
use super::norms::{Comparison, Errors, Norm};
use super::regret::{Regret, Tried};
use super::{Measured, Point, SceneStudy, figures, table};
use crate::report::style::PlotError;
use roulement::scene::Accuracy;

/// Why a report could not be written.
#[derive(Debug, Error)]
pub enum ReportError {
    /// A plot.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// The table.
    #[error("cannot write {path}: {source}")]
    Table {
        /// File.
        path: String,
        /// Cause.
        source: csv::Error,
    },
    /// A text.
    #[error("cannot write {path}: {source}")]
    Text {
        /// File.
        path: String,
        /// Cause.
        source: std::io::Error,
    },
}

/// Errors that the summary asks for.
const TARGETS: [f64; 5] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
const KINDS: [ReferenceKind; 2] = [ReferenceKind::Numerical, ReferenceKind::Model];
const TITLE: &str = "What accuracy costs in time";

/// Writes `cost.csv`, the plots, `report.md` and `report.html` into a directory and returns their paths.
///
/// # Errors
/// If a file cannot be written.
pub fn write(studies: &[SceneStudy], directory: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let csv = directory.join("cost.csv");
    table::write(studies, &csv)
        .map_err(|source| ReportError::Table { path: csv.display().to_string(), source })?;
    let mut paths = vec![csv];
    for study in studies {
        let file = |what| directory.join(figure_file(study, what));
        figures::write_overview(study, &file("overview"))?;
        paths.push(file("overview"));
        for kind in KINDS.into_iter().filter(|&kind| study.has(kind)) {
            let path = file(kind.into());
            figures::write_norms(study, kind, &path)?;
            paths.push(path);
        }
    }
    let blocks = report(studies);
    for (name, text) in [("report.md", markdown(&blocks)), ("report.html", html(TITLE, &blocks))] {
        let path = directory.join(name);
        fs::write(&path, text)
            .map_err(|source| ReportError::Text { path: path.display().to_string(), source })?;
        paths.push(path);
    }
    Ok(paths)
}

fn figure_file(study: &SceneStudy, what: &str) -> String {
    format!("{}-{what}.svg", study.name)
}

fn text(text: impl Into<String>) -> Block {
    Block::Text(text.into())
}

fn report(studies: &[SceneStudy]) -> Vec<Block> {
    let sentences = studies.iter().map(|study| format!("*{}*: {}", study.title(), study.advice.join(" ")));
    let advice = Block::Text(sentences.collect::<Vec<_>>().join("\n\n"));
    let group =
        |comparison| studies.iter().filter(|study| study.comparison == comparison).collect::<Vec<_>>();
    let (smooth, impacts) = (group(Comparison::Pointwise), group(Comparison::WindowMeans));
    let made = format!("roulement {} on {}.", env!("ROULEMENT_VERSION"), machine());
    let mut blocks = vec![
        Block::Heading(1, TITLE.into()),
        Block::Section("machine".into(), vec![text(made)]),
        text(
            "CPU is the time of one thread per simulated second, without the start; the least of up to three runs, with others \
             beside it on the other cores unless `--threads 1` was given. Errors are relative, from a quarter of the simulated time on. The numerical error is against the same \
             model at a tiny step, the model error against the richest model at the scene's own step. Each reference \
             has an error bar, its difference to a run at another step: errors near the bar or below it say no more than that.",
        ),
        text(
            "The cheapest law and step together, run once to be sure (errors against the richest model, where laws were run):",
        ),
        advice,
        text("The goals of `solver.accuracy` over all scenes:"),
        Block::Section("goals".into(), vec![goals(&smooth, &impacts)]),
    ];
    for (group, heading, how) in [
        (
            smooth,
            "Smooth scenes",
            "The two finest runs stay together: errors are root mean squares of differences at equal times.",
        ),
        (
            impacts,
            "Scenes with impacts",
            "Trajectories diverge, whatever the step: errors are differences of means over the window.",
        ),
    ] {
        if group.is_empty() {
            continue;
        }
        let plot = |study: &&SceneStudy| figure(study, "overview", "largest error against CPU time");
        blocks.extend([Block::Heading(2, heading.into()), text(how), goals_by_scene(&group)]);
        blocks.extend(group.iter().map(plot));
        if group.iter().all(|study| study.has(ReferenceKind::Numerical)) {
            blocks.extend([text(CHEAPEST), cheapest(&group)]);
        }
        if group.iter().all(|study| study.has(ReferenceKind::Model)) {
            blocks.extend([
                text("Error of every model against the richest, at the scene's own step, and its CPU time:"),
                models(&group),
            ]);
        }
        group.iter().for_each(|study| scene(study, &mut blocks));
    }
    blocks
}

/// The goals of `solver.accuracy`: what they stand for, and their errors and times over all scenes.
fn goals(smooth: &[&SceneStudy], impacts: &[&SceneStudy]) -> Block {
    let header = [
        "goal",
        "settings",
        "wrench error, smooth",
        "largest error, smooth",
        "CPU [s/s], smooth",
        "largest error, impacts",
        "CPU [s/s], impacts",
    ];
    let row = |goal: &Accuracy| {
        let name: &str = goal.into();
        let over = |group: &[&SceneStudy], get: &dyn Fn(&Measured) -> Option<f64>| -> Vec<f64> {
            let points = group.iter().flat_map(|study| &study.points);
            let of_goal = points.filter(|point| point.lever == Lever::Goal && point.label == name);
            of_goal.filter_map(|point| get(point.result.as_ref().ok()?)).collect()
        };
        let largest = |group, get| number(over(group, get).into_iter().reduce(f64::max));
        let times = |group| {
            let times = over(group, &|measured| Some(measured.cpu));
            let [least, most] = [f64::min, f64::max].map(|choose| times.iter().copied().reduce(choose));
            match least.zip(most) {
                Some((least, most)) if least < most => format!("{least:.2} to {most:.2}"),
                only => only.map(|(time, _)| format!("{time:.2}")).unwrap_or_default(),
            }
        };
        let solver = goal.solver();
        vec![
            format!("`{name}`"),
            format!("`tolerance` {:e}, `max_step` {}", solver.tolerance, seconds(solver.max_step.0)),
            largest(smooth, &|measured| measured.errors.get(Norm::Wrench)),
            largest(smooth, &|measured| measured.errors.worst()),
            times(smooth),
            largest(impacts, &|measured| measured.errors.worst()),
            times(impacts),
        ]
    };
    let rows = Accuracy::VARIANTS.iter().map(row).collect();
    Block::Table { header: header.map(String::from).to_vec(), rows }
}

/// Model errors and times: a row for every quantity and model, a column for every scene.
fn models(group: &[&SceneStudy]) -> Block {
    let header = ["quantity", "model"].map(String::from).into_iter();
    let header = header.chain(group.iter().map(|study| study.name.clone())).collect();
    let models = group[0].points_of(ReferenceKind::Model).filter(|point| point.label != DYNAMIC);
    let models: Vec<_> = models.map(|point| point.label.clone()).collect();
    let measured = |study: &SceneStudy, label: &str| {
        study
            .points_of(ReferenceKind::Model)
            .find(|point| point.label == label)?
            .result
            .as_ref()
            .ok()
            .cloned()
    };
    let norms = [Norm::Wrench, Norm::FrictionTorque, Norm::Power];
    let mut rows = Vec::new();
    for norm in norms {
        let name = norm.name().to_string();
        let bars = group.iter().map(|study| number(study.error_bar(ReferenceKind::Model).get(norm)));
        rows.push([name.clone(), "error bar".into()].into_iter().chain(bars).collect());
        for label in &models {
            let errors = group
                .iter()
                .map(|study| measured(study, label).map_or("failed".into(), |m| number(m.errors.get(norm))));
            rows.push([name.clone(), label.clone()].into_iter().chain(errors).collect());
        }
    }
    for label in &models {
        let times = group
            .iter()
            .map(|study| measured(study, label).map_or("failed".into(), |m| format!("{:.2}", m.cpu)));
        rows.push(["CPU [s/s]".to_string(), label.clone()].into_iter().chain(times).collect());
    }
    Block::Table { header, rows }
}

/// The goals of `solver.accuracy`, scene by scene.
fn goals_by_scene(group: &[&SceneStudy]) -> Block {
    let header = ["scene", "goal", "wrench", "friction torque", "mean power", "largest", "CPU [s/s]"];
    let mut rows = Vec::new();
    for study in group {
        for point in study.points.iter().filter(|point| point.lever == Lever::Goal) {
            let measured = point.result.as_ref().ok();
            let error = |norm| number(measured.and_then(|m| m.errors.get(norm)));
            rows.push(vec![
                study.name.clone(),
                point.label.clone(),
                error(Norm::Wrench),
                error(Norm::FrictionTorque),
                error(Norm::Power),
                number(measured.and_then(|m| m.errors.worst())),
                measured.map_or("failed".into(), |m| format!("{:.3}", m.cpu)),
            ]);
        }
    }
    Block::Table { header: header.map(String::from).to_vec(), rows }
}

const CHEAPEST: &str = "The cheapest setting whose largest numerical error is below a target:";

fn cheapest(group: &[&SceneStudy]) -> Block {
    let header = ["scene", "below", "lever", "setting", "largest", "CPU [s/s]"].map(String::from).to_vec();
    let mut rows = Vec::new();
    for study in group {
        let front = study.pareto(ReferenceKind::Numerical, None);
        for (index, target) in TARGETS.into_iter().enumerate() {
            // A setting that meets several targets is shown with the strictest.
            let strictest = |error: f64| TARGETS.get(index + 1).is_none_or(|&next| error > next);
            let found = front.iter().find(|(_, _, error)| *error <= target);
            if let Some((point, cpu, error)) = found.filter(|(_, _, error)| strictest(*error)) {
                rows.push(vec![
                    study.name.clone(),
                    format!("{target:e}"),
                    point.lever.name().into(),
                    point.label.clone(),
                    number(Some(*error)),
                    format!("{cpu:.3}"),
                ]);
            }
        }
    }
    Block::Table { header, rows }
}

fn figure(study: &SceneStudy, what: &str, caption: &str) -> Block {
    Block::Figure { file: figure_file(study, what), caption: format!("{}: {caption}", study.title()) }
}

fn scene(study: &SceneStudy, blocks: &mut Vec<Block>) {
    blocks.extend([
        Block::Heading(3, study.title().to_string()),
        text(format!(
            "{} ms simulated, communication step {}, numerical reference at fixed steps of {}. The two finest runs \
             differ by {} at equal times.",
            study.scene.duration() * 1e3,
            seconds(study.scene.output_interval()),
            seconds(study.reference_step),
            number(Some(study.divergence)),
        )),
        text(study.settled.join(" ")),
    ]);
    let of_bearing: Vec<Norm> =
        Norm::VARIANTS.iter().copied().filter(|norm| !norm.is_of_contacts()).collect();
    if study.has(ReferenceKind::Numerical) {
        blocks.extend([
            figure(study, "numerical", "numerical error of every quantity"),
            text("Numerical error, same model. A star marks the Pareto front of the largest error."),
            points(study, ReferenceKind::Numerical, &of_bearing),
        ]);
    }
    if let Some(regret) = &study.regret {
        blocks.push(text(study.promise().join(" ")));
        blocks.extend(regret.iter().flat_map(|regret| [text(OF_PROMISE), promise(regret)]));
    }
    if study.has(ReferenceKind::Model) {
        blocks.extend([
            figure(study, "model", "model error of every quantity"),
            text("Model error, at the scene's own step."),
            points(study, ReferenceKind::Model, &of_bearing),
            text(OF_CONTACTS),
            contacts(study),
        ]);
    }
    let failed = study.points.iter().filter_map(|point| Some((point, point.result.as_ref().err()?)));
    for (point, why) in failed {
        blocks.push(text(format!("{} {} failed: {why}.", point.lever.name(), point.label)));
    }
}

const OF_PROMISE: &str = "What default steps promise, and tolerances alone that are tried beside them: errors of means over the second half of \
    the run over 1 %, and of histories but that of the torque over 2 %, the largest of all. A star marks the cheapest tolerance that keeps it. \
    Evaluations of contacts with derivatives count as three.";

/// Steps and tolerances -> error over the promise -> evaluations.
fn promise(regret: &Regret) -> Block {
    let header = [
        "steps",
        "kept",
        "error over the promise",
        "history of the torque",
        "evaluations",
        "cost over the cheapest",
    ];
    let cheapest = regret.cheapest().map(|(tried, _)| tried);
    let row = |tried: &Tried| {
        let star = if cheapest.is_some_and(|cheapest| std::ptr::eq(cheapest, tried)) { " *" } else { "" };
        let mut row = vec![format!("{}{star}", tried.label)];
        match &tried.result {
            Ok(judged) => row.extend([
                if judged.keeps() { "yes" } else { "no" }.into(),
                format!("{:.2}", judged.over),
                number(Some(judged.torque)),
                judged.evaluations.to_string(),
                regret.of(judged).map(|regret| format!("{regret:.2}")).unwrap_or_default(),
            ]),
            Err(_) => row.push("failed".into()),
        }
        row.resize(header.len(), String::new());
        row
    };
    let rows = regret.steps.iter().chain(&regret.tolerances).map(row).collect();
    Block::Table { header: header.map(String::from).to_vec(), rows }
}

const OF_CONTACTS: &str = "Model error of single contacts, which no goal promises anything of: friction power of the races over that of \
    all contacts, share of the power that is spin (difference of the shares), largest load and peak pressure of a contact. \
    Numerical errors of these are in `cost.csv`.";

/// Model errors of single contacts.
fn contacts(study: &SceneStudy) -> Block {
    let shown: Vec<Norm> = Norm::VARIANTS.iter().copied().filter(|norm| norm.is_of_contacts()).collect();
    let header = ["lever", "setting"].into_iter().chain(shown.iter().map(|norm| norm.name()));
    let errors = |errors: &Errors| shown.iter().map(|&norm| number(errors.get(norm))).collect::<Vec<_>>();
    let row = |lever: &str, label: &str, errors: Vec<String>| {
        [lever.to_string(), label.to_string()].into_iter().chain(errors).collect::<Vec<_>>()
    };
    let bar = row("reference", "error bar", errors(study.error_bar(ReferenceKind::Model)));
    let rows = study.points_of(ReferenceKind::Model).filter_map(|point| {
        Some(row(point.lever.name(), &point.label, errors(&point.result.as_ref().ok()?.errors)))
    });
    Block::Table {
        header: header.map(String::from).collect(),
        rows: std::iter::once(bar).chain(rows).collect(),
    }
}

/// setting -> error -> CPU time -> work.
fn points(study: &SceneStudy, kind: ReferenceKind, norms: &[Norm]) -> Block {
    let measured = |point: &Point| point.result.as_ref().ok().cloned();
    let shown: Vec<Norm> = norms
        .iter()
        .copied()
        .filter(|&norm| study.points_of(kind).filter_map(measured).any(|m| m.errors.get(norm).is_some()))
        .collect();
    let instructions = study.points_of(kind).filter_map(measured).any(|m| m.instructions.is_some());
    let mut header = vec!["lever".to_string(), "setting".to_string()];
    header.extend(shown.iter().map(|norm| norm.name().to_string()));
    header.extend(["largest", "CPU [s/s]"].map(String::from));
    if instructions {
        header.push("instructions [1/s]".into());
    }
    header.extend(["steps", "rejected", "iterations", "matrices", "contacts"].map(String::from));
    let errors = |errors: &Errors| -> Vec<String> {
        shown.iter().map(|&norm| number(errors.get(norm))).chain([number(errors.worst())]).collect()
    };
    let mut bar = vec!["reference".to_string(), "error bar".to_string()];
    bar.extend(errors(study.error_bar(kind)));
    bar.resize(header.len(), String::new());
    let front = study.pareto(kind, None);
    let row = |point: &Point| {
        let star = if front.iter().any(|(other, _, _)| std::ptr::eq(*other, point)) { " *" } else { "" };
        let mut row = vec![point.lever.name().to_string(), format!("{}{star}", point.label)];
        let Ok(measured) = &point.result else {
            row.push("failed".into());
            row.resize(header.len(), String::new());
            return row;
        };
        row.extend(errors(&measured.errors));
        row.push(format!("{:.3}", measured.cpu));
        if instructions {
            row.push(number(measured.instructions));
        }
        let work = &measured.work;
        let contacts = work.contact_values + work.contact_tangents;
        let rejected = work.rejected_error + work.rejected_newton;
        let counts = [work.steps, rejected, work.newton.iterations, work.newton.factorisations, contacts];
        row.extend(counts.map(|count| count.to_string()));
        row
    };
    let rows = std::iter::once(bar).chain(study.points_of(kind).map(row)).collect();
    Block::Table { header, rows }
}

fn number(value: Option<f64>) -> String {
    match value {
        Some(0.0) => "0".into(),
        Some(value) => format!("{value:.1e}"),
        None => String::new(),
    }
}

/// Processor and system, as far as they are known.
fn machine() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        let line = info.lines().find(|line| line.starts_with(name))?;
        line.split_once(':').map(|(_, value)| value.trim().to_string())
    };
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let processor = field("model name").unwrap_or_else(|| "an unnamed processor".into());
    format!("{processor}, {cores} cores, {} {}", std::env::consts::OS, std::env::consts::ARCH)
}
