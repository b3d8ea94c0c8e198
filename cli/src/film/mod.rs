//! One lubricated contact of a scene at a given load, rolling speed and slip: what a run computes at every ball, by the same code.

pub mod figure;

use nalgebra::Vector3;
use roulement::contact::{BallMotion, ContactModel, RaceMotion};
use roulement::effects::RESISTING;
use roulement::equilibrium::{EquilibriumInput, Gyroscopic};
use roulement::model::bodies::Race;
use roulement::model::{Conditions, Model};
use roulement::scene::Scene;

/// [-] change of the approach in one correction at which the search ends. The approach is a difference of the bearing's lengths: of
/// a tenth of a micrometre it has 9 digits.
const SETTLED: f64 = 1e-9;
/// Most corrections of the approach. The load goes with its power of 1.5 but for a change of the curvature, so that few are needed.
const MOST: usize = 60;

/// A race of a scene, under a ball at its free contact angle.
pub struct FilmContact {
    model: Model,
    conditions: Conditions,
    /// The race.
    pub race: Race,
}

/// Load, speed and slip of a contact that rolls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// \[N] normal load.
    pub load: f64,
    /// [m/s] mean of both surfaces, against the contact.
    pub speed: f64,
    /// [-] surface of the ball less that of the race, over the rolling speed.
    pub slide_to_roll: f64,
}

/// Film and forces of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPoint {
    /// Load, speed and slip.
    pub rolling: Rolling,
    /// \[Pa] largest pressure.
    pub peak_pressure: f64,
    /// \[m] central and minimum film.
    pub films: [f64; 2],
    /// [-] film ratio: minimum film over roughness, times the degree of lubrication.
    pub ratio: f64,
    /// [-] friction coefficient of film and roughness: what the creep law may carry.
    pub limit: f64,
    /// [-] creep force of the ball on the race over the load, positive with the slip: of film and elastic bodies in series. A bent groove
    /// slips back at its sides where its middle rolls, and is pulled there (`effects.groove_slip`).
    pub traction: f64,
    /// \[W] power of the slip, that of a bent groove with it.
    pub slip_power: f64,
    /// \[N] rolling force on each surface.
    pub rolling_force: f64,
    /// \[W] power of rolling resistance.
    pub rolling_power: f64,
    /// \[W] power of the moment against rolling in the material; 0 where nothing resists.
    pub resisting_power: f64,
    /// \[N] drag of the medium on the ball; none without `effects.ambient`.
    pub drag: Option<f64>,
    /// \[W] its power.
    pub drag_power: Option<f64>,
}

/// A column: name with its unit, and what stands in it.
type Column = (String, Get);
/// Value of a column; nothing where the scene has none of it.
type Get = fn(&FilmPoint) -> Option<f64>;

/// Columns of a table of points.
pub fn columns() -> Vec<Column> {
    let resisting = format!("{}_power [W]", RESISTING.name);
    let columns: [(&str, Get); 15] = [
        ("load [N]", |point| Some(point.rolling.load)),
        ("speed [m/s]", |point| Some(point.rolling.speed)),
        ("slide_to_roll [1]", |point| Some(point.rolling.slide_to_roll)),
        ("peak_pressure [Pa]", |point| Some(point.peak_pressure)),
        ("film_central [m]", |point| Some(point.films[0])),
        ("film_minimum [m]", |point| Some(point.films[1])),
        ("film_ratio [1]", |point| Some(point.ratio)),
        ("friction_limit [1]", |point| Some(point.limit)),
        ("traction [1]", |point| Some(point.traction)),
        ("slip_power [W]", |point| Some(point.slip_power)),
        ("rolling_force [N]", |point| Some(point.rolling_force)),
        ("rolling_power [W]", |point| Some(point.rolling_power)),
        (&resisting, |point| Some(point.resisting_power)),
        ("drag [N]", |point| point.drag),
        ("drag_power [W]", |point| point.drag_power),
    ];
    columns.map(|(name, get)| (name.to_string(), get)).into()
}

impl FilmContact {
    /// The contact of a scene on a race.
    ///
    /// # Errors
    /// If the scene has no oil at its start, or its model cannot be built.
    pub fn new(scene: &Scene, race: Race) -> Result<Self, String> {
        let conditions = EquilibriumInput::from_scene(scene, Gyroscopic::OuterRaceControl).with_friction();
        let model = Model::new(scene).map_err(|why| why.to_string())?;
        if model.contact(race, &conditions).film.is_none() {
            return Err(
                "the scene has no oil: it needs a section [film], with lubrication above 0 at the start"
                    .into(),
            );
        }
        Ok(Self { model, conditions, race })
    }

