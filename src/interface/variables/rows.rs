//! The rows of the table.

use super::race_rows::RACE_VARIABLES;
use super::units::{self, Unit};
use super::{
    Causality, Coefficient, FromBall, FromCage, FromContact, FromOutputs, Kind, MAX_FRICTION, Source,
    Variable, Variables,
};
use crate::model::bodies::Race;
use crate::scene::parameters::PARAMETERS;
use crate::scene::{Drive, Guidance, Orientation, Scene};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Smallest and largest value that a variable can have.
fn limits(source: &Source) -> [Option<f64>; 2] {
    match source {
        Source::Race(_, quantity, _) => quantity.limits,
        Source::Friction => [Some(0.0), Some(MAX_FRICTION)],
        Source::Parameter(parameter, _) => [Some(parameter.range.low), Some(parameter.range.high)],
        Source::Bearing(_)
        | Source::Condensed(_)
        | Source::Cage(_)
        | Source::Ball(..)
        | Source::Contact(..) => [None; 2],
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
        let mut scene = scene.clone();
        for parameter in &PARAMETERS {
            if let Some(&mut start) = parameter.place(&mut scene) {
                let unit = units::of_parameter(parameter.range.unit);
                let nominal = if start == 0.0 { 1.0 } else { start.abs() };
                let source = Source::Parameter(parameter, start);
                let description = parameter.description.to_string();
                self.add(parameter.key.into(), unit, Causality::Parameter, nominal, description, source);
            }
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
        output("cage.speed", units::RADIAN_PER_SECOND, 100.0, "mean orbital speed of the balls", |o| {
            o.cage_speed
        });
        let slip = "1 - cage speed over its epicyclic value";
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

    /// Adds stiffness and damping of the running bearing, one variable per component.
    pub(super) fn add_condensed(&mut self) {
        const DIRECTIONS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];
        let stiffness = |i: usize, k: usize| match (i < 3, k < 3) {
            (true, true) => (units::NEWTON_PER_METRE, 1e8),
            (true, false) => (units::NEWTON_PER_RADIAN, 1e6),
            (false, true) => (units::NEWTON_METRE_PER_METRE, 1e6),
            (false, false) => (units::NEWTON_METRE_PER_RADIAN, 1e4),
        };
        let damping = |i: usize, k: usize| match (i < 3, k < 3) {
            (true, true) => (units::NEWTON_SECOND_PER_METRE, 1e4),
            (true, false) => (units::NEWTON_SECOND_PER_RADIAN, 1e2),
            (false, true) => (units::NEWTON_METRE_SECOND_PER_METRE, 1e2),
            (false, false) => (units::NEWTON_METRE_SECOND_PER_RADIAN, 1.0),
        };
        let load = |i: usize| format!("{} {}", if i < 3 { "force" } else { "moment" }, AXES[i % 3]);
        for (i, row) in DIRECTIONS.iter().enumerate() {
            for (k, column) in DIRECTIONS.iter().enumerate() {
                let (unit, nominal) = stiffness(i, k);
                let by = if k < 3 { "translation" } else { "rotation" };
                let what = format!(
                    "external {} that holds the inner race by its {by} {} relative to the outer race",
                    load(i),
                    AXES[k % 3]
                );
                let source = Source::Condensed(Coefficient::Stiffness(i, k));
                self.add(format!("stiffness.{row}.{column}"), unit, Causality::Output, nominal, what, source);
            }
        }
        for (i, row) in DIRECTIONS.iter().enumerate() {
            for (k, column) in DIRECTIONS.iter().enumerate() {
                let (unit, nominal) = damping(i, k);
                let by = if k < 3 { "velocity" } else { "angular velocity" };
                let what = format!(
                    "external {} that moves the inner race by its {by} {} relative to the outer race",
                    load(i),
                    AXES[k % 3]
                );
                let source = Source::Condensed(Coefficient::Damping(i, k));
                self.add(format!("damping.{row}.{column}"), unit, Causality::Output, nominal, what, source);
            }
        }
    }

    pub(super) fn add_cage(&mut self, guided_by: Guidance) {
        use units::{METRE, METRE_PER_SECOND, NEWTON, ONE, RADIAN, RADIAN_PER_SECOND, WATT};
        let guide = match guided_by {
            Guidance::Inner => "inner",
            Guidance::Outer | Guidance::Balls => "outer",
        };
        let centre = format!("cage centre relative to the {guide} race");
        let mut rows: Vec<(&str, Unit, f64, String, FromCage)> = vec![
            ("orientation.w", ONE, 1.0, "orientation of the cage, quaternion component w".into(), |c| {
                c.pose.orientation.w
            }),
            ("turned", RADIAN, 100.0, "turns of the cage about its axis since the start".into(), |c| {
                c.turned
            }),
            ("eccentricity.axial", METRE, 1e-4, format!("{centre}, along its axis"), |c| c.eccentricity.x),
            ("eccentricity.radius", METRE, 1e-4, format!("{centre}, distance from its axis"), |c| {
                c.eccentricity.yz().norm()
            }),
            ("eccentricity.angle", RADIAN, 1.0, format!("{centre}, angle from +y towards +z"), |c| {
                c.eccentricity.z.atan2(c.eccentricity.y)
            }),
            ("pocket_power", WATT, 1.0, "power lost to friction in all pockets".into(), |c| c.pocket_power),
        ];
        let vectors: [(&str, Unit, f64, &str, [FromCage; 3]); 6] = [
            (
                "position",
                METRE,
                1e-4,
                "position of the cage's centre",
                [|c| c.pose.position.x, |c| c.pose.position.y, |c| c.pose.position.z],
            ),
            (
                "orientation",
                ONE,
                1.0,
                "orientation of the cage, imaginary part of the quaternion",
                [|c| c.pose.orientation.i, |c| c.pose.orientation.j, |c| c.pose.orientation.k],
            ),
            (
                "velocity",
                METRE_PER_SECOND,
                1e-2,
                "velocity of the cage's centre",
                [|c| c.twist.velocity.x, |c| c.twist.velocity.y, |c| c.twist.velocity.z],
            ),
            (
                "angular_velocity",
                RADIAN_PER_SECOND,
                100.0,
                "angular velocity of the cage",
                [
                    |c| c.twist.angular_velocity.x,
                    |c| c.twist.angular_velocity.y,
                    |c| c.twist.angular_velocity.z,
                ],
            ),
            (
                "pocket_force",
                NEWTON,
                10.0,
                "force of all pockets on the cage",
                [|c| c.pocket_force.x, |c| c.pocket_force.y, |c| c.pocket_force.z],
            ),
            (
                "land_force",
                NEWTON,
                10.0,
                "force of the lands on the cage",
                [|c| c.land_force.x, |c| c.land_force.y, |c| c.land_force.z],
            ),
        ];
        if guided_by != Guidance::Balls {
            let (left, right) = ("normal load on the land at the cage's -x side", "at the cage's +x side");
            rows.push(("land_load.left", NEWTON, 10.0, left.into(), |c| c.land_loads[0]));
            let right = format!("normal load on the land {right}");
            rows.push(("land_load.right", NEWTON, 10.0, right, |c| c.land_loads[1]));
            let power = "power lost to friction on the lands".to_string();
            rows.push(("land_power", WATT, 1.0, power, |c| c.land_power));
        }
        for (name, unit, nominal, description, get) in rows {
            let name = format!("cage.{name}");
            self.add(name, unit, Causality::Output, nominal, description, Source::Cage(get));
        }
        for (name, unit, nominal, what, components) in vectors {
            if name == "land_force" && guided_by == Guidance::Balls {
                continue;
            }
            for (axis, get) in AXES.iter().zip(components) {
                let (name, description) =
                    (format!("cage.{name}.{axis}"), format!("{what}, {axis} component"));
                self.add(name, unit, Causality::Output, nominal, description, Source::Cage(get));
            }
        }
    }

    pub(super) fn add_ball(&mut self, index: usize, cage: bool) {
        let number = index + 1;
        let mut output = |name: &str, unit, nominal, what: &str, get: FromBall| {
            let (name, description) = (format!("ball[{number}].{name}"), format!("{what} of ball {number}"));
            self.add(name, unit, Causality::Output, nominal, description, Source::Ball(index, get));
        };
        output("azimuth", units::RADIAN, 1.0, "azimuth from +y towards +z", |b| b.azimuth);
        output("orbital_speed", units::RADIAN_PER_SECOND, 100.0, "orbital speed", |b| b.orbital_speed);
        if cage {
            let pocket: [(&str, Unit, f64, &str, FromBall); 6] = [
                ("load", units::NEWTON, 10.0, "normal load", |b| b.pocket.map_or(0.0, |p| p.load)),
                ("force.x", units::NEWTON, 10.0, "force on the ball, x component, world axes,", |b| {
                    b.pocket.map_or(0.0, |p| p.force.x)
                }),
                ("force.y", units::NEWTON, 10.0, "force on the ball, y component, world axes,", |b| {
                    b.pocket.map_or(0.0, |p| p.force.y)
                }),
                ("force.z", units::NEWTON, 10.0, "force on the ball, z component, world axes,", |b| {
                    b.pocket.map_or(0.0, |p| p.force.z)
                }),
                ("approach", units::METRE, 1e-4, "approach (negative is a gap)", |b| {
                    b.pocket.map_or(0.0, |p| p.approach)
                }),
                ("power", units::WATT, 0.1, "power lost to friction", |b| b.pocket.map_or(0.0, |p| p.power)),
            ];
            for (quantity, unit, nominal, what, get) in pocket {
                let description = format!("{what} of ball {number} and its cage pocket");
                let name = format!("ball[{number}].pocket.{quantity}");
                self.add(name, unit, Causality::Output, nominal, description, Source::Ball(index, get));
            }
        }
        for race in Race::BOTH {
            let name = race.name();
            let mut output = |quantity: &str, unit, nominal, what: &str, get: FromContact| {
                let description = format!("{what} of ball {number} and the {name} race");
                let source = Source::Contact(index, race, get);
                let name = format!("ball[{number}].{name}.{quantity}");
                self.add(name, unit, Causality::Output, nominal, description, source);
            };
            output("load", units::NEWTON, 100.0, "normal load", |c| c.load);
            output("contact_angle", units::RADIAN, 0.1, "contact angle", |c| c.contact_angle);
            let what = "longitudinal creepage";
            output("creepage_longitudinal", units::ONE, 1e-3, what, |c| c.creepage_longitudinal);
            output("creepage_lateral", units::ONE, 1e-3, "lateral creepage", |c| c.creepage_lateral);
            output("creepage_spin", units::PER_METRE, 10.0, "spin creepage", |c| c.creepage_spin);
            let what = "longitudinal creep force on the ball";
            output("force_longitudinal", units::NEWTON, 1.0, what, |c| c.force_longitudinal);
            output("force_lateral", units::NEWTON, 1.0, "lateral creep force on the ball", |c| {
                c.force_lateral
            });
            output("spin_moment", units::NEWTON_METRE, 1e-3, "spin moment on the ball", |c| c.spin_moment);
            output("power", units::WATT, 0.1, "power lost to friction", |c| c.power);
            output("peak_pressure", units::PASCAL, 1e9, "peak pressure", |c| c.peak_pressure);
        }
    }
}
