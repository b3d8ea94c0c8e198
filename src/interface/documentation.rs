//! The page that a package brings along: interface, frames, effects, limits, parameters.

use crate::effects::AnyEffect;
use crate::interface::model_description::{Wanted, is_exported};
use crate::interface::variables::{Causality, MachineVariables, Offered, Variable, Variables};
use crate::scene::{Dependencies, Drive, Orientation, Scene};
use crate::schema::numbers::Variability;
use crate::simulation::system::System;

const STYLE: &str = "body{font:16px sans-serif;max-width:64em;margin:2em auto;padding:0 1em}\
    td,th{text-align:left;padding:.2em .6em;vertical-align:top}tr:nth-child(even){background:#f3f5f7}\
    pre{background:#f3f5f7;padding:1em;overflow:auto}";

/// Text as it stands in a page: characters that mean something in HTML are written out.
pub fn escape(text: &str) -> String {
    quick_xml::escape::escape(text).into_owned()
}

fn drive(drive: Drive) -> &'static str {
    match drive {
        Drive::Pose => "pose and twist are inputs, the bearing's wrench is an output",
        Drive::Wrench => "a rigid body: applied wrench and spin speed are inputs, pose and twist are outputs",
        Drive::Fixed => "rests in its frame",
        Drive::Hinge => {
            "a rigid body on a hinge to its frame: pose, twist and the reaction of the hinge are outputs"
        }
    }
}

/// The row of an effect, on or off.
fn effect(effect: &dyn AnyEffect) -> String {
    let (info, setting) = (effect.info(), effect.setting().unwrap_or_else(|| "off".into()));
    let cells = [&setting, info.adds, info.states, info.source, info.price]
        .map(|text| format!("<td>{}</td>", escape(text)));
    format!("<tr><td><code>{}</code></td>{}</tr>\n", escape(info.key), cells.concat())
}

/// How orientations of races are written.
fn orientation(orientation: Orientation) -> &'static str {
    match orientation {
        Orientation::Shaft => {
            "The orientation of a race is the rotation vector of its axis (<code>rotation.y</code>, <code>rotation.z</code>), \
             with its rates, and the speed at which it spins about that axis; the angle about the axis is integrated inside. \
             Zeros are a legal start. Scenes may ask for quaternions or Cardan angles: <code>interface.orientation</code>."
        }
        Orientation::Quaternion => {
            "Orientations are unit quaternions w, x, y, z from race to world axes; the pose of a race that spins has to turn \
             with it. Only zeros, as of an input that nothing is connected to, mean no rotation."
        }
        Orientation::Cardan => {
            "Orientations are Cardan angles: the axis tilts by y and z, in this order, then the race turns about it by x, \
             without limit; the angle x of a race that spins has to grow with it."
        }
    }
}

/// Rows of variables that are wanted, with a column of their own between unit and meaning.
fn table(
    rows: &[Variable],
    wanted: impl Fn(&Variable) -> bool,
    column: impl Fn(&Variable) -> String,
) -> String {
    let cells = |row: &Variable| {
        let (name, unit, meaning) = (escape(&row.name), escape(row.unit.name), escape(&row.description));
        let column = escape(&column(row));
        format!("<tr><td><code>{name}</code></td><td>{unit}</td><td>{column}</td><td>{meaning}</td></tr>\n")
    };
    rows.iter().filter(|row| wanted(row)).map(cells).collect()
}

/// Inputs, locals, and outputs that are wanted.
fn interface(rows: &[Variable], wanted: Wanted<'_>) -> String {
    table(
        rows,
        |row| row.causality != Causality::Parameter && is_exported(row, wanted),
        |row| match row.causality {
            Causality::Input => "input".into(),
            Causality::Local => "local".into(),
            Causality::Output | Causality::Parameter => "output".into(),
        },
    )
}