    /// [rad/s] speed of the inner race at which balls roll with a speed [m/s], while the outer race stands: both contacts then roll alike.
    pub fn inner_speed(&self, speed: f64) -> f64 {
        4.0 * speed / (self.model.bearing.pitch_diameter * (1.0 - self.slenderness().powi(2)))
    }

    /// [-] ball diameter times the cosine of the contact angle, over the pitch diameter.
    fn slenderness(&self) -> f64 {
        let bearing = &self.model.bearing;
        2.0 * bearing.ball.radius * bearing.free_contact_angle.cos() / bearing.pitch_diameter
    }

    /// Film and forces of the contact, without spin.
    ///
    /// # Errors
    /// If no approach gives the load.
    pub fn at(&self, rolling: &Rolling) -> Result<FilmPoint, String> {
        // Replenishment of the oil, and growth where it is simulated, are those of the speed at which balls roll so.
        let mut conditions = self.conditions;
        conditions.warmth.spins = [self.inner_speed(rolling.speed), 0.0];
        let contact = self.model.contact(self.race, &conditions);
        let (ball, race) = pressed(&contact, self.race, self.model.bearing.free_contact_angle, rolling)?;
        let evaluated = contact.evaluate(&ball, &race);
        let loading = contact.film_loading(&evaluated);
        let film = contact.film.as_ref().ok_or("no film")?;
        let forces = film.forces(&loading);
        let radius = self.model.bearing.ball.radius;
        // The ball goes around at the speed of pure rolling with the outer race at rest.
        let velocity = Vector3::z() * (rolling.speed / (1.0 + self.slenderness()));
        let medium = self.model.ambient(&Default::default()).medium;
        let drag = medium.map(|medium| medium.drag(radius, &velocity).norm());
        Ok(FilmPoint {
            rolling: *rolling,
            peak_pressure: 1.5 * evaluated.load / loading.area,
            films: film.films(&loading),
            ratio: film.ratio(&loading),
            limit: forces.friction,
            traction: evaluated.creep.longitudinal * evaluated.geometry.circumferential.z / evaluated.load,
            slip_power: evaluated.sliding_power(),
            rolling_force: forces.rolling_force,
            rolling_power: 2.0 * forces.rolling_force * rolling.speed,
            resisting_power: contact.resisting_power(&evaluated),
            drag,
            drag_power: drag.map(|drag| drag * velocity.norm()),
        })
    }
}

/// A ball that is pressed into a race with a load and rolls on it: both turn about the ball's centre and the race's axis, which rest.
fn pressed(
    contact: &ContactModel<'_>,
    race: Race,
    angle: f64,
    rolling: &Rolling,
) -> Result<(BallMotion<f64>, RaceMotion<f64>), String> {
    let (raceway, radius) = (&contact.surface.raceway, contact.surface.ball_radius);
    // A thrust load holds the inner race's groove on the side of -x of the ball, and the outer one's on that of +x.
    let (out, side) = match race {
        Race::Inner => (-1.0, -1.0),
        Race::Outer => (1.0, 1.0),
    };
    let normal = Vector3::new(side * angle.sin(), out * angle.cos(), 0.0);
    let around = Vector3::z();
    let centre = Vector3::new(raceway.groove_offset, raceway.groove_circle_radius, 0.0);
    let surfaces = [0.5, -0.5].map(|share| rolling.speed * (1.0 + share * rolling.slide_to_roll));
    let mut approach = 1e-6;
    for _ in 0..MOST {
        let position = centre + normal * (raceway.groove_radius - radius + approach);
        let distance = (position + normal * radius).y;
        let race_spin = Vector3::x() * (surfaces[1] / distance);
        // Both surfaces move towards +z; about the normal the ball turns with the race.
        let ball_spin = normal.cross(&around) * (surfaces[0] / radius) + normal * normal.dot(&race_spin);
        let ball = BallMotion { position, velocity: Vector3::zeros(), angular_velocity: ball_spin };
        let turning = RaceMotion { angular_velocity: race_spin, ..RaceMotion::default() };
        let load = contact.evaluate(&ball, &turning).load;
        let correction = (rolling.load / load).powf(2.0 / 3.0);
        if (correction - 1.0).abs() <= SETTLED {
            return Ok((ball, turning));
        }
        approach = if correction.is_finite() { approach * correction } else { 2.0 * approach };
    }
    Err(format!("no approach of ball and race gives a load of {} N", rolling.load))
}
