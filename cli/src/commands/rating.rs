//! `roulement rating`: the life under several loads, each with its part of the time: those of a table, or of the `[[duty]]` of the scene.

use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use clap::Args;
use roulement::effects::rating::life_of_all;
use roulement::model::bodies::Race;
use roulement::scene::machine::MachineScene;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::LinkOutputs;
use roulement_cli::sweep::cases::Cases;

use super::{load, say, tell};

/// Column of the shares of the time.
const SHARE: &str = "share";
/// [-] difference of the sum of the shares from 1 from which on it is told: they are rounded to two digits.
const ROUNDED: f64 = 0.011;
/// Name of the machine in the column of its bearings.
const MACHINE: &str = "(machine)";

/// Options of `roulement rating`.
#[derive(Args)]
pub struct Options {
    /// Scene file of a bearing, or of a shaft with its bearings.
    scene: PathBuf,
    /// Table of loads: a column `share` of the time, and keys of the scene such as `load.inner_speed [rpm]` and `load.y.force [kN]`, as
    /// `roulement sweep` has them; the scene's own `[[duty]]` if not given.
    #[arg(long)]
    loads: Option<PathBuf>,
}

/// A load of the duty.
struct Load {
    /// Its name, or the number of its row.
    name: String,
    /// Its part of the whole, in whatever unit that has.
    part: f64,
    /// The scene under it.
    scene: MachineScene,
}

/// All loads.
struct Duty {
    loads: Vec<Load>,
    /// Where they are from, before the name of one of them.
    from: String,
    /// Are their parts hours?
    by_hours: bool,
}

impl Duty {
    /// Loads of a table.
    fn of_table(path: &Path, base: &MachineScene) -> Result<Self, Box<dyn Error>> {
        let mut cases = Cases::load(path)?;
        let file = path.display();
        let column = cases.keys.iter().position(|key| key.name == SHARE);
        let Some(column) = column else {
            return Err(format!(
                "{file}: a column `{SHARE}` is missing: the share of the time that a load has"
            )
            .into());
        };
        let shares = cases.rows.iter().enumerate().map(|(row, cells)| {
            let share =
                cells.get(column).and_then(|cell| cell.as_ref()).map_or("", |cell| cell.shown.as_str());
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
        let from = format!("{file}, load ");
        let scene =
            |row: usize| cases.text_of(base.source(), row).and_then(|text| MachineScene::edited(&text));
        let load = |(row, part): (usize, &f64)| {
            let scene = scene(row).map_err(|why| format!("{from}{}: {why}", row + 1))?;
            Ok(Load { name: (row + 1).to_string(), part: *part, scene })
        };
        let loads = shares.iter().enumerate().map(load).collect::<Result<_, String>>()?;
        Ok(Self { loads, from, by_hours: false })
    }

    /// Loads of the scene itself.
    fn of_scene(base: &MachineScene) -> Result<Self, Box<dyn Error>> {
        let duty = base.duty();
        let Some(first) = duty.first() else {
            return Err("there are no loads: give a table by --loads, or entries [[duty]] in the scene, each with name, share or hours, and \
                        the keys that it sets"
                .into());
        };
        let by_hours = first.hours.is_some();
        let from = "duty ".to_string();
        let load = |of: &roulement::scene::DutySection| {
            let scene = base.under(of).map_err(|why| format!("{from}{}: {why}", of.name))?;
            Ok(Load { name: of.name.clone(), part: of.part(), scene })
        };
        let loads = duty.iter().map(load).collect::<Result<_, String>>()?;
        Ok(Self { loads, from, by_hours })
    }
}

/// A life of a bearing, or what it came to under all loads.
#[derive(Clone, Default)]
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
    /// [-] power of the load that a life goes by: 3 of balls, 10/3 of rollers (ISO 281).
    exponent: f64,
    /// [N m] friction torque, its mean; none of rollers, whose friction is not simulated.
    torque: Option<f64>,
    /// \[W] all losses, their mean; likewise.
    loss: Option<f64>,
}

impl Rated {
    /// \[h] reference and modified life.
    fn hours(&self) -> [Option<f64>; 2] {
        self.lives
            .map(|life| life.filter(|_| self.speed > 0.0).map(|life| life * 1e6 * TAU / self.speed / 3600.0))
    }

