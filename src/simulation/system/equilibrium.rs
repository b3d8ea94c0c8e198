//! The quasi-static equilibrium of a shaft on its bearings, as it is reported: forces, displacements, stiffness, life, and how it swings.

use std::f64::consts::TAU;
use std::fmt;

use nalgebra::{Matrix6, Vector3};
use serde_json::{Map, Value, json};

use super::super::start::held_load;
use super::critical_speeds::{Campbell, campbell};
use super::linear::ShaftMode;
use super::{LinkOutputs, System, SystemError, SystemOutputs, steady_torque};
use crate::analysis::condensed::Condensed;
use crate::effects::rating::life_of_all;
use crate::effects::reports::LifeOutput;
use crate::model::link::roller_friction::FrictionOutputs;
use crate::model::link::rollers::RollerOutputs;
use crate::scene::system::SystemScene;
use crate::simulation::outputs::Outputs;

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct MachineEquilibrium {
    title: String,
    /// Names of meshes, then of bearings by their stiffness or by rollers, then of couplings; how many there are of the first two.
    links: (Vec<String>, [usize; 2]),
    /// Names of the shafts.
    shafts: Vec<String>,
    /// Motion at all points of the shafts and their housings.
    pub outputs: SystemOutputs,
    /// Every bearing.
    pub bearings: Vec<BearingEquilibrium>,
    /// How it swings about where it is, by growing frequency.
    pub modes: Vec<ShaftMode>,
    /// Natural frequencies over the speed.
    pub campbell: Campbell,
}

/// A bearing in it.
#[derive(Clone, Debug)]
pub struct BearingEquilibrium {
    /// Its name.
    pub name: String,
    /// \[N] force on the shaft, in its axes.
    pub force: Vector3<f64>,
    /// [N m] moment on the shaft across its axis, about the centre of the bore, in the axes of the shaft.
    pub moment: Vector3<f64>,
    /// Stiffness between its races [N/m, N, N m], in axes of its own: force and moment by displacement and rotation.
    pub stiffness: Matrix6<f64>,
    /// \[h] reference and modified life at the present speed.
    pub hours: Option<[Option<f64>; 2]>,
    /// All else, in axes of its own.
    pub outputs: Outputs,
}

impl MachineEquilibrium {
    /// That of a scene at a time \[s] of its scripts, with natural frequencies up to a speed [rad/s].
    ///
    /// # Errors
    /// If there is none.
    pub fn of(scene: &SystemScene, time: f64, up_to: f64) -> Result<Self, SystemError> {
        let mut system = System::starting_at(scene, time)?;
        let campbell = campbell(scene, time, up_to)?;
        let modes = system.modes()?.unwrap_or_default();
        let bearings = system.bearings().zip(&scene.bearings).map(|((name, bearing), mounted)| {
            let sign = mounted.mounting.direction.sign();
            let in_shaft = |x: f64, y: f64, z: f64| Vector3::new(sign * x, sign * y, z);
            // What holds the inner race in balance. Balls that were just started creep a little, which a moment of running takes away.
            let ([x, y, z, about_y, about_z], _) =
                held_load(bearing.scene(), bearing.model(), &mut bearing.inputs().clone(), time)
                    .map_err(|source| SystemError::Bearing { name: name.to_string(), source })?;
            let outputs = bearing.outputs().clone();
            let conditions = bearing.conditions();
            let speed = outputs.relative_speed().abs();
            let hours = outputs.life.filter(|_| speed > 0.0).map(|life| {
                let hours = |revolutions: f64| revolutions * 1e6 * TAU / speed / 3600.0;
                [Some(hours(life.reference)), life.modified.map(hours)]
            });
            Ok(BearingEquilibrium {
                name: name.to_string(),
                force: -in_shaft(x, y, z),
                moment: -in_shaft(0.0, about_y, about_z),
                stiffness: Condensed::new(bearing.model(), bearing.state(), &conditions).stiffness,
                hours,
                outputs,
            })
        });
        let bearings = bearings.collect::<Result<_, SystemError>>()?;
        let shafts = scene.shafts.iter().map(|shaft| shaft.name.clone()).collect();
        steady_torque::hold(&system.bearings, &mut system.structures);
        let by_stiffness = scene.springs.iter().filter(|spring| !spring.is_coupling()).count();
        let links = (scene.link_names().map(String::from).collect(), [scene.meshes.len(), by_stiffness]);
        Ok(Self {
            title: scene.title.clone(),
            links,
            shafts,
            outputs: system.structures.outputs,
            bearings,
            modes,
            campbell,
        })
    }