/// The page of a system's package, with some of its outputs.
pub fn system_page(system: &System, wanted: Wanted<'_>) -> String {
    let (scene, variables) = (system.scene(), MachineVariables::new(system));
    let title = if scene.title.is_empty() { "Shaft on ball bearings" } else { &scene.title };
    let against = scene.bearings.iter().filter(|bearing| bearing.mounting.direction.sign() < 0.0);
    let against: Vec<&str> = against.map(|bearing| bearing.name.as_str()).collect();
    let turned = match against.is_empty() {
        true => "Here the axes of all bearings are parallel to those of the shaft.".to_string(),
        false => format!("Here this is so of: {}.", escape(&against.join(", "))),
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n\
         <p>A shaft on {bearings} ball bearings, in one implicit step. FMI co-simulation, made by roulement {version}.</p>\n\
         <h2>Frames</h2>\n<p>Right-handed, x is the axis of the shaft. Loads, points and seats are in these axes, about which the shaft \
         does not turn them. A bearing has axes of its own, with its centre as the origin, and all its variables are in them: those of \
         a bearing that is mounted against the shaft's axis are turned by half a turn about z (x and y change their sign). {turned}</p>\n\
         <h2>Steps</h2>\n<p>Inputs are those at the start of a communication step; outputs those at its end. Forces, moments, speed and \
         torque move linearly to the given values within the step. Steps may vary; they are divided internally by error control. A step \
         that cannot be finished ends with fmi2Discard at the last time reached. The FMU state holds everything: a replay gives the same \
         bits. Directional derivatives are those of the last step, of outputs by inputs.</p>\n\
         <p>What the file gives as a table over time is played here too, exactly in every internal step: the force and moment of each \
         named load, the speed or torque of the shaft, and what each bearing has as a script. Setting an input ends the script of \
         the load, of the drive, or of the group of inputs of its bearing.</p>\n\
         <h2>Interface</h2>\n<table><tr><th>name</th><th>unit</th><th>causality</th><th>meaning</th></tr>\n{interface}\
         </table>\n\
         <h2>Parameters</h2>\n<table><tr><th>name</th><th>unit</th><th>start (range), may be set</th><th>meaning</th></tr>\n{parameters}</table>\n\
         <h2>System</h2>\n<pre>{source}</pre>\n\
         <p>Licences of what this package is linked from: <a href=\"licenses/license.txt\">licenses/license.txt</a>.</p>\n\
         </body></html>\n",
        title = escape(title),
        bearings = scene.bearings.len(),
        version = env!("CARGO_PKG_VERSION"),
        interface = interface(variables.rows(), wanted),
        parameters = parameters(variables.rows()),
        source = escape(&scene.source),
    )
}

/// The table of parameters among rows.
fn parameters(rows: &[Variable]) -> String {
    let start = |row: &Variable| {
        row.offered().map_or_else(String::new, |Offered { range, variability, start }| {
            let when = match variability {
                Variability::Fixed => "before the start",
                Variability::Tunable => "between steps too",
            };
            format!("{start} ({} to {}), {when}", range.low, range.high)
        })
    };
    table(rows, |row| row.causality == Causality::Parameter, start)
}