    /// [1/h] part of the life that an hour takes, of the modified one where it is known.
    fn used(&self) -> f64 {
        let [reference, modified] = self.hours();
        modified.or(reference).map_or(0.0, |hours| 1.0 / hours)
    }
}

/// Finds the equilibrium and the life under each of the loads, adds them up, and prints CSV.
///
/// # Errors
/// If a load has no equilibrium, or there are none.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let base = load(&options.scene)?;
    let duty = match &options.loads {
        Some(path) => Duty::of_table(path, &base)?,
        None => Duty::of_scene(&base)?,
    };
    let whole: f64 = duty.loads.iter().map(|load| load.part).sum();
    let odd = !duty.by_hours && (whole - 1.0).abs() > ROUNDED;
    tell(odd.then(|| format!("note: the shares come to {whole}; each is taken of that")));
    let mut text = "load,bearing,share,speed [rpm],equivalent_load [N],L10r [1e6],L10r [h],modified [1e6],modified [h],static_safety,\
                    friction_torque [N m],loss [W],damage\n"
        .to_string();
    let mut all: BTreeMap<String, Vec<Rated>> = BTreeMap::new();
    for Load { name: of_load, part, scene } in &duty.loads {
        let mut scene = scene.clone();
        scene.bearings_mut().for_each(|bearing| {
            bearing.effects.rating.section.get_or_insert_default();
        });
        let machine = Machine::new(&scene).map_err(|why| format!("{}{of_load}: {why}", duty.from))?;
        let mut here = vec![];
        for (name, simulation) in machine.bearings() {
            let outputs = simulation.outputs();
            let Some(life) = outputs.life else { continue };
            let spin = |race: Race| {
                (outputs[race].pose.orientation.inverse() * outputs[race].twist.angular_velocity).x
            };
            let rated = Rated {
                share: part / whole,
                speed: (spin(Race::Inner) - spin(Race::Outer)).abs(),
                equivalent_load: life.equivalent_load,
                lives: [Some(life.reference), life.modified],
                safety: life.static_safety,
                exponent: 3.0,
                torque: Some(outputs.friction_torque.abs()),
                loss: Some(outputs.losses.total()),
            };
            here.push((name.to_owned(), rated));
        }
        here.extend(of_rollers(&scene, &machine, part / whole));
        for (name, rated) in &here {
            let damage = duty.by_hours.then(|| part * rated.used());
            say_row(&mut text, of_load, name, rated, damage);
            all.entry(name.clone()).or_default().push(rated.clone());
        }
        let here: Vec<Rated> = here.into_iter().map(|(_, rated)| rated).collect();
        say_machine(&mut text, of_load, &here, duty.by_hours.then_some(*part));
    }
    let together: Vec<(&String, Rated)> = all.iter().map(|(name, rated)| (name, together(rated))).collect();
    for (name, of_all) in &together {
        say_row(&mut text, "all", name, of_all, duty.by_hours.then(|| whole * of_all.used()));
    }
    let of_all: Vec<Rated> = together.into_iter().map(|(_, rated)| rated).collect();
    say_machine(&mut text, "all", &of_all, duty.by_hours.then_some(whole));
    let without = all.values().flatten().any(|rated| rated.loss.is_none());
    tell(without.then(|| "note: rollers have no friction here: their torques and losses are empty, and those of the machine are without them".to_owned()));
    tell(all.iter().filter_map(|(name, rated)| worst(&duty, name, rated)));
    Ok(say(&text)?)
}

