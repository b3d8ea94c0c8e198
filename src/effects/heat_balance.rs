//! Temperatures of rings, balls, shaft and housing from the heat of friction: one temperature each, conductances between them.
//!
//! Rises are states, which `[growth]` and oils with a cold temperature follow. They change by an implicit Euler step after each step
//! of the motion, with the heat of that step: however small the heat capacities, they go to where heat balances and not beyond.
//!
//! Half of what a contact loses goes into each of its two surfaces; what balls lose in their pockets goes into the balls, and what a
//! cage loses on its lands into the ring: a cage has no temperature of its own. What the medium around the balls takes stays in it.

use std::f64::consts::PI;

use nalgebra::{SMatrix, SVector};
use serde::Deserialize;

use super::effect::{Effect, Getter, Info, Row, Setup};
use super::estimate::Outline;
use super::growth::RISE;
use super::heat::ByContact;
use super::keys::keys;
use super::reports::{PARTS, Rises, Warm};
use crate::schema::numbers::{Number, Place, Range};
use crate::schema::units::TemperatureRise;
use crate::schema::variable_units::{KELVIN, WATT};
use crate::schema::{BearingSection, Material, SceneError};

/// [-] integral of `(1 - t^2)^(1/4)` over an ellipse's half: B(1/2, 5/4).
const PASSING: f64 = 1.748_038;
/// Places in [`Rises`]; rings are 0 and 1.
const SHAFT: usize = 3;
const HOUSING: usize = 4;
const BALLS: usize = 2;

/// The section `[effects.heat_balance]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Section {
    /// [J/K] heat capacities of the rings and the balls; by usual dimensions and `specific_heat` if not given.
    pub inner_capacity: Option<f64>,
    /// See `inner_capacity`.
    pub outer_capacity: Option<f64>,
    /// See `inner_capacity`.
    pub balls_capacity: Option<f64>,
    /// [J/K] heat capacity of the shaft; without it the shaft stays as warm as `[growth]` has it.
    pub shaft_capacity: Option<f64>,
    /// [J/K] heat capacity of the housing; without it the housing stays as warm as `[growth]` has it.
    pub housing_capacity: Option<f64>,
    /// [J/(kg K)] specific heat of rings and balls.
    pub specific_heat: f64,
    /// [W/(m K)] thermal conductivity of rings and balls.
    pub conductivity: f64,
    /// [W/K] between inner ring and shaft; that of the seat by ISO 15312 if not given.
    pub inner_shaft: Option<f64>,
    /// [W/K] between outer ring and housing; that of the seat by ISO 15312 if not given.
    pub outer_housing: Option<f64>,
    /// [W/K] between shaft and surroundings, of a shaft with a heat capacity.
    pub shaft_surroundings: f64,
    /// [W/K] between housing and surroundings, of a housing with a heat capacity.
    pub housing_surroundings: f64,
    /// [W/K] between each of inner ring, outer ring, balls and an oil at the temperature of the surroundings; times the degree of
    /// lubrication where there is a film.
    pub oil: f64,
    /// \[K] rise of the temperature of the surroundings over that of the given dimensions.
    pub surroundings: TemperatureRise,
    /// [-] by how much everything warms faster: heat capacities are divided by it. Seconds then tell of minutes.
    pub faster: f64,
}

impl Default for Section {
    fn default() -> Self {
        Self {
            inner_capacity: None,
            outer_capacity: None,
            balls_capacity: None,
            shaft_capacity: None,
            housing_capacity: None,
            specific_heat: 460.0,
            conductivity: 46.0,
            inner_shaft: None,
            outer_housing: None,
            shaft_surroundings: 1.0,
            housing_surroundings: 5.0,
            oil: 0.0,
            surroundings: TemperatureRise(0.0),
            faster: 1.0,
        }
    }
}

keys! {
    /// Heat capacities and conductances; there with the effect only.
    "heat_balance" => section: Option<Section> = None,
}

/// A passing contact: what heat conducts through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passing {
    /// [m/N^(1/3)] semi-axes along and across rolling over the cube root of the load.
    pub semi_axes: [f64; 2],
}

