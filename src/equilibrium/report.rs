//! An equilibrium as text and as JSON.

use std::f64::consts::PI;
use std::fmt;

use nalgebra::Vector3;
use serde_json::{Value, json};

use super::Equilibrium;
use super::ball::{BallBalance, D};
use super::problem::TOLERANCE;
use crate::contact::geometry::GrooveContact;
use crate::contact::shoulder::largest_share;
use crate::model::bodies::{PerRace, Race};
use crate::model::{Conditions, Model};
use crate::numerics::scalar::{Single, values};

/// [-] stiffness over the root of both on the diagonal below which it is rounding.
const ROUNDING: f64 = 1e-12;

/// A number, or 0 where it is below a floor: what is left of digits that cancel, or less than is printed of it. Its sign would be chance.
fn without_rounding(value: f64, floor: f64) -> f64 {
    if value.abs() < floor { 0.0 } else { value }
}

/// Reported quantities of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallReport {
    /// \[N] normal load on the inner race.
    pub inner_load: f64,
    /// \[N] normal load on the outer race.
    pub outer_load: f64,
    /// \[rad] contact angle at the inner race, relative to the tilted ring.
    pub inner_contact_angle: f64,
    /// \[rad] contact angle at the outer race.
    pub outer_contact_angle: f64,
    /// \[m] approach at the inner race.
    pub inner_approach: f64,
    /// \[m] approach at the outer race.
    pub outer_approach: f64,
    /// \[N] centrifugal force.
    pub centrifugal_force: f64,
    /// [N m] gyroscopic moment.
    pub gyroscopic_moment: f64,
    /// [N/m^1.5] Hertz stiffness of the inner contact.
    pub inner_hertz_stiffness: f64,
    /// [N/m^1.5] Hertz stiffness of the outer contact.
    pub outer_hertz_stiffness: f64,
    /// [-] share of the inner load beyond the shoulders of the inner race.
    pub inner_shoulder_share: f64,
    /// [-] share of the outer load beyond the shoulders of the outer race.
    pub outer_shoulder_share: f64,
    /// [rad] half width of the contact with each race along rolling over the radius of the race there, where the race has waves.
    pub(super) spans: PerRace<f64>,
}

impl BallReport {
    /// Report of a settled ball; `inner_axis` is the inner race's axis relative to the outer race.
    pub(super) fn new(model: &Model, balance: &BallBalance, inner_axis: &Vector3<f64>) -> Self {
        // atan2(axial, radial) of the force on the ball for the inner race, of the opposite for the outer.
        let angle = |contact: &GrooveContact<D>, axis: &Vector3<f64>, sign: f64| {
            let normal = values(&contact.normal) * sign;
            normal.dot(axis).atan2(normal.dot(&values(&contact.radial)))
        };
        let contacts = model.contacts(&Conditions::default());
        let share = |race: Race, contact: &GrooveContact<D>, towards_x: f64| {
            let shape = contacts[race].shape.at(contact.circumferential_curvature.value);
            let semi_axis = shape.semi_axis_transverse * contact.approach.value.max(0.0).sqrt();
            model.bearing.shoulder(race, towards_x, semi_axis).0
        };
        let span = |race: Race, contact: &GrooveContact<D>| {
            let semi_axis =
                contacts[race].shape.at(contact.circumferential_curvature.value).semi_axis_rolling;
            let out = contact.normal.dot(&contact.radial).value * model.bearing.ball.radius;
            semi_axis * contact.approach.value.max(0.0).sqrt() / (contact.radius.value + out)
        };
        let inner_contact_angle = angle(&balance.inner, inner_axis, -1.0);
        let outer_contact_angle = angle(&balance.outer, &Vector3::x(), 1.0);
        Self {
            inner_load: balance.inner_load.value,
            outer_load: balance.outer_load.value,
            inner_contact_angle,
            outer_contact_angle,
            inner_approach: balance.inner.approach.value,
            outer_approach: balance.outer.approach.value,
            centrifugal_force: balance.centrifugal_force.value(),
            gyroscopic_moment: balance.gyroscopic_moment.value,
            inner_hertz_stiffness: balance.stiffness.inner.value,
            outer_hertz_stiffness: balance.stiffness.outer.value,
            inner_shoulder_share: share(Race::Inner, &balance.inner, -inner_contact_angle),
            outer_shoulder_share: share(Race::Outer, &balance.outer, outer_contact_angle),
            spans: PerRace {
                inner: span(Race::Inner, &balance.inner),
                outer: span(Race::Outer, &balance.outer),
            },
        }
    }

