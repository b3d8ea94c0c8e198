//! An elastohydrodynamic film between ball and raceway: what it leaves of dry friction, and its rolling resistance.
//!
//! Friction is that of the film's shear and of the roughness that still touches: its coefficient depends on the slip, and takes the
//! place of the constant one in the creep law. The elasticity of the bodies, which the creep law has, and the film that shears lie
//! in series ([`crate::contact::linear_theory::LinearTheory::in_series`]).
//!
//! Loads, speeds and slips are those of the moment: no state, and exact derivatives. Of the ellipse, its size is that of the moment,
//! its shape that at the free contact angle: between the shapes at 0 and 40 degrees rolling resistance changes by 2.2 %, friction by
//! 0.3 % (6206, tests/contact/film.rs).

pub mod mixed;
pub mod rolling;
pub mod thickness;
pub mod traction;

use serde::Deserialize;
use strum::IntoStaticStr;

use crate::numerics::elementary::ln;
use crate::numerics::scalar::{Dual, Scalar, SmoothMap, Values};
use mixed::MixedFriction;
use rolling::Inlet;
use thickness::Ellipse;

/// The pressure under which a film shears.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum ShearPressure {
    /// The mean pressure of the contact.
    #[default]
    Mean,
    /// Hertz's pressure, stresses integrated over the ellipse: light contacts that hardly slip carry up to ten times more.
    Hertz,
}

/// [m/s] slip that is added to the true one as if at a right angle: friction of a film that does not slip at all is 0, and a creep law
/// over a limit of 0 is none.
const LEAST_SLIP: f64 = 1e-6;
/// [-] mean of |t^2 - t0^2| over a Hertzian load along the long axis, at the t0 at which half of it slips forwards: 2 sin 10 degrees.
/// Where a bent groove rolls freely its force along rolling is zero there (Heathcote 1921; Johnson 1985, section 8.5).
pub const FREE_ROLLING: f64 = 0.161_142;

/// An oil, and the surfaces that it parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lubricant {
    /// [1/Pa] growth of the viscosity with pressure, at none.
    pub pressure_viscosity: f64,
    /// [1/K] fall of the viscosity with temperature.
    pub temperature_viscosity: f64,
    /// [W/(m K)] thermal conductivity.
    pub conductivity: f64,
    /// \[Pa] Eyring stress, above which shear thins the oil.
    pub eyring_stress: f64,
    /// [-] largest shear stress over pressure.
    pub limiting_shear: f64,
    /// The pressure under which it shears.
    pub shear_pressure: ShearPressure,
    /// \[m] roughness of ball and race together, root mean square.
    pub roughness: f64,
    /// Law of mixed friction: how much of a contact is dry.
    pub mixed_friction: MixedFriction,
    /// Does the shear of the inlet heat the oil?
    pub inlet_heating: bool,
    /// Is there rolling resistance?
    pub rolling_resistance: bool,
}

/// The film of a raceway: what stays the same during a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RacewayFilm {
    /// Oil and surfaces.
    pub lubricant: Lubricant,
    /// \[Pa] E' of ball and race: twice the modulus of Hertz's contact of both.
    pub modulus: f64,
    /// [-] logarithm of the pressure viscosity times E'.
    stiffening: f64,
    /// Shape of the contact ellipse.
    pub ellipse: Ellipse,
}

impl RacewayFilm {
    /// Films of an oil in contacts of a modulus E' \[Pa] and a shape.
    pub fn new(lubricant: Lubricant, modulus: f64, ellipse: Ellipse) -> Self {
        Self { lubricant, modulus, stiffening: ln(lubricant.pressure_viscosity * modulus), ellipse }
    }
}

/// Logarithms that several powers are computed from.
#[derive(Clone, Copy, Debug)]
struct Logarithms<S> {
    /// Logarithm of `eta0 u/(E' Rx)`.
    speed: S,
    /// Logarithm of the thermal loading of the inlet, `eta0 beta u^2/k`.
    heat: S,
}

/// The oil at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Supply {
    /// [Pa s] dynamic viscosity at the inlet.
    pub viscosity: f64,
    /// [-] 1 where films are full, 0 where surfaces are dry.
    pub lubrication: f64,
    /// [-] what starvation leaves of the rolling resistance.
    pub replenishment: f64,
    /// [-] share of friction that is dry, where the law of mixed friction has one for the whole bearing.
    pub dry_share: f64,
}

/// The film of a raceway during a step.
#[derive(Clone, Copy, Debug)]
pub struct Film<'a> {
    /// Constants of the run.
    pub raceway: &'a RacewayFilm,
    /// The oil.
    pub supply: Supply,
    /// [-] friction coefficient of dry surfaces.
    pub dry_friction: f64,
    /// [-] logarithms of `eta0/E'` and of `eta0 beta/k`.
    logarithms: [f64; 2],
}

/// Quantities that a film depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loading<S> {
    /// \[N] normal load.
    pub load: S,
    /// [m/s] rolling speed: mean of both surfaces, above 0.
    pub speed: S,
    /// [m/s] slip ([`slip_of`]).
    pub slip: S,
    /// [1/m] sum of the curvatures along rolling.
    pub curvature: S,
    /// \[m2] area of the ellipse.
    pub area: S,
}

/// Friction and rolling resistance of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmForces<S> {
    /// [-] friction coefficient.
    pub friction: S,
    /// [-] part of it that grows in proportion to the slip, as a viscous film's does: 0 dry, 1 of a film that slips little.
    pub viscous_share: S,
    /// \[N] rolling force on each surface, against its motion.
    pub rolling_force: S,
}