/// The balance of a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatBalance {
    /// [J/K] heat capacities; infinite of parts that stay as warm as they are.
    capacities: Rises,
    /// [W/K] of both seats.
    seats: [f64; 2],
    /// [W/K] of shaft and housing to the surroundings.
    outside: [f64; 2],
    /// [W/K] of rings and balls to the oil.
    oil: f64,
    /// \[K] rise of the surroundings.
    surroundings: f64,
    /// [W/(m K)] conductivity and [m2/s] diffusivity of steel.
    steel: [f64; 2],
    contacts: [Passing; 2],
    /// [-] mean surface speed in the contacts over the speed of the races against each other times the pitch radius.
    rolling: f64,
    /// \[m] pitch radius.
    orbit: f64,
}

/// Quantities of a step that the balance needs.
#[derive(Clone, Copy, Debug)]
pub struct Heating<'a> {
    /// \[W] powers lost to friction.
    pub powers: &'a ByContact,
    /// The race that guides the cage: 0 the inner, 1 the outer one.
    pub guide: Option<usize>,
    /// [N^(1/2)] sums over all balls of the roots of their loads on each race, which conductances go with.
    pub loads: [f64; 2],
    /// [rad/s] speed of the races against each other.
    pub speed: f64,
    /// [-] degree of lubrication, 1 where no film is simulated.
    pub lubrication: f64,
}

impl Settings {
    /// The balance of a bearing.
    pub fn balance(
        &self,
        bearing: &BearingSection,
        ball: &Material,
        race: &Material,
        contacts: [Passing; 2],
    ) -> Option<HeatBalance> {
        let section = self.section.as_ref()?;
        let (pitch, diameter) = (bearing.pitch_diameter.0, bearing.ball_diameter.0);
        let outline = Outline::usual(pitch, diameter);
        let (Outline { bore, outside, width }, [inner_seat, outer_seat]) = (outline, outline.seats());
        let heat = section.specific_heat;
        // Rings up to the bottoms of their grooves.
        let ring = |inside: f64, outside: f64| {
            0.25 * PI * (outside * outside - inside * inside) * width * race.density.0 * heat
        };
        let balls = bearing.balls as f64 * PI / 6.0 * diameter.powi(3) * ball.density.0 * heat;
        let finite = |given: Option<f64>, usual: f64| given.unwrap_or(usual) / section.faster;
        let ratio = diameter / pitch;
        Some(HeatBalance {
            capacities: [
                finite(section.inner_capacity, ring(bore, pitch - diameter)),
                finite(section.outer_capacity, ring(pitch + diameter, outside)),
                finite(section.balls_capacity, balls),
                finite(section.shaft_capacity, f64::INFINITY),
                finite(section.housing_capacity, f64::INFINITY),
            ],
            seats: [section.inner_shaft.unwrap_or(inner_seat), section.outer_housing.unwrap_or(outer_seat)],
            outside: [section.shaft_surroundings, section.housing_surroundings],
            oil: section.oil,
            surroundings: section.surroundings.0,
            steel: [section.conductivity, section.conductivity / (race.density.0 * heat)],
            contacts,
            rolling: 0.5 * (1.0 - ratio * ratio),
            orbit: 0.5 * pitch,
        })
    }
}

impl HeatBalance {
    /// [W/K] conductances of the contacts of all balls with the inner and the outer ring: two bodies that pass each other, each a
    /// half-space to the heat, in contact for as long as a point takes through the ellipse (Carslaw and Jaeger 1959, section 2.5).
    pub fn through_contacts(&self, loads: [f64; 2], speed: f64) -> [f64; 2] {
        let [conductivity, diffusivity] = self.steel;
        let surface = self.rolling * self.orbit * speed.abs();
        [0, 1].map(|race| {
            let [along, across] = self.contacts[race].semi_axes;
            let passing = (2.0 * along * surface / (PI * diffusivity)).sqrt();
            conductivity * passing * across * PASSING * loads[race]
        })
    }

