//! Gatherer of a shaft with its housings in a run: means, energy, and rows that its error is told from.

use roulement::contact::REGULARISATION_SPEED;
use roulement::model::structure::StructureEnergies;
use roulement::simulation::losses::LOSSES;
use roulement::simulation::system::{ShaftOutputs, System};

use super::bearing::lengths;
use super::part::{PartSeen, PartWatch};
use crate::error::{Course, Lengths, Sample};
use crate::report::energy::{ROUNDING, TOLERANCE};
use crate::report::figures::Figures;
use crate::report::losses::Sums as LossSums;
use crate::report::means::Blocks;
use crate::report::quantities::ShaftQuantities;

/// [-] of the largest force in a bearing, at its pitch radius: a torque of no account.
const NOTHING: f64 = 1e-6;

/// Gathers while shafts run.
pub struct ShaftWatch {
    part: PartWatch,
    quantities: ShaftQuantities,
    /// \[N] largest load of a ball of any bearing.
    largest_load: f64,
}

/// Gathered figures of shafts.
pub struct ShaftSeen {
    /// Figures that every part of a machine has; losses are those of the whole machine.
    pub part: PartSeen,
    largest_load: f64,
}

impl ShaftWatch {
    /// Gatherer of shafts that have not been played yet.
    pub fn of(system: &System) -> Self {
        let quantities = ShaftQuantities::of(system);
        let (scene, arm) = (system.scene(), lengths_of(system).pitch_radius);
        let blocks = Blocks::new(quantities.watched(), arm, scene.load.duration.0);
        Self { part: PartWatch::new(blocks, &scene.phases, &[], arm), quantities, largest_load: 0.0 }
    }

    /// Takes the start, or where a step has ended, with the losses of its bearings so far.
    pub fn step(&mut self, system: &System, bearings: impl Iterator<Item = LossSums>) {
        let values = self.quantities.values(system);
        let weights = vec![1.0; values.len()];
        self.part.step((system.time(), &values, &weights), [0.0; 3], &Vec::new, None);
        self.part.losses.step_of_shaft(system, bearings);
    }

    /// Takes a row.
    pub fn push(&mut self, system: &System) {
        let values = self.quantities.values(system);
        self.part.push(Sample { time: system.time(), values, largest_load: 0.0 });
        let loads = system.bearings().flat_map(|(_, bearing)| bearing.outputs().loads());
        self.largest_load = loads.fold(self.largest_load, f64::max);
    }

    /// All of it, at the end. Does a script, of a shaft or of a bearing, come to other values within a span \[s] of time?
    pub fn finish(self, changes: &dyn Fn(f64, f64) -> bool) -> ShaftSeen {
        ShaftSeen { part: self.part.finish(None, changes), largest_load: self.largest_load }
    }
}

impl ShaftSeen {
    /// Figures of the summary of a run that ended so: the variables at the end, energies, and means.
    pub fn figures(&self, system: &System) -> Figures {
        let quantities = ShaftQuantities::of(system);
        let mut figures = Figures::default();
        for (watched, value) in quantities.watched().into_iter().zip(quantities.values(system)) {
            figures.set(format!("end {}", watched.name), value);
        }
        for (name, energies) in energies(system) {
            let mut set = |what: &str, value| figures.set(format!("{name} {what}"), value);
            set("put in", energies.input);
            set("to bearings", energies.bearings);
            set("damped", energies.damping);
            set("balance", energies.unaccounted());
        }
        if let Some(means) = &self.part.means {
            figures.add_means(means);
        }
        self.part.phases.iter().for_each(|phase| figures.add_phase(phase));
        if let Some(closed) = &self.part.closed {
            figures.set(LOSSES[0].name, closed.lost);
        }
        figures
    }

    /// Warnings for whoever reads results of this run, a sentence each.
    pub fn warnings(&self, system: &System) -> Vec<String> {
        let unaccounted = |(name, energies): (String, &StructureEnergies)| {
            let (left, mut all) = (energies.unaccounted(), energies.turned_over());
            if name == RINGS {
                // Next to nothing goes through them.
                let shafts = system.outputs().shafts.iter().map(|own| own.energies.turned_over());
                all = shafts.fold(all, f64::max);
            }
            (left.abs() > (TOLERANCE * all).max(ROUNDING * energies.stored)).then(|| {
                format!(
                    "energy of the {name} does not close to 1 %: {left:.3e} J, {:.2} % of what was put in, given to bearings or lost; \
                     lower solver.max_step = {:e} s",
                    100.0 * left / all,
                    system.scene().solver().max_step.0
                )
            })
        };
        creeping(system).into_iter().chain(energies(system).filter_map(unaccounted)).collect()
    }

    /// Sample for comparison with other runs; its rows move there.
    pub fn take_course(&mut self, system: &System) -> Course {
        let lengths = lengths_of(system);
        let torque = NOTHING * self.largest_load * lengths.pitch_radius;
        let figures = self.figures(system);
        self.part.take_course("", lengths, torque, figures)
    }
}

/// Outer rings that slide in the ground.
const RINGS: &str = "rings that slide";

/// Energies of the shafts, of every housing and of rings in the ground, by name.
fn energies(system: &System) -> impl Iterator<Item = (String, &StructureEnergies)> {
    let outputs = system.outputs();
    let housings = system.scene().housings.iter().zip(&outputs.housings);
    let housings = housings.map(|(housing, own)| (format!("housing {}", housing.name), &own.energies));
    let ground = outputs.ground.iter().map(|own| (RINGS.to_string(), own));
    let shafts = system.scene().shafts.iter().zip(&outputs.shafts);
    shafts.map(|(shaft, own)| (shaft.name.clone(), &own.energies)).chain(housings).chain(ground)
}

/// Those of the smallest bearing.
fn lengths_of(system: &System) -> Lengths {
    let all = system.bearings().map(|(_, bearing)| lengths(bearing));
    let smaller = |a: Lengths, b: Lengths| if b.pitch_radius < a.pitch_radius { b } else { a };
    all.reduce(smaller).unwrap_or(Lengths { pitch_radius: 1.0, ball_diameter: 1.0 })
}

/// Warning of a shaft that creeps under a torque which its friction holds; none of one that moves or is driven by a speed.
fn creeping(system: &System) -> Option<String> {
    // Of several shafts, one that another drives creeps under no torque of its own.
    let [ShaftOutputs { spin, torque, .. }] = &system.outputs().shafts[..] else { return None };
    system.scene().shafts[0].torque.as_ref()?;
    let torque = *torque;
    let held: f64 = system.bearings().map(|(_, bearing)| bearing.outputs().friction_torque).sum();
    // A ball's centre goes half as fast as the shaft's surface, and rolls as fast on both races.
    let rolling = system.bearings().map(|(_, bearing)| 0.25 * bearing.model().bearing.pitch_diameter);
    let rolling = spin.speed.abs() * rolling.fold(0.0, f64::max);
    // One that starts is as slow, but what drives it makes it faster.
    let rests = (torque.abs() - held).abs() < 0.5 * torque.abs();
    (rests && rolling < REGULARISATION_SPEED).then(|| {
        format!(
            "the shaft creeps at {:.3e} rad/s under {torque:.3e} N m, which friction holds: its balls roll at {rolling:.1e} m/s, \
             below v0 = {REGULARISATION_SPEED:e} m/s, where creep laws are viscous (docs/creep-laws.md); a real shaft stands \
             still here",
            spin.speed
        )
    })
}