    /// \[h] life of all bearings together, reference and modified; none where one of them has none.
    pub fn hours(&self) -> [Option<f64>; 2] {
        let of_rollers =
            || self.outputs.links.iter().filter_map(LinkOutputs::hours).map(|hours| [Some(hours), None]);
        let each = || self.bearings.iter().map(|bearing| bearing.hours).chain(of_rollers().map(Some));
        [0, 1].map(|which| life_of_all(each().map(|hours| hours?[which])))
    }

    /// All of it, SI units.
    pub fn to_json(&self) -> Value {
        let vector = |v: &Vector3<f64>| json!({ "x": v.x, "y": v.y, "z": v.z });
        let outputs = &self.outputs;
        let bearing = |(place, of): (usize, &BearingEquilibrium)| {
            let balls = &of.outputs.balls;
            let column = |get: &dyn Fn(usize) -> f64| (0..balls.len()).map(get).collect::<Vec<_>>();
            let seat = &outputs.seats[place];
            let value = json!({
                "force": vector(&of.force),
                "moment": vector(&of.moment),
                "displacement": vector(&seat.displacement),
                "tilt": vector(&seat.tilt),
                "stiffness": of.stiffness.row_iter().map(|row| row.iter().copied().collect::<Vec<_>>()).collect::<Vec<_>>(),
                "peak_pressure": of.peak_pressure(),
                "friction_torque": of.outputs.torque_of_losses(),
                "life": of.outputs.life.as_ref().map(|life| life_json(life, of.hours)),
                "balls": {
                    "inner_load": column(&|k| balls[k].inner.load),
                    "outer_load": column(&|k| balls[k].outer.load),
                    "inner_contact_angle": column(&|k| balls[k].inner.contact_angle),
                    "outer_contact_angle": column(&|k| balls[k].outer.contact_angle),
                },
            });
            (of.name.clone(), value)
        };
        let mode = |mode: &ShaftMode| json!({ "frequency": mode.frequency, "damping": mode.damping, "whirl": mode.whirl.name(), "at": mode.place });
        let modes = |all: &[ShaftMode]| all.iter().map(mode).collect::<Vec<_>>();
        let springs = |from: usize, count: usize| -> Map<_, _> {
            let all = self.links.0.iter().zip(&outputs.links).skip(from).take(count);
            let of = all.map(|(name, link)| {
                let [force, moment] =
                    [0, 3].map(|from| vector(&link.state.force.fixed_rows::<3>(from).into_owned()));
                let value = match link.rollers() {
                    None => json!({ "force": force, "moment": moment }),
                    Some(rollers) => rollers_json((force, moment), rollers, link.hours()),
                };
                (name.clone(), value)
            });
            of.collect()
        };
        let [reference, modified] = self.hours();
        json!({
            "units": "SI: m, N, N m, rad, rad/s, Hz; life in h and million revolutions. Forces and moments are those on the shaft, in its axes; \
                      stiffness is in the axes of each bearing",
            "time": outputs.time,
            "speed": outputs.shafts[0].spin.speed,
            "torque": outputs.shafts[0].torque,
            "shafts": self.shafts.iter().zip(&outputs.shafts).map(|(name, own)| {
                (name.clone(), json!({ "speed": own.spin.speed, "torque": own.torque }))
            }).collect::<Map<_, _>>(),
            "bearings": self.bearings.iter().enumerate().map(bearing).collect::<Map<_, _>>(),
            "meshes": self.links.0.iter().zip(&outputs.links).take(self.links.1[0]).map(|(name, link)| {
                let force = link.state.force.fixed_rows::<3>(0).into_owned();
                let [first, second] = link.teeth.tilting_moments.each_ref().map(vector);
                (name.clone(), json!({
                    "force_on_first_gear": vector(&force), "normal_force": link.teeth.normal_force,
                    "misalignment": link.teeth.misalignment, "axial_moment_on_first_gear": first,
                    "axial_moment_on_second_gear": second, "friction_power": link.teeth.friction_power,
                }))
            }).collect::<Map<_, _>>(),
            "bearings_by_stiffness": springs(self.links.1[0], self.links.1[1]),
            "couplings": springs(self.links.1[0] + self.links.1[1], self.links.0.len()),
            "life_of_all_hours": { "L10r": reference, "modified": modified },
            "modes": modes(&self.modes),
            "campbell": self.campbell.rows.iter().map(|row| json!({
                "speed": row.speed,
                "modes": modes(&row.modes),
            })).collect::<Vec<_>>(),
            "critical_speeds": self.campbell.critical.iter().map(|critical| {
                let mut value = mode(&critical.mode);
                value["speed"] = critical.speed.into();
                value["driven_by_unbalance"] = critical.is_driven_by_unbalance().into();
                value
            }).collect::<Vec<_>>(),
        })
    }
}

