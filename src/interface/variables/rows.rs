//! The rows of the table.

use super::race_rows::RACE_VARIABLES;
use super::race_setting::RaceMotion;
use super::{Causality, FromOutputs, FromPoint, Kind, Source, Variable, Variables};
use crate::effects::InputRow;
use crate::effects::growth::RISE;
use crate::effects::reports::PARTS;
use crate::model::bodies::Race;
use crate::model::state::Statistics;
use crate::scene::Scene;
use crate::schema::numbers::FRICTION;
use crate::schema::variable_units::{self as units, Unit};
use crate::simulation::losses::LOSSES;
use crate::simulation::margins::MARGINS;

/// Smallest and largest value that a variable can have.
fn limits(source: &Source) -> [Option<f64>; 2] {
    match source {
        Source::Race(_, quantity, _) => quantity.limits,
        Source::Friction => [Some(FRICTION.low), Some(FRICTION.high)],
        Source::Parameter(parameter) => [Some(parameter.range.low), Some(parameter.range.high)],
        Source::Rise(_) => [Some(RISE.low), Some(RISE.high)],
        Source::Margin(_) => [Some(0.0), Some(1.0)],
        Source::Bearing(..) | Source::Loss(_) | Source::Effect(_) | Source::Input(_) | Source::Shaft(_) => {
            [None; 2]
        }
    }
}

/// What tells the value of a row of the bearing as a whole without all outputs: its state, its contacts, or sums over these.
fn from_less(name: &str) -> Option<FromPoint> {
    Some(match name {
        "cage.speed" => |s| s.sums().cage_speed,
        "cage.slip" => |s| s.sums().cage_slip,
        "friction_power" => |s| s.sums().friction_power,
        "damping_power" => |s| s.sums().damping_power,
        "balls.slip" => |s| s.sums().ball_slip,
        "balls.entering_slip_load" => |s| s.sums().entering_slip_load,
        "balls.largest_load" => |s| largest(s.loads()),
        "balls.smallest_load" => |s| smallest(s.loads()),
        "friction_torque" => |s| s.friction_torque(),
        "energy.work" => |s| s.state().energies.input,
        "energy.dissipated" => |s| s.state().energies.lost(),
        "integrator.steps" => |s| s.state().statistics.steps as f64,
        "integrator.rejections" => |s| rejections(&s.state().statistics),
        "integrator.newton_iterations" => |s| s.state().statistics.newton.iterations as f64,
        _ => return None,
    })
}

fn largest(loads: impl Iterator<Item = f64>) -> f64 {
    loads.fold(0.0, f64::max)
}

