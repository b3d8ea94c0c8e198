//! Films of a roller bearing: of lines on races, by formulas of lines, and of roller ends on ribs, which are balls on planes ([`Film`]).

use std::f64::consts::PI;

use crate::contact::film::thickness::{Ellipse, inlet_factor};
use crate::contact::film::{self, Film, RacewayFilm, Supply};
use crate::numerics::elementary::{exp, ln, pow};
use crate::numerics::scalar::SmoothMap;

/// \[Pa] E' of two bodies of bearing steel, 206 GPa and 0.3.
pub const MODULUS: f64 = 206e9 / (1.0 - 0.3 * 0.3);

/// An oil, and the surfaces that it parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lubricant {
    /// As balls have it.
    pub oil: film::Lubricant,
    /// [Pa s] dynamic viscosity at the inlets.
    pub viscosity: f64,
    /// [s/rad] exponent of starvation over the speed of the rings.
    pub starvation: f64,
}

/// A quantity with its derivatives by a load and by the logarithm of the speed.
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
        self.viscosity * self.oil.temperature_viscosity * u * u / self.oil.conductivity
    }

    /// \[N, N^(1/2)] elastic rolling force of a line over the power of the load, and rigid one over its root, for a radius of curvature and a length \[m] and surfaces of a speed [m/s].
    pub fn rolling(&self, [radius, length]: [f64; 2], u: f64) -> [f64; 2] {
        let stiffening = self.oil.pressure_viscosity;
        let stiffened = pow(stiffening * self.viscosity * u / radius, 0.658);
        [4.318 / stiffening * stiffened * radius * length, 2.08 * (self.viscosity * u * length).sqrt()]
    }

    /// [-] what heating (Aihara 1987) and starvation leave of rolling forces at a speed [rad/s] of the rings and one of the surfaces [m/s]; and its logarithmic derivative by the speed.
    pub fn left(&self, s: f64, u: f64) -> [f64; 2] {
        let heated = 0.29 * pow(self.heat(u), 0.78);
        let starved = self.starvation * s;
        [exp(-starved) / (1.0 + heated), -starved - 1.56 * heated / (1.0 + heated)]
    }

    /// \[m] central film of a line (Dowson and Toyoda 1979), and its least one (Dowson 1968); both recalled, with the heating that films of balls have.
    pub fn films(&self, [radius, length]: [f64; 2], load: f64, u: f64) -> [f64; 2] {
        let speed = self.viscosity * u / (MODULUS * radius);
        let stiffening = self.oil.pressure_viscosity * MODULUS;
        let w = load / (MODULUS * radius * length);
        let left: f64 = inlet_factor((w / (2.0 * PI)).sqrt(), ln(self.heat(u)));
        let central = 3.06 * pow(speed, 0.69) * pow(stiffening, 0.56) * pow(w, -0.10);
        let least = 2.65 * pow(speed, 0.70) * pow(stiffening, 0.54) * pow(w, -0.13);
        [central, least].map(|film| film * radius * left)
    }

    /// Films of roller ends on ribs, balls of a radius \[m] on planes.
    pub fn of_ribs(&self, radius: f64) -> RacewayFilm {
        let half_width = half_width(1.0, radius);
        RacewayFilm::new(self.oil, MODULUS, Ellipse::new([half_width; 2], 1.0, MODULUS, 1.0 / radius))
    }
}

/// \[m] radius of the contact of a ball and a plane under a load \[N] (Hertz).
fn half_width(load: f64, radius: f64) -> f64 {
    pow(1.5 * load * radius / MODULUS, 1.0 / 3.0)
}

/// Films between roller ends and ribs whose surfaces have a speed in the mean.
#[derive(Clone, Copy, Debug)]
pub struct RibFilm<'a> {
    film: Film<'a>,
    /// \[m] radius of the ball.
    radius: f64,
    /// [m/s] the speed.
    speed: f64,
}

impl<'a> RibFilm<'a> {
    /// Films of an oil of a viscosity [Pa s] for balls of a radius \[m] and a speed [m/s], over dry friction.
    pub fn new(ribs: &'a RacewayFilm, viscosity: f64, radius: f64, speed: f64, dry: f64) -> Self {
        let supply = Supply { viscosity, lubrication: 1.0, replenishment: 1.0, dry_share: 0.0 };
        Self { film: Film::new(ribs, supply, dry), radius, speed }
    }

    /// [-] friction coefficient under a load \[N] above 0 and a slip [m/s], which goes with the speed.
    pub fn friction(&self, load: f64, slip: f64) -> Of {
        let area = PI * half_width(load, self.radius).powi(2);
        let ([value, ..], [by, ..]) =
            self.film.with_gradient([load, self.speed, slip, 1.0 / self.radius, area]);
        Of {
            value,
            // The area goes with the power 2/3 of the load.
            by_load: by[0] + by[4] * area / (1.5 * load),
            by_speed: by[1] * self.speed + by[2] * slip,
        }
    }
}