/// A roller bearing with the force and the moment on its shaft, and its life \[h].
fn rollers_json((force, moment): (Value, Value), of: &RollerOutputs, hours: Option<f64>) -> Value {
    let mut value = json!({
        "force": force,
        "moment": moment,
        "stiffness": of.stiffness.row_iter().map(|row| row.iter().copied().collect::<Vec<_>>()).collect::<Vec<_>>(),
        "largest_load": of.largest_load,
        "largest_rib_load": of.largest_rib_load,
        "loaded_rollers": of.loaded,
        "peak_pressure": of.peak_pressure,
        "L10r": of.life,
        "L10r_hours": hours,
        "equivalent_load": of.equivalent_load,
        "static_safety": of.static_safety,
    });
    if let Some(friction) = &of.friction {
        value["friction"] = friction_json(friction);
    }
    value
}

fn friction_json(of: &FrictionOutputs) -> Value {
    let [rolling, ribs, drag] = of.parts;
    json!({
        "torque": of.torque(),
        "of_rolling": rolling,
        "of_ribs": ribs,
        "of_drag": drag,
        "loss": of.loss,
        "film_thickness": of.film,
        "film_ratio": of.film_ratio,
    })
}

fn life_json(life: &LifeOutput, hours: Option<[Option<f64>; 2]>) -> Value {
    let [reference, modified] = hours.unwrap_or_default();
    json!({
        "L10r": life.reference,
        "modified": life.modified,
        "L10r_hours": reference,
        "modified_hours": modified,
        "equivalent_load": life.equivalent_load,
        "static_safety": life.static_safety,
        "load_rests_on": life.load_rests_on.name(),
    })
}

impl BearingEquilibrium {
    /// \[Pa] largest contact pressure.
    pub fn peak_pressure(&self) -> f64 {
        let contacts = self.outputs.balls.iter().flat_map(|ball| [&ball.inner, &ball.outer]);
        contacts.map(|contact| contact.peak_pressure).fold(0.0, f64::max)
    }
}

/// \[rpm] of a speed [rad/s].
fn rpm(speed: f64) -> f64 {
    speed * 60.0 / TAU
}

/// Frequencies of a row of the table that are shown: those that matter lie low.
const SHOWN: usize = 8;

