//! What a file is, what it would run, and how long that would take.

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use roulement::analysis::auto;
use roulement::catalogue::Shelf;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::play::{Rows, play};

use crate::clock::ThreadTime;
use crate::kinds::Kind;
use crate::sweep::all::threads as cores;
use crate::sweep::cases::Cases;
use crate::{rexs, system};

/// Words before the reason that a run stops.
const STOPS: &str = "error: a run stops:";
/// \[s] CPU time that is spent on finding out how long a run takes.
const TRIED: f64 = 0.5;
/// [-] rows at which a trial may end.
const PIECES: f64 = 1e4;

/// A file that was looked at.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Its kind in words.
    pub kind: String,
    /// What is in it, notes and errors, a line each.
    pub lines: Vec<String>,
    /// Can it be read, and does its run not stop?
    pub good: bool,
}

/// Looks at a file.
pub fn check(path: &Path) -> Checked {
    let (lines, good) = match lines_of(path) {
        Ok(lines) => {
            let good = !lines.iter().any(|line| line.starts_with(STOPS));
            (lines, good)
        }
        Err(why) => (vec![format!("error: {why}")], false),
    };
    let kind = Kind::of(path)
        .map_or_else(|| "no kind of file that is known here".to_owned(), |kind| kind.to_string());
    Checked { kind, lines, good }
}

/// What is in a file.
fn lines_of(path: &Path) -> Result<Vec<String>, Box<dyn Error>> {
    match Kind::of(path) {
        Some(Kind::Sweep) => sweep(path),
        Some(Kind::System) => {
            Ok(vec![system::summary(path)?, format!("roulement system {} -o FOLDER", path.display())])
        }
        Some(Kind::Rexs) => {
            let found = rexs::import(path)?;
            let notes = found.notes.into_iter().map(|note| format!("note: {note}"));
            Ok([found.summary].into_iter().chain(notes).collect())
        }
        Some(Kind::Shelf) => {
            let names = Shelf::load(path)?.names().map(str::to_owned).collect::<Vec<_>>();
            Ok(vec![format!("{} bearings: {}", names.len(), names.join(", "))])
        }
        Some(kind @ (Kind::Package | Kind::Csv | Kind::Results)) => {
            Ok(vec![format!("commands that take it: {}", kind.commands())])
        }
        // Why it is none stands in the error.
        _ => scene(path),
    }
}

/// \[s] CPU time of a whole run, and the part of it \[s] that was played.
fn time_of(scene: &MachineScene) -> Result<(f64, f64), Box<dyn Error>> {
    let mut machine = Machine::new(scene)?;
    let begin = ThreadTime::now();
    let rows = Rows::new(scene.duration() / PIECES, scene.duration());
    let taken = |_: &Machine| match begin.elapsed().as_secs_f64() > TRIED {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let _ = play(&mut machine, rows, taken)?;
    let played = machine.time();
    Ok((begin.elapsed().as_secs_f64() * scene.duration() / played, played))
}

/// A time in words.
fn words(time: f64) -> String {
    match time {
        time if time < 100.0 => format!("{time:.1} s"),
        time if time < 6000.0 => format!("{:.0} min", time / 60.0),
        time => format!("{:.1} h", time / 3600.0),
    }
}

/// \[s] CPU time of a run, and a line about it; a run that stops has no time.
fn time_line(scene: &MachineScene) -> (Option<f64>, String) {
    let (time, played) = match time_of(scene) {
        Ok(found) => found,
        Err(why) => return (None, format!("{STOPS} {why}")),
    };
    let how = match played >= scene.duration() {
        true => "the whole of it was run".to_owned(),
        false => format!("by its first {:.3} ms", played * 1e3),
    };
    (Some(time), format!("time: about {} of CPU ({how})", words(time)))
}

fn scene(path: &Path) -> Result<Vec<String>, Box<dyn Error>> {
    let scene = MachineScene::load(path)?;
    let mut lines = scene.notes();
    let (scene, found_out) = auto::resolve_machine(scene, false)?;
    lines.extend(found_out);
    let of = match &scene {
        MachineScene::Bearing(scene) => format!("one bearing of {} balls", scene.bearing.balls),
        MachineScene::Shaft(system) => [
            (system.shafts.len(), "shaft", "shafts"),
            (system.bearings.len(), "bearing", "bearings"),
            (system.meshes.len(), "mesh", "meshes"),
            (
                system.springs.len(),
                "bearing or coupling without states",
                "bearings and couplings without states",
            ),
            (system.housings.len(), "housing", "housings"),
        ]
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, one, several)| format!("{count} {}", if count == 1 { one } else { several }))
        .collect::<Vec<_>>()
        .join(", "),
    };
    let rows = Rows::of_scene(&scene);
    lines.insert(
        0,
        format!("{of}; roulement run simulates {:.3} ms in {} rows", rows.duration * 1e3, rows.count() + 1),
    );
    lines.push(time_line(&scene).1);
    Ok(lines)
}

fn sweep(path: &Path) -> Result<Vec<String>, Box<dyn Error>> {
    let cases = Cases::load(path)?;
    let keys: Vec<&str> = cases.keys.iter().map(|key| key.name.as_str()).collect();
    let mut lines = vec![format!("{} cases over {}", cases.rows.len(), keys.join(", "))];
    let Some(base) = &cases.scene else {
        lines.push("no base scene: name it by --scene".into());
        return Ok(lines);
    };
    let text = cases.text_of(MachineScene::load(base)?.source(), 0)?;
    let first = MachineScene::edited(&text).map_err(|why| format!("case 1: {why}"))?;
    lines.push(format!("base scene {}", base.display()));
    let (time, line) = time_line(&first);
    lines.push(format!("its first case: {line}"));
    let all = time.map(|time| time * cases.rows.len() as f64 / cores() as f64);
    lines.extend(all.map(|all| format!("roulement sweep takes about {} on {} cores", words(all), cores())));
    Ok(lines)
}