/// [m/s] slip of a film, in the mean over the contact: of a slip along and across rolling [m/s], a spin [rad/s] on an ellipse of a mean
/// semi-axis \[m], and the slip of a bent groove at the ends of the ellipse [m/s].
#[inline(always)]
pub fn slip_of<S: Scalar>([along, across]: [S; 2], (spin, mean_semi_axis): (S, S), bent: S) -> S {
    let bent = bent.scale(FREE_ROLLING);
    let square = along.square() + across.square() + (spin * mean_semi_axis).square() + bent.square();
    (square + S::constant(LEAST_SLIP * LEAST_SLIP)).sqrt()
}

impl<'a> Film<'a> {
    /// The film of an oil, over dry friction.
    pub fn new(raceway: &'a RacewayFilm, supply: Supply, dry_friction: f64) -> Self {
        let Lubricant { temperature_viscosity, conductivity, .. } = raceway.lubricant;
        let viscosity = supply.viscosity;
        let logarithms =
            [viscosity / raceway.modulus, viscosity * temperature_viscosity / conductivity].map(ln);
        Self { raceway, supply, dry_friction, logarithms }
    }
}

impl Film<'_> {
    /// Friction and rolling resistance.
    #[inline(always)]
    pub fn forces<S: Scalar>(&self, loading: &Loading<S>) -> FilmForces<S> {
        let Loading { load, speed, slip, curvature, area } = *loading;
        let [friction, viscous_share, rolling_force] = S::apply(self, [load, speed, slip, curvature, area]);
        FilmForces { friction, viscous_share, rolling_force }
    }

    /// \[m] central and minimum film, with inlet heating where that is simulated.
    pub fn films<S: Scalar>(&self, loading: &Loading<S>) -> [S; 2] {
        self.films_at(loading, &self.logarithms(loading))
    }

    #[inline(always)]
    fn films_at<S: Scalar>(&self, loading: &Loading<S>, logarithms: &Logarithms<S>) -> [S; 2] {
        let RacewayFilm { lubricant, modulus, stiffening, ellipse } = self.raceway;
        let load = (loading.load * loading.curvature.square()).scale(1.0 / modulus);
        let films = ellipse.films(load, logarithms.speed, loading.curvature, *stiffening);
        if !lubricant.inlet_heating {
            return films;
        }
        let pressure = (loading.load / loading.area).scale(1.5 / modulus);
        let factor = thickness::inlet_factor(pressure, logarithms.heat);
        films.map(|film| film * factor)
    }

    /// Logarithms that powers of the speed are computed from.
    #[inline(always)]
    fn logarithms<S: Scalar>(&self, loading: &Loading<S>) -> Logarithms<S> {
        let [of_speed, of_heat] = self.logarithms.map(S::constant);
        let speed = ln(loading.speed);
        Logarithms { speed: speed + ln(loading.curvature) + of_speed, heat: speed.scale(2.0) + of_heat }
    }

    /// Is rolling resistance simulated?
    pub fn resists(&self) -> bool {
        self.raceway.lubricant.rolling_resistance
    }

    /// [-] film ratio: minimum film over roughness.
    pub fn ratio<S: Scalar>(&self, loading: &Loading<S>) -> S {
        self.films(loading)[1].scale(self.supply.lubrication / self.raceway.lubricant.roughness)
    }

    /// Friction coefficient, its viscous share, rolling force.
    fn evaluate<S: Scalar>(&self, x: [S; 5]) -> [S; 3] {
        let [load, speed, slip, curvature, area] = x;
        let RacewayFilm { lubricant, modulus, ellipse, .. } = self.raceway;
        // Neither a load nor an area of 0 is divided by: 1e-20 m2 are an ellipse of a tenth of a nanometre.
        let area = area + S::constant(1e-20);
        let loading = Loading { load, speed, slip, curvature, area };
        let logarithms = self.logarithms(&loading);
        let [central, minimum] = self.films_at(&loading, &logarithms);
        let shear = lubricant.shear(self.supply.viscosity, load / area, slip / central);
        let ratio = minimum.scale(self.supply.lubrication / lubricant.roughness);
        let touching = lubricant.mixed_friction.dry_share(ratio, self.supply.dry_share);
        let friction = shear.friction + (S::constant(self.dry_friction) - shear.friction) * touching;
        let viscous = S::one_minus(touching) * shear.friction * shear.thinning / friction;
        let rolling = if lubricant.rolling_resistance {
            let inlet = Inlet {
                load: (load * curvature.square()).scale(1.0 / modulus),
                speed: logarithms.speed + S::constant(std::f64::consts::LN_2),
                half_width: area.sqrt() * curvature,
            };
            let heated =
                if lubricant.inlet_heating { rolling::inlet_factor(logarithms.heat) } else { S::one() };
            let factor = self.supply.lubrication * self.supply.replenishment * modulus;
            let force = (inlet.rolling_force(&ellipse.rolling) * heated / curvature.square()).scale(factor);
            // Not even that of the area above.
            force.where_positive(load, S::zero())
        } else {
            S::zero()
        };
        [friction, viscous, rolling]
    }
}

impl SmoothMap<5, 3> for Film<'_> {
    #[inline(always)]
    fn values<V: Values>(&self, x: [V; 5]) -> [V; 3] {
        // Of no load friction and resistance are none, whatever the film is.
        if x[0].all(|load| load <= 0.0) {
            return [V::constant(self.dry_friction), V::zero(), V::zero()];
        }
        self.evaluate(x)
    }

    fn with_gradient(&self, x: [f64; 5]) -> ([f64; 3], [[f64; 5]; 3]) {
        if x[0] <= 0.0 {
            return (self.values(x), [[0.0; 5]; 3]);
        }
        let y = self.evaluate(std::array::from_fn(|i| Dual::<5>::variable(x[i], i, 1.0)));
        (y.map(|y| y.value), y.map(|y| y.derivatives))
    }
}