    /// Adds a step of `h` \[s].
    pub fn advance(&self, warm: &mut Warm, heating: &Heating<'_>, h: f64) {
        let Heating { powers, guide, loads, speed, lubrication } = *heating;
        let contacts = self.through_contacts(loads, speed);
        let mut heat = SVector::<f64, 5>::zeros();
        for race in 0..2 {
            let lands = if guide == Some(race) { powers.lands } else { 0.0 };
            heat[race] += 0.5 * powers.races[race] + lands;
            heat[BALLS] += 0.5 * powers.races[race];
        }
        heat[BALLS] += powers.pockets + powers.balls;
        let friction = heat.sum();

        let mut conductances = SMatrix::<f64, 5, 5>::zeros();
        for (a, b, conductance) in [
            (BALLS, 0, contacts[0]),
            (BALLS, 1, contacts[1]),
            (0, SHAFT, self.seats[0]),
            (1, HOUSING, self.seats[1]),
        ] {
            conductances[(a, a)] += conductance;
            conductances[(b, b)] += conductance;
            conductances[(a, b)] -= conductance;
            conductances[(b, a)] -= conductance;
        }
        let oil = self.oil * lubrication;
        let outside = SVector::from([oil, oil, oil, self.outside[0], self.outside[1]]);
        conductances += SMatrix::from_diagonal(&outside);
        heat += outside * self.surroundings - conductances * SVector::from(warm.rises);

        let mut matrix = conductances * h;
        for part in 0..5 {
            if self.capacities[part].is_finite() {
                matrix[(part, part)] += self.capacities[part];
            } else {
                matrix.row_mut(part).fill(0.0);
                matrix[(part, part)] = 1.0;
                heat[part] = 0.0;
            }
        }
        // Capacities above 0 on the diagonal of a matrix whose rows dominate: never singular.
        let Some(changes) = matrix.lu().solve(&(heat * h)) else { return };
        let mut stored = 0.0;
        for part in 0..5 {
            if self.capacities[part].is_finite() {
                warm.rises[part] += changes[part];
                stored += self.capacities[part] * changes[part];
            }
        }
        // What goes into a part that stays as warm as it is is out, too.
        warm.out = friction - stored / h;
    }
}

const CAPACITY: Range = Range::above(0.0, 1e9, "J/K");
const CONDUCTANCE: Range = Range::closed(0.0, 1e6, "W/K");

fn of(settings: &mut Settings, get: fn(&mut Section) -> Option<&mut f64>) -> Place<'_> {
    Place::Value(settings.section.as_mut().and_then(get))
}

