//! Life, safety and losses of a bearing under a load, and under several in turn.

use std::f64::consts::TAU;

use roulement::scene::machine::MachineScene;
use roulement::simulation::Simulation;
use roulement::simulation::machine::Machine;
use roulement::simulation::system::LinkOutputs;

/// A life of a bearing, or what it came to under all loads.
#[derive(Clone, Debug, Default)]
pub struct Rated {
    /// [-] share of the time.
    pub share: f64,
    /// [rad/s] speed of the races against each other, its mean.
    pub speed: f64,
    /// \[N] dynamic equivalent reference load.
    pub equivalent_load: f64,
    /// [million revolutions] reference and modified life.
    pub lives: [Option<f64>; 2],
    /// [-] least static safety.
    pub safety: f64,
    /// [-] power of the load that a life goes by: 3 of balls, 10/3 of rollers (ISO 281).
    pub exponent: f64,
    /// [N m] friction torque, its mean; none of rollers without friction.
    pub torque: Option<f64>,
    /// \[W] all losses, their mean; likewise.
    pub loss: Option<f64>,
}

impl Rated {
    /// \[h] reference and modified life.
    pub fn hours(&self) -> [Option<f64>; 2] {
        self.lives
            .map(|life| life.filter(|_| self.speed > 0.0).map(|life| life * 1e6 * TAU / self.speed / 3600.0))
    }

    /// [1/h] part of the life that an hour takes, of the modified one where it is known.
    pub fn used(&self) -> f64 {
        let [reference, modified] = self.hours();
        modified.or(reference).map_or(0.0, |hours| 1.0 / hours)
    }
}

/// All bearings of a machine at its start, balls first, with their share of the time.
pub fn found(scene: &MachineScene, machine: &Machine, share: f64) -> Vec<(String, Rated)> {
    let balls =
        machine.bearings().filter_map(|(name, bearing)| Some((name.to_owned(), of_balls(bearing, share)?)));
    balls.chain(of_rollers(scene, machine, share)).collect()
}

/// A machine all of whose bearings have a life, with its scene.
///
/// # Errors
/// If it has no equilibrium; says why.
pub fn with_lives(mut scene: MachineScene) -> Result<(MachineScene, Machine), String> {
    scene.bearings_mut().for_each(|bearing| {
        bearing.effects.rating.section.get_or_insert_default();
    });
    scene.check().map_err(|why| why.to_string())?;
    let machine = Machine::new(&scene).map_err(|why| why.to_string())?;
    Ok((scene, machine))
}

/// A ball bearing.
fn of_balls(bearing: &Simulation, share: f64) -> Option<Rated> {
    let outputs = bearing.outputs();
    let life = outputs.life?;
    Some(Rated {
        share,
        speed: outputs.relative_speed().abs(),
        equivalent_load: life.equivalent_load,
        lives: [Some(life.reference), life.modified],
        safety: life.static_safety,
        exponent: 3.0,
        torque: Some(outputs.torque_of_losses()),
        loss: Some(outputs.losses.total()),
    })
}

/// Roller bearings of a machine.
pub(super) fn of_rollers(scene: &MachineScene, machine: &Machine, share: f64) -> Vec<(String, Rated)> {
    let (MachineScene::Shaft(scene), Machine::Shaft(system)) = (scene, machine) else { return vec![] };
    let links = scene.link_names().zip(&system.outputs().links);
    let of = |(name, link): (&str, &LinkOutputs)| {
        let rollers = link.rollers()?;
        let rated = Rated {
            share,
            speed: link.speed()?,
            equivalent_load: rollers.equivalent_load,
            lives: [Some(rollers.life), None],
            safety: rollers.static_safety,
            exponent: 10.0 / 3.0,
            torque: rollers.friction.map(|friction| friction.torque()),
            loss: rollers.friction.map(|friction| friction.loss),
        };
        Some((name.to_owned(), rated))
    };
    links.filter_map(of).collect()
}

/// Rating under several loads in turn: each takes its revolutions over its life from the whole (Palmgren 1924; Miner 1945).
pub fn together(rated: &[Rated]) -> Rated {
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
    let mean = |get: fn(&Rated) -> Option<f64>| rated.iter().map(|of| Some(of.share * get(of)?)).sum();
    Rated {
        share: rated.iter().map(|of| of.share).sum(),
        speed,
        equivalent_load,
        lives,
        safety: rated.iter().map(|of| of.safety).fold(f64::INFINITY, f64::min),
        exponent,
        torque: mean(|of| of.torque),
        loss: mean(|of| of.loss),
    }
}