/// The smallest; 0 where there is none.
fn smallest(loads: impl Iterator<Item = f64>) -> f64 {
    let least = loads.fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

fn rejections(of: &Statistics) -> f64 {
    (of.rejected_error + of.rejected_newton) as f64
}

impl Variables {
    fn add(
        &mut self,
        name: String,
        unit: Unit,
        causality: Causality,
        nominal: f64,
        description: String,
        source: Source,
    ) {
        let limits = limits(&source);
        self.rows.push(Variable {
            name,
            unit,
            kind: Kind::Real,
            causality,
            nominal,
            limits,
            description,
            source,
        });
    }

    /// Adds the parameters that a scene makes use of.
    pub(super) fn add_parameters(&mut self, scene: &Scene) {
        for parameter in scene.parameters() {
            let unit = units::of_parameter(parameter.range.unit);
            let nominal = if parameter.start == 0.0 { 1.0 } else { parameter.start.abs() };
            let (name, description) = (parameter.key.into(), parameter.description.into());
            let source = Source::Parameter(parameter);
            self.add(name, unit, Causality::Parameter, nominal, description, source);
        }
    }

    /// Adds what a race has under its drive, or as a shaft carries it.
    pub(super) fn add_race(&mut self, scene: &Scene, race: Race, carried: bool) {
        let (section, speed) = match race {
            Race::Inner => (&scene.inner, &scene.load.inner_speed),
            Race::Outer => (&scene.outer, &scene.load.outer_speed),
        };
        let motion = RaceMotion {
            drive: section.drive,
            orientation: scene.interface.orientation,
            scripted_speed: [speed, &section.misalignment.ry, &section.misalignment.rz]
                .iter()
                .any(|schedule| schedule.is_scripted()),
            carried,
        };
        for quantity in &RACE_VARIABLES {
            let Some(causality) = (quantity.causality)(motion) else {
                continue;
            };
            for component in 0..quantity.components.len() {
                let source = Source::Race(race, quantity, component);
                let name = quantity.name_of(race, component);
                let description = quantity.description_of(race, component);
                self.add(name, quantity.unit, causality, quantity.nominal, description, source);
            }
        }
    }

    pub(super) fn add_bearing(&mut self, scene: &Scene) {
        let friction = "friction coefficient of the ball-race contacts".to_string();
        self.add("friction".into(), units::ONE, Causality::Input, 0.1, friction, Source::Friction);
        let mut output = |name: &str, unit, nominal, description: &str, get: FromOutputs| {
            let source = Source::Bearing(get, from_less(name));
            self.add(name.into(), unit, Causality::Output, nominal, description.into(), source);
        };
        let speed =
            "spin of the cage about its own axis where there is a cage, else mean orbital speed of the balls";
        output("cage.speed", units::RADIAN_PER_SECOND, 100.0, speed, |o| o.cage_speed);
        let slip = "1 - cage speed over the orbital speed of balls that roll without slip on both races, which counts as no less than half \
                    of the cage speed; fades to 0 below 1e-3 m/s at the pitch radius";
        output("cage.slip", units::ONE, 1e-2, slip, |o| o.cage_slip);
        let power = "power lost to friction in all contacts; drag, contact damping and dampers of supports are in loss.total alone";
        output("friction_power", units::WATT, 1.0, power, |o| o.friction_power);
        let power = "power lost to contact damping";
        let kind = "power lost to friction in all contacts with the inner race";
        output("power.inner", units::WATT, 1.0, kind, |o| o.contact_power(|ball| ball.inner.power));
        let kind = "power lost to friction in all contacts with the outer race";
        output("power.outer", units::WATT, 1.0, kind, |o| o.contact_power(|ball| ball.outer.power));
        let kind = "power of the spin moments of all contacts with the races, part of their friction power";
        output("power.spin", units::WATT, 1.0, kind, |o| {
            o.contact_power(|ball| ball.inner.spin_power + ball.outer.spin_power)
        });
        let load = "largest normal load of a ball on a race";
        output("balls.largest_load", units::NEWTON, 100.0, load, |o| largest(o.loads()));
        let load = "smallest normal load of a ball on a race";
        output("balls.smallest_load", units::NEWTON, 100.0, load, |o| smallest(o.loads()));
        let loaded = "number of balls that both races press on";
        output("balls.loaded", units::ONE, 10.0, loaded, |o| {
            o.balls.iter().filter(|ball| ball.inner.load > 0.0 && ball.outer.load > 0.0).count() as f64
        });
        let pressure = "largest peak pressure of a ball on a race";
        output("balls.largest_pressure", units::PASCAL, 1e9, pressure, |o| {
            o.balls
                .iter()
                .flat_map(|ball| [&ball.inner, &ball.outer])
                .fold(0.0, |most, contact| most.max(contact.peak_pressure))
        });
        output("damping_power", units::WATT, 1e-2, power, |o| o.damping_power);
        let torque = "friction torque against the rotation of the inner race";
        output("friction_torque", units::NEWTON_METRE, 0.1, torque, |o| o.friction_torque);
        output("energy.stored", units::JOULE, 1.0, "kinetic and elastic energy", |o| o.stored_energy);
        output("energy.work", units::JOULE, 1.0, "work put in since the start", |o| o.work);
        output("energy.dissipated", units::JOULE, 1.0, "energy lost since the start", |o| o.dissipated);
        let slip = "1 - mean orbital speed of the loaded balls over that of rolling without slip on both races, which counts as no less \
                    than half of the former; fades to 0 below 1e-3 m/s at the pitch radius";
        output("balls.slip", units::ONE, 1e-2, slip, |o| o.ball_slip);
        for part in LOSSES.iter().filter(|part| (part.is_of)(&scene.effects)) {
            let (name, description) = (part.name.into(), part.description.into());
            self.add(name, units::WATT, Causality::Output, 1.0, description, Source::Loss(part.get));
        }
        for margin in MARGINS.iter().filter(|margin| (margin.is_of)(scene)) {
            let (name, description) = (margin.name.into(), margin.description.into());
            self.add(name, units::ONE, Causality::Output, 1.0, description, Source::Margin(margin.get));
        }
        let mut count = |name: &str, description: &str, get: FromOutputs| {
            self.rows.push(Variable {
                name: name.into(),
                unit: units::ONE,
                kind: Kind::Integer,
                // Some masters read every output as a real number.
                causality: Causality::Local,
                nominal: 1.0,
                limits: [Some(0.0), None],
                description: description.into(),
                source: Source::Bearing(get, from_less(name)),
            });
        };
        count("integrator.steps", "accepted steps since the start", |o| o.statistics.steps as f64);
        count("integrator.rejections", "rejected steps since the start", |o| rejections(&o.statistics));
        count("integrator.newton_iterations", "Newton iterations since the start", |o| {
            o.statistics.newton.iterations as f64
        });
    }

    /// Adds the temperatures that rings and balls grow by, where they do.
    pub(super) fn add_temperatures(&mut self, scene: &Scene) {
        // Where the heat of friction gives them they are no inputs.
        if scene.effects.growth.section.is_none() || scene.effects.heat_balance.section.is_some() {
            return;
        }
        let names = ["the inner ring", "the outer ring", "the balls", "the shaft", "the housing"];
        for (part, (key, name)) in PARTS.into_iter().zip(names).enumerate() {
            let description = format!("rise of the temperature of {name} over that of the given dimensions");
            let name = format!("temperature_rise.{key}");
            self.add(name, units::KELVIN, Causality::Input, 10.0, description, Source::Rise(part));
        }
    }

    /// Adds what effects report.
    pub(super) fn add_effects(&mut self, scene: &Scene, every_ball: bool) {
        for row in scene.effects.inputs() {
            let InputRow { name, unit, nominal, description, .. } = row.clone();
            self.add(name, unit, Causality::Input, nominal, description, Source::Input(row));
        }
        for row in scene.effects.rows(scene.bearing.balls, every_ball) {
            let source = Source::Effect(row.get);
            self.add(row.name, row.unit, Causality::Output, row.nominal, row.description, source);
        }
        if every_ball {
            let description = "largest normal load times slip speed of a ball on its way into the load zone; 0 under thrust alone";
            let name = "balls.entering_slip_load";
            let source = Source::Bearing(|o| o.entering_slip_load, from_less(name));
            // No output: the largest of many has no derivative where another becomes the largest.
            self.add(name.into(), units::WATT, Causality::Local, 1.0, description.into(), source);
        }
    }
}
