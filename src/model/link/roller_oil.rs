//! Films of a roller bearing, in plain numbers with derivatives by hand: of lines on races, and of roller ends on ribs, with their friction.

use std::f64::consts::PI;

use crate::numerics::elementary::{asinh, exp, ln, pow};

/// \[Pa] E' of two bodies of bearing steel, 206 GPa and 0.3.
pub const MODULUS: f64 = 206e9 / (1.0 - 0.3 * 0.3);
/// [-] logarithm of the load over `E' R^2` below which films of ribs do not grow any more, 1e-9; and that of 3/2.
const LOG_LEAST_RIB: f64 = -20.723_265_836_946_414;
const LOG_3_HALVES: f64 = 0.405_465_108_108_164_4;
/// \[Pa] pressure of Roelands' law, and the logarithm of its pole with the opposite sign.
const ROELANDS: [f64; 2] = [1.962e8, 9.67];
/// [-] largest logarithm of the viscosity over that without pressure.
const LARGEST_GROWTH: f64 = 200.0;
/// [-] largest loss of film by heating to which the fit of Gupta and others holds; beyond, it comes near to a whole loss without reaching it.
const LARGEST_LOSS: f64 = 0.9;

/// An oil, and the surfaces that it parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lubricant {
    /// [Pa s] dynamic viscosity at the inlets.
    pub viscosity: f64,
    /// [1/K] fall of the viscosity with temperature.
    pub temperature_viscosity: f64,
    /// [W/(m K)] thermal conductivity.
    pub conductivity: f64,
    /// [1/Pa] growth of the viscosity with pressure.
    pub pressure_viscosity: f64,
    /// \[Pa] Eyring stress.
    pub eyring_stress: f64,
    /// [-] largest shear stress over pressure.
    pub limiting_shear: f64,
    /// \[m] roughness of both surfaces together, root mean square.
    pub roughness: f64,
    /// [s/rad] exponent of starvation over the speed of the rings.
    pub starvation: f64,
}

/// A quantity with its derivative by a load and, over the quantity, by the logarithm of the speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Of {
    /// Value.
    pub value: f64,
    /// Derivative by the load.
    pub by_load: f64,
    /// Derivative by the logarithm of the speed.
    pub by_speed: f64,
}

impl Lubricant {
    /// [-] thermal loading of an inlet whose surfaces have a speed [m/s].
    fn heat(&self, u: f64) -> f64 {
        self.viscosity * self.temperature_viscosity * u * u / self.conductivity
    }

    /// \[N, N^(1/2)] elastic rolling force of a line over the power of the load, and rigid one over its root, for a radius of curvature and a length \[m] and surfaces of a speed [m/s].
    pub fn rolling(&self, [radius, length]: [f64; 2], u: f64) -> [f64; 2] {
        let stiffened = pow(self.pressure_viscosity * self.viscosity * u / radius, 0.658);
        let elastic = 4.318 / self.pressure_viscosity * stiffened * radius * length;
        [elastic, 2.08 * (self.viscosity * u * length).sqrt()]
    }

    /// [-] what heating (Aihara 1987) and starvation leave of rolling forces at a speed [rad/s] of the rings and one of the surfaces [m/s]; and its logarithmic derivative by the speed.
    pub fn left(&self, s: f64, u: f64) -> [f64; 2] {
        let heated = 0.29 * pow(self.heat(u), 0.78);
        let starved = self.starvation * s;
        [exp(-starved) / (1.0 + heated), -starved - 1.56 * heated / (1.0 + heated)]
    }

    /// \[m] central film of a line (Dowson and Toyoda 1979), and its least one (Dowson 1968); both recalled, with the heating of Gupta and others (1992).
    pub fn films(&self, [radius, length]: [f64; 2], load: f64, u: f64) -> [f64; 2] {
        let speed = self.viscosity * u / (MODULUS * radius);
        let stiffening = self.pressure_viscosity * MODULUS;
        let w = load / (MODULUS * radius * length);
        let left = heating((w / (2.0 * PI)).sqrt(), powers_of_heat(self.heat(u))).value;
        let central = 3.06 * pow(speed, 0.69) * pow(stiffening, 0.56) * pow(w, -0.10);
        let least = 2.65 * pow(speed, 0.70) * pow(stiffening, 0.54) * pow(w, -0.13);
        [central, least].map(|film| film * radius * left)
    }
}

/// Films between roller ends and ribs at a speed: balls on planes.
#[derive(Clone, Copy, Debug)]
pub struct RibFilm {
    oil: Lubricant,
    /// \[m] radius of the ball.
    radius: f64,
    /// Powers of the thermal loading that its heating has.
    heats: [f64; 2],
    /// \[m] central and least film over the power of the load and heating.
    films: [f64; 2],
    /// [-] logarithm of the viscosity over Roelands' pole, and his exponent.
    growth: f64,
    exponent: f64,
}

