//! The one table of variables: names, units, causality, and how each is read and set.
//!
//! Model description, value references, CSV headers and the documentation of a package all derive from it.

mod level_rows;
mod link_rows;
mod machine;
mod race_rows;
mod race_setting;
mod rows;
mod shaft_rows;

use thiserror::Error;

use crate::effects::growth::RISE;
use crate::effects::{Getter, InputRow, Reports};
use crate::model::bodies::{PerRace, Race};
use crate::scene::{Drive, Group, Scene};
use crate::schema::numbers::{FRICTION, Parameter, Range, Variability};
use crate::schema::variable_units::Unit;
use crate::simulation::Simulation;
use crate::simulation::inputs::Inputs;
use crate::simulation::losses::Losses;
use crate::simulation::margins::Margins;
use crate::simulation::outputs::Outputs;
pub use machine::{MachineGroup, MachineVariables};
use race_rows::RaceVariable;
pub use race_setting::InputKind;
use race_setting::RaceSetting;
pub use shaft_rows::{ShaftSource, quoted, rows as rows_of_shaft};

/// FMI causality.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Set by the importer.
    Input,
    /// Read by the importer.
    Output,
    /// Read by the importer, and of interest to nobody else: no master offers it for connections.
    Local,
    /// A number of the scene, set by the importer before the start or, if tunable, between steps.
    Parameter,
}

/// FMI type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `fmi2Real`.
    Real,
    /// `fmi2Integer`.
    Integer,
}

type FromOutputs = fn(&Outputs) -> f64;
/// From the state at a communication point and its sums, without all outputs: the same bits.
type FromPoint = fn(&Simulation) -> f64;

/// Where a variable's value comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// A component of a quantity of a race.
    Race(Race, &'static RaceVariable, usize),
    /// The friction coefficient.
    Friction,
    /// Rise of the temperature of a part, by its index.
    Rise(usize),
    /// The bearing as a whole; from less than all its outputs, where less tells it.
    Bearing(FromOutputs, Option<FromPoint>),
    /// An input of an effect.
    Input(InputRow),
    /// Losses of a bearing.
    Loss(fn(&Losses) -> f64),
    /// How far a bearing is from where its run ends.
    Margin(fn(&Margins) -> f64),
    /// Value that an effect reports.
    Effect(Getter),
    /// A number of the scene.
    Parameter(Parameter),
    /// The shaft of a system.
    Shaft(ShaftSource),
}

/// One variable.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Structured name.
    pub name: String,
    /// Unit.
    pub unit: Unit,
    /// Real or integer.
    pub kind: Kind,
    /// Input or output.
    pub causality: Causality,
    /// \[unit] typical size.
    pub nominal: f64,
    /// \[unit] smallest and largest value, where there are some.
    pub limits: [Option<f64>; 2],
    /// One sentence.
    pub description: String,
    /// Where the value comes from.
    pub source: Source,
}

/// Why an input was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum InputError {
    /// NaN or infinite.
    #[error("{name} = {value} is not a finite number")]
    NotFinite {
        /// Variable.
        name: String,
        /// Value.
        value: f64,
    },
    /// The quaternion is not near unit length.
    #[error("{name} has norm {norm}: a unit quaternion is expected, to within 0.001")]
    Quaternion {
        /// Variable without component.
        name: String,
        /// [-] its norm.
        norm: f64,
    },
    /// A negative friction coefficient, or one that no surface has.
    #[error("friction = {0} is out of range: allowed is {FRICTION}")]
    Friction(f64),
    /// An input of an effect beyond what it allows.
    #[error("{name} = {value} is out of range: allowed is {range}")]
    Range {
        /// Variable.
        name: String,
        /// Value.
        value: f64,
        /// Allowed values.
        range: Range,
    },
    /// An input of a bearing of a system.
    #[error("bearing {name}: {source}")]
    Bearing {
        /// The bearing.
        name: String,
        /// Fault of its input.
        source: Box<InputError>,
    },
    /// A rise of temperature that no bearing stands.
    #[error("{name} = {value} K is out of range: allowed is {RISE}")]
    Rise {
        /// Variable.
        name: String,
        /// \[K] value.
        value: f64,
    },
}