impl fmt::Display for MachineEquilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let outputs = &self.outputs;
        if !self.title.is_empty() {
            writeln!(f, "{}", self.title)?;
        }
        for (name, own) in self.shafts.iter().zip(&outputs.shafts) {
            writeln!(f, "{name:<16} {:.2} rpm, held by {:.5} N m", rpm(own.spin.speed), own.torque)?;
        }
        for (of, seat) in self.bearings.iter().zip(&outputs.seats) {
            self.write_bearing(f, of, seat)?;
        }
        self.write_links(f)?;
        if let [Some(reference), modified] = self.hours() {
            let modified = modified.map_or(String::new(), |hours| format!(", modified {hours:.4e} h"));
            writeln!(f, "life of all      L10r {reference:.4e} h{modified}")?;
        }
        writeln!(f, "\nnatural frequencies at {:.2} rpm", rpm(outputs.shafts[0].spin.speed))?;
        for mode in &self.modes {
            writeln!(
                f,
                "{:>14.2} Hz  {:<9} damping {:8.5}, most at {}",
                mode.frequency,
                mode.whirl.name(),
                mode.damping,
                mode.place
            )?;
        }
        writeln!(f, "\nspeed [rpm]    natural frequencies [Hz]: f forward, b backward, p planar, a axial")?;
        for row in &self.campbell.rows {
            let shown = row.modes.iter().take(SHOWN);
            let shown: Vec<String> =
                shown.map(|mode| format!("{:9.2}{}", mode.frequency, &mode.whirl.name()[..1])).collect();
            writeln!(f, "{:>11.1}    {}", rpm(row.speed), shown.join(" "))?;
        }
        let up_to = rpm(self.campbell.rows.last().map_or(0.0, |row| row.speed));
        if self.campbell.critical.is_empty() {
            return writeln!(f, "\nno critical speed up to {up_to:.0} rpm");
        }
        writeln!(f, "\ncritical speeds up to {up_to:.0} rpm")?;
        for critical in &self.campbell.critical {
            let driven = if critical.is_driven_by_unbalance() { "" } else { "; no unbalance drives it" };
            writeln!(
                f,
                "{:>14.1} rpm {:<9} damping {:8.5}, most at {}{driven}",
                rpm(critical.speed),
                critical.mode.whirl.name(),
                critical.mode.damping,
                critical.mode.place
            )?;
        }
        Ok(())
    }
}

fn write_rollers(f: &mut fmt::Formatter<'_>, of: &RollerOutputs, hours: Option<f64>) -> fmt::Result {
    let rib = match of.largest_rib_load {
        0.0 => String::new(),
        load => format!(", rib up to {load:.2} N"),
    };
    writeln!(
        f,
        "{:<16} {} rollers loaded, up to {:.2} N{rib}, pressure {:.1} MPa",
        "",
        of.loaded,
        of.largest_load,
        of.peak_pressure * 1e-6
    )?;
    if let Some(friction) = &of.friction {
        let [rolling, ribs, drag] = friction.parts;
        let film = match friction.film_ratio {
            0.0 => String::new(),
            ratio => format!(", film {:.3} um, {ratio:.2} of the roughness", friction.film * 1e6),
        };
        writeln!(
            f,
            "{:<16} friction torque {:.5} N m (rolling {rolling:.5}, ribs {ribs:.5}, drag {drag:.5}), {:.3} W{film}",
            "",
            friction.torque(),
            friction.loss
        )?;
    }
    let hours = hours.map_or(String::new(), |hours| format!(" ({hours:.4e} h)"));
    writeln!(
        f,
        "{:<16} L10r {:.4e} million revolutions{hours}; P {:.2} N, static safety {:.3}",
        "", of.life, of.equivalent_load, of.static_safety
    )?;
    write_stiffness(f, "axes of the shaft", &of.stiffness)
}

fn write_stiffness(f: &mut fmt::Formatter<'_>, axes: &str, stiffness: &Matrix6<f64>) -> fmt::Result {
    writeln!(
        f,
        "{:<16} stiffness, {axes}: Fx, Fy, Fz [N], Mx, My, Mz [N m] by x, y, z [m], rx, ry, rz [rad]",
        ""
    )?;
    for row in stiffness.row_iter() {
        let row: Vec<String> = row.iter().map(|value| format!("{value:12.4e}")).collect();
        writeln!(f, "{:<16} {}", "", row.join(" "))?;
    }
    Ok(())
}