    /// \[N] load on a race, and \[rad] contact angle there towards the race's +x side.
    pub(super) fn on(&self, race: Race) -> (f64, f64) {
        match race {
            Race::Inner => (self.inner_load, -self.inner_contact_angle),
            Race::Outer => (self.outer_load, self.outer_contact_angle),
        }
    }
}

impl Equilibrium {
    /// A warning where the balance is unstable.
    pub fn warning(&self) -> Option<String> {
        let (stiffness, race) = (self.unstable?, self.race.name());
        Some(format!(
            "warning: this equilibrium is unstable: the {race} race is pushed on where it moves off ({stiffness:.2e} N/m), and no \
             stable one was found beside it"
        ))
    }

    /// \[Pa] largest contact pressure.
    pub fn peak_pressure(&self, model: &Model) -> f64 {
        let radius = model.bearing.ball.radius;
        let contacts = model.contacts(&Conditions::default());
        let mut largest = 0.0f64;
        for ball in &self.balls {
            let (b, orbit) = (&ball.report, ball.position.yz().norm());
            // Curvature along the circumference: cosine of the contact angle over the radius of the contact point.
            let (inner, outer) = (b.inner_contact_angle.cos(), b.outer_contact_angle.cos());
            for (race, load, approach, curvature) in [
                (Race::Inner, b.inner_load, b.inner_approach, inner / (orbit - radius * inner)),
                (Race::Outer, b.outer_load, b.outer_approach, -outer / (orbit + radius * outer)),
            ] {
                if load > 0.0 {
                    let hertz = contacts[race].shape.hertz(curvature);
                    let area = PI * hertz.semi_axis_rolling * hertz.semi_axis_transverse * approach;
                    largest = largest.max(1.5 * load / area);
                }
            }
        }
        largest
    }

    /// All results as JSON, SI units; keys are part of the command line's contract.
    pub fn to_json(&self) -> Value {
        let column = |get: fn(&BallReport) -> f64| -> Vec<f64> {
            self.balls.iter().map(|ball| get(&ball.report)).collect()
        };
        let printed = |values: [f64; 5], [first, last]: [f64; 2]| {
            std::array::from_fn(|k| without_rounding(values[k], if k < 3 { first } else { last }))
        };
        let [x, y, z, ry, rz] = printed(self.displacement, [5e-11, 5e-10]);
        let [fx, fy, fz, my, mz] = printed(self.load, [5e-4, 5e-6]);
        let stiffness: Vec<Vec<f64>> =
            self.stiffness.row_iter().map(|row| row.iter().copied().collect()).collect();
        let mut report = json!({
            "units": "SI: m, N, N m, rad, rad/s",
            "displacement": { "x": x, "y": y, "z": z, "ry": ry, "rz": rz },
            "race": self.race.name(),
            "load_is":
                format!("external load on the {} race; the bearing's force on it is the opposite", self.race.name()),
            "load": { "Fx": fx, "Fy": fy, "Fz": fz, "My": my, "Mz": mz },
            "stiffness": stiffness,
            "unstable": self.unstable,
            "cage_speed": self.cage_speed,
            "residual": self.residual,
            "iterations": self.iterations,
            "balls": {
                "azimuth": self.balls.iter().map(|ball| ball.azimuth).collect::<Vec<_>>(),
                "inner_load": column(|b| b.inner_load),
                "outer_load": column(|b| b.outer_load),
                "inner_contact_angle": column(|b| b.inner_contact_angle),
                "outer_contact_angle": column(|b| b.outer_contact_angle),
                "inner_approach": column(|b| b.inner_approach),
                "outer_approach": column(|b| b.outer_approach),
                "centrifugal_force": column(|b| b.centrifugal_force),
                "gyroscopic_moment": column(|b| b.gyroscopic_moment),
                "inner_hertz_stiffness": column(|b| b.inner_hertz_stiffness),
                "outer_hertz_stiffness": column(|b| b.outer_hertz_stiffness),
                "inner_shoulder_share": column(|b| b.inner_shoulder_share),
                "outer_shoulder_share": column(|b| b.outer_shoulder_share),
            },
        });
        if let (Some(growth), Some(report)) = (&self.growth, report.as_object_mut()) {
            let of_races = |[inner, outer]: [f64; 2]| json!({ "inner": inner, "outer": outer });
            let grown = json!({
                "clearance": growth.clearance,
                "contact_angle": growth.contact_angle,
                "interference": of_races(growth.interference),
                "seat_pressure": of_races(growth.seat_pressure),
            });
            report.insert("growth".into(), grown);
        }
        if let (Some(life), Some(report)) = (&self.life, report.as_object_mut()) {
            let rated = json!({
                "L10r": life.reference,
                "modified": life.modified,
                "equivalent_load": life.equivalent_load,
                "static_safety": life.static_safety,
                "load_rests_on": life.load_rests_on.name(),
            });
            report.insert("life".into(), rated);
        }
        report
    }
}

