//! The rows of the table.

use super::race_rows::RACE_VARIABLES;
use super::{Causality, FromOutputs, Kind, Source, Variable, Variables};
use crate::model::bodies::Race;
use crate::scene::{Drive, Orientation, Scene};
use crate::schema::numbers::FRICTION;
use crate::schema::variable_units::{self as units, Unit};

/// Smallest and largest value that a variable can have.
fn limits(source: &Source) -> [Option<f64>; 2] {
    match source {
        Source::Race(_, quantity, _) => quantity.limits,
        Source::Friction => [Some(FRICTION.low), Some(FRICTION.high)],
        Source::Parameter(parameter) => [Some(parameter.range.low), Some(parameter.range.high)],
        Source::Bearing(_) | Source::Effect(_) => [None; 2],
    }
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

    /// Adds what a race has under its drive.
    pub(super) fn add_race(&mut self, race: Race, drive: Drive, orientation: Orientation) {
        for quantity in &RACE_VARIABLES {
            let Some(causality) = (quantity.causality)(drive, orientation) else {
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

    pub(super) fn add_bearing(&mut self) {
        let friction = "friction coefficient of the ball-race contacts".to_string();
        self.add("friction".into(), units::ONE, Causality::Input, 0.1, friction, Source::Friction);
        let mut output = |name: &str, unit, nominal, description: &str, get: FromOutputs| {
            let source = Source::Bearing(get);
            self.add(name.into(), unit, Causality::Output, nominal, description.into(), source);
        };
        let speed =
            "spin of the cage about its own axis where there is a cage, else mean orbital speed of the balls";
        output("cage.speed", units::RADIAN_PER_SECOND, 100.0, speed, |o| o.cage_speed);
        let slip = "1 - cage speed over the orbital speed of balls that roll without slip on both races";
        output("cage.slip", units::ONE, 1e-2, slip, |o| o.cage_slip);
        let power = "power lost to friction in all contacts";
        output("friction_power", units::WATT, 1.0, power, |o| o.friction_power);
        let power = "power lost to contact damping";
        output("damping_power", units::WATT, 1e-2, power, |o| o.damping_power);
        let torque = "friction torque against the rotation of the inner race";
        output("friction_torque", units::NEWTON_METRE, 0.1, torque, |o| o.friction_torque);
        output("energy.stored", units::JOULE, 1.0, "kinetic and elastic energy", |o| o.stored_energy);
        output("energy.work", units::JOULE, 1.0, "work put in since the start", |o| o.work);
        output("energy.dissipated", units::JOULE, 1.0, "energy lost since the start", |o| o.dissipated);
        let slip =
            "1 - mean orbital speed of the loaded balls over that of rolling without slip on both races";
        output("balls.slip", units::ONE, 1e-2, slip, |o| o.ball_slip);
        let mut count = |name: &str, description: &str, get: FromOutputs| {
            self.rows.push(Variable {
                name: name.into(),
                unit: units::ONE,
                kind: Kind::Integer,
                causality: Causality::Output,
                nominal: 1.0,
                limits: [Some(0.0), None],
                description: description.into(),
                source: Source::Bearing(get),
            });
        };
        count("integrator.steps", "accepted steps since the start", |o| o.statistics.steps as f64);
        count("integrator.rejections", "rejected steps since the start", |o| {
            (o.statistics.rejected_error + o.statistics.rejected_newton) as f64
        });
        count("integrator.newton_iterations", "Newton iterations since the start", |o| {
            o.statistics.newton.iterations as f64
        });
    }

    /// Adds what effects report.
    pub(super) fn add_effects(&mut self, scene: &Scene, every_ball: bool) {
        for row in scene.effects.rows(scene.bearing.balls, every_ball) {
            let source = Source::Effect(row.get);
            self.add(row.name, row.unit, Causality::Output, row.nominal, row.description, source);
        }
    }
}