impl MachineEquilibrium {
    fn write_links(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (names, [meshes, by_stiffness]) = &self.links;
        for (index, (name, link)) in names.iter().zip(&self.outputs.links).enumerate() {
            let on = &link.state.force;
            match index < *meshes {
                true => {
                    let teeth = &link.teeth;
                    writeln!(
                        f,
                        "\n{name:<16} force on the first gear x {:.4} y {:.4} z {:.4} N, normal to the teeth {:.4} N",
                        on[0], on[1], on[2], teeth.normal_force
                    )?;
                    let moments = teeth
                        .tilting_moments
                        .map(|moment| format!("y {:.5} z {:.5} N m", moment.y, moment.z));
                    writeln!(
                        f,
                        "{:<16} moment of the axial force on the first gear {}, on the second {}",
                        "", moments[0], moments[1]
                    )?;
                    write!(f, "{:<16} teeth misaligned by {:.2} urad", "", teeth.misalignment * 1e6)?;
                    match teeth.friction_power {
                        0.0 => writeln!(f)?,
                        power => writeln!(f, ", their friction takes {power:.3} W")?,
                    }
                }
                false if index >= meshes + by_stiffness => writeln!(
                    f,
                    "\n{name:<16} force on the first shaft x {:.2} y {:.2} z {:.2} N, moment x {:.5} y {:.5} z {:.5} N m, twisted by {:.3} mrad",
                    on[0],
                    on[1],
                    on[2],
                    on[3],
                    on[4],
                    on[5],
                    link.state.displacement[3] * 1e3
                )?,
                false => {
                    let how = match link.rollers().map(|rollers| rollers.friction) {
                        Some(Some(_)) => "rollers",
                        Some(None) => "rollers without friction",
                        None => "by its stiffness",
                    };
                    writeln!(
                        f,
                        "\n{name:<16} force on the shaft x {:.2} y {:.2} z {:.2} N, moment y {:.5} z {:.5} N m ({how})",
                        on[0], on[1], on[2], on[4], on[5]
                    )?;
                    if let Some(rollers) = link.rollers() {
                        write_rollers(f, rollers, link.hours())?;
                    }
                }
            }
        }
        Ok(())
    }

    fn write_bearing(
        &self,
        f: &mut fmt::Formatter<'_>,
        of: &BearingEquilibrium,
        seat: &super::PointOutput,
    ) -> fmt::Result {
        let (force, moment, d, tilt) = (of.force, of.moment, seat.displacement * 1e6, seat.tilt * 1e6);
        writeln!(
            f,
            "\n{:<16} force on the shaft x {:.2} y {:.2} z {:.2} N",
            of.name, force.x, force.y, force.z
        )?;
        writeln!(f, "{:<16} moment on it y {:.5} z {:.5} N m", "", moment.y, moment.z)?;
        writeln!(
            f,
            "{:<16} shaft at x {:.4} y {:.4} z {:.4} um, tilted by y {:.3} z {:.3} urad",
            "", d.x, d.y, d.z, tilt.y, tilt.z
        )?;
        let loads = of.outputs.balls.iter().map(|ball| ball.inner.load);
        let (least, most) =
            loads.fold((f64::INFINITY, 0.0f64), |(low, high), load| (low.min(load), high.max(load)));
        writeln!(
            f,
            "{:<16} ball loads {least:.2} to {most:.2} N, pressure {:.1} MPa, friction torque {:.5} N m",
            "",
            of.peak_pressure() * 1e-6,
            of.outputs.torque_of_losses()
        )?;
        if let Some(life) = &of.outputs.life {
            let [reference, modified] = of.hours.unwrap_or_default();
            let hours = |hours: Option<f64>| hours.map_or(String::new(), |hours| format!(" ({hours:.4e} h)"));
            let modified = life
                .modified
                .map_or(String::new(), |life| format!(", modified {life:.4e}{}", hours(modified)));
            writeln!(
                f,
                "{:<16} L10r {:.4e} million revolutions{}{modified}; P {:.2} N, static safety {:.3}",
                "",
                life.reference,
                hours(reference),
                life.equivalent_load,
                life.static_safety
            )?;
        }
        write_stiffness(f, "own axes", &of.stiffness)
    }
}