impl Effect for Settings {
    const INFO: &'static Info = &Info {
        key: "effects.heat_balance",
        adds: "temperatures of rings, balls, shaft and housing from the heat of friction, which [growth] and the oil of [film] follow",
        states: "rises of temperature of five parts",
        source: "lumped heat balance; contacts after Carslaw and Jaeger 1959, seats after ISO 15312",
        price: "8 % of a step (thrust case), growth among them",
        example: "[effects]\nheat_balance = {}\n[growth]\n",
    };

    const NUMBERS: &'static [Number<Self>] = &[
        Number::fixed(
            "effects.heat_balance.inner_capacity",
            CAPACITY,
            "heat capacity of the inner ring",
            |s| of(s, |section| section.inner_capacity.as_mut()),
        ),
        Number::fixed(
            "effects.heat_balance.outer_capacity",
            CAPACITY,
            "heat capacity of the outer ring",
            |s| of(s, |section| section.outer_capacity.as_mut()),
        ),
        Number::fixed("effects.heat_balance.balls_capacity", CAPACITY, "heat capacity of all balls", |s| {
            of(s, |section| section.balls_capacity.as_mut())
        }),
        Number::fixed("effects.heat_balance.shaft_capacity", CAPACITY, "heat capacity of the shaft", |s| {
            of(s, |section| section.shaft_capacity.as_mut())
        }),
        Number::fixed(
            "effects.heat_balance.housing_capacity",
            CAPACITY,
            "heat capacity of the housing",
            |s| of(s, |section| section.housing_capacity.as_mut()),
        ),
        Number::fixed(
            "effects.heat_balance.specific_heat",
            Range::closed(10.0, 1e4, "J/(kg.K)"),
            "specific heat of rings and balls",
            |s| of(s, |section| Some(&mut section.specific_heat)),
        ),
        Number::fixed(
            "effects.heat_balance.conductivity",
            Range::closed(0.1, 1e3, "W/(m.K)"),
            "thermal conductivity of rings and balls",
            |s| of(s, |section| Some(&mut section.conductivity)),
        ),
        Number::fixed(
            "effects.heat_balance.inner_shaft",
            CONDUCTANCE,
            "conductance between inner ring and shaft",
            |s| of(s, |section| section.inner_shaft.as_mut()),
        ),
        Number::fixed(
            "effects.heat_balance.outer_housing",
            CONDUCTANCE,
            "conductance between outer ring and housing",
            |s| of(s, |section| section.outer_housing.as_mut()),
        ),
        Number::fixed(
            "effects.heat_balance.shaft_surroundings",
            CONDUCTANCE,
            "conductance between shaft and surroundings",
            |s| of(s, |section| Some(&mut section.shaft_surroundings)),
        ),
        Number::fixed(
            "effects.heat_balance.housing_surroundings",
            CONDUCTANCE,
            "conductance between housing and surroundings",
            |s| of(s, |section| Some(&mut section.housing_surroundings)),
        ),
        Number::fixed(
            "effects.heat_balance.oil",
            CONDUCTANCE,
            "conductance between each part and the oil",
            |s| of(s, |section| Some(&mut section.oil)),
        ),
        Number::fixed(
            "effects.heat_balance.surroundings",
            RISE,
            "rise of the temperature of the surroundings",
            |s| of(s, |section| Some(&mut section.surroundings.0)),
        ),
        Number::fixed(
            "effects.heat_balance.faster",
            Range::closed(1.0, 1e4, ""),
            "by how much everything warms faster",
            |s| of(s, |section| Some(&mut section.faster)),
        ),
    ];

    fn setting(&self) -> Option<String> {
        let Section { faster, surroundings, .. } = self.section.as_ref()?;
        let faster = if *faster == 1.0 { String::new() } else { format!(", {faster} times faster") };
        Some(format!("surroundings {} K{faster}", surroundings.0))
    }

    fn agree(&self, setup: &Setup<'_>) -> Result<(), SceneError> {
        if self.section.is_none() {
            return Ok(());
        }
        let key = "effects.heat_balance";
        if !setup.grows {
            let why =
                "it needs a section [growth], whose rises of temperature it computes from those given on";
            return Err(SceneError::conflict(key, why));
        }
        if setup.rises_follow_time {
            let why = "rises of temperature in [growth] are where it starts from: constants, no tables";
            return Err(SceneError::conflict(key, why));
        }
        Ok(())
    }

    fn headlines(&self) -> &'static [&'static str] {
        &["temperature_rise.inner", "temperature_rise.outer", "temperature_rise.balls", "heat.out"]
    }

    fn rows(&self) -> Vec<Row> {
        if self.section.is_none() {
            return vec![];
        }
        let rise = |(part, name): (usize, &str)| Row {
            name: format!("temperature_rise.{}", PARTS[part]),
            unit: KELVIN,
            nominal: 10.0,
            description: format!("rise of the temperature of {name} over that of the given dimensions"),
            get: Getter::new(move |reports| reports.warm.map_or(0.0, |warm| warm.rises[part])),
        };
        let names = ["the inner ring", "the outer ring", "the balls", "the shaft", "the housing"];
        let mut rows: Vec<Row> = names.into_iter().enumerate().map(rise).collect();
        rows.push(Row {
            name: "heat.out".into(),
            unit: WATT,
            nominal: 10.0,
            description: "heat that goes out to the surroundings, to the oil and to parts as warm as these; what drag heats is no part of it"
                .into(),
            get: Getter::new(|reports| reports.warm.map_or(0.0, |warm| warm.out)),
        });
        rows
    }
}