/// Value references of the inputs among rows.
fn references_of_inputs(rows: &[Variable]) -> Vec<usize> {
    let inputs = rows.iter().enumerate().filter(|(_, row)| row.causality == Causality::Input);
    inputs.map(|(index, _)| index).collect()
}

/// The table of a scene.
#[derive(Clone, Debug)]
pub struct Variables {
    rows: Vec<Variable>,
    /// Indices of the inputs among them: a few where every ball has variables of its own.
    inputs: Vec<usize>,
}

impl Variables {
    /// The variables of a scene's package.
    pub fn new(scene: &Scene) -> Self {
        let mut table = Self::moving(scene, scene.effects.per_ball.on);
        table.add_parameters(scene);
        table
    }

    /// The variables that can change in a run, with or without those of every ball.
    pub fn moving(scene: &Scene, per_ball: bool) -> Self {
        Self::of_bearing(scene, per_ball, |_| false)
    }

    /// The variables of a bearing of a system: structures carry its inner race, perhaps its outer one. Numbers of the integration and the
    /// motion of the frame are those of the system.
    pub fn carried(scene: &Scene, carried: impl Fn(Race) -> bool) -> Self {
        let mut table = Self::of_bearing(scene, scene.effects.per_ball.on, carried);
        table.add_parameters(scene);
        let shared = ["solver.", "frame.", "effects.frame."];
        table.rows.retain(|row| !shared.iter().any(|prefix| row.name.starts_with(prefix)));
        table.inputs = references_of_inputs(&table.rows);
        table
    }

    fn of_bearing(scene: &Scene, per_ball: bool, carried: impl Fn(Race) -> bool) -> Self {
        let mut table = Self { rows: vec![], inputs: vec![] };
        for race in Race::BOTH {
            table.add_race(scene, race, carried(race));
        }
        table.add_bearing(scene);
        table.add_effects(scene, per_ball);
        table.add_temperatures(scene);
        table.inputs = references_of_inputs(&table.rows);
        table
    }

    /// Rows; the index of a row is its value reference.
    pub fn rows(&self) -> &[Variable] {
        &self.rows
    }

    /// Value references of the inputs.
    pub fn input_references(&self) -> &[usize] {
        &self.inputs
    }

    /// The inputs with their value references.
    pub fn inputs_with_references(&self) -> impl Iterator<Item = (usize, &Variable)> + Clone {
        self.inputs.iter().map(|&index| (index, &self.rows[index]))
    }

    /// Value of a row: inputs from the inputs as set, outputs from the outputs.
    pub fn value(&self, row: &Variable, inputs: &Inputs, outputs: &Outputs) -> f64 {
        self.value_with(row, inputs, outputs, &outputs.reports())
    }

    fn value_with(&self, row: &Variable, inputs: &Inputs, outputs: &Outputs, reports: &Reports<'_>) -> f64 {
        match &row.source {
            Source::Bearing(get, _) => get(outputs),
            Source::Loss(get) => get(&outputs.losses),
            Source::Margin(get) => get(&outputs.margins),
            Source::Effect(getter) => getter.get(reports),
            Source::Race(race, quantity, component) if row.causality != Causality::Input => {
                (quantity.read)(&outputs[*race], *component)
            }
            // A bearing by itself has no others.
            _ => self.input_value(row, inputs).unwrap_or(f64::NAN),
        }
    }

