//! `roulement rating`: the life under given loads, each with its speed and its share of the time.

use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::PathBuf;

use clap::Args;
use roulement::model::bodies::Race;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement_cli::sweep::cases::Cases;

use super::{load, say, tell};

/// Column of the shares of the time.
const SHARE: &str = "share";
/// [-] difference of the sum of the shares from 1 from which on it is told: they are rounded to two digits.
const ROUNDED: f64 = 0.011;

/// Options of `roulement rating`.
#[derive(Args)]
pub struct Options {
    /// Scene file of a bearing, or of a shaft with its bearings.
    scene: PathBuf,
    /// Table of loads: a column `share` of the time, and keys of the scene such as `load.inner_speed [rpm]` and `load.y.force [kN]`, as
    /// `roulement sweep` has them.
    #[arg(long)]
    loads: PathBuf,
}

/// A life of a bearing, or what it came to under all loads.
#[derive(Default)]
struct Rated {
    /// [-] share of the time.
    share: f64,
    /// [rad/s] speed of the races against each other, its mean.
    speed: f64,
    /// \[N] dynamic equivalent reference load.
    equivalent_load: f64,
    /// [million revolutions] reference and modified life.
    lives: [Option<f64>; 2],
    /// [-] least static safety.
    safety: f64,
}

/// Finds the equilibrium and the life under each of the loads, adds them up, and prints CSV.
///
/// # Errors
/// If a load has no equilibrium, or the table is none.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let base = load(&options.scene)?;
    let mut cases = Cases::load(&options.loads)?;
    let file = options.loads.display();
    let column = cases.keys.iter().position(|key| key.name == SHARE);
    let Some(column) = column else {
        return Err(
            format!("{file}: a column `{SHARE}` is missing: the share of the time that a load has").into()
        );
    };
    let shares = cases.rows.iter().enumerate().map(|(row, cells)| {
        let share = cells.get(column).and_then(|cell| cell.as_ref()).map_or("", |cell| cell.shown.as_str());
        let wrong =
            || format!("{file}, load {}: {SHARE} = {share} is out of range: a number above 0", row + 1);
        share.parse().ok().filter(|share| f64::is_finite(*share) && *share > 0.0).ok_or_else(wrong)
    });
    let shares = shares.collect::<Result<Vec<f64>, _>>()?;
    // All other columns are keys of the scene.
    cases.keys.remove(column);
    cases.rows.iter_mut().filter(|row| row.len() > column).for_each(|row| {
        row.remove(column);
    });
    let whole: f64 = shares.iter().sum();
    tell(
        ((whole - 1.0).abs() > ROUNDED)
            .then(|| format!("note: the shares come to {whole}; each is taken of that")),
    );
    let mut text = "load,bearing,share,speed [rpm],equivalent_load [N],L10r [1e6],L10r [h],modified [1e6],modified [h],static_safety\n".to_string();
    let mut all: BTreeMap<String, Vec<Rated>> = BTreeMap::new();
    for (row, share) in shares.iter().enumerate() {
        let failed = |why: &dyn Error| format!("{file}, load {}: {why}", row + 1);
        let scene = cases.text_of(base.source(), row).map_err(|why| failed(&why))?;
        let mut scene = MachineScene::edited(&scene).map_err(|why| failed(&why))?;
        scene.bearings_mut().for_each(|bearing| {
            bearing.effects.rating.section.get_or_insert_default();
        });
        let machine = Machine::new(&scene).map_err(|why| failed(&why))?;
        for (name, simulation) in machine.bearings() {
            let outputs = simulation.outputs();
            let Some(life) = outputs.life else { continue };
            let spin = |race: Race| {
                (outputs[race].pose.orientation.inverse() * outputs[race].twist.angular_velocity).x
            };
            let speed = (spin(Race::Inner) - spin(Race::Outer)).abs();
            let rated = Rated {
                share: share / whole,
                speed,
                equivalent_load: life.equivalent_load,
                lives: [Some(life.reference), life.modified],
                safety: life.static_safety,
            };
            say_row(&mut text, &(row + 1).to_string(), name, &rated);
            all.entry(name.to_string()).or_default().push(rated);
        }
    }
    for (name, rated) in &all {
        say_row(&mut text, "all", name, &together(rated));
    }
    Ok(say(&text)?)
}

/// Rating under several loads in turn: each takes its revolutions over its life from the whole (Palmgren 1924; Miner 1945).
fn together(rated: &[Rated]) -> Rated {
    let speed: f64 = rated.iter().map(|of| of.share * of.speed).sum();
    let lives = [0, 1].map(|which| {
        let used = rated.iter().map(|of| of.lives[which].map(|life| of.share * of.speed / life));
        used.sum::<Option<f64>>().map(|used| speed / used)
    });
    // C over the cube root of the life, as of one load.
    let rating = rated.first().and_then(|of| Some(of.equivalent_load * of.lives[0]?.cbrt()));
    let equivalent_load = rating.zip(lives[0]).map_or(0.0, |(rating, life)| rating / life.cbrt());
    let safety = rated.iter().map(|of| of.safety).fold(f64::INFINITY, f64::min);
    Rated { share: rated.iter().map(|of| of.share).sum(), speed, equivalent_load, lives, safety }
}

fn say_row(text: &mut String, load: &str, bearing: &str, rated: &Rated) {
    let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let hours = |life: Option<f64>| {
        life.filter(|_| rated.speed > 0.0).map(|life| life * 1e6 * TAU / rated.speed / 3600.0)
    };
    let [reference, modified] = rated.lives;
    let numbers = [
        Some(rated.share),
        Some(rated.speed * 30.0 / PI),
        Some(rated.equivalent_load),
        reference,
        hours(reference),
        modified,
        hours(modified),
        Some(rated.safety),
    ];
    text.push_str(&format!("{load},{bearing},{}\n", numbers.map(cell).join(",")));
}