impl fmt::Display for Equilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let printed = |values: [f64; 5], [first, last]: [f64; 2]| {
            std::array::from_fn(|k| without_rounding(values[k], if k < 3 { first } else { last }))
        };
        let [x, y, z, ry, rz] = printed(self.displacement, [5e-11, 5e-10]);
        let [fx, fy, fz, my, mz] = printed(self.load, [5e-4, 5e-6]);
        let race = self.race.name();
        writeln!(f, "{race} race    x {:.4} um  y {:.4} um  z {:.4} um", x * 1e6, y * 1e6, z * 1e6)?;
        writeln!(f, "              ry {:.6} mrad  rz {:.6} mrad", ry * 1e3, rz * 1e3)?;
        writeln!(
            f,
            "external load Fx {fx:.3} N  Fy {fy:.3} N  Fz {fz:.3} N   (on the {race} race; the bearing's force on it"
        )?;
        writeln!(f, "              My {my:.5} N m  Mz {mz:.5} N m         is the opposite)")?;
        writeln!(f, "cage speed    {:.4} rad/s", self.cage_speed)?;
        // Below that its digits are those of the processor.
        let residual = match self.residual < TOLERANCE {
            true => format!("below {TOLERANCE:e}"),
            false => format!("{:.2e}", self.residual),
        };
        writeln!(f, "residual      {residual} of the load, {} iterations\n", self.iterations)?;
        if let Some(growth) = &self.growth {
            let (clearance, angle) = (growth.clearance * 1e6, growth.contact_angle.to_degrees());
            writeln!(f, "clearance     {clearance:.3} um, free contact angle {angle:.4} deg (grown)")?;
            for (race, (interference, pressure)) in
                ["inner", "outer"].into_iter().zip(growth.interference.into_iter().zip(growth.seat_pressure))
            {
                let (interference, pressure) = (interference * 1e6, pressure * 1e-6);
                writeln!(
                    f,
                    "seat          {race}: interference {interference:.3} um, pressure {pressure:.3} MPa"
                )?;
            }
            writeln!(f)?;
        }
        if let Some(life) = &self.life {
            let (load, safety) = (life.equivalent_load, life.static_safety);
            write!(f, "life          L10r {:.5e} million revolutions", life.reference)?;
            if let Some(modified) = life.modified {
                write!(f, ", modified {modified:.5e}")?;
            }
            writeln!(f, "; P {load:.2} N, static safety {safety:.3}")?;
            writeln!(f, "              {}\n", life.load_rests_on.words())?;
        }
        writeln!(f, "stiffness     external load Fx, Fy, Fz [N], My, Mz [N m] by x, y, z [m], ry, rz [rad]")?;
        let size = |i: usize| self.stiffness[(i, i)].abs().sqrt();
        for i in 0..5 {
            let floor = |j: usize| ROUNDING * size(i) * size(j);
            let row = (0..5).map(|j| format!("{:12.4e}", without_rounding(self.stiffness[(i, j)], floor(j))));
            writeln!(f, "              {}", row.collect::<Vec<_>>().join(" "))?;
        }
        if let Some(warning) = self.warning() {
            writeln!(f, "              {}", warning.trim_start_matches("warning: "))?;
        }
        writeln!(f, "\nball  azimuth [deg]  load inner, outer [N]   contact angle inner, outer [deg]")?;
        for (j, ball) in self.balls.iter().enumerate() {
            let b = &ball.report;
            writeln!(
                f,
                "{:4}  {:13.2}  {:10.3} {:10.3}   {:10.4} {:10.4}",
                j + 1,
                ball.azimuth.to_degrees(),
                b.inner_load,
                b.outer_load,
                without_rounding(b.inner_contact_angle.to_degrees(), 5e-5),
                without_rounding(b.outer_contact_angle.to_degrees(), 5e-5)
            )?;
        }
        let reports = || self.balls.iter().map(|ball| &ball.report);
        let over = [
            largest_share(reports().map(|b| (b.inner_load, b.inner_shoulder_share))),
            largest_share(reports().map(|b| (b.outer_load, b.outer_shoulder_share))),
        ];
        if over != [0.0; 2] {
            let [inner, outer] = over.map(|share| share * 100.0);
            writeln!(
                f,
                "\nover shoulders: up to {inner:.2} % of a load on the inner, {outer:.2} % on the outer race"
            )?;
        }
        Ok(())
    }
}