    /// Value of a row at the last communication point of a bearing. What its state or its sums tell is read from these, without all other
    /// outputs.
    pub fn value_of(&self, row: &Variable, simulation: &Simulation) -> f64 {
        let inputs = simulation.inputs();
        match (&row.source, simulation.known_outputs()) {
            (_, Some(outputs)) => self.value(row, inputs, outputs),
            (Source::Race(race, quantity, component), _) if row.causality != Causality::Input => {
                (quantity.read)(&simulation.race_output(*race), *component)
            }
            (Source::Bearing(_, Some(get)), _) => get(simulation),
            (Source::Loss(get), _) => get(&simulation.sums().losses),
            _ => match self.input_value(row, inputs) {
                Some(given) => given,
                None => self.value(row, inputs, simulation.outputs()),
            },
        }
    }

    /// Value of a row that no outputs are needed for: of an input as set, of a parameter at the start.
    pub fn input_value(&self, row: &Variable, inputs: &Inputs) -> Option<f64> {
        match &row.source {
            Source::Friction => Some(inputs.friction),
            Source::Rise(part) => Some(inputs.rises.map_or(0.0, |rises| rises[*part])),
            Source::Parameter(parameter) => Some(parameter.start),
            Source::Input(input) => Some((input.get)(&inputs.effects, input.place)),
            Source::Race(race, RaceVariable { input: Some(access), .. }, component)
                if row.causality == Causality::Input =>
            {
                Some((access.get)(&inputs[*race], *component))
            }
            Source::Race(..)
            | Source::Bearing(..)
            | Source::Loss(_)
            | Source::Margin(_)
            | Source::Effect(_)
            | Source::Shaft(_) => None,
        }
    }

    /// Values of all rows.
    pub fn values(&self, inputs: &Inputs, outputs: &Outputs) -> Vec<f64> {
        let reports = outputs.reports();
        self.rows.iter().map(|row| self.value_with(row, inputs, outputs, &reports)).collect()
    }

    /// Writes the parameters among the values of all rows into a scene.
    pub fn set_parameters(&self, scene: &mut Scene, values: &[f64]) {
        for (row, value) in self.rows.iter().zip(values) {
            if let Source::Parameter(parameter) = &row.source {
                scene.set_number(parameter.key, *value);
            }
        }
    }

    /// Rates of all rows that inputs were given with: those of a twist.
    pub fn rates(&self, inputs: &Inputs) -> Vec<f64> {
        let rate = |row: &Variable| match (row.causality, &row.source) {
            (Causality::Input, Source::Race(race, RaceVariable { input: Some(access), .. }, component)) => {
                (access.rate)(&inputs[*race], *component)
            }
            (Causality::Input, Source::Input(input)) => (input.rate)(&inputs.effects, input.place),
            _ => 0.0,
        };
        self.rows.iter().map(rate).collect()
    }

    /// Sets the pose and the twist of races that are given to where they are now, in the values of all rows.
    pub fn follow(&self, values: &mut [f64], simulation: &Simulation) {
        for (index, row) in self.inputs_with_references() {
            let Source::Race(race, quantity, component) = &row.source else { continue };
            // A prescribed spin is no pose: it holds.
            if quantity.components.len() > 1 && self.pose_is_given(*race) {
                values[index] = (quantity.read)(&simulation.race_output(*race), *component);
            }
        }
    }

    /// A race whose pose is an input.
    pub fn pose_is_given(&self, race: Race) -> bool {
        self.inputs_with_references().any(|(_, row)| {
            row.input_kind() == Some(InputKind::Velocity)
                && matches!(row.source, Source::Race(of, _, _) if of == race)
        })
    }

    /// A race whose orientation is a quaternion of zeros among the values of all rows: an input that nothing is connected to.
    pub fn zero_quaternion(&self, values: &[f64]) -> Option<Race> {
        Race::BOTH.into_iter().find(|race| {
            let mut components = self.inputs_with_references().filter(|(_, row)| {
                row.input_kind() == Some(InputKind::Quaternion)
                    && matches!(row.source, Source::Race(of, _, _) if of == *race)
            });
            components.next().is_some_and(|(first, _)| values[first] == 0.0)
                && components.all(|(index, _)| values[index] == 0.0)
        })
    }