/// Roller bearings of a machine.
fn of_rollers(scene: &MachineScene, machine: &Machine, share: f64) -> Vec<(String, Rated)> {
    let (MachineScene::Shaft(scene), Machine::Shaft(system)) = (scene, machine) else { return vec![] };
    let links = scene.link_names().zip(&system.outputs().links);
    let of = |(name, link): (&str, &LinkOutputs)| {
        let rollers = link.rollers.as_ref()?;
        let rated = Rated {
            share,
            speed: link.state.rate[3].abs(),
            equivalent_load: rollers.equivalent_load,
            lives: [Some(rollers.life), None],
            safety: rollers.static_safety,
            exponent: 10.0 / 3.0,
            torque: None,
            loss: None,
        };
        Some((name.to_owned(), rated))
    };
    links.filter_map(of).collect()
}

/// Which load takes most of a bearing's life.
fn worst(duty: &Duty, bearing: &str, rated: &[Rated]) -> Option<String> {
    let taken = |of: &Rated| of.share * of.used();
    let whole: f64 = rated.iter().map(taken).sum();
    let (place, most) = rated.iter().map(taken).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let name = &duty.loads.get(place)?.name;
    let who = if bearing.is_empty() { String::new() } else { format!("bearing {bearing}: ") };
    (rated.len() > 1 && whole > 0.0)
        .then(|| format!("note: {who}load {name} takes most of the life, {:.0} %", 100.0 * most / whole))
}

/// Rating under several loads in turn: each takes its revolutions over its life from the whole (Palmgren 1924; Miner 1945).
fn together(rated: &[Rated]) -> Rated {
    let speed: f64 = rated.iter().map(|of| of.share * of.speed).sum();
    let lives = [0, 1].map(|which| {
        let used = rated.iter().map(|of| of.lives[which].map(|life| of.share * of.speed / life));
        used.sum::<Option<f64>>().map(|used| speed / used)
    });
    // C over the root of the life, as of one load.
    let exponent = rated.first().map_or(3.0, |of| of.exponent);
    let root = |life: f64| life.powf(1.0 / exponent);
    let rating = rated.first().and_then(|of| Some(of.equivalent_load * root(of.lives[0]?)));
    let equivalent_load = rating.zip(lives[0]).map_or(0.0, |(rating, life)| rating / root(life));
    let safety = rated.iter().map(|of| of.safety).fold(f64::INFINITY, f64::min);
    let mean = |get: fn(&Rated) -> Option<f64>| rated.iter().map(|of| Some(of.share * get(of)?)).sum();
    Rated {
        share: rated.iter().map(|of| of.share).sum(),
        speed,
        equivalent_load,
        lives,
        safety,
        exponent,
        torque: mean(|of| of.torque),
        loss: mean(|of| of.loss),
    }
}

fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

fn say_row(text: &mut String, load: &str, bearing: &str, rated: &Rated, damage: Option<f64>) {
    let [reference, modified] = rated.lives;
    let [reference_hours, modified_hours] = rated.hours();
    let numbers = [
        Some(rated.share),
        Some(rated.speed * 30.0 / PI),
        Some(rated.equivalent_load),
        reference,
        reference_hours,
        modified,
        modified_hours,
        Some(rated.safety),
        rated.torque,
        rated.loss,
        damage,
    ];
    text.push_str(&format!("{load},{bearing},{}\n", numbers.map(cell).join(",")));
}

/// Row of all bearings of a machine together, where there are several: the life that nine of ten machines reach, in hours.
fn say_machine(text: &mut String, load: &str, bearings: &[Rated], hours: Option<f64>) {
    if bearings.len() < 2 {
        return;
    }
    let lives = [0, 1].map(|which| life_of_all(bearings.iter().map(|of| of.hours()[which])));
    let [reference, modified] = lives;
    let numbers = [
        bearings.first().map(|of| of.share),
        None,
        None,
        None,
        reference,
        None,
        modified,
        Some(bearings.iter().map(|of| of.safety).fold(f64::INFINITY, f64::min)),
        None,
        Some(bearings.iter().filter_map(|of| of.loss).sum()),
        hours.and_then(|hours| Some(hours / modified.or(reference)?)),
    ];
    text.push_str(&format!("{load},{MACHINE},{}\n", numbers.map(cell).join(",")));
}