/// The page of a scene's package, with some of its outputs.
pub fn page(scene: &Scene, wanted: Wanted<'_>) -> String {
    let title = if scene.title.is_empty() { "Ball bearing" } else { &scene.title };
    let variables = Variables::new(scene);
    let interface = interface(variables.rows(), wanted);
    let parameters = parameters(variables.rows());
    let dependencies = match scene.interface.dependencies {
        Dependencies::Point => {
            "The dependencies of outputs in modelDescription.xml are those at a communication point, where none follows an \
             input before the next step."
        }
        Dependencies::Step => {
            "The dependencies of outputs in modelDescription.xml are where these derivatives can be other than zero."
        }
    };
    let effects: String = scene.effects.each().into_iter().map(effect).collect();
    let found: String =
        scene.effects.auto.found.iter().map(|found| format!("<p>{}</p>\n", escape(found))).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n\
         <p>A ball bearing in three dimensions (Bovet, Linares, Zamponi, Mermoz 2013): {balls} balls as rigid bodies \
         between two races, Hertz contact, rolling contact with creep and spin, implicit time integration. FMI \
         co-simulation, made by roulement {version}.</p>\n\
         <h2>Frames</h2>\n<p>Right-handed, x is the bearing axis, the origin is the bearing centre; all components are in \
         these world axes. Azimuths count from +y towards +z. A force or moment of a race is what the bearing exerts on \
         it, about the origin of the race's frame. {orientation}</p>\n\
         <p>Inner race: {inner}. Outer race: {outer}.</p>\n\
         <h2>Steps</h2>\n<p>Inputs are those at the start of a communication step; outputs those at its end. A race whose \
         pose is given moves, without a jump, along a cubic from where it is to where the given pose leads with the given \
         twist (and its derivative, if given by fmi2SetRealInputDerivatives) by the end of the step. Applied wrenches and \
         speeds move linearly to the given values within the step, and so do temperatures. Steps may vary; they are divided internally by error \
         control. A step that cannot be finished ends with fmi2Discard at the last time reached. The FMU state holds \
         everything: a replay gives the same bits. fmi2GetDirectionalDerivative gives the derivatives of all real outputs \
         by all inputs over the last step. {dependencies}</p>\n\
         <p>What the scene gives as a table over time is played here too, exactly in every internal step, unless \
         <code>interface.inputs</code> of the scene leaves it to the master: applied loads (<code>loads</code>), the \
         speed of a race under a wrench (<code>speeds</code>), poses, twists and speed in pose drive (<code>tilts</code>), \
         <code>friction</code>, <code>temperatures</code>. Setting an input of such a group, or a derivative of one, ends the script of the whole \
         group; its other inputs stay at their last values. The log tells which scripts are played. An input that a script \
         gives reads as its value at the communication point, and directional derivatives by it are zero.</p>\n\
         <h2>Effects</h2>\n<table><tr><th>key</th><th>here</th><th>adds</th><th>states</th><th>source</th><th>price</th></tr>\n\
         {effects}</table>\n{found}\
         <h2>Limits</h2>\n<ul><li>Rigid rings: the raceways do not bend; they grow by temperatures and fits only as <code>[growth]</code> says. No \
         lubricant film.</li>\n\
         <li>A shaft on the bearing is moved by leapfrog, or at least by velocity first and then position: stable while a \
         step is shorter than the reciprocal of its angular frequency on the bearing (70 us for a shaft of 1 kg). A force held \
         constant over the step, position and velocity both from it, is unstable in all but steps a hundred times shorter; \
         the directional derivatives serve for longer steps.</li>\n\
         <li>What is not finite is refused, and a quaternion that is off by more than 0.001 in norm. A pose that contradicts \
         its velocities is logged, once.</li>\n\
         <li>The number of balls, the drives and the effects are fixed by the scene; everything under Parameters can be \
         changed.</li></ul>\n\
         <h2>Interface</h2>\n<table><tr><th>name</th><th>unit</th><th>causality</th><th>meaning</th></tr>\n{interface}\
         </table>\n\
         <h2>Parameters</h2>\n<table><tr><th>name</th><th>unit</th><th>start (range), may be set</th><th>meaning</th></tr>\n\
         {parameters}</table>\n\
         <h2>Scene</h2>\n<pre>{scene}</pre>\n\
         <p>Licences of what this package is linked from: <a href=\"licenses/license.txt\">licenses/license.txt</a>.</p>\n\
         </body></html>\n",
        orientation = orientation(scene.interface.orientation),
        balls = scene.bearing.balls,
        version = env!("CARGO_PKG_VERSION"),
        inner = drive(scene.inner.drive),
        outer = drive(scene.outer.drive),
        scene = escape(&scene.source),
        title = escape(title),
    )
}