    /// Turns the values of all rows (those of outputs are ignored) and their rates into inputs, on top of `base`.
    ///
    /// # Errors
    /// If a value is not finite, a quaternion far from unit length, or friction out of range; names the variable.
    pub fn inputs(&self, values: &[f64], rates: &[f64], base: &Inputs) -> Result<Inputs, InputError> {
        let mut inputs = *base;
        let mut races = PerRace::new(|race| RaceSetting::new(&base[race]));
        for (index, row) in self.inputs_with_references() {
            let (value, rate) = (values[index], rates[index]);
            for number in [value, rate] {
                if !number.is_finite() {
                    return Err(InputError::NotFinite { name: row.name.clone(), value: number });
                }
            }
            match &row.source {
                Source::Friction if FRICTION.contains(value) => inputs.friction = value,
                Source::Friction => return Err(InputError::Friction(value)),
                Source::Input(InputRow { range: Some(range), .. }) if !range.contains(value) => {
                    return Err(InputError::Range { name: row.name.clone(), value, range: *range });
                }
                Source::Input(input) => (input.set)(&mut inputs.effects, input.place, value, rate),
                Source::Rise(part) if RISE.contains(value) => {
                    if let Some(rises) = &mut inputs.rises {
                        rises[*part] = value;
                    }
                }
                Source::Rise(_) => return Err(InputError::Rise { name: row.name.clone(), value }),
                Source::Race(race, RaceVariable { input: Some(access), .. }, component) => {
                    (access.set)(&mut races[*race], *component, value, rate);
                }
                _ => {}
            }
        }
        inputs.inner = races.inner.finish(Race::Inner)?;
        inputs.outer = races.outer.finish(Race::Outer)?;
        Ok(inputs)
    }
}

/// Range, variability and start of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offered {
    /// Allowed values.
    pub range: Range,
    /// When it may be set.
    pub variability: Variability,
    /// Its value in the scene.
    pub start: f64,
}

impl Variable {
    /// Range, variability and start of a parameter; none of other variables.
    pub fn offered(&self) -> Option<Offered> {
        let (range, variability, start) = match &self.source {
            Source::Parameter(own) => (own.range, own.variability, own.start),
            Source::Shaft(ShaftSource::Number(own)) => (own.number.range, own.number.variability, own.start),
            _ => return None,
        };
        Some(Offered { range, variability, start })
    }

    /// Kind of an input; none for other variables.
    pub fn input_kind(&self) -> Option<InputKind> {
        match &self.source {
            _ if self.causality != Causality::Input => None,
            Source::Friction => Some(InputKind::Friction),
            Source::Rise(_) => Some(InputKind::Temperature),
            Source::Race(_, RaceVariable { input, .. }, _) => input.map(|access| access.kind),
            _ => None,
        }
    }

    /// \[unit] a small change of an input of an effect; none for other variables.
    pub fn small_change(&self) -> Option<f64> {
        match &self.source {
            Source::Input(input) => Some(input.change),
            _ => None,
        }
    }

    /// Allowed values of an input; none where every number is allowed, and for other variables.
    pub fn allowed(&self) -> Option<Range> {
        match &self.source {
            Source::Friction => Some(FRICTION),
            Source::Input(input) => input.range,
            _ => None,
        }
    }

    /// Group that an input is given with in a scene; none for other variables.
    pub fn group(&self, scene: &Scene) -> Option<Group> {
        match &self.source {
            _ if self.causality != Causality::Input => None,
            Source::Friction => Some(Group::Friction),
            Source::Input(input) => Some(input.group),
            Source::Rise(_) => Some(Group::Temperatures),
            // A race with a given motion has its speed with it.
            Source::Race(race, RaceVariable { input: Some(access), .. }, _) => {
                let section = if *race == Race::Inner { &scene.inner } else { &scene.outer };
                match section.drive {
                    Drive::Pose => Some(Group::Tilts),
                    Drive::Wrench => Some(access.group),
                    // What is scripted there is no input.
                    Drive::Fixed | Drive::Hinge => None,
                }
            }
            _ => None,
        }
    }
}