impl RibFilm {
    /// Films of an oil, for a radius \[m] and surfaces of a speed [m/s] in the mean.
    pub fn new(oil: &Lubricant, radius: f64, u: f64) -> Self {
        let speed = ln(oil.viscosity * u / (MODULUS * radius));
        let stiffening = ln(oil.pressure_viscosity * MODULUS);
        let [of_pressure, pole] = ROELANDS;
        let growth = ln(oil.viscosity) + pole;
        Self {
            oil: *oil,
            radius,
            heats: powers_of_heat(oil.heat(u)),
            films: [
                2.69 * (1.0 - 0.61 * exp(-0.73)) * radius * exp(0.67 * speed + 0.53 * stiffening),
                3.63 * (1.0 - exp(-0.68)) * radius * exp(0.68 * speed + 0.49 * stiffening),
            ],
            growth,
            exponent: oil.pressure_viscosity * of_pressure / growth,
        }
    }

    /// [-] friction coefficients under a load \[N] above 0 of two contacts that slip with these speeds [m/s], with that of dry surfaces. All speeds go with that of the rings.
    pub fn friction(&self, load: f64, slips: [f64; 2], dry: f64) -> [Of; 2] {
        let Self { oil, radius, growth, exponent, .. } = self;
        // Hertz: the pressure goes with the cube root of the load.
        let logarithm = ln(load / (MODULUS * radius * radius));
        let half_width = radius * exp((logarithm + LOG_3_HALVES) / 3.0);
        let pressure = load / (PI * half_width * half_width);
        let (logarithm, grows) =
            if logarithm > LOG_LEAST_RIB { (logarithm, 1.0) } else { (LOG_LEAST_RIB, 0.0) };
        let heated = heating(1.5 * pressure / MODULUS, self.heats);
        let film = |which: usize, [of_speed, of_load]: [f64; 2]| Of {
            value: self.films[which] * heated.value * exp(of_load * logarithm),
            by_load: of_load * grows + heated.by_load / 3.0,
            by_speed: of_speed + 2.0 * heated.by_speed,
        };
        let [central, least] = [film(0, [0.67, -0.067]), film(1, [0.68, -0.073])];
        // Roelands, and its slope by the logarithm of the pressure.
        let [of_pressure, _] = ROELANDS;
        let power = pow(1.0 + pressure / of_pressure, *exponent);
        let (thicker, slope) = match growth * (power - 1.0) {
            most if most >= LARGEST_GROWTH => (LARGEST_GROWTH, 0.0),
            none if none <= 0.0 => (0.0, 0.0),
            thicker => (thicker, growth * exponent * power * pressure / (of_pressure + pressure)),
        };
        let over_slip = oil.viscosity * exp(thicker) / (central.value * oil.eyring_stress);
        let ratio = least.value / oil.roughness;
        let touching = 1.0 / ((1.0 + ratio) * (1.0 + ratio));
        slips.map(|slip| {
            let over = (over_slip * slip).min(f64::MAX);
            let thinned = asinh(over);
            let stress = oil.eyring_stress * thinned;
            // Logarithmic slopes of the stress over the pressure.
            let sheared = match stress < oil.limiting_shear * pressure {
                true if thinned > 0.0 => {
                    let part = 1.0 / (1.0 + 1.0 / (over * over)).sqrt() / thinned;
                    let value = stress / pressure;
                    Of {
                        value,
                        by_load: value * (part * (slope / 3.0 - central.by_load) - 1.0 / 3.0),
                        by_speed: value * part * (1.0 - central.by_speed),
                    }
                }
                true => Of::default(),
                false => Of { value: oil.limiting_shear, ..Of::default() },
            };
            let falls = -2.0 * ratio / (1.0 + ratio) * touching * (dry - sheared.value);
            Of {
                value: sheared.value + (dry - sheared.value) * touching,
                by_load: (sheared.by_load * (1.0 - touching) + falls * least.by_load) / load,
                by_speed: sheared.by_speed * (1.0 - touching) + falls * least.by_speed,
            }
        })
    }
}

/// Powers of the thermal loading that [`heating`] takes.
fn powers_of_heat(heat: f64) -> [f64; 2] {
    [pow(heat, 0.42), pow(heat, 0.64)]
}

/// [-] what heating of the inlet leaves of a film (Gupta, Cheng and others 1992, without sliding), by the largest pressure over E' and powers of the thermal loading;
/// with its logarithmic derivatives by the pressure and the loading.
fn heating(pressure: f64, [to_loss, to_thinner]: [f64; 2]) -> Of {
    let loss = 13.2 * pressure * to_loss;
    let (left, steep) = match loss <= LARGEST_LOSS {
        true => (1.0 - loss, loss / (1.0 - loss)),
        false => {
            let left = (1.0 - LARGEST_LOSS) * exp((LARGEST_LOSS - loss) / (1.0 - LARGEST_LOSS));
            (left, loss / (1.0 - LARGEST_LOSS))
        }
    };
    let thinner = 0.213 * to_thinner;
    Of {
        value: left / (1.0 + thinner),
        by_load: -steep,
        by_speed: -0.42 * steep - 0.64 * thinner / (1.0 + thinner),
    }
}
