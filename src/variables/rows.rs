//! The rows of the table.

use super::units::{self, Unit};
use super::{
    Causality, FromBall, FromContact, FromOutputs, Kind, Race, RaceQuantity, Source, Variable, Variables,
};
use crate::scene::Drive;

const AXES: [&str; 3] = ["x", "y", "z"];

/// What the components of a vector have in common.
#[derive(Clone, Copy)]
struct Kin {
    unit: Unit,
    causality: Causality,
    nominal: f64,
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
        self.rows.push(Variable { name, unit, kind: Kind::Real, causality, nominal, description, source });
    }

    /// Adds the three world components of a vector of a race; `what` ends before "<prefix> race".
    fn add_vector(
        &mut self,
        race: Race,
        quantity: fn(usize) -> RaceQuantity,
        (name, what): (&str, &str),
        kind: Kin,
    ) {
        let prefix = race.prefix();
        for (i, axis) in AXES.iter().enumerate() {
            let description = format!("{what} the {prefix} race, {axis} component, world axes");
            let name = format!("{prefix}.{name}.{axis}");
            self.add(
                name,
                kind.unit,
                kind.causality,
                kind.nominal,
                description,
                Source::Race(race, quantity(i)),
            );
        }
    }

    pub(super) fn add_race(&mut self, race: Race, drive: Drive) {
        use RaceQuantity as Q;
        use units::{METRE, METRE_PER_SECOND, NEWTON, NEWTON_METRE, RADIAN_PER_SECOND};
        let of = |unit, causality, nominal| Kin { unit, causality, nominal };
        let motion = match drive {
            Drive::Pose => Some(Causality::Input),
            Drive::Wrench | Drive::Hinge => Some(Causality::Output),
            Drive::Fixed => None,
        };
        if let Some(causality) = motion {
            let position = ("position", "position of the origin of");
            self.add_vector(race, Q::Position, position, of(METRE, causality, 1e-5));
            self.add_orientation(race, race.prefix(), causality);
            let velocity = ("velocity", "velocity of the origin of");
            self.add_vector(race, Q::Velocity, velocity, of(METRE_PER_SECOND, causality, 1e-3));
            let angular = ("angular_velocity", "angular velocity of");
            self.add_vector(race, Q::AngularVelocity, angular, of(RADIAN_PER_SECOND, causality, 100.0));
        }
        let (input, output) = (Causality::Input, Causality::Output);
        let force = ("force", "force that the bearing exerts on");
        self.add_vector(race, Q::Force, force, of(NEWTON, output, 1e3));
        let moment = ("moment", "moment that the bearing exerts about the origin of");
        self.add_vector(race, Q::Moment, moment, of(NEWTON_METRE, output, 1.0));
        let prefix = race.prefix();
        let torque = format!("torque that keeps the {prefix} race at its prescribed speed");
        if drive == Drive::Hinge {
            let force = ("reaction_force", "force of the hinge on");
            self.add_vector(race, Q::ReactionForce, force, of(NEWTON, output, 1e3));
            let moment = ("reaction_moment", "moment of the hinge and its drive about the origin of");
            self.add_vector(race, Q::ReactionMoment, moment, of(NEWTON_METRE, output, 1.0));
            let source = Source::Race(race, Q::DriveTorque);
            self.add(format!("{prefix}.drive_torque"), NEWTON_METRE, output, 0.1, torque, source);
        } else if drive == Drive::Wrench {
            let force = ("applied_force", "external force on");
            self.add_vector(race, Q::AppliedForce, force, of(NEWTON, input, 1e3));
            let moment = ("applied_moment", "external moment about the origin of");
            self.add_vector(race, Q::AppliedMoment, moment, of(NEWTON_METRE, input, 1.0));
            let speed = format!("prescribed spin of the {prefix} race about its own axis");
            let source = Source::Race(race, Q::Speed);
            self.add(format!("{prefix}.speed"), RADIAN_PER_SECOND, input, 100.0, speed, source);
            let source = Source::Race(race, Q::DriveTorque);
            self.add(format!("{prefix}.drive_torque"), NEWTON_METRE, output, 0.1, torque, source);
        }
    }

    fn add_orientation(&mut self, race: Race, prefix: &str, causality: Causality) {
        if self.cardan {
            for (i, axis) in AXES.iter().enumerate() {
                let description =
                    format!("Cardan angle {axis} of the {prefix} race, intrinsic x-y-z (x without limit)");
                let source = Source::Race(race, RaceQuantity::Angle(i));
                let name = format!("{prefix}.angle.{axis}");
                self.add(name, units::RADIAN, causality, 1e-3, description, source);
            }
        } else {
            for (i, component) in ["w", "x", "y", "z"].iter().enumerate() {
                let description =
                    format!("orientation of the {prefix} race, unit quaternion component {component}");
                let source = Source::Race(race, RaceQuantity::Orientation(i));
                let name = format!("{prefix}.orientation.{component}");
                self.add(name, units::ONE, causality, 1.0, description, source);
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

    pub(super) fn add_ball(&mut self, index: usize) {
        let number = index + 1;
        let mut output = |name: &str, unit, nominal, what: &str, get: FromBall| {
            let (name, description) = (format!("ball[{number}].{name}"), format!("{what} of ball {number}"));
            self.add(name, unit, Causality::Output, nominal, description, Source::Ball(index, get));
        };
        output("azimuth", units::RADIAN, 1.0, "azimuth from +y towards +z", |b| b.azimuth);
        output("orbital_speed", units::RADIAN_PER_SECOND, 100.0, "orbital speed", |b| b.orbital_speed);
        for (race, name) in [(Race::Inner, "inner"), (Race::Outer, "outer")] {
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
